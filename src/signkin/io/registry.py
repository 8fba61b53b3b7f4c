"""Readers by format, and the way from a file's own axes and units to a Recording.

A format is one file in this folder: it registers a function with
`motion_reader` or `annotation_reader`. A motion reader returns a
`SourceMotion` as the file has it; `read_recording` makes it canonical
(metres or pixels, z up, x to the signer's right).
"""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.annotation import Annotation, TierWish
from signkin.annotation_rules import GlossRules, excerpt
from signkin.clock import FASTEST_HZ, SLOWEST_HZ, no_rate_of_motion
from signkin.errors import SignkinError, listed
from signkin.io.axes import axis_basis, turned
from signkin.io.chosen import check_joint_map, check_positions, check_shares, check_wrists
from signkin.io.collecting import annotation_options, check_annotation_options
from signkin.io.text import brief, quoted
from signkin.recording import Recording

# What people bring and no reader reads -> what to do.
CONVERTED = {
    ".asf": "It is the skeleton of an .amc file: convert both to BVH (Blender, amc2bvh) or C3D.",
    ".amc": "With its .asf it is one recording: convert both to BVH (Blender, amc2bvh) or C3D.",
    ".fbx": "Export it as BVH (Blender, MotionBuilder).",
    ".mvnx": "Export it as BVH or C3D from MVN Analyze.",
    ".xlsx": "Save it as CSV.",
    ".xls": "Save it as CSV.",
    ".mat": "Save the positions as .npy, (frames, points, 3): scipy.io.loadmat, numpy.save.",
}
METRES_PER = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "ft": 0.3048}
# A printed frame time such as 0.0333333 s is 30.00003 Hz: a declared rate may be this far off.
RATE_TOLERANCE = 1e-3


@dataclass(frozen=True, eq=False, kw_only=True)
class SourceMotion:
    """Motion as a file has it: own axes, own unit (None where the file does not say).

    positions: (F, J, 3); orientations: (F, J, 4) scalar-last, or None.
    rate_range: rates that the file's printed digits leave possible, where they leave a choice.
    start_s: time of the first frame on the file's own clock; clock_place: where it stands.
    notes: what was decided in reading, a sentence each.
    """

    rate_hz: float | None
    joints: tuple[str, ...]
    positions: NDArray[np.float64]
    orientations: NDArray[np.float64] | None = None
    parents: tuple[int, ...] | None = None
    unit: str | None = None
    rate_range: tuple[float, float] | None = None
    start_s: float = 0.0
    clock_place: str | None = None
    notes: tuple[str, ...] = ()


MotionReader = Callable[..., SourceMotion]
AnnotationReader = Callable[..., Annotation]

_MOTION: dict[str, tuple[MotionReader, tuple[str, ...]]] = {}
_FOLDERS: set[str] = set()  # formats whose recording is a folder of files
_ANNOTATION: dict[str, tuple[AnnotationReader, tuple[str, ...]]] = {}


def motion_reader(
    name: str, suffixes: tuple[str, ...] = (), folder: bool = False
) -> Callable[[MotionReader], MotionReader]:
    """Register a reader of motion: f(path, *, joints, part, **options) -> SourceMotion.

    Its keyword-only parameters besides joints and part are the format's options.
    folder: whether a recording is a folder.
    """

    def register(reader: MotionReader) -> MotionReader:
        _MOTION[name] = (reader, suffixes)
        if folder:
            _FOLDERS.add(name)
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
    unit: str | float | list[str | float] | None = None,
    rate_hz: float | Mapping[str, Any] | None = None,
    up: str = "z",
    right: str = "x",
    joints: Mapping[str, Any] | None = None,
    part: str | None = None,
    clock: str | None = None,
    **options: Any,
) -> Recording:
    """Read one recording and make it canonical.

    path: the file; its suffix tells the format unless `format` does.
    unit: m, cm, mm, inch, ft or px, or a number of metres, where the file does not say; a list
    of three for a unit an axis of the file.
    rate_hz: where the file does not say; where it does, the two must agree as far as the file's
    printed digits tell. `{use: 60, instead_of_file: true}` overrules the file, and is noted.
    up, right: the file's axis (`y`, `-x`, ...) that points up, and to the signer's right.
    joints: canonical name -> name in the file (for tables: its columns); None keeps all.
    part: which part of the file, where it holds several recordings or people.
    clock: `first_frame` where a file's times do not start at 0 and are to count from there.
    options: what the format wants to know besides (see its module).

    Returns positions in metres (or pixels), orientations where the file has them.
    Raises SignkinError with the file and the place in it.
    """
    path = _file(path)
    part = None if part is None else str(part)
    wanted = _find(_MOTION, path, format, "motion")
    try:
        check_joint_map(joints)
        _check_options(wanted, options)
    except SignkinError as error:
        raise brief(error.at(file=path)) from error
    folders = wanted in {_MOTION[key][0] for key in _FOLDERS}
    source = _guarded(wanted, path, folders, joints=joints, part=part, **options)
    try:
        check_positions(source.positions, source.joints)
        scale, final_unit = _scale(source.unit, unit)
        basis = axis_basis(up, right)
        rate, rate_notes = _agreed_rate(source, rate_hz)
        clock_notes = _clock(source, rate, clock)
        if isinstance(scale, float):
            positions = source.positions @ basis.T * scale
        else:
            positions = source.positions * scale @ basis.T
        sized = "image_size" in inspect.signature(wanted).parameters
        if options.get("image_size") is None:
            check_shares(positions, final_unit, sized)
        check_wrists(positions, source.joints)
        orientations = None
        if source.orientations is not None:
            orientations = turned(source.orientations, basis)
        return Recording(
            name=name or (part if part is not None else path.stem),
            rate_hz=rate,
            joints=source.joints,
            positions=positions,
            orientations=orientations,
            orientation_source="none" if orientations is None else "recorded",
            unit=final_unit,
            parents=source.parents,
            notes=(*source.notes, *rate_notes, *clock_notes),
        )
    except SignkinError as error:
        raise brief(error.at(file=path)) from error


def _check_options(reader: MotionReader, given: Mapping[str, Any]) -> None:
    """Refuse an option that a motion reader does not have."""
    shared = ("joints", "part")
    parameters = list(inspect.signature(reader).parameters.values())
    options = [p.name for p in parameters if p.kind is p.KEYWORD_ONLY and p.name not in shared]
    unknown = [name for name in given if name not in options]
    if unknown:
        known = {id(reader): key for key, (reader, _) in _MOTION.items()}
        raise SignkinError(
            f"no option {listed(unknown)} of the format {known.get(id(reader), 'chosen')}",
            place="options",
            expected=listed([*options, "clock"], 40),
        )
    for parameter in parameters:
        value = given.get(parameter.name)
        if parameter.annotation in ("bool", "bool | None") and not isinstance(value, bool | None):
            raise SignkinError(
                f"{parameter.name} is {quoted(value)}",
                place="options",
                expected="true or false",
            )


def _file(path: object) -> Path:
    if not isinstance(path, str | os.PathLike):
        raise SignkinError(f"the path is {quoted(path)}", expected="a file's name")
    return Path(path)


def _clock(source: SourceMotion, rate_hz: float, clock: str | None) -> tuple[str, ...]:
    """Check where the file's own clock starts; what was decided about it is returned."""
    if clock not in (None, "first_frame"):
        raise SignkinError(
            f"the clock is {quoted(clock)}", place="options, clock", expected="first_frame"
        )
    # Many programs give the first frame the time of one frame.
    if abs(source.start_s) <= 1.5 / rate_hz:
        return ()
    if clock is None:
        raise SignkinError(
            f"the clock starts at {source.start_s:.10g} s",
            place=source.clock_place,
            expected="0 s at the first frame, from which tags are counted",
            todo="Declare options: {clock: first_frame} to count from the first frame.",
        )
    return (f"the file's clock starts at {source.start_s:.10g} s; times count from there",)


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
    path = _file(path)
    reader = _find(_ANNOTATION, path, format, "annotation")
    check_annotation_options(reader, options, path)
    asked = _asked(tiers, path)
    spec = {"tiers": asked, "name": name, "part": part, **options}
    annotation: Annotation = _guarded(reader, path, False, **spec)
    try:
        annotation = excerpt(annotation, from_s, to_s, clock_offset_s, clip)
        return annotation if gloss is None else GlossRules.of(gloss).applied(annotation)
    except SignkinError as error:
        raise error.at(file=path) from error


def _asked(tiers: Any, path: Path) -> tuple[TierWish, ...] | None:
    """Return the tiers that are asked for, None for all."""
    if tiers is None or isinstance(tiers, str | Mapping):
        return None if tiers is None else (tiers,)
    if isinstance(tiers, Sequence) and all(isinstance(t, str | Mapping) for t in tiers):
        return tuple(tiers)
    raise SignkinError(
        f"the tiers are {quoted(tiers)}", file=path, place="tiers",
        expected="names, or mappings of pattern and participant",
    )  # fmt: skip


def in_file_axes(
    recording: Recording, *, unit: Any, up: str = "z", right: str = "x"
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Return positions and orientations in a file's own axes and unit: `read_recording` undone."""
    scale, _ = _scale(None, unit)
    basis = axis_basis(up, right)
    if isinstance(scale, float):
        positions = recording.positions / scale @ basis
    else:
        positions = recording.positions @ basis / scale
    if recording.orientations is None:
        return positions, None
    return positions, turned(recording.orientations, basis.T)


def _scale(of_file: str | None, declared: Any) -> tuple[float | NDArray[np.float64], str]:
    """Return the factor to metres (or 1 for pixels), one or one an axis, and the unit after it."""
    if isinstance(declared, list | tuple):
        if of_file is not None or len(declared) != 3 or "px" in declared:
            raise SignkinError(
                f"a unit an axis, {quoted(declared)}",
                place="unit",
                expected="three of m, cm, mm, inch, ft or metres a unit, where the file tells none",
            )
        return np.array([_scale(None, unit)[0] for unit in declared]), "m"
    if of_file is not None and declared is not None and of_file != declared:
        raise SignkinError(
            f"the declared unit is {declared}, the chosen joints are in {of_file}",
            place="unit",
            expected=of_file,
        )
    unit = of_file or declared
    if unit == "px":
        return 1.0, "px"
    if isinstance(unit, int | float) and not isinstance(unit, bool) and 0 < unit <= 1e6:
        return float(unit), "m"
    if not isinstance(unit, str) or unit not in METRES_PER:
        raise SignkinError(
            "the unit is missing" if unit is None else f"the unit is {quoted(unit)}",
            place="unit",
            expected="m, cm, mm or px, inch, ft, or the number of metres a unit",
            todo="The file does not tell its unit; declare it.",
        )
    return METRES_PER[unit], "m"


def _agreed_rate(source: SourceMotion, declared: Any) -> tuple[float, tuple[str, ...]]:
    """Return the rate of file and declaration, and what there is to be said about it."""
    of_file, possible = source.rate_hz, source.rate_range
    overrule = False
    if isinstance(declared, Mapping):
        if set(declared) - {"use", "instead_of_file"} or "use" not in declared:
            raise SignkinError(
                f"the keys {listed(declared)}", place="rate_hz", expected="use, instead_of_file"
            )
        overrule, declared = declared.get("instead_of_file") is True, declared["use"]
    if declared is not None and (
        isinstance(declared, bool)
        or not isinstance(declared, int | float | np.integer | np.floating)
        or not np.isfinite(declared)
        or declared <= 0
    ):
        raise SignkinError(
            f"the rate is {quoted(declared)}", place="rate_hz", expected="a number above 0, in Hz"
        )
    if declared is None:
        if of_file is None:
            raise SignkinError(
                "the rate is missing",
                place="rate_hz",
                expected="the capture rate in Hz, e.g. 240",
                todo="The file does not tell its rate; declare it.",
            )
        if not SLOWEST_HZ <= of_file <= FASTEST_HZ:
            raise no_rate_of_motion(of_file, source.clock_place or "rate")
        return float(of_file), ()
    rate = float(declared)
    if of_file is None and possible is None:
        return rate, ()
    told = of_file if of_file is not None else round(sum(possible or ()) / 2, 6)
    low, high = possible or (told, told)
    slack = RATE_TOLERANCE * rate
    if low - rate <= slack and rate - high <= slack:
        return rate, ()
    if overrule:
        return rate, (f"the file says {told:.6g} Hz; overruled by the declared {rate:.6g} Hz",)
    raise SignkinError(
        f"the file says {told:g} Hz, the declaration {rate:g} Hz",
        place="rate_hz",
        expected="two rates that agree to 0.1 %, or to the file's printed digits",
        todo=f"Where the file is wrong, rate_hz: {{use: {rate:g}, instead_of_file: true}}.",
    )


def _find(
    readers: Mapping[str, tuple[Any, tuple[str, ...]]],
    path: Path,
    format: str | None,
    what: str,
) -> Any:
    if format is not None:
        if not isinstance(format, str) or format not in readers:
            raise SignkinError(
                f"no reader for the {what} format {quoted(format)}",
                file=path,
                expected=listed(sorted(readers)),
            )
        return readers[format][0]
    if path.is_dir() and what == "motion":
        return readers["openpose_json"][0]
    for reader, suffixes in readers.values():
        if path.suffix.lower() in suffixes:
            return reader
    if what == "motion" and path.suffix.lower() in CONVERTED:
        raise SignkinError(
            f"{path.suffix.lower()} is not read",
            file=path,
            expected="a motion format of docs/adding-a-corpus.md",
            todo=CONVERTED[path.suffix.lower()],
        )
    known = sorted(suffix for _, suffixes in readers.values() for suffix in suffixes)
    raise SignkinError(
        f"the suffix {quoted(path.suffix)} tells no {what} format",
        file=path,
        expected=f"{listed(known)}, or the format by name",
    )


def _guarded(reader: Any, path: Path, folders: bool, **arguments: Any) -> Any:
    if path.is_dir() and not folders:
        raise SignkinError(
            "this is a folder",
            file=path,
            expected="a file",
            todo="A folder of OpenPose's JSON files has the format openpose_json.",
        )
    if not path.is_file() and not path.is_dir():
        raise SignkinError(
            "there is no such file", file=path, todo="Check data_dir and the file's name."
        )
    try:
        return reader(path, **arguments)
    except SignkinError as error:
        raise brief(error.at(file=path)) from error
    except OSError as error:
        raise SignkinError(f"not readable ({error.strerror})", file=path) from error
