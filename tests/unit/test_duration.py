"""The four models of transition duration (Naert et al. 2017, section 5.2)."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signkin import SignkinError
from signkin.coarticulation import (
    LinearDuration,
    MeanDuration,
    SimpleBoundedDuration,
    SimpleDuration,
    SurfaceDuration,
)
from signkin.coarticulation.duration import Transitions, predict_left_out

PRINTED = np.array([0.148777, 0.663958, 0.275229])


def made(n=30, seed=1, noise=0.02):
    rng = np.random.default_rng(seed)
    g, e = rng.uniform(0.02, 0.3, n), rng.uniform(0.1, 1.1, n)
    return Transitions(
        g, e, 0.15 + 0.66 * g + 0.28 * e + rng.normal(0, noise, n),
        rng.uniform(1, 3, (n, 2)), rng.uniform(0.5, 1, (n, 2)),
    )  # fmt: skip


def test_the_printed_worked_example_to_its_five_digits():
    found = SurfaceDuration(theta=PRINTED).predict(Transitions(0.103753, 1.08172))
    assert f"{found[0]:.5f}" == "0.51539"


def test_simple_is_equation_3():
    # 0.3 m at 1 and 2 m/s, 0.2 rad at 0.3 and 0.5 rad/s, by hand.
    found = SimpleDuration(alpha=0.25).predict(
        Transitions(0.2, 0.3, linear_speed=[1.0, 2.0], angular_speed=[0.3, 0.5])
    )
    assert found == pytest.approx(0.25 * 2 * 0.3 / 3 + 0.75 * 2 * 0.2 / 0.8)


@given(st.floats(0, 1))
def test_simple_is_right_for_motion_at_the_speed_of_its_signs(alpha):
    """A transition that goes on at the common speed of both signs takes distance / speed."""
    found = SimpleDuration(alpha).predict(
        Transitions([0.5 * 0.7], [1.5 * 0.7], linear_speed=[[1.5, 1.5]], angular_speed=[[0.5, 0.5]])
    )
    assert found == pytest.approx([0.7])


def test_a_part_without_weight_is_not_needed():
    only_linear = SimpleDuration(alpha=1).predict(Transitions(np.nan, 0.3, linear_speed=[1.0, 2.0]))
    assert only_linear == pytest.approx(0.2)
    with pytest.raises(SignkinError, match="no angular_speed"):
        SimpleDuration(alpha=0.5).predict(Transitions(0.1, 0.3, linear_speed=[1.0, 2.0]))


def test_signs_that_stand_still_are_refused():
    with pytest.raises(SignkinError, match=r"linear_speed is 0 or less for 1 transitions"):
        SimpleDuration(1).predict(Transitions([0, 0], [1, 1], linear_speed=[[0, 0], [1, 0]]))


def test_bounded_stays_within_its_bounds_and_is_simple_inside():
    free, held = SimpleDuration(1), SimpleBoundedDuration(1)
    distance = np.array([0.01, 0.3, 1.47])
    data = Transitions(distance, distance, linear_speed=np.ones((3, 2)))
    assert free.predict(data) == pytest.approx(distance)
    assert held.predict(data) == pytest.approx([0.1, 0.3, 0.5])


def test_linear_is_the_line_of_figure_7():
    data = made()
    model = LinearDuration().fit(data)
    parts = [(d - d.mean()) / (d.max() - d.min()) for d in (data.geodesic, data.euclidean)]
    slope, intercept = np.polyfit((parts[0] + parts[1]) / 2, data.duration_s, 1)
    assert model.theta == pytest.approx([intercept, slope])
    # Mean distances are 0 on average: the line passes through the mean duration there.
    assert intercept == pytest.approx(data.duration_s.mean())
    assert model.predict(data).shape == (30,)


def test_linear_without_orientations_uses_the_euclidean_distance():
    data = made()
    data = replace(data, geodesic=np.full(30, np.nan))
    model = LinearDuration().fit(data)
    slope = np.polyfit(data.euclidean / np.ptp(data.euclidean), data.duration_s, 1)[0]
    assert model.theta[1] == pytest.approx(slope)
    assert np.isfinite(model.predict(data)).all()


@pytest.mark.parametrize("model", [LinearDuration(), SurfaceDuration(), MeanDuration()])
def test_what_is_not_fitted_predicts_nothing(model):
    with pytest.raises(SignkinError, match="not fitted"):
        model.predict(Transitions([0.1], [0.2]))


def test_collinear_distances_are_singular():
    g = np.linspace(0, 1, 20)
    with pytest.raises(SignkinError, match="normal equations of 20 transitions are singular"):
        SurfaceDuration().fit(Transitions(g, 3 * g, g))
    with pytest.raises(SignkinError, match="does not vary"):
        LinearDuration().fit(Transitions(g, -g, g))
    with pytest.raises(SignkinError, match="no line through 20 transitions"):
        LinearDuration().fit(Transitions(np.ones(20), np.ones(20), g))


def test_arrays_of_different_lengths_are_refused():
    with pytest.raises(SignkinError, match=r"geodesic has shape \(2,\)"):
        Transitions([0.1, 0.2], [0.1, 0.2, 0.3])
    with pytest.raises(SignkinError, match=r"linear_speed has shape \(3, 1\)"):
        Transitions(np.ones(3), np.ones(3), linear_speed=np.ones((3, 1)))
    chosen = Transitions(np.arange(3.0), np.arange(3.0))[np.array([True, False, True])]
    assert chosen.euclidean.tolist() == [0, 2] and chosen.angular_speed.shape == (2, 2)


def test_a_missing_distance_is_refused_not_dropped():
    data = made()
    data.geodesic[3] = np.nan
    for model in (LinearDuration(), SurfaceDuration()):
        with pytest.raises(SignkinError, match="missing"):
            model.fit(data)


@settings(max_examples=25, deadline=None)
@given(st.integers(4, 25), st.integers(0, 1000))
def test_leaving_one_out_is_the_closed_form_of_least_squares(n, seed):
    """A residual left out is the residual over 1 - leverage."""
    data = made(n, seed)
    if n < 5:
        with pytest.raises(SignkinError, match="singular"):
            predict_left_out(SurfaceDuration, data, list(range(n)))
        return
    x = np.column_stack([np.ones(n), data.geodesic, data.euclidean])
    leverage = np.einsum("ij,ji->i", x, np.linalg.pinv(x))
    residual = data.duration_s - SurfaceDuration().fit(data).predict(data)
    found = predict_left_out(SurfaceDuration, data, list(range(n)))
    assert data.duration_s - found == pytest.approx(residual / (1 - leverage), abs=1e-9)


def test_leaving_groups_out_learns_nothing_from_them():
    data = made(6)
    groups = ["a", "a", "b", "b", "b", "b"]
    found = predict_left_out(MeanDuration, data, groups)
    assert found[:2] == pytest.approx(data.duration_s[2:].mean())
    assert found[2:] == pytest.approx(data.duration_s[:2].mean())
    with pytest.raises(SignkinError, match="1 group to leave out"):
        predict_left_out(MeanDuration, data, ["a"] * 6)
