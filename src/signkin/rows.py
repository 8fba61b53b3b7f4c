"""Rows of a text table: cells that know their line. The one row reader of the package.

Motion, tags and a corpus's own tables are read by it, so that quotes, blank lines, line numbers and
Excel's first line `sep=;` mean the same everywhere.
"""

from __future__ import annotations

import csv
import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from typing import Literal

from signkin.errors import SignkinError

# Excel writes, and hides, a first line that names the separator.
_EXCEL = re.compile(r'"?sep=(.)"?[,;\t]*', re.IGNORECASE)


def table_rows(
    lines: Iterable[str],
    separator: str,
    first: int = 1,
    blank: Literal["cells", "lines", "none"] = "lines",
) -> Iterator[tuple[int, list[str]]]:
    """Yield (line, cells) of the rows in lines of text, which come without their ends.

    first: the number of the first line. blank: which rows are passed over: empty `lines`, rows
    whose `cells` are all blank, or none (an empty line is then one empty cell). The line is the one
    that the row starts on: cells in quotes may hold line breaks.
    Raises SignkinError for quotes that do not close, and for cells of over 100 kB.
    """
    reader = csv.reader((f"{line}\n" for line in lines), delimiter=separator, strict=True)
    before = 0
    while True:
        try:
            row = next(reader)
        except StopIteration:
            return
        except csv.Error as error:
            raise SignkinError(
                f"not readable as CSV ({error})",
                place=f"line {first + before}",
                expected="quotes in pairs, and cells of less than 100 kB",
            ) from error
        line, before = first + before, reader.line_num
        empty = not row or (len(row) == 1 and not row[0].strip())
        if blank == "cells":
            empty = not any(cell.strip() for cell in row)
        if blank == "none" or not empty:
            yield line, row or [""]


def excel_separator(line: str) -> str | None:
    """Return the separator that a first line `sep=;` names, None where it is another line."""
    found = _EXCEL.fullmatch(line.strip())
    return found[1] if found else None


def check_length(row: Sequence[str], expected: int, line: int) -> None:
    """Refuse a row of more or fewer cells than the header, unless what is too much is empty."""
    if len(row) < expected or any(cell.strip() for cell in row[expected:]):
        raise SignkinError(
            f"{len(row)} cells",
            place=f"line {line}",
            expected=f"{expected}, as in the header",
            todo="Is text with a separator in it in quotes, and what is missing an empty cell?",
        )


def composed(text: str) -> str:
    """Return text with each accent and its letter as one, as files of most systems have it."""
    return unicodedata.normalize("NFC", text)


def plain_name(column: str) -> str:
    """Return a column's name in small letters, all but letters and digits as one `_`."""
    return re.sub(r"[^a-z0-9]+", "_", column.lower()).strip("_")
