"""Compiled: the largest local maxima of a boundary posterior, with room between them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from signkin.jit import kernel

CLEARANCE_BINS = 3
DIGITS_2 = 30  # binary digits, nine decimal ones, to which probabilities are compared


def greedy_maxima(probability: ArrayLike, count: int) -> NDArray[np.int64]:
    """Return the places of up to `count` largest local maxima, 3 bins cleared around each.

    Values that agree to 9 digits are taken for the same, and the first goes first: where every
    bin is a boundary, the order would otherwise be that of rounding.
    """
    given = np.array(probability, dtype=float)  # a copy: one kind of array, one compilation
    found = _greedy(given, int(count), CLEARANCE_BINS, DIGITS_2)
    return np.asarray(found, dtype=np.int64)


@kernel
def _greedy(
    probability: NDArray[np.float64], count: int, clearance: int, digits: int
) -> NDArray[np.int64]:
    """Return the places in order. probability: (N,), rounded here to so many binary digits."""
    n = len(probability)
    left = np.empty(n)
    for i in range(n):
        exponent = math.frexp(probability[i])[1]
        left[i] = math.ldexp(
            np.rint(math.ldexp(probability[i], digits - exponent)), exponent - digits
        )
    peak = np.zeros(n, dtype=np.bool_)
    for i in range(n):
        rises = i == 0 or left[i] >= left[i - 1]
        peak[i] = rises and (i == n - 1 or left[i] >= left[i + 1]) and left[i] > 0
    places = np.flatnonzero(peak)
    taken = np.zeros(n, dtype=np.bool_)
    cleared = np.zeros(n, dtype=np.bool_)
    room = count
    for place in places[np.argsort(-left[places], kind="mergesort")]:  # stable
        if room == 0:
            break
        if not cleared[place]:
            taken[place] = True
            room -= 1
            cleared[max(0, place - clearance) : place + clearance + 1] = True
    return np.flatnonzero(taken)
