"""Marker tracks of OpenSim and Motion Analysis (.trc): tabs or commas, five header rows.

Line 1 names the file, line 2 the keys (DataRate, NumFrames, NumMarkers, Units), line 3 their
values, line 4 the markers, each over three columns, line 5 the axes X1, Y1, Z1. The unit is read;
an empty cell, NaN in any case, and 0, 0, 0 are gaps.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import dropwhile, islice
from pathlib import Path

from signkin.errors import SignkinError, listed
from signkin.io.markers import MarkerHead, check_times, read_markers, unit_of
from signkin.io.points import source_motion
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.table import Layout, rows_of
from signkin.io.text import number, quoted, text_lines

_LINES = 5


@motion_reader("trc", suffixes=(".trc",))
def read_trc(
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
    """Read a .trc file: markers by name (`joints`), of the subject `part` where there are several.

    times: `check` (the column Time must agree with DataRate) or `ignore`. incomplete: read a file
    of fewer frames than NumFrames. resample_hz: see `points.source_motion`.
    """
    head_lines = list(islice(text_lines(path, encoding), _LINES))
    if len(head_lines) < _LINES or not head_lines[0].lower().startswith("pathfiletype"):
        raise SignkinError(
            f"found {quoted(head_lines[0] if head_lines else '')}",
            place="line 1",
            expected="PathFileType and a header of five rows",
        )
    separator = "\t" if "\t" in head_lines[1] else "," if "," in head_lines[1] else ";"
    layout = Layout(separator, decimal, encoding=encoding)
    head = _head(head_lines, separator, layout)
    # Some leave a line free below the header, and some fill it with separators.
    rows = dropwhile(
        lambda row: not any(cell.strip() for cell in row[1]),
        rows_of(path, layout, separator, _LINES + 1),
    )
    points = read_markers(
        rows,
        head,
        layout,
        joints,
        part,
        use_times=check_times(times) or resample_hz is not None,
        incomplete=incomplete,
    )
    return source_motion(points, resample_hz=resample_hz)


def _head(lines: list[str], separator: str, layout: Layout) -> MarkerHead:
    keys, values, names, axes = (
        [cell.strip() for cell in line.split(separator)] for line in lines[1:]
    )
    told = dict(zip((key.lower() for key in keys if key), values, strict=False))
    unit = unit_of(told.get("units", ""))
    rate = _value(told, "datarate", layout)
    if not rate > 0:
        raise SignkinError(f"DataRate {rate:g}", place="line 3", expected="a rate above 0 Hz")
    while names and not names[-1]:
        names.pop()
    starts = [i for i in range(2, len(names)) if names[i]]
    labels = tuple(names[i] for i in starts)
    count = _value(told, "nummarkers", layout)
    if count != len(labels):
        raise SignkinError(
            f"{len(labels)} markers, where NumMarkers says {count:g}",
            place="line 4",
            expected="as many; a name may be missing or doubled",
        )
    for place, start in enumerate(starts):
        found = [axis.upper() for axis in axes[start : start + 3]]
        numbered = {axis[1:] for axis in found} <= {"", str(place + 1)}
        if [axis[:1] for axis in found] != ["X", "Y", "Z"] or start != 2 + 3 * place or (
            not numbered and any(axis[1:].isdigit() for axis in axes)
        ):  # fmt: skip
            raise SignkinError(
                f"the marker {quoted(labels[place])} over {listed(axes[start : start + 3])}",
                place="line 5",
                expected=f"X{place + 1}, Y{place + 1}, Z{place + 1}",
            )
    if [name.lower() for name in names[:1]] != ["frame#"] or len(names) < 2 or not labels:
        raise SignkinError(
            f"found {quoted(separator.join(names[:2]))}", place="line 4", expected="Frame#, Time"
        )
    columns = tuple((start, start + 1, start + 2) for start in starts)
    frames = int(_value(told, "numframes", layout))
    return MarkerHead(
        labels=labels, columns=columns, width=2 + 3 * len(labels), frame=0, time=1,
        rate_hz=rate, unit=unit, frames=frames,
    )  # fmt: skip


def _value(told: Mapping[str, str], key: str, layout: Layout) -> float:
    text = told.get(key, "")
    value = number(text if layout.character == "," else text.replace(",", "."))
    if value is None:
        raise SignkinError(
            f"{key} is {quoted(text)}", place="line 3", expected="DataRate, NumFrames, NumMarkers"
        )
    return value
