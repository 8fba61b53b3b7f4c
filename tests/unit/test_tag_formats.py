"""Formats of tags besides ELAN: read as their makers mean them, refused with the line."""

import pytest

from signkin import SignkinError, read_annotation
from signkin.io.text_rows import TimeFormat, decoded


def put(tmp_path, name, text, encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def spans(annotation, tier=None):
    return [(i.label, i.start_s, i.end_s) for i in annotation.intervals if tier in (None, i.tier)]


# --- TextGrid ------------------------------------------------------------

LONG = """File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0
xmax = 2.5
tiers? <exists>
size = 3
item []:
    item [1]:
        class = "IntervalTier"
        name = "Gloß"
        xmin = 0
        xmax = 2.5
        intervals: size = 3
        intervals [1]:
            xmin = 0
            xmax = 1
            text = ""
        intervals [2]:
            xmin = 1
            xmax = 1.5
            text = "SAY ""HI""
twice 3 times"
        intervals [3]:
            xmin = 1.5
            xmax = 2.5
            text = "B"
    item [2]:
        class = "TextTier"
        name = "points"
        xmin = 0
        xmax = 2.5
        points: size = 1
        points [1]:
            number = 1.2
            mark = "p"
    item [3]:
        class = "IntervalTier"
        name = "none"
        xmin = 0
        xmax = 2.5
        intervals: size = 1
        intervals [1]:
            xmin = 0
            xmax = 2.5
            text = ""
"""
SHORT = """File type = "ooTextFile short"
"TextGrid"

0
2.5
<exists>
3 ! tiers
"IntervalTier"
"Gloß"
0
2.5
3
0 1 ""
1 1.5 "SAY ""HI""
twice 3 times"
1.5
2.5
"B"
"TextTier" "points" 0 2.5 1 1.2 "p"
"IntervalTier" "none" 0 2.5 1 0 2.5 ""
"""


@pytest.mark.parametrize("text", [LONG, SHORT])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_textgrids_of_both_forms_and_all_encodings(tmp_path, text, encoding, end):
    path = put(tmp_path, "x.TextGrid", text.replace("\n", end), encoding)
    a = read_annotation(path, tiers=("Gloß", "none"))
    assert spans(a) == [('SAY "HI"\ntwice 3 times', 1, 1.5), ("B", 1.5, 2.5)]
    assert a.empty_tiers == ("none",)
    assert [o.tier for o in read_annotation(path).left_out] == ["points"]


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("size = 3\nitem", "size = 1000000000\nitem", r"line 7: the number of tiers is 1000000000"),
        ("size = 3\nitem", "size = 2\nitem", r"line 38: found 'IntervalTier' behind the last tier"),
        ('text = "B"', 'text = "B', r"line \d+: (a text in quotes|found)"),
        ("xmin = 1.5", "xmin = one", r"expected a time \(number\)"),
        ('"TextGrid"', '"PitchTier"', r"line 1: the file type is 'ooTextFile', the class"),
        ("xmax = 1.5", "xmax = 0.5", r"line 20: 'SAY.*runs from 1.000 s to 0.500 s"),
        ("<exists>", "<absent>", r"line 6: no tiers"),
    ],
)
def test_what_is_wrong_in_a_textgrid_is_told_with_its_line(tmp_path, old, new, told):
    path = put(tmp_path, "x.TextGrid", LONG.replace(old, new, 1))
    with pytest.raises(SignkinError, match=rf"x.TextGrid, .*{told}"):
        read_annotation(path)


def test_point_tiers_doubled_names_and_binary_files(tmp_path):
    path = put(tmp_path, "x.TextGrid", LONG.replace('"none"', '"Gloß"'))
    with pytest.raises(SignkinError, match=r"no tier 'Gloß'; expected Gloß \(1\), points, Gloß"):
        read_annotation(path, tiers=("Gloß",))
    assert len(read_annotation(path, tiers=("Gloß (1)",)).intervals) == 2
    with pytest.raises(SignkinError, match="'points' is a point tier"):
        read_annotation(path, tiers=("points",))
    path.write_bytes(b"ooBinaryFile\x08TextGrid\x00")
    with pytest.raises(SignkinError, match="a binary TextGrid; expected a TextGrid as Praat"):
        read_annotation(path)


# --- subtitles ------------------------------------------------------------


def test_srt(tmp_path):
    text = (
        "1\n00:00:01,000 --> 00:00:02,500\n<i>HAUS</i>\nzwei\n\n\n2\n"
        "00:00:02.000 --> 01:00:03.000 X1:1\nANN: hm\n"
    )
    path = put(tmp_path, "x.srt", text.replace("\n", "\r\n"), "utf-8-sig")
    assert spans(read_annotation(path)) == [("HAUS\nzwei", 1, 2.5), ("ANN: hm", 2, 3603)]
    a = read_annotation(path, tiers=("ANN", "sign"), speaker_before_colon=True)
    assert spans(a, "ANN") == [("hm", 2, 3603)] and spans(a, "sign") == [("HAUS\nzwei", 1, 2.5)]


def test_vtt(tmp_path):
    text = (
        "WEBVTT - title\n\nNOTE nothing\nat all\n\nSTYLE\n::cue {}\n\nid\n"
        "00:01.000 --> 00:02.000 align:start\n<v Ann Lee>A &amp; <b>B</b></v> <v.bob>C\n\n"
        "00:03.000 --> 00:04.000\n<v Bob></v>\n\n01:00:00.000 --> 01:00:00.500\nplain\n"
    )
    a = read_annotation(put(tmp_path, "x.vtt", text))
    assert {(i.tier, *i_) for i, i_ in zip(a.intervals, spans(a), strict=True)} == {
        ("Ann Lee", "A & B", 1, 2), ("bob", "C", 1, 2), ("sign", "plain", 3600, 3600.5),
    }  # fmt: skip
    assert [(o.tier, o.place) for o in a.left_out] == [("Bob", "line 13")]
    assert spans(read_annotation(tmp_path / "x.vtt", tiers=({"participant": "bob"},))) == [
        ("C", 1, 2)
    ]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("1\n00:00:01,000 -> 00:00:02,500\nA\n", "line 1: found '1'"),
        ("1\n00:00:01,000 --> 00:61:02,500\nA\n", "line 2: found '00:61:02,500'"),
        ("1\n00:00:01,000 --> soon\nA\n", "line 2: found 'soon'"),
        ("1\n00:00:03,000 --> 00:00:02,500\nA\n", "line 2: 'A' runs from 3.000 s to 2.500 s"),
        ("1\n00:00:01,000 --> 00:00:02,500\nA\n2\n00:00:03,000 --> 00:00:04,000\nB\n",
         "line 5: another cue starts inside one"),
        ("1\n00:00:01,000 --> 00:00:02,500\nA\n\nstray\n", "line 5: found 'stray'"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_subtitles_is_told_with_its_line(tmp_path, text, told):
    with pytest.raises(SignkinError, match=f"x.srt, {told}"):
        read_annotation(put(tmp_path, "x.srt", text))


# --- tables ------------------------------------------------------------


def test_semicolons_decimal_commas_and_timecodes(tmp_path):
    path = put(
        tmp_path, "x.csv", "start;end;label\n0,5;1,25;Ä\n\n00:01:02,5;1:03.25;B\n", "latin-1"
    )
    with pytest.raises(SignkinError, match=r"line 2: the text is not utf-8 \(byte c4\).*latin-1"):
        read_annotation(path)
    assert spans(read_annotation(path, encoding="latin-1")) == [
        ("Ä", 0.5, 1.25), ("B", 62.5, 63.25),
    ]  # fmt: skip


def test_frames_of_timecodes_and_durations(tmp_path):
    path = put(tmp_path, "x.tsv", "start\tfor\tlabel\n01:00:00:12\t00:00:01:00\tA\n")
    spec = {"duration_column": "for", "separator": "\t"}
    with pytest.raises(SignkinError, match=r"line 2, column start: .*frame_rate_hz"):
        read_annotation(path, **spec)
    assert spans(read_annotation(path, frame_rate_hz=25, **spec)) == [("A", 3600.48, 3601.48)]


def test_drop_frame_timecodes_count_real_time():
    """At 29.97 Hz an hour of drop-frame timecode is an hour to 4 ms (SMPTE 12M)."""
    times = TimeFormat("timecode", None, 30000 / 1001)
    assert times.seconds("01:00:00;00", "") == pytest.approx(3600, abs=0.004)
    assert times.seconds("00:01:00;02", "") - times.seconds("00:00:59;29", "") == pytest.approx(
        1001 / 30000
    )
    assert times.seconds("01:00:00:00", "") == pytest.approx(3603.6)
    with pytest.raises(SignkinError, match="no frame 30"):
        times.seconds("00:00:00:30", "")


@pytest.mark.parametrize(
    ("cell", "spec", "value"),
    [
        ("0,5", {}, 0.5), ("12,75", {}, 12.75), ("1,234", {"decimal": ","}, 1.234),
        ("1234.5", {}, 1234.5), ("1e3", {"unit": "ms"}, 1.0), ("-0:01", {}, -1.0),
        ("0,125", {}, 0.125),
    ],
)  # fmt: skip
def test_times_that_can_be_read(cell, spec, value):
    assert TimeFormat(**spec).seconds(cell, "") == value


@pytest.mark.parametrize(
    ("cell", "spec"),
    [
        ("1,234", {}), ("1.5", {"decimal": ","}), ("1,5", {"decimal": "."}), ("inf", {}),
        ("nan", {}), ("", {}), ("1_0", {}), ("1e999", {}), ("0x1", {}), ("1:2:3:4", {}),
        ("00:99:00", {}), ("5", {"unit": "timecode"}), ("１", {}),
    ],
)  # fmt: skip
def test_times_that_cannot(cell, spec):
    with pytest.raises(SignkinError, match="line 1: "):
        TimeFormat(**spec).seconds(cell, "line 1")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("start,end,label\n0,1,A\n1,2\n", "line 3: 2 cells; expected 3, as in the header"),
        ("start,end,label\n0,1,A,x\n", "line 2: 4 cells; expected 3"),
        ("start,end,label,end\n0,1,A,2\n", "line 1: 2 columns are called 'end'"),
        ('start,end,label\n0,1,"A\n2,3,B\n', "line 2: not readable as CSV"),
        ("start,end,label\n0,inf,A\n", "line 2, column end: found 'inf'"),
        ("start,stop,label\n0,1,A\n", "no column 'end'; expected start, stop, label"),
        ("", "line 1: nothing in it"),
    ],
)
def test_what_is_wrong_in_a_table_is_told_with_its_line(tmp_path, text, told):
    with pytest.raises(SignkinError, match=rf"x.csv(?:, |: ){told}"):
        read_annotation(put(tmp_path, "x.csv", text))


def test_an_interval_without_length_is_listed_and_the_others_are_read(tmp_path):
    a = read_annotation(put(tmp_path, "x.csv", "start,end,label\n1,1,A\n1,2,B\n"))
    assert spans(a) == [("B", 1, 2)]
    assert [str(o) for o in a.left_out] == ["tier sign, line 2: 'A' has no length, at 1.000 s"]


def test_tiers_by_pattern_and_participant(tmp_path):
    rows = "start,end,label,tier,who\n0,1,A,Gloss R,S1\n0,1,B,Gloss L,S1\n0,1,C,Gloss R2,S2\n"
    path = put(tmp_path, "x.csv", rows)
    spec = {"tier_column": "tier", "participant_column": "who"}
    wish = {"pattern": "Gloss*", "participant": "S1"}
    a = read_annotation(path, tiers=(wish, "Gloss R2"), **spec)
    assert {i.label for i in a.of(wish)} == {"A", "B"}
    assert {i.label for i in a.of("Gloss R2")} == {"C"}
    with pytest.raises(SignkinError, match=r"no tier with participant S3; expected Gloss R \(S1\)"):
        read_annotation(path, tiers=({"participant": "S3"},), **spec)
    with pytest.raises(SignkinError, match="tiers are asked for by participnt"):
        read_annotation(path, tiers=({"participnt": "S3"},), **spec)


def test_two_signers_of_one_tier_are_told_apart(tmp_path):
    path = put(tmp_path, "x.csv", "start,end,label,tier,who\n0,1,A,G,S1\n1,2,B,G,S2\n2,3,C,H,S2\n")
    spec = {"tier_column": "tier", "participant_column": "who"}
    with pytest.raises(SignkinError, match=r"no tier 'G'; expected G \(S1\), G \(S2\), H"):
        read_annotation(path, tiers="G", **spec)
    wish = {"pattern": "G", "participant": "S2"}
    a = read_annotation(path, tiers=(wish,), **spec)
    assert spans(a) == [("B", 1, 2)]
    assert read_annotation(path, **spec).tiers == ("G (S1)", "G (S2)", "H")


# --- ELAN's text export ------------------------------------------------------------

TAB = (
    '"#file:///a/b.eaf"\n'
    "Gloss\tAnn\t00:00:01.500\t1.5\t1500\t00:00:02.000\t2.0\t2000\t00:00:00.500\t0.5\t500\tHAUS\n"
    'Gloss\tAnn\t00:00:02.000\t2.0\t2000\t00:00:03.250\t3.25\t3250\t00:00:01.250\t1.25\t1250\t"hm\n'
    "Text\t\t00:00:00.000\t0.0\t0\t00:00:09.000\t9.0\t9000\t00:00:09.000\t9.0\t9000\t12\n"
)


def test_elan_text_without_header(tmp_path):
    a = read_annotation(put(tmp_path, "x.txt", TAB), format="elan_tab")
    assert spans(a, "Gloss") == [("HAUS", 1.5, 2.0), ('"hm', 2.0, 3.25)]
    assert spans(a, "Text") == [("12", 0, 9)]
    by_person = read_annotation(
        tmp_path / "x.txt", format="elan_tab", tiers=({"participant": "Ann"},)
    )
    assert by_person.tiers == ("Gloss",)


@pytest.mark.parametrize(
    "row",
    [
        "G\t\t1.5\t2.0\tA", "G\t\t1500\t2000\t500\tA", "G\t\t00:00:01.500\t00:00:02.000\tA",
        "G\t\t1.5\t1500\t2.0\t2000\tA",
        "G\t\t00:00:01.500\t00:00:01:12\t00:00:02.000\t00:00:02:00\tA",
    ],
)  # fmt: skip
def test_elan_text_with_other_choices_of_times(tmp_path, row):
    a = read_annotation(put(tmp_path, "x.txt", row + "\n"), format="elan_tab")
    assert spans(a) == [("A", 1.5, 2.0)]


def test_elan_text_with_a_header(tmp_path):
    head = "Tier\tParticipant\tBegin Time - msec\tEnd Time - msec\tAnnotation\n"
    path = put(tmp_path, "x.txt", head + "G\tAnn\t100\t400\tA\nG\tAnn\t400\t900\n")
    assert spans(read_annotation(path, format="elan_tab")) == [("A", 0.1, 0.4), ("", 0.4, 0.9)]
    head = "Begin Time - ss.msec\tEnd Time - ss.msec\tDuration - ss.msec\tGloss R\tGloss L\n"
    path = put(tmp_path, "x.txt", head + "0.1\t0.4\t0.3\tA\n0.4\t0.9\t0.5\t\tB\n")
    a = read_annotation(path, format="elan_tab")
    assert spans(a, "Gloss R") == [("A", 0.1, 0.4)] and spans(a, "Gloss L") == [("B", 0.4, 0.9)]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (TAB.replace("\t2000\t00:00:00.500", "\t2500\t00:00:00.500", 1),
         "line 2: one time is 2.000 s and 2.500 s"),
        ("G\t\t1.5\t2.0\t0.7\tA\n", "line 1: 1.500 s to 2.000 s, which is no duration of 0.700 s"),
        ("G\t\tsoon\tlater\tA\n", "line 1: found 'G"),
        ("no tabs here\n", "line 1: found 'no tabs here'"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_an_export_is_told_with_its_line(tmp_path, text, told):
    with pytest.raises(SignkinError, match=f"x.txt, {told}"):
        read_annotation(put(tmp_path, "x.txt", text), format="elan_tab")


# --- labels of frames ------------------------------------------------------------


def test_labels_of_frames(tmp_path):
    spec = {"format": "frame_labels", "frame_rate_hz": 10}
    path = put(tmp_path, "x.csv", "label\n\nA\nA\n\nB\n")
    assert spans(read_annotation(path, **spec)) == [("A", 0.1, 0.3), ("B", 0.4, 0.5)]
    path = put(tmp_path, "x.txt", "O\nA\nA\nO\n\nB\n")
    a = read_annotation(path, header=False, blank=["O"], tiers=("G",), **spec)
    assert spans(a, "G") == [("A", 0.1, 0.3), ("B", 0.5, 0.6)]
    text = "take;frame;right;left\na;3;A;\na;4;A;B\nb;1;Z;Z\n"
    path = put(tmp_path, "y.csv", text)
    spec |= {"recording_column": "take", "frame_column": "frame", "first_frame": 1, "part": "a"}
    a = read_annotation(path, tiers=("right", "left"), **spec)
    assert spans(a, "right") == [("A", 0.2, 0.4)] and spans(a, "left") == [("B", 0.3, 0.4)]
    put(tmp_path, "y.csv", text.replace("a;4;", "a;5;"))
    with pytest.raises(SignkinError, match=r"line 3: frame 5 follows frame 3"):
        read_annotation(path, **spec)
    with pytest.raises(SignkinError, match="labels of frames, no rate"):
        read_annotation(path, format="frame_labels")


# --- text and options ------------------------------------------------------------


def test_text_of_no_known_encoding_is_refused():
    with pytest.raises(SignkinError, match=r"line 2: the text is not utf-8 \(byte ff\)"):
        decoded(b"a\n\xff\xfe\x00")
    with pytest.raises(SignkinError, match="no encoding is called 'klingon'"):
        decoded(b"a", "klingon")


@pytest.mark.parametrize("name", ["x.csv", "x.srt", "x.vtt", "x.TextGrid", "x.eaf"])
def test_an_option_that_a_format_lacks_is_refused_with_those_it_has(tmp_path, name):
    path = put(tmp_path, name, "")
    with pytest.raises(SignkinError, match=rf"{name}, key annotation.options: no option 'tyers'"):
        read_annotation(path, tyers=("A",))
