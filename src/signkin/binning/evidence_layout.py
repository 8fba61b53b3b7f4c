"""How the evidence of segments lies in memory: by segment, or by order for the sums over orders."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.binning.lanes import WIDTH, load, store, transpose
from signkin.jit import inlined

F = NDArray[np.float64]


@inlined
def write_evidence(
    values: F, turned: F, orders: int, first: int, n: int, bins: int, out: F
) -> None:
    """Write the evidence of the segments of n + 1 bins from `first` on, by order or by segment.

    values: (orders or more, 8), a lane a start, filled up here with the highest order. turned:
    (8, 8), room to work in.
    """
    here = min(WIDTH, bins - first - n)
    if out.ndim == 4:
        groups = (orders - 1) // WIDTH + 1
        for d in range(orders, groups * WIDTH):
            store(values, (d, 0), load(values, (orders - 1, 0)))
        for g in range(groups):
            transpose(values, (WIDTH * g, 0), turned, (0, 0))
            for b in range(here):
                store(out, (g, first + b, n, 0), load(turned, (b, 0)))
    else:
        for d in range(orders):
            for b in range(here):
                out[d, first + b, n] = values[d, b]
