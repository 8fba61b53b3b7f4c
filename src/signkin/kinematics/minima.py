"""Local minima of speed (Naert et al. 2017, section 4.1)."""

from __future__ import annotations

import numpy as np
import scipy  # loads scipy.signal when it is used: it takes as long to import as numba
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.kinematics.gaps import stretches
from signkin.kinematics.given import numbers, rate


def speed_minima(
    speed: NDArray[np.float64], rate_hz: float, prominence: float = 0.0, spacing_s: float = 0.0
) -> NDArray[np.float64]:
    """Return the times of the local minima in seconds, in order.

    speed: (F,), low-passed; NaN in gaps, next to which no minimum is found.
    prominence: how far a minimum must lie below the lower of the two ridges beside it, in
    the speed's unit. spacing_s: of two closer than this, the deeper one is kept.
    A flat minimum counts once, in its middle. The first and last frame are no minima.
    """
    return minima_with_depth(speed, rate_hz, prominence, spacing_s)[0]


def minima_with_depth(
    speed: NDArray[np.float64], rate_hz: float, prominence: float = 0.0, spacing_s: float = 0.0
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return times (s), speeds and prominences of the local minima, in order of time."""
    speed = numbers(speed, "speed", "(frames,)", axes=1, least=0)
    rate_hz = rate(rate_hz)
    if speed.ndim != 1:
        raise SignkinError(
            f"an array of shape {speed.shape}", place="speed", expected="shape (frames,)"
        )
    frames, depths = [], []
    distance = max(1, int(np.ceil(spacing_s * rate_hz - 1e-9)))
    for first, end in stretches(~np.isnan(speed)):
        peaks, properties = scipy.signal.find_peaks(
            -speed[first:end], prominence=max(prominence, 0.0), distance=distance
        )
        frames.append(first + peaks)
        depths.append(properties["prominences"])
    if not frames:
        return np.empty(0), np.empty(0), np.empty(0)
    at = np.concatenate(frames)
    return at / rate_hz, speed[at], np.concatenate(depths)
