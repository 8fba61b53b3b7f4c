"""p from statistics and back, the power of a design, and how far a design can go.

A printed statistic is an interval, and so is its p; a printed p may be `<0.001`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import permutations

import numpy as np
from scipy import optimize, stats

from signkin.audit.findings import CONSISTENT, INCONSISTENT, Finding
from signkin.audit.rounding import allowed, exactly, number
from signkin.audit.summaries import Range
from signkin.errors import SignkinError, listed

KINDS = ("F", "t", "chi2", "H", "z")


def _sf(kind: str, statistic: float, df: Sequence[float]) -> float:
    wanted = {"F": 2, "t": 1, "chi2": 1, "H": 1, "z": 0}
    if kind not in wanted:
        raise SignkinError(f"the statistic {kind!r}", expected=listed(KINDS))
    if len(df) != wanted[kind] or any(d <= 0 for d in df):
        raise SignkinError(
            f"degrees of freedom {list(df)} for {kind}", expected=f"{wanted[kind]}, above 0"
        )
    if kind == "F":
        return float(stats.f.sf(statistic, *df))
    if kind in ("chi2", "H"):  # H of Kruskal and Wallis is about chi-squared
        return float(stats.chi2.sf(statistic, *df))
    two = stats.t.sf(abs(statistic), *df) if kind == "t" else stats.norm.sf(abs(statistic))
    return float(2 * two)


def p_from(kind: str, statistic: str, *df: float, rounding: str = "nearest") -> Range:
    """Return the (two-sided) p of a printed statistic, with what its rounding allows.

    kind: F (two degrees of freedom), t, chi2, H (Kruskal-Wallis), or z (none).
    """
    values = abs(allowed(statistic, rounding)) if kind in ("t", "z") else allowed(statistic)
    p = [
        _sf(kind, float(x), df) for x in (values.middle, values.high, max(values.low, Fraction(0)))
    ]
    return Range(*p)


def statistic_from(kind: str, p: str, *df: float, rounding: str = "nearest") -> Range:
    """Return the statistic (its size) that a printed p belongs to."""
    values = allowed(p, rounding)

    def back(p: float) -> float:
        p = min(max(p, 1e-300), 1 - 1e-15)
        if kind == "F":
            return float(stats.f.isf(p, *df))
        if kind in ("chi2", "H"):
            return float(stats.chi2.isf(p, *df))
        return float(stats.t.isf(p / 2, *df) if kind == "t" else stats.norm.isf(p / 2))

    _sf(kind, 1.0, df)
    return Range(*(back(float(v)) for v in (values.middle, values.high, values.low)))


def p_agrees(
    kind: str, statistic: str, df: Sequence[float], p: str, alpha: str = "0.05",
    rounding: str = "nearest",
) -> Finding:  # fmt: skip
    """Say whether a printed p (`0.03`, `<0.001`, `>0.05`) belongs to a printed statistic.

    The wrong number may be either; where p crosses alpha the finding says so.
    """
    found = p_from(kind, statistic, *df, rounding=rounding)
    text = p.strip()
    sign, digits = (text[0], text[1:].strip()) if text[:1] in "<>=" else ("=", text)
    value = exactly(digits)
    if not 0 <= value <= 1:
        raise SignkinError(f"p is {p}", expected="a number from 0 to 1, or < or > one")
    if sign == "<":
        fits = found.low < value
    elif sign == ">":
        fits = found.high > value
    else:
        low, high = (float(v) for v in (allowed(digits).low, allowed(digits).high))
        fits = found.low <= high and low <= found.high
    level = float(number(alpha))
    crosses = (float(value) < level) != (found.value < level)
    why = f"{kind}({', '.join(f'{d:g}' for d in df)}) = {statistic} has p {found}"
    if not fits:
        why += ", not as printed: one of the two is wrong"
        why += f", and they disagree about {alpha}" if crosses else ""
    verdict = CONSISTENT if fits else INCONSISTENT
    return Finding(verdict, why, f"p {text}", f"{found.value:.6g}", found.interval)


def power_of(n: Sequence[int], effect_f: float, alpha: float = 0.05) -> float:
    """Return the power of a one-way ANOVA with groups of n for Cohen's f (noncentral F)."""
    df1, df2 = len(n) - 1, sum(n) - len(n)
    if df1 < 1 or df2 < 1:
        raise SignkinError(f"groups of {list(n)}", expected="two groups, more values than groups")
    critical = stats.f.isf(alpha, df1, df2)
    return float(stats.ncf.sf(critical, df1, df2, effect_f**2 * sum(n)))


def smallest_effect(n: Sequence[int], power: float = 0.8, alpha: float = 0.05) -> float:
    """Return the smallest Cohen's f that a one-way ANOVA with groups of n finds with a power."""
    return float(optimize.brentq(lambda f: power_of(n, f, alpha) - power, 1e-6, 50, xtol=1e-10))


def kruskal_limit(n: Sequence[int]) -> tuple[float, float]:
    """Return the greatest H, and its p, that groups of n can reach (no rank shared).

    All values of one group above all of the next: no data of this design have a smaller p.
    Up to six groups all orders of them are tried; more must be of one size.
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
