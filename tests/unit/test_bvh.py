import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from signkin import SignkinError, read_recording
from signkin.io.bvh import forward_kinematics, parse_bvh, write_bvh

ARM = """HIERARCHY
ROOT Hips
{
  OFFSET 0 90 0
  CHANNELS 6 Xposition Yposition Zposition %(root)s
  JOINT Arm
  {
    OFFSET 10 0 0
    CHANNELS 3 %(arm)s
    End Site
    {
      OFFSET 30 0 0
    }
  }
}
MOTION
Frames: %(frames)d
Frame Time: 0.01
%(rows)s
"""
ZXY = "Zrotation Xrotation Yrotation"
ZYX = "Zrotation Yrotation Xrotation"


def write(tmp_path, rows, root=ZXY, arm=ZXY, frames=None):
    text = ARM % {
        "root": root,
        "arm": arm,
        "frames": len(rows) if frames is None else frames,
        "rows": "\n".join(" ".join(str(v) for v in row) for row in rows),
    }
    path = tmp_path / "arm.bvh"
    path.write_text(text)
    return path


def read(path, **spec):
    return read_recording(path, unit="cm", up="y", right="-x", **spec)


def test_positions_of_a_known_pose(tmp_path):
    # The root turns 90 degrees about z: the arm, along x, points up.
    rows = [[1, 90, 2, 90, 0, 0, 0, 0, 0]] * 2
    r = read_recording(write(tmp_path, rows), unit="cm")
    assert r.joints == ("Hips", "Arm", "Arm_end")
    assert r.rate_hz == pytest.approx(100)
    assert r.track("Hips")[0] == pytest.approx([0.01, 0.9, 0.02])
    assert r.track("Arm")[0] == pytest.approx([0.01, 1.0, 0.02])
    assert r.track("Arm_end")[0] == pytest.approx([0.01, 1.3, 0.02])


@pytest.mark.parametrize("order", [ZXY, ZYX])
def test_the_order_of_the_channels_is_the_files(tmp_path, order):
    angles = np.array([20.0, 30.0, 40.0])
    rows = [[0, 0, 0, 0, 0, 0, *angles]] * 2
    r = read_recording(write(tmp_path, rows, arm=order), unit="cm")
    expected = np.eye(3)
    for name, angle in zip(order.split(), angles, strict=True):
        axis = np.eye(3)["XYZ".index(name[0])]
        expected = expected @ Rotation.from_rotvec(np.radians(angle) * axis).as_matrix()
    tip = expected @ [0.3, 0, 0]
    assert r.track("Arm_end")[0] - r.track("Arm")[0] == pytest.approx(tip)
    found = Rotation.from_quat(r.orientations[0, 1]).as_matrix()
    assert found == pytest.approx(expected)


def test_axes_become_right_forward_up(tmp_path):
    rows = [[0, 100, 0, 0, 0, 0, 0, 0, 0]] * 2
    r = read(write(tmp_path, rows))
    # y is up; the arm points along +x, which is the signer's left.
    assert r.track("Hips")[0] == pytest.approx([0, 0, 1.0])
    assert r.track("Arm_end")[0] == pytest.approx([-0.4, 0, 1.0])


def test_orientations_turn_with_the_axes(tmp_path):
    rows = [[0, 0, 0, 0, 0, 90, 0, 0, 0]] * 2  # about the file's y, which is up
    r = read(write(tmp_path, rows))
    assert Rotation.from_quat(r.orientations[0, 0]).as_rotvec() == pytest.approx([0, 0, np.pi / 2])


def test_quaternions_do_not_jump_between_q_and_minus_q(tmp_path):
    rows = [[0, 0, 0, angle, 0, 0, 0, 0, 0] for angle in range(0, 720, 5)]
    r = read_recording(write(tmp_path, rows), unit="cm")
    steps = (r.orientations[1:, 0] * r.orientations[:-1, 0]).sum(axis=1)
    assert steps.min() > 0.99


def test_joints_are_picked_and_renamed_with_their_hierarchy(tmp_path):
    rows = [[0] * 9] * 2
    r = read(write(tmp_path, rows), joints={"left_wrist": "Arm_end", "pelvis": "Hips"})
    assert r.joints == ("left_wrist", "pelvis")
    assert r.parents == (1, -1)


def test_a_written_file_reads_back_the_same(tmp_path):
    rng = np.random.default_rng(0)
    path = write(tmp_path, rng.uniform(-170, 170, (20, 9)).tolist())
    hierarchy, values, rate = parse_bvh(path)
    again = tmp_path / "again.bvh"
    write_bvh(again, hierarchy, values, rate)
    hierarchy2, values2, rate2 = parse_bvh(again)
    assert hierarchy2.joints == hierarchy.joints
    assert hierarchy2.channels == hierarchy.channels
    assert rate2 == pytest.approx(rate, rel=1e-9)
    p1, q1 = forward_kinematics(hierarchy, values)
    p2, q2 = forward_kinematics(hierarchy2, values2)
    assert np.abs(p1 - p2).max() < 1e-6
    assert np.abs((q1 * q2).sum(axis=2)).min() == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize(
    ("spoil", "told"),
    [
        (lambda t: t.replace("Frames: 3", "Frames: 4"), "3 frames, where the header says 4"),
        (lambda t: t[: t.rindex(" ")], "line 21: 8 numbers; expected 9; the file may be truncated"),
        (lambda t: t.replace("MOTION", "MOTOIN"), "line 16: found 'MOTOIN'"),
        (lambda t: t[: t.index("MOTION")], "the file ends in its hierarchy"),
        (lambda t: t.replace("Frame Time: 0.01", "Frame Time: 0"), "the frame time is 0 s"),
        (lambda t: t.replace("CHANNELS 3", "CHANNELS 4"), "line 9: CHANNELS 4"),
        (lambda t: t.replace("0 0 7\n", "0 0 x\n", 1), "line 19: found 'x'; expected a number"),
        (lambda t: t.replace("Frames: 3\n", ""), "no frame count and frame time"),
    ],
)
def test_a_broken_file_is_refused_with_its_line(tmp_path, spoil, told):
    path = write(tmp_path, [[0] * 8 + [7]] * 3)
    path.write_text(spoil(path.read_text()))
    with pytest.raises(SignkinError) as error:
        read(path)
    assert str(error.value).startswith(str(path))
    assert told in str(error.value)


def test_unit_rate_and_joints_must_be_told_or_agree(tmp_path):
    path = write(tmp_path, [[0] * 9] * 2)
    with pytest.raises(SignkinError, match="the unit is missing; expected m, cm, mm or px"):
        read_recording(path)
    with pytest.raises(SignkinError, match="the file says 100 Hz, the declaration 120 Hz"):
        read(path, rate_hz=120)
    with pytest.raises(SignkinError, match=r"no joint Hand in the file; expected Hips, Arm"):
        read(path, joints={"right_wrist": "Hand"})
    with pytest.raises(SignkinError, match="there is no such file"):
        read(tmp_path / "none.bvh")
    with pytest.raises(SignkinError, match="expected two different axes"):
        read_recording(path, unit="cm", up="y", right="-y")
    with pytest.raises(SignkinError, match=r"the suffix '.xyz' tells no motion format"):
        read_recording(tmp_path / "a.xyz")


def test_a_declared_rate_replaces_a_rounded_frame_time(tmp_path):
    path = write(tmp_path, [[0] * 9] * 2)
    path.write_text(path.read_text().replace("0.01", "0.0333333"))
    assert read(path).rate_hz == pytest.approx(30.00003)
    assert read(path, rate_hz=30).rate_hz == 30
