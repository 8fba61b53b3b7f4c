"""Ratings of the owner: from the page's CSV into the corpus, and from there into the next run."""

import shutil

import pytest

from signkin.annotation import Annotation, Interval
from signkin.corpus import load_corpus
from signkin.errors import SignkinError
from signkin.ratings import put, read_ratings, tag_ratings
from signkin.stages.ingest import _without_excluded, rated_row
from signkin.survey.commands import rate_corpora

HEAD = "corpus,recording,start_s,end_s,gloss,rating,note\n"


@pytest.fixture
def folder(root, tmp_path):
    return shutil.copytree(root / "corpora" / "lsf-sim", tmp_path / "corpora" / "lsf-sim")


@pytest.fixture
def saved(tmp_path):
    path = tmp_path / "ratings-lsf-sim.csv"
    path.write_text(
        HEAD + 'lsf-sim,lsf-sim-2,,,,exclude,"the left hand ""jumps"", see 3 s"\n'
        "lsf-sim,lsf-sim-1,1.830,2.150,ONE-06,exclude,cut off\n"
        "lsf-sim,lsf-sim-1,2.380,2.960,TWO-01,ok,\n",
        encoding="utf-8",
    )
    return path


def test_the_pages_csv_goes_into_the_corpus_and_is_read_by_the_next_run(folder, saved, monkeypatch):
    monkeypatch.chdir(folder.parents[1])
    before = load_corpus(folder)
    assert rate_corpora(saved) == 0
    corpus = load_corpus(folder)
    assert [e.recording for e in corpus.entries] == [e.recording for e in before.entries]
    entry = corpus.by_name["lsf-sim-2"]
    assert (entry.rating, entry.rating_note) == ("exclude", 'the left hand "jumps", see 3 s')
    row = rated_row(corpus, entry)
    assert row["stage"] == "rating" and "jumps" in row["reason"]
    # The tag is gone, and told; the one rated ok stays.
    signs = (Interval(1.83, 2.15, "ONE-06", "sign"), Interval(2.38, 2.96, "TWO-01", "sign"))
    twin = Interval(1.83, 2.15, "ONE-06", "utterance")
    annotation = Annotation(name="lsf-sim-1", intervals=(*signs, twin))
    left = _without_excluded(corpus, corpus.by_name["lsf-sim-1"], annotation)
    assert set(left.intervals) == {signs[1], twin}
    assert "ONE-06 at 1.830 s: rated `exclude`: cut off" in str(left.left_out[0])


def test_a_rating_replaces_the_one_before_and_an_empty_one_takes_it_back(folder, saved):
    put(read_ratings(saved)["lsf-sim"], folder)
    again = saved.with_name("again.csv")
    again.write_text(
        HEAD + "lsf-sim,lsf-sim-2,,,,,\nlsf-sim,lsf-sim-1,1.830,2.150,ONE-06,check,look\n",
        encoding="utf-8",
    )
    put(read_ratings(again)["lsf-sim"], folder)
    assert load_corpus(folder).by_name["lsf-sim-2"].rating == ""
    kept = {r.gloss: r.rating for r in tag_ratings(folder)["lsf-sim-1"]}
    assert kept == {"ONE-06": "check", "TWO-01": "ok"}
    once = (folder / "recordings.csv").read_bytes()
    put(read_ratings(again)["lsf-sim"], folder)
    assert (folder / "recordings.csv").read_bytes() == once


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("recording,rating\nlsf-sim-1,ok\n", "columns recording, rating"),
        (HEAD + "lsf-sim,lsf-sim-1,,,,perhaps,\n", "line 2: the rating 'perhaps'"),
        (HEAD + "lsf-sim,lsf-sim-1,soon,,X,ok,\n", "start_s is 'soon'"),
        (HEAD + "lsf-sim,lsf-sim-1,ok\n", "more or fewer cells"),
        (HEAD + "lsf-sim,lsf-sim-9,,,,ok,\n", "no recording lsf-sim-9"),
    ],
)
def test_what_is_no_rating_is_told_with_its_place(folder, saved, text, told):
    saved.write_text(text, encoding="utf-8")
    with pytest.raises(SignkinError, match=told):
        put(read_ratings(saved)["lsf-sim"], folder)
