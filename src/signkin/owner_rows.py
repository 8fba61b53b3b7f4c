"""Tables that people write beside a corpus: recordings.csv, signs.csv.

As spreadsheets save them: with commas, semicolons or tabs, Excel's line `sep=;`, decimal commas
beside semicolons, blank rows, blanks around cells. What cannot be meant is an error with its line.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from signkin.errors import SignkinError, listed
from signkin.rows import check_length, composed, excel_separator, plain_name, table_rows
from signkin.text_file import text_of

_DECIMAL = re.compile(r"-?[0-9]+,[0-9]+")


@dataclass(frozen=True)
class OwnerTable:
    """A table: the names of its columns, and its rows as (line, cell by column)."""

    columns: tuple[str, ...]
    rows: tuple[tuple[int, dict[str, str]], ...]


def read_owner_table(path: Path, as_written: Sequence[str] = ()) -> OwnerTable:
    """Return a table of a corpus; as_written: columns whose cells keep the blanks around them.

    Raises SignkinError for a file that is not UTF-8, columns that stand twice, rows of more or
    fewer cells than the header, and line breaks in cells; FileNotFoundError where it is not there.
    """
    lines = re.split(r"\r\n|\n|\r", text_of(path))
    separator = excel_separator(lines[0])
    first = 1 if separator is None else 2
    head = next((line for line in lines[first - 1 :] if line.strip(" ,;\t")), "")
    separator = separator or max(",;\t", key=head.count)
    try:
        rows = list(table_rows(lines[first - 1 :], separator, first, "cells"))
        if not rows:
            return OwnerTable((), ())
        line, names = rows[0]
        columns = [plain_name(name) for name in names]
        while columns and not columns[-1]:
            columns.pop()
        twice = [name for name in columns if columns.count(name) > 1]
        if twice:
            raise SignkinError(
                f"the column {twice[0]!r} stands twice", place=f"line {line}", expected="each once"
            )
        body = [(line, _cells(columns, row, line, separator, as_written)) for line, row in rows[1:]]
    except SignkinError as error:
        raise error.at(file=path) from error
    return OwnerTable(tuple(columns), tuple(body))


def _cells(
    columns: Sequence[str], row: Sequence[str], line: int, separator: str, as_written: Sequence[str]
) -> dict[str, str]:
    if len(row) != len(columns):
        try:
            check_length(row, len(columns), line)
        except SignkinError as error:
            raise SignkinError(
                "the row has more or fewer cells than the header",
                place=error.place,
                expected=listed(columns),
                todo=error.todo,
            ) from error
    out = {}
    for column, cell in zip(columns, row, strict=False):
        if "\n" in cell.strip():
            raise SignkinError(
                "a line break in a cell", place=f"line {line}, column {column}", expected="one line"
            )
        text = cell if column in as_written else cell.strip()
        if separator != "," and _DECIMAL.fullmatch(text):
            text = text.replace(",", ".")
        out[column] = composed(text) if column in as_written else text
    return out
