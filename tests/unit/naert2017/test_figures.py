"""Figures of Naert et al. 2017 are judged by what is drawn: artists, labels and units."""

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
import seaborn

from signkin.coarticulation.excerpts import choose_excerpts, excerpt_points
from signkin.figures import distance, hands, refinement, speed
from signkin.figures.style import LEFT, MANUAL, RIGHT, STYLE, paper_style, save
from signkin.studies.naert2017.figures import fig10_hands
from signkin.tables import TABLES


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


def test_the_style_is_seaborns_ticks():
    ticks = seaborn.axes_style("ticks")
    ours = dict(mpl.rc_params_from_file(STYLE, use_default_template=False))
    other = {"font.family", "image.cmap", "axes.spines.top", "axes.spines.right"}
    assert {k: ours[k] for k in ticks if k not in other} == {
        k: v for k, v in ticks.items() if k not in other
    }


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


def test_the_data_of_figure_10_hold_its_bars_and_its_dots():
    transitions = pd.DataFrame(
        {"type": ["1011", "", "0000", "0000"], "duration_s": [0.5, 0.9, 0.4, 0.2]}
    )
    published = pd.DataFrame(
        {
            "type": ["0000", "0010", "1100", "1011"], "n": ["6", "12", "3", "4"],
            "mean": ["0.27", "0.31", "0.3", "0.4"],
        }
    )  # fmt: skip
    shown = fig10_hands.data("signs", transitions, published)
    bars, dots = (shown[shown["kind"] == kind] for kind in ("mean", "transition"))
    assert list(shown) == TABLES["fig10"].names()
    assert bars["n"].tolist() == [2, 0, 0, 1]
    assert bars["mean_s"].iloc[[0, 3]].tolist() == pytest.approx([0.3, 0.5])
    assert dots[["change", "duration_s"]].to_numpy().tolist() == [
        ["1H to 1H", 0.2], ["1H to 1H", 0.4], ["2H to 2H", 0.5],
    ]  # fmt: skip
    assert dots[["n", "mean_s"]].isna().all(axis=None)


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
