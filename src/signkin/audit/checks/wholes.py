"""Checks on the same people split in several ways: each split has to give the same whole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial

from signkin.audit import summaries
from signkin.audit.checks.rows import Row, open_readings, rows_of, verdict_of, want_settings
from signkin.audit.findings import (
    DIGITS,
    INCONSISTENT,
    UNDECIDABLE,
    Finding,
    over_readings,
    unusable,
)
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.rounding import shown
from signkin.errors import SignkinError

Splits = dict[str, list[Row]]


@on_print(
    "groups and the whole",
    {"table": "splits.csv", "split": "by", "sd": "sd"},
    "group,by,n,mean,sd\nmen,sex,10,4.10,1.02\nwomen,sex,12,5.00,1.10\n"
    "young,age,8,4.40,1.20\nold,age,14,4.70,1.11\n",
)  # fmt: skip
def same_whole(
    context: OnPrint, table: str, split: str, measure: str = "", n: str = "n", mean: str = "mean",
    sd: str = "", divisor: str = "either", missing: bool = False,
) -> list[Finding]:  # fmt: skip
    """The same people, split in several ways, have one mean and one SD together.

    split: the column that names the way of splitting. measure: the column of what was measured,
    where a table has several. sd: the column of the SDs; without it the means alone. Splits of
    unlike n are not of the same people: undecidable. missing: true, where some people may have no
    value (a share of errors of who made none): what does not fit is undecidable then.
    """
    want_settings(None, 1, divisor)
    columns = {"n": n, "mean": mean, "split": split}
    columns |= {"sd": sd} if sd else {}
    columns |= {"measure": measure} if measure else {}
    measures: dict[str, Splits] = {}
    for row in rows_of(context, table, columns):
        of = measures.setdefault(row.cells.get("measure", ""), {})
        of.setdefault(row["split"], []).append(row)
    source = context.source(table)
    out: list[Finding] = []
    for name, splits in measures.items():
        try:
            out += _of_measure(name, splits, bool(sd), divisor, source)
        except SignkinError as error:
            out.append(unusable(error, name, source))
    if missing:
        out = [replace(f, verdict=UNDECIDABLE, why=f"{f.why}: some values may be missing",
                       severity="") if f.verdict == INCONSISTENT else f for f in out]  # fmt: skip
    return out


def _of_measure(
    name: str, splits: Splits, with_sd: bool, divisor: str, source: str
) -> list[Finding]:
    if len(splits) < 2:
        why = "only one way of splitting: nothing to set it against"
        return [Finding(UNDECIDABLE, why, source=source, item=name)]
    groups = {d: _groups(splits, with_sd, d) for _, d, _ in open_readings(divisor)}
    first = next(iter(groups.values()))
    sizes = {by: sum(g.n for g in of) for by, of in first.items()}
    if len(set(sizes.values())) > 1:
        told = ", ".join(f"{by} {size}" for by, size in sizes.items())
        why = f"the splits have unlike n ({told}): not of the same people"
        return [Finding(UNDECIDABLE, why, source=source, item=name)]
    out = [_means(name, first, source)]
    if with_sd:
        readings = [(f"divisor {d}", partial(_sds, name, of, d, source))
                    for d, of in groups.items()]  # fmt: skip
        out.append(over_readings(readings))
    return out


def _groups(splits: Splits, with_sd: bool, divisor: str) -> dict[str, list[summaries.Group]]:
    out: dict[str, list[summaries.Group]] = {}
    for by, rows in splits.items():
        for row in rows:
            sd = row["sd"] if with_sd else "0" if row["n"] != "1" else ""
            try:
                found = summaries.groups([row["n"]], [row["mean"]], [sd], divisor=divisor)
            except SignkinError as error:
                raise row.at(error) from None
            out.setdefault(by, []).extend(found)
    return out


def _means(name: str, splits: dict[str, list[summaries.Group]], source: str) -> Finding:
    found = {by: summaries.pooled_mean(of) for by, of in splits.items()}
    hand = {
        by: sum((g.by_hand[0] * g.n for g in of), Fraction(0)) / sum(g.n for g in of)
        for by, of in splits.items()
    }
    low, high = max(v.low for v in found.values()), min(v.high for v in found.values())
    told = ", ".join(f"{by} {shown(v)}" for by, v in hand.items())
    return _finding(
        f"{name}, mean".lstrip(", "), f"the weighted means are {told}", low <= high,
        (float(low), float(high)), source, "sum of n x mean, over the sum of n", "",
    )  # fmt: skip


def _sds(name: str, splits: dict[str, list[summaries.Group]], divisor: str, source: str) -> Finding:
    found = {by: summaries.pooled_sd(of, divisor) for by, of in splits.items()}
    low, high = max(v.low for v in found.values()), min(v.high for v in found.values())
    told = ", ".join(f"{by} {v.value:.5g}" for by, v in found.items())
    tiny = 1e-9 * max(1.0, abs(high))
    return _finding(
        f"{name}, SD".lstrip(", "), f"the SDs of all values are {told}", low <= high + tiny,
        (low, high), source, "squares within groups and between them, over the divisor",
        f"divisor {divisor}",
    )  # fmt: skip


def _finding(
    item: str, why: str, fits: bool, common: Sequence[float], source: str, hand: str, settings: str
) -> Finding:
    if not fits:
        why += "; no rounding makes them one, with the same people and no value missing"
    interval = f"{common[0]:.6g} to {common[1]:.6g}" if fits else "nothing in common"
    return Finding(
        verdict_of(fits), why, item=item, interval=interval, source=source, hand=hand,
        settings=settings, severity="" if fits else DIGITS,
        recomputed=why.partition(" are ")[2].partition(";")[0],
    )  # fmt: skip
