"""Columns that tell, by their name and without being declared, what the rows of a table are.

Two people or takes below one another, frames with holes and times that contradict the declared rate
look like one recording otherwise. A column that means something else is named in `ignore`.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.clock import SECONDS_PER, Clock, clock_of
from signkin.errors import SignkinError, listed
from signkin.io.table import FIRST_LINE, NAMELESS, column_numbers, finest_half_digit, known_column
from signkin.io.text import number, quoted
from signkin.io.text_rows import TextTable
from signkin.rows import plain_name

FRAMES = frozenset({"frame", "frames", "frame_number", "frame_no", "frame_nr", "frame_num",
                    "frame_id", "frame_index", "frame_idx", "framenumber", "frameno",
                    "index", plain_name(NAMELESS)})  # fmt: skip
ROWS = frozenset({"index", plain_name(NAMELESS)})  # pandas' numbers of rows
OWNERS = frozenset({"person", "person_id", "subject", "subject_id", "participant",
                    "participant_id", "signer", "signer_id", "speaker", "individual", "track_id",
                    "video", "take", "recording", "trial", "session", "clip"})  # fmt: skip
# These may also number or name each row; they tell people apart where a value comes again.
NAMES = frozenset({"id", "name", "user", "user_id", "file", "filename", "file_name", "source",
                   "object", "video_id", "clip_id"})  # fmt: skip
# Of tags alone: whose layers they are, and numbers of rows.
TIERS = frozenset({"tier", "tier_name", "layer", "hand", "articulator", "track"})
IDS = frozenset({"id", "annotation_id", "tag_id", "sign_id"})
_STEMS = ("time", "times", "t", "timestamp", "timestamps", "elapsed", "elapsed_time")
_UNITS = {
    **dict.fromkeys(("s", "sec", "secs", "seconds"), "s"),
    **dict.fromkeys(("ms", "msec", "millis", "milliseconds"), "ms"),
    "us": "us", "microseconds": "us", "ns": "ns", "nanoseconds": "ns",
}  # fmt: skip
# Name of a column of times -> its unit, None where it does not say.
TIMES: Mapping[str, str | None] = {
    **dict.fromkeys(_STEMS),
    **{f"{stem}_{word}": unit for stem in _STEMS for word, unit in _UNITS.items()},
    "seconds": "s", "milliseconds": "ms", "time_in_s": "s", "time_in_ms": "ms",
}  # fmt: skip
TELLING = frozenset({*FRAMES, *OWNERS, *NAMES, *TIMES})
_CLOCK = re.compile(r"(?:([0-9]{1,3}):)?([0-9]{1,2}):([0-9]{1,2}(?:[.,][0-9]{1,9})?)")


@dataclass(frozen=True)
class Told:
    """What undeclared columns say: a clock with its place, and what is to be noted."""

    clock: Clock | None = None
    place: str | None = None
    notes: tuple[str, ...] = ()


def told_by(rows: pd.DataFrame, declared: Sequence[str], clocked: bool) -> Told:
    """Return what the undeclared columns of one recording's rows say.

    declared: columns that are declared, or to be ignored. clocked: whether a column of times is
    declared. Raises SignkinError where they say that the rows are not one recording's frames.
    """
    columns = [column for column in rows.columns if column not in declared]
    names = {column: plain_name(column) for column in columns}
    for column in columns:
        if names[column] in OWNERS or names[column] in NAMES:
            _check_owner(rows, column, names[column] in NAMES)
    notes = [note for c in columns if names[c] in FRAMES for note in _frames(rows, c)]
    for column in () if clocked else columns:
        clock = _clock(rows, column, TIMES[names[column]]) if names[column] in TIMES else None
        if clock is not None:
            return Told(clock, f"column {column}", tuple(notes))
    return Told(notes=tuple(notes))


def check_undeclared(table: TextTable, declared: Sequence[str]) -> None:
    """Refuse tags whose undeclared columns tell several recordings, people or tiers apart.

    declared: columns that are declared, or to be ignored.
    """
    for place, column in enumerate(table.columns):
        name = plain_name(column)
        if column in declared or name not in OWNERS | NAMES | TIERS | IDS:
            continue
        cells = [row.cells[place].strip() for row in table.rows]
        owners = list(dict.fromkeys(cells))
        again = next((i for i, cell in enumerate(cells) if cell and cell in cells[:i]), None)
        if name in IDS:
            if again is not None and len(owners) > 1:
                raise SignkinError(
                    f"{column} {quoted(cells[again])} stands twice",
                    place=f"line {table.rows[again].line}",
                    expected="each once",
                    todo=f"Are rows doubled? Otherwise declare options: {{ignore: [{column}]}}.",
                )
            continue
        if len(owners) < 2 or (name in NAMES and len(owners) == len(cells)):
            continue
        option = "tier_column" if name in TIERS else "recording_column, participant_column"
        raise SignkinError(
            f"{len(owners)} values in the column {column}: {listed(owners, 3)}",
            place=f"line {table.rows[cells.index(owners[1])].line}",
            expected="what it tells apart, declared",
            todo=f"Declare options: {option}, or {{ignore: [{column}]}}.",
        )


def _check_owner(rows: pd.DataFrame, column: str, only_where_again: bool) -> None:
    owners = rows[column].unique()
    if len(owners) < 2 or (only_where_again and len(owners) == len(rows)):
        return
    raise SignkinError(
        f"{len(owners)} values in the column {column}: {listed(owners, 3)}",
        place=f"line {rows.index[rows[column] != owners[0]][0] + FIRST_LINE}",
        expected="one recording",
        todo=f"Declare options: {{recording_column: {column}}}, and `part`; or "
        f"{{ignore: [{column}]}}.",
    )


def _frames(rows: pd.DataFrame, column: str) -> list[str]:
    """Check undeclared frame numbers; return what is to be noted of them."""
    frames = [number(cell.strip()) for cell in rows[column]]
    steps = [None if a is None or b is None else b - a for a, b in itertools.pairwise(frames)]
    usual = steps[0] if steps else None
    wrong = next((i for i, s in enumerate(steps) if s is None or s <= 0 or s != usual), None)
    if wrong is not None and all(frame is not None for frame in frames):
        raise SignkinError(
            f"{column} {frames[wrong + 1]:g} follows {frames[wrong]:g}",
            place=f"line {rows.index[wrong + 1] + FIRST_LINE}",
            expected="frames that rise evenly, or several recordings that are told apart",
            todo=f"Declare options: {{frame_column: {column}}}, or recording_column; or "
            f"{{ignore: [{column}]}}.",
        )
    notes = []
    if usual is not None and usual != 1 and wrong is None:
        notes.append(f"{column} rises by {usual:g}: each row counts as one frame of the rate")
    if usual is not None and wrong is None and plain_name(column) not in ROWS:
        notes += first_frame_note(frames[0])
    return notes


def first_frame_note(number: float | None) -> list[str]:
    """Return the note on frames that are numbered from later than 1, none where they are not."""
    if number is None or number <= 1:
        return []
    return [f"the first frame is number {number:g}; times count from there"]


def _clock(rows: pd.DataFrame, column: str, unit: str | None) -> Clock | None:
    """Return the clock of an undeclared column of times, None where it tells nothing.

    Its unit is the one of s, ms, us and ns under which the times are those of motion.
    """
    try:
        times = times_of(rows, column)
    except SignkinError:
        return None  # no times: dates, say
    steps = np.diff(times)
    # The same all over, or a counter: no clock.
    if len(times) < 2 or not np.isfinite(times).all() or ((steps == steps[0]).all() and (
        steps[0] in (0, 1)
    )):  # fmt: skip
        return None
    fault: SignkinError | None = None
    for step in [SECONDS_PER[unit]] if unit else SECONDS_PER.values():
        half = finest_half_digit(rows[column].tolist()) * step
        try:
            return clock_of(times * step, f"column {column}", half, unit is not None)
        except SignkinError as error:
            fault = fault or error
    assert fault is not None
    raise SignkinError(
        fault.found,
        place=fault.place,
        expected=fault.expected,
        todo=f"Declare options: {{time_column: {column}}}, with resample_hz where its steps are "
        f"uneven; or {{ignore: [{column}]}}.",
    )


def times_of(rows: pd.DataFrame, column: str) -> NDArray[np.float64]:
    """Return a column of times, (F,): numbers, or h:m:s in seconds."""
    cells = [cell.strip() for cell in rows[known_column(rows, column)]]
    if not any(":" in cell for cell in cells):
        return column_numbers(rows, column)
    out = np.empty(len(cells))
    for i, cell in enumerate(cells):
        found = _CLOCK.fullmatch(cell)
        if found is None:
            raise SignkinError(
                f"found {quoted(cell)}",
                place=f"line {rows.index[i] + FIRST_LINE}, column {column}",
                expected="times, all as h:m:s, or all as numbers",
            )
        seconds = float(found[3].replace(",", "."))
        out[i] = (int(found[1] or 0) * 60 + int(found[2])) * 60 + seconds
    return out


def ignored(value: object) -> list[str]:
    """Return the columns that are not to be looked at."""
    if value is None:
        return []
    if not isinstance(value, list | tuple) or not all(isinstance(v, str) for v in value):
        raise SignkinError(
            f"ignore is {quoted(value)}", place="options, ignore", expected="a list of columns"
        )
    return [str(v) for v in value]
