"""Checks on what a paper prints. Each returns findings; claims.yaml names them.

Where a check takes a number (`equals`, `at_most`) it is the name of a printed number of the
claim, of another claim (`N02.mean`), or digits in quotes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import ceil, floor

from signkin.audit import significance, summaries
from signkin.audit.expressions import evaluate
from signkin.audit.findings import CONSISTENT, INCONSISTENT, UNDECIDABLE, Finding
from signkin.audit.grim import grain_of
from signkin.audit.grim import grim as grim_of
from signkin.audit.grimmer import DIVISORS, possible
from signkin.audit.grimmer import grimmer as grimmer_of
from signkin.audit.paper import PrintedRow
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.rounding import Interval, allowed, as_interval, count, exactly, shown
from signkin.errors import SignkinError, listed

ABSENT = ("", "/", "-", "–")


def _filled(
    context: OnPrint, table: str, n: str, mean: str, suffixes: Sequence[str]
) -> Iterator[tuple[PrintedRow, str, str]]:
    """Yield (row, suffix, name) of the rows that have values; n = 0 beside a mean is an error."""
    for row in context.paper.table(table):
        for suffix in suffixes:
            text = row[f"{n}{suffix}"]
            if text == "0" and row[f"{mean}{suffix}"] not in ABSENT:
                raise SignkinError(
                    f"n is 0 beside the mean {row[f'{mean}{suffix}']}",
                    file=row.file,
                    place=row.place,
                    expected="a whole number from 1, or no mean",
                )
            if text in ABSENT or text == "0":
                continue
            name = next(iter(row.cells.values()))
            yield row, suffix, name + suffix.replace("_", " ")


def _at(row: PrintedRow, error: SignkinError) -> SignkinError:
    return error.at(file=row.file, place=row.place)


def _verdict(fits: bool | None) -> str:
    return UNDECIDABLE if fits is None else CONSISTENT if fits else INCONSISTENT


def _groups(
    context: OnPrint, table: str, n: str, mean: str, sd: str, grain: str | None, suffix: str = ""
) -> list[tuple[str, summaries.Group]]:
    """Return the groups of a table by the name in its first column.

    suffix: take the columns with it (`_without_outlier`) where a row has them filled.
    """
    out = []
    for row, _, name in _filled(context, table, n, mean, ("",)):
        end = suffix if suffix and row[f"{n}{suffix}"] not in ABSENT else ""
        cells = [row[f"{c}{end}"] for c in (n, mean, sd)]
        try:
            of = summaries.groups([cells[0]], [cells[1]], [cells[2]], grain)
            out.append((name, of[0]))
        except SignkinError as error:
            raise _at(row, error) from None
    return out


@on_print
def total(context: OnPrint, table: str, column: str, equals: str) -> list[Finding]:
    """The counts of a column add up to a printed number."""
    found = 0
    for row in context.paper.table(table):
        text = row[column]
        if text in ABSENT:
            continue
        if not text.isdigit():
            raise SignkinError(
                f"{column} is {text!r}", file=row.file, place=row.place, expected="a whole number"
            )
        found += int(text)
    wanted = context.text(equals)
    fits = found == int(count(wanted))
    why = f"the column {column} of {table} adds up to {found}, printed is {wanted}"
    source = context.source(table)
    return [Finding(_verdict(fits), why, wanted, str(found), str(found), source=source)]


@on_print
def grim(
    context: OnPrint,
    table: str,
    grain: str,
    suffixes: Sequence[str] = ("",),
    n: str = "n",
    mean: str = "mean",
) -> list[Finding]:
    """Each row's mean is possible for its n on the grain (GRIM)."""
    out = []
    for row, suffix, name in _filled(context, table, n, mean, suffixes):
        try:
            found = grim_of(row[f"{mean}{suffix}"], row[f"{n}{suffix}"], grain)
        except SignkinError as error:
            raise _at(row, error) from None
        out.append(_item(found, name, context.source(table)))
    return out


@on_print
def grimmer(
    context: OnPrint,
    table: str,
    grain: str,
    divisor: str = "same",
    suffixes: Sequence[str] = ("",),
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
) -> list[Finding]:
    """Each row's mean and SD are possible for its n on the grain (exact GRIMMER).

    divisor: n-1, n, either (a row at a time), or same: the one that most rows pass with, for
    all rows.
    """
    found = []
    for row, suffix, name in _filled(context, table, n, mean, suffixes):
        cells = [row[f"{c}{suffix}"] for c in (mean, sd, n)]
        asked = "either" if divisor == "same" else divisor
        try:
            found.append((row, cells, name, grimmer_of(cells[0], cells[1], cells[2], grain, asked)))
        except SignkinError as error:
            raise _at(row, error) from None
    many = [result for _, cells, _, result in found if cells[2] != "1"]
    passed = {d: sum(bool(result.pairs.get(d)) for result in many) for d in DIVISORS}
    common = max(DIVISORS, key=lambda d: passed[d])
    source = context.source(table)
    out = []
    for row, cells, name, result in found:
        if cells[2] == "1":
            why = f"{row.file.name}, {row.place}: {result.why}"
            out.append(Finding(result.verdict, why, cells[1], source=source, item=name))
        elif divisor == "same" and result.verdict == CONSISTENT and not result.pairs[common]:
            why = f"{result.why}, where {passed[common]} of {len(many)} rows have {common}"
            out.append(_item(replace(result, verdict=INCONSISTENT, why=why), name, source))
        else:
            out.append(_item(result, name, source))
    return out


def _item(found: Finding, name: str, source: str) -> Finding:
    return Finding(
        found.verdict, found.why, found.printed, found.recomputed, found.interval, source, name
    )


@on_print
def pooled(
    context: OnPrint,
    table: str,
    mean_of_all: str = "",
    sd_of_all: str = "",
    grain: str | None = None,
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
) -> list[Finding]:
    """The groups of a table have the printed mean and SD of all values together."""
    of = [group for _, group in _groups(context, table, n, mean, sd, grain)]
    out = []
    source = context.source(table)
    if mean_of_all:
        text = context.text(mean_of_all)
        found = summaries.pooled_mean(of)
        fits = found.meets(allowed(text))
        why = f"the weighted mean of {len(of)} rows is {shown(found.middle)}, printed is {text}"
        out.append(Finding(_verdict(fits), why, text, shown(found.middle), str(found), source,
                           "mean"))  # fmt: skip
    if sd_of_all:
        text = context.text(sd_of_all)
        spread = summaries.pooled_sd(of)
        fits = Interval(Fraction(spread.low), Fraction(spread.high)).meets(allowed(text))
        why = f"the SD of all {sum(g.n for g in of)} values is {spread.value:.6g} (divisor n - 1)"
        out.append(Finding(_verdict(fits), f"{why}, printed is {text}", text,
                           f"{spread.value:.6g}", spread.interval, source, "SD"))  # fmt: skip
    return out


@on_print
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
) -> list[Finding]:
    """The value that a row prints with and without: the same by sum and by squares.

    With at_most or at_least, whether that value keeps a printed bound instead.
    """
    found = [r for r in context.paper.table(table) if next(iter(r.cells.values())) == row]
    if len(found) != 1:
        raise SignkinError(f"{table} has {len(found)} rows {row!r}", expected="one")
    cells = found[0]
    ns, means, sds = ([cells[f"{c}{end}"] for end in ("", suffix)] for c in (n, mean, sd))
    source = context.source(table)
    if count(ns[0]) != count(ns[1]) + 1:
        why = f"row {row} of {table} has n = {ns[0]} with and {ns[1]} without the value left out"
        verdict = UNDECIDABLE if at_most or at_least else INCONSISTENT
        return [Finding(verdict, why, f"n = {ns[0]} ({ns[1]})", source=source)]
    try:
        exact = summaries.groups(ns, means, sds, grain)
        rough = summaries.groups(ns, means, sds)
        by_sum, by_squares = summaries.left_out(*exact)
        rough_sum, rough_squares = summaries.left_out(*rough)
    except SignkinError as error:
        raise _at(cells, error) from None
    if grain is not None:
        for size, middle, spread in zip(ns, means, sds, strict=True):
            alone = grimmer_of(middle, spread, size, grain, "n-1")
            if alone.verdict == INCONSISTENT:
                return [Finding(INCONSISTENT, alone.why, f"{middle} ({spread})", source=source)]
    if at_most or at_least:
        bound = allowed(context.text(at_most or at_least))
        value = rough_sum
        fits = value.low <= bound.high if at_most else value.high >= bound.low
        word = "at most" if at_most else "at least"
        why = (
            f"row {row} of {table} holds a value of {shown(value.middle)} (by its sums with and "
            f"without it); printed is {word} {context.text(at_most or at_least)}"
        )
        printed = f"{word} {context.text(at_most or at_least)}"
        return [Finding(_verdict(fits), why, printed, shown(value.middle), str(value), source)]
    fits = by_sum.meets(by_squares) and rough_sum.meets(rough_squares)
    why = (
        f"by the sums the value left out is {by_sum}, by the squares {by_squares}"
        if fits
        else f"by the sums the value left out is {rough_sum}, by the squares {rough_squares}"
    )
    interval = f"{rough_sum} by sum, {rough_squares} by squares"
    printed = f"{means[0]} ({sds[0]}); {means[1]} ({sds[1]})"
    return [Finding(_verdict(fits), why, printed, shown(by_sum.middle), interval, source)]


@on_print
def range_possible(
    context: OnPrint,
    table: str,
    grain: str,
    low: str = "",
    high: str = "",
    suffix: str = "",
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
) -> list[Finding]:
    """Each row can come from values between printed bounds.

    suffix: rows that have columns with it filled are taken without their outlier.
    """
    step = grain_of(grain)
    bottom = ceil(exactly(context.text(low)) / step) if low else None
    top = floor(exactly(context.text(high)) / step) if high else None
    told = " and ".join(
        f"{word} {context.text(name)}"
        for word, name in (("at least", low), ("at most", high))
        if name
    )
    out = []
    for row, _, name in _filled(context, table, n, mean, ("",)):
        end = suffix if suffix and row[f"{n}{suffix}"] not in ABSENT else ""
        cells = [row[f"{c}{end}"] for c in (n, mean, sd)]
        if cells[0] == "1":
            sums = grim_of(cells[1], 1, grain).sums
            fits: bool | None = None
            if sums:
                fits = any(
                    (bottom is None or s >= bottom) and (top is None or s <= top) for s in sums
                )
        else:
            pairs = grimmer_of(cells[1], cells[2], cells[0], grain, "n-1").pairs.get("n-1", ())
            answers = [possible(int(cells[0]), s, q, bottom, top) for s, q in pairs]
            fits = True if True in answers else None if None in answers or not pairs else False
        why = f"the row can{'' if fits else ' not'} come from values {told}"
        if fits is None:
            why = "the row has no sample on the grain, or the search is too long"
        item = name + end.replace("_", " ")
        printed = f"{cells[1]} ({cells[2]})"
        out.append(Finding(_verdict(fits), why, printed, told, "", context.source(table), item))
    return out


@on_print
def groups_differ(
    context: OnPrint,
    table: str,
    differ: bool,
    test: str = "anova",
    alpha: float = 0.05,
    grain: str | None = None,
    rows: Sequence[str] = (),
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
) -> list[Finding]:
    """A test recomputed from printed groups is significant (`differ: true`), or is not.

    test: anova, welch or t (Welch's, two groups). rows: names in the first column; all without.
    For anova the smallest effect is told that the design finds with a power of 0.8: below it,
    not significant says little.
    """
    named = _groups(context, table, n, mean, sd, grain)
    _want_names(rows, dict(named), table)
    groups = [group for name, group in named if not rows or name in rows]
    tests = {"anova": summaries.anova, "welch": summaries.welch, "t": summaries.t_test}
    if test not in tests:
        raise SignkinError(f"test: {test}", expected=listed(tests))
    found = tests[test](groups)
    both = {found.p.low < alpha, found.p.high < alpha}
    fits = None if len(both) == 2 else both == {differ}
    letter = "t" if test == "t" else "F"
    df = f"{found.df2.value:.4g}" if test == "t" else f"{found.df1:g}, {found.df2.value:.4g}"
    why = f"{letter}({df}) = {found.statistic.value:.3f}, p = {found.p.value:.3f}"
    if test == "anova" and found.effect is not None:
        f = significance.smallest_effect([g.n for g in groups], 0.8, alpha)
        why += (
            f", eta squared {found.effect.value:.3f}; with these n, effects below eta squared "
            f"{f * f / (1 + f * f):.2f} (f = {f:.2f}) are missed more than 20 % of the time"
        )
    word = "significant" if differ else "not significant"
    recomputed = f"{letter} = {found.statistic.value:.3f}, p = {found.p.value:.3f}"
    statistic = f"{found.statistic.low:.4f} to {found.statistic.high:.4f}"
    interval = f"{letter} {statistic}, p {found.p.low:.4f} to {found.p.high:.4f}"
    return [Finding(_verdict(fits), why, word, recomputed, interval, context.source(table))]


@on_print
def order(
    context: OnPrint,
    table: str,
    lowest: Sequence[str] = (),
    highest: Sequence[str] = (),
    below: Sequence[Sequence[str]] = (),
    groups: Mapping[str, Sequence[str]] | None = None,
    suffix: str = "",
    n: str = "n",
    mean: str = "mean",
    sd: str = "sd",
) -> list[Finding]:
    """The means of a table's rows (or of groups of rows, weighted) stand in the printed order.

    lowest, highest: the first ones, in order. below: each of the first list under each of the
    second. suffix: without their outlier, where rows print it.
    """
    rows = dict(_groups(context, table, n, mean, sd, None, suffix))
    if groups is None:
        values = {name: group.mean for name, group in rows.items()}
    else:
        _want_names([name for names in groups.values() for name in names], rows, table)
        values = {
            name: summaries.pooled_mean([rows[kind] for kind in kinds])
            for name, kinds in groups.items()
        }
    names = [*lowest, *highest, *(name for part in below for name in part)]
    _want_names(names, values, table)
    pairs = ordered_pairs(list(values), lowest, highest, below)
    answers = [_less(values[a], values[b]) for a, b in pairs]
    wrong = [f"{a} is not under {b}" for (a, b), x in zip(pairs, answers, strict=True) if not x]
    fits = False if False in answers else None if None in answers else True
    shown_names = list(dict.fromkeys(names))
    told = ", ".join(f"{name} {shown(values[name].middle, 5)}" for name in shown_names)
    why = f"the means stand so: {told}" if fits else f"{'; '.join(wrong)} ({told})"
    return [Finding(_verdict(fits), why, "", told, source=context.source(table))]


def ordered_pairs(
    names: Sequence[str],
    lowest: Sequence[str],
    highest: Sequence[str],
    below: Sequence[Sequence[str]],
) -> list[tuple[str, str]]:
    """Return the pairs (smaller, larger) that an order claims."""
    pairs = []
    for i, name in enumerate(lowest):
        pairs += [(name, other) for other in names if other not in lowest[: i + 1]]
    for i, name in enumerate(highest):
        pairs += [(other, name) for other in names if other not in highest[: i + 1]]
    if below:
        pairs += [(a, b) for a in below[0] for b in below[1]]
    return pairs


def _less(a: Interval, b: Interval) -> bool | None:
    return True if a.high < b.low else False if a.low >= b.high else None


def _want_names(names: Sequence[str], there: Mapping[str, object], table: str) -> None:
    unknown = [name for name in names if name not in there]
    if unknown:
        raise SignkinError(
            f"{table} has no filled row {listed(unknown)}", expected=listed(there, 30)
        )


@on_print
def formula(context: OnPrint, value: str, equals: str, exact: Sequence[str] = ()) -> list[Finding]:
    """A formula with printed numbers gives the printed result, as far as rounding allows.

    exact: names of numbers that are counts or settings, not rounded.
    """
    found = as_interval(evaluate(value, context.values(tuple(exact))))
    text = context.text(equals)
    fits = found.meets(allowed(text)) if equals not in exact else exactly(text) in found
    why = f"{value} is {shown(found.middle)}, printed is {text}"
    if found.width:
        why = f"{value} is {shown(found.middle)} ({found}), printed is {text}"
    return [Finding(_verdict(fits), why, text, shown(found.middle), str(found))]


@on_print
def relation(context: OnPrint, holds: str, exact: Sequence[str] = ()) -> list[Finding]:
    """A relation between printed numbers holds for all values that rounding allows."""
    values = context.values(tuple(exact))
    answer = evaluate(holds, values)
    if answer not in (True, False, None):
        raise SignkinError(f"{holds!r} is no comparison", expected="one, such as `a < b`")
    word = {True: "holds", False: "does not hold", None: "is left open by rounding"}[answer]
    used = [name for name in values if name in holds.replace("(", " ").replace(")", " ").split()]
    told = ", ".join(f"{name} = {context.text(name)}" for name in used)
    return [Finding(_verdict(answer), f"{holds} {word}" + (f" ({told})" if told else ""), told)]


@on_print
def p_value(
    context: OnPrint, kind: str, statistic: str, p: str, df: Sequence[float] = (),
    alpha: str = "0.05",
) -> list[Finding]:  # fmt: skip
    """A printed p belongs to a printed statistic (F, t, chi2, H, z)."""
    found = significance.p_agrees(kind, context.text(statistic), df, context.text(p), alpha)
    return [found]


@on_print
def p_reachable(context: OnPrint, groups: Sequence[int], p: str) -> list[Finding]:
    """A Kruskal-Wallis test of groups of this size can reach a p below the printed one."""
    h, least = significance.kruskal_limit(groups)
    printed = context.text(p)
    fits = least < float(exactly(printed.lstrip("<").strip()))
    shape = f"{len(groups)} groups of {groups[0]}" if len(set(groups)) == 1 else (
        f"groups of {listed(groups)}"
    )  # fmt: skip
    why = f"{shape} can reach H = {h:.1f}, p = {least:.2g}; printed is p {printed}"
    return [Finding(_verdict(fits), why, f"p {printed}", f"p down to {least:.2g}")]


@on_print
def chains(
    context: OnPrint, table: str, sequences: str, column: str = "n", kind: str = "type"
) -> list[Finding]:
    """What counts of transitions imply: the least number of unbroken chains of signs.

    sequences: the printed number of recordings, which must then have been broken up where it
    is smaller. That is no contradiction: the finding is consistent and says what follows.
    """
    rows = context.paper.table(table)
    counts = {row[kind]: int(row[column]) for row in rows if row[column].isdigit()}
    least, kinds = summaries.chains(counts)
    told = ", ".join(f"{k} {before} before, {after} after" for k, (before, after) in kinds.items())
    printed = int(count(context.text(sequences)))
    why = f"the counts need {least} unbroken chains of signs or more ({told})"
    if least > printed:
        why += f": the {printed} sequences were broken up"
    return [
        Finding(CONSISTENT, why, f"{printed} sequences", f"{least} chains or more",
                source=context.source(table))
    ]  # fmt: skip
