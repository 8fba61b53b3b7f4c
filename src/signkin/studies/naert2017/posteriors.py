"""Manual tags as posteriors, for every tag and hand of a corpus, beside the paper's rule."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
import pandas as pd

from signkin.annotation import Interval
from signkin.coarticulation import (
    TagModel,
    learn_tag_model,
    refine_posterior,
)
from signkin.coarticulation.segmentation import EDGES
from signkin.corpus import Corpus
from signkin.joints import HANDS
from signkin.studies.naert2017.tagged import intervals_of, together, with_lead
from signkin.tables import ByRecording, rows_of

NOT_LEARNT = "too few tags or no minima to learn from: bias and jitter are assumed"


# Tags (N, 2), minima (M,), their depths, and where the hand rests near them (M, 2).
Given = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def tag_models(
    corpus: Corpus,
    names: Iterable[str],
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    sign_types: pd.DataFrame,
) -> dict[str, TagModel]:
    """Return how tags and minima of each hand lie about boundaries, learnt from recordings.

    names: of the recordings. intervals, minima, sign_types: tables of these names.
    """
    signs, given, acts = _given(corpus, names, intervals, minima, sign_types)
    return {
        hand: learn_tag_model(
            [given[hand, name][:3] for name in signs],
            rests_s=[given[hand, name][3] for name in signs],
            acts=[acts[hand, name] for name in signs],
        )
        for hand in HANDS
    }


def models_text(models: Mapping[str, TagModel]) -> str:
    """Return models as JSON, every digit kept."""
    return json.dumps({hand: asdict(model) for hand, model in models.items()}, indent=1) + "\n"


def models_of(text: str) -> dict[str, TagModel]:
    """Return the models of a text that `models_text` wrote."""

    def model(told: dict[str, Any]) -> TagModel:
        fields: dict[str, Any] = {
            name: tuple(value) if isinstance(value, list) else value for name, value in told.items()
        }
        return TagModel(**fields)

    return {hand: model(told) for hand, told in json.loads(text).items()}


def boundary_posteriors(
    corpus: Corpus,
    names: Iterable[str],
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    sign_types: pd.DataFrame,
    models: Mapping[str, TagModel],
) -> pd.DataFrame:
    """Return the table `boundary_posteriors` of some recordings; models: of `tag_models`."""
    signs, given, acts = _given(corpus, names, intervals, minima, sign_types)
    parts = []
    for hand in HANDS:
        model = models[hand]
        learnt = model != TagModel()
        for name, tags in signs.items():
            labels = [s.label for s in tags]
            rows = _rows(hand, labels, given[hand, name], acts[hand, name], model)
            if not learnt:
                rows["note"] = [f"{n}; {NOT_LEARNT}" if n else NOT_LEARNT for n in rows["note"]]
            parts.append(with_lead(corpus, name, rows))
    return together(parts, "boundary_posteriors", corpus.unit)


def _given(
    corpus: Corpus,
    names: Iterable[str],
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    sign_types: pd.DataFrame,
) -> tuple[
    dict[str, list[Interval]], dict[tuple[str, str], Given], dict[tuple[str, str], np.ndarray]
]:
    """Return signs by recording; tags with minima, and where a hand acts, by hand and recording."""
    depth = f"prominence_{corpus.unit}_per_s"
    given, acts = {}, {}
    tags_by, lows, types = map(ByRecording, (intervals, minima, sign_types))
    signs = {name: intervals_of(tags_by, name, "sign") for name in names}
    for name, tags in signs.items():
        times = np.array([(s.start_s, s.end_s) for s in tags]).reshape(-1, 2)
        own = lows[name]
        for hand in HANDS:
            rows = own[own["hand"] == hand]
            given[hand, name] = (
                times,
                rows["minimum_s"].to_numpy(float),
                rows[depth].to_numpy(float),
                rows[["rest_s", "rest_sd_s"]].to_numpy(float),
            )
            acts[hand, name] = acting(corpus, types, name, hand, len(tags))
    return signs, given, acts


def acting(
    corpus: Corpus, sign_types: pd.DataFrame | ByRecording, recording: str, hand: str, signs: int
) -> np.ndarray:
    """Return whether the hand acts in each sign of a recording, (N,), by the signs' types.

    The dominant hand does in all, the other one in two-handed signs; a sign without a type is
    taken for one in which both do.
    """
    acts = np.ones(signs, dtype=bool)
    if hand == corpus.dominant_hand(corpus.by_name[recording]):
        return acts
    rows = rows_of(sign_types, recording)
    one_handed = rows[rows["type"].str.match("[02]")]
    acts[one_handed["sign"].to_numpy(dtype=int) - 1] = False
    return acts


def _rows(
    hand: str,
    glosses: list[str],
    given: Given,
    acts: np.ndarray,
    model: TagModel,
) -> pd.DataFrame:
    tags, times, depth, rests = given
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
