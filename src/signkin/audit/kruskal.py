"""The Kruskal-Wallis test of small groups: its exact distribution, and how far it can go."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import permutations
from math import factorial, prod

import numpy as np
from scipy import stats

from signkin.audit.rounding import allowed, count, exactly
from signkin.audit.summaries import Range
from signkin.errors import SignkinError

MOST_STATES = 40_000  # of the exact distribution; larger designs have chi-squared


def _h(sums: Sequence[int], sizes: Sequence[int]) -> float:
    n = sum(sizes)
    squares = sum(r * r / k for r, k in zip(sums, sizes, strict=True))
    return 12 / (n * (n + 1)) * squares - 3 * (n + 1)


@lru_cache(maxsize=64)
def exact_distribution(sizes: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray] | None:
    """Return (H, its probability) over all orders of the ranks, none shared; None: too many.

    Ranks are dealt out one after the other; what counts is how many each group has, and their sum.
    """
    k = len(sizes)
    states: dict[tuple[tuple[int, ...], tuple[int, ...]], int] = {((0,) * k, (0,) * k): 1}
    for rank in range(1, sum(sizes) + 1):
        after: dict[tuple[tuple[int, ...], tuple[int, ...]], int] = {}
        for (held, sums), ways in states.items():
            for i in range(k):
                if held[i] < sizes[i]:
                    key = (
                        (*held[:i], held[i] + 1, *held[i + 1 :]),
                        (*sums[:i], sums[i] + rank, *sums[i + 1 :]),
                    )
                    after[key] = after.get(key, 0) + ways
        states = after
        if len(states) > MOST_STATES // k:
            return None
    total = factorial(sum(sizes)) // prod(factorial(s) for s in sizes)
    h = np.array([_h(sums, sizes) for _, sums in states])
    weight = np.array([float(ways) / total for ways in states.values()])
    return h, weight


def exact_tail(statistic: str, groups: Sequence[int | str], rounding: str = "nearest") -> Range:
    """Return the exact p of a printed H (ranks not shared), or a range of 0 to 1 if too many."""
    sizes = tuple(sorted(count(g) for g in groups))
    if len(sizes) < 2:
        raise SignkinError(f"{len(sizes)} groups", expected="two or more")
    found = exact_distribution(sizes) if sum(sizes) <= 25 else None
    if found is None:
        value = float(stats.chi2.sf(float(exactly(statistic)), len(sizes) - 1))
        return Range(value, value, value)
    h, weight = found
    values = allowed(statistic, rounding)

    def tail(x: float) -> float:
        return float(weight[h >= x - 1e-9].sum())

    return Range(tail(float(exactly(statistic))), tail(float(values.high)), tail(float(values.low)))


def kruskal_limit(n: Sequence[int]) -> tuple[float, float]:
    """Return the greatest H, and its p, that groups of n can reach (no rank shared).

    All values of one group above all of the next: no data of this design have a smaller p.
    Up to six groups all orders of them are tried; more must be of one size. The p is that of
    chi-squared.
    """
    sizes = np.array(sorted(n), dtype=float)
    total = sizes.sum()
    best = 0.0
    if len(sizes) > 6 and sizes.min() < sizes.max():
        raise SignkinError(f"{len(sizes)} groups of unlike size", expected="six, or one size")
    orders: Iterable[Sequence[float]] = permutations(sizes) if len(sizes) <= 6 else [tuple(sizes)]
    for order in orders:
        ends = np.cumsum(order)
        means = ends - (np.asarray(order) - 1) / 2
        h = 12 / (total * (total + 1)) * float(np.asarray(order) @ means**2) - 3 * (total + 1)
        best = max(best, h)
    return best, float(stats.chi2.sf(best, len(sizes) - 1))


def least_exact_p(n: Sequence[int]) -> float | None:
    """Return the least exact p that groups of n can reach; None where they are too many."""
    found = exact_distribution(tuple(sorted(n))) if sum(n) <= 25 else None
    if found is None:
        return None
    h, weight = found
    return float(weight[h >= h.max() - 1e-9].sum())
