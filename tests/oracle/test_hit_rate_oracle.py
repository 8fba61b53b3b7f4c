"""Matching and chance against brute force, scipy's assignment and closed forms."""

from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from signkin.binning import HitRate, chance_line, hpfpps, match
from signkin.binning.hit_rate import TOLERANCE_S
from signkin.binning.pairs import hits_of_many

WINDOW = 0.09
times = st.lists(st.integers(0, 60).map(lambda n: n / 40), max_size=14)  # with ties and edges


def score(predicted, truth):
    p, t = match(predicted, truth, WINDOW)
    return len(p), float(np.abs(np.asarray(predicted)[p] - np.asarray(truth)[t]).sum())


@given(st.lists(st.floats(0, 1), max_size=4), st.lists(st.floats(0, 1), max_size=4))
def test_against_every_possible_pairing(predicted, truth):
    best = (0, 0.0)
    for n in range(1, min(len(predicted), len(truth)) + 1):
        for a in combinations(predicted, n):
            for b in permutations(truth, n):
                apart = [abs(x - y) for x, y in zip(a, b, strict=True)]
                if max(apart) <= WINDOW + TOLERANCE_S:
                    best = max(best, (n, -sum(apart)))
    found = score(predicted, truth)
    assert found[0] == best[0]
    assert found[1] == pytest.approx(-best[1], abs=1e-12)


@given(times, times)
def test_against_the_hungarian_method(predicted, truth):
    if not predicted or not truth:
        return
    apart = np.abs(np.subtract.outer(predicted, truth))
    cost = np.where(apart <= WINDOW + TOLERANCE_S, apart - 1000, 0.0)  # a pair is worth 1000 s
    rows, columns = linear_sum_assignment(cost)
    chosen = cost[rows, columns] < 0
    found = score(predicted, truth)
    assert found[0] == chosen.sum()
    assert found[1] == pytest.approx(apart[rows, columns][chosen].sum(), abs=1e-9)


@given(st.lists(st.tuples(times, times), min_size=1, max_size=4))
def test_counting_alone_finds_as_many_pairs(trajectories):
    predicted, truth = zip(*trajectories, strict=True)
    counts = [np.array([len(x) for x in side], dtype=np.int64) for side in (predicted, truth)]
    flat = [
        np.concatenate([np.sort(np.array(x, dtype=float)) for x in s]) for s in (predicted, truth)
    ]
    found = hits_of_many(flat[0], counts[0], flat[1], counts[1], WINDOW + TOLERANCE_S)
    assert found.tolist() == [score(p, t)[0] for p, t in trajectories]


def test_chance_where_the_closed_form_holds():
    """One true boundary far from the edges competes with nothing."""
    rates = np.array([1.0, 5.0, 12.0])
    line = chance_line([[1.0]] * 400, [2.0] * 400, 1, rates, draws=100)
    assert line.closed_form == pytest.approx(1 - np.exp(-0.18 * rates))
    assert line.hit_rate == pytest.approx(line.closed_form, abs=0.005)
    assert line.false_positives_per_s == pytest.approx(rates - line.hit_rate / 2, abs=0.05)
    # the interval is that of means of 400 Bernoulli trials
    sd = np.sqrt(line.closed_form * (1 - line.closed_form) / 400)
    assert line.hit_rate_high - line.hit_rate_low == pytest.approx(2 * 1.96 * sd, rel=0.3)


def test_chance_where_it_does_not():
    at_the_edge = chance_line([[0.0]] * 400, [2.0] * 400, 1, [5.0], draws=50)
    assert at_the_edge.hit_rate == pytest.approx(1 - np.exp(-0.09 * 5), abs=0.01)
    # Two boundaries at one place: hits are min(N, 2), N Poisson.
    double = chance_line([[1.0, 1.0]] * 400, [2.0] * 400, 1, [5.0], draws=50)
    mean = 0.18 * 5
    none, one = np.exp(-mean), mean * np.exp(-mean)
    assert double.hit_rate == pytest.approx((one + 2 * (1 - none - one)) / 2, abs=0.01)
    assert double.hit_rate[0] < double.closed_form[0] - 0.05


def test_bootstrap_error_against_the_delta_method():
    rng = np.random.default_rng(7)
    hits = rng.binomial(2, 0.7, 300)
    false = rng.poisson(2.0, 300)
    rates = [HitRate(int(h), 2 - int(h), int(f), 1.5) for h, f in zip(hits, false, strict=True)]
    found = hpfpps(rates, 1, draws=4000)
    x, y = hits / 2, false / 1.5
    value = x.mean() / y.mean()
    error = np.std(x - value * y, ddof=1) / y.mean() / np.sqrt(300)
    assert found.value == pytest.approx(value)
    assert found.se == pytest.approx(error, rel=0.06)
    assert found.unbounded == 0
    assert (found.low, found.high) == pytest.approx(
        (value - 1.96 * error, value + 1.96 * error), rel=0.03
    )
