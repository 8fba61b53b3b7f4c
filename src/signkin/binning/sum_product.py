"""Compiled: sums over all segmentations, for eight polynomial orders at once.

Lanes are orders. Sums are kept in units of a best path whose segments each pay a penalty, so
that no factor exceeds 1; what a pass loses to underflow is worked out by passes with other
penalties, or in the log domain (log_domain.py). The mathematics is told in posterior.py.

Arrays end with the lanes: evidence (T, W, 8) of the segment of n bins from p at [p, n - 1],
best (T + 1, 8), ways (T + 1, K, 8) with K of `columns_for`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from signkin.binning.lanes import (
    WIDTH,
    aligned,
    any_above,
    exp,
    larger,
    load,
    splat,
    store,
    where_above,
)
from signkin.binning.log_domain import NEGLIGIBLE, log_posterior, log_ways

F = NDArray[np.float64]
I = NDArray[np.int64]  # noqa: E741

UNDERFLOW = 1e-120  # a sum in the linear domain below this may have lost terms
SLOW = 1e-250  # sums below are put to 0: numbers next to the smallest are slow
MOST_LOST = 1e-13  # mass of P(M | D) that a linear pass may lose
# Penalties of a segment in units of ln T, for bounds; those that mostly are enough go first.
TAIL_PENALTIES = (-1.0, -0.35, -2.0, -0.5, 0.0, -8.0, 0.2, 0.5, 1.0, 2.0, 8.0)
TAIL_WANTED = 1e-12
CLOSE = 0.5  # to the limit where a best path gets one segment more: a penalty is near enough
FIRST_STEP = 4.0  # of a penalty that is looked for; the next ones double
TOGETHER = 4  # numbers of segments that are summed together


@njit(nogil=True)
def columns_for(most: int) -> int:
    """Return the columns that sums over 0 to `most` segments want, with some room."""
    return most + 2 + TOGETHER


# --- the best path, which gives the sums their unit ------------------------------------------


@njit(cache=True, nogil=True, error_model="numpy")
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


@njit(cache=True, nogil=True, error_model="numpy")
def scaled_evidence(evidence: F, penalty: F, best: F, out: F) -> None:
    """Fill out[p, n - 1] with exp(evidence - penalty) in units of the best path: at most 1."""
    bins, longest, _ = evidence.shape
    price = load(penalty, (0,))
    for p in range(bins):
        base = load(best, (p, 0)) + price
        for n in range(min(longest, bins - p)):
            value = (load(evidence, (p, n, 0)) + load(best, (p + 1 + n, 0))) - base
            store(out, (p, n, 0), exp(value))


@njit(cache=True, nogil=True, error_model="numpy")
def settle_penalties(evidence: F, most: int, penalty: F, best: F, segments: I) -> None:
    """Raise each penalty until its best path has at most `most` segments, and fill best."""
    best_paths(evidence, penalty, best, segments)
    goal, active = np.full((2, WIDTH), most)
    going = False
    for lane in range(WIDTH):
        active[lane] = segments[lane] > most
        going = going or active[lane]
    if going:
        _move_penalties(evidence, goal, 1, active, penalty, best, segments)


@njit(cache=True, nogil=True, error_model="numpy")
def _move_penalties(
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


# --- sums over segmentations, by the number of segments --------------------------------------


@njit(nogil=True, error_model="numpy", forceinline=True)
def _fast(value):  # type: ignore[no-untyped-def]
    return where_above(value, splat(SLOW), value, splat(0.0))


@njit(cache=True, nogil=True, error_model="numpy")
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


@njit(cache=True, nogil=True, error_model="numpy")
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


@njit(cache=True, nogil=True, error_model="numpy")
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


# --- the posterior of the number of boundaries -----------------------------------------------


@njit(cache=True, nogil=True, error_model="numpy")
def price_of_boundary(bins: int, m: int) -> float:
    """Return how much the prior of eq. 7 takes off for one boundary more, at m boundaries."""
    return math.log(bins) if m <= 0 else math.log(max(bins - m, 1) / m)


@njit(cache=True, nogil=True, error_model="numpy")
def linear_pass(
    evidence: F, penalty: F, counts: int, best: F, weight: F, ways: F, low: I, high: I
) -> None:
    """Sum over segmentations with M = 0..counts - 1; fills the ranges [low, high) of M covered.

    best: that of the penalties. low, high: (8,).
    """
    scaled_evidence(evidence, penalty, best, weight)
    ways_on(weight, counts, ways)
    for lane in range(WIDTH):
        peak = 0
        for m in range(counts):
            if ways[0, m + 1, lane] > ways[0, peak + 1, lane]:
                peak = m
        low[lane] = high[lane] = peak
        while low[lane] > 0 and ways[0, low[lane], lane] >= UNDERFLOW:
            low[lane] -= 1
        while high[lane] < counts and ways[0, high[lane] + 1, lane] >= UNDERFLOW:
            high[lane] += 1


@njit(nogil=True, error_model="numpy")
def _take(ways: F, best: F, penalty: F, lane: int, low: int, high: int, log_ways: F) -> None:
    """Write the logs of the sums for M = low..high - 1 that a pass covers. log_ways: (C, 8)."""
    for m in range(low, high):
        log_sum = math.log(ways[0, m + 1, lane])
        log_ways[m, lane] = log_sum + best[0, lane] + (m + 1) * penalty[lane]


@njit(nogil=True)
def _all_reach(values: I, goal: int) -> bool:
    reached = True
    for value in values:
        reached = reached and value >= goal
    return reached


@njit(cache=True, nogil=True, error_model="numpy")
def fill_counts(
    evidence: F, wanted: I, log_prior: F, log_by_count: F, weight: F, penalty: F, best: F,
    ways: F, low: I, high: I, spare_ways: F, spare: F,
) -> None:  # fmt: skip
    """Fill log_by_count[M] (C, 8) = ln(P(M) P(D | M)) and leave a pass ready for the posteriors.

    log_prior: (C,) log of P(M) and of one segmentation with M boundaries. wanted: (8,) whether a
    lane is. The last two arrays are scratch; the others are filled with what belongs to a pass
    whose penalties suit the posterior.
    """
    bins = evidence.shape[0]
    counts = len(log_prior)
    segments = np.empty(WIDTH, dtype=np.int64)
    penalty[:] = math.log(bins)
    settle_penalties(evidence, counts, penalty, best, segments)
    linear_pass(evidence, penalty, counts, best, weight, ways, low, high)
    log_by_count[:] = -np.inf
    done = high.copy()
    for lane in range(WIDTH):
        _take(ways, best, penalty, lane, low[lane], high[lane], log_by_count)
        if not wanted[lane]:
            low[lane], done[lane] = 0, counts
    lowest = 0
    for lane in range(WIDTH):
        lowest = max(lowest, low[lane])
    if lowest > 0:
        table = np.empty((bins + 1, lowest + 4, WIDTH))
        log_ways(evidence, lowest, table)
        for lane in range(WIDTH):
            for m in range(low[lane]):
                log_by_count[m, lane] = table[0, m + 1, lane]
    if not _all_reach(done, counts):
        _far_counts(evidence, log_by_count, done, best, spare_ways, spare)
    again = False
    for lane in range(WIDTH):
        peak = 0
        for m in range(counts):
            log_by_count[m, lane] += log_prior[m]
            if log_by_count[m, lane] > log_by_count[peak, lane]:
                peak = m
        # The posterior's own pass: the main one, unless the peak lies far from what it favours.
        price = price_of_boundary(bins, peak)
        far = abs(price - penalty[lane]) * (peak + 1) > 150.0
        if wanted[lane] and (far or peak < low[lane] or peak >= high[lane]):
            penalty[lane] = price
            again = True
    if again:
        settle_penalties(evidence, counts, penalty, best, segments)
        linear_pass(evidence, penalty, counts, best, weight, ways, low, high)


@njit(cache=True, nogil=True, error_model="numpy")
def _far_counts(
    evidence: F, log_by_count: F, done: I, best: F, ways: F, weight: F
) -> None:  # fmt: skip
    """Fill the sums for counts from `done` (8,) up, which the main pass lost.

    Passes with lower prices of a segment, each covering a further range; what none covers
    (the sums need not be concave in the count) is done in the log domain.
    """
    bins = evidence.shape[0]
    counts = len(log_by_count)
    penalty = np.full(WIDTH, math.log(bins))
    first, last, segments = np.empty((3, WIDTH), dtype=np.int64)
    stuck, active, goal = np.zeros((3, WIDTH), dtype=np.int64)
    while True:
        going = False
        for lane in range(WIDTH):
            active[lane] = done[lane] < counts and not stuck[lane]
            goal[lane] = done[lane] + 1
            going = going or active[lane]
        if not going:
            break
        _move_penalties(evidence, goal, -1, active, penalty, best, segments)
        linear_pass(evidence, penalty, counts, best, weight, ways, first, last)
        for lane in range(WIDTH):
            if not active[lane]:
                continue
            if first[lane] > done[lane] or last[lane] <= done[lane]:
                stuck[lane] = 1
            else:
                _take(ways, best, penalty, lane, done[lane], last[lane], log_by_count)
                done[lane] = last[lane]
    if not _all_reach(done, counts):
        table = np.empty((bins + 1, counts + 4, WIDTH))
        log_ways(evidence, counts, table)
        for lane in range(WIDTH):
            for m in range(done[lane], counts):
                log_by_count[m, lane] = table[0, m + 1, lane]


@njit(cache=True, nogil=True, error_model="numpy")
def tail_shares(evidence: F, wanted: I, log_by_count: F, best: F, share: F) -> None:
    """Fill share (8,) with bounds on the share of P(M | D) beyond the counts worked out.

    log_by_count: (C, 8) ln(P(M) P(D | M)). P(D | M) is a mean over segmentations, so at most the
    best one's likelihood; and for any penalty, that is at most the best penalised path, with the
    penalties of M + 1 segments put back. The least over some penalties is the bound; no more of
    them are tried than are wanted.
    """
    bins = evidence.shape[0]
    counts = len(log_by_count)
    share[:] = 0.0
    if counts >= bins:
        return
    log_evidence, penalty = np.empty((2, WIDTH))
    segments = np.empty(WIDTH, dtype=np.int64)
    for lane in range(WIDTH):
        log_evidence[lane] = _log_sum(log_by_count[:, lane])
        share[lane] = 1.0 if wanted[lane] else 0.0
    base = load(log_evidence, (0,)) + math.log(bins)
    bound = aligned(bins * WIDTH).reshape((bins, WIDTH))
    bound[:] = np.inf
    sums = np.empty(WIDTH)
    for tried in TAIL_PENALTIES:
        price = tried * math.log(bins)
        penalty[:] = price
        best_paths(evidence, penalty, best, segments)
        sum_ = splat(0.0)
        path = load(best, (0, 0))
        for m in range(counts, bins):
            old, new = load(bound, (m, 0)), path + (m + 1) * price
            lesser = where_above(old, new, new, old)
            store(bound, (m, 0), lesser)
            over = lesser - base
            sum_ = sum_ + exp(where_above(over, splat(0.0), splat(0.0), over))
        store(sums, (0,), sum_)
        wanting = False
        for lane in range(WIDTH):
            if share[lane] >= TAIL_WANTED:
                share[lane] = min(1.0, sums[lane])
                wanting = wanting or share[lane] >= TAIL_WANTED
        if not wanting:
            break


@njit(nogil=True, error_model="numpy")
def _log_sum(values: F) -> float:
    """Return the log of the sum of exponentials."""
    top = values.max()
    sum_ = 0.0
    for value in values:
        sum_ += math.exp(value - top)
    return top + math.log(sum_)


@njit(cache=True, nogil=True, error_model="numpy")
def fit_orders(
    evidence: F, wanted: I, log_prior: F, log_by_count: F, probability: F, boundary: F,
    log_evidence: F, lost: F, cut: F, segments: F, best: F, ways: F, before: F, spare: F,
) -> None:  # fmt: skip
    """Work out eight orders with counts 0..C-1.

    evidence: (T, W, 8). wanted: (8,) whether a lane is: what the others are filled with has no
    meaning. log_prior: (C,). log_by_count: (C, 8). probability: (8, C) P(M | D). boundary: (T, 8)
    probability that a segment ends with bin q. log_evidence, lost (mass of P(M | D) that was lost
    to underflow), cut: (8,). segments: (T, W, 8) probabilities of segments. best, ways, before
    (like ways), spare (like segments): scratch.
    """
    bins = evidence.shape[0]
    counts = len(log_prior)
    penalty, negligible = np.empty((2, WIDTH))
    low, high = np.empty((2, WIDTH), dtype=np.int64)
    mass = np.zeros((counts, WIDTH))  # of P(M | D) that the pass has lost
    fill_counts(
        evidence, wanted, log_prior, log_by_count, segments, penalty, best, ways, low, high, before,
        spare,
    )  # fmt: skip
    tail_shares(evidence, wanted, log_by_count, best, cut)
    before[0] = 0.0
    most = 0
    again = False
    for lane in range(WIDTH):
        log_evidence[lane] = _log_sum(log_by_count[:, lane])
        least = 1.0  # of the sums that matter: a segment must be negligible beside the smallest
        for m in range(counts):
            probability[lane, m] = math.exp(log_by_count[m, lane] - log_evidence[lane])
            sum_ = ways[0, m + 1, lane]
            if not wanted[lane]:
                continue
            if sum_ < UNDERFLOW:
                mass[m, lane] = probability[lane, m]
            elif probability[lane, m] > NEGLIGIBLE:
                before[0, m + 1, lane] = probability[lane, m] / sum_
                least = min(least, sum_)
                most = max(most, m + 1)
        negligible[lane] = NEGLIGIBLE * least
        lost[lane] = 0.0
        for m in range(counts):
            lost[lane] += mass[m, lane]
        again = again or lost[lane] > MOST_LOST
    ways_from(segments, most, before)
    for q in range(1, bins):
        value = splat(0.0)
        for k in range(1, min(most, bins - q) + 1):
            value = value + load(before, (q, k, 0)) * load(ways, (q, k, 0))
        store(boundary, (q - 1, 0), value)
    segment_probabilities(segments, ways, before, most, negligible)
    if again:
        for lane in range(WIDTH):
            if lost[lane] > MOST_LOST:
                lost[lane] = 0.0
            else:
                for m in range(counts):
                    mass[m, lane] = 0.0
        log_posterior(evidence, mass, boundary, segments)
    boundary[bins - 1] = 1.0
