"""The simulated single signs: what is known of them by design, found in what is written."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from signkin import SignkinError, read_recording, tables
from signkin.corpus import load_corpus
from signkin.io.wide_csv import digits_for, write_wide_csv
from signkin.simulate import isl
from signkin.simulate.strokes import SHARES, Stroke, share_done, superposed


@pytest.fixture(scope="module")
def corpus(root):
    return load_corpus(root / "corpora/isl-sim")


@pytest.fixture(scope="module")
def takes(corpus):
    return isl.simulate(corpus.entries, corpus.name, corpus.noise_sd, seed=2017)


def test_the_design_is_two_signers_two_signs_twenty_repetitions(corpus):
    keys = {(e.signer, e.sign, e.repetition) for e in corpus.entries}
    assert len(keys) == len(corpus.entries) == 80
    assert len({e.signer for e in corpus.entries}) == len({e.sign for e in corpus.entries}) == 2
    assert {e.repetition for e in corpus.entries} == set(range(1, 21))
    assert corpus.settings["motion"]["rate_hz"] == isl.RATE_HZ


def test_a_stroke_is_of_least_jerk():
    """Flash & Hogan: rest at both ends, peak speed 1.875 of the mean one, in the middle."""
    t = np.linspace(0, 0.5, 2001)
    path = superposed(np.zeros(3), [Stroke(0.0, 0.5, np.array([0.0, 0.3, 0.4]))], t)
    speed = np.linalg.norm(np.gradient(path, t, axis=0), axis=1)
    assert path[[0, -1]] == pytest.approx(np.array([[0, 0, 0], [0, 0.3, 0.4]]))
    assert speed.max() == pytest.approx(1.875 * 0.5 / 0.5, rel=1e-5)
    assert t[speed.argmax()] == pytest.approx(0.25, abs=1e-3)
    assert speed[[0, -1]].max() < 1e-3
    assert share_done(np.array([-1.0, 2.0])).tolist() == [0, 1]


def test_strokes_overlap_and_hands_rest_before_and_after(takes):
    for take in takes:
        onsets = np.array([s.onset_s for s in take.strokes])
        ends = np.array([s.offset_s for s in take.strokes])
        assert (np.diff(onsets) > 0.1).all()
        assert (onsets[1:] < ends[:-1]).all()
        assert isl.REST_S[0] <= onsets[0] <= isl.REST_S[1]
        last = len(take.path) / isl.RATE_HZ
        assert isl.REST_S[0] - 0.01 <= last - ends.max() <= isl.REST_S[1] + 0.01
        speed = np.linalg.norm(np.diff(take.path, axis=0), axis=1) * isl.RATE_HZ
        t = (np.arange(len(speed)) + 0.5) / isl.RATE_HZ
        still = (t < onsets[0] - 0.01) | (t > ends.max() + 0.01)
        assert speed[still].max() < 0.02
        assert speed[~still].max() > 40 * speed[still].max()


def test_durations_and_peak_speeds_are_those_of_signing(takes):
    lengths = [max(s.offset_s for s in t.strokes) - t.strokes[0].onset_s for t in takes]
    peaks = [np.linalg.norm(np.diff(t.path, axis=0), axis=1).max() * isl.RATE_HZ for t in takes]
    assert min(lengths) > 1.1
    assert max(lengths) < 2.3
    assert 1.2 < np.median(lengths) < 2.0
    assert min(peaks) > 0.9
    assert max(peaks) < 2.3


def test_the_path_is_that_of_the_strokes_but_for_the_sway(takes):
    take = takes[25]
    t = np.arange(len(take.path)) / isl.RATE_HZ
    rest = take.path[: int(0.2 * isl.RATE_HZ)].mean(axis=0)
    rebuilt = superposed(rest, take.strokes, t)
    assert np.abs(rebuilt - take.path).max() < 5 * isl.SWAY_M


def test_the_noise_is_white_and_as_large_as_said(takes, corpus):
    noise = np.concatenate([take.measured["right"] - take.path for take in takes])
    assert noise.std(axis=0) == pytest.approx(corpus.noise_sd, rel=0.01)
    assert np.abs(noise.mean(axis=0)).max() < 5 * corpus.noise_sd / np.sqrt(len(noise))
    for lag in (1, 2, 10):
        r = (noise[lag:] * noise[:-lag]).mean() / noise.var()
        assert abs(r) < 4 / np.sqrt(noise.size)
    between = np.corrcoef(noise.T)[np.triu_indices(3, 1)]
    assert np.abs(between).max() < 4 / np.sqrt(len(noise))


@pytest.mark.parametrize("noise_sd", [0.0008, 1e-9])
def test_the_noise_survives_the_file(takes, corpus, tmp_path, noise_sd):
    """Its SD is found in what was written, however small: the file's digits follow it."""
    entry = corpus.entries[3]
    take = isl.simulate([entry], corpus.name, noise_sd, 2017)[0]
    write_wide_csv(tmp_path / "x.csv", isl.motion_columns(take), noise_sd)
    spec = corpus.motion_spec(entry)
    read = read_recording(tmp_path / "x.csv", **spec)
    assert (read.frames, read.rate_hz, read.unit) == (len(take.path), 240.0, "m")
    error = read.track("right_wrist") - take.path
    assert error.std() == pytest.approx(noise_sd, rel=0.05)
    assert np.abs(read.track("left_wrist") - take.measured["left"]).max() <= noise_sd / 1000
    assert len(np.unique(np.round(error / noise_sd, 6))) > 0.9 * error.size


def test_digits_follow_the_noise():
    assert [digits_for(sd) for sd in (0.0008, 0.001, 1e-9, 2.0)] == [7, 6, 12, 3]
    with pytest.raises(SignkinError, match="a noise of 0; expected a standard deviation above 0"):
        digits_for(0.0)


def test_a_recording_depends_on_its_name_and_the_seed_alone(takes, corpus):
    entry = corpus.entries[40]
    alone = isl.simulate([entry], corpus.name, corpus.noise_sd, 2017)[0]
    assert (alone.measured["right"] == takes[40].measured["right"]).all()
    other_seed = isl.simulate([entry], corpus.name, corpus.noise_sd, 2018)[0]
    assert not np.array_equal(other_seed.strokes[0].onset_s, alone.strokes[0].onset_s)
    louder = isl.simulate([entry], corpus.name, 0.01, 2017)[0]
    assert (louder.path == alone.path).all()


def resampled(take):
    """Return the path from first onset to last offset at 50 shares of its time, from its middle."""
    first, end = take.strokes[0].onset_s, max(s.offset_s for s in take.strokes)
    frames = np.linspace(first, end, 50) * isl.RATE_HZ
    path = np.column_stack(
        [np.interp(frames, np.arange(len(take.path)), take.path[:, i]) for i in range(3)]
    )
    return path - path.mean(axis=0)


def test_signs_differ_more_than_signers_and_signers_more_than_repetitions(takes, corpus):
    groups = {}
    for entry, take in zip(corpus.entries, takes, strict=True):
        groups.setdefault((entry.sign, entry.signer), []).append(resampled(take))
    means = {key: np.mean(paths, axis=0) for key, paths in groups.items()}

    def apart(a, b):
        return float(np.sqrt(((a - b) ** 2).sum(axis=1).mean()))

    again = np.mean([apart(p, means[key]) for key, paths in groups.items() for p in paths])
    signers = np.mean([apart(means[s, "sim-1"], means[s, "sim-2"]) for s in ("loop", "fold")])
    signs = np.mean([apart(means["loop", g], means["fold", g]) for g in ("sim-1", "sim-2")])
    assert 0.005 < again < signers < signs


def test_the_truth_is_told_in_declared_tables(takes, tmp_path):
    tables.write_table(isl.stroke_table(takes), tmp_path / "strokes.csv", "strokes")
    strokes = tables.read_table(tmp_path / "strokes.csv", "strokes")
    assert strokes.groupby("recording").size().to_dict() == {
        take.recording: len(take.strokes) for take in takes
    }
    moved = np.linalg.norm(strokes[["dx_m", "dy_m", "dz_m"]], axis=1)
    assert moved == pytest.approx(strokes["length_m"], abs=1e-8)
    tables.write_table(isl.path_table(takes), tmp_path / "true_path.parquet", "true_path")
    path = pd.read_parquet(tmp_path / "true_path.parquet")
    rows = path[path["recording"] == takes[7].recording]
    assert (rows[[f"right_wrist_{a}_m" for a in "xyz"]].to_numpy() == takes[7].path).all()
    with pytest.raises(SignkinError, match="columns missing: frame"):
        tables.write_table(path.drop(columns="frame"), tmp_path / "p.parquet", "true_path")


def test_a_sign_or_signer_that_it_does_not_know_is_named(corpus):
    entry = replace(corpus.entries[0], sign="CAKE")
    with pytest.raises(SignkinError, match=r"loop_sim-1_01: the sign 'CAKE' .*expected loop, fold"):
        isl.simulate([entry], "isl-sim", 0.001, 1)
    entry = replace(corpus.entries[0], signer="me")
    with pytest.raises(SignkinError, match=r"the signer 'me' .*expected sim-1, sim-2"):
        isl.simulate([entry], "isl-sim", 0.001, 1)


@pytest.mark.parametrize(("order", "peak"), [(3, 1.5), (5, 1.875), (7, 2.1875)])
def test_strokes_rest_at_both_ends_in_what_they_make_least(order, peak):
    """Peak over mean speed; derivatives below acceleration, jerk or snap are 0 at both ends."""
    share = np.polynomial.Polynomial(SHARES[order])
    assert share.degree() == order and share(0) == 0 and share(1) == pytest.approx(1)
    for derivative in range(1, (order + 1) // 2):
        assert share.deriv(derivative)(np.array([0.0, 1.0])) == pytest.approx(0, abs=1e-9)
    assert share.deriv((order + 1) // 2)(0) != 0
    assert share.deriv()(0.5) == pytest.approx(peak)
    tau = np.linspace(0, 1, 11)
    assert share_done(tau, order) == pytest.approx(share(tau), abs=1e-12)
    with pytest.raises(SignkinError, match="no stroke is of order 4"):
        share_done(tau, 4)


@pytest.mark.parametrize("recipe", [isl.Recipe(3), isl.Recipe(7, 3)])
def test_a_recipe_keeps_the_design(corpus, takes, recipe):
    made = isl.simulate(corpus.entries[:2], corpus.name, corpus.noise_sd, 2017, recipe)
    for take, known in zip(made, takes, strict=False):
        assert len(take.strokes) == recipe.parts * len(known.strokes)
        assert {s.order for s in take.strokes} == {recipe.order}
        for i, whole in enumerate(known.strokes):
            parts = take.strokes[i * recipe.parts : (i + 1) * recipe.parts]
            assert sum(p.displacement_m for p in parts) == pytest.approx(whole.displacement_m)
            assert parts[0].onset_s == whole.onset_s
            assert parts[-1].offset_s == pytest.approx(whole.offset_s)
        ends = isl.stroke_ends(take, 0.5, 1.5)
        assert (np.diff(ends) > 0).all() and ends.min() > 0 and ends.max() < 1
    # Between the ends of strokes the path is a polynomial of that order, beside the slow sway.
    take = isl.simulate(corpus.entries[:1], corpus.name, corpus.noise_sd, 2017, recipe)[0]
    ends = isl.stroke_ends(take)
    i = int(np.argmax(np.diff(ends)))
    t = np.arange(len(take.path)) / isl.RATE_HZ
    inside = (t > ends[i]) & (t < ends[i + 1])
    for order, most in ((recipe.order, 1e-4), (1, np.inf)):
        fitted = np.polynomial.Polynomial.fit(t[inside], take.path[inside, 0], order)
        assert np.abs(fitted(t[inside]) - take.path[inside, 0]).max() < most


def test_no_parts_are_refused():
    with pytest.raises(SignkinError, match="0 parts"):
        isl.Recipe(parts=0)
