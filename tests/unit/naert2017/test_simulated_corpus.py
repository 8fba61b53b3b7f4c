from collections import Counter
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signkin import SignkinError
from signkin.corpus import load_corpus
from signkin.io.bvh import forward_kinematics
from signkin.seeds import stream
from signkin.simulate import lsf
from signkin.simulate.body import Body
from signkin.simulate.chains import chains, fewest_chains
from signkin.simulate.lsf import motion
from signkin.simulate.printed import integers_with, sums_from_print
from signkin.simulate.surface import design_distances

THETA = np.array([0.148777, 0.663958, 0.275229])


@pytest.fixture(scope="module")
def published(root):
    return pd.read_csv(root / "papers/naert2017/table2.csv", dtype=str, keep_default_na=False)


def test_every_printed_row_allows_one_sum_and_one_sum_of_squares(published):
    filled = published[published["n"] != "0"]
    found = {r.type: sums_from_print(int(r.n), r.mean, r.sd, "0.01") for r in filled.itertuples()}
    assert len(found) == 13
    assert found["1110"] == (413, 11667)
    assert sums_from_print(8, "0.3150", "0.041057", "0.01") == (252, 14297 - 79**2)
    with pytest.raises(SignkinError, match="allow 0 pairs"):
        sums_from_print(6, "0.26933", "0.095167", "0.01")
    with pytest.raises(SignkinError, match=r"allow \d+ pairs"):
        sums_from_print(6, "0.27", "0.1", "0.01")


@given(st.lists(st.integers(10, 50), min_size=2, max_size=16), st.integers(0, 100))
@settings(max_examples=60, deadline=None)
def test_integers_with_a_given_sum_and_sum_of_squares(values, seed):
    total, squares = sum(values), sum(v * v for v in values)
    rng = np.random.default_rng(seed)
    found = integers_with(len(values), total, squares, 10, 50, rng)
    assert (sum(found), sum(v * v for v in found)) == (total, squares)
    assert 10 <= min(found) <= max(found) <= 50


def counts_of(published):
    filled = published[published["n"] != "0"]
    return {(k[:2], k[2:]): int(n) for k, n in zip(filled["type"], filled["n"], strict=True)}


def test_the_printed_counts_need_five_chains(published):
    assert fewest_chains(counts_of(published)) == 5


@pytest.mark.parametrize("number", [5, 9, 14])
def test_chains_have_exactly_the_transitions(published, number):
    counts = counts_of(published)
    found = chains(counts, number, 40, np.random.default_rng(number))
    assert len(found) == number
    steps = Counter(step for chain in found for step in pairwise(chain))
    assert steps == Counter(counts)


def test_closed_chains_too():
    found = chains({("a", "b"): 2, ("b", "a"): 2}, 1, 9, np.random.default_rng(0))
    assert len(found) == 1
    assert len(found[0]) == 5


@given(st.integers(0, 1000))
@settings(max_examples=10, deadline=None)
def test_designed_distances_give_theta_and_the_mean_error(seed):
    rng = np.random.default_rng(seed)
    d = np.clip(rng.normal(0.3, 0.09, 89), 0.1, 0.5)
    d[0] = 0.79
    far = rng.random(89) < 0.1
    g, e = design_distances(d, THETA, 0.06075, far, rng)
    x = np.column_stack([np.ones(89), g, e])
    theta, *_ = np.linalg.lstsq(x, d, rcond=None)
    assert theta == pytest.approx(THETA, abs=1e-6)
    assert np.abs(d - x @ theta).mean() == pytest.approx(0.06075, abs=1e-9)
    assert g.min() > 0
    assert e.min() > 0


def test_the_body_is_placed_as_the_reader_places_it():
    body = Body()
    rng = np.random.default_rng(0)
    coordinates = rng.uniform(-0.4, 0.4, (5, 24))
    rotations = body.rotations(coordinates[:, :12], coordinates[:, 12:])
    expected, _ = body.place(rotations)
    values = motion.channel_values(coordinates, body, quiet())
    positions, _ = forward_kinematics(body.hierarchy, values)
    assert positions == pytest.approx(expected, abs=1e-9)


def quiet():
    """Return a generator without noise: all draws are zero."""

    class Quiet:
        def normal(self, mean, sd, size):
            return np.zeros(size)

        def uniform(self, low, high, size):
            return np.zeros(size)

    return Quiet()


def test_the_same_coordinates_on_both_arms_mirror_each_other():
    body = Body()
    arm = np.random.default_rng(1).uniform(-0.4, 0.4, (1, 12))
    positions, _ = body.place(body.rotations(arm, arm))
    names = body.hierarchy.joints
    right, left = (positions[0, names.index(f"{s}Middle3")] for s in ("Right", "Left"))
    assert right * [-1, 1, 1] == pytest.approx(left)
    assert right[0] < 0 < right[2]


def test_minimum_jerk_rests_at_its_keys():
    at = np.arange(0, 1.0001, 0.001)
    path = motion.minimum_jerk([0, 1], [np.zeros(1), np.ones(1)], at)[:, 0]
    assert path[[0, 500, 1000]] == pytest.approx([0, 0.5, 1])
    v = np.gradient(path, at)
    assert v.max() == pytest.approx(1.875, abs=1e-3)
    assert v[[0, -1]] == pytest.approx([0, 0], abs=1e-3)


@pytest.fixture(scope="module")
def simulated(root, published):
    corpus = load_corpus(root / "corpora/lsf-sim")

    def make():
        return lsf.simulate(
            ["one", "two"], corpus.lexicon, published, THETA, 0.06075, 0.1, stream(2017, "lsf-sim")
        )

    return make(), make


def test_the_corpus_has_what_the_print_says(simulated, published):
    corpus, _ = simulated
    design = corpus.design
    assert len(design) == 89
    assert design["type"].value_counts().to_dict() == {
        k: int(n) for k, n in zip(published["type"], published["n"], strict=True) if n != "0"
    }
    frames = (design["duration_s"] * 100).round().astype(int)
    assert sorted(frames)[-1] == 79
    assert sorted(frames)[0] >= 10
    assert sorted(frames)[-2] <= 50
    assert sum(len(r.utterances) for r in corpus.recordings) >= 5


def test_truth_is_near_the_tags_and_in_order(simulated):
    corpus, _ = simulated
    for recording in corpus.recordings:
        tokens = [t for utterance in recording.utterances for t in utterance]
        right = np.array([t.true_s["right"] for t in tokens]).ravel()
        assert (np.diff(right) > 0).all()
        tags = np.array([(t.start, t.end) for t in tokens]).ravel() / 100
        assert np.abs(right - tags).max() < 0.15
    truth = corpus.truth
    assert set(truth["hand"]) == {"right", "left"}
    assert not truth.duplicated(["recording", "sign", "edge", "hand"]).any()


def test_the_same_seed_gives_the_same_bytes(simulated, tmp_path):
    corpus, make = simulated
    again = make()
    for i, c in enumerate((corpus, again)):
        lsf.write_motion(c.recordings[0], tmp_path / f"{i}.bvh")
        lsf.write_tags(c.recordings[0], tmp_path / f"{i}.eaf")
    assert (tmp_path / "0.bvh").read_bytes() == (tmp_path / "1.bvh").read_bytes()
    assert (tmp_path / "0.eaf").read_bytes() == (tmp_path / "1.eaf").read_bytes()
    pd.testing.assert_frame_equal(corpus.truth, again.truth)
