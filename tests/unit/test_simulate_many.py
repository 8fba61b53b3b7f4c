"""A simulated corpus of any size: files that are read like any, and say what they are."""

from __future__ import annotations

import re

import pytest

from signkin.__main__ import main
from signkin.corpus import data_folder, load_corpus
from signkin.corpus_files import check_files
from signkin.stages.ingest import ingest


@pytest.mark.parametrize(("kind", "count"), [("signs", 6), ("tagged", 2)])
def test_what_is_written_is_read(kind, count, tmp_path, capsys):
    assert main(["simulate", str(tmp_path), "--recordings", str(count), "--kind", kind]) == 0
    corpus = load_corpus(tmp_path / "corpora" / kind)
    assert corpus.simulator == "signkin simulate"
    assert not corpus.made_by_run
    folder = data_folder(corpus, None, tmp_path / "results")
    assert folder == tmp_path / "corpora" / kind / "data"
    check_files(corpus, folder)
    assert [file for file in corpus.files() if not (folder / file).is_file()] == []
    read = ingest(corpus, folder, corpus.entries)
    assert len(read.recordings) == count
    assert not read.excluded
    assert (len(read.intervals) > 0) == (kind == "tagged")
    assert len({r.positions.tobytes() for r in read.recordings}) == count
    assert "no evidence about people" in corpus.settings["description"]
    assert main(["simulate", str(tmp_path), "--recordings", "1", "--kind", kind]) == 1
    assert "there is a corpus already" in capsys.readouterr().err


def test_no_recordings_are_refused(tmp_path, capsys):
    assert main(["simulate", str(tmp_path), "--recordings", "0"]) == 1
    assert capsys.readouterr().err.startswith("signkin: 0 recordings; expected 1 or more")
    assert not (tmp_path / "corpora").exists()


def test_more_recordings_than_the_disk_holds_are_refused(tmp_path, capsys):
    assert main(["simulate", str(tmp_path / "new" / "one"), "--recordings", "9" * 14]) == 1
    told = capsys.readouterr().err
    assert re.match(r"signkin: 9+ recordings take about \d+ GB; expected at most \d+, which", told)
    assert not (tmp_path / "new").exists()
