"""Are durations the same, within a bound? No difference found is not a difference excluded."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from statsmodels.stats.oneway import equivalence_oneway
from statsmodels.stats.weightstats import CompareMeans, DescrStatsW, ttost_ind

from signkin.errors import listed
from signkin.statistics.effects import pooled_sd
from signkin.statistics.findings import Finding, Groups, Kind, untestable

TOST = "TOST (Welch)"
OMNIBUS = "equivalence of all means (Wellek, Welch)"
ALL_PAIRS = "all pairs"


def tost(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    comparison: str,
    bound_s: float,
    alpha: float,
    groups: tuple[str, ...] = (),
) -> Finding:
    """Return two one-sided t tests (unequal variances): do the means differ by less than the bound?

    The effect is the difference with its 1 - 2 alpha interval: inside the bounds exactly where
    p < alpha. Power: to show equivalence where the true difference is 0 (normal approximation
    of the shift, Student's t for the critical value).
    """
    n = len(a) + len(b)
    if min(len(a), len(b)) < 2:
        return untestable(
            TOST, Kind.EQUIVALENCE, comparison, n, "a group with fewer than two values"
        )
    if np.ptp(a) == 0 and np.ptp(b) == 0:
        return untestable(
            TOST, Kind.EQUIVALENCE, comparison, n, "all durations within the groups are equal"
        )
    p, lower, upper = ttost_ind(a, b, -bound_s, bound_s, usevar="unequal")
    compared = CompareMeans(DescrStatsW(a), DescrStatsW(b))
    low, high = compared.tconfint_diff(alpha=2 * alpha, usevar="unequal")
    worse = lower if lower[1] > upper[1] else upper
    df = float(lower[2])
    reach = bound_s / float(compared.std_meandiff_separatevar)
    power = max(0.0, 2 * float(stats.t.cdf(reach - stats.t.ppf(1 - alpha, df), df)) - 1)
    return Finding(
        TOST,
        Kind.EQUIVALENCE,
        comparison,
        groups,
        "t",
        float(worse[0]),
        df2=df,
        p=float(p),
        effect_name="difference (s)",
        effect=float(a.mean() - b.mean()),
        effect_low=float(low),
        effect_high=float(high),
        n=n,
        power=power,
        power_for="a true difference of 0",
        notes=(
            f"bound ± {bound_s:g} s",
            f"interval {1 - 2 * alpha:.0%}",
            f"p < {alpha:g}: equivalent",
        ),
    )


def tost_pairs(groups: Groups, comparison: str, bound_s: float, alpha: float) -> list[Finding]:
    """Return TOST of every pair, and of all together (the largest p: all must be equivalent)."""
    filled = {k: g for k, g in groups.items() if len(g)}
    out = [
        tost(filled[a], filled[b], f"{comparison}: {a} - {b}", bound_s, alpha, (a, b))
        for a, b in combinations(filled, 2)
    ]
    if len(out) < 2:
        return out
    n = sum(map(len, filled.values()))
    title = f"{comparison}: {ALL_PAIRS}"
    lost = [f.comparison for f in out if np.isnan(f.p)]
    if lost:
        reason = f"no TOST for {listed(lost, 4)}"
        return [*out, untestable(TOST, Kind.EQUIVALENCE, title, n, reason)]
    worst = max(out, key=lambda f: f.p)
    return [
        *out,
        Finding(
            TOST,
            Kind.EQUIVALENCE,
            title,
            p=worst.p,
            n=n,
            notes=(
                f"all means within ± {bound_s:g} s of each other? the largest p of the "
                f"pairs (intersection-union), of {' - '.join(worst.groups)}",
            ),
        ),
    ]


def omnibus(groups: Groups, comparison: str, bound_s: float, alpha: float) -> Finding:
    """Return the test that the means' SD is below half the bound (as two means, a bound apart)."""
    kept = {k: g for k, g in groups.items() if len(g) > 1 and np.ptp(g) > 0}
    n = sum(map(len, kept.values()))
    if len(kept) < 2:
        return untestable(
            OMNIBUS,
            Kind.EQUIVALENCE,
            comparison,
            n,
            "fewer than two groups of two or more that vary",
        )
    left = [k for k in groups if k not in kept]
    margin = bound_s / 2 / pooled_sd(*kept.values())
    found = equivalence_oneway(list(kept.values()), margin**2, use_var="unequal")
    notes = [f"f below {margin:.3f}: an SD of the true means below {bound_s / 2:g} s"]
    if left:
        notes.append(f"left out, one value or no variance: {listed(left)}")
    f2 = max(float(found.effectsize), 0.0)
    return Finding(
        OMNIBUS,
        Kind.EQUIVALENCE,
        comparison,
        (),
        "F",
        float(found.f_stat),
        float(found.df[0]),
        float(found.df[1]),
        float(found.pvalue),
        "Cohen's f",
        float(np.sqrt(f2)),
        n=n,
        power=float(found.power_zero),
        power_for="equal true means",
        spread_s=float(np.sqrt(f2)) * pooled_sd(*kept.values()),
        notes=(*notes, "no interval: see eta squared of Welch's ANOVA"),
    )
