"""What is wrong in a file is refused with its place, or read as declared: never in silence.

By kind of fault, over the formats that can have it. Legal variants of the same look are read.
"""

from __future__ import annotations

import json
import struct

import numpy as np
import pytest

from signkin import SignkinError, read_annotation, read_recording
from signkin.io.bvh import parse_bvh, write_bvh
from support.motion_files import COLUMNS, RATE_HZ, SAMPLES, motion, write_csv

WRISTS = {"right_wrist": ["rx", "ry", "rz"], "left_wrist": ["lx", "ly", "lz"]}
SPEC = {"joints": WRISTS, "unit": "m", "rate_hz": 100}
HEADER = "rx,ry,rz,lx,ly,lz"
ROW = "1,2,3,4,5,6"


def table(tmp_path, *lines, encoding="utf-8", end="\n"):
    path = tmp_path / "t.csv"
    path.write_bytes(end.join([*lines, ""]).encode(encoding))
    return path


def told(path, match, **spec):
    with pytest.raises(SignkinError, match=match) as error:
        read_recording(path, **spec)
    assert "\n" not in str(error.value) and len(str(error.value)) < 1500
    return error.value


def sample(name, folder, change=None, frames=40, **spec):
    """Write a sample, damaged by a change of its text, and return its path and declaration."""
    made = SAMPLES[name]
    path = folder / made.name
    made.write(path, motion(frames))
    if change is not None:
        path.write_bytes(change(path.read_bytes().decode()).encode())
    return path, {"format": made.format, **made.spec, **spec}


# --- rows and columns


@pytest.mark.parametrize(
    ("rows", "match"),
    [
        ((ROW, "1,2,3,4,5", "1,2,3,4,5,6,7"), r"line 3: 5 cells; expected 6"),
        ((ROW, "1,2,3,4,5,6,7", ROW), r"line 3: 7 cells; expected 6"),
        ((ROW, "# paused", ROW), r"line 3: 1 cells"),
        ((ROW, HEADER, ROW), r"line 3, column rx: found 'rx'"),
        ((ROW, "1,2,3,4,5,Infinity"), r"line 3, column lz: found 'Infinity'"),
        ((ROW, "1,2,1e999,4,5,6"), r"line 3, column rz: found '1e999'"),
        ((ROW, "1,2,0x10,4,5,6"), r"line 3, column rz: found '0x10'"),
        ((ROW, "1,2,1_0,4,5,6"), r"line 3, column rz: found '1_0'"),
        ((ROW, "1,2,1e300,4,5,6"), r"joint right_wrist, frame 1: a coordinate of 1e\+300"),
        ((ROW, "", "", '1,2,"x\ny",4,5,6'), r"line 5, column rz: found 'x\\ny'"),
        ((ROW, '1,2,"3,4,5,6', ROW), r"line 3"),
    ],
)
def test_rows_that_are_none_are_named_by_their_line(tmp_path, rows, match):
    told(table(tmp_path, HEADER, *rows), match, **SPEC)


def test_what_is_too_much_and_empty_is_nothing(tmp_path):
    path = table(tmp_path, HEADER + ",", ROW + ",,", "1,2,,4,5,6,,")
    recording = read_recording(path, **SPEC)
    assert recording.track("left_wrist")[0].tolist() == [4, 5, 6]
    assert np.isnan(recording.track("right_wrist")[1]).any()


@pytest.mark.parametrize(
    ("header", "match"),
    [
        ("rx,ry,rz,lx,ly,lz,rx", "column 'rx' stands twice"),
        ("rx,ry,rz,lx,ly,lz, rx ", "column 'rx' stands twice"),
        ("rx,ry,rz,lx,ly,l_z", "no column 'lz'; expected rx, ry"),
    ],
)
def test_columns_that_are_not_there_once(tmp_path, header, match):
    row = ",".join(str(i) for i in range(header.count(",") + 1))
    told(table(tmp_path, header, row, row), match, **SPEC)


def test_a_doubled_column_that_nobody_asks_for_is_no_fault(tmp_path):
    path = table(tmp_path, HEADER + ",x,x", ROW + ",7,8", ROW + ",7,8")
    assert read_recording(path, **SPEC).frames == 2


def test_people_and_takes_in_one_table_are_seen_without_being_declared(tmp_path):
    rows = [f"{f},{p},{ROW}" for f in range(3) for p in "AB"]
    path = table(tmp_path, "frame,person," + HEADER, *rows)
    told(path, r"line 3: 2 values in the column person: A, B.*recording_column: person", **SPEC)
    anna = read_recording(path, recording_column="person", part="A", **SPEC)
    assert (anna.frames, anna.name) == (3, "A")
    path = table(tmp_path, "Frame," + HEADER, f"1,{ROW}", f"2,{ROW}", f"4,{ROW}")
    told(path, r"line 4: Frame 4 follows 2", **SPEC)


# --- one place for two joints


@pytest.mark.parametrize(
    ("name", "joints"),
    [
        ("bvh", {"right_wrist": "right_wrist", "left_wrist": "right_wrist"}),
        ("c3d", {"right_wrist": "right_wrist", "left_wrist": "right_wrist"}),
        ("csv", {"right_wrist": COLUMNS["right_wrist"], "left_wrist": COLUMNS["right_wrist"]}),
        ("csv", {"right_wrist": ["right_wrist_x", "right_wrist_x", "right_wrist_z"]}),
    ],
)
def test_both_wrists_on_one_joint_are_refused(tmp_path, name, joints):
    path, spec = sample(name, tmp_path)
    told(path, r"stands twice, for right_wrist", **{**spec, "joints": joints})


@pytest.mark.parametrize("joints", [["right_wrist"], {"right_wrist": 3.5}, {"right_wrist": None}])
def test_a_joint_map_that_is_none(tmp_path, joints):
    path, spec = sample("bvh", tmp_path)
    told(path, "joints", **{**spec, "joints": joints})


# --- clocks and rates

CLOCK = {"joints": WRISTS, "unit": "m", "time_column": "t"}


def clock(tmp_path, times, form="{:.3f}"):
    return table(tmp_path, "t," + HEADER, *(f"{form.format(t)},{ROW}" for t in times))


@pytest.mark.parametrize(
    ("rate_hz", "form"),
    [(120, "{:.3f}"), (60, "{:.3f}"), (29.97, "{:.3f}"), (240, "{:.3f}"), (60, "{:.2f}"),
     (120, "{:.3f}000")],
)  # fmt: skip
def test_few_printed_digits_are_no_fault(tmp_path, rate_hz, form):
    path = clock(tmp_path, np.arange(200) / rate_hz, form)
    assert read_recording(path, rate_hz=rate_hz, **CLOCK).rate_hz == rate_hz
    assert read_recording(path, **CLOCK).rate_hz == pytest.approx(rate_hz, rel=0.01)


@pytest.mark.parametrize(
    ("times", "match"),
    [
        (np.delete(np.arange(50) / 100, 20), "steps of 0.01 to 0.02 s.*after row 20"),
        (np.concatenate([np.arange(30) / 100, 0.3 + np.arange(30) / 50]), "constant frame rate"),
        (np.arange(50) / 100 + 12, "the clock starts at 12 s; .*clock: first_frame"),
        (np.arange(50) / 100 - 3, "the clock starts at -3 s"),
        (np.arange(50) * 10.0, r"0\.1 Hz is no rate of motion: are these milliseconds, at 100 Hz"),
        (np.arange(50) * 1e7, "is no rate of motion"),
        (np.arange(50)[::-1] / 100, "constant frame rate"),
        (np.zeros(50), "constant frame rate"),
    ],
)
def test_clocks_that_are_none(tmp_path, times, match):
    told(clock(tmp_path, times), match, **CLOCK)


def test_a_clock_without_a_time(tmp_path):
    told(table(tmp_path, "t," + HEADER, f"0,{ROW}", f",{ROW}"), "no time in row 2", **CLOCK)


def test_declared_clocks_are_read(tmp_path):
    path = clock(tmp_path, np.arange(50) / 100 + 12)
    recording = read_recording(path, clock="first_frame", **CLOCK)
    assert recording.rate_hz == pytest.approx(100)
    assert recording.notes == ("the file's clock starts at 12 s; times count from there",)
    for unit, factor in (("ms", 1e3), ("us", 1e6), ("ns", 1e9)):
        path = clock(tmp_path, np.arange(50) / 25 * factor, "{:.0f}")
        assert read_recording(path, time_unit=unit, **CLOCK).rate_hz == pytest.approx(25)
    told(path, "the time unit is 'min'; expected s, ms, us, ns", time_unit="min", **CLOCK)


def test_an_uneven_clock_is_resampled_where_that_is_declared(tmp_path):
    rng = np.random.default_rng(3)
    times = np.cumsum(rng.uniform(0.015, 0.025, 100))
    times -= times[0]
    times = np.delete(times, slice(40, 48))
    x = np.sin(5 * times)
    rows = [f"{t:.6f},{v:.9f},0,0,0,0,{v:.9f}" for t, v in zip(times, x, strict=True)]
    path = table(tmp_path, "t," + HEADER, *rows)
    told(path, "expected a constant frame rate.*resample_hz", **CLOCK)
    recording = read_recording(path, resample_hz=50, **CLOCK)
    assert recording.rate_hz == 50
    assert "resampled to 50 Hz" in recording.notes[0]
    track = recording.track("right_wrist")[:, 0]
    # Between the eight lost samples nothing is known.
    lost = np.isnan(track)
    inside = (recording.times_s > times[39] + 1e-9) & (recording.times_s < times[40] - 1e-9)
    assert (lost == inside).all() and lost.sum() > 5
    assert np.abs(track - np.sin(5 * recording.times_s))[~lost].max() < 2e-3


def test_an_undeclared_clock_that_contradicts_the_rate_is_seen(tmp_path):
    spec = {"joints": WRISTS, "unit": "m"}
    for name, factor, form in (("time", 1, "{:.2f}"), ("Timestamp", 1000, "{:.0f}")):
        times = np.arange(50) / 50 * factor
        path = table(tmp_path, f"{name},{HEADER}", *(f"{form.format(t)},{ROW}" for t in times))
        told(path, r"the file says 50 Hz, the declaration 100 Hz", rate_hz=100, **spec)
        assert read_recording(path, rate_hz=50, **spec).rate_hz == 50
        told(path, r"the rate is missing.*declare it", **spec)
    # Neither a counter nor what is declared to be none.
    path = table(tmp_path, f"time,{HEADER}", *(f"{t},{ROW}" for t in (3, 4, 5, 6)))
    assert read_recording(path, rate_hz=100, **spec).rate_hz == 100
    path = table(tmp_path, f"time,{HEADER}", *(f"{t},{ROW}" for t in (0, 7, 8, 9)))
    told(path, r"steps of 1 to 7 s.*time_column: time.*ignore: \[time\]", rate_hz=100, **spec)
    assert read_recording(path, rate_hz=100, ignore=["time"], **spec).rate_hz == 100


@pytest.mark.parametrize(
    ("column", "cells", "match"),
    [
        ("time", [f"{(i % 15) * 0.02:.2f}" for i in range(30)], "steps of -0.28 to 0.02 s"),
        ("time", [f"{(i // 2) * 0.02:.2f}" for i in range(30)], "steps of 0 to 0.02 s"),
        ("Time [ms]", [str(20 * i) for i in range(30)], "the file says 50 Hz"),
        ("timestamp_ms", [str(20 * i) for i in range(30)], "the file says 50 Hz"),
        ("time", [f"00:00:{i * 0.02:06.3f}" for i in range(30)], "the file says 50 Hz"),
        ("time", [f"14:03:{i * 0.04:06.3f}" for i in range(30)], "the clock starts at 50580 s"),
        ("time (s)", [f"{7 + i * 0.04:.2f}" for i in range(30)], "the clock starts at 7 s"),
        ("Frame No.", [str(i // 2) for i in range(30)], "line 3: Frame No. 0 follows 0"),
        ("name", ["AB"[i % 2] for i in range(30)], "line 3: 2 values in the column name"),
        ("", [str(i if i < 9 else i + 3) for i in range(30)], "line 11: Unnamed: 0 12 follows 8"),
        ("index", [str(i if i < 9 else i + 3) for i in range(30)], "line 11: index 12 follows 8"),
        ("user id", [str(i % 2) for i in range(30)], "line 3: 2 values in the column user id"),
        ("file", ["ab"[i // 15] for i in range(30)], "line 17: 2 values in the column file"),
    ],
)
def test_undeclared_columns_tell_that_rows_are_not_one_recording_at_25_hz(
    tmp_path, column, cells, match
):
    path = table(tmp_path, f"{column},{HEADER}", *(f"{c},{ROW}" for c in cells))
    spec = {"joints": WRISTS, "unit": "m", "rate_hz": 25}
    told(path, match, **spec)
    assert read_recording(path, ignore=[column or "Unnamed: 0"], **spec).frames == 30


def test_names_that_number_the_rows_are_no_people(tmp_path):
    spec = {"joints": WRISTS, "unit": "m", "rate_hz": 25}
    path = table(tmp_path, f"id,file,{HEADER}", *(f"{i},img{i}.png,{ROW}" for i in range(30)))
    assert read_recording(path, **spec).notes == ()
    path = table(tmp_path, f"frame,{HEADER}", *(f"{2 * i},{ROW}" for i in range(30)))
    assert read_recording(path, **spec).notes == (
        "frame rises by 2: each row counts as one frame of the rate",
    )


def test_frames_that_are_numbered_from_later_are_noted(tmp_path):
    path = table(tmp_path, f"frame,{HEADER}", *(f"{i + 100},{ROW}" for i in range(30)))
    for declared in ({}, {"frame_column": "frame"}):
        read = read_recording(path, **SPEC, **declared)
        assert read.notes == ("the first frame is number 100; times count from there",)
    path = table(tmp_path, f",{HEADER}", *(f"{i + 100},{ROW}" for i in range(30)))
    assert read_recording(path, **SPEC).notes == ()


def test_the_confidence_of_a_misspelt_joint_is_told(tmp_path):
    path = table(tmp_path, f"{HEADER},c", *[f"{ROW},0.1"] * 9)
    told(path, "no joint 'right_wirst'", confidence={"right_wirst": "c"}, **SPEC)


def test_numbers_that_mean_not_seen_want_a_declaration(tmp_path):
    rows = [f"{i},2,3,4,5,6" for i in range(30)]
    path = table(tmp_path, HEADER, *rows, "-9999,-9999,-9999,4,5,6")
    told(path, r"line 32, frame 30: right_wrist is at -9999 .*missing: -9999", **SPEC)
    read = read_recording(path, missing=-9999, **SPEC)
    assert np.isnan(read.track("right_wrist")[-1]).all()
    assert read_recording(path, missing=[], **SPEC).track("right_wrist")[-1, 0] == -9999
    path = table(tmp_path, HEADER, *rows, "0,0,0,4,5,6")
    assert "1 points at exactly 0" in read_recording(path, **SPEC).notes[0]


def test_shares_of_an_image_and_pixels_are_told_apart(tmp_path):
    flat = {"right_wrist": ["rx", "ry"], "left_wrist": ["lx", "ly"]}
    spec = {"joints": flat, "unit": "px", "rate_hz": 25}
    shares = table(tmp_path, "rx,ry,lx,ly", *(f"{0.1 + i / 100},.2,.3,.4" for i in range(30)))
    told(shares, r"unit: coordinates of 0\.3.* which are shares of the image", **spec)
    size = {**spec, "image_size": [640, 480]}
    assert read_recording(shares, **size).track("right_wrist")[0, 0] == 64
    pixels = table(tmp_path, "rx,ry,lx,ly", *(f"{100 + i},200,300,400" for i in range(30)))
    told(pixels, "image_size: coordinates of 250 .*no shares of an image", **size)


def test_both_wrists_with_one_track_are_refused(tmp_path):
    path = table(tmp_path, HEADER, *(f"{i},2,3,{i},2,3" for i in range(9)))
    told(path, "right_wrist and left_wrist are at one place in every frame", **SPEC)
    path = table(tmp_path, HEADER, *(["1,2,3,1,2,3"] * 9))  # nothing moves: not for reading to say
    assert read_recording(path, **SPEC).frames == 9


def test_names_are_found_whatever_way_their_accents_are_coded(tmp_path):
    for there, asked in (("h\u00f6he", "ho\u0308he"), ("ho\u0308he", "h\u00f6he")):
        spec = {**SPEC, "joints": {"right_wrist": [asked, "ry", "rz"]}}
        path = table(tmp_path, HEADER.replace("rx", there), ROW, ROW)
        assert read_recording(path, **spec).track("right_wrist")[0].tolist() == [1, 2, 3]
        for name in ("bvh", "trc", "vicon_csv"):
            path, spec = sample(
                name, tmp_path, lambda text, there=there: text.replace("left_wrist", there)
            )
            spec["joints"] = {"left_wrist": asked}
            assert read_recording(path, **spec).joints == ("left_wrist",)


def test_a_line_for_excel_is_no_header(tmp_path):
    path = table(tmp_path, "sep=;", HEADER.replace(",", ";"), "0,1;2;3;4;5;6", "0,1;2;x;4;5;6")
    told(path, "line 4, column rz: found 'x'", **SPEC)
    path.write_text(path.read_text().replace("x;4", "3;4"))
    assert read_recording(path, **SPEC).track("right_wrist")[0].tolist() == [0.1, 2, 3]


@pytest.mark.parametrize("name", ["bvh", "csv", "trc", "c3d", "qualisys_tsv", "vicon_csv", "pose",
                                  "motive_csv", "mediapipe_csv"])  # fmt: skip
def test_a_rate_that_contradicts_the_file_is_refused_or_overruled(tmp_path, name):
    path, spec = sample(name, tmp_path)
    told(path, r"the file says 50 Hz, the declaration 60.*instead_of_file", rate_hz=60, **spec)
    overruled = read_recording(path, rate_hz={"use": 60, "instead_of_file": True}, **spec)
    assert overruled.rate_hz == 60
    assert overruled.notes == ("the file says 50 Hz; overruled by the declared 60 Hz",)
    agreed = read_recording(path, rate_hz={"use": 50, "instead_of_file": True}, **spec)
    assert (agreed.rate_hz, agreed.notes) == (50, ())


@pytest.mark.parametrize("rate", ["60", 0, -3, float("nan"), True, {"use": "x"}, {"instead": 1}])
def test_a_rate_that_is_none(tmp_path, rate):
    path, spec = sample("bvh", tmp_path)
    told(path, "rate_hz", rate_hz=rate, **spec)


@pytest.mark.parametrize("name", ["trc", "qualisys_tsv", "motive_csv"])
def test_a_header_that_contradicts_its_own_times(tmp_path, name):
    old, new = {"trc": ("\n50.00", "\n60.00"), "qualisys_tsv": ("FREQUENCY\t50", "FREQUENCY\t60"),
                "motive_csv": ("Export Frame Rate,50", "Export Frame Rate,60")}[name]  # fmt: skip
    path, spec = sample(name, tmp_path, lambda text: text.replace(old, new))
    told(path, "the header says 60 Hz, the times 50 Hz", **spec)
    assert read_recording(path, times="ignore", **spec).rate_hz == 60


@pytest.mark.parametrize("name", ["trc", "qualisys_tsv", "vicon_csv", "motive_csv",
                                  "deeplabcut_csv"])  # fmt: skip
def test_a_lost_frame_is_seen(tmp_path, name):
    def lose(text):
        lines = text.split("\n")
        del lines[-12]
        return "\n".join(lines)

    path, spec = sample(name, tmp_path, lose)
    told(path, r"line \d+: frame '?3\d'? follows (frame )?'?\d+", **spec)


# --- how tables are written


@pytest.mark.parametrize(
    ("separator", "decimal"), [(";", ","), ("\t", ","), (";", "."), ("\t", ".")]
)
def test_other_separators_and_decimal_commas_are_read(tmp_path, separator, decimal):
    path = tmp_path / "m.csv"
    write_csv(path, motion(), separator, decimal)
    spec = {"unit": "m", "time_column": "time", "joints": COLUMNS}
    for declared in ({}, {"separator": separator, "decimal": decimal}):
        recording = read_recording(path, **spec, **declared)
        assert recording.rate_hz == pytest.approx(RATE_HZ)
        assert np.abs(recording.positions - motion()).max() < 1e-6


@pytest.mark.parametrize(
    ("name", "separator"),
    [("vicon_csv", ";"), ("motive_csv", ";"), ("qualisys_tsv", "\t"), ("trc", "\t"),
     ("mediapipe_csv", ";"), ("deeplabcut_csv", ";"), ("openpose_csv", ";")],
)  # fmt: skip
def test_makers_exports_in_other_languages(tmp_path, name, separator):
    path, spec = sample(name, tmp_path)
    plain = read_recording(path, **spec)
    text = path.read_text().replace(",", separator).replace(".", ",")
    path.write_text(text)
    if name in ("mediapipe_csv", "deeplabcut_csv", "openpose_csv"):
        spec |= {"separator": "semicolon"}
    recording = read_recording(path, **spec)
    assert recording.rate_hz == plain.rate_hz
    assert np.array_equal(recording.positions, plain.positions)
    declared = read_recording(path, decimal=",", **spec)
    assert np.array_equal(declared.positions, plain.positions)


@pytest.mark.parametrize(
    ("rows", "match"),
    [
        (("1.234,5;2;3;4;5;6",) * 2, r"line 2, column rx: found '1.234,5'"),
        (("1,5;2;3;4;5;6", "1.5;2;3;4;5;6"), r"line 2, column rx: found '1,5'"),
        (("1,234,567;2;3;4;5;6",) * 2, r"line 2, column rx: found '1,234,567'"),
    ],
)
def test_thousands_are_no_decimals(tmp_path, rows, match):
    told(table(tmp_path, HEADER.replace(",", ";"), *rows), match, **SPEC)


def test_one_column_only_says_what_to_declare(tmp_path):
    path = table(tmp_path, HEADER.replace(",", "|"), ROW.replace(",", "|"))
    told(path, r"no column 'rx'.*options: \{separator", **SPEC)
    path = table(tmp_path, HEADER.replace(",", "|"), *[ROW.replace(",", "|")] * 2)
    assert read_recording(path, separator="|", **SPEC).frames == 2
    path = table(tmp_path, HEADER.replace(",", "  "), *[ROW.replace(",", "   ")] * 2)
    assert read_recording(path, separator="space", **SPEC).frames == 2


def test_encodings(tmp_path):
    names = {"right_wrist": ["höhe", "ry", "rz"]}
    header = HEADER.replace("rx", "höhe")
    spec = {"joints": names, "unit": "m", "rate_hz": 100}
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "utf-32"):
        path = table(tmp_path, header, ROW, ROW, encoding=encoding)
        assert read_recording(path, **spec).frames == 2
    path = table(tmp_path, header, ROW, ROW, encoding="latin-1")
    told(path, r"line 1: byte 0xf6 is not UTF-8.*encoding: latin-1", **spec)
    assert read_recording(path, encoding="latin-1", **spec).frames == 2
    path = table(tmp_path, header, ROW, ROW, encoding="utf-16-le")
    told(path, r"line 1: .*(zero bytes|not UTF-8)", **spec)
    assert read_recording(path, encoding="utf-16-le", **spec).frames == 2
    told(path, "the encoding is 'utf-99'", encoding="utf-99", **spec)


@pytest.mark.parametrize("end", ["\r\n", "\r"])
def test_line_ends_of_other_systems(tmp_path, end):
    path = table(tmp_path, HEADER, ROW, "1,2,x,4,5,6", end=end)
    told(path, r"line 3, column rz: found 'x'", **SPEC)


def test_headers_of_several_rows_or_none(tmp_path):
    path = table(tmp_path, "made by x", "wrist,,,other,,", "x,y,z,x,y,z", ROW, ROW)
    joints = {"right_wrist": ["wrist x", "wrist y", "wrist z"]}
    spec = {"joints": joints, "unit": "m", "rate_hz": 100, "skip_rows": 1, "header_rows": 2}
    assert read_recording(path, **spec).track("right_wrist")[0].tolist() == [1, 2, 3]
    path = table(tmp_path, ROW, ROW)
    spec = {"joints": {"right_wrist": [4, 5, 6]}, "unit": "m", "rate_hz": 100, "header_rows": 0}
    assert read_recording(path, **spec).track("right_wrist")[0].tolist() == [4, 5, 6]


def test_missing_values_and_confidence(tmp_path):
    rows = ["0,0,0,0.9,5,6", "1,2,3,0.4,5,6", "1,2,-99,0.9,5,6", "1,2,3,0.9,5,6"]
    path = table(tmp_path, "rx,ry,rz,c,a,b", *rows)
    spec = {"joints": {"right_wrist": ["rx", "ry", "rz"]}, "unit": "m", "rate_hz": 100}

    def gaps(**options):
        track = read_recording(path, **spec, **options).track("right_wrist")
        return np.flatnonzero(np.isnan(track).any(axis=1)).tolist()

    assert gaps() == []
    assert gaps(missing=0) == [0]
    assert gaps(missing="-99") == [2]
    assert gaps(missing=[0, "-99"]) == [0, 2]
    assert gaps(confidence={"right_wrist": "c"}, confidence_threshold=0.5) == [1]
    told(path, "missing is", missing={"a": 1}, **spec)
    told(
        path, "the threshold is", confidence={"right_wrist": "c"}, confidence_threshold="x", **spec
    )


def test_a_unit_an_axis_and_any_factor(tmp_path):
    path = table(tmp_path, HEADER, ROW, ROW)
    spec = {"joints": WRISTS, "rate_hz": 100}
    for unit, factor in (("inch", 0.0254), ("ft", 0.3048), (0.0564, 0.0564)):
        recording = read_recording(path, unit=unit, **spec)
        assert recording.track("right_wrist")[0] == pytest.approx(np.array([1, 2, 3]) * factor)
    recording = read_recording(path, unit=["mm", "cm", "m"], up="y", right="-x", **spec)
    assert recording.track("right_wrist")[0] == pytest.approx([-0.001, 3, 0.02])
    for unit in ("ell", 0, -1, True, ["m", "px", "m"], ["m", "m"], None, {"x": "m"}):
        told(path, "unit", unit=unit, **spec)


def test_velocities_are_integrated_on_request_only(tmp_path):
    t = np.arange(200) / 100
    rows = [f"{v:.2f},{np.cos(v):.9f},0,0,0,0,1" for v in t]
    path = table(tmp_path, "t," + HEADER, *rows)
    recording = read_recording(path, velocities="integrate", **CLOCK)
    assert np.abs(recording.track("right_wrist")[:, 0] - np.sin(t)).max() < 2e-5
    assert recording.track("left_wrist")[:, 2] == pytest.approx(t)
    assert recording.notes == ("positions are velocities, integrated: they drift",)
    assert read_recording(path, **CLOCK).track("right_wrist")[0, 0] == 1
    told(path, "velocities is 'yes'", velocities="yes", **CLOCK)


# --- BVH


def test_legal_variants_of_bvh_are_one_motion(tmp_path):
    path, spec = sample("bvh", tmp_path)
    plain = read_recording(path, **spec)
    text = path.read_text()
    variants = (
        text.replace("\n{", " {").replace("{\n", "{ "),
        text.upper().replace("RIGHT_WRIST", "right_wrist").replace("LEFT_WRIST", "left_wrist")
        .replace("RIGHT_ELBOW", "right_elbow"),
        "\ufeff" + text,
        text.replace("\n", "\r\n"),
        text.replace("  ", "\t").replace(" 0 0 0\n", "   0\t0  0 \n"),
        text.replace("position", "Position").replace("rotation", "Rotation"),
        text.replace("Frames: 40", "Frames:\t40").replace("Frame Time: ", "Frame Time:"),
        text.replace("Frames: 40", "Frames: 39"),
    )  # fmt: skip
    for variant in variants:
        assert variant != text
        path.write_text(variant, newline="")
        recording = read_recording(path, **spec)
        assert recording.joints == plain.joints and recording.frames == 40
        assert np.array_equal(recording.positions, plain.positions)


def test_joints_of_one_and_two_angles(tmp_path):
    path = tmp_path / "a.bvh"
    path.write_text(
        "HIERARCHY\nROOT a { OFFSET 0 0 0 CHANNELS 1 Zrotation\n"
        "JOINT b { OFFSET 1 0 0 CHANNELS 2 Xrotation Zrotation End Site { OFFSET 1 0 0 } } }\n"
        "MOTION\nFrames: 2\nFrame Time: 0.02\n90 0 0\n0 90 90\n"
    )
    recording = read_recording(path, unit="m")
    assert recording.track("b")[0] == pytest.approx([0, 1, 0])
    assert recording.track("b_end")[0] == pytest.approx([0, 2, 0])
    # x by 90, then z by 90 in the turned axes: x of the end goes to z of the world.
    assert recording.track("b_end")[1] == pytest.approx([1, 0, 1])


@pytest.mark.parametrize(
    ("old", "new", "match"),
    [
        ("ROOT right_elbow", "ROOT right_wrist", "no joint right_elbow in the file"),
        ("Frames: 40", "Frames: 1000000000", "40 frames, where the header says 1000000000"),
        ("Frames: 40", "Frames: 3.7", "'3.7' frames; expected a whole number"),
        ("Frames: 40", "Frames: inf", "'inf' frames"),
        ("Time: 0.02", "Time: 20.0", "0.05 Hz is no rate of motion: are these milliseconds, at 50"),
        ("Time: 0.02", "Time: 50.", "0.02 Hz is no rate of motion"),
        ("Time: 0.02", "Time: nan", "found 'nan0000'"),
        ("  OFFSET 0 0 0\n", "", "no OFFSET of right_wrist"),
        ("OFFSET 0 0 0", "OFFSET 0 0", "2 numbers; expected 3"),
        ("OFFSET 0 0 0", "OFFSET 0 inf 0", "found 'inf'"),
        ("Xposition Yposition", "Xposition Xposition", "each at most once"),
        ("Xposition", "Wposition", "the channel 'Wposition'"),
        ("CHANNELS 6", "CHANNELS 999999999999", "a count and as many channels"),
        ("ROOT right_wrist", "ROOT", "ROOT without a name"),
        ("End Site", "End", "expected End Site"),
    ],
)
def test_bvh_that_is_wrong(tmp_path, old, new, match):
    path, spec = sample("bvh", tmp_path, lambda text: text.replace(old, new, 1))
    error = told(path, match, **spec)
    assert error.place is not None


def test_a_root_of_several_is_the_part(tmp_path):
    def rename(text):
        return text.replace("ROOT left_wrist", "ROOT right_wrist")

    path, spec = sample("bvh", tmp_path, rename, joints={"right_wrist": "right_wrist"})
    second = read_recording(path, part="2", **spec)
    assert np.abs(second.positions[:, 0] - motion()[:, 1]).max() < 1e-6
    told(path, "the part is '9'; expected 1 to 3", part="9", **spec)
    told(path, "joint right_wrist stands twice in the file", **spec)


def test_a_name_that_cannot_be_written_is_refused_before_the_file(tmp_path):
    path, _ = sample("bvh", tmp_path)
    hierarchy, values, rate_hz = parse_bvh(path)
    spoilt = type(hierarchy)(
        ("a{b", *hierarchy.joints[1:]), hierarchy.parents, hierarchy.offsets, hierarchy.channels
    )
    with pytest.raises(SignkinError, match=r"the joint 'a\{b'"):
        write_bvh(tmp_path / "out.bvh", spoilt, values, rate_hz)
    assert not (tmp_path / "out.bvh").exists()


# --- markers and key points


def test_subjects_of_a_marker_file(tmp_path):
    def second(text):
        return text.replace("Anna:left_wrist", "Ben:right_wrist")

    path, spec = sample("vicon_csv", tmp_path, second)
    spec = {**spec, "joints": {"right_wrist": "right_wrist"}}
    told(path, "'right_wrist' may be Anna:right_wrist, Ben:right_wrist", **spec)
    ben = read_recording(path, part="Ben", **spec)
    assert np.abs(ben.positions[:, 0] - motion()[:, 1]).max() < 1e-6
    full = read_recording(path, **{**spec, "joints": {"right_wrist": "Ben:right_wrist"}})
    assert np.array_equal(full.positions, ben.positions)


@pytest.mark.parametrize("name", ["trc", "qualisys_tsv", "motive_csv"])
def test_a_table_that_ends_early(tmp_path, name):
    path, spec = sample(name, tmp_path, lambda text: "\n".join(text.split("\n")[:-6]) + "\n")
    told(path, r"35 frames, where the header says 40.*incomplete: true", **spec)
    recording = read_recording(path, incomplete=True, **spec)
    assert recording.frames == 35
    assert recording.notes == ("the header promises 40 frames, 35 are there and read",)


def test_occluded_markers_are_gaps(tmp_path):
    c3d = pytest.importorskip("c3d", reason="the optional library c3d is not there")
    x = np.concatenate([motion(10) * 1000, np.zeros((10, 3, 2))], axis=2).astype(np.float32)
    x[3, 0, 3] = -1  # no residual, and a place that is none
    x[4, 0, :3] = 0  # the other way of saying it
    writer = c3d.Writer(point_rate=50, point_units="mm ", point_scale=-1.0)
    writer.add_frames([(frame, np.zeros((0, 0))) for frame in x])
    writer.set_point_labels(["a", "b", "c"])
    path = tmp_path / "o.c3d"
    with path.open("wb") as file:
        writer.write(file)
    recording = read_recording(path, joints={"right_wrist": "a", "left_wrist": "b"})
    assert np.flatnonzero(np.isnan(recording.track("right_wrist")[:, 0])).tolist() == [3, 4]
    assert not np.isnan(recording.track("left_wrist")).any()
    whole = path.read_bytes()
    path.write_bytes(whole[:-132])
    told(path, r"7 frames, where the header says 10.*incomplete: true", joints={"right_wrist": "a"})
    # A header that promises 10^9 frames is held to the size of the file.
    path.write_bytes(whole.replace(struct.pack("<H", 10), struct.pack("<H", 60000)))
    told(path, r"where the header says|not readable as a C3D file", joints={"right_wrist": "a"})


@pytest.mark.parametrize(
    ("unit", "metres"), [("mm", 0.001), ("cm", 0.01), ("m", 1), ("meters", 1), ("in", 0.0254)]
)
def test_the_unit_of_a_c3d_file_is_read(tmp_path, unit, metres):
    c3d = pytest.importorskip("c3d", reason="the optional library c3d is not there")
    x = np.ones((3, 1, 5), dtype=np.float32)
    writer = c3d.Writer(point_rate=50, point_units=unit, point_scale=-1.0)
    writer.add_frames([(frame, np.zeros((0, 0))) for frame in x])
    writer.set_point_labels(["a"])
    path = tmp_path / "u.c3d"
    with path.open("wb") as file:
        writer.write(file)
    recording = read_recording(path, joints={"right_wrist": "a"})
    assert recording.track("right_wrist")[0] == pytest.approx([metres] * 3)
    told(path, "the declared unit is ft", joints={"right_wrist": "a"}, unit="ft")


def test_people_of_a_folder_of_json(tmp_path):
    path, spec = sample("openpose_json", tmp_path)
    files = sorted(path.iterdir())
    second = json.loads(files[5].read_text())
    second["people"].append(json.loads(files[6].read_text())["people"][0])
    files[5].write_text(json.dumps(second))
    told(path, r"2 people in the file; expected the one to read, 1 to 2, as `part`", **spec)
    assert read_recording(path, part="1", **spec).frames == 40
    other = read_recording(path, part="2", **spec)
    assert np.flatnonzero(~np.isnan(other.positions).any(axis=(1, 2))).tolist() == [5]
    files[7].unlink()
    told(path, r"no file of frame 7; expected every frame from 0 to 39", part="1", **spec)
    files[8].write_text('{"people": [{"pose_keypoints_2d": [1, 2, "x"]}]}')
    files[7].write_text('{"people": []}')
    told(path, r"v_000000000008_keypoints.json: not readable.*'x'", part="1", **spec)


@pytest.mark.parametrize("name", ["openpose_csv", "openpose_json"])
def test_shares_of_an_image_want_its_size(tmp_path, name, monkeypatch):
    from support import motion_files

    monkeypatch.setattr(motion_files, "pixels", lambda x, kept=motion_files.pixels: kept(x) / 1000)
    path, spec = sample(name, tmp_path)
    told(path, r"shares of the image.*image_size", **spec)
    recording = read_recording(path, image_size=[1000, 1000], **spec)
    assert recording.unit == "px"
    assert recording.track("right_wrist")[0, 0] == pytest.approx(640 + 500 * 0.35, abs=1e-3)
    told(path, "the image size is", image_size=[1000], **spec)


def test_landmarks_below_the_threshold_are_gaps(tmp_path):
    def doubt(text):
        lines = text.split("\n")
        lines[8] = lines[8].replace("0.95", "0.5").replace("0.99", "0.3")
        return "\n".join(lines)

    for name, row in (("deeplabcut_csv", 5), ("mediapipe_csv", 7)):
        path, spec = sample(name, tmp_path, doubt)
        recording = read_recording(path, **spec)
        assert np.flatnonzero(np.isnan(recording.positions).all(axis=(1, 2))).tolist() == [row]
        assert "gaps" in recording.notes[0] and "3 points less" in recording.notes[0]
        loose = read_recording(path, confidence_threshold=0.1, **spec)
        assert not np.isnan(loose.positions).any()


def test_individuals_of_deeplabcut(tmp_path):
    def people(text):
        lines = text.split("\n")
        lines.insert(1, ",".join(["individuals"] + ["A"] * 3 + ["B"] * 6))
        lines[2] = ",".join(["bodyparts"] + ["hand"] * 3 + ["hand"] * 3 + ["nose"] * 3)
        return "\n".join(lines)

    path, spec = sample("deeplabcut_csv", tmp_path, people, joints={"right_wrist": "hand"})
    told(path, "2 individuals; expected one of A, B", **spec)
    told(path, "no individual 'C'", part="C", **spec)
    a, b = (read_recording(path, part=p, **spec).track("right_wrist")[0] for p in "AB")
    assert a[0] - b[0] == pytest.approx(500 * 0.6, abs=1)


# --- what no file may do


def test_options_that_are_none_are_told(tmp_path):
    path, spec = sample("bvh", tmp_path)
    told(path, "no option rate of the format bvh; expected encoding, clock", rate=3, **spec)
    told(path, "the clock is 'late'; expected first_frame", clock="late", **spec)
    tags = table(tmp_path, "start,end,label", "0,1,A")
    with pytest.raises(SignkinError, match=r"no option .*starts.*expected rate_hz"):
        read_annotation(tags, starts="x")


def test_an_array_that_promises_more_than_it_holds(tmp_path):
    path, spec = sample("npy", tmp_path)
    content = path.read_bytes()
    path.write_bytes(content.replace(b"(40, 3, 2)", b"(10**9,3,2"[:10]))
    told(path, "not readable as an array of numpy", **spec)
    path.write_bytes(content.replace(b"(40, 3, 2), ", b"(4000000, 3, 2), ", 1)[: len(content)])
    told(path, "not readable as an array of numpy", **spec)
    np.save(path, np.array([{"a": 1}], dtype=object))
    told(path, "not of numbers", **spec)
    told(path, "not of numbers", **spec)


@pytest.mark.parametrize("name", SAMPLES)
def test_a_file_of_something_else_is_one_sentence(tmp_path, name):
    made = SAMPLES[name]
    path = tmp_path / made.name
    contents = (
        b"", b"\0" * 100_000, b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 40, b"x" * 99_999,
        b"PK\x03\x04" + b"\0" * 60, "a,b\n1,2\n".encode("utf-16"),
    )  # fmt: skip
    made.write(tmp_path / "whole", motion())  # skips where its library is not there
    for content in contents:
        path.write_bytes(content)
        told(path, str(path), format=made.format, **made.spec)
    path.unlink()
    told(path, "there is no such file", format=made.format, **made.spec)
    path.mkdir()
    told(path, "folder", format=made.format, **made.spec)


def test_one_marker_under_two_names_is_one_joint(tmp_path):
    path, spec = sample("c3d", tmp_path)
    joints = {"right_wrist": "Anna:right_wrist", "left_wrist": "right_wrist"}
    told(path, "'Anna:right_wrist' stands twice, for right_wrist and left_wrist",
         **{**spec, "joints": joints})  # fmt: skip


@pytest.mark.parametrize(
    "spec",
    [{"up": 5}, {"right": None}, {"format": ["bvh"]}, {"joints": {"right_wrist": ["a"]}},
     {"unit": object()}, {"encoding": 5}, {"part": 3.5}, {"rate_hz": [50]}, {"clock": 5}],
)  # fmt: skip
def test_declarations_of_another_kind_are_told_too(tmp_path, spec):
    path, good = sample("bvh", tmp_path)
    good["part"] = "1"
    told(path, str(path), **{**good, **spec})


def test_a_bvh_of_very_many_joints_is_refused_at_once(tmp_path):
    path = tmp_path / "m.bvh"
    joints = "".join(f"JOINT j{i} {{ OFFSET 0 0 0\n" for i in range(100_000))
    path.write_text("HIERARCHY\nROOT r { OFFSET 0 0 0 CHANNELS 0\n" + joints + "}" * 100_001)
    told(path, "more than 5000 joints", unit="m")
