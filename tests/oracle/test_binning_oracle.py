"""The engine of Bayesian binning against arithmetic that had no part in it.

60 digits of mpmath, chains of scipy's multivariate Student t, and every segmentation of
short trajectories one by one (tests/support/binning_model.py).
"""

import math

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import linear_sum_assignment
from scipy.special import logsumexp
from scipy.stats import multivariate_t

from signkin.binning import Prior, fit, segment_log_evidence
from signkin.binning.segmentation_prior import log_prior_of
from support.binning_model import (
    Model,
    enumerate_all,
    exact_log_evidence,
    segmentations,
)

BIN_S = 0.015
PRIORS = (
    {"noise_sd": 0.8},
    {"noise_sd": 0.01, "scale": "plain"},
    {"noise_sd": 5.0, "dof": 1000.0, "concentration": 1e-3},
    {"noise_sd": 0.3, "dof": 7.5, "concentration": 10.0, "scale": "plain"},
)


def walk(bins, dims, seed, size=2.0):
    """Return a random walk, centred."""
    x = np.random.default_rng(seed).normal(size=(bins, dims)).cumsum(0) * size
    return x - x.mean(0)


def model_of(bins, dims, *, noise_sd, dof=None, concentration=0.1, scale="expected", unit="bin"):
    """Return by hand what the prior's words mean."""
    nu = float(dims if dof is None else dof)
    factor = nu if scale == "expected" else 1.0
    step = {"bin": 1.0, "second": BIN_S, "trajectory": 1 / bins}[unit]
    noise = np.broadcast_to(np.atleast_1d(noise_sd).astype(float), (dims,))
    return Model(np.diag(factor * noise**2), nu, concentration, step)


@pytest.mark.parametrize("unit", ["bin", "second", "trajectory"])
@pytest.mark.parametrize("dims", [1, 2, 3, 4])
def test_evidence_of_a_segment_to_60_digits(unit, dims):
    bins = 60
    x = walk(bins, dims, dims, size=3.0)
    for words in PRIORS:
        prior = Prior(time_unit=unit, **words)
        model = model_of(bins, dims, unit=unit, **words)
        for order in (0, 3, 7):
            found = segment_log_evidence(x, order, prior, BIN_S)
            for i, j in ((0, bins - 1), (3, 10), (20, 45), (59, 59)):
                exact = exact_log_evidence(x[i : j + 1], order, model)
                assert abs(found[i, j] / exact - 1) < 1e-10, (words, order, i, j)
            assert np.isneginf(found[np.tril_indices(bins, -1)]).all()


def test_long_segments_keep_their_digits():
    x = walk(400, 3, 11)
    words = {"noise_sd": 0.8}
    for order in (3, 7):
        found = segment_log_evidence(x, order, Prior(**words))[0, 399]
        exact = exact_log_evidence(x, order, model_of(400, 3, **words))
        assert abs(found / exact - 1) < 1e-10


@pytest.mark.parametrize("dims", [1, 3])
def test_evidence_is_a_chain_of_student_predictives(dims):
    bins, b, nu = 12, 0.1, dims + 1.5
    x = walk(bins, dims, 5)
    prior = Prior(noise_sd=0.5, dof=nu, concentration=b)
    for order in (0, 1, 3):
        found = segment_log_evidence(x, order, prior)
        precision = b * np.eye(order + 1)
        coefficients = np.zeros((order + 1, dims))
        scale = nu * 0.25 * np.eye(dims)
        total = 0.0
        for n in range(bins):
            row = float(n + 1) ** np.arange(order + 1)
            reach = 1 + row @ np.linalg.solve(precision, row)
            free = nu + n - dims + 1
            predicted = row @ coefficients
            total += multivariate_t.logpdf(x[n], predicted, scale * reach / free, df=free)
            assert found[0, n] == pytest.approx(total, rel=1e-9)
            missed = x[n] - predicted
            scale = scale + np.outer(missed, missed) / reach
            grown = precision + np.outer(row, row)
            coefficients = np.linalg.solve(grown, precision @ coefficients + np.outer(row, x[n]))
            precision = grown


@pytest.mark.parametrize(
    ("bins", "dims", "longest", "unit", "words"),
    [
        (10, 3, None, "bin", {"noise_sd": 0.5}),
        (10, 3, 4, "bin", {"noise_sd": 0.5}),
        (9, 1, None, "second", {"noise_sd": 2.0, "dof": 4.0, "concentration": 1e-3}),
        (9, 1, 1, "bin", {"noise_sd": 2.0}),
        (10, 2, 3, "trajectory", {"noise_sd": (0.5, 1.5), "scale": "plain"}),
        (8, 5, None, "bin", {"noise_sd": 1.0, "dof": 6.5}),
        (8, 5, 7, "bin", {"noise_sd": 1.0}),
        (2, 3, None, "bin", {"noise_sd": 1.0}),
    ],
)
def test_everything_equals_the_sum_over_all_segmentations(bins, dims, longest, unit, words):
    x = walk(bins, dims, 7 * bins + dims)
    orders = tuple(range(min(8, bins)))
    model = model_of(bins, dims, unit=unit, **words)
    found = fit(x, orders, Prior(time_unit=unit, **words), BIN_S, max_segment_bins=longest)
    slow = [enumerate_all(x, order, model, longest) for order in orders]

    evidence = np.array([s.log_evidence for s in slow])
    assert found.log_evidence == pytest.approx(evidence, abs=1e-9)
    assert found.order_probability == pytest.approx(
        np.exp(evidence - logsumexp(evidence)), abs=1e-9
    )
    assert (found.cut_mass == 0).all()
    for order, s in zip(orders, slow, strict=True):
        counts = found.log_evidence_by_count[order]
        possible = np.isfinite(s.log_evidence_by_count)
        assert (np.isfinite(counts) == possible).all()
        assert counts[possible] == pytest.approx(s.log_evidence_by_count[possible], abs=1e-9)
        assert found.count_probability(order) == pytest.approx(s.count, abs=1e-10)
        assert found.boundary_probability(order) == pytest.approx(s.boundary, abs=1e-10)
        assert found.expected_trajectory(order) == pytest.approx(s.mean, abs=1e-8)
        assert found.noise_covariance(order) == pytest.approx(s.noise, rel=1e-8, abs=1e-10)
        assert found.map_count(order) == int(np.argmax(s.count))
        for count, cut in s.best.items():
            assert found.map_segmentation(order, count).tolist() == cut


def test_the_trajectory_of_the_best_segmentation_is_a_ridge_fit_a_segment():
    bins, order, b = 30, 2, 0.1
    x = walk(bins, 2, 3)
    found = fit(x, (order,), Prior(noise_sd=0.5, concentration=b))
    expected, start = np.empty_like(x), 0
    for end in [*found.map_segmentation(order, 3), bins - 1]:
        time = np.arange(1, end - start + 2)[:, None] ** np.arange(order + 1.0)
        rows = np.vstack([time, math.sqrt(b) * np.eye(order + 1)])
        wanted = np.vstack([x[start : end + 1], np.zeros((order + 1, 2))])
        expected[start : end + 1] = time @ np.linalg.lstsq(rows, wanted, rcond=None)[0]
        start = end + 1
    assert found.map_trajectory(order, 3) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(("bins", "longest"), [(8, 8), (9, 3), (10, 4), (7, 1), (6, 5)])
def test_the_prior_over_segmentations_sums_to_one(bins, longest):
    log_prior = log_prior_of(bins, longest)
    for count in range(bins):
        number = sum(1 for _ in segmentations(bins, count, longest))
        if number:
            assert number * math.exp(log_prior[count]) == pytest.approx(1 / bins, rel=1e-12)
        else:
            assert np.isneginf(log_prior[count])
    if longest == bins:
        total = sum(
            math.exp(log_prior[count]) for count in range(bins) for _ in segmentations(bins, count)
        )
        assert total == pytest.approx(1, rel=1e-12)


@pytest.mark.parametrize(("bins", "longest"), [(300, 7), (650, 9), (650, 200)])
def test_numbers_of_segmentations_of_long_series_are_exact(bins, longest):
    """Whole numbers of any size: coefficients of (z + ... + z^W)^(M+1)."""
    log_prior = log_prior_of(bins, longest)
    ways = [1] + [0] * bins
    for count in range(bins):
        sums = [0]
        for number in ways:
            sums.append(sums[-1] + number)
        ways = [0] + [sums[q] - sums[max(0, q - longest)] for q in range(1, bins + 1)]
        if ways[bins]:
            expected = -math.log(bins) - math.log(ways[bins])
            assert log_prior[count] == pytest.approx(expected, rel=1e-11)
        else:
            assert np.isneginf(log_prior[count])


def three_cubics(rng, bins=100, duration_s=1.5, noise_sd=0.8e-3):
    """Return positions (bins, 3) of three cubics, and where they join (s).

    Position and velocity are continuous, as of a hand; acceleration is not.
    """
    dt = duration_s / bins
    while True:
        joins = np.sort(rng.integers(15, bins - 15, size=2))
        if joins[1] - joins[0] >= 15:
            break
    edges_s = np.array([0, *joins, bins]) * dt
    curve = CubicHermiteSpline(edges_s, rng.normal(0, 0.1, (4, 3)), rng.normal(0, 0.5, (4, 3)))
    x = curve((np.arange(bins) + 0.5) * dt) + rng.normal(0, noise_sd, (bins, 3))
    return x - x.mean(0), edges_s[1:-1], dt


def test_the_order_and_the_boundaries_of_cubic_segments_are_found_again():
    rng = np.random.default_rng(20131107)
    for _ in range(10):
        x, joins_s, dt = three_cubics(rng)
        found = fit(x, prior=Prior(noise_sd=0.8e-3))
        assert found.order_probability[3] > 0.9
        assert found.map_count(3) == 2
        at_s = (found.boundaries(3) + 1) * dt
        distance = np.abs(at_s[:, None] - joins_s)
        pairs = linear_sum_assignment(distance)
        assert len(at_s) == 2
        assert distance[pairs].max() <= 0.09
