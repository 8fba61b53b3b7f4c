"""Evidences of data that are huge beside their noise, and posteriors that keep what they promise.

Against 60 digits of mpmath, and against draws from the model's own prior: what is said to be so
with P = 0.7 is so in seven cases of ten.
"""

import numpy as np
import pytest

from signkin import SignkinError
from signkin.binning import Prior, fit, segment_log_evidence
from signkin.binning.evidence import EXACT_ABOVE, MOST_NOISES
from support.binning_model import Model, drawn, exact_log_evidence

PRIOR = Prior(noise_sd=0.5)
SPANS = ((0, 39), (3, 10), (20, 36), (39, 39))


def worst(x, order, prior=PRIOR, spans=SPANS):
    """Return the worst relative error of the log evidence of some segments."""
    dims = x.shape[1]
    model = Model(np.diag(prior.inverse_scale(dims)), prior.degrees(dims), 0.1, 1.0)
    found = segment_log_evidence(x, order, prior)
    exact = [exact_log_evidence(x[i : j + 1], order, model) for i, j in spans]
    return max(abs(found[i, j] / e - 1) for (i, j), e in zip(spans, exact, strict=True))


@pytest.mark.parametrize("order", range(10))
def test_draws_from_the_prior_have_ten_digits(order):
    rng = np.random.default_rng(order)
    x = drawn(rng, (23, 17), order, 3, PRIOR)
    for fitted in {order, max(0, order - 2), min(9, order + 1)}:
        assert worst(x, fitted) < 1e-10


@pytest.mark.parametrize("dims", range(1, 7))
@pytest.mark.parametrize("size", [3e3, 0.9 * EXACT_ABOVE, 1e12, 1e17])
def test_straight_strokes_and_offsets_have_ten_digits(dims, size):
    rng = np.random.default_rng(dims)
    noise = rng.normal(size=(40, dims))
    stroke = np.linspace(-1, 1, 40)[:, None] * rng.uniform(-1, 1, dims) * size
    for x in (0.5 * (stroke + noise), 0.5 * (size + noise)):
        for order in (0, 5):
            assert worst(x, order, spans=SPANS[:2]) < 1e-10


def test_a_long_draw_of_a_high_order_has_ten_digits():
    x = drawn(np.random.default_rng(1), (150,), 7, 3, PRIOR)
    assert np.abs(x).max() > 1e14
    assert worst(x, 7, spans=((0, 149), (40, 149))) < 1e-10


@pytest.mark.parametrize("size", [1e3, 3e8])
def test_turned_strokes_keep_their_orders(size):
    """A straight stroke at 3e8 noise SDs once preferred order 5 or 0, as it was turned."""
    rng = np.random.default_rng(4)
    flat = np.column_stack([np.linspace(-size, size, 60), np.zeros((60, 2))])
    x = 0.5 * (flat + rng.normal(size=(60, 3)))
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    a, b = fit(x, prior=PRIOR), fit(x @ turn.T, prior=PRIOR)
    # The turned data are rounded: to 3e8 times 1e-16, which bears on what lies beside the line.
    assert b.log_evidence == pytest.approx(a.log_evidence, abs=1e-5)
    assert b.order_probability == pytest.approx(a.order_probability, abs=1e-5)


def test_what_even_32_digits_do_not_tell_is_refused():
    x = np.linspace(-1, 1, 30)[:, None] * np.ones(3) * 0.5
    assert np.isfinite(fit(x * MOST_NOISES * 0.5, (1,), PRIOR).log_evidence).all()
    with pytest.raises(SignkinError, match=r"take 7.*noise"):
        fit(x * MOST_NOISES * 4, (1,), PRIOR, name="take 7")


def test_expectations_of_huge_data_are_those_of_small_ones():
    """A stroke that order 1 follows exactly adds to the expectation and to nothing else."""
    x = np.random.default_rng(2).normal(size=(30, 2)) * 0.5
    stroke = np.arange(1, 31)[:, None] * np.array([3.0, -5.0])
    weak = Prior(noise_sd=0.5, concentration=1e-30)
    small, huge = (fit(x + far * stroke, (1,), weak, max_count=0) for far in (1.0, 2.0**30))
    scale = float(np.abs(small.noise_covariance(1)).max())
    assert huge.noise_covariance(1) == pytest.approx(small.noise_covariance(1), abs=1e-5 * scale)
    off = huge.expected_trajectory(1) - 2.0**30 * stroke
    assert off == pytest.approx(small.expected_trajectory(1) - stroke, abs=1e-4)


@pytest.fixture(scope="module")
def draws():
    """Posteriors of 500 trajectories drawn from the prior, averaged over orders, and the truth."""
    rng = np.random.default_rng(20131107)
    bins, out = 24, []
    for _ in range(500):
        order, count = int(rng.integers(8)), int(rng.integers(bins))
        ends = np.sort(rng.choice(bins - 1, size=count, replace=False))
        lengths = np.diff([-1, *ends, bins - 1])
        found = fit(drawn(rng, lengths, order, 2, PRIOR), prior=PRIOR, expectations=False)
        share = found.order_probability
        boundary = share @ [found.boundary_probability(s) for s in found.orders]
        counts = share @ [found.count_probability(s) for s in found.orders]
        out.append((order, ends, share, boundary, counts))
    return out


@pytest.mark.parametrize(("low", "high"), [(0.25, 0.35), (0.65, 0.75), (0.9, 0.99)])
def test_boundaries_are_real_as_often_as_they_are_said_to_be(draws, low, high):
    said, real = [], []
    for _, ends, _, boundary, _ in draws:
        there = np.isin(np.arange(len(boundary)), ends)
        given = (boundary >= low) & (boundary <= high)
        said += boundary[given].tolist()
        real += there[given].tolist()
    assert len(said) > 150
    error = np.sqrt(np.mean(said) * (1 - np.mean(said)) / len(said))
    assert abs(np.mean(real) - np.mean(said)) < 3.5 * error


def test_sets_of_95_per_cent_hold_the_true_number_of_boundaries(draws):
    inside = []
    for _, ends, _, _, counts in draws:
        likely = np.argsort(-counts)
        needed = 1 + int(np.argmax(np.cumsum(counts[likely]) >= 0.95))
        inside.append(len(ends) in likely[:needed])
    assert np.mean(inside) > 0.95 - 3.5 * np.sqrt(0.95 * 0.05 / len(draws))


def test_orders_are_right_as_often_as_they_are_said_to_be(draws):
    said = np.array([share.max() for _, _, share, _, _ in draws])
    right = np.array([order == np.argmax(share) for order, _, share, _, _ in draws])
    error = np.sqrt(np.sum(said * (1 - said))) / len(said)
    assert abs(right.mean() - said.mean()) < 3.5 * error
    sure = said > 0.99
    assert sure.sum() > 30 and right[sure].mean() > 0.97
