"""Readers of text files in tar archives: Auslan gloves and Kinect skeletons."""

import io
import tarfile

import numpy as np
import pytest

from signkin import SignkinError, read_recording
from signkin.io import kinect

TSD = {"joints": {"right_wrist": "right", "left_wrist": "left"}, "rate_hz": 25, "up": "y"}


def packed(path, members, mode="w:gz"):
    with tarfile.open(path, mode) as archive:
        for name, text in members.items():
            info = tarfile.TarInfo(name)
            info.size = len(text.encode())
            archive.addfile(info, io.BytesIO(text.encode()))
    return path


def lines(rows, sep="\t"):
    return "".join(sep.join(f"{v:g}" for v in row) + "\n" for row in rows)


def gloves(frames=3):
    """Return rows whose cell is 100 * frame + column, from 1."""
    return [[100 * frame + column for column in range(1, 23)] for frame in range(frames)]


@pytest.mark.parametrize("mode", ["w:gz", "w"])
def test_a_member_of_an_archive_is_read_in_canonical_axes(tmp_path, mode):
    path = packed(tmp_path / "a.tar.gz", {"day1/x-1.tsd": lines(gloves()), "day1/y": "?"}, mode)
    r = read_recording(path, format="tsd", part="day1/x-1.tsd", name="x-01", right="x", **TSD)
    assert (r.name, r.frames, r.rate_hz, r.unit) == ("x-01", 3, 25, "m")
    # x, y up, z to the signer: canonical y, forward, is -z.
    assert r.track("left_wrist")[1] == pytest.approx([101, -103, 102])
    assert r.track("right_wrist")[2] == pytest.approx([212, -214, 213])
    assert r.orientations is None


def test_a_file_outside_an_archive_is_the_recording_itself(tmp_path):
    path = tmp_path / "alive-1.tsd"
    path.write_text(lines(gloves()))
    assert read_recording(path, **TSD).name == "alive-1"


def broken(line, cell, value):
    rows = [[str(v) for v in row] for row in gloves()]
    rows[line - 1][cell - 1] = value
    return "\n".join("\t".join(row) for row in rows)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (lines(gloves()) + "1\t2\n", r"member m, line 4: 2 columns; expected 22 columns"),
        (lines([range(21)] * 3), r"member m, line 1: 21 columns; expected 22"),
        (broken(2, 5, "x"), r"member m, line 2, column 5: found 'x'; expected a finite number"),
        (broken(3, 22, "nan"), r"member m, line 3, column 22: found 'nan'; expected a finite"),
        (broken(1, 1, "inf"), r"member m, line 1, column 1: found 'inf'"),
        (broken(1, 1, "é"), r"member m: not a text file"),
        ("\n", r"member m: nothing in it"),
    ],
)
def test_bad_members_are_named_with_their_line(tmp_path, text, told):
    path = packed(tmp_path / "bad.tar.gz", {"m": text})
    with pytest.raises(SignkinError, match=r"bad.tar.gz, " + told):
        read_recording(path, format="tsd", part="m", **TSD)


def test_a_missing_member_and_a_broken_archive_are_named(tmp_path):
    path = packed(tmp_path / "a.tar.gz", {"b": "", "a": ""})
    with pytest.raises(SignkinError, match=r"a.tar.gz: no member 'c' among 2 .*; expected a, b"):
        read_recording(path, format="tsd", part="c", **TSD)
    path.write_bytes(path.read_bytes()[:40])
    with pytest.raises(SignkinError, match=r"a.tar.gz: not readable as a tar archive .*whole"):
        read_recording(path, format="tsd", part="b", **TSD)


def test_a_changed_archive_is_read_anew_and_an_unchanged_one_once(tmp_path, monkeypatch):
    path = packed(tmp_path / "a.tar.gz", {f"{k}": lines(gloves(k + 2)) for k in range(30)})
    opened = []
    monkeypatch.setattr(
        tarfile, "open", lambda *a, kept=tarfile.open, **k: opened.append(a) or kept(*a, **k)
    )
    for k in range(30):
        assert read_recording(path, format="tsd", part=f"{k}", **TSD).frames == k + 2
    assert len(opened) == 1
    monkeypatch.undo()
    packed(path, {"0": lines(gloves(9))})
    assert read_recording(path, format="tsd", part="0", **TSD).frames == 9


def skeleton(turn_rad):
    """Return 20 joints of someone who faces the sensor at 2 m, then turned by an angle."""
    at = np.zeros((20, 3))
    for joint, x in (("shoulder", 0.18), ("hip", 0.08), ("wrist", 0.3)):
        at[kinect.JOINTS.index(f"right_{joint}"), 0] = x
        at[kinect.JOINTS.index(f"left_{joint}"), 0] = -x
    at[kinect.JOINTS.index("right_wrist"), 2] = -0.4  # before the body, nearer to the sensor
    at[kinect.JOINTS.index("head"), 1] = 0.6
    cos, sin = np.cos(turn_rad), np.sin(turn_rad)
    return at @ np.array([[cos, 0, -sin], [0, 1, 0], [sin, 0, cos]]) + [0.2, 0.1, 2.0]


KINECT = {
    "joints": {"right_wrist": "right_wrist", "left_wrist": "left_wrist", "head": "head"},
    "format": "kinect", "rate_hz": 30, "up": "y", "right": "x", "part": "m",
}  # fmt: skip


@pytest.mark.parametrize("turn_rad", [0.0, 0.8, -0.8])
def test_a_turned_skeleton_is_turned_back(tmp_path, turn_rad):
    rows = np.tile(skeleton(turn_rad).ravel(), (4, 1))
    path = packed(tmp_path / "k.tar.gz", {"m": lines(rows, " ")})
    plain = read_recording(path, **KINECT)
    turned = read_recording(path, face_sensor=True, **KINECT)
    straight = np.array([[0.5, -1.6, 0.1], [-0.1, -2.0, 0.1], [0.2, -2.0, 0.7]])
    assert turned.positions[0] == pytest.approx(straight, abs=1e-5)
    assert (np.abs(plain.positions[0] - straight).max() < 1e-5) == (turn_rad == 0)
    # Turning keeps every distance.
    lengths = [np.linalg.norm(np.diff(r.positions[0], axis=0), axis=1) for r in (plain, turned)]
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-6)


def test_sixty_columns_are_expected_and_unknown_joints_listed(tmp_path):
    path = packed(tmp_path / "k.tar.gz", {"m": lines([range(59)] * 2, " ")})
    with pytest.raises(SignkinError, match=r"member m, line 1: 59 columns; expected 60 columns"):
        read_recording(path, **KINECT)
    path = packed(path, {"m": lines([[0] * 60] * 2, " ")})
    with pytest.raises(SignkinError, match=r"no joint wrist in the file; expected head, neck"):
        read_recording(path, **{**KINECT, "joints": {"right_wrist": "wrist"}})
    with pytest.raises(SignkinError, match=r"k.tar.gz: both shoulders at one place"):
        read_recording(path, face_sensor=True, **KINECT)
