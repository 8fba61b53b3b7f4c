"""Checks on printed counts: percentages, margins, chi-squared, Fisher's test, odds ratios."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import partial
from math import exp, log, sqrt

import numpy as np
from scipy import stats

from signkin.audit.checks.groups import within
from signkin.audit.checks.rows import Row, each, item, rows_of, verdict_of
from signkin.audit.findings import (
    CONSISTENT,
    DECISION,
    DIGITS,
    INCONSISTENT,
    Finding,
    over_readings,
)
from signkin.audit.pvalues import printed_p
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.rounding import allowed, count, exactly, shown
from signkin.errors import SignkinError, listed

MOST_CELLS = 400


def whole(name: str, text: str) -> int:
    """Return a printed count from 0; thousands' commas are taken off."""
    bare = text.strip().replace(",", "")
    if not bare.isdigit() or len(bare) > 12:
        raise SignkinError(f"{name} is {text[:40]!r}", expected="a whole number from 0")
    return int(bare)


@on_print("counts", {"count": "12", "n": "37", "percent": "34.2"}, outcome=INCONSISTENT)
def percentage(
    context: OnPrint, percent: str = "percent", n: str = "n", count: str = "count",
    table: str = "", rounding: str = "nearest", of: str = "100",
) -> list[Finding]:  # fmt: skip
    """A printed count of n is the printed percentage.

    With a table: columns. of: 100 for percent, 1 for a share.
    """
    scale = exactly(of)
    if scale <= 0:
        raise SignkinError(f"of is {of}", expected="100, or 1 for shares")
    allowed("0", rounding)

    def judge(row: Row) -> Finding:
        k, size = whole("the count", row["count"]), whole("n", row["n"])
        if size == 0 or k > size:
            why = f"{k} of {size} is no share"
            return Finding(INCONSISTENT, why, f"{row['percent']}")
        text = row["percent"].rstrip("% ")
        share = Fraction(k, size) * scale
        fits = share in allowed(text, rounding)
        why = f"{k} of {size} is {shown(share, 6)}, printed is {text}"
        values = allowed(text, rounding)
        near = values.multiples(scale / size)
        nearest = ""
        if not fits:
            other = f"{near[0]} of {size}" if len(near) else f"no count of {size}"
            nearest = f"{shown(share, 6)}, or for {text}: {other}"
        return Finding(verdict_of(fits), why, f"{k} of {size}: {text}", shown(share, 6),
                       nearest=nearest, hand=f"{k} / {size} x {of}")  # fmt: skip

    columns = {"count": count, "n": n, "percent": percent}
    return each(_zero_too(context, table, columns), judge)


def _zero_too(context: OnPrint, table: str, columns: dict[str, str]) -> list[Row]:
    """Return the rows under other names, since n = 0 is judged here, not skipped."""
    return [
        Row(row.name, row.cells, row.file, row.place, row.source)
        for row in rows_of(context, table, columns, key="percent")
    ]


@on_print(
    "counts", {"table": "table1.csv", "columns": ["yes", "no"], "total": "all", "total_row": "all"},
    "group,yes,no,all\na,5,7,12\nb,3,9,12\nall,8,16,24\n",
)  # fmt: skip
def margins(
    context: OnPrint, table: str, columns: Sequence[str], total: str = "", total_row: str = ""
) -> list[Finding]:
    """Counts add up to their printed margins.

    columns: of the counts. total: the column of their sums. total_row: the name (first column)
    of the row of sums.
    """
    if not columns:
        raise SignkinError("no columns of counts", expected="columns: [yes, no]")
    if not total and not total_row:
        raise SignkinError("no margin to add up to", expected="total, total_row or both")
    source, out = context.source(table), []
    sums = dict.fromkeys([*columns, *([total] if total else [])], 0)
    last: Row | None = None
    for row in rows_of(context, table, {c: c for c in sums}, key=columns[0]):
        try:
            cells = {c: whole(c, row[c]) for c in sums}
        except SignkinError as error:
            raise row.at(error) from None
        if total:
            found = sum(cells[c] for c in columns)
            told = " + ".join(str(cells[c]) for c in columns)
            why = f"{told} is {found}, printed is {cells[total]}"
            out.append(item(Finding(verdict_of(found == cells[total]), why, str(cells[total]),
                                    str(found)), row.name, source))  # fmt: skip
        if row.name == total_row:
            last = row
        else:
            sums = {c: v + cells[c] for c, v in sums.items()}
    if total_row and last is None:
        raise SignkinError(f"{table} has no row {total_row!r}", expected="the row of sums")
    for column, found in sums.items() if last else ():
        printed = whole(column, last[column]) if last else 0
        why = f"the column {column} adds up to {found}, printed is {printed}"
        out.append(Finding(verdict_of(found == printed), why, str(printed), str(found),
                           source=source, item=column))  # fmt: skip
    return out


def counts_of(
    context: OnPrint, table: str, counts: Sequence[Sequence[str]], columns: Sequence[str]
) -> np.ndarray:
    """Return a table of counts, given directly or as columns of a printed table."""
    if table:
        if not columns:
            raise SignkinError("no columns of counts", expected="columns: [yes, no]")
        rows = list(rows_of(context, table, {c: c for c in columns}, key=columns[0]))
        given = [[row[c] for c in columns] for row in rows]
    else:
        given = [[context.text(c) for c in row] for row in counts]
    if not given or len({len(row) for row in given}) != 1 or not given[0]:
        raise SignkinError("the counts make no table", expected="rows of one length")
    found = np.array([[whole("a count", c) for c in row] for row in given], dtype=float)
    if found.size > MOST_CELLS or found.sum() == 0:
        raise SignkinError(f"{found.size} counts that add up to {found.sum():.0f}",
                           expected=f"at most {MOST_CELLS} that are not all 0")  # fmt: skip
    return found


@on_print(
    "counts", {"counts": [["12", "8"], ["5", "15"]], "chi2": "5.01", "p": ".025"}
)  # fmt: skip
def chi_squared(
    context: OnPrint, counts: Sequence[Sequence[str]] = (), chi2: str = "", p: str = "",
    df: str = "", table: str = "", columns: Sequence[str] = (), test: str = "open",
    alpha: str = "0.05",
) -> list[Finding]:  # fmt: skip
    """A printed chi-squared, df and p are those of printed counts (a row: against even shares).

    test: pearson, yates (2 x 2), g (likelihood ratio), fisher (2 x 2, p alone), or open: each is
    tried. With a table: columns of the counts.
    """
    found = counts_of(context, table, counts, columns)
    printed = {name: context.text(text) for name, text in (("chi2", chi2), ("p", p), ("df", df))
               if text}  # fmt: skip
    if not {"chi2", "p"} & set(printed):
        raise SignkinError("nothing to set the counts against", expected="chi2 or p")
    tests = ("pearson", "yates", "g", "fisher")
    if test not in (*tests, "open"):
        raise SignkinError(f"test: {test}", expected=listed((*tests, "open")))
    used = found[:, found.sum(axis=0) > 0][found.sum(axis=1) > 0]
    two = used.shape == (2, 2)
    if min(used.shape) < 1 or (found.shape[0] > 1 and min(used.shape) < 2):
        raise SignkinError("all counts stand in one row or column", expected="two of each")
    possible = [t for t in tests if two or t in ("pearson", "g")]
    if "chi2" in printed:
        possible = [t for t in possible if t != "fisher"] if test == "open" else possible
        if two and "p" in printed and test == "open":  # the exact p may stand beside chi-squared
            possible += ["pearson with Fisher's p"]
    wanted = possible if test == "open" else [t for t in possible if t == test]
    if not wanted:
        raise SignkinError(f"{test} of a table of {used.shape}", expected="2 x 2")
    source = context.source(table) if table else ""
    return [over_readings([(t, partial(_chi, used, t, printed, alpha, source)) for t in wanted])]


def _chi(
    counts: np.ndarray, test: str, printed: dict[str, str], alpha: str, source: str
) -> Finding:
    if counts.shape[0] == 1:
        even = counts.sum() / counts.size
        parts = (counts - even) ** 2 / even if test != "g" else 2 * counts * np.log(
            np.where(counts > 0, counts, 1) / even)  # fmt: skip
        value, df = float(parts.sum()), counts.size - 1
        p = float(stats.chi2.sf(value, df))
    else:
        done = stats.chi2_contingency(
            counts, correction=test == "yates", lambda_="log-likelihood" if test == "g" else None
        )
        value, p, df = float(done.statistic), float(done.pvalue), int(done.dof)
    if "isher" in test:
        p = float(stats.fisher_exact(counts).pvalue)
    found = {"chi2": value, "p": p, "df": float(df)}
    if test == "fisher":
        found.pop("chi2")
    return _set_against(
        found, printed, alpha, source, test, "sum of (count - expected)^2 / expected"
    )


def _set_against(
    found: dict[str, float], printed: dict[str, str], alpha: str, source: str, name: str, hand: str
) -> Finding:
    """Return the finding of printed numbers against points (exact inputs)."""
    wrong, severe = [], False
    for what, text in printed.items():
        value = found[what]
        if what == "p":
            read = printed_p(text, alpha)
            digits, bounds = float(exactly(read.digits)), allowed(read.digits)
            fits = {"<": value < digits, ">": value > digits}.get(
                read.sign, float(bounds.low) - 1e-9 <= value <= float(bounds.high) + 1e-9
            )
            said = read.significant(float(alpha))
            severe = severe or (not fits and said is not None and said != (value < float(alpha)))
        else:
            fits = within(text, value, value)
        if not fits:
            wrong.append(f"{what} is {text}")
    told = ", ".join(f"{what} = {value:.4g}" for what, value in found.items())
    why = f"the numbers give {told}" + (f", printed {', '.join(wrong)}" if wrong else "")
    return Finding(
        INCONSISTENT if wrong else CONSISTENT, f"{why} ({name})",
        ", ".join(f"{what} {text}" for what, text in printed.items()), told, source=source,
        settings=name, hand=hand, nearest=told if wrong else "",
        severity=(DECISION if severe else DIGITS) if wrong else "",
    )  # fmt: skip


@on_print("counts", {"counts": [["12", "8"], ["5", "15"]], "odds_ratio": "4.50"})
def odds_ratio(
    context: OnPrint, counts: Sequence[Sequence[str]] = (), odds_ratio: str = "",
    risk_ratio: str = "", phi: str = "", low: str = "", high: str = "", level: str = "95",
    table: str = "", columns: Sequence[str] = (),
) -> list[Finding]:  # fmt: skip
    """A printed odds ratio, risk ratio or phi of a 2 x 2 table, with its interval (Woolf, Katz).

    Which group, and which outcome, comes first is left open. low, high: the interval's ends, of
    the odds ratio, or else of the risk ratio.
    """
    found = counts_of(context, table, counts, columns)
    if found.shape != (2, 2):
        raise SignkinError(f"a table of {found.shape}", expected="2 x 2")
    names = (("odds_ratio", odds_ratio), ("risk_ratio", risk_ratio), ("phi", phi), ("low", low),
             ("high", high))  # fmt: skip
    printed = {name: context.text(text) for name, text in names if text}
    if not {"odds_ratio", "risk_ratio", "phi"} & set(printed):
        raise SignkinError("nothing to set the counts against",
                           expected="odds_ratio, risk_ratio or phi")  # fmt: skip
    if (found == 0).any():
        why = "a count is 0: no odds ratio without a correction"
        return [Finding("undecidable", why)]
    z = float(stats.norm.isf((1 - float(exactly(level)) / 100) / 2))
    turns = {"as it stands": found, "groups exchanged": found[::-1],
             "outcomes exchanged": found[:, ::-1], "both exchanged": found[::-1, ::-1]}  # fmt: skip
    source = context.source(table) if table else ""
    return [over_readings([
        (name, partial(_odds, turned, printed, z, source, name)) for name, turned in turns.items()
    ])]  # fmt: skip


def _odds(c: np.ndarray, printed: dict[str, str], z: float, source: str, name: str) -> Finding:
    (a, b), (d, e) = c.tolist()
    odds, risk = a * e / (b * d), (a / (a + b)) / (d / (d + e))
    phi = (a * e - b * d) / sqrt((a + b) * (d + e) * (a + d) * (b + e))
    of, se = odds, sqrt(1 / a + 1 / b + 1 / d + 1 / e)
    if "odds_ratio" not in printed and "risk_ratio" in printed:
        of, se = risk, sqrt(1 / a - 1 / (a + b) + 1 / d - 1 / (d + e))
    found = {"odds_ratio": odds, "risk_ratio": risk, "phi": phi, "low": exp(log(of) - z * se),
             "high": exp(log(of) + z * se)}  # fmt: skip
    found = {what: value for what, value in found.items() if what in printed}
    return _set_against(found, printed, "0.05", source, name, "a d / (b c)")


def set_count(name: str, text: str) -> int:
    """Return a printed count from 1; the error names it."""
    try:
        return count(text)
    except SignkinError:
        raise SignkinError(f"{name} is {text[:40]!r}", expected="a whole number from 1") from None
