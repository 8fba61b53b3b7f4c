"""What follows from printed numbers of groups: totals, pooled SD, what a row leaves out, tests.

Each group is known by its n, mean and SD as printed, so what follows is an interval: every
value that rounding allows lies in it. With a grain (values in whole steps) the admissible sums
and sums of squares are enumerated first, which often leaves one value.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, stats

from signkin.audit.grim import grain_of, grim
from signkin.audit.grimmer import grimmer, times_of
from signkin.audit.rounding import Interval, allowed, count, exactly
from signkin.errors import SignkinError


@dataclass(frozen=True)
class Group:
    """A group as printed: its n, its mean, the sum of squares around it (divisor taken off).

    hand: mean and sum of squares that the printed digits themselves give; without them the
    middles of the intervals.
    """

    n: int
    mean: Interval
    ss: Interval
    hand: tuple[Fraction, Fraction] | None = None

    @property
    def by_hand(self) -> tuple[Fraction, Fraction]:
        """The mean and the sum of squares that a hand calculation starts from."""
        if self.hand is None or (self.mean.width == 0 and self.ss.width == 0):
            return self.mean.middle, self.ss.middle
        return self.hand


@dataclass(frozen=True)
class Range:
    """A number by hand from the printed digits, and the least and greatest that print allows."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        """`0.752 (0.751 to 0.753)`."""
        return f"{self.value:.6g} ({self.low:.6g} to {self.high:.6g})"

    @property
    def interval(self) -> str:
        """`0.751 to 0.753`."""
        return f"{self.low:.6g} to {self.high:.6g}"


def groups(
    n: Sequence[int | str],
    mean: Sequence[str],
    sd: Sequence[str],
    grain: str | None = None,
    rounding: str = "nearest",
    divisor: str = "n-1",
    spread: str = "sd",
) -> list[Group]:
    """Return groups from printed numbers; the SD of a single value must be 0 or empty.

    divisor: of the printed SD, `n-1` or `n`. spread: `sd`, or `se` where standard errors stand.
    """
    if not len(n) == len(mean) == len(sd):
        raise SignkinError(
            f"{len(n)} n, {len(mean)} means and {len(sd)} SDs", expected="as many of each"
        )
    return [_group(*row, grain, rounding, divisor, spread) for row in zip(n, mean, sd, strict=True)]


def _group(
    n: int | str, mean: str, sd: str, grain: str | None, rounding: str, divisor: str, of: str
) -> Group:
    size, hand = count(n), exactly(mean)
    middle = allowed(mean, rounding)
    if size == 1:
        if sd.strip() and exactly(sd) != 0:
            raise SignkinError(f"the SD {sd} of a single value", expected="0, or an empty cell")
        if grain is not None:
            fits = [k * grain_of(grain) for k in grim(mean, 1, grain, rounding).sums]
            middle = Interval(min(fits), max(fits)) if fits else middle
        return Group(1, middle, Interval(Fraction(0), Fraction(0)), (hand, Fraction(0)))
    spread = allowed(sd, rounding)
    if exactly(sd) < 0:
        raise SignkinError(f"the SD is {sd}", expected="a number from 0")
    times = times_of(size, divisor, of)
    ss = Interval(max(spread.low, Fraction(0)) ** 2 * times, spread.high**2 * times)
    at = (hand, exactly(sd) ** 2 * times)
    if grain is not None:
        found = grimmer(mean, sd, size, grain, divisor, rounding, spread=of)
        pairs = found.pairs.get(divisor, ())
        if pairs and found.complete:
            step = grain_of(grain)
            means = [Fraction(s) * step / size for s, _ in pairs]
            squares = [(q - Fraction(s * s, size)) * step**2 for s, q in pairs]
            return Group(size, Interval(min(means), max(means)),
                         Interval(min(squares), max(squares)), at)  # fmt: skip
    return Group(size, middle, ss, at)


def pooled_mean(of: Sequence[Group]) -> Interval:
    """Return the mean of all values of all groups."""
    total = sum((g.mean * g.n for g in of), Interval(Fraction(0), Fraction(0)))
    return total / sum(g.n for g in of)


def sums_of_squares(of: Sequence[Group]) -> tuple[Range, Range]:
    """Return the sums of squares between and within groups.

    Between: its root is a norm of the means, so moving each mean by at most h_i moves the root
    by at most sqrt(sum n_i h_i^2). The range may be a little too wide, never too narrow.
    """
    n = np.array([g.n for g in of], dtype=float)

    def root(means: list[Fraction]) -> float:
        values = np.array([float(m) for m in means])
        return float(np.sqrt(n @ (values - n @ values / n.sum()) ** 2))

    half = np.array([float(g.mean.width) / 2 for g in of])
    middle, hand = root([g.mean.middle for g in of]), root([g.by_hand[0] for g in of])
    reach = float(np.sqrt(n @ half**2))
    between = Range(hand**2, max(0.0, middle - reach) ** 2, (middle + reach) ** 2)
    ends = [float(sum((pick(g.ss) for g in of), Fraction(0))) for pick in _ENDS]
    within = float(sum((g.by_hand[1] for g in of), Fraction(0)))
    return between, Range(within, ends[0], ends[1])


_ENDS: tuple[Callable[[Interval], Fraction], ...] = (lambda i: i.low, lambda i: i.high)


def pooled_sd(of: Sequence[Group], divisor: str = "n-1") -> Range:
    """Return the SD of all values of all groups around their common mean."""
    between, within = sums_of_squares(of)
    n = sum(g.n for g in of)
    by = n - 1 if divisor == "n-1" else n
    if by < 1:
        raise SignkinError("one value in all", expected="two or more for an SD")
    sums = [getattr(between, e) + getattr(within, e) for e in ("value", "low", "high")]
    return Range(*(float(np.sqrt(s / by)) for s in sums))


def left_out(whole: Group, without: Group) -> tuple[Interval, Interval]:
    """Return the value that makes `without` from `whole`: by the sums, and by the squares."""
    if whole.n != without.n + 1:
        raise SignkinError(
            f"n = {whole.n} with and {without.n} without", expected="one value between them"
        )
    by_sum = whole.mean * whole.n - without.mean * without.n
    # Squares: Q = ss + n mean^2; the value's square is the difference.
    squares = (whole.ss + whole.mean**2 * whole.n) - (without.ss + without.mean**2 * without.n)
    roots = [Fraction(float(max(edge, Fraction(0))) ** 0.5) for edge in (squares.low, squares.high)]
    exact = by_sum.low == by_sum.high and squares.low == squares.high
    if exact and by_sum.low**2 == squares.low:
        return by_sum, Interval(abs(by_sum.low), abs(by_sum.low))
    return by_sum, Interval(min(roots), max(roots))


@dataclass(frozen=True)
class Test:
    """A test recomputed from summaries: statistic, degrees of freedom, p and an effect size."""

    name: str
    statistic: Range
    df1: float
    df2: Range
    p: Range
    effect: Range | None = None


def anova(of: Sequence[Group]) -> Test:
    """One-way analysis of variance from groups; the effect is eta squared."""
    k, n = len(of), sum(g.n for g in of)
    if k < 2 or n <= k:
        raise SignkinError(
            f"{k} groups with {n} values", expected="two groups or more, more values than groups"
        )
    between, within = sums_of_squares(of)
    df1, df2 = k - 1, n - k
    if within.low <= 0:
        raise SignkinError(
            "no spread within the groups", expected="SDs above 0 for an analysis of variance"
        )

    def ratio(b: float, w: float) -> float:
        return (b / df1) / (w / df2)

    f = Range(ratio(between.value, within.value), ratio(between.low, within.high),
              ratio(between.high, within.low))  # fmt: skip
    p = Range(*(float(stats.f.sf(x, df1, df2)) for x in (f.value, f.high, f.low)))
    eta = Range(
        between.value / (between.value + within.value),
        between.low / (between.low + within.high),
        between.high / (between.high + within.low),
    )
    return Test("one-way ANOVA", f, df1, Range(df2, df2, df2), p, eta)


def anova_from_summary(
    n: Sequence[int | str],
    mean: Sequence[str],
    sd: Sequence[str],
    grain: str | None = None,
    rounding: str = "nearest",
) -> Test:
    """One-way ANOVA from printed n, means and SDs (divisor n - 1), with what rounding allows.

    grain: the step of the values, where they have one (`0.01` for whole frames at 100 Hz).
    """
    return anova(groups(n, mean, sd, grain, rounding))


def welch(of: Sequence[Group]) -> Test:
    """Welch's analysis of variance (two groups: Welch's t, squared); each group wants n > 1."""
    _want_two(of)
    n = np.array([g.n for g in of], dtype=float)

    def parts(x: NDArray[np.float64]) -> tuple[float, float]:
        means, variances = x[: len(n)], x[len(n) :]
        weights = n / variances
        total = weights.sum()
        centre = weights @ means / total
        k = len(n)
        tail = float((((1 - weights / total) ** 2) / (n - 1)).sum())
        top = float(weights @ (means - centre) ** 2) / (k - 1)
        return top / (1 + 2 * (k - 2) / (k * k - 1) * tail), (k * k - 1) / (3 * tail)

    box, middle = _box(of)
    statistic = _searched(lambda x: parts(x)[0], middle, box)
    df2 = _searched(lambda x: parts(x)[1], middle, box)
    top = len(n) - 1
    corners = [float(stats.f.sf(f, top, df)) for f in (statistic.low, statistic.high)
               for df in (df2.low, df2.high)]  # fmt: skip
    hand = float(stats.f.sf(statistic.value, top, df2.value))
    p = Range(hand, min(hand, *corners), max(hand, *corners))
    return Test("Welch's ANOVA", statistic, len(n) - 1, df2, p)


def t_test(of: Sequence[Group], equal_variances: bool = False) -> Test:
    """Two-sided t of two groups, Welch's or pooled; the effect is Cohen's d (pooled SD)."""
    _want_two(of)
    if len(of) != 2:
        raise SignkinError(f"{len(of)} groups", expected="two for a t test")
    box, middle = _box(of)
    a, b = of[0].n, of[1].n

    def test(x: NDArray[np.float64]) -> tuple[float, float, float]:
        m, v = x[:2], x[2:]
        sds = np.sqrt(v)
        t, p = stats.ttest_ind_from_stats(m[0], sds[0], a, m[1], sds[1], b, equal_variances)
        return float(t), float(p), 0.0

    def df(x: NDArray[np.float64]) -> float:
        if equal_variances:
            return a + b - 2
        va, vb = x[2] / a, x[3] / b
        return float((va + vb) ** 2 / (va**2 / (a - 1) + vb**2 / (b - 1)))

    def d(x: NDArray[np.float64]) -> float:
        spread = ((a - 1) * x[2] + (b - 1) * x[3]) / (a + b - 2)
        return float((x[0] - x[1]) / np.sqrt(spread))

    return Test(
        "t test" if equal_variances else "Welch's t test",
        _searched(lambda x: test(x)[0], middle, box),
        1,
        _searched(df, middle, box),
        _searched(lambda x: test(x)[1], middle, box),
        _searched(d, middle, box),
    )


def welch_from_summary(
    n: Sequence[int | str], mean: Sequence[str], sd: Sequence[str], grain: str | None = None
) -> Test:
    """Welch's ANOVA from printed n, means and SDs."""
    return welch(groups(n, mean, sd, grain))


def t_from_summary(
    n: Sequence[int | str],
    mean: Sequence[str],
    sd: Sequence[str],
    grain: str | None = None,
    equal_variances: bool = False,
) -> Test:
    """Two-sided t test from printed n, means and SDs of two groups."""
    return t_test(groups(n, mean, sd, grain), equal_variances)


def _want_two(of: Sequence[Group]) -> None:
    small = [g.n for g in of if g.n < 2 or g.ss.low <= 0]
    if len(of) < 2 or small:
        raise SignkinError(
            "a group has one value or no spread", expected="two groups or more, each with an SD"
        )


def _box(of: Sequence[Group]) -> tuple[list[tuple[float, float]], NDArray[np.float64]]:
    box = [(float(g.mean.low), float(g.mean.high)) for g in of]
    box += [(float(g.ss.low) / (g.n - 1), float(g.ss.high) / (g.n - 1)) for g in of]
    hand = [float(g.by_hand[0]) for g in of]
    return box, np.array(hand + [float(g.by_hand[1]) / (g.n - 1) for g in of])


def _searched(
    function: Callable[[NDArray[np.float64]], float],
    middle: NDArray[np.float64],
    box: list[tuple[float, float]],
) -> Range:
    """Return a function's value at the printed digits and its least and greatest in the box.

    The boxes of rounding are small: up to twelve sides all corners are tried, else the corner
    that the slopes at the middle point to, refined from there.
    """
    value = function(middle)
    sides = [i for i, (low, high) in enumerate(box) if high > low]
    if not sides:
        return Range(value, value, value)
    found = [value, *(function(x) for x in _corners(box, middle, sides, function))]
    for sign in (1, -1):
        best = optimize.minimize(
            lambda x, sign=sign: sign * function(x), middle, bounds=box, method="L-BFGS-B"
        )
        found.append(sign * float(best.fun))
    return Range(value, min(found), max(found))


def _corners(
    box: list[tuple[float, float]],
    middle: NDArray[np.float64],
    sides: list[int],
    function: Callable[[NDArray[np.float64]], float],
) -> Iterator[NDArray[np.float64]]:
    if len(sides) <= 8:
        for ends in product((0, 1), repeat=len(sides)):
            x = middle.copy()
            for side, end in zip(sides, ends, strict=True):
                x[side] = box[side][end]
            yield x
        return
    slopes = []
    for side in sides:
        reached = []
        for end in (0, 1):
            x = middle.copy()
            x[side] = box[side][end]
            reached.append(function(x))
        slopes.append(reached[1] >= reached[0])
    for turn in (0, 1):
        x = middle.copy()
        for side, rising in zip(sides, slopes, strict=True):
            x[side] = box[side][int(rising) ^ turn]
        yield x


def chains(counts: dict[str, int], digits: int = 2) -> tuple[int, dict[str, tuple[int, int]]]:
    """Return the least number of unbroken chains of signs that such transitions come from.

    counts: transition type -> number; the first `digits` are the sign before, the others the
    sign after. In an unbroken chain each sign but the last is before a transition and each but
    the first after one, so a kind of sign that is before more often than after starts that
    many chains. Kinds that are linked to no such chain need one of their own.
    Also returns kind -> (times before, times after).
    """
    kinds: dict[str, tuple[int, int]] = {}
    links: dict[str, set[str]] = {}
    for kind, n in counts.items():
        first, second = kind[:digits], kind[digits:]
        before, after = kinds.get(first, (0, 0))
        kinds[first] = (before + n, after)
        before, after = kinds.get(second, (0, 0))
        kinds[second] = (before, after + n)
        if n:
            links.setdefault(first, set()).add(second)
            links.setdefault(second, set()).add(first)
    least, left = 0, set(links)
    while left:
        group: set[str] = set()
        open_ = [min(left)]
        while open_:
            kind = open_.pop()
            if kind not in group:
                group.add(kind)
                open_ += sorted(links[kind] - group)
        left -= group
        least += max(1, sum(max(0, kinds[k][0] - kinds[k][1]) for k in group))
    return least, dict(sorted(kinds.items()))
