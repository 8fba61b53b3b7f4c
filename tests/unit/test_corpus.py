import hashlib
import shutil
from typing import get_args

import pytest
import yaml

from signkin import SignkinError
from signkin.corpus import (
    data_folder,
    load_corpora,
    load_corpus,
)
from signkin.corpus_checksums import check_checksum
from signkin.corpus_files import check_files
from signkin.io import annotation_formats, motion_formats
from signkin.settings.corpus import Annotation, Motion

SETTINGS = {
    "title": "t", "language": "l", "licence": "none", "citation": "c", "noise_sd": 0.001,
    "motion": {
        "format": "csv", "unit": "m", "rate_hz": 50,
        "joints": {"right_wrist": ["a", "b"], "left_wrist": ["c", "d"]},
    },
    "annotation": {"format": "csv", "sign_tier": "sign"},
}  # fmt: skip


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "mine").mkdir()
    write(tmp_path / "mine")
    return tmp_path / "mine"


def write(folder, settings=None, recordings=None, signs=None):
    (folder / "corpus.yaml").write_text(yaml.safe_dump(settings or SETTINGS))
    rows = recordings or "recording,signer,motion,annotation\nr1,s1,m.csv,a.csv\n"
    (folder / "recordings.csv").write_text(rows)
    (folder / "signs.csv").write_text(signs or "gloss,hands,symmetric\nCAKE,1,1\nIX,0,0\n")


def changed(**changes):
    settings = yaml.safe_load(yaml.safe_dump(SETTINGS))
    for path, value in changes.items():
        *parents, key = path.split("__")
        place = settings
        for parent in parents:
            place = place[parent]
        if value is None:
            del place[key]
        else:
            place[key] = value
    return settings


def test_a_corpus_as_it_should_be(folder):
    corpus = load_corpus(folder)
    assert corpus.lexicon == {"CAKE": "11", "IX": "00"}
    assert corpus.entries[0].line == 2
    assert corpus.files() == ["m.csv", "a.csv"]
    assert corpus.tagged
    assert corpus.unit == "m"
    assert load_corpora(folder.parent).keys() == {"mine"}


def test_a_corpus_of_single_signs_has_a_sign_in_every_row(folder):
    assert not load_corpus(folder).single_signs
    write(folder, recordings=SINGLE + "r1,s1,m,a,CAKE,1\nr2,s1,n,a,CAKE,2\n")
    corpus = load_corpus(folder)
    assert corpus.single_signs
    assert [(e.sign, e.repetition) for e in corpus.entries] == [("CAKE", 1), ("CAKE", 2)]
    assert corpus.by_name["r2"].line == 3
    assert corpus.noise_sd == 0.001
    write(folder, recordings=SINGLE + "r1,s1,m,a,CAKE,1\nr2,s1,n,a,,\n")
    assert not load_corpus(folder).single_signs


@pytest.mark.parametrize(
    "recordings",
    [
        "recording;signer;motion;annotation;from_s\nr1;s;m;a;1,5\n",
        "recording\tsigner\tmotion\tannotation\tfrom_s\nr1\ts\tm\ta\t1.5\n",
        "sep=;\nrecording;signer;motion;annotation;from_s\n;;;;\nr1;s;m;a;1,5\n",
        "\ufeffRecording, Signer, Motion, Annotation, From s\r\nr1, s, m, a, 1.5\r\n",
        "recording,signer,motion,annotation,from_s,\nr1,s,m,a,1.5,\n\n,,,,,\n",
    ],
)
def test_tables_as_spreadsheets_save_them(folder, recordings):
    write(folder, recordings=recordings)
    (entry,) = load_corpus(folder).entries
    assert (entry.recording, entry.signer, entry.motion, entry.from_s) == ("r1", "s", "m", 1.5)


def test_a_gloss_without_a_type_is_a_question(folder):
    (folder / "signs.csv").write_text("gloss,hands,symmetric\nA,,\nB,1,1\n", encoding="utf-8")
    assert load_corpus(folder).lexicon == {"B": "11"}
    (folder / "signs.csv").write_text("gloss,hands,symmetric\nA,1,\n", encoding="utf-8")
    with pytest.raises(SignkinError, match="line 2: A has half a type"):
        load_corpus(folder)
    twice = "gloss,hands,symmetric\n\u00c4,0,0\nA\u0308,1,0\n"
    (folder / "signs.csv").write_text(twice, encoding="utf-8")
    with pytest.raises(SignkinError, match="line 3: gloss '\u00c4' stands in line 2"):
        load_corpus(folder)


def test_the_shipped_corpora_are_right(root):
    corpora = load_corpora(root / "corpora")
    single = {name for name, corpus in corpora.items() if corpus.single_signs}
    assert single == {"auslan-hq", "isl-kinect", "isl-sim"}
    assert set(corpora) >= {"lsf-sim", "dgs-1984189", "boston104", "libras"}
    assert len(corpora["boston104"].entries) == 201
    for corpus in corpora.values():
        assert corpus.settings["citation"] and corpus.settings["licence"]
        assert corpus.simulator or set(corpus.settings["checksums"]) == set(corpus.files())
    assert corpora["lsf-sim"].simulator == "lsf-sim"


def test_formats_of_the_model_are_those_that_can_be_read():
    assert set(get_args(Motion.model_fields["format"].annotation)) == set(motion_formats())
    assert set(get_args(Annotation.model_fields["format"].annotation)) == set(annotation_formats())


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        (
            changed(motion__unit="ell"),
            r"corpus.yaml, key motion.unit: 'ell'",
        ),
        (changed(noise_sd=None), r"corpus.yaml, key noise_sd: the key noise_sd is missing"),
        (changed(motion__rate_hz=0), r"key motion.rate_hz: 0; expected greater than 0"),
        (changed(motion__rates=3), r"no key motion.rates; expected motion.rate_hz"),
        (
            changed(motion__joints={"right_wrist": "a", "left_hand_wrist": "b"}),
            r"the joint 'left_hand_wrist' is not in the vocabulary; expected one of pelvis",
        ),
        (
            changed(motion__joints={"right_elbow": "a", "nose": "b"}),
            r"no joint right_wrist and no joint left_wrist; expected both wrists, or one",
        ),
        (
            changed(annotation__utterance_tier="u", annotation__utterance_gap_s=1),
            r"key annotation",
        ),
    ],
)
def test_a_wrong_corpus_yaml_names_the_key(folder, settings, told):
    write(folder, settings)
    with pytest.raises(SignkinError, match=told):
        load_corpus(folder)


def test_yaml_that_is_none_names_the_line(folder):
    (folder / "corpus.yaml").write_text("title: x\nlanguage: [a\n")
    with pytest.raises(SignkinError, match=r"corpus.yaml, line 3"):
        load_corpus(folder)
    (folder / "corpus.yaml").unlink()
    with pytest.raises(SignkinError, match="there is no such file"):
        load_corpus(folder)


HEAD = "recording,signer,motion,annotation\n"
SINGLE = "recording,signer,motion,annotation,sign,repetition\n"


@pytest.mark.parametrize(
    ("recordings", "told"),
    [
        (HEAD + "r1,s,m,a\nr1,s,m2,a2\n", r"line 3: recording 'r1' stands in line 2 already"),
        (HEAD + "r 1,s,m,a\n", r"recordings.csv, line 2, key recording: 'r 1' does not match"),
        (HEAD + "r1,,m,a\n", r"line 2, key signer"),
        (HEAD + "r1,s,m\n", r"line 2: the row has more or fewer cells"),
        (HEAD + "r1,s,m,\n", r"line 2: no annotation file"),
        ("recording,signer,signer,motion,annotation\nr1,s,t,m,a\n", "line 1: .*'signer' stands tw"),
        (HEAD + 'r1,"s,m,a\n', "line 2: not readable as CSV"),
        (HEAD + 'r1,"s\nt",m,a\n', "line 2, column signer: a line break"),
        (HEAD + "r1,s,m,a\nr2,s,m,a\n", r"line 3: r2 is r1 \(line 2\) once more"),
        (HEAD.strip() + ",from_s,to_s\nr1,s,m,a,5,2\n", "line 2: from_s 5, to_s 2"),
        (HEAD, r"no recording; expected one row a recording"),
        (
            "recording,signer,motion,annotation,colour\nr1,s,m,a,red\n",
            r"line 2: Additional propert",
        ),
        (SINGLE + "r1,s,m,a,CAKE,0\n", r"line 2, key repetition: '0' does not .*from 1"),
        (SINGLE + "r1,s,m,a,,1\n", r"line 2: repetition 1 without a sign"),
        (
            SINGLE + "r1,s,m,a,CAKE,1\nr2,t,n,a,CAKE,1\nr3,s,o,a,CAKE,1\n",
            r"line 4: repetition 1 of 'CAKE' by s stands in line 2 already",
        ),
    ],
)
def test_a_wrong_recordings_csv_names_the_line(folder, recordings, told):
    write(folder, recordings=recordings)
    with pytest.raises(SignkinError, match=told):
        load_corpus(folder)


@pytest.mark.parametrize(
    ("signs", "told"),
    [
        ("CAKE,1,1\nCAKE,0,0\n", r"signs.csv, line 3: gloss 'CAKE' stands in line 2 already"),
        ("CAKE,3,0\n", r"line 2, key hands: '3' is not one of .*expected 0 \(one hand\)"),
        ("CAKE,0,1\n", r"line 2: CAKE is symmetric with hands = 0"),
        ("CAKE,2,1\n", r"line 2: CAKE is symmetric with hands = 2"),
    ],
)
def test_a_wrong_signs_csv_names_the_line(folder, signs, told):
    write(folder, signs="gloss,hands,symmetric\n" + signs)
    with pytest.raises(SignkinError, match=told):
        load_corpus(folder)


def test_data_are_found_in_data_dir_or_beside_the_corpus(folder, tmp_path):
    corpus = load_corpus(folder)
    assert data_folder(corpus, None, tmp_path) is None
    (tmp_path / "data" / "mine").mkdir(parents=True)
    assert data_folder(corpus, tmp_path / "data", tmp_path) == tmp_path / "data" / "mine"
    (folder / "data").mkdir()
    assert data_folder(corpus, None, tmp_path) == folder / "data"


def test_missing_and_changed_files_are_named(folder, tmp_path):
    data = tmp_path / "data"
    data.mkdir()
    (data / "m.csv").write_text("x")
    with pytest.raises(SignkinError, match=r"recordings.csv, line 2: there is no file .*a.csv"):
        check_files(load_corpus(folder), data)
    right = hashlib.sha256(b"x").hexdigest()
    write(folder, changed(checksums={"m.csv": right}))
    check_checksum(load_corpus(folder), data, "m.csv")
    (data / "m.csv").write_text("y")
    with pytest.raises(SignkinError, match=rf"the SHA-256 of m.csv is .*; expected {right}"):
        check_checksum(load_corpus(folder), data, "m.csv")


def test_an_unknown_corpus_lists_the_known_ones(folder):
    with pytest.raises(SignkinError, match="no corpus yours; expected mine"):
        load_corpora(folder.parent, ["yours"])
    shutil.rmtree(folder)
    with pytest.raises(SignkinError, match="there is no such folder"):
        load_corpora(folder)


def test_a_missing_file_of_an_annotator_is_named(folder, tmp_path):
    data = tmp_path / "data"
    data.mkdir()
    for name in ("m.csv", "a.csv"):
        (data / name).write_text("x")
    annotation = load_corpus(folder).settings["annotation"]
    annotators = {"second": {"file": "{recording}-second.eaf"}}
    write(folder, changed(annotation={**annotation, "annotators": annotators}))
    corpus = load_corpus(folder)
    recording = corpus.entries[0].recording
    with pytest.raises(SignkinError) as refused:
        check_files(corpus, data)
    told = str(refused.value)
    assert told.startswith(
        f"{folder / 'corpus.yaml'}, key annotation.annotators.second, {recording}: "
    )
    assert f"there is no file {data / recording}-second.eaf; expected the annotator's file" in told
    (data / f"{recording}-second.eaf").write_text("x")
    check_files(corpus, data)
    write(folder, changed(annotation={**annotation, "annotators": annotators}, on_error="skip"))
    (data / f"{recording}-second.eaf").unlink()
    check_files(load_corpus(folder), data)
