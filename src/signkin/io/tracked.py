"""Tables of key points tracked in video: MediaPipe, OpenPose without a header, DeepLabCut.

Each is a preset of the one table reader (`table`). Coordinates from 0 to 1 are neither metres nor
pixels without the image's size, which is to be declared.
"""

from __future__ import annotations

import re
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

# DeepLabCut's own `pcutoff`, and what MediaPipe takes for a landmark that is in view.
LIKELY, VISIBLE = 0.6, 0.5
_NUMBERED = re.compile(r"(?P<video>.*?)(?P<frame>[0-9]{1,15})(?:\.0+|\.[A-Za-z]{2,4})?", re.DOTALL)


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
    header = _header(path, layout, 1)[0]
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
    table, short = _body(path, layout, header, [*clock, *titles, *trust.values()], 2, gaps=True)
    points = numbers_of(table, titles).reshape(len(table), len(chosen), 3)
    seen = {name: numbers_of(table, [title])[:, 0] for name, title in trust.items()}
    _check_seen(seen)
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
) -> SourceMotion:
    """Read a table without a header: x, y, confidence of one key point after the other.

    landmarks: their names, or a list of `landmarks.LISTS`; without, they are numbers from 0. The
    last one's confidence may be missing. 0, 0 or confidence 0 is a gap. image_size: for
    coordinates from 0 to 1.
    """
    layout = Layout(separator, decimal, header_rows=0)
    first = _header(path, layout, 1)[0]
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
    table, _ = _body(path, layout, header, [*titles, *trust.values()], 1)
    positions = np.zeros((len(table), len(chosen), 3))
    positions[..., :2] = numbers_of(table, titles).reshape(len(table), len(chosen), 2)
    seen = {name: numbers_of(table, [title])[:, 0] for name, title in trust.items()}
    _check_seen(seen)
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


@motion_reader("deeplabcut_csv")
def read_deeplabcut_csv(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    confidence_threshold: float = LIKELY,
    separator: str = "comma",
    decimal: str | None = None,
) -> SourceMotion:
    """Read a table of DeepLabCut (SLEAP and Lightning Pose export the same), in pixels.

    Header rows scorer, individuals (where there are several; `part` picks one), bodyparts, coords;
    rows are frames, numbered, or named by image. Less likely than confidence_threshold is a gap.
    """
    limit = threshold_of(confidence_threshold)
    layout = Layout(separator, decimal)
    rows = _header(path, layout, 4)
    titles = [row[0].lower() for row in rows]
    if "bodyparts" not in titles or "coords" not in titles:
        raise SignkinError(
            f"the rows {listed(titles)}", place="line 1", expected="scorer, bodyparts, coords"
        )
    parts, coords = rows[titles.index("bodyparts")], rows[titles.index("coords")]
    owners = rows[titles.index("individuals")] if "individuals" in titles else [""] * len(parts)
    before = next((i for i, axis in enumerate(coords) if axis == "x"), 0)
    people = list(dict.fromkeys(owners[before:]))
    if len(people) > 1 and part is None:
        raise SignkinError(
            f"{len(people)} individuals", place="part", expected=f"one of {listed(people)}"
        )
    if len(people) < 2:
        part = None
    elif part not in people:
        raise SignkinError(
            f"no individual {quoted(part)}", place="part", expected=listed(p for p in people if p)
        )
    places: dict[tuple[str, str], str] = {}
    for i in range(before, len(coords)):
        if part is None or owners[i] == part:
            if (parts[i], coords[i]) in places:
                raise SignkinError(
                    f"{quoted(parts[i])} has two columns {coords[i]}",
                    place=f"line {titles.index('coords') + 1}",
                    expected="each body part once; two scorers in one table are two recordings",
                )
            places[parts[i], coords[i]] = str(i)
    names = tuple(dict.fromkeys(name for name, axis in places if axis == "x"))
    canonical, chosen = pick(names, joints)
    axes = ("x", "y", "z") if all((names[i], "z") in places for i in chosen) else ("x", "y")
    lost = [names[i] for i in chosen for axis in axes if (names[i], axis) not in places]
    if lost or not names:
        raise SignkinError(f"no y of {listed(lost)}", place="row coords", expected="x and y")
    wanted = [places[names[i], axis] for i in chosen for axis in axes]
    trust = {
        name: places[names[i], "likelihood"]
        for name, i in zip(canonical, chosen, strict=True)
        if (names[i], "likelihood") in places
    }
    header = [str(i) for i in range(len(coords))]
    index = header[: max(before, 1)]
    first = titles.index("coords") + FIRST_LINE
    table, _ = _body(path, layout, header, [*wanted, *trust.values(), *index], first)
    _check_index(table, index)
    positions = np.zeros((len(table), len(chosen), 3))
    positions[..., : len(axes)] = numbers_of(table, wanted).reshape(len(table), len(chosen), -1)
    seen = {name: numbers_of(table, [title])[:, 0] for name, title in trust.items()}
    _check_seen(seen)
    masked = sum(int((values < limit).sum()) for values in seen.values())
    note = f"{masked} points less likely than {limit:g} are gaps"
    return source_motion(
        Points(
            joints=canonical,
            positions=positions,
            flat=(len(axes) == 2,) * len(canonical),
            confidence=seen,
            unit="px" if len(axes) == 2 else None,
            notes=(note,) if masked else (),
        ),
        confidence_threshold=confidence_threshold,
    )


def _check_index(table: pd.DataFrame, titles: Sequence[str]) -> None:
    """Refuse frames that do not follow one another, by number or by the image's name.

    Images are `labeled-data/video/img0001.png`, in one cell or in three.
    """
    names = ["/".join(cells) for cells in zip(*(table[t].tolist() for t in titles), strict=True)]
    before: tuple[str, int] | None = None
    for i, name in enumerate(names):
        found = _NUMBERED.fullmatch(name.strip().rstrip("/"))
        if found is None:
            return  # names without numbers say nothing
        now = (found["video"], int(found["frame"]))
        if before is not None and (now[0] != before[0] or now[1] - before[1] != 1):
            raise SignkinError(
                f"frame {quoted(name)} follows {quoted(names[i - 1])}",
                place=f"line {table.index[i] + FIRST_LINE}",
                expected="the frames of one video, whose numbers rise by 1",
            )
        before = now


def _check_seen(seen: Mapping[str, NDArray[np.float64]]) -> None:
    for joint, values in seen.items():
        check_confidence(values[:, None], [joint])


def _once(names: tuple[str, ...]) -> tuple[tuple[str, ...], list[int]]:
    """Return the names that stand once: of two columns of a name it is not known which is meant."""
    counts = Counter(names)
    kept = [i for i, name in enumerate(names) if counts[name] == 1]
    return tuple(names[i] for i in kept), kept


def _header(path: Path, layout: Layout, rows: int) -> list[list[str]]:
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


def _body(
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
