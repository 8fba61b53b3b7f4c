"""Tags moved to speed minima, and how they lie to the minima (Naert et al. 2017, 4.2)."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd

from signkin import seeds
from signkin.coarticulation.segmentation import (
    boundary_rows,
    chance_distances,
    refinement_quality,
)
from signkin.corpus import Corpus
from signkin.joints import HANDS
from signkin.settings.sections import Refinement
from signkin.studies.naert2017.sampling import Sample
from signkin.studies.naert2017.tagged import intervals_of, together, with_lead
from signkin.tables import ByRecording


def boundaries(
    corpus: Corpus,
    names: Iterable[str],
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    settings: Refinement,
) -> pd.DataFrame:
    """Return the table `boundaries` of some recordings."""
    parts = []
    tags, lows = ByRecording(intervals), ByRecording(minima)
    for name in names:
        signs = intervals_of(tags, name, "sign")
        of_recording = lows[name]
        times = {
            hand: of_recording.loc[of_recording["hand"] == hand, "minimum_s"].to_numpy(dtype=float)
            for hand in HANDS
        }
        rows = boundary_rows(signs, times, settings.search_window_s, settings.tolerance_s)
        parts.append(with_lead(corpus, name, rows))
    return together(parts, "boundaries", corpus.unit)


def refinement(
    corpus: Corpus,
    about: pd.DataFrame,
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    bounds: pd.DataFrame,
    settings: Refinement,
    seed: int,
    chosen: Sample,
) -> tuple[pd.DataFrame, dict[str, np.ndarray]]:
    """Return the table `refinement`, and all chance distances (draws, tags) of each hand.

    about: the table `recordings`. bounds: the table `boundaries`. chosen: the recordings that
    chance is drawn in.
    """
    chance = {}
    rates = about.set_index("recording")["rate_hz"]
    tags, lows = ByRecording(intervals), ByRecording(minima)
    for name in chosen.names:
        signs = intervals_of(tags, name, "sign")
        of_recording = lows[name]
        for hand in HANDS:
            own = of_recording["hand"] == hand
            chance[(name, hand)] = chance_distances(
                signs,
                of_recording.loc[own, "minimum_s"].to_numpy(dtype=float),
                float(rates[name]),
                settings.draws,
                seeds.stream(seed, corpus.name, name, hand, "chance"),
            )
    rows = refinement_quality(bounds, chance, settings.search_window_s, settings.tolerance_s)
    rows = chosen.told(rows, rows["chance"].notna())
    rows.insert(0, "corpus", corpus.name)
    pooled = {
        hand: np.concatenate([d for (_, h), d in chance.items() if h == hand], axis=1)
        for hand in HANDS
    }
    return rows, pooled
