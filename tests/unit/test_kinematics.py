from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from signkin import Recording, SignkinError
from signkin.kinematics import (
    check_recording,
    fill_gaps,
    lowpass,
    parent_relative,
    response_db,
    speed,
    speed_minima,
    with_limb_frames,
)
from signkin.kinematics.filters import fir_taps
from signkin.kinematics.gaps import longest_stretch_s, stretches

NAN = float("nan")


# --- gaps


def test_stretches():
    assert stretches(np.array([True, True, False, True])) == [(0, 2), (3, 4)]
    assert stretches(np.zeros(3, dtype=bool)) == []


def test_short_gaps_are_filled_long_and_outer_ones_stay():
    t = np.arange(20.0)
    track = np.column_stack([t, 2 * t, t**2])
    track[0] = track[5:7] = track[10:14] = NAN
    filled, which = fill_gaps(track, rate_hz=10, longest_gap_s=0.2)
    assert np.flatnonzero(which).tolist() == [5, 6]
    assert np.isnan(filled[[0, 10, 11, 12, 13]]).all()
    assert filled[5, :2] == pytest.approx([5, 10])
    assert 16 < filled[5, 2] < 49
    assert longest_stretch_s(np.isnan(track).any(axis=1), 10) == pytest.approx(0.4)


def test_a_gap_in_one_coordinate_is_a_gap():
    track = np.ones((9, 3))
    track[4, 1] = NAN
    filled, which = fill_gaps(track, 10, 0.0)
    assert not which.any()
    assert np.isnan(filled[4]).all()


@given(st.integers(1, 6), st.integers(1, 6))
def test_filling_never_leaves_the_range_of_its_neighbours(length, step):
    track = np.zeros((20, 3))
    track[8 + length :] = step
    track[8 : 8 + length] = NAN
    filled, _ = fill_gaps(track, 10, 1.0)
    assert filled.min() >= 0
    assert filled.max() <= step


# --- filters


@pytest.mark.parametrize("method", ["butterworth", "fir"])
@pytest.mark.parametrize("rate", [25, 30, 50, 100, 120, 240])
def test_half_gain_at_the_cutoff_whatever_the_rate(method, rate):
    assert response_db(np.array([6.0]), rate, 6.0, method)[0] == pytest.approx(-6.0206, abs=1e-3)


@pytest.mark.parametrize(
    ("rate", "taps", "design_hz"), [(240, 51, 5.577), (30, 7, 5.382), (25, 5, 4.045)]
)
def test_the_fir_filter_of_endres_at_other_rates(rate, taps, design_hz):
    from scipy.signal import firwin

    found = fir_taps(rate, 6.0)
    assert len(found) == taps
    assert found == pytest.approx(firwin(taps, design_hz, fs=rate), abs=2e-4)


@pytest.mark.parametrize("method", ["butterworth", "fir"])
def test_what_is_applied_has_the_told_response_and_no_delay(method):
    rate, t = 100.0, np.arange(2000) / 100.0
    for frequency in (1.0, 4.0, 6.0, 12.0):
        wave = np.sin(2 * np.pi * frequency * t)
        out = lowpass(wave, rate, 6.0, method)[500:1500]
        inside = t[500:1500]
        fit = 2 * np.mean(out * np.exp(-2j * np.pi * frequency * inside)) * 1j
        told = 10 ** (response_db(np.array([frequency]), rate, 6.0, method)[0] / 20)
        assert abs(fit) == pytest.approx(told, abs=2e-3)
        assert abs(np.angle(fit)) < 5e-3 or told < 0.05


@pytest.mark.parametrize("method", ["butterworth", "fir"])
def test_lines_pass_unchanged_up_to_the_edges(method):
    line = np.column_stack([np.linspace(0, 3, 80), np.linspace(5, -2, 80)])
    assert lowpass(line, 100, 6, method) == pytest.approx(line, abs=1e-3)
    constant = np.full((40, 3), 7.0)
    assert lowpass(constant, 100, 6, method) == pytest.approx(constant, abs=1e-9)


@pytest.mark.parametrize("method", ["butterworth", "fir"])
def test_gaps_stay_and_do_not_spread(method):
    x = np.sin(np.arange(100) / 9.0)
    x[40:45] = NAN
    out = lowpass(x, 50, 6, method)
    assert np.flatnonzero(np.isnan(out)).tolist() == [40, 41, 42, 43, 44]
    assert out[:40] == pytest.approx(lowpass(x[:40], 50, 6, method))


@pytest.mark.parametrize("length", range(1, 12))
@pytest.mark.parametrize("method", ["butterworth", "fir"])
def test_pieces_shorter_than_the_filter(method, length):
    out = lowpass(np.linspace(0, 1, length), 100, 6, method)
    assert np.isfinite(out).all()


def test_impossible_filters_are_refused():
    x = np.zeros(50)
    with pytest.raises(SignkinError, match="a cut-off of 30 Hz at 50 Hz; expected above 0 and bel"):
        lowpass(x, 50, 30)
    with pytest.raises(SignkinError, match="a rate of 14 Hz; expected 15 Hz or more"):
        lowpass(x, 14, 3, "fir")
    with pytest.raises(SignkinError, match="the filter is 'median'; expected butterworth, fir"):
        lowpass(x, 50, 6, "median")


# --- speed and minima


def test_speed_on_a_circle():
    rate, radius, turn = 200.0, 0.3, 2.0
    t = np.arange(400) / rate
    path = radius * np.column_stack([np.cos(turn * t), np.sin(turn * t), 0 * t])
    found = speed(path, rate)
    assert found[1:-1] == pytest.approx(radius * turn, rel=1e-4)
    several = speed(np.stack([path, 2 * path], axis=1), rate)
    assert several.shape == (400, 2)
    assert several[5, 1] == pytest.approx(2 * several[5, 0])


def test_speed_is_unknown_in_and_beside_gaps():
    path = np.zeros((10, 3))
    path[4, 2] = NAN
    assert np.flatnonzero(np.isnan(speed(path, 10))).tolist() == [3, 4, 5]


def test_minima_of_a_known_curve():
    rate = 100.0
    t = np.arange(300) / rate
    curve = 1 + np.cos(2 * np.pi * t)  # minima at 0.5, 1.5, 2.5
    assert speed_minima(curve, rate) == pytest.approx([0.5, 1.5, 2.5])


def test_prominence_spacing_plateaus_and_gaps():
    v = np.array([5, 1, 5, 4, 5, 0, 0, 0, 5, 2, 5], dtype=float)
    assert speed_minima(v, 1).tolist() == [1, 3, 6, 9]
    assert speed_minima(v, 1, prominence=1.5).tolist() == [1, 6, 9]
    assert speed_minima(v, 1, spacing_s=4).tolist() == [1, 6]
    v[5] = NAN
    assert speed_minima(v, 1).tolist() == [1, 3, 9]
    assert speed_minima(np.full(5, NAN), 1).tolist() == []
    assert speed_minima(np.array([0.0, 1, 2, 1, 0]), 1).tolist() == []


# --- orientations


def body(turn, n=3):
    """Return a recording of one bent right arm, turned as a whole."""
    arm = {
        "right_shoulder": [0, 0, 0], "right_elbow": [0.3, 0, 0], "right_wrist": [0.3, 0.25, 0],
        "right_index_1": [0.33, 0.33, 0.02], "right_pinky_1": [0.27, 0.33, 0.0],
        "left_wrist": [-1, 0, 0],
    }  # fmt: skip
    points = np.array(list(arm.values()))
    return Recording(
        name="b", rate_hz=50.0, joints=tuple(arm),
        positions=np.tile(turn.apply(points), (n, 1, 1)),
        parents=(-1, 0, 1, 2, 2, -1),
    )  # fmt: skip


def test_limb_frames_turn_with_the_body():
    turn = Rotation.from_rotvec([0.3, -0.7, 1.1])
    before, after = with_limb_frames(body(Rotation.identity())), with_limb_frames(body(turn))
    assert after.orientation_source == "limb_frames"
    for joint in ("right_shoulder", "right_elbow", "right_wrist"):
        j = after.index(joint)
        a, b = (Rotation.from_quat(r.orientations[0, j]) for r in (before, after))
        assert (b * a.inv()).as_rotvec() == pytest.approx(turn.as_rotvec())
    assert np.isnan(after.orientations[:, after.index("left_wrist")]).all()
    assert np.isnan(after.orientations[:, after.index("right_index_1")]).all()


def test_a_limb_frame_points_along_its_limb():
    r = with_limb_frames(body(Rotation.identity()))
    x = Rotation.from_quat(r.orientations[0, r.index("right_elbow")]).apply([1, 0, 0])
    assert x == pytest.approx([0, 1, 0])


def test_a_straight_arm_has_no_frame_and_no_arm_is_an_error():
    r = body(Rotation.identity())
    r.positions[1, r.index("right_wrist")] = [0.6, 0, 0]
    found = with_limb_frames(r)
    assert np.isnan(found.orientations[1, r.index("right_shoulder")]).all()
    assert np.isfinite(found.orientations[0, r.index("right_shoulder")]).all()
    bare = Recording(name="x", rate_hz=1.0, joints=("nose",), positions=np.zeros((2, 1, 3)))
    with pytest.raises(SignkinError, match="no limb frame can be made"):
        with_limb_frames(bare)


def test_parent_relative_orientations_do_not_see_the_whole_body_turn():
    rng = np.random.default_rng(1)
    local = [Rotation.random(4, rng=rng), Rotation.random(4, rng=rng)]
    world = np.stack([local[0].as_quat(), (local[0] * local[1]).as_quat()], axis=1)
    r = Recording(
        name="x", rate_hz=1.0, joints=("pelvis", "chest"), positions=np.zeros((4, 2, 3)),
        orientations=world, orientation_source="recorded", parents=(-1, 0),
    )  # fmt: skip
    found = parent_relative(r)[:, 1]
    assert (Rotation.from_quat(found) * local[1].inv()).magnitude() == pytest.approx(0, abs=1e-7)


# --- plausibility


def person(scale=1.0, rate=50.0, swap=False, unit="m"):
    t = np.arange(300) / 50.0
    shoulder = np.array([0.18, 0, 1.4])
    elbow = shoulder + np.array([0.05, 0.05, -0.28])
    wrist = elbow[None] + np.column_stack(
        [-0.15 + 0.1 * np.sin(4 * t), 0.2 + 0 * t, 0.05 + 0.05 * np.sin(6 * t)]
    )
    wrist = elbow + (wrist - elbow) / np.linalg.norm(wrist - elbow, axis=1)[:, None] * 0.25
    right = np.stack([np.tile(shoulder, (300, 1)), np.tile(elbow, (300, 1)), wrist], axis=1)
    left = right * [-1, 1, 1]
    if swap:
        right[100:110, 2], left[100:110, 2] = left[100:110, 2].copy(), right[100:110, 2].copy()
    joints = [f"{s}_{p}" for s in ("right", "left") for p in ("shoulder", "elbow", "wrist")]
    return Recording(
        name="p", rate_hz=rate, joints=tuple(joints), unit=unit,
        positions=np.concatenate([right, left], axis=1) * scale,
    )  # fmt: skip


def verdicts(recording):
    return {f.check: f for f in check_recording(recording)}


def test_a_person_is_plausible():
    assert {f.verdict for f in check_recording(person())} == {"plausible"}


def test_a_wrong_unit_is_named():
    found = verdicts(person(scale=1000))
    assert found["right upper arm"].verdict == "implausible"
    assert "in mm" in found["right upper arm"].note


def test_a_wrong_rate_is_named():
    found = verdicts(person(rate=500))
    assert found["right wrist speed, 99th percentile"].verdict == "implausible"
    assert "about" in found["right wrist speed, 99th percentile"].note
    assert found["right upper arm"].verdict == "plausible"


def test_a_hand_may_rest_while_the_other_moves_but_not_both():
    moving = person()
    still = moving.positions.copy()
    still[:, moving.index("left_wrist")] = still[0, moving.index("left_wrist")]
    found = verdicts(replace(moving, positions=still))["left wrist speed, 99th percentile"]
    assert (found.verdict, found.value) == ("plausible", pytest.approx(0, abs=1e-9))
    assert "rests" in found.note
    slow = verdicts(person(rate=0.5))
    for hand in ("right", "left"):
        assert slow[f"{hand} wrist speed, 99th percentile"].verdict == "implausible"


@pytest.mark.parametrize("method", ["butterworth", "fir"])
def test_columns_are_filtered_as_if_alone_whatever_their_gaps(method):
    x = np.random.default_rng(1).normal(size=(120, 4)).cumsum(axis=0)
    x[30:40] = np.nan
    x[70:75, 2] = np.nan
    alone = [lowpass(column, 50, 6, method) for column in x.T]
    assert np.array_equal(lowpass(x, 50, 6, method), np.column_stack(alone), equal_nan=True)


def test_swapped_hands_are_counted():
    assert verdicts(person(swap=True))["frames at which the hands swap"].value == 2
    assert verdicts(person())["frames at which the hands swap"].value == 0


def test_pixels_are_measured_by_the_shoulders_or_not_at_all():
    found = verdicts(person(scale=400, unit="px"))
    assert found["right wrist speed, 99th percentile"].verdict == "plausible"
    assert found["right upper arm"].verdict == "not testable"


@settings(max_examples=25, deadline=None)
@given(st.integers(20, 200), st.floats(0.5, 4.0))
def test_the_same_motion_at_any_rate_has_the_same_minima(rate, frequency):
    t = np.arange(0, 5, 1 / rate)
    curve = 1 + np.cos(2 * np.pi * frequency * t)
    found = speed_minima(curve, rate)
    expected = (np.arange(len(found)) + 0.5) / frequency
    assert np.abs(found - expected).max(initial=0) <= 0.5 / rate + 1e-9
