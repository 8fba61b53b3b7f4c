"""Bayesian binning with polynomial segments (Endres et al. 2013, section 2.5), exactly.

A trajectory of T bins is cut into M + 1 segments. Given the order S of the
polynomials, each segment has a marginal likelihood in closed form (prior.py).
The sum over all segmentations with M boundaries is a sum-product over bins,
done for all M at once; with the prior of eq. 7, one over the number of such
segmentations, it is P(D | M, S). P(M) is uniform (eq. 8), and so is P(S).

Equations 10 and 11 as printed leave out the factor of eq. 7, and their limits do
not fit: the last inner boundary is at most at bin T - 2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from signkin.binning import segmentation
from signkin.binning.evidence import Engine
from signkin.binning.maxima import greedy_maxima
from signkin.binning.prior import Prior
from signkin.errors import SignkinError, listed

Floats = NDArray[np.float64]

MOST_MISFIT = 3.0  # SDs of the prior's noise: more is no noise of the prior's


@dataclass(frozen=True, eq=False, repr=False)
class Posterior:
    """What a trajectory says about its segments, for each polynomial order.

    orders: the orders, in the rows of the arrays. log_evidence_by_count: (orders, counts),
    ln P(D | M, S) for M = 0, 1, ... inner boundaries. log_evidence: (orders,), ln P(D | S).
    order_probability: (orders,), P(S | D). cut_mass: (orders,), a bound on the share of P(M | D)
    beyond the counts that were worked out. dt_s: duration of a bin, if told. sample_at: where in
    its bin a sample stands, as a share of the bin.
    """

    x: Floats
    prior: Prior
    dt_s: float | None
    sample_at: float
    orders: tuple[int, ...]
    max_segment_bins: int
    log_evidence_by_count: Floats
    log_evidence: Floats
    order_probability: Floats
    cut_mass: Floats
    _count_probability: Floats
    _boundary: Floats
    _expected: tuple[int, ...]  # the orders in the rows of the next two
    _mean: Floats | None
    _noise: Floats | None

    def __repr__(self) -> str:
        """Return three lines: the data, the order they prefer, and its boundaries."""
        bins, dims = self.x.shape
        best = self.orders[int(np.argmax(self.order_probability))]
        share = float(self.order_probability.max())
        count = self.map_count(best)
        floor = ", the least possible" if self.at_floor(best) else ""
        return (
            f"Posterior of {bins} bins in {dims} dimensions, orders {listed(self.orders)}\n"
            f"  preferred order {best}, P = {share:.3f}, ln P(D) = {self.log_evidence.max():.2f}\n"
            f"  there {count} boundaries{floor}, P = {self.count_probability(best).max():.3f}"
        )

    def _row(self, order: int) -> int:
        try:
            return self.orders.index(order)
        except ValueError:
            raise SignkinError(
                f"order {order} was not fitted", place="order", expected=str(self.orders)
            ) from None

    def count_probability(self, order: int) -> Floats:
        """Return P(M | D, S), (counts,)."""
        return self._count_probability[self._row(order)]

    def map_count(self, order: int) -> int:
        """Return the most probable number M of inner boundaries."""
        return int(np.argmax(self.count_probability(order)))

    def boundary_probability(self, order: int) -> Floats:
        """Return the probability that a segment ends with bin q, (T - 1,), for q = 0..T-2.

        Averaged over M. Its sum is the expected number of inner boundaries.
        """
        return self._boundary[self._row(order), :-1]

    def boundaries(self, order: int, count: int | None = None) -> NDArray[np.int64]:
        """Return the inner boundaries, as the bins that end segments, in order.

        The `count` (None: the most probable number) largest local maxima of the boundary
        posterior, taken greedily with a clearance of 3 bins around each: the largest values
        alone would count one boundary twice. Fewer where there are no more maxima.
        """
        wanted = self.map_count(order) if count is None else count
        return greedy_maxima(self.boundary_probability(order), wanted)

    def boundaries_s(self, order: int, count: int | None = None) -> Floats:
        """Return when the `boundaries` are, in s from the first bin's start (`times_s`)."""
        return self.times_s(self.boundaries(order, count))

    def times_s(self, ends: NDArray[np.int64] | Sequence[int]) -> Floats:
        """Return when segments end that end with the bins given, in s.

        Halfway between the samples of a segment's last bin and the next one's first (see
        `boundary_times`). Raises SignkinError where the duration of a bin was not told.
        """
        if self.dt_s is None:
            raise SignkinError(
                "the duration of a bin was not told", place="fit", expected="fit(..., dt_s=...)"
            )
        return boundary_times(ends, self.dt_s, self.sample_at)

    @property
    def least_count(self) -> int:
        """The least number of inner boundaries that the longest segment allows."""
        return -(-len(self.x) // self.max_segment_bins) - 1

    def at_floor(self, order: int) -> bool:
        """Return whether the most probable M is the least possible, and not 0.

        There the longest segment makes boundaries, and not the data: raise it, or say so.
        """
        return 0 < self.least_count == self.map_count(order)

    def noise_misfit(self, order: int) -> float:
        """Return how far the data lie off the expected trajectory, in SDs of the prior's noise.

        Those of `Prior.expected_noise`; the root of the mean square over bins and dimensions.
        About 1 where the noise fits; far above, the polynomials do not follow the data or
        noise_sd is too small (a unit?); far below, it is too large, and boundaries are lost.
        """
        deviations = self.prior.expected_noise(self.x.shape[1])
        off = (self.x - self.expected_trajectory(order)) / deviations
        return float(np.sqrt(np.mean(off**2)))

    def doubts(self, order: int, misfit: float | None = None) -> str:
        """Return why the result of an order is to be doubted, in words; empty where it is not.

        M is the least that the longest segment allows, or the data lie more than
        `MOST_MISFIT` of the prior's SDs off the expected trajectory. misfit: the order's
        `noise_misfit`, where it is known already.
        """
        told = []
        if self.at_floor(order):
            told.append(f"{self.least_count} boundaries are the least that the longest segment "
                        "allows: it made them, not the data")  # fmt: skip
        misfit = self.noise_misfit(order) if misfit is None else misfit
        if misfit > MOST_MISFIT:
            told.append(f"the data lie {misfit:.1f} SDs of the prior's noise off the path")
        return "; ".join(told)

    def map_segmentation(self, order: int, count: int | None = None) -> NDArray[np.int64]:
        """Return the inner boundaries of the most probable segmentation with `count` of them.

        Raises SignkinError for a count that no segmentation has.
        """
        wanted = self.map_count(order) if count is None else count
        if not self.least_count <= wanted <= len(self.x) - 1:
            raise SignkinError(
                f"{wanted} boundaries in {len(self.x)} bins",
                place="count",
                expected=f"from {self.least_count} to {len(self.x) - 1}",
            )
        return segmentation.best_boundaries(self._evidence(order), wanted + 1)

    def expected_trajectory(self, order: int) -> Floats:
        """Return the posterior mean of the trajectory, (T, L), averaged over segmentations."""
        return self._of_expected(self._mean, order)

    def map_trajectory(
        self, order: int, count: int | None = None, ends: NDArray[np.int64] | None = None
    ) -> Floats:
        """Return the mean of the most probable segmentation, (T, L): exactly piecewise.

        ends: that `map_segmentation`, where it is known already.
        """
        inner = self.map_segmentation(order, count) if ends is None else ends
        bins = len(self.x)
        chosen = np.zeros((order + 1, bins, self.max_segment_bins))
        start = 0
        for end in (*inner, bins - 1):
            chosen[order, start, end - start] = 1.0
            start = int(end) + 1
        means, _ = self._engine(order).expect(chosen, (order,))
        return means[0]

    def noise_covariance(self, order: int) -> Floats:
        """Return the noise covariance, (L, L): inverse expected precision, averaged over bins."""
        return self._of_expected(self._noise, order)

    def _of_expected(self, values: Floats | None, order: int) -> Floats:
        self._row(order)  # was it fitted at all?
        if values is None or order not in self._expected:
            raise SignkinError(
                "expectations were not asked for",
                place="fit",
                expected="fit(..., expectations=True)",
            )
        return values[self._expected.index(order)]

    def _evidence(self, order: int) -> Floats:
        return self._engine(order).by_order()[order]

    def _engine(self, order: int) -> Engine:
        return Engine(self.x, self.prior, self.max_segment_bins, order + 1, self.dt_s)


def boundary_times(
    ends: NDArray[np.int64] | Sequence[int], bin_s: float, sample_at: float = 0.5
) -> Floats:
    """Return when segments end that end with the bins given, in s from the first bin's start.

    Bin i lasts from i to i + 1 times `bin_s`; its sample stands at (i + sample_at) bin_s. A
    boundary is halfway between the last sample of one segment and the first of the next:
    (end + 1/2 + sample_at) bin_s. With samples in the middle of bins that is the bin's end; where
    a bin is a frame, and frames stand at i / rate, sample_at is 0.
    """
    return np.asarray((np.asarray(ends) + (0.5 + sample_at)) * bin_s, dtype=float)
