"""How far the annotators of a corpus agree: every two of them, in three tables."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd

from signkin import tables
from signkin.corpus import Corpus
from signkin.joints import HANDS
from signkin.seeds import stream
from signkin.segments import Part, score_methods
from signkin.studies.naert2017.annotators import Signs, offsets, pair_rows, signs_of
from signkin.studies.naert2017.annotators_refined import refined_agreement
from signkin.studies.naert2017.sampling import sample
from signkin.studies.naert2017.tagged import intervals_of

FIRST = "the corpus's own"  # tags that all other analyses are made with
DRAWS = 100
NAMES = ("annotator_agreement", "annotator_offsets", "annotator_refined")


def agreement(
    corpus: Corpus,
    folder: Path,
    about: pd.DataFrame,
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    sign_types: pd.DataFrame,
    window_s: float,
    seed: int,
    most: int,
) -> dict[str, pd.DataFrame]:
    """Return the tables `annotator_agreement`, `annotator_offsets` and `annotator_refined`.

    folder: of the data. about, intervals, minima, sign_types: tables of these names (about:
    `recordings`). window_s: of the paper's rule. most: neighbouring signs of the recordings taken
    (`sampling.sample`), by halves: each draw of chance refines all of them anew. Recordings that an
    annotator did not tag are left out and told.
    """
    chosen = sample(corpus.name, about["recording"].astype(str), intervals, most // 2, seed)
    about = chosen.rows(about)
    rates = dict(zip(about["recording"].astype(str), about["rate_hz"], strict=True))
    tags, lows = tables.ByRecording(intervals), tables.ByRecording(minima)
    found: dict[str, Signs] = {FIRST: {name: intervals_of(tags, name, "sign") for name in rates}}
    notes: list[str] = []
    for annotator in corpus.annotators:
        found[annotator], untold = signs_of(corpus, annotator, folder, rates)
        notes += untold
    depth = f"prominence_{corpus.unit}_per_s"
    times = {}
    for name in rates:
        own = lows[name]
        for hand in HANDS:
            rows = own[own["hand"] == hand]
            times[name, hand] = (
                rows["minimum_s"].to_numpy(float),
                rows[depth].to_numpy(float),
                rows[["rest_s", "rest_sd_s"]].to_numpy(float),
            )
    made: dict[str, list[pd.DataFrame]] = {name: [] for name in NAMES}
    for one, other in combinations(found, 2):
        both = (one, other)
        signs = (found[one], found[other])
        told = "; ".join(note for note in notes if note.split(",")[0] in both)
        told = "; ".join(filter(None, (told, chosen.note)))
        rng = stream(seed, corpus.name, *both, "agreement")
        made["annotator_agreement"].append(_scores(corpus.name, both, signs, told, rng))
        pairs = pair_rows(*signs, sign_types)
        made["annotator_offsets"].append(offsets(corpus.name, both, pairs))
        made["annotator_refined"].append(
            refined_agreement(corpus.name, both, signs, times, window_s, seed)
        )
    return {name: pd.concat(parts, ignore_index=True) for name, parts in made.items()}


def _scores(
    corpus: str, names: tuple[str, str], signs: tuple[Signs, Signs], note: str,
    rng: np.random.Generator,
) -> pd.DataFrame:  # fmt: skip
    """Return the rows of `annotator_agreement` of two annotators."""
    first, second = (
        {name: np.array([(i.start_s, i.end_s) for i in own]).reshape(-1, 2)
         for name, own in side.items()}
        for side in signs
    )  # fmt: skip
    parts = [Part(first[name], second[name]) for name in first if name in second]
    rows = score_methods(parts, DRAWS, rng, gamma=True)
    if rows.empty:
        rows = pd.DataFrame([{"note": "no recording that both tagged"}])
    rows = rows.assign(corpus=corpus, first=names[0], second=names[1])
    if note:
        rows["note"] = note
    return rows.reindex(columns=tables.TABLES["annotator_agreement"].names())
