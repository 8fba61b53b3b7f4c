import math

import pytest

from signkin import Annotation, Interval, SignkinError, read_annotation
from signkin.annotation_rules import GlossRules, excerpt, labels_to_intervals, signs_of_hands


def interval(start, end, label, tier="sign"):
    return Interval(start, end, label, tier)


LONG = Annotation(
    name="x",
    intervals=(
        interval(1, 2, "A"), interval(9.5, 10.5, "B"), interval(11, 12, "C"),
        interval(19.8, 20.2, "D"), interval(8, 30, "u", "utterance"),
    ),
    chosen={"sign": ("sign",), "utterance": ("utterance",)},
)  # fmt: skip


def test_an_excerpt_starts_at_zero_and_lists_what_lies_outside():
    a = excerpt(LONG, 10, 20, 0.25, clip=["utterance"])
    assert [(i.label, i.start_s, i.end_s) for i in a.tier("sign")] == [("C", 1.25, 2.25)]
    assert [(i.start_s, i.end_s) for i in a.tier("utterance")] == [(0.25, 10.25)]
    assert a.clock_offset_s == pytest.approx(-9.75)
    assert [(out.place, out.reason) for out in a.left_out] == [
        ("'A' at 1.000 s", "outside the excerpt"),
        ("'B' at 9.500 s", "partly outside the excerpt"),
        ("'D' at 19.800 s", "partly outside the excerpt"),
    ]


def test_an_excerpt_without_a_tag_or_without_length_is_refused():
    with pytest.raises(SignkinError, match=r"no interval lies between 50 s and 60 s; they run"):
        excerpt(LONG, 50, 60)
    with pytest.raises(SignkinError, match="an end after the start"):
        excerpt(LONG, 5, 5)
    with pytest.raises(SignkinError, match="from_s is nan"):
        excerpt(LONG, math.nan)
    with pytest.raises(SignkinError, match="a time inside the recording"):
        excerpt(LONG, clock_offset_s=-5)
    assert excerpt(LONG) is LONG


def test_glosses_are_stripped_and_merged_and_kept_as_written():
    rules = GlossRules.of({"strip": ["*", "^", "$"], "merge": {"HOUSE1": "HOUSE"}})
    a = Annotation(name="x", intervals=tuple(
        interval(i, i + 1, label)
        for i, label in enumerate(["HOUSE1^*", "*HOUSE1", "TREE", "**", " $HOUSE "])
    ))  # fmt: skip
    out = rules.applied(a).intervals
    assert [i.label for i in out] == ["HOUSE", "HOUSE", "TREE", "**", "HOUSE"]
    assert [i.as_written for i in out] == ["HOUSE1^*", "*HOUSE1", "TREE", "**", " $HOUSE "]
    assert out[2].written == ""


@pytest.mark.parametrize(
    ("rules", "told"),
    [
        ({"strip": [""]}, "the rules are"),
        ({"strp": ["*"]}, "strp"),
        ({"merge": ["A"]}, "merge is no table"),
        ({"merge": {"A": "B", "B": "C"}}, "A counts as B, which counts as another"),
    ],
)
def test_rules_that_cannot_be_are_refused(rules, told):
    with pytest.raises(SignkinError, match=told):
        GlossRules.of(rules)


def test_the_hands_tiers_become_one_sequence():
    right = [interval(0, 1, "A", "R"), interval(2, 3, "B", "R"), interval(4, 5, "C", "R")]
    left = [
        interval(0.1, 1, "A", "L"),  # two-handed
        interval(2.1, 2.9, "HOLD", "L"),  # beside another sign
        interval(3.2, 3.8, "D", "L"),  # alone
        interval(4.9, 6, "E", "L"),  # a tenth of a second together is no simultaneous sign
    ]
    signs, left_out = signs_of_hands({"right": right, "left": left})
    assert [s.label for s in signs] == ["A", "B", "D", "C", "E"]
    assert [s.tier for s in signs] == ["R", "R", "L", "R", "L"]
    assert [(o.tier, o.reason) for o in left_out] == [
        ("L", "the left hand's, during 'B' of the dominant hand")
    ]
    signs, left_out = signs_of_hands({"right": right, "left": left}, dominant="left")
    assert [s.label for s in signs] == ["A", "HOLD", "D", "C", "E"]
    assert [o.place for o in left_out] == ["'B' at 2.000 s"]
    with pytest.raises(SignkinError, match="right, left or both"):
        signs_of_hands({"up": right})


def test_labels_of_frames_become_intervals():
    labels = ["", "A", "A", "B", "O", None, float("nan"), "B", "B"]
    out = labels_to_intervals(labels, 25, blank=("", "O"))
    assert [(i.label, i.start_s, i.end_s) for i in out] == [
        ("A", 0.04, 0.12), ("B", 0.12, 0.16), ("B", 0.28, 0.36),
    ]  # fmt: skip
    assert labels_to_intervals([], 25) == ()
    with pytest.raises(SignkinError, match="the rate is 0"):
        labels_to_intervals(["A"], 0)


def test_rules_are_applied_in_reading(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("start,end,label\n1,2,A*\n3,4,B\n")
    a = read_annotation(path, gloss={"strip": "*"}, from_s=0.5, to_s=2.5)
    assert [(i.label, i.as_written, i.start_s) for i in a.intervals] == [("A", "A*", 0.5)]
    assert len(a.left_out) == 1
    with pytest.raises(SignkinError, match=r"t\.csv, from_s, to_s: the excerpt"):
        read_annotation(path, from_s=3, to_s=1)
