"""The one reader of tables: a row a frame (or an interval), a column a value, as text.

A layout says how the file is written: separator, decimal sign, rows before and of the header,
encoding. What it does not say is found out where only one answer fits: of comma, semicolon and tab,
the separator under which the header has the columns that are wanted; a decimal comma where the
numbers have commas and no points. Rows must have the header's cells: one more or less is an error
with its line, unless what is too much is empty. Blank lines are passed over, and lines keep the
numbers an editor shows.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io.text import NOT_A_NUMBER, half_digit, number, quoted, text_lines
from signkin.rows import check_length, composed, excel_separator, plain_name, table_rows

SEPARATORS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " "}
GAPS = frozenset({"", "na", "n/a", "null", "none"}) | NOT_A_NUMBER
# Line numbers are an index that starts at line 2: that of the row below a header of one line.
FIRST_LINE = 2
NAMELESS = "Unnamed: 0"  # as pandas calls a first column without a name: its numbers of rows
_DIGITS = set("0123456789+-.eE")


@dataclass(frozen=True)
class Layout:
    """How a table is written; None is found out from the file.

    separator: comma, semicolon, tab, space (any run of blanks), or the character.
    decimal: the decimal sign, a point or a comma.
    skip_rows: lines before the header. header_rows: 0 (columns are named 1, 2, ...), 1, or more:
    the cells of a column joined by blanks, each row's empty cells taken from the left.
    encoding: where it is not UTF-8. missing: cells that mean nothing was measured.
    """

    separator: str | None = None
    decimal: str | None = None
    skip_rows: int = 0
    header_rows: int = 1
    encoding: str | None = None
    missing: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Refuse what no table is written with."""
        if self.separator is not None and (
            not isinstance(self.separator, str)
            or (self.separator not in SEPARATORS and len(self.separator) != 1)
            or self.separator in ('"', "\n", "\r", ".", "-")
        ):
            raise SignkinError(
                f"the separator is {quoted(self.separator)}",
                place="options, separator",
                expected=f"{listed(SEPARATORS)} or one character",
            )
        if self.decimal not in (None, ".", ","):
            raise SignkinError(
                f"the decimal sign is {quoted(self.decimal)}",
                place="options, decimal",
                expected="a point or a comma",
            )
        for key in ("skip_rows", "header_rows"):
            value = getattr(self, key)
            if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= 1000:
                raise SignkinError(
                    f"{key} is {quoted(value)}", place=f"options, {key}", expected="a whole number"
                )

    @property
    def character(self) -> str | None:
        """The separator itself."""
        return None if self.separator is None else SEPARATORS.get(self.separator, self.separator)


PLAIN = Layout()


def read_text_table(
    path: Path,
    layout: Layout = PLAIN,
    wanted: Sequence[str] | None = None,
    also: frozenset[str] = frozenset(),
) -> pd.DataFrame:
    """Return a table with every cell as text; a file is parsed once, however often asked for.

    wanted: the columns to keep (None: all), whatever way their accents are coded; also: those
    besides, as `plain_name` has them, that are kept where they are there. One file can hold
    hundreds of recordings. The row with index i stands in line i + 2 of the file, whatever was
    passed over before it.
    """
    state = Path(path).stat()
    names = None if wanted is None else tuple(dict.fromkeys(composed(str(n)) for n in wanted))
    return _parsed(Path(path), state.st_mtime_ns, state.st_size, layout, names, also)


@lru_cache(maxsize=4)
def _parsed(
    path: Path,
    mtime_ns: int,
    size: int,
    layout: Layout,
    wanted: tuple[str, ...] | None,
    also: frozenset[str],
) -> pd.DataFrame:
    header, separator, first = _header(path, layout, wanted)
    doubled = {name for name, count in Counter(header).items() if name and count > 1}
    for name in wanted or ():
        if name in doubled:
            raise _stands_twice(name)
        if name not in header:
            raise _no_column(name, header, separator)
    asked = None if wanted is None else {*wanted, *(n for n in header if plain_name(n) in also)}
    kept = [i for i, name in enumerate(header) if (name if asked is None else name in asked)]
    kept = [i for i in kept if header[i] not in doubled]
    cells: list[list[str]] = [[] for _ in kept]
    numbers: list[int] = []
    for line, row in rows_of(path, layout, separator, first):
        if len(row) != len(header):
            check_length(row, len(header), line)
        numbers.append(line)
        for column, i in zip(cells, kept, strict=True):
            column.append(row[i])
    index = pd.Index(np.array(numbers, dtype=np.int64) - FIRST_LINE)
    columns = {
        header[i]: pd.Series(c, index=index, dtype=object) for i, c in zip(kept, cells, strict=True)
    }
    table = pd.DataFrame(columns, index=index)
    table.attrs = {"doubled": sorted(doubled), "separator": separator, "layout": layout}
    return table


def _header(
    path: Path, layout: Layout, wanted: tuple[str, ...] | None
) -> tuple[list[str], str, int]:
    """Return the names of the columns, the separator and the number of the first row's line."""
    declared = layout.character
    named = excel_separator(next(text_lines(path, layout.encoding), ""))
    if named is not None and not layout.skip_rows:
        declared, layout = declared or named, replace(layout, skip_rows=1)
    candidates = [declared] if declared is not None else [",", ";", "\t"]
    best: tuple[list[str], str, int] | None = None
    for separator in candidates:
        try:
            header, first = _names(path, layout, separator)
        except SignkinError:
            if declared is not None or (separator == candidates[-1] and best is None):
                raise
            continue
        if wanted is not None and set(wanted) <= set(header):
            return header, separator, first
        if best is None or len(header) > len(best[0]):
            best = (header, separator, first)
    assert best is not None
    return best


def _names(path: Path, layout: Layout, separator: str) -> tuple[list[str], int]:
    rows = rows_of(path, layout, separator, layout.skip_rows + 1)
    if layout.header_rows == 0:
        for line, row in rows:
            width = len(row) if row[-1].strip() else len(row) - 1
            return [str(i + 1) for i in range(width)], line
        raise _nothing()
    head: list[list[str]] = []
    line = 0
    for line, row in rows:  # noqa: B007 the last one is wanted below
        head.append([composed(cell.strip()) for cell in row])
        if len(head) == layout.header_rows:
            break
    if len(head) < layout.header_rows:
        raise _nothing()
    width = max(len(row) for row in head)
    while width and not any(row[width - 1 : width] not in ([], [""]) for row in head):
        width -= 1
    if layout.header_rows == 1:
        names = head[0][:width]
        if width > 1 and not names[0] and NAMELESS not in names:
            names[0] = NAMELESS
        return names, line + 1
    return [" ".join(c for c in cells if c) for cells in spread(head, width)], line + 1


def spread(head: Sequence[Sequence[str]], width: int) -> list[tuple[str, ...]]:
    """Return the header's cells by column; an empty cell takes what stands left of it.

    The last row names each column by itself, and is not filled.
    """
    filled = []
    for place, row in enumerate(head):
        cells = [*row, *[""] * (width - len(row))][:width]
        if place < len(head) - 1:
            for i in range(1, width):
                cells[i] = cells[i] or cells[i - 1]
        filled.append(cells)
    return list(zip(*filled, strict=True))


def _nothing() -> SignkinError:
    return SignkinError(
        "not readable as CSV (nothing in it)", expected="a header and a row a frame"
    )


def rows_of(
    path: Path, layout: Layout, separator: str, first: int = 1
) -> Iterator[tuple[int, list[str]]]:
    """Yield (line, cells) of the rows from a line on; blank lines are passed over.

    The line is the one that the row starts on: cells in quotes may hold line breaks.
    """
    lines = text_lines(path, layout.encoding)
    for _ in range(first - 1):
        next(lines, None)
    if separator == " ":
        yield from ((n, text.split()) for n, text in enumerate(lines, start=first) if text.strip())
        return
    yield from table_rows(lines, separator, first)


def rows_of_part(table: pd.DataFrame, column: str | None, part: str | None) -> pd.DataFrame:
    """Return the rows of one recording, where a column tells several apart."""
    if column is None:
        return table
    column = known_column(table, column)
    if part is None:
        raise SignkinError(
            f"the table holds several recordings (column {column})",
            expected="the recording's value in the column `part` of recordings.csv",
        )
    rows = table[table[column] == part]
    if rows.empty:
        raise SignkinError(
            f"no row with {column} = {part}",
            place=f"column {column}",
            expected=listed(table[column].unique()),
        )
    return rows


def known_column(table: pd.DataFrame, column: str) -> str:
    """Return the name of a column that is there; a missing one is an error that lists them."""
    column = column if column in table.columns else composed(column)
    if column in table.attrs.get("doubled", ()):
        raise _stands_twice(column)
    if column not in table.columns:
        raise _no_column(column, list(table.columns), table.attrs.get("separator", ","))
    return column


def _no_column(name: str, header: Sequence[str], separator: str) -> SignkinError:
    todo = None
    if len(header) == 1:
        todo = "There is one column only: declare options: {separator: ...}."
    return SignkinError(f"no column {name!r}", expected=listed(header, 40), todo=todo)


def _stands_twice(name: str) -> SignkinError:
    return SignkinError(
        f"column {name!r} stands twice",
        place="header",
        expected="each column once",
        todo="Which one is meant cannot be known: rename or remove one.",
    )


def column_numbers(rows: pd.DataFrame, column: str) -> NDArray[np.float64]:
    """Return a column as numbers (an empty cell is NaN); other text is an error with its line."""
    return numbers_of(rows, [column])[:, 0]


def numbers_of(rows: pd.DataFrame, columns: Sequence[str]) -> NDArray[np.float64]:
    """Return columns as numbers, (rows, columns), all with the same decimal sign.

    An empty cell, `nan`, `NA` and what the layout calls missing is NaN; anything else that is no
    finite number in decimal digits is an error with its line.
    """
    layout: Layout = rows.attrs.get("layout", PLAIN)
    texts = [rows[known_column(rows, column)].tolist() for column in columns]
    decimal = _decimal(layout, texts, rows, columns)
    out = np.empty((len(rows), len(columns)))
    for place, (column, cells) in enumerate(zip(columns, texts, strict=True)):
        if decimal == ",":
            cells = [cell.replace(".", "\0").replace(",", ".") for cell in cells]
        out[:, place] = _numbers(cells, column, rows, layout.missing)
    return out


def _numbers(
    cells: Sequence[str], column: str, rows: pd.DataFrame, missing: Sequence[str]
) -> NDArray[np.float64]:
    if not missing and set("".join(cells)) <= _DIGITS:
        # Only digits and signs: numpy's own parser reads them as Python would, at once.
        try:
            values = np.array(cells, dtype=float)
        except ValueError:
            pass
        else:
            if np.isfinite(values).all():
                return values
    out = np.empty(len(cells))
    for i, cell in enumerate(cells):
        word = cell.strip()
        value = number(word)
        if word.lower() in GAPS or word in missing:
            value = float("nan")
        if value is None:
            raise SignkinError(
                f"found {quoted(rows[known_column(rows, column)].iloc[i])}",
                place=f"line {rows.index[i] + FIRST_LINE}, column {column}",
                expected="a number, or nothing for a gap",
            )
        out[i] = value
    return out


def _decimal(
    layout: Layout, texts: Sequence[Sequence[str]], rows: pd.DataFrame, columns: Sequence[str]
) -> str:
    """Return the decimal sign: a comma, where numbers have commas and none has a point."""
    if layout.decimal is not None:
        return layout.decimal
    comma: tuple[int, str, str] | None = None
    point = False
    for column, cells in zip(columns, texts, strict=True):
        joined = "\n".join(cells)
        point = point or "." in joined
        if comma is None and "," in joined:
            i = next(i for i, cell in enumerate(cells) if "," in cell)
            comma = (i, column, cells[i])
    if comma is None:
        return "."
    i, column, cell = comma
    # With commas between cells, or points in other numbers, a comma may part the thousands.
    if point or rows.attrs.get("separator", ",") == ",":
        raise SignkinError(
            f"found {quoted(cell)}",
            place=f"line {rows.index[i] + FIRST_LINE}, column {column}",
            expected="a number, or nothing for a gap",
            todo="Is the comma a decimal sign? Declare options: {decimal: ','}.",
        )
    return ","


def printed_half_digit(rows: pd.DataFrame, column: str) -> float:
    """Return half a unit of the last digit that a column's numbers have: the finest one.

    Zeros at the end are no digits: some print 3.067 as 3.067000.
    """
    return finest_half_digit(rows[known_column(rows, column)].tolist())


def finest_half_digit(cells: Sequence[str]) -> float:
    """Return half a unit of the last digit that numbers have, zeros at the end left away."""
    words = [cell.strip().replace(",", ".") for cell in cells]
    words = [w.rstrip("0") if "." in w and "e" not in w.lower() else w for w in words]
    return min((half_digit(word) for word in words if number(word) is not None), default=0.0)
