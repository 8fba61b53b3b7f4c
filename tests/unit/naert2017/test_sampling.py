"""What a corpus beyond a limit is cut to: a seeded sample, folds, draws of m out of n."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from signkin.coarticulation.duration import FOLDS, MOST_LEFT_OUT, folded
from signkin.statistics import association, posthoc
from signkin.studies.naert2017.sampling import sample

NAMES = [f"r{i:03d}" for i in range(100)]


@pytest.fixture
def intervals():
    """A hundred recordings of four signs, and one gloss that a single recording has."""
    rows = [(name, "sign", f"G{i}") for name in NAMES for i in range(4)]
    rows[398] = ("r099", "sign", "RARE")
    rows += [(name, "utterance", "") for name in NAMES]
    return pd.DataFrame(rows, columns=["recording", "role", "label"])


def test_a_corpus_within_the_limit_is_whole(intervals):
    found = sample("c", NAMES, intervals, 300, 1)
    assert list(found.names) == NAMES
    assert (found.whole, found.note) == (True, "")
    assert found.rows(intervals) is intervals


def test_a_larger_one_is_cut_to_the_limit_in_its_own_order(intervals):
    found = sample("c", NAMES, intervals, 60, 1)
    assert len(found.names) == 20
    assert list(found.names) == sorted(found.names)
    assert found == sample("c", NAMES, intervals, 60, 1)
    assert found != sample("c", NAMES, intervals, 60, 2)
    assert set(found.rows(intervals)["recording"]) == set(found.names)
    told = found.told(pd.DataFrame({"note": ["", "why"]}))
    assert told["note"].tolist() == [found.note, f"why; {found.note}"]
    assert found.note == "of a seeded sample: 20 of 100 recordings"


def test_one_long_recording_is_still_taken_and_a_wanted_gloss_too(intervals):
    assert len(sample("c", NAMES, intervals, 2, 1).names) == 1
    assert "r099" in sample("c", NAMES, intervals, 2, 1, ["RARE", "nobody's"]).names


def test_recordings_without_signs_count_one_each():
    none = pd.DataFrame({"recording": [], "role": [], "label": []})
    assert len(sample("c", NAMES, none, 30, 1).names) == 30


def test_more_groups_than_can_be_left_out_one_by_one_are_folded():
    few = list(range(MOST_LEFT_OUT))
    assert folded(few) == (few, "")
    held, told = folded([*range(MOST_LEFT_OUT + 1), 0])
    assert len(set(held)) == FOLDS
    assert held[-1] == held[0]
    assert f"{FOLDS} folds" in told


def test_draws_of_m_out_of_n_give_the_interval_of_all(monkeypatch):
    x = np.random.default_rng(3).normal(size=4000)

    def interval():
        rng = np.random.default_rng(4)
        return np.array(
            association.bootstrap(lambda rows: x[rows].mean(), range(len(x)), 400, 0.05, rng)
        )

    monkeypatch.setattr(association, "MOST_UNITS", 4000)
    whole = interval()
    monkeypatch.setattr(association, "MOST_UNITS", 250)
    assert interval() == pytest.approx(whole, abs=0.006)
    half = (whole[1] - whole[0]) / 2
    assert half == pytest.approx(1.96 / np.sqrt(4000), rel=0.1)


def test_of_too_many_groups_the_largest_are_compared(monkeypatch):
    monkeypatch.setattr(posthoc, "MOST_GROUPS", 3)
    rng = np.random.default_rng(5)
    groups = {f"g{i}": rng.normal(size=2 + i) for i in range(5)}
    found = posthoc.pairwise(groups, "x", 0.05)
    assert {f.groups for f in found} == {("g2", "g3"), ("g2", "g4"), ("g3", "g4")}
    assert all("the 3 largest of 5 groups" in "; ".join(f.notes) for f in found)
    kept, told = posthoc.largest(groups, 5)
    assert kept is groups
    assert told == ""
