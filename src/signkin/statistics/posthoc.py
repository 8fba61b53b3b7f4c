"""Which groups differ from which: Tukey's HSD and Games-Howell, with Cohen's d."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from scipy import stats

from signkin.errors import listed
from signkin.statistics.effects import cohens_d
from signkin.statistics.findings import Finding, Groups, Kind, joined, untestable

MOST_GROUPS = 20  # every pair of these is compared: 190 pairs
PAIRWISE = {"Tukey HSD": True, "Games-Howell": False}


def largest(groups: Groups, most: int) -> tuple[Groups, str]:
    """Return the groups with most values, in their order, and what is to be told of the others."""
    if len(groups) <= most:
        return groups, ""
    order = sorted(groups, key=lambda name: -len(groups[name]))[:most]  # of equals the first
    kept = {name: values for name, values in groups.items() if name in set(order)}
    return kept, f"the {most} largest of {len(groups)} groups: all pairs are too many"


def pairwise(groups: Groups, comparison: str, alpha: float) -> list[Finding]:
    """Return every pair of groups by Tukey's HSD and by Games-Howell.

    p is adjusted for all pairs of the test. The statistic is the difference of the means in s,
    the first less the second. Groups of one value are left out; told in the note. Pairs grow with
    the square of groups: of more than MOST_GROUPS the largest are compared, which is told, too.
    """
    groups, cut = largest(groups, MOST_GROUPS)
    out: list[Finding] = []
    for test, equal in PAIRWISE.items():
        kept = {k: g for k, g in groups.items() if len(g) > 1}
        if not equal:
            kept = {k: g for k, g in kept.items() if np.ptp(g) > 0}
        left = [k for k in groups if k not in kept]
        note = f"left out, one value or no variance: {listed(left)}" if left else ""
        note = joined(cut, note)
        n = sum(map(len, kept.values()))
        nothing = all(np.ptp(g) == 0 for g in kept.values())
        if len(kept) < 2 or n - len(kept) < 1 or nothing:
            reason = joined("fewer than two groups that vary", note)
            out.append(untestable(test, Kind.PAIR, comparison, n, reason))
            continue
        found = stats.tukey_hsd(*kept.values(), equal_var=equal)
        values = list(kept.values())
        for (i, a), (j, b) in combinations(enumerate(kept), 2):
            d = cohens_d(values[i], values[j], alpha)
            without = "" if np.isfinite(d[0]) else "no d: the two groups have no variance"
            out.append(
                Finding(
                    test,
                    Kind.PAIR,
                    f"{comparison}: {a} - {b}",
                    (a, b),
                    "difference (s)",
                    float(found.statistic[i, j]),
                    p=float(found.pvalue[i, j]),
                    effect_name="Cohen's d",
                    effect=d[0],
                    effect_low=d[1],
                    effect_high=d[2],
                    n=len(values[i]) + len(values[j]),
                ).noted(without, note)
            )
    return out
