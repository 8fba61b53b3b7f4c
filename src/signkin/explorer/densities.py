"""Where binning sees boundaries in a continuous recording: a density over time for each order.

The tables of a run have one order's boundaries; a page shows those of all orders, which are worked
out here for the recordings that have a page.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from signkin.binning import fit
from signkin.corpus import Corpus
from signkin.explorer.packing import packed
from signkin.recording import Recording
from signkin.settings import Settings
from signkin.studies.endres2013.posteriors import prior_of
from signkin.studies.one_wrist.long_series import longest_in_bins, wrist_in_bins
from signkin.studies.one_wrist.settings import SeriesSettings

MOST_BINS = 60_000  # for all orders: 20 minutes of 20 ms; what is longer has one
STEP = 1 / 250  # of a probability


@dataclass(frozen=True)
class DensitySettings:
    """What densities depend on: how long series are made, and the orders."""

    series: SeriesSettings
    orders: tuple[int, ...]

    @classmethod
    def of(cls, settings: Settings) -> DensitySettings:
        """Return those of a run; the order of long series is among them."""
        orders = {*settings.binning.orders, settings.binning.continuous.order}
        return cls(SeriesSettings.of(settings), tuple(sorted(orders)))


def series_densities(
    corpus: Corpus, recording: Recording, hands: Iterable[str], settings: DensitySettings
) -> list[dict[str, Any]]:
    """Return the posterior of boundaries of a continuous recording, by hand and order.

    hands: those whose wrist binning could use. Each density has the probability that a segment
    ends with a bin, (T - 1,), packed; the posterior of its order among those worked out; and the
    boundaries found, in ms, each as its distance from the one before.
    """
    out: list[dict[str, Any]] = []
    for hand in hands:
        x, bin_s, at = wrist_in_bins(recording, hand, settings.series)
        own = settings.series.continuous
        orders = settings.orders if len(x) <= MOST_BINS else (own.order,)
        posterior = fit(
            x, [order for order in orders if order < len(x)],
            prior_of(settings.series.prior, corpus.noise_sd, x, corpus.unit), bin_s, sample_at=at,
            max_segment_bins=longest_in_bins(own.longest_segment_s, bin_s), expectations=False,
            name=f"recording {recording.name}, {hand} wrist",
        )  # fmt: skip
        for order, share in zip(posterior.orders, posterior.order_probability, strict=True):
            values = posterior.boundary_probability(order)
            out.append(
                {
                    "hand": hand,
                    "order": order,
                    "probability": float(f"{share:.4g}"),
                    "first": float(f"{posterior.times_s([0])[0]:.9g}"),
                    "bin": bin_s,
                    "times": in_ms(posterior.boundaries_s(order)),
                    "values": packed(values.reshape(-1, 1), STEP),
                }
            )
    return out


def in_ms(times_s: Any) -> list[int]:
    """Return times in whole ms, each as its distance from the one before."""
    return np.diff(np.rint(1000 * np.asarray(times_s, dtype=float)), prepend=0).astype(int).tolist()
