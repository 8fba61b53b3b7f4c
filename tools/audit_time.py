"""How long each check on print takes, by n: the table of docs/reliability.md.

python -m tools.audit_time          a table in Markdown, in milliseconds of processor time

Checks that know no n (a formula, a matrix) are given their example, or a large table.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from signkin.audit.commands import findings_of
from signkin.audit.registry import ABOUT, PUBLISHED

SIZES = (10, 1_000, 10_000)
Call = tuple[dict[str, Any], str]  # arguments, and the table `t.csv` that they read
SCALE = {"mean": "3.2", "sd": "1.20", "grain": "1", "low": "1", "high": "5"}
WIDE = {"mean": "562", "sd": "87", "grain": "1", "low": "0", "high": "1000"}
OPEN = {"divisor": "either", "spread": "either"}


def _groups(n: int) -> str:
    return f"g,n,mean,sd\na,{n},5.1,1.5\nb,{n},4.2,1.4\nc,{n},3.3,1.1\n"


def _counts(n: int) -> list[list[str]]:
    return [[str(n), str(n + 9)], [str(n + 5), str(n)]]


def _left_out(n: int) -> Call:
    given = {"table": "t.csv", "row": "a", "suffix": "_o", "grain": "0.01"}
    return given, f"g,n,mean,sd,n_o,mean_o,sd_o\na,{n},2.50,1.29,{n - 1},2.48,1.20\n"


def _rows(n: int) -> str:
    return "g,x\n" + "".join(f"r{i},{i % 997 / 100:.2f}\n" for i in range(n))


def _matrix(k: int) -> str:
    rows = (f"v{i}," + ",".join(".30" if j < i else "" for j in range(k)) for i in range(k))
    return "\n".join([",".join(["", *(f"v{i}" for i in range(k))]), *rows]) + "\n"


def _splits(n: int) -> str:
    return f"g,by,n,mean,sd\na,s,{n},3.1,1.2\nb,s,{n},3.3,1.2\nc,t,{n},3.2,1.2\nd,t,{n},3.2,1.2\n"


CALLS: dict[str, Callable[[int], Call]] = {
    "grim": lambda n: ({"mean": "3.21", "n": str(n), "grain": "1"}, ""),
    "grimmer": lambda n: ({**WIDE, **OPEN, "n": str(n)}, ""),
    "debit": lambda n: ({"mean": "0.44", "sd": "0.50", "n": str(n)}, ""),
    "range_possible": lambda n: ({**WIDE, "n": str(n)}, ""),
    "scale_bounds": lambda n: (
        {"mean": "3.2", "sd": "1.20", "n": str(n), "low": "1", "high": "5"}, ""),
    "closure": lambda n: ({**SCALE, "n": str(n)}, ""),
    "sprite": lambda n: ({**WIDE, "n": str(n)}, ""),
    "pooled": lambda n: ({"table": "t.csv", "mean_of_all": "4.2", "sd_of_all": "1.5"}, _groups(n)),
    "same_whole": lambda n: ({"table": "t.csv", "split": "by", "sd": "sd"}, _splits(n)),
    "left_out": _left_out,
    "test_of_groups": lambda n: (
        {"n": [str(n)] * 6, "mean": ["5.1", "4.2", "3.3"] * 2, "sd": ["1.5", "1.4", "1.1"] * 2,
         "F": "99", "p": ".5", "spread": "either"}, ""),
    "groups_differ": lambda n: ({"table": "t.csv", "differ": True}, _groups(n)),
    "order": lambda n: ({"table": "t.csv", "lowest": ["c"]}, _groups(n)),
    "p_value": lambda n: ({"kind": "t", "statistic": "2.10", "df": [str(n)], "p": ".9"}, ""),
    "p_values": lambda n: ({"table": "t.csv", "kind": "t"}, f"e,t,df,p\na,2.1,{n},.9\n"),
    "p_reachable": lambda n: ({"groups": [str(n), str(n)], "p": "<.001"}, ""),
    "percentage": lambda n: ({"count": str(n // 3), "n": str(n), "percent": "33.3"}, ""),
    "chi_squared": lambda n: ({"counts": _counts(n), "p": ".5"}, ""),
    "odds_ratio": lambda n: ({"counts": _counts(n), "odds_ratio": "1.1"}, ""),
    "effect_size": lambda n: (
        {"effect": "d", "value": "0.5", "kind": "t", "statistic": "2.1", "n": [str(n), str(n)]},
        "",
    ),
    "standard_error": lambda n: ({"n": str(n), "sd": "1.2", "se": "0.3"}, ""),
    "effect_conversion": lambda n: (
        {"effect": "odds_ratio", "value": "9.9", "to": "g", "equals": ".1", "n": [str(n)] * 2}, ""),
    "confidence_interval": lambda n: (
        {"estimate": "0.4", "low": "0.1", "high": "0.7", "df": str(n), "p": ".9"}, ""),
    "regression_row": lambda n: ({"b": "0.42", "se": "0.16", "t": "2.6", "df": str(n)}, ""),
    "last_digits": lambda n: ({"table": "t.csv", "columns": ["x"]}, _rows(n)),
    "rows_twice": lambda n: ({"table": "t.csv", "columns": ["x"]}, _rows(n)),
    "total": lambda n: ({"table": "t.csv", "column": "n", "equals": str(3 * n)}, _groups(n)),
    "correlation_matrix": lambda n: ({"table": "t.csv"}, _matrix(min(60, n))),
}  # fmt: skip


def took(name: str, n: int, folder: Path) -> float:
    """Return the processor time of a check at a size, in s, the better of two."""
    if name in CALLS:
        given, table = CALLS[name](n)
    else:
        given, table = dict(ABOUT[name].example), ABOUT[name].table
        if table:
            given["table"] = "t.csv"
    if table:
        (folder / "t.csv").write_text(table, encoding="utf-8")
    times = []
    for _ in range(2):
        start = time.process_time()
        findings_of(name, given, folder)
        times.append(time.process_time() - start)
    return min(times)


def table(names: Iterable[str]) -> str:
    """Return the times as a table in Markdown."""
    lines = ["| check | n = 10 | n = 1,000 | n = 10,000 |", "|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            sizes = SIZES if name in CALLS else SIZES[:1]
            cells = [f"{took(name, n, Path(folder)) * 1e3:.0f} ms" for n in sizes]
            lines.append(f"| {name} | {' | '.join(cells + [''] * (3 - len(cells)))} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table(sys.argv[1:] or sorted(PUBLISHED)))
