"""Checks of the noise: white noise passes, filtered noise and a wrong prior do not."""

import numpy as np
import pytest

from signkin.binning import Prior, fit, noise_coverage, residual_autocorrelation
from signkin.errors import SignkinError


def fitted(noise_sd=0.5, smooth=1, seed=4):
    """Return the fit of a line in noise of 0.5, a running mean of `smooth` bins taken of it."""
    rng = np.random.default_rng(seed)
    noise = rng.normal(0, 0.5, (160 + smooth - 1, 2))
    kernel = np.ones(smooth) / np.sqrt(smooth)
    noise = np.column_stack([np.convolve(axis, kernel, "valid") for axis in noise.T])
    t = np.linspace(-1, 1, 160)[:, None]
    return fit(np.hstack([t, -t]) + noise, (1,), Prior(noise_sd=noise_sd), max_count=3)


def test_white_noise_has_no_memory_and_fills_its_band():
    found = fitted()
    assert abs(residual_autocorrelation(found, 1)) < 1.96 / np.sqrt(320) + 0.02
    assert noise_coverage(found, 1) == pytest.approx(0.95, abs=0.03)
    assert noise_coverage(found, 1, 0.5) == pytest.approx(0.5, abs=0.08)


def test_a_filter_shows_as_memory():
    found = fitted(smooth=4)
    near, far = (residual_autocorrelation(found, 1, lag) for lag in (1, 8))
    assert near > 0.6 and abs(far) < 0.25


def test_too_much_noise_in_the_prior_shows_as_a_band_too_wide():
    wide = fit(fitted().x, (1,), Prior(noise_sd=5.0, dof=1000), max_count=3)
    assert noise_coverage(wide, 1) == 1.0


def test_what_is_no_lag_or_level_is_refused():
    found = fitted()
    with pytest.raises(SignkinError, match="a lag of 160 bins"):
        residual_autocorrelation(found, 1, 160)
    with pytest.raises(SignkinError, match="a level of 1"):
        noise_coverage(found, 1, 1.0)
