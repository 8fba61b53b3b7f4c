"""Figures of Endres et al. 2013: what is drawn is what the points say, without warnings."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from signkin import tables
from signkin.errors import SignkinError
from signkin.exhibits import exhibits, of_groups
from signkin.figures import binning as drawing
from signkin.figures.style import paper_style
from signkin.studies.endres2013.figures import DRAWINGS, draw, fig02
from signkin.studies.endres2013.figures.fig03 import KINDS
from signkin.studies.endres2013.figures.points import told_orders
from signkin.studies.endres2013.figures.sources import TABLES, Example, Sources, read_sources
from signkin.studies.endres2013.posteriors import (
    FITTED,
    FITTED_MAP,
    read_posteriors,
    study,
    write_posteriors,
)
from signkin.studies.endres2013.settings import CutSettings, FitSettings
from signkin.studies.endres2013.single_signs import (
    POWERLAW,
    RECORDED,
    example_points,
    single_signs,
)
from signkin.studies.endres2013.summaries import summaries
from support.endres import arc, corpus_of, recording_of, settings

CHANCE = ("chance", "chance low", "chance high", "closed form")

pytestmark = pytest.mark.filterwarnings("error")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Everything the figures are drawn from, of four recordings."""
    names = ["a", "b", "c", "d"]
    corpus = corpus_of(names)
    own = settings(
        bins=30, orders=[0, 1, 2, 3], fitted_orders=[1, 3], bootstrap_draws=100,
        chance_trajectories=100,
    )  # fmt: skip
    recordings = [recording_of(name, arc(seed=i)) for i, name in enumerate(names)]
    cut = single_signs(corpus, recordings, CutSettings.of(own), 3)
    found = study(corpus, cut.trajectories, FitSettings.of(own), 2)
    path = tmp_path_factory.mktemp("posteriors") / "p.parquet"
    write_posteriors(path, found.fits)
    gathered = {name: found.table(name) for name in ("binning", "fitted_truths")}
    frames = summaries("tiny", gathered, cut.trajectories, own.binning, 3)
    x = {t.dataset: t.x for t in cut.trajectories if t.recording == "a"}
    example = Example(
        "a", "xyz", example_points(corpus, recordings[0], CutSettings.of(own), 3),
        cut.table("ground_truth", "m").query("recording == 'a'"), read_posteriors([path], "a"),
        x[RECORDED], x[POWERLAW],
    )  # fmt: skip
    return Sources(
        "tiny", "m", frames["order_posteriors"], frames["hit_rates"], frames["chance_lines"],
        frames["order_tests"], lambda: example,
    )  # fmt: skip


@pytest.fixture
def drawn(made):
    """Return a maker of one figure, drawn on a canvas and closed afterwards."""
    with paper_style():
        yield lambda name, **changes: _rendered(DRAWINGS[name](replace(made, **changes)))
    plt.close("all")


def _rendered(one):
    one.figure.canvas.draw()
    return one


def panels(figure):
    """Return the axes that hold a panel: no colour bars, none switched off."""
    return [ax for ax in figure.axes if ax.axison and ax.get_label() != "<colorbar>"]


def has_data(ax):
    return bool(ax.lines or ax.collections or ax.patches or ax.containers)


@pytest.mark.parametrize("name", DRAWINGS)
def test_every_panel_has_data_and_labels(drawn, name):
    one = drawn(name)
    for ax in panels(one.figure):
        assert has_data(ax), ax.get_title(loc="left")
    # Inner panels of a grid that shares axes are labelled at its edges.
    labels = [(ax.get_xlabel(), ax.get_ylabel()) for ax in panels(one.figure)]
    assert any(x for x, _ in labels) and any(y for _, y in labels)
    if name in ("fig01", "fig03"):
        assert all(x and y for x, y in labels)
    assert "nan" not in one.caption.lower()
    kind = "fig01_powerlaw" if name == "fig01" else "endres_figure"
    assert list(one.data.columns) == tables.TABLES[kind].names()
    if name != "fig01":
        assert one.data[["x"]].notna().all().all()
        assert set(one.data["corpus"]) == {"tiny"}


def curves(ax):
    return {
        tuple(np.round(np.column_stack(line.get_data()).astype(float).ravel(), 9))
        for line in ax.lines
    }


def as_curve(rows, x="x", y="y"):
    return tuple(np.round(rows[[x, y]].to_numpy(dtype=float).ravel(), 9))


def marks(ax):
    """Return the points of all error bars, (x, y)."""
    return {
        (round(float(x), 9), round(float(y), 9))
        for c in ax.containers
        if hasattr(c, "has_yerr")
        for x, y in zip(*c.lines[0].get_data(), strict=True)
    }


def points_of(rows):
    return {(round(row.x, 9), round(row.y, 9)) for row in rows.itertuples() if pd.notna(row.y)}


def bars(ax):
    return sorted(round(patch.get_height(), 9) for patch in ax.patches)


def test_figure_1_is_the_path_before_and_after(drawn):
    one = drawn("fig01")
    axes = {ax.get_title(loc="left")[0]: ax for ax in panels(one.figure)}
    assert sorted(axes) == ["a", "b", "c", "d", "e"]
    for name in "bce":
        assert axes[name].get_xlabel() == "curvature (1/m)"
        assert axes[name].get_ylabel() == "speed (m/s)"
        assert axes[name].get_xscale() == axes[name].get_yscale() == "log"
    for name in "ad":
        assert axes[name].get_xlabel().endswith("(m)") and axes[name].get_ylabel().endswith("(m)")
    before = one.data[one.data["dataset"] == RECORDED]
    after = one.data[one.data["dataset"] == POWERLAW]
    plane = [axes["a"].get_xlabel()[0], axes["a"].get_ylabel()[0]]
    path = before[[f"{axis}_m" for axis in plane]].to_numpy()
    steps = np.array(axes["a"].collections[0].get_segments())
    assert steps[:, 0] == pytest.approx(path[:-1])
    for ax, rows in ((axes["b"], before), (axes["c"], after)):
        # Curvature has no value at the ends of the path after warping.
        there = rows[rows["curvature_per_m"].notna() & (rows["speed_m_per_s"] > 0)]
        shown = np.asarray(ax.collections[0].get_offsets())
        assert shown == pytest.approx(there[["curvature_per_m", "speed_m_per_s"]].to_numpy())
    assert len(axes["d"].lines) == 3 + 2  # segments, start and end
    legend = [t.get_text() for t in axes["e"].get_legend().get_texts()]
    assert len(legend) == 3 and all("β = " in text for text in legend)


def test_figure_3_is_what_its_rows_say(drawn, made):
    one = drawn("fig03")
    a, b, c, d = panels(one.figure)
    data = {name: one.data[one.data["panel"] == name] for name in "ABCD"}
    assert a.get_ylabel() == "position, centred (m)" and a.get_xlabel() == "time (s)"
    curve_rows = data["A"][data["A"]["series"] != "boundaries"]
    for _, rows in curve_rows.groupby("series"):
        assert as_curve(rows) in curves(a)
    x = made.example.recorded
    first = data["A"].query("series == 'x'")["y"].to_numpy()
    assert first == pytest.approx(x[:, 0] - x[:, 0].mean())
    dotted = sorted(line.get_xdata()[0] for line in a.lines if line.get_linestyle() == ":")
    assert dotted == pytest.approx(data["A"].query("series == 'boundaries'")["x"].tolist())
    assert bars(b) == pytest.approx(sorted(data["B"]["y"]), abs=1e-8)
    shown = data["C"][~data["C"]["series"].isin(CHANCE)]
    assert marks(c) == points_of(shown)
    for series in ("chance", "closed form"):
        assert as_curve(data["C"][data["C"]["series"] == series]) in curves(c)
    assert marks(d) == points_of(data["D"])
    orders = made.orders
    recorded = orders[(orders["dataset"] == RECORDED) & (orders["signer"] == "all")]
    assert data["D"]["y"].to_numpy() == pytest.approx(recorded["mean_explained_variance"])


def test_figure_4_draws_densities_that_sum_to_the_expected_count(drawn, made):
    one = drawn("fig04")
    top, *lower = panels(one.figure)
    assert top.get_ylabel().endswith("centred (m)")
    assert lower[-1].get_xlabel() == "time (s)"
    fits = made.example.fits.query("dataset == 'powerlaw'").set_index("order")
    assert [ax.get_title(loc="left").split(":")[0] for ax in lower] == ["order 0", "order 3"]
    for ax, order in zip(lower, (0, 3), strict=True):
        assert ax.get_ylabel() == "boundaries (1/s)"
        rows = one.data[one.data["panel"] == f"order {order}"]
        density = rows.query("series == 'density'")
        assert as_curve(density) in curves(ax)
        fit = fits.loc[order]
        assert density["y"].sum() * fit["bin_s"] == pytest.approx(
            fit["boundary_probability"].sum(), rel=1e-5
        )
        true = sorted(line.get_xdata()[0] for line in ax.lines if line.get_linestyle() == ":")
        assert true == pytest.approx(made.example.segments["end_s"].iloc[:2].tolist())
    for order in (0, 3):
        rows = one.data[one.data["panel"] == "trajectory"]
        rows = rows[rows["series"] == f"order {order}"]
        assert as_curve(rows) in curves(top)


def test_figures_5_to_7_draw_each_group(drawn, made):
    five = drawn("fig05")
    for ax in panels(five.figure):
        title = ax.get_title(loc="left")
        name = title.removeprefix("signer ").replace("sign ", "").split(" (")[0]
        rows = five.data[five.data["panel"] == name]
        assert marks(ax) == points_of(rows[rows["series"] == name])
        assert title.endswith("(n = 2)")
    six = drawn("fig06")
    top, bottom, over = panels(six.figure)
    assert bars(top) == pytest.approx(
        sorted(six.data.query("panel == 'order posterior'")["y"]), abs=1e-8
    )
    assert bottom.get_ylabel() == "hit rate / false positives a second (s)"
    ratio = six.data.query("panel == 'ratio' and series == 'all'")
    rates = made.rates
    own = rates[(rates["dataset"] == POWERLAW) & (rates["signer"] == "all")]
    pd.testing.assert_series_equal(
        ratio["y"].reset_index(drop=True), own["hpfpps"].reset_index(drop=True), check_names=False
    )
    assert {y for _, y in points_of(six.data.query("panel == 'ratio'"))} == {
        y for _, y in marks(bottom) if not np.isnan(y)
    }
    assert marks(over) >= {
        (round(x + 0.06 * (i - 0.5), 9), round(y, 9))
        for i, column in enumerate(("over_chance", "over_shifted"))
        for x, y in zip(own["order"], own[column], strict=True)
        if np.isfinite(y)
    }
    chance = six.data.query("panel == 'ratio by chance' and series == 'boundaries shifted'")
    assert chance["y"].tolist() == pytest.approx(own["shifted_hpfpps"].tolist(), nan_ok=True)
    assert "hit rate less that of chance (greatest against Poisson events: order " in six.caption
    seven = drawn("fig07")
    (ax,) = panels(seven.figure)
    assert bars(ax) == pytest.approx(sorted(seven.data["y"]), abs=1e-8)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("polynomial order S", "P(S | data)")
    assert seven.data.groupby("series")["y"].sum().to_numpy() == pytest.approx(1)
    peak = int(seven.data.query("series == 'all'").set_index("x")["y"].idxmax())
    assert f"Peak at order {peak};" in seven.caption


def test_figure_a1_has_a_pair_of_panels_for_each_true_order(drawn):
    one = drawn("figA1")
    titled = [ax for ax in panels(one.figure) if ax.get_title(loc="left")]
    assert [ax.get_title(loc="left") for ax in titled] == ["true order 1", "true order 3"]
    others = [ax for ax in panels(one.figure) if ax not in titled]
    for order, top, bottom in zip((1, 3), titled, others, strict=True):
        rows = one.data[one.data["panel"] == f"P, order {order}"]
        assert bars(top) == pytest.approx(sorted(rows["y"]), abs=1e-8)
        assert set(rows["series"]) == set(KINDS.values())
        hits = one.data[one.data["panel"] == f"hits, order {order}"]
        shown = hits[~hits["series"].isin(CHANCE)]
        assert marks(bottom) == points_of(shown)
        assert order in {line.get_xdata()[0] for line in top.lines}
    assert {FITTED, FITTED_MAP} == set(KINDS)


def test_the_scheme_has_its_boundaries():
    one = _rendered(fig02.drawn())
    (ax,) = one.figure.axes
    assert ax.get_xlabel().startswith("time: T = 15 bins") and "M = 2" in ax.get_xlabel()
    dotted = {line.get_xdata()[0] for line in ax.lines if line.get_linestyle() == ":"}
    assert dotted == {0, *one.data["x"]}
    assert list(one.data.columns) == tables.TABLES["endres_figure"].names()
    plt.close(one.figure)


@pytest.mark.parametrize("signer", ["clara", "chance", "chancellor", "closed form"])
def test_marks_of_signers_called_like_a_line_are_drawn(drawn, made, signer):
    renamed = [table.replace({"signer": {"s1": signer}}) for table in (made.rates, made.lines)]
    one = drawn("fig05", rates=renamed[0], lines=renamed[1])
    titles = {ax.get_title(loc="left"): ax for ax in panels(one.figure)}
    ax = titles[f"signer {signer}, sign wave (n = 2)"]
    rows = one.data[one.data["series"] == f"{signer}, wave"]
    assert len(rows) == 4 and marks(ax) == points_of(rows)


def test_axes_are_named_as_recorded(drawn, made):
    example = made.example
    expected = [np.reshape(e, (-1, 3))[:, :2].ravel() for e in example.fits["expected"]]
    fits = example.fits.assign(expected=expected)
    flat = replace(example, axes="xz", recorded=example.recorded[:, :2], fits=fits)
    three = drawn("fig03", find_example=lambda: flat)
    assert {"x", "z", "z, order 3"} <= set(three.data["series"])
    assert not {"y", "y, order 3"} & set(three.data["series"])


@pytest.mark.parametrize("name", ["fig05", "figA1"])
def test_captions_tell_the_orders_that_were_run(drawn, made, name):
    assert "orders 0 to 3" in drawn(name).caption
    rates, orders = (table[table["order"] != 1] for table in (made.rates, made.orders))
    assert "orders 0, 2 and 3" in drawn(name, rates=rates, orders=orders).caption


def test_orders_are_told_in_words():
    assert told_orders([3, 1, 2, 1]) == "orders 1 to 3"
    assert told_orders([0, 1]) == "orders 0 and 1"
    assert told_orders([6, 0, 3]) == "orders 0, 3 and 6"
    assert told_orders([2]) == "order 2"


def test_the_list_is_what_is_drawn(root, made):
    listing = of_groups(exhibits(root / "papers" / "endres2013"), "figures")
    assert [exhibit.stem for exhibit in listing] == list(DRAWINGS)
    with paper_style():
        assert list(draw(made, listing[4:5])) == ["fig06"]
    more = [*listing, replace(listing[0], stem="fig99")]
    with pytest.raises(SignkinError, match=r"nothing draws fig99"):
        draw(made, more)
    plt.close("all")


def test_without_ground_truth_there_is_a_sentence():
    frames = {kind: tables.empty(kind, "m") for kind in TABLES}
    with pytest.raises(SignkinError, match=r"tiny: no recording has a power-law ground truth"):
        assert read_sources(corpus_of(["a"]), frames, {}, CutSettings.of(settings()), 3).example


def test_marks_on_one_spot_share_a_label():
    rows = pd.DataFrame(
        [("p", "s", 0.5, 0.5, None, None, "1"), ("p", "s", 0.51, 0.502, 0.1, 0.1, "2"),
         ("p", "s", 2.0, 0.5, None, None, "3")],
        columns=["panel", "series", "x", "y", "x_error", "y_error", "label"],
    ).astype({"x_error": float, "y_error": float})  # fmt: skip
    figure, ax = plt.subplots()
    drawing.plot_hit_rates(rows, ax=ax)
    figure.canvas.draw()
    assert sorted(t.get_text() for t in ax.texts) == ["1,2", "3"]
    assert ax.get_xlim()[1] > 2.0 and ax.get_ylim()[1] > 1.0
    plt.close(figure)
