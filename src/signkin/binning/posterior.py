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
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln

from signkin.binning import band, lanes, log_domain, segmentation, segments, sum_product
from signkin.binning.lanes import WIDTH
from signkin.binning.prior import HIGHEST_ORDER, Prior, Tables, tables
from signkin.binning.room import Room
from signkin.binning.stale import forget_stale
from signkin.errors import SignkinError

Floats = NDArray[np.float64]

# Above so many bins not every M is worked out unless asked for: the cost grows with M T^2.
EVERY_COUNT_UP_TO = 256
# There, at each bin, numbers of segments within this of the best path's are kept; the band is
# widened until the bound on what it leaves out is below BAND_CUT_MASS.
BAND = 32
BAND_CUT_MASS = 1e-6
CLEARANCE_BINS = 3
DIGITS_2 = 30  # binary digits, nine decimal ones, to which probabilities are compared
TAIL_STEPS = 4
MOST_NOISES = 1e30  # products of squares overflow above
NO_CANCELLATION = 0.01
_ROOM = Room()

KERNELS = (band, lanes, log_domain, segmentation, segments, sum_product)
forget_stale(
    Path(str(segments.segment_evidence.stats.cache_path)), [Path(str(m.__file__)) for m in KERNELS]
)
ROUNDING = 2e-15  # the least share that two sums can differ by and it be told


@dataclass(frozen=True, eq=False)
class Posterior:
    """What a trajectory says about its segments, for each polynomial order.

    orders: the orders, in the rows of the arrays. log_evidence_by_count: (orders, counts),
    ln P(D | M, S) for M = 0, 1, ... inner boundaries. log_evidence: (orders,), ln P(D | S).
    order_probability: (orders,), P(S | D). cut_mass: (orders,), a bound on the share of P(M | D)
    beyond the counts that were worked out.
    """

    x: Floats
    prior: Prior
    dt_s: float | None
    orders: tuple[int, ...]
    max_segment_bins: int
    log_evidence_by_count: Floats
    log_evidence: Floats
    order_probability: Floats
    cut_mass: Floats
    _count_probability: Floats
    _boundary: Floats
    _mean: Floats | None
    _noise: Floats | None

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

    def map_segmentation(self, order: int, count: int | None = None) -> NDArray[np.int64]:
        """Return the inner boundaries of the most probable segmentation with `count` of them.

        Raises SignkinError for a count that no segmentation has.
        """
        wanted = self.map_count(order) if count is None else count
        fewest = -(-len(self.x) // self.max_segment_bins) - 1
        if not fewest <= wanted <= len(self.x) - 1:
            raise SignkinError(
                f"{wanted} boundaries in {len(self.x)} bins",
                place="count",
                expected=f"from {fewest} to {len(self.x) - 1}",
            )
        return segmentation.best_boundaries(self._evidence(order), wanted + 1)

    def expected_trajectory(self, order: int) -> Floats:
        """Return the posterior mean of the trajectory, (T, L), averaged over segmentations."""
        return self._kept(self._mean)[self._row(order)]

    def map_trajectory(self, order: int, count: int | None = None) -> Floats:
        """Return the mean of the most probable segmentation, (T, L): exactly piecewise."""
        ends = [*self.map_segmentation(order, count), len(self.x) - 1]
        bins, dims = self.x.shape
        chosen = np.zeros((order + 1, bins, self.max_segment_bins))
        start = 0
        for end in ends:
            chosen[order, start, end - start] = 1.0
            start = int(end) + 1
        made = tables(self.prior, bins, self.max_segment_bins, dims, order + 1, self.dt_s)
        whitened = _whitened(self.x, self.prior)
        means, _ = _expect(whitened, bins, made, chosen, (order,), self.prior.inverse_scale(dims))
        return means[0]

    def noise_covariance(self, order: int) -> Floats:
        """Return the noise covariance, (L, L): inverse expected precision, averaged over bins."""
        return self._kept(self._noise)[self._row(order)]

    @staticmethod
    def _kept(values: Floats | None) -> Floats:
        if values is None:
            raise SignkinError(
                "expectations were not asked for",
                place="fit",
                expected="fit(..., expectations=True)",
            )
        return values

    def _evidence(self, order: int) -> Floats:
        bins, dims = self.x.shape
        made = tables(self.prior, bins, self.max_segment_bins, dims, order + 1, self.dt_s)
        whitened = _whitened(self.x, self.prior)
        return _by_order(whitened, bins, made, self.max_segment_bins)[order]


def fit(
    X: Floats,
    orders: Sequence[int] = tuple(range(8)),
    prior: Prior | None = None,
    dt_s: float | None = None,
    max_count: int | None = None,
    max_segment_bins: int | None = None,
    expectations: bool = True,
    name: str = "trajectory",
) -> Posterior:
    """Return the posterior of one trajectory for all orders at once.

    X: (T, L), taken as given: the prior's coefficients are around 0, so centre it first.
    orders: polynomial orders. prior: mandatory. dt_s: duration of a bin, for
    Prior(time_unit="second"). max_count: the largest M worked out; None is every M up to 256
    bins, and above those around the likely M, the others being -inf; either way `cut_mass`
    bounds the share of P(M | D) that is left out. A count takes 128 bytes of memory a bin.
    max_segment_bins: the longest segment; segmentations with longer ones have no prior
    probability, the others share it evenly.
    expectations: whether to work out expected trajectories and noise too.

    Raises SignkinError that names the trajectory for gaps, too few bins, impossible orders.
    """
    if prior is None:
        raise SignkinError("no prior", file=name, expected="Prior(noise_sd=...)")
    x, wanted = _checked(X, orders, name)
    bins, dims = x.shape
    longest = bins if max_segment_bins is None else int(max_segment_bins)
    if longest < 1:
        raise SignkinError(
            f"max_segment_bins is {longest}", file=name, expected="a whole number from 1"
        )
    longest = min(longest, bins)
    if max_count is not None and (max_count != int(max_count) or max_count < 0):
        raise SignkinError(f"max_count is {max_count}", file=name, expected="a whole number from 0")
    n_orders = max(wanted) + 1
    try:
        made = tables(prior, bins, longest, dims, n_orders, dt_s)
    except SignkinError as error:
        raise error.at(file=name) from error
    whitened = _whitened(x, prior)
    if not np.abs(whitened).max() < MOST_NOISES:
        raise SignkinError(
            f"positions up to {np.abs(whitened).max():.1e} times the prior's noise",
            file=name,
            expected=f"less than {MOST_NOISES:.0e}",
            todo="Check the unit of the data against that of noise_sd.",
        )
    every = max_count is not None or bins <= EVERY_COUNT_UP_TO
    if every:
        evidence = _by_segment(whitened, bins, made, longest)
        found = _counted(evidence, wanted, bins, longest, max_count)
    else:
        found = _in_band(_by_order(whitened, bins, made, longest), wanted, bins, longest)
    mean = noise = None
    if expectations:
        inverse_scale = prior.inverse_scale(dims)
        mean, noise = _expect(whitened, bins, made, found.segments, wanted, inverse_scale)
    return Posterior(
        x=x,
        prior=prior,
        dt_s=dt_s,
        orders=wanted,
        max_segment_bins=longest,
        log_evidence_by_count=found.log_by_count - _log_uniform(bins),
        log_evidence=found.log_evidence,
        order_probability=np.exp(found.log_evidence - _log_sum(found.log_evidence)),
        cut_mass=found.cut_mass,
        _count_probability=found.probability,
        _boundary=found.boundary,
        _mean=mean,
        _noise=noise,
    )


def fit_many(
    trajectories: Sequence[Floats],
    orders: Sequence[int] = tuple(range(8)),
    prior: Prior | Sequence[Prior] | None = None,
    dt_s: float | Sequence[float] | None = None,
    workers: int = 1,
    names: Sequence[str] | None = None,
    **options: object,
) -> list[Posterior]:
    """Fit many trajectories, on `workers` cores; the results do not depend on how many.

    The kernels run without Python's lock, so threads share the work. prior, dt_s: one for all,
    or one each. options: as for `fit`.
    """
    n = len(trajectories)
    priors = [prior] * n if prior is None or isinstance(prior, Prior) else list(prior)
    steps = list(dt_s) if isinstance(dt_s, Sequence) else [dt_s] * n
    called = [f"trajectory {i + 1}" for i in range(n)] if names is None else list(names)

    def one(job: tuple[Floats, Prior | None, float | None, str]) -> Posterior:
        x, of_it, step, name = job
        return fit(x, orders, of_it, dt_s=step, name=name, **options)  # type: ignore[arg-type]

    jobs = zip(trajectories, priors, steps, called, strict=True)
    if workers <= 1:
        return [one(job) for job in jobs]
    with ThreadPoolExecutor(max_workers=workers) as pool:
        return list(pool.map(one, jobs))


def segment_log_evidence(X: Floats, order: int, prior: Prior, dt_s: float | None = None) -> Floats:
    """Return ln P(X[i..j]) of every segment, (T, T) at [i, j], inclusive; -inf for j < i.

    Local time runs from 1 to the segment's number of bins. X is taken as given.
    """
    x, _ = _checked(X, [order], "trajectory", least_bins=1)
    bins, dims = x.shape
    made = tables(prior, bins, bins, dims, order + 1, dt_s)
    by_length = _by_order(_whitened(x, prior), bins, made, bins)[order]
    out = np.full((bins, bins), -np.inf)
    for i in range(bins):
        out[i, i:] = by_length[i, : bins - i]
    return out


def greedy_maxima(probability: Floats, count: int) -> NDArray[np.int64]:
    """Return the places of up to `count` largest local maxima, 3 bins cleared around each.

    Values that agree to 9 digits are taken for the same, and the first goes first: where every
    bin is a boundary, the order would otherwise be that of rounding.
    """
    given = np.asarray(probability, dtype=float)
    _, exponent = np.frexp(given)
    left = np.ldexp(np.round(np.ldexp(given, DIGITS_2 - exponent)), exponent - DIGITS_2)
    padded = np.concatenate([[-np.inf], left, [-np.inf]])
    peak = (padded[1:-1] >= padded[:-2]) & (padded[1:-1] >= padded[2:]) & (left > 0)
    free = np.where(peak, left, -np.inf)
    found: list[int] = []
    while len(found) < count:
        best = int(np.argmax(free)) if len(free) else 0
        if not len(free) or not np.isfinite(free[best]):
            break
        found.append(best)
        free[max(0, best - CLEARANCE_BINS) : best + CLEARANCE_BINS + 1] = -np.inf
    return np.array(sorted(found), dtype=np.int64)


# --- inside ----------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Found:
    """Rows for the wanted orders. log_by_count: ln(P(M) P(D | M)).

    segments: probabilities of segments, by segment or by order (segments.py), of all orders.
    """

    log_by_count: Floats
    probability: Floats
    boundary: Floats
    log_evidence: Floats
    cut_mass: Floats
    segments: Floats


def _checked(
    X: Floats, orders: Sequence[int], name: str, least_bins: int = 2
) -> tuple[Floats, tuple[int, ...]]:
    try:
        x = np.array(X, dtype=float, order="C")  # a copy: the caller may go on with his own
    except (TypeError, ValueError) as error:
        raise SignkinError(
            f"the data are not an array of numbers ({error})",
            file=name,
            expected="(bins, dimensions)",
        ) from None
    if x.ndim == 1:
        x = x[:, np.newaxis]
    if x.ndim != 2 or x.shape[0] < least_bins or x.shape[1] < 1:
        raise SignkinError(
            f"the data have shape {np.shape(X)}",
            file=name,
            expected=f"(bins, dimensions) with {least_bins} bins or more",
        )
    bad = ~np.isfinite(x).all(axis=1)
    if bad.any():
        raise SignkinError(
            f"{int(bad.sum())} bins have no value",
            file=name,
            place=f"bin {int(np.argmax(bad))}",
            expected="finite values; fill or cut out gaps first",
        )
    wanted = tuple(int(order) if order == int(order) else -1 for order in orders)
    if (
        not wanted
        or min(wanted) < 0
        or max(wanted) > HIGHEST_ORDER
        or len(set(wanted)) < len(wanted)
    ):
        raise SignkinError(
            f"the orders are {list(orders)}",
            file=name,
            expected=f"different orders from 0 to {HIGHEST_ORDER}",
        )
    if max(wanted) >= x.shape[0]:
        raise SignkinError(
            f"order {max(wanted)} with {x.shape[0]} bins",
            file=name,
            expected="more bins than the order",
            todo="Leave out the high orders, or take more bins.",
        )
    return x, wanted


def _whitened(x: Floats, prior: Prior) -> Floats:
    """Return the data in units of the prior's noise, (L, T + 8): a row for each dimension."""
    bins, dims = x.shape
    out = np.zeros((dims, bins + WIDTH))
    out[:, :bins] = (x / np.sqrt(prior.inverse_scale(dims))).T
    return out


def _by_segment(whitened: Floats, bins: int, made: Tables, longest: int) -> Floats:
    """Return the log evidence of all segments, (G, T, W, 8)."""
    groups = -(-made.cosine.shape[1] // WIDTH)
    return _filled(_ROOM.array("evidence", groups, bins, longest, WIDTH), whitened, bins, made)


def _by_order(whitened: Floats, bins: int, made: Tables, longest: int) -> Floats:
    """Return the log evidence of all segments, (D, T, W)."""
    orders = made.cosine.shape[1]
    return _filled(_ROOM.array("evidence", orders, bins, longest), whitened, bins, made)


def _filled(out: Floats, whitened: Floats, bins: int, made: Tables) -> Floats:
    tables_of_evidence = (made.cosine, made.sine, made.constant, made.half)
    segments.segment_evidence(whitened, *tables_of_evidence, bins, out)
    return out


def _expect(
    whitened: Floats, bins: int, made: Tables, probability: Floats, wanted: tuple[int, ...],
    inverse_scale: Floats,
) -> tuple[Floats, Floats]:  # fmt: skip
    """Return the wanted orders' expected trajectories and noise, in the data's unit."""
    orders = made.cosine.shape[1]
    dims = len(whitened)
    asked = np.zeros(orders, dtype=np.int64)
    asked[list(wanted)] = 1
    longest = probability.shape[2]
    z = _ROOM.array("z", longest + 1, orders, dims, WIDTH)
    chances = _ROOM.array("chances", longest, -(-orders // WIDTH) * WIDTH, WIDTH)
    mean = np.empty((orders, dims, whitened.shape[1]))
    noise = np.empty((orders, dims, dims))
    segments.expectations(
        whitened, made.cosine, made.sine, made.inverse, made.powers, made.half, bins,
        probability, asked, mean, noise, z, chances,
    )  # fmt: skip
    scale = np.sqrt(inverse_scale)
    rows = list(wanted)
    means = np.ascontiguousarray(mean[rows, :, :bins].transpose(0, 2, 1))
    return means * scale, noise[rows] * (scale[:, None] * scale)


def _counted(
    evidence: Floats, wanted: tuple[int, ...], bins: int, longest: int, max_count: int | None
) -> _Found:
    """Work out M = 0..max_count of all orders together."""
    fewest = -(-bins // longest) - 1
    most = bins - 1 if max_count is None else min(max(int(max_count), fewest), bins - 1)
    counts = most + 1
    log_prior = np.ascontiguousarray(_log_prior(bins, longest)[:counts])
    groups = len(evidence)
    held = groups * WIDTH
    log_by_count = np.empty((groups, counts, WIDTH))
    probability = np.empty((held, counts))
    boundary = np.empty((groups, bins, WIDTH))
    log_evidence, lost, cut = np.empty((3, held))
    likely = _ROOM.array("probabilities", *evidence.shape)
    best = _ROOM.array("best", bins + 1, WIDTH)
    columns = sum_product.columns_for(counts)
    ways = _ROOM.array("ways", bins + 1, columns, WIDTH)
    before = _ROOM.array("before", bins + 1, columns, WIDTH)
    spare = _ROOM.array("spare", *evidence.shape[1:])
    asked = np.zeros(held, dtype=np.int64)
    asked[list(wanted)] = 1
    for g in range(groups):
        own = slice(g * WIDTH, (g + 1) * WIDTH)
        sum_product.fit_orders(
            evidence[g], asked[own], log_prior, log_by_count[g], probability[own], boundary[g],
            log_evidence[own], lost[own], cut[own], likely[g],
            best, ways, before, spare,
        )  # fmt: skip
    rows = list(wanted)
    _refuse_lost(lost[rows])
    return _Found(
        np.moveaxis(log_by_count, 1, 2).reshape(held, counts)[rows],
        probability[rows],
        np.moveaxis(boundary, 1, 2).reshape(held, bins)[rows],
        log_evidence[rows],
        cut[rows],
        likely,
    )


def _in_band(evidence: Floats, wanted: tuple[int, ...], bins: int, longest: int) -> _Found:
    """Work out the likely M of a long series, with a bound on what is left out.

    `evidence` (D, T, W) becomes probabilities of segments.
    """
    log_prior = _log_prior(bins, longest)
    rows = len(wanted)
    log_by_count, probability = np.empty((2, rows, bins))
    boundary = np.empty((rows, bins))
    log_evidence, cut = np.empty((2, rows))
    for i, d in enumerate(wanted):
        half_width = BAND
        while True:
            kept = evidence[d].copy()
            log_evidence[i], lost, left_out, price = band.fit_order_in_band(
                kept, log_prior, half_width, log_by_count[i], probability[i], boundary[i]
            )
            _refuse_lost(np.array([lost]))
            cut[i] = _band_cut(
                evidence[d], log_by_count[i], log_prior, log_evidence[i], left_out, price
            )
            if cut[i] <= BAND_CUT_MASS or 2 * half_width >= bins:
                break
            half_width *= 2
        evidence[d] = kept
    return _Found(log_by_count, probability, boundary, log_evidence, cut, evidence)


def _band_cut(
    evidence: Floats, log_by_count: Floats, log_prior: Floats, log_evidence: float,
    left_out: float, price: float,
) -> float:  # fmt: skip
    """Return a bound on the share of P(M | D) that a band leaves out.

    Outside of the window of counts everything is left out, inside of it the paths that leave
    the band. Their sum at the pass's price of a segment is `left_out` of the sum over all, which
    bounds what any one M lacks (as small as rounding lets it be told), and Chernoff's bound
    holds for each M as well: the lesser of the two counts. Prices are added until the bound is
    good enough.
    """
    bins = len(evidence)
    m = np.arange(bins)
    inside = np.flatnonzero(np.isfinite(log_by_count))
    low, high = int(inside[0]), int(inside[-1]) + 1
    at_price = log_by_count[low:high] - log_prior[low:high] - (inside + 1) * price
    strayed = np.full(bins, np.inf)
    strayed[low:high] = np.log(max(left_out, ROUNDING)) + _log_sum(at_price)
    strayed += (m + 1) * price
    bound = np.full(bins, np.inf)
    share = np.inf
    for step in range(TAIL_STEPS):
        for tilt in _prices(bins, low, high, step):
            bound = np.minimum(bound, _log_bound(evidence, tilt) + (m + 1) * tilt)
        lacking = np.minimum(bound, strayed) + log_prior - log_evidence
        share = float(np.exp(np.minimum(0.0, _log_sum(lacking))))
        if share <= BAND_CUT_MASS:
            break
    return share


def _prices(bins: int, low: int, high: int, step: int) -> list[float]:
    """Return prices of a segment at which few, and many segments weigh most.

    At first for the counts below the window, at twice its end and near one segment a bin; then
    in between, and higher still for the low side, where few segments fit badly.
    """
    at_low = sum_product.price_of_boundary(bins, max(low - 1, 0)) * 4.0 * 8.0**step
    at_top = bins - 1 - (bins >> 6)
    ratio = at_top / (2 * high)
    shares = ((0.0, 1.0), (0.5,), (0.25, 0.75), (0.125, 0.375, 0.625, 0.875))[step]
    places = [min(int(2 * high * ratio**share), bins - 1) for share in shares]
    return [at_low, *(sum_product.price_of_boundary(bins, at) for at in places)]


def _log_bound(evidence: Floats, price: float) -> float:
    """Return the log of the sum over all segmentations, each segment paying the price.

    With M + 1 prices put back it bounds the sum over those with M boundaries (Chernoff).
    """
    best, weight = np.empty(len(evidence) + 1), np.empty(evidence.shape)
    return float(band.log_all_ways(evidence, price, best, weight))


def _log_sum(values: Floats) -> float:
    """Return the log of the sum of exponentials. SciPy's has a start of its own of 50 us."""
    top = values.max()
    return float(top + np.log(np.exp(values - top).sum())) if np.isfinite(top) else float(top)


def _refuse_lost(lost: Floats) -> None:
    if lost.max() > 1e-9:
        raise SignkinError(
            f"{lost.max():.1e} of the posterior was lost to underflow",
            place="sum-product",
            expected="less than 1e-9",
            todo="Report this trajectory: the pass should have found its peak.",
        )


def _log_uniform(bins: int) -> float:
    return -float(np.log(bins))  # eq. 8: P(M) = 1 / T


@lru_cache(maxsize=256)
def _log_prior(bins: int, longest: int) -> Floats:
    """Return ln(P(M) P({q} | M)) for M = 0..T-1 (eq. 7, 8); -inf where no segmentation fits."""
    m = np.arange(bins)
    if longest >= bins:
        log_number = gammaln(bins) - gammaln(m + 1) - gammaln(bins - m)
    else:
        log_number = _log_compositions(bins, longest)
    return np.where(np.isfinite(log_number), _log_uniform(bins) - log_number, -np.inf)


@lru_cache(maxsize=16)
def _log_compositions(bins: int, longest: int) -> Floats:
    """Return the log of the number of ways to cut T bins into M + 1 parts of at most W each.

    Inclusion and exclusion, sum over r of (-1)^r C(k, r) C(T - rW - 1, k - 1) for k parts, where
    its terms do not cancel, that is for many parts; for few parts a recursion that adds alone.
    """
    k = np.arange(1, bins + 1)[:, None]
    r = np.arange(-(-bins // longest))[None, :]
    left = bins - r * longest - 1
    fits = (left >= k - 1) & (r <= k)
    log_term = np.where(fits, _log_comb(k, r) + _log_comb(left, k - 1), -np.inf)
    largest = np.maximum(log_term.max(axis=1), 0.0)  # -inf where no cut fits
    total = np.sum(np.where(r % 2, -1.0, 1.0) * np.exp(log_term - largest[:, None]), axis=1)
    cancelled = np.flatnonzero(total < NO_CANCELLATION)
    first = int(cancelled[-1]) + 1 if len(cancelled) else 0
    out = np.empty(bins)
    out[:first] = segmentation.log_compositions(bins, longest, first)
    with np.errstate(divide="ignore"):
        out[first:] = largest[first:] + np.log(total[first:])
    return out


def _log_comb(n: NDArray[np.int64], k: NDArray[np.int64]) -> Floats:
    """Return ln C(n, k), of whatever value where k is not in 0..n."""
    inside = (k >= 0) & (k <= n)
    n, k = np.where(inside, n, 0), np.where(inside, k, 0)
    return np.asarray(gammaln(n + 1) - gammaln(k + 1) - gammaln(n - k + 1))
