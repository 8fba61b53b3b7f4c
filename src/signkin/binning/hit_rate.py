"""Hit rates: predicted against true boundaries (Endres et al. 2013, sections 3.1 and 3.2).

A predicted boundary is a hit where it can be paired with a true one within the window, each with
at most one other. Orders are compared by hits for each false positive a second (eq. 17), and all
of them with events thrown at random.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from signkin.binning.pairs import best_pairs, count_pairs, hits_of_many
from signkin.errors import SignkinError
from signkin.masked import unmasked
from signkin.resampling import narrowed

Floats = NDArray[np.float64]

WINDOW_S = 0.09  # section 3.1: "an accuracy window of 90 ms", read as a half-width
# Bins and samples put boundaries on a grid of floating-point times; this much beyond the window
# is still on its edge.
TOLERANCE_S = 1e-6
INTERVAL = (2.5, 97.5)  # percentiles of all intervals here
NO_TRUTH = "no true boundary"
Weights = Callable[[int, int], Any]  # of (trajectories, draws): as `bootstrap_weights`
MOST_DRAWN = 2000  # trajectories that a bootstrap draw takes


# --- one trajectory --------------------------------------------------------------------------


def match(
    predicted_s: ArrayLike, truth_s: ArrayLike, window_s: float = WINDOW_S
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pair predicted with true boundaries, each at most once, and return the pairs' indices.

    predicted_s, truth_s: times in s, in any order. window_s: most distance of a pair, either
    way, inclusive with a tolerance of 1 microsecond.
    Returns (indices of predicted, indices of truth), (H,) each, in order of time. Of all
    pairings with the most pairs it is one with the least total distance. (On a line some best
    pairing keeps the order of both sides, so dynamic programming finds it.)
    """
    predicted, truth = _times(predicted_s, "predicted_s"), _times(truth_s, "truth_s")
    _check_window(window_s)
    by_p, by_t = np.argsort(predicted, kind="stable"), np.argsort(truth, kind="stable")
    p, t = best_pairs(predicted[by_p], truth[by_t], window_s + TOLERANCE_S)
    return by_p[p], by_t[t]


def _check_window(window_s: float) -> None:
    if not (np.isfinite(window_s) and window_s >= 0):
        raise _error(f"a window of {window_s:g} s", "seconds from 0")


@dataclass(frozen=True)
class HitRate:
    """Hits of one trajectory. `note` tells why `hit_rate` is NaN, empty where it is not."""

    hits: int
    misses: int
    false_positives: int
    duration_s: float
    note: str = ""

    @property
    def hit_rate(self) -> float:
        """Share of the true boundaries that were hit; NaN where there are none."""
        true = self.hits + self.misses
        return self.hits / true if true else float("nan")

    @property
    def false_positives_per_s(self) -> float:
        """Predicted boundaries that hit nothing, a second."""
        return self.false_positives / self.duration_s

    @property
    def hpfpps(self) -> float:
        """Hit rate for each false positive a second (eq. 17).

        Infinite with hits and no false positive; NaN without both, or without truth.
        """
        hit_share, false = self.hit_rate, self.false_positives_per_s
        if false > 0:
            return hit_share / false
        return float("inf") if hit_share > 0 else float("nan")


def hit_rate(
    predicted_s: ArrayLike, truth_s: ArrayLike, window_s: float = WINDOW_S, *, duration_s: float
) -> HitRate:
    """Count hits, misses and false positives of a trajectory that lasts `duration_s` seconds."""
    if not (np.isfinite(duration_s) and duration_s > 0):
        raise _error(f"a duration of {duration_s:g} s", "seconds above 0")
    predicted, truth = _times(predicted_s, "predicted_s"), _times(truth_s, "truth_s")
    _check_window(window_s)
    hits = int(count_pairs(np.array(predicted), np.sort(truth), window_s + TOLERANCE_S))
    return HitRate(
        hits=hits,
        misses=len(truth) - hits,
        false_positives=len(predicted) - hits,
        duration_s=float(duration_s),
        note="" if len(truth) else NO_TRUTH,
    )


# --- groups of trajectories ------------------------------------------------------------------


@dataclass(frozen=True)
class GroupRates:
    """Means over trajectories with standard errors, as Fig. 3C and 5 plot them.

    n: trajectories; without_truth: how many of them have no hit rate and are not in its mean.
    An error is NaN with fewer than two values, a mean with none.
    """

    hit_rate: float
    hit_rate_se: float
    false_positives_per_s: float
    false_positives_per_s_se: float
    n: int
    without_truth: int


def group_rates(rates: Sequence[HitRate]) -> GroupRates:
    """Average hit rates and false positives a second over trajectories."""
    hit = np.array([r.hit_rate for r in rates if r.hits + r.misses])
    false = np.array([r.false_positives_per_s for r in rates])
    return GroupRates(*_mean_se(hit), *_mean_se(false), len(rates), len(rates) - len(hit))


def _mean_se(values: Floats) -> tuple[float, float]:
    n = len(values)
    mean = float(values.mean()) if n else float("nan")
    return mean, float(values.std(ddof=1) / np.sqrt(n)) if n > 1 else float("nan")


@dataclass(frozen=True)
class Hpfpps:
    """Hit rate for each false positive a second (eq. 17) of a group, pooled.

    value: infinite without a false positive, NaN where there are no hits either. se: standard
    deviation of the bootstrap's finite values; unbounded: how many of its draws were not
    finite; low, high: 95 % interval of all draws, by percentiles (NaN draws left out).
    note: why a value is not finite, empty where it is. n, without_truth: trajectories.
    """

    value: float
    se: float
    low: float
    high: float
    draws: int
    unbounded: int
    n: int
    without_truth: int
    note: str = ""


def hpfpps(
    rates: Sequence[HitRate], rng: np.random.Generator | int | Weights, draws: int = 2000
) -> Hpfpps:  # fmt: skip
    """Return eq. 17 of a group: pooled hit rate over pooled false positives a second.

    The mean of the trajectories' own ratios does not exist once one has no false positive.
    Standard error and interval are from a bootstrap over trajectories.
    Trajectories without a true boundary have no hit rate; they are left out and counted.
    rng: a random generator, a seed, or what gives the weights of n trajectories (n, draws).
    Of more than MOST_DRAWN trajectories, n, a draw takes m = MOST_DRAWN, and error and interval
    are narrowed by the square root of m / n (the m out of n bootstrap; Bickel, Goetze and van Zwet
    1997): draws cost the same whatever n.
    """
    if draws < 2:
        raise _error(f"{draws} bootstrap draws", "at least 2")
    counts = _counts(rates)
    without = len(rates) - len(counts)
    if not len(counts):
        nan = float("nan")
        return Hpfpps(nan, nan, nan, nan, draws, 0, len(rates), without, NO_TRUTH)
    value = float(_pooled(counts.sum(axis=0)))
    n = len(counts)
    weights = rng(n, draws) if callable(rng) else bootstrap_weights(rng, n, draws)
    drawn = _pooled(weights @ counts)
    finite = drawn[np.isfinite(drawn)]
    there = np.sort(drawn[~np.isnan(drawn)])
    # A percentile between a number and infinity is no number: take one of the draws.
    low, high = (
        np.percentile(there, INTERVAL, method="closest_observation")
        if len(there)
        else (float("nan"), float("nan"))
    )
    taken = min(n, MOST_DRAWN)
    if taken < n and np.isfinite(value):  # an infinite end stays one
        low, high = (narrowed(value, bound, taken, n) for bound in (low, high))
    note = ""
    if np.isinf(value):
        note = "no false positive"
    elif np.isnan(value):
        note = "neither hits nor false positives"
    return Hpfpps(
        value=value,
        se=float(narrowed(0.0, finite.std(ddof=1), taken, n)) if len(finite) > 1 else float("nan"),
        low=float(low),
        high=float(high),
        draws=draws,
        unbounded=draws - len(finite),
        n=len(rates),
        without_truth=without,
        note=note,
    )


def bootstrap_weights(rng: np.random.Generator | int, n: int, draws: int) -> Any:
    """Draw how often each of n trajectories stands in each bootstrap sample, (draws, n).

    An array; of more than MOST_DRAWN trajectories a sparse one, a sample of MOST_DRAWN a row.
    """
    generator = np.random.default_rng(rng)
    if n <= MOST_DRAWN:
        return generator.multinomial(n, np.full(n, 1 / n), size=draws)
    from scipy.sparse import csr_array  # most corpora do without it

    chosen = generator.integers(0, n, (draws, MOST_DRAWN), dtype=np.int32)
    ends = np.arange(draws + 1, dtype=np.int32) * MOST_DRAWN
    return csr_array((np.ones(chosen.size), chosen.ravel(), ends), shape=(draws, n))


def pooled_hpfpps(rates: Sequence[HitRate]) -> float:
    """Return eq. 17 of a group alone, as `hpfpps` does, without its bootstrap."""
    counts = _counts(rates)
    return float(_pooled(counts.sum(axis=0))) if len(counts) else float("nan")


def _counts(rates: Sequence[HitRate]) -> Floats:
    """Return hits, true boundaries, false positives, seconds, (n, 4), where there is truth."""
    return np.array(
        [
            (r.hits, r.hits + r.misses, r.false_positives, r.duration_s)
            for r in rates
            if r.hits + r.misses
        ],
        dtype=float,
    )


def _pooled(sums: Floats) -> Floats:
    """Return eq. 17 from sums of hits, true boundaries, false positives and seconds (..., 4)."""
    hits, true, false, seconds = np.moveaxis(np.asarray(sums, dtype=float), -1, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((hits / true) / (false / seconds))


# --- orders against each other ---------------------------------------------------------------


@dataclass(frozen=True)
class RankTest:
    """A rank test; `note` tells why statistic and p are NaN, empty where they are not."""

    test: str
    question: str
    statistic: float
    df: int
    p: float
    n: int
    note: str = ""


@dataclass(frozen=True)
class OrderTests:
    """Do orders differ in hits for each false positive a second? By ranks of trajectories.

    one_against_rest, all_orders: Kruskal-Wallis, as in the paper, which takes the values as
    independent although each trajectory stands in every order's group. friedman: the same
    question with the trajectory as a block. medians: median value of each order.
    left_out: values of 0/0 (neither hit nor false positive), by order; without_truth:
    trajectories without a true boundary; incomplete: blocks that Friedman's test goes without.
    """

    one_against_rest: RankTest
    all_orders: RankTest
    friedman: RankTest
    medians: Mapping[int, float]
    left_out: Mapping[int, int]
    without_truth: int
    incomplete: int


def compare_orders(rates: Mapping[int, Sequence[HitRate]], order: int = 3) -> OrderTests:
    """Test one order against the rest, and all against each other (section 3.2, Fig. 6).

    rates: hit rates of the same trajectories, in the same sequence, for each order. A
    trajectory with hits and no false positive has an infinite ratio: these are tied at the
    top rank. One with neither has no ratio (0/0): left out and counted.
    """
    lengths = {len(row) for row in rates.values()}
    if order not in rates or len(rates) < 2 or len(lengths) != 1:
        raise _error(
            f"orders {sorted(rates)} with {sorted(lengths)} trajectories",
            f"order {order} among at least two, the same trajectories for each",
        )
    orders = sorted(rates)
    table = np.array([[r.hpfpps for r in rates[o]] for o in orders]).T  # (trajectories, orders)
    no_truth = np.array(
        [[r.hits + r.misses == 0 for r in rates[o]] for o in orders], dtype=bool
    ).T.any(axis=1)
    table = table[~no_truth]
    gone = np.isnan(table)
    groups = {o: table[~gone[:, c], c] for c, o in enumerate(orders)}
    rest = np.concatenate([groups[o] for o in orders if o != order])
    complete = table[~gone.any(axis=1)]
    return OrderTests(
        one_against_rest=_kruskal(f"order {order} against the rest", [groups[order], rest]),
        all_orders=_kruskal("all orders against each other", list(groups.values())),
        friedman=_friedman("all orders against each other, within trajectories", complete),
        medians={o: _median(g) for o, g in groups.items()},
        left_out={o: int(gone[:, c].sum()) for c, o in enumerate(orders)},
        without_truth=int(no_truth.sum()),
        incomplete=len(table) - len(complete),
    )


def _median(values: Floats) -> float:
    """Return the median, a value that is there (the lower of two): infinity has no halves."""
    return float(np.sort(values)[(len(values) - 1) // 2]) if len(values) else float("nan")


def _kruskal(question: str, groups: list[Floats]) -> RankTest:
    from scipy.stats import kruskal, rankdata  # takes three times as long to import as numba

    name, df = "Kruskal-Wallis", len(groups) - 1
    values = np.concatenate(groups)
    n = len(values)
    if min(map(len, groups)) == 0:
        return _untested(name, question, df, n, "a group without a value")
    if len(np.unique(values)) == 1:
        return _untested(name, question, df, n, "all values are equal")
    # Ranks, since a sum with an infinite value is none; ranks of ranks are the same.
    ranks = np.split(rankdata(values), np.cumsum([len(g) for g in groups])[:-1])
    done = kruskal(*ranks)
    return RankTest(name, question, float(done.statistic), df, float(done.pvalue), n)


def _friedman(question: str, table: Floats) -> RankTest:
    from scipy.stats import friedmanchisquare, rankdata

    name, (n, orders) = "Friedman", table.shape
    if orders < 3 or n < 2:
        return _untested(name, question, orders - 1, n, "fewer than 3 orders or 2 trajectories")
    if (table == table[:, :1]).all():
        return _untested(name, question, orders - 1, n, "all values of each trajectory are equal")
    done = friedmanchisquare(*rankdata(table, axis=1).T)
    return RankTest(name, question, float(done.statistic), orders - 1, float(done.pvalue), n)


def _untested(name: str, question: str, df: int, n: int, note: str) -> RankTest:
    return RankTest(name, question, float("nan"), df, float("nan"), n, note)


# --- the line of no discrimination -----------------------------------------------------------


@dataclass(frozen=True, eq=False)
class ChanceLine:
    """What events thrown at random hit (section 3.1: "line of no discrimination").

    rate_per_s: (R,), rate lambda of the homogeneous Poisson process. hit_rate,
    false_positives_per_s: (R,), means over draws of the mean over trajectories. hit_rate_low,
    hit_rate_high: (R,), 95 % of the draws, each of which is a set of all trajectories.
    closed_form: (R,), 1 - exp(-2 w lambda), which knows neither one-to-one pairs nor edges.
    """

    rate_per_s: Floats
    hit_rate: Floats
    hit_rate_low: Floats
    hit_rate_high: Floats
    false_positives_per_s: Floats
    closed_form: Floats
    draws: int
    without_truth: int


def chance_line(
    truths_s: Sequence[ArrayLike],
    durations_s: Sequence[float],
    rng: np.random.Generator | int,
    rates_per_s: ArrayLike | None = None,
    window_s: float = WINDOW_S,
    draws: int = 200,
) -> ChanceLine:
    """Throw Poisson events at given trajectories, through the same matcher.

    truths_s: true boundaries of each trajectory, in s from its start. durations_s: how long
    each lasts. rates_per_s: rates of the process (None: 0 to 20 a second, 25 of them).
    draws: simulated sets of all trajectories at each rate.
    Trajectories without a true boundary have no hit rate; their false positives count.
    """
    rates = np.linspace(0, 20, 25) if rates_per_s is None else _times(rates_per_s, "rates_per_s")
    truths = [np.sort(_times(truth, "truths_s")) for truth in truths_s]
    durations = np.asarray(durations_s, dtype=float)
    if len(truths) != len(durations) or not (durations > 0).all() or not any(map(len, truths)):
        raise _error(
            f"{len(truths)} sets of true boundaries and {len(durations)} durations",
            "as many of each, durations above 0, some true boundary",
        )
    if (rates < 0).any() or draws < 1 or not window_s >= 0:
        raise _error("a rate, window or number of draws below 0", "rates and windows from 0")
    generator = np.random.default_rng(rng)
    true = np.array([len(truth) for truth in truths], dtype=np.int64)
    flat = np.concatenate(truths)
    hit = np.empty((len(rates), draws))
    false = np.empty((len(rates), draws))
    there = true > 0
    repeated = np.tile(flat, draws), np.tile(true, draws)
    for r, events_per_s in enumerate(rates):
        events = generator.poisson(events_per_s * durations, size=(draws, len(durations))).ravel()
        times = generator.uniform(size=events.sum()) * np.repeat(np.tile(durations, draws), events)
        hits = hits_of_many(times, events, *repeated, window_s + TOLERANCE_S).reshape(draws, -1)
        hit[r] = np.mean(hits[:, there] / true[there], axis=1)
        false[r] = np.mean((events.reshape(draws, -1) - hits) / durations, axis=1)
    low, high = np.percentile(hit, INTERVAL, axis=1)
    return ChanceLine(
        rate_per_s=rates,
        hit_rate=hit.mean(axis=1),
        hit_rate_low=low,
        hit_rate_high=high,
        false_positives_per_s=false.mean(axis=1),
        closed_form=1 - np.exp(-2 * window_s * rates),
        draws=draws,
        without_truth=int(np.count_nonzero(true == 0)),
    )


def _times(values: ArrayLike, name: str) -> Floats:
    times = unmasked(values)
    if times.ndim != 1 or not np.isfinite(times).all():
        raise SignkinError(
            f"{name} has shape {times.shape} and {np.count_nonzero(~np.isfinite(times))} gaps",
            place="hit_rate",
            expected="(N,) numbers",
        )
    return np.ascontiguousarray(times)


def _error(found: str, expected: str) -> SignkinError:
    return SignkinError(found, place="hit_rate", expected=expected)
