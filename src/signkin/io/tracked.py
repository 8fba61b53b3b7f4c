"""Tables of key points tracked in video: MediaPipe, and OpenPose without a header.

Each is a preset of the one table reader (`table`). Coordinates from 0 to 1 are neither metres nor
pixels without the image's size, which is to be declared.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io.chosen import pick
from signkin.io.landmarks import landmark_names
from signkin.io.points import Points, check_confidence, source_motion, threshold_of
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.table import (
    FIRST_LINE,
    Layout,
    finest_half_digit,
    numbers_of,
    rows_of,
)
from signkin.io.text import quoted
from signkin.rows import check_length

# What MediaPipe takes for a landmark that is in view.
VISIBLE = 0.5


@motion_reader("mediapipe_csv")
def read_mediapipe_csv(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    image_size: Sequence[float] | None = None,
    confidence_threshold: float = VISIBLE,
    time_column: str | None = "time",
    time_unit: str = "ms",
    resample_hz: float | None = None,
    separator: str = "comma",
    decimal: str | None = None,
    encoding: str | None = None,
) -> SourceMotion:
    """Read a table of MediaPipe landmarks as masked-piper and envisionBOX write it.

    A row a frame: time (ms), then X_, Y_, Z_ and, of the body, visibility_ of each landmark, named
    without these letters (`RIGHT_WRIST`). x and y are shares of the image, z of its width:
    image_size [width, height] makes them pixels. A landmark less visible than
    confidence_threshold is a gap, and so is a row without its landmarks: the hands' tables write
    what was found first, and of one hand do not say which it is.
    """
    limit = threshold_of(confidence_threshold)
    if image_size is None:
        raise SignkinError(
            "coordinates from 0 to 1, and no size of the image",
            place="options, image_size",
            expected="[width, height] of the video in pixels",
        )
    layout = Layout(separator, decimal, encoding=encoding)
    header = header_of(path, layout, 1)[0]
    names = tuple(title[2:] for title in header if title[:2].upper() == "X_")
    if not names:
        raise SignkinError(
            f"the columns {listed(header, 6)}", place="line 1", expected="time, X_..., Y_..., Z_..."
        )
    canonical, chosen = pick(names, joints) if joints is not None else _once(names)
    titles = [f"{axis}_{names[i]}" for i in chosen for axis in "XYZ"]
    trust = {
        name: f"visibility_{names[i]}"
        for name, i in zip(canonical, chosen, strict=True)
        if f"visibility_{names[i]}" in header
    }
    clock = [] if time_column is None else [time_column]
    table, short = body_of(path, layout, header, [*clock, *titles, *trust.values()], 2, gaps=True)
    points = numbers_of(table, titles).reshape(len(table), len(chosen), 3)
    seen = {name: numbers_of(table, [title])[:, 0] for name, title in trust.items()}
    check_seen(seen)
    masked = sum(int((values < limit).sum()) for values in seen.values())
    notes = [f"{short} rows without all landmarks are gaps"] if short else []
    if masked:
        notes.append(f"{masked} points less visible than {limit:g} are gaps")
    return source_motion(
        Points(
            joints=canonical,
            positions=points,
            flat=(False,) * len(canonical),
            confidence=seen,
            times=numbers_of(table, clock)[:, 0] if clock else None,
            half_digit=finest_half_digit(table[clock[0]].tolist()) if clock else 0.0,
            time_place=f"column {time_column}",
            notes=tuple(notes),
        ),
        time_unit=time_unit,
        resample_hz=resample_hz,
        confidence_threshold=confidence_threshold,
        image_size=image_size,
    )


@motion_reader("openpose_csv")
def read_openpose_csv(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    landmarks: Any = None,
    image_size: Sequence[float] | None = None,
    confidence_threshold: float = 0.0,
    separator: str = "comma",
    decimal: str | None = None,
    encoding: str | None = None,
) -> SourceMotion:
    """Read a table without a header: x, y, confidence of one key point after the other.

    landmarks: their names, or a list of `landmarks.LISTS`; without, they are numbers from 0. The
    last one's confidence may be missing. 0, 0 or confidence 0 is a gap. image_size: for
    coordinates from 0 to 1.
    """
    layout = Layout(separator, decimal, header_rows=0, encoding=encoding)
    first = header_of(path, layout, 1)[0]
    width = len(first)
    if width % 3 == 1 or width < 2:
        raise SignkinError(
            f"{width} columns", place="line 1", expected="three for each point: x, y, confidence"
        )
    names = landmark_names(landmarks, (width + 1) // 3)
    places = None if joints is None else {joint: str(place) for joint, place in joints.items()}
    canonical, chosen = pick(names, places)
    header = [str(i) for i in range(width)]
    titles = [str(3 * i + axis) for i in chosen for axis in (0, 1)]
    trust = {n: str(3 * i + 2) for n, i in zip(canonical, chosen, strict=True) if 3 * i + 2 < width}
    table, _ = body_of(path, layout, header, [*titles, *trust.values()], 1)
    positions = np.zeros((len(table), len(chosen), 3))
    positions[..., :2] = numbers_of(table, titles).reshape(len(table), len(chosen), 2)
    seen = {name: numbers_of(table, [title])[:, 0] for name, title in trust.items()}
    check_seen(seen)
    return source_motion(
        Points(
            joints=canonical,
            positions=positions,
            flat=(True,) * len(canonical),
            confidence=seen,
            unit="px",
        ),
        missing=(0.0,),
        confidence_threshold=confidence_threshold,
        image_size=image_size,
    )


def check_seen(seen: Mapping[str, NDArray[np.float64]]) -> None:
    """Refuse confidences, joint -> (F,), that are none."""
    for joint, values in seen.items():
        check_confidence(values[:, None], [joint])


def _once(names: tuple[str, ...]) -> tuple[tuple[str, ...], list[int]]:
    """Return the names that stand once: of two columns of a name it is not known which is meant."""
    counts = Counter(names)
    kept = [i for i, name in enumerate(names) if counts[name] == 1]
    return tuple(names[i] for i in kept), kept


def header_of(path: Path, layout: Layout, rows: int) -> list[list[str]]:
    """Return the cells of the first rows, all of one length."""
    separator = layout.character or ","
    head = [[c.strip() for c in row] for _, row in islice(rows_of(path, layout, separator), rows)]
    if len(head) < rows:
        raise SignkinError(
            "not readable as CSV (nothing in it)", expected="a header and a row a frame"
        )
    for row in head:
        while row and not row[-1]:
            row.pop()
    width = max(len(row) for row in head)
    if not width:
        raise SignkinError("an empty header", place="line 1", expected="columns")
    return [[*row, *[""] * (width - len(row))] for row in head]


def body_of(
    path: Path,
    layout: Layout,
    header: Sequence[str],
    wanted: Sequence[str],
    first: int,
    gaps: bool = False,
) -> tuple[pd.DataFrame, int]:
    """Return the wanted columns as text from a line on, and how many rows were too short.

    gaps: whether a row that is too short is one whose points are missing (its first cell stays).
    """
    for title in wanted:
        if title not in header:
            raise SignkinError(f"no column {quoted(title)}", expected=listed(header, 40))
        if list(header).count(title) > 1:
            raise SignkinError(f"column {title!r} stands twice", expected="each column once")
    places = [list(header).index(title) for title in wanted]
    cells: list[list[str]] = []
    lines: list[int] = []
    short = 0
    for line, row in rows_of(path, layout, layout.character or ",", first):
        if gaps and len(row) < len(header) and len(row) % 3 == 1:
            row = [row[0], *[""] * (len(header) - 1)]
            short += 1
        elif len(row) != len(header):
            check_length(row, len(header), line)
        cells.append([row[i] for i in places])
        lines.append(line)
    if not lines:
        raise SignkinError("no frame in the table", expected="a row a frame")
    index = np.array(lines, dtype=np.int64) - FIRST_LINE
    table = pd.DataFrame(cells, index=index, columns=list(wanted), dtype=object)
    table.attrs = {"layout": layout, "separator": layout.character}
    return table, short
