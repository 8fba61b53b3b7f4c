import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from signkin import Interval, Recording, SignkinError
from signkin.coarticulation import SurfaceDuration, euclidean_distance, geodesic_distance
from signkin.coarticulation.duration import Transitions
from signkin.coarticulation.posture import normalised
from signkin.coarticulation.sign_types import TypeRule, Wrists, reach_of, sign_type_rows
from signkin.coarticulation.transitions import (
    transition_rows,
    utterance_names,
    with_normalised,
)

NAN = float("nan")


# --- distances


def test_the_geodesic_distance_is_half_the_angle_and_sees_no_sign():
    a = Rotation.random(40, rng=np.random.default_rng(0))
    b = Rotation.random(40, rng=np.random.default_rng(1))
    expected = (a.inv() * b).magnitude() / 2
    q1, q2 = a.as_quat(), b.as_quat()
    for sign in (1, -1):
        found = geodesic_distance(q1[:, None], sign * q2[:, None])
        assert found == pytest.approx(expected)
    assert geodesic_distance(q1, q2) == pytest.approx(expected.mean())


@settings(max_examples=50, deadline=None)
@given(st.floats(1e-9, np.pi - 1e-9))
def test_small_and_large_angles_are_exact(angle):
    q = Rotation.from_rotvec([0, 0, angle]).as_quat()
    found = geodesic_distance(np.array([[0, 0, 0, 1.0]]), q[None])
    assert found == pytest.approx(angle / 2, rel=1e-9)


def test_gaps_are_left_out_of_the_mean():
    p = np.zeros((3, 3))
    q = np.array([[1.0, 0, 0], [NAN, 0, 0], [0, 3.0, 0]])
    assert euclidean_distance(p, q) == 2
    assert np.isnan(euclidean_distance(p * NAN, q))


def test_normalisation_takes_mean_and_range():
    assert normalised(np.array([1.0, 2, 6])).tolist() == pytest.approx([-0.4, -0.2, 0.6])
    assert np.isnan(normalised(np.array([1.0, NAN, 3]))[1])
    assert normalised(np.array([2.0, 2])).tolist() == [0, 0]


# --- utterances


def signs(*times):
    return [Interval(a, b, f"S{i}", "s") for i, (a, b) in enumerate(times)]


def test_utterances_by_tier_by_gap_and_none():
    some = signs((0, 1), (1.2, 2), (3, 4), (4.5, 5))
    assert utterance_names(some) == ["1"] * 4
    assert utterance_names(some, gap_s=0.5) == ["1", "1", "2", "2"]
    tier = [Interval(0, 2.5, "a", "u"), Interval(2.5, 4.2, "b", "u")]
    assert utterance_names(some, tier) == ["1", "1", "2", ""]


def test_a_long_sign_bridges_the_gap_behind_a_short_one():
    assert utterance_names(signs((0, 5), (1, 2), (5.1, 6)), gap_s=0.5) == ["1", "1", "1"]


# --- transitions


def moving(unit="m"):
    """Return 5 s at 10 Hz: the right wrist moves 1 a second along x, the left one stands."""
    t = np.arange(50) / 10
    right = np.column_stack([t, 0 * t, 0 * t])
    positions = np.stack([right, 0 * right, 0 * right], axis=1)
    turns = Rotation.from_rotvec(np.column_stack([0 * t, 0 * t, t])).as_quat()
    still = np.tile([0, 0, 0, 1.0], (50, 1))
    return Recording(
        name="r", rate_hz=10.0, joints=("right_wrist", "left_wrist", "nose"), unit=unit,
        positions=positions, orientations=np.stack([turns, still, still], axis=1),
        orientation_source="recorded",
    )  # fmt: skip


def types(*digits):
    return pd.DataFrame({"type": digits, "type_source": ["lexicon"] * len(digits)})


def made(some, refined=None, digits=None, names=None, recording=None):
    r = recording or moving()
    manual = np.array([(s.start_s, s.end_s) for s in some])
    refined = refined or {"right": manual, "left": manual}
    return transition_rows(
        r, r.orientations, some, names or ["1"] * len(some),
        types(*(digits or ["00"] * len(some))), refined,
    )  # fmt: skip


def test_durations_distances_and_types():
    some = signs((0, 1), (1.3, 2), (2.4, 3))
    shifted = {"right": np.array([[0, 1.1], [1.3, 2], [2.4, 3]]), "left": np.zeros((3, 2))}
    table = made(some, shifted, ["00", "11", "20"])
    assert len(table) == 2 * 5
    whole = table[table["hand"] == "both"]
    assert whole["duration_s"].tolist() == [0.3, 0.4]
    assert whole["type"].tolist() == ["0011", "1120"]
    assert whole["euclidean_m"].tolist() == pytest.approx([0.1, 0.4 / 3])
    assert whole["geodesic_rad"].tolist() == pytest.approx([0.15 / 3, 0.2 / 3])
    right = table[(table["hand"] == "right") & (table["segmentation"] == "refined")]
    assert right["duration_s"].tolist() == [0.2, 0.4]
    assert right["euclidean_m"].tolist() == pytest.approx([0.2, 0.4])
    left = table[(table["hand"] == "left") & (table["segmentation"] == "manual")]
    assert left["euclidean_m"].tolist() == [0, 0]


def test_zero_length_and_overlap_are_kept_and_named():
    table = made(signs((0, 1), (1, 2), (1.9, 3)))
    whole = table[table["hand"] == "both"]
    assert whole["status"].tolist() == ["zero_length", "overlap"]
    assert whole["duration_s"].tolist() == [0.0, -0.1]


def test_no_transition_between_utterances_or_outside():
    some = signs((0, 1), (1.3, 2), (2.4, 3), (3.2, 4))
    table = made(some, names=["1", "1", "2", ""])
    whole = table[table["hand"] == "both"]
    assert whole["previous_gloss"].tolist() == ["S0"]
    assert made(some[:1]).empty


def test_a_missing_type_leaves_the_four_digits_empty():
    table = made(signs((0, 1), (1.3, 2)), digits=["00", ""])
    assert set(table["type"]) == {""}


def test_normalised_within_segmentation_and_hand_without_overlaps():
    table = made(signs((0, 1), (1.3, 2), (2.4, 3), (2.9, 4)))
    found = with_normalised(table, "m")
    whole = found[found["hand"] == "both"]
    assert whole["euclidean_norm"].tolist()[:2] == pytest.approx([-0.5, 0.5])
    assert np.isnan(whole["mean_distance"].iloc[2])
    assert whole["note"].iloc[2] == "signs overlap: no transition between them"


def test_without_orientations_the_mean_distance_is_the_euclidean_one():
    bare = moving().without_orientations()
    found = with_normalised(made(signs((0, 1), (1.3, 2), (2.4, 3)), recording=bare), "m")
    assert found["mean_distance"].tolist() == pytest.approx(found["euclidean_norm"].tolist())
    assert set(found["note"]) == {"no orientations: the mean distance is the Euclidean one"}


# --- types


RULE = TypeRule(activity=0.35, mirror=0.5, held_shift=0.08, held_height=0.35)
RATE = 50.0


def wave(t, amplitude, phase=0.0):
    return amplitude * np.sin(2 * np.pi * 2 * t + phase)


def inferred(right, left, some, lexicon=None):
    wrists = Wrists(right, left, RATE, reach=0.5)
    return sign_type_rows(some, ["1"] * len(some), wrists, lexicon or {}, RULE)


def paths(kind, seconds=4):
    """Return wrists: at rest for 1 s, then signing two signs of 1 s, then rest."""
    t = np.arange(int(seconds * RATE)) / RATE
    on = (t >= 1) & (t < 3)
    up = np.where(on, 0.4, 0.0)
    still = np.column_stack([0 * t, 0 * t, up])
    right = still + np.where(on, 1, 0)[:, None] * np.column_stack(
        [0.2 + wave(t, 0.1), 0.3 + 0 * t, wave(t, 0.05, 1)]
    )
    mirror = right * [-1, 1, 1]
    if kind == "11":
        return right, mirror
    if kind == "10":
        return right, still + np.where(on, 1, 0)[:, None] * np.column_stack(
            [-0.2 + wave(t, 0.1), 0.3 + 0 * t, wave(t, 0.05, 2.5)]
        )
    left = mirror.copy()
    second = t >= 1.9
    left[second] = mirror[np.flatnonzero(second)[0]]
    if kind == "00":  # the hand drops after the first sign
        left[t >= 1.96] = [0, 0, 0]
    return right, left


SOME = [Interval(1.1, 1.9, "A", "s"), Interval(2.1, 2.9, "B", "s")]


@pytest.mark.parametrize("kind", ["11", "10"])
def test_two_moving_hands(kind):
    assert inferred(*paths(kind), SOME)["kinematic"].tolist() == [kind, kind]


def test_a_held_hand_keeps_the_context_and_a_dropped_one_does_not():
    assert inferred(*paths("20"), SOME)["kinematic"].tolist() == ["11", "20"]
    assert inferred(*paths("00"), SOME)["kinematic"].tolist() == ["11", "00"]


def test_the_lexicon_goes_first():
    table = inferred(*paths("11"), SOME, {"A": "00"})
    assert table["type"].tolist() == ["00", "11"]
    assert table["type_source"].tolist() == ["lexicon", "kinematic"]
    assert table["kinematic"].tolist() == ["11", "11"]


def test_missing_wrists_are_said():
    right, left = paths("11")
    left[60:80] = NAN
    table = inferred(right, left, SOME)
    assert table["kinematic"].tolist() == ["00", "11"]
    assert table["note"].tolist() == ["a wrist is missing: taken for one-handed", ""]
    right[60:80] = NAN
    assert inferred(right, left, SOME)["type"].tolist() == ["", "11"]


def test_the_reach_is_the_arm_or_the_wrists_spread():
    right, left = paths("11")
    assert reach_of(right, left, 0.6) == 0.6
    assert 0.3 < reach_of(right, left, None) < 1.2


# --- the surface


def test_the_printed_example():
    model = SurfaceDuration(theta=np.array([0.148777, 0.663958, 0.275229]))
    assert f"{model.predict(Transitions(0.103753, 1.08172))[0]:.5f}" == "0.51539"


def test_the_surface_is_the_normal_equations_solution():
    rng = np.random.default_rng(0)
    g, e = rng.uniform(0, 0.3, 89), rng.uniform(0, 1, 89)
    y = 0.15 + 0.66 * g + 0.28 * e + rng.normal(0, 0.05, 89)
    x = np.column_stack([np.ones(89), g, e])
    model = SurfaceDuration().fit(Transitions(g, e, y))
    assert model.theta == pytest.approx(np.linalg.inv(x.T @ x) @ x.T @ y)
    assert model.mean_error_s == pytest.approx(np.abs(y - x @ model.theta).mean())
    assert (model.interval()[:, 0] < model.theta).all()


def test_singular_or_missing_input_is_refused():
    line = np.linspace(0, 1, 20)
    with pytest.raises(SignkinError, match="normal equations of 20 transitions are singular"):
        SurfaceDuration().fit(Transitions(line, 2 * line + 0.1, line))
    with pytest.raises(SignkinError, match="a distance or duration is missing"):
        SurfaceDuration().fit(Transitions(line * NAN, line, line))
    with pytest.raises(SignkinError, match="of 3 transitions"):
        SurfaceDuration().fit(Transitions(line[:3], line[:3] ** 2, line[:3]))
