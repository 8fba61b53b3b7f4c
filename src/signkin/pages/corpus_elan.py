"""ELAN files with a tier `check`: what the owner of a corpus should look at, where it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

import pandas as pd

from signkin.annotation import Interval
from signkin.errors import SignkinError
from signkin.io.eaf_write import NewTier, insert_tiers, new_eaf

TIER = "check"
MOST_FILES = 500  # the gravest first
RATED_OK = 4  # rank in the list


@dataclass(frozen=True)
class Looked:
    """A recording for which a file is made: how long it is, its media, its tagged ELAN file.

    clock_offset_s: added to the ELAN file's times to get the recording's.
    """

    duration_s: float
    media: str
    elan: Path | None
    clock_offset_s: float = 0.0


def with_check_tier(rows: pd.DataFrame, about: Looked) -> bytes:
    """Return an ELAN file with what to look at in a recording in a tier `check`.

    rows: of the table `corpus_todo`, of one recording. The file is a copy of the recording's ELAN
    file where there is one (its tags, and refined ones), else it has this tier alone. What
    concerns the whole recording spans it; ELAN allows no overlap in a tier, so that what overlaps
    stands in further ones, `check (2)`. A tier of the user's with such a name stays: the new one
    is then called `signkin check`.
    """
    lanes = _lanes(_annotations(rows, about.duration_s))
    content = (
        new_eaf(author="signkin", date="1970-01-01T00:00:00+00:00", media_url=about.media, tiers=[])
        if about.elan is None
        else about.elan.read_bytes()
    )
    offset = 0.0 if about.elan is None else about.clock_offset_s
    try:
        return insert_tiers(content, _named(TIER, lanes), offset)
    except SignkinError:
        return insert_tiers(content, _named(f"signkin {TIER}", lanes), offset)


def _named(name: str, lanes: Sequence[Sequence[Interval]]) -> list[NewTier]:
    return [
        NewTier(name if i == 1 else f"{name} ({i})", tuple(lane))
        for i, lane in enumerate(lanes, start=1)
    ]


def _annotations(rows: pd.DataFrame, duration_s: float) -> list[Interval]:
    """Return an annotation for each span, with all that is to be looked at there."""
    spans: dict[tuple[float, float], list[str]] = {}
    for row in rows.itertuples():
        whole = pd.isna(row.start_s)
        span = (0.0, duration_s) if whole else (float(row.start_s), float(row.end_s))
        about = f"{row.what} {row.gloss}".strip() if row.gloss else str(row.what)
        spans.setdefault(span, []).append(_writable(f"{about}: {row.why}"))
    return [
        Interval(start, max(end, start + 0.001), "; ".join(told), TIER)
        for (start, end), told in sorted(spans.items())
    ]


def _writable(text: str) -> str:
    """Return a text without what XML has no way to write."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


def _lanes(found: Sequence[Interval]) -> list[list[Interval]]:
    """Return annotations in lanes without overlap, those of tags and transitions first."""
    lanes: list[list[Interval]] = []
    longest_last = sorted(found, key=lambda one: one.label.startswith("recording"))
    for one in longest_last:
        free = (lane for lane in lanes if all(_apart(one, other) for other in lane))
        lane = next(free, None)
        if lane is None:
            lanes.append([one])
        else:
            lane.append(one)
    return lanes


def _apart(one: Interval, other: Interval) -> bool:
    return one.end_s <= other.start_s or other.end_s <= one.start_s


def write_check_files(
    todo: pd.DataFrame, looked: dict[str, Looked], folder: Path
) -> dict[str, Path]:
    """Write the files of a corpus into a folder; returns recording -> file.

    todo: the table `corpus_todo`, the gravest first: of more than 500 recordings the first get a
    file. What is rated ok is not looked at again.
    """
    rows = todo[todo["rank"] < RATED_OK]
    names = [name for name in dict.fromkeys(rows["recording"]) if name in looked]
    out: dict[str, Path] = {}
    by_name = dict(list(rows.groupby("recording", sort=False)))
    for name in names[:MOST_FILES]:
        folder.mkdir(parents=True, exist_ok=True)
        out[name] = folder / f"{name}.eaf"
        out[name].write_bytes(with_check_tier(by_name[name], looked[name]))
    return out


def address_of(file: Path, home: Path) -> str:
    """Return the address of a file from a page in the folder `home`."""
    return quote(file.relative_to(home).as_posix())
