"""The rows that a check on print goes through: those of a printed table, or one given directly."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from signkin.audit import summaries
from signkin.audit.findings import CONSISTENT, INCONSISTENT, UNDECIDABLE, Finding, unusable
from signkin.audit.grim import grain_of
from signkin.audit.grimmer import DIVISORS, SPREADS
from signkin.audit.registry import OnPrint
from signkin.audit.rounding import allowed
from signkin.errors import SignkinError, listed

ABSENT = ("", "/", "-", "–", "—", "NA", "n/a")


MOST_TOLD = 8  # single digits that would do


@dataclass(frozen=True)
class Row:
    """One row: its name, its cells by what they are (`n`, `mean`), and where it stands."""

    name: str
    cells: Mapping[str, str]
    file: Path | None = None
    place: str | None = None
    source: str = ""

    def __getitem__(self, role: str) -> str:
        """Return a cell."""
        return self.cells[role]

    def at(self, error: SignkinError) -> SignkinError:
        """Return the error with the row's file and line."""
        return error.at(file=self.file, place=self.place)


def rows_of(
    context: OnPrint,
    table: str,
    columns: Mapping[str, str],
    suffixes: Sequence[str] = ("",),
    key: str = "n",
) -> Iterator[Row]:
    """Yield the rows that have a value in the column `key`.

    columns: role -> column of the table; without a table, role -> a printed number (its name or
    its digits), which make one row. suffixes: further columns of a row (`_without_outlier`).
    """
    if not columns.get(key):
        raise SignkinError(f"no {key}", expected="a number, or a column of the table")
    if not table:
        yield Row("", {role: context.text(value) for role, value in columns.items()})
        return
    source = context.source(table)
    for printed in context.paper.table(table):
        name = next(iter(printed.cells.values()))
        for suffix in suffixes:
            filled = {r: printed[f"{c}{suffix}"].strip() for r, c in columns.items() if c}
            cells = {role: filled.get(role, "") for role in columns}
            if cells[key] in ABSENT:
                continue
            if key == "n" and cells["n"] == "0" and cells.get("mean", "") in ABSENT:
                continue
            yield Row(
                name + suffix.replace("_", " "), cells, printed.file, printed.place, source
            )  # fmt: skip


def each(rows: Iterable[Row], judge: Callable[[Row], Finding]) -> list[Finding]:
    """Return a finding for each row; a row that cannot be used is told, and the others go on."""
    out = []
    for row in rows:
        try:
            if row.cells.get("n") == "0":
                raise SignkinError(
                    f"n is 0 beside the mean {row.cells.get('mean', '')}",
                    expected="a whole number from 1, or no mean",
                )
            found = judge(row)
            out.append(item(found, row.name, row.source))
        except SignkinError as error:
            if row.place is None:
                raise
            out.append(unusable(row.at(error), row.name, row.source))
    return out


def scale_columns(context: OnPrint, table: str, low: str, high: str) -> dict[str, str]:
    """Return the ends of a scale that are columns of the table (a printed range a row)."""
    header = context.paper.table(table)[:1] if table else []
    return {
        role: name for role, name in (("low", low), ("high", high))
        if name and any(name in row.cells for row in header)
    }  # fmt: skip


def scale_of(context: OnPrint, row: Row, low: str, high: str) -> tuple[str, str]:
    """Return both ends of a row's scale: its own cells, or the check's numbers; empty: none."""
    found = [
        row.cells[role] if role in row.cells else context.text(end) if end else ""
        for role, end in (("low", low), ("high", high))
    ]
    return tuple("" if end in ABSENT else end for end in found)  # type: ignore[return-value]


def item(found: Finding, name: str, source: str) -> Finding:
    """Return a plain finding of a row, without what its check keeps for itself."""
    return Finding(
        found.verdict, found.why, found.printed, found.recomputed, found.interval, source, name,
        found.settings, found.hand, found.nearest, found.severity, found.fault, found.histogram,
    )  # fmt: skip


def verdict_of(fits: bool | None) -> str:
    """Return the verdict on print of yes, no, or open."""
    return UNDECIDABLE if fits is None else CONSISTENT if fits else INCONSISTENT


def want_settings(
    grain: str | None = None, items: int | str = 1, divisor: str = "", rounding: str = "nearest",
    spread: str = "sd", further: Sequence[str] = ("either",),
) -> None:  # fmt: skip
    """Check what a claim sets before any row is read, so that no row is blamed for it."""
    if grain is not None:
        grain_of(grain, items)
    if divisor and divisor not in (*DIVISORS, *further):
        raise SignkinError(f"the divisor {divisor!r}", expected=listed((*DIVISORS, *further)))
    if spread not in (*SPREADS, "either"):
        raise SignkinError(f"the spread {spread!r}", expected=listed((*SPREADS, "either")))
    allowed("0", rounding)


def open_readings(divisor: str, spread: str = "sd") -> list[tuple[str, str, str]]:
    """Return (name, divisor, spread) of every reading of printed SDs that is left open."""
    divisors = DIVISORS if divisor == "either" else (divisor,)
    spreads = SPREADS if spread == "either" else (spread,)
    words = {"sd": "SDs", "se": "standard errors"}
    return [(f"{words[s]} with divisor {d}", d, s) for s in spreads for d in divisors]


def groups_of(
    context: OnPrint, table: str, columns: Mapping[str, str], grain: str | None,
    divisor: str = "n-1", spread: str = "sd", suffix: str = "",
) -> list[tuple[str, summaries.Group]]:  # fmt: skip
    """Return the groups of a table by the name in its first column.

    columns: of n, mean and sd. suffix: take the columns with it (`_without_outlier`) where a row
    has them filled.
    """
    ended = (
        {r.place: r.cells for r in rows_of(context, table, columns, (suffix,))} if suffix else {}
    )
    out = []
    for row in rows_of(context, table, columns):
        cells = ended.get(row.place, row.cells)
        try:
            of = summaries.groups(
                [cells["n"]], [cells["mean"]], [cells["sd"]], grain, divisor=divisor, spread=spread
            )
            out.append((row.name, of[0]))
        except SignkinError as error:
            raise row.at(error) from None
    return out


def one_digit(cells: Mapping[str, str], fits: Callable[[Mapping[str, str]], bool]) -> str:
    """Return which single digit, printed otherwise, would make the numbers fit: `n 27, mean 5.18`.

    Neighbours on the keyboard or not: each digit of each cell is tried in all ten ways.
    """
    found = []
    for role, text in cells.items():
        for i, digit in enumerate(text):
            for other in "0123456789" if digit.isdigit() else "":
                changed = f"{text[:i]}{other}{text[i + 1 :]}"
                if other == digit or (role == "n" and changed.startswith("0")):
                    continue
                try:
                    if fits({**cells, role: changed}):
                        found.append(f"{role} {changed}")
                except SignkinError:
                    continue
    told = ", ".join(found[:MOST_TOLD])
    more = f" and {len(found) - MOST_TOLD} more" if len(found) > MOST_TOLD else ""
    return f"one digit otherwise: {told}{more}" if found else "no single digit would do"
