"""Checks on effect sizes, standard errors, confidence intervals, regression rows and changes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import inf, log, sqrt

from scipy import stats

from signkin.audit.checks.counts import set_count
from signkin.audit.checks.groups import want_number, within
from signkin.audit.checks.rows import ABSENT, Row, each, rows_of
from signkin.audit.findings import (
    CONSISTENT,
    DECISION,
    DIGITS,
    INCONSISTENT,
    UNDECIDABLE,
    Finding,
    over_readings,
)
from signkin.audit.pvalues import PrintedP, printed_p, printed_statistic
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.rounding import allowed, exactly
from signkin.audit.two_groups import hedges
from signkin.errors import SignkinError, listed

Ends = tuple[float, float, float]  # by hand, least, greatest


def ends(text: str) -> Ends:
    """Return a printed number as its digits stand, and the least and greatest it allows."""
    return printed_statistic(text)


@on_print(
    "effect sizes",
    {"effect": "partial_eta2", "value": ".12", "kind": "F", "statistic": "5.20", "df": ["1", "38"]},
)
def effect_size(
    context: OnPrint, effect: str, value: str, kind: str, statistic: str, df: Sequence[str] = (),
    n: Sequence[str] = (), k: str = "2",
) -> list[Finding]:  # fmt: skip
    """A printed effect size follows from a printed statistic; the finding names the variant.

    effect: d, g, r, eta2, partial_eta2, omega2, epsilon2, f (Cohen's), phi or v (Cramer's).
    kind: t, F, chi2 (one df for d) or z. n: the groups' sizes, or of all together. k: the smaller
    number of rows or columns, for v. Signs are not looked at.
    """
    dfs = [want_number("df", context.text(d)) for d in df]
    sizes = [set_count("n", context.text(size)) for size in n]
    variants = _variants(effect, kind, dfs, sizes, set_count("k", context.text(k)))
    if not variants:
        raise SignkinError(
            f"{effect} from {kind} with {len(dfs)} df and {len(sizes)} n",
            expected="d, g, r of t (df, or n); eta2, partial_eta2, omega2, epsilon2, f of F (two "
            "df); phi, v of chi2 (n); r of z (n)",
        )  # fmt: skip
    text, printed = context.text(statistic), context.text(value)
    return [
        over_readings([(name, partial(_effect, effect, printed, kind, text, name, by))
                       for name, by in variants])
    ]  # fmt: skip


def _variants(
    effect: str, kind: str, df: Sequence[float], n: Sequence[int], k: int
) -> list[tuple[str, Callable[[float], float]]]:
    """Return (name, effect of the statistic) of each usual formula; each rises with its size."""
    if kind == "t":
        return _of_t(effect, df[0] if df else None, n)
    if kind == "F" and len(df) == 2:
        a, b = df
        whole: dict[str, Callable[[float], float]] = {
            "partial_eta2": lambda f: f * a / (f * a + b),
            "eta2": lambda f: f * a / (f * a + b),
            "epsilon2": lambda f: (f - 1) * a / (f * a + b),
            "omega2": lambda f: (f - 1) * a / (f * a + b + 1),
            "f": lambda f: sqrt(f * a / b),
            "r": lambda f: sqrt(f / (f + b)) if a == 1 else inf,
        }
        names = {"eta2": "eta squared (one factor)", "omega2": "omega squared (one-way)"}
        if effect in ("d", "g") and a == 1:
            return _of_t(effect, b, n, squared=True)
        return [(names.get(effect, effect), whole[effect])] if effect in whole else []
    if kind == "chi2" and n and effect in ("phi", "v", "r"):
        by = sum(n) * ((k - 1) if effect == "v" else 1)
        return [(f"sqrt(chi2 / {by})", lambda x: sqrt(x / by))] if by > 0 else []
    if kind == "chi2" and n and effect == "d":
        whole_n = sum(n)
        return [("2 sqrt(chi2 / (n - chi2))",
                 lambda x: 2 * sqrt(x / (whole_n - x)) if x < whole_n else inf)]  # fmt: skip
    if kind == "z" and n and effect == "r":
        return [("z / sqrt(n)", lambda x: x / sqrt(sum(n)))]
    return []


def _of_t(
    effect: str, df: float | None, n: Sequence[int], squared: bool = False
) -> list[tuple[str, Callable[[float], float]]]:
    def size(x: float) -> float:
        return sqrt(x) if squared else x

    if effect in ("r", "eta2", "partial_eta2") and df:
        if effect == "r":
            return [("t / sqrt(t^2 + df)", lambda x: size(x) / sqrt(size(x) ** 2 + df))]
        return [("t^2 / (t^2 + df)", lambda x: size(x) ** 2 / (size(x) ** 2 + df))]
    if effect not in ("d", "g"):
        return []
    by: list[tuple[str, float]] = []
    if len(n) == 2:
        by.append(("t sqrt(1 / n1 + 1 / n2)", sqrt(1 / n[0] + 1 / n[1])))
    if df:
        by.append(("2 t / sqrt(df)", 2 / sqrt(df)))
        by.append(("2 t / sqrt(df + 2)", 2 / sqrt(df + 2)))
        by.append(("t / sqrt(df + 1), paired", 1 / sqrt(df + 1)))
    if len(n) == 1:
        by.append(("t / sqrt(n), paired", 1 / sqrt(n[0])))
    of = df or float(sum(n) - len(n))
    small = {"": 1.0}
    if effect == "g":
        small = {", Hedges' correction": hedges(of),
                 ", Hedges' correction 1 - 3 / (4 df - 1)": 1 - 3 / (4 * of - 1)}  # fmt: skip
    return [
        (name + word, partial(_times, squared, times * factor))
        for name, times in by
        for word, factor in small.items()
    ]


def _times(squared: bool, times: float, x: float) -> float:
    return (sqrt(x) if squared else x) * times


def _effect(
    effect: str, printed: str, kind: str, statistic: str, name: str, by: Callable[[float], float]
) -> Finding:
    hand, low, high = ends(statistic)
    sizes = [abs(hand), 0.0 if low <= 0 <= high else min(abs(low), abs(high)),
             max(abs(low), abs(high))]  # fmt: skip
    value, least, most = (by(size) for size in sizes)
    _, first, last = ends(printed)
    if effect in ("d", "g", "r", "phi"):
        first, last = (0.0 if first <= 0 <= last else min(abs(first), abs(last))), max(
            abs(first), abs(last)
        )  # fmt: skip
    fits = least - 1e-9 <= last and first <= most + 1e-9
    if not fits and effect in ("omega2", "epsilon2") and value < 0:
        fits = first <= 0 <= last  # negative ones are often printed as 0
    why = f"{kind} = {statistic} gives {effect} {value:.4g} ({least:.4g} to {most:.4g}) by {name}"
    return Finding(
        CONSISTENT if fits else INCONSISTENT, why + ("" if fits else f", printed is {printed}"),
        printed, f"{value:.6g}", f"{least:.6g} to {most:.6g}", hand=name, settings=name,
        nearest="" if fits else f"{value:.4g}", severity="" if fits else DIGITS,
    )  # fmt: skip


@on_print("means and SDs", {"sd": "2.10", "se": "0.47", "n": "20"})
def standard_error(
    context: OnPrint, table: str = "", n: str = "n", sd: str = "sd", se: str = "se"
) -> list[Finding]:
    """A printed standard error of the mean is the SD over the root of n."""

    def judge(row: Row) -> Finding:
        size = set_count("n", row["n"])
        hand, low, high = (x / sqrt(size) for x in ends(row["sd"]))
        return _against(
            row["se"], (hand, low, high), f"SD over sqrt({size})",
            f"n of {round((ends(row['sd'])[0] / ends(row['se'])[0]) ** 2)}"
            if ends(row["se"])[0] > 0 else "",
        )  # fmt: skip

    return each(rows_of(context, table, {"n": n, "sd": sd, "se": se}, key="se"), judge)


def _against(printed: str, found: Ends, hand: str, other: str = "") -> Finding:
    fits = within(printed, found[1], found[2])
    why = f"{hand} is {found[0]:.6g} ({found[1]:.6g} to {found[2]:.6g}), printed is {printed}"
    near = f"{found[0]:.4g}" + (f", or {other}" if other else "")
    return Finding(CONSISTENT if fits else INCONSISTENT, why, printed, f"{found[0]:.6g}",
                   f"{found[1]:.6g} to {found[2]:.6g}", hand=hand, nearest="" if fits else near,
                   severity="" if fits else DIGITS)  # fmt: skip


@on_print(
    "estimates", {"estimate": "0.42", "low": "0.11", "high": "0.73", "se": "0.16", "p": ".009"}
)
def confidence_interval(
    context: OnPrint, table: str = "", estimate: str = "estimate", low: str = "low",
    high: str = "high", se: str = "", p: str = "", df: str = "", level: str = "95",
    scale: str = "open", alpha: str = "0.05",
) -> list[Finding]:  # fmt: skip
    """An estimate lies in the middle of its confidence interval, which fits its SE and p.

    scale: linear, log (ratios), fisher (correlations), or open: each is tried. df: of t; without
    it the normal distribution, or (where no df is given) any t with 3 degrees of freedom or more.
    With a table: columns. The interval itself, where se and p are not given, only has to be
    symmetric on one of the scales.
    """
    share = float(exactly(level)) / 100
    if not 0 < share < 1:
        raise SignkinError(f"the level {level}", expected="percent, such as 95")
    scales = ("linear", "log", "fisher")
    if scale not in (*scales, "open"):
        raise SignkinError(f"scale: {scale}", expected=listed((*scales, "open")))
    columns = {"estimate": estimate, "low": low, "high": high, "se": se, "p": p, "df": df}
    columns = {role: text for role, text in columns.items() if text}
    wanted = scales if scale == "open" else (scale,)

    def judge(row: Row) -> Finding:
        readings = [(f"the {s} scale", partial(_interval, row, share, s, alpha)) for s in wanted]
        return over_readings(readings)

    return each(rows_of(context, table, columns, key="estimate"), judge)


def _turned(text: str, scale: str) -> Ends | None:
    found = ends(text)
    if scale == "linear":
        return found
    if scale == "log":
        if found[2] <= 0 or found[0] <= 0:
            return None
        return (log(found[0]), log(found[1]) if found[1] > 0 else -inf, log(found[2]))
    if max(abs(found[1]), abs(found[2])) >= 1:
        return None
    return tuple(0.5 * log((1 + x) / (1 - x)) for x in found)  # type: ignore[return-value]


def _interval(row: Row, share: float, scale: str, alpha: str) -> Finding:
    parts = [_turned(row[name], scale) for name in ("estimate", "low", "high")]
    printed = f"{row['estimate']} [{row['low']}, {row['high']}]"
    if any(part is None for part in parts):
        return Finding(INCONSISTENT, f"{printed} cannot stand on the {scale} scale", printed)
    e, a, b = (part for part in parts if part is not None)
    if b[2] < a[1] or e[2] < a[1] or e[1] > b[2]:
        return Finding(INCONSISTENT, f"{printed}: the estimate lies outside its interval", printed,
                       severity=DIGITS)  # fmt: skip
    middle = tuple((x + y) / 2 for x, y in zip(a, b, strict=True))
    half = ((b[0] - a[0]) / 2, max(0.0, (b[1] - a[2]) / 2), (b[2] - a[1]) / 2)
    wrong = []
    if not (e[1] <= middle[2] + 1e-9 and middle[1] - 1e-9 <= e[2]):
        wrong.append(f"the middle of the interval is {middle[0]:.4g}, not {e[0]:.4g}")
    times = _critical(row, share)
    error = (half[0] / times[1], half[1] / times[1], half[2] / times[0])
    if row.cells.get("se", "") not in ABSENT and scale != "fisher":
        given = ends(row["se"])
        if not (given[1] <= error[2] + 1e-9 and error[1] - 1e-9 <= given[2]):
            wrong.append(f"the interval's width wants an SE of {error[0]:.4g}, not {row['se']}")
        else:
            error = (given[0], max(given[1], error[1]), min(given[2], error[2]))
    severe = False
    if row.cells.get("p", "") not in ABSENT:
        told, severe = _p_of_interval(row, e, error, alpha)
        wrong += [told] if told else []
    found = f"middle {middle[0]:.4g}, SE {error[0]:.4g}"
    why = f"{printed} on the {scale} scale has {found}"
    why += f": {'; '.join(wrong)}" if wrong else ""
    return Finding(INCONSISTENT if wrong else CONSISTENT, why, printed, found,
                   f"middle {middle[1]:.4g} to {middle[2]:.4g}", settings=f"{scale} scale",
                   hand="half of low + high; high - low over 2 x the critical value",
                   nearest=found if wrong else "",
                   severity=(DECISION if severe else DIGITS) if wrong else "")  # fmt: skip


def _critical(row: Row, share: float) -> tuple[float, float]:
    """Return the least and greatest critical value: of t with the df given, or z to t(3)."""
    tail = (1 - share) / 2
    if row.cells.get("df", "") not in ABSENT:
        _, low, high = ends(row["df"])
        if "." not in row["df"]:
            low = high = want_number("df", row["df"])
        return float(stats.t.isf(tail, high)), float(stats.t.isf(tail, max(low, 1e-3)))
    return float(stats.norm.isf(tail)) * (1.95 / 1.96), float(stats.t.isf(tail, 3))


def _p_of_interval(row: Row, e: Ends, error: Ends, alpha: str) -> tuple[str, bool]:
    """Return what is wrong with a printed p, and whether a decision hangs on it."""
    read = printed_p(row["p"], alpha)
    least = 0.0 if e[1] <= 0 <= e[2] else min(abs(e[1]), abs(e[2]))
    most = max(abs(e[1]), abs(e[2]))
    t = [least / error[2] if error[2] > 0 else inf, most / error[1] if error[1] > 0 else inf]
    by_hand = abs(e[0]) / error[0] if error[0] > 0 else inf
    df = [inf, 3.0] if row.cells.get("df", "") in ABSENT else [want_number("df", row["df"])] * 2
    low, high = (float(2 * stats.t.sf(t[1], df[0])), float(2 * stats.t.sf(t[0], df[1])))
    hand = float(2 * stats.t.sf(by_hand, df[0]))
    if _allows(read, low, high):
        return "", False
    said = read.significant(float(alpha))
    return f"p is {hand:.4g}, not {row['p']}", said is not None and said != (hand < float(alpha))


def _allows(read: PrintedP, low: float, high: float) -> bool:
    value = float(exactly(read.digits))
    if read.sign == "<":
        return low < value
    if read.sign == ">":
        return high > value
    bounds = allowed(read.digits)
    return low <= float(bounds.high) + 1e-9 and float(bounds.low) - 1e-9 <= high


@on_print("estimates", {"b": "0.42", "se": "0.16", "t": "2.63", "p": ".010", "df": "96"})
def regression_row(
    context: OnPrint, table: str = "", b: str = "b", se: str = "se", t: str = "", p: str = "",
    df: str = "", low: str = "", high: str = "", level: str = "95", alpha: str = "0.05",
    beta: str = "", sd_x: str = "", sd_y: str = "",
) -> list[Finding]:  # fmt: skip
    """In a row of a regression t is b over its SE, p is that of t, and the interval fits.

    beta: the standardised coefficient, b times the SD of the predictor (sd_x) over that of the
    outcome (sd_y).

    df: of t; without it the normal distribution, or any t with 3 degrees of freedom or more.
    With a table: columns.
    """
    columns = {"b": b, "se": se, "t": t, "p": p, "df": df, "low": low, "high": high,
               "beta": beta, "sd_x": sd_x, "sd_y": sd_y}  # fmt: skip
    columns = {role: text for role, text in columns.items() if text}
    if not {"t", "p", "low", "beta"} & set(columns):
        raise SignkinError("nothing to set b and its SE against",
                           expected="t, p, low and high, or beta with sd_x and sd_y")  # fmt: skip
    if beta and not (sd_x and sd_y):
        raise SignkinError("beta without the SDs", expected="sd_x and sd_y")
    share = float(exactly(level)) / 100

    def judge(row: Row) -> Finding:
        return _regression(row, share, alpha)

    return each(rows_of(context, table, columns, key="b"), judge)


def _regression(row: Row, share: float, alpha: str) -> Finding:
    e, error = ends(row["b"]), ends(row["se"])
    error = (error[0], max(error[1], 0.0), error[2])
    if error[2] <= 0:
        raise SignkinError(f"the SE is {row['se']}", expected="a number above 0")
    wrong, severe = [], False
    corners = [x / y if y > 0 else (0.0 if x == 0 else inf * (1 if x > 0 else -1))
               for x in e[1:] for y in error[1:]]  # fmt: skip
    by_hand = e[0] / error[0] if error[0] > 0 else inf
    if row.cells.get("t", "") not in ABSENT:
        given = ends(row["t"])
        reach = 1e-9 * max(1.0, abs(given[0]))
        signed = min(corners) - reach <= given[2] and given[1] <= max(corners) + reach
        if not signed:
            wrong.append(f"b / SE is {by_hand:.4g}, not {row['t']}")
    if row.cells.get("p", "") not in ABSENT:
        told, severe = _p_of_interval(row, e, error, alpha)
        wrong += [told] if told else []
    if row.cells.get("low", "") not in ABSENT and row.cells.get("high", "") not in ABSENT:
        times = _critical(row, share)
        for name, way in (("low", -1), ("high", 1)):
            given = ends(row[name])
            values = [x + way * c * s for x in e[1:] for c in times for s in error[1:]]
            if not (min(values) - 1e-9 <= given[2] and given[1] <= max(values) + 1e-9):
                end = e[0] + way * times[0] * error[0]
                wrong.append(f"the {name} end is {end:.4g} or beyond, not {row[name]}")
    if all(row.cells.get(role, "") not in ABSENT for role in ("beta", "sd_x", "sd_y")):
        wrong += _beta(row, e)
    found = f"t = {by_hand:.4g}"
    printed = ", ".join(f"{k} {v}" for k, v in row.cells.items() if v)
    why = f"b / SE = {row['b']} / {row['se']} is {by_hand:.4g}"
    why += f": {'; '.join(wrong)}" if wrong else ""
    return Finding(INCONSISTENT if wrong else CONSISTENT, why, printed, found,
                   f"t {min(corners):.4g} to {max(corners):.4g}", hand="b / SE; p of t with df",
                   nearest="; ".join(wrong), severity=(DECISION if severe else DIGITS) if wrong
                   else "")  # fmt: skip


def _beta(row: Row, b: Ends) -> list[str]:
    """Return what is wrong with a standardised coefficient: it is b sd_x / sd_y."""
    x, y = ends(row["sd_x"]), ends(row["sd_y"])
    if y[1] <= 0 or x[1] < 0:
        raise SignkinError(f"the SDs are {row['sd_x']} and {row['sd_y']}",
                           expected="numbers above 0")  # fmt: skip
    values = [s * p / q for s in b[1:] for p in x[1:] for q in y[1:]]
    if within(row["beta"], min(values), max(values)):
        return []
    return [f"b sd_x / sd_y is {b[0] * x[0] / y[0]:.4g}, not {row['beta']}"]


@on_print(
    "groups and the whole",
    {"pre": "10.2", "post": "12.9", "change": "2.7", "sd_pre": "3.1", "sd_post": "3.4",
     "sd_change": "2.0"},
)  # fmt: skip
def change_scores(
    context: OnPrint, table: str = "", pre: str = "", post: str = "", change: str = "",
    sd_pre: str = "", sd_post: str = "", sd_change: str = "", r: str = "",
) -> list[Finding]:  # fmt: skip
    """A mean change is post less pre, and its SD is one that a correlation of -1 to 1 allows.

    r: the printed correlation of pre and post. The same people in both. With a table: columns.
    """
    columns = {"pre": pre, "post": post, "change": change, "sd_pre": sd_pre, "sd_post": sd_post,
               "sd_change": sd_change, "r": r}  # fmt: skip
    columns = {role: text for role, text in columns.items() if text}
    means, sds = {"pre", "post", "change"}, {"sd_pre", "sd_post", "sd_change"}
    if not means <= set(columns) and not sds <= set(columns):
        raise SignkinError("nothing to compare", expected="pre, post, change, or their three SDs")
    key = "pre" if "pre" in columns else "sd_pre"
    return each(rows_of(context, table, columns, key=key), _change)


def _change(row: Row) -> Finding:
    wrong, told = [], []
    cells = {role: text for role, text in row.cells.items() if text not in ABSENT}
    if {"pre", "post", "change"} <= set(cells):
        a, b = ends(cells["pre"]), ends(cells["post"])
        found = (b[0] - a[0], b[1] - a[2], b[2] - a[1])
        told.append(f"post - pre is {found[0]:.6g}")
        turned = (-found[0], -found[2], -found[1])
        if not within(cells["change"], *found[1:]) and not within(cells["change"], *turned[1:]):
            wrong.append(f"post - pre is {found[0]:.6g}, not {cells['change']}")
    if {"sd_pre", "sd_post", "sd_change"} <= set(cells):
        x, y, d = (ends(cells[name]) for name in ("sd_pre", "sd_post", "sd_change"))
        least, most = _correlation(x, y, d)
        told.append(f"the SDs want r from {least:.3g} to {most:.3g}")
        if least > 1 or most < -1:
            wrong.append(f"the SDs want a correlation of {least:.3g} to {most:.3g}")
        elif "r" in cells and not within(cells["r"], least, most):
            wrong.append(f"the SDs want r from {least:.3g} to {most:.3g}, not {cells['r']}")
    if not told:
        return Finding(UNDECIDABLE, "cells are missing")
    printed = ", ".join(f"{k} {v}" for k, v in cells.items())
    return Finding(
        INCONSISTENT if wrong else CONSISTENT, "; ".join(wrong or told), printed, "; ".join(told),
        hand="r = (sd_pre^2 + sd_post^2 - sd_change^2) / (2 sd_pre sd_post)",
        nearest="; ".join(told) if wrong else "", severity=DIGITS if wrong else "",
    )  # fmt: skip


def _correlation(x: Ends, y: Ends, d: Ends) -> tuple[float, float]:
    """Return the least and greatest (x^2 + y^2 - d^2) / (2 x y); zero SDs allow all."""
    lows = [max(v[1], 0.0) for v in (x, y, d)]
    if min(lows[:2]) <= 0:
        return -1.0, 1.0
    grid = [
        (a * a + b * b - c * c) / (2 * a * b)
        for a in (lows[0], x[2]) for b in (lows[1], y[2]) for c in (lows[2], d[2])
    ]  # fmt: skip
    # In x and in y the ratio has a minimum where x^2 = y^2 - d^2 (and the other way round).
    for a, b in ((x, y), (y, x)):
        for fixed in (max(b[1], 0.0), b[2]):
            for c in (lows[2], d[2]):
                turn = sqrt(max(0.0, fixed * fixed - c * c))
                if max(a[1], 0.0) < turn < a[2]:
                    grid.append((turn * turn + fixed * fixed - c * c) / (2 * turn * fixed))
    return min(grid) - 1e-9, max(grid) + 1e-9
