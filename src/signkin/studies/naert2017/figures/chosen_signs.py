"""Which signs Fig. 1, 2, 12 and 13 show."""

from __future__ import annotations

import numpy as np
import pandas as pd

from signkin.coarticulation.retrieval import distances
from signkin.errors import SignkinError
from signkin.studies.naert2017.synthesis.comparison import OWN
from signkin.studies.naert2017.synthesis.database import Database
from signkin.studies.naert2017.synthesis.duration_models import MODELS
from signkin.studies.naert2017.synthesis.retrieval import distance_scale

SHOWN_S = (0.2, 0.5)  # durations of transitions that Fig. 12 may show
FAR = 0.95  # Fig. 13: farther apart than this share of all pairs


def shown_pair(base: Database, rows: pd.DataFrame | None) -> tuple[int, int]:
    """Return the tokens that Fig. 1, 2 and 12 show; rows: the table `synthesis`, or None."""
    if rows is None or rows.empty:
        return 0, 1
    key = chosen_transition(rows, base.corpus.unit)
    for pair in base.pairs():
        if (base.tokens[pair.first].sign.recording.name, pair.transition) == key:
            return pair.first, pair.second
    return 0, 1


def chosen_transition(rows: pd.DataFrame, unit: str) -> tuple[str, int]:
    """Return recording and number of the transition shown: of usual length and usual error.

    Among the captured transitions of 0.2 to 0.5 s (all, where there is none) that every fitted
    model has a duration for, the one whose position error by interpolation is the median.
    """
    own = rows[(rows["material"] == OWN) & (rows["method"] == "interpolation")]
    models = [m for m in MODELS if own.loc[own["duration_model"] == m, "duration_s"].notna().any()]
    told = own[own["duration_model"].isin(models)].groupby(["recording", "transition"])
    complete = told["duration_s"].apply(lambda s: bool(s.notna().all()))
    error = told[f"error_{unit}"].mean()
    length = told["true_s"].first()
    usual = complete & error.notna() & length.between(*SHOWN_S)
    for candidates in (usual, error.notna(), length.notna()):
        if candidates.any():
            values = error[candidates].fillna(0.0)
            place = (values - values.median()).abs().idxmin()
            return str(place[0]), int(place[1])
    raise SignkinError("no transition", place="Fig. 12", expected="one or more")


def far_pair(base: Database) -> tuple[int, int]:
    """Return two signs that do not follow one another, farther apart than most pairs."""
    count = len(base.tokens)
    everything = base.candidates(range(count))
    cost = distances(everything, everything, distance_scale(base))
    cost[np.arange(count), np.arange(count)] = np.inf
    cost[np.arange(count - 1), np.arange(1, count)] = np.inf
    if count == 2 or not np.isfinite(cost).any():
        return 0, 1
    flat = np.flatnonzero(np.isfinite(cost))
    order = flat[np.argsort(cost.ravel()[flat], kind="stable")]
    pick = order[min(len(order) - 1, int(np.ceil(FAR * len(order))) - 1)]
    return int(pick // count), int(pick % count)
