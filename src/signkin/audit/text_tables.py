"""Tables in running text: lines whose cells stand apart by tabs, bars or two spaces."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

MOST_TABLES = 100
_RULE = re.compile(r"[-=_+|:\s\u2013\u2014\u2500\u2502]+")


@dataclass(frozen=True)
class TextTable:
    """A table of a text: its header, its rows, and the line of its header."""

    header: list[str]
    rows: list[list[str]]
    line: int


def cells_of(line: str) -> list[str]:
    """Return the cells of a line; one cell where nothing parts it."""
    if "\t" in line:
        return [cell.strip() for cell in line.strip("\n").split("\t")]
    if line.count("|") > 1:
        return [cell.strip() for cell in line.strip().strip("|").split("|")]
    return re.split(r"\s{2,}", line.strip())


def tables_in(text: str, is_header: Callable[[Sequence[str]], bool]) -> Iterator[TextTable]:
    """Yield the tables of a text whose header is one that is looked for.

    Rows follow their header without a break, but for ruled lines; a row of another number of
    cells ends the table. Where the header lacks a name for the first column, it is given one.
    """
    lines = text.splitlines()
    at = found = 0
    while at < len(lines) and found < MOST_TABLES:
        header = cells_of(lines[at])
        if len(header) < 2 or not is_header(header):
            at += 1
            continue
        start, rows = at, list[list[str]]()
        at += 1
        while at < len(lines):
            if lines[at].strip() and _RULE.fullmatch(lines[at]):
                at += 1
                continue
            cells = cells_of(lines[at])
            if len(cells) == len(header) + 1 and not rows:
                header = ["row", *header]
            if len(cells) != len(header):
                break
            rows.append(cells)
            at += 1
        if rows:
            found += 1
            yield TextTable(header, rows, start + 1)
