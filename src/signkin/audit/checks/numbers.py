"""Checks on printed numbers by formula, on p, and on what groups of a size can reach."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from signkin.audit import kruskal, pvalues
from signkin.audit.checks.rows import Row, each, one_digit, rows_of, verdict_of
from signkin.audit.expressions import evaluate, sides
from signkin.audit.findings import CONSISTENT, INCONSISTENT, Finding
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.rounding import Interval, allowed, as_interval, count, exactly, shown
from signkin.errors import SignkinError, listed


@on_print("formulas", {"value": "20 / 100", "equals": "0.20"})
def formula(context: OnPrint, value: str, equals: str, exact: Sequence[str] = ()) -> list[Finding]:
    """A formula with printed numbers gives the printed result, as far as rounding allows.

    exact: names of numbers that are counts or settings, not rounded.
    """
    found = _number(evaluate(value, context.values(tuple(exact))), value)
    hand = _number(evaluate(value, context.points()), value).middle
    text = context.text(equals)
    fits = found.meets(allowed(text)) if equals not in exact else exactly(text) in found
    why = f"{value} is {shown(hand)}, printed is {text}"
    if found.width:
        why = f"{value} is {shown(hand)} ({found}), printed is {text}"
    return [Finding(verdict_of(fits), why, text, shown(hand), str(found), hand=value)]


def _number(value: object, text: str) -> Interval:
    if isinstance(value, bool) or (not isinstance(value, Interval | int) and not hasattr(
        value, "numerator"
    )):  # fmt: skip
        raise SignkinError(f"{text!r} is no number", expected="a formula, such as `a * b`")
    return as_interval(value)  # type: ignore[arg-type]


@on_print("formulas", {"holds": "0.05 < 0.10"})
def relation(context: OnPrint, holds: str, exact: Sequence[str] = ()) -> list[Finding]:
    """A relation between printed numbers holds for all values that rounding allows.

    `a == b` holds where rounding allows that both are equal.
    """
    values = context.values(tuple(exact))
    answer = evaluate(holds, values)
    if answer not in (True, False, None):
        raise SignkinError(f"{holds!r} is no comparison", expected="one, such as `a < b`")
    word = {True: "holds", False: "does not hold", None: "is left open by rounding"}[answer]
    both = []
    for text, value in sides(holds, values):
        printed = context.text(text)
        hand = (
            printed
            if printed != text
            else shown(as_interval(evaluate(text, context.points())).middle)
        )
        interval = as_interval(value)
        wide = f" ({interval})" if interval.width else ""
        both.append(f"{text} = {hand}{wide}")
    used = [name for name in values if name in holds.replace("(", " ").replace(")", " ").split()]
    told = ", ".join(f"{name} = {context.text(name)}" for name in used)
    return [
        Finding(verdict_of(answer), f"{holds} {word}" + (f" ({', '.join(both)})" if both else ""),
                told, "; ".join(both))
    ]  # fmt: skip


@on_print("p values", {"kind": "t", "statistic": "2.10", "df": ["38"], "p": ".04"})
def p_value(
    context: OnPrint, kind: str, statistic: str, p: str, df: Sequence[str] = (),
    alpha: str = "0.05", tails: str = "open", groups: Sequence[str] = (),
    rounding: str = "nearest", epsilon: str = "",
) -> list[Finding]:  # fmt: skip
    """A printed p belongs to a printed statistic (F, t, chi2, H, Q, z, r).

    p: `.04`, `<.001`, `>.05`, `ns`, `1.4e-5`. df: one, two for F, none for z; of r, n - 2.
    tails: two, one, or open (each is tried, and told). groups: the sizes of the groups of H, for
    its exact p. Degrees of freedom printed whole may be rounded (Welch): that is tried, too.
    epsilon: of repeated measures (F), where p is corrected and df is not: printed, or open.
    """
    found = pvalues.p_agrees(
        kind, context.text(statistic), [context.text(d) for d in df], context.text(p), alpha,
        rounding, tails, [context.text(g) for g in groups], context.text(epsilon),
    )  # fmt: skip
    if found.verdict == INCONSISTENT:
        cells = {kind: context.text(statistic), "p": context.text(p)}
        cells |= {f"df{i or ''}": context.text(d) for i, d in enumerate(df)}

        def fits(changed: Mapping[str, str]) -> bool:
            dfs = [changed[f"df{i or ''}"] for i in range(len(df))]
            one = pvalues.p_agrees(kind, changed[kind], dfs, changed["p"], alpha, rounding, "two")
            return one.verdict == CONSISTENT

        near = f"{found.nearest}; {one_digit(cells, fits)}"
        if kind == "F" and not epsilon:
            near += pvalues.correction_told(cells["F"], [context.text(d) for d in df], cells["p"])
        found = replace(found, nearest=near)
    return [found]


@on_print(
    "p values", {"table": "tests.csv", "kind": "t"},
    "effect,t,df,p\nage,2.10,38,.04\nsex,0.40,38,.69\n",
)  # fmt: skip
def p_values(
    context: OnPrint, table: str, kind: str, statistic: str = "", df: str = "df", df1: str = "",
    p: str = "p", alpha: str = "0.05", tails: str = "open", epsilon: str = "",
) -> list[Finding]:  # fmt: skip
    """Each row's p belongs to its statistic.

    statistic, df, df1, p: columns; the statistic's is called as its kind, if not told. df1: of F.
    epsilon: as of p_value, for all rows.
    """
    wanted = {"t": 1, "F": 2, "chi2": 1, "H": 1, "Q": 1, "z": 0, "r": 1}
    if kind not in wanted:
        raise SignkinError(f"the statistic {kind!r}", expected=listed(wanted))
    if tails not in pvalues.TAILS:
        raise SignkinError(f"tails: {tails!r}", expected=listed(pvalues.TAILS))
    columns = {"statistic": statistic or kind, "p": p}
    columns |= {"df1": df1 or "df1"} if wanted[kind] == 2 else {}
    columns |= {"df": df} if wanted[kind] else {}

    def judge(row: Row) -> Finding:
        dfs = [row[name] for name in ("df1", "df") if name in columns]
        return pvalues.p_agrees(kind, row["statistic"], dfs, row["p"], alpha, tails=tails,
                                epsilon=epsilon)  # fmt: skip

    return each(rows_of(context, table, columns, key="statistic"), judge)


@on_print("p values", {"groups": ["3", "3"], "p": "<0.01"}, outcome="inconsistent")
def p_reachable(context: OnPrint, groups: Sequence[str], p: str) -> list[Finding]:
    """A Kruskal-Wallis test of groups of this size can reach a p below the printed one.

    By chi-squared, and for small groups by the exact distribution.
    """
    sizes = [count(context.text(g)) for g in groups]
    if len(sizes) < 2:
        raise SignkinError(f"{len(sizes)} groups", expected="two or more")
    h, least = kruskal.kruskal_limit(sizes)
    printed = context.text(p)
    exact = kruskal.least_exact_p(sizes)
    read, lowest = pvalues.printed_p(printed), min(least, 1.0 if exact is None else exact)
    fits = lowest < float(exactly(read.digits)) if read.sign == "<" else True
    if read.sign == "=":
        fits = lowest <= float(allowed(read.digits).high)
    shape = f"{len(sizes)} groups of {sizes[0]}" if len(set(sizes)) == 1 else (
        f"groups of {listed(sizes)}"
    )  # fmt: skip
    why = f"{shape} can reach H = {h:.1f}, p = {least:.2g}"
    why += "" if exact is None else f" (exact {exact:.2g})"
    why += f"; printed is p {printed}"
    return [Finding(verdict_of(fits), why, f"p {printed}", f"p down to {least:.2g}")]
