"""Speed from positions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.kinematics.given import numbers, rate


def velocity(positions: NDArray[np.float64], rate_hz: float) -> NDArray[np.float64]:
    """Return the velocity, (F, ..., 3), by central differences (one-sided at the ends).

    NaN in and beside gaps: a difference over a gap is no velocity.
    """
    positions = numbers(positions, "positions", "(frames, ..., 3)", axes=1, least=2)
    v = np.gradient(positions, 1.0 / rate(rate_hz), axis=0)
    v[np.isnan(positions)] = np.nan  # a central difference skips its own frame
    return np.asarray(v)


def speed(positions: NDArray[np.float64], rate_hz: float) -> NDArray[np.float64]:
    """Return the norm of the velocity: (F, ..., 3) -> (F, ...), units a second."""
    return np.asarray(np.linalg.norm(velocity(positions, rate_hz), axis=-1))
