"""Compiled: one order of a long series, with numbers of segments near the likely one only.

Lanes are eight numbers of segments. At each bin those are kept that lie in a band around the
best path's number (or the mean); posterior.py bounds what the band leaves out. Arrays are (T, W),
evidence of the segment of n bins from p at [p, n - 1].
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from signkin.binning.counts import UNDERFLOW, price_of_boundary
from signkin.binning.lanes import (
    WIDTH,
    aligned,
    any_above,
    exp_in_place,
    load,
    splat,
    store,
    total,
    where_above,
)
from signkin.binning.log_domain import NEGLIGIBLE
from signkin.binning.sum_product import SLOW
from signkin.jit import kernel

F = NDArray[np.float64]
I = NDArray[np.int64]  # noqa: E741

PRICE_STEPS = 20
HIGHEST_SUM = 1e200  # sums of suffixes exceed that of the whole a little


@kernel
def best_path(evidence: F, penalty: float, best: F) -> int:
    """Fill best[p], the largest sum of (log evidence - penalty) over segmentations of p bins.

    evidence: (T, W). Returns the number of segments of the best segmentation of all T bins.
    """
    bins, longest = evidence.shape
    best[0] = 0.0
    for p in range(1, bins + 1):
        best[p] = -np.inf
    for p in range(bins):
        base = best[p] - penalty
        row = evidence[p]
        ahead = best[p + 1 :]
        for n in range(min(longest, bins - p)):
            ahead[n] = max(ahead[n], base + row[n])
    count = 0
    q = bins
    while q > 0:
        for n in range(min(longest, q)):
            p = q - 1 - n
            if best[p] - penalty + evidence[p, n] == best[q]:
                q = p
                break
        count += 1
    return count


@kernel
def segments_to_go(evidence: F, penalty: float, best: F, out: I) -> None:
    """Fill out[p] with the number of segments of the best path that end behind bin p - 1."""
    bins, longest = evidence.shape
    count = 0
    q = bins
    out[bins] = 0
    while q > 0:
        count += 1
        for n in range(min(longest, q)):
            p = q - 1 - n
            out[p] = count
            if best[p] - penalty + evidence[p, n] == best[q]:
                q = p
                break


@kernel
def scaled_evidence(evidence: F, penalty: float, best: F, out: F) -> None:
    """Fill out[p, n - 1] with exp(evidence - penalty) in units of the best path: at most 1."""
    bins, longest = evidence.shape
    values = aligned(longest + WIDTH)
    for p in range(bins):
        base = best[p] - penalty
        row, target, ahead = evidence[p], out[p], best[p + 1 :]
        length = min(longest, bins - p)
        for n in range(length):
            values[n] = base + row[n] - ahead[n]
        exp_in_place(values, length)
        for n in range(length):
            target[n] = values[n]


@kernel
def ways_on(weight: F, offset: I, ways: F) -> None:
    """Fill ways[p, WIDTH + k - offset[p]] with the sum over ways to cut bins p.. into k segments.

    weight: (T, W) scaled evidence. offset: (T + 1,) whole multiples of WIDTH: the band of k that
    is kept at p starts there, and no later for a later p. ways: (T + 1, K), K of `columns_for`,
    the first and last WIDTH columns stay 0. What would come from outside of a band is taken for 0.
    """
    bins, longest = weight.shape
    columns = ways.shape[1]
    ways[:] = 0.0
    ways[bins, WIDTH - offset[bins]] = 1.0
    for p in range(bins - 1, -1, -1):
        last = bins - p - offset[p] + WIDTH
        for at in range(WIDTH, min(columns - WIDTH, last + 1), WIDTH):
            sum_ = splat(0.0)
            for n in range(min(longest, bins - p)):
                w = weight[p, n]
                c = at + offset[p] - 1 - offset[p + 1 + n]
                if w > 0.0 and c <= columns - WIDTH:
                    sum_ = sum_ + w * load(ways, (p + 1 + n, c))
            store(ways, (p, at), where_above(sum_, splat(SLOW), sum_, splat(0.0)))


@kernel
def columns_for(most: int) -> int:
    """Return the columns that `ways_on` wants to keep sums of 0 to `most` segments."""
    return WIDTH * (most // WIDTH + 3)


@kernel
def all_ways(weight: F) -> float:
    """Return the sum over all segmentations, of whatever number of segments."""
    bins, longest = weight.shape
    sums = np.zeros(bins + 1)
    sums[bins] = 1.0
    for p in range(bins - 1, -1, -1):
        row = weight[p]
        value = 0.0
        for n in range(min(longest, bins - p)):
            value += row[n] * sums[p + 1 + n]
        sums[p] = value
    return sums[0]


@kernel
def log_sums(evidence: F, penalty: float, out: F) -> None:
    """Fill out[p], the log of the sum over all segmentations of p bins, each segment paying."""
    bins, longest = evidence.shape
    out[0] = 0.0
    for q in range(1, bins + 1):
        top = -np.inf
        for n in range(min(longest, q)):
            top = max(top, out[q - 1 - n] + evidence[q - 1 - n, n])
        value = 0.0
        if top > -np.inf:
            for n in range(min(longest, q)):
                value += math.exp(out[q - 1 - n] + evidence[q - 1 - n, n] - top)
            out[q] = top - penalty + math.log(value)
        else:
            out[q] = -np.inf


@kernel
def log_sums_by_best(evidence: F, penalty: float, weight: F, out: F) -> None:
    """Fill out as `log_sums` does, by the best path: sooner, but infinite where sums exceed it.

    weight: (T, W) scratch.
    """
    bins, longest = evidence.shape
    best_path(evidence, penalty, out)
    scaled_evidence(evidence, penalty, out, weight)
    sums = np.zeros(bins + 1)
    sums[0] = 1.0
    for p in range(bins):
        here, row, ahead = sums[p], weight[p], sums[p + 1 :]
        for n in range(min(longest, bins - p)):
            ahead[n] += here * row[n]
    for p in range(bins + 1):
        out[p] += math.log(sums[p])


@kernel
def scaled_to_fit(evidence: F, penalty: float, best: F, weight: F) -> tuple[float, bool]:
    """Scale evidence so that sums over segmentations can be held.

    Returns the sum over all, and whether the unit had to be another than the best path.

    In units of the best path, where it fits: of a very long series nearly as good segmentations
    are more than a double can count. There the unit is the sum itself, bin by bin: a weight is the
    probability of a segment given where it ends, and no sum exceeds 1. `best` becomes the unit.
    """
    scaled_evidence(evidence, penalty, best, weight)
    sum_ = all_ways(weight)
    other = not sum_ < HIGHEST_SUM
    if other:
        log_sums(evidence, penalty, best)
        scaled_evidence(evidence, penalty, best, weight)
        sum_ = all_ways(weight)
    return sum_, other


@kernel
def mean_segments_to_go(weight: F, out: I) -> None:
    """Fill out[p] with how many segments of all bins end behind bin p - 1, in the mean.

    weight: probabilities of a segment given where it ends (`scaled_to_fit`). Where there are that
    many segmentations, the best path has another number of segments than most of them.
    """
    bins, longest = weight.shape
    so_far = np.zeros(bins + 1)
    for q in range(1, bins + 1):
        value = 0.0
        for n in range(min(longest, q)):
            value += weight[q - 1 - n, n] * (so_far[q - 1 - n] + 1.0)
        so_far[q] = value
    latest = 0.0  # a later bin has no more to go
    for p in range(bins + 1):
        latest = max(latest, so_far[p])
        out[p] = round(max(0.0, so_far[bins] - latest))


@kernel
def log_all_ways(evidence: F, penalty: float, best: F, weight: F) -> float:
    """Return the log of the sum over all segmentations, each segment paying the penalty."""
    best_path(evidence, penalty, best)
    sum_, _ = scaled_to_fit(evidence, penalty, best, weight)
    return best[len(best) - 1] + math.log(sum_)


@kernel
def counts_in_band(
    evidence: F, log_prior: F, half_width: int, log_by_count: F, weight: F, best: F, offset: I,
    ways: F,
) -> tuple[float, float]:  # fmt: skip
    """Fill log_by_count for the counts near the likely one; -inf for the others.

    For long series: at each bin only numbers of segments within `half_width` of the best
    path's are kept (or of the mean: `scaled_to_fit`). log_prior, log_by_count: (T,). ways:
    (T + 1, columns_for(2 half_width)).
    Leaves a pass ready for `posterior_of_order`. Returns the share of the sum over all
    segmentations, at the pass's price of a segment, that the band and the window of counts
    leave out, and the penalty.
    """
    bins = evidence.shape[0]
    to_go = np.empty(bins + 1, dtype=np.int64)
    penalty = math.log(bins)
    for _ in range(4):
        likely = best_path(evidence, penalty, best) - 1
        price = price_of_boundary(bins, likely)
        if abs(price - penalty) < 0.2:
            break
        penalty = price
    best_path(evidence, penalty, best)
    segments_to_go(evidence, penalty, best, to_go)
    total_ways, other = scaled_to_fit(evidence, penalty, best, weight)
    if other:
        mean_segments_to_go(weight, to_go)
        for _ in range(PRICE_STEPS):
            price = price_of_boundary(bins, to_go[0] - 1)
            if abs(price - penalty) < 0.02:
                break
            penalty = price
            log_sums(evidence, penalty, best)
            scaled_evidence(evidence, penalty, best, weight)
            mean_segments_to_go(weight, to_go)
        total_ways = all_ways(weight)
    for p in range(bins + 1):
        offset[p] = max(0, (to_go[p] - half_width) // WIDTH * WIDTH)
    ways_on(weight, offset, ways)
    kept = 0.0
    for m in range(bins):
        log_by_count[m] = -np.inf
    for c in range(WIDTH, ways.shape[1] - WIDTH):
        m = c - WIDTH + offset[0] - 1
        if 0 <= m < bins and ways[0, c] >= UNDERFLOW:
            kept += ways[0, c]
            log_by_count[m] = math.log(ways[0, c]) + best[bins] + (m + 1) * penalty + log_prior[m]
    return max(0.0, 1.0 - kept / total_ways), penalty


@kernel
def posterior_of_order(
    log_by_count: F, weight: F, offset: I, ways: F, before: F, probability: F, boundary: F,
    segments: F,
) -> tuple[float, float]:  # fmt: skip
    """Fill what the data say about one order, given the pass that was left for it.

    log_by_count: (C,) ln(P(M) P(D | M)). probability: (C,) P(M | D). boundary: (T,) probability
    that a segment ends with bin q. segments: (T, W) probability of the segment of n bins from
    p. before: scratch like `ways`. Returns ln P(D) for this order and the mass of P(M | D) that
    the pass lost to underflow.
    """
    bins, longest = weight.shape
    counts = len(log_by_count)
    columns = ways.shape[1]
    top = -np.inf
    for m in range(counts):
        top = max(top, log_by_count[m])
    mass = 0.0
    for m in range(counts):
        mass += math.exp(log_by_count[m] - top)
    lost = 0.0
    least = 1.0  # of the sums that matter: a segment must be negligible beside the smallest
    # before[p]: sums over the ways to come to p with k segments to go, P(M | D) folded in.
    before[:] = 0.0
    for m in range(counts):
        probability[m] = math.exp(log_by_count[m] - top) / mass
        c = WIDTH + m + 1 - offset[0]
        if WIDTH <= c < columns - WIDTH and ways[0, c] >= UNDERFLOW:
            if probability[m] > NEGLIGIBLE:
                before[0, c] = probability[m] / ways[0, c]
                least = min(least, ways[0, c])
        else:
            lost += probability[m]
    negligible = NEGLIGIBLE * least
    for p in range(bins):
        # The columns in which anything has arrived, in whole lanes.
        first, last = columns, -1
        sum_ = splat(0.0)
        for c in range(WIDTH, columns - WIDTH, WIDTH):
            behind = load(before, (p, c))
            if any_above(behind, splat(0.0)):
                first = min(first, c)
                last = c
                sum_ = sum_ + behind * load(ways, (p, c))
        if p > 0:
            boundary[p - 1] = total(sum_)
        for n in range(longest):
            segments[p, n] = 0.0
        for n in range(min(longest, bins - p)):
            w = weight[p, n]
            if w <= negligible or last < 0:
                continue
            q = p + 1 + n
            shift = offset[p] - offset[q] - 1
            sum_ = splat(0.0)
            # What falls out of the band at q falls on its empty columns, or beyond them.
            for c in range(first, min(last, columns - WIDTH - shift) + 1, WIDTH):
                behind = load(before, (p, c))
                sum_ = sum_ + behind * load(ways, (q, c + shift))
                store(before, (q, c + shift), load(before, (q, c + shift)) + w * behind)
            segments[p, n] = w * total(sum_)
    boundary[bins - 1] = 1.0
    return top + math.log(mass), lost


@kernel
def fit_order_in_band(
    evidence: F, log_prior: F, half_width: int, log_by_count: F, probability: F, boundary: F
) -> tuple[float, float, float, float]:
    """Work out one order of a long series in a band; evidence (T, W) is overwritten.

    Returns ln P(D), the mass lost to underflow, the share that the band left out (at the
    pass's price of a segment) and that price.
    """
    bins, longest = evidence.shape
    weight = np.empty((bins, longest))
    best = np.empty(bins + 1)
    offset = np.empty(bins + 1, dtype=np.int64)
    ways = np.empty((bins + 1, columns_for(2 * half_width)))
    left_out, penalty = counts_in_band(
        evidence, log_prior, half_width, log_by_count, weight, best, offset, ways
    )
    log_evidence, lost = posterior_of_order(
        log_by_count, weight, offset, ways, np.empty(ways.shape), probability, boundary, evidence
    )
    return log_evidence, lost, left_out, penalty
