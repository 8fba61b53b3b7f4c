"""`signkin compare A B` and `signkin verify`: is a tree of results what it should be?"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

from signkin.errors import SignkinError
from signkin.results.written import STATE, differences

SHOWN = 40
COMPARE = """Tables are compared cell by cell, figures by the data drawn in them (figNN.csv), EAF,
BVH and captions by their lines; pages, which hold the day and the versions, are not compared.
Exit status 1 where a number differs beyond the tolerance, or a verdict, a text or a file at all.

example:
  signkin compare results /media/reviewer/results --out differences.csv
"""
VERIFY = """Each job of a run leaves the hashes of its outputs. Exit status 1 where a file is
changed or missing; `signkin run` makes such files anew where they are wanted.

example:
  signkin verify
"""


def add_parsers(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add `compare` and `verify` to the command line."""
    plain = argparse.RawDescriptionHelpFormatter
    compare = commands.add_parser(
        "compare", help="two trees of results: what differs, by how much", epilog=COMPARE,
        formatter_class=plain,
    )  # fmt: skip
    compare.add_argument("a", type=Path, help="results of a run")
    compare.add_argument("b", type=Path, help="results of another one")
    compare.add_argument("--tolerance", type=float, default=1e-9,
                         help="relative difference of numbers that is none (1e-9)")  # fmt: skip
    compare.add_argument("--out", type=Path, help="write all rows to this CSV file, too")
    verify = commands.add_parser(
        "verify", help="list what in results/ is not what the run wrote", epilog=VERIFY,
        formatter_class=plain,
    )  # fmt: skip
    verify.add_argument("results", type=Path, nargs="?", default=Path("results"))


def run_compare(told: argparse.Namespace) -> int:
    """Print how two trees differ; returns 0 where they do not, else 1."""
    import pandas as pd

    from signkin.results.comparison import Row, compare

    try:
        rows = compare(told.a, told.b, told.tolerance)
    except SignkinError as error:
        print(f"signkin: {error}", file=sys.stderr)
        return 1
    if told.out:
        frame = pd.DataFrame([vars(row) for row in rows], columns=list(Row.__annotations__))
        frame.to_csv(told.out, index=False)
    for row in rows[:SHOWN]:
        size = "" if math.isnan(row.relative) else f", up to {row.relative:.2g} relative"
        cells = f" {row.cells} differ{size}" if row.cells else ""
        place = f" ({row.place})" if row.place else ""
        print(f"{row.file}: {row.what}{place}{cells}" + (f": {row.example}" if row.example else ""))
    if len(rows) > SHOWN:
        print(f"and {len(rows) - SHOWN} more" + ("" if told.out else " (--out FILE lists all)"))
    if not rows:
        print(f"No difference beyond {told.tolerance:g} relative.")
    return 1 if rows else 0


def run_verify(told: argparse.Namespace) -> int:
    """Print what in a tree of results is not what its jobs wrote; returns 1 where it matters."""
    if not STATE.is_dir():
        print(f"signkin: no run has left hashes in {STATE.parent.absolute()}. Call this in the "
              "folder of the run.", file=sys.stderr)  # fmt: skip
        return 1
    found = list(differences(told.results))
    wrong = [d for d in found if d.what != "not of a job"]
    for difference in wrong:
        print(f"{difference.path}: {difference.what}")
    extra = len(found) - len(wrong)
    if extra:
        print(f"{extra} files are not of a job (put there by hand, or by an older version).")
    if not wrong:
        print("All that jobs wrote is as they wrote it.")
    else:
        print("`signkin run` makes these anew where they are wanted.")
    return 1 if wrong else 0
