"""How long a synthetic transition lasts: the duration models of section 5.2, fitted and asked."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.coarticulation import duration
from signkin.coarticulation.duration import (
    TERMS,
    DurationModel,
    MeanDuration,
    SurfaceDuration,
    Transitions,
)
from signkin.errors import SignkinError
from signkin.settings.sections import Durations
from signkin.studies.naert2017.synthesis.database import Array, Database, Pair

MODELS = ("simple", "simple_bounded", "linear", "surface")
METRES = "m"


def maker(model: str, settings: Durations, geodesic: bool) -> Callable[[], DurationModel]:
    """Return what makes a duration model.

    geodesic: whether the corpus has this distance; without, SIMPLE is its Euclidean part alone.
    """
    alpha = settings.simple_alpha if geodesic else 1.0
    low, high = settings.lowest_s, settings.highest_s
    makers: dict[str, Callable[[], DurationModel]] = {
        "simple": lambda: duration.SimpleDuration(alpha),
        "simple_bounded": lambda: duration.SimpleBoundedDuration(alpha, low, high),
        "linear": duration.LinearDuration,
        "surface": duration.SurfaceDuration,
    }
    return makers[model]


def usable(model: str, data: Transitions) -> NDArray[np.bool_]:
    """Return for which transitions a model has what it wants, (N,)."""
    there = np.isfinite(data.euclidean)
    geodesic = np.isfinite(data.geodesic)
    if geodesic.any() or model == "surface":
        there = there & geodesic
    if model in ("simple", "simple_bounded"):
        there = there & (data.linear_speed.sum(axis=1) > 0)
        if geodesic.any():
            there = there & (data.angular_speed.sum(axis=1) > 0)
    return np.asarray(there)


def with_durations(data: Transitions, duration_s: Array) -> Transitions:
    """Return the same transitions with their durations."""
    return Transitions(
        data.geodesic, data.euclidean, duration_s, data.linear_speed, data.angular_speed
    )


def predictions(
    known: Transitions, groups: Sequence[str], asked: Transitions, settings: Durations
) -> dict[str, Array]:
    """Return what each model predicts for `asked`, (N,), having learnt from other groups.

    known: the captured transitions. asked: what is to be
    predicted in their place, row by row. A model that cannot be fitted or asked predicts NaN.
    """
    labels = np.array(groups)
    geodesic = bool(np.isfinite(known.geodesic).any())
    out = {}
    for model in MODELS:
        make, values = maker(model, settings, geodesic), np.full(len(known), np.nan)
        learn, ask = usable(model, known), usable(model, asked)
        for group in dict.fromkeys(groups):
            held = (labels == group) & ask
            if held.any():
                try:
                    fitted = known[(labels != group) & learn].teach(make())
                except SignkinError:
                    continue
                values[held] = asked[held].ask(fitted)
        out[model] = values
    return out


def captured(base: Database, pairs: Sequence[Pair]) -> Transitions:
    """Return captured transitions as the duration models learn from them."""
    data = base.features([p.first for p in pairs], [p.second for p in pairs])
    return with_durations(data, np.array([p.true_s for p in pairs]))


def groups_of(database: Database, pairs: Sequence[Pair]) -> list[str]:
    """Return what is left out together: recordings; single transitions of a lone recording."""
    names = [database.tokens[p.first].sign.recording.name for p in pairs]
    if len(set(names)) > 1:
        return names
    return [f"{name} {pair.transition}" for name, pair in zip(names, pairs, strict=True)]


def printed_theta(constants: str | Path) -> np.ndarray:
    """Return theta of eq. 4 as the paper prints it, (3,), from papers/naert2017/constants.csv."""
    frame = pd.read_csv(constants, dtype=str, keep_default_na=False).set_index("name")
    return np.array([float(frame.loc[f"theta_{term}", "value"]) for term in TERMS])


@dataclass(frozen=True, eq=False)
class Timing:
    """The model that tells how long transitions last, what it learnt from, and what stands in."""

    model: DurationModel
    name: str
    told: str
    fallback: DurationModel

    def ask(self, data: Transitions) -> tuple[float, str]:
        """Return the duration of one transition, and a note where the model had none."""
        value, note = float("nan"), ""
        if usable(self.name, data).all():
            value = float(data.ask(self.model)[0])
        if not np.isfinite(value):
            value = float(data.ask(self.fallback)[0])
            note = f"{self.name} has no duration for these postures: {value:.3f} s instead"
        return value, note


def timing(base: Database, model: str, settings: Durations, printed: np.ndarray) -> Timing:
    """Return the duration model, learnt from all captured transitions of the corpus.

    printed: theta of the paper's surface, for corpora without transitions to learn from.
    """
    pairs = base.pairs()
    usual = MeanDuration((settings.lowest_s + settings.highest_s) / 2)
    if pairs:
        known = captured(base, pairs)
        usual = MeanDuration(float(known.duration_s.mean()))
        geodesic = bool(np.isfinite(known.geodesic).any())
        for name in dict.fromkeys((model, "linear")):
            learn = known[usable(name, known)]
            try:
                fitted_model = learn.teach(maker(name, settings, geodesic)())
            except SignkinError:
                continue
            told = f"{name}, from {len(learn)} transitions of the corpus"
            if name != model:
                told += f" ({model} cannot be fitted)"
            return Timing(fitted_model, name, told, usual)
    has_turns = all(turns is not None for turns in base.turns.values())
    if model in ("surface", "linear") and has_turns and base.corpus.unit == METRES:
        told = "surface as printed in the paper (no captured transition to learn from)"
        return Timing(SurfaceDuration(theta=printed), "surface", told, usual)
    name = model if model == "simple" else "simple_bounded"
    bounded = maker(name, settings, has_turns)()
    return Timing(bounded, name, f"{name} (nothing to learn)", usual)


def model_durations(
    base: Database, pair: tuple[int, int], settings: Durations, printed: Array
) -> tuple[dict[str, float], str]:
    """Return what each model says about two signs, and what the models have learnt from."""
    asked = base.features([pair[0]], [pair[1]])
    pairs = base.pairs()
    known, told = None, "no captured transitions: LINEAR is left out, SURFACE is the printed one"
    if pairs:
        known = captured(base, pairs)
        told = f"models learnt from the {len(pairs)} captured transitions of the corpus"
    source = asked if known is None else known
    geodesic = bool(np.isfinite(source.geodesic).any())
    out = {}
    for name in MODELS:
        make, model = maker(name, settings, geodesic), None
        try:
            if known is not None:
                model = known[usable(name, known)].teach(make())
            elif name.startswith("simple"):
                model = make()
            elif name == "surface" and base.corpus.unit == METRES:
                model = SurfaceDuration(theta=printed)
        except SignkinError:
            continue
        if model is not None and usable(name, asked).all():
            out[name] = max(float(asked.ask(model)[0]), 0.0)
    return out, told
