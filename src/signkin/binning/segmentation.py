"""Compiled: the most probable segmentation, and the number of segmentations."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from signkin.jit import kernel

F = NDArray[np.float64]


@kernel
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


@kernel
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
