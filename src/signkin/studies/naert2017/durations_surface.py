"""What the fitted duration models look like: their coefficients, and the surface of Fig. 11."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
import scipy  # loads scipy.stats when it is used: it takes as long to import as numba

from signkin import seeds, tables
from signkin.coarticulation.duration import LINEAR_TERMS, TERMS, LinearDuration, SurfaceDuration
from signkin.errors import SignkinError
from signkin.settings.sections import Durations
from signkin.statistics import association
from signkin.studies.naert2017.durations_models import Learnable
from signkin.studies.naert2017.settings import DurationSettings


def coefficients(
    corpus: str,
    learn: Learnable,
    settings: DurationSettings,
    constants: Mapping[str, str],
    seed: int,
) -> pd.DataFrame:
    """Return the table `duration_coefficients`: LINEAR and SURFACE, beside what is printed."""
    rng = seeds.stream(seed, corpus, "duration_coefficients")
    units = {"constant": "s", "mean_distance": "s/unit", "geodesic": "s/rad"}
    units["euclidean"] = f"s per {learn.unit}"
    out = []
    for name, terms in (("LINEAR", LINEAR_TERMS), ("SURFACE", TERMS)):
        try:
            if name in learn.absent:
                raise SignkinError(learn.absent[name])
            values = _coefficients(name, learn, settings.durations, rng)
            note = learn.note
        except SignkinError as error:
            values, note = pd.DataFrame(index=range(len(terms))), f"not testable: {error.found}"
        for i, term in enumerate(terms):
            row = {"corpus": corpus, "model": name, "coefficient": term, "unit": units[term]}
            row["published"] = constants[f"theta_{term}"] if name == "SURFACE" else ""
            row |= {str(k): v for k, v in values.iloc[i].to_dict().items()}
            row["published_inside"] = _inside(row)
            out.append({**row, "n": len(learn.data), "note": note})
    return pd.DataFrame(out).reindex(columns=tables.TABLES["duration_coefficients"].names())


def _coefficients(
    name: str, learn: Learnable, chosen: Durations, rng: np.random.Generator
) -> pd.DataFrame:
    model: LinearDuration | SurfaceDuration
    model = LinearDuration() if name == "LINEAR" else SurfaceDuration()
    model.fit(learn.data)
    freedom = model.n - len(model.theta)
    half = scipy.stats.t.isf(chosen.alpha / 2, freedom) * model.standard_error
    recordings = list(learn.rows["recording"])
    units, _ = association.resampled_units(recordings, chosen.bootstrap_recordings)

    def theta(rows: np.ndarray) -> np.ndarray:
        again = LinearDuration() if name == "LINEAR" else SurfaceDuration()
        try:
            again.fit(learn.data[rows])
        except SignkinError:  # a draw of nothing but one transition, many times over
            return np.full(len(model.theta), np.nan)
        return again.theta

    low, high = association.bootstrap(theta, units, chosen.draws, chosen.alpha, rng)
    return pd.DataFrame(
        {
            "fitted": model.theta,
            "standard_error": model.standard_error,
            "low": model.theta - half,
            "high": model.theta + half,
            "bootstrap_low": low,
            "bootstrap_high": high,
        }
    )


def _inside(row: Mapping[str, Any]) -> str:
    if not row["published"] or "low" not in row:
        return ""
    value = float(row["published"])
    held = row["low"] <= value <= row["high"]
    return "yes" if held and row["bootstrap_low"] <= value <= row["bootstrap_high"] else "no"


def surface_points(learn: Learnable) -> tuple[pd.DataFrame, np.ndarray | None, str]:
    """Return the table `surface_points` (Fig. 11), theta, and why there is no surface."""
    out = learn.rows[["corpus", "recording", "signer", "transition", "geodesic_rad"]].copy()
    out["euclidean_units"] = learn.data.euclidean
    out["duration_s"] = learn.data.duration_s
    theta, reason = None, ""
    try:
        model = SurfaceDuration()
        out["surface_s"] = model.fit(learn.data).predict(learn.data)
        theta = model.theta
    except SignkinError as error:
        out["surface_s"], reason = np.nan, error.found
    return out[tables.TABLES["surface_points"].names()], theta, reason
