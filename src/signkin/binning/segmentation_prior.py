"""The prior over segmentations (Endres et al. 2013, eq. 7 and 8): all of them counted."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from signkin.binning import segmentation

Floats = NDArray[np.float64]

NO_CANCELLATION = 0.01
MOST_TERMS = 1 << 19  # worked out at once
MOST_TILT = 30.0  # exponent a bin: parts of one bin each, or of the longest
GRID = np.linspace(-1, 1, 1001)
NEWTON_STEPS = 8


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


def log_cuts(bins: int, longest: int, parts: Floats) -> tuple[Floats, Floats]:
    """Return the log of the number of ways to cut T bins into `parts` of at most W each, and slope.

    parts: (K,), between T / W and T. Of the saddle point, with the term after the first: wrong by
    about one over the square of the number of parts, where `log_prior_of` is exact but wants room
    for T^2 / W terms. The slope is the derivative by the number of parts, to the first term.
    """
    lengths = np.arange(1.0, longest + 1)
    grid = GRID * np.abs(GRID) * MOST_TILT
    tilt = np.interp(-bins / parts, -_length_moments(grid, lengths)[1], grid)
    for _ in range(NEWTON_STEPS):
        _, mean, variance, _, _ = _length_moments(tilt, lengths)
        tilt = tilt + np.clip((mean - bins / parts) / variance, -1.0, 1.0)
    log_all, _, variance, third, fourth = _length_moments(tilt, lengths)
    after = (fourth / variance**2 / 8 - 5 * third**2 / variance**3 / 24) / parts
    local = after - 0.5 * np.log(2 * np.pi * parts * variance)
    return parts * log_all + tilt * bins + local, log_all


def _length_moments(tilt: Floats, lengths: Floats) -> tuple[Floats, ...]:
    """Return the log of the sum of exp(-tilt n), and the mean and cumulants 2 to 4 of n, each (K,).

    In parts, so that no more than some megabytes are wanted.
    """
    out = np.empty((5, len(tilt)))
    step = max(1, MOST_TERMS // len(lengths))
    for first in range(0, len(tilt), step):
        power = -tilt[first : first + step, None] * lengths
        top = power.max(axis=1)
        weight = np.exp(power - top[:, None])
        all_ = weight.sum(axis=1)
        weight /= all_[:, None]
        mean = weight @ lengths
        off = lengths - mean[:, None]
        second, third, fourth = ((weight * off**n).sum(axis=1) for n in (2, 3, 4))
        out[:, first : first + step] = (
            top + np.log(all_), mean, second, third, fourth - 3 * second**2
        )  # fmt: skip
    return tuple(out)


@lru_cache(maxsize=16)
def _log_compositions(bins: int, longest: int) -> Floats:
    """Return the log of the number of ways to cut T bins into M + 1 parts of at most W each.

    Inclusion and exclusion, sum over r of (-1)^r C(k, r) C(T - rW - 1, k - 1) for k parts, where
    its terms do not cancel, that is for many parts; for few parts a recursion that adds alone. Of
    long series that has too few digits for the fewest parts: there W + 1 less each part are parts
    again, and few of them are long.
    """
    parts = np.arange(1, bins + 1)
    out, total = _included(np.full(bins, bins), parts, longest)
    cancelled = np.flatnonzero(total < NO_CANCELLATION)
    first = int(cancelled[-1]) + 1 if len(cancelled) else 0
    out[:first] = segmentation.log_compositions(bins, longest, first)
    lost = parts[:first][np.isneginf(out[:first]) & (parts[:first] * longest >= bins)]
    out[lost - 1] = _included(lost * (longest + 1) - bins, lost, longest)[0]
    return out


def _included(
    bins: NDArray[np.int64], parts: NDArray[np.int64], longest: int
) -> tuple[Floats, Floats]:
    """Return ln of the sum of inclusion and exclusion, and the sum over its largest term, (K,).

    For so many bins cut into so many parts each; some numbers of parts at a time, to save room.
    """
    out, totals = np.empty((2, len(parts)))
    terms = -(-int(bins.max(initial=1)) // longest)
    step = max(1, MOST_TERMS // terms)
    for first in range(0, len(parts), step):
        own = slice(first, first + step)
        k = parts[own, None]
        r = np.arange(terms)[None, :]
        left = bins[own, None] - r * longest - 1
        fits = (left >= k - 1) & (r <= k)
        log_term = np.where(fits, _log_comb(k, r) + _log_comb(left, k - 1), -np.inf)
        largest = np.maximum(log_term.max(axis=1), 0.0)  # -inf where no cut fits
        total = np.sum(np.where(r % 2, -1.0, 1.0) * np.exp(log_term - largest[:, None]), axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            out[own] = largest + np.log(total)
        totals[own] = total
    return out, totals


def _log_comb(n: NDArray[np.int64], k: NDArray[np.int64]) -> Floats:
    """Return ln C(n, k), of whatever value where k is not in 0..n."""
    inside = (k >= 0) & (k <= n)
    n, k = np.where(inside, n, 0), np.where(inside, k, 0)
    return np.asarray(_log_gamma(n + 1) - _log_gamma(k + 1) - _log_gamma(n - k + 1))


def _log_gamma(x: Floats | NDArray[np.int64] | int) -> Floats:
    from scipy.special import gammaln  # as long to import as half of numba, and not for reading

    return np.asarray(gammaln(x))
