"""Continuous wrists as long series, their boundaries beside other events, and ELAN tiers."""

from itertools import pairwise

import numpy as np
import pandas as pd
import pympi
import pytest

from signkin import tables
from signkin.annotation import Interval
from signkin.errors import SignkinError
from signkin.figures.style import paper_style
from signkin.io.eaf import write_eaf
from signkin.studies.one_wrist import long_series as module
from signkin.studies.one_wrist.long_series import (
    caption,
    copies,
    draw,
    events_of,
    example,
    long_series,
    one_wrist,
    tiers,
)
from support.endres import corpus_of, recording_of, settings

RATE = 50.0
OWN = settings(continuous={"bin_s": 0.04, "longest_segment_s": 1.0, "order": 1})
CORNERS_S = (0.8, 1.6, 2.4)


def zigzag(size=0.2, seconds=3.2, seed=0):
    """Return a path that turns at CORNERS_S, (F, 3); in between it goes straight on."""
    t = np.arange(round(seconds * RATE)) / RATE
    knots = [0, *CORNERS_S, seconds]
    places = np.random.default_rng(seed).uniform(-1, 1, (len(knots), 3))
    places[1::2] += 1.0
    path = np.column_stack([np.interp(t, knots, column) for column in places.T])
    return size * path


def test_turns_of_both_wrists_are_found():
    recordings = [recording_of("a", zigzag(seed=1), zigzag(seed=2), RATE)]
    corpus = corpus_of(["a"], noise_sd=0.002)
    found = long_series(corpus, recordings, OWN, 1)
    about = found.table("wrist_posteriors", "m")
    assert list(about.columns) == tables.TABLES["wrist_posteriors"].names("m")
    assert about["hand"].tolist() == ["right", "left"]
    bins = round((160 - 1) / RATE / 0.04)
    assert (about["n_bins"] == bins).all()
    assert about["bin_s"].to_numpy() == pytest.approx(159 / RATE / bins)
    ends = found.table("wrist_boundaries", "m")
    for row in about.itertuples():
        times = ends.loc[ends["hand"] == row.hand, "boundary_s"].to_numpy()
        assert len(times) == row.map_count or row.note
        assert row.boundaries_per_s == pytest.approx(len(times) / (bins * row.bin_s))
        for corner in CORNERS_S:
            assert np.abs(times - corner).min() < 0.09
        assert row.explained_variance > 0.99
        assert row.cut_mass < 1e-6
    assert ends["probability"].between(0, 1).all() and (ends["probability"] > 0.05).all()
    assert found.table("binning_left_out", "m").empty


def test_flat_recordings_in_pixels_take_two_dimensions(monkeypatch):
    path = 1000 * zigzag(seed=1)
    path[:, 2] = 0
    seen = []
    original = module.fit_many

    def spy(trajectories, *rest, **more):
        seen.extend(x.shape for x in trajectories)
        return original(trajectories, *rest, **more)

    monkeypatch.setattr(module, "fit_many", spy)
    corpus = corpus_of(["flat"], noise_sd=2.0, unit="px")
    found = long_series(corpus, [recording_of("flat", path, path, RATE, unit="px")], OWN, 1)
    assert {shape[1] for shape in seen} == {2} and len(seen) == 2
    assert len(found.posteriors) == 2
    times = np.array([r["boundary_s"] for r in found.boundaries if r["hand"] == "right"])
    assert all(np.abs(times - corner).min() < 0.09 for corner in CORNERS_S)


def test_what_cannot_be_binned_is_listed_and_the_rest_goes_on():
    gaps, nothing = zigzag(), np.full((160, 3), np.nan)
    gaps[60:90] = np.nan  # 0.6 s
    filled = zigzag(seed=1)
    filled[60:68] = np.nan  # 0.16 s
    few = zigzag(seconds=3.2)[:3]
    recordings = [
        recording_of("gaps", gaps, zigzag(seed=2), RATE),
        recording_of("still", filled, None, RATE),
        recording_of("nothing", zigzag(), nothing, RATE),
        recording_of("few", few, few, RATE),
        recording_of("slow", zigzag()[::4], zigzag()[::4], 12.5),
    ]
    corpus = corpus_of([r.name for r in recordings], noise_sd=0.002)
    high = settings(continuous={"bin_s": 0.04, "longest_segment_s": 1.0, "order": 3})
    found = long_series(corpus, recordings, high, 1)
    binned = [(r["recording"], r["hand"]) for r in found.posteriors]
    assert binned == [("gaps", "left"), ("still", "right"), ("nothing", "right")]
    reasons = {(r["recording"], r["dataset"]): r["reason"] for r in found.left_out}
    assert len(reasons) == 10 - len(binned)
    assert "recording gaps, right_wrist: 30 frames without a" in reasons["gaps", "right wrist"]
    assert "the wrist does not move" in reasons["still", "left wrist"]
    assert "recording nothing, left_wrist" in reasons["nothing", "left wrist"]
    assert "160 frames without a position" in reasons["nothing", "left wrist"]
    assert "recording few: 1 bins; expected more than the order, 3" in reasons["few", "left wrist"]
    assert "recording slow" in reasons["slow", "right wrist"]
    assert "12.5 Hz" in reasons["slow", "right wrist"]


def test_the_number_of_workers_changes_nothing():
    recordings = [recording_of(f"r{i}", zigzag(seed=i), zigzag(seed=9 + i), RATE) for i in range(3)]
    corpus = corpus_of([r.name for r in recordings], noise_sd=0.002)
    one, two = (long_series(corpus, recordings, OWN, n) for n in (1, 2))
    for name in ("wrist_posteriors", "wrist_boundaries"):
        pd.testing.assert_frame_equal(one.table(name, "m"), two.table(name, "m"), check_exact=True)


# --- against other events ----------------------------------------------------------------------

FOUND_S = {
    ("a", "right"): [0.50, 1.04, 2.00, 2.90], ("b", "right"): [0.30, 1.00],
    ("a", "left"): [1.00], ("b", "left"): [],
}  # fmt: skip
MINIMA_S = {
    ("a", "right"): [0.55, 1.50], ("b", "right"): [0.95], ("a", "left"): [2.5], ("b", "left"): [],
}  # fmt: skip
# One sign of a ends where the next one starts, at 1.0 s.
TAGS = [("a", "start", 0.58, 0.55), ("a", "end", 1.0, 1.0), ("a", "start", 1.0, 1.5),
        ("a", "end", 2.5, 2.5), ("b", "start", 0.6, 0.6), ("b", "end", 1.05, 0.95)]  # fmt: skip
DURATIONS = {"a": 4.0, "b": 2.0}


def tables_of_events():
    def rows(times, column):
        return pd.DataFrame(
            [(r, h, t) for (r, h), many in times.items() for t in many],
            columns=["recording", "hand", column],
        )

    tags = pd.DataFrame(
        [(r, h, e, m, f) for r, e, m, f in TAGS for h in ("right", "left")],
        columns=["recording", "hand", "edge", "manual_s", "refined_s"],
    )
    about = pd.DataFrame({"recording": list(DURATIONS), "duration_s": list(DURATIONS.values())})
    posteriors = pd.DataFrame(list(FOUND_S), columns=["recording", "hand"])
    return about, posteriors, rows(FOUND_S, "boundary_s"), rows(MINIMA_S, "minimum_s"), tags


def counted(found, truth, window):
    """Return the most pairs within a window, by trying every one-to-one pairing."""
    if not found or not truth:
        return 0
    best = 0
    for i, t in enumerate(truth):
        if abs(found[0] - t) <= window + 1e-9:
            best = max(best, 1 + counted(found[1:], truth[:i] + truth[i + 1 :], window))
    return max(best, counted(found[1:], truth, window))


@pytest.mark.parametrize("window", [0.03, 0.09, 0.6])
def test_hits_of_a_wrist_are_those_counted_by_hand(window):
    about, posteriors, found, minima, tags = tables_of_events()
    corpus = corpus_of(["a", "b"])
    events = events_of(found, minima, tags)
    table, points = one_wrist(corpus, about, posteriors, events, window, 5)
    assert list(table.columns) == tables.TABLES["one_wrist"].names()
    assert list(points.columns) == tables.TABLES["endres_figure"].names()
    manual = {n: sorted({m for r, _, m, _ in TAGS if r == n}) for n in "ab"}
    refined = {n: sorted({f for r, _, _, f in TAGS if r == n}) for n in "ab"}
    assert [len(manual[n]) for n in "ab"] == [3, 2]  # an instant counts once
    named = {
        "boundaries": FOUND_S, "minima": MINIMA_S,
        "manual tags": {(n, h): manual[n] for n in "ab" for h in ("right", "left")},
        "refined tags": {(n, h): refined[n] for n in "ab" for h in ("right", "left")},
    }  # fmt: skip
    assert len(table) == 8
    for row in table.itertuples():
        pairs = [(named[row.found][n, row.hand], named[row.truth][n, row.hand]) for n in "ab"]
        hits = [counted(list(f), list(t), window) for f, t in pairs]
        assert row.hits == sum(hits), (row.hand, row.found, row.truth)
        assert row.n_found == sum(len(f) for f, _ in pairs)
        assert row.n_truth == sum(len(t) for _, t in pairs)
        rates = [h / len(t) for h, (_, t) in zip(hits, pairs, strict=True) if t]
        assert row.hit_rate == pytest.approx(np.mean(rates))
        false = [
            (len(f) - h) / DURATIONS[n] for n, h, (f, _) in zip("ab", hits, pairs, strict=True)
        ]
        assert row.false_positives_per_s == pytest.approx(np.mean(false))
        assert row.chance_low <= row.chance_high
        if window < 0.1:  # few pairs compete for an event, few windows reach beyond the ends
            closed = 1 - np.exp(-2 * window * row.n_found / sum(DURATIONS.values()))
            assert row.chance_hit_rate == pytest.approx(closed, abs=0.03)
        mark = points[(points["x_error"].notna()) & points["panel"].str.startswith(row.hand)]
        assert row.hit_rate in set(mark["y"])


def test_without_tags_boundaries_stand_beside_minima_alone():
    about, posteriors, found, minima, _ = tables_of_events()
    minima = minima[minima["hand"] == "right"]
    events = events_of(found, minima, None)
    table, points = one_wrist(corpus_of(["a", "b"]), about, posteriors, events, 0.09, 5)
    assert table[["found", "truth"]].to_numpy().tolist() == [["boundaries", "minima"]] * 2
    assert table["note"].tolist() == ["", "nothing to be hit"]
    assert np.isnan(table["hit_rate"].iloc[1])
    assert set(points["panel"]) == {"right wrist: minima"}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("unit", ["m", "px"])
def test_the_figure_draws_what_the_points_say(unit):
    about, posteriors, found, minima, tags = tables_of_events()
    corpus = corpus_of(["a", "b"], unit=unit)
    events = events_of(found, minima, tags)
    table, points = one_wrist(corpus, about, posteriors, events, 0.09, 5)
    assert example(about, posteriors, {"a", "b"}) == "a"
    t = np.arange(0, 4, 0.02)
    frames = pd.DataFrame(
        {"time_s": t, **{f"{h}_speed_{unit}_per_s": 1 + np.sin(5 * t) for h in ("right", "left")}}
    )
    with paper_style():
        figure = draw(corpus, points, frames, events, "a")
        figure.canvas.draw()
    speeds, panels = figure.axes[:2], figure.axes[2:]
    for ax, hand in zip(speeds, ("right", "left"), strict=True):
        assert ax.get_ylabel().startswith(f"{hand} wrist") and f"{unit}/s" in ax.get_ylabel()
        dashed = [line.get_xdata()[0] for line in ax.get_lines() if line.get_linestyle() == "--"]
        assert dashed == pytest.approx(FOUND_S["a", hand])  # all: 4 s fit in
    assert speeds[1].get_xlabel() == "time in the recording (s)"
    assert [ax.get_title(loc="left") for ax in panels] == list(dict.fromkeys(points["panel"]))
    for ax in panels:
        assert ax.get_xlabel() == "false positives a second"
        rows = points[points["panel"] == ax.get_title(loc="left")]
        marks = rows[~rows["series"].str.startswith(("chance", "closed"))]
        drawn = {
            (float(x), float(y))
            for c in ax.containers
            for x, y in zip(*c.lines[0].get_data(), strict=True)
        }
        assert drawn == {(row.x, row.y) for row in marks.itertuples()}
    told = caption(table, "a", {"window_s": 0.09, "continuous": OWN["binning"]["continuous"]})
    assert "nan" not in told and "recording a" in told and "order 1" in told


# --- ELAN --------------------------------------------------------------------------------------


def test_segments_come_back_from_elan(tmp_path):
    write_eaf(
        tmp_path / "a.eaf", author="t", date="2020", media_url="v.mp4",
        tiers=[("Gloss", None, [Interval(1, 2, "A", "Gloss"), Interval(3, 4, "B", "Gloss")])],
    )  # fmt: skip
    about = pd.DataFrame(
        {
            "recording": ["a"], "annotation_file": ["a.eaf"], "clock_offset_s": [0.25],
            "motion_file": ["a.bvh"],
        }
    )  # fmt: skip
    tags = tables.empty("intervals")
    _, _, found, _, _ = tables_of_events()
    made = copies(tmp_path, about, found, tags)
    assert list(made) == ["a.eaf"]
    (tmp_path / "new.eaf").write_bytes(made["a.eaf"])
    back = pympi.Elan.Eaf(str(tmp_path / "new.eaf"))
    assert {n for n in back.get_tier_names() if n.startswith("signkin")} == {
        "signkin binning right", "signkin binning left",
    }  # fmt: skip
    segments = back.get_annotation_data_for_tier("signkin binning right")
    # The file's clock runs 0.25 s behind the recording's.
    times = [round(1000 * (t - 0.25)) for t in FOUND_S["a", "right"]]
    assert [(a, b) for a, b, *_ in sorted(segments)] == list(pairwise(times))
    assert [label for _, _, label, *_ in sorted(segments)] == ["1", "2", "3"]
    assert not back.get_annotation_data_for_tier("signkin binning left")  # one boundary: no segment
    assert len(back.get_annotation_data_for_tier("Gloss")) == 2
    assert tiers(found, "nobody")[0].intervals == ()
    (tmp_path / "a.eaf").write_text("no ELAN")
    with pytest.raises(SignkinError, match=r"a\.eaf"):
        copies(tmp_path, about, found, tags)
