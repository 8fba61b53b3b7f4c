"""Wide tables (.csv): a row a frame, a column a coordinate; several recordings may share a file.

The joint map names the columns of each joint: `right_wrist: [right-x, right-y]`.
Two columns make a flat recording (the third coordinate is 0).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np
import pandas as pd

from signkin.errors import SignkinError, listed
from signkin.io.registry import SourceMotion, motion_reader

# Noise is written with digits this much finer than its standard deviation, so that the file's last
# digit adds nothing to it.
NOISE_PER_DIGIT = 1000
# A clock that is off by more than this share of a frame is not a constant rate.
CLOCK_TOLERANCE = 0.05


@motion_reader("csv", suffixes=(".csv",))
def read_wide_csv(
    path: Path,
    *,
    joints: Mapping[str, Sequence[str]] | None = None,
    part: str | None = None,
    recording_column: str | None = None,
    frame_column: str | None = None,
    time_column: str | None = None,
) -> SourceMotion:
    """Read one recording of a table.

    recording_column: column whose value is `part`, where a file holds several recordings.
    frame_column: frame numbers; they must follow one another without a hole.
    time_column: seconds; a constant rate is required and read off.
    """
    if not joints:
        raise SignkinError(
            "no joint map", place="joints", expected="joint: [columns] for at least one joint"
        )
    table = read_text_table(path)
    rows = rows_of_part(table, recording_column, part)
    if frame_column is not None:
        frames = column_numbers(rows, frame_column)
        order = np.argsort(frames, kind="stable")
        rows = rows.iloc[order]
        _check_frames(frames[order], rows.index.to_numpy())
    positions = np.zeros((len(rows), len(joints), 3))
    for j, (joint, columns) in enumerate(joints.items()):
        if isinstance(columns, str) or len(columns) not in (2, 3):
            raise SignkinError(
                f"{joint} has the columns {columns!r}", place="joints", expected="2 or 3 columns"
            )
        for axis, column in enumerate(columns):
            positions[:, j, axis] = column_numbers(rows, column)
    rate = None if time_column is None else _rate(column_numbers(rows, time_column), time_column)
    return SourceMotion(rate_hz=rate, joints=tuple(joints), positions=positions)


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


def read_text_table(path: Path) -> pd.DataFrame:
    """Return a CSV file with every cell as text; a file is parsed once, however often asked for.

    One file can hold hundreds of recordings. Row i of the frame is line i + 2 of the file.
    """
    state = Path(path).stat()
    return _parsed(Path(path), state.st_mtime_ns, state.st_size)


@lru_cache(maxsize=4)
def _parsed(path: Path, mtime_ns: int, size: int) -> pd.DataFrame:
    try:
        return pd.read_csv(path, dtype=str, keep_default_na=False)
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        raise SignkinError(f"not readable as CSV ({error})") from error


def rows_of_part(table: pd.DataFrame, column: str | None, part: str | None) -> pd.DataFrame:
    """Return the rows of one recording, where a column tells several apart."""
    if column is None:
        return table
    known_column(table, column)
    if part is None:
        raise SignkinError(
            f"the table holds several recordings (column {column})",
            expected="the recording's value in the column `part` of recordings.csv",
        )
    rows = table[table[column] == part]
    if rows.empty:
        raise SignkinError(
            f"no row with {column} = {part}",
            place=f"column {column}",
            expected=listed(table[column].unique()),
        )
    return rows


def known_column(table: pd.DataFrame, column: str) -> str:
    """Return the name of a column that is there; a missing one is an error that lists them."""
    if column not in table.columns:
        raise SignkinError(f"no column {column!r}", expected=listed(table.columns, 40))
    return column


def column_numbers(rows: pd.DataFrame, column: str) -> np.ndarray:
    """Return a column as numbers (an empty cell is NaN); other text is an error with its line."""
    text = rows[known_column(rows, column)].str.strip()
    gaps = text.str.lower().isin(["", "nan", "na"])
    numbers = pd.to_numeric(text.where(~gaps), errors="coerce")
    wrong = numbers.isna() & ~gaps
    if wrong.any():
        line = rows.index[wrong][0]
        raise SignkinError(
            f"found {text[line]!r}",
            place=f"line {line + 2}, column {column}",
            expected="a number, or nothing for a gap",
        )
    return numbers.to_numpy(dtype=float)


def _check_frames(frames: np.ndarray, index: np.ndarray) -> None:
    wrong = ~(np.diff(frames) == 1)
    if wrong.any():
        bad = int(np.flatnonzero(wrong)[0]) + 1
        raise SignkinError(
            f"frame {frames[bad]:g} follows frame {frames[bad - 1]:g}",
            place=f"line {index[bad] + 2}",
            expected="frame numbers that rise by 1; write an empty cell for a gap",
        )


def _rate(times: np.ndarray, column: str) -> float:
    steps = np.diff(times)
    mean = float(np.mean(steps)) if len(steps) else float("nan")
    if not mean > 0 or np.max(np.abs(steps - mean)) > CLOCK_TOLERANCE * mean:
        raise SignkinError(
            f"steps of {np.min(steps):.4g} to {np.max(steps):.4g} s",
            place=f"column {column}",
            expected="a constant frame rate",
            todo="Resample the recording to a constant rate first.",
        )
    return 1.0 / mean
