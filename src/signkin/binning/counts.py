"""Compiled: the posterior of the number of boundaries, and all else, of eight orders at once.

Lanes are orders, arrays as in sum_product.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from signkin.binning.best_path import (
    best_paths,
    move_penalties,
    scaled_evidence,
    settle_penalties,
)
from signkin.binning.lanes import WIDTH, aligned, exp, load, splat, store, where_above
from signkin.binning.log_domain import NEGLIGIBLE, log_posterior, log_ways
from signkin.binning.sum_product import segment_probabilities, ways_from, ways_on
from signkin.jit import helper, kernel

F = NDArray[np.float64]
I = NDArray[np.int64]  # noqa: E741

UNDERFLOW = 1e-120  # a sum in the linear domain below this may have lost terms
MOST_LOST = 1e-13  # mass of P(M | D) that a linear pass may lose
# Penalties of a segment in units of ln T, for bounds; those that mostly are enough go first.
TAIL_PENALTIES = (-1.0, -0.35, -2.0, -0.5, 0.0, -8.0, 0.2, 0.5, 1.0, 2.0, 8.0)
TAIL_WANTED = 1e-12


@kernel
def likely_most(evidence: F, wanted: I, best: F) -> int:
    """Return a number of boundaries that the likely ones of the wanted lanes hardly exceed."""
    penalty = np.full(WIDTH, math.log(len(evidence)))
    segments = np.empty(WIDTH, dtype=np.int64)
    best_paths(evidence, penalty, best, segments)
    most = 0
    for lane in range(WIDTH):
        if wanted[lane]:
            most = max(most, segments[lane])
    return most + most // 2 + 12


@kernel
def price_of_boundary(bins: int, m: int) -> float:
    """Return how much the prior of eq. 7 takes off for one boundary more, at m boundaries."""
    return math.log(bins) if m <= 0 else math.log(max(bins - m, 1) / m)


@kernel
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


@helper
def _take(ways: F, best: F, penalty: F, lane: int, low: int, high: int, log_ways: F) -> None:
    """Write the logs of the sums for M = low..high - 1 that a pass covers. log_ways: (C, 8)."""
    for m in range(low, high):
        log_sum = math.log(ways[0, m + 1, lane])
        log_ways[m, lane] = log_sum + best[0, lane] + (m + 1) * penalty[lane]


@helper
def _lost_share(
    ways: F, best: F, penalty: F, lane: int, low: int, high: int, log_prior: F, log_by_count: F
) -> float:
    """Return a bound on the mass of the counts that a pass lost, beside the largest that it has.

    A sum below UNDERFLOW has lost terms below 1e-250, of which there are fewer than 2^T: up to
    some 400 bins it is below UNDERFLOW for all that.
    """
    top = -np.inf
    for m in range(low, high):
        top = max(top, log_by_count[m, lane] + log_prior[m])
    share = 0.0
    for m in range(len(log_prior)):
        if m < low or m >= high:
            log_sum = math.log(max(ways[0, m + 1, lane], UNDERFLOW))
            at = log_sum + best[0, lane] + (m + 1) * penalty[lane] + log_prior[m]
            share += math.exp(min(at - top, 0.0))
    return share


@helper
def _all_reach(values: I, goal: int) -> bool:
    reached = True
    for value in values:
        reached = reached and value >= goal
    return reached


@kernel
def fill_counts(
    evidence: F, wanted: I, log_prior: F, log_by_count: F, weight: F, penalty: F, best: F,
    ways: F, low: I, high: I, spare_ways: F, spare: F, likely: bool,
) -> None:  # fmt: skip
    """Fill log_by_count[M] (C, 8) = ln(P(M) P(D | M)) and leave a pass ready for the posteriors.

    log_prior: (C,) log of P(M) and of one segmentation with M boundaries. wanted: (8,) whether a
    lane is. likely: whether counts of no weight may be left at -inf. spare_ways, spare: scratch; the
    others are filled with what belongs to a pass whose penalties suit the posterior.
    """
    bins = evidence.shape[0]
    counts = len(log_prior)
    segments = np.empty(WIDTH, dtype=np.int64)
    penalty[:] = math.log(bins)
    settle_penalties(evidence, counts, penalty, best, segments)
    linear_pass(evidence, penalty, counts, best, weight, ways, low, high)
    log_by_count[:] = -np.inf
    done = high.copy()
    passed_over = np.zeros(WIDTH, dtype=np.int64)
    lowest = 0
    for lane in range(WIDTH):
        _take(ways, best, penalty, lane, low[lane], high[lane], log_by_count)
        if not wanted[lane]:
            low[lane], done[lane] = 0, counts
        elif likely:
            lost = _lost_share(
                ways, best, penalty, lane, low[lane], high[lane], log_prior, log_by_count
            )
            passed_over[lane] = lost < NEGLIGIBLE
        if passed_over[lane]:
            done[lane] = counts
        else:
            lowest = max(lowest, low[lane])
    if lowest > 0:
        table = np.empty((bins + 1, lowest + 4, WIDTH))
        log_ways(evidence, lowest, table)
        for lane in range(WIDTH):
            if not passed_over[lane]:
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


@kernel
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
        move_penalties(evidence, goal, -1, active, penalty, best, segments)
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


@kernel
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
        log_evidence[lane] = log_sum_of(log_by_count[:, lane])
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


@helper
def log_sum_of(values: F) -> float:
    """Return the log of the sum of exponentials."""
    top = values.max()
    sum_ = 0.0
    for value in values:
        sum_ += math.exp(value - top)
    return top + math.log(sum_)


@kernel
def fit_orders(
    evidence: F, wanted: I, log_prior: F, log_by_count: F, probability: F, boundary: F,
    log_evidence: F, lost: F, cut: F, segments: F, best: F, ways: F, before: F, spare: F,
    likely: bool,
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
        spare, likely,
    )  # fmt: skip
    tail_shares(evidence, wanted, log_by_count, best, cut)
    before[0] = 0.0
    most = 0
    again = False
    for lane in range(WIDTH):
        log_evidence[lane] = log_sum_of(log_by_count[:, lane])
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
