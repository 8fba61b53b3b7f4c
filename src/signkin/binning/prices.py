"""Compiled: sums over all segmentations of a stretch of a series, at a price of a segment.

Each segmentation counts as its evidence less the price of its segments, whatever their number k.
Lanes are prices, or angles t of the characteristic function of k, E exp(-i t k) with (2, G, 8) as
real and imaginary parts of 8 G angles: with those the number of segments is told afterwards.
evidence is (P, W), that of the segment of n bins from bin p of the stretch at [p, n - 1]. What it
is all for is said in stretches.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.binning.lanes import (
    WIDTH,
    aligned,
    exp,
    exp_in_place,
    larger,
    load,
    log,
    splat,
    store,
    total,
)
from signkin.jit import kernel

F = NDArray[np.float64]


@kernel
def sums_to_bins(evidence: F, known: int, price: F, turn: F, sums: F, waves: F) -> None:
    """Fill sums[q] and waves[q] of the ways to come to bin q, for q = known + 1..

    price: (8,). turn: (2, G, 8), exp(-i t). sums: (Q + 1, 8) logs of the sums over the ways.
    waves: (Q + 1, 2, G, 8), the mean of exp(-i t k) over them at the first price. Those of up to
    `known` bins are there: of 0 bins alone, or of as many as the longest segment has.
    """
    longest = evidence.shape[1]
    groups = turn.shape[1]
    parts = aligned(longest * WIDTH).reshape((longest, WIDTH))
    for q in range(known + 1, len(sums)):
        top = splat(-np.inf)
        for n in range(min(longest, q)):
            top = larger(top, load(sums, (q - 1 - n, 0)) + evidence[q - 1 - n, n])
        value = splat(0.0)
        for n in range(min(longest, q)):
            part = exp((load(sums, (q - 1 - n, 0)) + evidence[q - 1 - n, n]) - top)
            store(parts, (n, 0), part)
            value = value + part
        store(sums, (q, 0), (top + log(value)) - load(price, (0,)))
        all_ = 0.0
        for n in range(min(longest, q)):
            all_ += parts[n, 0]
        for g in range(groups):
            real, imaginary = splat(0.0), splat(0.0)
            for n in range(min(longest, q)):
                share = parts[n, 0] / all_
                real = real + share * load(waves, (q - 1 - n, 0, g, 0))
                imaginary = imaginary + share * load(waves, (q - 1 - n, 1, g, 0))
            c, s = load(turn, (0, g, 0)), load(turn, (1, g, 0))
            store(waves, (q, 0, g, 0), c * real - s * imaginary)
            store(waves, (q, 1, g, 0), c * imaginary + s * real)


@kernel
def segments_to_end(
    evidence: F, price: float, turn: F, share: F, sums: F, waves: F, ends: F, boundary: F,
    segments: F,
) -> None:  # fmt: skip
    """Fill segments[p, n - 1] with the probability of that segment, for all bins p of a stretch.

    share: (2, G, 8), what exp(-i t k) counts. sums: (Q + 1,) as before, Q bins being what the
    segments from these bins reach. waves: (P, 2, G, 8) of the bins themselves. ends: (Q + 1, 2, G,
    8), over the ways on from bin q; known from bin P on, filled before. boundary: (P,) filled with
    the probability that a segment starts with bin p.
    """
    rows, longest = evidence.shape
    groups = turn.shape[1]
    reach = len(sums) - 1
    weight = aligned(longest + WIDTH)
    near = aligned(2 * groups * WIDTH).reshape((2, groups, WIDTH))
    for p in range(rows - 1, -1, -1):
        length = min(longest, reach - p)
        base = sums[p] - price
        for n in range(length):
            weight[n] = (base + evidence[p, n]) - sums[p + 1 + n]
        exp_in_place(weight, length)
        here = splat(0.0)
        for g in range(groups):
            real, imaginary = splat(0.0), splat(0.0)
            for n in range(length):
                real = real + weight[n] * load(ends, (p + 1 + n, 0, g, 0))
                imaginary = imaginary + weight[n] * load(ends, (p + 1 + n, 1, g, 0))
            c, s = load(turn, (0, g, 0)), load(turn, (1, g, 0))
            a, b = load(share, (0, g, 0)), load(share, (1, g, 0))
            x, y = load(waves, (p, 0, g, 0)), load(waves, (p, 1, g, 0))
            # What the ways to p count, without their segment from p on, and with it.
            x, y = a * x - b * y, a * y + b * x
            store(near, (0, g, 0), c * x - s * y)
            store(near, (1, g, 0), c * y + s * x)
            u, v = c * real - s * imaginary, c * imaginary + s * real
            store(ends, (p, 0, g, 0), u)
            store(ends, (p, 1, g, 0), v)
            here = here + (x * u - y * v)
        boundary[p] = total(here)
        for n in range(length):
            sum_ = splat(0.0)
            for g in range(groups):
                sum_ = sum_ + load(near, (0, g, 0)) * load(ends, (p + 1 + n, 0, g, 0))
                sum_ = sum_ - load(near, (1, g, 0)) * load(ends, (p + 1 + n, 1, g, 0))
            segments[p, n] = weight[n] * total(sum_)
