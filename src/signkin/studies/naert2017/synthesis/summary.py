"""Errors of all methods against the captured transitions, and which is nearest (section 5.2)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from signkin import seeds, tables
from signkin.coarticulation.synthesis import METHODS
from signkin.corpus import Corpus
from signkin.studies.naert2017.synthesis.comparison import DECIMALS, TRUE
from signkin.studies.naert2017.synthesis.database import Array
from signkin.studies.naert2017.synthesis.duration_models import MODELS

DURATION_ERROR = "duration error"


def error_measures(unit: str) -> dict[str, tuple[str, Callable[[pd.DataFrame], pd.Series]]]:
    """Return the measures of the summary, all the better the smaller: unit and definition."""

    def ratio(name: str) -> Callable[[pd.DataFrame], pd.Series]:
        def of(rows: pd.DataFrame) -> pd.Series:
            with np.errstate(divide="ignore", invalid="ignore"):
                value = np.log(rows[name] / rows[f"true_{name}"]).abs()
            return value.where(np.isfinite(value))

        return of

    return {
        DURATION_ERROR: ("s", lambda rows: rows["duration_error_s"].abs()),
        "position error": (unit, lambda rows: rows[f"error_{unit}"]),
        "wrist position error": (unit, lambda rows: rows[f"wrist_error_{unit}"]),
        "peak speed, |ln ratio|": ("", ratio(f"peak_speed_{unit}_per_s")),
        "jerk, |ln ratio|": ("", ratio(f"rms_jerk_{unit}_per_s3")),
        "hesitations": ("extra minima", lambda rows: rows["extra_minima"].clip(lower=0)),
    }


def summary(rows: pd.DataFrame, corpus: Corpus, draws: int, seed: int) -> pd.DataFrame:
    """Return the table `synthesis_summary`: mean errors with 95 % bootstrap intervals.

    Within one measure and material all methods are compared on the same transitions: those that
    every one of them has a value for. The transitions are resampled, the same for all methods.
    """
    names = tables.TABLES["synthesis_summary"].names()
    out = []
    for material, part in rows.groupby("material", sort=False):
        total = part.groupby(["recording", "transition"]).ngroups
        for measure, (unit, define) in error_measures(corpus.unit).items():
            values = part.assign(value=define(part).round(DECIMALS)).pivot_table(
                index=["recording", "transition"], columns=["method", "duration_model"],
                values="value", dropna=False, observed=False, sort=False,
            )  # fmt: skip
            methods = METHODS[:1] if measure == DURATION_ERROR else METHODS
            values = values.reindex(columns=pd.MultiIndex.from_product([methods, (*MODELS, TRUE)]))
            known = values.dropna(axis=1, how="all")
            complete = known.dropna()
            rng = seeds.stream(seed, corpus.name, str(material), measure, "synthesis")
            means = _bootstrap(complete.to_numpy(dtype=float), draws, rng)
            ranked = [c for c in known.columns if c[1] != TRUE] if len(complete) else []
            best = min(ranked, key=lambda c: float(complete[c].mean())) if ranked else None
            for column in values.columns:
                out.append(
                    {
                        "corpus": corpus.name,
                        "material": material,
                        "measure": measure,
                        "unit": unit,
                        "method": "either" if measure == DURATION_ERROR else column[0],
                        "duration_model": column[1],
                        "transitions": total,
                        **_summary_row(column, complete, known, means, best),
                    }
                )
    return pd.DataFrame(out, columns=names)


def _bootstrap(values: Array, draws: int, rng: np.random.Generator) -> Array:
    """Return means (draws, columns) of resampled rows."""
    if not len(values):
        return np.full((draws, values.shape[1]), np.nan)
    weights = rng.multinomial(len(values), np.full(len(values), 1 / len(values)), size=draws)
    return np.asarray(weights @ values / len(values))


def _summary_row(
    column: tuple[str, str],
    complete: pd.DataFrame,
    known: pd.DataFrame,
    means: Array,
    best: tuple[str, str] | None,
) -> dict[str, Any]:
    nan = float("nan")
    row: dict[str, Any] = {"n": 0, "mean": nan, "low": nan, "high": nan, "over_best": nan,
                           "over_best_low": nan, "over_best_high": nan, "nearest": "",
                           "note": ""}  # fmt: skip
    if column not in known.columns or best is None:
        row["note"] = "the model has no duration in this corpus" if len(known) else "no transition"
        return row
    place = known.columns.get_loc(column)
    draws = means[:, place]
    over = draws - means[:, known.columns.get_loc(best)]
    values = complete[column]
    row |= {
        "n": len(values),
        "mean": float(values.mean()),
        "low": float(np.quantile(draws, 0.025)),
        "high": float(np.quantile(draws, 0.975)),
        "over_best": float(values.mean() - complete[best].mean()),
        "over_best_low": float(np.quantile(over, 0.025)),
        "over_best_high": float(np.quantile(over, 0.975)),
    }
    if column[1] == TRUE:
        row["nearest"] = "reference"
        row["note"] = "the true duration is not known in practice: not ranked"
    elif column == best:
        row["nearest"] = "nearest"
    else:
        row["nearest"] = "as near" if row["over_best_low"] <= 0 else "farther"
    return row
