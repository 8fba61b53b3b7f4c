"""Claims drafted from a table with columns of n, mean, and SD or standard error."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from signkin.audit.drafts import Draft
from signkin.audit.rounding import is_number
from signkin.errors import listed

N_NAMES = ("n", "number", "count", "participants", "subjects", "size")
MEAN_NAMES = ("mean", "m", "average", "avg")
SD_NAMES = ("sd", "s.d.", "std", "stdev", "standarddeviation", "std.dev.")
SE_NAMES = ("se", "s.e.", "sem", "standarderror", "std.error", "std.err.")
BOTH = re.compile(r"\s*([-\u2212]?[\d.]+)\s*(?:\(\s*([\d.]+)\s*\)|±\s*([\d.]+))\s*")


def is_header(cells: Sequence[str]) -> bool:
    """Whether cells of a line name columns of n and of means."""
    roles = {role for role, names in _ROLES for cell in cells if _bare(cell) in names}
    both = any(_bare(part) in MEAN_NAMES for cell in cells for part in re.split(r"[(±]", cell)[:1])
    return "n" in roles and ("mean" in roles or both)


_ROLES = (("n", N_NAMES), ("mean", MEAN_NAMES), ("sd", SD_NAMES), ("se", SE_NAMES))


def _bare(text: str) -> str:
    return re.sub(r"[\s_]", "", text.lower())


def from_table(text: str, file: Path) -> Draft:
    """Return claims about a table with n and mean, and an SD or standard error."""
    try:
        sniffed = csv.Sniffer().sniff(text[:4000], delimiters=",;\t")
        rows = list(csv.reader(text.splitlines(), sniffed))
    except csv.Error:
        rows = list(csv.reader(text.splitlines()))
    rows = [[cell.strip() for cell in row] for row in rows if any(cell.strip() for cell in row)]
    draft = Draft()
    if len(rows) < 2:
        draft.not_understood.append(f"{file.name}: a table without rows")
        return draft
    return from_rows(rows[0], rows[1:], file, draft)


def from_rows(
    header: list[str], body: list[list[str]], file: Path, draft: Draft, place: str = ""
) -> Draft:
    """Add the claims about a table to a draft; place: where it stands in a text."""
    told = f"{place}: the table" if place else file.name
    ragged = [i for i, row in enumerate(body, 2) if len(row) != len(header)]
    if ragged:
        draft.not_understood.append(
            f"{told}, row {listed(ragged)}: more or fewer cells than the header; left out"
        )
        body = [row for row in body if len(row) == len(header)]
    header, body = _taken_apart(header, body)
    roles = _roles(header, draft, told)
    if "n" not in roles or "mean" not in roles:
        lacking = "n" if "n" not in roles else "means"
        draft.not_understood.append(f"{told}: no column of {lacking} among {listed(header)}")
        return draft
    stem = re.sub(r"[^A-Za-z0-9._-]+", "-", file.stem)
    name = f"{stem}-table{len(draft.tables) + 1}.csv" if place else f"{stem}.csv"
    of = "n, mean and SD" if "sd" in roles else "n and mean"
    claim = f"{of[0].upper()}{of[1:]} of {len(body)} row{'s' if len(body) > 1 else ''}."
    draft.add("T", place or name, claim, _table_claim(name, roles, header, body))
    draft.tables[name] = "\n".join(",".join(_quoted(row)) for row in [header, *body]) + "\n"
    return draft


def _quoted(row: Iterable[str]) -> Iterator[str]:
    for cell in row:
        yield f'"{cell}"' if set(cell) & set(',"\n') else cell


def _taken_apart(header: list[str], body: list[list[str]]) -> tuple[list[str], list[list[str]]]:
    """Take columns of `5.1 (1.2)` or `5.1 ± 1.2` apart into two."""
    out_head: list[str] = []
    out: list[list[str]] = [[] for _ in body]
    for i, name in enumerate(header):
        cells = [row[i] for row in body]
        filled = [cell for cell in cells if cell]
        if filled and all(BOTH.fullmatch(cell) for cell in filled):
            first, _, second = re.sub(r"[()±,/]", " ", name).strip().partition(" ")
            out_head += [first or "mean", second.strip() or "in_brackets"]
            for row, cell in zip(out, cells, strict=True):
                match = BOTH.fullmatch(cell)
                row += [match[1], match[2] or match[3]] if match else ["", ""]
        else:
            out_head.append(name)
            for row, cell in zip(out, cells, strict=True):
                row.append(cell)
    return out_head, out


def _roles(header: Sequence[str], draft: Draft, told: str) -> dict[str, str]:
    roles: dict[str, str] = {}
    for role, names in _ROLES:
        fits = [h for h in header if _bare(h) in names]
        if len(fits) > 1:
            draft.not_understood.append(f"{told}: {listed(fits)} may each be the {role}")
        elif fits:
            roles[role] = fits[0]
    return roles


def _table_claim(
    name: str, roles: dict[str, str], header: Sequence[str], body: Sequence[Sequence[str]]
) -> Iterator[str]:
    named = {role: column for role, column in roles.items() if column != role}
    extra = "".join(f", {role}: {json.dumps(column)}" for role, column in named.items())
    plain = "".join(f", {role}: {json.dumps(column)}" for role, column in named.items()
                    if role in ("n", "mean"))  # fmt: skip
    unread = [
        h
        for h in header
        if h not in roles.values()
        and h != header[0]
        and any(is_number(row[header.index(h)]) for row in body if row[header.index(h)])
    ]
    if unread:
        yield f"# ? not looked at: {listed(unread)}; `signkin audit list` tells what can be"
    yield "# ? Do values come in steps (points, frames)? Then add, with the step as grain:"
    check, own = ("grimmer", extra) if "sd" in roles else ("grim", plain)
    yield f'#   - {{check: {check}, table: {name}, grain: "1"{own}, reads: "Points."}}'
    yield "# ? On a scale? Then add its ends; `closure` counts the samples that print so:"
    ends = f'low: "1", high: "7"{extra}'
    yield f'#   - {{check: scale_bounds, table: {name}, {ends}, reads: "A scale."}}'
    yield "checks:"
    columns = json.dumps(list(roles.values()))
    yield f"  - {{check: rows_twice, table: {name}, columns: {columns},"
    yield '     reads: "No two rows have the same numbers."}'
    if {"sd", "se"} <= set(roles):
        yield f"  - {{check: standard_error, table: {name}{extra},"
        yield '     reads: "The standard error is the SD over the root of n."}'
