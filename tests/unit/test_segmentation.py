from itertools import pairwise, product

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signkin import Interval, SignkinError
from signkin.coarticulation import refine
from signkin.coarticulation.segmentation import (
    boundary_rows,
    chance_distances,
    nearest,
    refine_each,
    refinement_quality,
    truth_errors,
    truth_summary,
)


def moved_to(intervals, minima, **options):
    refined, moved, minimum = refine(np.array(intervals, dtype=float), np.array(minima), **options)
    return refined.tolist(), moved.tolist(), minimum.tolist()


def test_each_tag_goes_to_its_nearest_minimum():
    refined, moved, minimum = moved_to([[1.0, 2.0]], [0.5, 0.93, 1.1, 1.9, 2.2])
    assert refined == [[0.93, 1.9]]
    assert moved == [[True, True]]
    assert minimum == [[0.93, 1.9]]


def test_a_tag_without_a_minimum_in_the_window_stays():
    refined, moved, minimum = moved_to([[1.0, 2.0]], [1.16, 2.0])
    assert refined == [[1.0, 2.0]]
    assert moved == [[False, True]]
    assert minimum == [[1.16, 2.0]]
    assert np.isnan(moved_to([[1.0, 2.0]], [])[2]).all()


@pytest.mark.parametrize("rate", [25.0, 29.97, 30.0, 50.0, 100.0, 120.0, 240.0])
def test_the_window_is_inclusive_at_any_rate(rate):
    frames = round(0.15 * rate)
    window = frames / rate
    for first in range(0, 400, 7):
        tag, at, beyond = (k / rate for k in (first, first + frames, first + frames + 1))
        assert moved_to([[tag, tag + 9]], [at], window_s=window)[0][0][0] == at
        assert moved_to([[tag, tag + 9]], [beyond], window_s=window)[0][0][0] == tag


def test_two_tags_never_share_a_minimum():
    # The end at 1.0 and the start at 1.1 both want 1.04.
    refined, moved, _ = moved_to([[0.5, 1.0], [1.1, 1.6]], [1.04])
    assert refined == [[0.5, 1.04], [1.1, 1.6]]
    assert moved == [[False, True], [False, False]]
    refined, _, _ = moved_to([[0.5, 1.0], [1.1, 1.6]], [1.04, 1.2])
    assert refined == [[0.5, 1.04], [1.2, 1.6]]


def test_a_boundary_that_is_one_instant_moves_as_one():
    refined, moved, _ = moved_to([[0.5, 1.0], [1.0, 1.6]], [1.04, 0.9])
    assert refined == [[0.5, 1.04], [1.04, 1.6]]
    assert moved == [[False, True], [True, False]]


def test_the_plain_rule_moves_each_tag_on_its_own():
    tags, minima = np.array([[0.5, 1.0], [1.1, 1.6]]), np.array([1.04, 1.2])
    refined, moved, closest = refine_each(tags, minima)
    assert refined.tolist() == [[0.5, 1.04], [1.04, 1.6]]  # both on one minimum
    assert moved.tolist() == [[False, True], [True, False]]
    ours, _, same = refine(tags, minima)
    assert int((ours != refined).sum()) == 1 and (same == closest).all()
    assert refine_each(tags, np.empty(0))[0].tolist() == tags.tolist()


@pytest.mark.parametrize("rule", [refine, refine_each])
def test_a_tag_without_a_time_stays_so_and_is_not_moved(rule):
    whole = rule(np.array([[0.5, 1.0], [1.1, 1.6]]), np.array([0.52, 1.04, 1.2]))
    for spoilt in (
        np.array([[0.5, 1.0], [np.nan, 1.6]]),
        np.ma.array([[0.5, 1.0], [1.1, 1.6]], mask=[[0, 0], [1, 0]]),
    ):
        refined, moved, closest = rule(spoilt, np.array([0.52, 1.04, 1.2]))
        assert np.isnan(refined[1, 0]) and np.isnan(closest[1, 0]) and not moved[1, 0]
        assert (refined[0] == whole[0][0]).all() and moved.sum() == 2


@pytest.mark.parametrize("rule", [refine, refine_each])
def test_a_minimum_without_a_time_is_refused(rule):
    tags = np.array([[0.5, 1.0]])
    for minima in (np.array([0.5, np.nan, 2.0]), np.ma.array([0.5, 1.0], mask=[0, 1])):
        with pytest.raises(SignkinError, match=f"1 of {len(minima)} minima have no time"):
            rule(tags, minima)
    with pytest.raises(SignkinError, match="the window is nan s"):
        rule(tags, np.array([0.5]), window_s=np.nan)


def test_a_start_stays_before_its_end():
    # Nearest minima alone would put the start at 1.10 and the end at 1.02.
    refined, _, _ = moved_to([[1.0, 1.05]], [1.02, 1.10])
    assert refined[0][0] < refined[0][1]
    refined, _, _ = moved_to([[1.0, 1.05]], [1.03])
    assert refined in ([[1.0, 1.03]], [[1.03, 1.05]])


tags = st.lists(st.integers(0, 60), min_size=2, max_size=6, unique=True).map(sorted)
lows = st.lists(st.integers(0, 60), max_size=5, unique=True).map(sorted)


@settings(max_examples=300, deadline=None)
@given(tags, lows)
def test_the_least_total_displacement_that_keeps_the_order(times, minima):
    times = times[: len(times) // 2 * 2]
    window = 8
    intervals = np.array(times, dtype=float).reshape(-1, 2)
    refined, moved, _ = refine(intervals, np.array(minima, dtype=float), window, 1e-6)
    flat, went = refined.ravel(), moved.ravel()
    assert (np.diff(flat) > 0).all()

    def cost(values, stays):
        return sum(
            window + 1e-6 if stay else abs(v - t)
            for v, t, stay in zip(values, times, stays, strict=True)
        )

    best = np.inf
    options = [[(m, False) for m in minima if abs(m - t) <= window] + [(t, True)] for t in times]
    for choice in product(*options):
        values = [v for v, _ in choice]
        if all(a < b for a, b in pairwise(values)):
            best = min(best, cost(values, [s for _, s in choice]))
    assert cost(flat, ~went) == pytest.approx(best)


@settings(max_examples=200, deadline=None)
@given(tags, lows)
def test_without_competition_it_is_the_papers_rule(times, minima):
    times = times[: len(times) // 2 * 2]
    window = 8
    alone = {t: [m for m in minima if abs(m - t) <= window] for t in times}
    intervals = np.array(times, dtype=float).reshape(-1, 2)
    refined, _, _ = refine(intervals, np.array(minima, dtype=float), window, 1e-6)
    plain = [min(near, key=lambda m: (abs(m - t), m)) if near else t for t, near in alone.items()]
    if all(a < b for a, b in pairwise(plain)):
        total = sum(abs(a - b) for a, b in zip(plain, times, strict=True))
        assert np.abs(refined.ravel() - times).sum() == pytest.approx(total)


def test_nearest_takes_the_earlier_of_two_equally_near():
    assert nearest(np.array([1.0, 5.0, -3.0]), np.array([0.0, 2.0])).tolist() == [0.0, 2.0, 0.0]


# --- tables


SIGNS = [Interval(1.0, 2.0, "A", "s"), Interval(2.3, 3.0, "B", "s")]
MINIMA = {"right": np.array([0.95, 2.05, 2.2, 3.4]), "left": np.array([2.1])}


def rows():
    return boundary_rows(SIGNS, MINIMA, 0.15, 1e-6)


def test_boundaries_tell_what_happened_to_each_tag():
    table = rows().set_index(["hand", "sign", "edge"])
    assert table.loc[("right", 1, "start"), "refined_s"] == 0.95
    assert table.loc[("right", 2, "end"), "status"] == "far"
    assert table.loc[("right", 2, "end"), "distance_s"] == pytest.approx(0.4)
    assert table.loc[("left", 1, "end"), ["status", "moved"]].tolist() == ["moved", True]
    assert table.loc[("left", 2, "start"), "status"] == "far"


def test_a_tag_that_loses_its_minimum_says_so():
    signs = [Interval(0.5, 1.0, "A", "s"), Interval(1.1, 1.6, "B", "s")]
    table = boundary_rows(signs, {"right": np.array([1.04]), "left": np.empty(0)}, 0.15, 1e-6)
    right = table[table["hand"] == "right"].set_index(["sign", "edge"])
    assert right.loc[(2, "start"), "status"] == "taken"
    assert right.loc[(2, "start"), "note"] == "another tag has the minimum: stays"
    left = table[table["hand"] == "left"]
    assert (left["note"] == "this hand has no speed minimum").all()


def test_tags_that_the_plain_rule_puts_elsewhere_are_counted():
    signs = [Interval(0.5, 1.0, "A", "s"), Interval(1.1, 1.6, "B", "s")]
    minima = {"right": np.array([1.04, 1.2]), "left": np.array([1.04])}
    table = boundary_rows(signs, minima, 0.15, 1e-6).assign(recording="r")
    found = refinement_quality(table, {}, 0.15, 1e-6).set_index(["measure", "hand"])
    elsewhere = found.loc["tags that the paper's plain rule puts elsewhere", "value"]
    assert elsewhere.to_dict() == {"right": 0.25, "left": 0.25}
    second = found.loc["tags moved to a minimum that is not the nearest", "value"]
    assert second.to_dict() == {"right": 0.25, "left": 0}


def test_chance_is_on_frames_inside_the_annotation_and_seeded():
    def draw():
        return chance_distances(SIGNS, np.array([2.0]), 10.0, 50, np.random.default_rng(3))

    found = draw()
    assert found.shape == (50, 4)
    assert (found == draw()).all()
    assert np.allclose(found * 10, np.rint(found * 10))
    assert found.max() <= 1.0 + 1e-9


def test_quality_against_chance():
    table = rows().assign(recording="r")
    chance = {("r", hand): np.tile([0.0, 0.1, 0.2, 0.3], (10, 1)) for hand in ("right", "left")}
    found = refinement_quality(table, chance, 0.15, 1e-6).set_index(["hand", "measure"])
    inside = found.loc[("right", "tags with a minimum within the window")]
    assert inside["value"] == 0.75
    assert inside[["chance", "chance_low", "chance_high"]].tolist() == [0.5, 0.5, 0.5]
    assert found.loc[("right", "tags moved"), "value"] == 0.75
    assert found.loc[("left", "tags moved"), "value"] == 0.25
    assert found.loc[("right", "tags moved"), "chance"] == 0.5
    low, high = found.loc[("right", "tags moved"), ["low", "high"]]
    assert (low, high) == pytest.approx((0.1941, 0.9937), abs=1e-4)  # exact, 3 of 4
    elsewhere = found.loc[("right", "tags that the paper's plain rule puts elsewhere")]
    assert elsewhere["value"] == 0 and elsewhere["note"].startswith("0 of 4 tags")
    offset = found.loc[("both", "median offset, left after right")]
    assert offset["value"] == pytest.approx(0.05)
    assert offset["n"] == 1


def test_errors_to_truth_before_and_after():
    truth = pd.DataFrame(
        {
            "recording": "r", "sign": [1, 1], "edge": ["start", "end"], "hand": "right",
            "true_s": [0.96, 2.04],
        }
    )  # fmt: skip
    errors = truth_errors(rows().assign(recording="r"), truth)
    assert errors["manual_error_s"].tolist() == pytest.approx([0.04, -0.04])
    assert errors["refined_error_s"].tolist() == pytest.approx([-0.01, 0.01])
    summary = truth_summary(errors, 100, np.random.default_rng(0)).set_index("segmentation")
    assert summary["mean_error_s"].to_dict() == pytest.approx({"manual": 0.04, "refined": 0.01})
    assert summary.loc["refined", "within_20ms"] == 1
