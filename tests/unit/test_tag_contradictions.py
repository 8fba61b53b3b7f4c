"""Tags that contradict themselves or leave a choice open: refused with the line, or declared."""

from __future__ import annotations

import pytest

from signkin import Interval, SignkinError, read_annotation
from signkin.io.eaf_write import new_eaf

HEAD = "start,end,label\n"
EXPORT = "G\t\t00:00:01.500\t1.5\t1500\t00:00:02.000\t2.0\t2000\tA\n"
CUES = "WEBVTT\n{}\n00:01.000 --> 00:02.000\nA\n"


def grid(*intervals, low=0, high=3):
    rows = "".join(f'{a}\n{b}\n"{text}"\n' for a, b, text in intervals)
    return (
        f'"ooTextFile"\n"TextGrid"\n{low}\n{high}\n<exists>\n1\n"IntervalTier"\n"g"\n{low}\n{high}\n'
        f"{len(intervals)}\n{rows}"
    )


def eaf(value):
    made = new_eaf(author="a", date="2020-01-01T00:00:00Z", media_url="v.mp4",
                   tiers=[("G", None, [Interval(0, 1, "LABEL", "")])]).decode()  # fmt: skip
    return made.replace("\n", "").replace("?>", "?>\n", 1).replace("LABEL", value)


def spans(path, format, **spec):
    found = read_annotation(path, format=format, **spec)
    return [(round(i.start_s, 6), round(i.end_s, 6), i.label) for i in found.intervals]


@pytest.mark.parametrize(
    ("format", "text", "match", "choice", "read"),
    [
        ("csv", HEAD + "100,400,A\n500,900,B\n", "columns start, end: whole numbers",
         {"time_unit": "ms"}, [(0.1, 0.4, "A"), (0.5, 0.9, "B")]),
        ("csv", HEAD + "100,400,A\n500,900,B\n", "columns start, end: whole numbers",
         {"time_unit": "s"}, [(100, 400, "A"), (500, 900, "B")]),
        ("csv", "start_ms,end_ms,label\n100,400,A\n", "'start_ms' is named as ms",
         {"time_unit": "ms"}, [(0.1, 0.4, "A")]),
        ("csv", "Start frame,End frame,label\n10,15,A\n", "'Start frame' is named as frames",
         {"time_unit": "frames", "frame_rate_hz": 25}, [(0.4, 0.6, "A")]),
        ("csv", "participant," + HEAD + "S,0,1,A\nT,0.5,2,B\n", "line 3: 2 values in",
         {"participant_column": "participant", "tiers": "S"}, [(0, 1, "A")]),
        ("csv", "Hand," + HEAD + "R,0,1,A\nL,0.5,2,B\n", "line 3: 2 values in",
         {"tier_column": "Hand", "tiers": "L"}, [(0.5, 2, "B")]),
        ("csv", "file," + HEAD + "a,0,1,A\na,1,2,B\nb,0,1,C\n", "line 4: 2 values in",
         {"recording_column": "file", "part": "b"}, [(0, 1, "C")]),
        ("csv", "id," + HEAD + "7,0,1,A\n8,1,2,B\n8,2,3,C\n", "line 4: id '8' stands twice",
         {"ignore": ["id"]}, [(0, 1, "A"), (1, 2, "B"), (2, 3, "C")]),
        ("elan_tab", '"#file:///a.mp4 -- offset: 1200"\n' + EXPORT, "line 1: a medium with an offs",
         {"media_offset": "added"}, [(1.5, 2, "A")]),
        ("elan_tab", '"#file:///a.mp4 -- offset: 1200"\n' + EXPORT, "line 1: a medium with an offs",
         {"media_offset": "not_added"}, [(2.7, 3.2, "A")]),
        ("vtt", CUES.format("X-TIMESTAMP-MAP=LOCAL:00:00:00.000,MPEGTS:900000\n"), "line 2: ",
         {"timestamp_map": "ignore"}, [(1, 2, "A")]),
        ("frame_labels", "frame,right\n0,A\n1,A\n", "line 1: the column 'frame' is not declared",
         {"frame_column": "frame"}, [(0, 0.08, "A")]),
        ("frame_labels", "Time (s),right\n0,A\n0.04,A\n", "line 1: the column 'Time \\(s\\)' ",
         {"ignore": ["Time (s)"]}, [(0, 0.08, "A")]),
    ],
)  # fmt: skip
def test_what_is_open_is_refused_and_read_as_declared(tmp_path, format, text, match, choice, read):
    path = tmp_path / "x"
    path.write_text(text)
    always = {"frame_rate_hz": 25} if format == "frame_labels" else {}
    names = text.partition("\n")[0].split(",")
    if format == "csv" and "start" not in names:
        always |= {"start_column": names[0], "end_column": names[1]}
    with pytest.raises(SignkinError, match=match) as error:
        read_annotation(path, format=format, **always)
    assert "\n" not in str(error.value)
    assert spans(path, format, **{**always, **choice}) == read


@pytest.mark.parametrize(
    ("format", "text", "match"),
    [
        ("textgrid", grid((0, 2, "A"), (1, 3, "B")), "line 15: an interval from 1 to 3 s"),
        ("textgrid", grid((0, 1, "A"), (1, 30, "B")), "line 15: .* the tier at 3 s"),
        ("textgrid", grid((0, 1, "A"), low=0.5), "line 12: an interval from 0 to 1 s"),
        ("eaf", eaf("A</ANNOTATION_VALUE><ANNOTATION_VALUE>B"), "line 2: an annotation with 2 val"),
        ("eaf", eaf("A<b>not</b>B"), "line 2: an annotation with 1 values, or elements inside"),
        ("frame_labels", "0\tA\n1\tA\n", "line 1: found '0\\\\tA'"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path, format, text, match):
    path = tmp_path / "x"
    path.write_text(text)
    spec = {"header": False, "frame_rate_hz": 25} if format == "frame_labels" else {}
    with pytest.raises(SignkinError, match=match):
        read_annotation(path, format=format, **spec)


@pytest.mark.parametrize(
    ("format", "text"),
    [
        ("csv", HEAD + "0,1,A\n0,1,A\n1,2,B\n"),
        ("elan_tab", EXPORT + EXPORT + EXPORT.replace("A\n", "B\n")),
    ],
)
def test_a_row_twice_counts_once_and_is_listed(tmp_path, format, text):
    path = tmp_path / "x"
    path.write_text(text)
    found = read_annotation(path, format=format)
    assert sorted(i.label for i in found.intervals) == ["A", "B"]
    assert [out.reason[:11] for out in found.left_out] == ["the same as"]


@pytest.mark.parametrize(
    ("format", "text", "read"),
    [
        ("csv", "sep=;\nstart;end;label\n0,1;0,4;A\n", [(0.1, 0.4, "A")]),
        ("csv", HEAD + "0.1,0.4,A,\n0.5,0.9,B,,\n", [(0.1, 0.4, "A"), (0.5, 0.9, "B")]),
        ("csv", "id,name," + HEAD + "1,x,0,1,A\n2,y,1,2,B\n", [(0, 1, "A"), (1, 2, "B")]),
        ("csv", HEAD + "0,3,A\n3,6,B\n", [(0, 3, "A"), (3, 6, "B")]),
        ("csv", "Begin Time - ss.msec;end;label\n1;2;A\n", [(1, 2, "A")]),
        ("textgrid", grid((0, 1, "A"), (2, 3.001, "B")), [(0, 1, "A"), (2, 3.001, "B")]),
        ("elan_tab", '"#file:///a.mp4 -- offset: 0"\n' + EXPORT, [(1.5, 2, "A")]),
    ],
)
def test_what_is_unusual_is_read(tmp_path, format, text, read):
    path = tmp_path / "x"
    path.write_text(text)
    named = {"start_column": "Begin Time - ss.msec", "separator": "semicolon"}
    assert spans(path, format, **(named if "ss.msec" in text else {})) == read
