"""Segments that are left out because they are too long to be likely: a bound on what they add.

Without a longest segment the evidence of all segments fills T^2 numbers for each order, and nearly
all of them are of segments much longer than those the data have. Where those of up to W bins are
worked out, the rest is bounded. With one sample more, the residuals of a segment only grow, so a
segment of n > W bins from p has at most the log evidence

    constant(n) - half(n) ln|I + R|    (prior.Tables)

with the R of its first W bins. Where each segment pays a price, let F(q) be the sum over the ways
to come to bin q without long segments, and e(q) the most that ways with a long one as their last
add, as a share of it: then all ways come to at most F(T) times the product of 1 + e(q).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from signkin.binning import band
from signkin.binning.evidence import ROOM
from signkin.binning.prior import Tables

Floats = NDArray[np.float64]
Longer = Callable[[Floats, int, float], float]

BLOCK = 8  # neighbouring bins that are bounded together
MOST = 50.0  # of the log of a bound; more bounds nothing


def bound_on_longer(tables: Tables, bins: int) -> Longer:
    """Return a function of the evidence (T, W) of an order, the order, and a price of a segment.

    It returns a bound on the log of the sum over all segmentations over that without longer
    segments. tables: of segments of up to all bins.
    """

    def log_of_all(evidence: Floats, order: int, price: float) -> float:
        longest = evidence.shape[1]
        starts = bins - longest  # from which a segment can be longer
        if starts <= 0:
            return 0.0
        sums = np.empty(bins + 1)
        band.log_sums_by_best(evidence, price, ROOM.array("spare", *evidence.shape), sums)
        if not np.isfinite(sums).all():
            return MOST
        per_bin = sums[-1] / bins  # all segmentations have as many: so sums stay level
        n = np.arange(1, bins + 1)
        constant = tables.constant[:, order] - per_bin * n
        sums -= per_bin * np.arange(bins + 1)
        log_size = tables.constant[longest - 1, order] - evidence[:starts, longest - 1]
        log_size = np.maximum(log_size / tables.half[longest - 1], 0.0)
        high, size = _blocks(sums[:starts], np.maximum), _blocks(log_size, np.minimum)
        low = _blocks(sums, np.minimum)
        apart = np.arange(len(low))[None, :] - np.arange(len(high))[:, None]
        least = np.clip(BLOCK * np.arange(len(low)) - BLOCK + 1, longest + 1, bins)
        most = np.clip(BLOCK * np.arange(len(low)) + BLOCK - 1, longest + 1, bins)
        best = np.array([constant[a - 1 : b].max() for a, b in zip(least, most, strict=True)])
        half = tables.half[least - 1]
        at = np.maximum(apart, 0)
        height = (high - price)[:, None] + best[at] - half[at] * size[:, None] - low
        reaches = BLOCK * apart + BLOCK - 1 > longest
        added = np.where(reaches, np.exp(np.minimum(height, MOST)), 0.0).sum()
        return float(min(MOST, BLOCK**2 * added))

    return log_of_all


def _blocks(values: Floats, of_each: np.ufunc) -> Floats:
    return np.asarray(of_each.reduceat(values, np.arange(0, len(values), BLOCK)))
