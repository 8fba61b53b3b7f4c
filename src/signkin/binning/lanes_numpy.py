"""Eight numbers at a time as arrays of NumPy: what lanes.py is with the JIT off.

Each function does what its namesake of lanes_llvm.py does, to the bit, and tells it more plainly.
+, -, *, / are NumPy's own. A place that leaves its row is an error here, and unchecked there.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

F = NDArray[np.float64]

WIDTH = 8  # lanes: of eight double numbers, 64 bytes, a line of a cache
ROUND = 6755399441055744.0  # 1.5 * 2**52: added, it leaves a whole number in the low bits
ROUND_BITS = 0x4338000000000000
SQRT_HALF_BITS = 0x3FE6A09E667F3BCD


def splat(x: float) -> Any:
    """Return lanes that are all x."""
    return np.full(WIDTH, x)


def larger(a: Any, b: Any) -> Any:
    """Return the larger of each pair of lanes."""
    return np.where(a > b, a, b)


def where_above(x: Any, limit: Any, value: Any, otherwise: Any) -> Any:
    """Return `value` in the lanes in which x is above the limit, `otherwise` in the others."""
    return np.where(x > limit, value, otherwise)


def any_above(x: Any, limit: Any) -> bool:
    """Return whether x is above the limit in some lane."""
    return bool((x > limit).any())


def total(x: Any) -> float:
    """Return the sum of the lanes, by halves: always in the same order."""
    while len(x) > 1:
        x = x[: len(x) // 2] + x[len(x) // 2 :]
    return float(x[0])


def moved_up(x: Any) -> Any:
    """Return each lane's neighbour below, and 0 in the first."""
    return np.concatenate([[0.0], x[:-1]])


def _lanes_at(array: F, place: tuple[int, ...], lines: int = 1) -> F:
    """Return a view of the eight elements from a place on, or of some lines of eight."""
    if lines > 1:
        first = int(np.ravel_multi_index(place, array.shape))
        return array.reshape(-1)[first : first + lines * WIDTH].reshape(lines, WIDTH)
    view: F = array[place[:-1]][place[-1] : place[-1] + WIDTH]
    if min(place) < 0 or len(view) != WIDTH:
        raise IndexError(f"lanes at {place} of an array of shape {array.shape}")
    return view


def load(array: F, place: tuple[int, ...]) -> Any:
    """Return eight elements of an array from `place`, a full index, along the last axis."""
    return _lanes_at(array, place).copy()


def store(array: F, place: tuple[int, ...], value: Any) -> None:
    """Write lanes to eight elements of an array from `place`, a full index, on."""
    _lanes_at(array, place)[:] = value


def transpose(source: F, at: tuple[int, ...], target: F, to: tuple[int, ...]) -> None:
    """Write the columns of the eight rows from `at` on to the eight rows from `to` on.

    Rows are of eight elements, one after the other in memory.
    """
    _lanes_at(target, to, WIDTH)[:] = _lanes_at(source, at, WIDTH).T.copy()


def _power(x: Any) -> NDArray[np.int64]:
    return (x.view(np.int64) - SQRT_HALF_BITS) >> 52


def mantissa(x: Any) -> Any:
    """Return x divided by the power of two that brings it to sqrt(1/2) .. sqrt(2)."""
    return (x.view(np.int64) - (_power(x) << 52)).view(np.float64)


def power_and_round(x: Any) -> Any:
    """Return the exponent of that power of two, plus ROUND."""
    return (_power(x) + ROUND_BITS).view(np.float64)


def two_to_the(k: Any) -> Any:
    """Return two to the power of k, whole numbers with ROUND added."""
    return ((k.view(np.int64) + 1023) << 52).view(np.float64)
