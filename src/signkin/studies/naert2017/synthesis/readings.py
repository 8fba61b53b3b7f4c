"""What is printed of synthesis where rules of ours add to it (Naert et al. 2017, 3.1, 5.2).

Orientations go along the arc (slerp), printed is linear interpolation; signs of a list are chosen
for the whole of it (chain), printed is each sign by its distance to those beside it. Both are
run both ways. No claim of the paper's rests on either, so that no verdict is told with them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from signkin import seeds, tables
from signkin.coarticulation.posture import euclidean_distance
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.comparison import in_true_time
from signkin.studies.naert2017.synthesis.database import Database
from signkin.studies.naert2017.synthesis.joining import INTERPOLATION
from signkin.studies.naert2017.synthesis.retrieval import distance_scale, retrieved
from signkin.studies.naert2017.synthesis.summary import DURATION_ERROR, error_measures

ORIENTATIONS = ("slerp", "linear")  # the second one as printed
RETRIEVALS = ("chain", "greedy")
LISTS, GLOSSES = 300, 5  # random lists of glosses, each of which occurs more than once
MOST = 150  # transitions, evenly spread


def synthesis_readings(base: Database, settings: SynthesisSettings, seed: int) -> pd.DataFrame:
    """Return the table `readings_synthesis`."""
    rows = [*_orientations(base, settings), *_retrievals(base, seed)]
    frame = pd.DataFrame(rows).assign(corpus=base.corpus.name)
    return frame.reindex(columns=tables.TABLES["readings_synthesis"].names())


def _orientations(base: Database, settings: SynthesisSettings) -> Iterator[dict[str, Any]]:
    rule = {"rule": "orientations", "claims": "none"}
    if not any(take.orientations is not None for take in base.recordings.values()):
        note = "no recorded orientations: positions alone are mixed, linearly under both"
        for i, reading in enumerate(ORIENTATIONS):
            yield {**rule, "reading": reading, "printed": _told(i), "n": 0, "note": note}
        return
    for i, reading in enumerate(ORIENTATIONS):
        changed = settings.synthesis.model_copy(update={"orientations": reading})
        made = in_true_time(base, settings.model_copy(update={"synthesis": changed}), MOST)
        for measure, (unit, define) in error_measures(base.corpus.unit).items():
            if measure == DURATION_ERROR:  # in the true time there is none
                continue
            values = define(made[made["method"] == INTERPOLATION]).dropna()
            yield {
                **rule, "reading": reading, "printed": _told(i), "method": INTERPOLATION,
                "measure": measure, "unit": unit, "n": len(values),
                "mean": values.mean() if len(values) else None, "note": "",
            }  # fmt: skip


def _retrievals(base: Database, seed: int) -> Iterator[dict[str, Any]]:
    often = sorted(gloss for gloss, tokens in base.glosses().items() if len(tokens) > 1)
    lead = {"rule": "retrieval", "claims": "none", "measure": "distance at transitions",
            "unit": base.corpus.unit}  # fmt: skip
    lists: list[list[str]] = []
    if len(often) >= GLOSSES:
        rng = seeds.stream(seed, base.corpus.name, "retrieval")
        lists = [list(rng.choice(often, GLOSSES, replace=False)) for _ in range(LISTS)]
    scale = distance_scale(base)
    for i, reading in enumerate(RETRIEVALS):
        found = [_distance(base, retrieved(base, glosses, reading, scale)) for glosses in lists]
        there = np.array(found)[np.isfinite(found)] if found else np.empty(0)
        short = f"{len(often)} glosses occur more than once: too few for a list of {GLOSSES}"
        yield {
            **lead, "reading": reading, "printed": _told(i), "n": len(there),
            "mean": float(there.mean()) if len(there) else None, "note": "" if lists else short,
        }  # fmt: skip


def _distance(base: Database, tokens: list[int]) -> float:
    """Return the mean Euclidean distance at the transitions of a list of signs."""
    a, b = base.candidates(tokens[:-1]), base.candidates(tokens[1:])
    return float(np.mean(euclidean_distance(a.last, b.first)))


def _told(place: int) -> str:
    return "yes" if place else "no"
