"""Corpora of which much cannot be made: each table and page that can be is, the rest says why."""

import numpy as np
import pytest
import yaml

from signkin.tables import read_table
from signkin.unavailable import rows_of
from support.elan_rules import broken
from support.in_process import run_in_process
from support.less import LESS
from support.runs import MINI, RATE, mini_motion, prepare, signkin

# As the page of the corpus saves them.
RATINGS = """corpus,recording,start_s,end_s,gloss,rating,note
rated,m2,,,,exclude,"the signer laughs, twice"
rated,m1,3.000,3.600,CAKE,exclude,half a sign
rated,m3,,,,ok,looked at
"""
TAGGED = "recording,signer,motion,annotation\nm,s1,m.csv,t.csv\n"


def cells(text):
    lines = [line.split(",") for line in text.strip().splitlines()]
    return lines[0], lines[1:]


def blank(text, joint, first_s, end_s):
    """Return a motion in which a joint has no position for a while."""
    head, rows = cells(text)
    at = head.index(f"{joint}_x")
    for row in rows[round(first_s * RATE) : round(end_s * RATE)]:
        row[at : at + 3] = ["", "", ""]
    return "\n".join(",".join(row) for row in [head, *rows]) + "\n"


def tags(count):
    rows = (f"{k},{k + 0.6},{('CAKE', 'IX', 'NEW')[k % 3]}\n" for k in range(1, count + 1))
    return "start,end,gloss\n" + "".join(rows)


def describe(folder, name, recordings, files, **changes):
    """Write a corpus and its files. changes: of corpus.yaml; `annotation=None` for none."""
    corpus, data = folder / "corpora" / name, folder / "data" / name
    corpus.mkdir(parents=True)
    data.mkdir(parents=True)
    about = {**MINI, "data_folder": name, **changes}
    about["motion"] = {**MINI["motion"], **changes.get("motion", {})}
    (corpus / "corpus.yaml").write_text(yaml.safe_dump(about))
    (corpus / "recordings.csv").write_text(recordings)
    for file, text in files.items():
        (data / file).write_text(text)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A run of one-handed, gappy, flat and short corpora, and of one that has nothing usable."""
    folder = tmp_path_factory.mktemp("broken")
    joints = MINI["motion"]["joints"]
    one_hand = {name: columns for name, columns in joints.items() if name.startswith("right")}
    flat = {name: columns[::2] for name, columns in joints.items()}
    moved = mini_motion(12, 1)
    describe(folder, "one-hand", TAGGED, {"m.csv": moved, "t.csv": tags(9)},
             motion={"joints": one_hand})  # fmt: skip
    gappy = blank(blank(moved, "right_wrist", 2, 2.8), "left_wrist", 6, 6.8)
    describe(folder, "gappy", TAGGED, {"m.csv": gappy, "t.csv": tags(9)})
    describe(folder, "flat-one-sign", TAGGED, {"m.csv": mini_motion(4, 1), "t.csv": tags(1)},
             motion={"joints": flat, "orientations": "none"})  # fmt: skip
    single = "recording,signer,motion,sign,repetition\n"
    rows = [f"{g}{i},s1,{g}{i}.csv,{g},{i}" for g in "AB" for i in (1, 2)]
    files = {f"{g}{i}.csv": mini_motion(0.7, i) for g in "AB" for i in (1, 2)}
    describe(folder, "short-signs", single + "\n".join(rows) + "\n", files, annotation=None)
    lost = blank(blank(mini_motion(3, 1), "right_wrist", 1, 1.4), "left_wrist", 1, 1.4)
    describe(folder, "gap-in-sign", single + "A1,s1,A1.csv,A,1\n", {"A1.csv": lost},
             annotation=None)  # fmt: skip
    riddled = blank(moved, "right_wrist", 1, 9)
    describe(folder, "nothing", TAGGED, {"m.csv": riddled, "t.csv": tags(9)}, on_error="skip")
    several = "recording,signer,motion,annotation\n" + "".join(
        f"m{i},s{i},m{i}.csv,t.csv\n" for i in (1, 2, 3)
    )
    files = {"t.csv": tags(9), **{f"m{i}.csv": mini_motion(12, i) for i in (1, 2, 3)}}
    describe(folder, "rated", several, files)
    ratings = folder / "ratings-rated.csv"
    ratings.write_text(RATINGS)
    signkin("corpus", "rate", ratings.name, folder=folder)
    names = [path.name for path in (folder / "corpora").iterdir()]
    prepare(folder, corpora=sorted(names), **LESS)
    return folder, run_in_process(folder, folder / "data")


def lacks(run, corpus):
    """Return analysis -> reasons of what is not available."""
    rows = rows_of(run[0] / "results" / corpus / "not_available")
    assert not rows["reason"].str.contains("fault of signkin").any(), rows["reason"].tolist()
    return rows.groupby("analysis")["reason"].agg(set).to_dict()


def test_every_job_ends_and_the_report_is_there(run):
    folder, done = run
    assert not done[-1].failed, done[-1]
    assert "report" in {job.rule for job in done}
    page = (folder / "results/report/index.html").read_text(encoding="utf-8")
    assert "Analyses, or parts of them, not available (flat-one-sign, gap-in-sign, " in page
    assert "gap-in-sign: endres figures, fig01" in page
    own = (folder / "results/report/corpora/short-signs.html").read_text(encoding="utf-8")
    assert "no recording has a power-law ground truth" in own
    assert "nothing: recording m is left out." in page


def test_one_hand_has_all_that_one_hand_can_have(run):
    table = run[0] / "results/naert2017/one-hand"
    assert "left_wrist" not in str(lacks(run, "one-hand"))
    assert (table / "table2.csv").read_text().count("\n") > 2
    minima = (run[0] / "results/one-hand/minima.csv").read_text()
    assert ",right," in minima
    assert ",left," not in minima


def test_gaps_and_flat_data_leave_the_rest(run):
    found = lacks(run, "gappy")
    assert found["one wrist"] == {
        "one wrist: no recording has both a wrist in bins and a speed; expected one or more; "
        "wrists_left_out.csv and excluded.csv tell why not."
    }
    assert set(found) == {"one wrist"}
    flat = lacks(run, "flat-one-sign")
    assert "no transition that a model of duration can use" in str(flat["duration models"])
    signs = (run[0] / "results/naert2017/flat-one-sign/sign_types.csv").read_text()
    assert signs.count("\n") == 2


def test_short_and_torn_signs_say_why_they_have_no_ground_truth(run):
    short = lacks(run, "short-signs")
    assert "no recording has a power-law ground truth" in str(short["endres figures"])
    posteriors = run[0] / "results/endres2013/short-signs/order_posteriors.csv"
    assert posteriors.read_text().count("\n") > 5
    torn = lacks(run, "gap-in-sign")
    assert "no recording could be binned" in str(torn["endres figures"])


def test_a_corpus_without_a_usable_recording_does_not_end_the_run(run):
    reasons = {reason for some in lacks(run, "nothing").values() for reason in some}
    assert any("most_missing" in reason for reason in reasons), reasons
    assert np.all(["m.csv" not in reason or "wrist" in reason for reason in reasons])


def test_what_was_rated_exclude_is_left_out_of_the_next_run_counted_and_listed(run):
    results = run[0] / "results"
    excluded = read_table(results / "rated/excluded.csv", "excluded")
    assert excluded[["recording", "stage"]].to_numpy().tolist() == [["m2", "rating"]]
    about = read_table(results / "rated/recordings.csv", "recordings").set_index("recording")
    assert about["tags_left_out"].to_dict() == {"m1": 1, "m3": 0}
    assert about["signs"].to_dict() == {"m1": 8, "m3": 9}
    moves = read_table(results / "naert2017/rated/transitions.csv", "transitions")
    assert set(moves["recording"]) == {"m1", "m3"}
    front = (results / "report/index.html").read_text(encoding="utf-8")
    assert "rated: recording m2 is left out." in front and "the signer laughs, twice" in front
    assert "rated, m1: 1 tags left out." in front and "CAKE at 3.000 s: rated `exclude`" in front
    todo = read_table(results / "report/corpora/rated_todo.csv", "corpus_todo")
    assert "the signer laughs, twice" in str(todo["why"].tolist())
    # Each recording of the list has an ELAN file with a tier `check`.
    listed = set(todo.loc[todo["rank"] < 4, "recording"])
    files = {
        path.stem: path.read_bytes() for path in (results / "report/corpora").glob("rated_check/*")
    }
    assert set(files) == listed and all(broken(content) == [] for content in files.values())
    assert all(b'TIER_ID="check"' in content for content in files.values())
