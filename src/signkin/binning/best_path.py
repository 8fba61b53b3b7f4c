"""Compiled: the best segmentation of eight orders when each segment pays a penalty.

Lanes are orders, arrays as in sum_product.py: the best path gives the sums their unit, and its
penalties say which numbers of segments a pass covers.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from signkin.binning.lanes import WIDTH, exp, larger, load, splat, store
from signkin.jit import kernel

F = NDArray[np.float64]
I = NDArray[np.int64]  # noqa: E741

CLOSE = 0.5  # to the limit where a best path gets one segment more: a penalty is near enough
FIRST_STEP = 4.0  # of a penalty that is looked for; the next ones double


@kernel
def best_paths(evidence: F, penalty: F, best: F, segments: I) -> None:
    """Fill best[p], the largest sum of (log evidence - penalty) over segmentations of bins p...

    penalty: (8,). segments: (8,), filled with the number of segments of the best segmentation of
    all T bins.
    """
    bins, longest, _ = evidence.shape
    price = load(penalty, (0,))
    store(best, (bins, 0), splat(0.0))
    for p in range(bins - 1, -1, -1):
        value = splat(-np.inf)
        for n in range(min(longest, bins - p)):
            value = larger(value, load(evidence, (p, n, 0)) + load(best, (p + 1 + n, 0)))
        store(best, (p, 0), value - price)
    for lane in range(WIDTH):
        segments[lane] = 0
        p = 0
        while p < bins:
            segments[lane] += 1
            for n in range(min(longest, bins - p)):
                value = (evidence[p, n, lane] + best[p + 1 + n, lane]) - penalty[lane]
                if value == best[p, lane]:
                    p += 1 + n
                    break


@kernel
def scaled_evidence(evidence: F, penalty: F, best: F, out: F) -> None:
    """Fill out[p, n - 1] with exp(evidence - penalty) in units of the best path: at most 1."""
    bins, longest, _ = evidence.shape
    price = load(penalty, (0,))
    for p in range(bins):
        base = load(best, (p, 0)) + price
        for n in range(min(longest, bins - p)):
            value = (load(evidence, (p, n, 0)) + load(best, (p + 1 + n, 0))) - base
            store(out, (p, n, 0), exp(value))


@kernel
def settle_penalties(evidence: F, most: int, penalty: F, best: F, segments: I) -> None:
    """Raise each penalty until its best path has at most `most` segments, and fill best."""
    best_paths(evidence, penalty, best, segments)
    goal, active = np.full((2, WIDTH), most)
    going = False
    for lane in range(WIDTH):
        active[lane] = segments[lane] > most
        going = going or active[lane]
    if going:
        move_penalties(evidence, goal, 1, active, penalty, best, segments)


@kernel
def move_penalties(
    evidence: F, goal: I, way: int, active: I, penalty: F, best: F, segments: I
) -> None:
    """Move the active penalties, up or down, until their best paths reach a number of segments.

    way: 1, up until it is at most the goal; -1, down until it is at least that. No further than
    that wants, but for CLOSE. Fills best, too.
    """
    reached, missed = np.full(WIDTH, np.nan), penalty.copy()
    step = FIRST_STEP
    for lane in range(WIDTH):
        if active[lane]:
            penalty[lane] += way * step
    for _ in range(100):
        best_paths(evidence, penalty, best, segments)
        settled = True
        for lane in range(WIDTH):
            if not active[lane]:
                continue
            if way * segments[lane] <= way * goal[lane]:
                reached[lane] = penalty[lane]
            else:
                missed[lane] = penalty[lane]
            if math.isnan(reached[lane]):
                penalty[lane] += way * step
                settled = False
            elif abs(reached[lane] - missed[lane]) >= CLOSE:
                penalty[lane] = 0.5 * (reached[lane] + missed[lane])
                settled = False
            elif penalty[lane] != reached[lane]:
                penalty[lane] = reached[lane]
                settled = False
        if settled:
            return
        step *= 2.0
