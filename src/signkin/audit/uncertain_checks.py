"""Checks on rows of recordings that tell how sure they are: no sharper than the rows allow.

A mean holds where its interval lies on one side of the bound, and fails where it lies on the
other; else it is undecided. Draws weigh whole signers and signs (signkin.resampling).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import resampling, seeds
from signkin.audit.checks.groups import ordered_pairs
from signkin.audit.corpus_checks import LEVEL, _label, _numbers, _rows
from signkin.audit.findings import FAILS, HOLDS, NOT_TESTABLE, UNDECIDED, Finding
from signkin.audit.registry import Missing, OnCorpus, on_corpus
from signkin.audit.rounding import shown
from signkin.audit.verdicts import Verdict, across, from_interval, more_than_luck
from signkin.errors import SignkinError, listed

DRAWS = 2000
Array = NDArray[np.float64]


def _lacking(table: str, frame: pd.DataFrame, names: Sequence[str]) -> None:
    unknown = [name for name in names if name not in frame.columns]
    if unknown:
        raise Missing(f"{table}.csv lacks the columns {listed(unknown)}")


def _rng(context: OnCorpus, *names: str) -> np.random.Generator:
    return seeds.stream(0, "audit", context.evidence.name, context.claim.id, *names)


def _clusters(rows: pd.DataFrame, names: Sequence[str]) -> dict[str, list[str]]:
    """Return the labels of clusters; without names each row is one of its own."""
    if not names:
        return {"rows": [str(i) for i in range(len(rows))]}
    return {name: rows.index.get_level_values(name).astype(str).tolist() for name in names}


def _few(error: SignkinError) -> Missing:
    return Missing(f"only {error.found}, needed: {error.expected}")


def _drawn_as(clusters: Sequence[str], unit: Sequence[str]) -> str:
    if clusters:
        return f"draws of {' and '.join(clusters)}"
    return f"{'/'.join(unit)} taken as independent"


@on_corpus
def mean_of(
    context: OnCorpus,
    table: str,
    value: str,
    unit: Sequence[str],
    clusters: Sequence[str] = (),
    take: str = "mean",
    where: str = "",
    above: str | float | None = None,
    below: str | float | None = None,
) -> list[Finding]:
    """A mean over recordings (or tags, transitions) lies above, or below, a bound, surely.

    unit: columns that name a recording; take: the mean or sum of its rows. clusters: one or two
    columns, such as signer and sign, that the 95 % bootstrap weighs whole; without, units count as
    independent. Undecided where the interval holds the bound.
    """
    if (above is None) == (below is None):
        raise SignkinError("the check mean_of wants one bound", expected="above or below")
    if take not in ("mean", "sum"):
        raise SignkinError(f"take: {take}", expected="mean or sum")
    frame = _rows(context, table, where)
    keys = [*unit, *(name for name in clusters if name not in unit)]
    _lacking(table, frame, keys)
    numbers = _numbers(context, table, frame, value).astype(float)
    grouped = numbers.groupby([frame[key] for key in keys])
    rows = (grouped.mean() if take == "mean" else grouped.sum(min_count=1)).dropna()
    if len(rows) < 2:
        raise Missing(f"{len(rows)} values in {table}.csv")
    data = rows.to_numpy()
    try:
        found = resampling.difference(
            data, np.zeros(len(data)), _clusters(rows.to_frame(), clusters), DRAWS,
            _rng(context, table, value, where), LEVEL,
        )  # fmt: skip
    except SignkinError as error:
        raise _few(error) from None
    bound = context.number(above if above is not None else below)
    sides = (found.low, found.high, bound) if below is None else (-found.high, -found.low, -bound)
    interval = f"{shown(found.low, 4)} to {shown(found.high, 4)}"
    told = shown(found.value, 4)
    why = (
        f"mean of {value}: {told} ({interval}; n = {found.n}, {_drawn_as(clusters, unit)}), "
        f"claimed {'above' if below is None else 'below'} {bound:g}"
    )
    return [Finding(str(from_interval(*sides)), why, recomputed=told, interval=interval,
                    source=context.source(table))]  # fmt: skip


@on_corpus
def ranked(
    context: OnCorpus,
    table: str,
    key: str,
    unit: Sequence[str],
    value: str = "",
    over: Sequence[str] = (),
    under: Sequence[str] = (),
    clusters: Sequence[str] = (),
    where: str = "",
    lowest: Sequence[object] = (),
    highest: Sequence[object] = (),
    below: Sequence[Sequence[object]] = (),
) -> list[Finding]:
    """Alternatives stand in the claimed order by their means over the same recordings, surely.

    key: the column that names the alternatives (order). unit, clusters: as mean_of. value: the
    number; or over and under: sums above and below the line of a pooled ratio. Holds where the
    95 % interval of every paired difference lies on the claimed side; fails where one lies on the
    other, at a level shared among all (Bonferroni); else undecided. A peak (highest) is told with
    its probability; a small one alone fails nothing: where many tie, each is rarely on top.
    """
    frame = _rows(context, table, where)
    keys = [*unit, *(name for name in clusters if name not in unit)]
    _lacking(table, frame, [*keys, key])
    frame = frame.assign(**{key: frame[key].map(_label)})

    def wide(expression: str) -> pd.DataFrame:
        numbers = _numbers(context, table, frame, expression).astype(float)
        return numbers.groupby([frame[k] for k in [*keys, key]]).mean().unstack(key)

    if bool(value) == bool(over and under):
        raise SignkinError("the check ranked wants value, or over and under")
    parts = {name: wide(name) for name in ([value] if value else [*over, *under])}
    whole = pd.concat(parts, axis=1).dropna()
    labels = list(next(iter(parts.values())).columns)
    claimed = [[_label(v) for v in part] for part in (lowest, highest, *below)]
    absent = [v for v in dict.fromkeys(chain(*claimed)) if v not in labels]
    if absent or len(whole) < 2:
        raise Missing(f"{table}.csv has no number for {key} {listed(absent)}" if absent
                      else f"{len(whole)} recordings in {table}.csv with all numbers")  # fmt: skip
    rows = (whole[value].to_numpy() if value else resampling.ratio_rows(
        [whole[name] for name in over], [whole[name] for name in under]))  # fmt: skip
    pairs = ordered_pairs(labels, claimed[0], claimed[1], claimed[2:])
    return _ranking(context, table, key, whole, rows, labels, pairs, claimed[1], clusters, unit)


def _ranking(
    context: OnCorpus, table: str, key: str, whole: pd.DataFrame, rows: Array,
    labels: list[str], pairs: list[tuple[str, str]], highest: list[str],
    clusters: Sequence[str], unit: Sequence[str],
) -> list[Finding]:  # fmt: skip
    groups = _clusters(whole, clusters)
    means = dict(zip(labels, rows.mean(axis=0), strict=True))
    unknown = [v for v in dict.fromkeys(chain(*pairs)) if np.isnan(means[v])]
    if unknown:
        raise Missing(f"{table}.csv has no ratio for {key} {listed(unknown)}: a sum of 0 in it")
    open_, against = [], []
    try:
        for small, large in pairs:
            a, b = rows[:, labels.index(large)], rows[:, labels.index(small)]
            one, shared = (
                resampling.difference(a, b, groups, DRAWS, _rng(context, table, small, large), at)
                for at in (LEVEL, 1 - (1 - LEVEL) / len(pairs))
            )
            if shared.high < 0:
                against.append((small, large, one))
            elif not one.low > 0:
                open_.append((small, large, one))
        sure = ""
        if len(highest) == 1:
            peak = resampling.peak(rows, labels, groups, DRAWS, _rng(context, table, "peak"), LEVEL)
            likely = sorted(zip(-peak.probability, peak.labels, strict=True))[:3]
            sure = f"the peak is at {highest[0]} with P = {peak.probability_of(*highest):.3f} (" + \
                ", ".join(f"{label}: {-p:.3f}" for p, label in likely) + "); "  # fmt: skip
    except SignkinError as error:
        raise _few(error) from None
    verdict = FAILS if against else UNDECIDED if open_ else HOLDS
    told = ", ".join(f"{v}: {shown(float(means[v]), 4)}" for v in labels)
    why = f"{sure}n = {len(whole)}, {_drawn_as(clusters, unit)}; by {key}, {told}"
    word = "is over" if against else "cannot be told from"
    faults = [
        f"{small} {word} {large} (difference {shown(-d.value, 3)}, {shown(-d.high, 3)} to "
        f"{shown(-d.low, 3)})"
        for small, large, d in against or open_
    ]
    why += f"; {listed(faults, 3)}" if faults else ""
    return [Finding(verdict, why, recomputed=told, source=context.source(table))]


@on_corpus
def against_nulls(
    context: OnCorpus, table: str, by: Sequence[str], null: str = "null", where: str = ""
) -> list[Finding]:
    """A share lies above what each of several nulls gives, in every row of each.

    The columns value, chance, chance_low and chance_high are those of tag_chance. Under a null:
    holds where all rows lie above its 95 % interval, fails where more lie below than luck puts
    there, else undecided. Where nulls disagree the claim depends on which chance is meant.
    """
    frame = _rows(context, table, where)
    _lacking(table, frame, [null, *by, "value", "chance", "chance_low", "chance_high"])
    frame = frame[frame[["value", "chance_low", "chance_high"]].notna().all(axis=1)]
    if frame.empty:
        raise Missing(f"{table}.csv has no chance interval")
    verdicts: dict[str, Verdict] = {}
    told = []
    for name, rows in frame.groupby(null, sort=False):
        each = [
            from_interval(r.value - r.chance_high, r.value - r.chance_low)
            for r in rows.itertuples()
        ]
        verdicts[str(name)] = (
            Verdict.FAILS if more_than_luck(each.count(Verdict.FAILS), len(each))
            else Verdict.HOLDS if set(each) == {Verdict.HOLDS} else Verdict.UNDECIDED
        )  # fmt: skip
        what = ", ".join(
            f"{'/'.join(_label(getattr(r, k)) for k in by)} {r.value:.3f} against {r.chance:.3f} "
            f"({r.chance_low:.3f} to {r.chance_high:.3f})"
            for r in rows.itertuples()
        )
        told.append(f"{name}: {verdicts[str(name)]}, {what}")
    found = across(verdicts)
    lead = {
        Verdict.DEPENDS: "it depends on which chance is meant",
        Verdict.HOLDS: "above chance under every null",
        Verdict.FAILS: "below chance under every null",
        Verdict.UNDECIDED: "not to be told from chance under any null",
    }.get(found.verdict, NOT_TESTABLE)
    above = len(found.by_verdict.get(Verdict.HOLDS, ()))
    return [Finding(str(found.verdict), f"{lead} ({'; '.join(told)})",
                    recomputed=f"above chance under {above} of {len(verdicts)} nulls",
                    source=context.source(table))]  # fmt: skip
