"""Two trees of results, file by file: what differs, and by how much.

A rerun on the same kind of processor gives the same bytes; on another one, sums of floats end in
other digits (docs/reliability.md). Here tables are compared by their cells, figures by the data
drawn in them, and other texts by the numbers they hold.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from signkin.errors import SignkinError

TOLERANCE = 1e-9
# Pages hold the day and the versions, and what they show is in the files compared.
NOT_COMPARED = {".html", ".pdf", ".svg", ".done"}
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
# Columns whose change is a changed result, whatever the digits.
VERDICTS = {"verdict", "verdicts", "decision", "holds", "significant", "decisive"}


@dataclass(frozen=True)
class Row:
    """How one file differs.

    what: `only in A`, `only in B`, `columns`, `rows`, `cells`, `text` or `verdict`; place: column
    or line; cells: how many differ beyond the tolerance; relative: the largest relative difference
    of two numbers, NaN where texts differ; example: of A and of B.
    """

    file: str
    what: str
    place: str
    cells: int
    relative: float
    example: str


def compare(a: Path, b: Path, tolerance: float = TOLERANCE) -> list[Row]:
    """Return what differs between two trees of results, in the order of the files.

    tolerance: relative; numbers nearer than this are equal, as are two empty cells. Raises
    SignkinError where one is no folder or neither holds a file.
    """
    for folder in (a, b):
        if not folder.is_dir():
            raise SignkinError("no such folder", file=folder, expected="a folder of results")
    files = sorted(_files(a) | _files(b))
    if not files:
        raise SignkinError("two folders without files", file=a, expected="results of a run")
    return [row for name in files for row in _compare_file(a, b, name, tolerance)]


def _files(folder: Path) -> set[str]:
    return {
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_file() and path.suffix not in NOT_COMPARED
        and not any(part.startswith(".") for part in path.relative_to(folder).parts)
    }  # fmt: skip


def _compare_file(a: Path, b: Path, name: str, tolerance: float) -> Iterator[Row]:
    for folder, letter in ((a, "B"), (b, "A")):
        if not (folder / name).is_file():
            yield Row(name, f"only in {letter}", "", 0, math.nan, "")
            return
    one, other = a / name, b / name
    if one.read_bytes() == other.read_bytes():
        return
    suffix = Path(name).suffix
    try:
        if suffix in (".csv", ".parquet"):
            yield from _compare_tables(_table(one), _table(other), name, tolerance)
        elif suffix == ".json":
            yield from _compare_texts(_lines_of_json(one), _lines_of_json(other), name, tolerance)
        else:
            yield from _compare_texts(_lines(one), _lines(other), name, tolerance)
    except (ValueError, OSError) as error:
        yield Row(name, "text", "unreadable", 1, math.nan, str(error).splitlines()[0][:80])


def _table(path: Path) -> pd.DataFrame:
    if path.suffix == ".parquet":
        return pd.read_parquet(path)
    return pd.read_csv(path, dtype="str", keep_default_na=False)


def _lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8").splitlines()


def _lines_of_json(path: Path) -> list[str]:
    value = json.loads(path.read_text(encoding="utf-8"))
    return json.dumps(value, indent=0, sort_keys=True, ensure_ascii=False).splitlines()


def _compare_tables(
    one: pd.DataFrame, other: pd.DataFrame, name: str, tolerance: float
) -> Iterator[Row]:
    if list(one.columns) != list(other.columns):
        mine, theirs = (
            ", ".join(map(str, [c for c in x.columns if c not in y.columns])) or "none"
            for x, y in ((one, other), (other, one))
        )
        yield Row(name, "columns", "", 0, math.nan, f"only in A: {mine}; only in B: {theirs}")
    if len(one) != len(other):
        yield Row(name, "rows", "", 0, math.nan, f"{len(one)}; {len(other)}")
        return
    for column in (c for c in one.columns if c in other.columns):
        yield from _compare_column(one[column], other[column], name, str(column), tolerance)


def _compare_column(
    one: pd.Series, other: pd.Series, name: str, column: str, tolerance: float
) -> Iterator[Row]:
    texts_a, texts_b = one.astype("str").to_numpy(), other.astype("str").to_numpy()
    unequal = np.flatnonzero(texts_a != texts_b)
    if not len(unequal):
        return
    a, b = _numbers(one, unequal), _numbers(other, unequal)
    relative = _relative(a, b)
    counted = ~(relative <= tolerance)  # NaN, a text, counts
    if not counted.any():
        return
    first = unequal[np.flatnonzero(counted)[0]]
    what = "verdict" if column in VERDICTS else "cells"
    numbers = relative[counted & ~np.isnan(relative)]
    yield Row(
        name, what, f"{column}, row {first + 1}", int(counted.sum()),
        float(numbers.max()) if len(numbers) else math.nan,
        f"{texts_a[first][:40]}; {texts_b[first][:40]}",
    )  # fmt: skip


def _numbers(values: pd.Series, rows: np.ndarray) -> np.ndarray:
    """Return some cells as numbers; NaN for texts, such as the type `0010`."""
    cells = values.iloc[rows]
    numbers = pd.to_numeric(cells, errors="coerce").to_numpy(dtype=float)
    typed = cells.astype("str").str.match(r"-?0\d").to_numpy(dtype=bool)
    return np.where(typed, np.nan, numbers)


def _relative(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the relative difference of numbers; NaN where one of the two is none."""
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = np.maximum(np.abs(a), np.abs(b))
        return np.where(a == b, 0.0, np.abs(a - b) / scale)


def _compare_texts(one: list[str], other: list[str], name: str, tolerance: float) -> Iterator[Row]:
    if len(one) != len(other):
        yield Row(name, "rows", "", 0, math.nan, f"{len(one)} lines; {len(other)} lines")
        return
    differing, largest, first, texts = 0, 0.0, -1, False
    for i, (x, y) in enumerate(zip(one, other, strict=True)):
        if x == y:
            continue
        between = _between_lines(x, y)
        if between <= tolerance:
            continue
        differing += 1
        first = i if first < 0 else first
        texts |= math.isnan(between)
        largest = largest if math.isnan(between) else max(largest, between)
    if differing:
        yield Row(
            name, "text", f"line {first + 1}", differing, largest if largest else math.nan,
            f"{one[first].strip()[:40]}; {other[first].strip()[:40]}",
        )  # fmt: skip


def _between_lines(x: str, y: str) -> float:
    """Return the largest relative difference of two lines' numbers; NaN where words differ."""
    if _NUMBER.sub("#", x) != _NUMBER.sub("#", y):
        return math.nan
    a, b = (np.array([float(n) for n in _NUMBER.findall(line)]) for line in (x, y))
    return float(_relative(a, b).max()) if len(a) else math.nan
