"""Very long series, stretch by stretch, against the whole of them at once."""

import math

import numpy as np
import pytest

from signkin.binning import Prior, fit, fitting
from signkin.binning.segmentation_prior import log_cuts, log_prior_of, log_uniform
from signkin.binning.stretches import Stretches, in_stretches

ORDERS = (0, 1, 3)
LONGEST = 30


def walk(bins, dims=3, noise=0.1, seed=0):
    """Return a path with turns, and noise."""
    rng = np.random.default_rng(seed)
    turns = np.sort(rng.choice(bins, bins // 14, replace=False))
    x = np.column_stack(
        [np.interp(np.arange(bins), turns, rng.normal(0, 2, len(turns))) for _ in range(dims)]
    )
    return x - x.mean(0) + rng.normal(0, noise, x.shape)


@pytest.mark.parametrize(
    ("stretch_bins", "prior"),
    [
        (64, Prior(noise_sd=0.1)),
        (150, Prior(noise_sd=0.1, time_unit="trajectory")),
        (10_000, Prior(noise_sd=0.1)),
    ],
)
def test_stretches_are_the_whole_series(stretch_bins, prior):
    x = walk(700)
    whole = fit(x, ORDERS, prior, max_segment_bins=LONGEST)
    series = Stretches.of(x, prior, LONGEST, 4, None, stretch_bins)
    assert len(series.edges) == max(2, 1 + 700 // stretch_bins)
    cut = in_stretches(series, ORDERS, (1, 3))
    assert np.abs(cut.found.boundary - whole._boundary).max() < 1e-8
    assert np.abs(cut.found.probability - whole._count_probability).max() < 1e-8
    assert (cut.found.cut_mass < 1e-6).all()
    assert cut.found.log_evidence == pytest.approx(whole.log_evidence, abs=1e-6)
    told = cut.found.probability > 1e-3
    assert cut.found.log_by_count[told] - whole.log_evidence_by_count[told] == pytest.approx(
        log_uniform(700), abs=1e-6
    )
    for row, order in enumerate((1, 3)):
        assert np.abs(cut.mean[row] - whole.expected_trajectory(order)).max() < 1e-8
        assert cut.noise[row] == pytest.approx(whole.noise_covariance(order), rel=1e-8)


@pytest.mark.parametrize("noise_sd", [0.01, 3.0, 300.0])
def test_priors_that_want_the_fewest_segments_or_many(noise_sd):
    x = walk(400, dims=2, seed=1)
    options = {"orders": (2,), "prior": Prior(noise_sd=noise_sd), "max_segment_bins": 20}
    whole, cut = fit(x, **options), fit(x, **options, whole_up_to=100)
    assert cut.map_count(2) == whole.map_count(2)
    assert cut.at_floor(2) == whole.at_floor(2) == (noise_sd >= 3.0)
    off = np.abs(cut.boundary_probability(2) - whole.boundary_probability(2)).max()
    assert off <= cut.cut_mass[0] + 1e-9


@pytest.mark.parametrize("turns", [14, 300])
def test_too_long_segments_are_left_out_only_where_they_add_nothing(monkeypatch, turns):
    rng = np.random.default_rng(3)
    at = np.append(np.arange(0, 800, turns), 800)
    path = np.interp(np.arange(800), at, rng.normal(0, 2, len(at)))
    x = (path - path.mean() + rng.normal(0, 0.1, 800))[:, None]
    options = {"orders": (0, 1), "prior": Prior(noise_sd=0.1), "expectations": (1,)}
    whole = fit(x, **options)
    seen = []
    original = fitting.in_band
    monkeypatch.setattr(fitting, "LEFT_OUT_ABOVE", 700)
    monkeypatch.setattr(
        fitting, "in_band", lambda e, *rest: seen.append(e.shape[2]) or original(e, *rest)
    )
    short = fit(x, **options)
    assert seen[0] == 256
    assert np.abs(short._boundary - whole._boundary).max() < 1e-9
    assert np.abs(short.expected_trajectory(1) - whole.expected_trajectory(1)).max() < 1e-9
    assert (short.cut_mass <= whole.cut_mass + 1e-9).all()


def test_short_series_are_binned_as_a_whole():
    x = walk(300)
    options = {"orders": (1,), "prior": Prior(noise_sd=0.1), "max_segment_bins": LONGEST}
    one, other = fit(x, **options), fit(x, **options, whole_up_to=300)
    assert (one._boundary == other._boundary).all()


@pytest.mark.parametrize(("bins", "longest"), [(1500, 50), (1000, 37)])
def test_cuts_of_the_saddle_point_are_those_counted(bins, longest):
    parts = np.arange(bins // longest + 20, bins - 20)
    exact = log_uniform(bins) - log_prior_of(bins, longest)[parts - 1]
    told, slope = log_cuts(bins, longest, parts.astype(float))
    assert told == pytest.approx(exact, abs=1e-4)
    assert slope[200:-200] == pytest.approx(np.gradient(exact)[200:-200], abs=0.02)


def test_cuts_into_nearly_the_fewest_parts_are_counted_where_digits_run_out():
    prior = log_prior_of(4000, 20)
    assert np.isneginf(prior[:199]).all()
    assert prior[199] == pytest.approx(log_uniform(4000))  # 200 of 20 bins: one way
    assert prior[200] == pytest.approx(log_uniform(4000) - math.log(_ways_to_spread(20, 201, 20)))
    assert np.isfinite(prior[199:]).all()


def _ways_to_spread(spare, parts, longest):
    """Return how many ways there are to take `spare` bins off parts, less than `longest` each."""
    ways = [1] + [0] * spare
    for _ in range(parts):
        ways = [sum(ways[max(0, i - longest + 1) : i + 1]) for i in range(spare + 1)]
    return ways[spare]
