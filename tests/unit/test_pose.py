"""Small .pose files written by the library itself; the real one is in tests/oracle."""

import numpy as np
import pytest
from pose_format import Pose
from pose_format.numpy import NumPyPoseBody
from pose_format.pose_header import PoseHeader, PoseHeaderComponent, PoseHeaderDimensions

from signkin import SignkinError, read_recording

WIDTH, HEIGHT = 640, 360
POINTS = ["LEFT_SHOULDER", "RIGHT_SHOULDER", "LEFT_WRIST", "RIGHT_WRIST"]
# Metres in the world: shoulders 0.4 m apart, the right wrist in front and below.
WORLD = np.array([[0.2, -0.4, 0.0], [-0.2, -0.4, 0.0], [0.3, 0.0, -0.1], [-0.3, 0.0, -0.2]])
# Pixels: the shoulders 160 apart, so that a pixel is 0.0025 m.
IMAGE = np.array([[400.0, 120, 0], [240, 120, 0], [440, 280, 0], [200, 280, 0]])
HAND = np.array([[200.0, 280, 0.0], [220, 260, -0.01]])


def component(name, points):
    return PoseHeaderComponent(name=name, points=points, limbs=[], colors=[], point_format="XYZC")


def write(tmp_path, fps=29.97, unseen=(), version=0.2):
    header = PoseHeader(
        version=version,
        dimensions=PoseHeaderDimensions(WIDTH, HEIGHT, WIDTH),
        components=[
            component("POSE_LANDMARKS", POINTS),
            component("RIGHT_HAND_LANDMARKS", ["WRIST", "INDEX_FINGER_TIP"]),
            component("POSE_WORLD_LANDMARKS", POINTS),
        ],
    )
    # As the loader writes it: x and y of every component times the image's size.
    world = WORLD * [WIDTH, HEIGHT, 1]
    points = np.concatenate([IMAGE, HAND, world])
    data = np.tile(points, (5, 1, 1, 1)).astype(np.float32)
    confidence = np.ones((5, 1, len(points)), dtype=np.float32)
    for frame, point in unseen:
        confidence[frame, 0, point] = 0
    path = tmp_path / "x.pose"
    with path.open("wb") as file:
        Pose(header, NumPyPoseBody(fps, data, confidence)).write(file)
    return path


def joints(**names):
    return {k: v.replace("@", "POSE_WORLD_LANDMARKS.") for k, v in names.items()}


def test_world_landmarks_are_metres_again(tmp_path):
    wanted = joints(right_wrist="@RIGHT_WRIST", left_shoulder="@LEFT_SHOULDER")
    r = read_recording(write(tmp_path), joints=wanted, up="-y", right="-x")
    assert r.unit == "m"
    # Right, forward, up: x and y turned, depth towards the camera is forward.
    assert r.track("right_wrist")[0] == pytest.approx([0.3, 0.2, 0.0], abs=1e-6)
    assert r.track("left_shoulder")[0] == pytest.approx([-0.2, 0.0, 0.4], abs=1e-6)


def test_the_rate_is_a_float(tmp_path):
    r = read_recording(write(tmp_path), joints=joints(right_wrist="@RIGHT_WRIST"))
    assert r.rate_hz == 29.97


def test_image_components_alone_are_pixels(tmp_path):
    wanted = {"right_index_tip": "RIGHT_HAND_LANDMARKS.INDEX_FINGER_TIP"}
    r = read_recording(write(tmp_path), joints=wanted)
    assert r.unit == "px"
    assert r.track("right_index_tip")[0] == pytest.approx([220, 260, -6.4], abs=1e-4)


def test_hands_are_set_on_the_world_wrist_in_metres(tmp_path):
    wanted = joints(right_wrist="@RIGHT_WRIST")
    wanted["right_index_tip"] = "RIGHT_HAND_LANDMARKS.INDEX_FINGER_TIP"
    r = read_recording(write(tmp_path), joints=wanted, up="z", right="x")
    shape = (HAND[1] - HAND[0]) * [1, 1, WIDTH] * 0.0025
    assert r.track("right_index_tip")[0] == pytest.approx(WORLD[3] + shape, abs=1e-6)


def test_what_the_tracker_did_not_see_is_a_gap(tmp_path):
    path = write(tmp_path, unseen=[(2, 9)])
    r = read_recording(path, joints=joints(right_wrist="@RIGHT_WRIST"))
    assert np.isnan(r.track("right_wrist")[2]).all()
    assert not np.isnan(r.track("right_wrist")[[0, 1, 3, 4]]).any()


def test_mixed_units_unknown_points_and_truncation_are_refused(tmp_path):
    path = write(tmp_path)
    mixed = {"right_wrist": "POSE_LANDMARKS.RIGHT_WRIST", **joints(left_wrist="@LEFT_WRIST")}
    with pytest.raises(SignkinError, match="POSE_WORLD_LANDMARKS together with POSE_LANDMARKS"):
        read_recording(path, joints=mixed)
    with pytest.raises(SignkinError, match=r"no joint POSE_WORLD_LANDMARKS.NOSE in the file"):
        read_recording(path, joints=joints(nose="@NOSE"))
    with pytest.raises(SignkinError, match="the declared unit is px, the chosen joints are in m"):
        read_recording(path, joints=joints(right_wrist="@RIGHT_WRIST"), unit="px")
    for size in (3, 60, path.stat().st_size - 40):
        path.write_bytes(write(tmp_path).read_bytes()[:size])
        with pytest.raises(SignkinError, match=r"x.pose, \d+ bytes: not readable as a .pose file"):
            read_recording(path, joints=joints(right_wrist="@RIGHT_WRIST"))
