"""Minimum-jerk strokes: the building block of simulated hands (Flash & Hogan 1985, eq. 7)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Stroke:
    """A straight movement from rest to rest: when (s), how long (s), how far, (3,) in metres."""

    onset_s: float
    duration_s: float
    displacement_m: NDArray[np.float64]

    @property
    def offset_s(self) -> float:
        """End of the stroke, in seconds."""
        return self.onset_s + self.duration_s

    @property
    def length_m(self) -> float:
        """Length of the stroke, in metres."""
        return float(np.linalg.norm(self.displacement_m))


def share_done(tau: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the share of a minimum-jerk movement that is done at the share `tau` of its time."""
    tau = np.clip(tau, 0, 1)
    return np.asarray(tau**3 * (10 - 15 * tau + 6 * tau**2))


def superposed(
    start_m: NDArray[np.float64], strokes: Sequence[Stroke], at_s: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the path (F, 3) from `start_m` on: the sum of all strokes, which may overlap.

    Where a stroke starts before the one before it has ended, the hand rounds the corner (Flash &
    Henis 1991).
    """
    path = np.tile(np.asarray(start_m, dtype=float), (len(at_s), 1))
    for stroke in strokes:
        done = share_done((at_s - stroke.onset_s) / stroke.duration_s)
        path += done[:, None] * stroke.displacement_m
    return path
