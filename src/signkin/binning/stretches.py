"""A very long series, stretch by stretch: all its segmentations, in memory that does not grow.

Of a series of hours the evidence of all segments, and sums over them for each number of segments,
fill gigabytes. Neither is needed at once. The prior of a segmentation (eq. 7, 8) depends on its
number of segments alone. Where each segment pays a price, and their number has no other say, sums
over segmentations go from bin to bin and look back no further than the longest segment does: so the
series is gone through in stretches, from the first to the last and back, and the evidence of their
segments is worked out each time. With the sums goes the characteristic function of the number of
segments at some angles (prices.py): from it the number is told at the end, and the prior's say on
it put in the place of the price (price_counts.py), for the number as for each probability.

So no segmentation is cut where stretches meet, the result is that of the whole series to rounding,
and how long stretches are changes its last digits alone. What is cut are numbers of segments
that are all but impossible; `cut_mass` bounds their share. Against the series as a whole
(all_counts.in_band), with 3,000 and 30,000 bins, probabilities of boundaries differ by 2e-11 at
orders 0 and 3, and by 6e-8 at order 7, where 12 % of the variance of the number of segments is the
prior's. Log evidences differ by 1e-6 at most: above 10,000 bins the ways to cut the series are
counted by the saddle point. Most probable segmentations are not looked for here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from signkin.binning.all_counts import Found
from signkin.binning.evidence import ROOM, Engine
from signkin.binning.lanes import WIDTH
from signkin.binning.price_counts import (
    GROUPS,
    Counts,
    Wanted,
    counts_at_price,
    likely_price,
    search_prices,
)
from signkin.binning.prices import segments_to_end, sums_to_bins
from signkin.binning.prior import Prior

Floats = NDArray[np.float64]

STRETCH_BINS = 4096
SAMPLED = 8  # stretches in which the price is looked for
SEARCHES = 4  # each with as many prices, closer together
SEARCH_PRICES = 16
PASSES = 4  # over the whole series at most, until the price suits it


@dataclass(frozen=True)
class Stretches:
    """A series (T, L) in stretches, from bin edges[b] up to edges[b + 1].

    Each is longer than the longest segment. per_bin: (n_orders,), what is taken off the evidence of
    a segment for each of its bins, so that sums stay small and keep their digits: all
    segmentations have the same number of bins.
    """

    x: Floats
    prior: Prior
    longest: int
    n_orders: int
    dt_s: float | None
    edges: tuple[int, ...]
    per_bin: Floats

    @classmethod
    def of(
        cls, x: Floats, prior: Prior, longest: int, n_orders: int, dt_s: float | None,
        stretch_bins: int = STRETCH_BINS,
    ) -> Stretches:  # fmt: skip
        """Cut a series into stretches of about so many bins."""
        bins = len(x)
        if prior.time_unit == "trajectory":  # of the whole one
            prior, dt_s = replace(prior, time_unit="second"), prior.step(bins, dt_s)
        parts = max(1, bins // max(stretch_bins, longest + 1))
        edges = tuple(bins * i // parts for i in range(parts + 1))
        return cls(x, prior, longest, n_orders, dt_s, edges, np.zeros(n_orders))

    @property
    def parts(self) -> list[tuple[int, int]]:
        """Return the first bin of each stretch, and the first behind it."""
        return list(pairwise(self.edges))

    def engine(self, first: int, last: int) -> Engine:
        """Return the kernels for the segments within bins first..last - 1."""
        return Engine(self.x[first:last], self.prior, self.longest, self.n_orders, self.dt_s)

    def evidence(self, first: int, last: int, orders: tuple[int, ...]) -> Floats:
        """Return what counts of the segments within those bins, (n_orders, last - first, W)."""
        out = self.engine(first, last).by_order()
        for order in orders:
            out[order] -= self.per_bin[order] * np.arange(1, self.longest + 1)
        return out


@dataclass(frozen=True, eq=False)
class InStretches:
    """What is found of the wanted orders, and expected trajectories and noise of some of them."""

    found: Found
    mean: Floats
    noise: Floats


@dataclass(frozen=True, eq=False)
class _Behind:
    """Sums behind a stretch, by order. logs: those of the whole so far, (8,), of its price.

    sums: (longest, 8) of the last bins, in units of the last. waves: (longest + 1, 2, GROUPS, 8).
    """

    logs: NDArray[np.longdouble]
    sums: Floats
    waves: Floats


def in_stretches(
    series: Stretches, orders: tuple[int, ...], expected: tuple[int, ...]
) -> InStretches:
    """Return what `all_counts.in_band` finds of the whole series, but for single segments."""
    bins, longest = len(series.x), series.longest
    series, wanted = _looked_for(series, orders)
    for left in range(PASSES - 1, -1, -1):
        behind = _forward(series, orders, wanted)
        counts: list[Counts] = []
        for of_it, last in zip(wanted, behind[-1], strict=True):
            wave = last.waves[-1, 0] + 1j * last.waves[-1, 1]
            counts.append(counts_at_price(of_it, last.logs, wave.ravel(), bins, longest))
        if all(count.settled for count in counts) or left == 0:
            break
        wanted = [count.better for count in counts]
    log_by_count = np.full((len(orders), bins), -np.inf)
    probability = np.zeros((len(orders), bins))
    taken_off = bins * series.per_bin[list(orders)]
    for i, count in enumerate(counts):
        log_by_count[i, count.counts - 1] = count.log_by_count + taken_off[i]
        probability[i, count.counts - 1] = count.probability
    boundary, mean, noise = _backward(series, orders, wanted, counts, behind, expected)
    found = Found(
        log_by_count, probability, boundary,
        np.array([count.log_evidence for count in counts]) + taken_off,
        np.array([count.beyond for count in counts]), np.empty((0, 0, 0)),
    )  # fmt: skip
    return InStretches(found, mean, noise)


def _looked_for(series: Stretches, orders: tuple[int, ...]) -> tuple[Stretches, list[Wanted]]:
    """Return the series with what to take off a bin, and what suits a sample of its stretches."""
    parts, bins = series.parts, len(series.x)
    chosen = sorted({round(at) for at in np.linspace(0, len(parts) - 1, SAMPLED)})
    part = sum(parts[b][1] - parts[b][0] for b in chosen) / bins
    prices = np.tile(search_prices(bins, series.longest, SEARCH_PRICES), (len(orders), 1))
    nothing = np.zeros((2, 0, WIDTH))
    for _ in range(SEARCHES):
        logs = np.zeros(prices.shape)
        for b in chosen:
            evidence = series.evidence(parts[b][0], parts[b][1], orders)
            size = parts[b][1] - parts[b][0] + 1
            for i, order in enumerate(orders):
                for first in range(0, SEARCH_PRICES, WIDTH):
                    own, sums = slice(first, first + WIDTH), np.zeros((size, WIDTH))
                    sums_to_bins(
                        evidence[order], 0, prices[i, own], nothing, sums,
                        np.zeros((size, 2, 0, WIDTH)),
                    )  # fmt: skip
                    logs[i, own] += sums[-1]
        places = [
            likely_price(own, log, bins, series.longest, part)
            for own, log in zip(prices, logs, strict=True)
        ]
        step = prices[:, 1] - prices[:, 0]
        near = np.array([place[0] for place in places])
        prices = near[:, None] + step[:, None] * np.linspace(-1, 1, SEARCH_PRICES)
    per_bin = np.zeros(series.n_orders)
    for i, order in enumerate(orders):
        per_bin[order] = np.median(logs[i]) / (part * bins)
    return replace(series, per_bin=per_bin), [Wanted.of(price, sd) for price, _, sd in places]


def _local(
    series: Stretches, b: int, evidence: Floats, wanted: Wanted, behind: _Behind
) -> tuple[Floats, Floats]:
    """Return sums, in units of the one at the stretch's start, and waves at its bins and before.

    From `longest` bins before the stretch on, or of the first one from its start.
    """
    first, last = series.edges[b], series.edges[b + 1]
    known = series.longest if b else 0
    sums = np.zeros((known + last - first + 1, WIDTH))
    waves = np.zeros((len(sums), 2, GROUPS, WIDTH))
    sums[:known] = behind.sums[:known]
    waves[: known + 1] = behind.waves[-known - 1 :]
    sums_to_bins(evidence, known, wanted.prices, wanted.turn, sums, waves)
    return sums, waves


def _forward(
    series: Stretches, orders: tuple[int, ...], wanted: list[Wanted]
) -> list[list[_Behind]]:
    """Return what lies behind each stretch, and behind all of them, by order."""
    longest = series.longest
    waves = np.zeros((1, 2, GROUPS, WIDTH))
    waves[:, 0] = 1.0
    none = _Behind(np.zeros(WIDTH, dtype=np.longdouble), np.zeros((0, WIDTH)), waves)
    out = [[none] * len(orders)]
    for b, (first, last) in enumerate(series.parts):
        evidence = series.evidence(first - (longest if b else 0), last, orders)
        now = []
        for order, of_it, behind in zip(orders, wanted, out[-1], strict=True):
            sums, waves = _local(series, b, evidence[order], of_it, behind)
            now.append(
                _Behind(
                    behind.logs + sums[-1], sums[-longest - 1 : -1] - sums[-1],
                    waves[-longest - 1 :].copy(),
                )
            )  # fmt: skip
        out.append(now)
    return out


def _backward(
    series: Stretches, orders: tuple[int, ...], wanted: list[Wanted], counts: list[Counts],
    behind: list[list[_Behind]], expected: tuple[int, ...],
) -> tuple[Floats, Floats, Floats]:  # fmt: skip
    """Return boundaries, (orders, T), expected trajectories and noise, from the last stretch on."""
    bins, dims = series.x.shape
    edges, longest = series.edges, series.longest
    starts = np.zeros((len(orders), bins + 1))
    mean, noise = np.zeros((len(expected), bins, dims)), np.zeros((len(expected), dims, dims))
    # Of the bins from the stretch's end on: logs of sums, and what the ways on from them count.
    sums_ahead = [np.zeros(1) for _ in orders]
    ends_ahead = [behind[0][0].waves.copy() for _ in orders]
    for b in range(len(edges) - 2, -1, -1):
        first, last = edges[b], edges[b + 1]
        reach, known = min(last + longest, bins), longest if b else 0
        evidence = series.evidence(first - known, reach, orders)
        likely = ROOM.array("likely", len(evidence), reach - first, longest)
        likely[:] = 0.0
        for i, (order, of_it) in enumerate(zip(orders, wanted, strict=True)):
            # Of segments that end in the stretch, and then of those that start in it.
            sums, waves = _local(series, b, evidence[order], of_it, behind[b][i])
            own = np.concatenate([sums[known:-1, 0], sums[-1, 0] + sums_ahead[i]])
            ends = np.empty((len(own), 2, GROUPS, WIDTH))
            ends[last - first :] = ends_ahead[i]
            segments_to_end(
                evidence[order, known : known + last - first], of_it.price, of_it.turn,
                counts[i].share, own, waves[known:-1], ends, starts[i, first:last],
                likely[order, : last - first],
            )  # fmt: skip
            kept = min(longest, bins - first) + 1
            sums_ahead[i], ends_ahead[i] = own[:kept].copy(), ends[:kept].copy()
        if expected:
            part, spread = series.engine(first, reach).expect(likely, expected)
            mean[:, first:reach] += part
            noise += spread * ((reach - first) / bins)
    starts[:, -1] = 1.0
    return np.maximum(starts[:, 1:], 0.0), mean, noise
