"""What a claim rests on: the share of reasonable choices under which it holds.

Takes any table with a row a specification: columns of choices, an estimate, and whether the
claim holds so (yes or no, True or False).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from signkin.errors import SignkinError, listed
from signkin.tables import TABLES

NONE = "–"  # a choice that plays no part in a specification


def specifications(
    table: pd.DataFrame, choices: Mapping[str, str], estimate: str, reference: str = ""
) -> pd.DataFrame:
    """Return one row a specification, in order of the estimate.

    Columns: the choices by their names in figures, as text (`–` where one plays no part),
    estimate, reference (NaN without one), holds (bool). Rows without an estimate, or without the
    reference it is set against, are left out.
    """
    wanted = [*choices, estimate, "holds", *([reference] if reference else [])]
    lacking = [column for column in wanted if column not in table.columns]
    if lacking:
        raise SignkinError(
            f"the table lacks {listed(lacking)}",
            place="specification_curves",
            expected=listed(table.columns),
        )
    out = pd.DataFrame({name: _levels(table[column]) for column, name in choices.items()})
    out["estimate"] = table[estimate].astype(float)
    out["reference"] = table[reference].astype(float) if reference else np.nan
    out["holds"] = table["holds"].astype(str).isin(["True", "yes", "1"])
    out = out[out["estimate"].notna() & (out["reference"].notna() | (not reference))]
    keys = ["estimate", *choices.values()]
    return out.sort_values(keys, kind="stable").reset_index(drop=True)


def _levels(column: pd.Series) -> pd.Series:
    if pd.api.types.is_numeric_dtype(column) and column.dtype != bool:
        return column.map(lambda v: NONE if pd.isna(v) else f"{v:g}")
    return column.astype(str).replace({"": NONE, "nan": NONE})


def levels_of(column: pd.Series) -> list[str]:
    """Return the levels of a choice in order: numbers by size, else as they come by name."""
    names = [name for name in column.unique() if name != NONE]

    def size(name: str) -> tuple[int, float, str]:
        try:
            return (0, float(name), "")
        except ValueError:
            return (1, 0.0, name)

    return sorted(names, key=size) + ([NONE] if NONE in set(column) else [])


def by_choice(
    specs: pd.DataFrame, paper: str, claim: str, corpus: str, names: list[str], left_out: int = 0
) -> pd.DataFrame:
    """Return the table `specifications`: how often the claim holds, overall and by level.

    `share_decided` of a choice: the variance of holds between its levels, over its variance in
    all (eta squared, among the specifications that the choice plays a part in). 0 where the
    claim holds in all of them or in none. left_out: specifications without an estimate.
    """
    rows = [_row(specs, "all", "")]
    decided: dict[str, float] = {}
    for name in names:
        part = specs[specs[name] != NONE]
        levels = levels_of(part[name])
        if len(levels) < 2:
            continue
        decided[name] = _decided(part["holds"], part[name])
        for level in levels:
            rows.append(
                {**_row(part[part[name] == level], name, level), "share_decided": decided[name]}
            )
    rows[0]["note"] = _told(specs, decided)
    if left_out:
        rows[0]["note"] = (
            f"{rows[0]['note']}; {left_out} more have no estimate, or nothing to set it against"
        )
    out = pd.DataFrame(rows)
    out.insert(0, "paper", paper)
    out.insert(1, "claim", claim)
    out.insert(2, "corpus", corpus)
    out["note"] = out["note"].fillna("") if "note" in out else ""
    return out.reindex(columns=TABLES["specifications"].names())


def _row(part: pd.DataFrame, choice: str, level: str) -> dict[str, object]:
    holding = int(part["holds"].sum())
    return {
        "choice": choice,
        "level": level,
        "specifications": len(part),
        "holding": holding,
        "share": holding / len(part),
        "median_estimate": float(part["estimate"].median()),
        "share_decided": np.nan,
    }


def _decided(holds: pd.Series, levels: pd.Series) -> float:
    values = holds.astype(float)
    total = float(((values - values.mean()) ** 2).sum())
    if total == 0:
        return 0.0
    means = values.groupby(levels).transform("mean")
    return float(((means - values.mean()) ** 2).sum()) / total


def _told(specs: pd.DataFrame, decided: Mapping[str, float]) -> str:
    if specs["holds"].all():
        return "nothing decides: it holds in all"
    if not specs["holds"].any():
        return "nothing decides: it holds in none"
    if not decided:
        return "one specification"
    name = max(decided, key=lambda choice: decided[choice])
    return f"what decides most is {name} ({decided[name]:.0%} of the variance)"
