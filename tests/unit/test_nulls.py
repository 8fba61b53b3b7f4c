"""Nulls that keep the structure of tags: what they keep, their rate, and what they find."""

import numpy as np
import pandas as pd
import pytest

from signkin.corpus import load_corpus
from signkin.errors import SignkinError
from signkin.io.bvh import forward_kinematics
from signkin.kinematics.derivatives import speed
from signkin.kinematics.filters import lowpass
from signkin.kinematics.minima import speed_minima
from signkin.seeds import stream
from signkin.simulate import lsf
from signkin.simulate.body import Body
from signkin.statistics.nulls import (
    MEAN_SHARE,
    MEDIAN,
    POISSON,
    SHARE,
    Null,
    against_nulls,
    change_against_nulls,
    distances,
    placed,
    stretches,
)

SIGNS = np.array([[1.0, 1.4], [1.6, 1.8], [2.1, 2.9], [6.0, 6.3], [6.4, 7.0]])
MINIMA = np.array([0.5, 0.9, 1.45, 1.85, 2.05, 2.9, 4.5, 6.05, 6.35, 7.1, 8.0])


def test_signs_are_cut_at_pauses_with_the_minima_around_them():
    first, second = stretches(SIGNS, MINIMA, 100)
    assert first.signs_s.tolist() == SIGNS[:3].tolist()
    assert first.minima_s.tolist() == [0.9, 1.45, 1.85, 2.05, 2.9]
    assert second.minima_s.tolist() == [6.05, 6.35, 7.1]
    assert second.counted(True).tolist() == [[False, True], [True, False]]
    assert len(stretches(SIGNS, MINIMA, 100, pause_s=5)) == 1
    assert stretches(np.empty((0, 2)), MINIMA, 100) == []


def test_distances_by_hand():
    assert distances(np.array([0.0, 1.2, 9.0]), np.array([1.0, 2.0])) == pytest.approx([1, 0.2, 7])
    assert np.isinf(distances(np.array([1.0]), np.empty(0))).all()


def test_what_each_null_keeps():
    (part, _) = stretches(SIGNS, MINIMA, 100)
    rng = np.random.default_rng(1)
    lengths, gaps = np.sort(np.diff(part.signs_s, axis=1).ravel()), [0.2, 0.3]
    found = placed(part, Null.PERMUTATION, 200, rng)
    assert np.sort(found[..., 1] - found[..., 0], axis=1) == pytest.approx(
        np.tile(lengths, (200, 1))
    )
    assert np.sort(found[:, 1:, 0] - found[:, :-1, 1], axis=1) == pytest.approx(
        np.tile(gaps, (200, 1))
    )
    assert found[:, 0, 0] == pytest.approx(1.0) and found[:, -1, 1] == pytest.approx(2.9)
    assert len(np.unique(np.round(found[:, 0, 1], 6))) == 3  # each sign may come first
    shifted = placed(part, Null.SHIFT, 500, rng)
    apart = np.mod(shifted - shifted[:, :1, :1], 1.9)
    wanted = np.mod(part.signs_s - part.signs_s[0, 0], 1.9)
    assert np.abs(np.mod(apart - wanted + 0.5, 1.9) - 0.5).max() < 1e-9
    for times in (shifted, placed(part, Null.UNIFORM, 500, rng)):
        assert 1.0 <= times.min() < 1.1 and 2.8 < times.max() <= 2.9
        assert np.allclose(times * 100, np.rint(times * 100))  # on frames, as tags and minima


def test_shares_and_median_by_hand():
    parts = stretches(SIGNS, MINIMA, 100)
    table = against_nulls(parts, 200, np.random.default_rng(0), (0.05, 0.1))
    value = table[table["null"] == "uniform"].set_index(["measure", "window_s"])["value"]
    # Distances: .1 .05 .15 .05 .05 0, then .05 .05 .05 .1.
    assert value[SHARE, 0.05] == 0.7
    assert value[SHARE, 0.1] == 0.9
    assert value.xs(MEDIAN).item() == pytest.approx(0.05)
    assert value.xs(MEAN_SHARE).item() == pytest.approx(0.8)
    assert set(table["n"]) == {10} and set(table["stretches"]) == {2}
    inner = against_nulls(parts, 20, np.random.default_rng(0), (0.05, 0.1), transitions_only=True)
    assert set(inner["n"]) == {6}
    line = table[table["null"] == POISSON].set_index(["measure", "window_s"])["chance"]
    rates = np.array([4 / 1.9, 2 / 1.0])
    assert line[SHARE, 0.1] == pytest.approx(np.average(1 - np.exp(-0.2 * rates), weights=[6, 4]))
    half = line.xs(MEDIAN).item()
    assert np.average(1 - np.exp(-2 * half * rates), weights=[6, 4]) == pytest.approx(0.5)


def test_it_does_not_matter_how_a_transcript_is_cut():
    """Whole, or as recordings that begin and end in pauses: the very same numbers."""
    rng = np.random.default_rng(5)
    signs, minima = transcript(rng, 30)
    whole = stretches(signs, minima, 100)
    cut = []
    for part in whole:
        low, high = part.span_s
        near = (minima > low - 0.5) & (minima < high + 0.5)  # a recording with some rest
        cut += stretches(part.signs_s, minima[near], 100)
    assert len(whole) > 5
    a, b = (against_nulls(p, 300, np.random.default_rng(2)) for p in (whole, cut))
    pd.testing.assert_frame_equal(a, b)


def transcript(rng, signs, near=0.0):
    """Signs with pauses between some, and minima about evenly spaced; a share of tags on them."""
    lengths = rng.integers(15, 60, signs) / 100
    gaps = rng.integers(8, 45, signs) / 100 + 3.0 * (rng.random(signs) < 0.3)
    starts = np.cumsum(np.r_[1.0, (lengths + gaps)[:-1]])
    tags = np.column_stack([starts, starts + lengths])
    steps = rng.integers(18, 32, int(tags.max() / 0.18) + 20) / 100
    minima = np.round(0.5 + np.cumsum(steps), 2)
    drawn = rng.random(tags.shape) < near
    closest = minima[np.abs(minima[:, None] - tags.ravel()).argmin(axis=0)].reshape(tags.shape)
    return np.round(np.where(drawn, closest, tags), 2), minima


def rejected(made, runs, draws=99):
    """Return the share of runs that each null rejects at 5 %, by the mean share."""
    counts = dict.fromkeys(Null, 0)
    for seed in range(runs):
        parts = made(np.random.default_rng(seed))
        table = against_nulls(parts, draws, np.random.default_rng(10_000 + seed))
        p = table[table["measure"] == MEAN_SHARE].set_index("null")["p"]
        for null in Null:
            counts[null] += p[null] <= 0.05
    return {null: count / runs for null, count in counts.items()}


def test_tags_apart_from_minima_are_rejected_at_the_nominal_rate():
    """Negative control: 200 transcripts whose tags know nothing of the minima."""
    rates = rejected(lambda rng: stretches(*transcript(rng, 25), 100), 200)
    assert all(0.01 <= rate <= 0.095 for rate in rates.values()), rates  # 3 standard errors


def lockstep(rng):
    """Signs and minima of one period, at a random phase: all tags are near, or none is."""
    starts = 1 + 0.6 * np.arange(12)
    minima = 0.4 + 0.3 * np.arange(30) + rng.integers(0, 30) / 100
    return stretches(np.column_stack([starts, starts + 0.3]), np.round(minima, 2), 100)


def test_where_all_share_a_rhythm_only_the_shift_keeps_its_level():
    rates = rejected(lockstep, 150)
    assert rates[Null.SHIFT] <= 0.12
    assert rates[Null.UNIFORM] >= 0.25


def test_tags_on_minima_are_found():
    rates = rejected(lambda rng: stretches(*transcript(rng, 25, 0.7), 100), 20)
    assert min(rates.values()) >= 0.8


def test_the_simulated_corpus_rejects_every_null(root):
    """Positive control: lsf-sim, whose tags stand beside true boundaries by a tagger's jitter."""
    corpus = load_corpus(root / "corpora/lsf-sim")
    published = pd.read_csv(root / "papers/naert2017/table2.csv", dtype=str, keep_default_na=False)
    theta = np.array([0.148777, 0.663958, 0.275229])
    made = lsf.simulate(
        ["one", "two"], corpus.lexicon, published, theta, 0.06075, 0.1, stream(2017, "lsf-sim")
    )
    joints = list(Body().hierarchy.joints)
    parts = []
    for recording in made.recordings:
        positions, _ = forward_kinematics(Body().hierarchy, recording.values)
        wrist = positions[:, joints.index("RightHand")]
        values = speed(lowpass(wrist, 100.0, cutoff_hz=8.0), 100.0)
        minima = speed_minima(values, 100.0, prominence=0.05 * np.nanpercentile(values, 95))
        for utterance in recording.utterances:
            tags = np.array([(t.start, t.end) for t in utterance]) / 100
            parts += stretches(tags, minima, 100)
    for transitions_only in (False, True):
        found = against_nulls(
            parts, 499, stream(1, "lsf-sim", "nulls"), transitions_only=transitions_only
        )
        rows = found[(found["measure"] == MEAN_SHARE) & (found["null"] != POISSON)]
        assert (rows["p"] <= 0.01).all()
        assert (rows["value"] > rows["chance_high"]).all()


def test_changes_of_durations_beside_those_of_tags_by_chance():
    """Minima every 0.4 s: a tag by chance moves 0.1 s; tags on minima do not move at all."""
    minima = np.arange(0, 40, 0.4)
    on = np.column_stack([minima[2:90:3], minima[3:91:3]])
    still = change_against_nulls(stretches(on, minima, 100.0), 60, np.random.default_rng(1), 0.2)
    assert (still["value"] == 0).all() and (still["chance_low"] > 0.05).any()
    off = on + np.array([0.1, -0.05])
    moved = change_against_nulls(stretches(off, minima, 100.0), 60, np.random.default_rng(1), 0.2)
    assert moved["value"].to_numpy() == pytest.approx(0.15)
    assert moved["n"].tolist() == [len(on) - 1] * 3
    with pytest.raises(SignkinError, match="no transition to compare"):
        change_against_nulls(stretches(on[:1], minima, 100.0), 9, np.random.default_rng(1), 0.2)


def test_what_cannot_be_compared_is_one_sentence():
    with pytest.raises(SignkinError, match="no tag to compare with chance"):
        against_nulls([], 10, np.random.default_rng(0))
    alone = stretches([[1.0, 2.0]], [1.0], 100)
    with pytest.raises(SignkinError, match="no tag to compare"):
        against_nulls(alone, 10, np.random.default_rng(0), transitions_only=True)
    with pytest.raises(SignkinError, match="1 minima have no time"):
        stretches([[1.0, 2.0]], [1.0, np.nan], 100)
    with pytest.raises(SignkinError, match="the rate is 0 Hz"):
        stretches([[1.0, 2.0]], [1.0], 0)
    silent = against_nulls(stretches([[1.0, 2.0]], [], 100), 10, np.random.default_rng(0))
    assert (silent.loc[silent["measure"] != MEDIAN, "value"] == 0).all()
    assert silent.loc[silent["p"].notna(), "p"].eq(1).all()
