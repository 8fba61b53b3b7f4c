"""One short motion in every format that can be read: both wrists of a signer, made by the tests.

Positions are metres, right, forward, up (canonical axes), or pixels (right, up) for image formats.
"""

from __future__ import annotations

import io
import json
import tarfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

RATE_HZ = 50.0
JOINTS = ("right_wrist", "left_wrist", "right_elbow")
UP_RIGHT = {"up": "z", "right": "x"}


def motion(frames: int = 40) -> np.ndarray:
    """Return positions (F, 3, 3) in metres: wrists on ellipses of their own, an elbow between."""
    t = np.arange(frames) / RATE_HZ
    right = np.column_stack([0.25 + 0.1 * np.cos(6 * t), 0.3 + 0.05 * t, 1.1 + 0.1 * np.sin(6 * t)])
    left = np.column_stack([-0.25 + 0.05 * np.sin(4 * t), 0.3 + 0 * t, 1.0 + 0.08 * np.cos(5 * t)])
    return np.stack([right, left, (right + np.array([0.3, 0.0, 1.3])) / 2], axis=1)


@dataclass(frozen=True)
class Sample:
    """A file (or folder) of a format, written by `write`, and how it is read."""

    format: str
    name: str
    write: Callable[[Path, np.ndarray], None]
    spec: dict[str, Any] = field(default_factory=dict)
    pixels: bool = False
    tolerance: float = 2e-6  # metres, by the digits written


def _lines(path: Path, rows: list[str], encoding: str = "utf-8") -> None:
    path.write_bytes(("\n".join(rows) + "\n").encode(encoding))


def _cells(values: np.ndarray, digits: int = 6) -> list[str]:
    return [f"{value:.{digits}f}" for value in np.ravel(values)]


def write_bvh(path: Path, x: np.ndarray) -> None:
    """Three roots side by side, each with positions of its own, in centimetres."""
    rows = ["HIERARCHY"]
    for joint in JOINTS:
        rows += [f"ROOT {joint}", "{", "  OFFSET 0 0 0",
                 "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation",
                 "  End Site", "  {", "    OFFSET 0 5 0", "  }", "}"]  # fmt: skip
    rows += ["MOTION", f"Frames: {len(x)}", f"Frame Time: {1 / RATE_HZ:.6f}"]
    rows += [" ".join(c for p in frame for c in [*_cells(p * 100), "0", "0", "0"]) for frame in x]
    _lines(path, rows)


def write_csv(path: Path, x: np.ndarray, separator: str = ",", decimal: str = ".") -> None:
    """A wide table with a clock, in metres."""
    rows = [separator.join(["time", *(f"{j}_{a}" for j in JOINTS for a in "xyz")])]
    for i, frame in enumerate(x):
        cells = [f"{i / RATE_HZ:.2f}", *_cells(frame)]
        rows.append(separator.join(c.replace(".", decimal) for c in cells))
    _lines(path, rows)


COLUMNS = {joint: [f"{joint}_{axis}" for axis in "xyz"] for joint in JOINTS}


def write_trc(path: Path, x: np.ndarray) -> None:
    """Marker tracks in millimetres."""
    keys = "DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame"
    rate = f"{RATE_HZ:.2f}"
    rows = [
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
        "\t".join([*keys.split(), "OrigNumFrames"]),
        "\t".join([rate, rate, str(len(x)), "3", "mm", rate, "1", str(len(x))]),
        "\t".join(["Frame#", "Time", *(f"{j}\t\t" for j in JOINTS)]),
        "\t\t" + "\t".join(f"{a}{i}" for i in (1, 2, 3) for a in "XYZ"),
        "",
    ]
    rows += [
        "\t".join([str(i + 1), f"{i / RATE_HZ:.6f}", *_cells(f * 1000)]) for i, f in enumerate(x)
    ]
    _lines(path, rows)


def write_c3d(path: Path, x: np.ndarray) -> None:
    """Points in millimetres, written by the library c3d."""
    import pytest

    c3d = pytest.importorskip("c3d", reason="the optional library c3d is not there")
    writer = c3d.Writer(point_rate=RATE_HZ, point_units="mm ", point_scale=-1.0)
    extra = np.zeros((len(x), len(JOINTS), 2))
    frames = np.concatenate([x * 1000, extra], axis=2).astype(np.float32)
    writer.add_frames([(frame, np.zeros((0, 0))) for frame in frames])
    writer.set_point_labels([f"Anna:{joint}" for joint in JOINTS])
    with path.open("wb") as file:
        writer.write(file)


def write_qualisys(path: Path, x: np.ndarray) -> None:
    """An export of Qualisys Track Manager, in millimetres."""
    rows = [
        f"NO_OF_FRAMES\t{len(x)}", "NO_OF_CAMERAS\t8", f"NO_OF_MARKERS\t{len(JOINTS)}",
        f"FREQUENCY\t{RATE_HZ:g}", "NO_OF_ANALOG\t0", "DESCRIPTION\t--",
        "TIME_STAMP\t2026-01-19, 10:19:43.755\t2063631.96", "DATA_INCLUDED\t3D",
        "\t".join(["MARKER_NAMES", *JOINTS]),
        "\t".join(["Frame", "Time", *(f"{j} {a}" for j in JOINTS for a in "XYZ")]),
    ]  # fmt: skip
    rows += [
        "\t".join([str(i + 1), f"{i / RATE_HZ:.5f}", *_cells(f * 1000, 3), ""])
        for i, f in enumerate(x)
    ]
    _lines(path, rows)


def write_vicon(path: Path, x: np.ndarray) -> None:
    """An export of Vicon Nexus, in millimetres, with a section of devices before it."""
    rows = [
        "Devices",
        "1000",
        ",,Force.Fx",
        "Frame,Sub Frame,Fx",
        ",,N",
        "1,0,0.5",
        "",
    ]
    rows += ["Trajectories", f"{RATE_HZ:g}", ",," + ",".join(f"Anna:{j},," for j in JOINTS),
             "Frame,Sub Frame," + ",".join(["X,Y,Z"] * 3), ",," + ",".join(["mm"] * 9)]  # fmt: skip
    rows += [",".join([str(i + 1), "0", *_cells(f * 1000, 3)]) for i, f in enumerate(x)]
    _lines(path, rows)


def write_motive(path: Path, x: np.ndarray) -> None:
    """An export of OptiTrack Motive, in metres: a rigid body that is passed over, and markers."""
    rows = [
        f"Format Version,1.23,Take Name,t,Capture Frame Rate,{RATE_HZ:.6f},Export Frame Rate,"
        f"{RATE_HZ:.6f},Total Exported Frames,{len(x)},Rotation Type,Quaternion,"
        "Length Units,Meters,Coordinate Space,Global",
        "",
        ",Type," + ",".join(["Rigid Body"] * 4 + ["Marker"] * 9),
        ",Name," + ",".join(["hat"] * 4 + [j for j in JOINTS for _ in range(3)]),
        ",ID," + ",".join(["A1"] * 13),
        ",," + ",".join(["Rotation"] * 4 + ["Position"] * 9),
        "Frame,Time (Seconds),X,Y,Z,W," + ",".join(["X,Y,Z"] * 3),
    ]
    rows += [
        ",".join([str(i), f"{i / RATE_HZ:.6f}", "0", "0", "0", "1", *_cells(f)])
        for i, f in enumerate(x)
    ]
    _lines(path, rows)


SIZE = (1280, 720)
LANDMARKS = ("RIGHT_WRIST", "LEFT_WRIST", "RIGHT_ELBOW")
OPENPOSE = ("RWrist", "LWrist", "RElbow")


def pixels(x: np.ndarray) -> np.ndarray:
    """Return the motion as an image of 500 pixels a metre has it: x to the right, y down."""
    return np.stack([640 + 500 * x[..., 0], 700 - 500 * x[..., 2]], axis=-1)


def write_mediapipe(path: Path, x: np.ndarray) -> None:
    """A table as masked-piper writes it: shares of the image, milliseconds, visibility."""
    titles = [f"{a}_{n}" for n in LANDMARKS for a in ("X", "Y", "Z", "visibility")]
    rows = [",".join(["time", *titles])]
    shares = pixels(x) / SIZE
    for i, frame in enumerate(shares):
        cells = [c for p in frame for c in [*_cells(p, 9), "0.0", "0.99"]]
        rows.append(",".join([f"{1000 * i / RATE_HZ:g}", *cells]))
    _lines(path, rows)


def write_openpose_csv(path: Path, x: np.ndarray) -> None:
    """x, y, confidence of each point, without a header."""
    _lines(path, [",".join(c for p in f for c in [*_cells(p), "0.9"]) for f in pixels(x)])


def write_openpose_json(path: Path, x: np.ndarray) -> None:
    """A folder with a file a frame."""
    path.mkdir(exist_ok=True)
    for i, frame in enumerate(pixels(x)):
        body = np.zeros((25, 3))
        for place, point in zip((4, 7, 3), frame, strict=True):
            body[place] = [*point, 0.8]
        person = {"person_id": [-1], "pose_keypoints_2d": body.ravel().tolist()}
        for part, count in (("face", 70), ("hand_left", 21), ("hand_right", 21)):
            person[f"{part}_keypoints_2d"] = [0.0] * (3 * count)
        text = json.dumps({"version": 1.3, "people": [person]})
        (path / f"v_{i:012d}_keypoints.json").write_text(text)


def write_deeplabcut(path: Path, x: np.ndarray) -> None:
    """Three header rows, then the frames."""
    rows = [",".join(["scorer"] + ["net"] * 9),
            ",".join(["bodyparts", *(n for n in LANDMARKS for _ in range(3))]),
            ",".join(["coords"] + ["x", "y", "likelihood"] * 3)]  # fmt: skip
    rows += [
        ",".join([str(i), *(c for p in f for c in [*_cells(p), "0.95"])])
        for i, f in enumerate(pixels(x))
    ]
    _lines(path, rows)


def write_deeplabcut_h5(path: Path, x: np.ndarray) -> None:
    """The same as pandas keeps it in HDF5: one record a frame, names pickled."""
    import pickle

    import pytest

    h5py = pytest.importorskip("h5py", reason="the optional library h5py is not there")
    names = [("net", n, c) for n in LANDMARKS for c in ("x", "y", "likelihood")]
    rows = np.zeros(len(x), dtype=[("index", "i8"), ("values_block_0", "f8", (len(names),))])
    rows["index"] = np.arange(len(x))
    shown = np.concatenate([pixels(x), np.full((*x.shape[:2], 1), 0.95)], axis=2)
    rows["values_block_0"] = shown.reshape(len(x), -1)
    with h5py.File(path, "w") as file:
        group = file.create_group("df_with_missing")
        group.attrs["pandas_type"] = np.bytes_(b"frame_table")
        group.attrs["non_index_axes"] = np.bytes_(pickle.dumps([(1, names)], protocol=0))
        table = group.create_dataset("table", data=rows)
        table.attrs["values_block_0_kind"] = np.bytes_(pickle.dumps(names, protocol=0))


def write_npy(path: Path, x: np.ndarray) -> None:
    """(frames, points, 2), pixels."""
    np.save(path, pixels(x))


def write_npz(path: Path, x: np.ndarray) -> None:
    """The same, compressed."""
    np.savez_compressed(path, keypoints=pixels(x))


def write_pose(path: Path, x: np.ndarray) -> None:
    """A .pose file of two dimensions, by the library pose-format."""
    from pose_format import Pose
    from pose_format.numpy import NumPyPoseBody
    from pose_format.pose_header import PoseHeader, PoseHeaderComponent, PoseHeaderDimensions

    part = PoseHeaderComponent("pose_keypoints_2d", list(OPENPOSE), [], [], "XYC")
    header = PoseHeader(0.2, PoseHeaderDimensions(*SIZE, 0), [part])
    data = pixels(x)[:, None].astype(np.float32)
    confidence = np.ones(data.shape[:3], dtype=np.float32)
    with path.open("wb") as file:
        Pose(header, NumPyPoseBody(RATE_HZ, data, confidence)).write(file)


def _skeleton(x: np.ndarray, joints: tuple[str, ...]) -> list[str]:
    table = np.zeros((len(x), len(joints), 3))
    for j, joint in enumerate(JOINTS):
        table[:, joints.index(joint)] = x[:, j]
    return [" ".join(_cells(frame)) for frame in table]


def write_kinect(path: Path, x: np.ndarray) -> None:
    """Text of 60 columns."""
    from signkin.io.kinect import JOINTS as ORDER

    _lines(path, _skeleton(x, ORDER))


def write_kinect_v2(path: Path, x: np.ndarray) -> None:
    """Text of 75 columns."""
    from signkin.io.kinect import JOINTS_V2

    _lines(path, _skeleton(x, JOINTS_V2))


def write_tsd(path: Path, x: np.ndarray) -> None:
    """An archive with one member of 22 columns: the left glove, then the right one."""
    zeros = ["0"] * 8
    rows = ["\t".join([*_cells(f[1]), *zeros, *_cells(f[0]), *zeros]) for f in x]
    content = ("\n".join(rows) + "\n").encode()
    with tarfile.open(path, "w:gz") as archive:
        member = tarfile.TarInfo("a/one.tsd")
        member.size = len(content)
        archive.addfile(member, io.BytesIO(content))


_OF_SELF = {joint: joint for joint in JOINTS}
_FLAT = {**dict(zip(JOINTS, OPENPOSE, strict=True))}
_GLOVES = {"right_wrist": "right", "left_wrist": "left"}
_LANDMARKS = dict(zip(JOINTS, LANDMARKS, strict=True))
_IMAGE = {"up": "-y", "right": "x"}
_RATE = {"rate_hz": RATE_HZ}
_POINTS = {joint: f"pose_keypoints_2d.{name}" for joint, name in _FLAT.items()}

SAMPLES = {
    sample.format + ("" if sample.name != "m.npz" else "_z"): sample
    for sample in (
        Sample("bvh", "m.bvh", write_bvh, {"unit": "cm", "joints": _OF_SELF}),
        Sample("csv", "m.csv", write_csv, {"unit": "m", "time_column": "time", "joints": COLUMNS}),
        Sample("trc", "m.trc", write_trc, {"joints": _OF_SELF}),
        Sample("c3d", "m.c3d", write_c3d, {"joints": _OF_SELF}, tolerance=1e-6),
        Sample("qualisys_tsv", "m.tsv", write_qualisys, {"joints": _OF_SELF}),
        Sample("vicon_csv", "v.csv", write_vicon, {"joints": _OF_SELF}),
        Sample("motive_csv", "o.csv", write_motive, {"joints": _OF_SELF}),
        Sample("kinect", "k.txt", write_kinect, {"joints": _OF_SELF, **_RATE}),
        Sample("kinect_v2", "k2.txt", write_kinect_v2, {"joints": _OF_SELF, **_RATE}),
        Sample(
            "tsd", "t.tar.gz", write_tsd,
            {"joints": _GLOVES, "part": "a/one.tsd", **_RATE},
        ),
        Sample(
            "mediapipe_csv", "p.csv", write_mediapipe,
            {"joints": _LANDMARKS, "image_size": list(SIZE), **_IMAGE},
            pixels=True,
        ),
        Sample(
            "openpose_csv", "op.csv", write_openpose_csv,
            {"joints": _FLAT, "landmarks": list(OPENPOSE), **_RATE, **_IMAGE}, pixels=True,
        ),
        Sample(
            "openpose_json", "frames", write_openpose_json, {"joints": _POINTS, **_RATE, **_IMAGE},
            pixels=True,
        ),
        Sample(
            "deeplabcut_csv", "d.csv", write_deeplabcut,
            {"joints": _LANDMARKS, **_RATE, **_IMAGE}, pixels=True,
        ),
        Sample(
            "deeplabcut_h5", "d.h5", write_deeplabcut_h5,
            {"joints": _LANDMARKS, **_RATE, **_IMAGE}, pixels=True,
        ),
        Sample(
            "npy", "m.npy", write_npy,
            {"joints": _FLAT, "landmarks": list(OPENPOSE), "unit": "px", **_RATE, **_IMAGE},
            pixels=True,
        ),
        Sample(
            "npy", "m.npz", write_npz,
            {"joints": _FLAT, "landmarks": list(OPENPOSE), "unit": "px", **_RATE, **_IMAGE},
            pixels=True,
        ),
        Sample("pose", "m.pose", write_pose, {"joints": _POINTS, **_IMAGE}, pixels=True,
               tolerance=1e-4),
    )
}  # fmt: skip
