"""Fig. 9 tells what its distances are made of."""

import pandas as pd
import pytest

from signkin.studies.naert2017.figures import fig09_segmentations as fig09


def transitions(unit, joints):
    rows = [
        {
            "corpus": "c", "recording": "r", "signer": "s", "transition": n, "hand": hand,
            "segmentation": segmentation, f"euclidean_{unit}": 0.1 * n,
            "duration_s": 0.2 * n + (0.05 if segmentation == "refined" else 0.0),
            "n_joints": 99 if hand == "both" else joints - (n == 2),
        }
        for n in (1, 2) for hand in ("both", "right", "left")
        for segmentation in ("manual", "refined")
    ]  # fmt: skip
    return pd.DataFrame(rows)


@pytest.mark.parametrize(
    ("unit", "joints", "pixels", "one_point"),
    [
        ("px", 1, True, True),
        ("px", 24, True, False),
        ("m", 24, False, False),
        ("m", 1, False, True),
    ],
)
def test_one_point_an_arm_is_told_where_there_is_one(unit, joints, pixels, one_point):
    table = transitions(unit, joints)
    points = fig09.points_of_an_arm(table)
    assert points == joints  # the whole body's joints do not count, nor a transition with a gap
    told = fig09.caption(fig09.data(table, unit), unit, points)
    assert ("image pixels" in told) is pixels
    assert ("An arm has one point" in told) is one_point
    assert "4 pairs over both hands" in told and "left 0.050 s, right 0.050 s" in told


def test_pairs_without_a_distance_are_counted_and_not_drawn():
    table = transitions("m", 3)
    gap = (table["transition"] == 2) & (table["hand"] == "left")
    table.loc[gap, "euclidean_m"] = None
    pairs = fig09.data(table, "m")
    assert len(pairs) == 4
    assert "3 pairs over both hands" in fig09.caption(pairs, "m", 3)
    assert "1 pairs have no distance" in fig09.caption(pairs, "m", 3)


def test_a_corpus_without_transitions_has_no_points():
    assert fig09.points_of_an_arm(transitions("m", 3).iloc[:0]) == 0
