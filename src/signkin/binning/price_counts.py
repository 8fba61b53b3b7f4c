"""How many segments a series has, from sums over all segmentations at a price of a segment.

At a price the number k of segments has a distribution, whose characteristic function E exp(-i t k)
comes with the sums (prices.py): its Fourier sum over a window is P(k) at that price, and with the
prior of k segmentations in the price's place P(k | D). What lies beyond the window is bounded by
Chernoff's bound at further prices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from signkin.binning.all_counts import log_sum
from signkin.binning.lanes import WIDTH
from signkin.binning.segmentation_prior import log_cuts, log_prior_of, log_uniform

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

GROUPS = 3  # of eight angles
SPAN_SDS = 17.5  # of k, of the window that a Fourier sum tells
LEAST_SPAN = 24
# Prices beside the one that counts: for the mean and variance of k there, and for bounds.
STEP = 0.25
BESIDE = np.array([0.0, -STEP, STEP, 1.0, 10.0, -1.0, -4.0, -14.0])
HIGH = 10.0  # a price above it has further ones beside it, by so much of the rest:
BESIDE_HIGH = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -0.1, -0.4, -1.0])
RESOLVED = 1e-13  # the least P(k) that rounding leaves
# How far the mean may lie from that at the price, where what is beyond is little, and where not.
NEAR_SDS = 1.5
CLOSE_SDS = 0.2
GOOD = 1e-9
LEAST_VARIANCE = 0.1  # to step by
COUNTED_UP_TO = 10_000  # bins: ways to cut a longer series are told by the saddle point
MOST_STEP = 2.0  # of a price, from one pass to the next
FAR_PLACES = 400  # numbers of segments between which bounds are taken together


@dataclass(frozen=True, eq=False)
class Wanted:
    """What sums are to be made with, of one order. angles: (GROUPS * 8,), those unused 0.

    price: of a segment. span: numbers of segments in the window. used: how many angles.
    """

    price: float
    span: int
    angles: Floats
    used: int

    @classmethod
    def of(cls, price: float, sd: float) -> Wanted:
        """Return those for numbers of segments with so large a standard deviation."""
        span = max(LEAST_SPAN, int(np.ceil(SPAN_SDS * sd)))
        span += span % 2
        used = min(GROUPS * WIDTH, span // 2 + 1)
        angles = np.zeros(GROUPS * WIDTH)
        angles[:used] = 2 * np.pi * np.arange(used) / span
        return cls(price, span, angles, used)

    @property
    def prices(self) -> Floats:
        """Return the prices of the sums, (8,), its own first."""
        return self.price + BESIDE + max(0.0, self.price - HIGH) * BESIDE_HIGH

    @property
    def turn(self) -> Floats:
        """Return exp(-i t) of the angles, (2, GROUPS, 8)."""
        shape = (GROUPS, WIDTH)
        return np.stack([np.cos(self.angles).reshape(shape), -np.sin(self.angles).reshape(shape)])

    def weights(self) -> Floats:
        """Return how often each angle counts in a Fourier sum: with its negative, or alone."""
        out = np.zeros(len(self.angles))
        out[: self.used] = 2.0
        out[0] = 1.0
        if self.used == self.span // 2 + 1:
            out[self.used - 1] = 1.0
        return out / self.span


@dataclass(frozen=True, eq=False)
class Counts:
    """What sums at a price say of the number of segments, of one order.

    counts: those told, k = M + 1, one after the other. log_by_count: ln(P(M) P(D | M)),
    probability: P(M | D), of each. share: (2, GROUPS, 8), what each angle counts in
    probabilities. beyond: a bound on the share of P(M | D) that is not told. better: what
    suits the series, settled: whether that was what the sums were made with.
    """

    counts: NDArray[np.int64]
    log_by_count: Floats
    probability: Floats
    log_evidence: float
    share: Floats
    beyond: float
    better: Wanted
    settled: bool


def counts_at_price(
    wanted: Wanted, sums: NDArray[np.longdouble], wave: Complex, bins: int, longest: int
) -> Counts:
    """Return P(M | D) of a series from the logs of sums, (8,), and E exp(-i t k), (angles,)."""
    base = float(sums[0])
    logs = np.asarray(sums - sums[0], dtype=float)  # as long doubles they keep small differences
    mean, variance = _moments(logs)
    low = int(np.clip(round(mean) - wanted.span // 2, -(-bins // longest), bins))
    k = np.arange(low, min(low + wanted.span, bins + 1))
    phase = np.exp(1j * np.outer(wanted.angles, k))
    at_price = (wanted.weights() * wave) @ phase
    top = int(np.argmax(at_price.real))
    good = at_price.real > RESOLVED
    first = top - int(np.argmin(np.append(good[top::-1], False))) + 1
    last = top + int(np.argmin(np.append(good[top:], False)))
    k, at_price, phase = k[first:last], at_price.real[first:last], phase[:, first:last]
    log_cut = _log_cuts(k, bins, longest)
    # The price is taken back, and one over the number of segmentations put in its place.
    weight = np.log(at_price) + wanted.price * k - log_cut
    evidence = log_sum(weight)
    probability = np.exp(weight - evidence)
    share = wanted.weights() * (phase @ (probability / at_price))
    beyond = _beyond(wanted, logs, k, low, evidence, bins, longest)
    about = float(probability @ k)
    sd = float(np.sqrt(probability @ (k - about) ** 2))
    off = (about - mean) / np.sqrt(max(variance, LEAST_VARIANCE))
    fits = Wanted.of(wanted.price, max(sd, np.sqrt(variance))).span
    # Of a window far too wide the angles are too few: nothing of it holds but the moments.
    if wanted.used < wanted.span // 2 and wanted.span > 2 * Wanted.of(0.0, np.sqrt(variance)).span:
        off, fits, sd = np.inf, 0, 0.0
    settled = fits <= 1.1 * wanted.span and abs(off) <= (NEAR_SDS if beyond <= GOOD else CLOSE_SDS)
    off = off if np.isfinite(off) else 0.0
    step = np.clip(off / np.sqrt(max(variance, LEAST_VARIANCE)), -MOST_STEP, MOST_STEP)
    better = wanted if settled else Wanted.of(wanted.price - step, max(sd, np.sqrt(variance)))
    log_by_count = weight + base + log_uniform(bins)
    return Counts(
        k, log_by_count, probability, evidence + base + log_uniform(bins),
        np.stack([share.real, share.imag]).reshape(2, GROUPS, WIDTH), beyond,
        better, bool(settled),
    )  # fmt: skip


def search_prices(bins: int, longest: int, number: int) -> Floats:
    """Return evenly spaced prices, from those of a boundary at each bin to the fewest segments."""
    fewest = np.array([bins / longest * 1.0001 + 1.0])
    highest = float(log_cuts(bins, longest, fewest)[1][0])
    return np.linspace(-np.log(bins) - 2.0, max(np.log(bins), highest) + 2.0, number)


def likely_price(
    prices: Floats, logs: Floats, bins: int, longest: int, part: float
) -> tuple[float, float, float]:
    """Return about the price that the prior has in effect, and mean and SD of k there.

    prices: evenly spaced. logs: of the sums at them, of `part` of the series.
    """
    counts = -np.diff(logs) / np.diff(prices) / part
    between = (prices[1:] + prices[:-1]) / 2
    fits = (counts > bins / longest * 1.001) & (counts < bins * 0.999)
    if fits.any():
        counts, between = counts[fits][::-1], between[fits][::-1]  # rising counts
    # The price at which k is the mean is d ln(sum of k alone) / dk.
    gain = between - log_cuts(bins, longest, np.clip(counts, bins / longest, bins))[1]
    steps = (gain[1:] + gain[:-1]) / 2 * np.diff(counts)
    at = int(np.argmax(np.concatenate([[0.0], np.cumsum(steps)])))
    falls = np.gradient(counts, between) if len(counts) > 1 else np.zeros(1)
    return float(between[at]), float(counts[at]), float(np.sqrt(max(-falls[at], 0.0)))


def _moments(logs: Floats) -> tuple[float, float]:
    """Return mean and variance of k at the price, from the logs at those beside it less its own."""
    less, more = float(logs[1]), float(logs[2])
    return (less - more) / (2 * STEP), max(0.0, (less + more) / STEP**2)


def _log_cuts(k: NDArray[np.int64], bins: int, longest: int) -> Floats:
    """Return ln N(k): counted, or of a very long series told by the saddle point."""
    if bins <= COUNTED_UP_TO:
        return log_uniform(bins) - log_prior_of(bins, longest)[k - 1]
    one_way = (k == bins) | (k * longest == bins)
    inner = np.where(one_way, np.sqrt(bins / longest * bins), k)
    return np.where(one_way, 0.0, log_cuts(bins, longest, inner)[0])


def _beyond(
    wanted: Wanted, logs: Floats, told: NDArray[np.int64], low: int, evidence: float, bins: int,
    longest: int,
) -> float:  # fmt: skip
    """Return a bound on the share of P(k | D) of the numbers of segments that are not told.

    In the window, from `low` on, those have P(k) at the price below RESOLVED. Everywhere that is at
    most exp(K' - K + (price' - price) k) for any other price, K being the logs of sums. The bound's
    log is a line in k, and -ln N(k) bends upwards: between two k it is highest at one of them.
    """

    def log_most(k: NDArray[np.int64]) -> Floats:  # at each price
        at_price = logs[:, None] + wanted.prices[:, None] * k
        return np.asarray(at_price - _log_cuts(k, bins, longest) - evidence)

    high = min(low + wanted.span - 1, bins)
    near = np.concatenate([np.arange(low, told[0]), np.arange(told[-1] + 1, high + 1)])
    bound = log_most(near)
    bound[0] += np.log(RESOLVED)
    share = float(np.exp(np.minimum(bound.min(axis=0), 0.0)).sum())
    for first, last in ((-(-bins // longest), low - 1), (high + 1, bins)):
        if first > last:
            continue
        steps = np.unique(np.geomspace(1, last - first + 1, FAR_PLACES).astype(int)) - 1
        k = last - steps[::-1] if first < low else first + steps
        bound = np.exp(np.minimum(log_most(k), 0.0))
        between = np.maximum(bound[:, 1:], bound[:, :-1]).min(axis=0)
        share += float(bound[:, 0].min() + (np.diff(k) * between).sum())
    return min(1.0, share)
