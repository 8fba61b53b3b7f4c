"""Manual tags as posteriors, for every tag and hand of a corpus, beside the paper's rule."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd

from signkin.coarticulation import (
    TagModel,
    learn_tag_model,
    refine_posterior,
)
from signkin.coarticulation.segmentation import EDGES
from signkin.corpus import Corpus
from signkin.joints import HANDS
from signkin.studies.naert2017.tagged import intervals_of, together, with_lead

NOT_LEARNT = "too few tags or no minima to learn from: bias and jitter are assumed"


def boundary_posteriors(
    corpus: Corpus,
    names: Iterable[str],
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    sign_types: pd.DataFrame,
) -> pd.DataFrame:
    """Return the table `boundary_posteriors`; the jitter is learnt from all recordings of a hand.

    names: of the recordings. intervals, minima, sign_types: tables of these names.
    """
    start = TagModel()
    depth = f"prominence_{corpus.unit}_per_s"
    parts = []
    signs = {name: intervals_of(intervals, name, "sign") for name in names}
    for hand in HANDS:
        acts = {name: acting(corpus, sign_types, name, hand, len(signs[name])) for name in signs}
        sets, rests = {}, {}
        for name, tags in signs.items():
            rows = minima[(minima["recording"] == name) & (minima["hand"] == hand)]
            times = np.array([(s.start_s, s.end_s) for s in tags]).reshape(-1, 2)
            sets[name] = (times, rows["minimum_s"].to_numpy(float), rows[depth].to_numpy(float))
            rests[name] = rows[["rest_s", "rest_sd_s"]].to_numpy(float)
        model = learn_tag_model(
            list(sets.values()), start, rests_s=list(rests.values()), acts=list(acts.values())
        )
        for name, tags in signs.items():
            glosses = [s.label for s in tags]
            rows = _rows(hand, glosses, sets[name], rests[name], acts[name], model)
            if model == start:
                rows["note"] = [f"{n}; {NOT_LEARNT}" if n else NOT_LEARNT for n in rows["note"]]
            parts.append(with_lead(corpus, name, rows))
    return together(parts, "boundary_posteriors", corpus.unit)


def acting(
    corpus: Corpus, sign_types: pd.DataFrame, recording: str, hand: str, signs: int
) -> np.ndarray:
    """Return whether the hand acts in each sign of a recording, (N,), by the signs' types.

    The dominant hand does in all, the other one in two-handed signs; a sign without a type is
    taken for one in which both do.
    """
    acts = np.ones(signs, dtype=bool)
    if hand == corpus.dominant_hand(corpus.by_name[recording]):
        return acts
    rows = sign_types[sign_types["recording"] == recording]
    one_handed = rows[rows["type"].str.match("[02]")]
    acts[one_handed["sign"].to_numpy(dtype=int) - 1] = False
    return acts


def _rows(
    hand: str,
    glosses: list[str],
    given: tuple[np.ndarray, np.ndarray, np.ndarray],
    rests: np.ndarray,
    acts: np.ndarray,
    model: TagModel,
) -> pd.DataFrame:
    tags, times, depth = given
    found = refine_posterior(tags, times, depth, rests_s=rests, acts=acts, model=model)
    bias = np.broadcast_to(model.bias_s, tags.shape)
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
            "acts": np.repeat(acts, 2),
            "bias_s": bias.ravel(),
            "jitter_s": model.sd_s,
            "note": [str(note) for note in found.notes.ravel()],
        }
    )
