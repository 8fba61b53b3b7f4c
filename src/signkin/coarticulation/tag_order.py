"""Boundaries that keep their order: exact forward-backward over all tags of a recording.

What is summed over is where each boundary is and which minimum of speed, if any, is its own.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def in_order(
    weights: Floats, first: NDArray[np.int64], own: NDArray[np.int64]
) -> tuple[Floats, float]:
    """Return where each of K boundaries is, given that each comes after the one before it.

    weights: (K, A, W), what is known of boundary k alone (prior times likelihood) on the frames
    first[k], first[k] + 1, ... of one grid, for each of A minima that may be its own. first: (K,),
    not falling. own: (K, A), which minimum that is; negative for none. Two boundaries never share
    a frame, and two in succession never a minimum.

    Returns the probabilities (K, A, W), with sum 1 for each boundary, and the log of the sum, over
    all boundaries in order, of the product of weights.
    """
    k_all = len(weights)
    forward, backward = np.empty_like(weights), np.ones_like(weights)
    log_sum = 0.0
    for k in range(k_all):
        forward[k] = weights[k]
        if k:
            shift = int(first[k] - first[k - 1])
            forward[k] *= _beside(forward[k - 1], shift, own[k - 1], own[k])
        total = forward[k].sum()
        forward[k] /= total
        log_sum += float(np.log(total))
    for k in range(k_all - 2, -1, -1):
        after = (weights[k + 1] * backward[k + 1])[:, ::-1]
        # Mirrored, the next boundary is the one before, and the shift is the same.
        shift = int(first[k + 1] - first[k])
        backward[k] = _beside(after, shift, own[k + 1], own[k])[:, ::-1]
        backward[k] /= backward[k].max()
    found = forward * backward
    return found / found.sum(axis=(1, 2), keepdims=True), log_sum


def _beside(mass: Floats, shift: int, theirs: NDArray[np.int64], ours: NDArray[np.int64]) -> Floats:
    """Return for each frame how much mass lies on frames before it, less what has our minimum.

    mass: (A, W), on frames that start `shift` before those of the result, (A, W).
    """
    until = np.zeros(mass.shape[1] + 1)  # until[i]: mass on the first i frames
    np.add.reduce(mass, axis=0).cumsum(out=until[1:])
    # Frame i has i + shift frames of theirs before it, or all of them.
    all_before = _moved(until, shift)
    out = np.repeat(all_before[None], len(ours), axis=0)
    for a, b in np.argwhere((ours[:, None] == theirs) & (ours[:, None] >= 0)):
        mass[b].cumsum(out=until[1:])
        out[a] -= _moved(until, shift)
    return np.maximum(out, 0.0, out=out)


def _moved(until: Floats, shift: int) -> Floats:
    """Return until[shift], until[shift + 1], ..., as many as frames; the last one repeated."""
    width = len(until) - 1
    out = np.full(width, until[-1])
    if shift < width:
        out[: width - shift] = until[shift:width]
    return out
