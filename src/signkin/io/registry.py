"""Readers by format, and the way from a file's own axes and units to a Recording.

A format is one file in this folder: it registers a function with
`motion_reader` or `annotation_reader`. A motion reader returns a
`SourceMotion` as the file has it; `read_recording` makes it canonical
(metres or pixels, z up, x to the signer's right).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from signkin.annotation import Annotation, TierWish
from signkin.annotation_rules import GlossRules, excerpt
from signkin.errors import SignkinError, listed
from signkin.io.collecting import annotation_options, check_annotation_options
from signkin.recording import Recording

METRES_PER = {"m": 1.0, "cm": 0.01, "mm": 0.001}
# A printed frame time such as 0.0333333 s is 30.00003 Hz: a declared rate may be this far off.
RATE_TOLERANCE = 1e-3


@dataclass(frozen=True, eq=False, kw_only=True)
class SourceMotion:
    """Motion as a file has it: own axes, own unit (None where the file does not say).

    positions: (F, J, 3); orientations: (F, J, 4) scalar-last, or None.
    """

    rate_hz: float | None
    joints: tuple[str, ...]
    positions: NDArray[np.float64]
    orientations: NDArray[np.float64] | None = None
    parents: tuple[int, ...] | None = None
    unit: str | None = None


MotionReader = Callable[..., SourceMotion]
AnnotationReader = Callable[..., Annotation]

_MOTION: dict[str, tuple[MotionReader, tuple[str, ...]]] = {}
_ANNOTATION: dict[str, tuple[AnnotationReader, tuple[str, ...]]] = {}


def motion_reader(
    name: str, suffixes: tuple[str, ...] = ()
) -> Callable[[MotionReader], MotionReader]:
    """Register a reader of motion: f(path, *, joints, part, **options) -> SourceMotion."""

    def register(reader: MotionReader) -> MotionReader:
        _MOTION[name] = (reader, suffixes)
        return reader

    return register


def annotation_reader(
    name: str, suffixes: tuple[str, ...] = ()
) -> Callable[[AnnotationReader], AnnotationReader]:
    """Register a reader of annotation: f(path, *, tiers, part, **options) -> Annotation."""

    def register(reader: AnnotationReader) -> AnnotationReader:
        _ANNOTATION[name] = (reader, suffixes)
        return reader

    return register


def motion_formats() -> tuple[str, ...]:
    """Return the names of the motion formats that can be read."""
    return tuple(sorted(_MOTION))


def annotation_formats() -> tuple[str, ...]:
    """Return the names of the annotation formats that can be read."""
    return tuple(sorted(_ANNOTATION))


def wants_rate(format: str) -> bool:
    """Whether an annotation format counts in frames of the motion (option `rate_hz`)."""
    return format in _ANNOTATION and "rate_hz" in annotation_options(_ANNOTATION[format][0])


def read_recording(
    path: str | Path,
    *,
    name: str | None = None,
    format: str | None = None,
    unit: str | None = None,
    rate_hz: float | None = None,
    up: str = "z",
    right: str = "x",
    joints: Mapping[str, Any] | None = None,
    part: str | None = None,
    **options: Any,
) -> Recording:
    """Read one recording and make it canonical.

    path: the file; its suffix tells the format unless `format` does.
    unit: m, cm, mm or px, where the file does not say.
    rate_hz: where the file does not say; where it does, the two must agree.
    up, right: the file's axis (`y`, `-x`, ...) that points up, and to the signer's right.
    joints: canonical name -> name in the file (for tables: its columns); None keeps all.
    part: which part of the file, where it holds several recordings.
    options: what the format wants to know besides (see its module).

    Returns positions in metres (or pixels), orientations where the file has them.
    Raises SignkinError with the file and the place in it.
    """
    path = Path(path)
    reader = _find(_MOTION, path, format, "motion")
    source = _guarded(reader, path, joints=joints, part=part, **options)
    try:
        scale, final_unit = _scale(source.unit, unit)
        basis = axis_basis(up, right)
        positions = source.positions @ basis.T * scale
        orientations = None
        if source.orientations is not None:
            orientations = _turned(source.orientations, basis)
        return Recording(
            name=name or (part if part is not None else path.stem),
            rate_hz=_agreed_rate(source.rate_hz, rate_hz),
            joints=source.joints,
            positions=positions,
            orientations=orientations,
            orientation_source="none" if orientations is None else "recorded",
            unit=final_unit,
            parents=source.parents,
        )
    except SignkinError as error:
        raise error.at(file=path) from error


def read_annotation(
    path: str | Path,
    *,
    tiers: str | Sequence[TierWish] | None = None,
    name: str | None = None,
    format: str | None = None,
    part: str | None = None,
    gloss: Mapping[str, Any] | None = None,
    from_s: float = 0.0,
    to_s: float | None = None,
    clock_offset_s: float = 0.0,
    clip: Sequence[TierWish] = (),
    **options: Any,
) -> Annotation:
    """Read the intervals of tiers (None: all); times in seconds from the recording's start.

    path: the file; its suffix tells the format unless `format` does.
    tiers: names, or mappings with `pattern` (`Gloss*`) and `participant`.
    gloss: rules for labels, `{strip: ["*"], merge: {HOUSE1: HOUSE}}`; see `GlossRules`.
    from_s, to_s: the stretch of the file's time that the recording is; from_s becomes 0.
    clock_offset_s: added to the file's times besides.
    clip: tiers (of utterances, say) whose intervals are cut at the ends of that stretch, where
    those of other tiers are left out and listed.
    options: what the format wants to know besides (see its module).

    Raises SignkinError with the file and the tier.
    """
    path = Path(path)
    reader = _find(_ANNOTATION, path, format, "annotation")
    check_annotation_options(reader, options, path)
    asked = (tiers,) if isinstance(tiers, str) else None if tiers is None else tuple(tiers)
    annotation: Annotation = _guarded(reader, path, tiers=asked, name=name, part=part, **options)
    try:
        annotation = excerpt(annotation, from_s, to_s, clock_offset_s, clip)
        return annotation if gloss is None else GlossRules.of(gloss).applied(annotation)
    except SignkinError as error:
        raise error.at(file=path) from error


def in_file_axes(
    recording: Recording, *, unit: str, up: str = "z", right: str = "x"
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Return positions and orientations in a file's own axes and unit: `read_recording` undone."""
    scale, _ = _scale(None, unit)
    basis = axis_basis(up, right)
    positions = recording.positions / scale @ basis
    if recording.orientations is None:
        return positions, None
    return positions, _turned(recording.orientations, basis.T)


def axis_basis(up: str, right: str) -> NDArray[np.float64]:
    """Return the rotation (3, 3) that takes file axes to right, forward, up.

    Its rows are the signer's right, forward (up x right) and up, as the file
    names them; both axes are written `x`, `-y` and so on.
    """
    z, x = _axis(up, "up"), _axis(right, "right")
    if abs(z @ x) > 0:
        raise SignkinError(
            f"up is {up} and right is {right}", place="axes", expected="two different axes"
        )
    return np.array([x, np.cross(z, x), z])


def _axis(text: str, key: str) -> NDArray[np.float64]:
    name = text.removeprefix("-")
    if name not in ("x", "y", "z"):
        raise SignkinError(
            f"{key} is {text!r}", place="axes", expected="x, y or z, with or without a minus sign"
        )
    axis = np.zeros(3)
    axis["xyz".index(name)] = -1.0 if text.startswith("-") else 1.0
    return axis


def _turned(orientations: NDArray[np.float64], basis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Express rotations of world space in turned axes: R q R^-1."""
    turn = Rotation.from_matrix(basis)
    flat = orientations.reshape(-1, 4)
    out = np.full_like(flat, np.nan)
    there = ~np.isnan(flat).any(axis=1)
    if there.any():
        out[there] = (turn * Rotation.from_quat(flat[there]) * turn.inv()).as_quat()
    return continuous(out.reshape(orientations.shape))


def continuous(quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Choose between q and -q (the same rotation) so that each follows its predecessor smoothly.

    quaternions: (F, J, 4); the first of each joint gets w >= 0. NaN frames are passed over.
    """
    out: NDArray[np.float64] = quaternions.copy()
    for joint in range(out.shape[1]):
        track = out[:, joint]
        there = np.flatnonzero(~np.isnan(track).any(axis=1))
        if not there.size:
            continue
        valid = track[there]
        flips = np.ones(len(there))
        flips[0] = -1.0 if valid[0, 3] < 0 else 1.0
        flips[1:] = np.where((valid[1:] * valid[:-1]).sum(axis=1) < 0, -1.0, 1.0)
        out[there, joint] = valid * np.cumprod(flips)[:, None]
    return out


def _scale(of_file: str | None, declared: str | None) -> tuple[float, str]:
    if of_file is not None and declared is not None and of_file != declared:
        raise SignkinError(
            f"the declared unit is {declared}, the chosen joints are in {of_file}",
            place="unit",
            expected=of_file,
        )
    unit = of_file or declared
    if unit == "px":
        return 1.0, "px"
    if unit not in METRES_PER:
        raise SignkinError(
            "the unit is missing" if unit is None else f"the unit is {unit!r}",
            place="unit",
            expected="m, cm, mm or px",
            todo="The file does not tell its unit; declare it.",
        )
    return METRES_PER[unit], "m"


def _agreed_rate(of_file: float | None, declared: float | None) -> float:
    if of_file is None and declared is None:
        raise SignkinError(
            "the rate is missing",
            place="rate_hz",
            expected="the capture rate in Hz, e.g. 240",
            todo="The file does not tell its rate; declare it.",
        )
    if of_file is None or declared is None:
        rate = of_file if declared is None else declared
        assert rate is not None
        return float(rate)
    if abs(of_file - declared) > RATE_TOLERANCE * abs(declared):
        raise SignkinError(
            f"the file says {of_file:g} Hz, the declaration {declared:g} Hz",
            place="rate_hz",
            expected="two rates that agree to 0.1 %",
        )
    return float(declared)


def _find(
    readers: Mapping[str, tuple[Any, tuple[str, ...]]],
    path: Path,
    format: str | None,
    what: str,
) -> Any:
    if format is not None:
        if format not in readers:
            raise SignkinError(
                f"no reader for the {what} format {format!r}",
                file=path,
                expected=listed(sorted(readers)),
            )
        return readers[format][0]
    for reader, suffixes in readers.values():
        if path.suffix.lower() in suffixes:
            return reader
    known = sorted(suffix for _, suffixes in readers.values() for suffix in suffixes)
    raise SignkinError(
        f"the suffix {path.suffix!r} tells no {what} format",
        file=path,
        expected=f"{listed(known)}, or the format by name",
    )


def _guarded(reader: Any, path: Path, **arguments: Any) -> Any:
    if not path.is_file():
        raise SignkinError(
            "there is no such file", file=path, todo="Check data_dir and the file's name."
        )
    try:
        return reader(path, **arguments)
    except SignkinError as error:
        raise error.at(file=path) from error


def pick(
    available: tuple[str, ...], wanted: Mapping[str, Any] | None
) -> tuple[tuple[str, ...], list[int]]:
    """Return canonical names and the file's indices of the wanted joints (None: all)."""
    if wanted is None:
        return available, list(range(len(available)))
    unknown = [str(name) for name in wanted.values() if name not in available]
    if unknown:
        raise SignkinError(
            f"no joint {listed(unknown)} in the file",
            place="joints",
            expected=listed(available, 200),
        )
    return tuple(wanted), [available.index(name) for name in wanted.values()]
