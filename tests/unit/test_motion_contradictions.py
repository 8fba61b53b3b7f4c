"""Files that contradict themselves: refused with the place, or read as a declared choice says.

By format, over what only that format can say twice. What tables have in common: test_motion_faults.
"""

from __future__ import annotations

import json
import struct

import numpy as np
import pytest

from signkin import SignkinError, read_annotation, read_recording
from support.motion_files import SAMPLES, motion, pixels


def changed(name, folder, change=lambda text: text):
    made = SAMPLES[name]
    path = folder / made.name
    made.write(path, motion(40))
    before = path.read_bytes().decode()
    after = change(before)
    path.write_bytes(after.encode())
    return path, {"format": made.format, **made.spec}, after != before


def swap(old, new):
    return lambda text: text.replace(old, new)


def rows(first, change):
    """Return a change of each row from one on; change: (its number from 0, its text) -> text."""

    def of(text):
        lines = text.rstrip("\n").split("\n")
        return "\n".join(lines[:first] + [change(i, r) for i, r in enumerate(lines[first:])]) + "\n"

    return of


def named(form):
    """Return a change of the first cell of DeepLabCut's rows."""
    return rows(3, lambda i, row: form(i) + "," + row.partition(",")[2])


@pytest.mark.parametrize(
    ("name", "change", "match"),
    [
        ("bvh", swap("Frames: 40", "Frames: 40\nFrames: 30"), "line 31: 'Frames: 30', a second"),
        ("trc", swap("X1\tY1\tZ1\tX2\tY2\tZ2", "X2\tY2\tZ2\tX1\tY1\tZ1"), "line 5: .* over X2"),
        ("qualisys_tsv", swap("FREQUENCY\t50", "FREQUENCY\t60\nFREQUENCY\t50"), "line 5: FREQUENC"),
        ("vicon_csv", swap("\n50\n", "\n50,60\n"), "line 9: the rate is '50, 60'"),
        ("vicon_csv", swap("\n30,0,", "\n30,1,"), "line 42: sub frame '1'"),
        ("vicon_csv", lambda text: text + text, "line 60: another section Trajectories"),
        ("vicon_csv", swap("X,Y,Z", "X,Z,Y"), "line 11: 'Anna:right_wrist' over X, Z, Y"),
        ("motive_csv", swap("Space,Global", "Space,Local"), "line 1: Coordinate Space 'Local'"),
        ("openpose_csv", swap(",0.9\n", ",50\n"), "joint right_elbow, frame 0: a confidence of 50"),
        ("deeplabcut_csv", swap("LEFT_WRIST", "RIGHT_WRIST"), "line 3: 'RIGHT_WRIST' has two col"),
        ("deeplabcut_csv", named(lambda i: f"v/img{7 * i:03d}.png"), "line 5: frame 'v/img007"),
        ("deeplabcut_csv", named(lambda i: f"v/img{i ^ 1:03d}.png"), "line 5: frame 'v/img000"),
        ("deeplabcut_csv", named(lambda i: f"{'ab'[i // 20]}/{i % 20}"), "line 24: frame 'b/0'"),
        ("deeplabcut_csv", named(lambda i: f"{2 * i}.0"), "line 5: frame '2.0' follows '0.0'"),
    ],
)
def test_what_stands_twice_or_out_of_order(tmp_path, name, change, match):
    path, spec, done = changed(name, tmp_path, change)
    assert done
    with pytest.raises(SignkinError, match=match):
        read_recording(path, **spec)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("trc", swap("Frame#", "FRAME#")),
        ("deeplabcut_csv", named(lambda i: f"labeled-data/v/img{i:04d}.png")),
        ("deeplabcut_csv", named(lambda i: f"{i}.0")),
        ("deeplabcut_csv", named(lambda i: "frame")),
        ("openpose_csv", swap(",0.9\n", ",1.04\n")),
        ("qualisys_tsv", swap("NO_OF_CAMERAS\t8", "NO_OF_CAMERAS\t8\nNO_OF_CAMERAS\t8")),
        ("qualisys_tsv", swap("DESCRIPTION\t--", "EVENT\tA\t1\t0.0\nEVENT\tB\t9\t0.2")),
        ("vicon_csv", swap("Frame,Sub Frame,", "Frame,,")),
    ],
)
def test_what_is_unusual_is_read(tmp_path, name, change):
    path, spec, _ = changed(name, tmp_path)
    plain = read_recording(path, **spec)
    path, spec, done = changed(name, tmp_path, change)
    assert done
    assert np.array_equal(read_recording(path, **spec).positions, plain.positions)


@pytest.mark.parametrize(
    ("edit", "match", "choice"),
    [
        (
            (20, struct.pack("<f", 60.0)),
            "60.0 in the header, 50.0 POINT:RATE",
            "header",
        ),
        ((8, struct.pack("<H", 50)), "42 frames by the header's last frame, 40 by POINT", "frames"),
    ],
)
def test_c3d_whose_header_and_parameters_differ(tmp_path, edit, match, choice):
    made = SAMPLES["c3d"]
    path = tmp_path / "m.c3d"
    made.write(path, motion(40))
    content = bytearray(path.read_bytes())
    content[edit[0] : edit[0] + len(edit[1])] = edit[1]
    path.write_bytes(content)
    with pytest.raises(SignkinError, match=match):
        read_recording(path, **made.spec)
    option = {"header": "ignore"} if choice == "header" else {"incomplete": True}
    recording = read_recording(path, **made.spec, **option)
    assert (recording.rate_hz, recording.frames) == (50, 40)


def test_an_infinite_coordinate_of_c3d_is_no_gap(tmp_path):
    made = SAMPLES["c3d"]
    x = motion(40)
    x[3, 0] = np.inf
    made.write(tmp_path / "m.c3d", x)
    with pytest.raises(SignkinError, match=r"joint right_wrist, frame 3: .* infinite"):
        read_recording(tmp_path / "m.c3d", **made.spec)
    x[3, 0] = np.nan
    made.write(tmp_path / "m.c3d", x)
    read = read_recording(tmp_path / "m.c3d", **made.spec)
    assert np.isnan(read.positions).sum() == 3


def test_a_third_coordinate_that_is_confidence_must_be_said(tmp_path):
    path = tmp_path / "m.npy"
    x = pixels(motion(40))
    np.save(path, np.concatenate([x, np.full((*x.shape[:2], 1), 0.9)], axis=2))
    spec = {**SAMPLES["npy"].spec, "format": "npy"}
    with pytest.raises(SignkinError, match=r"third coordinate is 0.9 to 0.9.*confidence: true"):
        read_recording(path, **spec)
    assert (read_recording(path, confidence=True, **spec).positions[..., 1] == 0).all()
    assert (read_recording(path, confidence=False, **spec).positions[..., 1] == 0.9).all()
    np.save(path, np.zeros((12, 25, 2)) + np.linspace(0, 1, 12)[:, None, None])
    flat = {"landmarks": "openpose_body_25", "joints": {"right_wrist": "RWrist"}, "rate_hz": 25}
    with pytest.raises(SignkinError, match="declared unit is m, the chosen joints are in px"):
        read_recording(path, unit="m", **flat)


def test_a_folder_of_frames_holds_one_video(tmp_path):
    made = SAMPLES["openpose_json"]
    folder = tmp_path / "frames"
    made.write(folder, motion(12))
    spec = {"format": made.format, **made.spec}
    for i in range(11, -1, -1):
        (folder / f"v_{i:012d}_keypoints.json").rename(folder / f"v_{i + 7:012d}_keypoints.json")
    assert read_recording(folder, **spec).notes == (
        "the first frame is number 7; times count from there",
    )
    last = folder / f"v_{18:012d}_keypoints.json"
    text = last.read_text()
    last.write_text(text.replace('"people"', '"people": [], "people"'))
    with pytest.raises(SignkinError, match=r"v_0+18_keypoints.json: .*'people' stands twice"):
        read_recording(folder, **spec)
    last.write_text(json.dumps(json.loads(text)))
    last.rename(folder / f"w_{18:012d}_keypoints.json")
    with pytest.raises(SignkinError, match=r"w_0+18_keypoints.json: frames of 'v_' and of 'w_'"):
        read_recording(folder, **spec)


def test_formats_that_are_not_read_say_what_to_do(tmp_path):
    for suffix, told in ((".AMC", "convert both to BVH"), (".asf", "BVH"), (".xlsx", "as CSV")):
        path = tmp_path / f"a{suffix}"
        path.write_bytes(b"x")
        with pytest.raises(SignkinError, match=f"{suffix.lower()} is not read.*{told}"):
            read_recording(path, unit="m")


@pytest.mark.parametrize(
    ("call", "match"),
    [
        (lambda p: read_recording(None), "the path is 'None'"),
        (lambda p: read_annotation(3), "the path is '3'"),
        (lambda p: read_annotation(p, format="csv", tiers=(3,)), "the tiers are"),
        (lambda p: read_annotation(p, format="csv", from_s="1"), "from_s is 1"),
        (lambda p: read_annotation(p, format="csv", to_s="1"), "from_s is 0.0"),
        (lambda p: read_recording(p, format="c3d", incomplete="no"), "incomplete is 'no'"),
        (lambda p: read_recording(p, format="npy", confidence=1), "confidence is '1'"),
    ],
)
def test_arguments_of_another_kind_are_told(tmp_path, call, match):
    path = tmp_path / "x"
    path.write_text("start,end,label\n0,1,A\n")
    with pytest.raises(SignkinError, match=match):
        call(path)


@pytest.mark.parametrize("name", ["deeplabcut_csv", "bvh", "trc", "vicon_csv"])
def test_names_in_another_encoding_are_declared(tmp_path, name):
    old = "LEFT_WRIST" if name == "deeplabcut_csv" else "left_wrist"
    path, spec, _ = changed(name, tmp_path, swap(old, "händ"))
    path.write_bytes(path.read_bytes().decode().encode("latin-1"))
    spec["joints"] = {"left_wrist": "händ"}
    with pytest.raises(SignkinError, match=r"line \d+: byte 0xe4 is not UTF-8.*encoding: latin-1"):
        read_recording(path, **spec)
    assert read_recording(path, encoding="latin-1", **spec).joints == ("left_wrist",)


def test_kinect_in_millimetres_is_refused(tmp_path):
    made = SAMPLES["kinect"]
    made.write(tmp_path / "k.txt", motion(12) * 1000)
    with pytest.raises(SignkinError, match="no sensor sees in metres"):
        read_recording(tmp_path / "k.txt", format="kinect", **made.spec)
