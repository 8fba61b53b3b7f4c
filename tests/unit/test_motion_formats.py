"""One motion in every format: the same rate, the same places, the same speeds."""

import numpy as np
import pytest

from signkin import read_recording
from signkin.io import motion_formats
from signkin.kinematics import speed
from support.motion_files import JOINTS, RATE_HZ, SAMPLES, motion

X = motion()


def expected(sample, joint):
    track = X[:, JOINTS.index(joint)]
    if not sample.pixels:
        return track
    # Pixels: right as it is, up turned about, no depth.
    flat = np.zeros_like(track)
    flat[:, 0], flat[:, 2] = 640 + 500 * track[:, 0], -(700 - 500 * track[:, 2])
    return flat


def written(sample, folder, spec=None):
    path = folder / sample.name
    sample.write(path, X)
    return read_recording(path, format=sample.format, **(spec or sample.spec))


@pytest.mark.parametrize("name", SAMPLES)
def test_the_same_motion_in_every_format(tmp_path, name):
    sample = SAMPLES[name]
    r = written(sample, tmp_path)
    assert r.rate_hz == pytest.approx(RATE_HZ, rel=1e-6)
    assert r.unit == ("px" if sample.pixels else "m")
    assert r.notes == ()
    scale = 500 if sample.pixels else 1
    for joint in sample.spec["joints"]:
        want = expected(sample, joint)
        assert np.abs(r.track(joint) - want).max() <= sample.tolerance * scale
        # What the analyses see: speeds, and no more of the writing's rounding than its last digit.
        off = np.abs(speed(r.track(joint), r.rate_hz) - speed(want, RATE_HZ)).max()
        assert off <= 2 * sample.tolerance * scale * RATE_HZ


def test_every_format_is_tried():
    assert {sample.format for sample in SAMPLES.values()} == set(motion_formats())
