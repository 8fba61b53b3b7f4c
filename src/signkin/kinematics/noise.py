"""How noisy a recording is: the standard deviation of its device's noise, measured from motion.

Third differences leave nothing of motion that is smooth from frame to frame; of white noise of
variance s2 they have the variance 20 s2 (1 + 9 + 9 + 1). Taken robustly (1.4826 times the median
absolute value), so that jumps and fast strokes do not count.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.joints import wrists_of
from signkin.masked import unmasked
from signkin.recording import Recording

ROBUST = 1.4826  # standard deviation of a normal distribution by its median absolute deviation
THIRD_DIFFERENCES = 20.0
LEAST_DIFFERENCES = 30


@dataclass(frozen=True)
class Noise:
    """Measured noise.

    axes: standard deviation along right, forward and up, in the recording's unit; sd: their root
    mean square over the axes that have any. correlation: of successive third differences; white
    noise has -0.75, what the device has smoothed is nearer to 0 or above it.
    """

    axes: tuple[float, float, float]
    sd: float
    correlation: float


def measure_noise(recording: Recording, joints: Sequence[str] | None = None) -> Noise:
    """Return the noise of joints of a recording, the median over them; else that of its wrists.

    Raises SignkinError where there are fewer than 30 third differences, or most of them are 0
    (positions held for several frames, or simulated without noise).
    """
    chosen = wrists_of(recording.joints) if joints is None else joints
    found = [axis_noise(recording.track(joint)) for joint in chosen]
    axes = np.median([sd for sd, _ in found], axis=0)
    there = axes[axes > 0]
    if not there.size:
        raise SignkinError(
            "more than half of the third differences are 0",
            file=f"recording {recording.name}",
            place="noise_sd",
            expected="positions that change from frame to frame",
            todo="Declare noise_sd from the device's description.",
        )
    sd = float(np.sqrt(np.mean(there**2)))
    correlation = float(np.median([c for _, c in found]))
    return Noise((float(axes[0]), float(axes[1]), float(axes[2])), sd, correlation)


def axis_noise(track: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return the noise of a track (F, 3), NaN in gaps, by axis (3,), and the correlation."""
    third = np.diff(unmasked(track), n=3, axis=0)
    there = np.asarray(np.isfinite(third).all(axis=1))
    if there.sum() < LEAST_DIFFERENCES:
        raise SignkinError(
            f"{int(there.sum())} stretches of four frames without a gap",
            place="noise_sd",
            expected=f"{LEAST_DIFFERENCES} or more to measure noise by",
        )
    sd = ROBUST * np.median(np.abs(third[there]), axis=0) / np.sqrt(THIRD_DIFFERENCES)
    both = there[1:] & there[:-1]
    first, second = third[:-1][both].ravel(), third[1:][both].ravel()
    # Only what lies within three deviations: single jumps would make the correlation.
    scale = np.tile(3 * np.sqrt(THIRD_DIFFERENCES) * sd, int(both.sum()))
    near = (np.abs(first) <= scale) & (np.abs(second) <= scale)
    power = float(np.sqrt((first[near] ** 2).sum() * (second[near] ** 2).sum()))
    correlation = float((first[near] * second[near]).sum() / power) if power > 0 else float("nan")
    return np.asarray(sd), correlation
