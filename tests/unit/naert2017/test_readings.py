"""Durations under the plain rule of refinement, and r against random intervals."""

import numpy as np
import pandas as pd
import pytest

from signkin import tables
from signkin.annotation import Interval
from signkin.coarticulation.segmentation import boundary_rows
from signkin.recording import Recording
from signkin.settings import Settings
from signkin.studies.naert2017.interval_chance import interval_chance
from signkin.studies.naert2017.open_choices import Take, _near, _random_tags
from signkin.studies.naert2017.readings import plain_boundaries, plain_segmentations

RATE = 50.0
REFINEMENT = Settings().refinement


def take(signs, position, name="r"):
    """Return a take of one joint at `position(t)` along x; each sign is followed by the next."""
    manual = np.array(signs)
    time = np.arange(int(manual.max() * RATE) + 2) / RATE
    points = np.zeros((len(time), 1, 3))
    points[:, 0, 0] = position(time)
    filled = Recording(name=name, rate_hz=RATE, joints=("right_wrist",), positions=points, unit="m")
    before = np.arange(len(manual) - 1)
    return Take(name, filled, None, [], manual, before, [""] * len(before))


def signs(count, seed=0):
    """Return signs of 0.4 s with gaps of 2 to 30 frames."""
    gaps = np.random.default_rng(seed).integers(2, 30, count) / RATE
    starts = 1 + np.cumsum(gaps + 0.4)
    return np.column_stack([starts, starts + 0.4])


def test_a_path_that_is_the_same_everywhere_has_no_r_of_its_own():
    """At a constant speed the distance is the duration, in transitions and anywhere."""
    row = interval_chance("c", [take(signs(30), lambda t: t)], 40, 1).iloc[0]
    assert row["value"] == pytest.approx(1)
    assert row["chance"] == pytest.approx(1)
    assert row["p"] == 1
    assert (row["n"], row["draws"]) == (29, 40)


def test_distances_that_only_transitions_have_lie_above_chance():
    own = signs(40)

    def position(t):
        """Move within transitions alone: as far as they last."""
        moved = np.zeros_like(t)
        for start, end in zip(own[:-1, 1], own[1:, 0], strict=True):
            moved += np.clip(t - start, 0, end - start) * (-1) ** int(start * 7)
        return moved

    row = interval_chance("c", [take(own, position)], 200, 1).iloc[0]
    assert row["value"] > row["chance_high"]
    assert row["p"] < 0.05


@pytest.mark.parametrize("count", [1, 2, 5])
def test_one_transition_or_few_have_no_correlation(count):
    table = interval_chance("c", [take(signs(count), lambda t: t)], 10, 1)
    assert list(table.columns) == tables.TABLES["interval_chance"].names()
    assert table["value"].isna().all()
    assert len(table) == (count > 1)
    if count > 1:
        assert "no correlation" in table["note"].iloc[0]


def test_the_plain_rule_moves_two_tags_to_one_minimum():
    given = [Interval(1.0, 1.5, "A", "t"), Interval(1.6, 2.0, "B", "t")]
    minima = {"right": np.array([0.95, 1.56, 2.5]), "left": np.array([])}
    rows = boundary_rows(given, minima, REFINEMENT.search_window_s, REFINEMENT.tolerance_s)
    rows = rows.assign(corpus="c", recording="r", signer="s")
    moves = pd.DataFrame(
        {"corpus": "c", "recording": "r", "signer": "s", "transition": 1,
         "hand": ["both", "right", "left"], "segmentation": "manual", "start_s": 1.5, "end_s": 1.6,
         "duration_s": 0.1, "euclidean_m": 0.2}
    )  # fmt: skip
    found = plain_segmentations(moves, rows, "m").set_index("hand")
    assert found["refined_duration_s"].to_dict() == {"right": 0.0, "left": 0.1}
    assert (found["manual_duration_s"] == 0.1).all()
    plain = plain_boundaries(rows, REFINEMENT).query("hand == 'right'")
    assert plain["refined_s"].tolist() == [0.95, 1.56, 1.56, 2.0]
    assert plain["moved"].tolist() == [True, True, True, False]
    ours = rows.query("hand == 'right'")["refined_s"].tolist()
    assert ours[1] != ours[2]


def test_the_grid_counts_transitions_tags_apart_and_under_each_null():
    one = take(signs(6), lambda t: t)
    minima = one.manual.ravel()
    near = _near(one, minima, _random_tags(one, 20, 1, "c"), 0.2)
    assert near.tags["all"].size == 12
    assert near.tags["transition"].size == 10
    assert (near.tags["all"] == 0).all()
    assert {null for null, _ in near.chance} == {
        "circular shift", "signs and gaps permuted", "uniform"
    }  # fmt: skip
    assert near.chance["uniform", "transition"].shape == (20, 10)
