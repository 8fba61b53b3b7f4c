"""Comparisons clustered by signer and sign, and verdicts: how often they are wrong."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from signkin.audit.verdicts import (
    Verdict,
    across,
    from_interval,
    from_probability,
    of_simulation,
)
from signkin.errors import SignkinError
from signkin.resampling import difference, peak

NAN = float("nan")


def recordings(rng, signers=8, signs=10, repeats=2, columns=1, sd=(1.0, 1.0, 1.0)):
    """Values with a share of each signer and each sign in every column, and their labels."""
    who, what = (
        x.ravel()
        for x in np.meshgrid(range(signers), np.repeat(range(signs), repeats), indexing="ij")
    )
    values = (
        sd[0] * rng.normal(size=(signers, columns))[who]
        + sd[1] * rng.normal(size=(signs, columns))[what]
        + sd[2] * rng.normal(size=(len(who), columns))
    )
    return values, {"signer": who.tolist(), "sign": what.tolist()}


def test_a_difference_by_hand():
    a, b = np.array([1.0, 2, 3, NAN]), np.array([0.5, 1, 2.5, 1])
    found = difference(a, b, {"signer": ["p", "p", "q", "q"]}, 200, np.random.default_rng(0))
    assert found.value == pytest.approx(2 / 3)
    assert (found.n, found.left_out, found.clusters) == (3, 1, {"signer": 2})
    assert found.low < 0 < found.value < found.high  # two signers: nothing is decided


def test_a_constant_difference_has_no_spread_whatever_the_offset():
    values, clusters = recordings(np.random.default_rng(1))
    found = difference(values[:, 0] + 1e6, values[:, 0] + 1e6 - 2, clusters, 200,
                       np.random.default_rng(0))  # fmt: skip
    assert (found.low, found.value, found.high) == pytest.approx((2, 2, 2))
    assert found.above == 1


def test_the_spread_is_that_of_the_weighted_mean():
    """One kind of cluster: the SD of draws is that of the bootstrap's closed form."""
    rng = np.random.default_rng(4)
    values, who = rng.normal(size=60), np.repeat(range(20), 3)
    found = difference(values, np.zeros(60), {"signer": who.tolist()}, 20_000, rng)
    means = values.reshape(20, 3).mean(axis=1)
    from scipy import stats

    half = stats.t.ppf(0.975, 19) * means.std(ddof=1) / np.sqrt(20)
    assert (found.high - found.low) / 2 == pytest.approx(half, rel=0.05)


def test_false_verdicts_come_at_most_at_the_nominal_rate():
    """No difference in truth: `holds` and `fails` in at most 2.5 % each, undecided else."""
    runs, verdicts, naive = 300, [], 0
    for seed in range(runs):
        rng = np.random.default_rng(seed)
        values, clusters = recordings(rng)
        found = difference(values[:, 0], np.zeros(len(values)), clusters, 300, rng)
        verdicts.append(from_interval(found.low, found.high))
        alone = values[:, 0].mean() / (values[:, 0].std(ddof=1) / np.sqrt(len(values)))
        naive += abs(alone) > 1.96
    for wrong in (Verdict.HOLDS, Verdict.FAILS):
        assert verdicts.count(wrong) / runs <= 0.025 + 3 * np.sqrt(0.025 * 0.975 / runs)
    assert naive / runs > 0.4  # recordings taken one by one


def test_a_large_difference_is_decided():
    right = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        values, clusters = recordings(rng)
        found = difference(values[:, 0] + 3, np.zeros(len(values)), clusters, 200, rng)
        right += from_interval(found.low, found.high) is Verdict.HOLDS
    assert right >= 38


def test_a_tie_is_no_peak_at_the_nominal_rate():
    """Two of three alternatives are equally high: neither is the peak but in 5 % of cases."""
    runs, decided = 200, 0
    for seed in range(runs):
        rng = np.random.default_rng(seed)
        values, clusters = recordings(rng, columns=3)
        found = peak(values + np.array([0, 0, -20]), (3, 4, 5), clusters, 300, rng)
        assert found.probability.sum() == pytest.approx(1)
        decided += from_probability(found.probability_of(3)) is not Verdict.UNDECIDED
        assert found.probability_of(5) == 0
    assert decided / runs <= 0.05 + 3 * np.sqrt(0.05 * 0.95 / runs)


def test_a_clear_peak_is_found_and_told_with_its_neighbours():
    rng = np.random.default_rng(3)
    values, clusters = recordings(rng, columns=4, sd=(0.1, 0.1, 0.3))
    found = peak(values + np.array([0, 1, 3, 1]), range(4), clusters, 300, rng)
    assert found.at == 2 and found.probability_of(2) == 1
    assert found.probability_of(1, 2, 3) == 1
    assert from_probability(found.probability_of(2)) is Verdict.HOLDS
    assert from_probability(found.probability_of(0, 1)) is Verdict.FAILS
    with pytest.raises(SignkinError, match="9 is no alternative"):
        found.probability_of(9)


def test_ties_within_a_draw_are_shared():
    found = peak(np.ones((6, 2)), "ab", {"signer": list("ppqqrr")}, 50, np.random.default_rng(0))
    assert found.probability.tolist() == [0.5, 0.5]


def test_too_few_clusters_are_one_sentence_and_no_number():
    rng = np.random.default_rng(0)
    with pytest.raises(SignkinError, match="1 signer with numbers to compare"):
        difference([1, 2], [0, 0], {"signer": ["p", "p"]}, 10, rng)
    with pytest.raises(SignkinError, match="1 sign with numbers to compare"):
        difference([1, 2, NAN], [0, 0, 0], {"signer": list("pqr"), "sign": list("aab")}, 10, rng)
    with pytest.raises(SignkinError, match="0 signer with numbers"):
        difference([NAN], [0], {"signer": ["p"]}, 10, rng)
    with pytest.raises(SignkinError, match="1 labels of signer for 2 pairs"):
        difference([1, 2], [0, 0], {"signer": ["p"]}, 10, rng)
    with pytest.raises(SignkinError, match=r"values of shape \(2,\) for 2 alternatives"):
        peak([1, 2], "ab", {"signer": ["p", "q"]}, 10, rng)


def test_the_same_stream_gives_the_same_numbers():
    values, clusters = recordings(np.random.default_rng(1))
    a, b = (
        difference(values[:, 0], values[:, 0] ** 2, clusters, 100, np.random.default_rng(7))
        for _ in range(2)
    )
    assert a == b


# --- verdicts


@given(st.floats(-5, 5), st.floats(0, 5), st.floats(-5, 5))
def test_an_interval_decides_only_what_it_leaves_on_one_side(low, width, bound):
    found = from_interval(low, low + width, bound)
    assert (found is Verdict.UNDECIDED) == (low <= bound <= low + width)
    assert (found is Verdict.HOLDS) == (low > bound)


def test_what_is_no_number_is_not_testable_and_what_is_no_interval_an_error():
    assert from_interval(NAN, NAN) is Verdict.NOT_TESTABLE
    assert from_probability(NAN) is Verdict.NOT_TESTABLE
    with pytest.raises(SignkinError, match="the interval goes from 2 to 1"):
        from_interval(2, 1)
    with pytest.raises(SignkinError, match=r"a probability of 1\.2"):
        from_probability(1.2)


def test_readings_that_disagree_make_it_depend():
    found = across({"V": Verdict.HOLDS, "W": Verdict.FAILS, "X": Verdict.HOLDS})
    assert found.verdict is Verdict.DEPENDS
    assert found.share(Verdict.HOLDS) == pytest.approx(2 / 3)
    assert found.why() == "holds under 2 of 3 readings (V, X); fails under 1 of 3 readings (W)"
    silent = across({"V": Verdict.HOLDS, "W": Verdict.NOT_TESTABLE})
    assert silent.verdict is Verdict.HOLDS and silent.share(Verdict.HOLDS) == 1
    assert across({"V": Verdict.UNDECIDED, "W": Verdict.HOLDS}).verdict is Verdict.DEPENDS
    assert across({"V": Verdict.NOT_TESTABLE}).verdict is Verdict.NOT_TESTABLE
    with pytest.raises(SignkinError, match="no reading"):
        across({})


def test_a_simulation_made_with_the_print_is_no_evidence_for_it():
    assert of_simulation(Verdict.HOLDS, True) is Verdict.BY_CONSTRUCTION
    assert of_simulation(Verdict.HOLDS, False) is Verdict.HOLDS
    assert of_simulation(Verdict.FAILS, True) is Verdict.FAILS
