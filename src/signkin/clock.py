"""Clocks: what rate printed times tell, and an uneven clock made even.

Printed times are rounded: a perfect 120 Hz clock in milliseconds has steps of 8 and 9 ms. What
rounding explains is no fault; what it does not is refused, or resampled where that is declared.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy  # loads its parts when they are used
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.masked import unmasked

# A clock that is off by more than this share of a frame is not a constant rate.
CLOCK_TOLERANCE = 0.05
# Rates that motion is recorded at. Outside, the times are in another unit than was thought.
SLOWEST_HZ, FASTEST_HZ = 2.0, 5000.0
SECONDS_PER = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
# Between two samples further apart than this many usual steps nothing is known.
LONGEST_STEP = 3.0


@dataclass(frozen=True)
class Clock:
    """What times tell: rate in Hz, the range that rounding leaves it, the first time in seconds."""

    rate_hz: float
    rate_range: tuple[float, float]
    start_s: float


def clock_of(
    times_s: NDArray[np.float64], place: str, half_digit_s: float = 0.0, unit_declared: bool = False
) -> Clock:
    """Return the clock of evenly spaced times (F,), in seconds.

    half_digit_s: half a unit of the last digit that the times have.
    Raises SignkinError where a time is missing, does not rise, or is off by more than rounding
    and a twentieth of a frame; and where the rate is none of motion (milliseconds read as
    seconds), unless the unit of the times was declared.
    """
    times_s = np.asarray(times_s, dtype=float)
    missing = np.flatnonzero(~np.isfinite(times_s))
    if missing.size:
        raise SignkinError(
            f"no time in row {missing[0] + 1}", place=place, expected="a time in every row"
        )
    if len(times_s) < 2:
        raise SignkinError(f"{len(times_s)} times", place=place, expected="2 frames or more")
    steps = np.diff(times_s)
    mean = float(np.mean(steps))
    span = float(times_s[-1] - times_s[0])
    uneven = not mean > 0
    if not uneven:
        even = times_s[0] + np.arange(len(times_s)) * mean
        rounding = 2 * half_digit_s if _is_rounded(steps, mean, half_digit_s) else 0.0
        off = np.abs(steps - mean) > CLOCK_TOLERANCE * mean + rounding
        # Small steps off add up: no time may be more than half a frame from where it belongs.
        drift = np.abs(times_s - even) > 0.5 * mean + rounding
        uneven = bool(off.any() or drift.any())
    if uneven:
        worst = int(np.argmax(np.abs(steps - np.median(steps))))
        raise SignkinError(
            f"steps of {np.min(steps):.4g} to {np.max(steps):.4g} s, the furthest off after row "
            f"{worst + 1}",
            place=place,
            expected="a constant frame rate",
            todo="Declare options: {resample_hz: RATE} to have the recording resampled.",
        )
    rate = 1.0 / mean
    if np.max(np.abs(steps - mean)) <= 1e-6 * mean:
        half_digit_s = 0.0  # nothing was rounded: these digits are all there are
    if not unit_declared and not SLOWEST_HZ <= rate <= FASTEST_HZ:
        raise no_rate_of_motion(rate, place)
    low = (len(times_s) - 1) / (span + 2 * half_digit_s)
    high = (len(times_s) - 1) / max(span - 2 * half_digit_s, 1e-12)
    return Clock(rate, (low, high), float(times_s[0]))


def _is_rounded(steps: NDArray[np.float64], mean: float, half_digit_s: float) -> bool:
    """Return whether rounding may explain that steps differ, rather than lost frames.

    A digit of up to half a step cannot hide a lost frame, which doubles one. Coarser than that,
    60 Hz in hundredths has a third of short steps, and 100 Hz with a lost frame one long step.
    """
    digit = 2 * half_digit_s
    if digit <= 0.5 * mean:
        return True
    short = np.count_nonzero(steps < mean)
    rarer = min(short, len(steps) - short)
    return bool(digit <= mean and len(steps) >= 20 and rarer >= 0.1 * len(steps))


def no_rate_of_motion(rate_hz: float, place: str) -> SignkinError:
    """Return the error for a rate at which no motion is recorded."""
    likely = f"are these milliseconds, at {rate_hz * 1000:.4g} Hz?"
    guess = likely if SLOWEST_HZ <= rate_hz * 1000 <= FASTEST_HZ else "in which unit are the times?"
    return SignkinError(
        f"{rate_hz:.4g} Hz is no rate of motion: {guess}",
        place=place,
        expected=f"{SLOWEST_HZ:g} to {FASTEST_HZ:g} Hz",
        todo="Declare the unit (options: {time_unit: ms} in tables), or the rate: "
        "rate_hz: {use: RATE, instead_of_file: true}.",
    )


def resample(
    times_s: NDArray[np.float64], values: NDArray[np.float64], rate_hz: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return even times (G,) from the first to the last one, and the values (G, ...) there.

    times_s: (F,), rising; values: (F, ...), NaN in gaps. Each column is interpolated by a
    shape-preserving cubic (PCHIP) between its own samples, which does not overshoot. Nothing is
    known, and a gap stays, within a gap of the column and between samples more than three usual
    (median) steps apart. Raises SignkinError for times that do not rise.
    """
    times_s, values = unmasked(times_s), unmasked(values)
    steps = np.diff(times_s)
    if len(times_s) < 2 or not np.isfinite(times_s).all() or not (steps > 0).all():
        row = int(np.argmin(np.where(np.isfinite(steps), steps, -np.inf))) + 1 if len(steps) else 0
        raise SignkinError(
            "times that do not rise", place=f"after row {row}", expected="each later than the last"
        )
    if not (np.isfinite(rate_hz) and 0 < rate_hz <= FASTEST_HZ):
        raise SignkinError(
            f"a rate of {rate_hz:g} Hz", place="resample_hz", expected=f"up to {FASTEST_HZ:g} Hz"
        )
    usual = float(np.median(steps))
    count = (times_s[-1] - times_s[0]) * rate_hz
    if count > 1e8:
        raise SignkinError(
            f"{count:.3g} frames from {times_s[0]:g} to {times_s[-1]:g} s",
            place="resample_hz",
            expected="times in seconds",
        )
    even = times_s[0] + np.arange(int(np.floor(count + 1e-6)) + 1) / rate_hz
    flat = np.asarray(values, dtype=float).reshape(len(times_s), -1)
    out = np.full((len(even), flat.shape[1]), np.nan)
    there = np.isfinite(flat)
    patterns: dict[bytes, list[int]] = {}
    for column in range(flat.shape[1]):
        patterns.setdefault(there[:, column].tobytes(), []).append(column)
    for columns in patterns.values():
        known = np.flatnonzero(there[:, columns[0]])
        if len(known) < 2:
            continue
        at = times_s[known]
        left = np.clip(np.searchsorted(at, even, side="right") - 1, 0, len(at) - 2)
        eps = 1e-9 * usual
        inside = (even >= at[0] - eps) & (even <= at[-1] + eps)
        near = (at[left + 1] - at[left]) <= LONGEST_STEP * usual
        # In a gap of the column, samples that are there on both sides do not follow one another.
        whole = known[left + 1] - known[left] == 1
        on_sample = np.minimum(np.abs(even - at[left]), np.abs(even - at[left + 1])) <= eps
        use = inside & ((near & whole) | on_sample)
        curve = scipy.interpolate.PchipInterpolator(at, flat[known][:, columns])
        out[np.ix_(use, columns)] = curve(np.clip(even[use], at[0], at[-1]))
    return even, out.reshape(len(even), *np.shape(values)[1:])
