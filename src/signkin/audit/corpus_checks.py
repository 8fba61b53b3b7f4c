"""Checks on the result tables of a corpus. Each returns findings; claims.yaml names them.

A check takes rows of one table (`where`), numbers from their columns by small expressions, and
a condition. What a corpus has no table for is Missing, which the ledger tells as not testable.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats

from signkin import seeds
from signkin.audit.checks.groups import ordered_pairs
from signkin.audit.expressions import evaluate
from signkin.audit.findings import FAILS, HOLDS, UNDECIDABLE, UNDECIDED, Finding
from signkin.audit.registry import Missing, OnCorpus, on_corpus
from signkin.audit.rounding import allowed, shown
from signkin.audit.verdicts import from_interval, more_than_luck
from signkin.errors import SignkinError, listed
from signkin.resampling import narrowed

DRAWS = 1000  # of the bootstrap
MOST_DRAWN = 50_000  # rows that a bootstrap draw takes
AT_ONCE = 250_000  # values of draws held at a time: as fast as more, in a tenth of the memory
LEVEL = 0.95
LEAST = 3  # values that an estimate is made from
TAKES: dict[str, Any] = {
    "mean": np.mean,
    "median": np.median,
    "sd": lambda x, axis=None: np.std(x, ddof=1, axis=axis),
    "min": np.min,
    "max": np.max,
    "sum": np.sum,
    "count": lambda x, axis=None: np.size(x) if axis is None else np.shape(x)[axis],
}
CONDITIONS = ("above", "below", "at_least", "at_most")


def _env(frame: pd.DataFrame) -> dict[str, Any]:
    return {str(column): frame[column] for column in frame.columns}


def _rows(context: OnCorpus, table: str, where: str) -> pd.DataFrame:
    frame = context.table(table)
    if where:
        try:
            frame = frame[evaluate(where, _env(frame))]
        except SignkinError as error:
            raise _about(context, table, error) from None
    if frame.empty:
        raise Missing(f"{table}.csv has no row with {where}")
    return frame


def _about(context: OnCorpus, table: str, error: SignkinError) -> Exception:
    if "is unknown" in error.found:
        return Missing(f"{table}.csv lacks a column: {error.found}")
    return error


def _numbers(context: OnCorpus, table: str, frame: pd.DataFrame, value: str) -> pd.Series:
    try:
        found = evaluate(value, _env(frame))
    except SignkinError as error:
        raise _about(context, table, error) from None
    return found if isinstance(found, pd.Series) else pd.Series(found, index=frame.index)


@on_corpus
def measure(
    context: OnCorpus,
    table: str,
    value: str,
    take: str = "mean",
    where: str = "",
    above: str | float | None = None,
    below: str | float | None = None,
    at_least: str | float | None = None,
    at_most: str | float | None = None,
    contains: str | None = None,
    equals: str | None = None,
) -> list[Finding]:
    """A number taken from a table keeps a bound, or agrees with a printed one.

    take: mean, median, sd, min, max, sum, count, share or number (of rows where `value` is
    true), or distinct (number of different values). above, below, at_least, at_most: the number
    itself keeps the bound. contains: the 95 % bootstrap interval of the number (values taken as
    independent) holds the printed one. equals: the very number. A bound within the bootstrap
    interval of a mean, SD, median or share leaves it undecided.
    """
    frame = _rows(context, table, where)
    values = _numbers(context, table, frame, value)
    source = context.source(table)
    if take == "distinct":
        found, interval = float(values.nunique()), ""
    elif take == "number":
        found, interval = float(values.astype(bool).sum()), ""
    else:
        data = values.dropna().to_numpy(dtype=float)
        wanted = TAKES.get("mean" if take == "share" else take)
        if wanted is None:
            raise SignkinError(
                f"take: {take}", expected=listed([*TAKES, "share", "number", "distinct"])
            )
        if len(data) < (LEAST if take in ("mean", "sd", "median", "share") else 1):
            raise Missing(f"{len(data)} values in {table}.csv")
        found = float(wanted(data))
        interval = ""
        if take in ("mean", "sd", "median", "share"):
            low, high = _bootstrap(data, wanted, found, context, value)
            interval = f"{shown(low, 4)} to {shown(high, 4)}"
    told = f"{shown(found, 4)}"
    bounds = {"above": above, "below": below, "at_least": at_least, "at_most": at_most}
    bounds = {name: bound for name, bound in bounds.items() if bound is not None}
    if not bounds and contains is None and equals is None:
        raise SignkinError("the check measure has no condition", expected=listed(
            [*CONDITIONS, "contains", "equals"]))  # fmt: skip
    holds, parts, within = True, [], []
    for name, bound in bounds.items():
        limit = context.number(bound)
        if interval and low <= limit <= high and low != high:
            within.append(f"{limit:g}")
        keeps = {
            "above": found > limit,
            "below": found < limit,
            "at_least": found >= limit - 1e-9,
            "at_most": found <= limit + 1e-9,
        }
        holds &= keeps[name] or f"{limit:g}" in within
        parts.append(f"is {name.replace('_', ' ')} {limit:g}")
    if contains is not None:
        text = context.text(contains)
        values_allowed = allowed(text)
        holds &= low <= float(values_allowed.high) and float(values_allowed.low) <= high
        parts.append(f"has {text} in its 95 % interval, {interval}")
    if equals is not None:
        text = context.text(equals)
        holds &= found == context.number(equals)
        parts.append(f"is {text}")
    rows = f"n = {len(frame)}"
    negated = [part.replace("is ", "is not ", 1).replace("has ", "has not ", 1) for part in parts]
    word = " and ".join(parts) if holds else " or ".join(negated)
    if holds and within:
        word = f"cannot be told from {listed(within)}: its 95 % interval is {interval}"
    why = f"{take} of {value}: {told} ({rows}), which {word}"
    verdict = FAILS if not holds else UNDECIDED if within else HOLDS
    return [Finding(verdict, why, recomputed=told, interval=interval, source=source)]


def _bootstrap(
    data: NDArray[np.float64], function: Any, found: float, context: OnCorpus, value: str
) -> tuple[float, float]:
    rng = seeds.stream(0, "audit", context.evidence.name, context.claim.id, value)
    drawn = np.concatenate(
        [function(data[rng.integers(0, len(data), shape)], axis=1) for shape in _shapes(len(data))]
    )
    return _interval(drawn, found, len(data))


def _shapes(n: int) -> list[tuple[int, int]]:
    """Return how many draws are made at a time, and how many of n rows each takes."""
    taken = min(n, MOST_DRAWN)
    most = max(1, AT_ONCE // max(taken, 1))
    return [(min(most, DRAWS - start), taken) for start in range(0, DRAWS, most)]


def _interval(drawn: NDArray[np.float64], found: float, n: int) -> tuple[float, float]:
    """Return the interval of draws; of fewer than n rows it is narrowed (m out of n)."""
    low, high = np.quantile(drawn, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    if n > MOST_DRAWN:
        low, high = (narrowed(found, bound, MOST_DRAWN, n) for bound in (low, high))
    return float(low), float(high)


@on_corpus
def correlation(
    context: OnCorpus,
    table: str,
    x: str,
    y: str,
    where: str = "",
    method: str = "pearson",
    sign: str = "positive",
) -> list[Finding]:
    """Two columns go together: the 95 % bootstrap interval of r lies on the claimed side of zero.

    It fails where it lies on the other side; with zero within it, it is undecided.
    """
    frame = _rows(context, table, where)
    pairs = pd.DataFrame(
        {"x": _numbers(context, table, frame, x), "y": _numbers(context, table, frame, y)}
    ).dropna()
    data = pairs.to_numpy(dtype=float)
    if len(data) < 2 * LEAST or not np.ptp(data, axis=0).all():
        raise Missing(f"{len(data)} pairs in {table}.csv, or no spread")
    if method == "spearman":
        data = np.column_stack([stats.rankdata(data[:, 0]), stats.rankdata(data[:, 1])])
    elif method != "pearson":
        raise SignkinError(f"method: {method}", expected="pearson or spearman")
    r = float(np.corrcoef(data.T)[0, 1])
    rng = seeds.stream(0, "audit", context.evidence.name, context.claim.id, x, y)
    drawn = []
    for shape in _shapes(len(data)):
        at = rng.integers(0, len(data), shape)
        a, b = data[at, 0], data[at, 1]
        a, b = a - a.mean(axis=1, keepdims=True), b - b.mean(axis=1, keepdims=True)
        spread = np.sqrt((a * a).sum(axis=1) * (b * b).sum(axis=1))
        drawn.append(np.where(spread > 0, (a * b).sum(axis=1) / np.where(spread > 0, spread, 1), 0))
    low, high = _interval(np.concatenate(drawn), r, len(data))
    verdict = from_interval(*((low, high) if sign == "positive" else (-high, -low)))
    why = f"{method} r of {x} and {y} is {r:.3f} ({low:.3f} to {high:.3f}), n = {len(data)}"
    return [Finding(str(verdict), why, recomputed=f"r = {r:.3f}",
                    interval=f"{low:.3f} to {high:.3f}", source=context.source(table))]  # fmt: skip


@on_corpus
def mostly(
    context: OnCorpus, table: str, holds: str, share: float, missing: str, where: str = ""
) -> list[Finding]:
    """A condition for the claim to be tested at all: `holds` in at least this share of the rows.

    With `gate: true` the claim is not testable where it is not met; `missing` says why.
    """
    frame = _rows(context, table, where)
    answers = _numbers(context, table, frame, holds).astype(bool)
    told = f"{holds} in {int(answers.sum())} of {len(answers)} rows"
    if answers.mean() < share:
        raise Missing(f"{missing} ({told})")
    return [Finding(HOLDS, told, recomputed=f"{answers.mean():.0%}",
                    source=context.source(table))]  # fmt: skip


def _taken(
    context: OnCorpus, table: str, frame: pd.DataFrame, by: Sequence[str], take: Mapping[str, str]
) -> pd.DataFrame:
    """Return a row a group with the numbers of `take` (`mean hit_rate`)."""
    unknown = [name for name in by if name not in frame.columns]
    if unknown:
        raise Missing(f"{table}.csv lacks the columns {listed(unknown)}")
    columns = {}
    for name, recipe in take.items():
        how, _, value = recipe.partition(" ")
        if how not in TAKES or not value:
            raise SignkinError(f"take: {recipe!r}", expected="such as `mean hit_rate`")
        numbers = _numbers(context, table, frame, value).astype(float)
        grouped = numbers.groupby([frame[k] for k in by], sort=True)
        kind = {"sd": "std"}.get(how, how)
        columns[name] = grouped.agg(kind).round(9)  # differences of times in seconds
    return pd.DataFrame(columns).reset_index()


@on_corpus
def every(
    context: OnCorpus,
    table: str,
    holds: str,
    where: str = "",
    by: Sequence[str] = (),
    take: Mapping[str, str] | None = None,
    show: str = "",
    share: float = 1.0,
) -> list[Finding]:
    """A condition holds in every row, or in every group with the numbers of `take`.

    share: it is enough if it holds in this share of them. show: the number told.
    """
    frame = _rows(context, table, where)
    if take:
        if not by:
            frame = frame.assign(all="all")
        frame = _taken(context, table, frame, list(by) or ["all"], take)
    missing = frame.isna() if take else None
    if missing is not None and missing.to_numpy().any():
        frame = frame[~missing.any(axis=1)]
        if frame.empty:
            raise Missing(f"{table}.csv has no numbers for {listed(take or ())}")
    answers = _numbers(context, table, frame, holds).astype(bool)
    good = float(answers.mean())
    what = "groups" if take else "rows"
    told = f"{int(answers.sum())} of {len(answers)} {what}"
    if show:
        shown_values = _numbers(context, table, frame, show).astype(float)
        if shown_values.isna().all():
            raise Missing(f"{table}.csv has no number for {show}")
        told = f"{shown(float(shown_values.min()), 4)}"
        if shown_values.nunique() > 1:
            told += f" to {shown(float(shown_values.max()), 4)}"
    why = f"{holds} in {int(answers.sum())} of {len(answers)} {what}"
    against = frame[~answers]
    if len(against) and by:
        names = ["/".join(map(_label, row)) for row in against[list(by)].to_numpy()]
        why += f"; not in {'/'.join(by)} {listed(names, 6)}"
    fits = good >= share - 1e-12
    return [Finding(HOLDS if fits else FAILS, why, recomputed=told,
                    source=context.source(table))]  # fmt: skip


@on_corpus
def beyond_chance(
    context: OnCorpus,
    table: str,
    value: str,
    low: str,
    high: str,
    by: Sequence[str],
    where: str = "",
    more_than: float = 0.0,
    all_of: bool = True,
) -> list[Finding]:
    """A share lies above what chance gives, row by row.

    low, high: columns with the 2.5 and 97.5 % of draws by chance. by: columns that name a row.
    all_of: it holds if every row is above; else if more than the share `more_than` is. Rows
    within the interval of chance leave it undecided; rows below it fail it, if they are more
    than luck puts there. Rows without a chance interval count neither way: where they would
    decide, it is not testable.
    """
    frame = _rows(context, table, where)
    unknown = [name for name in by if name not in frame.columns]
    if unknown:
        raise Missing(f"{table}.csv lacks the columns {listed(unknown)}")
    numbers = pd.DataFrame(
        {n: _numbers(context, table, frame, v) for n, v in (("x", value), ("a", low), ("b", high))}
    ).astype(float)
    names = [" ".join(map(_label, row)) for row in frame[list(by)].to_numpy(dtype=object)]
    told, above, unsure, lower = [], [], [], []
    for name, row in zip(names, numbers.itertuples(), strict=True):
        if np.isnan([row.x, row.a, row.b]).any():
            unsure.append(name)
            continue
        told.append(f"{name}: {row.x:.2f} ({row.a:.2f} to {row.b:.2f})")
        if row.x > row.b:
            above.append(name)
        elif row.x < row.a:
            lower.append(name)
    least = len(names) if all_of else int(np.floor(more_than * len(names))) + 1
    if len(above) < least <= len(above) + len(unsure):
        raise Missing(f"{table}.csv has no chance interval for {'/'.join(by)} {listed(unsure)}")
    under = [name for name in names if name not in above and name not in unsure]
    why = f"above chance in {len(above)} of {len(names)} ({'/'.join(by)})"
    why += f", not in {listed(under, 9)}" if under else ""
    why += f"; no chance interval for {listed(unsure, 9)}" if unsure else ""
    why += f". Share (chance): {', '.join(told)}"
    verdict = HOLDS if len(above) >= least else UNDECIDED
    if len(names) - len(lower) < least and more_than_luck(len(lower), len(names)):
        verdict = FAILS
    why += f". Below chance: {listed(lower, 9)}" if lower else ""
    return [Finding(verdict, why,
                    recomputed=f"{len(above)} of {len(names)} above chance",
                    source=context.source(table))]  # fmt: skip


@on_corpus
def order(
    context: OnCorpus,
    table: str,
    key: str,
    take: Mapping[str, str] | None = None,
    value: str = "",
    where: str = "",
    lowest: Sequence[object] = (),
    highest: Sequence[object] = (),
    below: Sequence[Sequence[object]] = (),
    sd: str = "",
    n: str = "",
) -> list[Finding]:
    """Groups stand in the claimed order by a number.

    key: the column that names the groups. take and value: the number, from aggregates
    (`take: {hits: mean hit_rate}`, `value: hits`); without take the table has one row a group.
    sd, n: columns with each group's SD and size. With them it holds where every difference is
    above 0 by Welch's interval (95 %), fails where one is below (at a level shared among all),
    and else is undecided; without them the numbers count as they are (no test). `ranked` is for
    groups of the same recordings.
    """
    frame = _rows(context, table, where)
    if take:
        frame = _taken(context, table, frame, [key], take)
    elif key not in frame.columns:
        raise Missing(f"{table}.csv lacks the column {key}")
    numbers = _numbers(context, table, frame, value or next(iter(take or {"": ""})))
    values = {_label(k): float(v) for k, v in zip(frame[key], numbers, strict=True) if v == v}
    parts = [[_label(v) for v in part] for part in (lowest, highest, *below)]
    names = list(dict.fromkeys(name for part in parts for name in part))
    lacking = [name for name in names if name not in values]
    if lacking:
        raise Missing(f"{table}.csv has no number for {key} {listed(lacking)}")
    pairs = ordered_pairs(list(values), parts[0], parts[1], parts[2:])
    if sd and n and pairs:
        spreads = [_numbers(context, table, frame, column) for column in (sd, n)]
        groups = {
            _label(k): (float(m), float(s), float(size))
            for k, m, s, size in zip(frame[key], numbers, *spreads, strict=True)
        }
        return [_by_welch(groups, pairs, f"by {key}", context.source(table))]
    wrong = [(a, b) for a, b in pairs if not values[a] < values[b]]
    told = ", ".join(f"{name}: {shown(values[name], 4)}" for name in names)
    why = f"by {key}, {told}"
    if wrong:
        faults = [f"{a} ({shown(values[a], 4)}) is not under {b} ({shown(values[b], 4)})"
                  for a, b in wrong]  # fmt: skip
        why = listed(faults, 4)
    elif not pairs:
        return [Finding(UNDECIDABLE, "nothing to compare", source=context.source(table))]
    return [Finding(FAILS if wrong else HOLDS, why, recomputed=told,
                    source=context.source(table))]  # fmt: skip


def _by_welch(
    groups: Mapping[str, tuple[float, float, float]],
    pairs: Sequence[tuple[str, str]],
    lead: str,
    source: str,
) -> Finding:
    """Return whether each pair (smaller, larger) stands so. groups: mean, SD and n of each."""
    against, open_ = [], []
    for small, large in pairs:
        (m1, s1, n1), (m2, s2, n2) = groups[small], groups[large]
        gap, parts = m2 - m1, [s * s / k if k > 1 else np.nan for s, k in ((s1, n1), (s2, n2))]
        error = float(np.sqrt(sum(parts)))
        if not error > 0:  # nothing, or no spread, to tell it by
            open_.append(f"{small} cannot be told from {large} (no standard error)")
            continue
        df = sum(parts) ** 2 / (parts[0] ** 2 / (n1 - 1) + parts[1] ** 2 / (n2 - 1))
        one, shared = (error * stats.t.ppf(1 - (1 - LEVEL) / (2 * k), df) for k in (1, len(pairs)))
        span = f"({shown(m1, 4)} and {shown(m2, 4)}, difference {gap:.3g} +- {one:.2g})"
        if gap < -shared:
            against.append(f"{small} is over {large} {span}")
        elif not gap > one:
            open_.append(f"{small} cannot be told from {large} {span}")
    names = list(dict.fromkeys(name for pair in pairs for name in pair))
    told = ", ".join(f"{name}: {shown(groups[name][0], 4)}" for name in names)
    verdict = FAILS if against else UNDECIDED if open_ else HOLDS
    faults = against or open_
    why = f"{lead}, {told}" + (f"; {listed(faults, 4)}" if faults else "")
    return Finding(verdict, why, recomputed=told, source=source)


def _label(value: object) -> str:
    if isinstance(value, float) and value.is_integer():
        return str(int(value))
    return str(value)
