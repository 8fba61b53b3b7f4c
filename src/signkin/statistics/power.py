"""What a design could have found: power, and the smallest effect found at a given power."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy import stats
from scipy.optimize import brentq
from statsmodels.stats.power import TTestIndPower

from signkin.statistics.effects import pooled_sd
from signkin.statistics.findings import Finding, Groups, Kind, untestable

DESIGN = "a property of the design, no statistic of these means"


def power_of_f(effect_f: float, df1: float, df2: float, n: int, alpha: float) -> float:
    """Return the power of an F test of n values for Cohen's f, with noncentrality n f^2."""
    return float(stats.ncf.sf(stats.f.isf(alpha, df1, df2), df1, df2, n * effect_f**2))


def smallest_f(df1: float, df2: float, n: int, alpha: float, power: float) -> float:
    """Return the smallest Cohen's f that an F test of n values finds with the given power."""
    return _least_effect(lambda f: power_of_f(f, df1, df2, n, alpha), power)


def smallest_d(n1: int, n2: int, alpha: float, power: float) -> float:
    """Return the smallest Cohen's d that a two-sided t test of two groups finds."""
    test = TTestIndPower()
    return _least_effect(lambda d: float(test.power(d, n1, alpha, ratio=n2 / n1)), power)


def _least_effect(power_of: Callable[[float], float], wanted: float) -> float:
    """Solve power(effect) = wanted; statsmodels' own solver now and then returns no solution."""
    high = 0.01
    while power_of(high) < wanted:
        high *= 1.5
    return float(brentq(lambda effect: power_of(effect) - wanted, 1e-9, high))


def sensitivity(groups: Groups, comparison: str, alpha: float, power: float) -> list[Finding]:
    """Return the smallest effect that a one-way ANOVA of these groups could have found.

    In units of f, and as the SD of the groups' true means in seconds, weighted by group size.
    """
    test = f"smallest effect at {power:.0%} power"
    filled = [g for g in groups.values() if len(g)]
    n = sum(map(len, filled))
    if len(filled) < 2 or n - len(filled) < 1:
        return [
            untestable(
                test, Kind.SENSITIVITY, comparison, n, "fewer than two groups, or one value in each"
            )
        ]
    f = smallest_f(len(filled) - 1, n - len(filled), n, alpha, power)
    sd = pooled_sd(*filled)
    return [
        Finding(
            test,
            Kind.SENSITIVITY,
            comparison,
            statistic_name="F",
            df1=len(filled) - 1,
            df2=n - len(filled),
            effect_name="Cohen's f",
            effect=f,
            n=n,
            power=power,
            power_for=f"f = {f:.3f}",
            spread_s=f * sd,
            notes=(f"eta squared {f**2 / (1 + f**2):.3f}", spread_text(f * sd, sd), DESIGN),
        )
    ]


def spread_text(spread_s: float, within_s: float) -> str:
    """Return what an effect in seconds means beside the scatter within groups."""
    return (
        f"an SD of {spread_s:.4f} s of the true means where durations scatter by {within_s:.4f} s "
        "within groups"
    )


def sensitivity_of_two(
    a: np.ndarray,
    b: np.ndarray,
    comparison: str,
    alpha: float,
    power: float,
    groups: tuple[str, ...] = (),
) -> Finding:
    """Return the smallest difference of two means, in s, that a t test could have found."""
    test = f"smallest difference at {power:.0%} power"
    n = len(a) + len(b)
    if min(len(a), len(b)) < 2:
        return untestable(
            test, Kind.SENSITIVITY, comparison, n, "a group with fewer than two values"
        )
    sd = pooled_sd(a, b)
    d = smallest_d(len(a), len(b), alpha, power)
    return Finding(
        test,
        Kind.SENSITIVITY,
        comparison,
        groups,
        "t",
        df2=n - 2,
        effect_name="difference (s)",
        effect=d * sd,
        n=n,
        power=power,
        power_for=f"d = {d:.3f}",
        notes=(DESIGN,),
    ).noted("" if sd > 0 else "0, since nothing varies within the groups")
