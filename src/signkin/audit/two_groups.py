"""t tests of two printed groups in closed form, every value that rounding allows included."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import gamma, inf, sqrt

from scipy import stats

from signkin.audit.summaries import Group, Range
from signkin.errors import SignkinError

TINY = 1e-12


@dataclass(frozen=True)
class TwoGroups:
    """What two groups give: t, df, p (two-sided), d (pooled SD) and Hedges' g.

    others: further standardised differences by their name (Glass's delta, the SDs' mean square).
    """

    t: Range
    df: Range
    p: Range
    d: Range
    g: Range
    others: tuple[tuple[str, Range], ...] = ()


def compare(of: Sequence[Group], equal_variances: bool) -> TwoGroups:
    """Return Student's t (equal_variances), or Welch's, of two groups with n > 1."""
    if len(of) != 2 or min(g.n for g in of) < 2:
        raise SignkinError(
            f"{len(of)} groups of {', '.join(str(g.n) for g in of)}",
            expected="two groups of two or more values",
        )
    a, b = of
    ends = [
        [float(a.mean.low - b.mean.high), float(a.mean.high - b.mean.low)],
        [float(a.ss.low) / (a.n - 1), float(a.ss.high) / (a.n - 1)],
        [float(b.ss.low) / (b.n - 1), float(b.ss.high) / (b.n - 1)],
    ]
    hand = (float(a.by_hand[0] - b.by_hand[0]), float(a.by_hand[1]) / (a.n - 1),
            float(b.by_hand[1]) / (b.n - 1))  # fmt: skip

    def pooled(v: float, w: float) -> float:
        return sqrt(((a.n - 1) * v + (b.n - 1) * w) / (a.n + b.n - 2))

    def error(v: float, w: float) -> float:
        if equal_variances:
            return pooled(v, w) * sqrt(1 / a.n + 1 / b.n)
        return sqrt(v / a.n + w / b.n)

    def df(v: float, w: float) -> float:
        if equal_variances or v + w == 0:
            return float(a.n + b.n - 2)
        x, y = v / a.n, w / b.n
        return (x + y) ** 2 / (x * x / (a.n - 1) + y * y / (b.n - 1))

    low, high = [error(ends[1][i], ends[2][i]) for i in (0, 1)]
    t = _over(ends[0], (low, high), hand[0], error(*hand[1:]))
    # df turns on the ratio of the variances alone and has one peak, n1 + n2 - 2.
    dfs = [df(v, w) for v in ends[1] for w in ends[2]]
    peak = a.n * (a.n - 1) / (b.n * (b.n - 1))
    if ends[1][0] <= peak * ends[2][1] and ends[1][1] >= peak * ends[2][0]:
        dfs.append(float(a.n + b.n - 2))
    degrees = Range(df(*hand[1:]), min(dfs) * (1 - TINY), max(dfs) * (1 + TINY))
    sizes = _sizes(t)
    p = Range(
        float(2 * stats.t.sf(abs(t.value), degrees.value)),
        float(2 * stats.t.sf(sizes[1], degrees.high)),
        float(2 * stats.t.sf(sizes[0], degrees.low)),
    )
    d = _over(ends[0], (pooled(ends[1][0], ends[2][0]), pooled(ends[1][1], ends[2][1])), hand[0],
              pooled(*hand[1:]))  # fmt: skip
    by = hedges(a.n + b.n - 2)
    others = [
        (f"Glass's delta, SD of group {i}",
         _over(ends[0], (sqrt(ends[i][0]), sqrt(ends[i][1])), hand[0], sqrt(hand[i])))
        for i in (1, 2)
    ]  # fmt: skip
    mean = [sqrt((v + w) / 2) for v, w in zip(ends[1], ends[2], strict=True)]
    by_mean = _over(ends[0], (mean[0], mean[1]), hand[0], sqrt(sum(hand[1:]) / 2))
    others.append(("d with the root of the mean variance", by_mean))
    return TwoGroups(t, degrees, p, d, Range(d.value * by, d.low * by, d.high * by), tuple(others))


def hedges(df: float) -> float:
    """Return Hedges' correction of d for small samples (exact, by the gamma function)."""
    if df > 300:
        return 1 - 3 / (4 * df - 1)
    return gamma(df / 2) / (sqrt(df / 2) * gamma((df - 1) / 2)) if df > 1 else 0.0


def _over(
    top: Sequence[float], below: tuple[float, float], hand: float, hand_below: float
) -> Range:
    """Divide an interval by one of numbers from zero on; what is divided by zero has no end."""

    def ratio(x: float, y: float) -> float:
        return x / y if y > 0 else (0.0 if x == 0 else inf if x > 0 else -inf)

    ends = [ratio(x, y) for x in top for y in below]
    return Range(ratio(hand, hand_below), _lower(min(ends)), -_lower(-max(ends)))


def _lower(x: float) -> float:
    return x if abs(x) == inf else x - TINY * max(1.0, abs(x))


def _sizes(t: Range) -> tuple[float, float]:
    least = 0.0 if t.low <= 0 <= t.high else min(abs(t.low), abs(t.high))
    return least, max(abs(t.low), abs(t.high))
