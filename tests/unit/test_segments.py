"""Scores of two segmentations: closed forms, brute force, and the command line."""

import itertools

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signkin import Interval, SignkinError
from signkin.__main__ import main
from signkin.io.eaf import write_eaf
from signkin.segments import (
    as_segments,
    boundary_f1,
    boundary_hits,
    covering,
    frame_labels,
    hausdorff_s,
    offsets_s,
    overlap,
    score,
    segment_f1,
    share_of_segments,
    shuffled,
)
from signkin.segments.frames import LEAST_IOU, mean_f1, runs

TENTHS = st.lists(st.integers(0, 60), max_size=6).map(lambda x: [v / 10 for v in x])
LABELS = st.lists(st.integers(0, 1), min_size=24, max_size=24).map(
    lambda x: np.array(x, dtype=np.int8)
)


def segments_of(lengths):
    cuts = np.cumsum(lengths) / 10
    return cuts[: len(cuts) // 2 * 2].reshape(-1, 2)


SEGMENTS = st.lists(st.integers(1, 9), min_size=2, max_size=12).map(segments_of)


@given(TENTHS, TENTHS, st.sampled_from([0.0, 0.1, 0.3]))
@settings(max_examples=80)
def test_hits_are_the_most_pairs_that_there_can_be(p, r, tolerance):
    few, many = sorted((p, r), key=len)
    best = max(
        sum(abs(a - b) <= tolerance + 1e-9 for a, b in zip(few, order, strict=True))
        for order in itertools.permutations(many, len(few))
    )
    found = boundary_hits(p, r, tolerance)
    assert found.hits == best
    assert (found.predicted, found.reference) == (len(p), len(r))


def test_rates_of_hits():
    found = boundary_hits([1.0, 2.0, 5.0], [1.05, 2.3], 0.1) + boundary_hits([1.0], [1.0], 0.1)
    assert found.hit_rate == pytest.approx(2 / 3)
    assert found.precision == pytest.approx(2 / 4)
    assert found.f1 == pytest.approx(4 / 7)
    assert np.isnan(boundary_hits([], [], 0.1).f1)
    with pytest.raises(SignkinError, match="a tolerance of -1 s"):
        boundary_hits([1.0], [1.0], -1.0)
    with pytest.raises(SignkinError, match="1 without a time"):
        boundary_hits([np.nan], [1.0], 0.1)


@given(TENTHS.filter(bool), TENTHS.filter(bool))
@settings(max_examples=60)
def test_hausdorff_is_scipys(p, r):
    from scipy.spatial.distance import directed_hausdorff

    x, y = np.array(p)[:, None], np.array(r)[:, None]
    both = max(directed_hausdorff(x, y)[0], directed_hausdorff(y, x)[0])
    assert hausdorff_s(p, r) == pytest.approx(both)


def test_offsets_tell_who_leads():
    assert offsets_s([1.1, 2.1], [1.0, 2.0]) == pytest.approx([0.1, 0.1])
    assert np.isnan(offsets_s([], [1.0])).all()
    assert np.isnan(hausdorff_s([], [1.0]))


@given(SEGMENTS, SEGMENTS)
@settings(max_examples=60)
def test_overlap_is_that_of_fine_frames(a, b):
    span = (0.0, 6.5)
    at = np.arange(650) / 100 + 0.005
    p, r = (((at[:, None] > x[:, 0]) & (at[:, None] < x[:, 1])).any(axis=1)
            for x in (np.clip(a, *span), np.clip(b, *span)))  # fmt: skip
    found = overlap(a, b, span)
    counts = [(p & r).sum(), (p & ~r).sum(), (~p & r).sum(), (~p & ~r).sum()]
    told = [found.both_s, found.predicted_only_s, found.reference_only_s, found.neither_s]
    assert told == pytest.approx(np.array(counts) / 100)
    if (p | r).any():
        assert found.iou_sign == pytest.approx((p & r).sum() / (p | r).sum())
        assert found.f1_sign == pytest.approx(2 * (p & r).sum() / (p.sum() + r.sum()))
    if not (p & r).all():
        assert found.iou_transition == pytest.approx((~p & ~r).sum() / (~(p & r)).sum())


def test_kappa_is_that_of_a_textbook_table():
    # 20 yes-yes, 5 and 10 apart, 15 no-no: observed 0.70, by chance 0.50.
    a = np.array([[0.0, 25.0]])
    b = np.array([[0.0, 20.0], [25.0, 35.0]])
    assert overlap(a, b, (0.0, 50.0)).kappa == pytest.approx(0.4)


def test_overlapping_segments_of_one_side_count_once():
    a = np.array([[0.0, 2.0], [1.0, 3.0]])
    assert overlap(a, np.array([[0.0, 3.0]]), (0.0, 4.0)).iou_sign == 1.0


def test_covering_by_hand_and_of_itself():
    a, b = np.array([[0.0, 5.0]]), np.array([[0.0, 4.0]])
    # Pieces of b: 4 s, covered by [0, 5] with 4/5; 6 s, by [5, 10] with 5/6.
    assert covering(a, b, (0.0, 10.0)) == pytest.approx(0.4 * 0.8 + 0.6 * 5 / 6)
    assert covering(b, b, (0.0, 10.0)) == 1.0
    assert share_of_segments(np.zeros((3, 2)), np.zeros((4, 2))) == 0.75


def greedy_by_the_matrix(value, keep):
    """Take the best cell, strike its row and column, and go on: the definition, as it stands."""
    value = value.astype(float).copy()
    taken = []
    while value.size and np.isfinite(value).any():
        row, column = np.unravel_index(np.argmin(value), value.shape)
        taken.append(value[row, column])
        value[row], value[:, column] = np.inf, np.inf
    return {k: sum(bool(keep(v, k)) for v in taken) for k in LEVELS[keep]}


def near_enough(distance, frames):
    return distance <= frames


def overlaps_enough(minus_iou, least):
    return -minus_iou > least


LEVELS = {near_enough: (1, 2, 3, 4), overlaps_enough: LEAST_IOU}


@given(LABELS, LABELS)
@settings(max_examples=100)
def test_boundary_and_segment_hits_are_those_of_the_definition(p, r):
    a, b = (runs(x, 1).mean(axis=1) for x in (p, r))
    expected = greedy_by_the_matrix(np.abs(a[:, None] - b), near_enough)
    assert {k: h.hits for k, h in boundary_f1(p, r).items()} == expected
    a, b = (runs(x, 0) for x in (p, r))
    shared = np.minimum(a[:, None, 1], b[:, 1]) - np.maximum(a[:, None, 0], b[:, 0])
    whole = np.maximum(a[:, None, 1], b[:, 1]) - np.minimum(a[:, None, 0], b[:, 0])
    found = segment_f1(p, r)
    assert {k: h.hits for k, h in found.items()} == greedy_by_the_matrix(
        -shared / whole, overlaps_enough
    )
    assert {(h.predicted, h.reference) for h in found.values()} == {(len(a), len(b))}


def test_mean_f1_by_hand():
    # Two boundaries each; one exact, one 3 frames off: F1 is 1/2 up to 2 frames, then 1.
    p = np.array([0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0], dtype=np.int8)
    r = np.array([0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0], dtype=np.int8)
    assert mean_f1(boundary_f1(p, r)) == pytest.approx(0.75)
    # Segments: 1 = 1; 4 of 7 frames (0.571); 2 of 5 (0.4, which is not above 0.40).
    hits = [h.hits for h in segment_f1(p, r).values()]
    assert hits == [2, 2, 2, 2, 1, 1, 1, 1]
    nothing = np.zeros(0, dtype=np.int8)
    assert mean_f1(segment_f1(nothing, r)) == 0.0


def test_an_overlap_of_13_of_20_frames_is_065_as_in_the_evaluation_of_renz_et_al():
    r = np.array([1, *[0] * 20, 1], dtype=np.int8)
    p = np.array([1, *[0] * 13, *[1] * 8], dtype=np.int8)
    # Theirs (eval.py of a97fa9e, get_sign_metric) gives true positives [1, 1, 1, 1, 1, 1, 0, 0].
    assert [h.hits for h in segment_f1(p, r).values()] == [1, 1, 1, 1, 1, 1, 0, 0]


def test_labels_of_frames():
    labels = frame_labels(np.array([[0.0, 0.2], [0.2, 0.4], [0.48, 0.6]]), (0.0, 0.6), 25.0)
    assert labels.tolist() == [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 0, 0, 1]


@given(SEGMENTS, st.integers(0, 99))
@settings(max_examples=40)
def test_shuffling_keeps_lengths_and_gaps(segments, seed):
    span = (0.0, float(segments.max()) + 0.3)
    made = shuffled(segments, span, np.random.default_rng(seed))

    def gaps(x):
        return np.sort(np.append(x[:, 0], span[1]) - np.append(span[0], x[:, 1]))

    assert np.sort(np.diff(made).ravel()) == pytest.approx(np.sort(np.diff(segments).ravel()))
    assert gaps(made) == pytest.approx(gaps(segments))


def value(table, measure, of):
    row = table[(table["measure"] == measure) & (table["of"] == of)]
    assert len(row) == 1
    return row.iloc[0]


def test_a_segmentation_agrees_with_itself_and_not_with_a_shuffled_one():
    rng = np.random.default_rng(1)
    cuts = np.cumsum(rng.uniform(0.15, 0.9, 60))
    segments = cuts.reshape(-1, 2)
    table = score(segments, segments, draws=50, rng=2)
    shares = table[(table["unit"] == "") & (table["measure"] != "")]
    assert shares["value"].to_numpy() == pytest.approx(1.0)
    assert (table.loc[table["unit"] == "s", "value"] == 0).all()
    scores = shares[shares["measure"] != "segments, share of the reference's"]
    assert (scores["chance_high"] < 0.95).all()
    late = score(segments + 0.06, segments, span_s=(0.0, cuts[-1] + 1))
    assert value(late, "median offset", "start")["value"] == pytest.approx(0.06)
    assert value(late, "boundary F1", "all, 0.1 s")["value"] == 1.0
    assert value(late, "boundary F1", "all, 0.05 s")["value"] < 0.2
    assert late["chance"].isna().all()


def test_what_cannot_be_scored_is_one_sentence():
    with pytest.raises(SignkinError, match=r"segment 2: it runs from 3\.000 s to 3\.000 s"):
        as_segments([(1, 2), (3, 3)])
    with pytest.raises(SignkinError, match="neither side has a segment"):
        score([], [])
    with pytest.raises(SignkinError, match="1 segments reach outside"):
        score([(0.0, 1.0)], [(0.0, 2.0)], span_s=(0.0, 1.5))
    one_side = score(np.empty((0, 2)), [(0.0, 1.0)], draws=3)
    assert value(one_side, "boundary hit rate", "all, 0.1 s")["value"] == 0
    assert np.isnan(value(one_side, "boundary precision", "all, 0.1 s")["value"])


@pytest.fixture
def session(tmp_path):
    """One ELAN file with the tiers of two annotators, the second of whom starts late."""
    first = [Interval(t, t + 0.6, "A", "one") for t in (1.0, 2.0, 3.0, 4.5)]
    second = [Interval(i.start_s + 0.08, i.end_s, "A", "two") for i in first[:3]]
    path = tmp_path / "session.eaf"
    write_eaf(path, author="t", date="2020-01-01T00:00:00+00:00", media_url="a.mp4",
              tiers=[("one", None, first), ("two", None, second)])  # fmt: skip
    return path


def test_the_command_scores_two_tiers_of_a_file(session, tmp_path, capsys):
    out = tmp_path / "deep" / "scores.csv"
    words = ["score", str(session), "--tier", "two", "--tier", "one", "--out", str(out)]
    assert main([*words, "--draws", "5"]) == 0
    told = capsys.readouterr().out
    assert "scored" in told and "3 segments" in told and "4 segments" in told
    table = pd.read_csv(out, keep_default_na=False, na_values=[""], dtype={"unit": str})
    assert value(table, "boundary hit rate", "end, 0.02 s")["value"] == 0.75
    assert value(table, "boundary hit rate", "start, 0.05 s")["value"] == 0
    assert value(table, "median offset", "start")["value"] == pytest.approx(0.08)


def test_the_command_scores_two_files_of_different_formats(session, tmp_path, capsys):
    grid = tmp_path / "model.srt"
    grid.write_text("1\n00:00:01,000 --> 00:00:01,600\nA\n\n2\n00:00:02,000 --> 00:00:02,600\nB\n")
    assert main(["score", str(grid), str(session), "--tier", "one", "--draws", "0"]) == 0
    told = capsys.readouterr().out
    assert "2 segments" in told and "4 segments" in told
    assert "boundary hit rate                    all, 0.02 s               0.500" in told
    assert main(["score", str(grid), str(session), "--draws", "0"]) == 1
    assert "2 tiers hold tags" in capsys.readouterr().err
    assert main(["score", str(session), "--tier", "one", "--tier", "three"]) == 1
    assert "three" in capsys.readouterr().err
    assert main(["score", str(session)]) == 1
    assert "two different ones of one file" in capsys.readouterr().err


def test_the_command_tells_of_tiers_of_different_length_and_of_empty_ones(tmp_path, capsys):
    whole = [Interval(t, t + 0.6, "A", "whole") for t in (9.0, 1.0, 2.0, 3.0)]  # not in order
    path = tmp_path / "session.eaf"
    write_eaf(path, author="t", date="2020-01-01T00:00:00+00:00", media_url="a.mp4",
              tiers=[("whole", None, whole), ("half", None, whole[2:]),
                     ("empty", None, [])])  # fmt: skip
    words = ["score", str(path), "--draws", "3", "--tier"]
    assert main([*words, "half", "--tier", "whole"]) == 0
    told = capsys.readouterr().out
    assert "reference: 2 of 4 segments lie before 2.000 s or after 3.600 s, where sc" in told
    assert "scored: 2 of" not in told
    assert main([*words, "empty", "--tier", "whole"]) == 1
    assert "tier 'empty': the tier is empty" in capsys.readouterr().err
    assert main([*words, "whole"]) == 1
    assert "1 tiers; expected two different ones of one file" in capsys.readouterr().err


def test_tags_out_of_order_and_at_one_instant_score_as_if_in_order():
    there = np.array([(1.0, 2.0), (2.0, 3.0), (3.5, 4.0)])
    table = score(there[::-1], there)
    assert (table.loc[table["unit"] == "", "value"] == 1).all()
    short = score(there[:1], there)
    assert value(short, "boundary hit rate", "all, 0.1 s")["value"] == pytest.approx(1 / 3)
    assert value(short, "boundary precision", "all, 0.1 s")["value"] == 1
