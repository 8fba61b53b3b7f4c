"""C3D files (.c3d) of optical motion capture, read by the library c3d (optional: `signkin[c3d]`).

Points with a residual below 0, and points at 0, 0, 0, are gaps: makers mark occlusion in both
ways. The unit is the file's. Analog channels are left alone, and so are points that the file lists
as angles, forces, moments or powers. The reference library in C++, ezc3d, reads the same values
(tests/oracle), but ends the whole process on some broken files, which a corpus may hold.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from signkin.errors import SignkinError, listed
from signkin.io.binary import damage_told
from signkin.io.markers import few_frames, pick_markers, unit_of, zeros_to_gaps
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.text import content_of, encoding_of, quoted

T = TypeVar("T")
_NO_POSITIONS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")


@motion_reader("c3d", suffixes=(".c3d",))
def read_c3d(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    incomplete: bool = False,
    header: str = "check",
    encoding: str = "utf-8",
) -> SourceMotion:
    """Read the points of a C3D file: labels by name, of the subject `part` where there are several.

    incomplete: read a file of fewer frames than its header promises. header: `check` (its rate and
    numbers must agree with the parameters) or `ignore`. encoding: of the labels.
    """
    size = path.stat().st_size

    def read(reader: Any) -> tuple[list[str], _About, list[Any], int, int]:
        labels, about = _about(reader, encoding_of(b"", encoding))
        _check_size(reader, size, incomplete)
        frames = [points for _, points, _ in reader.read_frames(check_nan=False)]
        return labels, about, frames, int(reader.first_frame), _promised(reader)

    labels, about, frames, first, promised = opened(path, header, read)
    if len(frames) > promised and not incomplete:
        raise SignkinError(
            f"{len(frames)} frames by the header's last frame, {promised} by POINT:FRAMES",
            place="header",
            expected="one number of frames",
            todo="Declare options: {incomplete: true} to read the smaller number.",
        )
    frames = frames[:promised]
    if not frames or not labels:
        raise SignkinError("no points in the file", expected="points, over 2 frames or more")
    notes: list[str] = []
    if len(frames) < promised:
        notes.append(few_frames(len(frames), promised, incomplete))
    names, chosen = pick_markers(labels, joints, part)
    others = [labels[i] for i in chosen if labels[i] in about.no_positions]
    if joints is not None and others:
        raise SignkinError(
            f"{listed(others)} is no position",
            place="joints",
            expected="a marker; the file lists this under angles, forces, moments or powers",
        )
    if others:
        kept = [k for k, i in enumerate(chosen) if labels[i] not in about.no_positions]
        names, chosen = tuple(names[k] for k in kept), [chosen[k] for k in kept]
        notes.append(f"{len(others)} points that are angles, forces or the like are left out")
    with np.errstate(invalid="ignore"):  # a damaged file may hold signalling NaNs
        points = np.array(frames, dtype=float)[:, chosen]
    positions = np.ascontiguousarray(points[..., :3])
    positions[points[..., 3] < 0] = np.nan
    notes += zeros_to_gaps(positions)
    if first > 1:
        notes.append(f"the first frame is number {first}; times count from there")
    return SourceMotion(
        rate_hz=about.rate_hz,
        joints=names,
        positions=positions,
        unit=about.unit,
        clock_place="POINT:RATE",
        notes=tuple(notes),
    )


def opened(path: Path, header: str, read: Callable[[Any], T]) -> T:
    """Return what `read` takes from the library's reader; whatever the library says is a sentence.

    header: see `read_c3d`.
    """
    try:
        import c3d
    except ImportError:
        raise SignkinError(
            "the library c3d is not there", file=path, todo="pip install 'signkin[c3d]'"
        ) from None
    content = content_of(path)
    whole = "a whole file; this one may be damaged"
    with damage_told("a C3D file", content, whole), np.errstate(all="ignore"):
        return read(_reader(c3d, content, header))


def _reader(c3d: Any, content: bytes, header: str) -> Any:
    """Return the library's reader; where header and parameters differ, say in what."""
    if header not in ("check", "ignore"):
        raise SignkinError(
            f"header is {quoted(header)}", place="options, header", expected="check or ignore"
        )

    class Reader(c3d.Reader):  # type: ignore[misc,name-defined,unused-ignore]
        """A reader that ends with a sentence, or takes the parameters' word."""

        def _check_metadata(self) -> None:
            if header == "ignore":
                return
            try:
                super()._check_metadata()
            except AssertionError as error:
                raise SignkinError(
                    str(error).replace(" header != ", " in the header, "),
                    place="header",
                    expected="what the parameters say",
                    todo="Declare options: {header: ignore} where the parameters are right.",
                ) from error

    return Reader(io.BytesIO(content))


class _About:
    """Rate and unit of the points, and the labels that are no positions."""

    def __init__(self, reader: Any, encoding: str) -> None:
        rate = float(reader.point_rate)
        self.rate_hz = float(str(np.float32(rate)))
        units = strings(reader, "POINT.UNITS", encoding)
        self.unit = unit_of(units[0].split()[0]) if units and units[0].split() else None
        self.no_positions = {
            label
            for key in _NO_POSITIONS
            for label in strings(reader, f"POINT.{key}", encoding)
            if label
        }


def _about(reader: Any, encoding: str) -> tuple[list[str], _About]:
    labels = strings(reader, "POINT.LABELS", encoding)
    more = 2
    while strings(reader, f"POINT.LABELS{more}", encoding):  # a parameter holds 255 labels
        labels += strings(reader, f"POINT.LABELS{more}", encoding)
        more += 1
    used = int(reader.point_used)
    labels = [*labels, *(f"*{i}" for i in range(len(labels), used))][:used]
    return labels, _About(reader, encoding)


def strings(reader: Any, key: str, encoding: str) -> list[str]:
    """Return the texts of a parameter, none where it is not there."""
    parameter = reader.get(key)
    if parameter is None or not len(parameter.bytes):
        return []
    content = bytes(parameter.bytes)
    sizes = [int(size) for size in parameter.dimensions]
    width = sizes[0] if len(sizes) > 1 else len(content)
    try:
        return [
            content[at : at + width].decode(encoding).strip(" \0")
            for at in range(0, len(content), max(width, 1))
        ]
    except UnicodeDecodeError as error:
        raise SignkinError(
            f"the labels are not {encoding.upper()}",
            place=key.replace(".", ":"),
            expected="text in UTF-8",
            todo="Declare what they are written in, e.g. options: {encoding: latin-1}.",
        ) from error


def _promised(reader: Any) -> int:
    """Return the number of frames that POINT:FRAMES promises, or else the header."""
    parameter = reader.get("POINT.FRAMES")
    frames = int(parameter.uint16_value) if parameter and len(parameter.bytes) == 2 else 0
    if 0 < frames < 65535:
        return frames
    return int(reader.last_frame) - int(reader.first_frame) + 1


def _check_size(reader: Any, size: int, incomplete: bool) -> None:
    """Refuse a header that promises more than the file holds, before anything is read."""
    a_frame = int(reader.point_used) * 4 * (4 if float(reader.point_scale) < 0 else 2)
    promised = _promised(reader)
    if a_frame <= 0:
        raise SignkinError("no points in the file", expected="points, over 2 frames or more")
    if a_frame * promised > size and not incomplete:
        few_frames(size // a_frame, promised, incomplete)
