"""Compiled kernels of Bayesian binning. Loops only; the mathematics is told in posterior.py.

The compiler may not reorder sums, so that results do not depend on the width of a
machine's vectors: loops that should run on vectors keep one sum a lane.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

F = NDArray[np.float64]
I = NDArray[np.int64]  # noqa: E741

BLOCK = 32  # starts of segments that are worked on together
LANES = 8  # sums that are kept in registers together
LEAST_WEIGHT = -345.0  # log of the smallest weight that is not taken for 0
UNDERFLOW = 1e-120  # a sum in the linear domain below this may have lost terms
NEGLIGIBLE = 1e-20  # weight, in units of the best path, that posteriors pass over
# Penalties of a segment in units of ln T, for bounds; those that mostly are enough go first.
TAIL_PENALTIES = (-0.5, -2.0, 0.0, -8.0, 0.2, 0.5, 1.0, 2.0, 8.0)
TAIL_WANTED = 1e-12
MOST_LOST = 1e-13  # mass of P(M | D) that a linear pass may lose
LEAST = 1e-13  # probability of a segment that expectations pass over


# --- elementary functions on arrays, which libraries have on single numbers only -------------

LN2_HIGH = 6.93147180369123816490e-01  # ln 2 in two parts, the first with trailing zeros
LN2_LOW = 1.90821492927058770002e-10
ROUND = 6755399441055744.0  # 1.5 * 2**52: added, it leaves a whole number in the low bits
ROUND_BITS = 0x4338000000000000
SQRT_HALF_BITS = 0x3FE6A09E667F3BCD
_LOG = (
    6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01,
    2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01,
    1.479819860510658591e-01,
)  # fmt: skip
L1, L2, L3, L4, L5, L6, L7 = _LOG
C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, C13 = (1.0 / math.factorial(k) for k in range(2, 14))


@njit(cache=True, nogil=True, error_model="numpy")
def log_in_place(
    x: F, x_bits: I, mantissa: F, mantissa_bits: I, power: F, power_bits: I, n: int
) -> None:
    """Replace x[:n], positive and normal, by its natural log, to the last bit or so.

    The bits arrays are the same memory as whole numbers; mantissa and power are scratch. The
    method is that of the C library fdlibm: a power of two, and a polynomial in (m - 1)/(m + 1).
    """
    for i in range(n):
        bits = x_bits[i]
        exponent = (bits - SQRT_HALF_BITS) >> 52
        mantissa_bits[i] = bits - (exponent << 52)
        power_bits[i] = exponent + ROUND_BITS
    for i in range(n):
        e = power[i] - ROUND
        f = mantissa[i] - 1.0
        s = f / (2.0 + f)
        z = s * s
        r = z * (L1 + z * (L2 + z * (L3 + z * (L4 + z * (L5 + z * (L6 + z * L7))))))
        h = 0.5 * f * f
        x[i] = e * LN2_HIGH - ((h - (s * (h + r) + e * LN2_LOW)) - f)


@njit(cache=True, nogil=True, error_model="numpy")
def exp_in_place(x: F, rounded: F, rounded_bits: I, scale: F, scale_bits: I, n: int) -> None:
    """Replace x[:n], at most 0, by its exponential; below LEAST_WEIGHT by 0."""
    for i in range(n):
        value = max(x[i], LEAST_WEIGHT)
        shifted = value * 1.4426950408889634 + ROUND
        k = shifted - ROUND
        rounded[i] = shifted
        r = (value - k * LN2_HIGH) - k * LN2_LOW
        p = C12 + r * C13
        p = C10 + r * (C11 + r * p)
        p = C8 + r * (C9 + r * p)
        p = C6 + r * (C7 + r * p)
        p = C4 + r * (C5 + r * p)
        p = C2 + r * (C3 + r * p)
        p = 1.0 + (r + r * r * p)
        x[i] = p if x[i] > LEAST_WEIGHT else 0.0
    for i in range(n):
        scale_bits[i] = (rounded_bits[i] + 1023) << 52
    for i in range(n):
        x[i] *= scale[i]


# --- evidence of every segment ---------------------------------------------------------------


@njit(cache=True, nogil=True, error_model="numpy")
def segment_evidence(x: F, cosine: F, sine: F, constant: F, half: F, out: F) -> None:
    """Fill out[d, i, n - 1] with the log evidence of the segment of n bins from bin i, order d.

    x: (T, L), whitened. out: (D, T, W), W the longest segment; what would run over the end of
    the data is left as it was.
    """
    bins, dims = x.shape
    orders, _, longest = out.shape
    pairs = dims * (dims + 1) // 2
    z = np.empty((orders, dims, BLOCK))
    r = np.empty((orders, pairs, BLOCK))
    e = np.empty((dims, BLOCK))
    scratch = np.empty((orders, longest, BLOCK))
    chol = np.empty((dims, dims))
    mantissa = np.empty(BLOCK)
    power = np.empty(BLOCK)
    mantissa_bits = mantissa.view(np.int64)
    power_bits = power.view(np.int64)
    for first in range(0, bins, BLOCK):
        width = min(BLOCK, bins - first)
        z[:] = 0.0
        r[:] = 0.0
        for n in range(min(longest, bins - first)):
            here = min(width, bins - first - n)
            for k in range(dims):
                ek = e[k]
                for b in range(here):
                    ek[b] = x[first + b + n, k]
            for d in range(orders):
                _rotate(z[d], e, cosine[n, d], sine[n, d], here)
                _accumulate(r[d], e, here)
                row = scratch[d, n]
                _determinants(r[d], dims, here, row, chol)
                log_in_place(
                    row, row.view(np.int64), mantissa, mantissa_bits, power, power_bits, here
                )
                base, weight = constant[n, d], half[n]
                for b in range(here):
                    row[b] = base - weight * row[b]
        for d in range(orders):
            for b in range(width):
                target = out[d, first + b]
                for n in range(min(longest, bins - first - b)):
                    target[n] = scratch[d, n, b]


@njit(cache=True, nogil=True, error_model="numpy")
def _rotate(z: F, e: F, c: float, s: float, here: int) -> None:
    """Append one sample to each of some segments: rotate it into row z, e keeps the residual."""
    for k in range(e.shape[0]):
        zk, ek = z[k], e[k]
        for b in range(here):
            old = zk[b]
            zk[b] = c * old + s * ek[b]
            ek[b] = c * ek[b] - s * old


@njit(cache=True, nogil=True, error_model="numpy")
def _accumulate(r: F, e: F, here: int) -> None:
    """Add the squares and products of residuals, the lower triangle row by row."""
    p = 0
    for k in range(e.shape[0]):
        ek = e[k]
        for m in range(k + 1):
            em, rp = e[m], r[p]
            for b in range(here):
                rp[b] += ek[b] * em[b]
            p += 1


@njit(cache=True, nogil=True, error_model="numpy")
def _determinants(r: F, dims: int, here: int, out: F, chol: F) -> None:
    """Fill out with |I + R|, as a product of pivots, which loses nothing."""
    if dims == 3:
        r0, r1, r2, r3, r4, r5 = r[0], r[1], r[2], r[3], r[4], r[5]
        for b in range(here):
            a00 = 1.0 + r0[b]
            l10 = r1[b] / a00
            d1 = (1.0 + r2[b]) - l10 * r1[b]
            l20 = r3[b] / a00
            t21 = r4[b] - l20 * r1[b]
            d2 = (1.0 + r5[b]) - l20 * r3[b] - t21 * t21 / d1
            out[b] = a00 * d1 * d2
    elif dims == 1:
        r0 = r[0]
        for b in range(here):
            out[b] = 1.0 + r0[b]
    elif dims == 2:
        r0, r1, r2 = r[0], r[1], r[2]
        for b in range(here):
            a00 = 1.0 + r0[b]
            out[b] = a00 * ((1.0 + r2[b]) - r1[b] * r1[b] / a00)
    else:
        for b in range(here):
            product = 1.0
            p = 0
            for k in range(dims):
                for m in range(k + 1):
                    value = r[p, b] + (1.0 if k == m else 0.0)
                    for q in range(m):
                        value -= chol[k, q] * chol[m, q]
                    if k == m:
                        product *= value
                        chol[k, k] = math.sqrt(value)
                    else:
                        chol[k, m] = value / chol[m, m]
                    p += 1
            out[b] = product


# --- sum-product over all segmentations ------------------------------------------------------


@njit(cache=True, nogil=True, error_model="numpy")
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


@njit(cache=True, nogil=True, error_model="numpy")
def scaled_evidence(evidence: F, penalty: float, best: F, out: F) -> None:
    """Fill out[p, n - 1] with exp(evidence - penalty) in units of the best path: at most 1."""
    bins, longest = evidence.shape
    rounded = np.empty(longest)
    scale = np.empty(longest)
    rounded_bits = rounded.view(np.int64)
    scale_bits = scale.view(np.int64)
    for p in range(bins):
        base = best[p] - penalty
        row, target, ahead = evidence[p], out[p], best[p + 1 :]
        length = min(longest, bins - p)
        for n in range(length):
            target[n] = base + row[n] - ahead[n]
        exp_in_place(target, rounded, rounded_bits, scale, scale_bits, length)


@njit(cache=True, nogil=True, error_model="numpy")
def ways_on(weight: F, offset: I, most: int, out: F) -> None:
    """Fill out[p, LANES + k - offset[p]] with the sum over ways to cut bins p.. into k segments.

    weight: (T, W) scaled evidence. offset: (T + 1,) whole multiples of LANES: the band of k that
    is kept at p starts there (all 0 for every k). most: the largest k. out: (T + 1, K), K whole
    LANES, the first and last LANES columns stay 0. What would come from outside of a band is
    taken for 0. Sums far below UNDERFLOW are put to 0: numbers next to the smallest are slow.
    """
    bins, longest = weight.shape
    columns = out.shape[1]
    out[:] = 0.0
    out[bins, LANES - offset[bins]] = 1.0
    for p in range(bins - 1, -1, -1):
        row, target = weight[p], out[p]
        length = min(longest, bins - p)
        last = min(most, bins - p) - offset[p] + LANES
        # Eight sums at a time, each a lane of its own.
        at = LANES
        while at < columns - LANES and at <= last:
            s0, s1, s2, s3, s4, s5, s6, s7 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            k = at + offset[p] - 1
            for n in range(length):
                w = row[n]
                if w > 0.0:
                    c = k - offset[p + 1 + n]
                    if c < 0 or c + LANES > columns:
                        continue
                    ahead = out[p + 1 + n, c : c + LANES]
                    s0 += w * ahead[0]
                    s1 += w * ahead[1]
                    s2 += w * ahead[2]
                    s3 += w * ahead[3]
                    s4 += w * ahead[4]
                    s5 += w * ahead[5]
                    s6 += w * ahead[6]
                    s7 += w * ahead[7]
            target[at] = s0 if s0 > 1e-250 else 0.0
            target[at + 1] = s1 if s1 > 1e-250 else 0.0
            target[at + 2] = s2 if s2 > 1e-250 else 0.0
            target[at + 3] = s3 if s3 > 1e-250 else 0.0
            target[at + 4] = s4 if s4 > 1e-250 else 0.0
            target[at + 5] = s5 if s5 > 1e-250 else 0.0
            target[at + 6] = s6 if s6 > 1e-250 else 0.0
            target[at + 7] = s7 if s7 > 1e-250 else 0.0
            at += LANES
        for c in range(max(last + 1, LANES), min(at, columns)):
            target[c] = 0.0  # more segments than asked for


@njit(cache=True, nogil=True, error_model="numpy")
def columns_for(most: int) -> int:
    """Return the columns that `ways_on` wants to keep sums of 0 to `most` segments."""
    return LANES * (most // LANES + 3)


@njit(cache=True, nogil=True, error_model="numpy")
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


@njit(cache=True, nogil=True, error_model="numpy")
def log_all_ways(evidence: F, penalty: float, best: F, weight: F) -> float:
    """Return the log of the sum over all segmentations, each segment paying the penalty."""
    best_path(evidence, penalty, best)
    scaled_evidence(evidence, penalty, best, weight)
    return best[len(best) - 1] + math.log(all_ways(weight))


@njit(cache=True, nogil=True, error_model="numpy")
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


@njit(cache=True, nogil=True, error_model="numpy")
def log_counts(evidence: F, most: int, total: F) -> None:
    """Fill total[m] with the log of the sum over ways to cover all bins with m segments.

    In the log domain, for m = 1..most, where the linear one underflows. evidence: (T, W).
    What lies far below the best way to a bin is passed over, so this is faster than the whole
    table of `log_ways_on` (a third of a fit of 1,000 bins).
    """
    bins, longest = evidence.shape
    now = np.full(bins + 1, -np.inf)
    top = np.empty(bins + 1)
    rest = np.empty(bins + 1)
    values = np.empty(longest)
    rounded = np.empty(longest)
    scale = np.empty(longest)
    rounded_bits = rounded.view(np.int64)
    scale_bits = scale.view(np.int64)
    now[0] = 0.0
    for m in range(1, most + 1):
        top[:] = -np.inf
        for p in range(bins):
            base = now[p]
            if base == -np.inf:
                continue
            row, ahead = evidence[p], top[p + 1 :]
            for n in range(min(longest, bins - p)):
                ahead[n] = max(ahead[n], base + row[n])
        rest[:] = 0.0
        for p in range(bins):
            base = now[p]
            if base == -np.inf:
                continue
            row, ahead, sums = evidence[p], top[p + 1 :], rest[p + 1 :]
            length = min(longest, bins - p)
            near = 0  # whole numbers may be added in any order: this loop runs on vectors
            for n in range(length):
                near += base + row[n] - ahead[n] > -45.0
            if near == 0:
                continue
            for n in range(length):
                values[n] = base + row[n] - ahead[n]
            exp_in_place(values, rounded, rounded_bits, scale, scale_bits, length)
            for n in range(length):
                sums[n] += values[n]
        for p in range(bins + 1):
            now[p] = top[p] + math.log(rest[p]) if rest[p] > 0.0 else -np.inf
        total[m] = now[bins]


@njit(cache=True, nogil=True, error_model="numpy")
def price_of_boundary(bins: int, m: int) -> float:
    """Return how much the prior of eq. 7 takes off for one boundary more, at m boundaries."""
    return math.log(bins) if m <= 0 else math.log(max(bins - m, 1) / m)


@njit(cache=True, nogil=True, error_model="numpy")
def suitable_penalty(evidence: F, start: float, most: int, best: F) -> float:
    """Return a penalty, from `start` up, whose best path has at most `most` segments."""
    penalty = start
    if best_path(evidence, penalty, best) <= most:
        return penalty
    step = 4.0
    while best_path(evidence, penalty + step, best) > most and step < 1e6:
        step *= 2.0
    low, high = penalty, penalty + step
    for _ in range(40):
        if high - low < 0.05:
            break
        middle = 0.5 * (low + high)
        if best_path(evidence, middle, best) > most:
            low = middle
        else:
            high = middle
    return high


@njit(cache=True, nogil=True, error_model="numpy")
def linear_pass(
    evidence: F, penalty: float, counts: int, best: F, weight: F, offset: I, ways: F
) -> tuple[int, int]:
    """Run one pass over all M; returns the range of counts [low, high) that it covers."""
    best_path(evidence, penalty, best)
    scaled_evidence(evidence, penalty, best, weight)
    ways_on(weight, offset, counts, ways)
    sums = ways[0, LANES + 1 :]
    peak = 0
    for m in range(counts):
        if sums[m] > sums[peak]:
            peak = m
    low = peak
    while low > 0 and sums[low - 1] >= UNDERFLOW:
        low -= 1
    high = peak
    while high < counts and sums[high] >= UNDERFLOW:
        high += 1
    return low, high


@njit(cache=True, nogil=True, error_model="numpy")
def take_counts(ways: F, best: F, penalty: float, low: int, high: int, log_ways: F) -> None:
    """Write the logs of the sums that a pass covers."""
    bins = len(best) - 1
    for m in range(low, high):
        log_ways[m] = math.log(ways[0, LANES + m + 1]) + best[bins] + (m + 1) * penalty


@njit(cache=True, nogil=True, error_model="numpy")
def counts_of_order(
    evidence: F, log_prior: F, log_by_count: F, weight: F, best: F, offset: I, ways: F
) -> None:
    """Fill log_by_count[M] = ln(P(M) P(D | M)) and leave a pass ready for the posteriors.

    evidence: (T, W). log_prior: (C,) log of P(M) and of one segmentation with M boundaries.
    weight (T, W), best (T + 1), ways (T + 1, columns_for(C)): filled with scaled evidences,
    best sums and sums over ways of a pass whose penalty suits the posterior. offset: zeros.
    """
    bins = evidence.shape[0]
    counts = len(log_prior)
    penalty = suitable_penalty(evidence, math.log(bins), counts, best)
    low, high = linear_pass(evidence, penalty, counts, best, weight, offset, ways)
    for m in range(counts):
        log_by_count[m] = -np.inf
    take_counts(ways, best, penalty, low, high, log_by_count)
    if low > 0:
        total = np.empty(low + 1)
        log_counts(evidence, low, total)
        for m in range(low):
            log_by_count[m] = total[m + 1]
    if high < counts:
        far_counts(evidence, log_by_count, offset, high)
    peak = 0
    for m in range(counts):
        log_by_count[m] += log_prior[m]
        if log_by_count[m] > log_by_count[peak]:
            peak = m
    # The posterior's own pass: the main one, unless the peak lies far from what it favours.
    price = price_of_boundary(bins, peak)
    if peak < low or peak >= high or abs(price - penalty) * (peak + 1) > 150.0:
        penalty = suitable_penalty(evidence, price, counts, best)
        linear_pass(evidence, penalty, counts, best, weight, offset, ways)


@njit(cache=True, nogil=True, error_model="numpy")
def far_counts(evidence: F, log_by_count: F, offset: I, done: int) -> None:
    """Fill the sums for counts from `done` up, which the main pass lost.

    Passes with lower prices of a segment, each covering a further range; what none covers
    (the sums need not be concave in the count) is done in the log domain.
    """
    bins, longest = evidence.shape
    counts = len(log_by_count)
    best = np.empty(bins + 1)
    weight = np.empty((bins, longest))
    ways = np.empty((bins + 1, columns_for(counts)))
    penalty = math.log(bins)
    while done < counts:
        high, step = penalty, 8.0
        while best_path(evidence, high - step, best) - 1 < done and step < 1e9:
            step *= 2.0
        low = high - step
        for _ in range(60):
            if high - low < 0.05:
                break
            middle = 0.5 * (low + high)
            if best_path(evidence, middle, best) - 1 >= done:
                low = middle
            else:
                high = middle
        penalty = low
        first, last = linear_pass(evidence, penalty, counts, best, weight, offset, ways)
        if first > done or last <= done:
            break
        take_counts(ways, best, penalty, done, last, log_by_count)
        done = last
    if done < counts:
        total = np.empty(counts + 1)
        log_counts(evidence, counts, total)
        for m in range(done, counts):
            log_by_count[m] = total[m + 1]


@njit(cache=True, nogil=True, error_model="numpy")
def counts_in_band(
    evidence: F, log_prior: F, half_width: int, log_by_count: F, weight: F, best: F, offset: I,
    ways: F,
) -> tuple[float, float]:  # fmt: skip
    """Fill log_by_count for the counts near the likely one; -inf for the others.

    For long series: at each bin only numbers of segments within `half_width` of the best
    path's are kept. log_prior, log_by_count: (T,). ways: (T + 1, columns_for(2 half_width)).
    Leaves a pass ready like `counts_of_order`. Returns the share of the sum over all
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
    for p in range(bins + 1):
        offset[p] = max(0, (to_go[p] - half_width) // LANES * LANES)
    scaled_evidence(evidence, penalty, best, weight)
    ways_on(weight, offset, bins, ways)
    kept = 0.0
    for m in range(bins):
        log_by_count[m] = -np.inf
    for c in range(LANES, ways.shape[1] - LANES):
        m = c - LANES + offset[0] - 1
        if 0 <= m < bins and ways[0, c] >= UNDERFLOW:
            kept += ways[0, c]
            log_by_count[m] = math.log(ways[0, c]) + best[bins] + (m + 1) * penalty + log_prior[m]
    return max(0.0, 1.0 - kept / all_ways(weight)), penalty


@njit(cache=True, nogil=True, error_model="numpy")
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
    total = 0.0
    for m in range(counts):
        total += math.exp(log_by_count[m] - top)
    lost = 0.0
    least = 1.0  # of the sums that matter: a segment must be negligible beside the smallest
    # before[p]: sums over the ways to come to p with k segments to go, P(M | D) folded in.
    before[:] = 0.0
    for m in range(counts):
        probability[m] = math.exp(log_by_count[m] - top) / total
        c = LANES + m + 1 - offset[0]
        if LANES <= c < columns - LANES and ways[0, c] >= UNDERFLOW:
            if probability[m] > NEGLIGIBLE:
                before[0, c] = probability[m] / ways[0, c]
                least = min(least, ways[0, c])
        else:
            lost += probability[m]
    negligible = NEGLIGIBLE * least
    for p in range(bins):
        row, source, target = weight[p], before[p], segments[p]
        length = min(longest, bins - p)
        for n in range(longest):
            target[n] = 0.0
        # The columns in which anything has arrived.
        first, last = columns, -1
        for c in range(LANES, columns - LANES):
            if source[c] > 0.0:
                first = min(first, c)
                last = c
        sum_ = 0.0
        for c in range(first, last + 1):
            sum_ += source[c] * ways[p, c]
        if p > 0:
            boundary[p - 1] = sum_
        if last < 0:
            continue
        for n in range(length):
            w = row[n]
            if w <= negligible:
                continue
            shift = offset[p] - offset[p + 1 + n] - 1
            low = max(first, LANES - shift)
            high = min(last, columns - LANES - 1 - shift)
            onward, sums = ways[p + 1 + n], before[p + 1 + n]
            # Four sums, always these four: fast, and the same on every machine.
            s0, s1, s2, s3 = 0.0, 0.0, 0.0, 0.0
            c = low
            while c + 3 <= high:
                s0 += source[c] * onward[c + shift]
                s1 += source[c + 1] * onward[c + 1 + shift]
                s2 += source[c + 2] * onward[c + 2 + shift]
                s3 += source[c + 3] * onward[c + 3 + shift]
                c += 4
            while c <= high:
                s0 += source[c] * onward[c + shift]
                c += 1
            target[n] = w * ((s0 + s1) + (s2 + s3))
            for c in range(low, high + 1):
                sums[c + shift] += w * source[c]
    boundary[bins - 1] = 1.0
    return top + math.log(total), lost


@njit(cache=True, nogil=True, error_model="numpy")
def log_ways_on(evidence: F, most: int, table: F) -> None:
    """Fill table[k, p] with the log of the sum over ways to cut bins p.. into k segments.

    In the log domain, for k = 0..most. evidence: (T, W). table: (most + 1, T + 1).
    """
    bins, longest = evidence.shape
    values = np.empty(longest)
    rounded = np.empty(longest)
    scale = np.empty(longest)
    rounded_bits = rounded.view(np.int64)
    scale_bits = scale.view(np.int64)
    table[:] = -np.inf
    table[0, bins] = 0.0
    for k in range(1, most + 1):
        for p in range(bins - k, -1, -1):
            row, ahead = evidence[p], table[k - 1, p + 1 :]
            length = min(longest, bins - p)
            top = -np.inf
            for n in range(length):
                values[n] = row[n] + ahead[n]
                top = max(top, values[n])
            if top == -np.inf:
                continue
            for n in range(length):
                values[n] -= top
            exp_in_place(values, rounded, rounded_bits, scale, scale_bits, length)
            sum_ = 0.0
            for n in range(length):
                sum_ += values[n]
            table[k, p] = top + math.log(sum_)


@njit(cache=True, nogil=True, error_model="numpy")
def log_posterior(evidence: F, mass: F, boundary: F, segments: F) -> None:
    """Add to boundary and segments what the counts with some `mass` say, in the log domain.

    For counts whose sums the linear domain loses beside those of others: a posterior with two
    peaks far apart. evidence: (T, W). mass: (C,) of P(M | D). From each bin on, a segment's
    probability given the number of segments to go is the ratio of two sums.
    """
    bins, longest = evidence.shape
    most = 0
    for m in range(len(mass)):
        if mass[m] > 0.0:
            most = m + 1
    table = np.empty((most + 1, bins + 1))
    log_ways_on(evidence, most, table)
    here = np.zeros((bins + 1, most + 1))
    here[0, 1:] = mass[:most]
    values = np.empty(longest)
    rounded = np.empty(longest)
    scale = np.empty(longest)
    rounded_bits = rounded.view(np.int64)
    scale_bits = scale.view(np.int64)
    for p in range(bins):
        row, target = evidence[p], segments[p]
        length = min(longest, bins - p)
        if p > 0:
            boundary[p - 1] += np.sum(here[p])
        for k in range(1, most + 1):
            share = here[p, k]
            if share <= NEGLIGIBLE or table[k, p] == -np.inf:
                continue
            ahead = table[k - 1, p + 1 :]
            for n in range(length):
                values[n] = row[n] + ahead[n] - table[k, p]
            exp_in_place(values, rounded, rounded_bits, scale, scale_bits, length)
            for n in range(length):
                part = share * values[n]
                target[n] += part
                here[p + 1 + n, k - 1] += part


@njit(cache=True, nogil=True, error_model="numpy")
def uncovered(log_by_count: F, offset: I, ways: F, mass: F) -> float:
    """Fill mass with P(M | D) where a pass has lost it, 0 elsewhere; returns its sum."""
    columns = ways.shape[1]
    top = -np.inf
    for m in range(len(log_by_count)):
        top = max(top, log_by_count[m])
    total = 0.0
    lost = 0.0
    for m in range(len(log_by_count)):
        share = math.exp(log_by_count[m] - top)
        total += share
        c = LANES + m + 1 - offset[0]
        there = LANES <= c < columns - LANES and ways[0, c] >= UNDERFLOW
        mass[m] = 0.0 if there else share
        lost += mass[m]
    for m in range(len(log_by_count)):
        mass[m] /= total
    return lost / total


@njit(cache=True, nogil=True, error_model="numpy")
def tail_share(evidence: F, log_by_count: F, best: F, bound: F) -> float:
    """Return a bound on the share of P(M | D) beyond the counts worked out.

    log_by_count: (C,) ln(P(M) P(D | M)). P(D | M) is a mean over segmentations, so at most the
    best one's likelihood; and for any penalty, that is at most the best penalised path, with the
    penalties of M + 1 segments put back. The least over some penalties is the bound; no more of
    them are tried than are wanted. bound: (T,) scratch.
    """
    bins = evidence.shape[0]
    counts = len(log_by_count)
    if counts >= bins:
        return 0.0
    top = -np.inf
    for m in range(counts):
        top = max(top, log_by_count[m])
    total = 0.0
    for m in range(counts):
        total += math.exp(log_by_count[m] - top)
    log_evidence = top + math.log(total)
    bound[:] = np.inf
    share = 1.0
    for penalty in TAIL_PENALTIES:
        price = penalty * math.log(bins)
        best_path(evidence, price, best)
        sum_ = 0.0
        for m in range(counts, bins):
            bound[m] = min(bound[m], best[bins] + (m + 1) * price)
            sum_ += math.exp(min(0.0, bound[m] - math.log(bins) - log_evidence))
        share = min(1.0, sum_)
        if share < TAIL_WANTED:
            break
    return share


@njit(cache=True, nogil=True, error_model="numpy")
def fit_orders(
    evidence: F, wanted: I, log_prior: F, log_by_count: F, probability: F, boundary: F,
    log_evidence: F, lost: F, cut: F,
) -> None:  # fmt: skip
    """Work out some orders with counts 0..C-1; evidence (D, T, W) becomes segment probabilities.

    wanted: orders. log_prior: (C,). The other arrays have a row for each wanted order.
    """
    _, bins, longest = evidence.shape
    counts = len(log_prior)
    weight = np.empty((bins, longest))
    best = np.empty(bins + 1)
    offset = np.zeros(bins + 1, dtype=np.int64)
    ways = np.empty((bins + 1, columns_for(counts)))
    before = np.empty(ways.shape)
    mass = np.empty(counts)
    bound = np.empty(bins)
    for i in range(len(wanted)):
        of_order = evidence[wanted[i]]
        counts_of_order(of_order, log_prior, log_by_count[i], weight, best, offset, ways)
        cut[i] = tail_share(of_order, log_by_count[i], best, bound)
        # The posterior overwrites the evidence, which is wanted again where a pass loses counts.
        again = uncovered(log_by_count[i], offset, ways, mass) > MOST_LOST
        kept = of_order.copy() if again else of_order
        log_evidence[i], lost[i] = posterior_of_order(
            log_by_count[i], weight, offset, ways, before, probability[i], boundary[i], of_order
        )
        if again:
            log_posterior(kept, mass, boundary[i], of_order)
            lost[i] = 0.0
            boundary[i, bins - 1] = 1.0


@njit(cache=True, nogil=True, error_model="numpy")
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


# --- expected trajectories -------------------------------------------------------------------


@njit(cache=True, nogil=True, error_model="numpy")
def expectations(
    x: F, cosine: F, sine: F, inverse: F, powers: F, half: F, segments: F, mean: F, noise: F
) -> None:
    """Fill mean[d] (T, L), averaged over segmentations, and noise[d] (L, L), over bins.

    x: (T, L) whitened. segments: (D, T, W) probabilities of segments for each order. The noise
    of a segment is the inverse of its expected precision.
    """
    bins, dims = x.shape
    orders, _, longest = segments.shape
    pairs = dims * (dims + 1) // 2
    starts = np.empty(bins, dtype=np.int64)
    reach = np.empty(bins, dtype=np.int64)
    active = 0
    for p in range(bins):
        far = 0
        for d in range(orders):
            row = segments[d, p]
            for n in range(min(longest, bins - p) - 1, far - 1, -1):
                if row[n] > LEAST:
                    far = n + 1
                    break
        if far > 0:
            starts[active], reach[active] = p, far
            active += 1
    z = np.empty((orders, dims, LANES))
    r = np.empty((orders, pairs, LANES))
    e = np.empty((dims, LANES))
    found = np.empty((orders, LANES), dtype=np.int64)
    lengths = np.empty((orders, LANES, longest), dtype=np.int64)
    terms = np.empty((orders, LANES, longest, orders, dims))
    sums = np.empty((orders, dims))
    mean[:] = 0.0
    noise[:] = 0.0
    for first in range(0, active, LANES):
        width = min(LANES, active - first)
        far = 0
        for b in range(width):
            far = max(far, reach[first + b])
        z[:] = 0.0
        r[:] = 0.0
        found[:] = 0
        for n in range(far):
            for b in range(LANES):
                at = starts[first + b] + n if b < width else bins
                for k in range(dims):
                    e[k, b] = x[at, k] if at < bins else 0.0
            for d in range(orders):
                _rotate(z[d], e, cosine[n, d], sine[n, d], LANES)
                _accumulate(r[d], e, LANES)
                for b in range(width):
                    if n >= reach[first + b]:
                        continue
                    chance = segments[d, starts[first + b], n]
                    if chance <= LEAST:
                        continue
                    f = found[d, b]
                    here = terms[d, b, f]
                    for i in range(d + 1):
                        for k in range(dims):
                            value = 0.0
                            for j in range(i, d + 1):
                                value += inverse[n, i, j] * z[j, k, b]
                            here[i, k] = chance * value
                    lengths[d, b, f] = n + 1
                    found[d, b] = f + 1
                    share = chance * (n + 1) / (2.0 * half[n])
                    q = 0
                    for k in range(dims):
                        noise[d, k, k] += share
                        for m in range(k + 1):
                            noise[d, k, m] += share * r[d, q, b]
                            if m < k:
                                noise[d, m, k] += share * r[d, q, b]
                            q += 1
        for b in range(width):
            p = starts[first + b]
            for d in range(orders):
                # From the longest segment down: its terms hold for all bins of the shorter ones.
                sums[:] = 0.0
                for f in range(found[d, b] - 1, -1, -1):
                    for i in range(d + 1):
                        for k in range(dims):
                            sums[i, k] += terms[d, b, f, i, k]
                    shortest = lengths[d, b, f - 1] if f > 0 else 0
                    for n in range(shortest, lengths[d, b, f]):
                        u = powers[n, 1] if orders > 1 else 0.0
                        for k in range(dims):
                            value = sums[d, k]
                            for i in range(d - 1, -1, -1):
                                value = value * u + sums[i, k]
                            mean[d, p + n, k] += value
    for d in range(orders):
        for k in range(dims):
            for m in range(dims):
                noise[d, k, m] /= bins


# --- the most probable segmentation, and its prior -------------------------------------------


@njit(cache=True, nogil=True, error_model="numpy")
def best_boundaries(evidence: F, parts: int) -> NDArray[np.int64]:
    """Return the bins that end the segments, but the last, of the best cut into `parts`."""
    bins, longest = evidence.shape
    now = np.full(bins + 1, -np.inf)
    after = np.empty(bins + 1)
    came = np.full((parts + 1, bins + 1), -1, dtype=np.int32)
    now[0] = 0.0
    for m in range(1, parts + 1):
        after[:] = -np.inf
        for p in range(bins):
            base = now[p]
            if base == -np.inf:
                continue
            row = evidence[p]
            for n in range(min(longest, bins - p)):
                value = base + row[n]
                if value > after[p + 1 + n]:
                    after[p + 1 + n] = value
                    came[m, p + 1 + n] = p
        now, after = after, now
    out = np.empty(parts - 1, dtype=np.int64)
    q = bins
    for m in range(parts, 1, -1):
        q = came[m, q]
        out[m - 2] = q - 1
    return out


@njit(cache=True, nogil=True, error_model="numpy")
def log_compositions(bins: int, longest: int, most: int) -> F:
    """Return, for m < most, the log of the number of cuts of T bins into m + 1 parts <= W.

    A sum over a window of W is the end of one block of W plus the start of the next: nothing
    is subtracted, so nothing is lost. For few parts: for many, the numbers that lead to T bins
    are too small beside the largest.
    """
    out = np.full(most, -np.inf)
    now = np.zeros(bins + 1)
    after = np.empty(bins + 1)
    ending = np.empty(bins + 1)  # sum from q to the end of q's block
    starting = np.empty(bins + 1)  # sum from the start of q's block to q
    scale = 0.0
    now[0] = 1.0
    for m in range(most):
        for q in range(bins + 1):
            starting[q] = now[q] + (starting[q - 1] if q % longest else 0.0)
        for q in range(bins, -1, -1):
            last = q == bins or q % longest == longest - 1
            ending[q] = now[q] + (0.0 if last else ending[q + 1])
        top = 0.0
        after[0] = 0.0
        for q in range(1, bins + 1):
            first = max(0, q - longest)  # the window is first..q-1
            if first % longest == 0:
                value = starting[q - 1]
            else:
                value = ending[first]
                if (q - 1) // longest != first // longest:
                    value += starting[q - 1]
            after[q] = value
            top = max(top, value)
        if top == 0.0:
            break
        for q in range(bins + 1):
            after[q] /= top
        scale += math.log(top)
        now, after = after, now
        if now[bins] > 0.0:
            out[m] = math.log(now[bins]) + scale
    return out
