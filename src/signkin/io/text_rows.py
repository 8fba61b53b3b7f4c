"""Text files: decoded by what their bytes are, and tables of cells that know their line.

Cells stay text, so that no library guesses at headers, missing values or thousands.
"""

from __future__ import annotations

import codecs
import csv
import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from signkin.errors import SignkinError, listed
from signkin.rows import check_length, composed, excel_separator, table_rows

SEPARATORS = (",", ";", "\t")
NAMED = {"comma": ",", "semicolon": ";", "tab": "\t"}
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?", re.ASCII)
# h:m:s or m:s; the seconds may have decimals, or frames behind another colon or semicolon.
_CLOCK = re.compile(
    r"(?P<sign>[+-]?)(?:(?P<h>[0-9]{1,4}):)?(?P<m>[0-9]{1,4}):(?P<s>[0-9]{1,2})"
    r"(?:[.,](?P<part>[0-9]{1,9})|(?P<mark>[:;])(?P<f>[0-9]{1,3}))?",
    re.ASCII,
)


def read_text(path: Path, encoding: str | None = None) -> str:
    """Return a text file; UTF-8 and UTF-16 are told by their bytes, others must be declared."""
    return decoded(path.read_bytes(), encoding)


def decoded(content: bytes, encoding: str | None = None) -> str:
    """Return bytes as text with line ends as `\\n`; see `read_text`."""
    name = encoding or _told(content)
    try:
        text = content.decode(name)
    except LookupError:
        raise SignkinError(
            f"no encoding is called {encoding!r}", place="encoding", expected="e.g. latin-1"
        ) from None
    except UnicodeError as error:
        at = getattr(error, "start", 0)
        line = content.count(b"\n", 0, at) + 1
        raise SignkinError(
            f"the text is not {name} (byte {content[at : at + 1].hex() or '?'})",
            place=f"line {line}",
            expected="UTF-8 or UTF-16",
            todo="Save it as UTF-8, or declare its `encoding`, e.g. latin-1.",
        ) from error
    return text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")


def _told(content: bytes) -> str:
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    head = content[:200]
    if len(head) >= 4 and head[1::2].count(0) > len(head) // 4:
        return "utf-16-le"
    if len(head) >= 4 and head[::2].count(0) > len(head) // 4:
        return "utf-16-be"
    return "utf-8"


@dataclass(frozen=True)
class Row:
    """A row of a table: its line in the file and its cells."""

    line: int
    cells: tuple[str, ...]


@dataclass(frozen=True)
class TextTable:
    """A table with named columns; every row has as many cells as there are columns."""

    columns: tuple[str, ...]
    rows: tuple[Row, ...]

    def index(self, column: str) -> int:
        """Return the place of a column; one that is missing or doubled is an error."""
        count = self.columns.count(column)
        if count == 1:
            return self.columns.index(column)
        if not count:  # accents may be coded in another way
            plain = [composed(name) for name in self.columns]
            wanted = composed(column)
            if plain.count(wanted) == 1:
                return plain.index(wanted)
        if count:
            raise SignkinError(
                f"{count} columns are called {column!r}", place="line 1", expected="one"
            )
        raise SignkinError(f"no column {column!r}", expected=listed(_flat(self.columns), 40))

    def part(self, column: str | None, part: str | None) -> TextTable:
        """Return the rows of one recording, where a column tells several apart."""
        if column is None:
            return self
        place = self.index(column)
        if part is None:
            raise SignkinError(
                f"the table holds several recordings (column {column})",
                expected="the recording's value in the column `part` of recordings.csv",
            )
        rows = tuple(row for row in self.rows if row.cells[place].strip() == part)
        if not rows:
            there = dict.fromkeys(row.cells[place] for row in self.rows)
            raise SignkinError(
                f"no row with {column} = {part}",
                place=f"column {column}",
                expected=listed(_flat(there)),
            )
        return TextTable(self.columns, rows)


def _flat(names: Iterable[str]) -> list[str]:
    """Return names as a message may quote them."""
    return [name.replace("\n", " ")[:60] for name in names]


def read_table(
    path: Path,
    wanted: Sequence[str],
    separator: str | None = None,
    encoding: str | None = None,
    *,
    keep_blank: bool = False,
) -> TextTable:
    """Read a table with a header row; a file is parsed once, however often asked for.

    wanted: columns that tell the separator (comma, semicolon or tab) where none is declared.
    keep_blank: a row without any text counts, where rows are frames.
    """
    state = path.stat()
    return _parsed(
        path, tuple(wanted), separator, encoding, keep_blank, state.st_mtime_ns, state.st_size
    )


@lru_cache(maxsize=4)
def _parsed(
    path: Path,
    wanted: tuple[str, ...],
    separator: str | None,
    encoding: str | None,
    keep_blank: bool,
    mtime_ns: int,
    size: int,
) -> TextTable:
    text = read_text(path, encoding)
    named = excel_separator(text.partition("\n")[0])
    start = 1 if named is None else 2
    head = next((line for line in text.split("\n")[start - 1 :] if line.strip()), "")
    mark = separator or named or _separator(head, wanted)
    rows = split_rows(text, mark, keep_blank=keep_blank, first=start)
    if not rows:
        raise SignkinError("nothing in it", place="line 1", expected="a header and rows")
    columns = tuple(cell.strip() for cell in rows[0].cells)
    while columns and not columns[-1]:
        columns = columns[:-1]
    for row in rows[1:]:
        if len(row.cells) != len(columns):
            check_length(row.cells, len(columns), row.line)
    return TextTable(columns, tuple(Row(r.line, r.cells[: len(columns)]) for r in rows[1:]))


def split_rows(text: str, separator: str, *, keep_blank: bool = False, first: int = 1) -> list[Row]:
    """Return the rows of a text, with the line each starts in; blank ones if they count.

    An empty line has one empty cell. first: the line to start with.
    """
    separator = NAMED.get(separator, separator) if isinstance(separator, str) else separator
    if not isinstance(separator, str) or len(separator) != 1 or separator in '"\n':
        raise SignkinError(
            f"the separator is {separator!r}",
            place="separator",
            expected=f"{listed(NAMED)}, or one character",
        )
    lines = text.removesuffix("\n").split("\n")[first - 1 :]
    rows = table_rows(lines, separator, first, "none" if keep_blank else "cells")
    return [Row(line, tuple(cells)) for line, cells in rows]


def _separator(head: str, wanted: Sequence[str]) -> str:
    best, most = SEPARATORS[0], -1
    for separator in SEPARATORS:
        try:
            cells = [cell.strip() for cell in next(csv.reader([head], delimiter=separator), [])]
        except csv.Error:
            continue
        there = sum(name in cells for name in wanted) * 1000 + len(cells)
        if there > most:
            best, most = separator, there
    return best


# --- times ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class TimeFormat:
    """How times are written.

    unit: s, ms, frames or timecode; a cell with a colon is read as a timecode in any case.
    decimal: `.` or `,`; None takes a comma for the decimal sign where it cannot be anything else.
    frame_rate_hz: of frame numbers, and of timecodes that end in frames.
    """

    unit: str = "s"
    decimal: str | None = None
    frame_rate_hz: float | None = None

    def __post_init__(self) -> None:
        """Check the declaration."""
        if self.unit not in ("s", "ms", "frames", "timecode"):
            raise SignkinError(
                f"the time unit is {self.unit!r}",
                place="time_unit",
                expected="s, ms, frames or timecode",
            )
        if self.decimal not in (None, ".", ","):
            raise SignkinError(
                f"the decimal sign is {self.decimal!r}", place="decimal", expected="`.` or `,`"
            )
        rate = self.frame_rate_hz
        if rate is not None and not (
            isinstance(rate, int | float) and math.isfinite(rate) and rate > 0
        ):
            raise SignkinError(
                f"the frame rate is {rate!r}", place="frame_rate_hz", expected="a rate in Hz"
            )
        if self.unit == "frames" and rate is None:
            raise SignkinError(
                "times in frames, no rate", place="frame_rate_hz", expected="the rate of the frames"
            )

    def seconds(self, cell: str, place: str, add: float = 0.0) -> float:
        """Return a cell in seconds. add: in the cell's unit, before it is turned to seconds."""
        text = cell.strip()
        if ":" in text:
            return self._timecode(text, place) + add / (self.frame_rate_hz or math.inf)
        value = self._number(text, place)
        if self.unit == "timecode":
            raise SignkinError(f"found {cell[:40]!r}", place=place, expected="h:m:s.ms, or h:m:s:f")
        if self.unit == "frames":
            assert self.frame_rate_hz is not None
            return (value + add) / self.frame_rate_hz
        return (value + add) * (0.001 if self.unit == "ms" else 1.0)

    def _number(self, text: str, place: str) -> float:
        plain = text
        if "," in text and self.decimal != ".":
            # 1,234 is a thousand to some; 0,4 and 12,75 are not.
            sure = self.decimal == "," or re.fullmatch(r"[+-]?[0-9]+,[0-9]+", text)
            grouped = re.fullmatch(r"[+-]?[1-9][0-9]{0,2}(,[0-9]{3})+", text)
            if sure and not (self.decimal is None and grouped):
                plain = text.replace(",", ".")
            elif grouped:
                raise SignkinError(
                    f"found {text[:40]!r}, which is a thousand or a decimal comma",
                    place=place,
                    expected='a number that tells, or `decimal: ","` in options',
                )
        elif self.decimal == "," and "." in text:
            plain = ""
        value = float(plain) if _NUMBER.fullmatch(plain) else math.nan
        if not math.isfinite(value):
            raise SignkinError(
                f"found {text[:40]!r}" if text else "the time is missing",
                place=place,
                expected="a finite number",
            )
        return value

    def _timecode(self, text: str, place: str) -> float:
        found = _CLOCK.fullmatch(text)
        if not found or int(found["s"]) > 59 or (found["h"] and int(found["m"]) > 59):
            raise SignkinError(f"found {text[:40]!r}", place=place, expected="h:m:s.ms, or h:m:s:f")
        sign = -1.0 if found["sign"] == "-" else 1.0
        minutes = int(found["h"] or 0) * 60 + int(found["m"])
        whole = minutes * 60 + int(found["s"])
        if found["f"] is None:
            return sign * (whole + float(f"0.{found['part'] or 0}"))
        rate, frame = self.frame_rate_hz, int(found["f"])
        if rate is None:
            raise SignkinError(
                f"found {text[:40]!r}, a timecode with frames",
                place=place,
                expected="the video's rate as `frame_rate_hz`",
            )
        nominal = round(rate)
        if frame >= max(nominal, 1):
            raise SignkinError(
                f"found {text[:40]!r}: no frame {frame} at {rate:g} Hz",
                place=place,
                expected=f"frames 0 to {nominal - 1}",
            )
        count = whole * nominal + frame
        if found["mark"] == ";":  # drop-frame: numbers are left out, but in each tenth minute
            count -= (nominal // 15) * (minutes - minutes // 10)
        return sign * count / rate
