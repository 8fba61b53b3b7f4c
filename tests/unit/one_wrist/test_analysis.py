"""Boundaries of long series beside other events on the same wrists."""

import numpy as np
import pytest

from signkin import tables
from signkin.studies.one_wrist.analysis import events_of, one_wrist
from support.endres import corpus_of
from support.wrists import DURATIONS, FOUND_S, MINIMA_S, TAGS, tables_of_events


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
        assert 0 <= row.shifted_low <= row.shifted_high <= 1
        if window < 0.1:  # few pairs compete for an event, few windows reach beyond the ends
            closed = 1 - np.exp(-2 * window * row.n_found / sum(DURATIONS.values()))
            assert row.chance_hit_rate == pytest.approx(closed, abs=0.03)
            assert row.shifted_hit_rate == pytest.approx(closed, abs=0.06)
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
