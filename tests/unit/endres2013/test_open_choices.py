"""What the paper does not print, varied on a grid of few settings."""

from dataclasses import replace

import pandas as pd
import pytest

from signkin import tables
from signkin.errors import SignkinError
from signkin.figures.style import paper_style
from signkin.studies.endres2013.figures.open_choices import OUTCOMES
from signkin.studies.endres2013.figures.open_choices import drawn as figure_of
from signkin.studies.endres2013.open_choices import order_choices
from signkin.studies.endres2013.posteriors import study
from signkin.studies.endres2013.settings import ChoiceSettings, CutSettings, FitSettings
from signkin.studies.endres2013.single_signs import POWERLAW, RECORDED, single_signs
from support.endres import arc, corpus_of, recording_of, settings

NAMES = ["a", "b"]
GRID = {
    "recordings": 2, "orders": [0, 1, 3], "dof": [None, 5], "noise": ["sensor expected"],
    "concentration": [0.1], "time_unit": ["bin"], "bins": [30], "literal_dof": [],
}  # fmt: skip


def recordings(seconds=1.6):
    return [recording_of(name, arc(seconds, seed=i)) for i, name in enumerate(NAMES)]


def table_of(seconds=1.6, **grid):
    own = settings({**GRID, **grid}, bins=30)
    return own, order_choices(corpus_of(NAMES), recordings(seconds), ChoiceSettings.of(own), 3, 1)


@pytest.fixture(scope="module")
def found():
    return table_of()


def test_each_combination_is_a_row(found):
    _, table = found
    assert list(table.columns) == tables.TABLES["order_choices"].names("m")
    assert table["dof"].tolist() == ["L", "5"]
    assert table["default"].tolist() == ["yes", "no"]
    assert table["printed"].tolist() == ["no", "no"]
    assert (table["recordings"] == 2).all()


def test_the_default_row_is_the_study_itself(found):
    own, table = found
    corpus = corpus_of(NAMES)
    cut = single_signs(corpus, recordings(), CutSettings.of(own), 3).trajectories
    fit = replace(FitSettings.of(own), orders=(0, 1, 3), fitted_orders=(3,))
    rows = study(corpus, cut, fit, 1).table("binning")
    line = table.iloc[0]
    recorded = rows[rows["dataset"] == RECORDED]
    assert line["mean_count_order_0"] == recorded.query("order == 0")["map_count"].mean()
    assert line["mean_count_order_3"] == recorded.query("order == 3")["map_count"].mean()
    assert pd.isna(line["mean_count_order_7"])  # not in the grid
    means = recorded.groupby("order")["order_probability"].mean()
    assert line["order_peak_recorded"] == means.idxmax()
    assert line["probability_3_to_5_recorded"] == pytest.approx(means[3])
    third = rows[(rows["dataset"] == POWERLAW) & (rows["order"] == 3)]
    assert len(third) == 2
    assert line["hit_rate_order_3"] == pytest.approx(third["hit_rate"].mean())
    false = third["false_positives_per_s"].mean()
    assert line["false_positives_per_s_order_3"] == pytest.approx(false)
    pooled = third["hits"].sum() / (third["hits"] + third["misses"]).sum()
    per_s = third["false_positives"].sum() / third["duration_s"].sum()
    if per_s:
        assert line["hpfpps_order_3"] == pytest.approx(pooled / per_s)
    else:
        assert pd.isna(line["hpfpps_order_3"]) and line["note"]
    exact = rows[(rows["dataset"] == "fitted_map") & (rows["order"] == 3)]
    assert line["recovered_hit_rate"] == pytest.approx(exact["hit_rate"].mean())
    assert line["recovered_probability"] == pytest.approx(exact["order_probability"].mean())


def test_what_is_printed_and_what_is_default():
    grid = {
        "dof": [None], "noise": ["data expected", "sensor expected"], "concentration": [0.1, 1.0],
        "bins": [100, 20], "orders": [0, 3],
    }  # fmt: skip
    _, table = table_of(**grid)
    flagged = {
        (row.noise, row.concentration, row.bins): (row.printed, row.default)
        for row in table.itertuples()
    }
    assert len(flagged) == 8
    # Section 3.2 prints the data's variances, B = 0.1 I and T = 100.
    assert [key for key, (printed, _) in flagged.items() if printed == "yes"] == [
        ("data expected", 0.1, 100)
    ]
    assert not [key for key, (_, default) in flagged.items() if default == "yes"]  # 30 bins are


def test_recordings_without_ground_truth_are_said():
    _, table = table_of(seconds=0.7, dof=[None])
    assert table["note"].tolist() == ["no recording has a power-law ground truth"]
    assert table["hit_rate_order_3"].isna().all() and table["hpfpps_peak"].isna().all()
    assert table["mean_count_order_3"].notna().all()


def test_without_a_recording_there_is_a_sentence():
    with pytest.raises(SignkinError, match=r"tiny: no recording has a power-law ground truth"):
        order_choices(corpus_of(NAMES), [], ChoiceSettings.of(settings(GRID)), 3, 1)


def test_the_number_of_workers_changes_nothing(found):
    own, table = found
    again = order_choices(corpus_of(NAMES), recordings(), ChoiceSettings.of(own), 3, 2)
    pd.testing.assert_frame_equal(table, again, check_exact=True)


@pytest.mark.filterwarnings("error")
def test_the_figure_has_a_mark_for_each_setting(found):
    _, table = found
    table = pd.concat([table, table.assign(noise="data plain", printed="yes", default="no")])
    table = table.reset_index(drop=True)
    with paper_style():
        one = figure_of(table)
        figure = one.figure
        figure.canvas.draw()
    assert len(figure.axes) == len(OUTCOMES)
    for ax, (column, (label, paper)) in zip(figure.axes, OUTCOMES.items(), strict=True):
        lines = ax.get_lines()

        def drawn(size, lines=lines):
            return sorted(y for line in lines if line.get_markersize() == size
                          for y in line.get_ydata())  # fmt: skip

        assert drawn(3.6) == pytest.approx(sorted(table[column].dropna()))
        there = table[table[column].notna()]
        for size, flag in ((8, "printed"), (13, "default")):
            flagged = there.loc[there[flag] == "yes", column]
            assert drawn(size) == pytest.approx(sorted(flagged))
        dashed = [line.get_ydata()[0] for line in lines if line.get_linestyle() == "--"]
        assert dashed == ([] if paper is None else [paper])
        assert ax.get_ylabel() == label
    names = [t.get_text() for t in figure.axes[-1].get_xticklabels()]
    assert names == ["sensor\nexpected\nbin", "data\nplain\nbin"]
    told = one.caption
    assert "4 settings" in told and "The 2 ringed" in told and "nan" not in told
