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
from signkin.binning.hit_rate import ChanceLine, HitRate, chance_line, hpfpps
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.io.store import read_recordings
from signkin.recording import Recording
from signkin.seeds import stream
from signkin.settings.sections import EndresChoices, Prior
from signkin.studies.endres2013.posteriors import (
    FITTED_MAP,
    Data,
    Fitted,
    Study,
    chosen,
    rows_of,
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
            rows.append({**told, **_outcomes(corpus, cut, line, fit, workers)})
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
    corpus: Corpus, cut: Sequence[Trajectory], line: ChanceLine | None, settings: FitSettings,
    workers: int,
) -> dict[str, Any]:  # fmt: skip
    orders = settings.orders
    runs = Study(corpus, settings, workers)
    fits = runs.run([Data(t, t.dataset, t.x, None, t.boundaries_s) for t in cut])
    out: dict[str, Any] = {"recordings": len({t.recording for t in cut}), "note": ""}
    frame = _rows(corpus, settings, fits)
    recorded, powerlaw = (frame[frame["dataset"] == name] for name in (RECORDED, POWERLAW))
    for order in (0, 3, 7):
        if order in orders:
            here = recorded[recorded["order"] == order]
            out[f"mean_count_order_{order}"] = here["map_count"].mean()
    posterior = recorded.groupby("order")["order_probability"].mean()
    out["order_peak_recorded"] = int(posterior.idxmax())
    out["probability_3_to_5_recorded"] = float(posterior.reindex([3, 4, 5]).sum())
    if RECOVERED in orders:
        third = recorded[recorded["order"] == RECOVERED]
        out["explained_variance_order_3"] = third["explained_variance"].mean()
        out |= _recovered(corpus, runs, settings, fits)
    if powerlaw.empty:
        return {**out, "note": "no recording has a power-law ground truth"}
    truth = powerlaw.groupby("order")["order_probability"].mean()
    out["order_peak_powerlaw"] = int(truth.idxmax())
    return {**out, **_hits(powerlaw, line)}


def _rows(corpus: Corpus, settings: FitSettings, fits: Sequence[Fitted]) -> pd.DataFrame:
    return pd.DataFrame([row for one in fits for row in rows_of(corpus, settings, one)])


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


def _hits(powerlaw: pd.DataFrame, line: ChanceLine | None) -> dict[str, Any]:
    ratios = {}
    out: dict[str, Any] = {}
    for order, rows in powerlaw.groupby("order"):
        columns = (rows[name] for name in ("hits", "misses", "false_positives", "duration_s"))
        rates = [
            HitRate(int(hits), int(misses), int(false_positives), duration_s)
            for hits, misses, false_positives, duration_s in zip(*columns, strict=True)
        ]
        # Only the ratio itself is wanted here, not its bootstrap.
        ratios[int(order)] = hpfpps(rates, 0, draws=2).value
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


def _recovered(
    corpus: Corpus, runs: Study, settings: FitSettings, fits: Sequence[Fitted]
) -> dict[str, Any]:
    again = [
        item
        for one in fits
        if one.data.dataset == RECORDED
        for item in runs.fitted_data(one, RECOVERED)
        if item.dataset == FITTED_MAP
    ]
    frame = _rows(corpus, settings, runs.run(again))
    same = frame[frame["order"] == RECOVERED]
    return {
        "recovered_probability": same["order_probability"].mean(),
        "recovered_hit_rate": same["hit_rate"].mean(),
    }
