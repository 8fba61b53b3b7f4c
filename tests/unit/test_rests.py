"""Where a hand rests between two strokes, from positions before the low-pass."""

import numpy as np
import pytest

from signkin import SignkinError
from signkin.kinematics import lowpass, rest_times, speed, speed_minima
from signkin.kinematics.rests import REACH_S
from signkin.simulate.strokes import share_done

RATE_HZ = 100.0
FLAT = REACH_S / np.sqrt(3)


def strokes(rng, number, noise_m):
    """Strokes of least jerk between rests, of very different lengths; times of the rests."""
    rests = 1.0 + np.cumsum(rng.uniform(0.25, 0.6, number))
    stops = np.cumsum(rng.normal(size=(number, 3)) * rng.uniform(0.03, 0.25, number)[:, None], 0)
    at = np.arange(int((rests[-1] + 1) * RATE_HZ)) / RATE_HZ
    k = np.clip(np.searchsorted(rests, at, side="right") - 1, 0, number - 2)
    done = share_done(np.clip((at - rests[k]) / (rests[k + 1] - rests[k]), 0, 1))
    x = stops[k] + done[:, None] * (stops[k + 1] - stops[k])
    return x + rng.normal(0, noise_m, x.shape), rests[1:-1]


def near_rests(x, rests):
    """Return the minima of low-passed speed that are nearest to each rest, within 60 ms."""
    times = speed_minima(speed(lowpass(x, RATE_HZ, 6.0), RATE_HZ), RATE_HZ)
    nearest = times[np.abs(times[:, None] - rests).argmin(axis=0)]
    close = np.abs(nearest - rests) < 0.06
    return nearest[close], rests[close]


def test_rests_are_nearer_than_minima_and_their_sd_is_that_of_their_errors():
    x, rests = strokes(np.random.default_rng(4), 300, 5e-4)
    minima, rests = near_rests(x, rests)
    assert len(rests) > 200
    found, sd = rest_times(x, RATE_HZ, minima)
    assert np.abs(found - rests).mean() < 0.6 * np.abs(minima - rests).mean()
    z = np.abs(found - rests) / np.hypot(sd, 0.0015)
    assert 0.43 < (z < 0.674).mean() < 0.57
    assert 0.83 < (z < 1.645).mean() < 0.95
    # Turned and in another unit, the same; along a flat axis nothing is told.
    turned, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    assert rest_times(1000 * x @ turned, RATE_HZ, minima)[0] == pytest.approx(found, abs=1e-7)
    flat = np.column_stack([x, np.full(len(x), 7.0)])
    assert rest_times(flat, RATE_HZ, minima)[1] == pytest.approx(sd)


def test_without_noise_the_rest_is_found_on_the_grid():
    t = np.arange(200) / RATE_HZ - 1.015
    x = np.column_stack([np.where(t < 0, 3 * t**3, -(t**3) + 2 * t**4), np.where(t < 0, 0, t**3)])
    found, sd = rest_times(x, RATE_HZ, np.array([0.99, 1.0, 1.03]))
    assert found == pytest.approx(1.015, abs=1e-6)
    assert (sd < 0.001).all()


def test_smoothed_noise_counts_for_less():
    x, rests = strokes(np.random.default_rng(5), 60, 0.0)
    noise = np.random.default_rng(6).normal(0, 2e-3, x.shape)
    smooth = lowpass(noise, RATE_HZ, 8.0)
    smooth *= noise.std() / smooth.std()
    minima, _ = near_rests(x, rests)
    white = rest_times(x + noise, RATE_HZ, minima)[1]
    assert np.median(rest_times(x + smooth, RATE_HZ, minima)[1]) > 0.8 * np.median(white)


def test_what_positions_do_not_tell_stays_with_the_minimum():
    x, _ = strokes(np.random.default_rng(7), 6, 5e-4)
    minima = np.array([0.02, 1.5, 2.0])
    gone = x.copy()
    gone[152:175] = np.nan  # all after the second minimum
    found, sd = rest_times(gone, RATE_HZ, minima)
    assert found[:2].tolist() == minima[:2].tolist()
    assert sd[:2] == pytest.approx(FLAT)
    assert sd[2] < FLAT
    for still in (np.zeros((300, 3)), np.full((300, 3), np.nan), np.empty((0, 3))):
        found, sd = rest_times(still, RATE_HZ, minima)
        assert found.tolist() == minima.tolist() and sd == pytest.approx(FLAT)
    assert rest_times(x, RATE_HZ, np.empty(0))[0].shape == (0,)
    with pytest.raises(SignkinError, match="the rate is 0"):
        rest_times(x, 0, minima)
