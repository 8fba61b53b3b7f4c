"""Compiled: forward and backward through the tags of a recording (see tag_order.py).

Apart from its caller, so that numba is imported where it is wanted only.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.jit import kernel

Floats = NDArray[np.float64]
Whole = NDArray[np.int64]


@kernel
def _beside(
    mass: Floats, shift: int, theirs: Whole, ours: Whole, out: Floats, until: Floats
) -> None:
    """Fill out with the mass on frames before each, less what has our minimum.

    mass: (A, W), on frames that start `shift` before those of out, (A, W). until: (W + 1,), room
    for the mass on the first so many frames.
    """
    minima, width = mass.shape
    until[0] = 0.0
    for i in range(width):
        here = 0.0
        for b in range(minima):
            here += mass[b, i]
        until[i + 1] = until[i] + here
    for i in range(width):
        before = until[min(i + shift, width)]
        for a in range(minima):
            out[a, i] = before
    for b in range(minima):
        if theirs[b] < 0 or not (ours == theirs[b]).any():
            continue
        for i in range(width):
            until[i + 1] = until[i] + mass[b, i]
        for a in range(minima):
            if ours[a] == theirs[b]:
                for i in range(width):
                    out[a, i] -= until[min(i + shift, width)]
    for a in range(minima):
        for i in range(width):
            out[a, i] = max(out[a, i], 0.0)


@kernel
def forward_backward(weights: Floats, first: Whole, own: Whole) -> tuple[Floats, float]:
    """Return the probabilities (K, A, W) and the log of the sum, as `tag_order.in_order` does."""
    tags, minima, width = weights.shape
    forward, found = np.empty_like(weights), np.empty_like(weights)
    room, until = np.empty((minima, width)), np.empty(width + 1)
    log_sum = 0.0
    for k in range(tags):
        forward[k] = weights[k]
        if k > 0:
            _beside(forward[k - 1], first[k] - first[k - 1], own[k - 1], own[k], room, until)
            forward[k] *= room
        total = forward[k].sum()
        forward[k] /= total
        log_sum += np.log(total)
    backward, after = np.ones((minima, width)), np.empty((minima, width))
    for k in range(tags - 1, -1, -1):
        if k < tags - 1:
            for a in range(minima):
                for i in range(width):  # mirrored: the next boundary is the one before
                    after[a, width - 1 - i] = weights[k + 1, a, i] * backward[a, i]
            _beside(after, first[k + 1] - first[k], own[k + 1], own[k], room, until)
            highest = room.max()
            for a in range(minima):
                for i in range(width):
                    backward[a, i] = room[a, width - 1 - i] / highest
        found[k] = forward[k] * backward
        found[k] /= found[k].sum()
    return found, log_sum
