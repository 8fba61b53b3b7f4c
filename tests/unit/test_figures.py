"""Figures are judged by what is drawn: artists, labels and units."""

import json
import re
import subprocess
from pathlib import Path
from urllib.parse import unquote
from xml.etree import ElementTree

import matplotlib.pyplot as plt
import pandas as pd
import pytest
from matplotlib.colors import to_rgba
from matplotlib.patches import FancyBboxPatch

from signkin.figures import overview, specification
from signkin.figures.style import RIGHT, paper_style, save
from signkin.pages import overview as page
from signkin.pages.overview import layout, parse_rule_graph, rule_notes, stage_order
from signkin.report.cells import cell
from signkin.report.images import data_uri, lighter
from signkin.report.page import (
    FigureView,
    Page,
    Section,
    TableView,
    render,
)
from signkin.settings import Settings


@pytest.fixture
def ax():
    with paper_style():
        figure, axes = plt.subplots()
        yield axes
        plt.close(figure)


# --- the overview


DOT = """digraph snakemake_dag {
    graph[bgcolor=white, margin=0];
\t0[label = "all", color = "0.3 0.6 0.85", style="rounded"];
\t1[label = "report", color = "0.3 0.6 0.85", style="rounded"];
\t2[label = "read", color = "0.3 0.6 0.85", style="rounded"];
\t3[label = "filter", color = "0.3 0.6 0.85", style="rounded"];
\t1 -> 0
\t2 -> 1
\t3 -> 1
\t2 -> 3
}
"""


def test_the_overview_is_the_workflows_graph(ax, tmp_path):
    edges = parse_rule_graph(DOT)
    assert edges == [("filter", "report"), ("read", "filter"), ("read", "report")]
    rules = tmp_path / "ingest.smk"
    rules.write_text('rule read:\n    """Raw files."""\n    input:\n        "x",\n')
    table = layout(edges, rule_notes([rules]))
    # The arrow that a longer way replaces is left out.
    assert table["rule"].tolist() == ["read", "filter", "report"]
    assert table["after"].tolist() == ["", "read", "filter"]
    assert table.loc[0, ["stage", "note"]].tolist() == ["ingest", "Raw files."]
    overview.plot_overview(table, ax=ax)
    assert "read" in [text.get_text() for text in ax.texts]
    assert "from read" in [text.get_text() for text in ax.texts]  # `filter` has another stage


def test_stages_are_lanes_below_what_they_need():
    stages = {"a": "one", "b": "one", "c": "two", "d": "two", "e": "two", "f": "two", "g": "0"}
    edges = [("a", "b"), ("b", "c"), ("c", "d"), ("c", "e"), ("a", "f"), ("d", "g")]
    table = layout(edges, {rule: (stage, "") for rule, stage in stages.items()})
    places = table.set_index("rule")[["column", "row"]].apply(tuple, axis=1).to_dict()
    # Lane two: the chain and its branch; f, which follows nothing of the lane, below.
    assert places == {
        "a": (0, 0), "b": (1, 0), "c": (0, 1), "d": (1, 1), "e": (1, 2), "f": (0, 3), "g": (0, 4),
    }  # fmt: skip
    assert stage_order([("x", "y"), ("y", "x")], ["x", "y"]) == ["x", "y"]  # a circle ends


def test_the_workflow_fits_into_its_boxes(root):
    notes = rule_notes(sorted((root / "workflow/rules").glob("*.smk")))
    last = {}
    edges = []
    for rule, (stage, _) in notes.items():  # chains of three, each stage after the one before
        chain = last.setdefault(stage, [])
        edges += [(chain[-1], rule)] if len(chain) % 3 else []
        edges += [(next(iter(notes)), rule)] if rule != next(iter(notes)) else []
        chain.append(rule)
    table = layout(parse_rule_graph(as_dot(edges)), notes)
    assert len(table) > 25
    assert not table.duplicated(["column", "row"]).any()
    with paper_style():
        figure, ax = plt.subplots(figsize=overview.size(table))
        overview.plot_overview(table, ax=ax)
        figure.canvas.draw()
        boxes = [p.get_window_extent() for p in ax.patches if isinstance(p, FancyBboxPatch)]
        texts = [t.get_window_extent() for t in ax.texts]
        faces = {tuple(p.get_facecolor()) for p in ax.patches if isinstance(p, FancyBboxPatch)}
    plt.close(figure)
    assert len(boxes) == len(table)
    inside = [t for t in texts if any(b.x0 < (t.x0 + t.x1) / 2 < b.x1 and
              b.y0 < (t.y0 + t.y1) / 2 < b.y1 for b in boxes)]  # fmt: skip
    assert len(inside) >= 2 * len(table) - 2
    for text in inside:
        box = min(boxes, key=lambda b: abs(b.x0 + b.x1 - text.x0 - text.x1)
                  + abs(b.y0 + b.y1 - text.y0 - text.y1))  # fmt: skip
        assert box.x0 <= text.x0 and text.x1 <= box.x1
        assert box.y0 - 1 <= text.y0 and text.y1 <= box.y1 + 1
    assert len(faces) == table["stage"].nunique()  # no two stages look the same
    assert set(table["stage"]) <= set(overview.STAGE_COLOURS)


def as_dot(edges):
    names = sorted({name for edge in edges for name in edge})
    lines = [f'{names.index(n)}[label = "{n}"];' for n in names]
    lines += [f"{names.index(a)} -> {names.index(b)}" for a, b in edges]
    return "\n".join(lines)


# --- specification curves


def test_each_specification_keeps_to_its_place(ax):
    specs = pd.DataFrame({"cut": list("aabab"), "holds": [True, True, True, False, True]})
    specification.plot_choices(specs, {"cut": ["a", "b"]}, ax=ax)
    spans = {}
    for patch in ax.patches:
        corners = patch.get_path().vertices.reshape(-1, 5, 2)
        key = (round(corners[:, :, 1].mean()), patch.get_facecolor() == to_rgba(RIGHT))
        spans[key] = [(c[:, 0].min(), c[:, 0].max()) for c in corners]
    assert spans == {
        (0, True): [(-0.5, 1.5)], (0, False): [(2.5, 3.5)], (1, True): [(1.5, 2.5), (3.5, 4.5)],
    }  # fmt: skip


# --- the page


def test_a_lighter_figure_is_the_same_drawing(tmp_path):
    with paper_style():
        figure, ax = plt.subplots()
        ax.plot([0.12345, 0.777], [1, 2], "o-")
        ax.set_xlabel("it's 5 % & more #1 <2>")
        save(figure, tmp_path / "f.svg", tmp_path / "f.pdf")
    full = (tmp_path / "f.svg").read_text()
    light = lighter(full)
    assert len(light) < 0.9 * len(full)
    kept = [e for e in ElementTree.fromstring(full).iter() if "svg}" in e.tag]
    same = [e for e in ElementTree.fromstring(light).iter() if "svg}" in e.tag]
    kept = [e for e in kept if not e.tag.endswith("metadata")]
    assert [e.tag for e in kept] == [e.tag for e in same]
    for before, after in zip(kept, same, strict=True):
        assert before.attrib.keys() == after.attrib.keys()
        for name, text in before.attrib.items():
            a, b = (re.split(r"[ ,()]+", x.strip()) for x in (text, after.attrib[name]))
            assert len(a) == len(b)
            for x, y in zip(a, b, strict=True):
                number = re.fullmatch(r"-?\d+\.\d+", x)
                assert float(x) == pytest.approx(float(y), abs=0.00501) if number else x == y
    address = data_uri(tmp_path / "f.svg")
    assert not set('"#&\n') & set(address)
    assert unquote(address.split(",", 1)[1]) == light


def test_cells():
    assert cell(None, "d") == cell(float("nan"), ".2f") == cell("", "") == "–"
    assert cell(3.0, "d") == "3"
    assert cell(0.5, ".0%") == "50%"
    assert cell("0000", "") == "0000"


def test_the_page_escapes_folds_and_embeds(tmp_path):
    (tmp_path / "f.svg").write_text("<svg xmlns='http://www.w3.org/2000/svg'/>")
    table = TableView(
        "Table 1", "T", "c", pd.DataFrame({"a": ["<b>", "y", "z"]}), {"a": ("A", "")},
        file=tmp_path / "t.csv", most=2,
    )  # fmt: skip
    figure = FigureView("Figure 4", "F", "caption", tmp_path / "f.svg", [tmp_path / "f.pdf"])
    section = Section("x", "X & Y", badge="simulated", exhibits=(table, figure), notices=("n",))
    html = render(Page("P", ("lead",), (section,), "0"), tmp_path / "report")
    assert "&lt;b&gt;" in html
    assert "X &amp; Y" in html
    assert 'class="more">[["z"]]</script>' in html
    assert "data:image/svg+xml,<svg xmlns='http://www.w3.org/2000/svg'/>" in html
    assert 'href="../f.pdf"' in html
    assert "no evidence about people" in html


def test_last_digits_of_a_layout_do_not_change_the_bytes(tmp_path):
    """The solver of the layout adds up in an order that differs from run to run."""
    made = []
    for jitter in (0.0, 3e-13):
        with paper_style(), plt.rc_context({"figure.constrained_layout.use": False}):
            figure = plt.figure(figsize=(4, 2))
            axes = figure.add_axes((0.1234567891 + jitter, 0.2, 0.7, 0.6 - jitter))
            axes.plot([0, 1], [0, 2])
            save(figure, tmp_path / "a.svg", tmp_path / "a.pdf")
        made.append([(tmp_path / f"a.{kind}").read_bytes() for kind in ("svg", "pdf")])
    assert made[0] == made[1]


def test_the_overview_is_the_same_wherever_results_are_copied(monkeypatch, tmp_path):
    asked = []

    def drawn(command, **how):
        asked.append(json.loads(Path(command[command.index("--configfile") + 1]).read_text()))
        return subprocess.CompletedProcess(command, 0, stdout=DOT, stderr="")

    monkeypatch.setattr(page.subprocess, "run", drawn)
    settings = Settings(seed=7, results_store="s3://signs/mine")
    assert page.rule_graph(tmp_path / "Snakefile", settings, "all") == DOT
    assert (asked[0]["seed"], asked[0]["results_store"]) == (7, None)
