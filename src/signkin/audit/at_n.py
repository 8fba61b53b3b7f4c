"""Tests of a corpus at the n that the paper had: a p-value says nothing beside one of another n.

Where a corpus has more than the print, as many are drawn from it, and what counts is how often
the printed test comes out as printed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import special, stats

from signkin import seeds
from signkin.audit.corpus_checks import _label, _numbers, _rows
from signkin.audit.findings import FAILS, HOLDS, UNDECIDED, Finding
from signkin.audit.registry import Missing, OnCorpus, on_corpus
from signkin.audit.rounding import exactly
from signkin.audit.significance import smallest_effect
from signkin.audit.verdicts import from_probability
from signkin.errors import SignkinError, listed

DRAWS = 200
Array = NDArray[np.float64]
SURE = 0.95  # the printed outcome, or its opposite, in so many draws


def _rng(context: OnCorpus, *names: str) -> np.random.Generator:
    return seeds.stream(0, "audit", context.evidence.name, context.claim.id, "at n", *names)


@on_corpus
def kruskal_at_n(
    context: OnCorpus,
    table: str,
    key: str,
    unit: Sequence[str],
    over: Sequence[str],
    under: Sequence[str],
    n: str,
    p: str,
    where: str = "",
    against_rest: str = "",
) -> list[Finding]:
    """A Kruskal-Wallis test of groups of n has a p below the printed one.

    key: the column that names the groups. unit: columns that name a recording. over, under:
    columns above and below the line of each row's ratio; x / 0 is tied at the top, 0 / 0 is left
    out. n: the printed number of recordings; so many are drawn, with replacement, whatever a corpus
    has (half of n at least). against_rest: the group that is set against all others together.
    Holds where the test comes out so in more than 97.5 % of draws, fails where in less than 2.5 %.
    """
    frame = _rows(context, table, where)
    lacking = [name for name in [*unit, key] if name not in frame.columns]
    if lacking:
        raise Missing(f"{table}.csv lacks the columns {listed(lacking)}")
    size = int(exactly(context.text(n)))
    bound = float(exactly(context.text(p).lstrip("<=≤ ")))
    ratio = pd.Series(1.0, index=frame.index)
    with np.errstate(divide="ignore", invalid="ignore"):
        for name in over:
            ratio = ratio * _numbers(context, table, frame, name).astype(float)
        for name in under:
            ratio = ratio / _numbers(context, table, frame, name).astype(float)
    names = frame[key].map(_label)
    wide = ratio.groupby([*(frame[k] for k in unit), names]).first().unstack(key)
    if len(wide) < size / 2:
        raise Missing(
            f"{len(wide)} recordings in {table}.csv, fewer than half of the printed {size}"
        )
    if wide.shape[1] < 2 or (against_rest and against_rest not in wide.columns):
        raise Missing(f"{table}.csv has no groups to compare by {key}")
    data = wide.to_numpy(dtype=float)
    one = list(wide.columns).index(against_rest) if against_rest else None
    rng = _rng(context, table, against_rest)
    found = np.array([_kruskal(data[rng.integers(0, len(data), size)], one) for _ in range(DRAWS)])
    if np.isnan(found).any():
        raise Missing(f"{table}.csv has draws of {size} without any ratio to rank")
    share = float((found < bound).mean())
    own = _kruskal(data, one)
    verdict = str(from_probability(share))
    question = f"{key} {against_rest} against the rest" if against_rest else f"all {key}s"
    why = (
        f"{question}: at the printed n = {size}, p below {bound:g} in {share:.0%} of {DRAWS} draws "
        f"of the corpus's {len(data)} recordings (median p {np.median(found):.2g}; p of all "
        f"{len(data)}, at another n, {own:.2g})"
    )
    return [Finding(verdict, why, recomputed=f"p < {bound:g} in {share:.0%} of draws",
                    source=context.source(table))]  # fmt: skip


def _kruskal(values: Array, one: int | None) -> float:
    """Return p of groups, the columns (NaN: left out); one: this column against the others."""
    groups = [column[~np.isnan(column)] for column in values.T]
    if one is not None:
        rest = np.concatenate([g for i, g in enumerate(groups) if i != one])
        groups = [groups[one], rest]
    # Infinite ratios are tied at the top: ranks alone count.
    groups = [np.where(np.isinf(g), np.finfo(float).max, g) for g in groups if len(g)]
    if len(groups) < 2:
        return float("nan")
    pooled = np.concatenate(groups)
    _, at, ties = np.unique(pooled, return_inverse=True, return_counts=True)
    if len(ties) < 2:
        return float("nan")
    # Kruskal & Wallis 1952, as scipy.stats.kruskal reckons it, which takes 3 ms a call to find out
    # what it is given: here it is asked for each of some hundred draws.
    ranks = (np.cumsum(ties) - (ties - 1) / 2)[at]
    n = len(pooled)
    ends = np.cumsum([len(g) for g in groups])
    sums = [float(np.sum(part)) for part in np.split(ranks, ends[:-1])]
    squares = sum(total**2 / len(g) for total, g in zip(sums, groups, strict=True))
    h = 12.0 / (n * (n + 1)) * squares - 3 * (n + 1)
    h /= 1 - float(np.sum(ties.astype(float) ** 3 - ties)) / (n**3 - n)
    return float(special.chdtrc(len(groups) - 1, h))


@on_corpus
def groups_differ(
    context: OnCorpus,
    table: str,
    value: str,
    by: str,
    differ: bool,
    where: str = "",
    test: str = "anova",
    alpha: str | float = 0.05,
    least: int = 2,
    at_n: str = "",
) -> list[Finding]:
    """A column differs between groups (`differ: true`), or not significantly (`false`).

    test: anova or kruskal. Groups of fewer than `least` values are left out and counted. at_n: the
    printed number of values: where a corpus has more, so many are drawn (without replacement) and
    it holds where most draws come out as claimed, fails where 95 % come out the other way. Where a
    test is not significant, the smallest effect is told that it would have found.
    """
    frame = _rows(context, table, where)
    values = _numbers(context, table, frame, value)
    keys = _numbers(context, table, frame, by)
    there = values.notna() & (keys.astype(str) != "")
    x, labels = values[there].to_numpy(dtype=float), keys[there].astype(str).to_numpy()
    parts = _parts(x, labels)
    kept = [p for p in parts if len(p) >= least]
    if len(kept) < 2 or sum(map(len, kept)) <= len(kept):
        raise Missing(f"{len(kept)} groups of {least} values or more in {table}.csv")
    if not np.ptp(np.concatenate(kept)):
        raise Missing(f"no spread of {value} in {table}.csv")
    if test not in ("anova", "kruskal"):
        raise SignkinError(f"test: {test}", expected="anova or kruskal")
    run = stats.f_oneway if test == "anova" else stats.kruskal
    done = run(*kept)
    n = sum(map(len, kept))
    df = f"({len(kept) - 1}, {n - len(kept)})" if test == "anova" else f"({len(kept) - 1})"
    level = context.number(alpha)
    verdict = HOLDS if (done.pvalue < level) == differ else FAILS
    letter = "F" if test == "anova" else "H"
    told = f"{letter}{df} = {done.statistic:.3f}, p = {done.pvalue:.3g}"
    why = f"{told}; n = {n}, level {level:g}, {len(kept)} groups"
    dropped = len(parts) - len(kept)
    why += f" ({dropped} with fewer than {least} left out)" if dropped else ""
    size = int(exactly(context.text(at_n))) if at_n else n
    if n > size:
        share = _share_significant(x, labels, size, least, run, level, _rng(context, table, value))
        so = share if differ else 1 - share
        verdict = HOLDS if so > 0.5 else FAILS if so < 1 - SURE else UNDECIDED
        why += f". At the printed n = {size} it is significant in {share:.0%} of {DRAWS} draws"
    elif done.pvalue >= level and test == "anova":
        f = smallest_effect([len(p) for p in kept], 0.8, level)
        why += f"; with 80 % power it finds effects from f = {f:.2f} on"
    if at_n and n < size:
        why += f"; the print had {size}"
    return [Finding(verdict, why, recomputed=told, source=context.source(table))]


def _parts(values: Array, labels: NDArray[np.str_]) -> list[Array]:
    return [values[labels == label] for label in np.unique(labels)]


def _share_significant(
    values: Array, labels: NDArray[np.str_], size: int, least: int, run: Callable[..., Any],
    level: float, rng: np.random.Generator,
) -> float:  # fmt: skip
    """Return how often a test of so many values, drawn from all, is significant."""
    hits = 0
    for _ in range(DRAWS):
        at = rng.choice(len(values), size, replace=False)
        kept = [p for p in _parts(values[at], labels[at]) if len(p) >= least]
        if len(kept) > 1 and sum(map(len, kept)) > len(kept) and np.ptp(np.concatenate(kept)):
            hits += run(*kept).pvalue < level
    return hits / DRAWS
