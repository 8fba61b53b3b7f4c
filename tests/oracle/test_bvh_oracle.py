"""Our BVH reader against bvhio, on two recordings of real signing."""

import bvhio
import numpy as np
import pytest

from signkin import read_recording
from signkin.io.bvh import forward_kinematics, parse_bvh, write_bvh

FILES = ("source_animation-boca.bvh", "source_animation-entender.bvh")


@pytest.mark.parametrize("name", FILES)
def test_positions_are_those_of_bvhio(real_corpora, name):
    path = real_corpora / "libras" / name
    recording = read_recording(path, unit="cm")
    root = bvhio.readAsHierarchy(str(path))
    for frame in (0, 1, 100, 377, recording.frames - 1):
        root.loadPose(frame)
        for joint, _, _ in root.layout():
            expected = np.array(joint.PositionWorld) / 100
            found = recording.track(joint.Name)[frame]
            # bvhio computes in 32 bits: a tenth of a millimetre over 2 m.
            assert found == pytest.approx(expected, abs=1e-4), (joint.Name, frame)


@pytest.mark.parametrize("name", FILES)
def test_bones_keep_their_length_and_the_orientation_carries_them(real_corpora, name):
    hierarchy, values, rate = parse_bvh(real_corpora / "libras" / name)
    assert rate == pytest.approx(120, rel=1e-5)
    positions, orientations = forward_kinematics(hierarchy, values)
    elbow, wrist = (hierarchy.joints.index(j) for j in ("RightForeArm", "RightHand"))
    length = np.linalg.norm(positions[:, wrist] - positions[:, elbow], axis=1)
    assert np.ptp(length) < 1e-3 * length.mean()
    from scipy.spatial.transform import Rotation

    bone = (
        Rotation.from_quat(orientations[:, elbow])
        .inv()
        .apply(positions[:, wrist] - positions[:, elbow])
    )
    assert np.abs(bone - bone[0]).max() < 1e-2  # cm: the offset channel, rounded in the file


def test_a_real_file_written_again_is_the_same_motion(real_corpora, tmp_path):
    hierarchy, values, rate = parse_bvh(real_corpora / "libras" / FILES[1])
    write_bvh(tmp_path / "again.bvh", hierarchy, values, rate)
    before = read_recording(real_corpora / "libras" / FILES[1], unit="cm")
    after = read_recording(tmp_path / "again.bvh", unit="cm")
    assert np.abs(before.positions - after.positions).max() < 1e-6
    assert np.abs((before.orientations * after.orientations).sum(axis=2)).min() > 1 - 1e-12
    assert after.rate_hz == pytest.approx(before.rate_hz, rel=1e-9)


def test_the_signer_stands_upright_facing_forward(real_corpora, root):
    """At the T-pose the right hand is to the right, the head up, the toes in front."""
    path = real_corpora / "libras" / FILES[0]
    r = read_recording(path, unit="cm", up="y", right="-x")
    assert r.track("RightHand")[0][0] - r.track("LeftHand")[0][0] > 1.2
    assert r.track("Head")[0][2] - r.track("Hips")[0][2] > 0.5
    assert r.track("RightToeBase")[0][1] - r.track("RightFoot")[0][1] > 0.05
