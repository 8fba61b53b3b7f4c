"""A cost for ruptures: residual sum of squares of a cubic, over the noise variance.

ruptures has no polynomial cost. Two of ours, both far faster than a least-squares fit a
segment, so that what is timed is the search: one in numpy at a constant price a segment, one
compiled. They agree to 1e-6 of the noise variance (checked before anything is timed).
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray
from ruptures.base import BaseCost

F = NDArray[np.float64]
BINOMIAL = np.array([[1, 0, 0, 0], [1, 1, 0, 0], [1, 2, 1, 0], [1, 3, 3, 1]], dtype=float)


class MomentsCost(BaseCost):
    """By prefix sums of moments: each segment costs the same, whatever its length.

    Loses digits with the fourth power of T: for short series (up to about 300 bins).
    """

    model = "cubic"
    min_size = 5

    def __init__(self, noise_sd: float) -> None:
        self.variance = noise_sd**2

    def fit(self, signal: F) -> MomentsCost:
        """Sum up moments about 0, and prepare what depends on lengths and middles alone."""
        self.signal = signal
        bins, dims = signal.shape
        time = (2 * np.arange(bins) + 1 - bins) / bins
        powers = time[:, None] ** np.arange(4)
        moments = (powers[:, :, None] * signal[:, None, :]).cumsum(0)
        self.moments = np.concatenate([np.zeros((1, 4, dims)), moments])
        self.squares = np.concatenate([[0.0], (signal**2).sum(1).cumsum()]).tolist()
        middle = (np.arange(2 * bins + 1) - bins) / bins
        lag = np.arange(4)[:, None] - np.arange(4)
        self.shift = BINOMIAL * np.where(
            lag >= 0, (-middle[:, None, None]) ** np.maximum(lag, 0), 0.0
        )
        self.root = np.zeros((bins + 1, 4, 4))
        for n in range(self.min_size, bins + 1):
            local = (2 * np.arange(n) + 1 - n) / bins
            basis = local[:, None] ** np.arange(4)
            triangle = np.linalg.qr(basis, mode="r")
            self.root[n] = np.linalg.inv(triangle).T
        return self

    def error(self, start: int, end: int) -> float:
        """Return the cost of the segment [start, end)."""
        moments = self.shift[start + end] @ (self.moments[end] - self.moments[start])
        fitted = (self.root[end - start] @ moments).ravel()
        return (self.squares[end] - self.squares[start] - fitted.dot(fitted)) / self.variance


class CompiledCost(BaseCost):
    """By one pass over the segment, compiled: for series of any length."""

    model = "cubic"
    min_size = 5

    def __init__(self, noise_sd: float) -> None:
        self.variance = noise_sd**2

    def fit(self, signal: F) -> CompiledCost:
        """Keep the signal, dimensions first."""
        self.signal = signal
        self.rows = np.ascontiguousarray(signal.T)
        return self

    def error(self, start: int, end: int) -> float:
        """Return the cost of the segment [start, end)."""
        return _residual(self.rows, start, end) / self.variance


@njit(cache=True, fastmath=True)
def _residual(rows: F, start: int, end: int) -> float:
    """Return the residual sum of squares; about the middle, even and odd powers are apart."""
    n = end - start
    h = 2.0 / n
    u2 = (n * n - 1.0) / (3.0 * n)  # closed sums of u^2, u^4, u^6 for u = (2k + 1 - n)/n
    u4 = (n * n - 1.0) * (3.0 * n * n - 7.0) / (15.0 * n**3)
    u6 = (n * n - 1.0) * (3.0 * n**4 - 18.0 * n * n + 31.0) / (21.0 * n**5)
    total = 0.0
    for row in rows:
        base = row[start]
        m0 = m1 = m2 = m3 = ss = 0.0
        for k in range(n):
            u = (k + 0.5) * h - 1.0
            v = row[start + k] - base
            m0 += v
            m1 += v * u
            m2 += v * u * u
            m3 += v * u * u * u
            ss += v * v
        even = m2 - u2 / n * m0
        odd = m3 - u4 / u2 * m1
        total += ss - m0 * m0 / n - even * even / (u4 - u2 * u2 / n)
        total -= m1 * m1 / u2 + odd * odd / (u6 - u4 * u4 / u2)
    return total


def check(x: F, noise_sd: float) -> float:
    """Return the largest difference of both costs from least squares, in noise variances."""
    worst = 0.0
    bins = len(x)
    costs = [MomentsCost(noise_sd).fit(x), CompiledCost(noise_sd).fit(x)]
    for start, end in ((0, bins), (3, 8), (10, 22), (bins // 3, bins // 2), (bins - 6, bins)):
        basis = np.linspace(-1, 1, end - start)[:, None] ** np.arange(4)
        residual = np.linalg.lstsq(basis, x[start:end], rcond=None)
        fitted = basis @ residual[0]
        exact = ((x[start:end] - fitted) ** 2).sum() / noise_sd**2
        worst = max(worst, *(abs(cost.error(start, end) - exact) for cost in costs))
    return worst
