"""Every check's example has the outcome that is told, from a claim and from the command line."""

import json
import shlex

import pytest

from signkin.__main__ import main
from signkin.audit.commands import as_command, findings_of
from signkin.audit.findings import INCONSISTENT, summary
from signkin.audit.registry import ABOUT, PUBLISHED


def prepared(folder, name):
    about = ABOUT[name]
    if about.table:
        (folder / about.example["table"]).write_text(about.table)


@pytest.mark.parametrize("name", sorted(PUBLISHED))
def test_the_example_has_its_outcome(tmp_path, monkeypatch, capsys, name):
    prepared(tmp_path, name)
    findings = findings_of(name, dict(ABOUT[name].example), tmp_path)
    assert summary(findings) == ABOUT[name].outcome, findings
    assert not any(f.fault for f in findings)
    monkeypatch.chdir(tmp_path)
    words = shlex.split(as_command(name))
    assert words[:4] == ["signkin", "audit", "check", name]
    status = main([*words[1:], "--json"])
    told = json.loads(capsys.readouterr().out)
    assert status == (1 if ABOUT[name].outcome == INCONSISTENT else 0)
    assert [f["verdict"] for f in told] == [f.verdict for f in findings]


def test_the_list_tells_every_check_with_an_example(capsys):
    assert main(["audit", "list"]) == 0
    told = capsys.readouterr().out
    for name in PUBLISHED:
        assert f"\n{name}: " in told
        assert as_command(name) in told
    assert main(["audit", "list", "grim"]) == 0
    assert "grimmer" not in capsys.readouterr().out


@pytest.mark.parametrize(
    "words, sentence",
    [
        (["grimm", "--mean", "5.19"], "there is an unknown check 'grimm'"),
        (["grim", "--mean", "5.19"], "lacks grain"),
        (["grim", "--mean", "5.19", "--n", "28", "--grain", "x"], "'x' is no number"),
        (["grim", "--mean", "5.19", "--n", "2.5", "--grain", "1"], "n is '2.5'"),
        (["grim", "--mean", "5.19", "--n", "about 30", "--grain", "1"], "n is 'about 30'"),
        (["grim", "--mean", "5.19", "--m", "28", "--grain", "1"], "has no argument m"),
        (["grim", "mean", "5.19"], "the argument 'mean'"),
        (["grim", "--mean"], "--mean stands without a value"),
        (["grimmer", "--mean", "5.1", "--sd", "-1", "--n", "9", "--grain", "1"], "the SD is -1"),
        (["grim", "--table", "none.csv", "--grain", "1"], "there is no table none.csv"),
        (["p_value", "--kind", "t", "--statistic", "2", "--df", "9", "--p", "1.2"], "p is 1.2"),
        (["chi_squared", "--counts", "1,2;3", "--p", ".5"], "the counts make no table"),
        (["odds_ratio", "--counts", "1,2,3;3,4,5", "--odds_ratio", "2"], "expected 2 x 2"),
    ],
)  # fmt: skip
def test_bad_arguments_are_one_sentence(capsys, words, sentence):
    assert main(["audit", "check", *words]) == 1
    told = capsys.readouterr()
    assert sentence in told.err
    assert told.err.count("\n") == 1
