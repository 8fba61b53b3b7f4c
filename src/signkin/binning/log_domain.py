"""Compiled: sums over all segmentations in the log domain, for eight orders at once.

Slow, and without limits: for what the passes of sum_product.py lose to underflow. Lanes are
orders, arrays as there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.binning.lanes import (
    WIDTH,
    aligned,
    any_above,
    exp,
    larger,
    load,
    log,
    splat,
    store,
    where_above,
)
from signkin.jit import kernel

F = NDArray[np.float64]

NEGLIGIBLE = 1e-20  # probability, or weight in units of the best path, that is passed over
FAR_BELOW = -45.0  # log of a share of a sum that is not felt


@kernel
def log_ways(evidence: F, most: int, table: F) -> None:
    """Fill table[p, k] with the log of the sum over ways to cut bins p.. into k segments.

    For k = 0..most. evidence: (T, W, 8). table: (T + 1, most + 4, 8).
    """
    bins, longest, _ = evidence.shape
    least, tiny = splat(FAR_BELOW), splat(1e-300)
    none = splat(-np.inf)
    table[:] = -np.inf
    store(table, (bins, 0, 0), splat(0.0))
    for p in range(bins - 1, -1, -1):
        length = min(longest, bins - p)
        for k in range(1, min(most, bins - p) + 1, 2):
            # Two numbers at a time: the best way first, then all in its units.
            top0, top1 = none, none
            for n in range(length):
                value = load(evidence, (p, n, 0))
                top0 = larger(top0, value + load(table, (p + 1 + n, k - 1, 0)))
                top1 = larger(top1, value + load(table, (p + 1 + n, k, 0)))
            sum0, sum1 = splat(0.0), splat(0.0)
            for n in range(length):
                value = load(evidence, (p, n, 0))
                below0 = (value + load(table, (p + 1 + n, k - 1, 0))) - top0
                below1 = (value + load(table, (p + 1 + n, k, 0))) - top1
                if any_above(below0, least):
                    sum0 = sum0 + exp(below0)
                if any_above(below1, least):
                    sum1 = sum1 + exp(below1)
            # Where there is no way the sum is 0, or not a number.
            log0, log1 = top0 + log(larger(sum0, tiny)), top1 + log(larger(sum1, tiny))
            store(table, (p, k, 0), where_above(sum0, tiny, log0, none))
            store(table, (p, k + 1, 0), where_above(sum1, tiny, log1, none))
        for k in range(most + 1, table.shape[1]):
            store(table, (p, k, 0), none)


@kernel
def log_posterior(evidence: F, mass: F, boundary: F, segments: F) -> None:
    """Add to boundary and segments what the counts with some `mass` say, in the log domain.

    For counts whose sums the linear domain loses beside those of others: a posterior with two
    peaks far apart. mass: (C, 8) of P(M | D). boundary: (T, 8). segments: (T, W, 8). From each
    bin on, a segment's probability given the number of segments to go is the ratio of two sums.
    """
    bins, longest, _ = evidence.shape
    zero, negligible, least = splat(0.0), splat(NEGLIGIBLE), splat(FAR_BELOW)
    most = 0
    for m in range(len(mass)):
        if any_above(load(mass, (m, 0)), zero):
            most = m + 1
    table = aligned((bins + 1) * (most + 4) * WIDTH).reshape((bins + 1, most + 4, WIDTH))
    log_ways(evidence, most, table)
    # here[p, k]: the probability of a boundary before p with k segments to go.
    here = aligned((bins + 1) * (most + 1) * WIDTH).reshape((bins + 1, most + 1, WIDTH))
    here[:] = 0.0
    for m in range(most):
        store(here, (0, m + 1, 0), load(mass, (m, 0)))
    for p in range(bins):
        for k in range(1, min(most, bins - p) + 1):
            share = load(here, (p, k, 0))
            if not any_above(share, negligible):
                continue
            if p > 0:
                store(boundary, (p - 1, 0), load(boundary, (p - 1, 0)) + share)
            ways = load(table, (p, k, 0))
            for n in range(min(longest, bins - p)):
                part = load(evidence, (p, n, 0)) + load(table, (p + 1 + n, k - 1, 0))
                if not any_above(part - ways, least):
                    continue
                # No way is -inf beside a sum, not a number beside none: 0 of it both times.
                part = share * exp(part - ways)
                store(segments, (p, n, 0), load(segments, (p, n, 0)) + part)
                ahead = (p + 1 + n, k - 1, 0)
                store(here, ahead, load(here, ahead) + part)
