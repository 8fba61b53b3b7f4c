"""GRIMMER by exact enumeration: can n values on a grain have the printed mean and SD?

In whole grains a sample has a whole sum and a whole sum of squares, of the same parity. Every
pair that the print allows is tried for n whole numbers that have it, instead of the shortcuts
of the published tests, one of which accuses wrongly.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from math import ceil, floor, isqrt

import numpy as np

from signkin import seeds
from signkin.audit.findings import CONSISTENT, INCONSISTENT, UNDECIDABLE, Finding
from signkin.audit.grim import grain_of, grim
from signkin.audit.rounding import Interval, allowed, count, exactly, shown
from signkin.errors import SignkinError, listed

DIVISORS = ("n-1", "n")
MOST_STEPS = 200_000  # of a search for whole numbers; beyond it the answer is `undecidable`
MOST_PAIRS = 20_000
MOST_DEEP = 100  # numbers searched for one by one
Pair = tuple[int, int]


@dataclass(frozen=True)
class Grimmer(Finding):
    """A finding with the pairs (sum, sum of squares), in grains, for each divisor of the SD."""

    pairs: Mapping[str, tuple[Pair, ...]] = field(default_factory=dict)


class _Undecided(Exception):
    """The search took too long."""


def grimmer(
    mean: str,
    sd: str,
    n: int | str,
    grain: str = "1",
    divisor: str = "either",
    rounding: str = "nearest",
) -> Grimmer:
    """Say whether n multiples of `grain` can have the printed mean and standard deviation.

    divisor: `n-1`, `n` or `either`. A single value has no SD with n - 1: a printed 0 there is
    undecidable (a convention), anything else inconsistent.
    """
    if divisor not in (*DIVISORS, "either"):
        raise SignkinError(f"the divisor {divisor!r}", expected=listed((*DIVISORS, "either")))
    n = count(n)
    of_mean = grim(mean, n, grain, rounding)
    spread = allowed(sd, rounding)
    if spread.high < 0:
        raise SignkinError(f"the SD is {sd}", expected="a number from 0")
    if n == 1:
        return _single(sd, of_mean.sums)
    printed = f"{mean} ({sd})"
    if of_mean.verdict == INCONSISTENT:
        return Grimmer(INCONSISTENT, of_mean.why, printed, of_mean.recomputed, of_mean.interval)
    tried = DIVISORS if divisor == "either" else (divisor,)
    step = grain_of(grain)
    try:
        pairs = {
            d: tuple(pairs_allowed(n, of_mean.sums, spread, step, n - 1 if d == "n-1" else n))
            for d in tried
        }
    except _Undecided:
        why = f"more than {MOST_PAIRS} pairs of sum and sum of squares fit, or the search is long"
        return Grimmer(UNDECIDABLE, why, printed)
    fitting = [d for d in tried if pairs[d]]
    if not fitting:
        why = f"no {n} multiples of {grain} have mean {mean} and SD {sd} with divisor "
        return Grimmer(INCONSISTENT, why + " or ".join(tried), printed, pairs=pairs)
    d = fitting[0]
    found = pairs[d]
    told = f"sum {found[0][0]}, sum of squares {found[0][1]}"
    why = (
        f"in grains of {grain}: {told}"
        if len(found) == 1
        else f"{len(found)} pairs of sum and sum of squares fit"
    ) + f", divisor {' or '.join(fitting)}"
    sds = [float(sd_of(pair, n, d) * step.numerator / step.denominator) for pair in found]
    recomputed = f"{shown(Fraction(found[0][0]) * step / n)} ({min(sds):.6g}"
    recomputed += ")" if len(found) == 1 else f" to {max(sds):.6g})"
    return Grimmer(CONSISTENT, why, printed, recomputed, str(spread), pairs=pairs)


def _single(sd: str, sums: tuple[int, ...]) -> Grimmer:
    pairs = {"n": tuple((s, s * s) for s in sums)}
    if exactly(sd) == 0:
        why = "a single value has no SD with divisor n - 1; the printed 0 is a convention"
        return Grimmer(UNDECIDABLE, why, sd, pairs=pairs)
    return Grimmer(INCONSISTENT, f"a single value has no SD, and {sd} is printed", sd)


def sd_of(pair: Pair, n: int, divisor: str = "n-1") -> float:
    """Return the SD, in grains, of n values with a sum and sum of squares."""
    total, squares = pair
    ss = Fraction(squares) - Fraction(total * total, n)
    return float(ss / (n - 1 if divisor == "n-1" else n)) ** 0.5


def pairs_allowed(
    n: int, sums: tuple[int, ...], sd: Interval, step: Fraction, divisor: int
) -> Iterator[Pair]:
    """Yield (sum, sum of squares) that n whole numbers can have and the print allows."""
    low = max(sd.low, Fraction(0)) / step
    high = sd.high / step
    seen = 0
    for total in sums:
        base = Fraction(total * total, n)
        first, last = ceil(low**2 * divisor + base), floor(high**2 * divisor + base)
        for squares in range(first, last + 1):
            ss = squares - base
            if sd.low_open and sd.low >= 0 and ss == low**2 * divisor:
                continue
            if sd.high_open and ss == high**2 * divisor:
                continue
            if squares % 2 == total % 2 and exists(n, total, squares):
                seen += 1
                if seen > MOST_PAIRS:
                    raise _Undecided
                yield total, squares


def exists(
    n: int, total: int, squares: int, low: int | None = None, high: int | None = None
) -> bool:
    """Whether n whole numbers (in low..high, where given) have a sum and a sum of squares.

    Raises _Undecided after MOST_STEPS steps; `possible` turns that into None.
    """
    if n > MOST_DEEP:
        # Beside numbers at the mean, so many are enough for any spread that there is.
        shift = total // n
        ones = total - n * shift
        inside = min(ones, MOST_DEEP)
        q = squares - 2 * shift * total + n * shift * shift - (ones - inside)
        edges = [None if edge is None else edge - shift for edge in (low, high)]
        room = (edges[0] or 0) <= 0 and (edges[1] is None or edges[1] >= 1) and q >= 0
        if room and next(_multisets(MOST_DEEP, inside, q, edges[0], edges[1]), None) is not None:
            return True
        if squares % 2 != total % 2 or n * squares < total * total or q < inside:
            return False
        raise _Undecided
    return next(_multisets(n, total, squares, low, high), None) is not None


def possible(
    n: int, total: int, squares: int, low: int | None = None, high: int | None = None
) -> bool | None:
    """Return `exists`, or None where the search would be too long."""
    try:
        return exists(n, total, squares, low, high)
    except _Undecided:
        return None


def _multisets(
    n: int, total: int, squares: int, low: int | None, high: int | None
) -> Iterator[tuple[int, ...]]:
    """Yield all falling sequences of n whole numbers with a sum and a sum of squares.

    Moved to a mean near zero first, which keeps the numbers small.
    """
    shift = total // n
    moved = total - n * shift
    moved_squares = squares - 2 * shift * total + n * shift * shift
    reach = isqrt(max(moved_squares, 0))
    bottom = -reach if low is None else max(low - shift, -reach)
    top = reach if high is None else min(high - shift, reach)
    steps = [0]
    dead: set[tuple[int, int, int, int]] = set()

    def search(k: int, s: int, q: int, most: int) -> Iterator[tuple[int, ...]]:
        # k numbers left, none above `most`, with sum s and squares q.
        if k * q < s * s or (q - s) % 2 or s > k * most or s < k * bottom:
            return
        if k == 1:
            if s * s == q and bottom <= s <= most:
                yield (s,)
            return
        if k == 2:
            root = isqrt(2 * q - s * s)
            if root * root == 2 * q - s * s and (s + root) % 2 == 0:
                larger, smaller = (s + root) // 2, (s - root) // 2
                if larger <= most and smaller >= bottom:
                    yield (larger, smaller)
            return
        state = (k, s, q, most)
        if state in dead:
            return
        found = False
        # The largest number is at least the mean, and no farther from it than the spread allows.
        spread = isqrt((k - 1) * (k * q - s * s)) // k + 1
        first = min(most, floor(Fraction(s, k)) + spread + 1, isqrt(q))
        last = max(ceil(Fraction(s, k)), bottom)
        for value in range(first, last - 1, -1):
            steps[0] += 1
            if steps[0] > MOST_STEPS:
                raise _Undecided
            for rest in search(k - 1, s - value, q - value * value, value):
                found = True
                yield (value, *rest)
        if not found:
            dead.add(state)

    if moved_squares >= 0 and bottom <= top:
        for values in search(n, moved, moved_squares, top):
            yield tuple(value + shift for value in values)


@dataclass(frozen=True)
class Samples:
    """Samples that fit a print, in grains, each sorted; all of them, or some drawn at random."""

    values: tuple[tuple[int, ...], ...]
    complete: bool
    grain: str

    def in_units(self) -> list[list[float]]:
        """Return the samples in the unit of the print."""
        step = exactly(self.grain)
        return [[float(v * step) for v in sample] for sample in self.values]


def samples(
    mean: str,
    sd: str,
    n: int | str,
    grain: str = "1",
    low: str | None = None,
    high: str | None = None,
    divisor: str = "n-1",
    most: int = 1000,
    seed: int = 0,
    rounding: str = "nearest",
) -> Samples:
    """Return samples of n multiples of `grain` in low..high that print this mean and SD.

    All of them (as sorted samples) where there are at most `most`; else `most` draws of a
    random walk with a seed: it redraws three values at a time among all triples with the same
    sum and sum of squares, which favours no sample that it can reach.
    """
    n = count(n)
    step = grain_of(grain)
    bottom = None if low is None else ceil(exactly(low) / step)
    top = None if high is None else floor(exactly(high) / step)
    pairs = grimmer(mean, sd, n, grain, divisor, rounding).pairs.get(divisor, ())
    if n == 1:
        kept = [s for s in grim(mean, 1, grain, rounding).sums if _inside(s, bottom, top)]
        return Samples(tuple((s,) for s in kept), True, grain)
    found: list[tuple[int, ...]] = []
    starts: list[tuple[int, ...]] = []
    complete = True
    for total, squares in pairs:
        before = len(found)
        try:
            for values in _multisets(n, total, squares, bottom, top):
                found.append(tuple(sorted(values)))
                if len(found) > most:
                    complete = False
                    break
        except _Undecided:
            complete = False
        starts += found[before : before + 1]
        if len(found) > most:
            break
    if complete:
        return Samples(tuple(sorted(found)), True, grain)
    if not starts:
        raise SignkinError(
            f"the search for {n} values with mean {mean} and SD {sd} is too long",
            expected="a smaller n or SD, or a range of the values",
        )
    rng = seeds.stream(seed, "samples", mean, sd, str(n), grain)
    drawn = _walk(starts, bottom, top, most, rng)
    return Samples(tuple(drawn), False, grain)


def _inside(value: int, low: int | None, high: int | None) -> bool:
    return (low is None or value >= low) and (high is None or value <= high)


def _walk(
    starts: list[tuple[int, ...]],
    low: int | None,
    high: int | None,
    draws: int,
    rng: np.random.Generator,
) -> Iterator[tuple[int, ...]]:
    n = len(starts[0])
    current = [list(start) for start in starts]
    for draw in range(draws):
        values = current[draw % len(current)]
        for _ in range(2 * n):
            at = rng.choice(n, size=3, replace=False)
            s = sum(values[i] for i in at)
            q = sum(values[i] ** 2 for i in at)
            options = [t for t in _triples(s, q) if all(_inside(v, low, high) for v in t)]
            for i, v in zip(at, options[int(rng.integers(len(options)))], strict=True):
                values[i] = v
        yield tuple(sorted(values))


@lru_cache(maxsize=4096)
def _triples(s: int, q: int) -> tuple[tuple[int, int, int], ...]:
    """Return all ordered triples of whole numbers with a sum and a sum of squares."""
    out = []
    spread = isqrt(max(0, 2 * (3 * q - s * s))) // 3 + 1
    for a in range(s // 3 - spread - 1, s // 3 + spread + 2):
        rest, squares = s - a, q - a * a
        square = 2 * squares - rest * rest
        if square < 0:
            continue
        root = isqrt(square)
        if root * root == square and (rest + root) % 2 == 0:
            b, c = (rest + root) // 2, (rest - root) // 2
            out += [(a, b, c)] if b == c else [(a, b, c), (a, c, b)]
    return tuple(out)
