"""Compiled: predicted boundaries paired with true ones, each at most once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.jit import helper, kernel

Floats = NDArray[np.float64]

MANY = 64  # events that are sorted at once rather than one by one


@kernel
def best_pairs(p: Floats, t: Floats, most: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the best order-keeping pairing of two sorted arrays."""
    n, m = len(p), len(t)
    count = np.zeros((n + 1, m + 1), dtype=np.int64)  # most pairs among the first i and j ...
    total = np.zeros((n + 1, m + 1))  # ... and their least total distance
    for i in range(1, n + 1):
        for j in range(1, m + 1):
            c, d = count[i - 1, j], total[i - 1, j]
            if count[i, j - 1] > c or (count[i, j - 1] == c and total[i, j - 1] < d):
                c, d = count[i, j - 1], total[i, j - 1]
            apart = abs(p[i - 1] - t[j - 1])
            if apart <= most:
                c2, d2 = count[i - 1, j - 1] + 1, total[i - 1, j - 1] + apart
                if c2 > c or (c2 == c and d2 < d):
                    c, d = c2, d2
            count[i, j], total[i, j] = c, d
    size = count[n, m]
    first, second = np.empty(size, dtype=np.int64), np.empty(size, dtype=np.int64)
    i, j, k = n, m, size
    while k > 0:
        if count[i - 1, j] == k and total[i - 1, j] == total[i, j]:
            i -= 1
        elif count[i, j - 1] == k and total[i, j - 1] == total[i, j]:
            j -= 1
        else:
            i, j, k = i - 1, j - 1, k - 1
            first[k], second[k] = i, j
    return first, second


@helper
def _hits_of_one(times: Floats, truth: Floats, most: float) -> int:
    """Return the pairs of one trajectory. times: put in order here. truth: in order."""
    if len(times) > MANY:
        times.sort()
    else:  # few, or nearly in order
        for i in range(1, len(times)):
            here, j = times[i], i
            while j > 0 and times[j - 1] > here:
                times[j] = times[j - 1]
                j -= 1
            times[j] = here
    hits = p = t = 0
    while p < len(times) and t < len(truth):
        if abs(times[p] - truth[t]) <= most:
            hits += 1
            p += 1
            t += 1
        elif times[p] < truth[t]:
            p += 1
        else:
            t += 1
    return hits


@kernel
def count_pairs(predicted: Floats, truth: Floats, most: float) -> int:
    """Return how many pairs `best_pairs` would make. predicted: put in order here."""
    return _hits_of_one(predicted, truth, most)


@kernel
def hits_of_many(
    times: Floats, events: NDArray[np.int64], truth: Floats, true: NDArray[np.int64], most: float
) -> NDArray[np.int64]:
    """Return how many pairs `best_pairs` would make of each of many trajectories.

    times, truth: those of all trajectories, one after the other. Only the number of pairs is
    wanted, and to give each boundary the earliest event still free makes the most.
    """
    hits = np.zeros(len(events), dtype=np.int64)
    a = b = 0
    for i in range(len(events)):
        own = times[a : a + events[i]].copy()
        hits[i] = _hits_of_one(own, truth[b : b + true[i]], most)
        a, b = a + events[i], b + true[i]
    return hits


@kernel
def shifted_counts(
    predicted: Floats, truth: Floats, most: float, duration_s: float, shifts_s: Floats
) -> Floats:
    """Return the pairs for each shift of predicted boundaries in a circle (shifted.py).

    predicted, truth: in order; shifted ones are so but for where they wrap around.
    """
    hits = np.empty(len(shifts_s))
    n = len(predicted)
    moved, own = np.empty(n), np.empty(n)
    for i in range(len(shifts_s)):
        wrapped = 0  # how many do, the last ones
        for k in range(n):
            moved[k] = (predicted[k] + shifts_s[i]) % duration_s
            if k > 0 and moved[k] < moved[k - 1]:
                wrapped = n - k
        for k in range(n):
            own[(k + wrapped) % n] = moved[k]
        hits[i] = _hits_of_one(own, truth, most)
    return hits
