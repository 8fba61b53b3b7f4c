"""Samples that a printed number, mean and standard deviation allow (Naert et al. 2017, Table 2).

In whole frames, a row's sum and sum of squares follow from its print; durations
that have them are found by moving pairs of values apart or together.
"""

from __future__ import annotations

from decimal import Decimal
from math import ceil, floor

import numpy as np

from signkin.errors import SignkinError

MOST_MOVES = 200_000


def sums_from_print(n: int, mean: str, sd: str, grain: str) -> tuple[int, int]:
    """Return sum and sum of squares, in grains, of n values with a printed mean and SD (n - 1).

    mean, sd: as printed; grain: the step of the values (`0.01` for frames at 100 Hz).
    Raises SignkinError where the print allows none, or more than one.
    """
    step = Decimal(grain)
    low, high = _bounds(mean)
    sums = range(ceil(low * n / step), floor(high * n / step) + 1)
    found = []
    for total in sums:
        if n == 1:
            found.append((total, total * total))
            continue
        sd_low, sd_high = _bounds(sd)
        base = Decimal(total * total) / n
        first = ceil((sd_low / step) ** 2 * (n - 1) + base)
        last = floor((sd_high / step) ** 2 * (n - 1) + base)
        # A sum of integers and the sum of their squares are both even or both odd.
        found += [
            (total, squares) for squares in range(first, last + 1) if squares % 2 == total % 2
        ]
    if len(found) != 1:
        raise SignkinError(
            f"n = {n}, mean {mean}, SD {sd} allow {len(found)} pairs of sum and sum of squares",
            place="printed row",
            expected="one pair",
        )
    return found[0]


def _bounds(printed: str) -> tuple[Decimal, Decimal]:
    value = Decimal(printed)
    exponent = value.as_tuple().exponent
    assert isinstance(exponent, int)
    half = Decimal(5).scaleb(exponent - 1)
    return value - half, value + half


def integers_with(
    n: int, total: int, squares: int, low: int, high: int, rng: np.random.Generator
) -> list[int]:
    """Return n integers in [low, high] with a given sum and sum of squares, at random.

    Starts from values as equal as can be and moves random pairs, keeping the sum, towards the
    sum of squares. Raises SignkinError where none are found.
    """
    values = np.full(n, total // n)
    values[: total - int(values.sum())] += 1
    for _ in range(MOST_MOVES):
        missing = squares - int((values**2).sum())
        if missing == 0:
            return [int(v) for v in rng.permutation(values)]
        i, j = rng.choice(n, size=2, replace=False)
        step = int(rng.integers(1, 4))
        after = values[[i, j]] + (step, -step)
        if after.min() < low or after.max() > high:
            continue
        change = int((after**2).sum() - (values[[i, j]] ** 2).sum())
        # Mostly towards the goal; now and then away from it, to leave dead ends.
        if abs(missing - change) < abs(missing) or rng.random() < 0.05:
            values[[i, j]] = after
    raise SignkinError(
        f"no {n} integers in {low}..{high} with sum {total} and sum of squares {squares} found",
        place="printed row",
        expected="a row that such values can have",
    )
