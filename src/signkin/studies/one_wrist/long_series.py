"""Wrists of continuous recordings as long series: binned with a longest segment."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import tables
from signkin.binning import Posterior, fit_many
from signkin.binning.maxima import CLEARANCE_BINS
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.joints import HANDS
from signkin.recording import Recording
from signkin.stages.ingest import lead
from signkin.stages.wrists import in_bins, ready_wrist, sample_at
from signkin.studies.endres2013.posteriors import explained_variance, prior_of
from signkin.studies.one_wrist.settings import SeriesSettings

Floats = NDArray[np.float64]
Job = tuple[str, str, Floats, float, float]  # of wrist_in_bins, by recording and hand


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
    corpus: Corpus, recordings: Iterable[Recording], settings: SeriesSettings, workers: int
) -> LongSeries:
    """Bin both wrists of each recording."""
    out = LongSeries()
    order = settings.continuous.order
    jobs: list[Job] = []
    for recording in recordings:
        for hand in HANDS:
            start = {**lead(corpus, recording.name), "dataset": f"{hand} wrist"}
            try:
                jobs.append((recording.name, hand, *wrist_in_bins(recording, hand, settings)))
            except SignkinError as error:
                out.left_out.append({**start, "reason": str(error)})
    for longest, some in _by_longest(jobs, settings.continuous.longest_segment_s).items():
        fits = fit_many(
            [x for _, _, x, _, _ in some],
            [order],
            [prior_of(settings.prior, corpus.noise_sd, x, corpus.unit) for _, _, x, _, _ in some],
            [bin_s for _, _, _, bin_s, _ in some],
            workers=workers,
            names=[f"recording {name}, {hand} wrist" for name, hand, _, _, _ in some],
            sample_at=[at for _, _, _, _, at in some],
            max_segment_bins=longest,
        )
        for (name, hand, x, bin_s, _), posterior in zip(some, fits, strict=True):
            _take(out, corpus, name, hand, x, bin_s, posterior, order)
    key = {entry.recording: i for i, entry in enumerate(corpus.entries)}
    for rows in (out.posteriors, out.boundaries):
        rows.sort(key=lambda row: (key[row["recording"]], row["hand"] != HANDS[0]))
    return out


def wrist_in_bins(
    recording: Recording, hand: str, settings: SeriesSettings
) -> tuple[Floats, float, float]:
    """Return positions, the duration of a bin, and where in its bin a position is."""
    wrist = ready_wrist(recording, hand, settings.longest_gap_s, settings.lowpass)
    frames, rate, order = len(wrist.path), wrist.rate_hz, settings.continuous.order
    bins = min(frames, round((frames - 1) / rate / settings.continuous.bin_s))
    if bins <= order:
        raise SignkinError(
            f"{bins} bins",
            file=f"recording {recording.name}",
            expected=f"more than the order, {order}",
        )
    x, bin_s = in_bins(wrist.path, rate, bins)
    return x - x.mean(axis=0), bin_s, sample_at(frames, bins)


def longest_in_bins(longest_s: float, bin_s: float) -> int:
    """Return the longest segment in bins, at least 2."""
    return max(2, round(longest_s / bin_s))


def _by_longest(jobs: Sequence[Job], longest_s: float) -> dict[int, list[Job]]:
    out: dict[int, list[Job]] = {}
    for job in jobs:
        out.setdefault(longest_in_bins(longest_s, job[3]), []).append(job)
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
            "noise_misfit": posterior.noise_misfit(order),
            "at_floor": "yes" if posterior.at_floor(order) else "no",
            "note": _note(posterior, order, found),
        }
    )
    for end, time in zip(ends, posterior.times_s(ends), strict=True):
        near = probability[max(0, end - CLEARANCE_BINS) : end + CLEARANCE_BINS + 1]
        out.boundaries.append(
            {**start, "boundary_s": time, "probability": min(1.0, float(near.sum()))}
        )


def _note(posterior: Posterior, order: int, found: int) -> str:
    few = found < posterior.map_count(order)
    told = f"only {found} local maxima of the boundary posterior" if few else ""
    return "; ".join(note for note in (told, posterior.doubts(order)) if note)
