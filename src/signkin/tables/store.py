"""Write and read tables: one whose columns are not those of its kind is not written."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pandas as pd

from signkin.errors import SignkinError, listed
from signkin.tables.kinds import TABLES
from signkin.tables.schema import LENGTH_UNITS


def write_table(frame: pd.DataFrame, path: str | Path, name: str, unit: str = "m") -> None:
    """Write a table whose columns are those of its kind, in their order.

    A path that ends in .parquet gives Parquet with every bit; else CSV, times to 1 ns.
    """
    expected = TABLES[name].names(unit)
    if list(frame.columns) != expected:
        missing = [column for column in expected if column not in frame.columns]
        extra = [column for column in frame.columns if column not in expected]
        raise SignkinError(
            f"columns missing: {listed(missing)}; not declared: {listed(extra)}",
            file=path,
            place=f"table {name}",
            expected=listed(expected, 40),
        )
    if Path(path).suffix == ".parquet":
        frame.to_parquet(path, index=False)
        return
    frame.to_csv(path, index=False, float_format="%.9g", lineterminator="\n")


def read_table(path: str | Path, name: str) -> pd.DataFrame:
    """Read a table as it was written: text stays text (`0000`), an empty cell of text is ''."""
    kinds = {n: c for c in TABLES[name].columns for n in {c.name.format(u=u) for u in LENGTH_UNITS}}
    header = pd.read_csv(path, nrows=0).columns
    text = [column for column in header if column in kinds and kinds[column].text]
    frame = pd.read_csv(
        path,
        dtype=dict.fromkeys(text, "str"),
        keep_default_na=False,
        na_values={column: [""] for column in header if column not in text},
    )
    return frame


def concatenated(paths: Iterable[str | Path], name: str, unit: str = "m") -> pd.DataFrame:
    """Read tables of one kind and put them below one another, in the order given."""
    parts = [read_table(path, name) for path in paths]
    kept = [part for part in parts if len(part)]
    return pd.concat(kept, ignore_index=True) if kept else empty(name, unit)


def empty(name: str, unit: str = "m") -> pd.DataFrame:
    """Return a table without rows."""
    return pd.DataFrame(columns=TABLES[name].names(unit))
