"""Each kind of bad input: one sentence, exit status not 0, nothing that counts as done."""

import re

import pytest
import yaml

from signkin import tables
from support.less import LESS
from support.runs import MINI, checked, prepare, run, write_mini


def sentence(done):
    """Return the lines that signkin itself printed; the last word on which step failed is apart."""
    lines = [line for line in done.text.splitlines() if line.startswith("signkin: ")]
    return [line for line in lines if not line.startswith("signkin: the step ")]


def told(text):
    return re.compile(text.replace("...", ".*"))


def edit(name, change):
    """Return a spoiler that rewrites a data file."""

    def spoil(corpus, data):
        path = data / name
        path.write_text(change(path.read_text()))

    return spoil


def riddle(text, frames=25):
    """Blank the right wrist in every other stretch, by itself half a second."""
    lines = text.splitlines()
    column = lines[0].split(",").index("right_wrist_x")
    for i in range(1, len(lines)):
        if (i // frames) % 2:
            cells = lines[i].split(",")
            cells[column : column + 3] = ["", "", ""]
            lines[i] = ",".join(cells)
    return "\n".join(lines) + "\n"


def unknown_joint(corpus, data):
    settings = yaml.safe_load((corpus / "corpus.yaml").read_text())
    settings["motion"]["joints"]["right_hand"] = ["right_wrist_x", "right_wrist_y"]
    (corpus / "corpus.yaml").write_text(yaml.safe_dump(settings))


def rate_of_zero(corpus, data):
    text = (corpus / "corpus.yaml").read_text()
    (corpus / "corpus.yaml").write_text(text.replace("rate_hz: 50", "rate_hz: 0"))


def doubled_gloss(corpus, data):
    (corpus / "signs.csv").write_text("gloss,hands,symmetric\nCAKE,1,1\nCAKE,0,0\n")


def as_elan(corpus, data):
    """Turn the second annotation into ELAN with one tier, and ask for another."""
    settings = yaml.safe_load((corpus / "corpus.yaml").read_text())
    settings["annotation"] = {"format": "eaf", "sign_tier": "Glosses"}
    (corpus / "corpus.yaml").write_text(yaml.safe_dump(settings))
    from pathlib import Path

    from signkin import Interval
    from signkin.io.eaf import write_eaf

    for i in (1, 2):
        write_eaf(
            Path(data / f"t{i}.csv"), author="t", date="2020", media_url="v.mp4",
            tiers=[("Gloss", None, [Interval(1, 2, "A", "Gloss"), Interval(3, 4, "B", "Gloss")])],
        )  # fmt: skip


def as_bvh(corpus, data):
    settings = yaml.safe_load((corpus / "corpus.yaml").read_text())
    settings["motion"] = {
        "format": "bvh", "unit": "cm", "joints": {"right_wrist": "A", "left_wrist": "B"},
    }  # fmt: skip
    (corpus / "corpus.yaml").write_text(yaml.safe_dump(settings))
    head = "HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    head += "JOINT B\n{\nOFFSET 1 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\n}\n"
    rows = "0 0 0 0 0 0\n" * 6
    (data / "m1.csv").write_text(f"{head}MOTION\nFrames: 900\nFrame Time: 0.02\n{rows}")


def as_pose(corpus, data):
    settings = yaml.safe_load((corpus / "corpus.yaml").read_text())
    settings["motion"] = {
        "format": "pose", "joints": {"right_wrist": "P.R", "left_wrist": "P.L"},
    }  # fmt: skip
    (corpus / "corpus.yaml").write_text(yaml.safe_dump(settings))
    (data / "m1.csv").write_bytes(b"\x00\x00\x20\x3e truncated")


CASES = {
    "unknown tier": (as_elan, r"t1.csv, tiers: no tier 'Glosses'; expected Gloss. Tier names are"),
    "unknown joint": (unknown_joint, r"key motion.joints: the joint 'right_hand' is not in the"),
    "tags past the end": (
        edit("t2.csv", lambda t: t + "12.50,13.10,LATE\n"),
        r"t2.csv, tier sign, 'LATE': 1 intervals end after the motion, the last at 13.100 s; "
        r"expected no time after 12.000 s",
    ),
    "riddled wrist": (
        edit("m1.csv", riddle),
        r"recording m1, joint right_wrist: 50% of the frames have no position...at most 20%",
    ),
    "rate of 0": (rate_of_zero, r"corpus.yaml, key motion.rate_hz: 0; expected greater than 0"),
    "truncated bvh": (as_bvh, r"m1.csv, line 20: 6 frames, where the header says 900"),
    "truncated pose": (as_pose, r"m1.csv, 14 bytes: not readable as a .pose file"),
    "doubled gloss": (doubled_gloss, r"signs.csv, line 3: gloss 'CAKE' stands in line 2 already"),
    "missing file": (
        lambda corpus, data: (data / "t2.csv").unlink(),
        r"recordings.csv, line 3: there is no file ...t2.csv; expected the recording's file",
    ),
}  # fmt: skip


# Found when a corpus is read in: one run for all of them. The others end a run of their own.
READ_IN = ("unknown tier", "tags past the end", "truncated bvh", "truncated pose")


def written(folder):
    return {path.name for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("case", [case for case in CASES if case not in READ_IN])
def test_bad_input_is_one_sentence_and_leaves_nothing_done(mini, case):
    spoil, expected = CASES[case]
    folder, data = mini(spoil)
    done = run(folder, data=data)
    assert done.status != 0
    lines = sentence(done) or [x for x in done.text.splitlines() if "signkin: " in x]
    assert len(lines) == 1, done.text
    assert told(expected).search(lines[0]), lines[0]
    assert "Traceback" not in done.text
    results = folder / "results"
    assert not (results / "report").exists()
    # No table or recording that the failing step was to write.
    if case == "riddled wrist":
        assert not written(results) & {"minima.csv", "plausibility.csv"}
    else:
        assert not written(results) & {"0001.parquet", "intervals.csv"}


@pytest.fixture(scope="module")
def read_in(tmp_path_factory):
    """A run of a corpus for each of READ_IN, which goes on with the others when one fails."""
    base = tmp_path_factory.mktemp("read_in")
    names = [case.replace(" ", "-") for case in READ_IN]
    folder = prepare(base / "run", corpora=names)
    for case, name in zip(READ_IN, names, strict=True):
        CASES[case][0](*write_mini(folder, base / "data", name, data_folder=name))
    wanted = [f"results/{name}/shards/0001/minima.csv" for name in names]
    return run(folder, "--keep-going", "--", *wanted, data=base / "data")


@pytest.mark.parametrize("case", READ_IN)
def test_what_cannot_be_read_in_is_one_sentence_and_leaves_nothing_done(read_in, case):
    assert read_in.status != 0
    lines = sentence(read_in)
    assert len(lines) == len(READ_IN), read_in.text
    own = [line for line in lines if f"/{case.replace(' ', '-')}/" in line]
    assert len(own) == 1 and told(CASES[case][1]).search(own[0]), lines
    assert "Traceback" not in read_in.text
    assert not written(read_in.results / case.replace(" ", "-"))


@pytest.fixture(scope="module")
def two(tmp_path_factory):
    """A run of two mini corpora: one with a gloss that never occurs, one of 400 Hz with a gap."""
    base = tmp_path_factory.mktemp("two")
    folder = prepare(base / "run", corpora=["fast", "mini"], **LESS)
    corpus, _ = write_mini(folder, base / "data")
    (corpus / "signs.csv").write_text("gloss,hands,symmetric\nCAKE,1,1\nCAKES,1,1\n")
    fast = yaml.safe_load(yaml.safe_dump(MINI))
    fast["motion"]["rate_hz"] = 400
    fast |= {"on_error": "skip", "title": "Fast", "data_folder": "fast"}
    corpus, data = write_mini(folder, base / "data", "fast", **fast)
    edit("m1.csv", lambda text: riddle(text, 200))(corpus, data)  # half a second at 400 Hz
    for i in (1, 2):
        path = data / f"t{i}.csv"
        lines = path.read_text().splitlines()
        cells = [line.split(",") for line in lines[1:]]
        rows = [f"{float(a) / 8:.4f},{float(b) / 8:.4f},{g}" for a, b, g in cells]
        path.write_text("\n".join([lines[0], *rows]) + "\n")
    return checked(run(folder, data=base / "data"))


def test_a_mini_corpus_runs_to_its_report(two):
    """And tells of a gloss in signs.csv that never occurs."""
    moves = tables.read_table(two.results / "naert2017/mini/transitions.csv", "transitions")
    whole = moves[(moves["hand"] == "both")]
    assert len(whole) == 16
    assert set(whole["type_source"]) == {"kinematic"}  # one of two signs is not in signs.csv
    assert whole["geodesic_rad"].notna().all()
    lexicon = tables.read_table(two.results / "naert2017/mini/lexicon.csv", "lexicon")
    notes = lexicon.set_index("gloss")["note"].to_dict()
    assert notes["CAKES"].startswith("occurs in no recording")
    assert notes["IX"].startswith("not in signs.csv")
    assert notes["CAKE"] == ""
    page = (two.results / "report/index.html").read_text(encoding="utf-8")
    assert "real recordings" in page
    paper = (two.results / "report/papers/naert2017.html").read_text(encoding="utf-8")
    assert "limb and palm frames" in paper
    assert "signs.csv has 1 glosses that occur in no recording: CAKES" in page


def test_bad_recordings_and_implausible_rates_are_told_in_the_report(two):
    """A recording without a wrist is left out where the corpus allows; 400 Hz cannot be."""
    excluded = tables.read_table(two.results / "fast/excluded.csv", "excluded")
    assert excluded["recording"].tolist() == ["m1"]
    assert excluded["stage"].tolist() == ["wrists"]
    moves = tables.read_table(two.results / "naert2017/fast/transitions.csv", "transitions")
    assert set(moves["recording"]) == {"m2"}
    page = (two.results / "report/index.html").read_text(encoding="utf-8")
    assert "fast: recording m1 is left out." in page
    assert "wrist speed, 99th percentile is implausible in" in page
    assert "no hand moves so fast" in page


def test_a_data_folder_that_is_not_there_is_told(mini, tmp_path):
    folder, _ = mini()
    done = run(folder, data=tmp_path / "nowhere")
    assert done.status != 0
    assert "signkin: data_dir: there is no folder" in done.text
