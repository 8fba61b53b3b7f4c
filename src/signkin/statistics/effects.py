"""Effect sizes with intervals: shares of variance and Cohen's d.

The intervals invert the noncentral F and t distributions (statsmodels).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from statsmodels.stats.effect_size import _noncentrality_t
from statsmodels.stats.oneway import confint_noncentrality

Array = NDArray[np.float64]


def share_interval(f: float, df1: float, df2: float, n: int, alpha: float) -> tuple[float, float]:
    """Return the interval of the share of variance in the population, nc / (nc + n).

    Eta and omega squared both estimate this share (eta squared too high), so it serves both.
    """
    low, high = np.maximum(np.nan_to_num(confint_noncentrality(f, (df1, df2), alpha=alpha)), 0.0)
    return float(low / (low + n)), float(high / (high + n))


def eta_squared(f: float, df1: float, df2: float) -> float:
    """Return (partial) eta squared from F."""
    return df1 * f / (df1 * f + df2)


def omega_squared(f: float, df1: float, n: int) -> float:
    """Return (partial) omega squared from F; it may be below 0, where F is below 1."""
    return df1 * (f - 1) / (df1 * (f - 1) + n)


def pooled_sd(*groups: Array) -> float:
    """Return the SD within groups, pooled over those with two values or more."""
    squares = sum(float(((g - g.mean()) ** 2).sum()) for g in groups if len(g))
    freedom = sum(len(g) - 1 for g in groups if len(g))
    return float(np.sqrt(squares / freedom)) if freedom > 0 else float("nan")


def cohens_d(a: Array, b: Array, alpha: float) -> tuple[float, float, float]:
    """Return Cohen's d of a against b (pooled SD) and its interval; NaN where nothing varies."""
    sd = pooled_sd(a, b)
    if not sd > 0 or len(a) + len(b) < 3:
        return float("nan"), float("nan"), float("nan")
    d = float(a.mean() - b.mean()) / sd
    root = np.sqrt(len(a) * len(b) / (len(a) + len(b)))
    low, high = _noncentrality_t(d * root, len(a) + len(b) - 2, alpha=alpha).confint
    return d, float(low / root), float(high / root)
