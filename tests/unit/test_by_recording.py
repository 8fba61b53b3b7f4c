"""Rows of a recording, found once for all: the same as looking for each."""

from __future__ import annotations

import pandas as pd

from signkin.tables import ByRecording, empty, rows_of


def test_rows_are_those_found_one_by_one():
    frame = pd.DataFrame({"recording": ["b", "a", "b", "c"], "x": [1, 2, 3, 4]}, index=[7, 5, 3, 9])
    own = ByRecording(frame)
    for name in ("a", "b", "c", "d"):
        pd.testing.assert_frame_equal(own[name], frame[frame["recording"] == name])
        pd.testing.assert_frame_equal(rows_of(own, name), rows_of(frame, name))


def test_a_table_without_rows_has_none():
    assert list(ByRecording(empty("minima"))["a"].columns) == list(empty("minima").columns)
