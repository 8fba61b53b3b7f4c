"""Compiled: sums over all segmentations, for eight polynomial orders at once.

Lanes are orders. Sums are kept in units of a best path whose segments each pay a penalty
(best_path.py), so that no factor exceeds 1; what a pass loses to underflow is worked out by
passes with other penalties, or in the log domain (log_domain.py): counts.py puts them together.
The mathematics is told in posterior.py.

Arrays end with the lanes: evidence (T, W, 8) of the segment of n bins from p at [p, n - 1],
best (T + 1, 8), ways (T + 1, K, 8) with K of `columns_for`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.binning.lanes import any_above, larger, load, splat, store, where_above
from signkin.jit import helper, inlined, kernel

F = NDArray[np.float64]

SLOW = 1e-250  # sums below are put to 0: numbers next to the smallest are slow
TOGETHER = 4  # numbers of segments that are summed together


@helper
def columns_for(most: int) -> int:
    """Return the columns that sums over 0 to `most` segments want, with some room."""
    return most + 2 + TOGETHER


@inlined
def _fast(value: Any) -> Any:
    return where_above(value, splat(SLOW), value, splat(0.0))


@kernel
def ways_on(weight: F, most: int, ways: F) -> None:
    """Fill ways[p, k] with the sum over ways to cut bins p.. into k segments, up to `most`.

    weight: (T, W, 8) scaled evidence. Two bins and four numbers of segments at a time: what is
    loaded is used more than once.
    """
    bins, longest, _ = weight.shape
    zero = splat(0.0)
    ways[:] = 0.0
    store(ways, (bins, 0, 0), splat(1.0))
    for r in range(bins - 1, -1, -2):
        p = r - 1  # -1: r alone
        v_shift = r + 1
        for k in range(1, min(most, bins - p) + 1, TOGETHER):
            a0, a1, a2, a3 = zero, zero, zero, zero
            b0, b1, b2, b3 = zero, zero, zero, zero
            last = bins - k + 1  # behind it there are too few bins
            for q in range(r + 1, min(last, r + longest) + 1):
                v = load(weight, (r, q - v_shift, 0))
                w = zero
                if p >= 0 and q - r < longest:
                    w = load(weight, (p, q - r, 0))
                ahead = load(ways, (q, k - 1, 0))
                a0, b0 = a0 + v * ahead, b0 + w * ahead
                ahead = load(ways, (q, k, 0))
                a1, b1 = a1 + v * ahead, b1 + w * ahead
                ahead = load(ways, (q, k + 1, 0))
                a2, b2 = a2 + v * ahead, b2 + w * ahead
                ahead = load(ways, (q, k + 2, 0))
                a3, b3 = a3 + v * ahead, b3 + w * ahead
            store(ways, (r, k, 0), _fast(a0))
            store(ways, (r, k + 1, 0), _fast(a1))
            store(ways, (r, k + 2, 0), _fast(a2))
            store(ways, (r, k + 3, 0), _fast(a3))
            if p >= 0:
                w = load(weight, (p, 0, 0))
                store(ways, (p, k, 0), _fast(b0 + w * load(ways, (r, k - 1, 0))))
                store(ways, (p, k + 1, 0), _fast(b1 + w * load(ways, (r, k, 0))))
                store(ways, (p, k + 2, 0), _fast(b2 + w * load(ways, (r, k + 1, 0))))
                store(ways, (p, k + 3, 0), _fast(b3 + w * load(ways, (r, k + 2, 0))))
        for k in range(most + 1, columns_for(most)):
            store(ways, (r, k, 0), zero)  # more segments than asked for
            if p >= 0:
                store(ways, (p, k, 0), zero)


@kernel
def ways_from(weight: F, most: int, before: F) -> None:
    """Fill before[q, k] with the sum over ways to come to bin q with k segments to go.

    before[0] is given, 0 above `most` segments; it weighs each number of them. Like `ways_on`,
    from the other end.
    """
    bins, longest, _ = weight.shape
    zero = splat(0.0)
    before[1:] = 0.0
    for q in range(1, bins + 1, 2):
        s = q + 1  # T + 1: q alone
        first = max(0, q - longest)
        k = (min(most - 1, bins - q) - 1) // TOGETHER * TOGETHER + 1
        while k >= 1:
            a0, a1, a2, a3 = zero, zero, zero, zero
            b0, b1, b2, b3 = zero, zero, zero, zero
            for p in range(first, q):
                v = load(weight, (p, q - p - 1, 0))
                w = zero
                if s <= bins and q - p < longest:
                    w = load(weight, (p, q - p, 0))
                behind = load(before, (p, k + 1, 0))
                a0, b0 = a0 + v * behind, b0 + w * behind
                behind = load(before, (p, k + 2, 0))
                a1, b1 = a1 + v * behind, b1 + w * behind
                behind = load(before, (p, k + 3, 0))
                a2, b2 = a2 + v * behind, b2 + w * behind
                behind = load(before, (p, k + 4, 0))
                a3, b3 = a3 + v * behind, b3 + w * behind
            store(before, (q, k, 0), _fast(a0))
            store(before, (q, k + 1, 0), _fast(a1))
            store(before, (q, k + 2, 0), _fast(a2))
            store(before, (q, k + 3, 0), _fast(a3))
            if s <= bins:
                w = load(weight, (q, 0, 0))
                store(before, (s, k, 0), _fast(b0 + w * load(before, (q, k + 1, 0))))
                store(before, (s, k + 1, 0), _fast(b1 + w * load(before, (q, k + 2, 0))))
                store(before, (s, k + 2, 0), _fast(b2 + w * load(before, (q, k + 3, 0))))
                store(before, (s, k + 3, 0), _fast(b3 + w * load(before, (q, k + 4, 0))))
            k -= TOGETHER


@kernel
def segment_probabilities(weight: F, ways: F, before: F, most: int, negligible: F) -> None:
    """Turn weight[p, n - 1] into the probability of the segment of n bins from p.

    negligible: (8,) weights up to which it is taken for 0.
    """
    bins, longest, _ = weight.shape
    zero = splat(0.0)
    least = load(negligible, (0,))
    for p in range(bins):
        low, high = most + 1, 0  # the numbers of segments with which anything arrives
        for k in range(1, min(most, bins - p) + 1):
            if any_above(load(before, (p, k, 0)), zero):
                low = min(low, k)
                high = k
        length = min(longest, bins - p)
        for n in range(0, length, TOGETHER):
            here = min(TOGETHER, length - n)
            w0 = load(weight, (p, n, 0))
            w1 = load(weight, (p, n + 1, 0)) if here > 1 else zero
            w2 = load(weight, (p, n + 2, 0)) if here > 2 else zero
            w3 = load(weight, (p, n + 3, 0)) if here > 3 else zero
            s0, s1, s2, s3 = zero, zero, zero, zero
            if any_above(larger(larger(w0, w1), larger(w2, w3)), least):
                q0 = p + 1 + n
                q1, q2, q3 = min(q0 + 1, bins), min(q0 + 2, bins), min(q0 + 3, bins)
                for k in range(low, high + 1):
                    behind = load(before, (p, k, 0))
                    s0 = s0 + behind * load(ways, (q0, k - 1, 0))
                    s1 = s1 + behind * load(ways, (q1, k - 1, 0))
                    s2 = s2 + behind * load(ways, (q2, k - 1, 0))
                    s3 = s3 + behind * load(ways, (q3, k - 1, 0))
            store(weight, (p, n, 0), w0 * s0)
            if here > 1:
                store(weight, (p, n + 1, 0), w1 * s1)
            if here > 2:
                store(weight, (p, n + 2, 0), w2 * s2)
            if here > 3:
                store(weight, (p, n + 3, 0), w3 * s3)
