"""Small inputs that fail, or failed: each is read rightly, or refused with one sentence.

The inputs lie beside the project's data (folder `cases` of what SIGNKIN_CASES names). Each case
says what is right; inputs of the same kinds that the project makes itself are in tests/unit.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np
import pytest

from signkin import SignkinError, read_recording
from signkin.io.bvh import parse_bvh, write_bvh
from signkin.kinematics.plausibility import check_recording

WRISTS = {"right_wrist": ["rx", "ry", "rz"], "left_wrist": ["lx", "ly", "lz"]}
TABLE = {"joints": WRISTS, "unit": "m", "rate_hz": 100}
BVH = {"unit": "cm"}
NAMES = ("Hips", "Arm", "Arm_end")
FLAT = {"right_wrist": ["rx", "ry"], "left_wrist": ["lx", "ly"]}


@pytest.fixture(scope="module")
def cases() -> Path:
    data = os.environ.get("SIGNKIN_DATA")
    named = os.environ.get("SIGNKIN_CASES")
    folder = Path(named) if named else Path(data).resolve().parent / "cases" if data else None
    if folder is None or not (folder / "motion").is_dir():
        pytest.skip("the cases are not there: SIGNKIN_CASES, or `cases` beside SIGNKIN_DATA")
    return folder / "motion"


def read(name, **spec):
    """Return a check that reads the case and looks at it."""

    def check(look):
        return (name, spec, look)

    return check


def first(recording):
    return [recording.track(j)[0].tolist() for j in ("right_wrist", "left_wrist")]


def wrists(recording):
    assert first(recording) == [[1.5, 2.5, 3.5], [4.5, 5.5, 6.5]]


def clock(rate_hz, duration_s=None):
    def look(recording):
        assert recording.rate_hz == pytest.approx(rate_hz, rel=1e-6)
        assert duration_s is None or recording.duration_s == pytest.approx(duration_s, rel=1e-6)

    return look


def names(recording):
    assert recording.joints == NAMES
    assert recording.track("Hips")[0] == pytest.approx([0.01, 0.9, 0.02])


def lost_frame(recording):
    assert recording.track("Arm")[0] == pytest.approx([0.01, 1.0, 0.02])
    assert np.isnan(recording.track("Arm")[1]).all()
    assert np.isfinite(recording.track("Arm_end")[2]).all()


def three_frames(recording):
    assert recording.frames == 3
    assert "1 frames more than the 2" in recording.notes[0]


def openpose(recording):
    assert first(recording) == [[100, 200, 0], [300, 200, 0]]
    assert recording.unit == "px"


def inches(recording):
    assert recording.track("Hips")[0] == pytest.approx([0.0254, 90 * 0.0254, 0.0508])


def gap(recording):
    lost = np.isnan(recording.track("right_wrist")).all(axis=1)
    assert np.flatnonzero(lost).tolist() == list(range(40, 46))


POSE = {"joints": {"right_wrist": "POSE_LANDMARKS.RIGHT_WRIST"}}
CLOCK = {"joints": WRISTS, "unit": "m", "time_column": "time"}
READ = [
    read("01-csv-row-longer-than-header", **TABLE)(wrists),
    read("02-csv-row-longer-than-header-crash", frame_column="frame", **TABLE)(wrists),
    read("05-csv-time-in-ms", time_unit="ms", **CLOCK)(clock(30, 1.0)),
    read("06-csv-time-rounded-to-ms-120hz", rate_hz=120, **CLOCK)(clock(120)),
    read("08-csv-semicolon-decimal-comma", **TABLE)(wrists),
    read("13-bvh-nan-angle", **BVH)(lost_frame),
    read("17-bvh-brace-on-joint-line", **BVH)(names),
    read("18-bvh-utf8-bom", **BVH)(names),
    read("19-bvh-upper-lower-case", **BVH)(names),
    read("21-bvh-more-frames-than-header", **BVH)(three_frames),
    read("22-bvh-frame-time-4-digits", rate_hz=120, **BVH)(clock(120)),
    read(
        "23-bvh-wrong-frame-time-cannot-be-overruled",
        rate_hz={"use": 120, "instead_of_file": True},
        **BVH,
    )(clock(120)),
    read(
        "27-pose-openpose-2d",
        rate_hz=25,
        joints={
            "right_wrist": "pose_keypoints_2d.RWrist",
            "left_wrist": "pose_keypoints_2d.LWrist",
        },
    )(openpose),
    read("29-pose-two-people", part="2", **POSE)(lambda r: r.frames == 4),
    read("34-bvh-inches", unit="inch")(inches),
    read("34-bvh-inches", unit=0.0254)(inches),
    read("38-csv-zero-is-missing", joints=FLAT, unit="px", rate_hz=25, missing=0)(gap),
    read(
        "38-csv-zero-is-missing",
        joints=FLAT,
        unit="px",
        rate_hz=25,
        confidence={"right_wrist": "rc"},
    )(gap),
]
REFUSED = [
    ("04-csv-stray-line-is-a-frame", TABLE, r"line 4: 1 cells; expected 7"),
    ("05-csv-time-in-ms", CLOCK, r"0\.03 Hz is no rate of motion: are these milliseconds.*ms"),
    ("09-csv-wrong-line-in-error", TABLE, r"line 6, column rz: found 'x'"),
    ("11-csv-duplicate-column", TABLE, r"column 'rx' stands twice"),
    ("12-infinite-becomes-gap", TABLE, r"line 3, column rx: found 'inf'"),
    ("14-bvh-frames-nan", BVH, r"line 17: 'nan' frames"),
    ("15-bvh-row-shift", BVH, r"line 20: 8 numbers; expected 9"),
    (
        "23-bvh-wrong-frame-time-cannot-be-overruled",
        {"rate_hz": 120, **BVH},
        r"23.9998 Hz, the declaration 120 Hz.*instead_of_file: true",
    ),
    ("29-pose-two-people", POSE, r"2 people.*part"),
    (
        "30-pose-v01-contradicting-rate",
        {"rate_hz": 60, **POSE},
        r"the file says 30 Hz, the declaration 60",
    ),
    (
        "31-bvh-two-people-same-names",
        {"joints": {"right_wrist": "Arm", "left_wrist": "Hips"}, **BVH},
        r"joint Arm, Hips stands twice",
    ),
    (
        "33-option-misspelt",
        {"frame_colum": "frame", **TABLE},
        r"no option frame_colum of the format csv; expected .*frame_column, time_column",
    ),
    ("37-folder-of-json", {"format": "csv", **TABLE}, r"this is a folder"),
]


def input_of(folder: Path) -> Path:
    inputs = list(folder.glob("in.*"))
    return inputs[0] if inputs else folder / "v"


@pytest.mark.parametrize(("name", "spec", "look"), READ, ids=lambda v: v if type(v) is str else "")
def test_a_case_is_read_rightly(cases, name, spec, look):
    look(read_recording(input_of(cases / name), **spec))


@pytest.mark.parametrize(
    ("name", "spec", "told"), REFUSED, ids=lambda v: v if type(v) is str and v[0].isdigit() else ""
)
def test_a_case_is_refused_with_its_place(cases, name, spec, told):
    with pytest.raises(SignkinError, match=told) as error:
        read_recording(input_of(cases / name), **spec)
    assert "\n" not in str(error.value) and len(str(error.value)) < 1500


def test_names_beyond_ascii_are_written_too(cases, tmp_path):
    hierarchy, values, rate_hz = parse_bvh(cases / "24-bvh-write-non-ascii-name" / "in.bvh")
    write_bvh(tmp_path / "out.bvh", hierarchy, values, rate_hz)
    assert parse_bvh(tmp_path / "out.bvh")[0].joints == ("Hips", "Épaule_右手", "Épaule_右手_end")


def test_an_error_is_not_as_long_as_the_file(tmp_path):
    path = tmp_path / "in.bvh"
    for content in (b"\0" * 2_000_000, b"x" * 300_000, b"HIERARCHY\nROOT " + b"y" * 300_000):
        path.write_bytes(content)
        with pytest.raises(SignkinError) as error:
            read_recording(path, unit="cm")
        assert len(str(error.value)) < 800
    table = tmp_path / "in.csv"
    for text in ("x" * 300_000 + ",ry\n1,2\n", "rx,ry\n" + "z" * 100_000 + ",1\n"):
        table.write_text(text)
        with pytest.raises(SignkinError) as error:
            read_recording(table, joints={"right_wrist": ["rx", "ry"]}, unit="px", rate_hz=25)
        assert len(str(error.value)) < 800


def test_the_advice_on_units_does_not_contradict_itself(cases):
    spec = {
        "right_shoulder": ["rsx", "rsy", "rsz"],
        "right_elbow": ["rex", "rey", "rez"],
        **WRISTS,
    }
    path = input_of(cases / "35-plausibility-wrong-advice")
    recording = read_recording(path, unit="cm", rate_hz=60, joints=spec)
    findings = [f for f in check_recording(recording) if f.verdict == "implausible"]
    arms = {f.note for f in findings if "arm" in f.check and "variation" not in f.check}
    # One factor for all limbs, near the 5.6444 cm of such files; no unit that some limbs refute.
    assert len(arms) == 1
    told = re.search(r"([\d.]+) times", arms.pop())
    assert told is not None and 5 < float(told[1]) < 6.5


def test_every_case_is_tried(cases):
    here = {name for name, *_ in (*READ, *REFUSED)}
    by_hand = {
        "24-bvh-write-non-ascii-name",
        "26-error-as-long-as-the-file",
        "35-plausibility-wrong-advice",
    }
    assert {path.name for path in cases.iterdir() if path.is_dir()} == here | by_hand


def test_a_folder_of_json_without_people_is_told(cases):
    with pytest.raises(SignkinError, match="no person in any frame"):
        read_recording(cases / "37-folder-of-json" / "v", rate_hz=25)
