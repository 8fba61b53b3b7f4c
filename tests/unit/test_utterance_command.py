"""`signkin utterance`: of one corpus, with the configuration asked for, whatever ails others."""

import shutil

import pytest
import yaml

from signkin import __main__ as command
from signkin.studies.naert2017.synthesis import speak as speaking


@pytest.fixture
def asked(root, tmp_path, monkeypatch):
    """A folder with a broken corpus beside a good one; what is asked of the workflow."""
    folder = tmp_path / "corpora" / "broken"
    folder.mkdir(parents=True)
    (folder / "corpus.yaml").write_text("title: [not closed")
    shutil.copytree(root / "corpora" / "lsf-sim", tmp_path / "corpora" / "lsf-sim")
    for name, cutoff in (("config.yaml", 6.0), ("other.yaml", 8.0)):
        config = {
            "corpora": ["broken", "lsf-sim"],
            "kinematics": {"lowpass": {"cutoff_hz": cutoff}},
        }
        (tmp_path / name).write_text(yaml.safe_dump(config))
    monkeypatch.chdir(tmp_path)
    calls = {}
    monkeypatch.setattr(
        command, "run_workflow", lambda extra, brief=False: calls.update(run=extra) or 0
    )

    def speak(corpus, glosses, name, changes, home, config):
        calls.update(
            glosses=glosses, plan=speaking._plan(corpus, changes, home, config), changes=changes
        )
        return ["done"]

    monkeypatch.setattr(speaking, "speak", speak)
    return calls


def test_another_corpus_that_is_broken_does_not_matter(asked, capsys):
    assert command.main(["utterance", "lsf-sim", "ONE-07 TWO-07"]) == 0
    assert capsys.readouterr().out == "done\n"
    assert asked["glosses"] == ["ONE-07", "TWO-07"] and set(asked["plan"].corpora) == {"lsf-sim"}
    assert asked["run"][:3] == ["--config", 'corpora=["lsf-sim"]', "--"]
    assert "results/lsf-sim/intervals.csv" in asked["run"][3:]
    assert command.main(["utterance", "broken", "A"]) == 1
    assert "broken" in capsys.readouterr().err


def test_the_configuration_asked_for_is_taken_by_the_run_and_by_the_utterance(asked, capsys):
    words = ["utterance", "lsf-sim", "A,B C", "--config", "other.yaml", "--method", "blending"]
    assert command.main(words) == 0
    assert asked["run"][:2] == ["--configfile", "other.yaml"]
    assert asked["plan"].settings.kinematics.lowpass.cutoff_hz == 8.0
    assert asked["plan"].settings.synthesis.method == "blending"
    assert asked["glosses"] == ["A", "B C"]
    assert command.main([*words[:3], "--config", "none.yaml"]) == 1
    assert "none.yaml" in capsys.readouterr().err
