"""Wrists of continuous recordings as long series."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from signkin import tables
from signkin.studies.one_wrist import long_series as module
from signkin.studies.one_wrist.long_series import long_series
from signkin.studies.one_wrist.settings import SeriesSettings
from support.endres import corpus_of, recording_of, settings

RATE = 50.0
OWN = SeriesSettings.of(settings(continuous={"bin_s": 0.04, "longest_segment_s": 1.0, "order": 1}))
CORNERS_S = (0.8, 1.6, 2.4)


def zigzag(size=0.2, seconds=3.2, seed=0):
    """Return a path that turns at CORNERS_S, (F, 3); in between it goes straight on."""
    t = np.arange(round(seconds * RATE)) / RATE
    knots = [0, *CORNERS_S, seconds]
    places = np.random.default_rng(seed).uniform(-1, 1, (len(knots), 3))
    places[1::2] += 1.0
    path = np.column_stack([np.interp(t, knots, column) for column in places.T])
    return size * path


def test_turns_of_both_wrists_are_found():
    recordings = [recording_of("a", zigzag(seed=1), zigzag(seed=2), RATE)]
    corpus = corpus_of(["a"], noise_sd=0.002)
    found = long_series(corpus, recordings, OWN, 1)
    about = found.table("wrist_posteriors", "m")
    assert list(about.columns) == tables.TABLES["wrist_posteriors"].names("m")
    assert about["hand"].tolist() == ["right", "left"]
    bins = round((160 - 1) / RATE / 0.04)
    assert (about["n_bins"] == bins).all()
    assert about["bin_s"].to_numpy() == pytest.approx(159 / RATE / bins)
    ends = found.table("wrist_boundaries", "m")
    for row in about.itertuples():
        times = ends.loc[ends["hand"] == row.hand, "boundary_s"].to_numpy()
        assert len(times) == row.map_count or row.note
        assert row.boundaries_per_s == pytest.approx(len(times) / (bins * row.bin_s))
        for corner in CORNERS_S:
            assert np.abs(times - corner).min() < 0.09
        assert row.explained_variance > 0.99
        assert row.cut_mass < 1e-6
    assert ends["probability"].between(0, 1).all() and (ends["probability"] > 0.05).all()
    assert found.table("binning_left_out", "m").empty


def test_flat_recordings_in_pixels_take_two_dimensions(monkeypatch):
    path = 1000 * zigzag(seed=1)
    path[:, 2] = 0
    seen = []
    original = module.fit_many

    def spy(trajectories, *rest, **more):
        seen.extend(x.shape for x in trajectories)
        return original(trajectories, *rest, **more)

    monkeypatch.setattr(module, "fit_many", spy)
    corpus = corpus_of(["flat"], noise_sd=2.0, unit="px")
    found = long_series(corpus, [recording_of("flat", path, path, RATE, unit="px")], OWN, 1)
    assert {shape[1] for shape in seen} == {2} and len(seen) == 2
    assert len(found.posteriors) == 2
    times = np.array([r["boundary_s"] for r in found.boundaries if r["hand"] == "right"])
    assert all(np.abs(times - corner).min() < 0.09 for corner in CORNERS_S)


def test_what_cannot_be_binned_is_listed_and_the_rest_goes_on():
    gaps, nothing = zigzag(), np.full((160, 3), np.nan)
    gaps[60:90] = np.nan  # 0.6 s
    filled = zigzag(seed=1)
    filled[60:68] = np.nan  # 0.16 s
    few = zigzag(seconds=3.2)[:3]
    recordings = [
        recording_of("gaps", gaps, zigzag(seed=2), RATE),
        recording_of("still", filled, None, RATE),
        recording_of("nothing", zigzag(), nothing, RATE),
        recording_of("few", few, few, RATE),
        recording_of("slow", zigzag()[::4], zigzag()[::4], 12.5),
    ]
    corpus = corpus_of([r.name for r in recordings], noise_sd=0.002)
    high = replace(OWN, continuous=OWN.continuous.model_copy(update={"order": 3}))
    found = long_series(corpus, recordings, high, 1)
    binned = [(r["recording"], r["hand"]) for r in found.posteriors]
    assert binned == [("gaps", "left"), ("still", "right"), ("nothing", "right")]
    reasons = {(r["recording"], r["dataset"]): r["reason"] for r in found.left_out}
    assert len(reasons) == 10 - len(binned)
    assert "recording gaps, right_wrist: 30 frames without a" in reasons["gaps", "right wrist"]
    assert "the wrist does not move" in reasons["still", "left wrist"]
    assert "recording nothing, left_wrist" in reasons["nothing", "left wrist"]
    assert "160 frames without a position" in reasons["nothing", "left wrist"]
    assert "recording few: 1 bins; expected more than the order, 3" in reasons["few", "left wrist"]
    assert "recording slow" in reasons["slow", "right wrist"]
    assert "12.5 Hz" in reasons["slow", "right wrist"]


def test_the_number_of_workers_changes_nothing():
    recordings = [recording_of(f"r{i}", zigzag(seed=i), zigzag(seed=9 + i), RATE) for i in range(3)]
    corpus = corpus_of([r.name for r in recordings], noise_sd=0.002)
    one, two = (long_series(corpus, recordings, OWN, n) for n in (1, 2))
    for name in ("wrist_posteriors", "wrist_boundaries"):
        pd.testing.assert_frame_equal(one.table(name, "m"), two.table(name, "m"), check_exact=True)
