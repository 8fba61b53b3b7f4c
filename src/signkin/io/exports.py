"""Tables that makers of motion capture export: Qualisys (.tsv), Vicon Nexus and OptiTrack (.csv).

Each is a preset of the one table reader (`table`): how its header stands, and that its unit and
rate are read from there. Markers are named as the file names them, with or without the subject.
Points at exactly 0, 0, 0 and empty cells are gaps.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path

from signkin.errors import SignkinError, listed
from signkin.io.markers import MarkerHead, check_times, read_markers, unit_of
from signkin.io.points import source_motion
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.table import Layout, rows_of
from signkin.io.text import number, quoted, text_lines

# Keys of Qualisys that are read; others, such as EVENT, may come again.
_USED = ("NO_OF_FRAMES", "NO_OF_MARKERS", "FREQUENCY", "DATA_INCLUDED", "MARKER_NAMES")
# Further down no maker's header goes.
_LONGEST_HEADER = 60


@motion_reader("qualisys_tsv")
def read_qualisys_tsv(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    times: str = "check",
    incomplete: bool = False,
    resample_hz: float | None = None,
    decimal: str | None = None,
    encoding: str | None = None,
) -> SourceMotion:
    """Read a 3D export of Qualisys Track Manager: keys and values, then a row a frame, in mm.

    times, incomplete: as for .trc (`trc.read_trc`).
    """
    layout = Layout("tab", decimal, encoding=encoding)
    told: dict[str, list[str]] = {}
    rows = rows_of(path, layout, "\t")
    for line, row in rows:
        key = row[0].strip()
        if key == "Frame" or number(key.replace(",", ".")) is not None:
            break
        if line > _LONGEST_HEADER:
            raise _no_header("MARKER_NAMES and the frames", line)
        cells = [cell.strip() for cell in row[1:]]
        if told.setdefault(key.upper(), cells) != cells and key.upper() in _USED:
            raise SignkinError(
                f"{key} stands twice, with two values", place=f"line {line}", expected="one value"
            )
    else:
        raise _no_header("MARKER_NAMES and the frames", 1)
    if (told.get("DATA_INCLUDED") or ["3D"])[0].upper() != "3D":
        raise SignkinError(
            f"DATA_INCLUDED {quoted(told['DATA_INCLUDED'][0])}",
            place="header",
            expected="3D: the export of marker positions",
        )
    labels = tuple(label for label in told.get("MARKER_NAMES", ()) if label)
    count = _told(told, "NO_OF_MARKERS")
    if not labels or count != len(labels):
        raise SignkinError(
            f"{len(labels)} names in MARKER_NAMES, NO_OF_MARKERS says {count:g}",
            place="header",
            expected="as many",
        )
    titled = row[0].strip() == "Frame"
    before = 2 if titled else 0
    columns = tuple((before + 3 * i, before + 3 * i + 1, before + 3 * i + 2)
                    for i in range(len(labels)))  # fmt: skip
    if titled:
        _check_titles(row, labels, columns, line)
    head = MarkerHead(
        labels=labels, columns=columns, width=before + 3 * len(labels),
        frame=0 if titled else None, time=1 if titled else None,
        rate_hz=_told(told, "FREQUENCY"), unit="mm", frames=int(_told(told, "NO_OF_FRAMES")),
    )  # fmt: skip
    points = read_markers(
        rows_of(path, layout, "\t", line + titled), head, layout, joints, part,
        use_times=check_times(times) or resample_hz is not None, incomplete=incomplete,
    )  # fmt: skip
    return source_motion(points, resample_hz=resample_hz)


def _told(told: Mapping[str, Sequence[str]], key: str) -> float:
    text = (told.get(key) or [""])[0]
    value = number(text.replace(",", "."))
    if value is None or not 0 <= value < 1e9:
        raise SignkinError(f"{key} is {quoted(text)}", place="header", expected="a number")
    return value


def _check_titles(
    row: Sequence[str], labels: Sequence[str], columns: Sequence[tuple[int, int, int]], line: int
) -> None:
    for label, places in zip(labels, columns, strict=True):
        found = [row[i].strip() if i < len(row) else "" for i in places]
        if found != [f"{label} {axis}" for axis in "XYZ"]:
            raise SignkinError(
                f"the columns {listed(found)}",
                place=f"line {line}",
                expected=f"{label} X, Y and Z, as MARKER_NAMES says",
            )


@motion_reader("vicon_csv")
def read_vicon_csv(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    separator: str | None = None,
    decimal: str | None = None,
    encoding: str | None = None,
) -> SourceMotion:
    """Read the section Trajectories of an export of Vicon Nexus.

    Five header rows: title, rate, markers over three columns each, axes, units; the section ends
    where another one starts. Columns of velocities and accelerations are passed over.
    """
    layout, mark = _separated(path, separator, decimal, encoding)
    rows = rows_of(path, layout, mark)
    head: list[tuple[int, list[str]]] = []
    for line, row in rows:
        cells = [cell.strip() for cell in row]
        if head or cells[0].lower() == "trajectories":
            head.append((line, cells))
        if len(head) == 5:
            break
    if len(head) < 5:
        raise _no_header("a section Trajectories: rate, markers, axes, units", 1)
    rate_line, rates = head[1]
    rate = number(rates[0].replace(",", "."))
    if rate is None or not rate > 0 or any(rates[1:]):
        raise SignkinError(
            f"the rate is {listed([rates[0], *filter(None, rates[1:])])!r}",
            place=f"line {rate_line}",
            expected="one number of Hz",
        )
    labels, columns = _triples(head[2][1], head[3][1], head[3][0])
    units = {head[4][1][i] for place in columns for i in place if i < len(head[4][1])}
    if len(units) > 1:
        raise SignkinError(
            f"the units {listed(sorted(units))}", place=f"line {head[4][0]}", expected="one unit"
        )
    width = max(len(head[3][1]), *(place[-1] + 1 for place in columns))
    while width > columns[-1][-1] + 1 and not head[3][1][width - 1]:
        width -= 1
    sub_frames = head[3][1][1:2] == ["Sub Frame"]
    points = read_markers(
        _section(rows, sub_frames),
        _marker_head(labels, columns, width, rate, units),
        layout,
        joints,
        part,
    )
    return source_motion(points)


def _marker_head(
    labels: tuple[str, ...], columns: tuple[tuple[int, int, int], ...], width: int,
    rate: float, units: set[str],
) -> MarkerHead:  # fmt: skip
    unit = unit_of(next(iter(units), ""))
    return MarkerHead(
        labels=labels, columns=columns, width=width, frame=0, time=None, rate_hz=rate, unit=unit
    )


def _section(
    rows: Iterator[tuple[int, list[str]]], sub_frames: bool
) -> Iterator[tuple[int, list[str]]]:
    """Yield rows up to the title of the next section; trajectories again are an error."""
    for line, row in rows:
        title = row[0].strip()
        if title and title[0].isalpha() and not any(cell.strip() for cell in row[1:]):
            break
        if sub_frames and len(row) > 1 and number(row[1].strip()) not in (None, 0):
            raise SignkinError(
                f"sub frame {quoted(row[1])}", place=f"line {line}", expected="0: whole frames"
            )
        yield line, row
    else:
        return
    for later, cells in itertools.chain([(line, row)], rows):
        if cells[0].strip().lower() == "trajectories" and not any(c.strip() for c in cells[1:]):
            raise SignkinError(
                "another section Trajectories", place=f"line {later}", expected="one recording"
            )


def _triples(
    names: Sequence[str], axes: Sequence[str], line: int
) -> tuple[tuple[str, ...], tuple[tuple[int, int, int], ...]]:
    """Return the markers whose name stands over the columns X, Y, Z."""
    labels, columns = [], []
    for i, name in enumerate(names):
        found = [axis.strip().upper() for axis in axes[i : i + 3]]
        if name and found == ["X", "Y", "Z"]:
            labels.append(name)
            columns.append((i, i + 1, i + 2))
        elif name and sorted(found) == ["X", "Y", "Z"]:
            raise SignkinError(
                f"{quoted(name)} over {listed(found)}", place=f"line {line}", expected="X, Y, Z"
            )
    if not labels:
        raise SignkinError(
            f"the axes {listed(axes[:6])}", place=f"line {line}", expected="X, Y, Z under a marker"
        )
    return tuple(labels), tuple(columns)


@motion_reader("motive_csv")
def read_motive_csv(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    times: str = "check",
    incomplete: bool = False,
    resample_hz: float | None = None,
    separator: str | None = None,
    decimal: str | None = None,
    encoding: str | None = None,
) -> SourceMotion:
    """Read an export of OptiTrack Motive: positions of markers, rigid bodies and bones.

    The first row holds keys and values (rate, unit, frames); below it stand the rows Type, Name,
    ID, Parent (some), what is measured, and the axes. Rotations and errors are passed over.
    """
    layout, mark = _separated(path, separator, decimal, encoding)
    rows = rows_of(path, layout, mark)
    told: dict[str, str] = {}
    above: list[list[str]] = []
    for line, row in rows:
        cells = [cell.strip() for cell in row]
        if not told:
            told = dict(zip(cells[::2], cells[1::2], strict=False))
            if "Format Version" not in told:
                raise _no_header("Format Version, Capture Frame Rate, ...", line)
            continue
        if cells[0] == "Frame":
            break
        above.append(cells)
        if line > _LONGEST_HEADER:
            raise _no_header("the row Frame, Time (Seconds), X, Y, Z", line)
    else:
        raise _no_header("the row Frame, Time (Seconds), X, Y, Z", 1)
    if told.get("Coordinate Space", "Global").lower() != "global":
        raise SignkinError(
            f"Coordinate Space {quoted(told['Coordinate Space'])}",
            place="line 1",
            expected="Global: bones in local space are where their parents are",
            todo="Export the take again in global coordinates.",
        )
    by_title = {cells[1]: cells for cells in above if len(cells) > 1 and cells[1]}
    measured = next((cells for cells in reversed(above) if "Position" in cells), None)
    if "Name" not in by_title or measured is None:
        raise _no_header("a row Name, and a row that says Position", line)
    names = [*by_title["Name"], *[""] * len(cells)][: len(cells)]
    measured = [*measured, *[""] * len(cells)][: len(cells)]
    at_position = [
        name if measured[i] == "Position" and cells[i].upper() == "X" and i > 1 else ""
        for i, name in enumerate(names)
    ]
    labels, columns = _triples(at_position, cells, line)
    printed = told.get("Export Frame Rate") or told.get("Capture Frame Rate") or ""
    rate = number(printed.replace(",", "."))
    if rate is None or not rate > 0:
        raise SignkinError(
            f"Export Frame Rate is {quoted(printed)}",
            place="line 1",
            expected="a number of Hz",
        )
    frames = number(told.get("Total Exported Frames", ""))
    head = MarkerHead(
        labels=labels, columns=columns, width=len(cells), frame=0, time=1, rate_hz=rate,
        unit=unit_of(told.get("Length Units", "")), frames=None if frames is None else int(frames),
    )  # fmt: skip
    points = read_markers(
        rows, head, layout, joints, part,
        use_times=check_times(times) or resample_hz is not None, incomplete=incomplete,
    )  # fmt: skip
    return source_motion(points, resample_hz=resample_hz)


def _separated(
    path: Path, separator: str | None, decimal: str | None, encoding: str | None
) -> tuple[Layout, str]:
    """Return the layout, and the separator: the declared one, or the one of the first rows.

    Semicolons and tabs stand in few texts, commas also within numbers: so they are asked first.
    """
    layout = Layout(separator, decimal, encoding=encoding)
    if layout.character is not None:
        return layout, layout.character
    for mark in ("\t", ";"):
        first = [text.count(mark) for text in islice(text_lines(path, encoding), _LONGEST_HEADER)]
        if sum(count >= 3 for count in first) >= 2:
            return Layout(mark, decimal, encoding=encoding), mark
    return Layout(",", decimal, encoding=encoding), ","


def _no_header(expected: str, line: int) -> SignkinError:
    return SignkinError("not this maker's header", place=f"line {line}", expected=expected)
