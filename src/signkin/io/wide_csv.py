"""Wide tables (.csv): a row a frame, a column a coordinate; several recordings may share a file.

The joint map names the columns of each joint: `right_wrist: [right-x, right-y]`.
Two columns make a flat recording (the third coordinate is 0).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.io.points import Points, source_motion
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.table import (
    FIRST_LINE,
    Layout,
    column_numbers,
    known_column,
    numbers_of,
    printed_half_digit,
    read_text_table,
    rows_of_part,
)
from signkin.io.telling import TELLING, first_frame_note, ignored, times_of, told_by
from signkin.io.text import quoted
from signkin.joints import is_known
from signkin.recording import Recording

__all__ = [
    "column_map",
    "column_numbers",
    "digits_for",
    "known_column",
    "read_text_table",
    "read_wide_csv",
    "rows_of_part",
    "write_positions",
    "write_wide_csv",
]

# Noise is written with digits this much finer than its standard deviation, so that the file's last
# digit adds nothing to it.
NOISE_PER_DIGIT = 1000


@motion_reader("csv", suffixes=(".csv", ".tsv"))
def read_wide_csv(
    path: Path,
    *,
    joints: Mapping[str, Sequence[str]] | None = None,
    part: str | None = None,
    recording_column: str | None = None,
    frame_column: str | None = None,
    time_column: str | None = None,
    time_unit: str | None = None,
    resample_hz: float | None = None,
    separator: str | None = None,
    decimal: str | None = None,
    encoding: str | None = None,
    skip_rows: int = 0,
    header_rows: int = 1,
    missing: Any = None,
    confidence: Mapping[str, str] | None = None,
    confidence_threshold: float = 0.0,
    image_size: Sequence[float] | None = None,
    velocities: str | None = None,
    ignore: Sequence[str] | None = None,
) -> SourceMotion:
    """Read one recording of a table.

    recording_column: column whose value is `part`, where a file holds several recordings.
    frame_column: frame numbers; they must follow one another without a hole.
    time_column: a constant rate is required and read off. time_unit: s (default), ms, us or ns.
    resample_hz: rate to which a table with uneven times is resampled, which is noted.
    separator, decimal, encoding, skip_rows, header_rows: see `table.Layout`.
    missing: a number (a point whose coordinates all are this is missing), a text (a cell that is
    this is missing), or a list of them.
    confidence: joint -> column; below confidence_threshold, or at 0, the point is missing.
    image_size: [width, height] in pixels, for coordinates from 0 to 1.
    velocities: `integrate`, where the columns are velocities in unit/s; positions start at 0.
    ignore: columns whose names mean something else than they do elsewhere (see `telling`).
    """
    of_joint = _columns_of(joints)
    trust = _confidence(confidence, of_joint)
    layout = Layout(separator, decimal, skip_rows, header_rows, encoding, missing_texts(missing))
    others = [c for c in (recording_column, frame_column, time_column) if c is not None]
    wanted = [*others, *trust.values(), *(c for columns in of_joint.values() for c in columns)]
    table = read_text_table(path, layout, wanted, also=TELLING)
    rows = rows_of_part(table, recording_column, part)
    told = told_by(rows, [*others, *ignored(ignore)], time_column is not None)
    if frame_column is not None:
        frames = column_numbers(rows, frame_column)
        order = np.argsort(frames, kind="stable")
        rows = rows.iloc[order]
        _check_frames(frames[order], rows.index.to_numpy())
        told = replace(told, notes=(*told.notes, *first_frame_note(frames[order][0])))
    times = None if time_column is None else times_of(rows, time_column)
    motion = source_motion(
        Points(
            rate_range=None if told.clock is None else told.clock.rate_range,
            joints=tuple(of_joint),
            positions=_positions(rows, of_joint),
            flat=tuple(len(columns) == 2 for columns in of_joint.values()),
            confidence={joint: column_numbers(rows, c) for joint, c in trust.items()},
            times=times,
            half_digit=0.0 if time_column is None else printed_half_digit(rows, time_column),
            time_place=f"column {time_column}",
            notes=told.notes,
            lines=rows.index.to_numpy() + FIRST_LINE,
        ),
        time_unit=time_unit,
        resample_hz=resample_hz,
        missing=None if missing is None else missing_numbers(missing),
        confidence_threshold=confidence_threshold,
        image_size=image_size,
        velocities=velocities,
    )
    if told.clock is None:
        return motion
    return replace(motion, start_s=told.clock.start_s, clock_place=told.place)


def _confidence(declared: Any, of_joint: Mapping[str, Sequence[str]]) -> dict[str, str]:
    """Return joint -> column of confidence, of the joints that are read."""
    if declared is not None and not isinstance(declared, Mapping):
        raise SignkinError(
            f"confidence is {quoted(declared)}",
            place="options, confidence",
            expected="joint: column",
        )
    for joint in declared or {}:
        if joint not in of_joint and not is_known(str(joint)):
            raise SignkinError(
                f"no joint {quoted(joint)}", place="options, confidence", expected="a joint's name"
            )
    return {joint: str(c) for joint, c in (declared or {}).items() if joint in of_joint}


def _columns_of(joints: Mapping[str, Sequence[str]] | None) -> dict[str, list[str]]:
    """Return joint -> its columns; no joint, or not 2 or 3 columns of one, is an error."""
    if not joints:
        raise SignkinError(
            "no joint map", place="joints", expected="joint: [columns] for at least one joint"
        )
    for joint, columns in joints.items():
        if isinstance(columns, str | int) or len(columns) not in (2, 3):
            raise SignkinError(
                f"{joint} has the columns {columns!r}", place="joints", expected="2 or 3 columns"
            )
    return {joint: [str(c) for c in columns] for joint, columns in joints.items()}


def _positions(rows: pd.DataFrame, of_joint: Mapping[str, Sequence[str]]) -> NDArray[np.float64]:
    """Return the positions, (F, J, 3); a joint of two columns has 0 as its third coordinate."""
    places = [(j, axis) for j, c in enumerate(of_joint.values()) for axis in range(len(c))]
    positions = np.zeros((len(rows), len(of_joint), 3))
    numbers = numbers_of(rows, [c for columns in of_joint.values() for c in columns])
    for column, (j, axis) in enumerate(places):
        positions[:, j, axis] = numbers[:, column]
    return positions


def missing_texts(missing: Any) -> tuple[str, ...]:
    """Return those of the declared missing values that are text: cells."""
    values = missing if isinstance(missing, list | tuple) else [missing]
    return tuple(value for value in values if isinstance(value, str))


def missing_numbers(missing: Any) -> tuple[float, ...]:
    """Return those of the declared missing values that are numbers: points."""
    values = missing if isinstance(missing, list | tuple) else [missing]
    wrong = [v for v in values if not (v is None or isinstance(v, str | int | float))]
    if wrong:
        raise SignkinError(
            f"missing is {quoted(missing)}",
            place="options, missing",
            expected="a number, a text, or a list of them",
        )
    return tuple(float(v) for v in values if v is not None and not isinstance(v, str))


def write_wide_csv(
    path: Path, columns: Mapping[str, Sequence[float] | np.ndarray], noise_sd: float
) -> None:
    """Write columns of numbers with a column `frame` before them, a row a frame.

    noise_sd: standard deviation of the values' noise, in their unit; it sets the digits written.
    """
    digits = digits_for(noise_sd)
    table = np.column_stack([np.asarray(values, dtype=float) for values in columns.values()])
    rows = (",".join([str(i), *(f"{v:.{digits}f}" for v in row)]) for i, row in enumerate(table))
    path.write_text("\n".join([",".join(["frame", *columns]), *rows]) + "\n", encoding="utf-8")


def digits_for(noise_sd: float) -> int:
    """Return the decimals whose last one is at most a thousandth of the noise."""
    if not noise_sd > 0:
        raise SignkinError(f"a noise of {noise_sd:g}", expected="a standard deviation above 0")
    return max(0, int(np.ceil(np.log10(NOISE_PER_DIGIT / noise_sd))))


def _check_frames(frames: np.ndarray, index: np.ndarray) -> None:
    wrong = ~(np.diff(frames) == 1)
    if wrong.any():
        bad = int(np.flatnonzero(wrong)[0]) + 1
        raise SignkinError(
            f"frame {frames[bad]:g} follows frame {frames[bad - 1]:g}",
            place=f"line {index[bad] + FIRST_LINE}",
            expected="frame numbers that rise by 1; write an empty cell for a gap",
        )


def write_positions(path: Path, recording: Recording) -> None:
    """Write positions as `read_wide_csv` reads them; gaps are empty cells.

    Columns: time_s, then `<joint>_x_m`, `_y_m`, `_z_m` (or `_px`): right, forward, up.
    """
    columns = {"time_s": recording.times_s}
    for joint, axes in column_map(recording).items():
        for axis, column in enumerate(axes):
            columns[column] = recording.track(joint)[:, axis]
    pd.DataFrame(columns).to_csv(path, index=False, float_format="%.9g", lineterminator="\n")


def column_map(recording: Recording) -> dict[str, list[str]]:
    """Return the columns of each joint in a written table: the joint map to read it with."""
    return {
        joint: [f"{joint}_{axis}_{recording.unit}" for axis in "xyz"] for joint in recording.joints
    }
