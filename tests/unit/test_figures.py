"""Figures are judged by what is drawn: artists, labels and units."""

import re
from urllib.parse import unquote
from xml.etree import ElementTree

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_rgba
from matplotlib.patches import FancyBboxPatch

from signkin.coarticulation.excerpts import choose_excerpts, excerpt_points
from signkin.figures import distance, hands, overview, refinement, specification, speed
from signkin.figures.style import LEFT, MANUAL, RIGHT, paper_style, save
from signkin.pages.overview import layout, parse_rule_graph, rule_notes, stage_order
from signkin.report.page import (
    FigureView,
    Page,
    Section,
    TableView,
    cell,
    data_uri,
    lighter,
    render,
)


@pytest.fixture
def ax():
    with paper_style():
        figure, axes = plt.subplots()
        yield axes
        plt.close(figure)


def colours(lines):
    return [line.get_color() for line in lines]


def points():
    t = np.arange(0, 1, 0.02)
    speeds = [
        pd.DataFrame(
            {"kind": "speed", "hand": hand, "time_s": t, "speed_m_per_s": np.abs(np.sin(9 * t))}
        )
        for hand in ("right", "left")
    ]
    marks = pd.DataFrame(
        [
            ("tag", "both", "start", "CAKE", "", 0.2), ("tag", "both", "end", "CAKE", "", 0.7),
            ("minimum", "right", "", "", "", 0.35), ("minimum", "left", "", "", "", 0.69),
            ("refined", "right", "start", "CAKE", "far", 0.2),
            ("refined", "right", "end", "CAKE", "moved", 0.69),
        ],
        columns=["kind", "hand", "edge", "gloss", "status", "time_s"],
    )  # fmt: skip
    table = pd.concat([*speeds, marks], ignore_index=True)
    text = ["edge", "gloss", "status"]
    table[text] = table[text].fillna("")
    return table


def test_speed_curves_with_tags_and_minima(ax):
    speed.plot_speed(points(), "m", 50.0, ax=ax, marks="minima")
    lines = ax.get_lines()
    assert colours(lines[:2]) == [RIGHT, LEFT]
    assert [c for c in colours(lines) if c == MANUAL] == [MANUAL] * 2
    assert sum(line.get_linestyle() == ":" for line in lines) == 2
    assert ax.get_xlabel() == "time in the recording (s)"
    assert ax.get_ylabel() == "wrist speed (m/s)"
    assert ax.child_axes[0].get_xlabel() == "frame (50 Hz)"
    assert [t.get_text() for t in ax.texts] == ["CAKE"]


def test_refined_tags_and_those_that_stay(ax):
    speed.plot_speed(points(), "m", 50.0, ax=ax, marks="refined")
    markers = [line for line in ax.get_lines() if line.get_marker() == "x"]
    assert len(markers) == 1
    assert markers[0].get_xdata()[0] == 0.2


def test_units_of_pixel_corpora_are_pixels(ax):
    table = points().rename(columns={"speed_m_per_s": "speed_px_per_s"})
    speed.plot_speed(table, "px", 30.0, ax=ax, marks="minima")
    assert ax.get_ylabel() == "wrist speed (px/s)"


def distances():
    return pd.DataFrame(
        {
            "mean_distance": [-0.2, 0.0, 0.3, 0.4], "duration_s": [0.2, 0.3, 0.35, 0.8],
            "outlier": [False, False, False, True], "in_diamond": [True, True, True, False],
        }
    )  # fmt: skip


def test_distances_with_line_and_outlier(ax):
    distance.plot_distances(distances(), (0.5, 0.3), ax=ax)
    assert [len(c.get_offsets()) for c in ax.collections] == [3, 1]
    x, y = ax.get_lines()[0].get_data()
    assert y == pytest.approx(0.5 * x + 0.3)
    assert ax.get_ylim()[0] == 0


def test_the_diamond_is_closed(ax):
    corners = {"left": (-1, 0.3), "top": (0, 0.6), "right": (1, 0.3), "bottom": (0, 0.1)}
    distance.plot_diamond(distances(), corners, ax=ax)
    x, y = ax.get_lines()[0].get_data()
    assert (x[0], y[0]) == (x[-1], y[-1])
    assert len(x) == 5


def test_pairs_of_segmentations_are_joined(ax):
    pairs = pd.DataFrame(
        {
            "hand": ["left", "right", "left"], "manual_euclidean_m": [0.1, 0.2, 0.3],
            "manual_duration_s": [0.2, 0.3, 0.4], "refined_euclidean_m": [0.2, 0.3, 0.4],
            "refined_duration_s": [0.1, 0.2, 0.3],
        }
    )  # fmt: skip
    distance.plot_segmentations(pairs, "left", "m", ax=ax)
    assert len(ax.collections[0].get_segments()) == 2
    assert "(m)" in ax.get_xlabel()


def test_bars_of_hand_changes_tell_their_n(ax):
    groups = pd.DataFrame(
        {
            "change": ["1H to 1H", "1H to 2H"], "n": [2, 0], "mean_s": [0.3, np.nan],
            "sd_s": [0.1, np.nan], "published_n": [6, 12], "published_mean_s": [0.27, 0.31],
        }
    )  # fmt: skip
    single = pd.DataFrame({"change": ["1H to 1H"] * 2, "duration_s": [0.2, 0.4]})
    hands.plot_hand_changes(groups, single, ax=ax)
    labels = [t.get_text() for t in ax.get_xticklabels()]
    assert labels == ["1H → 1H\nn = 2", "1H → 2H\nn = 0 (none)"]
    assert ax.patches[0].get_height() == pytest.approx(0.3)


def test_chance_band_and_truth_curves(ax):
    rng = np.random.default_rng(0)
    refinement.plot_chance(rng.random(30) / 9, rng.random((50, 30)) / 3, 0.15, "right", ax=ax)
    assert ax.get_lines()[1].get_ydata()[-1] == 1
    figure, other = plt.subplots()
    errors = pd.DataFrame(
        {"hand": ["right", "left"], "manual_error_s": [-0.1, 0.1], "refined_error_s": [0.01, 0]}
    )
    refinement.plot_truth(errors, ax=other)
    assert len(other.get_lines()) == 4
    plt.close(figure)


def test_saved_figures_are_the_same_bytes(tmp_path):
    def draw(name):
        with paper_style():
            figure, axes = plt.subplots()
            speed.plot_speed(points(), "m", 50.0, ax=axes, marks="minima")
            save(figure, tmp_path / f"{name}.svg", tmp_path / f"{name}.pdf")

    draw("a")
    draw("b")
    for suffix in (".svg", ".pdf"):
        assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()
    assert b"<dc:date>" not in (tmp_path / "a.svg").read_bytes()


# --- excerpts


def bounds():
    rows = []
    for sign in range(1, 7):
        for edge, time in (("start", sign), ("end", sign + 0.5)):
            for hand, shift in (("right", 0.02), ("left", 0.02 + 0.01 * sign)):
                far = sign == 5 and edge == "end" and hand == "left"
                rows.append(
                    {
                        "recording": "r", "sign": sign, "gloss": f"G{sign}", "edge": edge,
                        "manual_s": float(time), "hand": hand, "minimum_s": time + shift,
                        "refined_s": time if far else time + shift, "moved": not far,
                        "distance_s": shift, "status": "far" if far else "moved", "note": "",
                    }
                )  # fmt: skip
    return pd.DataFrame(rows)


def test_excerpts_follow_their_rules():
    utterances = pd.DataFrame({"recording": "r", "sign": range(1, 7), "utterance": "1"})
    found = choose_excerpts(bounds(), utterances, {})
    assert found["fig05"].to_s - 0.35 == 6.5  # the offset grows with the sign
    assert found["fig06"].from_s < 5.5 < found["fig06"].to_s
    named = {"fig04": {"recording": "r", "from_s": 1.0, "to_s": 2.0}}
    assert choose_excerpts(bounds(), utterances, named)["fig04"].rule == "corpus"


def test_an_excerpt_holds_what_is_drawn_and_nothing_else():
    utterances = pd.DataFrame({"recording": "r", "sign": range(1, 7), "utterance": "1"})
    excerpt = choose_excerpts(bounds(), utterances, {})["fig06"]
    speeds = pd.DataFrame({"time_s": np.arange(0, 8, 0.1), "right": 1.0, "left": 2.0})
    minima = pd.DataFrame(
        {"recording": ["r", "q"], "hand": "left", "minimum_s": [5.0, 5.0], "speed_m_per_s": 0.1}
    )
    found = excerpt_points(excerpt, speeds, bounds(), minima, "speed_m_per_s")
    assert found["time_s"].between(excerpt.from_s, excerpt.to_s).all()
    assert (found["kind"] == "minimum").sum() == 1
    assert set(found.loc[found["kind"] == "tag", "hand"]) == {"both"}


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
    assert "1 more row<" in html
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
