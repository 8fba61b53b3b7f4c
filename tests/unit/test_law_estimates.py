"""Exponents by three regressions, and what noise and filters make of known ones."""

import numpy as np
import pytest

from signkin import SignkinError
from signkin.kinematics import curvature, lowpass, speed
from signkin.powerlaw.estimates import (
    BOTH_ERRORS,
    ESTIMATORS,
    LOGARITHMS,
    NON_LINEAR,
    ellipse,
    estimates,
    noise_gains,
    pitfall,
    pitfalls,
)

RATE = 240.0


def fir(x):
    return lowpass(x, RATE, 6.0, method="fir")


def plain(x):
    return x


@pytest.mark.parametrize("beta", [0.0, -1 / 3, -0.5])
def test_an_ellipse_has_its_exponent(beta):
    path = ellipse(beta, 1.0, 2000.0)
    inside = slice(2000, 4000)
    found = estimates(speed(path, 2000.0)[inside], curvature(path)[inside], 0.0, (0.0, 0.0))
    for name in ESTIMATORS:
        assert found.beta[name] == pytest.approx(beta, abs=2e-3)
    assert found.r_squared > 0.999 or beta == 0


@pytest.mark.parametrize("beta, low, high", [(0.0, -0.08, -0.06), (-0.5, -0.47, -0.46)])
def test_a_filter_bends_exponents_without_any_noise(beta, low, high):
    """A turn of 0.8 s through 6 Hz: toward -1/3, where filter and law agree."""
    found = pitfall(beta, 0.8, 0.0, RATE, fir, np.random.default_rng(1), 1)
    assert low < found.values[NON_LINEAR][0] < high
    same = pitfall(-1 / 3, 0.8, 0.0, RATE, fir, np.random.default_rng(1), 1)
    assert same.values[NON_LINEAR][0] == pytest.approx(-1 / 3, abs=1e-3)


def test_noise_alone_has_an_exponent_and_a_high_correlation():
    found = pitfall(float("nan"), 0.8, 8e-4, RATE, fir, np.random.default_rng(1), 30)
    assert found.r.mean() < -0.6
    for name in (NON_LINEAR, LOGARITHMS):
        assert found.values[name].mean() < -0.1
    # Its size is the filter's affair, not the noise's.
    again = pitfall(float("nan"), 0.8, 8e-3, RATE, fir, np.random.default_rng(1), 30)
    assert again.values[LOGARITHMS] == pytest.approx(found.values[LOGARITHMS], abs=1e-6)


@pytest.mark.parametrize("rate", [25.0, RATE])
def test_with_errors_in_both_noise_alone_has_no_exponent(rate):
    """Deming's line had one with an SD of 6 over draws at 25 Hz: its noise has no first axis."""

    def filtered(x):
        return lowpass(x, rate, 6.0, method="fir")

    found = pitfall(float("nan"), 0.8, 5e-4, rate, filtered, np.random.default_rng(1), 40)
    assert found.told(BOTH_ERRORS) == 0 and found.told(LOGARITHMS) == 40
    assert np.isnan([found.mean(BOTH_ERRORS), found.sd(BOTH_ERRORS)]).all()
    # A movement in more noise than that is told, and nearer to what the filter leaves of it.
    law = pitfall(-1 / 3, 0.8, 3e-3, rate, filtered, np.random.default_rng(1), 40)
    exact = pitfall(-1 / 3, 0.8, 0.0, rate, filtered, np.random.default_rng(1), 1)
    off = {name: abs(law.mean(name) - exact.mean(name)) for name in (BOTH_ERRORS, LOGARITHMS)}
    assert law.told(BOTH_ERRORS) > 30 and law.sd(BOTH_ERRORS) < 0.1
    assert off[BOTH_ERRORS] < 0.6 * off[LOGARITHMS]


def test_errors_in_curvature_flatten_the_line_and_the_third_regression_mends_it():
    rng = np.random.default_rng(4)
    log_k, of_speed = rng.normal(0, 0.5, 20_000), rng.normal(0, 0.05, 20_000)
    v = np.exp(-0.4 * log_k + of_speed)
    k = np.exp(log_k + rng.normal(0, 0.3, 20_000) - 2 * of_speed)
    # Noise and gains whose errors are these where speed and curvature are 1: SD 0.05 and 0.3.
    found = estimates(v, k, 1.0, (0.05, 0.3))
    seen = 0.25 + 0.09 + 4 * 0.0025
    assert found.beta[LOGARITHMS] == pytest.approx((-0.4 * 0.25 - 2 * 0.0025) / seen, abs=0.01)
    assert found.beta[BOTH_ERRORS] == pytest.approx(-0.4, abs=0.02)
    assert found.reliability == pytest.approx(0.25 / seen, abs=0.02) and not found.note


def test_scatter_that_is_no_noise_does_not_turn_the_line_upright():
    """A movement without a law: Deming's line through it has any slope, up to 40 on isl-sim."""
    rng = np.random.default_rng(6)
    k = np.exp(rng.normal(0, 0.5, 400))
    v = np.exp(-0.05 * np.log(k) + rng.normal(0, 0.7, 400))
    found = estimates(v, k, 1e-3, (1.0, 10.0))
    assert found.beta[BOTH_ERRORS] == pytest.approx(found.beta[LOGARITHMS], abs=0.01)


def test_half_noise_is_no_exponent_and_a_sentence():
    rng = np.random.default_rng(7)
    k = np.exp(rng.normal(0, 0.5, 200))
    found = estimates(k**-0.3, k, 1.0, (0.05, 0.4))
    assert np.isnan(found.beta[BOTH_ERRORS])
    assert found.note.startswith("no exponent with errors in both: noise makes ")
    assert np.isfinite([found.beta[NON_LINEAR], found.beta[LOGARITHMS]]).all()


def test_gains_are_those_of_filtered_noise():
    first, second = noise_gains(fir, RATE)
    noise = fir(np.random.default_rng(2).standard_normal((60_000, 2)))[200:-200, 0]
    assert np.std(np.gradient(noise) * RATE) == pytest.approx(first, rel=0.05)
    assert np.std(np.diff(noise, 2) * RATE**2) == pytest.approx(second, rel=0.05)
    assert noise_gains(plain, RATE)[1] == pytest.approx(np.sqrt(6) * RATE**2)


def test_the_smallest_difference_falls_with_the_noise():
    loud, soft = (
        pitfall(-1 / 3, 0.8, sd, RATE, fir, np.random.default_rng(1), 30) for sd in (5e-3, 5e-4)
    )
    assert soft.smallest_difference(NON_LINEAR) < loud.smallest_difference(NON_LINEAR)
    # Told in 80 % of pairs: half the reach is sqrt(2) SDs times 1.4.
    assert loud.smallest_difference(NON_LINEAR) == pytest.approx(
        3.962 * np.std(loud.values[NON_LINEAR], ddof=1), rel=1e-3
    )


def test_the_table_of_pitfalls_has_each_case_once():
    found = pitfalls((0.0,), (0.8, 1.6), 1e-3, RATE, fir, np.random.default_rng(1), 3)
    cases = [(one.beta, one.duration_s, one.noise_sd, len(one.r)) for one in found]
    assert cases[:4] == [(0.0, 0.8, 0.0, 1), (0.0, 1.6, 0.0, 1), (0.0, 0.8, 1e-3, 3),
                         (0.0, 1.6, 1e-3, 3)]  # fmt: skip
    assert [np.isnan(case[0]) for case in cases[4:]] == [True, True]


def test_a_turn_of_few_samples_is_an_error():
    with pytest.raises(SignkinError, match=r"a turn of 0\.2 s at 25 Hz; expected eight samples"):
        ellipse(0.0, 0.2, 25.0)
