"""Claims drafted from a table: n, means and SDs in whatever shape, tests, regressions, counts."""

from __future__ import annotations

import csv
import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from signkin.audit.drafts import Draft
from signkin.audit.table_claims import add_others
from signkin.audit.table_shapes import Shape, merged_headers, shape_of
from signkin.audit.table_words import decimal_commas, is_numeric, pair_of, role_of, tidy
from signkin.errors import listed

ORDER = ("n", "mean", "value", "sd", "se", "in_brackets", "low", "high")
_PLAIN = ("n", "mean", "sd", "se")


def from_table(text: str, file: Path) -> Draft:
    """Return claims about a table of a file."""
    try:
        sniffed = csv.Sniffer().sniff(text[:4000], delimiters=",;\t")
        rows = list(csv.reader(text.splitlines(), sniffed))
    except csv.Error:
        rows = list(csv.reader(text.splitlines()))
    draft = Draft()
    rows = [[cell.strip() for cell in row] for row in rows]
    kept = [(i, row) for i, row in enumerate(rows, 1) if any(row)]
    if len(kept) > 2 and sum(bool(c) for c in kept[0][1]) == 1 < len(kept[1][1]):
        kept = kept[1:]  # a title above the header
    if len(kept) < 2:
        draft.not_understood.append(f"{file.name}: a table without rows")
        return draft
    width = Counter(len(row) for _, row in kept).most_common(1)[0][0]
    ragged = [i for i, row in kept if len(row) != width]
    if len(kept[0][1]) != width and len(kept) == 2:
        ragged = [kept[1][0]]
    if ragged:
        draft.not_understood.append(
            f"{file.name}, row {listed(ragged)}: more or fewer cells than the other rows; left out"
        )
        kept = [(i, row) for i, row in kept if i not in ragged]
    if len(kept) < 2:
        draft.not_understood.append(f"{file.name}: a table without rows")
        return draft
    return from_rows([row for _, row in kept], file, draft)


def from_rows(rows: list[list[str]], file: Path, draft: Draft, place: str = "") -> Draft:
    """Add the claims about a table to a draft; place: where it stands in a text.

    rows: those of the header first.
    """
    told = f"{place}: the table" if place else file.name
    rows = _points(rows, draft, told)
    header, body = merged_headers(rows)
    if not body:
        draft.not_understood.append(f"{told}: no row has numbers")
        return draft
    stem = re.sub(r"[^A-Za-z0-9._-]+", "-", file.stem)
    number = draft.numbers["table"] = draft.numbers.get("table", 0) + bool(place)
    name = f"{stem}-table{number}" if place else stem
    before = len(draft.claims)
    header_, body_ = _taken_apart(header, body)
    roles = _simple_roles(header_)
    shape = shape_of(header, body)
    if roles is not None:
        claim = _sentence(roles, len(body_))
        draft.add("T", place or f"{name}.csv", claim, _table_claim(
            f"{name}.csv", roles, _unread(header_, body_, roles)))  # fmt: skip
        draft.tables[f"{name}.csv"] = as_csv([header_, *body_])
    else:
        _from_shape(shape, f"{name}.csv", draft, told, place)
    add_others(shape, header, body, name, draft, place, told)
    if len(draft.claims) == before:
        draft.not_understood.append(
            f"{told}: no n with means, no test with its df and p among {listed(_named(header), 30)}"
        )
    return draft


def _named(header: Sequence[str]) -> list[str]:
    return [name for name in header if name]


def as_csv(rows: Iterable[Sequence[str]]) -> str:
    """Return rows as CSV."""
    return "\n".join(",".join(_quoted(row)) for row in rows) + "\n"


def _quoted(row: Iterable[str]) -> Iterator[str]:
    for cell in row:
        yield '"' + cell.replace('"', '""') + '"' if set(cell) & set(',"\n') else cell


def _points(rows: list[list[str]], draft: Draft, told: str) -> list[list[str]]:
    """Write decimal commas as points where all of a table has commas; tell it."""
    commas, points = decimal_commas(rows)
    if not commas:
        return rows
    if points:
        draft.not_understood.append(
            f"{told}: {commas} numbers with a decimal comma, {points} with a point; left so"
        )
        return rows
    draft.not_understood.append(f"{told}: decimal commas, written as points (no other numbers)")
    return [
        [re.sub(r"(?<=\d),(?=\d)|(?<![\d.]),(?=\d)", ".", cell) if is_numeric(cell) else cell
         for cell in row] for row in rows
    ]  # fmt: skip


def _taken_apart(header: list[str], body: list[list[str]]) -> tuple[list[str], list[list[str]]]:
    """Take columns of `5.1 (1.2)` or `5.1 ± 1.2` apart into two."""
    out_head: list[str] = []
    out: list[list[str]] = [[] for _ in body]
    for i, name in enumerate(header):
        cells = [row[i] for row in body]
        filled = [cell for cell in cells if cell]
        if filled and all(pair_of(cell) for cell in filled):
            first, _, second = re.sub(r"[()\[\]±,/]", " ", name).strip().partition(" ")
            out_head += [first or "mean", second.strip() or "in_brackets"]
            for row, cell in zip(out, cells, strict=True):
                row += pair_of(cell) or ("", "")
        else:
            out_head.append(name or ("row" if not i else ""))
            for row, cell in zip(out, cells, strict=True):
                row.append(tidy(cell))
    return out_head, out


def _simple_roles(header: Sequence[str]) -> dict[str, str] | None:
    """Return role -> column where n and means stand in one column each; None otherwise."""
    roles: dict[str, str] = {}
    if len(set(header)) < len(header) or "" in header:
        return None
    for name in header:
        role = role_of(name)
        if role in roles:
            return None
        if role in _PLAIN:
            roles[role] = name
    return roles if {"n", "mean"} <= set(roles) else None


def _unread(
    header: Sequence[str], body: Sequence[Sequence[str]], roles: Mapping[str, str]
) -> list[str]:
    """Return the columns with numbers that no check reads."""
    return [
        name for j, name in enumerate(header)
        if j and name not in roles.values() and any(is_numeric(row[j]) for row in body if row[j])
    ]  # fmt: skip


def _sentence(roles: Mapping[str, str], rows: int) -> str:
    of = "n, mean and SD" if "sd" in roles else "n and mean"
    return f"{of[0].upper()}{of[1:]} of {rows} row{'s' if rows > 1 else ''}."


def _from_shape(shape: Shape, name: str, draft: Draft, told: str, place: str) -> None:
    """Add the claim about a table's means, brought to a row a measure and group."""
    found = {
        key: cells for key, cells in shape.cells.items() if {"mean", "value"} & set(cells)
    }  # fmt: skip
    if "value" in {r for c in found.values() for r in c} and not any(
        "in_brackets" in c or "n" in c for c in found.values()
    ):
        found = {key: cells for key, cells in found.items() if "mean" in cells}
    if not found:
        return
    there = [role for role in ORDER if role == "n" or any(role in c for c in found.values())]
    rows = [
        [", ".join(part for part in key if part) or "all", *(c.get(role, "") for role in there)]
        for key, c in found.items()
    ]  # fmt: skip
    lacking = [row[0] for row in rows if not row[1]]
    if lacking:
        draft.not_understood.append(
            f"{told}: n of {listed(lacking)} does not stand beside it; fill it into {name}"
        )
    roles = {role: role for role in there if role in _PLAIN}
    if "mean" not in roles:
        roles["mean"] = "value"
    if "sd" not in roles and "in_brackets" in there:
        roles["sd"] = "in_brackets"
    unread = [role for role in there if role in ("value", "in_brackets")]
    if unread:
        draft.not_understood.append(
            f"{told}: what the numbers {'in brackets ' if unread == ['in_brackets'] else ''}are is "
            f"not told (SDs?); they stand as {listed(unread)}"
        )
    if shape.unread:
        draft.not_understood.append(f"{told}: cells without a number that is read: "
                                    f"{listed([c[:30] for c in shape.unread], 6)}")  # fmt: skip
    draft.add("T", place or name, f"Means of {len(rows)} cell{'s' if len(rows) > 1 else ''}, by "
              "measure and group.", _table_claim(name, roles, unread))  # fmt: skip
    draft.tables[name] = as_csv([["row", *there], *rows])


def _table_claim(name: str, roles: Mapping[str, str], unread: Sequence[str]) -> Iterator[str]:
    named = {role: column for role, column in roles.items() if column != role}

    def given(*of: str) -> str:
        return "".join(f", {role}: {json.dumps(named[role])}" for role in of if role in named)

    if unread:
        yield f"# ? not looked at: {listed(unread)}; `signkin audit list` tells what can be"
    yield "# ? Do values come in steps (points, frames)? Then add, with the step as grain:"
    check, own = ("grim", given("n", "mean"))
    if "sd" in roles:
        check, own = "grimmer", given("n", "mean", "sd") + ", divisor: either"
    elif "se" in roles:
        check, own = "grimmer", given("n", "mean") + f", sd: {json.dumps(roles['se'])}, spread: se"
    yield f'#   - {{check: {check}, table: {name}, grain: "1"{own}, reads: "Points."}}'
    if "sd" in roles:
        yield "# ? On a scale? Then add its ends; `closure` counts the samples that print so:"
    ends = f'low: "1", high: "7"{given("n", "mean", "sd")}'
    if "sd" in roles:
        yield f'#   - {{check: scale_bounds, table: {name}, {ends}, reads: "A scale."}}'
    yield "checks:"
    columns = json.dumps(list(roles.values()))
    yield f"  - {{check: rows_twice, table: {name}, columns: {columns},"
    yield '     reads: "No two rows have the same numbers."}'
    if {"sd", "se"} <= set(roles):
        yield f"  - {{check: standard_error, table: {name}{given('n', 'sd', 'se')},"
        yield '     reads: "The standard error is the SD over the root of n."}'
