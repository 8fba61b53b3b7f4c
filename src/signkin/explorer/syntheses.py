"""Captured transitions made anew (Naert et al. 2017, 3.1), for a look at both side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.coarticulation.synthesis import METHODS
from signkin.errors import SignkinError
from signkin.explorer.packing import packed, weight
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.comparison import OWN, TRUE
from signkin.studies.naert2017.synthesis.database import Database, Pair
from signkin.studies.naert2017.synthesis.joining import joined

RATES_HZ = (30.0, 20.0, 15.0)  # tried in this order: a transition is short and smooth
SAMPLE = 30  # transitions that tell how heavy all of them will be

Made = tuple[int, float, NDArray[np.float64]]  # transition, its duration in s, (n + 1, J, 3)


def syntheses(
    base: Database,
    table: pd.DataFrame,
    settings: SynthesisSettings,
    joints: Sequence[str],
    step: float,
    most_bytes: int,
) -> Mapping[str, Any]:
    """Return the transitions of a recording made by both methods, within so many bytes.

    base: the signs of the recording alone. table: its rows of the table `synthesis`, of which
    the durations are taken that `synthesis.duration` of config.yaml predicts without this
    recording (the captured one where it has none). joints, step: as the page's skeleton has them.
    All transitions of a method lie in one pack; `frames` tells transition, number of frames and
    duration of each. Where both methods do not fit, only the one that config.yaml names is
    there; where that does not fit, none is, and `told` says so.
    """
    model, durations = _durations(table, settings)
    pairs = [pair for pair in base.pairs() if pair.transition in durations]
    names = [settings.synthesis.method, *(m for m in METHODS if m != settings.synthesis.method)]
    rate = next(iter(base.recordings.values())).rate_hz
    maker = _Maker(base, durations, settings, joints, step)
    some = pairs[:: max(1, len(pairs) // SAMPLE)]
    samples = {name: maker.made(some, name) for name in names}
    empty = {"model": model, "methods": {}}
    if not all(samples.values()):
        return {**empty, "told": "no transition of this recording can be made"}
    for kept in (names, names[:1]):
        for wanted in RATES_HZ:
            every = max(1, int(np.ceil(rate / wanted)))
            heavy = sum(weight(maker.packed(samples[name], every)["positions"]) for name in kept)
            if heavy * len(pairs) / len(some) + 30 * len(pairs) * len(kept) <= most_bytes:
                left_out = [name for name in names if name not in kept]
                return {
                    "model": model,
                    "methods": {n: maker.packed(maker.made(pairs, n), every) for n in kept},
                    "told": f"{left_out[0]} would make this page too heavy" if left_out else "",
                }
    return {**empty, "told": "all transitions would make this page too heavy"}


def _durations(table: pd.DataFrame, settings: SynthesisSettings) -> tuple[str, dict[int, float]]:
    """Return the model, and transition -> duration (s) that it predicts."""
    model = settings.synthesis.duration
    own = table[(table["material"] == OWN) & (table["method"] == METHODS[0])]
    out: dict[int, float] = {}
    for name in (TRUE, model):  # the second one's, where it has any
        rows = own[(own["duration_model"] == name) & own["duration_s"].notna()]
        columns = zip(rows["transition"], rows["duration_s"], strict=True)
        out |= {int(number): float(duration) for number, duration in columns}
    return model, out


@dataclass(frozen=True, eq=False)
class _Maker:
    """Makes transitions anew and packs the joints that the page has."""

    base: Database
    durations: Mapping[int, float]
    settings: SynthesisSettings
    joints: Sequence[str]
    step: float

    def made(self, pairs: Sequence[Pair], method: str) -> list[Made]:
        """Return transitions by a method; those that cannot be made are left out."""
        out = []
        for pair in pairs:
            signs = [self.base.tokens[i].sign for i in (pair.first, pair.second)]
            take = signs[0].recording
            wanted = max(self.durations[pair.transition], 1 / take.rate_hz)
            try:
                made = joined(signs, wanted, method, self.settings.synthesis)
            except SignkinError:
                continue
            chosen = [take.index(joint) for joint in self.joints]
            path = made.motion.positions[:, chosen]
            out.append((pair.transition, made.steps / take.rate_hz, path))
        return out

    def packed(self, transitions: Sequence[Made], every: int) -> dict[str, Any]:
        """Return transitions as the page takes them, one of so many frames and the last."""
        frames, parts = [], []
        for number, duration, path in transitions:
            count = max(2, round((len(path) - 1) / every) + 1)
            at = np.linspace(0, len(path) - 1, count).round().astype(int)
            frames.append([number, count, round(duration, 4)])
            parts.append(path[at].reshape(count, -1))
        return {"frames": frames, "positions": packed(np.concatenate(parts), self.step)}
