import pickle

import numpy as np
import pytest

from signkin import Annotation, Interval, Recording, SignkinError

POSITIONS = np.zeros((4, 2, 3))
JOINTS = ("right_wrist", "left_wrist")


def recording(**changes):
    fields = {"name": "r", "rate_hz": 50.0, "joints": JOINTS, "positions": POSITIONS}
    return Recording(**{**fields, **changes})


def test_times_and_frames():
    r = recording(rate_hz=29.97)
    assert r.duration_s == pytest.approx(4 / 29.97)
    assert r.times_s == pytest.approx(np.arange(4) / 29.97)
    assert r.frame_at(0.034) == 1
    assert r.frame_at(99) == 3
    assert r.frame_at(-1) == 0


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"rate_hz": 0.0}, "the rate is 0 Hz; expected a rate above 0 Hz"),
        ({"rate_hz": float("nan")}, "the rate is nan Hz"),
        ({"unit": "inch"}, "the unit is 'inch'; expected m, px"),
        ({"joints": ("a", "a")}, "a occurs twice"),
        ({"joints": ("a",)}, "expected (frames, 1, 3)"),
        ({"positions": POSITIONS[:1]}, "there are 1 frames"),
        ({"positions": np.full((4, 2, 3), np.inf)}, "joint right_wrist, frame 0"),
        ({"orientations": np.zeros((4, 2, 4))}, "both or neither"),
        (
            {"orientations": np.ones((4, 2, 4)), "orientation_source": "recorded"},
            "a quaternion has length 2; expected unit quaternions",
        ),
        ({"orientation_source": "guessed"}, "the source is 'guessed'"),
        ({"parents": (-1,)}, "1 parents"),
    ],
)
def test_a_broken_recording_is_refused_with_its_place(changes, told):
    with pytest.raises(SignkinError, match="recording r") as error:
        recording(**changes)
    assert told in str(error.value)


def test_gaps_are_no_error():
    positions = POSITIONS.copy()
    positions[2] = np.nan
    quaternions = np.zeros((4, 2, 4))
    quaternions[..., 3] = 1
    quaternions[1] = np.nan
    r = recording(positions=positions, orientations=quaternions, orientation_source="recorded")
    assert np.isnan(r.track("left_wrist")[2]).all()
    assert r.without_orientations().orientations is None


def test_an_unknown_joint_lists_the_known_ones():
    with pytest.raises(SignkinError, match=r"no joint 'nose'; expected right_wrist, left_wrist"):
        recording().track("nose")


def interval(start, end, label="A", tier="sign"):
    return Interval(start, end, label, tier)


def test_intervals_are_put_in_order_and_found_by_tier():
    a = Annotation(
        name="x", intervals=(interval(2, 3, "B"), interval(0, 1), interval(0, 3, "U", "u"))
    )
    assert [i.label for i in a.tier("sign")] == ["A", "B"]
    assert a.tiers == ("sign", "u")
    assert a.times_s("sign").tolist() == [[0, 1], [2, 3]]


@pytest.mark.parametrize(
    ("bad", "told"),
    [
        (interval(1, 1), "it runs from 1.000 s to 1.000 s"),
        (interval(2, 1), "an end after the start"),
        (interval(-0.5, 1), "it starts at -0.500 s"),
        (interval(float("nan"), 1), "a time is missing"),
    ],
)
def test_a_broken_interval_is_refused_with_its_place(bad, told):
    with pytest.raises(SignkinError, match="annotation x, tier sign, 'A'") as error:
        Annotation(name="x", intervals=(bad,))
    assert told in str(error.value)


def test_tags_after_the_motion_are_refused():
    a = Annotation(name="x", intervals=(interval(0, 1), interval(1, 2.02, "LAST")))
    a.refuse_past(2.0, tolerance_s=0.02)
    with pytest.raises(SignkinError, match=r"'LAST'.*end after the motion, the last at 2.020 s"):
        a.refuse_past(2.0, tolerance_s=0.01)


def test_an_unknown_tier_lists_the_known_ones():
    with pytest.raises(SignkinError, match=r"no tier 'glosses'; expected sign"):
        Annotation(name="x", intervals=(interval(0, 1),)).tier("glosses")


def test_errors_keep_their_parts_over_a_process_boundary():
    error = SignkinError("found", file="f", place="p", expected="e", todo="Do it.")
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) == "f, p: found; expected e. Do it."
    assert str(SignkinError("x").at(file="g")) == "g: x."
    assert error.at(file="g").file == "f"
