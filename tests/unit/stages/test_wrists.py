"""A wrist ready for bins: hand, gaps, flat axes, low-pass, bins."""

import numpy as np
import pytest

from signkin.errors import SignkinError
from signkin.kinematics import lowpass
from signkin.recording import Recording
from signkin.settings.sections import BinningLowpass
from signkin.stages.wrists import in_bins, moving_hand, ready_wrist
from support.endres import arc, recording_of

SETTINGS = BinningLowpass(cutoff_hz=5.0)
LOW = {"method": "fir", "cutoff_hz": 5.0}


@pytest.mark.parametrize(
    ("flat", "axes"), [((), "xyz"), ((2,), "xy"), ((0,), "yz"), ((1,), "xz"), ((0, 2), "y")]
)
@pytest.mark.parametrize("value", [0.0, 0.7])
def test_an_axis_without_movement_is_left_out_whichever_it_is(flat, axes, value):
    path = arc()
    path[:, flat] = value
    wrist = ready_wrist(recording_of("a", path), "right", 0.2, SETTINGS)
    assert wrist.axes == axes
    moving = ["xyz".index(axis) for axis in axes]
    assert wrist.path == pytest.approx(lowpass(arc()[:, moving], 100.0, **LOW))
    assert wrist.path.flags.c_contiguous


def test_each_hand_can_be_asked_for():
    recording = recording_of("a", arc(seed=1), 0.5 * arc(seed=2))
    for hand, path in (("right", arc(seed=1)), ("left", 0.5 * arc(seed=2))):
        assert ready_wrist(recording, hand, 0.2, SETTINGS).path == pytest.approx(
            lowpass(path, 100.0, **LOW)
        )


def test_gaps_are_filled_up_to_the_longest():
    path = arc()
    path[80:90] = np.nan  # 0.1 s
    recording = recording_of("a", path)
    assert np.isfinite(ready_wrist(recording, "right", 0.1, SETTINGS).path).all()
    with pytest.raises(SignkinError, match=r"recording a, right_wrist: 10 frames without a posi"):
        ready_wrist(recording, "right", 0.09, SETTINGS)


def test_the_hand_with_the_longer_path_moves():
    assert moving_hand(recording_of("a", arc(), 0.9 * arc()), 0.2) == "right"
    assert moving_hand(recording_of("a", 0.9 * arc(), arc()), 0.2) == "left"
    alone = Recording(
        name="a", rate_hz=100.0, joints=("left_wrist",), positions=arc()[:, None], unit="m"
    )
    assert moving_hand(alone, 0.2) == "left"


@pytest.mark.parametrize("degree", range(6))
@pytest.mark.parametrize(("frames", "bins"), [(40, 17), (40, 39), (12, 5)])
def test_polynomials_up_to_the_splines_degree_are_exact(degree, frames, bins):
    rate = 30.0
    rng = np.random.default_rng(degree)
    curve = [np.polynomial.Polynomial(rng.normal(size=degree + 1)) for _ in range(3)]
    t = np.arange(frames) / rate
    x, bin_s = in_bins(np.column_stack([p(t) for p in curve]), rate, bins)
    duration = (frames - 1) / rate
    assert bin_s * bins == pytest.approx(duration)
    middle = (np.arange(bins) + 0.5) * duration / bins
    assert x == pytest.approx(np.column_stack([p(middle) for p in curve]), abs=1e-9)


def test_few_samples_take_a_spline_of_lower_degree():
    t = np.arange(3) / 10
    x, _ = in_bins(np.column_stack([t**2, 1 - t]), 10.0, 2)
    assert x == pytest.approx(np.array([[0.05**2, 0.95], [0.15**2, 0.85]]))


def test_as_many_bins_as_samples_are_the_samples():
    path = np.random.default_rng(1).normal(size=(20, 3))
    x, bin_s = in_bins(path, 50.0, 20)
    assert (x == path).all()
    assert x is not path
    assert bin_s == 1 / 50
