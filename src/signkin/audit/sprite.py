"""Samples that print a mean and an SD, made one by one (after SPRITE, Heathers et al. 2018).

Numbers are drawn with about the printed mean and SD, and then moved, two at a time and against
each other, which keeps the sum, until the sum of squares is one that the print allows. A sample
that is found is a proof; samples so found are possible ones, not likely ones, and none need be
like the data.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from signkin.audit.whole import Steps, TooLong, bounds_of, most_squares, multisets

MOST_ROUNDS = 400
FEW = 40  # so few numbers are searched one by one where moving them does not do
Ints = NDArray[np.int64]


def draw_samples(
    n: int, sums: Sequence[int], squares_of: Callable[[int], range], low: int | None,
    high: int | None, draws: int, rng: np.random.Generator,
) -> list[Ints]:  # fmt: skip
    """Return up to `draws` samples of n whole numbers in low..high, each sorted; perhaps none.

    sums, squares_of: what the print allows of the sum, and of the sum of squares beside a sum.
    """
    possible = [
        (total, squares) for total in sums[:: max(1, len(sums) // 200)]
        if len(squares := _squares(n, total, squares_of(total), low, high))
    ]  # fmt: skip
    out: list[Ints] = []
    for _ in range(draws if possible else 0):
        total, squares = possible[int(rng.integers(len(possible)))]
        found = _moved(n, total, squares, low, high, rng)
        if found is not None:
            out.append(np.sort(found))
    return out or _searched(n, possible, low, high)


def _squares(n: int, total: int, squares: range, low: int | None, high: int | None) -> range:
    if not squares or low is None or high is None:
        return squares
    if not n * low <= total <= n * high:
        return range(0)
    return squares[: max(0, (most_squares(n, total, low, high) - squares[0]) // 2 + 1)]


def _searched(
    n: int, possible: Sequence[tuple[int, range]], low: int | None, high: int | None
) -> list[Ints]:
    if n > FEW:
        return []
    steps = Steps()
    try:
        for total, squares in possible:
            for each in squares:
                found = next(multisets(n, total, each, low, high, steps), None)
                if found is not None:
                    return [np.sort(np.array(found, dtype=np.int64))]
    except TooLong:
        pass
    return []


def _moved(
    n: int, total: int, squares: range, low: int | None, high: int | None,
    rng: np.random.Generator,
) -> Ints | None:  # fmt: skip
    wanted = squares[int(rng.integers(len(squares)))]
    bottom, top, _ = bounds_of(n, total, wanted, low, high)
    mean = total / n
    sd = max(0.0, wanted / n - mean * mean) ** 0.5
    x = np.rint(_start(n, mean, sd, bottom, top, rng)).astype(np.int64).clip(bottom, top)
    for _ in range(MOST_ROUNDS):
        left = total - int(x.sum())
        if left == 0:
            break
        free = np.flatnonzero(x < top if left > 0 else x > bottom)
        at = rng.permutation(free)[: abs(left)]
        x[at] += 1 if left > 0 else -1
    else:
        return None
    for _ in range(MOST_ROUNDS):
        left = wanted - int((x * x).sum())
        if left == 0 or wanted - left in squares:
            return x
        if not _step(x, left, bottom, top, rng):
            return None
    return None


def _start(
    n: int, mean: float, sd: float, bottom: int, top: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Draw numbers with about a mean and an SD: a beta within bounds, else a normal."""
    width = top - bottom
    share = (mean - bottom) / width if width else 0.0
    room = share * (1 - share) * width * width
    if 0 < sd * sd < room:
        both = room / (sd * sd) - 1
        if both < 1e4:
            return bottom + width * rng.beta(share * both, (1 - share) * both, n)
    return mean + sd * rng.standard_normal(n)


def _step(x: Ints, left: int, bottom: int, top: int, rng: np.random.Generator) -> bool:
    """Move pairs of numbers by one against each other, never past what is left; in place.

    Apart, a pair d apart adds 2 d + 2 to the sum of squares; together, it takes 2 d - 2 off.
    """
    order = rng.permutation(len(x))
    half = len(x) // 2
    first, second = order[:half], order[half : 2 * half]
    lower = np.where(x[first] <= x[second], first, second)
    upper = np.where(x[first] <= x[second], second, first)
    apart = x[upper] - x[lower]
    if left > 0:
        changes, may = 2 * apart + 2, (x[lower] > bottom) & (x[upper] < top)
    else:
        changes, may = 2 * apart - 2, apart > 1
    may &= changes <= abs(left)
    lower, upper, changes = lower[may], upper[may], changes[may]
    kept = np.cumsum(changes) <= abs(left)
    if not kept.any():
        return _last_step(x, left, bottom, top)
    sign = 1 if left > 0 else -1
    x[lower[kept]] -= sign
    x[upper[kept]] += sign
    return True


def _last_step(x: Ints, left: int, bottom: int, top: int) -> bool:
    """Move one pair: the two values whose change comes nearest to what is left."""
    values, copies = np.unique(x, return_counts=True)
    gaps = values[None, :] - values[:, None]
    if left > 0:
        changes = 2 * gaps + 2
        may = (gaps >= 0) & (values[:, None] > bottom) & (values[None, :] < top)
        may &= (gaps > 0) | (copies > 1)[:, None]
    else:
        changes, may = 2 * gaps - 2, gaps > 1
    may &= changes <= abs(left)
    if not may.any():
        return False
    i, j = np.unravel_index(np.argmax(np.where(may, changes, -1)), may.shape)
    sign = 1 if left > 0 else -1
    lower = int(np.flatnonzero(x == values[i])[0])
    upper = int(np.flatnonzero(x == values[j])[-1])
    x[lower] -= sign
    x[upper] += sign
    return True
