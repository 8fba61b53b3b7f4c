import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from signkin import SignkinError
from signkin.binning import (
    HitRate,
    chance_line,
    compare_orders,
    group_rates,
    hit_rate,
    hpfpps,
    match,
)
from signkin.binning.shifted import Shifted, shifted_hits, shifted_rates

NAN, INF = float("nan"), float("inf")

times = st.lists(st.floats(0, 3), max_size=12)


def pairs(predicted, truth, window=0.09):
    p, t = match(predicted, truth, window)
    return list(zip(p.tolist(), t.tolist(), strict=True))


# --- matching


def test_each_boundary_is_paired_once():
    assert pairs([0.5, 0.52], [0.51]) in ([(0, 0)], [(1, 0)])
    assert pairs([0.5], [0.45, 0.51]) == [(0, 1)]


def test_more_pairs_go_before_near_ones():
    """The nearest pair, 0.58 with 0.60, would leave the other two alone."""
    assert pairs([0.50, 0.58], [0.60, 0.66], 0.1) == [(0, 0), (1, 1)]


def test_of_as_many_pairs_the_nearer():
    assert pairs([0.43, 0.5], [0.51]) == [(1, 0)]


def test_the_window_is_a_half_width_and_its_edge_is_inside():
    assert pairs([0.59], [0.5]) == pairs([0.41], [0.5]) == [(0, 0)]
    assert 0.1 + 0.2 - 0.21 > 0.09  # what floating point makes of an edge
    assert pairs([0.1 + 0.2], [0.21]) == [(0, 0)]
    assert pairs([0.5901], [0.5]) == []
    assert pairs([0.5], [0.5], 0.0) == [(0, 0)]


def test_nothing_to_pair():
    assert pairs([], [0.5]) == pairs([0.5], []) == pairs([], []) == []


@given(times, times, st.randoms(use_true_random=False))
def test_the_order_of_the_input_does_not_matter(predicted, truth, random):
    def distance(p, t):
        return sum(abs(p[i] - t[j]) for i, j in pairs(p, t))

    shuffled = random.sample(predicted, len(predicted)), random.sample(truth, len(truth))
    assert len(pairs(*shuffled)) == len(pairs(predicted, truth))
    assert distance(*shuffled) == pytest.approx(distance(predicted, truth))
    assert distance(truth, predicted) == pytest.approx(distance(predicted, truth))
    found = pairs(predicted, truth)
    assert len({i for i, _ in found}) == len({j for _, j in found}) == len(found)
    assert all(abs(predicted[i] - truth[j]) <= 0.09 + 1e-6 for i, j in found)


@pytest.mark.parametrize("wrong", [[NAN], [[0.1]]])
def test_times_that_are_none_are_refused(wrong):
    with pytest.raises(SignkinError, match="predicted_s"):
        match(wrong, [0.1])
    with pytest.raises(SignkinError, match="window"):
        match([0.1], [0.1], -1.0)


# --- one trajectory


def test_hits_misses_and_false_positives():
    found = hit_rate([0.31, 0.33, 1.0], [0.3, 0.7], duration_s=1.5)
    assert (found.hits, found.misses, found.false_positives) == (1, 1, 2)
    assert found.hit_rate == 0.5
    assert found.false_positives_per_s == pytest.approx(2 / 1.5)
    assert found.hpfpps == pytest.approx(0.5 / (2 / 1.5))
    assert found.note == ""


def test_without_truth_there_is_no_hit_rate():
    found = hit_rate([0.3], [], duration_s=2.0)
    assert np.isnan(found.hit_rate)
    assert np.isnan(found.hpfpps)
    assert found.false_positives_per_s == 0.5
    assert found.note == "no true boundary"
    with pytest.raises(SignkinError, match="duration"):
        hit_rate([0.3], [], duration_s=0)


def test_eq_17_of_one_trajectory():
    assert HitRate(2, 0, 0, 1.0).hpfpps == INF
    assert np.isnan(HitRate(0, 2, 0, 1.0).hpfpps)
    assert HitRate(0, 2, 3, 1.0).hpfpps == 0


# --- groups

GOOD, FALSE, BOTH, NEITHER = (
    HitRate(2, 0, 0, 1.5), HitRate(0, 2, 3, 1.5), HitRate(1, 1, 1, 1.5), HitRate(0, 2, 0, 1.5)
)  # fmt: skip
NO_TRUTH = HitRate(0, 0, 1, 1.5, "no true boundary")


def test_means_over_trajectories():
    found = group_rates([GOOD, FALSE, BOTH, NO_TRUTH])
    assert found.hit_rate == pytest.approx(0.5)
    assert found.hit_rate_se == pytest.approx(0.5 / np.sqrt(3))
    assert found.false_positives_per_s == pytest.approx((0 + 3 + 1 + 1) / 1.5 / 4)
    assert (found.n, found.without_truth) == (4, 1)
    assert np.isnan(group_rates([NO_TRUTH]).hit_rate)
    assert np.isnan(group_rates([GOOD]).hit_rate_se)


def test_eq_17_is_pooled():
    found = hpfpps([GOOD, FALSE, BOTH, NO_TRUTH], 0, draws=500)
    assert found.value == pytest.approx((3 / 6) / (4 / 4.5))
    assert (found.n, found.without_truth, found.note) == (4, 1, "")
    assert found.low <= found.value <= found.high
    assert found == hpfpps([GOOD, FALSE, BOTH, NO_TRUTH], 0, draws=500)
    # (1/3)^3 of the bootstrap's draws take GOOD three times
    assert found.unbounded / 500 == pytest.approx(1 / 27, abs=0.03)


def test_draws_of_some_trajectories_tell_what_draws_of_all_would(monkeypatch):
    rng = np.random.default_rng(5)
    counts = zip(rng.integers(0, 5, 400), rng.integers(1, 4, 400), rng.integers(0, 4, 400),
                 strict=True)  # fmt: skip
    rates = [HitRate(int(h), int(m), int(f), 1.0 + i / 400) for i, (h, m, f) in enumerate(counts)]
    whole = hpfpps(rates, 3)
    monkeypatch.setattr(sys.modules[HitRate.__module__], "MOST_DRAWN", 100)
    some = hpfpps(rates, 3)
    assert some.value == whole.value and some.se != whole.se
    assert some.se == pytest.approx(whole.se, rel=0.1)
    widths = [found.high - found.low for found in (some, whole)]
    assert widths[0] == pytest.approx(widths[1], rel=0.1)
    assert some.low < some.value < some.high
    no_false = hpfpps([HitRate(1, 1, 0, 1.0)] * 101, 3)  # an infinite end stays one
    assert (no_false.low, no_false.high, no_false.unbounded) == (np.inf, np.inf, 2000)


def test_eq_17_without_false_positives_hits_or_truth():
    found = hpfpps([GOOD, GOOD], 0)
    assert found.value == found.low == found.high == INF
    assert np.isnan(found.se)
    assert (found.note, found.unbounded) == ("no false positive", found.draws)
    assert hpfpps([NEITHER], 0).note == "neither hits nor false positives"
    nothing = hpfpps([NO_TRUTH], 0)
    assert np.isnan(nothing.value)
    assert nothing.note == "no true boundary"
    assert nothing.without_truth == 1


# --- orders


def test_infinite_ratios_tie_at_the_top_and_empty_ones_are_counted():
    rates = {
        2: [FALSE, BOTH, BOTH, NEITHER, NO_TRUTH],
        3: [GOOD, GOOD, GOOD, GOOD, NO_TRUTH],
        4: [BOTH, GOOD, BOTH, BOTH, NO_TRUTH],
    }
    found = compare_orders(rates)
    assert found.left_out == {2: 1, 3: 0, 4: 0}
    assert (found.without_truth, found.incomplete) == (1, 1)
    assert found.medians == {2: 0.75, 3: INF, 4: 0.75}
    assert (found.one_against_rest.n, found.all_orders.n, found.friedman.n) == (11, 11, 3)
    assert (found.one_against_rest.df, found.all_orders.df, found.friedman.df) == (1, 2, 2)
    # any finite number above all others instead of the infinite ones is the same
    from scipy.stats import friedmanchisquare, kruskal

    top, mid = 99.0, 0.75
    told = kruskal([top] * 4, [0, mid, mid, mid, top, mid, mid])
    assert found.one_against_rest.statistic == pytest.approx(told.statistic)
    assert found.one_against_rest.p == pytest.approx(told.pvalue)
    told = kruskal([0, mid, mid], [top] * 4, [mid, top, mid, mid])
    assert found.all_orders.p == pytest.approx(told.pvalue)
    told = friedmanchisquare([0, mid, mid], [top] * 3, [mid, top, mid])
    assert found.friedman.p == pytest.approx(told.pvalue)


def test_what_cannot_be_tested_says_why():
    same = compare_orders({2: [GOOD, GOOD], 3: [GOOD, GOOD], 4: [GOOD, GOOD]})
    assert np.isnan(same.all_orders.p)
    assert same.all_orders.note == "all values are equal"
    assert same.friedman.note == "all values of each trajectory are equal"
    empty = compare_orders({2: [NEITHER], 3: [GOOD]})
    assert empty.one_against_rest.note == "a group without a value"
    assert empty.friedman.note.startswith("fewer than 3")
    assert np.isnan(empty.medians[2])
    with pytest.raises(SignkinError, match="order 3"):
        compare_orders({2: [GOOD], 4: [GOOD]})
    with pytest.raises(SignkinError, match="same trajectories"):
        compare_orders({2: [GOOD], 3: [GOOD, GOOD]})


# --- chance


def test_chance_depends_on_its_seed_alone_and_rises_with_the_rate():
    truths, durations = [[0.4, 1.0], [0.5], []], [1.5, 1.2, 1.0]
    line = chance_line(truths, durations, 3, [0.0, 2.0, 8.0], draws=300)
    again = chance_line(truths, durations, 3, [0.0, 2.0, 8.0], draws=300)
    assert (line.hit_rate == again.hit_rate).all()
    assert line.hit_rate[0] == line.false_positives_per_s[0] == 0
    assert (np.diff(line.hit_rate) > 0).all()
    assert (line.hit_rate_low <= line.hit_rate).all()
    assert (line.hit_rate <= line.hit_rate_high).all()
    assert line.without_truth == 1
    # events that hit are no false positives
    assert (line.false_positives_per_s < line.rate_per_s).tolist() == [False, True, True]


@pytest.mark.parametrize(
    ("truths", "durations", "rates"),
    [([[0.1]], [1.0, 2.0], [1.0]), ([[]], [1.0], [1.0]), ([[0.1]], [1.0], [-1.0])],
)
def test_chance_of_nothing_is_refused(truths, durations, rates):
    with pytest.raises(SignkinError, match="hit_rate"):
        chance_line(truths, durations, 1, rates)


# --- the same boundaries, shifted in a circle


def test_shifted_boundaries_hit_by_what_their_windows_cover():
    """One boundary and one truth: the window's share of the circle; two of each: twice that."""
    one = shifted_hits([0.7], [1.1], 0.09, duration_s=2.0)
    assert one.mean == pytest.approx(2 * 0.09 / 2, abs=0.006)
    assert one.sd == pytest.approx(np.sqrt(one.mean * (1 - one.mean)))
    # Two that stand as far apart as the true ones hit both or none; others one at a time.
    same = shifted_hits([0.2, 0.8], [0.9, 1.5], 0.09, duration_s=2.0)
    other = shifted_hits([0.2, 1.2], [0.9, 1.5], 0.09, duration_s=2.0)
    for found in (same, other):
        assert found.mean == pytest.approx(4 * 0.09 * 2 / 2, abs=0.012)
    assert same.sd > other.sd
    # Evenly spaced ones a window apart hit wherever they are: Poisson events would not.
    even = shifted_hits(np.arange(0, 2, 0.18), [0.9], 0.09, duration_s=2.0)
    assert even.mean > 0.97 > 1 - np.exp(-11 * 0.18 / 2) + 0.3


def test_shifted_boundaries_of_no_movement_are_an_error_and_none_hit_nothing():
    assert shifted_hits([], [0.5], 0.09, duration_s=2.0) == Shifted(0.0, 0.0)
    assert shifted_hits([0.5], [], 0.09, duration_s=2.0) == Shifted(0.0, 0.0)
    with pytest.raises(SignkinError, match="a duration of 0 s"):
        shifted_hits([0.5], [0.5], 0.09, duration_s=0.0)


def test_a_group_shifted_by_hand():
    found = shifted_rates(
        [Shifted(1.0, 0.5), Shifted(0.5, 0.5), Shifted(0.0, 0.0)], [2, 2, 0], [3, 2, 4], [2, 1, 1]
    )  # fmt: skip
    assert found.hit_rate == pytest.approx(0.375)
    assert found.high - found.hit_rate == pytest.approx(1.96 * np.sqrt(2 * 0.25**2) / 2, rel=1e-3)
    assert found.hpfpps == pytest.approx((1.5 / 4) / (3.5 / 3))
    assert np.isnan(shifted_rates([Shifted(0.0, 0.0)], [0], [3], [1.0]).hit_rate)
    assert np.isnan(shifted_rates([Shifted(0.0, 0.0)], [1], [0], [1.0]).hpfpps)
