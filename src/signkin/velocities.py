"""Velocities made into positions, where a corpus asks for it: an integral drifts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from signkin.errors import SignkinError


def integrate(velocities: NDArray[np.float64], rate_hz: float) -> NDArray[np.float64]:
    """Return positions (F, ...) in unit of velocities (F, ...) in unit/s, by the trapezoid rule.

    Positions start at 0. Behind a gap (NaN) nothing is known of where a point is: all that follows
    is a gap. An error of the velocities adds up; high-pass or compare over short times only.
    """
    if not (np.isfinite(rate_hz) and rate_hz > 0):
        raise SignkinError(f"a rate of {rate_hz:g} Hz", place="rate", expected="a rate above 0 Hz")
    return np.asarray(cumulative_trapezoid(velocities, dx=1.0 / rate_hz, axis=0, initial=0.0))
