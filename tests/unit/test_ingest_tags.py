"""Tags of a corpus on their way into tables: hands, excerpts, glosses, what is left out."""

import pytest
import yaml

from signkin import SignkinError, tables
from signkin.corpus import load_corpus
from signkin.stages.ingest import ingest, tags_of

SETTINGS = {
    "title": "t", "language": "l", "licence": "none", "citation": "c", "noise_sd": 0.001,
    "motion": {
        "format": "csv", "unit": "m", "rate_hz": 10,
        "joints": {"right_wrist": ["a", "b", "c"], "left_wrist": ["d", "e", "f"]},
    },
}  # fmt: skip
TABLE = (
    "start,end,label,tier,who\n"
    "0.5,1.0,A*,right,S1\n0.5,1.0,A*,left,S1\n1.2,1.6,HOLD,left,S1\n1.2,1.8,B,right,S1\n"
    "2.0,2.2,C,left,S1\n3.0,3.0,D,right,S1\n0.0,9.0,hello,text,S1\n4,5,Z,right,S2\n"
    "12.5,13.5,LATE,right,S1\n"
)


def corpus(tmp_path, annotation, recordings="r,s1,m.csv,t.csv", columns="", **more):
    folder = tmp_path / "mine"
    folder.mkdir(exist_ok=True)
    settings = {**SETTINGS, **more, "annotation": annotation}
    (folder / "corpus.yaml").write_text(yaml.safe_dump(settings))
    head = f"recording,signer,motion,annotation{columns}"
    (folder / "recordings.csv").write_text(f"{head}\n{recordings}\n")
    frames = "".join(f"{i},0,0,0,{i},0\n" for i in range(100))
    for name in ("m.csv", "n.csv"):
        (folder / name).write_text(f"a,b,c,d,e,f\n{frames}")
    (folder / "t.csv").write_text(TABLE)
    made = load_corpus(folder)
    return ingest(made, folder, made.entries)


def of_role(out, role="sign"):
    rows = out.table("intervals")
    return [(r.label, r.start_s, r.end_s) for r in rows[rows["role"] == role].itertuples()]


BY_HAND = {
    "format": "csv",
    "sign_tiers": {"right": {"pattern": "right", "participant": "S1"}, "left": "left"},
    "utterance_tier": "text",
    "gloss": {"strip": ["*"]},
    "options": {"tier_column": "tier", "participant_column": "who"},
}
CUT = {"recordings": "r,s1,m.csv,t.csv,0,9", "columns": ",from_s,to_s"}


def test_both_hands_are_one_sequence_and_what_is_left_out_is_told(tmp_path):
    out = corpus(tmp_path, BY_HAND, **CUT)
    assert of_role(out) == [("A", 0.5, 1.0), ("B", 1.2, 1.8), ("C", 2.0, 2.2)]
    assert out.table("intervals")["written"].tolist()[:2] == ["A*", "B"]
    about = out.table("recordings").iloc[0]
    assert about["signs"] == 3 and about["tags_left_out"] == 3
    assert "'D' has no length" in about["tags_note"]
    assert "'LATE' at 12.500 s: outside the excerpt" in about["tags_note"]
    assert "the left hand's, during 'B' of the dominant hand" in about["tags_note"]
    assert list(out.table("recordings").columns) == tables.TABLES["recordings"].names()
    assert [i.label for i in tags_of(out.table("intervals"), "r")] == ["A*", "B", "C", "hello"]


def test_a_left_handed_signers_left_hand_comes_first(tmp_path):
    out = corpus(tmp_path, BY_HAND, left_handed=["s1"], **CUT)
    assert of_role(out) == [("A", 0.5, 1.0), ("HOLD", 1.2, 1.6), ("C", 2.0, 2.2)]


def test_an_excerpt_of_a_longer_transcript(tmp_path):
    columns = ",from_s,to_s,clock_offset_s"
    out = corpus(tmp_path, BY_HAND, "r,s1,m.csv,t.csv,1,9,0.5", columns)
    assert of_role(out) == [("B", 0.7, 1.3), ("C", 1.5, 1.7)]
    assert of_role(out, "utterance") == [("hello", 0.5, 8.5)]  # cut at the excerpt's ends
    assert out.table("recordings")["clock_offset_s"].tolist() == [-0.5]


def test_tags_after_the_motion_hint_at_excerpts(tmp_path):
    with pytest.raises(SignkinError, match=r"end after the motion.*tell from_s and to_s in"):
        corpus(tmp_path, BY_HAND)


def test_tiers_by_the_recordings_own_words(tmp_path):
    annotation = {
        "format": "csv",
        "sign_tier": {"pattern": "r*", "participant": "{part}"},
        "options": {"tier_column": "tier", "participant_column": "who"},
    }
    rows = "r1,s1,m.csv,t.csv,S1,9\nr2,s2,n.csv,t.csv,S2,9"
    out = corpus(tmp_path, annotation, rows, ",part,to_s")
    assert of_role(out) == [("A*", 0.5, 1.0), ("B", 1.2, 1.8), ("Z", 4, 5)]


def test_two_parts_of_one_annotation_never_get_the_same_tags(tmp_path):
    options = {"tier_column": "tier"}
    annotation = {"format": "csv", "sign_tier": "right", "options": options}
    rows = "r1,s1,m.csv,t.csv,S1,0,9\nr2,s2,n.csv,t.csv,S2,0,9"
    with pytest.raises(SignkinError, match=r"line 3: r2 and r1 are parts of t.csv and would get"):
        corpus(tmp_path, annotation, rows, ",part,from_s,to_s")
    excerpts = "r1,s1,m.csv,t.csv,1,0,3\nr2,s1,n.csv,t.csv,2,3,9"
    out = corpus(tmp_path, annotation, excerpts, ",part,from_s,to_s")
    assert of_role(out) == [("A*", 0.5, 1.0), ("B", 1.2, 1.8), ("Z", 1, 2)]


def test_labels_of_frames_count_in_the_motions_rate(tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "f.csv").write_text("gloss\n\nA\nA\nB\n")
    out = corpus(tmp_path, {"format": "frame_labels", "sign_tier": "gloss"}, "r,s1,m.csv,f.csv")
    assert of_role(out) == [("A", 0.1, 0.3), ("B", 0.3, 0.4)]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"sign_tier": "x"}, r"key annotation: .*sign_tier or sign_tiers, one of them"),
        ({"sign_tiers": {"middle": "x"}}, "key annotation.sign_tiers.middle: there is no key"),
        ({"sign_tiers": {}}, "a tier for right, left or both"),
        ({"options": {"unalined": "refuse"}}, "no option 'unalined'; csv has encoding, rate_hz"),
        ({"options": {"tier_column": 5}}, "option tier_column: should be a valid string"),
        ({"gloss": {"strip": "*"}}, "key annotation.gloss.strip"),
    ],
)
def test_mistakes_in_corpus_yaml_are_told_with_their_key(tmp_path, change, told):
    with pytest.raises(SignkinError, match=rf"corpus.yaml, .*{told}"):
        corpus(tmp_path, {**BY_HAND, **change}, **CUT)


def test_a_recording_without_a_sign_is_refused_or_skipped(tmp_path):
    options = {"tier_column": "tier"}
    annotation = {"format": "csv", "sign_tier": "right", "options": options}
    bad = "r,s1,m.csv,t.csv,0,9\nlate,s1,m.csv,t.csv,20,30"
    with pytest.raises(SignkinError, match="no interval lies between 20 s and 30 s"):
        corpus(tmp_path, annotation, bad, ",from_s,to_s")
    out = corpus(tmp_path, annotation, bad, ",from_s,to_s", on_error="skip")
    assert [row["recording"] for row in out.excluded] == ["late"]
