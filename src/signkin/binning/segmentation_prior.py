"""The prior over segmentations (Endres et al. 2013, eq. 7 and 8): all of them counted."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from signkin.binning import segmentation

Floats = NDArray[np.float64]

NO_CANCELLATION = 0.01


def log_uniform(bins: int) -> float:
    """Return ln P(M) = -ln T (eq. 8)."""
    return -float(np.log(bins))


@lru_cache(maxsize=256)
def log_prior_of(bins: int, longest: int) -> Floats:
    """Return ln(P(M) P({q} | M)) for M = 0..T-1 (eq. 7, 8); -inf where no segmentation fits."""
    m = np.arange(bins)
    if longest >= bins:
        log_number = _log_gamma(bins) - _log_gamma(m + 1) - _log_gamma(bins - m)
    else:
        log_number = _log_compositions(bins, longest)
    return np.where(np.isfinite(log_number), log_uniform(bins) - log_number, -np.inf)


@lru_cache(maxsize=16)
def _log_compositions(bins: int, longest: int) -> Floats:
    """Return the log of the number of ways to cut T bins into M + 1 parts of at most W each.

    Inclusion and exclusion, sum over r of (-1)^r C(k, r) C(T - rW - 1, k - 1) for k parts, where
    its terms do not cancel, that is for many parts; for few parts a recursion that adds alone.
    """
    k = np.arange(1, bins + 1)[:, None]
    r = np.arange(-(-bins // longest))[None, :]
    left = bins - r * longest - 1
    fits = (left >= k - 1) & (r <= k)
    log_term = np.where(fits, _log_comb(k, r) + _log_comb(left, k - 1), -np.inf)
    largest = np.maximum(log_term.max(axis=1), 0.0)  # -inf where no cut fits
    total = np.sum(np.where(r % 2, -1.0, 1.0) * np.exp(log_term - largest[:, None]), axis=1)
    cancelled = np.flatnonzero(total < NO_CANCELLATION)
    first = int(cancelled[-1]) + 1 if len(cancelled) else 0
    out = np.empty(bins)
    out[:first] = segmentation.log_compositions(bins, longest, first)
    with np.errstate(divide="ignore"):
        out[first:] = largest[first:] + np.log(total[first:])
    return out


def _log_comb(n: NDArray[np.int64], k: NDArray[np.int64]) -> Floats:
    """Return ln C(n, k), of whatever value where k is not in 0..n."""
    inside = (k >= 0) & (k <= n)
    n, k = np.where(inside, n, 0), np.where(inside, k, 0)
    return np.asarray(_log_gamma(n + 1) - _log_gamma(k + 1) - _log_gamma(n - k + 1))


def _log_gamma(x: Floats | NDArray[np.int64] | int) -> Floats:
    from scipy.special import gammaln  # as long to import as half of numba, and not for reading

    return np.asarray(gammaln(x))
