"""Checks on printed tables of n, mean and SD, and on single ones.

A check that takes a table names its columns (`n`, `mean`, `sd`); without a table the same
arguments are printed numbers: names of the claim's (or another claim's, `N02.mean`), or digits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial

from signkin.audit import summaries
from signkin.audit.checks.rows import (
    ABSENT,
    Row,
    each,
    groups_of,
    item,
    one_digit,
    rows_of,
    scale_columns,
    scale_of,
    verdict_of,
    want_settings,
)
from signkin.audit.findings import (
    CONSISTENT,
    INCONSISTENT,
    UNDECIDABLE,
    Finding,
    over_readings,
)
from signkin.audit.grim import grim as grim_of
from signkin.audit.grimmer import DIVISORS
from signkin.audit.grimmer import grimmer as grimmer_of
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.rounding import Interval, allowed, count, shown
from signkin.errors import SignkinError

SMALL = "group,n,mean,sd\na,12,4.10,0.90\nb,12,4.00,1.00\nc,12,7.00,0.80\n"


@on_print("tables", {"table": "table1.csv", "column": "n", "equals": "36"}, SMALL)
def total(context: OnPrint, table: str, column: str, equals: str) -> list[Finding]:
    """The counts of a column add up to a printed number."""
    wanted = context.text(equals)
    number = count(wanted)
    found = 0
    for row in context.paper.table(table):
        text = row[column].strip()
        if text in ABSENT:
            continue
        if not text.isdigit():
            raise SignkinError(
                f"{column} is {text!r}", file=row.file, place=row.place, expected="a whole number"
            )
        found += int(text)
    why = f"the column {column} of {table} adds up to {found}, printed is {wanted}"
    return [
        Finding(verdict_of(found == number), why, wanted, str(found), str(found),
                source=context.source(table), hand=f"add up the column {column}")
    ]  # fmt: skip


@on_print("means and SDs", {"mean": "5.19", "n": "28", "grain": "1"}, outcome=INCONSISTENT)
def grim(
    context: OnPrint,
    grain: str,
    table: str = "",
    suffixes: Sequence[str] = ("",),
    n: str = "n",
    mean: str = "mean",
    items: str = "1",
    rounding: str = "nearest",
) -> list[Finding]:
    """Each row's mean is possible for its n on the grain (GRIM).

    grain: the step of one answer, a number or a ratio (`1/3`); 100 for percentages of people.
    items: how many answers each person's value is the mean of.
    """
    want_settings(grain, items, rounding=rounding)

    fits = partial(_grim_fits, grain, rounding, items)

    def judge(row: Row) -> Finding:
        found = grim_of(row["mean"], row["n"], grain, rounding, items)
        step = grain if items == "1" else f"({grain} / {items})"
        hand = f"{row['mean']} x {row['n']} / {step}, to the next whole number and back"
        nearest = ""
        if found.verdict == INCONSISTENT:
            near = one_digit({"mean": row["mean"], "n": row["n"]}, fits)
            nearest = f"{found.nearest}; {near}"
        settings = _settings(grain, items, rounding)
        return replace(found, settings=settings, hand=hand, nearest=nearest)

    return each(rows_of(context, table, {"n": n, "mean": mean}, suffixes), judge)


def _by_hand(row: Row) -> str:
    return (
        f"{row['mean']} x {row['n']} / grain is near a whole number, the sum s; "
        f"{row['sd']}^2 x ({row['n']} - 1) / grain^2 + s^2 / {row['n']} is, too, odd or even as s"
    )


def _grim_fits(grain: str, rounding: str, items: str, cells: Mapping[str, str]) -> bool:
    found = grim_of(cells["mean"], cells["n"], grain, rounding, items)
    return found.verdict != INCONSISTENT


def _settings(grain: str, items: str, rounding: str, divisor: str = "") -> str:
    parts = [f"grain {grain}"] + ([f"items {items}"] if items != "1" else [])
    parts += [f"divisor {divisor}"] if divisor else []
    parts += [f"rounding {rounding}"] if rounding != "nearest" else []
    return ", ".join(parts)


@on_print(
    "means and SDs", {"mean": "3.44", "sd": "2.47", "n": "18", "grain": "1"}, outcome=INCONSISTENT
)
def grimmer(
    context: OnPrint,
    grain: str,
    table: str = "",
    divisor: str = "same",
    suffixes: Sequence[str] = ("",),
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
    items: str = "1",
    low: str = "",
    high: str = "",
    spread: str = "sd",
    rounding: str = "nearest",
) -> list[Finding]:
    """Each row's mean and SD are possible for its n on the grain (exact GRIMMER).

    divisor: n-1, n, either (a row at a time), or same: the one that most rows pass with, for
    all rows. items: answers that each value is the mean of. low, high: the ends of the scale, or
    columns with those of each row. spread: sd, se (standard errors are printed), or either.
    """
    want_settings(grain, items, divisor, rounding, spread, ("either", "same"))
    asked = "either" if divisor == "same" else divisor
    kept: dict[tuple[str, str | None], tuple[Row, dict[str, bool]]] = {}

    def once(row: Row, kind: str) -> Finding:
        found = grimmer_of(row["mean"], row["sd"], row["n"], grain, asked, rounding, items,
                           *scale_of(context, row, low, high), kind)  # fmt: skip
        passed = {d: bool(found.pairs.get(d)) for d in DIVISORS}
        kept[row.name, row.place] = (row, passed)
        if row["n"] == "1" and row.file is not None:
            return replace(found, why=f"{row.file.name}, {row.place}: {found.why}", recomputed="",
                           interval="")  # fmt: skip
        nearest = found.nearest
        if nearest:  # the mean fails alone
            digits = {"mean": row["mean"], "n": row["n"]}
            nearest += f"; {one_digit(digits, partial(_grim_fits, grain, rounding, items))}"
        elif found.verdict == INCONSISTENT:
            nearest = found.recomputed
        return replace(found, settings=_settings(grain, items, rounding, asked), nearest=nearest,
                       hand=_by_hand(row),
                       recomputed="" if found.recomputed.startswith("nearest") else
                       found.recomputed)  # fmt: skip

    def judge(row: Row) -> Finding:
        if spread != "either":
            return once(row, spread)
        names = {"sd": "SDs", "se": "standard errors"}
        return over_readings([(name, partial(once, row, s)) for s, name in names.items()])

    columns = {"n": n, "mean": mean, "sd": sd, **scale_columns(context, table, low, high)}
    found = each(rows_of(context, table, columns, suffixes), judge)
    return _with_one_divisor(found, kept) if divisor == "same" else found


def _with_one_divisor(
    found: list[Finding], kept: dict[tuple[str, str | None], tuple[Row, dict[str, bool]]]
) -> list[Finding]:
    """Accuse rows that pass with the other divisor only than most rows do."""
    many = {name: passed for (name, _), (row, passed) in kept.items() if row["n"] != "1"}
    number = {d: sum(passed[d] for passed in many.values()) for d in DIVISORS}
    common = max(DIVISORS, key=lambda d: number[d])
    out = []
    for one in found:
        alone = one.item in many and one.verdict == CONSISTENT and not many[one.item][common]
        if alone and number[common] > 1:
            why = f"{one.why}, where {number[common]} of {len(many)} rows have {common}"
            one = replace(one, verdict=INCONSISTENT, why=why)
        out.append(one)
    return out


@on_print("means and SDs", {"mean": "0.35", "sd": "0.18", "n": "20"}, outcome=INCONSISTENT)
def debit(
    context: OnPrint,
    table: str = "",
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
    divisor: str = "either",
    rounding: str = "nearest",
) -> list[Finding]:
    """The mean and SD of values that are 0 or 1 belong together (DEBIT)."""
    want_settings("1", 1, divisor, rounding)

    def judge(row: Row) -> Finding:
        found = grimmer_of(row["mean"], row["sd"], row["n"], "1", divisor, rounding, low="0",
                           high="1")  # fmt: skip
        n_, m = count(row["n"]), float(allowed(row["mean"]).middle)
        by_hand = (max(0.0, m * (1 - m)) * n_ / max(1, n_ - 1)) ** 0.5
        why = found.why if found.verdict != INCONSISTENT else (
            f"{n_} values of 0 or 1 with mean {row['mean']} have an SD near {by_hand:.4g}, "
            f"printed is {row['sd']}"
        )  # fmt: skip
        return replace(found, why=why, recomputed=f"{by_hand:.4g}", nearest=f"SD {by_hand:.4g}",
                       settings=f"0 or 1, divisor {divisor}",
                       hand="sqrt(mean (1 - mean) n / (n - 1))")  # fmt: skip

    return each(rows_of(context, table, {"n": n, "mean": mean, "sd": sd}), judge)


@on_print("groups and the whole", {"table": "table1.csv", "mean_of_all": "5.03"}, SMALL)
def pooled(
    context: OnPrint,
    table: str,
    mean_of_all: str = "",
    sd_of_all: str = "",
    grain: str | None = None,
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
    divisor: str = "either",
    n_of_all: str = "",
) -> list[Finding]:
    """The groups of a table have the printed n, mean and SD of all values together.

    divisor: of the SDs, n-1, n or either. With n_of_all fewer than the groups add up to, the
    groups may overlap; more: some are not printed. Either is told, and nothing else then.
    """
    want_settings(grain, 1, divisor)
    columns = {"n": n, "mean": mean, "sd": sd}
    source = context.source(table)
    first = DIVISORS[0] if divisor == "either" else divisor
    of = [group for _, group in groups_of(context, table, columns, grain, first)]
    if not of:
        raise SignkinError(f"{table} has no filled row", expected="groups with n, mean and SD")
    size = sum(g.n for g in of)
    out = []
    if n_of_all:
        wanted = count(context.text(n_of_all))
        why = f"the groups of {table} have {size} values together, printed is {wanted}"
        out.append(Finding(verdict_of(size == wanted), why, str(wanted), str(size), str(size),
                           source, "n"))  # fmt: skip
        if size != wanted:
            return out
    if mean_of_all:
        text = context.text(mean_of_all)
        found = summaries.pooled_mean(of)
        hand = shown(sum(g.by_hand[0] * g.n for g in of) / size)
        fits = found.meets(allowed(text))
        why = f"the weighted mean of {len(of)} rows is {hand}, printed is {text}"
        out.append(Finding(verdict_of(fits), why, text, hand, str(found), source, "mean",
                           hand="sum of n x mean, over the sum of n"))  # fmt: skip
    if sd_of_all:
        text = context.text(sd_of_all)

        def with_divisor(d: str) -> Finding:
            groups = [group for _, group in groups_of(context, table, columns, grain, d)]
            spread = summaries.pooled_sd(groups, d)
            wide = Interval(_less_tiny(spread.low), _more_tiny(spread.high))
            by = d.replace("-", " - ")
            why = f"the SD of all {size} values is {spread.value:.6g} (divisor {by})"
            return Finding(verdict_of(wide.meets(allowed(text))), f"{why}, printed is {text}", text,
                           f"{spread.value:.6g}", spread.interval, source, "SD",
                           f"divisor {d}")  # fmt: skip

        readings = DIVISORS if divisor == "either" else (divisor,)
        out.append(over_readings([(f"divisor {d}", partial(with_divisor, d)) for d in readings]))
    return out


def _less_tiny(x: float) -> Fraction:
    return Fraction(x * (1 - 1e-12))


def _more_tiny(x: float) -> Fraction:
    return Fraction(x * (1 + 1e-12))


@on_print(
    "groups and the whole",
    {"table": "table1.csv", "row": "a", "suffix": "_without"},
    "group,n,mean,sd,n_without,mean_without,sd_without\na,4,2.50,1.291,3,2.00,1.000\n",
)
def left_out(
    context: OnPrint,
    table: str,
    row: str,
    suffix: str,
    grain: str | None = None,
    at_most: str = "",
    at_least: str = "",
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
    divisor: str = "either",
) -> list[Finding]:
    """The value that a row prints with and without: the same by sum and by squares.

    With at_most or at_least, whether that value keeps a printed bound instead.
    """
    want_settings(grain, 1, divisor)
    found = [r for r in context.paper.table(table) if next(iter(r.cells.values())) == row]
    if len(found) != 1:
        raise SignkinError(f"{table} has {len(found)} rows {row!r}", expected="one")
    cells = found[0]
    columns = [[cells[f"{c}{end}"] for end in ("", suffix)] for c in (n, mean, sd)]
    source = context.source(table)
    try:
        sizes = [count(text) for text in columns[0]]
        if sizes[0] != sizes[1] + 1:
            ns = columns[0]
            why = (
                f"row {row} of {table} has n = {ns[0]} with and {ns[1]} without the value left out"
            )
            verdict = UNDECIDABLE if at_most or at_least else INCONSISTENT
            return [Finding(verdict, why, f"n = {ns[0]} ({ns[1]})", source=source)]
        bounds = (
            context.text(at_most) if at_most else "",
            context.text(at_least) if at_least else "",
        )
        where = (row, table, source)
        readings = DIVISORS if divisor == "either" else (divisor,)
        return [
            over_readings([
                (f"SDs with divisor {d}", partial(_left_out, columns, grain, bounds, where, d))
                for d in readings
            ])
        ]  # fmt: skip
    except SignkinError as error:
        raise error.at(file=cells.file, place=cells.place) from None


def _left_out(
    columns: list[list[str]], grain: str | None, bounds: tuple[str, str],
    where: tuple[str, str, str], divisor: str,
) -> Finding:  # fmt: skip
    (ns, means, sds), (row, table, source) = columns, where
    exact = summaries.groups(ns, means, sds, grain, divisor=divisor)
    rough = summaries.groups(ns, means, sds, divisor=divisor)
    by_sum, by_squares = summaries.left_out(*exact)
    rough_sum, rough_squares = summaries.left_out(*rough)
    if grain is not None:
        for size, middle, spread in zip(ns, means, sds, strict=True):
            alone = grimmer_of(middle, spread, size, grain, divisor)
            if alone.verdict == INCONSISTENT:
                return Finding(INCONSISTENT, alone.why, f"{middle} ({spread})", source=source)
    if any(bounds):
        text = bounds[0] or bounds[1]
        bound, value = allowed(text), rough_sum
        fits = value.low <= bound.high if bounds[0] else value.high >= bound.low
        word = "at most" if bounds[0] else "at least"
        why = (
            f"row {row} of {table} holds a value of {shown(value.middle)} (by its sums with and "
            f"without it); printed is {word} {text}"
        )
        return Finding(verdict_of(fits), why, f"{word} {text}", shown(value.middle), str(value),
                       source)  # fmt: skip
    fits = by_sum.meets(by_squares) and rough_sum.meets(rough_squares)
    why = (
        f"by the sums the value left out is {by_sum}, by the squares {by_squares}"
        if fits
        else f"by the sums the value left out is {rough_sum}, by the squares {rough_squares}"
    )
    interval = f"{rough_sum} by sum, {rough_squares} by squares"
    printed = f"{means[0]} ({sds[0]}); {means[1]} ({sds[1]})"
    return Finding(
        verdict_of(fits), why, printed, shown(by_sum.middle), interval, source,
        settings=f"divisor {divisor}", hand="n x mean with, less n x mean without",
    )  # fmt: skip


@on_print(
    "means and SDs",
    {"mean": "4.50", "sd": "2.09", "n": "20", "grain": "1", "low": "1", "high": "5"},
    outcome=INCONSISTENT,
)
def range_possible(
    context: OnPrint,
    grain: str,
    table: str = "",
    low: str = "",
    high: str = "",
    suffix: str = "",
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
    divisor: str = "either",
    items: str = "1",
) -> list[Finding]:
    """Each row can come from values between printed bounds.

    low, high: numbers, or columns with those of each row. suffix: rows that have columns with it
    filled are taken without their outlier.
    """
    want_settings(grain, items, divisor)
    columns = {"n": n, "mean": mean, "sd": sd, **scale_columns(context, table, low, high)}
    without = {r.place: r for r in rows_of(context, table, columns, (suffix,))} if suffix else {}

    def judge(row: Row) -> Finding:
        row = without.get(row.place, row)
        bounds = scale_of(context, row, low, high)
        ends = dict(zip(("low", "high"), bounds, strict=True))
        told = " and ".join(
            f"{word} {end}"
            for word, end in zip(("at least", "at most"), bounds, strict=True)
            if end
        )
        if row["n"] == "1":
            mean_alone = grim_of(row["mean"], 1, grain, items=items)
            found = grimmer_of(row["mean"], "0", 1, grain, items=items, **ends)
            fits = {INCONSISTENT: False}.get(found.verdict, True) if mean_alone.sums else None
        else:
            spread = row["sd"]
            found = grimmer_of(row["mean"], spread, row["n"], grain, divisor, items=items, **ends)
            fits = {CONSISTENT: True, INCONSISTENT: False}.get(found.verdict)
            if fits is False:  # off the grain, whatever the bounds
                free = grimmer_of(row["mean"], spread, row["n"], grain, divisor, items=items)
                fits = False if free.verdict == CONSISTENT else None
        why = f"the row can{'' if fits else ' not'} come from values {told}"
        if fits is None:
            why = "the row has no sample on the grain, or the search is too long"
        nearest = ""
        if fits is False and found.why.startswith("the mean"):
            why, nearest = f"{why}: {found.why}", told
        settings = _settings(grain, items, "nearest", divisor)
        printed = f"{row['mean']} ({row['sd']})"
        return Finding(verdict_of(fits), why, printed, told, settings=settings, nearest=nearest)

    found = each(rows_of(context, table, columns), judge)
    names = {r.place: r.name for r in without.values()}
    rows = {r.name: r.place for r in rows_of(context, table, columns)}
    return [item(f, names.get(rows.get(f.item), f.item), f.source) for f in found]
