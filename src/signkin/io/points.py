"""Points as a table or a folder has them, made into motion: gaps, pixels, the clock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.clock import SECONDS_PER, clock_of, resample
from signkin.errors import SignkinError, listed
from signkin.io.registry import SourceMotion
from signkin.io.text import quoted
from signkin.velocities import integrate

# Numbers by which programs say that nothing was measured.
SENTINELS = (999.0, 9999.0, 99999.0, 999999.0, 9999999.0)
MOST_CONFIDENCE = 2.0  # OpenPose's reaches a little above 1
MOST_SHARE = 2.0  # points outside the image are further than 1, most are not


@dataclass(frozen=True, eq=False, kw_only=True)
class Points:
    """What a file has of each frame.

    joints: J names; positions: (F, J, 3), NaN where a cell is empty; flat: joints without depth
    (z is 0). confidence: joint -> (F,). times: (F,) in the file's unit, with half a unit of their
    last printed digit and where they stand. rate_hz, unit: where a header tells them. lines: (F,)
    of a text file.
    """

    joints: tuple[str, ...]
    positions: NDArray[np.float64]
    flat: tuple[bool, ...]
    confidence: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    times: NDArray[np.float64] | None = None
    half_digit: float = 0.0
    time_place: str = "times"
    rate_hz: float | None = None
    rate_range: tuple[float, float] | None = None
    unit: str | None = None
    notes: tuple[str, ...] = ()
    lines: NDArray[np.int64] | None = None


def source_motion(
    points: Points,
    *,
    time_unit: str | None = None,
    resample_hz: float | None = None,
    missing: Sequence[float] | None = (),
    confidence_threshold: float = 0.0,
    image_size: Sequence[float] | None = None,
    velocities: str | None = None,
) -> SourceMotion:
    """Return points as motion: what is missing becomes a gap, 0 to 1 becomes pixels.

    A header's rate and the times must agree; resample_hz makes an uneven clock even, with a note.
    missing: values of points that were not seen; None: none was declared, and it is looked for.
    velocities: `integrate`, where the values are velocities in unit/s: also with a note.
    """
    positions = points.positions.copy()
    odd = _check_sentinels(positions, points) if missing is None else ()
    missing = missing or ()
    _blank(positions, points, missing, confidence_threshold)
    unit = points.unit
    if image_size is not None:
        factors = _pixels(image_size)
        _check_shares(positions)
        with np.errstate(over="ignore"):  # what becomes infinite is refused as that
            positions *= factors
        unit = "px"
    rate, possible, start, notes = points.rate_hz, points.rate_range, 0.0, list(points.notes)
    if points.times is not None:
        step = _seconds(time_unit)
        times = points.times * step
        if resample_hz is not None:
            steps = np.diff(times)
            _, positions = resample(times, positions, _rate(resample_hz))
            rate, possible, start = float(resample_hz), None, float(times[0])
            notes.append(
                f"times in steps of {np.min(steps):.4g} to {np.max(steps):.4g} s, "
                f"resampled to {resample_hz:g} Hz"
            )
        else:
            clock = clock_of(
                times, points.time_place, points.half_digit * step, time_unit is not None
            )
            rate, possible = _one_rate(points, clock.rate_hz, clock.rate_range)
            start = clock.start_s
    elif resample_hz is not None:
        raise SignkinError(
            "there are no times to resample by", place="options, resample_hz", expected="times"
        )
    if velocities is not None:
        if velocities != "integrate" or rate is None:
            raise SignkinError(
                f"velocities is {quoted(velocities)}" if rate is not None else "no times",
                place="options, velocities",
                expected="integrate, and times that tell the rate",
            )
        positions = integrate(positions, rate)
        notes.append("positions are velocities, integrated: they drift")
    return SourceMotion(
        rate_hz=rate,
        joints=points.joints,
        positions=positions,
        unit=unit,
        rate_range=possible,
        start_s=start,
        clock_place=points.time_place if points.times is not None else None,
        notes=(*notes, *odd),
    )


def _blank(
    positions: NDArray[np.float64], points: Points, missing: Sequence[float], threshold: float
) -> None:
    """Make gaps, in place, of points that have a missing value or too little confidence."""
    threshold = threshold_of(threshold)
    for j, joint in enumerate(points.joints):
        dimensions = 2 if points.flat[j] else 3
        for value in missing:
            positions[(positions[:, j, :dimensions] == value).all(axis=1), j] = np.nan
        trust = points.confidence.get(joint)
        if trust is not None:
            positions[~((trust > 0) & (trust >= threshold)), j] = np.nan


def check_confidence(trust: NDArray[np.float64], joints: Sequence[str]) -> None:
    """Refuse confidences (F, J) of a tracker that are none: it gives 0 to 1, or little more."""
    with np.errstate(invalid="ignore"):
        wrong = np.argwhere(np.abs(trust) > MOST_CONFIDENCE)
    if len(wrong):
        frame, joint = (int(i) for i in wrong[0])
        raise SignkinError(
            f"a confidence of {trust[frame, joint]:.4g}",
            place=f"joint {joints[joint]}, frame {frame}",
            expected="0 to 1: are these x, y and confidence?",
        )


def threshold_of(value: Any) -> float:
    """Return a declared threshold of confidence, which is a number."""
    if isinstance(value, bool) or not isinstance(value, int | float) or value != value:
        raise SignkinError(
            f"the threshold is {quoted(value)}",
            place="options, confidence_threshold",
            expected="a number",
        )
    return float(value)


def _pixels(image_size: Any) -> NDArray[np.float64]:
    if (
        not isinstance(image_size, list | tuple)
        or len(image_size) != 2
        or not all(isinstance(v, int | float) and 0 < v < 1e6 for v in image_size)
    ):
        raise SignkinError(
            f"the image size is {quoted(image_size)}",
            place="options, image_size",
            expected="[width, height] in pixels",
        )
    width, height = (float(v) for v in image_size)
    return np.array([width, height, width])  # trackers give depth in image widths


def _check_shares(positions: NDArray[np.float64]) -> None:
    """Refuse pixels where shares of the image are to be made pixels; some may lie outside it."""
    there = np.abs(positions[..., :2][np.isfinite(positions[..., :2])])
    if there.size and np.median(there) > MOST_SHARE:
        raise SignkinError(
            f"coordinates of {np.median(there):.4g} (the median), which are no shares of an image",
            place="options, image_size",
            expected="coordinates from 0 to 1",
            todo="Leave image_size out where the file has pixels.",
        )


def _check_sentinels(positions: NDArray[np.float64], points: Points) -> tuple[str, ...]:
    """Refuse points that say `missing` in a number that is not declared; note those at 0."""
    first = positions[..., 0]
    same = (first == positions[..., 1]) & np.isin(np.abs(first), SENTINELS)
    for j in np.flatnonzero(same.any(axis=0)):
        frame = int(np.flatnonzero(same[:, j])[0])
        line = "" if points.lines is None else f"line {points.lines[frame]}, "
        raise SignkinError(
            f"{points.joints[j]} is at {first[frame, j]:g} in all coordinates",
            place=f"{line}frame {frame}",
            expected="a place, or a gap",
            todo=f"Does it mean `not seen`? Declare options: {{missing: {first[frame, j]:g}}}; "
            "else {missing: []}.",
        )
    zero = int((positions == 0).all(axis=2).sum())
    told = "points at exactly 0 in all coordinates are kept as places (options: missing)"
    return (f"{zero} {told}",) if zero else ()


def _seconds(time_unit: str | None) -> float:
    if time_unit is None:
        return 1.0
    if not isinstance(time_unit, str) or time_unit not in SECONDS_PER:
        raise SignkinError(
            f"the time unit is {quoted(time_unit)}",
            place="options, time_unit",
            expected=listed(SECONDS_PER),
        )
    return SECONDS_PER[time_unit]


def _rate(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not value > 0:
        raise SignkinError(
            f"the rate is {quoted(value)}", place="options, resample_hz", expected="a rate in Hz"
        )
    return float(value)


def _one_rate(
    points: Points, of_times: float, possible: tuple[float, float]
) -> tuple[float, tuple[float, float]]:
    """Return the rate of times and header: the header's, where rounded times agree with it."""
    told = points.rate_hz
    if told is None:
        return of_times, possible
    low, high = possible
    if not low * (1 - 1e-3) <= told <= high * (1 + 1e-3):
        raise SignkinError(
            f"the header says {told:g} Hz, the times {of_times:g} Hz",
            place=points.time_place,
            expected="one rate",
            todo="Declare options: {times: ignore} where the header is right.",
        )
    return told, points.rate_range or (told, told)
