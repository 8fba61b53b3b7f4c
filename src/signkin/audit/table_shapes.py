"""Printed tables whose n, means and SDs do not stand as columns, as rows of one cell's numbers.

Groups as columns, `M (SD)` in one cell, n in a header or a row of its own, two lines of headers,
statistics as rows: each number is brought to its measure and group. What stands in brackets
without a name keeps the name `in_brackets`: it may be an SD, an error, or anything.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from signkin.audit.table_words import (
    TESTS,
    Header,
    bare_number,
    header_of,
    in_brackets,
    is_numeric,
    names_a_test,
    pair_of,
    role_of,
    tidy,
)

Key = tuple[str, str]  # measure, group


@dataclass
class Shape:
    """What a table has: numbers by measure and group, tests by measure, and what is left."""

    cells: dict[Key, dict[str, str]] = field(default_factory=dict)
    tests: dict[str, dict[str, str]] = field(default_factory=dict)
    unread: list[str] = field(default_factory=list)

    def roles(self) -> set[str]:
        """The roles that have a number."""
        return {role for found in self.cells.values() for role in found}


def merged_headers(rows: Sequence[Sequence[str]]) -> tuple[list[str], list[list[str]]]:
    """Return one header of a table's first rows, and its body.

    A name over several columns stands over the first of them, and over those that follow it
    empty. Header rows go on until a row has a number beside its label.
    """
    first = next(
        (i for i, row in enumerate(rows) if i and any(is_numeric(c) for c in row[1:] if c.strip())
         and not _is_header(row)), 1)  # fmt: skip
    heads = [list(row) for row in rows[:first]]
    width = max(len(row) for row in rows)
    heads = [row + [""] * (width - len(row)) for row in heads]
    for row in heads[:-1]:
        for j in range(2, width):
            if not row[j].strip() and row[0].strip() != row[j - 1].strip():
                lower = heads[-1][j].strip()
                row[j] = row[j - 1] if lower and not names_a_test(lower) else ""
    names = []
    for j in range(width):
        parts = list(dict.fromkeys(row[j].strip() for row in heads if row[j].strip()))
        names.append(" ".join(parts))
    body = [[tidy(c) for c in row] + [""] * (width - len(row)) for row in rows[first:]]
    return names, body


def _is_header(row: Sequence[str]) -> bool:
    """Whether a row has names of columns, of which some may be numbers (`1`, `2`, `3`)."""
    roles = [role_of(c) for c in row[1:] if c.strip()]
    return sum(bool(r) for r in roles) > len(roles) / 2


def shape_of(header: Sequence[str], body: Sequence[Sequence[str]]) -> Shape:
    """Return the numbers of a table by measure and group."""
    shape, columns = Shape(), [header_of(name) for name in header]
    labels = _label_columns(columns, body)
    statistic = _statistic_column(labels, body)
    joined = _with_brackets(body, labels)
    sizes: dict[str, str] = {}
    section = ""
    for row in joined:
        told = header_of(row[statistic]) if statistic is not None else Header()
        words = [row[j] for j in labels if j != statistic and row[j].strip()]
        name = header_of(", ".join(words)) if words else Header()
        if not any(row[j].strip() for j in range(len(row)) if j not in labels):
            section = " ".join(row[j].strip() for j in labels if row[j].strip()) or section
            continue
        roles = told.roles or name.roles
        measure = name.rest or told.rest or (section if roles else "")
        if statistic is not None and not words:
            measure = told.rest or section
        elif statistic is not None:
            section = measure
        for j, column in enumerate(columns):
            if j not in labels and row[j].strip():
                _put(shape, row[j], column, Header(roles, measure, name.n or told.n), sizes)
    for (_, group), found in shape.cells.items():
        if "n" not in found and group in sizes:
            found["n"] = sizes[group]
    return shape


def _label_columns(columns: Sequence[Header], body: Sequence[Sequence[str]]) -> list[int]:
    """Return the columns of words: the first one, and those that follow it without numbers."""
    out = []
    for j, column in enumerate(columns):
        filled = [row[j] for row in body if row[j].strip()]
        if j and (column.roles or not filled or any(is_numeric(cell) for cell in filled)):
            break
        if j == 0 and column.roles and filled and all(is_numeric(c) for c in filled):
            break
        out.append(j)
    return out


def _statistic_column(labels: Sequence[int], body: Sequence[Sequence[str]]) -> int | None:
    """Return the column that names n, M and SD, where one does."""
    for j in labels:
        named = {role_of(row[j]) or "-".join(header_of(row[j]).roles) for row in body} - {""}
        plain = sum(bool(role_of(row[j])) for row in body)
        if len(named) >= 2 and named & {"mean", "n", "sd"} and plain >= len(body) / 2:
            return j
    return None


def _with_brackets(body: Sequence[Sequence[str]], labels: Sequence[int]) -> list[list[str]]:
    """Join a row whose numbers all stand in brackets to the one above it: `5.1` over `(1.2)`."""
    out: list[list[str]] = []
    for row in body:
        filled = [j for j in range(len(row)) if j not in labels and row[j].strip()]
        own = any(row[j].strip() for j in labels)
        if out and filled and not own and all(in_brackets(row[j]) for j in filled) and all(
            bare_number(out[-1][j]) for j in filled
        ):  # fmt: skip
            out[-1] = [f"{c} {row[j]}" if j in filled else c for j, c in enumerate(out[-1])]
        else:
            out.append(list(row))
    return out


def _put(shape: Shape, cell: str, column: Header, row: Header, sizes: dict[str, str]) -> None:
    """Bring a cell to its measure and group, by the roles of its column or of its row."""
    roles, group, measure = column.roles or row.roles, column.rest, row.rest
    single, two = bare_number(cell), pair_of(cell)
    if roles and roles[0] in TESTS and len(roles) == 1:
        found = shape.tests.setdefault(measure, {})
        found.setdefault(roles[0], cell)
        if column.df:
            found.setdefault("df", column.df)
        return
    if not single and not two:
        if cell.strip("-\u2013\u2014 "):
            shape.unread.append(cell)
        return
    if roles == ("n",) and not measure and single:
        sizes[group] = single
        return
    key = (measure, group)
    if two:
        names = roles if len(roles) == 2 else ((roles[0] if roles else "value"), "in_brackets")
        put = dict(zip(names, two, strict=True))
    else:
        put = {roles[0] if roles else "value": single}
    found = shape.cells.setdefault(key, {})
    for role, text in put.items():
        found.setdefault(role, text)
    size = column.n or row.n
    if size:
        found.setdefault("n", size)
