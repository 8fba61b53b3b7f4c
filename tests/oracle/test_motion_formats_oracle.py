"""Real files of formats that people bring, against a second library that reads them.

The files lie beside the project's data (`formats`), and each library is asked for only here.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from signkin import SignkinError, read_recording
from signkin.io.landmarks import MEDIAPIPE_HAND, OPENPOSE_BODY_25, OPENPOSE_HAND
from support.motion_files import SAMPLES, motion


@pytest.fixture(scope="module")
def formats(real_data) -> Path:
    folder = real_data / "formats"
    if not folder.is_dir():
        pytest.skip("no folder `formats` in the real data")
    return folder


def same(found, wanted, tolerance):
    """Hold two arrays to the same gaps and the same values."""
    assert found.shape == wanted.shape
    assert np.array_equal(np.isnan(found).any(axis=2), np.isnan(wanted).any(axis=2))
    assert np.nanmax(np.abs(found - wanted)) <= tolerance


@pytest.mark.parametrize(
    ("name", "rate_hz", "spec"),
    [
        ("Vicon", 100, {}),
        ("Qualisys", 200, {}),
        ("OptiTrack", 160, {}),
        ("gesture", 120, {}),
        ("Optotrak", 30, {"incomplete": True}),
    ],
)
def test_c3d_as_ezc3d_reads_it(formats, name, rate_hz, spec):
    pytest.importorskip("c3d", reason="the optional library c3d is not there")
    ezc3d = pytest.importorskip("ezc3d", reason="the reference library ezc3d is not there")
    path = formats / "c3d" / f"{name}.c3d"
    reference = ezc3d.c3d(str(path))
    labels = reference["parameters"]["POINT"]["LABELS"]["value"]
    points = reference["data"]["points"][:3].transpose(2, 1, 0)  # (F, J, 3), mm
    recording = read_recording(path, **spec)
    assert recording.rate_hz == rate_hz == reference["header"]["points"]["frame_rate"]
    assert list(recording.joints) == [label.strip() for label in labels if label.strip()]
    kept = [i for i, label in enumerate(labels) if label.strip()]
    # Stored as floats or scaled integers: the same to a hundredth of a micrometre.
    same(recording.positions, points[:, kept] / 1000, 1e-7)


def test_a_c3d_file_that_ends_early_is_refused(formats):
    pytest.importorskip("c3d", reason="the optional library c3d is not there")
    with pytest.raises(SignkinError, match=r"where the header says 1149.*incomplete: true"):
        read_recording(formats / "c3d" / "Optotrak.c3d")


@pytest.mark.parametrize(
    ("name", "separator", "skip", "spec", "rate_hz"),
    [
        ("markers.trc", ",", 6, {"incomplete": True}, 100),
        ("walk.trc", "\t", 6, {"incomplete": True, "clock": "first_frame"}, 60),
        ("nan_of_different_cases.trc", "\t", 5, {}, 250),
    ],
)
def test_trc_as_pandas_reads_it(formats, name, separator, skip, spec, rate_hz):
    path = formats / "trc" / name
    table = pd.read_csv(path, sep=separator, skiprows=skip, header=None, na_values=["NaN", "nan"])
    recording = read_recording(path, **spec)
    assert recording.rate_hz == rate_hz and recording.unit == "m"
    count = len(recording.joints)
    points = table.iloc[:, 2 : 2 + 3 * count].apply(pd.to_numeric, errors="coerce").to_numpy()
    points = points.reshape(-1, count, 3).astype(float)
    points[(points == 0).all(axis=2)] = np.nan
    same(recording.positions, points / 1000, 1e-12)


def test_vicon_nexus_as_its_c3d_of_the_same_take(formats):
    """Both files are exports of one take: markers, gaps and places agree to the table's digits."""
    pytest.importorskip("c3d", reason="the optional library c3d is not there")
    table = read_recording(formats / "tables" / "vicon_nexus.csv", format="vicon_csv")
    binary = read_recording(formats / "c3d" / "Vicon.c3d")
    assert table.rate_hz == binary.rate_hz == 100
    # The subject was renamed between the two.
    assert [n.split(":")[1] for n in table.joints] == [n.split(":")[1] for n in binary.joints]
    same(table.positions, binary.positions, 5.1e-6)  # six digits: half of 0.01 mm above 1 m


def test_qualisys_as_numpy_reads_it(formats):
    path = formats / "tables" / "qualisys.tsv"
    table = np.genfromtxt(path, skip_header=12)[:, 2:]
    recording = read_recording(path, format="qualisys_tsv")
    assert recording.rate_hz == 100 and recording.joints[0] == "New 0000"
    same(recording.positions, table.reshape(2000, 15, 3) / 1000, 1e-12)


def test_masked_piper_as_pandas_reads_it(formats):
    path = formats / "tables" / "masked_piper_body.csv"
    table = pd.read_csv(path)
    spec = {"format": "mediapipe_csv", "image_size": [640, 480], "confidence_threshold": 0.0}
    joints = {"right_wrist": "RIGHT_WRIST", "left_wrist": "LEFT_WRIST"}
    recording = read_recording(path, joints=joints, **spec)
    assert recording.rate_hz == pytest.approx(1000 / np.diff(table["time"]).mean())
    columns = [f"{a}_{n}" for n in joints.values() for a in "XYZ"]
    shares = table[columns].to_numpy().reshape(-1, 2, 3)
    same(recording.positions, shares * [640, 480, 640], 1e-9)
    with pytest.raises(SignkinError, match="joint RIGHT_EYE_OUTER stands twice"):
        read_recording(path, joints={"right_eye": "RIGHT_EYE_OUTER"}, **spec)
    hidden = read_recording(path, joints=joints, **{**spec, "confidence_threshold": 0.999})
    seen = table[["visibility_RIGHT_WRIST", "visibility_LEFT_WRIST"]].to_numpy() >= 0.999
    assert np.array_equal(~np.isnan(hidden.positions).any(axis=2), seen)


def test_masked_pipers_hands_where_one_was_found_are_gaps(formats):
    path = formats / "tables" / "masked_piper_hands.csv"
    with path.open(newline="") as file:
        whole = [len(row) == 127 for row in csv.reader(file)][1:]
    recording = read_recording(path, format="mediapipe_csv", image_size=[640, 480])
    assert len(recording.joints) == 2 * len(MEDIAPIPE_HAND)
    assert np.array_equal(~np.isnan(recording.positions).any(axis=(1, 2)), whole)
    assert recording.notes == (f"{whole.count(False)} rows without all landmarks are gaps",)


def test_openpose_without_a_header_as_numpy_reads_it(formats):
    path = formats / "tables" / "openpose_spudnig_body.csv"
    table = np.genfromtxt(path, delimiter=",")
    spec = {"format": "openpose_csv", "rate_hz": 25, "landmarks": ["a", "b", "c", "d"]}
    recording = read_recording(path, image_size=[1, 1], **spec)
    points = np.stack([table[:, i : i + 2] for i in (0, 3, 6, 9)], axis=1)
    points[(points == 0).all(axis=2)] = np.nan
    assert np.isnan(points).any()
    same(recording.positions[..., :2], points, 1e-12)
    with pytest.raises(SignkinError, match="shares of the image"):
        read_recording(path, **spec)


def test_deeplabcut_as_pandas_reads_it(formats):
    path = formats / "tables" / "deeplabcut.csv"
    table = pd.read_csv(path, header=[0, 1, 2], index_col=0)
    recording = read_recording(path, format="deeplabcut_csv", rate_hz=30)
    assert recording.unit == "px"
    assert list(recording.joints) == list(dict.fromkeys(table.columns.get_level_values(1)))
    same(recording.positions[..., :2], table.to_numpy().reshape(len(table), -1, 2), 1e-12)


def test_deeplabcut_in_hdf5_is_the_table_of_the_same_name(formats):
    # pandas with PyTables reads the .h5 as the .csv; that was compared when the reader was made.
    pytest.importorskip("h5py", reason="the optional library h5py is not there")
    path = formats / "tables" / "deeplabcut.h5"
    table = pd.read_csv(path.with_suffix(".csv"), header=[0, 1, 2], index_col=0)
    recording = read_recording(path, rate_hz=30)
    assert list(recording.joints) == list(dict.fromkeys(table.columns.get_level_values(1)))
    same(recording.positions[..., :2], table.to_numpy().reshape(len(table), -1, 2), 0)


def test_key_points_of_numpy(formats):
    path = formats / "tables" / "mediapipe_holistic.npy"
    joints = {
        "nose": "POSE_LANDMARKS.NOSE",
        "left_index_tip": "LEFT_HAND_LANDMARKS.INDEX_FINGER_TIP",
    }
    spec = {"landmarks": "mediapipe_holistic", "rate_hz": 25, "image_size": [1, 1]}
    recording = read_recording(path, joints=joints, **spec)
    values = np.load(path)[:, [0, 33 + 468 + 8]].astype(float)
    same(recording.positions[..., :2], values, 0)
    with pytest.raises(SignkinError, match="33 landmarks, 543 points"):
        read_recording(path, **{**spec, "landmarks": "mediapipe_pose"})


def test_two_dimensions_of_pose_format(formats):
    from pose_format import Pose

    path = formats / "pose" / "openpose_2d.pose"
    body = Pose.read(path.read_bytes()).body
    recording = read_recording(path, rate_hz=24)
    wanted = np.ma.getdata(body.data)[:, 0].astype(float)
    wanted[np.asarray(body.confidence)[:, 0] == 0] = np.nan
    same(recording.positions[..., :2], wanted, 0)
    assert (recording.unit, recording.joints[4]) == ("px", "pose_keypoints_2d.RWrist")
    with pytest.raises(SignkinError, match="the file says 24 Hz, the declaration 60 Hz"):
        read_recording(path, rate_hz=60)


def test_a_folder_of_openpose_as_pose_format_reads_it(tmp_path):
    from pose_format.utils import openpose

    sample = SAMPLES["openpose_json"]
    sample.write(tmp_path / "frames", motion())
    pose = openpose.load_openpose_directory(
        str(tmp_path / "frames"), fps=50, width=1280, height=720
    )
    recording = read_recording(tmp_path / "frames", rate_hz=50)
    wanted = np.ma.getdata(pose.body.data)[:, 0].astype(float)
    wanted[np.asarray(pose.body.confidence)[:, 0] == 0] = np.nan
    same(recording.positions[..., :2], wanted, 1e-4)
    assert tuple(openpose.BODY_POINTS) == OPENPOSE_BODY_25
    assert tuple(openpose.HAND_POINTS) == OPENPOSE_HAND
