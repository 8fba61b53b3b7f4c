"""The list of a paper's figures and tables, and figures written by it."""

import json

import matplotlib.pyplot as plt
import pandas as pd
import pytest
import yaml

from signkin import tables
from signkin.errors import SignkinError
from signkin.exhibits import exhibits, files, of_groups
from signkin.report.drawn import Drawn, drawings, write_figures
from signkin.studies.naert2017.figures import of_synthesis, of_transitions

ENTRY = {
    "id": "fig10",
    "label": "Figure 10",
    "title": "Hands",
    "group": "figures",
    "table": "fig10",
    "differs": "The SD is added.",
}


@pytest.fixture
def listing(tmp_path):
    def write(*entries: object) -> tuple:
        content = yaml.safe_dump({"exhibits": list(entries)}, sort_keys=False)
        (tmp_path / "exhibits.yaml").write_text(content, encoding="utf-8")
        return exhibits(tmp_path)

    return write


def changed(**values: object) -> dict:
    return {k: v for k, v in {**ENTRY, **values}.items() if v is not None}


def test_an_entry_is_read_with_its_number_as_printed(listing):
    (one,) = listing(changed(id="figA1", label="Figure A1"))
    assert (one.stem, one.kind, one.number, one.label) == ("figA1", "figure", "A1", "Figure A1")
    assert (one.group, one.table, one.differs) == ("figures", "fig10", "The SD is added.")


@pytest.mark.parametrize("paper", ["naert2017", "endres2013"])
def test_the_papers_own_lists_are_read(root, paper):
    found = exhibits(root / "papers" / paper)
    raw = yaml.safe_load((root / "papers" / paper / "exhibits.yaml").read_text(encoding="utf-8"))
    assert [e.stem for e in found] == [entry["id"] for entry in raw["exhibits"]]
    assert [e.label for e in found] == [entry["label"] for entry in raw["exhibits"]]


@pytest.mark.parametrize(
    ("entries", "told"),
    [
        ([changed(differs=None)], r"exhibit 1 \(fig10\): no differs"),
        ([changed(title=" ")], "no title"),
        ([changed(colour="red")], "unknown key colour"),
        ([changed(label="Plate 3")], "the label 'Plate 3'; expected Figure or Table"),
        ([changed(label="Figure")], "the label 'Figure'"),
        ([changed(table="fig99")], "no kind of table 'fig99'"),
        ([ENTRY, dict(ENTRY)], r"exhibit 2: the id fig10 stands twice"),
        (["fig10"], "exhibit 1: no mapping"),
        ([], "no list of exhibits"),
    ],
)
def test_a_bad_list_names_file_place_and_key(listing, entries, told):
    with pytest.raises(SignkinError, match=told) as error:
        listing(*entries)
    assert "exhibits.yaml" in str(error.value)


def test_a_file_that_is_not_there_or_no_yaml_is_told(tmp_path):
    with pytest.raises(SignkinError, match=r"exhibits.yaml: there is no such file"):
        exhibits(tmp_path)
    (tmp_path / "exhibits.yaml").write_text("exhibits:\n  - id: [", encoding="utf-8")
    with pytest.raises(SignkinError, match=r"exhibits.yaml, line \d: .*; expected YAML"):
        exhibits(tmp_path)


def test_groups_come_in_the_order_asked_for_and_an_unknown_one_is_told(listing):
    found = listing(
        changed(id="fig12", group="truth"), ENTRY, changed(id="fig13", group="composition")
    )
    assert [e.stem for e in of_groups(found, "composition", "truth")] == ["fig13", "fig12"]
    with pytest.raises(SignkinError, match="no exhibit of the group 'plates'"):
        of_groups(found, "plates")


def test_figures_are_written_by_their_names_not_by_their_order(listing, tmp_path):
    found = listing(ENTRY, changed(id="fig07", label="Figure 7"))
    frames = {}
    for stem, n in (("fig07", 7), ("fig10", 10)):
        values = ["sim", "mean", "1H to 1H", None, n, 0.2, 0.1, n, 0.2]
        frames[stem] = pd.DataFrame([values], columns=tables.TABLES["fig10"].names())
    drawn = {stem: Drawn(plt.figure(), frame, f"of {stem}") for stem, frame in frames.items()}
    out = tmp_path / "out"
    out.mkdir()
    write_figures(drawn, found, out, out / "captions.json", "m")
    assert {str(out / p.name) for p in out.glob("fig*")} == set(files(found, str(out)))
    assert tables.read_table(out / "fig07.csv", "fig10")["n"].tolist() == [7]
    told = json.loads((out / "captions.json").read_text(encoding="utf-8"))
    assert list(told.items()) == [("fig10", "of fig10"), ("fig07", "of fig07")]


@pytest.mark.parametrize(
    ("draw", "groups"),
    [(of_transitions.DRAWINGS, ["figures"]), (of_synthesis.DRAWINGS, ["composition", "truth"])],
)
def test_naerts_list_and_drawings_are_the_same_figures(root, draw, groups):
    listing = of_groups(exhibits(root / "papers" / "naert2017"), *groups)
    assert {exhibit.stem for exhibit in listing} == set(draw)
    assert all(exhibit.table and exhibit.kind == "figure" for exhibit in listing)


def test_a_figure_without_a_drawing_is_told(listing):
    found = listing(changed(id="fig99", label="Figure 99"))
    with pytest.raises(SignkinError, match=r"nothing draws fig99; expected fig10"):
        drawings({"fig10": lambda source: source}, None, found)


def test_a_figure_that_nothing_draws_is_told(listing, tmp_path):
    found = listing(ENTRY)
    with pytest.raises(SignkinError, match="fig10 are listed, none are drawn"):
        write_figures({}, found, tmp_path, tmp_path / "captions.json", "m")
