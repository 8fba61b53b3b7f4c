"""Claims drafted from a table beside its means: tests, regressions, correlations, counts."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterator, Sequence
from itertools import groupby

from signkin.audit.drafts import Draft
from signkin.audit.table_shapes import Key, Shape
from signkin.audit.table_words import bare_number, is_numeric, tidy
from signkin.errors import listed


def add_others(
    shape: Shape, header: Sequence[str], body: Sequence[Sequence[str]], name: str, draft: Draft,
    place: str, told: str,
) -> None:  # fmt: skip
    """Add claims about a table's tests, regressions, correlations and percentages to a draft."""
    if _regression(shape, name, draft, place):
        return
    _tests(shape, name, draft, place, told)
    _groups(shape, draft, place or f"{name}.csv")
    _counts(shape, name, draft, place)
    _correlations(header, body, name, draft, place)


def _written(rows: Sequence[Sequence[str]]) -> str:
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()


def _p(text: str) -> str:
    """Return a p without stars, `*` alone and the like as nothing."""
    bare = re.sub(r"\s*[*†‡]+$", "", tidy(text)).replace(" ", "")
    return bare if is_numeric(bare) and re.search(r"\d|n", bare) else ""


def _degrees(text: str) -> list[str]:
    return [part.strip() for part in re.split(r"[,;]", tidy(text).strip("()[]")) if part.strip()]


def _tests(shape: Shape, name: str, draft: Draft, place: str, told: str) -> None:
    for kind in ("t", "F", "chi2", "z"):
        rows, without = [], []
        for measure, found in shape.tests.items():
            statistic, p = bare_number(found.get(kind, "")), _p(found.get("p", ""))
            df = _degrees(found.get("df", ""))
            if not statistic or not p:
                continue
            if len(df) != {"t": 1, "F": 2, "chi2": 1, "z": 0}[kind] and kind != "z":
                without.append(measure)
                continue
            rows.append([measure or "all", statistic, *(df if kind != "z" else ()), p])
        if without:
            why = "two degrees of freedom (df: 2, 57)" if kind == "F" else "degrees of freedom (df)"
            draft.not_understood.append(f"{told}: {kind} of {listed(without)} stands without {why}")
        if not rows:
            continue
        file = f"{name}-{kind}-tests.csv"
        dfs = {"F": ["df1", "df"], "z": []}.get(kind, ["df"])
        draft.tables[file] = _written([["row", kind, *dfs, "p"], *rows])
        more = ", df1: df1" if kind == "F" else ""
        draft.add("P", place or file, f"{kind} and p of {len(rows)} rows.", iter([
            "checks:",
            "  # ? tails: two or one, where the paper says so: {tails: two}"
            if kind in "tz" else "  # ? the df of each row are those of its test",
            f"  - {{check: p_values, table: {file}, kind: {kind}{more},",
            '     reads: "Each p belongs to its statistic."}',
        ]))  # fmt: skip


def _groups(shape: Shape, draft: Draft, place: str) -> None:
    """Ask whether a test printed beside groups is one of independent groups."""

    def of(item: tuple[Key, dict[str, str]]) -> str:
        return item[0][0]

    lines = []
    for measure, cells in groupby(shape.cells.items(), key=of):
        whole = [c for _, c in cells if {"n", "mean", "sd"} <= set(c)]
        own = shape.tests.get(measure, {})
        tests = {k: bare_number(own.get(k, "")) for k in ("t", "F", "d")}
        tests = {k: v for k, v in {**tests, "p": _p(own.get("p", ""))}.items() if v}
        if len(whole) < 2 or not {"t", "F", "d"} & set(tests) or ("t" in tests and "F" in tests):
            continue
        numbers = "".join(f", {role}: {json.dumps([c[role] for c in whole])}"
                          for role in ("n", "mean", "sd"))  # fmt: skip
        told = "".join(f", {k}: {json.dumps(v)}" for k, v in tests.items())
        lines.append(f"#   - {{check: test_of_groups{numbers}{told},")
        lines.append(f"#      reads: {json.dumps(measure or 'Groups')}}}")
    if lines:
        draft.add("G", place, "Tests between the groups of a table.", iter([
            "missing: whether the groups are independent and the test has no covariates",
            "# ? Other people in each group, and nothing else in the test? Then:",
            "# checks:", *lines,
        ]))  # fmt: skip


def _regression(shape: Shape, name: str, draft: Draft, place: str) -> bool:
    rows = []
    for (measure, group), cells in shape.cells.items():
        tests = shape.tests.get(measure, {})
        row = {"b": cells.get("b", ""), "se": cells.get("se", ""),
               "t": bare_number(tests.get("t", "")), "p": _p(tests.get("p", "")),
               "df": tests.get("df", "")}  # fmt: skip
        if row["b"] and row["se"] and (row["t"] or row["p"]) and not group:
            rows.append([measure or "all", *row.values()])
    if not rows:
        return False
    file, names = f"{name}-regression.csv", ("b", "se", "t", "p", "df")
    draft.tables[file] = _written([["row", *names], *rows])
    told = "".join(f", {n}: {n}" for i, n in enumerate(names, 1)
                   if n in ("t", "p", "df") and any(row[i] for row in rows))  # fmt: skip
    draft.add("R", place or file, f"Coefficients of {len(rows)} predictors.", iter([
        "checks:",
        "  # ? SEs by bootstrap, or p of a test other than b / SE? Then take this out.",
        f"  - {{check: regression_row, table: {file}{told},",
        '     reads: "t is b over its SE, and p is that of t."}',
    ]))  # fmt: skip
    return True


def _counts(shape: Shape, name: str, draft: Draft, place: str) -> None:
    rows = [
        [", ".join(part for part in key if part) or "all", c["count"], c.get("n", ""), c["percent"]]
        for key, c in ((key, _with_n(c)) for key, c in shape.cells.items())
        if {"count", "percent"} <= set(c)
    ]  # fmt: skip
    if not rows:
        return
    file = f"{name}-counts.csv"
    draft.tables[file] = _written([["row", "count", "n", "percent"], *rows])
    draft.add("C", place or file, f"Counts and percentages of {len(rows)} cells.", iter([
        "missing: of how many each percentage is (missing values, row or column) is not told",
        "# ? Of all of a group? Fill n in where it lacks, and then:",
        "# checks:",
        f'#   - {{check: percentage, table: {file}, reads: "Of all of the group."}}',
    ]))  # fmt: skip


def _with_n(cells: dict[str, str]) -> dict[str, str]:
    """Return cells where a column `n` beside one of percent is a count."""
    if "percent" in cells and "count" not in cells and "n" in cells:
        return {"count": cells["n"], "percent": cells["percent"]}
    return cells


def _correlations(
    header: Sequence[str], body: Sequence[Sequence[str]], name: str, draft: Draft, place: str
) -> None:
    """Add a matrix of correlations: columns called 1, 2, 3, or as the rows are."""

    def bare(text: str) -> str:
        return re.sub(r"^\(?\d+\)?[.)]?\s*", "", text).strip().lower()

    labels = [row[0] for row in body]
    numbers = [m[0] if (m := re.match(r"\(?(\d+)", text)) else "" for text in labels]
    numbers = [n.strip("(") for n in numbers]
    columns = []
    for j, text in enumerate(header[1:], 1):
        own = re.fullmatch(r"\(?(\d+)\)?\.?", text.strip())
        k = numbers.index(own[1]) if own and own[1] in numbers else -1
        if not own and bare(text) and bare(text) in [bare(label) for label in labels]:
            k = [bare(label) for label in labels].index(bare(text))
        if k >= 0:
            columns.append((k, j))
    cells = [bare_number(row[j]) for _, j in columns for row in body]
    filled = [c for c in cells if c]
    if len(columns) < 2 or len(filled) < 3 or any(not -1 <= float(c) <= 1 for c in filled):
        return
    order = [k for k, _ in columns]
    names = [bare(labels[k]).replace(",", " ") or f"v{k + 1}" for k in range(len(labels))]
    if len(set(names)) < len(names):
        names = [f"{i}. {n}" for i, n in enumerate(names, 1)]
    rows = []
    for k in range(len(body)):
        own_row = {c: bare_number(body[k][j]) for c, j in columns}
        rows.append([names[k], *("" if c == k else own_row[c] for c in order)])
    file = f"{name}-correlations.csv"
    draft.tables[file] = _written([["variable", *(names[k] for k in order)], *rows])
    draft.add("K", place or file, f"A matrix of correlations of {len(body)} variables.",
              _matrix_claim(file))  # fmt: skip


def _matrix_claim(file: str) -> Iterator[str]:
    yield "missing: whether all correlations are of the same people is not told"
    yield "# ? Of the same people each, Pearson's on both sides of the diagonal? Then:"
    yield "# checks:"
    yield f'#   - {{check: correlation_matrix, table: {file}, reads: "All of the same people."}}'
