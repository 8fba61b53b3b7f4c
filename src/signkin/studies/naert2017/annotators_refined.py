"""Does refinement bring two annotators nearer to each other than it would shuffled tags?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from signkin import tables
from signkin.coarticulation import TagModel, learn_tag_model, refine_each, refine_posterior
from signkin.coarticulation.segmentation import EDGES
from signkin.joints import HANDS
from signkin.seeds import stream
from signkin.studies.naert2017.annotators import Signs, pairs_of

DRAWS = {"rule": 200, "posterior": 39}
NO_PAIR = "no sign of one overlaps a sign of the other"

# Times, depths and rests (M, 2) of the minima of a hand, as `refine_posterior` has them.
OfHand = tuple[np.ndarray, np.ndarray, np.ndarray]
Minima = Mapping[tuple[str, str], OfHand]  # by recording and hand


@dataclass(frozen=True, eq=False)
class _Both:
    """One recording: tags (N, 2) of both annotators, which are pairs, and the hand's minima."""

    tags: tuple[np.ndarray, np.ndarray]
    pairs: np.ndarray
    minima_s: np.ndarray
    depth: np.ndarray
    rests_s: np.ndarray

    def shifted(self, rng: np.random.Generator) -> _Both:
        """Return the same with minima shifted in a circle, by 1 s or more where there is room."""
        low = min(tags.min() for tags in self.tags) - 1.0
        span = max(tags.max() for tags in self.tags) + 1.0 - low
        by = rng.uniform(min(1.0, span / 3), max(span - 1.0, span * 2 / 3))
        shifted = low + (self.minima_s - low + by) % span
        moved = np.column_stack([shifted - self.minima_s, np.zeros(len(shifted))])
        return replace(self, minima_s=shifted, rests_s=self.rests_s + moved)


def refined_agreement(
    corpus: str,
    names: tuple[str, str],
    signs: tuple[Signs, Signs],
    minima: Minima,
    window_s: float,
    seed: int,
) -> pd.DataFrame:
    """Return the table `annotator_refined`: offsets of two annotators before and after refinement.

    minima: of every recording and hand. Chance: the minima shifted in time, so that tags are
    refined to minima that have nothing to do with them, and keep their offsets to each other.
    """
    rows = []
    for hand in HANDS:
        parts = [_both(signs, name, minima[name, hand]) for name in signs[0] if name in signs[1]]
        parts = [part for part in parts if len(part.pairs)]
        lead = {"corpus": corpus, "first": names[0], "second": names[1], "hand": hand}
        if not parts:
            rows += [{**lead, "edge": edge, "n": 0, "note": NO_PAIR} for edge in EDGES]
            continue
        before = _apart(parts, [part.tags for part in parts])
        for method, draws in DRAWS.items():
            models = _models(parts) if method == "posterior" else None
            after = _apart(parts, [_refined(p, window_s, models) for p in parts])
            rng = stream(seed, corpus, *names, hand, method, "annotators")
            chance = before - np.array([
                _apart(parts, [_refined(p.shifted(rng), window_s, models) for p in parts])
                for _ in range(draws)
            ])  # fmt: skip
            low, high = np.quantile(chance, [0.025, 0.975], axis=0)
            as_near = (chance >= before - after).sum(axis=0)
            rows += [
                {**lead, "edge": edge, "method": method, "n": sum(len(p.pairs) for p in parts),
                 "before_s": before[k], "after_s": after[k], "nearer_s": before[k] - after[k],
                 "chance": chance.mean(axis=0)[k], "chance_low": low[k], "chance_high": high[k],
                 "p": (1 + as_near[k]) / (1 + draws), "note": ""}
                for k, edge in enumerate(EDGES)
            ]  # fmt: skip
    return pd.DataFrame(rows, columns=tables.TABLES["annotator_refined"].names())


def _both(signs: tuple[Signs, Signs], name: str, minima: OfHand) -> _Both:
    first, second = (
        np.array([(i.start_s, i.end_s) for i in side[name]]).reshape(-1, 2) for side in signs
    )
    pairs = np.array(pairs_of(signs[0][name], signs[1][name]), dtype=int).reshape(-1, 2)
    order = np.argsort(minima[0], kind="stable")
    return _Both((first, second), pairs, *(values[order] for values in minima))


def _models(parts: list[_Both]) -> tuple[TagModel, TagModel]:
    first, second = (
        learn_tag_model(
            [(part.tags[k], part.minima_s, part.depth) for part in parts],
            rests_s=[part.rests_s for part in parts],
        )
        for k in (0, 1)
    )
    return first, second


def _refined(
    part: _Both, window_s: float, models: tuple[TagModel, TagModel] | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return the tags of both annotators after refinement; without models by the plain rule."""
    if models is None:
        ordered = np.sort(part.minima_s)
        first, second = (refine_each(tags, ordered, window_s)[0] for tags in part.tags)
    else:
        first, second = (
            refine_posterior(
                tags, part.minima_s, part.depth, rests_s=part.rests_s, model=model
            ).mean_s
            for tags, model in zip(part.tags, models, strict=True)
        )
    return first, second


def _apart(parts: list[_Both], tags: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Return the mean absolute offset of paired tags, (2,) of starts and ends."""
    away = [
        np.abs(first[part.pairs[:, 0]] - second[part.pairs[:, 1]])
        for part, (first, second) in zip(parts, tags, strict=True)
    ]
    return np.asarray(np.nanmean(np.concatenate(away), axis=0))
