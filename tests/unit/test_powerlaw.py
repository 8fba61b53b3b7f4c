from dataclasses import asdict, fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signkin import SignkinError
from signkin.kinematics import curvature, speed
from signkin.powerlaw import (
    REASONS,
    GroundTruth,
    LeftOut,
    PowerLaw,
    WarpSettings,
    active_part,
    fit_power_law,
    warp_to_power_law,
)
from signkin.settings import Settings
from support.signs import minimum_jerk_sign

# --- fitting


@given(st.floats(-1, 0), st.floats(-4, 4), st.floats(-3, 3), st.integers(0, 2**32 - 1))
def test_an_exact_law_is_found_in_any_unit(beta, log_alpha, log_unit, seed):
    k = 10 ** (np.random.default_rng(seed).uniform(-0.5, 1.5, 60) + log_unit)
    found = fit_power_law(10**log_alpha * k**beta, k)
    assert found.beta == pytest.approx(beta, abs=1e-8)
    assert found.alpha == pytest.approx(10**log_alpha, rel=1e-6)
    assert found.r_squared == pytest.approx(1, abs=1e-8) or abs(beta) < 1e-4
    assert found.speed(k) == pytest.approx(10**log_alpha * k**beta, rel=1e-6)


def test_harmonic_motion_on_an_ellipse_is_the_two_thirds_power_law():
    a, b, turn = 0.2, 0.08, 2 * np.pi  # v = turn (ab)^(1/3) kappa^(-1/3), in closed form
    t = np.arange(2400) / 2400
    path = np.column_stack([a * np.cos(turn * t), b * np.sin(turn * t), 0 * t])
    inner = slice(1, -1)
    found = fit_power_law(speed(path, 2400)[inner], curvature(path)[inner])
    assert found.beta == pytest.approx(-1 / 3, abs=1e-5)
    assert found.alpha == pytest.approx(turn * (a * b) ** (1 / 3), rel=1e-5)
    assert found.r_squared > 1 - 1e-9


def test_the_least_squares_are_of_speed_not_of_its_logarithm():
    k = np.array([1.0, 2.0, 4.0, 8.0, 16.0, 32.0])
    v = k**-0.5
    v[-1] = 1e-6  # tiny for speeds, huge for logarithms
    found = fit_power_law(v, k)
    assert found.beta == pytest.approx(-0.5, abs=0.1)
    assert np.polyfit(np.log(k), np.log(v), 1)[0] < -1.5
    predicted = found.alpha * k**found.beta
    printed = 1 - np.sum((v - predicted) ** 2) / np.sum((v - v.mean()) ** 2)  # eq. 5
    assert found.r_squared == pytest.approx(printed)


def test_a_stop_inside_a_segment_is_no_hindrance():
    k = np.geomspace(1, 100, 40)
    v = k**-0.4
    v[-1] = 0.0
    assert fit_power_law(v, k).beta == pytest.approx(-0.4, abs=0.02)


def test_a_constant_speed_has_exponent_0_and_nothing_to_explain():
    found = fit_power_law(np.full(9, 0.7), np.geomspace(1, 9, 9))
    assert (found.alpha, found.beta) == pytest.approx((0.7, 0))
    assert np.isnan(found.r_squared)


@pytest.mark.parametrize(
    ("v", "k", "said"),
    [
        ([1, 2, 3], [1, 2, 3], "3 samples"),
        ([1, 2, 3, 4], [1, 2, 3], "shape"),
        ([1, 2, 3, 4], [1, 2, np.nan, 4], "1 of 4 samples without"),
        ([1, 2, np.inf, 4], [1, 2, 3, 4], "1 of 4 samples without"),
        ([1, 2, 3, 4], [1, 2, 0, 4], "1 of 4 curvatures are 0"),
        ([1, 2, 3, 4], [5, 5, 5, 5], "constant curvature of 5"),
        ([0, 0, 0, 0], [1, 2, 3, 4], "speeds"),
        ([1, -2, 3, 4], [1, 2, 3, 4], "speeds"),
    ],
)
def test_what_tells_no_law_is_refused(v, k, said):
    with pytest.raises(SignkinError, match=said):
        fit_power_law(np.array(v, dtype=float), np.array(k, dtype=float))


def test_the_active_part_keeps_pauses_inside():
    v = np.array([0, 0.1, 0.2, 1.0, 0.0, 0.5, 0.149, 0.1])
    assert active_part(v) == slice(2, 6)
    assert active_part(v, 0) == slice(0, 8)
    assert active_part(v, 1) == slice(3, 4)
    with pytest.raises(SignkinError, match="1 of them no numbers"):
        active_part(np.array([1.0, np.nan]))
    with pytest.raises(SignkinError, match="share"):
        active_part(v, 1.5)


# --- ground truth


@pytest.fixture(scope="module")
def sign():
    return minimum_jerk_sign(np.random.default_rng(2))


@pytest.fixture(scope="module")
def truth(sign):
    found = warp_to_power_law(sign, 240.0, 1)
    assert isinstance(found, GroundTruth)
    return found


def test_each_segment_obeys_its_own_law_as_measured_from_the_samples(truth):
    """From positions and boundaries alone, nothing that the warping stored."""
    v, k = speed(truth.positions, 240.0), curvature(truth.positions)
    t = np.arange(len(v)) / 240.0
    edges = [0, *truth.boundaries_s, np.inf]
    for i in range(3):
        here = (t >= edges[i]) & (t < edges[i + 1]) & np.isfinite(k)
        found = fit_power_law(v[here], k[here])
        assert found.r_squared > 0.97
        assert found == truth.fitted[i]
        assert found.beta == pytest.approx(truth.drawn[i].beta, abs=0.15)
        assert truth.predicted_speed[here] == pytest.approx(found.speed(k[here]))


def test_sampled_finely_the_laws_are_those_drawn(sign):
    """What the fits miss at 240 Hz is the sampling, not the warping."""
    found = warp_to_power_law(sign, 240.0, 1, WarpSettings(output_rate_hz=8000.0))
    assert isinstance(found, GroundTruth)
    for drawn, fitted in zip(found.drawn, found.fitted, strict=True):
        assert fitted.r_squared > 0.999
        assert fitted.beta == pytest.approx(drawn.beta, abs=0.005)
        assert fitted.alpha == pytest.approx(drawn.alpha, rel=0.01)


def test_the_draw_keeps_to_the_paper(truth):
    beta = np.array([law.beta for law in truth.drawn])
    assert ((beta >= -1) & (beta <= 0)).all()
    assert (np.abs(np.diff(beta)) > 0.1).all()
    assert (truth.durations_s > 0.3).all()
    assert (truth.durations_recorded_s > 0.3).all()
    for ratio in (
        truth.top_speeds / truth.top_speeds_recorded,
        truth.durations_s / truth.durations_recorded_s,
    ):
        assert (ratio < 2).all()
        assert (ratio > 0.5).all()
    assert truth.draws == 1 + sum(truth.rejected.values())
    assert set(truth.rejected) <= set(REASONS)


def test_speed_is_continuous_at_the_boundaries(sign):
    """The step between samples across a boundary shrinks with their distance."""
    steps = []
    for rate in (2000.0, 4000.0, 8000.0):
        found = warp_to_power_law(sign, 240.0, 1, WarpSettings(output_rate_hz=rate))
        assert isinstance(found, GroundTruth)
        v = np.linalg.norm(np.diff(found.positions, axis=0), axis=1) * rate
        after = np.searchsorted(found.time_s, found.boundaries_s)
        steps.append(np.abs(v[after + 1] - v[after - 2]).max())
    assert steps[2] < 0.05
    assert steps[0] > 1.7 * steps[1] > 2.9 * steps[2]


def test_time_and_positions_hang_together(truth, sign):
    assert truth.positions.shape == (len(truth.time_s), 3)
    # The last sample may stand on the end: sums of floats differ by processor.
    assert truth.time_s[-1] - 1e-9 <= truth.duration_s < truth.time_s[-1] + 1 / 240
    recorded = (truth.active.stop - 1 - truth.active.start) / 240
    assert truth.duration_s == pytest.approx(recorded)  # first_gain: duration
    assert truth.positions[0] == pytest.approx(sign[truth.active.start], abs=1e-9)
    assert truth.boundaries_s == pytest.approx(np.cumsum(truth.durations_s)[:-1])
    # Where the boundary was in recorded time, the recorded hand was at the same place.
    frames = np.arange(len(sign)) / 240
    for at_s, place in zip(truth.boundaries_recorded_s, truth.boundary_positions, strict=True):
        there = [np.interp(at_s, frames, sign[:, axis]) for axis in range(3)]
        assert there == pytest.approx(place, abs=1e-4)
    assert np.isnan(truth.curvature[[0, -1]]).all()
    assert np.isfinite(truth.curvature[1:-1]).all()


def test_the_same_seed_makes_the_same_and_another_another(sign, truth):
    again = warp_to_power_law(sign, 240.0, np.random.default_rng(1))
    other = warp_to_power_law(sign, 240.0, 2)
    assert isinstance(again, GroundTruth)
    assert isinstance(other, GroundTruth)
    assert (again.positions == truth.positions).all()
    assert other.drawn != truth.drawn


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_every_accepted_draw_keeps_its_promises(seed):
    found = warp_to_power_law(
        minimum_jerk_sign(np.random.default_rng(seed)), 240.0, seed, WarpSettings(most_draws=100)
    )
    assert found.draws == sum(found.rejected.values()) + isinstance(found, GroundTruth)
    if isinstance(found, GroundTruth):
        assert min(law.r_squared for law in found.fitted) >= 0.97
        assert (np.diff(found.boundaries_s) > 0.3).all()
        v = [law.speed(1.0) for law in found.drawn]
        assert np.isfinite(v).all()


def test_pixels_warp_like_metres(sign, truth):
    found = warp_to_power_law(sign * 1000, 240.0, 1)
    assert isinstance(found, GroundTruth)
    assert found.positions == pytest.approx(truth.positions * 1000, abs=1e-6)
    assert [law.beta for law in found.drawn] == [law.beta for law in truth.drawn]


@pytest.mark.parametrize("inflections", [False, True])
def test_flat_paths_work_too(inflections):
    """At an inflection the curvature is 0, and the law has no speed: its floor has one."""
    t = np.arange(480) / 240
    spiral = (0.3 - 0.08 * t)[:, None] * np.column_stack([np.cos(5 * t), 0.5 * np.sin(5 * t)])
    wave = np.column_stack([0.4 * t, 0.1 * np.sin(6 * t)])
    found = warp_to_power_law(wave if inflections else spiral, 240.0, 1)
    assert isinstance(found, GroundTruth)
    assert found.positions.shape[1] == 2
    assert (found.straight_share > 0) == inflections
    assert min(law.r_squared for law in found.fitted) > 0.97


def test_the_printed_first_gain_is_speed_and_curvature_of_the_first_sample(sign):
    loose = WarpSettings(
        first_gain="first_sample", most_speed_ratio=9, most_duration_ratio=9, least_r_squared=0
    )
    found = warp_to_power_law(sign, 240.0, 5, loose)
    assert isinstance(found, GroundTruth)
    first = speed(sign, 240.0)[found.active.start]
    # v(0) = alpha_1 kappa(0)^beta_1: the warped motion starts at the recorded speed.
    warped = np.linalg.norm(found.positions[1] - found.positions[0]) * 240
    assert warped == pytest.approx(first, rel=0.1)


@pytest.mark.parametrize("first_gain", ["duration", "first_sample"])
def test_draws_that_are_clearly_rejected_are_so_for_the_same_reason(sign, first_gain):
    from signkin.powerlaw.ground_truth import _clearly, _draw, _Path, _Timing, _timing

    settings = WarpSettings(first_gain=first_gain)
    path, rng = _Path(sign, 240.0, settings), np.random.default_rng(3)
    draws = _draw(path, path.time_s[-1] - 3 * settings.least_segment_s - 0.01, 300, rng, settings)
    asked = [(_clearly(path, draws, i, settings), _timing(path, draws, i, settings))
             for i, reason in enumerate(draws.rejected) if not reason]  # fmt: skip
    assert len({clear for clear, _ in asked}) > 1
    for clear, told in asked:
        assert clear == ("" if isinstance(told, _Timing) else told)


def test_a_pause_inside_is_passed():
    """A hand that stands still has a place on the path and no time of its own."""
    sign = minimum_jerk_sign(np.random.default_rng(2), noise_sd=0)
    stopped = np.concatenate([sign[:180], np.repeat(sign[180:181], 60, axis=0), sign[180:]])
    loose = WarpSettings(most_speed_ratio=9, most_duration_ratio=9, least_r_squared=0)
    found = warp_to_power_law(stopped, 240.0, 8, loose)
    assert isinstance(found, GroundTruth)
    moved = np.linalg.norm(np.diff(found.positions, axis=0), axis=1)
    assert moved.min() > 0


def test_too_short_and_hopeless_trajectories_are_left_out_with_the_reason(sign):
    short = warp_to_power_law(sign[100:300], 240.0, 1)
    assert isinstance(short, LeftOut)
    assert "no room for 3 segments of more than 0.3 s" in short.reason
    assert (short.draws, short.rejected) == (0, {})
    t = np.linspace(0, 1.5, 360)
    line = np.outer(10 * (t / 1.5) ** 3 - 15 * (t / 1.5) ** 4 + 6 * (t / 1.5) ** 5, [0.5, 0.2, 0])
    straight = warp_to_power_law(line, 240.0, 1, WarpSettings(most_draws=50))
    assert isinstance(straight, LeftOut)
    assert straight.reason == "none of 50 draws was accepted"
    assert sum(straight.rejected.values()) == straight.draws == 50


@pytest.mark.parametrize(
    ("x", "said"),
    [
        (np.zeros((300, 4)), "shape"),
        (np.zeros((5, 3)), "shape"),
        (np.zeros((300, 3)), "one point"),
        (np.full((300, 3), np.nan), "300 of 300 frames"),
    ],
)
def test_what_is_no_path_is_refused(x, said):
    with pytest.raises(SignkinError, match=said):
        warp_to_power_law(x, 240.0, 1)


@pytest.mark.parametrize(
    "wrong",
    [
        {"first_gain": "median"}, {"segments": 0}, {"least_exponent_step": 0.5},
        {"most_speed_ratio": 1.0}, {"straight_turn_rad": 0.0}, {"output_rate_hz": -1.0},
        {"least_exponent": 0.5},
    ],
)  # fmt: skip
def test_settings_that_leave_nothing_to_draw_are_refused(wrong):
    with pytest.raises(SignkinError, match=next(iter(wrong))):
        WarpSettings(**wrong)


def test_config_and_settings_have_the_same_keys_and_values():
    section = dict(Settings().powerlaw)
    assert set(section) == {field.name for field in fields(WarpSettings)}
    assert WarpSettings(**section) == WarpSettings()
    assert asdict(replace(WarpSettings(), segments=4))["segments"] == 4


def test_a_law_predicts_speeds():
    assert PowerLaw(2.0, -0.5).speed(np.array([1.0, 4.0])) == pytest.approx([2, 1])
