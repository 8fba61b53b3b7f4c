"""Damaged tag files: a reader answers with an annotation or a SignkinError, and soon.

500 files a format, always the same ones; SIGNKIN_FUZZ sets another number.
"""

from __future__ import annotations

import os
import random
import time

import pytest

from signkin import Annotation, Interval, SignkinError, read_annotation
from signkin.io.eaf import NewTier, insert_tiers
from signkin.io.eaf_write import new_eaf
from support.c3d_files import write_events

FILES = int(os.environ.get("SIGNKIN_FUZZ", "500"))
LONGEST_S = 5.0

ELAN = new_eaf(
    author="a", date="2020-01-01T00:00:00Z", media_url="v.mp4",
    tiers=[
        ("Gloss", None, [Interval(0.1, 0.4, "HÄUS", ""), Interval(0.5, 0.9, "B", "")]),
        ("Part", "Gloss", [Interval(0.1, 0.2, "x", "")]),
    ],
).decode().replace(' TIME_VALUE="400"', "", 1).replace(
    '<LINGUISTIC_TYPE ',
    '<TIER TIER_ID="Ref" PARENT_REF="Gloss" LINGUISTIC_TYPE_REF="default-lt">'
    + "".join(
        f'<ANNOTATION><REF_ANNOTATION ANNOTATION_ID="r{i}" ANNOTATION_REF="a2" '
        f'PREVIOUS_ANNOTATION="r{i - 1}"><ANNOTATION_VALUE>r</ANNOTATION_VALUE></REF_ANNOTATION>'
        "</ANNOTATION>"
        for i in range(3)
    )
    + "</TIER><LINGUISTIC_TYPE ",
    1,
)  # fmt: skip
GRID = (
    'File type = "ooTextFile"\nObject class = "TextGrid"\n\nxmin = 0\nxmax = 2\ntiers? <exists>\n'
    'size = 2\nitem []:\nitem [1]:\nclass = "IntervalTier"\nname = "Ä"\nxmin = 0\nxmax = 2\n'
    'intervals: size = 2\nintervals [1]:\nxmin = 0\nxmax = 1\ntext = "A ""b"""\nintervals [2]:\n'
    'xmin = 1\nxmax = 2\ntext = ""\nitem [2]:\nclass = "TextTier"\nname = "p"\nxmin = 0\nxmax = 2\n'
    'points: size = 1\npoints [1]:\nnumber = 1\nmark = "m"\n'
)
FORMATS = {
    "eaf": (ELAN, {"unaligned": "interpolate"}),
    "textgrid": (GRID, {}),
    "srt": ("1\n00:00:01,000 --> 00:00:02,500\n<i>Ä</i>\n\n2\n00:00:03,000 --> 00:00:04,000\nB:c\n",
            {"speaker_before_colon": True}),
    "vtt": ("WEBVTT\n\nNOTE x\n\n1\n00:01.000 --> 00:02.000 align:start\n<v.s Ann>Ä &amp; <b>B</b>"
            "</v><v Bob>C\n\n00:00:03.000 --> 00:00:04.000\nplain\n", {}),
    "csv": ('start;end;label;tier\n0,5;1,25;Ä;R\n00:00:02.5;00:00:03:12;"B;c";L\n4;5;D;R\n',
            {"tier_column": "tier", "frame_rate_hz": 25}),
    "elan_tab": ('"#file:///a.eaf"\nG\tAnn\t00:00:01.500\t1.5\t1500\t00:00:02.000\t2.0\t2000\tÄ\n'
                 "G\t\t00:00:02.000\t2.0\t2000\t00:00:03.000\t3.0\t3000\t12\n", {}),
    "frame_labels": ("frame,right,left\n0,A,\n1,A,B\n2,,B\n3,Ä,\n",
                     {"frame_column": "frame", "frame_rate_hz": 25}),
}  # fmt: skip
BITS = [
    b"", b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b'"', b"'", b"<", b">", b"&", b"&x;", b"\t", b";",
    b",", b"\n", b"\r", b"-1", b"1e999", b"nan", b"inf", b"99999999999999999999", b"1_0", b"0x1",
    b":", b"-->", b"<!DOCTYPE a [<!ENTITY x 'y'>]>", b"<!--", b"]]>", b"\xc3", "１".encode(),
    b"encoding=\"utf-7\"", b"<v ", b"</", b"<exists>", b"a1", b"ts1", b"Gloss",
]  # fmt: skip


def damaged(content: bytes, rng: random.Random) -> bytes:
    out = bytearray(content)
    for _ in range(rng.choice((1, 1, 2, 3, 8))):
        i, j = sorted(rng.randrange(len(out) + 1) for _ in range(2))
        match rng.randrange(8):
            case 0 if out:
                out[rng.randrange(len(out))] = rng.randrange(256)
            case 1:
                del out[i : min(j, i + rng.choice((1, 4, 60)))]
            case 2:
                out[i:i] = rng.choice(BITS)
            case 3:
                out[i:i] = out[i : min(j, i + 200)] * rng.choice((1, 2, 20))
            case 4:  # one number for another
                digits = [k for k, byte in enumerate(out) if 48 <= byte < 58]
                if digits:
                    k = rng.choice(digits)
                    out[k : k + 1] = rng.choice(BITS)
            case 5:  # two lines change places
                lines = bytes(out).split(b"\n")
                a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
                lines[a], lines[b] = lines[b], lines[a]
                out = bytearray(b"\n".join(lines))
            case 6 if rng.random() < 0.3:
                out = out[:i]
            case 7 if rng.random() < 0.3:
                text = bytes(out).decode("utf-8", "replace")
                out = bytearray(text.encode(rng.choice(("utf-16", "utf-16-be", "utf-8-sig"))))
    return bytes(out)


@pytest.mark.parametrize("format", [*FORMATS, "c3d_events"])
def test_damaged_files_raise_no_foreign_exception(tmp_path, format):
    path = tmp_path / "x"
    if format == "c3d_events":
        signs = [("Sign", "Right", "HAUS", 0.1), ("End", "Right", "", 0.3)]
        content, options = (
            write_events(tmp_path / "e.c3d", signs)[0].read_bytes(),
            {"blank": ["End"]},
        )
    else:
        text, options = FORMATS[format]
        content = text.encode()
    path.write_bytes(content)
    assert read_annotation(path, format=format, **options).intervals  # the whole file is good
    read = 0
    for seed in range(FILES):
        rng = random.Random(f"{format} {seed}")
        path.write_bytes(damaged(content, rng))
        spec = dict(options) if rng.random() < 0.8 else {}
        if rng.random() < 0.3:
            spec["tiers"] = (rng.choice(["Gloss", "sign", "R", "right"]), {"pattern": "*"})
        start = time.process_time()
        try:
            found = read_annotation(path, format=format, **spec)
            read += 1
            assert isinstance(found, Annotation)
        except SignkinError as error:
            assert "\n" not in str(error), (seed, str(error))
            assert len(str(error)) < 1500, seed
        assert time.process_time() - start < LONGEST_S, seed
    assert 0 < read < FILES


def test_damaged_elan_files_are_refused_or_written_well(tmp_path):
    new = [NewTier("signkin refined right", (Interval(0.1, 0.2, "A", "r"),))]
    written = 0
    for seed in range(FILES):
        content = damaged(ELAN.encode(), random.Random(f"insert {seed}"))
        try:
            out = insert_tiers(content, new)
        except SignkinError as error:
            assert "\n" not in str(error), (seed, str(error))
            continue
        written += 1
        assert insert_tiers(out, new) == out, seed
    assert 0 < written < FILES
