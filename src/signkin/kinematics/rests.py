"""Where a hand rests between two strokes, from the positions about a minimum of speed.

A low-pass moves a minimum of speed to the slower of the two strokes beside it. The positions, as
they were recorded, tell where it was: each stroke leaves the instant of rest without velocity and
acceleration, as the strokes of least jerk do (Flash & Hogan 1985).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.kinematics.given import numbers, rate

Floats = NDArray[np.float64]
REACH_S = 0.045  # a rest is at most this far from its minimum
STEP_S = 0.0025
WINDOW_S = 0.12  # of the positions that tell, either side
POWERS = (3, 4)  # of the time from the rest, which positions are made of, on either side


def rest_times(
    positions: Floats, rate_hz: float, minima_s: Floats, window_s: float = WINDOW_S
) -> tuple[Floats, Floats]:
    """Return where the hand rests near each minimum of its speed, and the SD of that, s, (M,) each.

    positions: (F, D), not low-passed, any unit; NaN in gaps. minima_s: (M,). About each minimum
    positions are a constant and, on either side of the rest, a cubic and a quartic of the time
    from it, with white noise of unknown SD (Jeffreys' prior, all coefficients flat); so is the
    instant of rest, up to REACH_S from the minimum. Where residuals run with those of the next
    frame, as in smoothed positions, frames count for less. With too few frames about it a minimum
    tells nothing: it stays where it is, with the SD of a flat distribution.
    """
    x = numbers(positions, "positions", "(frames, axes)", axes=2, least=0)
    rate_hz = rate(rate_hz)
    times = np.array(minima_s, dtype=float)
    sd = np.full(len(times), REACH_S / np.sqrt(3))
    there = np.asarray(~np.isnan(x).any(axis=1))
    x = x[:, np.ptp(x[there], axis=0) > 0] if there.any() else x[:, :0]  # a flat axis tells nothing
    steps = round(REACH_S / STEP_S)
    shifts = np.asarray(STEP_S * np.arange(-steps, steps + 1), dtype=np.float64)
    fits = _Fits(shifts, rate_hz, max(round(window_s * rate_hz), 1))
    found = [fits.about(x, there, frame) for frame in np.rint(times * rate_hz).astype(int).tolist()]
    share = fits.share
    for k, one in enumerate(found):
        if one is None:
            continue
        squares, free = one
        chance = np.exp(-0.5 * share * free * np.log(squares / squares.min()))
        chance /= chance.sum()
        mean = chance @ shifts
        times[k] += mean
        sd[k] = np.sqrt(chance @ (shifts - mean) ** 2 + STEP_S**2 / 12)
    return times, sd


class _Fits:
    """Fits about minima, and how far the residuals of all of them run with those beside them."""

    def __init__(self, shifts: Floats, rate_hz: float, half: int) -> None:
        self.shifts, self.rate_hz, self.half = shifts, rate_hz, half
        self.known: dict[bytes, list[Floats]] = {}  # orthonormal columns a shift, by frames there
        self.beside = self.alone = 0.0

    @property
    def share(self) -> float:
        """How much a frame counts among frames whose noise is an autoregression of order 1."""
        r = min(max(self.beside / self.alone, 0.0), 0.95) if self.alone else 0.0
        return (1 - r) / (1 + r)

    def about(self, x: Floats, there: NDArray[np.bool_], at: int) -> tuple[Floats, int] | None:
        """Return the sum of squares that each shift leaves, and degrees of freedom."""
        near = np.arange(at - self.half, at + self.half + 1)
        use = (near >= 0) & (near < len(x))
        use[use] = there[near[use]]
        least = 2 * len(POWERS)
        if not x.shape[1] or min(use[: self.half].sum(), use[self.half + 1 :].sum()) < least:
            return None
        columns = self._columns(use)
        y = x[near[use]] - x[near[use]].mean(axis=0)
        whole = float((y**2).sum())
        squares = np.array([whole - ((q.T @ y) ** 2).sum() for q in columns])
        best = columns[int(squares.argmin())]
        left = y - best @ (best.T @ y)
        self.beside += float((left[1:] * left[:-1]).sum())
        self.alone += float((left**2).sum())
        # Rounding alone is left where positions are exact.
        return np.maximum(squares, max(1e-12 * whole, 1e-300)), x.shape[1] * (len(y) - 1 - least)

    def _columns(self, use: NDArray[np.bool_]) -> list[Floats]:
        """Return orthonormal columns (F, C) that span the positions about a rest at each shift."""
        key = use.tobytes()
        if key not in self.known:
            times = (np.flatnonzero(use) - self.half) / self.rate_hz
            self.known[key] = [_spanning(times - shift) for shift in self.shifts]
        return self.known[key]


def _spanning(away: Floats) -> Floats:
    sides = [np.maximum(side * away, 0.0) ** p for p in POWERS for side in (-1, 1)]
    columns = np.column_stack([np.ones_like(away), *sides])
    columns /= np.maximum(np.abs(columns).max(axis=0), 1e-300)
    u, s, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(u[:, s > 1e-9 * s[0]])
