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
    from signkin.coarticulation.tag_order_kernel import forward_backward

    found, log_sum = forward_backward(
        np.ascontiguousarray(weights, dtype=np.float64),
        np.ascontiguousarray(first, dtype=np.int64),
        np.ascontiguousarray(own, dtype=np.int64),
    )
    return found, float(log_sum)
