import time
import unicodedata
import xml.etree.ElementTree as ET

import pytest
from pympi.Elan import Eaf

from signkin import Interval, SignkinError, read_annotation
from signkin.io.eaf import NewTier, insert_tiers, write_eaf

HEAD = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<ANNOTATION_DOCUMENT AUTHOR="a" DATE="2020" '
    'FORMAT="3.0" VERSION="3.0" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    'xsi:noNamespaceSchemaLocation="http://www.mpi.nl/tools/elan/EAFv3.0.xsd">\n'
)
TYPES = (
    '<LINGUISTIC_TYPE LINGUISTIC_TYPE_ID="top" TIME_ALIGNABLE="true"/>\n'
    '<LINGUISTIC_TYPE LINGUISTIC_TYPE_ID="child" TIME_ALIGNABLE="false" '
    'CONSTRAINTS="Symbolic_Association"/>\n</ANNOTATION_DOCUMENT>\n'
)


def slot(name, ms):
    value = "" if ms is None else f' TIME_VALUE="{ms}"'
    return f'<TIME_SLOT TIME_SLOT_ID="{name}"{value}/>\n'


def aligned(key, first, second, value):
    return (
        f'<ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="{key}" TIME_SLOT_REF1="{first}" '
        f'TIME_SLOT_REF2="{second}"><ANNOTATION_VALUE>{value}</ANNOTATION_VALUE>'
        "</ALIGNABLE_ANNOTATION></ANNOTATION>\n"
    )


def referring(key, parent, value, previous=None):
    link = f' PREVIOUS_ANNOTATION="{previous}"' if previous else ""
    return (
        f'<ANNOTATION><REF_ANNOTATION ANNOTATION_ID="{key}" ANNOTATION_REF="{parent}"{link}>'
        f"<ANNOTATION_VALUE>{value}</ANNOTATION_VALUE></REF_ANNOTATION></ANNOTATION>\n"
    )


def tier(name, body, parent=None, kind="top"):
    of = f' PARENT_REF="{parent}"' if parent else ""
    return f'<TIER TIER_ID="{name}" LINGUISTIC_TYPE_REF="{kind}"{of}>\n{body}</TIER>\n'


def eaf(
    tmp_path, slots, tiers, media='<MEDIA_DESCRIPTOR MEDIA_URL="v.mp4" MIME_TYPE="video/mp4"/>'
):
    header = f'<HEADER MEDIA_FILE="" TIME_UNITS="milliseconds">{media}</HEADER>\n'
    order = "".join(slot(name, ms) for name, ms in slots.items())
    path = tmp_path / "x.eaf"
    path.write_text(f"{HEAD}{header}<TIME_ORDER>\n{order}</TIME_ORDER>\n{tiers}{TYPES}")
    return path


@pytest.fixture
def nested(tmp_path):
    slots = {"ts1": 100, "ts2": 400, "ts3": 700, "ts4": 1000}
    tiers = (
        tier("Sign", aligned("a1", "ts1", "ts2", "A") + aligned("a2", "ts3", "ts4", "B"))
        + tier(
            "English", referring("a3", "a1", "ONE") + referring("a4", "a2", "TWO"), "Sign", "child"
        )
        + tier(
            "Part",
            referring("a7", "a2", "last", "a6")
            + referring("a5", "a2", "first")
            + referring("a6", "a2", "middle", "a5"),
            "Sign",
            "child",
        )
    )
    return eaf(tmp_path, slots, tiers)


def spans(annotation, name):
    return [(i.label, i.start_s, i.end_s) for i in annotation.tier(name)]


def test_a_symbolic_child_has_its_parents_times(nested):
    a = read_annotation(nested, tiers=("English", "Sign"))
    assert spans(a, "English") == [("ONE", 0.1, 0.4), ("TWO", 0.7, 1.0)]
    assert spans(a, "Sign") == [("A", 0.1, 0.4), ("B", 0.7, 1.0)]


def test_children_that_subdivide_a_parent_share_it_in_chain_order(nested):
    a = read_annotation(nested, tiers=("Part",))
    assert spans(a, "Part") == [
        ("first", 0.7, pytest.approx(0.8)),
        ("middle", pytest.approx(0.8), pytest.approx(0.9)),
        ("last", pytest.approx(0.9), 1.0),
    ]


def test_unknown_and_empty_tiers_are_refused(nested, tmp_path):
    with pytest.raises(SignkinError, match=r"no tier 'sign'; expected Sign, English, Part"):
        read_annotation(nested, tiers=("sign",))
    path = eaf(tmp_path, {"ts1": 0, "ts2": 10}, tier("Empty", "") + tier("S", ""))
    with pytest.raises(SignkinError, match="tier 'Empty': the tier is empty"):
        read_annotation(path, tiers=("Empty",))


def test_open_times_are_refused_or_spread_evenly(tmp_path):
    slots = {"ts1": 0, "ts2": None, "ts3": None, "ts4": 900}
    body = aligned("a1", "ts1", "ts2", "A") + aligned("a2", "ts2", "ts3", "B")
    path = eaf(tmp_path, slots, tier("S", body + aligned("a3", "ts3", "ts4", "C")))
    with pytest.raises(SignkinError, match=r"2 times are left open .*ts2.*unaligned: interpolate"):
        read_annotation(path)
    a = read_annotation(path, unaligned="interpolate")
    assert spans(a, "S") == [("A", 0, 0.3), ("B", 0.3, 0.6), ("C", 0.6, 0.9)]
    assert a.interpolated == 2
    with pytest.raises(SignkinError, match="unaligned is 'guess'"):
        read_annotation(path, unaligned="guess")


def test_an_open_time_without_neighbours_is_refused(tmp_path):
    path = eaf(tmp_path, {"ts1": 0, "ts2": None}, tier("S", aligned("a1", "ts1", "ts2", "A")))
    with pytest.raises(SignkinError, match="no aligned time stands on both sides"):
        read_annotation(path, unaligned="interpolate")


def media(*origins):
    return "".join(
        f'<MEDIA_DESCRIPTOR MEDIA_URL="dir/v{i}.mp4" MIME_TYPE="video/mp4" TIME_ORIGIN="{ms}"/>'
        for i, ms in enumerate(origins)
    )


def test_time_origin_is_added_and_reported(tmp_path):
    body = tier("S", aligned("a1", "ts1", "ts2", "A"))
    path = eaf(tmp_path, {"ts1": 100, "ts2": 400}, body, media(1200))
    a = read_annotation(path)
    assert spans(a, "S") == [("A", 1.3, 1.6)]
    assert a.clock_offset_s == 1.2


def test_media_that_start_apart_want_a_choice(tmp_path):
    body = tier("S", aligned("a1", "ts1", "ts2", "A"))
    path = eaf(tmp_path, {"ts1": 100, "ts2": 400}, body, media(0, 500))
    with pytest.raises(SignkinError, match=r"start at different times.*clock_media"):
        read_annotation(path)
    assert read_annotation(path, clock_media="v1.mp4").clock_offset_s == 0.5
    with pytest.raises(SignkinError, match=r"no medium 'v9.mp4'; expected v0.mp4, v1.mp4"):
        read_annotation(path, clock_media="v9.mp4")


def test_a_file_that_is_no_eaf_is_refused(tmp_path):
    path = tmp_path / "x.eaf"
    path.write_text("<A></B>")
    with pytest.raises(SignkinError, match=r"x.eaf, line 1.*not well-formed XML .*an .eaf that"):
        read_annotation(path)


NEW = [
    NewTier("signkin refined right", (Interval(0.11, 0.43, "A & <B>", "r"),)),
    NewTier("signkin refined left", (Interval(0.12, 0.4, "A", "l"), Interval(0.7, 1.1, "B", "l"))),
]


def test_inserting_leaves_every_other_byte(nested):
    before = nested.read_bytes()
    after = insert_tiers(before, NEW)
    place, kept = 0, bytearray()
    for byte in before:  # the old bytes stand in the new file in their order
        found = after.find(bytes([byte]), place)
        assert found >= 0
        kept.append(after[found])
        place = found + 1
    assert bytes(kept) == before
    nested.write_bytes(after)
    a = read_annotation(nested, tiers=("Sign", "English", "Part"))
    assert spans(a, "Sign") == [("A", 0.1, 0.4), ("B", 0.7, 1.0)]


def test_inserted_tiers_are_there_in_order_and_well_formed(nested):
    nested.write_bytes(insert_tiers(nested.read_bytes(), NEW))
    a = read_annotation(nested)
    assert spans(a, "signkin refined right") == [("A & <B>", 0.11, 0.43)]
    assert spans(a, "signkin refined left") == [("A", 0.12, 0.4), ("B", 0.7, 1.1)]
    tree = ET.parse(nested).getroot()
    values = [int(s.get("TIME_VALUE")) for s in tree.iter("TIME_SLOT")]
    assert values == sorted(values)
    order = [child.tag for child in tree]
    rank = {"HEADER": 0, "TIME_ORDER": 1, "TIER": 2, "LINGUISTIC_TYPE": 3, "CONSTRAINT": 4}
    assert [rank[tag] for tag in order] == sorted(rank[tag] for tag in order)
    ids = [e.get(k) for e in tree.iter() for k in ("ANNOTATION_ID", "TIME_SLOT_ID") if e.get(k)]
    assert len(ids) == len(set(ids))
    types = {t.get("LINGUISTIC_TYPE_ID") for t in tree.iter("LINGUISTIC_TYPE")}
    assert {t.get("LINGUISTIC_TYPE_REF") for t in tree.iter("TIER")} <= types
    assert "signkin refined left" in Eaf(str(nested)).get_tier_names()


def test_a_second_insertion_changes_no_byte(nested):
    once = insert_tiers(nested.read_bytes(), NEW)
    assert insert_tiers(once, NEW) == once


def test_the_clock_offset_is_taken_off_again(nested):
    nested.write_bytes(insert_tiers(nested.read_bytes(), NEW[:1], clock_offset_s=0.1))
    assert spans(read_annotation(nested), "signkin refined right") == [("A & <B>", 0.01, 0.33)]


def test_a_tier_of_that_name_is_not_overwritten(nested):
    with pytest.raises(SignkinError, match="the file has a tier 'Sign' already"):
        insert_tiers(nested.read_bytes(), [NewTier("Sign", ())])


def test_written_files_are_the_same_bytes_and_read_back(tmp_path):
    tiers = [
        ("utterance", None, [Interval(0.1, 2, "u", "utterance")]),
        ("sign", "utterance", [Interval(0.1, 0.5, "A", "sign"), Interval(1, 2, "B", "sign")]),
    ]
    about = {"author": "t", "date": "2017-07-09T00:00:00+00:00", "media_url": "x.bvh"}
    for name in ("a.eaf", "b.eaf"):
        write_eaf(tmp_path / name, tiers=tiers, **about)
    assert (tmp_path / "a.eaf").read_bytes() == (tmp_path / "b.eaf").read_bytes()
    a = read_annotation(tmp_path / "a.eaf")
    assert spans(a, "sign") == [("A", 0.1, 0.5), ("B", 1, 2)]


@pytest.mark.parametrize("encoding", ["ISO-8859-1", "windows-1252", "US-ASCII", "UTF-16", "UTF-8"])
def test_a_file_keeps_its_encoding(nested, encoding):
    text = (
        nested.read_text()
        .replace("UTF-8", encoding)
        .replace("<ANNOTATION_VALUE>A<", "<ANNOTATION_VALUE>Ä<")
    )
    before = text.encode(encoding, "xmlcharrefreplace")
    new = [NewTier("signkin Größe ☺", (Interval(0.11, 0.43, "Ä ☺", "r"),))]
    after = insert_tiers(before, new)
    assert insert_tiers(after, new) == after
    nested.write_bytes(after)
    a = read_annotation(nested)
    assert spans(a, "signkin Größe ☺") == [("Ä ☺", 0.11, 0.43)]
    assert spans(a, "Sign") == [("Ä", 0.1, 0.4), ("B", 0.7, 1.0)]
    assert ET.parse(nested).getroot().tag == "ANNOTATION_DOCUMENT"


def test_self_closed_elements_right_before_a_closing_tag(nested):
    content = nested.read_bytes().replace(
        b"/>\n</ANNOTATION_DOCUMENT>", b"/></ANNOTATION_DOCUMENT>"
    )
    nested.write_bytes(insert_tiers(content, NEW))
    assert len(read_annotation(nested).tiers) == 5


# --- files as they are ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    "bomb",
    [
        '<!DOCTYPE a [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;&a;">]>',
        '<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]>',
        '<!DOCTYPE a [<!ENTITY % p SYSTEM "http://127.0.0.1/p">%p;]>',
        '<!DOCTYPE a SYSTEM "file:///nowhere.dtd">',
    ],
)
def test_entities_are_refused_in_one_sentence_and_nothing_is_fetched(nested, bomb):
    text = nested.read_text().replace("?>\n", f"?>\n{bomb}\n", 1).replace(">A<", ">&b;<", 1)
    nested.write_text(text)
    with pytest.raises(SignkinError, match=r"line \d+: the file declares or uses an entity"):
        read_annotation(nested)
    with pytest.raises(SignkinError, match="the file declares or uses an entity"):
        insert_tiers(text.encode(), NEW)


def test_a_name_for_the_schema_alone_is_no_entity(nested):
    text = nested.read_text().replace("?>\n", '?>\n<!DOCTYPE ANNOTATION_DOCUMENT SYSTEM "x">\n', 1)
    nested.write_text(text)
    assert len(read_annotation(nested).tier("Sign")) == 2


def test_an_id_used_twice_loses_nothing_unless_a_child_asks_for_it(tmp_path):
    slots = {"ts1": 100, "ts2": 400, "ts3": 700, "ts4": 1000}
    body = aligned("a1", "ts1", "ts2", "A") + aligned("a1", "ts3", "ts4", "B")
    path = eaf(
        tmp_path, slots,
        tier("S", body) + tier("C", referring("a1", "a1", "c"), "S", "child"),
    )  # fmt: skip
    assert [label for label, *_ in spans(read_annotation(path, tiers=("S",)), "S")] == ["A", "B"]
    with pytest.raises(SignkinError, match=r"a1 is used twice \(lines \d+ and \d+\), and tier 'C'"):
        read_annotation(path, tiers=("C",))


def test_a_parent_is_looked_up_in_the_parent_tier_alone(tmp_path):
    slots = {"ts1": 100, "ts2": 400, "ts3": 700, "ts4": 1000}
    tiers = (
        tier("Other", aligned("p", "ts3", "ts4", "O"))
        + tier("P", aligned("p", "ts1", "ts2", "A"))
        + tier("C", referring("p", "p", "c"), "P", "child")
        + tier("D", referring("d", "x", "d"), "P", "child")
    )
    path = eaf(tmp_path, slots, tiers)
    assert spans(read_annotation(path, tiers=("C",)), "C") == [("c", 0.1, 0.4)]
    with pytest.raises(SignkinError, match="d refers to x, which is not on the tier 'P'"):
        read_annotation(path, tiers=("D",))


def test_tiers_that_hang_on_themselves_or_on_nothing_are_refused(tmp_path):
    tiers = tier("A", referring("a", "b", "x"), "B", "child") + tier(
        "B", referring("b", "a", "y"), "A", "child"
    )
    with pytest.raises(SignkinError, match="the tier is its own ancestor"):
        read_annotation(eaf(tmp_path, {"ts1": 0}, tiers))
    with pytest.raises(SignkinError, match="the parent tier 'B' is not there"):
        read_annotation(eaf(tmp_path, {}, tier("A", referring("a", "b", "x"), "B", "child")))
    with pytest.raises(SignkinError, match=r"tier 'A' stands in line \d+ already"):
        read_annotation(eaf(tmp_path, {}, tier("A", "") + tier("A", "")))


def test_an_open_slot_has_one_time_in_all_tiers(tmp_path):
    """The parent's words share the phrase; a morpheme's open edge lies between those times."""
    slots = {"ts1": 0, "o2": None, "ts2": 900, "o1": None, "m": None}
    tiers = (
        tier("Morph", aligned("m2", "m", "o1", "b") + aligned("m1", "ts1", "m", "a"), "Word")
        + tier("Word", aligned("w3", "o2", "ts2", "C") + aligned("w1", "ts1", "o1", "A")
               + aligned("w2", "o1", "o2", "B"), "Phrase")
        + tier("Phrase", aligned("p", "ts1", "ts2", "p"))
    )  # fmt: skip
    a = read_annotation(eaf(tmp_path, slots, tiers), unaligned="interpolate")
    assert spans(a, "Word") == [("A", 0, 0.3), ("B", 0.3, 0.6), ("C", 0.6, 0.9)]
    assert spans(a, "Morph") == [("a", 0, 0.15), ("b", 0.15, 0.3)]
    assert a.interpolated == 3


def test_open_edges_that_do_not_touch_follow_time_order(tmp_path):
    slots = {"ts1": 0, "o1": None, "o2": None, "ts2": 900, "ts3": 1000}
    body = aligned("b", "o2", "ts2", "B") + aligned("a", "ts1", "o1", "A")
    a = read_annotation(eaf(tmp_path, slots, tier("S", body)), unaligned="interpolate")
    assert spans(a, "S") == [("A", 0, 0.3), ("B", 0.6, 0.9)]


def test_one_bad_value_is_listed_and_the_others_are_read(tmp_path):
    slots = {"ts1": 0, "ts2": "12.5", "ts3": 400, "ts4": 400, "ts5": 900, "ts6": "-5"}
    body = (
        aligned("a1", "ts1", "ts2", "A") + aligned("a2", "ts3", "ts4", "B")
        + aligned("a3", "ts4", "ts5", "C") + aligned("a4", "ts6", "ts5", "D")
    )  # fmt: skip
    tiers = tier("S", body) + tier("E", referring("e1", "a1", "e") + referring("e3", "a3", "f"),
                                   "S", "child")  # fmt: skip
    a = read_annotation(eaf(tmp_path, slots, tiers))
    assert spans(a, "S") == [("C", 0.4, 0.9)] and spans(a, "E") == [("f", 0.4, 0.9)]
    told = [str(o) for o in a.left_out]
    assert len(told) == 4
    assert "annotation a1, line" in told[0] and "TIME_VALUE 12.5" in told[0]
    assert "'B' has no length, at 0.400 s" in told[1]
    assert "TIME_VALUE -5" in told[2]
    assert "tier E" in told[3] and "its parent a1: slot ts2" in told[3]


def linked(url, origin=None):
    at = "" if origin is None else f' TIME_ORIGIN="{origin}"'
    return f'<LINKED_FILE_DESCRIPTOR LINK_URL="{url}" MIME_TYPE="text/plain"{at}/>'


def test_time_origin_of_linked_files_counts_and_media_are_known_by_address(tmp_path):
    body = tier("S", aligned("a1", "ts1", "ts2", "A"))
    slots = {"ts1": 100, "ts2": 400}

    def offset(media, **options):
        return read_annotation(eaf(tmp_path, slots, body, media), **options).clock_offset_s

    assert offset(linked("file:///d/motion.csv", 1500)) == 1.5
    both = media(0) + linked("file:///d/my%20motion.csv", 1500)
    with pytest.raises(SignkinError, match=r"start at different times.*1500 ms.*clock_media"):
        offset(both)
    assert offset(both, clock_media="my motion.csv") == 1.5
    assert offset(media(700) + linked("file:///d/x_tsconf.xml")) == 0.7  # no clock of its own
    twins = media(0).replace("dir/v0.mp4", "file:///a/v.mp4") + media(900).replace(
        "dir/v0.mp4", "file:///b/v.mp4"
    )
    with pytest.raises(SignkinError, match=r"several media are called 'v.mp4'"):
        offset(twins, clock_media="v.mp4")
    assert offset(twins, clock_media="file:///b/v.mp4") == 0.9
    with pytest.raises(SignkinError, match=r"TIME_ORIGIN is '1.5'; expected whole milliseconds"):
        offset(media("1.5"))


def test_times_that_are_not_milliseconds_want_a_word(tmp_path):
    path = eaf(tmp_path, {"ts1": 0, "ts2": 25}, tier("S", aligned("a1", "ts1", "ts2", "A")))
    path.write_text(path.read_text().replace('"milliseconds"', '"PAL-frames"'))
    with pytest.raises(SignkinError, match="TIME_UNITS is 'PAL-frames'; expected milliseconds"):
        read_annotation(path)
    assert spans(read_annotation(path, time_units="PAL-frames"), "S") == [("A", 0, 1.0)]
    assert spans(read_annotation(path, time_units="milliseconds"), "S") == [("A", 0, 0.025)]


def test_old_and_sparse_files_are_read(tmp_path):
    """EAF 2.0 had no FORMAT, and much of the rest may be missing."""
    path = tmp_path / "x.eaf"
    path.write_text(
        '<ANNOTATION_DOCUMENT DATE="2002" AUTHOR="" VERSION="2.0"><HEADER MEDIA_FILE="x.mpg" '
        'TIME_UNITS="milliseconds"/><TIME_ORDER>' + slot("t", 100) + slot("u", 400)
        + "</TIME_ORDER>" + tier("S", aligned("x", "t", "u", "A"))
        + '<LINGUISTIC_TYPE LINGUISTIC_TYPE_ID="top"/></ANNOTATION_DOCUMENT>'
    )  # fmt: skip
    assert spans(read_annotation(path), "S") == [("A", 0.1, 0.4)]


def test_a_hundred_thousand_annotations_take_time_as_they_are_many(tmp_path):
    """Time grows with the number, not its square: ten times as many take less than thirty."""
    path = tmp_path / "x.eaf"

    def seconds(n):
        own = [Interval(i, i + 0.9, "A", "S") for i in range(n)]
        write_eaf(path, author="a", date="2020", media_url="v", tiers=[("S", None, own)])
        start = time.process_time()
        assert len(read_annotation(path).intervals) == n
        return time.process_time() - start

    seconds(1000)
    small, large = seconds(10_000), seconds(100_000)
    assert large < 20
    assert large < 30 * small


def test_accents_coded_in_another_way_are_the_same_letters(nested):
    apart = unicodedata.normalize("NFD", "HÄUS")
    nested.write_text(nested.read_text().replace(">A<", f">{apart}<"), encoding="utf-8")
    a = read_annotation(nested, tiers=("Sign",), gloss={"merge": {apart: "HOUSE"}})
    assert [(i.label, i.as_written) for i in a.intervals] == [("HOUSE", apart), ("B", "B")]
    assert read_annotation(nested, tiers=("Sign",)).intervals[0].label == "HÄUS"


def test_a_name_of_utf_8_that_is_none_of_xml_is_understood(nested):
    text = nested.read_text().replace('encoding="UTF-8"', 'encoding="utf8"').replace(">A<", ">Ä<")
    nested.write_bytes(text.encode())
    assert read_annotation(nested, tiers=("Sign",)).intervals[0].label == "Ä"
    assert "Ä".encode() in insert_tiers(text.encode(), NEW)
    for bad in ("shift_jis", "klingon", "utf-7"):
        with pytest.raises(SignkinError, match=r"the encoding .* is not one that can be read|XML"):
            insert_tiers(text.replace("utf8", bad).encode(), NEW)
