"""Checks on whole columns: correlation matrices, scales, last digits, rows that stand twice."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import combinations
from math import inf, sqrt

import numpy as np
from scipy import stats

from signkin.audit.checks.counts import set_count
from signkin.audit.checks.effects import Ends, ends
from signkin.audit.checks.groups import want_number
from signkin.audit.checks.rows import ABSENT, Row, each, rows_of, scale_columns, scale_of
from signkin.audit.findings import CONSISTENT, DIGITS, INCONSISTENT, UNDECIDABLE, Finding
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.rounding import allowed, is_number
from signkin.errors import SignkinError, listed

MOST_VARIABLES = 60
LEAST_DIGITS = 40


@on_print(
    "correlations", {"table": "r.csv"},
    ",a,b,c\na,1,,\nb,.90,1,\nc,.90,-.90,1\n", outcome=INCONSISTENT,
)  # fmt: skip
def correlation_matrix(context: OnPrint, table: str) -> list[Finding]:
    """A printed matrix of correlations can be one (positive semi-definite), as far as it is filled.

    The first column names the variables, and the others are called as they are. Half of it is
    enough. Every three variables are looked at, and all of them together where all are printed
    (of the same people: left-out values, pair by pair, can break the rule without a slip).
    """
    low, high, names = _matrix(context, table)
    source, out = context.source(table), []
    full = bool(np.isfinite(low).all())
    middle, half = (low + high) / 2, (high - low) / 2
    bad = [
        (a, b, c) for a, b, c in combinations(range(len(names)), 3)
        if _apart(low, high, a, b, c)
    ] if len(names) <= MOST_VARIABLES else []  # fmt: skip
    for a, b, c in bad[:20]:
        least, most = _third(low, high, a, b, c)
        why = (
            f"r of {names[a]} with {names[b]} and with {names[c]} wants one from {least:.3g} to "
            f"{most:.3g} of {names[b]} with {names[c]}, printed is {middle[b, c]:.3g}"
        )
        out.append(Finding(INCONSISTENT, why, source=source, item=f"{names[a]}, {names[b]}, "
                           f"{names[c]}", nearest=f"{least:.3g} to {most:.3g}", severity=DIGITS,
                           hand="r1 r2 -/+ sqrt((1 - r1^2)(1 - r2^2))"))  # fmt: skip
    if full:
        smallest = float(np.linalg.eigvalsh(middle)[0])
        # No matrix within rounding has a smallest eigenvalue above this one (Weyl).
        reach = smallest + float(np.linalg.eigvalsh(half)[-1]) + 1e-9
        verdict = CONSISTENT if smallest >= 0 else INCONSISTENT if reach < 0 else UNDECIDABLE
        if len(names) == 3 and not bad:  # of three variables the first rule says all
            verdict = CONSISTENT
        why = f"the smallest eigenvalue is {smallest:.4g}, and at most {reach:.4g} within rounding"
        out.append(Finding(verdict, why, f"{len(names)} variables", f"{smallest:.4g}",
                           f"up to {reach:.4g}", source, "all"))  # fmt: skip
    elif not out:
        why = "no three variables contradict each other; not all correlations are printed"
        out.append(Finding(CONSISTENT if len(names) > 2 else UNDECIDABLE, why, source=source))
    return out


def _matrix(context: OnPrint, table: str) -> tuple[np.ndarray, np.ndarray, list[str]]:
    rows = context.paper.table(table)
    names = [next(iter(row.cells.values())).strip() for row in rows]
    n = len(names)
    if n < 2:
        raise SignkinError(f"{table} has {n} rows", expected="two variables or more")
    low, high = np.full((n, n), np.nan), np.full((n, n), np.nan)
    np.fill_diagonal(low, 1.0)
    np.fill_diagonal(high, 1.0)
    for i, row in enumerate(rows):
        cells = list(row.cells.values())[1:]
        if len(cells) < n - 1:
            raise SignkinError(f"{len(cells)} columns of correlations", file=row.file,
                               place="line 1", expected=f"{n}, or {n - 1}")  # fmt: skip
        for j, text in enumerate(cells[:n]):
            bare = text.strip().rstrip("*†‡ ")
            if i == j or bare in ABSENT:
                continue
            if not is_number(bare):
                raise SignkinError(f"r is {text[:40]!r}", file=row.file, place=row.place,
                                   expected="digits with a decimal point, or nothing")  # fmt: skip
            values = allowed(bare)
            ends_ = (float(values.low), float(values.high))
            if ends_[0] > 1 or ends_[1] < -1:
                raise SignkinError(f"r is {bare}", file=row.file, place=row.place,
                                   expected="a number from -1 to 1")  # fmt: skip
            if np.isfinite(low[j, i]) and (ends_[0] > high[j, i] or ends_[1] < low[j, i]):
                raise SignkinError(f"r is {bare} here, and another on the other side of the "
                                   "diagonal", file=row.file, place=row.place,
                                   expected="one number of a pair")  # fmt: skip
            low[i, j] = low[j, i] = max(ends_[0], -1.0)
            high[i, j] = high[j, i] = min(ends_[1], 1.0)
    return low, high, names


def _third(low: np.ndarray, high: np.ndarray, a: int, b: int, c: int) -> tuple[float, float]:
    """Return what two correlations leave to the third: the angles between them add up."""
    angles = [(np.arccos(high[a, k]), np.arccos(low[a, k])) for k in (b, c)]
    (x0, x1), (y0, y1) = angles
    least = max(0.0, x0 - y1, y0 - x1)
    most = max(min(s, 2 * np.pi - s) for s in (x0 + y0, x1 + y1))
    if x0 + y0 <= np.pi <= x1 + y1:
        most = np.pi
    return float(np.cos(most)) - 1e-9, float(np.cos(least)) + 1e-9


def _apart(low: np.ndarray, high: np.ndarray, a: int, b: int, c: int) -> bool:
    if not np.isfinite([low[a, b], low[a, c], low[b, c]]).all():
        return False
    least, most = _third(low, high, a, b, c)
    return bool(high[b, c] < least or low[b, c] > most)


@on_print(
    "means and SDs", {"mean": "4.50", "sd": "2.10", "n": "20", "low": "1", "high": "5"},
    outcome=INCONSISTENT,
)  # fmt: skip
def scale_bounds(
    context: OnPrint, low: str, high: str, table: str = "", n: str = "n", mean: str = "mean",
    sd: str = "sd", observed: bool = False,
) -> list[Finding]:  # fmt: skip
    """A mean lies on its scale, and its SD is not above what the scale allows (any values).

    low, high: the ends, numbers or columns of the table. The greatest SD has all values at the
    ends: sqrt((high - mean)(mean - low) n / (n - 1)). With `observed: true` low and high are the
    printed least and greatest value: both are there, and the SD is not too small for that.
    """
    columns = {"n": n, "mean": mean, "sd": sd, **scale_columns(context, table, low, high)}
    fixed = {name: want_number(name, context.text(text))
             for name, text in (("low", low), ("high", high)) if name not in columns}  # fmt: skip
    if len(fixed) == 2 and (fixed["low"] > fixed["high"] or (
        fixed["low"] == fixed["high"] and not observed
    )):  # fmt: skip
        raise SignkinError(f"a scale from {fixed['low']:g} to {fixed['high']:g}",
                           expected="its lower end first")  # fmt: skip

    def judge(row: Row) -> Finding:
        scale = scale_of(context, row, low, high)
        for name, end in zip(("low", "high"), scale, strict=True):
            want_number(name, end)
        bottom, top = (ends(end) for end in scale)
        if not observed:
            bottom, top = ((end[0],) * 3 for end in (bottom, top))
        if bottom[0] > top[0] or (bottom[0] == top[0] and not observed):
            raise SignkinError(f"a scale from {scale[0]} to {scale[1]}",
                               expected="its lower end first")  # fmt: skip
        size, m, s = set_count("n", row["n"]), ends(row["mean"]), ends(row["sd"])
        if s[0] < 0:
            raise SignkinError(f"the SD is {row['sd']}", expected="a number from 0")
        return _on_scale(row, size, m, s, (bottom, top), observed)

    return each(rows_of(context, table, columns), judge)


def _on_scale(
    row: Row, size: int, m: Ends, s: Ends, scale: tuple[Ends, Ends], observed: bool
) -> Finding:
    printed, (a, b) = f"{row['mean']} ({row['sd']})", scale
    told = f"{a[0]:g} to {b[0]:g}"
    settings = f"{told}, both ends observed" if observed else told
    least_mean, most_mean = a[1], b[2]
    if observed and size > 1:  # one value at each end at least
        least_mean = (a[1] * (size - 1) + b[1]) / size
        most_mean = (a[2] + b[2] * (size - 1)) / size
    if m[2] < least_mean - 1e-9 or m[1] > most_mean + 1e-9:
        beyond = f" of {size} values with both ends among them" if observed else ""
        why = f"the mean {row['mean']}{beyond} lies outside the scale from {told}"
        return Finding(INCONSISTENT, why, printed, settings=settings,
                       nearest=f"{least_mean:.4g} to {most_mean:.4g}")  # fmt: skip
    by = size / (size - 1) if size > 1 else inf

    def most(x: float, low: float, high: float) -> float:
        x = min(max(x, low), high)
        return sqrt((high - x) * (x - low) * by) if size > 1 else 0.0

    half = (a[1] + b[2]) / 2
    values = [most(x, a[1], b[2]) for x in (m[1], m[2])]
    values += [most(half, a[1], b[2])] if m[1] <= half <= m[2] else []
    least = _least_sd(size, m, a, b) if observed else 0.0
    above, below = s[1] > max(values) + 1e-9, s[2] < least - 1e-9
    hand = most(m[0], a[0], b[0])
    why = f"with mean {row['mean']} the SD is at most {hand:.4g}"
    why += f" and at least {least:.4g}" if observed else ""
    why += f", printed is {row['sd']}" if above or below else ""
    near = (
        f"SD from {least:.4g} to {max(values):.4g}" if observed else f"SD up to {max(values):.4g}"
    )
    bad = above or below
    return Finding(
        INCONSISTENT if bad else CONSISTENT, why, printed, f"{hand:.4g}",
        f"{least:.6g} to {max(values):.6g}" if observed else f"up to {max(values):.6g}",
        nearest=near if bad else "", severity=DIGITS if bad else "", settings=settings,
        hand="sqrt((high - mean)(mean - low) n / (n - 1))",
    )  # fmt: skip


def _least_sd(n: int, m: Ends, a: Ends, b: Ends) -> float:
    """Return a bound that no SD (divisor n) lies below with values at both ends a and b.

    The others all at one place make it least: their squares and the ends' are
    u^2 / 2 + s^2 (1 / 2 + 1 / (n - 2)), with u = b - a and s = a + b - 2 mean.
    """
    apart = max(0.0, b[1] - a[2])
    if n < 2:
        return 0.0
    sides = (a[1] + b[1] - 2 * m[2], a[2] + b[2] - 2 * m[1])
    skew = 0.0 if sides[0] <= 0 <= sides[1] else min(map(abs, sides))
    times = 0.5 + (1 / (n - 2) if n > 2 else 0.0)
    return sqrt((apart * apart / 2 + skew * skew * times) / n)


@on_print(
    "columns", {"table": "long.csv", "columns": ["x"]},
    "x\n" + "".join(f"{i / 100 + 0.1:.2f}\n" for i in range(50)),
)  # fmt: skip
def last_digits(
    context: OnPrint, table: str, columns: Sequence[str], alpha: float = 0.001
) -> list[Finding]:
    """Last digits are about as many of each, as measurement to more digits than matter leaves them.

    A test, no contradiction: few of one digit have many harmless reasons. Undecidable where p is
    below alpha, or where there are fewer than 40 digits; its power is told.
    """
    rows = list(context.paper.table(table))
    digits = []
    for row in rows:
        for column in columns:
            text = row[column].strip()
            if is_number(text):
                digits.append(int(text[-1]) if text[-1].isdigit() else 0)
    n = len(digits)
    source = context.source(table)
    if n < LEAST_DIGITS:
        why = f"{n} last digits are too few (40)"
        return [Finding(UNDECIDABLE, why, source=source)]
    counts = np.bincount(digits, minlength=10)
    value = float(((counts - n / 10) ** 2 / (n / 10)).sum())
    p = float(stats.chi2.sf(value, 9))
    power = _power(n, alpha)
    told = ", ".join(f"{digit}: {k}" for digit, k in enumerate(counts))
    why = (
        f"the last digits of {n} numbers ({told}) have chi-squared {value:.1f}, p = {p:.3g}; one "
        f"digit twice as often as the others would be found in {power:.0%} of such tables"
    )
    verdict = CONSISTENT if p >= alpha else UNDECIDABLE
    return [Finding(verdict, why, f"{n} digits", f"p = {p:.3g}", source=source,
                    settings=f"alpha {alpha:g}")]  # fmt: skip


@cache
def _power(n: int, alpha: float) -> float:
    """Return the power against one digit that comes twice as often as each other one."""
    shares = np.array([2.0] + [1.0] * 9) / 11
    away = float(((shares - 0.1) ** 2 / 0.1).sum()) * n
    return float(stats.ncx2.sf(stats.chi2.isf(alpha, 9), 9, away))


@on_print(
    "columns", {"table": "table1.csv", "columns": ["mean", "sd"]},
    "group,mean,sd\na,4.10,0.90\nb,4.00,1.00\nc,7.00,0.80\n",
)  # fmt: skip
def rows_twice(
    context: OnPrint, table: str, columns: Sequence[str], others: Sequence[str] = ()
) -> list[Finding]:
    """No two rows have the same numbers in these columns.

    others: further tables with the same columns, whose rows are set against these, too.
    A question, no contradiction: rows that stand twice are told as undecidable.
    """
    seen: dict[tuple[str, ...], list[str]] = {}
    for name in (table, *others):
        for row in context.paper.table(name):
            key = tuple(row[column].strip() for column in columns)
            if not all(text in ABSENT for text in key):
                first = next(iter(row.cells.values()))
                seen.setdefault(key, []).append(f"{first} of {name}" if others else first)
    twice = [(key, names) for key, names in seen.items() if len(names) > 1]
    source = context.source(table)
    if not twice:
        return [Finding(CONSISTENT, f"all {len(seen)} rows differ", source=source)]
    return [
        Finding(UNDECIDABLE, f"the rows {listed(names)} have the same numbers: {', '.join(key)}",
                source=source, item=names[0])
        for key, names in twice
    ]  # fmt: skip
