"""`signkin score`: one segmentation against another, of two files or two tiers of one file."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from signkin.annotation import Interval
from signkin.errors import SignkinError, listed

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

DRAWS = 200
EXAMPLES = """examples:
  signkin score refined.eaf manual.eaf --tier sign
  signkin score session.eaf --tier annotator2 --tier annotator1
  signkin score model.csv manual.TextGrid --tier SIGN --tier sign --out scores.csv
"""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add `score` to the command line."""
    score = commands.add_parser(
        "score", help="compare two segmentations", epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    score.add_argument("scored", type=Path, help="tags to be scored, of any format that is read")
    score.add_argument("reference", type=Path, nargs="?",
                       help="tags to score against; without: two tiers of one file")  # fmt: skip
    score.add_argument("--tier", action="append", default=[],
                       help="once for both, or of the scored and of the reference")  # fmt: skip
    score.add_argument("--format", help="of the tags, where the suffix does not tell")
    score.add_argument("--rate", type=float, default=25.0,
                       help="frames a second of mF1B and mF1S (25)")  # fmt: skip
    score.add_argument("--draws", type=int, default=DRAWS,
                       help=f"shuffled segmentations for chance ({DRAWS}; 0: none)")  # fmt: skip
    score.add_argument("--out", type=Path, help="write the table to this CSV file, too")


def run_score(told: argparse.Namespace) -> int:
    """Print the table of scores; returns 1 where the tags cannot be compared."""
    try:
        return _score(told)
    except SignkinError as error:
        print(f"signkin: {error}", file=sys.stderr)
        return 1


def _score(told: argparse.Namespace) -> int:
    from signkin.segments.scores import as_segments, score

    tiers = told.tier
    if len(tiers) > 2 or (told.reference is None and len(set(tiers)) != 2):
        raise SignkinError(
            f"{len(tiers)} tiers", place="--tier",
            expected="two different ones of one file" if told.reference is None else "at most two",
        )  # fmt: skip
    if told.draws < 0:
        raise SignkinError(f"--draws {told.draws}", expected="0 or more")
    pair = (tiers * 2)[:2] if tiers else [None, None]
    sides = []
    files = (told.scored, told.reference or told.scored)
    for word, path, tier in zip(("scored", "reference"), files, pair, strict=True):
        segments, tier = _read(path, tier, told.format)
        sides.append(as_segments(segments))
        print(f"{word}: {path}, tier {tier}, {len(segments)} segments")
    print("".join(f"{sentence}\n" for sentence in _beyond(*sides)), end="")
    table = score(sides[0], sides[1], rate_hz=told.rate, draws=told.draws, rng=2017)
    print(_printed(table))
    if told.out is not None:
        told.out.parent.mkdir(parents=True, exist_ok=True)
        table.to_csv(told.out, index=False, float_format="%.6g", lineterminator="\n")
        print(f"The table: {told.out}")
    return 0


def _read(path: Path, tier: str | None, form: str | None) -> tuple[tuple[Interval, ...], str]:
    """Return the intervals of a tier, and its name; what the reader left out is printed."""
    from signkin.io import read_annotation

    annotation = read_annotation(path, tiers=None if tier is None else [tier], format=form)
    if tier is None:
        if len(annotation.tiers) != 1:
            raise SignkinError(
                f"{len(annotation.tiers)} tiers hold tags", file=path, place="tiers",
                expected="one, or --tier with one of: " + listed(annotation.tiers, 40),
            )  # fmt: skip
        tier = annotation.tiers[0]
    for left in annotation.left_out:
        print(f"left out of {path}: {left}")
    segments = annotation.of(tier)
    if not segments:
        print(f"{path}: tier {tier} holds nothing")
    return segments, tier


def _beyond(scored: Floats, reference: Floats) -> list[str]:
    """Say which segments of one side lie where the other has none: tiers of different length."""
    out = []
    for word, other, ours, theirs in (
        ("scored", "reference", scored, reference),
        ("reference", "scored", reference, scored),
    ):
        if not len(ours) or not len(theirs):
            continue
        first, last = float(theirs[:, 0].min()), float(theirs[:, 1].max())
        beyond = int(((ours[:, 1] <= first) | (ours[:, 0] >= last)).sum())
        if beyond:
            out.append(
                f"{word}: {beyond} of {len(ours)} segments lie before {first:.3f} s or after "
                f"{last:.3f} s, where {other} has none; they are scored as without a partner"
            )
    return out


def _printed(table: pd.DataFrame) -> str:
    lines = [f"{'':36s} {'':22s} {'value':>8s}  {'chance (95 %)':>22s}"]
    for row in table.itertuples(index=False):
        there = row.chance == row.chance  # NaN: none was drawn
        chance = f"{row.chance:.3f} ({row.chance_low:.3f}-{row.chance_high:.3f})" if there else ""
        lines.append(
            f"{row.measure:36s} {row.of:22s} {row.value:8.3f}{row.unit:2s}{chance:>22s}".rstrip()
        )
    return "\n".join(lines)
