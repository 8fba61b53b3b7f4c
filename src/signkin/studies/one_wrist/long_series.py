"""Wrists of continuous recordings as long series: binned with a longest segment."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import tables
from signkin.binning import Posterior, fit_many
from signkin.binning.posterior import CLEARANCE_BINS
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.joints import HANDS
from signkin.recording import Recording
from signkin.stages.ingest import lead
from signkin.stages.wrists import in_bins, ready_wrist
from signkin.studies.endres2013.posteriors import boundary_times, explained_variance, prior_of

Floats = NDArray[np.float64]


@dataclass
class LongSeries:
    """Rows of the tables wrist_posteriors, wrist_boundaries and binning_left_out."""

    posteriors: list[dict[str, Any]] = field(default_factory=list)
    boundaries: list[dict[str, Any]] = field(default_factory=list)
    left_out: list[dict[str, Any]] = field(default_factory=list)

    def table(self, name: str, unit: str) -> pd.DataFrame:
        """Return one of the tables."""
        rows = {
            "wrist_posteriors": self.posteriors,
            "wrist_boundaries": self.boundaries,
            "binning_left_out": self.left_out,
        }[name]
        return pd.DataFrame(rows, columns=tables.TABLES[name].names(unit))


def long_series(
    corpus: Corpus, recordings: Iterable[Recording], settings: Mapping[str, Any], workers: int
) -> LongSeries:
    """Bin both wrists of each recording. settings: the sections `kinematics` and `binning`."""
    out = LongSeries()
    own = settings["binning"]["continuous"]
    order = int(own["order"])
    jobs: list[tuple[str, str, Floats, float]] = []
    for recording in recordings:
        for hand in HANDS:
            start = {**lead(corpus, recording.name), "dataset": f"{hand} wrist"}
            try:
                jobs.append((recording.name, hand, *_wrist_in_bins(recording, hand, settings)))
            except SignkinError as error:
                out.left_out.append({**start, "reason": str(error)})
    for longest, some in _by_longest(jobs, own["longest_segment_s"]).items():
        fits = fit_many(
            [x for _, _, x, _ in some],
            [order],
            [prior_of(settings["binning"]["prior"], corpus.noise_sd, x) for _, _, x, _ in some],
            [bin_s for _, _, _, bin_s in some],
            workers=workers,
            names=[f"recording {name}, {hand} wrist" for name, hand, _, _ in some],
            max_segment_bins=longest,
        )
        for (name, hand, x, bin_s), posterior in zip(some, fits, strict=True):
            _take(out, corpus, name, hand, x, bin_s, posterior, order)
    key = {entry.recording: i for i, entry in enumerate(corpus.entries)}
    for rows in (out.posteriors, out.boundaries):
        rows.sort(key=lambda row: (key[row["recording"]], row["hand"] != HANDS[0]))
    return out


def _wrist_in_bins(
    recording: Recording, hand: str, settings: Mapping[str, Any]
) -> tuple[Floats, float]:
    wrist = ready_wrist(
        recording,
        hand,
        settings["kinematics"]["longest_gap_s"],
        settings["binning"]["lowpass"],
    )
    own, frames, rate = settings["binning"]["continuous"], len(wrist.path), wrist.rate_hz
    bins = min(frames, round((frames - 1) / rate / own["bin_s"]))
    if bins <= own["order"]:
        raise SignkinError(
            f"{bins} bins",
            file=f"recording {recording.name}",
            expected=f"more than the order, {own['order']}",
        )
    x, bin_s = in_bins(wrist.path, rate, bins)
    return x - x.mean(axis=0), bin_s


def _by_longest(
    jobs: Sequence[tuple[str, str, Floats, float]], longest_s: float
) -> dict[int, list[tuple[str, str, Floats, float]]]:
    out: dict[int, list[tuple[str, str, Floats, float]]] = {}
    for job in jobs:
        out.setdefault(max(2, round(longest_s / job[3])), []).append(job)
    return out


def _take(
    out: LongSeries, corpus: Corpus, name: str, hand: str, x: Floats, bin_s: float,
    posterior: Posterior, order: int,
) -> None:  # fmt: skip
    start = {**lead(corpus, name), "hand": hand}
    ends = posterior.boundaries(order)
    probability = posterior.boundary_probability(order)
    found = len(ends)
    out.posteriors.append(
        {
            **start,
            "n_bins": len(x),
            "bin_s": bin_s,
            "order": order,
            "map_count": posterior.map_count(order),
            "boundaries_per_s": found / (len(x) * bin_s),
            "cut_mass": posterior.cut_mass[0],
            "explained_variance": explained_variance(x, posterior.expected_trajectory(order)),
            "note": ""
            if found == posterior.map_count(order)
            else f"only {found} local maxima of the boundary posterior",
        }
    )
    for end, time in zip(ends, boundary_times(ends, bin_s), strict=True):
        near = probability[max(0, end - CLEARANCE_BINS) : end + CLEARANCE_BINS + 1]
        out.boundaries.append(
            {**start, "boundary_s": time, "probability": min(1.0, float(near.sum()))}
        )
