"""What was put in is found: fitted trajectories as data, and sums in the log domain."""

import numpy as np
import pytest
from scipy.special import gammaln, logsumexp

from signkin.binning import Prior, counts, fit, segment_log_evidence, sum_product
from signkin.binning.lanes import WIDTH
from signkin.studies.endres2013.posteriors import FITTED_MAP, study
from signkin.studies.endres2013.settings import CutSettings, FitSettings
from signkin.studies.endres2013.single_signs import RECORDED, single_signs
from signkin.studies.endres2013.summaries import hit_rates, known_boundaries, order_posteriors
from support.endres import settings, simulated

TRUE_ORDERS = [1, 2, 3, 4, 5]


@pytest.fixture(scope="module")
def recovered():
    """Eight simulated signs, fitted with orders 1 to 5, and binned again with orders 0 to 7."""
    corpus, recordings = simulated(8)
    own = settings(fitted_orders=TRUE_ORDERS, bootstrap_draws=100, chance_trajectories=160)
    whole = single_signs(corpus, recordings, CutSettings.of(own), 2017).trajectories
    cut = [t for t in whole if t.dataset == RECORDED]
    assert len(cut) == 8
    found = study(corpus, cut, FitSettings.of(own), 2)
    binning = found.table("binning")
    truths = known_boundaries(cut, found.table("fitted_truths"))
    rates, _ = hit_rates(corpus.name, binning, truths, own.binning, 2017)
    exact = rates["dataset"] == FITTED_MAP
    orders = order_posteriors(corpus.name, binning)
    return orders[orders["dataset"] == FITTED_MAP], rates[exact]


@pytest.mark.parametrize("true_order", TRUE_ORDERS)
def test_the_order_of_piecewise_polynomials_is_found_again(recovered, true_order):
    orders, _ = recovered
    own = orders[orders["true_order"] == true_order].set_index("order")["mean_probability"]
    assert own.idxmax() == true_order
    assert own[true_order] > 0.9


@pytest.mark.parametrize("true_order", TRUE_ORDERS)
def test_their_boundaries_are_found_again(recovered, true_order):
    _, rates = recovered
    same = rates[(rates["true_order"] == true_order) & (rates["order"] == true_order)].iloc[0]
    assert same["n"] == 8
    assert same["hit_rate"] > 0.95
    assert same["false_positives_per_s"] < 0.1


# --- a posterior with two peaks far apart ------------------------------------------------------

NOISE_SD, BINS, ORDER = 0.005, 90, 7


def waving(amplitude, seed, cycles=7.0):
    """Return a smooth wave, (T, 3), small beside the prior of a single bin."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 1, BINS)
    hz, phase = rng.uniform(0.5 * cycles, 1.5 * cycles, 3), rng.uniform(size=3)
    x = amplitude * np.sin(2 * np.pi * (t[:, None] * hz + phase))
    return x - x.mean(axis=0)


def log_sums(evidence):
    """Return, in the log domain, sums over the ways to cut the first q bins into k segments.

    And over those of the bins from q on. evidence: (T, T) of the segments [i, j].
    """
    bins = len(evidence)
    before, after = np.full((2, bins + 1, bins + 1), -np.inf)
    before[0, 0] = after[bins, 0] = 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        for q in range(1, bins + 1):
            ways = before[:q, :-1] + evidence[:q, q - 1, None]
            before[q, 1:] = logsumexp(ways, axis=0)
        for q in range(bins - 1, -1, -1):
            ways = after[q + 1 :, :-1] + evidence[q, q:, None]
            after[q, 1:] = logsumexp(ways, axis=0)
    return before, after


def slow_posterior(evidence):
    """Return P(M | D), the boundaries' posterior and ln P(D), by eq. 7 and 8."""
    bins = len(evidence)
    before, after = log_sums(evidence)
    m = np.arange(bins)
    prior = -np.log(bins) - (gammaln(bins) - gammaln(m + 1) - gammaln(bins - m))
    by_count = before[bins, 1:] + prior
    total = logsumexp(by_count)
    boundary = np.zeros(bins - 1)
    for q in range(1, bins):
        for count in m[1:]:
            left = np.arange(1, count + 1)  # segments up to q, of count + 1
            ways = before[q, left] + after[q, count + 1 - left]
            if np.isfinite(ways).any():
                boundary[q - 1] += np.exp(logsumexp(ways) + prior[count] - total)
    return np.exp(by_count - total), boundary, total


def lost_by_the_linear_pass(x, prior):
    """Return the mass of P(M | D) that the pass in the linear domain does not cover."""
    evidence = np.zeros((BINS, BINS, WIDTH))
    whole = segment_log_evidence(x, ORDER, prior)
    for i in range(BINS):
        evidence[i, : BINS - i] = whole[i, i:, None]
    m = np.arange(BINS)
    log_prior = -np.log(BINS) - (gammaln(BINS) - gammaln(m + 1) - gammaln(BINS - m))
    log_by_count = np.empty((BINS, WIDTH))
    ways, spare_ways = np.empty((2, BINS + 1, sum_product.columns_for(BINS), WIDTH))
    weight, spare = np.empty((2, *evidence.shape))
    wanted, low, high = np.ones((3, WIDTH), dtype=np.int64)
    counts.fill_counts(
        evidence, wanted, log_prior, log_by_count, weight, np.empty(WIDTH),
        np.empty((BINS + 1, WIDTH)), ways, low, high, spare_ways, spare, False,
    )  # fmt: skip
    mass = np.exp(log_by_count[:, 0] - logsumexp(log_by_count[:, 0]))
    return mass[ways[0, 1 : BINS + 1, 0] < counts.UNDERFLOW].sum()


@pytest.mark.parametrize(
    ("amplitude", "seed", "falls_back"),
    [(0.1519, 0, True), (0.0248, 0, True), (0.1906, 0, True), (0.1519, 1, False)],
)
def test_two_peaks_far_apart_are_both_weighed(amplitude, seed, falls_back):
    x, prior = waving(amplitude, seed), Prior(noise_sd=NOISE_SD)
    lost = lost_by_the_linear_pass(x, prior)
    # Where the linear domain loses a peak, it is that of one segment a bin or that of few.
    assert (lost > 1e-7) if falls_back else (lost < counts.MOST_LOST)
    count, boundary, evidence = slow_posterior(segment_log_evidence(x, ORDER, prior))
    if falls_back:
        few, many = count[: BINS // 2].sum(), count[BINS // 2 :].sum()
        assert min(few, many) == pytest.approx(lost, rel=1e-3)
    likely = fit(x, [ORDER], prior, every_count=False)
    assert likely.log_evidence[0] == pytest.approx(evidence, abs=1e-8)
    assert likely.boundary_probability(ORDER) == pytest.approx(boundary, abs=1e-9)
    found = fit(x, [ORDER], prior)
    assert found.log_evidence[0] == pytest.approx(evidence, abs=1e-8)
    assert found.count_probability(ORDER) == pytest.approx(count, abs=1e-10)
    assert found.boundary_probability(ORDER) == pytest.approx(boundary, abs=1e-9)
    expected_count = float((np.arange(BINS) * count).sum())
    assert found.boundary_probability(ORDER).sum() == pytest.approx(expected_count, abs=1e-7)


@pytest.mark.parametrize("longest", [BINS, 20])
@pytest.mark.parametrize("size", [1.0, 30.0, 1000.0])
def test_sums_far_below_the_largest_are_as_exact(size, longest):
    # Few segments fit a wild walk worse by thousands of units than many do, or the other way.
    x = size * NOISE_SD * np.cumsum(np.random.default_rng(5).normal(size=(BINS, 2)), axis=0)
    prior, orders = Prior(noise_sd=NOISE_SD), [0, 3, 8]
    found = fit(x, orders, prior, max_segment_bins=longest)
    spread = []
    for row, order in enumerate(orders):
        evidence = segment_log_evidence(x, order, prior)
        i, j = np.indices(evidence.shape)
        sums = log_sums(np.where(j - i < longest, evidence, -np.inf))[0][BINS, 1:]
        possible = np.isfinite(sums)
        ours = found.log_evidence_by_count[row]
        assert (np.isfinite(ours) == possible).all()
        # What one segmentation of a count weighs is the same for all orders.
        share = ours[possible] - sums[possible]
        if row == 0:
            m = np.arange(BINS)
            cuts = gammaln(BINS) - gammaln(m + 1) - gammaln(BINS - m)
            expected = -cuts if longest == BINS else share
        np.testing.assert_allclose(share, expected, rtol=0, atol=1e-7)
        spread.append(np.ptp(sums[possible]))
    assert max(spread) > -np.log(counts.UNDERFLOW)
