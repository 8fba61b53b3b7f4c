"""Captured transitions made anew (Naert et al. 2017, 3.1), for a look at both side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from signkin.coarticulation.synthesis import METHODS
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.explorer.packing import packed, weight
from signkin.recording import Recording
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.comparison import OWN, TRUE
from signkin.studies.naert2017.synthesis.database import Database, database
from signkin.studies.naert2017.synthesis.joining import joined

MOST_HZ = 30.0


def syntheses(
    corpus: Corpus,
    recording: Recording,
    intervals: pd.DataFrame,
    table: pd.DataFrame,
    settings: SynthesisSettings,
    joints: Sequence[str],
    step: float,
    most_bytes: int,
) -> Mapping[str, Any]:
    """Return the transitions of a recording made by both methods, within so many bytes.

    intervals: the corpus's table. table: the recording's rows of the table `synthesis`, of which
    the durations are taken that `synthesis.duration` of config.yaml predicts without this
    recording (the captured one where it has none). joints, step: as the page's skeleton has them.
    All transitions of a method lie in one pack, `frames` tells how many frames each has. Where
    both do not fit, only the method that config.yaml names is there; where that does not fit,
    none is, and `told` says so.
    """
    base = database(corpus, [recording], intervals, settings)
    model, durations = _durations(table, settings)
    every = max(1, int(np.ceil(recording.rate_hz / MOST_HZ)))
    head = {"model": model, "rate": recording.rate_hz / every, "step": every}
    methods = [settings.synthesis.method, *(m for m in METHODS if m != settings.synthesis.method)]
    made: dict[str, Any] = {}
    left = most_bytes
    for method in methods:
        one = _of_method(base, durations, method, settings, joints, step, every)
        if not one["frames"]:
            return {**head, "methods": {}, "told": "no transition of this recording can be made"}
        left -= weight(one["positions"]) + 30 * len(one["frames"])
        if left < 0:
            break
        made[method] = one
    told = ""
    if len(made) < len(methods):
        names = " and ".join(m for m in methods if m not in made)
        told = f"{names} would make this page too heavy"
    return {**head, "methods": made, "told": told}


def _durations(table: pd.DataFrame, settings: SynthesisSettings) -> tuple[str, dict[int, float]]:
    """Return the model, and transition -> duration (s) that it predicts."""
    model = settings.synthesis.duration
    own = table[(table["material"] == OWN) & (table["method"] == METHODS[0])]
    out: dict[int, float] = {}
    for name in (TRUE, model):  # the second one's, where it has any
        rows = own[(own["duration_model"] == name) & own["duration_s"].notna()]
        out |= {
            int(n): float(d) for n, d in zip(rows["transition"], rows["duration_s"], strict=True)
        }
    return model, out


def _of_method(
    base: Database,
    durations: Mapping[int, float],
    method: str,
    settings: SynthesisSettings,
    joints: Sequence[str],
    step: float,
    every: int,
) -> dict[str, Any]:
    frames: list[list[float]] = []
    parts = []
    for pair in base.pairs():
        if pair.transition not in durations:
            continue
        signs = [base.tokens[i].sign for i in (pair.first, pair.second)]
        take = signs[0].recording
        wanted = max(durations[pair.transition], 1 / take.rate_hz)
        try:
            made = joined(signs, wanted, method, settings.synthesis)
        except SignkinError:
            continue
        chosen = [take.index(joint) for joint in joints]
        path = made.motion.positions[:, chosen]
        at = np.unique(np.append(np.arange(0, len(path), every), len(path) - 1))
        frames.append([pair.transition, len(at), round(made.steps / take.rate_hz, 4)])
        parts.append(path[at].reshape(len(at), -1))
    if not parts:
        return {"frames": [], "positions": None}
    return {"frames": frames, "positions": packed(np.concatenate(parts), step)}
