"""The power of a one-way design, and the smallest effect that it finds."""

from __future__ import annotations

from collections.abc import Sequence

from scipy import optimize, stats

from signkin.errors import SignkinError


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
