"""`signkin audit init FILE`: claims.yaml from the text or the table of a paper, to be gone through.

From a text: each test statistic in it (`apa`) becomes a claim with its place. From a CSV: a table
with columns of n, mean and SD becomes claims, with what has to be known first as questions. What
decides a verdict (the grain, the tails, the divisor) is asked for, never guessed.
"""

from __future__ import annotations

import argparse
import csv
import json
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from signkin.audit.apa import FoundStatistic, NotRead, statistics_in
from signkin.audit.claims_file import MOST_BYTES
from signkin.audit.rounding import is_number
from signkin.errors import SignkinError, listed
from signkin.text_file import text_of

N_NAMES = ("n", "number", "count", "participants", "subjects", "size")
MEAN_NAMES = ("mean", "m", "average", "avg")
SD_NAMES = ("sd", "s.d.", "std", "stdev", "standarddeviation", "std.dev.")
SE_NAMES = ("se", "s.e.", "sem", "standarderror", "std.error", "std.err.")
TABLES = (".csv", ".tsv", ".tab")
BOTH = re.compile(r"\s*([-\u2212]?[\d.]+)\s*(?:\(\s*([\d.]+)\s*\)|±\s*([\d.]+))\s*")


@dataclass
class Draft:
    """What was found: claims as text, tables to write beside them, and what was not understood."""

    claims: list[str] = field(default_factory=list)
    tables: dict[str, str] = field(default_factory=dict)
    not_understood: list[str] = field(default_factory=list)


def init(arguments: Sequence[str]) -> int:
    """Write a paper's folder from a file; prints what was found and what was not understood."""
    parser = argparse.ArgumentParser(prog="signkin audit init", description=__doc__)
    parser.add_argument("file", type=Path, help="the paper's text (.txt) or a table (.csv, .tsv)")
    parser.add_argument("--to", type=Path, help="the folder to write; by default the file's name")
    told = parser.parse_args(list(arguments))
    if not told.file.is_file():
        raise SignkinError(f"there is no file {told.file}", expected="a text or a table")
    if told.file.suffix.lower() == ".pdf" or told.file.read_bytes()[:5] == b"%PDF-":
        raise SignkinError(
            "it is a PDF", file=told.file, expected="its text layer as .txt",
            todo="Make one with `pdftotext -layout FILE.pdf`.",
        )  # fmt: skip
    text = text_of(told.file, MOST_BYTES)
    draft = from_table(text, told.file) if told.file.suffix.lower() in TABLES else from_text(text)
    to = told.to or Path(re.sub(r"[^A-Za-z0-9._-]+", "-", told.file.stem))
    if (to / "claims.yaml").exists():
        raise SignkinError("there is a claims.yaml already", file=to, todo="Give another --to.")
    if not draft.claims:
        for line in draft.not_understood:
            print(f"not understood: {line}")
        raise SignkinError(
            "nothing that could be checked was found", file=told.file,
            expected="statistics such as t(38) = 2.1, p = .04, or columns n, mean and sd",
        )  # fmt: skip
    to.mkdir(parents=True, exist_ok=True)
    for name, table in draft.tables.items():
        (to / name).write_text(table, encoding="utf-8")
    (to / "claims.yaml").write_text(written(draft, told.file), encoding="utf-8")
    for line in draft.not_understood:
        print(f"not understood: {line}")
    print(f"{len(draft.claims)} claims in {to / 'claims.yaml'}, {len(draft.not_understood)} places "
          f"not understood. Answer its questions, then: signkin audit {to}")  # fmt: skip
    return 0


def written(draft: Draft, file: Path) -> str:
    """Return claims.yaml with its questions as comments."""
    head = [
        f"# Drafted from {file.name}. Go through it: every claim says where it was found, and",
        "# `# ?` starts questions whose answer a verdict may hang on.",
        f"paper: {json.dumps(file.stem)}   # ? authors and year",
        "claims:",
    ]
    tail = [f"# not understood: {line}" for line in draft.not_understood]
    return "\n".join([*head, *draft.claims, *tail]) + "\n"


def from_text(text: str) -> Draft:
    """Return a claim for every test statistic that is found in a text."""
    found, missed = statistics_in(text)
    draft = Draft([_claim_of(i, one) for i, one in enumerate(found, 1)])
    draft.not_understood = [_told(one) for one in missed]
    one_tailed = re.search(r"one[- ](?:tailed|sided)|directional", text, re.IGNORECASE)
    if one_tailed:
        line = text.count("\n", 0, one_tailed.start()) + 1
        draft.claims = [
            claim.replace("# ? tails", f"# ? `{one_tailed[0]}` stands in line {line}: tails")
            for claim in draft.claims
        ]  # fmt: skip
    return draft


def _told(one: NotRead) -> str:
    return f"line {one.line}: {' '.join(one.raw.split())[:80]} ({one.why})"


def _claim_of(number: int, one: FoundStatistic) -> str:
    raw = json.dumps(one.raw, ensure_ascii=False)
    lines = [
        f"  - id: S{number:03d}",
        f"    location: {one.place}",
        f"    claim: {raw}",
        "    published:",
        "      checks:",
    ]
    if one.kind in ("t", "z", "r"):
        lines.append("        # ? tails: two or one, where the paper says so; else both are tried")
    if one.kind == "H":
        lines.append('        # ? groups: ["n1", "n2", ...], if they are few: the exact p is tried')
    df = f", df: {json.dumps(list(one.df))}" if one.df else ""
    lines.append(
        f"        - {{check: p_value, kind: {one.kind}, "
        f"statistic: {json.dumps(one.statistic)}{df}, p: {json.dumps(one.p)},"
    )
    lines.append('           reads: "The printed p belongs to the printed statistic."}')
    return "\n".join(lines)


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
    header, body = rows[0], rows[1:]
    ragged = [i for i, row in enumerate(body, 2) if len(row) != len(header)]
    if ragged:
        draft.not_understood.append(
            f"{file.name}, row {listed(ragged)}: more or fewer cells than the header; left out"
        )
        body = [row for row in body if len(row) == len(header)]
    header, body = _taken_apart(header, body)
    roles = _roles(header, draft, file)
    name = f"{re.sub(r'[^A-Za-z0-9._-]+', '-', file.stem)}.csv"
    if "n" not in roles or "mean" not in roles:
        lacking = "n" if "n" not in roles else "means"
        draft.not_understood.append(f"{file.name}: no column of {lacking} among {listed(header)}")
        return draft
    draft.claims = ["\n".join(_table_claim(name, roles, header, body))]
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


def _roles(header: Sequence[str], draft: Draft, file: Path) -> dict[str, str]:
    roles: dict[str, str] = {}
    for role, names in (("n", N_NAMES), ("mean", MEAN_NAMES), ("sd", SD_NAMES), ("se", SE_NAMES)):
        fits = [h for h in header if re.sub(r"[\s_]", "", h.lower()) in names]
        if len(fits) > 1:
            draft.not_understood.append(f"{file.name}: {listed(fits)} may each be the {role}")
        elif fits:
            roles[role] = fits[0]
    return roles


def _table_claim(
    name: str, roles: dict[str, str], header: Sequence[str], body: Sequence[Sequence[str]]
) -> Iterator[str]:
    columns = ", ".join(f"{role}: {json.dumps(column)}" for role, column in roles.items()
                        if column != role)  # fmt: skip
    extra = f", {columns}" if columns else ""
    of = "n, mean and SD" if "sd" in roles else "n and mean"
    yield "  - id: T001"
    yield f"    location: {name}"
    yield f"    claim: {of.capitalize()} of {len(body)} rows."
    yield "    published:"
    unread = [
        h
        for h in header
        if h not in roles.values()
        and h != header[0]
        and any(is_number(row[header.index(h)]) for row in body if row[header.index(h)])
    ]
    if unread:
        yield f"      # ? not looked at: {listed(unread)}; `signkin audit list` tells what can be"
    yield "      # ? Do values come in steps (points, frames)? Then add, with the step as grain:"
    check = "grimmer" if "sd" in roles else "grim"
    plain = extra if check == "grimmer" else f", mean: {json.dumps(roles['mean'])}"
    yield f'      #   - {{check: {check}, table: {name}, grain: "1"{plain}, reads: "Points."}}'
    yield "      # ? On a scale? Then add its ends:"
    ends = f'low: "1", high: "7"{extra}'
    yield f'      #   - {{check: scale_bounds, table: {name}, {ends}, reads: "A scale."}}'
    yield "      checks:"
    columns = json.dumps(list(roles.values()))
    yield f"        - {{check: rows_twice, table: {name}, columns: {columns},"
    yield '           reads: "No two rows have the same numbers."}'
    if {"sd", "se"} <= set(roles):
        yield f"        - {{check: standard_error, table: {name}{extra},"
        yield '           reads: "The standard error is the SD over the root of n."}'
