"""Python users get a sentence, too, for what is no motion."""

import numpy as np
import pytest

from signkin.binning import Prior, fit, match
from signkin.coarticulation.posture import euclidean_distance
from signkin.errors import SignkinError
from signkin.kinematics import (
    curvature,
    fill_gaps,
    lowpass,
    resample,
    speed,
    speed_minima,
    velocity,
)
from signkin.recording import Recording


def recording_of(positions):
    return Recording(name="r", rate_hz=100.0, joints=("a",), positions=positions)


X = np.cumsum(np.ones((60, 2)), axis=0)


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: fit(X, orders=3, prior=Prior(noise_sd=1)), "the orders are 3; expected"),
        (lambda: fit(X, orders=[3], prior=0.001), r"the prior is 0.001; expected Prior"),
        (lambda: Prior(noise_sd="device"), "noise_sd is 'device'; expected a standard deviation"),
        (lambda: speed([1.0], 100), r"positions: an array of shape \(1,\); expected shape"),
        (lambda: speed(["a", "b"], 100), "positions: no array of numbers"),
        (lambda: velocity(X, 0), "rate_hz: the rate is 0; expected a number above 0, in Hz"),
        (lambda: speed_minima("fast", 100), "speed: no array of numbers"),
        (lambda: speed_minima(X, 100), r"speed: an array of shape \(60, 2\)"),
        (lambda: speed_minima([1.0, 0.0, 1.0], "fast"), "rate_hz: the rate is 'fast'"),
    ],
)
def test_what_is_none_is_refused_in_a_sentence(call, told):
    with pytest.raises(SignkinError, match=told):
        call()


def test_lists_are_arrays_and_one_speed_has_no_minimum():
    assert speed_minima([1.0], 100).size == 0
    assert speed_minima([2.0, 1.0, 2.0], 2).tolist() == [0.5]
    assert speed([[0, 0], [3, 4]], 2).tolist() == [10.0, 10.0]


def test_what_a_mask_hides_is_a_gap():
    """A masked sample once went on as the number below its mask."""
    rng = np.random.default_rng(2)
    x = rng.normal(size=(60, 3))
    gap = np.arange(60) == 20
    masked = np.ma.masked_array(x, mask=np.repeat(gap[:, None], 3, axis=1))
    plain = np.where(gap[:, None], np.nan, x)
    for call in (
        lambda p: speed(p, 100.0),
        lambda p: lowpass(p, 100.0, 6.0),
        lambda p: curvature(p),
        lambda p: fill_gaps(p, 100.0, 0.0)[0],
        lambda p: fill_gaps(p, 100.0, 0.1)[0],
        lambda p: resample(np.arange(60) / 100, p, 50.0)[1],
        lambda p: speed_minima(p[:, 0], 100.0),
        lambda p: euclidean_distance(p[20:22, None], p[21:23, None]),
        lambda p: recording_of(p[:, None]).positions,
    ):
        found = call(masked)
        assert not np.ma.isMaskedArray(found)
        np.testing.assert_array_equal(found, call(plain))
    with pytest.raises(SignkinError, match="1 gaps"):
        match(masked[:, 0], [1.0])


def test_a_posterior_is_told_in_three_lines():
    found = fit(X + np.random.default_rng(1).normal(size=X.shape), [0, 1], Prior(noise_sd=1))
    assert 1 <= len(repr(found).splitlines()) <= 3
