"""The numbers that programs of tools/ write into docs/interpretations.md, as far as can be told."""

import importlib

import pytest

from tools import marked, numbers, simulated


@pytest.fixture(scope="module")
def page():
    return numbers.PAGE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """What a run would have of the simulated corpora."""
    folder = tmp_path_factory.mktemp("results")
    simulated.write_lsf(folder / "lsf-sim" / "simulated")
    simulated.write_isl(folder / "isl-sim" / "simulated")
    return folder


def places_of(page, program):
    return [n for n in marked.names(page) if n.startswith(f"{program}-")]


@pytest.mark.parametrize("program", numbers.PROGRAMS)
def test_every_place_tells_what_it_was_made_from(page, program):
    assert places_of(page, program)
    for name in places_of(page, program):
        made_by, digests = numbers.recorded(marked.content(page, name))
        assert made_by == program
        assert set(digests) == set(numbers.inputs(program))


def test_every_place_has_a_program(page):
    found = {n for program in numbers.PROGRAMS for n in places_of(page, program)}
    assert found == set(marked.names(page))


@pytest.mark.parametrize("program", numbers.PROGRAMS)
def test_settings_and_corpora_are_those_that_the_numbers_were_made_from(page, program):
    now = numbers.inputs(program)
    for name in places_of(page, program):
        made = numbers.recorded(marked.content(page, name))[1]
        stale = [key for key in ("settings", "corpora") if made[key] != now[key]]
        assert not stale, (
            f"{name}: made from other {' and '.join(stale)}. Run: {numbers.command(program)}"
        )


@pytest.mark.parametrize("program", numbers.PROGRAMS)
def test_the_code_is_that_of_the_numbers_or_says_the_same_of_a_simulated_corpus(
    page, program, request
):
    now = numbers.inputs(program)["code"]
    made = {numbers.recorded(marked.content(page, n))[1]["code"] for n in places_of(page, program)}
    if made == {now}:
        return
    module = importlib.import_module(f"tools.{program}")
    name, start = module.sample(request.getfixturevalue("results"))
    lines = marked.content(page, name).splitlines()
    assert any(line.startswith(start) for line in lines), (
        f"{name} has no row '{start}', which the code says now. Run: {numbers.command(program)}"
    )


def test_the_line_below_a_table_can_be_read_again():
    for program in numbers.PROGRAMS:
        content = "| a |\n|---|\n\n" + numbers.note(program, "2026-01-02") + "\n"
        assert numbers.recorded(content) == (program, numbers.inputs(program))
    with pytest.raises(marked.MarkError, match="tells what it was made from"):
        numbers.recorded("| a |\n|---|\n")


def test_a_table_has_a_line_for_each_column():
    assert numbers.table(("", "b"), [("x", "1")]) == "|  | b |\n|---|---|\n| x | 1 |"
