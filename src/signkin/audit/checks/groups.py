"""Checks on tests between printed groups: what their n, means and SDs give, and their order."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import inf

from scipy import stats

from signkin.audit import significance, summaries, two_groups
from signkin.audit.checks.rows import groups_of, open_readings, verdict_of, want_settings
from signkin.audit.checks.tables import SMALL
from signkin.audit.findings import (
    CONSISTENT,
    DECISION,
    DIGITS,
    INCONSISTENT,
    Finding,
    over_readings,
)
from signkin.audit.pvalues import printed_p, printed_statistic
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.rounding import Interval, allowed, count, exactly, is_number, shown
from signkin.audit.summaries import Range
from signkin.errors import SignkinError, listed


@on_print("tests of groups", {"table": "table1.csv", "differ": True, "test": "anova"}, SMALL)
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
    divisor: str = "n-1",
) -> list[Finding]:
    """A test recomputed from printed groups is significant (`differ: true`), or is not.

    test: anova, welch or t (Welch's, two groups). rows: names in the first column; all without.
    For anova the smallest effect is told that the design finds with a power of 0.8: below it,
    not significant says little. divisor: of the SDs, n-1, n or either.
    """
    want_settings(grain, 1, divisor)
    tests: dict[str, Callable[[Sequence[summaries.Group]], summaries.Test]] = {
        "anova": summaries.anova, "welch": summaries.welch, "t": summaries.t_test,
    }  # fmt: skip
    if test not in tests:
        raise SignkinError(f"test: {test}", expected=listed(tests))
    if not 0 < alpha < 1:
        raise SignkinError(f"alpha is {alpha}", expected="a number between 0 and 1")

    def once(d: str) -> Finding:
        named = groups_of(context, table, {"n": n, "mean": mean, "sd": sd}, grain, d)
        want_names(rows, dict(named), table)
        groups = [group for name, group in named if not rows or name in rows]
        return _differ(groups, tests[test], test, alpha, differ, context.source(table))

    return [over_readings([(name, partial(once, d)) for name, d, _ in open_readings(divisor)])]


def _differ(
    groups: Sequence[summaries.Group],
    function: Callable[[Sequence[summaries.Group]], summaries.Test],
    test: str, alpha: float, differ: bool, source: str,
) -> Finding:  # fmt: skip
    found = function(groups)
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
    severity = DECISION if fits is False else ""
    return Finding(verdict_of(fits), why, word, recomputed, interval, source, severity=severity)


@on_print(
    "tests of groups",
    {"n": ["30", "30"], "mean": ["5.10", "4.20"], "sd": ["1.50", "1.40"], "t": "2.40", "p": ".02"},
)
def test_of_groups(
    context: OnPrint,
    table: str = "",
    test: str = "open",
    t: str = "",
    F: str = "",
    df: str = "",
    p: str = "",
    d: str = "",
    rows: Sequence[str] = (),
    n: Sequence[str] = ("n",),
    mean: Sequence[str] = ("mean",),
    sd: Sequence[str] = ("sd",),
    divisor: str = "either",
    spread: str = "sd",
    tails: str = "open",
    alpha: str = "0.05",
) -> list[Finding]:
    """A printed t, F, df, p or d of independent groups is what their n, means and SDs give.

    test: student, welch (t of two groups), anova, welch_anova, or open: each that fits the number
    of groups is tried, with each divisor (spread: sd, se or either) that is left open. Without a
    table, n, mean and sd are lists of as many numbers. Signs of t and d are not looked at. d may be
    by the pooled SD, Hedges' g, Glass's delta or by the mean variance: the finding names which.
    """
    want_settings(None, 1, divisor, "nearest", spread)
    printed = {name: context.text(text) for name, text in
               (("t", t), ("F", F), ("df", df), ("p", p), ("d", d)) if text}  # fmt: skip
    if not printed:
        raise SignkinError("nothing to set the groups against", expected="t, F, df, p or d")
    if tails not in ("open", "two", "one"):
        raise SignkinError(f"tails: {tails!r}", expected="open, two, one")
    numbers = [[context.text(v) for v in values] for values in (n, mean, sd)]
    columns = {"n": n[0], "mean": mean[0], "sd": sd[0]}

    def groups(of_divisor: str, of_spread: str) -> list[summaries.Group]:
        if not table:
            return summaries.groups(
                numbers[0], numbers[1], numbers[2], divisor=of_divisor, spread=of_spread
            )
        named = groups_of(context, table, columns, None, of_divisor, of_spread)
        want_names(rows, dict(named), table)
        return [group for name, group in named if not rows or name in rows]

    kinds = _tests(test, len(groups(*open_readings(divisor, spread)[0][1:])), printed)
    readings = [
        (f"{kind}, {name}, {tail}" if "p" in printed and kind in ("student", "welch")
         else f"{kind}, {name}",
         partial(_given, kind, groups, (of_divisor, of_spread), printed, alpha, tail,
                 context.source(table) if table else ""))
        for tail in _tails(tails, printed, kinds)
        for name, of_divisor, of_spread in open_readings(divisor, spread)
        for kind in kinds
    ]  # fmt: skip
    return [over_readings(readings)]


test_of_groups.__test__ = False  # type: ignore[attr-defined] # no test of pytest's


def _tails(tails: str, printed: Mapping[str, str], kinds: Sequence[str]) -> tuple[str, ...]:
    if "p" not in printed or not {"student", "welch"} & set(kinds):
        return ("two",)
    return {"open": ("two", "one"), "two": ("two",), "one": ("one",)}[tails]


def _tests(test: str, number: int, printed: Mapping[str, str]) -> tuple[str, ...]:
    two, more = ("student", "welch"), ("anova", "welch_anova")
    if test != "open":
        if test not in (*two, *more):
            raise SignkinError(f"test: {test}", expected=listed((*two, *more, "open")))
        return (test,)
    if number == 2 and "F" not in printed:
        return two
    return more if "t" not in printed and "d" not in printed else two


def _given(
    kind: str, groups: Callable[[str, str], list[summaries.Group]], reading: tuple[str, str],
    printed: Mapping[str, str], alpha: str, tail: str, source: str,
) -> Finding:  # fmt: skip
    """Return the finding of all printed numbers under one reading."""
    of = groups(*reading)
    found: dict[str, list[Range]] = {}
    variants: list[str] = []
    if kind in ("student", "welch"):
        two = two_groups.compare(of, kind == "student")
        p = two.p if tail == "two" else Range(two.p.value / 2, two.p.low / 2, two.p.high / 2)
        found = {"t": [two.t], "df": [two.df], "p": [p],
                 "d": [two.d, two.g, *(value for _, value in two.others)]}  # fmt: skip
        variants = ["", "d as Hedges' g", *(f"d as {name}" for name, _ in two.others)]
    else:
        test = (summaries.anova if kind == "anova" else summaries.welch)(of)
        found = {"F": [test.statistic], "df": [test.df2], "p": [test.p]}
    unknown = [name for name in printed if name not in found]
    if unknown:
        raise SignkinError(f"{listed(unknown)} is no number of {kind}", expected=listed(found))
    wrong, told, intervals, severe, as_variant = [], [], [], False, ""
    for name, text in printed.items():
        fitting = [_printed_in(name, text, value, alpha) for value in found[name]]
        fits = any(fitting)
        place = fitting.index(True) if fits else 0
        as_variant = as_variant or (variants[place] if name == "d" else "")
        first = found[name][place]
        told.append(f"{name} = {first.value:.4g}")
        intervals.append(f"{name} {first.low:.4g} to {first.high:.4g}")
        if not fits:
            wrong.append(f"{name} is {text}")
            said = (
                printed_p(printed["p"], alpha).significant(float(alpha)) if "p" in printed else None
            )
            if said is None and name in ("t", "F"):
                said = _p_of(name, text, of, found) < float(alpha)
            severe = severe or (said is not None and said != (found["p"][0].value < float(alpha)))
    why = f"the groups give {', '.join(told)}"
    why += f" ({as_variant})" if as_variant else ""
    why += f", printed {', '.join(wrong)}" if wrong else ""
    shown_print = ", ".join(f"{name} {text}" for name, text in printed.items())
    return Finding(
        INCONSISTENT if wrong else CONSISTENT, why, shown_print, ", ".join(told),
        ", ".join(intervals), source, settings=f"{kind}, {reading[1]}, divisor {reading[0]}",
        nearest=", ".join(intervals) if wrong else "",
        severity=(DECISION if severe else DIGITS) if wrong else "",
        hand="difference of the means over its standard error" if kind in ("student", "welch")
        else "mean square between over mean square within",
    )  # fmt: skip


def _p_of(
    name: str, text: str, of: Sequence[summaries.Group], found: Mapping[str, list[Range]]
) -> float:
    """Return the p that a printed t or F itself would have."""
    value, df = abs(printed_statistic(text)[0]), found["df"][0].value
    if name == "t":
        return float(2 * stats.t.sf(value, df))
    return float(stats.f.sf(value, len(of) - 1, df))


def _printed_in(name: str, text: str, value: Range, alpha: str) -> bool:
    """Whether a printed t, F, d or df (in size) or p allows one of the values."""
    slack = 1e-9
    low, high = (
        value.low - slack * max(1, abs(value.low)),
        value.high + slack * max(1, abs(value.high)),
    )
    if name == "p":
        p = printed_p(text, alpha)
        if p.sign == "<":
            return low < float(exactly(p.digits))
        if p.sign == ">":
            return high > float(exactly(p.digits))
        print_ = allowed(p.digits)
        return low <= float(print_.high) and float(print_.low) <= high
    _, least, most = printed_statistic(text)
    if name in ("t", "d"):
        least, most = _size(least, most)
        low, high = _size(low, high)
    return low <= most + slack and least - slack <= high


def _size(low: float, high: float) -> tuple[float, float]:
    return (0.0 if low <= 0 <= high else min(abs(low), abs(high))), max(abs(low), abs(high))


@on_print("tests of groups", {"table": "table1.csv", "lowest": ["b", "a"]}, SMALL)
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
    rows = dict(groups_of(context, table, {"n": n, "mean": mean, "sd": sd}, None, suffix=suffix))
    if groups is None:
        values = {name: group.mean for name, group in rows.items()}
    else:
        want_names([name for names in groups.values() for name in names], rows, table)
        values = {
            name: summaries.pooled_mean([rows[kind] for kind in kinds])
            for name, kinds in groups.items()
        }
    if below and len(below) != 2:
        raise SignkinError(f"below has {len(below)} lists", expected="two")
    names = [*lowest, *highest, *(name for part in below for name in part)]
    want_names(names, values, table)
    pairs = ordered_pairs(list(values), lowest, highest, below)
    answers = [_less(values[a], values[b]) for a, b in pairs]
    wrong = [f"{a} is not under {b}" for (a, b), x in zip(pairs, answers, strict=True) if not x]
    fits = False if False in answers else None if None in answers else True
    shown_names = list(dict.fromkeys(names))
    told = ", ".join(f"{name} {shown(values[name].middle, 5)}" for name in shown_names)
    why = f"the means stand so: {told}" if fits else f"{'; '.join(wrong)} ({told})"
    return [Finding(verdict_of(fits), why, "", told, source=context.source(table))]


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


def want_names(names: Sequence[str], there: Mapping[str, object], table: str) -> None:
    """Raise where a table lacks rows that a claim names."""
    unknown = [name for name in names if name not in there]
    if unknown:
        raise SignkinError(
            f"{table} has no filled row {listed(unknown)}", expected=listed(there, 30)
        )


@on_print(
    "groups and the whole", {"table": "table1.csv", "sequences": "2"},
    "type,n\n0010,2\n1000,1\n",
)  # fmt: skip
def chains(
    context: OnPrint, table: str, sequences: str, column: str = "n", kind: str = "type"
) -> list[Finding]:
    """What counts of transitions imply: the least number of unbroken chains of signs.

    sequences: the printed number of recordings, which must then have been broken up where it
    is smaller. That is no contradiction: the finding is consistent and says what follows.
    """
    printed = int(count(context.text(sequences)))
    rows = context.paper.table(table)
    counts = {row[kind]: int(row[column]) for row in rows if row[column].isdigit()}
    least, kinds = summaries.chains(counts)
    told = ", ".join(f"{k} {before} before, {after} after" for k, (before, after) in kinds.items())
    why = f"the counts need {least} unbroken chains of signs or more ({told})"
    if least > printed:
        why += f": the {printed} sequences were broken up"
    return [
        Finding(CONSISTENT, why, f"{printed} sequences", f"{least} chains or more",
                source=context.source(table))
    ]  # fmt: skip


def within(text: str, low: float, high: float) -> bool:
    """Whether a printed number (or bound) allows one of the values from low to high."""
    _, least, most = printed_statistic(text)
    slack = 1e-9 * max(1.0, *(abs(x) for x in (low, high) if abs(x) < inf))
    return low - slack <= most and least <= high + slack


def want_number(name: str, text: str) -> float:
    """Return a printed number as its digits stand, or an error that names it."""
    if not is_number(text):
        raise SignkinError(f"{name} is {text[:40]!r}", expected="digits with a decimal point")
    return float(exactly(text))
