import numpy as np
import pytest

from signkin import SignkinError, read_annotation, read_recording

JOINTS = {"right_wrist": ["rx", "ry"], "left_wrist": ["lx", "ly"]}
SPEC = {"joints": JOINTS, "unit": "px", "rate_hz": 30, "up": "-y", "right": "-x"}


def table(tmp_path, text):
    path = tmp_path / "t.csv"
    path.write_text(text)
    return path


@pytest.fixture
def two(tmp_path):
    rows = ["take,frame,rx,ry,lx,ly"]
    # Eleven frames, so that text order (1, 10, 2) would be wrong; not in order.
    rows += [f"b,{i},{i},{2 * i},0,0" for i in reversed(range(11))]
    rows += ["a,0,1,1,,", "a,1,1,1,nan,5"]
    return table(tmp_path, "\n".join(rows) + "\n")


def test_one_of_several_recordings_in_order_of_frames(two):
    r = read_recording(two, part="b", recording_column="take", frame_column="frame", **SPEC)
    assert (r.name, r.frames, r.unit) == ("b", 11, "px")
    # Image x to the left of the signer's right, y down: canonical x = -x, z = -y, no depth.
    assert r.track("right_wrist")[3] == pytest.approx([-3, 0, -6])


def test_empty_cells_are_gaps(two):
    r = read_recording(two, part="a", recording_column="take", **SPEC)
    assert np.isnan(r.track("left_wrist")[0]).any()
    assert np.isnan(r.track("left_wrist")[1]).any()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"part": "z"}, r"no row with take = z; expected b, a"),
        ({"part": None}, r"the table holds several recordings \(column take\)"),
        ({"recording_column": "video"}, r"no column 'video'; expected take, frame"),
        ({"joints": {"right_wrist": ["rx", "rz"]}}, r"no column 'rz'"),
        ({"joints": {"right_wrist": "rx"}}, r"right_wrist has the columns 'rx'"),
        ({"joints": None}, r"no joint map"),
        ({"rate_hz": None, "frame_column": "frame"}, r"the rate is missing"),
        ({}, r"line 3: frame 9 follows 10; .*frame_column: frame"),
    ],
)
def test_bad_declarations_are_refused(two, change, told):
    spec = {"part": "b", "recording_column": "take", **SPEC, **change}
    with pytest.raises(SignkinError, match=told):
        read_recording(two, **spec)


def test_text_and_holes_are_refused_with_their_line(tmp_path):
    path = table(tmp_path, "frame,rx,ry,lx,ly\n0,1,1,1,1\n1,x,1,1,1\n")
    with pytest.raises(SignkinError, match=r"t.csv, line 3, column rx: found 'x'"):
        read_recording(path, **SPEC)
    path = table(tmp_path, "frame,rx,ry,lx,ly\n0,1,1,1,1\n2,1,1,1,1\n")
    with pytest.raises(SignkinError, match=r"line 3: frame 2 follows frame 0"):
        read_recording(path, frame_column="frame", **SPEC)
    path = table(tmp_path, "")
    with pytest.raises(SignkinError, match="not readable as CSV"):
        read_recording(path, **SPEC)


def test_a_time_column_tells_the_rate_and_refuses_a_variable_one(tmp_path):
    spec = {k: v for k, v in SPEC.items() if k != "rate_hz"}
    rows = "".join(f"{i / 29.97:.6f},0,0,0,0\n" for i in range(20))
    path = table(tmp_path, "t,rx,ry,lx,ly\n" + rows)
    assert read_recording(path, time_column="t", **spec).rate_hz == pytest.approx(29.97, rel=1e-5)
    path = table(tmp_path, "t,rx,ry,lx,ly\n0,0,0,0,0\n0.1,0,0,0,0\n0.3,0,0,0,0\n")
    with pytest.raises(SignkinError, match="expected a constant frame rate"):
        read_recording(path, time_column="t", **spec)


def test_a_changed_file_is_read_anew(tmp_path):
    path = table(tmp_path, "rx,ry,lx,ly\n0,0,0,0\n0,0,0,0\n")
    assert read_recording(path, **SPEC).frames == 2
    path = table(tmp_path, "rx,ry,lx,ly\n" + "0,0,0,0\n" * 5)
    assert read_recording(path, **SPEC).frames == 5


WORDS = "video,word,from,to\n1,JOHN,8,17\n1,WRITE,18,50\n2,IX,3,4\n"
COLUMNS = {
    "recording_column": "video", "start_column": "from", "end_column": "to",
    "label_column": "word", "time_unit": "frames", "rate_hz": 30,
}  # fmt: skip


def test_words_in_frames_with_inclusive_ends(tmp_path):
    path = table(tmp_path, WORDS)
    a = read_annotation(path, part="1", tiers=("word",), end_inclusive=True, **COLUMNS)
    assert [(i.label, i.tier) for i in a.intervals] == [("JOHN", "word"), ("WRITE", "word")]
    assert a.times_s("word") == pytest.approx(np.array([[8, 18], [18, 51]]) / 30)


def test_words_want_an_end_after_the_start_and_a_known_unit(tmp_path):
    path = table(tmp_path, WORDS.replace("18,50", "18,17"))
    with pytest.raises(SignkinError, match=r"line 3: 'WRITE' runs from 0.600 s to 0.567 s"):
        read_annotation(path, part="1", tiers=("word",), **COLUMNS)
    with pytest.raises(SignkinError, match="the time unit is 'min'; expected s, ms, frames"):
        read_annotation(path, part="1", **{**COLUMNS, "time_unit": "min"})
    with pytest.raises(SignkinError, match="times in frames, no rate"):
        read_annotation(path, part="1", **{**COLUMNS, "rate_hz": None})
