"""What the paper does not print, varied: the prior and the number of bins.

Every combination of degrees of freedom, noise and scale, concentration, time unit
and bins in config.yaml, on some recordings of a corpus. The data's variances as V
itself (`literal`) come with degrees of freedom and units of length of their own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from signkin import tables
from signkin.binning.hit_rate import ChanceLine, HitRate, chance_line, hit_rate, pooled_hpfpps
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.io.store import read_recordings
from signkin.recording import Recording
from signkin.seeds import stream
from signkin.settings.sections import EndresChoices, Prior
from signkin.studies.endres2013.posteriors import (
    Data,
    Fitted,
    Study,
    chosen,
    explained_variance,
    scale_id,
)
from signkin.studies.endres2013.settings import ChoiceSettings, FitSettings
from signkin.studies.endres2013.single_signs import (
    POWERLAW,
    RECORDED,
    Trajectory,
    single_signs,
)
from signkin.studies.endres2013.summaries import RATES_PER_S

# Section 3.2 prints B = 0.1 I, the data's variances and T = 100; neither degrees of freedom,
# nor what the variances scale, nor the unit of time.
PRINTED = {"concentration": 0.1, "bins": 100}
RECOVERED = 3
CHANCE_DRAWS = 400


def chosen_recordings(
    paths: Iterable[str | Path], truth: pd.DataFrame, most: int
) -> list[Recording]:
    """Return the recordings to be run: of those with a ground truth at most so many, spread evenly.

    paths: the recordings of all shards. truth: the table `ground_truth`.
    """
    names = chosen(list(dict.fromkeys(truth["recording"])), most)
    return [one for path in paths for one in read_recordings(Path(path), names)]


def order_choices(
    corpus: Corpus, recordings: Sequence[Recording], settings: ChoiceSettings, seed: int,
    workers: int,
) -> pd.DataFrame:  # fmt: skip
    """Return the table `order_choices` of the recordings."""
    if not recordings:
        raise SignkinError(
            "no recording has a power-law ground truth",
            file=corpus.folder,
            expected="one or more; results/endres2013/<corpus>/left_out.csv tells why not",
        )
    grid = settings.choices
    rows = []
    for bins in grid.bins:
        cut = single_signs(corpus, recordings, replace(settings.cut, bins=bins), seed).trajectories
        line = _chance(corpus, cut, settings.fit.hit_window_s, bins, seed)
        given = [Data(t, t.dataset, t.x, None, t.boundaries_s) for t in cut]
        for prior in priors(grid, corpus.unit):
            told = {
                "corpus": corpus.name,
                "dof": "L" if prior.dof is None else f"{prior.dof:g}",
                "noise": f"{prior.noise} {scale_id(prior)}",
                "concentration": prior.concentration,
                "time_unit": prior.time_unit,
                "bins": bins,
                "printed": _yes(prior.noise == "data" and _printed(prior.concentration, bins)),
                "default": _yes(prior == settings.fit.prior and bins == settings.cut.bins),
            }
            fit = replace(settings.fit, prior=prior, orders=grid.orders)
            rows.append({**told, **_outcomes(corpus, given, line, fit, workers)})
    return pd.DataFrame(rows, columns=tables.TABLES["order_choices"].names(corpus.unit))


def priors(grid: EndresChoices, unit: str) -> Iterator[Prior]:
    """Yield the priors of the grid; those in a unit of length for positions in metres alone."""
    readings: list[tuple[float | None, dict[str, Any]]] = [
        (dof, dict(zip(("noise", "scale"), noise.split(), strict=True)))
        for dof, noise in product(grid.dof, grid.noise)
    ]
    if unit == "m":
        readings += [
            (dof, {"noise": "data", "scale": "literal", "length_unit": length})
            for dof, length in product(grid.literal_dof, grid.literal_unit)
        ]
    for (dof, reading), concentration, time in product(
        readings, grid.concentration, grid.time_unit
    ):
        told = {**reading, "dof": dof, "concentration": concentration, "time_unit": time}
        yield Prior.model_validate(told)


def _yes(value: bool) -> str:
    return "yes" if value else "no"


def _printed(concentration: float, bins: int) -> bool:
    return {"concentration": concentration, "bins": bins} == PRINTED


def _outcomes(
    corpus: Corpus, given: Sequence[Data], line: ChanceLine | None, settings: FitSettings,
    workers: int,
) -> dict[str, Any]:  # fmt: skip
    orders = settings.orders
    runs = Study(corpus, settings, workers, every_count=False)
    # Expectations are worked out where something rests on them: a third of a fit's time.
    wanted = (RECOVERED,) if RECOVERED in orders else False
    fits = runs.run([one for one in given if one.dataset == RECORDED], wanted)
    truths = runs.run([one for one in given if one.dataset == POWERLAW], False)
    out: dict[str, Any] = {"recordings": len({one.source.recording for one in given}), "note": ""}
    for order in (0, 3, 7):
        if order in orders:
            counts = pd.Series([one.posterior.map_count(order) for one in fits])
            out[f"mean_count_order_{order}"] = counts.mean()
    posterior = _mean_probability(fits)
    out["order_peak_recorded"] = int(posterior.idxmax())
    out["probability_3_to_5_recorded"] = float(posterior.reindex([3, 4, 5]).sum())
    if RECOVERED in orders:
        explained = [
            explained_variance(one.data.centred, one.posterior.expected_trajectory(RECOVERED))
            for one in fits
        ]
        out["explained_variance_order_3"] = pd.Series(explained).mean()
        out |= _recovered(runs, settings, fits)
    if not truths:
        return {**out, "note": "no recording has a power-law ground truth"}
    out["order_peak_powerlaw"] = int(_mean_probability(truths).idxmax())
    return {**out, **_hits(truths, settings, line)}


def _mean_probability(fits: Sequence[Fitted]) -> pd.Series:
    """Return the mean probability of each order."""
    probability = np.mean([one.posterior.order_probability for one in fits], axis=0)
    return pd.Series(probability, index=list(fits[0].posterior.orders)).sort_index()


def _rate(one: Fitted, order: int, settings: FitSettings) -> HitRate:
    return hit_rate(
        one.boundaries_s(order), one.data.truth_s, settings.hit_window_s,
        duration_s=one.data.source.duration_s,
    )  # fmt: skip


def _chance(
    corpus: Corpus, cut: Sequence[Trajectory], window_s: float, bins: int, seed: int
) -> ChanceLine | None:
    """Return the line of no discrimination on the ground truth, whatever the prior; None: none."""
    known = [t for t in cut if t.dataset == POWERLAW]
    if not any(len(t.boundaries_s) for t in known):
        return None
    rng = stream(seed, corpus.name, "sensitivity", str(bins))
    return chance_line(
        [t.boundaries_s for t in known], [t.duration_s for t in known], rng, RATES_PER_S,
        window_s, CHANCE_DRAWS,
    )  # fmt: skip


def _hits(
    truths: Sequence[Fitted], settings: FitSettings, line: ChanceLine | None
) -> dict[str, Any]:
    ratios = {}
    out: dict[str, Any] = {}
    for order in sorted(settings.orders):
        rates = [_rate(one, order, settings) for one in truths]
        ratios[order] = pooled_hpfpps(rates)
        if order == RECOVERED:
            out["hit_rate_order_3"] = float(np.nanmean([r.hit_rate for r in rates]))
            out["false_positives_per_s_order_3"] = float(
                np.mean([r.false_positives_per_s for r in rates])
            )
    false = out.get("false_positives_per_s_order_3")
    if line is not None and false is not None and false <= line.false_positives_per_s[-1]:
        high = np.interp(false, line.false_positives_per_s, line.hit_rate_high)
        out["chance_high_order_3"] = float(high)
    known = {order: value for order, value in ratios.items() if not np.isnan(value)}
    best = max(known.values(), default=float("nan"))
    out["hpfpps_peak"] = " ".join(str(o) for o, value in known.items() if value == best)
    at_three = ratios.get(RECOVERED, float("nan"))
    out["hpfpps_order_3"] = at_three if np.isfinite(at_three) else None
    if RECOVERED in ratios and not np.isfinite(at_three):
        out["note"] = "order 3 has no false positive" if at_three > 0 else "order 3 finds nothing"
    return out


def _recovered(runs: Study, settings: FitSettings, fits: Sequence[Fitted]) -> dict[str, Any]:
    at = settings.orders.index(RECOVERED)
    again = runs.run([runs.fitted_map_data(one, RECOVERED) for one in fits], False)
    probabilities = [one.posterior.order_probability[at] for one in again]
    rates = [_rate(one, RECOVERED, settings).hit_rate for one in again]
    return {
        "recovered_probability": pd.Series(probabilities).mean(),
        "recovered_hit_rate": pd.Series(rates).mean(),
    }
