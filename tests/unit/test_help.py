"""The help of every command: an example in each."""

import contextlib

import pytest

from signkin.__main__ import main

COMMANDS = (
    [], ["run"], ["utterance"], ["corpus"], ["corpus", "list"], ["corpus", "check"],
    ["corpus", "rate"], ["corpus", "init"], ["corpus", "fetch"], ["score"], ["compare"], ["verify"],
    ["simulate"], ["audit"], ["audit", "init"], ["audit", "list"],
)  # fmt: skip


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_the_help_of_every_command_has_an_example(words, capsys):
    with contextlib.suppress(SystemExit):
        main([*words, "--help"])
    told = capsys.readouterr().out
    example = " ".join(["signkin", *words])
    assert told.count(example) > told.count("usage: " + example)
