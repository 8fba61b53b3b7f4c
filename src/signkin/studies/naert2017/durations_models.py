"""Models of transition duration, learnt and tested on one corpus (Naert et al. 2017, 5.2)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from signkin import seeds, tables
from signkin.coarticulation.duration import (
    TERMS,
    DurationModel,
    LinearDuration,
    MeanDuration,
    PrintedSurface,
    SimpleBoundedDuration,
    SimpleDuration,
    SurfaceDuration,
    Transitions,
    folded,
    predict_left_out,
    simple_weight,
)
from signkin.errors import SignkinError
from signkin.settings.sections import Durations
from signkin.statistics import association
from signkin.statistics.findings import joined
from signkin.studies.naert2017.settings import DurationSettings
from signkin.studies.naert2017.transitions import counted

MODELS = ("MEAN", "SIMPLE", "SIMPLE_BOUNDED", "LINEAR", "SURFACE", "SURFACE_PRINTED")
ONE_DISTANCE = "no geodesic distance: its Euclidean part alone"
NOTHING_LEARNT = "nothing is learnt: the same in every evaluation"


@dataclass(frozen=True, eq=False)
class Learnable:
    """The transitions of a corpus that every model it allows can use, and why not all.

    rows: of the table `transitions`. data: the same in the models' units. unit: what Euclidean
    distances are counted in (`0.1 m`, `px`). note: what was left out. absent: model -> why it is
    not tested.
    """

    rows: pd.DataFrame
    data: Transitions
    unit: str
    note: str
    absent: Mapping[str, str]

    @property
    def geodesic(self) -> bool:
        """Whether the corpus has a geodesic distance."""
        return bool(np.isfinite(self.data.geodesic).any())

    @property
    def unit_in_words(self) -> str:
        """The unit as an axis names it."""
        return self.unit if self.unit == "px" else f"units of {self.unit}"


def learnable(
    transitions: pd.DataFrame, speeds: pd.DataFrame, unit: str, settings: DurationSettings
) -> Learnable:
    """Return the transitions between manual tags that all testable models can use."""
    rows = counted(transitions).merge(
        speeds.drop(columns="note"),
        on=["corpus", "recording", "signer", "transition"],
        validate="one_to_one",
    )
    scale = settings.transitions.euclidean_unit_m if unit == "m" else 1.0
    name = f"{scale:g} m" if unit == "m" else "px"
    angle = 1.0 if settings.durations.simple_angle == "half" else 2.0
    sides = ("previous", "next")
    linear = [f"{side}_linear_speed_{unit}_per_s" for side in sides]
    angular = [f"{side}_angular_speed_rad_per_s" for side in sides]
    data = Transitions(
        rows["geodesic_rad"].to_numpy(dtype=float),
        rows[f"euclidean_{unit}"].to_numpy(dtype=float) / scale,
        rows["duration_s"].to_numpy(dtype=float),
        rows[linear].to_numpy(dtype=float) / scale,
        rows[angular].to_numpy(dtype=float) * angle,
    )
    absent: dict[str, str] = {}
    usable = {"no Euclidean distance (gaps)": np.isfinite(data.euclidean)}
    if np.isfinite(data.geodesic).any():
        usable["no geodesic distance (gaps)"] = np.isfinite(data.geodesic)
        usable["a sign without speed"] = (
            (data.linear_speed.sum(axis=1) > 0) & (data.angular_speed.sum(axis=1) > 0)
        )  # fmt: skip
    else:
        reason = "no orientations, so no geodesic distance"
        absent |= dict.fromkeys(("SURFACE", "SURFACE_PRINTED"), reason)
        usable["a sign without speed"] = data.linear_speed.sum(axis=1) > 0
    if unit != "m":
        absent["SURFACE_PRINTED"] = "distances in px, theta in metres"
    kept = np.logical_and.reduce(list(usable.values()))
    told = [
        f"{int((~held).sum())} left out: {why}" for why, held in usable.items() if not held.all()
    ]
    if not kept.any():
        why = joined(*told) or "no two signs of an utterance follow each other without overlap"
        raise SignkinError(
            "no transition that a model of duration can use",
            place="transitions",
            expected=f"one or more ({why})",
        )
    return Learnable(rows[kept].reset_index(drop=True), data[kept], name, joined(*told), absent)


def makers(
    settings: DurationSettings, constants: Mapping[str, str], geodesic: bool
) -> dict[str, Callable[[], DurationModel]]:
    """Return how each model is made. constants: numbers printed in the paper, as strings.

    geodesic: whether the corpus has this distance.
    """
    chosen = settings.durations
    alpha = simple_weight(chosen.simple_alpha, geodesic)
    bounds = {"low_s": chosen.lowest_s, "high_s": chosen.highest_s}
    printed = np.array([float(constants[f"theta_{term}"]) for term in TERMS])
    return {
        "MEAN": MeanDuration,
        "SIMPLE": lambda: SimpleDuration(alpha),
        "SIMPLE_BOUNDED": lambda: SimpleBoundedDuration(alpha, **bounds),
        "LINEAR": LinearDuration,
        "SURFACE": SurfaceDuration,
        "SURFACE_PRINTED": lambda: PrintedSurface(theta=printed),
    }


def models(
    corpus: str,
    learn: Learnable,
    settings: DurationSettings,
    constants: Mapping[str, str],
    seed: int,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the tables `duration_models` and `duration_predictions`."""
    chosen = settings.durations
    errors, predicted = [], []
    baseline: dict[str, np.ndarray] = {}
    recordings = list(learn.rows["recording"])
    groups = {
        "in_sample": None,
        "leave_one_out": list(range(len(learn.data))),
        "leave_one_recording_out": recordings,
    }
    for name, make in makers(settings, constants, learn.geodesic).items():
        for evaluation, members in groups.items():
            lead: dict[str, Any] = {"corpus": corpus, "model": name, "evaluation": evaluation}
            lead["n"] = len(learn.data)
            folds = ""
            try:
                if name in learn.absent:
                    raise SignkinError(learn.absent[name])
                if name == "MEAN" and len(learn.data) < 2:
                    raise SignkinError("one transition is its own mean")
                if members is None:
                    found = make().fit(learn.data).predict(learn.data)
                else:
                    held, folds = folded(members)
                    found = predict_left_out(make, learn.data, held)
            except SignkinError as error:
                reason = error.found
                if evaluation == "leave_one_recording_out" and len(set(recordings)) < 2:
                    reason = "one recording only"
                errors.append({**lead, "note": f"not testable: {reason}"})
                continue
            note = joined(folds, learn.note)
            if name.startswith("SIMPLE") or name == "SURFACE_PRINTED":
                note = joined(NOTHING_LEARNT, note)
            if name.startswith("SIMPLE") and not learn.geodesic:
                note = joined(note, ONE_DISTANCE)
            if name == "MEAN":
                baseline[evaluation] = np.abs(found - learn.data.duration_s)
            # One stream for all: models are compared on the same draws.
            rng = seeds.stream(seed, corpus, "duration_models")
            none = np.full(len(learn.data), np.nan)
            measured = _errors(
                found, baseline.get(evaluation, none), learn, recordings, chosen, rng
            )
            errors.append({**lead, **measured, "note": note})
            if evaluation == "leave_one_out":
                predicted.append(_predictions(learn.rows, name, found))
    names = tables.TABLES["duration_predictions"].names()
    together = pd.concat(predicted, ignore_index=True) if predicted else None
    return (
        pd.DataFrame(errors).reindex(columns=tables.TABLES["duration_models"].names()),
        pd.DataFrame(columns=names) if together is None else together[names],
    )


def _errors(
    found: np.ndarray,
    baseline: np.ndarray,
    learn: Learnable,
    recordings: list[str],
    chosen: Durations,
    rng: np.random.Generator,
) -> dict[str, float]:
    residual = found - learn.data.duration_s
    units, _ = association.resampled_units(recordings, chosen.bootstrap_recordings)
    absolute, too_long = np.abs(residual), _too_long(residual)
    parts = (absolute, baseline - absolute, residual, too_long)

    def means(rows: np.ndarray) -> np.ndarray:
        return np.array([part[rows].mean() for part in parts])

    low = high = np.full(len(parts), np.nan)
    if len(units) > 1:  # one transition has no interval
        low, high = association.bootstrap(means, units, chosen.draws, chosen.alpha, rng)
    measured = {
        "mean_error_s": absolute.mean(),
        "mean_error_low_s": low[0],
        "mean_error_high_s": high[0],
        "gain_s": (baseline - absolute).mean(),
        "gain_low_s": low[1],
        "gain_high_s": high[1],
        "rmse_s": np.sqrt(np.mean(residual**2)),
        "bias_s": residual.mean(),
        "bias_low_s": low[2],
        "bias_high_s": high[2],
        "share_too_long": too_long.mean(),
        "share_too_long_low": low[3],
        "share_too_long_high": high[3],
        "longest_s": found.max(),
        "share_above_bound": (found > chosen.highest_s + 1e-12).mean(),
    }
    # A bias of least squares is 0 but for rounding.
    return {name: round(float(value), 12) for name, value in measured.items()}


def _too_long(residual: np.ndarray) -> np.ndarray:
    """Return 1 for a prediction that is too long, 0 for one too short, 0.5 for an exact one."""
    return 0.5 + 0.5 * np.sign(np.round(residual, 12))


def _predictions(rows: pd.DataFrame, name: str, found: np.ndarray) -> pd.DataFrame:
    out = rows[["corpus", "recording", "signer", "transition"]].copy()
    out["model"] = name
    out["duration_s"] = rows["duration_s"].to_numpy(dtype=float)
    out["predicted_s"] = found
    return out
