"""Manual tags as posteriors, for every tag and hand of a corpus, beside the paper's rule."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd

from signkin.coarticulation import TagModel, learn_tag_model, refine_posterior
from signkin.coarticulation.segmentation import EDGES
from signkin.corpus import Corpus
from signkin.joints import HANDS
from signkin.studies.naert2017.tagged import intervals_of, together, with_lead

NOT_LEARNT = "too few tags or no minima to learn from: bias and jitter are assumed"


def boundary_posteriors(
    corpus: Corpus, names: Iterable[str], intervals: pd.DataFrame, minima: pd.DataFrame
) -> pd.DataFrame:
    """Return the table `boundary_posteriors`; the jitter is learnt from all recordings of a hand.

    names: of the recordings. intervals, minima: tables of these names.
    """
    depth = f"prominence_{corpus.unit}_per_s"
    parts = []
    signs = {name: intervals_of(intervals, name, "sign") for name in names}
    for hand in HANDS:
        sets = {}
        for name, tags in signs.items():
            rows = minima[(minima["recording"] == name) & (minima["hand"] == hand)]
            times = np.array([(s.start_s, s.end_s) for s in tags]).reshape(-1, 2)
            sets[name] = (times, rows["minimum_s"].to_numpy(float), rows[depth].to_numpy(float))
        model = learn_tag_model(list(sets.values()))
        for name, tags in signs.items():
            rows = _rows(hand, [s.label for s in tags], sets[name], model)
            parts.append(with_lead(corpus, name, rows))
    return together(parts, "boundary_posteriors", corpus.unit)


def _rows(
    hand: str,
    glosses: list[str],
    given: tuple[np.ndarray, np.ndarray, np.ndarray],
    model: TagModel,
) -> pd.DataFrame:
    tags, times, depth = given
    found = refine_posterior(tags, times, depth, model=model)
    notes = [str(note) for note in found.notes.ravel()]
    if model == TagModel():
        notes = [f"{note}; {NOT_LEARNT}" if note else NOT_LEARNT for note in notes]
    return pd.DataFrame(
        {
            "sign": np.repeat(np.arange(1, len(tags) + 1), 2),
            "gloss": np.repeat(np.array(glosses, dtype=object), 2),
            "edge": list(EDGES) * len(tags),
            "hand": hand,
            "manual_s": tags.ravel(),
            "mean_s": found.mean_s.ravel(),
            "low50_s": found.interval50_s[..., 0].ravel(),
            "high50_s": found.interval50_s[..., 1].ravel(),
            "low90_s": found.interval90_s[..., 0].ravel(),
            "high90_s": found.interval90_s[..., 1].ravel(),
            "off": found.off.ravel(),
            "own_minimum": found.own_minimum.ravel(),
            "bias_s": model.bias_s,
            "jitter_s": model.sd_s,
            "note": notes,
        }
    )
