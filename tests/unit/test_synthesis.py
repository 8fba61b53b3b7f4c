"""Transitions between two signs, on motions whose answer is known."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from signkin.coarticulation import blend, interpolate
from signkin.coarticulation.synthesis import Sign, fitted, limbs, moved, resampled
from signkin.errors import SignkinError
from signkin.kinematics import rotations
from signkin.recording import Recording

RATE = 50.0
JOINTS = ("pelvis", "right_shoulder", "right_elbow", "right_wrist", "left_wrist")
PARENTS = (-1, 0, 1, 2, 0)


def skeleton(frames=60, seed=1, name="a", rate=RATE, bone=0.3):
    """A chain that turns smoothly, with its world positions from forward kinematics."""
    rng = np.random.default_rng(seed)
    t = np.arange(frames) / rate
    shifts = np.zeros((frames, 5, 3))
    shifts[:, 0] = np.column_stack([0.1 * np.sin(t), 0 * t, 1 + 0.05 * t])
    shifts[:, 1:] = np.array([[0.2, 0, 0.4], [bone, 0, 0], [0.25, 0, 0], [-0.4, 0, 0]])
    turns = np.empty((frames, 5, 4))
    for joint in range(5):
        angles = rng.uniform(-1, 1, 3) * np.sin(2 * t + joint)[:, None]
        turns[:, joint] = Rotation.from_rotvec(angles).as_quat()
    positions, orientations = rotations.world_pose(shifts, turns, PARENTS)
    return Recording(
        name=name, rate_hz=rate, joints=JOINTS, positions=positions, orientations=orientations,
        orientation_source="recorded", parents=PARENTS,
    )  # fmt: skip


def points(frames=60, name="p"):
    """Positions only, each joint at constant speed: time can be read off every posture."""
    t = np.arange(frames)[:, None, None] / RATE
    speed = np.arange(1, 16).reshape(1, 5, 3) / 10
    return Recording(name=name, rate_hz=RATE, joints=JOINTS, positions=t * speed)


def sign(take, start, end, gloss="A"):
    return Sign(recording=take, gloss=gloss, start_s=start, end_s=end)


def bone_lengths(take):
    return np.array([
        np.linalg.norm(take.positions[:, c] - take.positions[:, p], axis=1)
        for c, p in enumerate(PARENTS) if p >= 0
    ])  # fmt: skip


@pytest.mark.parametrize("make", [interpolate, blend])
def test_ends_are_the_signs_own_postures_and_the_length_is_the_duration(make):
    take = skeleton()
    a, b = sign(take, 0.1, 0.3), sign(take, 0.8, 1.0, "B")
    made = make(a, b, 0.24)
    assert made.steps == 12 and made.motion.frames == 13
    for frame, expected in ((0, a.last), (-1, b.first)):
        assert made.motion.positions[frame] == pytest.approx(take.positions[expected], abs=1e-12)
        same = np.abs((made.motion.orientations[frame] * take.orientations[expected]).sum(-1))
        assert same == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("make", [interpolate, blend])
def test_bones_keep_their_length(make):
    take = skeleton()
    made = make(sign(take, 0.1, 0.3), sign(take, 0.8, 1.0), 0.3)
    assert np.ptp(bone_lengths(made.motion), axis=1) == pytest.approx(0, abs=1e-12)


@given(st.integers(0, 10_000), st.floats(0, 1))
def test_slerp_is_that_of_scipy(seed, weight):
    a, b = Rotation.random(2, rng=np.random.default_rng(seed)).as_quat()
    expected = Slerp([0, 1], Rotation.from_quat([a, b]))(weight)
    found = Rotation.from_quat(rotations.slerp(a, b, np.array([weight])))
    assert (found.inv() * expected).magnitude() < 1e-9


def test_the_linear_form_runs_on_the_same_arc_faster_in_the_middle():
    a, b = Rotation.from_euler("z", [[0], [160]], degrees=True).as_quat()
    share = np.linspace(0, 1, 21)[:, None]
    angle = 2 * np.arctan2(*rotations.linear(a, b, share)[:, 2:].T)
    straight = 2 * np.arctan2(*rotations.slerp(a, b, share)[:, 2:].T)
    assert np.diff(straight) == pytest.approx(np.radians(8), abs=1e-12)
    assert angle[[0, 10, 20]] == pytest.approx(np.radians([0, 80, 160]))
    assert np.argmax(np.diff(angle)) in (9, 10) and np.ptp(np.diff(angle)) > 0.05


@given(st.integers(0, 1000))
def test_local_poses_lead_back_to_the_world(seed):
    take = skeleton(frames=5, seed=seed)
    local = rotations.local_pose(take.positions, take.orientations, PARENTS)
    positions, turns = rotations.world_pose(*local, PARENTS)
    assert positions == pytest.approx(take.positions, abs=1e-12)
    assert np.abs((turns * take.orientations).sum(-1)) == pytest.approx(1, abs=1e-12)


def test_positions_are_interpolated_linearly_where_there_are_no_orientations():
    take = points()
    made = interpolate(sign(take, 0.1, 0.3), sign(take, 0.8, 1.0), 0.25, keep_limbs=False)
    start, end = take.positions[15], take.positions[40]
    share = np.arange(made.steps + 1)[:, None, None] / made.steps
    assert made.motion.positions == pytest.approx(start + share * (end - start), abs=1e-12)


@pytest.mark.parametrize("take", [points(), skeleton()])
def test_blending_a_captured_transition_in_its_own_time_is_that_transition(take):
    made = blend(sign(take, 0.1, 0.3), sign(take, 0.8, 1.0), 0.5)
    assert made.motion.positions == pytest.approx(take.positions[15:41], abs=1e-9)
    assert made.idle == 0


def test_blending_is_the_weighted_mean_of_retraction_and_preparation():
    take = points()
    made = blend(sign(take, 0.1, 0.3), sign(take, 0.8, 1.0), 0.2, keep_limbs=False)
    w = (np.arange(11) / 10)[:, None, None]
    expected = (1 - w) * take.positions[15:26] + w * take.positions[30:41]
    assert made.motion.positions == pytest.approx(expected, abs=1e-12)


def test_where_motion_is_missing_the_idle_posture_comes_in_and_is_told():
    take = points(frames=60)
    late = sign(take, 0.9, 1.1, "LATE")  # 4 frames after it
    early = sign(take, 0.04, 0.2, "EARLY")  # 2 frames before it
    made = blend(late, early, 0.2, keep_limbs=False)
    assert made.idle == (10 - 4) + (10 - 2)
    assert made.notes == (
        "no motion after LATE for 6 of 10 frames: idle posture",
        "no motion before EARLY for 8 of 10 frames: idle posture",
    )
    steps = np.linalg.norm(np.diff(made.motion.positions, axis=0), axis=-1)
    # Nothing jumps: no step is longer than the whole way at once over a few frames.
    assert steps.max() < np.linalg.norm(take.positions[59] - take.positions[0], axis=-1).max() / 3


def test_limbs_get_their_length_back():
    take = points()
    swing = np.zeros((2, 5, 3))
    swing[0, 1:4] = [[0, 0, 1.4], [0.3, 0, 1.4], [0.6, 0, 1.4]]
    swing[1, 1:4] = [[0, 0, 1.4], [0, 0.3, 1.4], [0, 0.6, 1.4]]
    take = replace(take, positions=swing)
    made = interpolate(sign(take, 0, 0), sign(take, 0.02, 0.02), 0.2)
    free = interpolate(sign(take, 0, 0), sign(take, 0.02, 0.02), 0.2, keep_limbs=False)
    pairs = limbs(JOINTS)
    assert pairs == [(2, 1), (3, 2)]
    for child, parent in pairs:
        kept, loose = (
            np.linalg.norm(m.motion.positions[:, child] - m.motion.positions[:, parent], axis=1)
            for m in (made, free)
        )
        assert kept == pytest.approx(0.3, abs=1e-12)
        assert loose[5] == pytest.approx(0.3 / np.sqrt(2))


def test_another_rate_is_resampled_and_told():
    slow, fast = skeleton(frames=60), skeleton(frames=119, rate=2 * RATE, name="fast")
    found, notes = fitted(sign(fast, 0.2, 0.5), slow)
    assert notes == ("fast resampled from 100 to 50 Hz",)
    assert found.recording.positions == pytest.approx(fast.positions[::2], abs=1e-9)
    assert resampled(points(frames=31), 150.0).positions[:, 1] == pytest.approx(
        np.arange(91)[:, None] / 150 * [0.4, 0.5, 0.6]
    )


def test_another_skeleton_is_put_on_the_first_ones_bones_and_told():
    one, other = skeleton(bone=0.3), skeleton(bone=0.34, name="other", seed=2)
    found, notes = fitted(sign(other, 0.2, 0.5), one)
    assert "other put on the skeleton of a (0.040 m apart)" in notes
    assert bone_lengths(found.recording)[1] == pytest.approx(0.3, abs=1e-12)
    kept = np.abs((found.recording.orientations * other.orientations).sum(-1))
    assert kept == pytest.approx(1, abs=1e-9)


def test_skeletons_with_other_joints_are_refused():
    one, other = points(), replace(points(name="q"), joints=(*JOINTS[:-1], "left_elbow"))
    with pytest.raises(
        SignkinError, match=r"skeletons of p and q differ in left_elbow, left_wrist"
    ):
        interpolate(sign(one, 0.1, 0.2), sign(other, 0.1, 0.2), 0.2)


@pytest.mark.parametrize("duration", [0.0, -0.1, float("nan")])
def test_a_transition_takes_time(duration):
    take = points()
    with pytest.raises(SignkinError, match="expected a duration above 0 s"):
        blend(sign(take, 0.1, 0.2), sign(take, 0.5, 0.6), duration)


def test_an_unknown_form_is_refused():
    take = points()
    with pytest.raises(SignkinError, match="expected slerp, linear"):
        blend(sign(take, 0.1, 0.2), sign(take, 0.5, 0.6), 0.2, orientations="cubic")


def test_moving_a_take_keeps_its_shape():
    take = skeleton()
    there = moved(take, 0.7, np.array([1.0, -2.0, 0.0]))
    assert bone_lengths(there) == pytest.approx(bone_lengths(take))
    local = [rotations.local_pose(t.positions, t.orientations, PARENTS)[0] for t in (take, there)]
    assert local[1][:, 1:] == pytest.approx(local[0][:, 1:], abs=1e-12)
