"""Key points as numpy saves them (.npy, .npz): (frames, points, 2 or 3), with a list of landmarks.

With `confidence: true` the last coordinate is confidence. Several people stand before the points:
(frames, people, points, ...), and `part` picks one.
"""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io.binary import damage_told
from signkin.io.chosen import pick
from signkin.io.landmarks import landmark_names
from signkin.io.points import Points, check_confidence, source_motion
from signkin.io.pose import which_person
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.text import LARGEST_BYTES, content_of, quoted


@motion_reader("npy", suffixes=(".npy", ".npz"))
def read_npy(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    landmarks: Any = None,
    key: str | None = None,
    confidence: bool | None = None,
    confidence_threshold: float = 0.0,
    missing: float | None = None,
    image_size: Sequence[float] | None = None,
) -> SourceMotion:
    """Read key points; the unit is to be declared, or image_size for coordinates from 0 to 1.

    landmarks: a list of `landmarks.LISTS` by name, or the names; without, they are numbers from 0.
    confidence: whether the last coordinate is one; where it looks like it, it must be said.
    key: which array of an .npz file with several. missing: value of a point that was not seen.
    """
    values = _array(path, key)
    if values.ndim == 4:
        there = np.isfinite(values).any(axis=(0, 2, 3)) & (values != 0).any(axis=(0, 2, 3))
        values = values[:, which_person(there, part)]
    dimensions = values.shape[2] - bool(confidence) if values.ndim == 3 else 0
    if confidence is None and dimensions == 3:
        _check_depth(values)
    if dimensions not in (2, 3):
        raise SignkinError(
            f"an array of shape {values.shape}",
            place="array",
            expected="(frames, points, 2 or 3), one more with confidence",
        )
    names = landmark_names(landmarks, values.shape[1])
    canonical, chosen = pick(names, None if joints is None else _as_text(joints))
    positions = np.zeros((len(values), len(chosen), 3))
    positions[..., :dimensions] = values[:, chosen, :dimensions]
    if confidence:
        check_confidence(values[:, chosen, -1], canonical)
    trust = {c: values[:, i, -1] for c, i in zip(canonical, chosen, strict=True)}
    if missing is not None and (isinstance(missing, bool) or not isinstance(missing, int | float)):
        raise SignkinError(
            f"missing is {quoted(missing)}", place="options, missing", expected="a number"
        )
    return source_motion(
        Points(
            joints=canonical,
            positions=positions,
            flat=(dimensions == 2,) * len(canonical),
            confidence=trust if confidence else {},
            # Trackers of video give images their two dimensions.
            unit="px" if dimensions == 2 and isinstance(landmarks, str) else None,
        ),
        missing=None if missing is None else (float(missing),),
        confidence_threshold=confidence_threshold,
        image_size=image_size,
    )


def _check_depth(values: NDArray[np.float64]) -> None:
    """Refuse a third coordinate that looks like confidence: 0 to 1 beside pixels."""
    third = values[..., 2][np.isfinite(values[..., 2])]
    flat = np.abs(values[..., :2][np.isfinite(values[..., :2])])
    if third.size and flat.size and flat.max() > 20 and third.min() >= 0 and 0 < third.max() <= 1:
        raise SignkinError(
            f"the third coordinate is {third.min():.3g} to {third.max():.3g} beside others up to "
            f"{flat.max():.4g}",
            place="array",
            expected="coordinates, or confidence that is declared",
            todo="Declare options: {confidence: true}, or false where it is a coordinate.",
        )


def _as_text(joints: Mapping[str, Any]) -> dict[str, str]:
    return {joint: str(place) for joint, place in joints.items()}


def _array(path: Path, key: str | None) -> NDArray[np.float64]:
    """Return the array of a file, never more of it than the file holds, and never an object."""
    content = content_of(path)
    what, whole = "an array of numpy", "a whole .npy or .npz file of numbers"
    if content[:2] == b"PK":
        with damage_told(what, content, whole):
            content = _member(content, key)
    with damage_told(what, content, whole):
        stream = io.BytesIO(content)
        version = np.lib.format.read_magic(stream)
        read = {(1, 0): np.lib.format.read_array_header_1_0,
                (2, 0): np.lib.format.read_array_header_2_0}.get(version)  # fmt: skip
        if read is None:
            raise ValueError(f"version {version}")
        shape, _, kind = read(stream)
        if kind.hasobject or kind.kind not in "fiu":
            raise ValueError(f"an array of {kind}, not of numbers")
        # The header may promise any shape: it is held to the bytes that follow it.
        if any(n < 0 for n in shape) or math.prod(shape) * kind.itemsize > len(content):
            raise ValueError(f"the shape {shape} for {len(content)} bytes")
        stream.seek(0)
        array = np.lib.format.read_array(stream, allow_pickle=False)
    if array.ndim not in (3, 4) or 0 in array.shape:
        raise SignkinError(
            f"an array of shape {array.shape}",
            place="array",
            expected="(frames, points, 2 or 3), or (frames, people, points, 2 or 3)",
        )
    return np.asarray(array, dtype=float)


def _member(content: bytes, key: str | None) -> bytes:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = [name.removesuffix(".npy") for name in archive.namelist()]
        if key is None and len(names) > 1:
            raise SignkinError(
                f"{len(names)} arrays in the file",
                place="options, key",
                expected=f"one of {listed(names)}",
            )
        if not names or (key is not None and key not in names):
            raise SignkinError(
                f"no array {quoted(key)}", place="options, key", expected=listed(names)
            )
        member = archive.infolist()[0 if key is None else names.index(key)]
        if member.file_size > LARGEST_BYTES:
            raise SignkinError(
                f"{member.file_size / 1e6:.0f} MB unpacked",
                place="array",
                expected=f"{LARGEST_BYTES / 1e6:.0f} MB or less",
            )
        with archive.open(member) as file:
            return file.read(LARGEST_BYTES)
