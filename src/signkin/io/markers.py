"""Markers of optical motion capture: labels with subject prefixes, frames that follow on.

What makers' exports (`exports`), .trc and .c3d have in common.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io.chosen import pick
from signkin.io.points import Points
from signkin.io.registry import METRES_PER
from signkin.io.table import (
    FIRST_LINE,
    Layout,
    column_numbers,
    finest_half_digit,
    numbers_of,
)
from signkin.io.text import quoted
from signkin.rows import check_length, composed

UNITS = {
    **{unit: unit for unit in METRES_PER},
    "meters": "m", "metres": "m", "meter": "m", "metre": "m",
    "centimeters": "cm", "centimetres": "cm", "millimeters": "mm", "millimetres": "mm",
    "in": "inch", "inches": "inch", "feet": "ft", "foot": "ft",
}  # fmt: skip


@dataclass(frozen=True, eq=False, kw_only=True)
class MarkerHead:
    """The header of a table of markers.

    labels: one a marker; columns: where each one's x, y, z stand. width: cells of a row.
    frame, time: columns of frame number and time, where there are such.
    """

    labels: tuple[str, ...]
    columns: tuple[tuple[int, int, int], ...]
    width: int
    frame: int | None
    time: int | None
    rate_hz: float | None
    unit: str | None
    frames: int | None = None


def check_times(times: str) -> bool:
    """Return whether a reader looks at the column of times."""
    if times not in ("check", "ignore"):
        raise SignkinError(
            f"times is {quoted(times)}", place="options, times", expected="check or ignore"
        )
    return times == "check"


def unit_of(text: str) -> str | None:
    """Return the unit that a header names, None where it names none that is known."""
    return UNITS.get(text.strip().lower())


def pick_markers(
    labels: Sequence[str], joints: Mapping[str, str] | None, subject: str | None
) -> tuple[tuple[str, ...], list[int]]:
    """Return canonical names and indices of the wanted markers.

    A marker `Anna:RWRI` is found as that, and as `RWRI` where one subject has it; `subject`
    (the recording's part) keeps the markers of one. Without a map, all that have a label.
    """
    labels = [composed(label) for label in labels]
    joints = None if joints is None else {j: _text(name) for j, name in joints.items()}
    kept = list(range(len(labels)))
    prefixes = list(dict.fromkeys(label.rpartition(":")[0] for label in labels if ":" in label))
    if subject in prefixes:  # otherwise the part names something else, such as a row of the tags
        kept = [i for i in kept if labels[i].rpartition(":")[0] == subject]
    full = [labels[i] for i in kept]
    short = [label.rpartition(":")[2] for label in full]
    if joints is None:
        named = [i for i, label in zip(kept, full, strict=True) if label and label[0] != "*"]
        if not named:
            raise SignkinError("no marker with a label", place="joints", expected="one or more")
        _, order = pick(tuple(labels[i] for i in named), None)
        return tuple(labels[i] for i in named), [named[i] for i in order]
    resolved = {}
    for joint, wanted in joints.items():
        by_short = wanted not in full and wanted in short
        resolved[joint] = full[short.index(wanted)] if by_short else wanted
        if by_short and short.count(wanted) > 1:
            owners = [label for label in full if label.rpartition(":")[2] == wanted]
            raise SignkinError(
                f"{quoted(wanted)} may be {listed(owners)}",
                place="joints",
                expected="one marker",
                todo="Name the subject too, or in the column `part` of recordings.csv.",
            )
    names, indices = pick(tuple(full), resolved)
    return names, [kept[i] for i in indices]


def _text(name: Any) -> Any:
    return composed(name) if isinstance(name, str) else name


def zeros_to_gaps(positions: NDArray[np.float64]) -> tuple[str, ...]:
    """Make gaps, in place, of points at exactly (0, 0, 0); return the note that tells it."""
    zero = (positions == 0).all(axis=2)
    positions[zero] = np.nan
    count = int(zero.sum())
    return (f"{count} points at exactly 0, 0, 0 are taken for missing",) if count else ()


def read_markers(
    rows: Iterable[tuple[int, list[str]]],
    head: MarkerHead,
    layout: Layout,
    joints: Mapping[str, str] | None,
    subject: str | None,
    *,
    use_times: bool = True,
    incomplete: bool = False,
) -> Points:
    """Return the wanted markers of the rows (line, cells) below a header.

    Frames must follow one another; use_times: whether times are looked at. Fewer frames than the
    header promises are an error unless `incomplete`.
    """
    names, chosen = pick_markers(head.labels, joints, subject)
    at = [c for c, used in ((head.frame, True), (head.time, use_times)) if c is not None and used]
    at += [column for i in chosen for column in head.columns[i]]
    cells: list[list[str]] = [[] for _ in at]
    lines: list[int] = []
    for line, row in rows:
        if len(row) != head.width:
            check_length(row, head.width, line)
        lines.append(line)
        for column, i in zip(cells, at, strict=True):
            column.append(row[i])
    if not lines:
        raise SignkinError("no frame below the header", expected="a row a frame")
    table = pd.DataFrame(
        dict(enumerate(cells)), index=np.array(lines, dtype=np.int64) - FIRST_LINE, dtype=object
    )
    titles = ["Frame"] * (head.frame is not None)
    titles += ["Time"] * (head.time is not None and use_times)
    titles += [f"{head.labels[i]} {axis}" for i in chosen for axis in "XYZ"]
    table.columns = pd.Index(titles)
    table.attrs = {"layout": layout, "separator": layout.character}
    notes = _check_frames(table, head, len(lines), incomplete)
    times = column_numbers(table, "Time") if "Time" in titles[:2] else None
    numbers = numbers_of(table, titles[-3 * len(chosen) :])
    positions = numbers.reshape(len(lines), len(chosen), 3)
    gaps = zeros_to_gaps(positions)
    return Points(
        joints=names,
        positions=positions,
        flat=(False,) * len(names),
        times=times,
        half_digit=0.0 if times is None else finest_half_digit(table["Time"].tolist()),
        time_place="column Time",
        rate_hz=head.rate_hz,
        unit=head.unit,
        notes=(*notes, *gaps),
    )


def _check_frames(
    table: pd.DataFrame, head: MarkerHead, count: int, incomplete: bool
) -> tuple[str, ...]:
    notes: list[str] = []
    if head.frame is not None:
        frames = column_numbers(table, "Frame")
        wrong = np.flatnonzero(~(np.diff(frames) == 1))
        if wrong.size:
            bad = int(wrong[0]) + 1
            raise SignkinError(
                f"frame {frames[bad]:g} follows frame {frames[bad - 1]:g}",
                place=f"line {table.index[bad] + FIRST_LINE}",
                expected="frame numbers that rise by 1",
            )
        if frames[0] not in (0, 1):
            notes.append(f"the first frame is number {frames[0]:g}; times count from there")
    if head.frames is not None and head.frames != count:
        notes.append(few_frames(count, head.frames, incomplete))
    return tuple(notes)


def few_frames(count: int, promised: int, incomplete: bool) -> str:
    """Return the note on another number of frames than promised; fewer are an error.

    incomplete: whether the corpus declares that the file is to be read as it is.
    """
    if count < promised and not incomplete:
        raise SignkinError(
            f"{count} frames, where the header says {promised}",
            place="header",
            expected="as many; the file may be truncated",
            todo="Declare options: {incomplete: true} to read what is there.",
        )
    return f"the header promises {promised} frames, {count} are there and read"
