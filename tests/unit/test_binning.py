import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from scipy.special import logsumexp

from signkin import SignkinError
from signkin.binning import Posterior, Prior, fit, fit_many, segment_log_evidence
from signkin.binning.band import fit_order_in_band
from signkin.binning.fitting import log_evidence
from signkin.binning.maxima import greedy_maxima
from signkin.binning.segmentation_prior import log_prior_of

PRIOR = Prior(noise_sd=0.5)
seeds = st.integers(0, 2**32 - 1)
few = settings(max_examples=15, deadline=None, derandomize=True)


def walk(bins, dims, seed, size=1.0):
    x = np.random.default_rng(seed).normal(size=(bins, dims)).cumsum(0) * size
    return x - x.mean(0)


def same(a: Posterior, b: Posterior, **tolerance) -> None:
    """Compare all of two posteriors of data in the same coordinates."""
    assert a.orders == b.orders
    assert a.log_evidence == pytest.approx(b.log_evidence, **tolerance)
    for order in a.orders:
        row, other = a.orders.index(order), b.orders.index(order)
        by_count = a.log_evidence_by_count[row], b.log_evidence_by_count[other]
        assert by_count[0] == pytest.approx(by_count[1], **tolerance)
        for what in ("count_probability", "boundary_probability", "expected_trajectory"):
            values = [getattr(posterior, what)(order) for posterior in (a, b)]
            assert values[0] == pytest.approx(values[1], **tolerance)
        noise = [posterior.noise_covariance(order) for posterior in (a, b)]
        assert noise[0] == pytest.approx(noise[1], **tolerance)


# --- what must not change, and what must


@few
@given(seeds, st.integers(5, 40))
def test_turning_the_data_turns_the_expectation_and_nothing_else(seed, bins):
    x = walk(bins, 3, seed)
    turn = Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
    a, b = (fit(data, (0, 2, 4), PRIOR) for data in (x, x @ turn.T))
    assert a.log_evidence_by_count == pytest.approx(b.log_evidence_by_count, abs=1e-8)
    for order in (0, 2, 4):
        assert a.boundary_probability(order) == pytest.approx(
            b.boundary_probability(order), abs=1e-8
        )
        assert a.expected_trajectory(order) @ turn.T == pytest.approx(
            b.expected_trajectory(order), abs=1e-8
        )
        turned = turn @ a.noise_covariance(order) @ turn.T
        assert turned == pytest.approx(b.noise_covariance(order), abs=1e-8)


@few
@given(seeds, st.integers(2, 40), st.integers(1, 4), st.floats(1e-4, 1e4))
def test_another_unit_of_length_changes_densities_by_the_jacobian_alone(seed, bins, dims, factor):
    x = walk(bins, dims, seed)
    a = fit(x, (0, 1), PRIOR)
    b = fit(x * factor, (0, 1), Prior(noise_sd=0.5 * factor))
    shift = bins * dims * np.log(factor)
    assert b.log_evidence_by_count + shift == pytest.approx(a.log_evidence_by_count, abs=1e-8)
    assert b.order_probability == pytest.approx(a.order_probability, abs=1e-8)
    for order in (0, 1):
        assert b.boundary_probability(order) == pytest.approx(
            a.boundary_probability(order), abs=1e-8
        )
        assert b.expected_trajectory(order) / factor == pytest.approx(
            a.expected_trajectory(order), abs=1e-8
        )
        assert b.noise_covariance(order) / factor**2 == pytest.approx(
            a.noise_covariance(order), abs=1e-8
        )


@few
@given(seeds, st.permutations(range(4)))
def test_the_order_of_the_dimensions_does_not_matter(seed, order):
    x = walk(25, 4, seed)
    noise = np.array([0.2, 0.5, 1.0, 3.0])
    a = fit(x, (0, 3), Prior(noise_sd=tuple(noise)))
    b = fit(x[:, order], (0, 3), Prior(noise_sd=tuple(noise[order])))
    assert a.log_evidence_by_count == pytest.approx(b.log_evidence_by_count, abs=1e-8)
    for s in (0, 3):
        assert a.expected_trajectory(s)[:, order] == pytest.approx(
            b.expected_trajectory(s), abs=1e-8
        )
        covariance = a.noise_covariance(s)[np.ix_(order, order)]
        assert covariance == pytest.approx(b.noise_covariance(s), abs=1e-8)


@few
@given(seeds, st.lists(st.integers(0, 9), min_size=1, max_size=4, unique=True))
def test_orders_asked_together_are_as_each_asked_alone(seed, orders):
    x = walk(30, 3, seed)
    together = fit(x, orders, PRIOR)
    alone = [fit(x, (order,), PRIOR) for order in orders]
    for i, (order, one) in enumerate(zip(orders, alone, strict=True)):
        assert together.log_evidence_by_count[i] == pytest.approx(one.log_evidence_by_count[0])
        assert together.boundary_probability(order) == pytest.approx(
            one.boundary_probability(order), abs=1e-12
        )
        assert together.expected_trajectory(order) == pytest.approx(
            one.expected_trajectory(order), abs=1e-10
        )
    evidence = np.array([one.log_evidence[0] for one in alone])
    assert together.order_probability == pytest.approx(np.exp(evidence - logsumexp(evidence)))


@few
@given(seeds, st.sampled_from([None, 6]))
def test_probabilities_are_consistent_with_one_another(seed, longest):
    found = fit(walk(40, 2, seed, 0.3), (0, 1, 2), PRIOR, max_segment_bins=longest)
    assert found.order_probability.sum() == pytest.approx(1)
    for order in found.orders:
        count, boundary = found.count_probability(order), found.boundary_probability(order)
        assert count.sum() == pytest.approx(1)
        assert ((boundary >= 0) & (boundary <= 1 + 1e-12)).all()
        assert boundary.sum() == pytest.approx(count @ np.arange(len(count)))
        assert (np.linalg.eigvalsh(found.noise_covariance(order)) > 0).all()


def test_boundaries_are_as_many_as_expected_where_every_bin_is_a_segment():
    found = fit(walk(40, 2, 27, 3.0), (3,), PRIOR)
    assert found.map_count(3) == 39
    expected = found.count_probability(3) @ np.arange(40)
    assert found.boundary_probability(3).sum() == pytest.approx(expected)


def test_a_posterior_with_peaks_at_few_and_at_all_boundaries_is_no_error():
    found = fit(walk(100, 2, 3, 3.0), (5,), PRIOR)
    count = found.count_probability(5)
    assert count.sum() == pytest.approx(1)
    assert count[:50].sum() > 1e-3 and count[50:].sum() > 1e-3
    assert found.boundary_probability(5).sum() == pytest.approx(count @ np.arange(100))


def test_the_evidence_of_one_segment_is_that_of_no_boundary():
    x = walk(20, 3, 4)
    found = fit(x, (2,), PRIOR)
    assert found.log_evidence_by_count[0, 0] == pytest.approx(
        segment_log_evidence(x, 2, PRIOR)[0, -1], rel=1e-12
    )


@pytest.mark.parametrize("workers", [1, 2])
def test_many_are_each_bitwise_as_alone(workers):
    data = [walk(bins, 3, bins) for bins in (8, 40, 33, 100, 41)]
    many = fit_many(data, prior=PRIOR, workers=workers)
    for x, found in zip(data, many, strict=True):
        alone = fit(x, prior=PRIOR)
        for field in ("log_evidence_by_count", "log_evidence", "order_probability", "cut_mass",
                      "_count_probability", "_boundary", "_mean", "_noise"):  # fmt: skip
            assert getattr(found, field).tobytes() == getattr(alone, field).tobytes()


def test_fitting_leaves_the_data_alone_and_keeps_no_tie_to_the_order_of_memory():
    x = walk(30, 3, 1)
    before = x.copy()
    a, b = fit(x, (0, 3), PRIOR), fit(np.asfortranarray(x), (0, 3), PRIOR)
    assert (x == before).all()
    same(a, b, rel=0, abs=0)
    same(a, pickle.loads(pickle.dumps(a)), rel=0, abs=0)


# --- what is left out is accounted for


@few
@given(seeds, st.integers(0, 30), st.floats(0.05, 3))
def test_fewer_counts_agree_and_the_cut_is_within_its_bound(seed, most, size):
    x = walk(45, 2, seed, size)
    orders = (0, 1, 4)
    every, some = fit(x, orders, PRIOR), fit(x, orders, PRIOR, max_count=most)
    assert some.log_evidence_by_count.shape == (3, most + 1)
    assert some.log_evidence_by_count == pytest.approx(
        every.log_evidence_by_count[:, : most + 1], abs=1e-8
    )
    assert (every.cut_mass == 0).all()
    for i, order in enumerate(orders):
        left_out = every.count_probability(order)[most + 1 :].sum()
        # The bound is on the share in terms of what was kept.
        ratio = left_out / max(1 - left_out, 1e-300)
        assert min(1.0, ratio) <= some.cut_mass[i] * (1 + 1e-9) + 1e-12


@few
@given(
    seeds, st.sampled_from([None, 9, 30]), st.floats(-2, 3), st.sampled_from([None, 5.0, 1000.0]),
    st.sampled_from([1e-3, 0.1, 10.0]),
)  # fmt: skip
def test_counts_that_cannot_matter_may_be_left_out(seed, longest, size, dof, concentration):
    x, orders = walk(60, 2, seed, 10**size), (0, 2, 5)
    prior = Prior(noise_sd=1.0, dof=dof, concentration=concentration)
    every, some = (
        fit(x, orders, prior, max_segment_bins=longest, every_count=each) for each in (True, False)
    )
    assert (some.cut_mass <= 1e-12).all() and (every.cut_mass == 0).all()
    assert some.log_evidence == pytest.approx(every.log_evidence, rel=1e-13, abs=1e-10)
    for order in orders:
        assert some.map_count(order) == every.map_count(order)
        for name in ("boundary_probability", "expected_trajectory"):
            of_some, of_every = (getattr(one, name)(order) for one in (some, every))
            assert of_some == pytest.approx(of_every, abs=1e-10 * 10**size + 1e-10)
    if longest is None:
        assert log_evidence(x, orders, prior) == pytest.approx(
            every.log_evidence, rel=1e-13, abs=1e-10
        )


@pytest.mark.parametrize("longest", [None, 60])
@pytest.mark.parametrize("size", [0.05, 1.0, 20.0])
def test_the_band_of_a_long_series_agrees_with_every_count(longest, size):
    bins = 300
    x = walk(bins, 2, 6, size)
    orders = (0, 2)
    options = {"max_segment_bins": longest}
    band = fit(x, orders, PRIOR, **options)
    every = fit(x, orders, PRIOR, max_count=bins - 1, **options)
    assert (every.cut_mass == 0).all()
    assert band.log_evidence == pytest.approx(every.log_evidence, abs=1e-6)
    for i, order in enumerate(orders):
        if band.cut_mass[i] < 1:
            less = every.log_evidence[i] - band.log_evidence[i]
            assert less <= -np.log1p(-band.cut_mass[i]) + 1e-9
        for what in ("count_probability", "boundary_probability"):
            values = [getattr(posterior, what)(order) for posterior in (band, every)]
            assert values[0] == pytest.approx(values[1], abs=1e-6)
        assert band.map_segmentation(order).tolist() == every.map_segmentation(order).tolist()
        assert band.expected_trajectory(order) == pytest.approx(
            every.expected_trajectory(order), abs=1e-6 * np.abs(x).max()
        )


def test_more_segmentations_than_a_double_can_count():
    """Where all are about as good, sums in units of the best path overflow."""
    bins, longest = 4_000, 16
    evidence = np.random.default_rng(5).normal(0, 0.3, (1, bins, longest))
    for n in range(1, longest):
        evidence[0, bins - n :, n] = -np.inf
    log_prior = log_prior_of(bins, longest)
    by_count, probability, boundary = np.empty((3, bins))
    _, lost, left_out, price = fit_order_in_band(
        evidence[0].copy(), log_prior, 300, by_count, probability, boundary
    )
    counts = np.flatnonzero(np.isfinite(by_count))
    ways = by_count[counts] - log_prior[counts]
    log_sum = np.zeros(bins + 1)
    for q in range(1, bins + 1):
        n = np.arange(min(longest, q))
        log_sum[q] = logsumexp(log_sum[q - 1 - n] + evidence[0, q - 1 - n, n] - price)
    kept = logsumexp(ways - (counts + 1) * price)
    assert kept == pytest.approx(log_sum[-1] + np.log1p(-left_out), abs=1e-9)
    assert left_out < 1e-4
    assert lost == 0
    mean = 1 + probability[counts] @ counts
    assert boundary.sum() == pytest.approx(mean, rel=1e-11)


def test_the_bound_of_the_band_says_something():
    """Truly 1e-13 or less is left out of each (the test above)."""
    for size in (0.3, 1.0, 20.0):
        found = fit(walk(300, 2, 6, size), (0, 2), PRIOR, expectations=False)
        assert (found.cut_mass <= 1e-6).all()


def test_a_cap_that_no_likely_segment_reaches_changes_the_prior_only():
    x = walk(40, 2, 2, 5.0)
    free, capped = (fit(x, (0,), PRIOR, max_segment_bins=w) for w in (None, 39))
    counts = capped.log_evidence_by_count
    assert np.isneginf(counts[0, 0]) and np.isfinite(counts[0, 1:]).all()
    assert counts[0, 5:] == pytest.approx(free.log_evidence_by_count[0, 5:], abs=1e-6)


# --- hard data


@pytest.mark.parametrize("dims", [1, 2, 3, 5])
def test_constant_data_are_one_segment(dims):
    found = fit(np.zeros((30, dims)), prior=PRIOR)
    assert np.isfinite(found.log_evidence).all()
    assert all(found.map_count(order) == 0 for order in found.orders)
    assert found.map_segmentation(0).tolist() == [] and found.boundaries(0).tolist() == []
    assert found.expected_trajectory(3) == pytest.approx(np.zeros((30, dims)), abs=1e-12)
    assert (np.linalg.eigvalsh(found.noise_covariance(0)) > 0).all()


@pytest.mark.parametrize("noise_sd", [1e-9, 1e-3, 1.0])
def test_collinear_data_have_finite_evidences(noise_sd):
    line = walk(60, 1, 3) @ np.array([[1.0, 2.0, -1.0]])
    found = fit(line, prior=Prior(noise_sd=noise_sd))
    for order in found.orders:
        assert np.isfinite(found.log_evidence_by_count[order]).all()
        assert np.isfinite(found.expected_trajectory(order)).all()
        assert np.isfinite(found.noise_covariance(order)).all()


@pytest.mark.parametrize("far", [0.0, 1e6])
@pytest.mark.parametrize("size", [1e-12, 1.0, 1e3, 1e6])
def test_no_size_of_the_data_underflows(far, size):
    found = fit(walk(100, 3, 9, size) + far, (0, 3, 7), PRIOR, max_count=99)
    assert np.isfinite(found.log_evidence_by_count).all()
    for order in found.orders:
        assert found.count_probability(order).sum() == pytest.approx(1)
        boundary = found.boundary_probability(order)
        expected = found.count_probability(order) @ np.arange(100)
        assert boundary.sum() == pytest.approx(expected, abs=1e-6)


def test_one_dimension_may_come_as_a_plain_series():
    x = walk(30, 1, 8)
    same(fit(x, (0, 2), PRIOR), fit(x[:, 0], (0, 2), PRIOR), rel=0, abs=0)


# --- what is asked of a posterior


def test_maxima_are_taken_once_each_with_room_around_them():
    probability = np.array([0, 0.1, 0.9, 0.8, 0.1, 0.2, 0.1, 0, 0.3, 0, 0.05, 0.04])
    assert greedy_maxima(probability, 2).tolist() == [2, 8]
    # 0.2 stands within 3 bins of 0.9, 0.05 of 0.3.
    assert greedy_maxima(probability, 5).tolist() == [2, 8]
    assert greedy_maxima(probability, 0).tolist() == []
    assert greedy_maxima(np.zeros(5), 3).tolist() == []
    assert greedy_maxima(np.zeros(0), 3).tolist() == []
    assert greedy_maxima(np.array([0.5, 0, 0, 0, 0.5]), 9).tolist() == [0, 4]


def test_maxima_that_differ_by_rounding_are_taken_from_the_first_on():
    rng = np.random.default_rng(0)
    for _ in range(20):
        everywhere = 1.0 - rng.uniform(0, 1e-12, 30)
        assert list(greedy_maxima(everywhere, 4)) == [0, 4, 8, 12]
        near_zero = everywhere * 1e-200
        assert list(greedy_maxima(near_zero, 4)) == [0, 4, 8, 12]
    assert list(greedy_maxima(np.array([0.2, 0.0, 0.0, 0.0, 0.2 + 1e-9]), 1)) == [4]


def test_expectations_that_were_not_asked_for_are_told():
    found = fit(walk(20, 2, 0), (0, 3), PRIOR, expectations=False)
    with pytest.raises(SignkinError, match="expectations"):
        found.expected_trajectory(0)
    with pytest.raises(SignkinError, match="order 5 was not fitted"):
        found.count_probability(5)
    whole = fit(walk(20, 2, 0), (0, 3), PRIOR)
    assert found.log_evidence.tolist() == whole.log_evidence.tolist()


def test_a_boundary_is_halfway_between_two_samples():
    x = np.repeat([[0.0, 0.0], [40.0, 9.0], [-30.0, 2.0]], [7, 9, 8], axis=0)
    x += np.random.default_rng(1).normal(0, 0.5, x.shape)
    middle, frames = (fit(x, (0,), PRIOR, 0.04, sample_at=at) for at in (0.5, 0.0))
    assert middle.boundaries(0).tolist() == frames.boundaries(0).tolist() == [6, 15]
    # Bins of 40 ms with samples in their middle: the bins' ends. Frames at i / 25 s: frames 6 and
    # 7 stand at 0.24 and 0.28 s.
    assert middle.boundaries_s(0).tolist() == [7 * 0.04, 16 * 0.04]
    assert frames.boundaries_s(0) == pytest.approx([0.26, 0.62])
    assert frames.times_s([6]) == pytest.approx([0.26])
    with pytest.raises(SignkinError, match="duration of a bin"):
        fit(x, (0,), PRIOR).boundaries_s(0)
    each = fit_many([x, x], (0,), PRIOR, 0.04, sample_at=[0.5, 0.0])
    assert [f.sample_at for f in each] == [0.5, 0.0]
    assert each[1].boundaries_s(0).tolist() == frames.boundaries_s(0).tolist()


def test_the_least_possible_number_of_boundaries_is_told():
    x = np.zeros((40, 2))
    capped, free = fit(x, (0, 1), PRIOR, max_segment_bins=10), fit(x, (0, 1), PRIOR)
    assert capped.least_count == 3 and capped.map_count(1) == 3 and capped.at_floor(1)
    assert free.least_count == 0 and free.map_count(1) == 0 and not free.at_floor(1)
    jumping = fit(np.repeat(walk(10, 2, 1, 50.0), 4, axis=0), (0,), PRIOR, max_segment_bins=10)
    assert jumping.map_count(0) > 3 and not jumping.at_floor(0)


@pytest.mark.parametrize(("told", "low", "high"), [(0.5, 0.8, 1.2), (0.01, 40, 60), (50, 0, 0.05)])
def test_noise_that_does_not_fit_shows(told, low, high):
    """A smooth path with noise of 0.5, of which no polynomial of order 1 follows all."""
    t = np.linspace(0, 3, 120)[:, None]
    x = np.hstack([t, -t]) + np.random.default_rng(3).normal(0, 0.5, (120, 2))
    found = fit(x - x.mean(0), (1,), Prior(noise_sd=told), max_count=3)
    assert low < found.noise_misfit(1) < high


def test_a_posterior_tells_of_itself_in_three_lines():
    x = np.repeat([[0.0, 0.0], [40.0, 9.0]], [12, 18], axis=0)
    told = repr(fit(x, (0, 2), PRIOR, max_segment_bins=20)).splitlines()
    assert len(told) == 3 and "30 bins in 2 dimensions, orders 0, 2" in told[0]
    assert "preferred order 0" in told[1] and "1 boundaries, the least possible" in told[2]


def test_arrays_that_mask_nothing_are_arrays_and_lists_of_noise_are_tuples():
    same(fit(np.ma.asarray(GOOD), (0, 2), PRIOR), fit(GOOD, (0, 2), PRIOR), rel=0, abs=0)
    assert Prior(noise_sd=[1.0, 2.0]) == Prior(noise_sd=(1.0, 2.0))  # type: ignore[arg-type]
    assert hash(Prior(noise_sd=np.array([1.0]))) == hash(Prior(noise_sd=(1.0,)))


@pytest.mark.parametrize("given", [{"prior": 0.001}, {"prior": [PRIOR]}, {"names": "ab c"}])
def test_what_is_given_for_many_is_one_or_as_many(given):
    with pytest.raises(SignkinError):
        fit_many([GOOD, GOOD], (0,), **{"prior": PRIOR, **given})


# --- bad input


def with_gap():
    x = walk(20, 3, 0)
    x[7, 1] = np.nan
    return x


GOOD = walk(20, 3, 0)
BAD = {
    "a gap": (with_gap(), {}, "bin 7"),
    "infinity": (np.where(GOOD.max() == GOOD, np.inf, GOOD), {}, "finite"),
    "one bin": (GOOD[:1], {"orders": (0,)}, "2 bins or more"),
    "no bins": (GOOD[:0], {"orders": (0,)}, "2 bins or more"),
    "no dimensions": (GOOD[:, :0], {}, "dimensions"),
    "three axes": (GOOD[None], {}, "shape"),
    "a number": (np.float64(3.0), {"orders": (0,)}, "shape"),
    "order as many as bins": (GOOD[:5], {"orders": (0, 5)}, "order 5 with 5 bins"),
    "an order twice": (GOOD, {"orders": (3, 3)}, "different orders"),
    "no order": (GOOD, {"orders": ()}, "orders"),
    "a negative order": (GOOD, {"orders": (-1,)}, "orders"),
    "an order too high": (GOOD, {"orders": (10,)}, "0 to 9"),
    "no segment": (GOOD, {"max_segment_bins": 0}, "max_segment_bins"),
    "no prior": (GOOD, {"prior": None}, "prior"),
    "a number as prior": (GOOD, {"prior": 0.001}, "the prior is 0.001"),
    "a number as orders": (GOOD, {"orders": 3}, "the orders are 3"),
    "words as orders": (GOOD, {"orders": "cubic"}, "the orders are 'cubic'"),
    "a word as count": (GOOD, {"max_count": "all"}, "max_count is 'all'"),
    "a word as longest segment": (GOOD, {"max_segment_bins": "long"}, "whole number from 1"),
    "a duration of nothing": (GOOD, {"dt_s": 0.0}, "dt_s is 0.0"),
    "a word as duration": (GOOD, {"dt_s": "15 ms"}, "dt_s is '15 ms'"),
    "a masked value": (np.ma.masked_equal(GOOD, GOOD[7, 1]), {}, "bin 7"),
    "words as data": (["a", "b"], {"orders": (0,)}, "not an array of numbers"),
    "a list of one speed": ([1.5], {"orders": (0,)}, "2 bins or more"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_told_with_the_name_of_the_trajectory(case):
    x, options, told = BAD[case]
    with pytest.raises(SignkinError, match=told) as caught:
        fit(x, **{"prior": PRIOR, **options}, name="take 7")
    assert "take 7" in str(caught.value)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ({"noise_sd": 0.0}, "noise_sd"),
        ({"noise_sd": -1.0}, "noise_sd"),
        ({"noise_sd": 1e-300}, "noise_sd is 1e-300; expected .* between 1e-150 and"),
        ({"noise_sd": 1e300}, "noise_sd is 1e.300; expected"),
        ({"noise_sd": float("nan")}, "noise_sd"),
        ({"noise_sd": (1.0, 0.0, 1.0)}, "noise_sd"),
        ({"noise_sd": 1.0, "concentration": 0.0}, "concentration"),
        ({"noise_sd": "0.8 mm"}, "noise_sd is '0.8 mm'"),
        ({"noise_sd": None}, "noise_sd"),
        ({"noise_sd": []}, "noise_sd"),
        ({"noise_sd": 1.0, "concentration": "small"}, "concentration is 'small'"),
        ({"noise_sd": 1.0, "dof": "L"}, "dof is 'L'"),
        ({"noise_sd": 1.0, "time_unit": "frame"}, "bin, second, trajectory"),
        ({"noise_sd": 1.0, "scale": "printed"}, "expected, plain"),
    ],
)
def test_a_prior_that_is_no_density_is_refused(words, told):
    with pytest.raises(SignkinError, match=told):
        Prior(**words)


MISFITS = [
    (Prior(noise_sd=1.0, dof=2.0), "more than 2 for 3 dimensions"),
    (Prior(noise_sd=(1.0, 2.0)), "one value, or 3"),
    (Prior(noise_sd=1.0, time_unit="second"), "dt_s"),
]


@pytest.mark.parametrize(("prior", "told"), MISFITS)
def test_a_prior_that_does_not_fit_the_data_is_refused(prior, told):
    with pytest.raises(SignkinError, match=told):
        fit(GOOD, prior=prior)


@pytest.mark.parametrize(("prior", "told"), MISFITS)
def test_a_prior_that_does_not_fit_names_the_trajectory(prior, told):
    with pytest.raises(SignkinError, match=told) as caught:
        fit(GOOD, prior=prior, name="take 7")
    assert "take 7" in str(caught.value)


def test_data_whose_squares_overflow_are_refused():
    with pytest.raises(SignkinError, match="take 7"):
        fit(GOOD * 1e200, (0,), PRIOR, name="take 7")


@pytest.mark.parametrize(("count", "options"), [(25, {}), (-1, {}), (1, {"max_segment_bins": 5})])
def test_an_impossible_number_of_boundaries_is_refused(count, options):
    found = fit(GOOD, (0,), PRIOR, **options)
    with pytest.raises(SignkinError, match=str(count)):
        found.map_segmentation(0, count)


def test_many_name_the_bad_one():
    data = [GOOD, with_gap()]
    with pytest.raises(SignkinError, match="trajectory 2"):
        fit_many(data, prior=PRIOR)
    with pytest.raises(SignkinError, match="take b"):
        fit_many(data, prior=PRIOR, names=["take a", "take b"], workers=2)
