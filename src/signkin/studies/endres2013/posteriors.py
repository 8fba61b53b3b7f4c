"""Bayesian binning of single signs: order posteriors, fitted trajectories, hit rates.

Endres et al. 2013, section 3: the recorded trajectories, their power-law ground
truth, and trajectories fitted with each order, taken as data again. Fitted ones
are of two kinds: the paper's, averaged over segmentations, and `fitted_map`, which
is exactly piecewise polynomial, from the most probable segmentation.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from signkin import tables
from signkin.binning import Posterior, Prior, fit_many
from signkin.binning.hit_rate import hit_rate
from signkin.binning.shifted import shifted_hits
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.settings.sections import Prior as PriorSettings
from signkin.stages.ingest import lead
from signkin.studies.endres2013.settings import FitSettings
from signkin.studies.endres2013.single_signs import POWERLAW, RECORDED, Trajectory

Floats = NDArray[np.float64]

METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
FITTED, FITTED_MAP = "fitted", "fitted_map"


def prior_of(settings: PriorSettings, noise_sd: float, x: Floats, unit: str = "m") -> Prior:
    """Return the prior that config.yaml describes, for one trajectory (section 3.2).

    noise_sd: of the corpus's sensor. x: (T, L). unit: the corpus's unit, of both. `noise: data` is
    the printed reading: the data's own variances, one a dimension. Raises SignkinError for a
    prior in mm, cm or m where positions are no lengths.
    """
    noise: float | tuple[float, ...] = noise_sd
    if settings.noise == "data":
        noise = tuple(float(sd) for sd in x.std(axis=0, ddof=1))
    return Prior(
        noise_sd=noise,
        dof=settings.dof,
        concentration=settings.concentration,
        time_unit=settings.time_unit,
        scale=settings.scale,
        length_unit=_length_unit(settings, unit),
    )


def _length_unit(settings: PriorSettings, unit: str) -> float | None:
    if settings.length_unit is None:
        return None
    if unit != "m":
        raise SignkinError(
            f"a prior in {settings.length_unit}, and positions are in {unit}",
            place="key binning.prior.length_unit",
            expected="a corpus in metres, or a scale without a unit of length",
        )
    return METRES[settings.length_unit]


def prior_id(settings: PriorSettings, noise_share: float = 1.0) -> str:
    """Return a name for the prior: `dof3 sensor expected b0.1 bin`."""
    noise = settings.noise if noise_share == 1.0 else f"{noise_share:g}x{settings.noise}"
    dof = "L" if settings.dof is None else f"{settings.dof:g}"
    b, time = settings.concentration, settings.time_unit
    return f"dof{dof} {noise} {scale_id(settings)} b{b:g} {time}"


def scale_id(settings: PriorSettings) -> str:
    """Return the reading of V, with its unit of length where it has one: `literal mm`."""
    unit = settings.length_unit
    return settings.scale if unit is None else f"{settings.scale} {unit}"


@dataclass(frozen=True, eq=False)
class Data:
    """A trajectory to be binned, where it comes from, and its known boundaries in s, if any.

    true_order: order of the polynomials that a fitted trajectory was made with.
    noise_share: the prior's noise over the sensor's.
    """

    source: Trajectory
    dataset: str
    x: Floats
    true_order: int | None
    truth_s: Floats
    noise_share: float = 1.0

    @cached_property
    def centred(self) -> Floats:
        """The positions around their mean, (T, L): the same under each of many priors."""
        return self.x - self.x.mean(axis=0)

    @cached_property
    def gaps(self) -> int:
        """How many bins have no position."""
        return int((~np.isfinite(self.x)).any(axis=1).sum())

    @cached_property
    def moves(self) -> bool:
        """Whether bins differ."""
        return bool((self.centred.std(axis=0) > 0).any())


@dataclass(frozen=True, eq=False)
class Fitted:
    """A trajectory with its posterior."""

    data: Data
    posterior: Posterior
    _told: dict[int, Mapping[str, Any]] = field(default_factory=dict, init=False, repr=False)

    def boundaries_s(self, order: int) -> Floats:
        """Return the M_opt boundaries of an order, in s from the start."""
        return self.posterior.boundaries_s(order)

    def told(self, order: int) -> Mapping[str, Any]:
        """Return what is told of an order whatever the window of hits; worked out once."""
        if order not in self._told:
            posterior, misfit = self.posterior, self.posterior.noise_misfit(order)
            expected = posterior.expected_trajectory(order)
            self._told[order] = {
                "boundaries_s": self.boundaries_s(order),
                "expected_count": float(posterior.boundary_probability(order).sum()),
                "explained_variance": explained_variance(self.data.centred, expected),
                "noise_misfit": misfit,
                "doubts": posterior.doubts(order, misfit),
            }
        return self._told[order]


def chosen(names: Sequence[str], most: int) -> list[str]:
    """Return at most so many of the names, evenly spread over the list."""
    if len(names) <= most:
        return list(names)
    places = np.linspace(0, len(names) - 1, most).round().astype(int)
    return [names[i] for i in places]


class Study:
    """The runs of one corpus: a trajectory in, its posterior out, with the settings of a run."""

    def __init__(
        self, corpus: Corpus, settings: FitSettings, workers: int = 1, every_count: bool = True
    ) -> None:
        """Take a corpus and the settings of a run. every_count: as for `fit`."""
        self.corpus = corpus
        self.settings = settings
        self.orders = settings.orders
        self.workers = workers
        self.every_count = every_count
        self.left_out: list[dict[str, Any]] = []

    def run(self, items: Sequence[Data], expectations: bool | Sequence[int] = True) -> list[Fitted]:
        """Bin the trajectories; those that cannot be are left out and listed.

        expectations: as for `fit`.
        """
        usable: list[tuple[Data, Floats, Prior]] = []
        for item in items:
            try:
                usable.append((item, *self._ready(item)))
            except SignkinError as error:
                self.left_out.append(
                    {
                        **lead(self.corpus, item.source.recording),
                        "dataset": item.dataset,
                        "reason": str(error),
                    }
                )
        found = fit_many(
            [x for _, x, _ in usable],
            self.orders,
            [prior for _, _, prior in usable],
            [item.source.bin_s for item, _, _ in usable],
            workers=self.workers,
            names=[f"recording {item.source.recording}" for item, _, _ in usable],
            sample_at=[item.source.sample_at for item, _, _ in usable],
            expectations=expectations,
            every_count=self.every_count,
        )
        return [Fitted(item, one) for (item, _, _), one in zip(usable, found, strict=True)]

    def _ready(self, item: Data) -> tuple[Floats, Prior]:
        where = f"recording {item.source.recording}"
        if item.gaps:
            raise SignkinError(f"{item.gaps} bins without a position", file=where, expected="none")
        x = item.centred
        if not item.moves:
            raise SignkinError("all bins are equal", file=where, expected="a movement")
        if len(x) <= max(self.orders):
            raise SignkinError(
                f"{len(x)} bins",
                file=where,
                expected=f"more than the highest order, {max(self.orders)}",
            )
        prior = prior_of(self.settings.prior, self.corpus.noise_sd, x, self.corpus.unit)
        return x, prior.with_noise(item.noise_share)

    def fitted_data(self, fitted: Fitted, order: int) -> Iterator[Data]:
        """Yield both kinds of trajectory that the fit of an order makes, to be binned as data."""
        mean = fitted.posterior.expected_trajectory(order)
        truth_s = fitted.boundaries_s(order)
        yield Data(fitted.data.source, FITTED, mean, order, truth_s, self._share())
        yield self.fitted_map_data(fitted, order)

    def fitted_map_data(self, fitted: Fitted, order: int) -> Data:
        """Return the one from the most probable segmentation, exactly piecewise polynomial."""
        posterior = fitted.posterior
        ends = posterior.map_segmentation(order)
        exact = posterior.map_trajectory(order, ends=ends)
        return Data(
            fitted.data.source, FITTED_MAP, exact, order, posterior.times_s(ends), self._share()
        )

    def _share(self) -> float:
        # The data's variances are the fitted trajectory's own: nothing of a sensor's in them.
        return 1.0 if self.settings.prior.noise == "data" else self.settings.recovery_noise


def rows_of(corpus: Corpus, settings: FitSettings, fitted: Fitted) -> Iterator[dict[str, Any]]:
    """Yield the rows of binning.csv for one trajectory, one an order."""
    data, posterior = fitted.data, fitted.posterior
    source = data.source
    start = lead(corpus, source.recording)
    entry = corpus.by_name[source.recording]
    known = data.dataset != RECORDED
    prior = prior_id(settings.prior, data.noise_share)
    for i, order in enumerate(posterior.orders):
        told = fitted.told(order)
        row: dict[str, Any] = {
            **start,
            "sign": entry.sign,
            "repetition": entry.repetition,
            "dataset": data.dataset,
            "true_order": data.true_order,
            "prior_id": prior,
            "n_bins": len(data.x),
            "duration_s": source.duration_s,
            "order": order,
            "log_evidence": posterior.log_evidence[i],
            "order_probability": posterior.order_probability[i],
            "map_count": posterior.map_count(order),
            "expected_count": told["expected_count"],
            "cut_mass": posterior.cut_mass[i],
            "explained_variance": told["explained_variance"],
            "noise_misfit": told["noise_misfit"],
            "at_floor": "yes" if posterior.at_floor(order) else "no",
        }
        doubts = told["doubts"]
        if not known:
            yield {**row, "note": _joined("boundaries of recorded movements are not known", doubts)}
            continue
        found, window = told["boundaries_s"], settings.hit_window_s
        rate = hit_rate(found, data.truth_s, window, duration_s=source.duration_s)
        chance = shifted_hits(found, data.truth_s, window, duration_s=source.duration_s)
        hpfpps = rate.hpfpps
        yield {
            **row,
            "hits": rate.hits,
            "misses": rate.misses,
            "false_positives": rate.false_positives,
            "hit_rate": rate.hit_rate,
            "false_positives_per_s": rate.false_positives_per_s,
            "hpfpps": hpfpps if np.isfinite(hpfpps) else None,
            "shifted_hits": chance.mean,
            "shifted_sd": chance.sd,
            "note": _joined(
                rate.note or ("" if np.isfinite(hpfpps) else _why_no_ratio(rate.hits)), doubts
            ),
        }


def _joined(*notes: str) -> str:
    return "; ".join(note for note in notes if note)


def _why_no_ratio(hits: int) -> str:
    return "no false positive" if hits else "neither hit nor false positive"


def explained_variance(x: Floats, fitted: Floats) -> float:
    """Return 1 - residual over total sum of squares (Fig. 3D)."""
    total = float(np.sum((x - x.mean(axis=0)) ** 2))
    return 1 - float(np.sum((x - fitted) ** 2)) / total


@dataclass(frozen=True, eq=False)
class Found:
    """What a shard gave: fits of recorded and power-law trajectories, and rows of tables."""

    fits: list[Fitted]
    rows: Mapping[str, list[dict[str, Any]]]

    def table(self, name: str) -> pd.DataFrame:
        """Return one of the tables binning, fitted_truths, binning_left_out."""
        return pd.DataFrame(self.rows[name], columns=tables.TABLES[name].names())


def study(
    corpus: Corpus, trajectories: Sequence[Trajectory], settings: FitSettings, workers: int
) -> Found:
    """Bin a shard's trajectories, and the trajectories fitted to some of the recorded ones.

    Of all recordings of the corpus at most `fitted_recordings` are fitted and binned again.
    """
    runs = Study(corpus, settings, workers)
    none = np.empty(0)
    given = [
        Data(t, t.dataset, t.x, None, t.boundaries_s if t.dataset == POWERLAW else none)
        for t in trajectories
    ]
    fits = runs.run(given)
    picked = set(chosen([e.recording for e in corpus.entries], settings.fitted_recordings))
    again = [
        item
        for one in fits
        if one.data.dataset == RECORDED and one.data.source.recording in picked
        for order in settings.fitted_orders
        for item in runs.fitted_data(one, order)
    ]
    rows = [row for one in (*fits, *runs.run(again)) for row in rows_of(corpus, settings, one)]
    truths = [
        {
            **lead(corpus, item.source.recording),
            "dataset": item.dataset,
            "true_order": item.true_order,
            "boundary_s": time,
        }
        for item in again
        for time in item.truth_s
    ]
    return Found(
        fits, {"binning": rows, "fitted_truths": truths, "binning_left_out": runs.left_out}
    )


# --- per-trajectory results ------------------------------------------------------------------


def write_posteriors(path: str | Path, fits: Sequence[Fitted]) -> None:
    """Write what binning says of each trajectory to Parquet, one row a trajectory and order.

    Lists: log_evidence_by_count (M = 0, 1, ...), boundary_probability (T - 1), boundaries_s,
    noise_covariance (L x L, row by row), expected (T x L, row by row, in the corpus's unit and
    around the trajectory's mean, which is `centre`).
    """
    rows = [(one, i, order) for one in fits for i, order in enumerate(one.posterior.orders)]

    def column(values: Any, kind: pa.DataType) -> pa.Array:
        return pa.array([values(*row) for row in rows], kind)

    wide, narrow = pa.list_(pa.float64()), pa.list_(pa.float32())
    table = pa.table(
        {
            "recording": column(lambda f, i, o: f.data.source.recording, pa.string()),
            "hand": column(lambda f, i, o: f.data.source.hand, pa.string()),
            "dataset": column(lambda f, i, o: f.data.dataset, pa.string()),
            "order": column(lambda f, i, o: o, pa.int32()),
            "bin_s": column(lambda f, i, o: f.data.source.bin_s, pa.float64()),
            "sample_at": column(lambda f, i, o: f.data.source.sample_at, pa.float64()),
            "log_evidence": column(lambda f, i, o: f.posterior.log_evidence[i], pa.float64()),
            "order_probability": column(
                lambda f, i, o: f.posterior.order_probability[i], pa.float64()
            ),
            "map_count": column(lambda f, i, o: f.posterior.map_count(o), pa.int32()),
            "boundaries_s": column(lambda f, i, o: f.boundaries_s(o), wide),
            "true_boundaries_s": column(lambda f, i, o: f.data.truth_s, wide),
            "log_evidence_by_count": column(
                lambda f, i, o: f.posterior.log_evidence_by_count[i], wide
            ),
            "boundary_probability": column(
                lambda f, i, o: f.posterior.boundary_probability(o).astype(np.float32), narrow
            ),
            "noise_covariance": column(
                lambda f, i, o: f.posterior.noise_covariance(o).ravel(), wide
            ),
            "expected": column(
                lambda f, i, o: f.posterior.expected_trajectory(o).astype(np.float32).ravel(),
                narrow,
            ),
            "centre": column(lambda f, i, o: f.data.x.mean(axis=0), wide),
        }
    )
    pq.write_table(table, path, compression="zstd")


def read_posteriors(paths: Iterable[str | Path], recording: str) -> pd.DataFrame:
    """Return the rows of one recording, the lists as arrays."""
    parts = [
        pq.read_table(path, filters=[("recording", "=", recording)]).to_pandas() for path in paths
    ]
    return pd.concat(parts, ignore_index=True)
