"""The page of a corpus where nobody planned for it: very many, one, none, hostile names."""

from pathlib import Path

import numpy as np
import pytest

from signkin.pages.corpus_durations import durations_of, untyped_glosses
from signkin.pages.corpus_list import overview_of, todo_of
from signkin.pages.corpus_tags import tags_of, worst_tags
from signkin.report.page import Page, PlotView, Section, TableView, render, shown_of
from signkin.report.plots import MOST_POINTS, Point, scatter, thinned
from support.owner_tables import frame, shared, tagged

HEAVIEST = 3e6
COLUMNS = {"recording": ("recording", ""), "mean_s": ("mean (s)", ".3f"), "flags": ("odd", "d"),
           "odd": ("what looks odd", "")}  # fmt: skip


def parts_of(names, **options):
    about, own = shared("c", names), tagged("c", names, **options)
    durations = durations_of("c", own["transitions"], 1)
    tags = tags_of("c", own["boundaries"], 0.15)
    overview = overview_of(about["recordings"], about["gaps"], about["plausibility"],
                           durations, tags)  # fmt: skip
    worst = worst_tags(own["boundaries"], own["intervals"])
    todo = todo_of(overview, about["excluded"], about["plausibility"], worst,
                   own["transitions"], own["distances"], 0.15)  # fmt: skip
    return durations, tags, overview, todo


def html_of(frame, columns=COLUMNS, keys=("recording", "signer"), plots=()):
    view = TableView("", "T", "c", frame, columns, keys=keys)
    section = Section("s", "S", exhibits=(view, *plots))
    return render(Page("P", ("lead",), (section,), "0", ratings="c"), Path())


def test_ten_thousand_recordings_with_long_names_stay_light(tmp_path):
    names = [f"recording-{i:05d}-" + "n" * 180 for i in range(10_000)]
    about = shared("c", names)
    overview = overview_of(about["recordings"], about["gaps"], about["plausibility"], None, None)
    assert len(overview) == 10_000
    points = [Point(i, i % 9, name, "s", name) for i, name in enumerate(names)]
    shown, told = thinned(points)
    assert len(shown) == MOST_POINTS and "of 10000 points" in told
    plot = PlotView("", "P", "c", scatter(shown, "x", "y", "finding"))
    html = html_of(overview, plots=(plot,))
    assert len(html.encode()) < HEAVIEST
    view = TableView("", "T", "c", overview, COLUMNS, keys=("recording", "signer"))
    found = shown_of(view)
    assert found.left_out > 0 and found.many + found.left_out == 10_000
    assert f"the first {found.many} rows, the file all 10000" in html


def test_a_gloss_cannot_bring_markup_into_a_page():
    evil = "</script><img src=x onerror=alert(1)>\"'&"
    _, _, _, todo = parts_of(["r1", "r2"], gloss=evil, many=30)
    assert (todo["gloss"] == evil).any()
    html = html_of(todo, {"gloss": ("sign", ""), "why": ("why", "")}, ("recording", "gloss"))
    assert "<img src=x" not in html
    assert html.count("</script>") == html.count("<script")


def test_one_recording_has_an_interval_that_says_what_it_is_of():
    durations, tags, overview, _ = parts_of(["only"], many=6)
    whole = durations.set_index("group").loc["all"]
    assert whole["n"] == 6 and whole["low_s"] <= whole["mean_s"] <= whole["high_s"]
    assert "of this recording alone" in whole["note"]
    assert len(overview) == 1 and tags["n"].min() == 14


def test_no_transition_at_all_leaves_tables_without_rows():
    durations, _, overview, todo = parts_of(["a", "b"], many=0)
    assert durations.empty and next(iter(durations.columns)) == "corpus"
    assert overview["mean_s"].isna().all()
    assert set(todo["what"]) <= {"recording", "tag"}


def test_groups_add_up_and_recordings_are_drawn():
    durations, tags, overview, _ = parts_of([f"r{i}" for i in range(12)], many=6)
    for group in ("all", "types from", "type", "signer", "recording"):
        assert durations.loc[durations["group"] == group, "n"].sum() == 72
    whole = durations.iloc[0]
    assert whole["note"] == "" and whole["recordings"] == 12
    assert whole["mean_s"] == pytest.approx(np.mean([0.3 + 0.01 * (i % 5) for i in range(12)]))
    near = tags[tags["group"] == "all"]
    assert ((near["low"] < near["near"]) & (near["near"] < near["high"])).all()
    assert overview.loc[0, "flags"] == 1 and "right forearm" in overview.loc[0, "odd"]
    assert "a gap of 5.80 s" in overview.loc[11, "odd"]


def test_the_list_has_the_gravest_first_and_tells_overlaps_and_far_tags():
    own = tagged("c", ["r"], many=4)
    own["transitions"].loc[0, ["status", "duration_s"]] = ["overlap", -0.2]
    own["transitions"].loc[1, "status"] = "zero_length"
    own["distances"].loc[2, "outlier"] = True
    own["boundaries"].loc[own["boundaries"].index[:2], "distance_s"] = 0.9
    about = shared("c", ["r"])
    overview = overview_of(about["recordings"], about["gaps"], about["plausibility"], None, None)
    todo = todo_of(overview, about["excluded"], about["plausibility"],
                   worst_tags(own["boundaries"], own["intervals"]), own["transitions"],
                   own["distances"], 0.15)  # fmt: skip
    assert todo["rank"].is_monotonic_increasing and todo.loc[0, "what"] == "recording"
    told = "\n".join(todo["why"])
    assert "0.20 s before the last one ends" in told and "of no length" in told
    assert "an outlier" in told and "lies 0.90 s from the nearest minimum" in told
    tag = todo[todo["what"] == "tag"].iloc[0]
    assert (tag["start_s"], tag["end_s"]) == (0.2, 0.7)


def test_untyped_glosses_come_by_frequency():
    signs = frame("sign_types", [
        {"recording": "r", "gloss": g, "lexicon": lexicon, "kinematic": k, "start_s": 1.0}
        for g, lexicon, k in (("A", "", "10"), ("B", "", "10"), ("B", "", "10"), ("B", "", "00"),
                              ("C", "11", "11"))
    ])  # fmt: skip
    found = untyped_glosses(signs)
    assert list(found["gloss"]) == ["B", "A"]
    assert found.iloc[0]["commonest"] == "10" and found.iloc[0]["agreement"] == pytest.approx(2 / 3)


def test_a_plot_of_nothing_and_of_one_point_is_drawn():
    for points in ([], [Point(1.0, np.nan, "r", "s", "t")], [Point(1.0, 2.0, "r", "s", "t")]):
        drawing = scatter(points, "x", "y", "finding")
        assert drawing.startswith("<svg") and "nan" not in drawing
