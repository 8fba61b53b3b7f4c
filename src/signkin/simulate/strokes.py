"""Strokes from rest to rest: the building block of simulated hands (Flash & Hogan 1985, eq. 7).

What a movement makes least decides its polynomial: acceleration order 3, jerk order 5, snap order
7, each at rest at both ends with all derivatives below the one that is least.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError

# Coefficients of tau^k, from k = 0 on, of the share that is done at the share tau of the time.
SHARES: dict[int, tuple[float, ...]] = {
    3: (0, 0, 3, -2),
    5: (0, 0, 0, 10, -15, 6),
    7: (0, 0, 0, 0, 35, -84, 70, -20),
}
JERK = 5


@dataclass(frozen=True, eq=False)
class Stroke:
    """A straight movement from rest to rest: when (s), how long (s), how far, (3,) in metres.

    order: of its polynomial, a key of `SHARES`.
    """

    onset_s: float
    duration_s: float
    displacement_m: NDArray[np.float64]
    order: int = JERK

    @property
    def offset_s(self) -> float:
        """End of the stroke, in seconds."""
        return self.onset_s + self.duration_s

    @property
    def length_m(self) -> float:
        """Length of the stroke, in metres."""
        return float(np.linalg.norm(self.displacement_m))


def share_done(tau: NDArray[np.float64], order: int = JERK) -> NDArray[np.float64]:
    """Return the share of a movement that is done at the share `tau` of its time.

    order: 3, 5 or 7 for least acceleration, jerk or snap. Raises SignkinError for another.
    """
    if order not in SHARES:
        raise SignkinError(
            f"no stroke is of order {order}", place="simulator", expected="3, 5 or 7"
        )
    tau = np.clip(tau, 0, 1)
    if order == JERK:
        return np.asarray(tau**3 * (10 - 15 * tau + 6 * tau**2))
    return np.asarray(np.polynomial.polynomial.polyval(tau, SHARES[order]))


def superposed(
    start_m: NDArray[np.float64], strokes: Sequence[Stroke], at_s: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the path (F, 3) from `start_m` on: the sum of all strokes, which may overlap.

    Where a stroke starts before the one before it has ended, the hand rounds the corner (Flash &
    Henis 1991).
    """
    path = np.tile(np.asarray(start_m, dtype=float), (len(at_s), 1))
    for stroke in strokes:
        done = share_done((at_s - stroke.onset_s) / stroke.duration_s, stroke.order)
        path += done[:, None] * stroke.displacement_m
    return path
