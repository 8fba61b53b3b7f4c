"""Writing into ELAN files: what the user made stays, what comes out is valid."""

import re
import xml.etree.ElementTree as ET

import pandas as pd
import pytest

from signkin import Interval, SignkinError, read_annotation
from signkin.io.eaf import NewTier, insert_tiers
from signkin.io.eaf_write import LINGUISTIC_TYPE, elan_copy, new_eaf
from signkin.studies.naert2017.elan import refined_copies
from support.elan_rules import broken

NEW = [
    NewTier("signkin refined right", (Interval(0.11, 0.43, "A & <B>", "r"),)),
    NewTier("signkin refined left", (Interval(0.12, 0.4, "A", "l"), Interval(0.7, 1.1, "B", "l"))),
]


def original(format="3.0"):
    tiers = [("Sign", None, [Interval(0.1, 0.4, "A", ""), Interval(0.7, 1.0, "B", "")]),
             ("Part", "Sign", [Interval(0.1, 0.2, "x", "")])]  # fmt: skip
    content = new_eaf(author="u", date="2020-01-01T00:00:00Z", media_url="v.mp4", tiers=tiers)
    return content.replace(b'FORMAT="3.0"', f'FORMAT="{format}"'.encode())


def saved_by_elan(content, rename=None, drop=(), retype=None):
    """What ELAN does on saving: attributes in order of the alphabet, slots with new names."""
    rename = rename or {}
    root = ET.fromstring(content)
    for tier in list(root.iter("TIER")):
        if tier.get("TIER_ID") in drop:
            root.remove(tier)
        else:
            tier.set("TIER_ID", rename.get(tier.get("TIER_ID"), tier.get("TIER_ID")))
    used = {e.get(k) for e in root.iter() for k in ("TIME_SLOT_REF1", "TIME_SLOT_REF2")}
    order = root.find("TIME_ORDER")
    for slot in list(order):
        if slot.get("TIME_SLOT_ID") not in used:
            order.remove(slot)
    names = {slot.get("TIME_SLOT_ID"): f"ts{i}" for i, slot in enumerate(order, start=1)}
    for e in root.iter():
        for key in ("TIME_SLOT_ID", "TIME_SLOT_REF1", "TIME_SLOT_REF2"):
            if e.get(key):
                e.set(key, names[e.get(key)])
        for key in ("LINGUISTIC_TYPE_REF", "LINGUISTIC_TYPE_ID"):
            if retype and e.get(key) == LINGUISTIC_TYPE:
                e.set(key, retype)
        ordered = sorted(e.attrib.items())
        e.attrib.clear()
        e.attrib.update(ordered)
    return ET.tostring(root, encoding="utf-8", xml_declaration=True)


def content_of(root, but=()):
    """The tiers with their labels and times, without those named."""
    root = ET.fromstring(root)
    value = {s.get("TIME_SLOT_ID"): s.get("TIME_VALUE") for s in root.iter("TIME_SLOT")}
    return {
        t.get("TIER_ID"): [
            (value[a.get("TIME_SLOT_REF1")], value[a.get("TIME_SLOT_REF2")], a[0].text)
            for a in t.iter("ALIGNABLE_ANNOTATION")
        ]
        for t in root.iter("TIER")
        if t.get("TIER_ID") not in but
    }


NAMES = tuple(tier.name for tier in NEW)


@pytest.mark.parametrize("format", ["2.7", "2.8", "3.0"])
def test_what_is_written_keeps_the_rules_of_the_schema(format):
    before = original(format)
    assert broken(before) == []
    after = insert_tiers(before, NEW)
    assert broken(after) == []
    assert content_of(after, NAMES) == content_of(before)
    assert content_of(after)["signkin refined left"] == [("120", "400", "A"), ("700", "1100", "B")]


def test_the_rules_find_what_is_broken():
    """A check that finds nothing would prove nothing."""
    after = insert_tiers(original(), NEW).decode()
    for change in (
        ('ANNOTATION_ID="a2"', 'ANNOTATION_ID="a1"'),
        ('TIME_SLOT_REF1="ts1"', 'TIME_SLOT_REF1="nowhere"'),
        ('LINGUISTIC_TYPE_ID="included"', 'LINGUISTIC_TYPE_ID="default-lt"'),
        ('PARENT_REF="Sign"', 'PARENT_REF="Sing"'),
        ('TIME_VALUE="100"', 'TIME_VALUE="-1"'),
    ):
        assert change[0] in after
        assert broken(after.replace(*change, 1).encode()), change


def test_a_copy_that_elan_saved_gets_its_tiers_replaced():
    copy = saved_by_elan(insert_tiers(original(), NEW))
    other = [NewTier(NAMES[0], (Interval(0.5, 0.6, "C", "r"),)), NewTier(NAMES[1], ())]
    after = insert_tiers(copy, other)
    assert broken(after) == []
    assert content_of(after) == {**content_of(original()), NAMES[0]: [("500", "600", "C")],
                                 NAMES[1]: []}  # fmt: skip
    assert insert_tiers(after, other) == after


def test_renamed_tiers_and_a_renamed_type_are_the_users():
    copy = saved_by_elan(insert_tiers(original(), NEW), rename={NAMES[0]: "RH checked"})
    after = insert_tiers(copy, [NewTier(NAMES[0], (Interval(0.5, 0.6, "C", "r"),)), NEW[1]])
    assert broken(after) == []
    assert content_of(after)["RH checked"] == [("110", "430", "A & <B>")]
    assert content_of(after)[NAMES[0]] == [("500", "600", "C")]
    copy = saved_by_elan(insert_tiers(original(), NEW), retype="refined by hand")
    after = insert_tiers(copy, NEW)
    assert broken(after) == []
    assert list(content_of(after)) == ["Sign", "Part", *NAMES]
    assert b"refined by hand" in after


def test_deleted_tiers_leave_a_type_that_is_used_again():
    copy = saved_by_elan(insert_tiers(original(), NEW), drop=NAMES)
    after = insert_tiers(copy, NEW)
    assert broken(after) == []
    assert len(re.findall(f'LINGUISTIC_TYPE_ID="{LINGUISTIC_TYPE}"', after.decode())) == 1


def test_a_type_of_that_name_that_cannot_hold_the_tiers_is_left_alone():
    copy = saved_by_elan(insert_tiers(original(), NEW), drop=NAMES).decode()
    name = f'LINGUISTIC_TYPE_ID="{LINGUISTIC_TYPE}"'
    copy = copy.replace(name, f'CONSTRAINTS="Included_In" {name}')
    after = insert_tiers(copy.encode(), NEW)
    assert broken(after) == []
    assert f'LINGUISTIC_TYPE_REF="{LINGUISTIC_TYPE}-2"' in after.decode()
    assert insert_tiers(after, NEW) == after


def test_a_tier_that_the_user_built_on_is_kept_beside_a_new_one():
    once = insert_tiers(original(), NEW).decode()
    child = (
        f'<TIER TIER_ID="note" PARENT_REF="{NAMES[0]}" LINGUISTIC_TYPE_REF="included"><ANNOTATION>'
        '<REF_ANNOTATION ANNOTATION_ID="n1" ANNOTATION_REF="signkin_a1_1"><ANNOTATION_VALUE>?'
        "</ANNOTATION_VALUE></REF_ANNOTATION></ANNOTATION></TIER>"
    )
    built = once.replace("<LINGUISTIC_TYPE ", child + "<LINGUISTIC_TYPE ", 1).encode()
    after = insert_tiers(built, NEW)
    assert broken(after) == []
    assert content_of(after)[NAMES[0]] == [("110", "430", "A & <B>")]
    assert f"{NAMES[0]} (2)" in content_of(after)
    assert insert_tiers(after, NEW) == after


def test_annotations_that_the_user_added_to_an_own_tier_are_kept():
    once = insert_tiers(original(), NEW).decode()
    mine = (
        '<ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a77" TIME_SLOT_REF1="ts1" '
        'TIME_SLOT_REF2="ts2"><ANNOTATION_VALUE>mine</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION>'
        "</ANNOTATION></TIER>"
    )
    place = once.index("</TIER>", once.index(NAMES[0]))
    after = insert_tiers((once[:place] + mine + once[place + 7 :]).encode(), NEW)
    assert ("100", "400", "mine") in content_of(after)[NAMES[0]]
    assert broken(after) == []


def test_comments_processing_instructions_and_cdata_stay():
    odd = (
        '<!-- <TIER TIER_ID="signkin refined right" LINGUISTIC_TYPE_REF="signkin-segmentation">'
        "</TIER> --><?keep <TIME_SLOT/>?>"
    )
    before = original().decode().replace("<LINGUISTIC_TYPE ", odd + "<LINGUISTIC_TYPE ", 1)
    before = before.replace(">x<", "><![CDATA[</TIER>&]]><").encode()
    after = insert_tiers(before, NEW)
    assert odd.encode() in after and b"<![CDATA[</TIER>&]]>" in after
    assert broken(after) == [] and insert_tiers(after, NEW) == after


@pytest.mark.parametrize("order", ["<TIME_ORDER/>", "<TIME_ORDER></TIME_ORDER>", "<TIME_ORDER />"])
def test_a_file_without_slots_tiers_and_types(order):
    empty = (
        '<ANNOTATION_DOCUMENT AUTHOR="" DATE="2020-01-01T00:00:00Z" VERSION="3.0"><HEADER/>'
        f"{order}</ANNOTATION_DOCUMENT>"
    )
    after = insert_tiers(empty.encode(), NEW)
    assert broken(after) == []
    assert set(content_of(after)) == set(NAMES)
    assert insert_tiers(after, NEW) == after


def test_a_label_that_xml_cannot_hold_is_refused():
    with pytest.raises(SignkinError, match=r"XML cannot hold \(U\+0001\)"):
        insert_tiers(original(), [NewTier("n", (Interval(0, 1, "A\x01", "n"),))])


def test_tags_that_are_not_elan_become_elan(tmp_path):
    (tmp_path / "a.csv").write_text("start,end,label\n")
    about = pd.DataFrame({"recording": ["r"], "annotation_file": ["a.csv"],
                          "motion_file": ["m.bvh"], "clock_offset_s": [-2.0]})  # fmt: skip
    edges = [("start", 0.12), ("end", 0.44)]
    boundaries = pd.DataFrame(
        [{"recording": "r", "hand": hand, "sign": 1, "gloss": "A", "edge": edge, "refined_s": t}
         for hand in ("right", "left") for edge, t in edges]
    )  # fmt: skip
    intervals = pd.DataFrame(
        {"recording": ["r", "r", "other"], "start_s": [0.1, 0.6, 0.0], "end_s": [0.4, 0.9, 1.0],
         "written": ["A*", float("nan"), "Z"], "tier": ["Gloss", "Gloss", "Gloss"]}
    )  # fmt: skip
    made = refined_copies(tmp_path, about, boundaries, intervals, elan=False)
    assert broken(made["r.eaf"]) == []
    assert content_of(made["r.eaf"])["Gloss"] == [("100", "400", "A*"), ("600", "900", None)]
    assert content_of(made["r.eaf"])["signkin refined left"] == [("120", "440", "A")]
    assert made == refined_copies(tmp_path, about, boundaries, intervals, elan=False)
    (tmp_path / "r.eaf").write_bytes(made["r.eaf"])
    assert len(read_annotation(tmp_path / "r.eaf").intervals) == 4
    with pytest.raises(SignkinError, match=r"a\.csv.*not well-formed"):
        elan_copy(tmp_path / "a.csv", NEW, elan=True, clock_offset_s=0, tags=(), media_url="m")


def test_overlaps_stand_on_tiers_of_their_own(tmp_path):
    """A tier in ELAN has no overlap; no tag is lost, no name is used twice."""
    rows = [(0, 1, "A"), (0.9, 2, "B"), (0.95, 3, "C"), (2, 4, "D"), (3, 5, "E")]
    tags = [Interval(a, b, label, "word") for a, b, label in rows]
    tags.append(Interval(0, 1, "x", "word (2)"))
    made = elan_copy(tmp_path / "t.csv", [], elan=False, clock_offset_s=0, tags=tags, media_url="m")
    assert broken(made) == []
    found = {name: [label for *_, label in own] for name, own in content_of(made).items()}
    assert found == {
        "word": ["A", "D"], "word (3)": ["B", "E"], "word (4)": ["C"], "word (2)": ["x"],
    }  # fmt: skip
