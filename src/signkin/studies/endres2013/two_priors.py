"""Fig. 3 to 7 under two readings of the prior: config.yaml's, and one beside it (3.2).

The other one is `open_choices.endres2013.beside`: as shipped, the data's variances as
the scale matrix V itself, in mm. The same recordings under both.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from signkin import tables
from signkin.binning.hit_rate import group_rates, pooled_hpfpps
from signkin.corpus import Corpus
from signkin.studies.endres2013.posteriors import (
    FITTED,
    FITTED_MAP,
    chosen,
    prior_id,
    study,
)
from signkin.studies.endres2013.settings import ChoiceSettings
from signkin.studies.endres2013.single_signs import POWERLAW, RECORDED, Trajectory
from signkin.studies.endres2013.summaries import rates_by_order

SHIPPED, BESIDE = "as configured", "beside"
FITTED_ORDER = 3  # that of Fig. 3B and C
GROUPS = ((RECORDED, None), (POWERLAW, None), (FITTED, FITTED_ORDER), (FITTED_MAP, FITTED_ORDER))


def two_priors(
    corpus: Corpus, trajectories: Sequence[Trajectory], binning: pd.DataFrame,
    settings: ChoiceSettings, workers: int,
) -> pd.DataFrame:  # fmt: skip
    """Return the table `two_priors`: a row a reading, a group of trajectories and an order.

    trajectories: of all shards. binning: the corpus's table `binning`, under its own prior. At
    most `fitted_recordings` recordings, those that fitted trajectories are made of.
    """
    fit = settings.fit
    picked = set(chosen([e.recording for e in corpus.entries], fit.fitted_recordings))
    own = binning[binning["recording"].isin(picked)]
    other = study(
        corpus,
        [t for t in trajectories if t.recording in picked],
        replace(fit, prior=settings.choices.beside, fitted_orders=(FITTED_ORDER,)),
        workers,
    ).table("binning")
    priors = {SHIPPED: fit.prior, BESIDE: settings.choices.beside}
    rows = [
        {"corpus": corpus.name, "reading": reading, "prior": prior_id(priors[reading]), **row}
        for reading, frame in ((SHIPPED, own), (BESIDE, other))
        for row in _rows(frame)
    ]
    return pd.DataFrame(rows, columns=tables.TABLES["two_priors"].names())


def _rows(binning: pd.DataFrame) -> Iterator[dict[str, Any]]:
    for dataset, true_order in GROUPS:
        here = binning["dataset"] == dataset
        if true_order is not None:
            here &= binning["true_order"] == true_order
        part = binning[here]
        # Recorded boundaries are not known: hits are empty there.
        rates = {} if dataset == RECORDED else rates_by_order(part)
        for order, rows in part.groupby("order"):
            p = rows["order_probability"].to_numpy(dtype=float)
            row: dict[str, Any] = {
                "dataset": dataset,
                "true_order": true_order,
                "order": order,
                "mean_probability": p.mean(),
                "se": p.std(ddof=1) / np.sqrt(len(p)) if len(p) > 1 else None,
                "mean_count": rows["map_count"].mean(),
                "mean_explained_variance": rows["explained_variance"].mean(),
                "median_noise_misfit": rows["noise_misfit"].median(),
                "n": len(p),
            }
            if order in rates:
                mean = group_rates(rates[order])
                ratio = pooled_hpfpps(rates[order])
                row |= {
                    "hit_rate": mean.hit_rate,
                    "hit_rate_se": mean.hit_rate_se,
                    "false_positives_per_s": mean.false_positives_per_s,
                    "false_positives_per_s_se": mean.false_positives_per_s_se,
                    "hpfpps": ratio if np.isfinite(ratio) else None,
                }
            yield row


def told_prior(prior: str) -> str:
    """Return a `prior_id` in words: `nu = L, noise of the sensor, V expected, b = 0.1, bins`."""
    dof, noise, *scale, b, unit = prior.split(" ")
    return (
        f"nu = {dof.removeprefix('dof')}, noise of the {noise}, V {' in '.join(scale)}, "
        f"b = {b.removeprefix('b')}, time in {'bins' if unit == 'bin' else unit}"
    )


def printed_beside(table: pd.DataFrame) -> pd.DataFrame:
    """Return what the paper prints of Fig. 3 to 7 beside both readings: what, where, printed, ...

    table: `two_priors`. One column a reading, each a text; empty where a group is empty.
    """
    found = {reading: dict(_numbers(part)) for reading, part in table.groupby("reading")}
    rows = [
        {
            "what": what,
            "where": where,
            "printed": printed,
            **{reading: found.get(reading, {}).get(what, "") for reading in (SHIPPED, BESIDE)},
        }
        for what, (where, printed) in PRINTED.items()
    ]
    return pd.DataFrame(rows)


# What is printed: what -> (where, value).
PRINTED = {
    "mean M, orders 0, 3, 7": ("3.1", "13, 7 (one example), 2"),
    "explained variance, orders 0, 3": ("Fig. 3D", "> 0.95, > 0.99"),
    "P(S = 3), fitted with order 3: averaged, most probable": ("Fig. 3B", "near 1"),
    "hit rate there": ("Fig. 3C", "near 1"),
    "false positives a second there": ("Fig. 3C", "almost none"),
    "ground truth, order 3: hit rate, false positives a second": ("Fig. 5", "drawn"),
    "ground truth: peak of eq. 17": ("Fig. 6", "3"),
    "ground truth: peak of the order posterior, its P": ("Fig. 6", "3"),
    "recorded: peak of the order posterior, its P": ("Fig. 7", "4"),
    "recorded: P(3 ≤ S ≤ 5)": ("3.3", "> 0.95"),
}


def _numbers(part: pd.DataFrame) -> Iterator[tuple[str, str]]:
    recorded, truth, averaged, probable = (_group(part, name) for name, _ in GROUPS)
    names = list(PRINTED)

    def cells(frames: Sequence[pd.DataFrame], column: str, orders: Sequence[int], to: str) -> str:
        """Return numbers, one an order and frame; empty where one is lacking."""
        values = [f[column].get(order) for f in frames for order in orders]
        known = [format(v, to) for v in values if v is not None and pd.notna(v)]
        return ", ".join(known) if len(known) == len(values) else ""

    yield names[0], cells([recorded], "mean_count", (0, 3, 7), ".1f")
    yield names[1], cells([recorded], "mean_explained_variance", (0, 3), ".4f")
    again = [averaged, probable]
    for name, column in zip(
        names[2:5], ("mean_probability", "hit_rate", "false_positives_per_s"), strict=True
    ):
        yield name, cells(again, column, (FITTED_ORDER,), ".2f")
    hits = [cells([truth], c, (3,), ".2f") for c in ("hit_rate", "false_positives_per_s")]
    yield names[5], ", ".join(hits) if all(hits) else ""
    if truth["hpfpps"].notna().any():
        yield names[6], str(int(truth["hpfpps"].idxmax()))
    for name, frame in ((names[7], truth), (names[8], recorded)):
        if len(frame):
            peak = int(frame["mean_probability"].idxmax())
            yield name, f"{peak}, {frame['mean_probability'][peak]:.2f}"
    yield names[9], f"{recorded['mean_probability'].reindex([3, 4, 5]).sum():.3f}"


def _group(part: pd.DataFrame, dataset: str) -> pd.DataFrame:
    return part[part["dataset"] == dataset].set_index("order")
