"""All samples that print a mean and an SD, counted without listing them (the question of CLOSURE).

CLOSURE (R package unsum) lists every sorted sample of whole numbers on a scale that has a printed
mean, SD and n. The lists grow past millions; how many samples there are, and how often each value
stands in them, follows from counts alone. On a scale of few points the copies of three values
follow from those of the others; else samples are counted by (values taken, sum, sum of squares).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import comb, isqrt

import numpy as np
from numpy.typing import NDArray

from signkin.audit.whole import Pair

MOST_STATES = 14_000_000  # numbers of 8 bytes
MOST_ADDED = 60_000_000  # additions, about half a second
MOST_SOLVED = 8_000_000  # equations for three values, about half a second
MOST_COUNT = 2**62
Counts = NDArray[np.int64]


@dataclass(frozen=True)
class Counted:
    """How many samples there are, and how often each value stands in them.

    values: in grains. least, mean, most: of the copies of each value, over all samples (each
    sorted sample counts once).
    """

    samples: int
    values: tuple[int, ...]
    least: tuple[int, ...]
    mean: tuple[float, ...]
    most: tuple[int, ...]


def count_samples(
    n: int, pairs: Iterable[Pair], low: int | None = None, high: int | None = None
) -> Counted | None:
    """Count the sorted samples of n whole numbers in low..high with one of the given pairs.

    pairs: (sum, sum of squares), each once. None: too many to count.
    """
    wanted = list(pairs)
    if not wanted:
        return Counted(0, (), (), (), ())
    centre = round(wanted[0][0] / n)  # numbers near zero keep the squares small
    moved = [(s - n * centre, q - 2 * centre * s + n * centre * centre) for s, q in wanted]
    moved = [(s, q) for s, q in moved if q >= 0]
    if not moved:
        return Counted(0, (), (), (), ())
    squares = max(q for _, q in moved)
    # Part of a sample has a sum of at most sqrt(k q), and leaves as little to the rest.
    sums = isqrt(n * squares) // 2 + 1 + max(abs(s) for s, _ in moved)
    reach = isqrt(squares)
    bottom = -reach if low is None else max(-reach, low - centre)
    top = reach if high is None else min(reach, high - centre)
    values = range(bottom, top + 1)
    if not values:
        return Counted(0, (), (), (), ())
    if len(values) > 2 and comb(n + len(values) - 3, n) * len(moved) <= MOST_SOLVED:
        return _solved(n, moved, values, centre)
    states = (n + 1) * (squares + 1) * (2 * sums + 1)
    if states > MOST_STATES or states * len(values) > MOST_ADDED:
        return None
    if comb(n + len(values) - 1, n) > MOST_COUNT:
        return None
    return _shares(_table(n, squares, sums, values), n, moved, sums, values, centre)


def _solved(n: int, wanted: list[Pair], values: range, centre: int) -> Counted:
    """Try all copies of all values but three, whose copies three equations then give."""
    a, b, c = values[0], values[len(values) // 2], values[-1]
    free = [value for value in values if value not in (a, b, c)]
    copies, used = np.zeros((1, 0), dtype=np.int64), np.zeros(1, dtype=np.int64)
    for _ in free:
        options = n - used + 1
        first = np.repeat(np.cumsum(options) - options, options)
        more = np.arange(options.sum()) - first
        copies = np.column_stack([np.repeat(copies, options, axis=0), more])
        used = np.repeat(used, options) + more
    left = n - used
    by_sum, by_squares = (copies @ np.array([v**k for v in free], dtype=np.int64) for k in (1, 2))
    order = [values.index(v) for v in (*free, a, b, c)]
    total, added = 0, np.zeros(len(values))
    least, most = np.full(len(values), n), np.zeros(len(values), dtype=np.int64)
    for s, q in wanted:
        rest_s, rest_q = s - by_sum, q - by_squares
        kept = np.ones(len(left), dtype=bool)
        three = []
        for x, y, z in ((a, b, c), (b, a, c), (c, a, b)):
            found, odd = np.divmod(rest_q - (y + z) * rest_s + y * z * left, (x - y) * (x - z))
            kept &= (odd == 0) & (found >= 0)
            three.append(found)
        rows = np.column_stack([copies[kept], *(found[kept] for found in three)])
        if len(rows):
            total += len(rows)
            added[order] += rows.sum(axis=0)
            least[order] = np.minimum(least[order], rows.min(axis=0))
            most[order] = np.maximum(most[order], rows.max(axis=0))
    there = np.flatnonzero(most)
    return Counted(
        total, tuple(values[i] + centre for i in there), tuple(least[there].tolist()),
        tuple((added[there] / max(total, 1)).tolist()), tuple(most[there].tolist()),
    )  # fmt: skip


def _table(n: int, squares: int, sums: int, values: range) -> Counts:
    """Return [k, q, s + sums]: how many samples of k values have sum s and sum of squares q."""
    table = np.zeros((n + 1, squares + 1, 2 * sums + 1), dtype=np.int64)
    table[0, 0, sums] = 1
    width = 2 * sums + 1
    for value in values:
        q = value * value
        into = slice(max(0, value), width + min(0, value))
        out = slice(max(0, -value), width - max(0, value))
        for k in range(1, n + 1):
            table[k, q:, into] += table[k - 1, : squares + 1 - q, out]
    return table


def _shares(
    table: Counts, n: int, wanted: list[Pair], sums: int, values: range, centre: int
) -> Counted:
    s, q = (np.array(part, dtype=np.int64) for part in zip(*wanted, strict=True))
    total = int(table[n, q, s + sums].sum())
    if total == 0:
        return Counted(0, (), (), (), ())
    rows = []
    for value in values:
        at_least = [total]  # samples with so many copies of the value, or more
        for copies in range(1, n + 1):
            left_q, left_s = q - copies * value * value, s - copies * value + sums
            inside = (left_q >= 0) & (left_s >= 0) & (left_s <= 2 * sums)
            found = int(table[n - copies, left_q[inside], left_s[inside]].sum())
            if found == 0:
                break
            at_least.append(found)
        least = next(j for j, k in enumerate(at_least) if k > (*at_least, 0)[j + 1])
        mean = sum(at_least[1:]) / total
        rows.append((value + centre, least, mean, len(at_least) - 1))
    rows = [row for row in rows if row[3]]
    found_values, least_, mean_, most = zip(*rows, strict=True)
    return Counted(total, found_values, least_, mean_, most)
