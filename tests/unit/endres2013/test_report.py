"""What the report says of Bayesian binning, from tables with known numbers."""

import json

import pandas as pd
import pytest

from signkin import tables
from signkin.exhibits import exhibits, of_groups
from signkin.studies.endres2013 import report as endres_report

ORDERS = range(8)


def group(dataset, order, true_order=None, **values):
    whole = {"corpus": "c", "dataset": dataset, "signer": "all", "sign": "all", "order": order}
    return {**whole, "true_order": true_order, **values}


def frame_of(name, rows):
    return pd.DataFrame(rows, columns=tables.TABLES[name].names())


def orders_and_rates(peak=2):
    """Return tables in which order `peak` is likeliest, and order 5 finds the ground truth best."""
    orders, rates = [], []
    for order in ORDERS:
        probability = 0.6 if order == peak else 0.4 / 7
        of_order = {"mean_probability": probability, "mean_explained_variance": 0.9 + 0.01 * order}
        orders.append(group("recorded", order, mean_count=20.0 - order, **of_order))
        orders.append(group("powerlaw", order, mean_count=9.0, **of_order))
        # One signer's rows, which are not those of all.
        orders.append({**orders[0], "signer": "anna", "order": order, "mean_probability": 1.0})
        ratio = 0.5 if order == 5 else (None if order == 7 else 0.1)
        rates.append(group("powerlaw", order, hpfpps=ratio))
    for dataset, found in (("fitted", 0.7), ("fitted_map", 1.0)):
        orders.append(group(dataset, 3, 3, mean_probability=found))
        orders.append(group(dataset, 3, 4, mean_probability=0.01))
        rates.append(group(dataset, 3, 3, hit_rate=found, false_positives_per_s=1 - found))
    return frame_of("order_posteriors", orders), frame_of("hit_rates", rates)


def test_found_stands_beside_printed():
    told = {what: (where, printed, found) for what, where, printed, found in
            endres_report._comparisons(*orders_and_rates())}  # fmt: skip
    assert told["order posterior of recorded trajectories, peak"] == ("Fig. 7", "4", "2")
    assert told["P(3 ≤ S ≤ 5), recorded"][2] == f"{3 * 0.4 / 7:.3f}"
    assert told["mean number of boundaries, order 0"][1:] == ("13", "20.0")
    assert told["mean number of boundaries, order 7"][1:] == ("2", "13.0")
    assert told["explained variance, order 3"][1:] == ("> 0.99", "0.9300")
    assert told["hits for each false positive a second, peak"][1:] == ("3", "5")
    assert told["P(S = 3), fitted with order 3, averaged"][2] == "0.700"
    assert told["hit rate, false positives a second, most probable"][2] == "1.000, 0.000"


def test_what_was_not_run_is_not_told():
    orders, rates = orders_and_rates()
    few = orders[(orders["dataset"] == "recorded") & (orders["order"] < 3)]
    told = [row[0] for row in endres_report._comparisons(few, rates[:0])]
    assert told == [
        "order posterior of recorded trajectories, peak",
        "P(3 ≤ S ≤ 5), recorded",
        "mean number of boundaries, order 0",
        "explained variance, order 0",
    ]


def left_out(reasons):
    rows = [
        {"corpus": "c", "recording": f"r{i}", "signer": "anna", "dataset": dataset, "reason": why}
        for i, (dataset, why) in enumerate(reasons)
    ]
    return frame_of("binning_left_out", rows)


def test_reasons_are_counted_whatever_their_numbers(tmp_path):
    path = tmp_path / "left_out.csv"
    reasons = [
        ("recorded", "recording r0: 5 bins, expected more than 7"),
        ("recorded", "recording r1: 6 bins, expected more than 7"),
        ("powerlaw", "recording r2: 0.25 s, too short"),
    ]
    tables.write_table(left_out(reasons), path, "binning_left_out")
    (view,) = endres_report.left_out(path)
    assert view.frame[["dataset", "n", "example"]].to_numpy().tolist() == [
        ["powerlaw", 1, "r2"], ["recorded", 2, "r0"],
    ]  # fmt: skip
    assert "3 trajectories" in view.caption
    assert set(view.columns) <= set(view.frame.columns)


@pytest.mark.parametrize(
    ("name", "file", "make"),
    [
        ("binning_left_out", "left_out.csv", lambda f: endres_report.left_out(f / "left_out.csv")),
        ("rejected_draws", "rejected_draws.csv", endres_report._rejected),
    ],
)
def test_there_is_no_table_of_nothing(tmp_path, name, file, make):
    tables.write_table(tables.empty(name), tmp_path / file, name)
    assert list(make(tmp_path)) == []


def test_draws_are_counted_once_a_recording(tmp_path):
    rows = [
        {"corpus": "c", "recording": recording, "signer": "anna", "draws": draws, "reason": why,
         "rejected": rejected}
        for recording, draws, why, rejected in (
            ("r0", 10, "too fast", 7), ("r0", 10, "too short", 2), ("r1", 30, "too fast", 29),
        )
    ]  # fmt: skip
    table = frame_of("rejected_draws", rows)
    tables.write_table(table, tmp_path / "rejected_draws.csv", "rejected_draws")
    (view,) = endres_report._rejected(tmp_path)
    assert "Of 40 draws" in view.caption
    found = view.frame[["reason", "rejected", "recordings"]].to_numpy().tolist()
    assert found == [["too fast", 36, 2], ["too short", 2, 1]]


def test_figures_stand_in_the_order_of_the_list_with_what_is_added(tmp_path, root):
    listing = of_groups(exhibits(root / "papers" / "endres2013"), "figures")
    told = {exhibit.stem: f"Caption of {exhibit.stem}." for exhibit in reversed(listing)}
    (tmp_path / "captions.json").write_text(json.dumps(told))
    views = list(endres_report.figure_views(tmp_path, listing, " Simulated."))
    assert [view.svg.stem for view in views] == [exhibit.stem for exhibit in listing]
    assert views[0].caption == "Caption of fig01. Simulated."
    for view, exhibit in zip(views, listing, strict=True):
        assert (view.label, view.title, view.differs) == (
            exhibit.label, exhibit.title, exhibit.differs,
        )  # fmt: skip
        assert {file.suffix for file in view.files} == {".svg", ".pdf", ".csv"}
