import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from signkin import SignkinError
from signkin.kinematics import curvature


def circle(radius, angles):
    return radius * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])


@given(st.floats(1e-3, 1e3), st.integers(0, 2**32 - 1))
def test_exact_on_circles_however_unevenly_they_are_run(radius, seed):
    angles = np.cumsum(np.random.default_rng(seed).uniform(0.05, 0.5, 30))
    path = circle(radius, angles)
    found = curvature(path)
    assert np.isnan(found[[0, -1]]).all()
    assert found[1:-1] == pytest.approx(1 / radius, rel=1e-9)
    assert curvature(path[:, :2])[1:-1] == pytest.approx(1 / radius, rel=1e-9)
    wide = curvature(path, spacing=3)
    assert np.isnan(wide[:3]).all()
    assert np.isnan(wide[-3:]).all()
    assert wide[3:-3] == pytest.approx(1 / radius, rel=1e-9)


def test_a_helix_to_second_order_of_the_step():
    radius, pitch = 0.1, 0.05
    errors = []
    for n in (200, 400):
        t = np.linspace(0, 6, n)
        path = np.column_stack([radius * np.cos(t), radius * np.sin(t), pitch * t])
        errors.append(np.nanmax(np.abs(curvature(path) - radius / (radius**2 + pitch**2))))
    assert errors[0] < 1e-3
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.05)


def test_a_line_is_straight_not_a_gap():
    line = np.outer([0.0, 1, 2, 4, 8], [1, 2, 3])
    assert curvature(line)[1:-1].tolist() == [0, 0, 0]


@given(st.integers(0, 2**32 - 1))
def test_the_same_moved_turned_mirrored_and_run_backwards_and_one_over_the_scale(seed):
    rng = np.random.default_rng(seed)
    path = np.cumsum(rng.normal(size=(20, 3)), axis=0)
    found = curvature(path)
    moved = Rotation.random(rng=rng).apply(path) + rng.normal(size=3)
    close = {"rel": 1e-6, "abs": 1e-9, "nan_ok": True}
    assert curvature(moved) == pytest.approx(found, **close)
    assert curvature(path * [-1, 1, 1]) == pytest.approx(found, **close)
    assert curvature(path[::-1])[::-1] == pytest.approx(found, **close)
    assert curvature(path * 1000) == pytest.approx(found / 1000, **close)


def test_coincident_points_gaps_and_short_chords_have_no_curvature():
    path = circle(1.0, np.array([0.0, 0.5, 1.0, 1.0, 1.5, 2.0, 2.5, 3.0]))
    assert np.flatnonzero(np.isnan(curvature(path))).tolist() == [0, 2, 3, 7]
    back = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 0]])
    assert np.isnan(curvature(back)[1])
    path[5, 2] = np.nan
    assert np.flatnonzero(np.isnan(curvature(path))).tolist() == [0, 2, 3, 4, 5, 6, 7]
    uneven = circle(1.0, np.array([0.0, 0.5, 1.0, 1.01, 1.5, 2.0]))
    assert np.flatnonzero(np.isnan(curvature(uneven, least_chord=0.02))).tolist() == [0, 2, 3, 5]
    assert np.isnan(curvature(path[:2])).all()


def test_noise_at_low_speed_is_as_large_as_told_and_a_wider_spacing_takes_it_off():
    rng = np.random.default_rng(1)
    path = np.column_stack([np.arange(20000) * 0.01, np.zeros((20000, 2))])
    path[:, 1] += rng.normal(0, 1e-5, len(path))
    told = np.sqrt(6) * 1e-5 / 0.01**2
    assert np.sqrt(np.nanmean(curvature(path) ** 2)) == pytest.approx(told, rel=0.03)
    assert np.sqrt(np.nanmean(curvature(path, 4) ** 2)) == pytest.approx(told / 16, rel=0.05)


@pytest.mark.parametrize("wrong", [np.zeros(5), np.zeros((5, 4)), np.zeros((5, 1))])
def test_other_shapes_are_refused(wrong):
    with pytest.raises(SignkinError, match="shape"):
        curvature(wrong)
    with pytest.raises(SignkinError, match="spacing"):
        curvature(np.zeros((5, 3)), spacing=0)
