"""Compiled: the evidence of every segment of a trajectory, and expectations over segments.

Lanes are segments that start at eight neighbouring bins. Samples are appended one by one: the
rotations of prior.Tables bring each into the triangular factor's right side z, and what is left
of it after order d + 1 rotations is the residual of order d, whose squares and products add up
to the matrix R (prior.py).

The segments of all orders stand `by_segment`, (G, T, W, 8), the orders as lanes in G groups of
eight, or `by_order`, (D, T, W): in both at [.., p, n - 1] that of n bins from bin p.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.binning.evidence_layout import write_evidence
from signkin.binning.exact import append_exactly
from signkin.binning.lanes import (
    WIDTH,
    aligned,
    any_above,
    load,
    log,
    moved_up,
    splat,
    store,
    total,
    transpose,
)
from signkin.jit import helper, inlined, kernel

F = NDArray[np.float64]
I = NDArray[np.int64]  # noqa: E741

# Product of I + R's diagonal over that of its pivots: how much rounding grows in ln |I + R|.
MOST_LOST = 1e6
LEAST = 1e-13  # probability of a segment that expectations pass over


@inlined
def _append(
    x: F, at: int, cosine: F, sine: F, n: int, orders: int, z: F, old: int, new: int, r: F, rest: F
) -> None:  # fmt: skip
    """Append bin at, at + 1, .. at + 7 to segments of n bins: one each, for the first orders.

    x: (L, ..). z: (.., D, L, 8), read at `old` and written at `new`. r: (D, L (L+1)/2, 8), R's
    lower triangle row by row, added to. rest: (L, 8) scratch.
    """
    dims = x.shape[0]
    if dims == 3:
        e0, e1, e2 = load(x, (0, at)), load(x, (1, at)), load(x, (2, at))
        for d in range(orders):
            c, s = cosine[n, d], sine[n, d]
            z0, z1, z2 = (
                load(z, (old, d, 0, 0)), load(z, (old, d, 1, 0)), load(z, (old, d, 2, 0))
            )  # fmt: skip
            store(z, (new, d, 0, 0), c * z0 + s * e0)
            store(z, (new, d, 1, 0), c * z1 + s * e1)
            store(z, (new, d, 2, 0), c * z2 + s * e2)
            e0, e1, e2 = c * e0 - s * z0, c * e1 - s * z1, c * e2 - s * z2
            store(r, (d, 0, 0), load(r, (d, 0, 0)) + e0 * e0)
            store(r, (d, 1, 0), load(r, (d, 1, 0)) + e1 * e0)
            store(r, (d, 2, 0), load(r, (d, 2, 0)) + e1 * e1)
            store(r, (d, 3, 0), load(r, (d, 3, 0)) + e2 * e0)
            store(r, (d, 4, 0), load(r, (d, 4, 0)) + e2 * e1)
            store(r, (d, 5, 0), load(r, (d, 5, 0)) + e2 * e2)
        return
    for k in range(dims):
        store(rest, (k, 0), load(x, (k, at)))
    for d in range(orders):
        c, s = cosine[n, d], sine[n, d]
        q = 0
        for k in range(dims):
            y, e = load(z, (old, d, k, 0)), load(rest, (k, 0))
            store(z, (new, d, k, 0), c * y + s * e)
            e = c * e - s * y
            store(rest, (k, 0), e)
            for m in range(k + 1):
                store(r, (d, q, 0), load(r, (d, q, 0)) + e * load(rest, (m, 0)))
                q += 1


@inlined
def _log_determinants(r: F, orders: int, dims: int, factor: F, out: F) -> bool:
    """Fill out[d] (8,) with ln |I + R|; returns whether some of them have lost too many digits.

    They have where the product of pivots is far below that of the diagonal: residuals nearly on
    a line, or in a plane (MOST_LOST). factor: (L (L+1)/2, 8) scratch. Logs are long chains of
    sums: they wait for one another less in a loop of their own.
    """
    lost = False
    if dims == 3:
        for d in range(orders):
            a00 = 1.0 + load(r, (d, 0, 0))
            a10, a20 = load(r, (d, 1, 0)), load(r, (d, 3, 0))
            # The pivots, each times the first one: one division instead of three.
            a11, a22 = 1.0 + load(r, (d, 2, 0)), 1.0 + load(r, (d, 5, 0))
            b11 = a00 * a11 - a10 * a10
            b21 = a00 * load(r, (d, 4, 0)) - a20 * a10
            b22 = a00 * a22 - a20 * a20
            minor = b11 * b22 - b21 * b21
            lost = lost or any_above(a00 * a00 * a11 * a22, MOST_LOST * minor)
            store(out, (d, 0), minor / a00)
        for d in range(orders):
            store(out, (d, 0), log(load(out, (d, 0))))
        return lost
    for d in range(orders):
        value, diagonal, pivots = splat(0.0), splat(1.0), splat(1.0)
        q = 0
        for k in range(dims):
            first = q  # of row k
            for m in range(k + 1):
                above = m * (m + 1) // 2  # of row m
                a = load(r, (d, q, 0)) + (1.0 if k == m else 0.0)
                if k == m:
                    diagonal = diagonal * a
                for j in range(m):
                    # factor holds the entries times the pivot of their column.
                    pivot = load(factor, (j * (j + 3) // 2, 0))
                    a = a - load(factor, (first + j, 0)) * load(factor, (above + j, 0)) / pivot
                store(factor, (q, 0), a)
                if k == m:
                    value = value + log(a)
                    pivots = pivots * a
                q += 1
        lost = lost or any_above(diagonal, MOST_LOST * pivots)
        store(out, (d, 0), value)
    return lost


@inlined
def _append_carefully(
    x: F, at: int, cosine: F, sine: F, n: int, orders: int, z: F, factor: F, rest: F, w: F
) -> None:
    """Append bins as `_append` does, and keep I + R as L D L', from which nothing is subtracted.

    factor: (D, L (L+1)/2, 8), row by row, the diagonal of D in the place of L's, which is 1
    (exact.py does the same with 32 digits). rest, w: (L, 8) scratch.
    """
    dims = x.shape[0]
    for d in range(orders):
        c, s = cosine[n, d], sine[n, d]
        for k in range(dims):
            e = load(rest, (k, 0))
            if d == 0:
                e = load(x, (k, at))
            y = load(z, (0, d, k, 0))
            store(z, (0, d, k, 0), c * y + s * e)
            e = c * e - s * y
            store(rest, (k, 0), e)
            store(w, (k, 0), e)
        a = splat(1.0)
        for k in range(dims):
            p, old = load(w, (k, 0)), load(factor, (d, k * (k + 3) // 2, 0))
            b = a * p
            new = old + b * p
            store(factor, (d, k * (k + 3) // 2, 0), new)
            over = 1.0 / new
            a, b = a * old * over, b * over
            for j in range(k + 1, dims):
                of = j * (j + 1) // 2 + k
                share = load(factor, (d, of, 0))
                v = load(w, (j, 0)) - p * share
                store(w, (j, 0), v)
                store(factor, (d, of, 0), share + b * v)


@inlined
def _logs_of_pivots(factor: F, orders: int, dims: int, out: F) -> None:
    """Fill out[d] (8,) with the log of the product of D's diagonal."""
    for d in range(orders):
        value, product = splat(0.0), splat(1.0)
        for k in range(dims):
            product = product * load(factor, (d, k * (k + 3) // 2, 0))
            if k % 8 == 7:
                value = value + log(product)
                product = splat(1.0)
        store(out, (d, 0), value + log(product))


@kernel
def segment_evidence(
    x: F, cosine: F, sine: F, constant: F, half: F, bins: int, carefully: bool, out: F
) -> bool:
    """Fill out, by segment or by order, with the log evidence of every segment.

    Returns whether some of them have lost digits that matter, and stops there: then they are to
    be worked out `carefully`, which takes twice as long.

    x: (L, T + 8), whitened, 0 behind the last bin. The tables are those of prior.Tables. What
    would run over the end of the data is left as it was. Lanes beyond the highest order repeat it.
    """
    dims = x.shape[0]
    orders = cosine.shape[1]
    groups = (orders - 1) // WIDTH + 1
    longest = out.shape[2]
    pairs = dims * (dims + 1) // 2
    z = aligned(orders * dims * WIDTH).reshape((1, orders, dims, WIDTH))
    r = aligned(orders * pairs * WIDTH).reshape((orders, pairs, WIDTH))
    rest = aligned(dims * WIDTH).reshape((dims, WIDTH))
    factor = aligned(pairs * WIDTH).reshape((pairs, WIDTH))
    values = aligned(groups * WIDTH * WIDTH).reshape((groups * WIDTH, WIDTH))
    turned = aligned(WIDTH * WIDTH).reshape((WIDTH, WIDTH))
    w = aligned(dims * WIDTH).reshape((dims, WIDTH))
    for first in range(0, bins, WIDTH):
        z[:] = 0.0
        r[:] = 0.0
        if carefully:  # r holds the factors
            for k in range(dims):
                r[:, k * (k + 3) // 2] = 1.0
        lost = False
        for n in range(min(longest, bins - first)):
            if carefully:
                _append_carefully(x, first + n, cosine, sine, n, orders, z, r, rest, w)
                _logs_of_pivots(r, orders, dims, values)
            else:
                _append(x, first + n, cosine, sine, n, orders, z, 0, 0, r, rest)
                lost = _log_determinants(r, orders, dims, factor, values) or lost
            for d in range(orders):
                store(values, (d, 0), constant[n, d] - half[n] * load(values, (d, 0)))
            write_evidence(values, turned, orders, first, n, bins, out)
        if lost:
            return True
    return False


@helper
def _chances(segments: F, first: int, bins: int, wanted: I, chances: F, turned: F, far: I) -> None:
    """Fill chances[n] (D, 8) with the probabilities of segments from `first` on, by starts.

    segments: by segment or by order. far: (D,) filled with the bins of the longest that counts.
    """
    orders = len(wanted)
    longest = segments.shape[2]
    least = splat(LEAST)
    far[:] = 0
    for n in range(min(longest, bins - first)):
        here = min(WIDTH, bins - first - n)
        if segments.ndim == 4:
            for g in range(segments.shape[0]):
                likely = False
                for b in range(here):
                    row = load(segments, (g, first + b, n, 0))
                    store(turned, (b, 0), row)
                    likely = likely or any_above(row, least)
                if likely:
                    for b in range(here, WIDTH):
                        store(turned, (b, 0), splat(0.0))
                    transpose(turned, (0, 0), chances, (n, WIDTH * g, 0))
                else:
                    for d in range(WIDTH * g, WIDTH * (g + 1)):
                        store(chances, (n, d, 0), splat(0.0))
        else:
            for d in range(orders):
                for b in range(WIDTH):
                    chances[n, d, b] = segments[d, first + b, n] if b < here else 0.0
        for d in range(orders):
            if wanted[d] and any_above(load(chances, (n, d, 0)), least):
                far[d] = n + 1


@inlined
def _append_all(
    x: F, at: int, rotations: F, n: int, orders: int, z: F, z_low: F, old: int, new: int, r: F,
    rest: F, rest_low: F,
) -> None:  # fmt: skip
    """Append bins as `_append` does, with 32 digits; squares and products have 16."""
    for d in range(orders):
        append_exactly(x, at, rotations, n, d, z, z_low, old, new, rest, rest_low)
        q = 0
        for k in range(x.shape[0]):
            for m in range(k + 1):
                square = load(rest, (k, 0)) * load(rest, (m, 0))
                store(r, (d, q, 0), load(r, (d, q, 0)) + square)
                q += 1


@inlined
def _noise_of_segments(
    r: F, d: int, n: int, weight: float, chances: F, dims: int, scale: F, spread: F
) -> None:  # fmt: skip
    """Add to spread[d] the squares and products of residuals, V^-1 + R, as likely as they are."""
    share = load(chances, (n, d, 0)) * weight
    q = 0
    for k in range(dims):
        for m in range(k + 1):
            value = load(r, (d, q, 0)) + (scale[k] if k == m else 0.0)
            store(spread, (d, q, 0), load(spread, (d, q, 0)) + share * value)
            q += 1


@inlined
def _mean_of_segments(
    inverse: F, powers: F, z: F, d: int, far: int, chances: F, first: int, dims: int, sums: F,
    trail: F, mean: F,
) -> None:  # fmt: skip
    """Add to mean[d] (L, T + 8) the polynomials of the segments that start at eight bins.

    From the longest segment down: the coefficients of the longer ones, weighed and added up in
    sums (D, L, 8), hold for all bins of the shorter ones. trail: (L, 8), the last eight bins' sums,
    which move on by one lane a bin.
    """
    least = splat(LEAST)
    for i in range(d + 1):
        for k in range(dims):
            store(sums, (i, k, 0), splat(0.0))
    for k in range(dims):
        store(trail, (k, 0), splat(0.0))
    for n in range(far - 1, -1, -1):
        chance = load(chances, (n, d, 0))
        if any_above(chance, least):
            for i in range(d + 1):
                for k in range(dims):
                    value = inverse[n, i, i] * load(z, (n + 1, i, k, 0))
                    for j in range(i + 1, d + 1):
                        value = value + inverse[n, i, j] * load(z, (n + 1, j, k, 0))
                    store(sums, (i, k, 0), load(sums, (i, k, 0)) + chance * value)
        u = powers[n, 1] if powers.shape[1] > 1 else 0.0
        for k in range(dims):
            value = load(sums, (d, k, 0))
            for i in range(d - 1, -1, -1):
                value = value * u + load(sums, (i, k, 0))
            # Lane b is bin first + n + b here, and first + n - 1 + b next.
            value = moved_up(load(trail, (k, 0))) + value
            store(trail, (k, 0), value)
            mean[d, k, first + n + WIDTH - 1] += trail[k, WIDTH - 1]
    if far > 0:
        for k in range(dims):
            for b in range(WIDTH - 1):
                mean[d, k, first + b] += trail[k, b]


@inlined
def _expectations(
    x: F, cosine: F, sine: F, inverse: F, powers: F, half: F, bins: int, segments: F, wanted: I,
    dims: int, mean: F, noise: F, z: F, chances: F, scale: F, rotations: F, z_low: F,
) -> None:  # fmt: skip
    orders = len(wanted)
    pairs = dims * (dims + 1) // 2
    r = aligned(orders * pairs * WIDTH).reshape((orders, pairs, WIDTH))
    spread = aligned(orders * pairs * WIDTH).reshape((orders, pairs, WIDTH))
    rest, rest_low = aligned(2 * dims * WIDTH).reshape((2, dims, WIDTH))
    turned = aligned(WIDTH * WIDTH).reshape((WIDTH, WIDTH))
    exactly = len(z_low) > 0
    sums = aligned(orders * dims * WIDTH).reshape((orders, dims, WIDTH))
    trail = aligned(dims * WIDTH).reshape((dims, WIDTH))
    far = np.empty(orders, dtype=np.int64)
    mean[:] = 0.0
    spread[:] = 0.0
    for first in range(0, bins, WIDTH):
        _chances(segments, first, bins, wanted, chances, turned, far)
        z[0] = 0.0
        z_low[:1] = 0.0
        r[:] = 0.0
        upto = orders
        for n in range(far.max()):
            while far[upto - 1] <= n:
                upto -= 1  # no longer segments of the highest orders count
            if exactly:
                _append_all(
                    x, first + n, rotations, n, upto, z, z_low, n, n + 1, r, rest, rest_low
                )  # fmt: skip
            else:
                _append(x, first + n, cosine, sine, n, upto, z, n, n + 1, r, rest)
            weight = (n + 1) / (2.0 * half[n])
            for d in range(upto):
                if n < far[d]:
                    _noise_of_segments(r, d, n, weight, chances, dims, scale, spread)
        for d in range(orders):
            _mean_of_segments(
                inverse, powers, z, d, far[d], chances, first, dims, sums, trail, mean
            )  # fmt: skip
    for d in range(orders):
        q = 0
        for k in range(dims):
            for m in range(k + 1):
                noise[d, k, m] = total(load(spread, (d, q, 0))) / bins
                noise[d, m, k] = noise[d, k, m]
                q += 1


@kernel
def expectations(
    x: F, cosine: F, sine: F, inverse: F, powers: F, half: F, bins: int, segments: F, wanted: I,
    mean: F, noise: F, z: F, chances: F, scale: F, rotations: F, z_low: F,
) -> None:  # fmt: skip
    """Fill mean[d] (L, T + 8), averaged over segmentations, and noise[d] (L, L), over bins.

    x: (L, T + 8) whitened, 0 behind the last bin. segments: probabilities of segments, by
    segment or by order. wanted: (D,) whether an order is; the others become 0. The noise of a
    segment is the inverse of its expected precision. Behind bin T - 1 the mean is of no meaning.
    z: (W + 1, D, L, 8) and chances: (W, 8 G, 8) scratch. scale: (L,) V^-1 of x, all 1.
    With z_low like z, and not of no length, residuals have 32 digits (exact.py: rotations), and x
    and scale are in the data's unit.
    """
    # The compiler unrolls loops over dimensions where it knows their number.
    tables = (cosine, sine, inverse, powers, half)
    rest = (mean, noise, z, chances, scale, rotations, z_low)
    if x.shape[0] == 3:
        _expectations(x, *tables, bins, segments, wanted, 3, *rest)
    else:
        _expectations(x, *tables, bins, segments, wanted, x.shape[0], *rest)
