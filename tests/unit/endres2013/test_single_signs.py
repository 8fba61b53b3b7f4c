"""Recordings of single signs into bins, and what is left out."""

import re
from dataclasses import replace

import numpy as np
import pytest

from signkin import tables
from signkin.errors import SignkinError
from signkin.kinematics import lowpass
from signkin.studies.endres2013.single_signs import (
    POWERLAW,
    RECORDED,
    example_points,
    movement_of,
    read_trajectories,
    recorded,
    single_signs,
    write_trajectories,
)
from support.endres import arc, corpus_of, recording_of
from support.endres import cut as cut_settings


def test_the_hand_that_moves_more_is_taken():
    small = 0.5 * arc()
    assert movement_of(recording_of("a", arc(), small), cut_settings()).wrist.hand == "right"
    left = movement_of(recording_of("a", small, arc()), cut_settings())
    assert left.wrist.hand == "left"
    assert left.wrist.path == pytest.approx(lowpass(arc(), 100.0, 6.0, method="fir"))
    moving = np.linalg.norm(np.gradient(left.wrist.path, 0.01, axis=0), axis=1)
    # Endres et al. 2.4: the ends below 15 % of the top speed are left out.
    inside = moving > 0.15 * moving.max()
    assert left.active.start == pytest.approx(np.argmax(inside), abs=1)
    assert left.active.stop == pytest.approx(len(inside) - np.argmax(inside[::-1]), abs=1)


def test_a_short_gap_is_filled():
    path = arc()
    path[80:90] = np.nan  # 0.1 s
    filled = movement_of(recording_of("a", path), cut_settings()).wrist.path
    whole = movement_of(recording_of("a", arc()), cut_settings()).wrist.path
    assert np.abs(filled - whole).max() < 0.02 * np.ptp(whole, axis=0).max()


def spoiled(kind):
    """Return a recording that cannot be cut."""
    path, rate = arc(), 100.0
    if kind == "gap":
        path[60:100] = np.nan
    elif kind == "still":
        path[:] = 0.3
    elif kind == "slow":
        path, rate = path[::8], 12.5
    return recording_of(f"bad_{kind}", path, rate_hz=rate)


REASONS = {
    "gap": r"recording bad_gap, right_wrist: 40 frames without a position; expected a path",
    "still": r"recording bad_still, right_wrist: the wrist does not move; expected a movement",
    "slow": r"recording bad_slow, lowpass: a rate of 12\.5 Hz; expected 15 Hz or more",
}


@pytest.mark.parametrize("kind", REASONS)
def test_what_cannot_be_cut_says_why_and_names_the_recording(kind):
    with pytest.raises(SignkinError, match=REASONS[kind]):
        movement_of(spoiled(kind), cut_settings())


def test_a_movement_of_one_sample_is_refused():
    movement = movement_of(recording_of("a", arc()), cut_settings())
    with pytest.raises(SignkinError, match=r"recording a: the movement has 1 samples"):
        recorded(replace(movement, active=slice(80, 81)), 100)


def test_every_recording_is_cut_or_listed():
    good = [recording_of(f"good_{i}", arc(seed=i)) for i in range(2)]
    # 0.6 s of movement holds no three segments of more than 300 ms.
    short = recording_of("short", arc(seconds=0.7))
    bad = [spoiled(kind) for kind in REASONS]
    recordings = [*good, short, *bad]
    corpus = corpus_of([r.name for r in recordings])
    out = single_signs(corpus, recordings, cut_settings(bins=50), 3)

    cut = [(t.recording, t.dataset) for t in out.trajectories]
    listed = [(row["recording"], row["dataset"]) for row in out.left_out]
    both = [(r.name, dataset) for r in recordings for dataset in (RECORDED, POWERLAW)]
    assert sorted(cut + listed) == sorted(both)  # each once
    assert {name for name, _ in listed} == {"short", *(r.name for r in bad)}
    assert cut == [(f"good_{i}", d) for i in range(2) for d in (RECORDED, POWERLAW)] + [
        ("short", RECORDED)
    ]
    reasons = {(row["recording"], row["dataset"]): row["reason"] for row in out.left_out}
    assert re.search(
        r"the active part of 0\.\d{3} s has no room for 3 segments of more than 0.3 s",
        reasons["short", POWERLAW],
    )
    for kind, reason in REASONS.items():
        for dataset in (RECORDED, POWERLAW):
            assert re.search(reason, reasons[f"bad_{kind}", dataset])

    for t in out.trajectories:
        # The short movement has fewer samples than bins wanted.
        assert t.x.shape == ((50, 3) if t.recording != "short" else (round(t.duration_s * 100), 3))
        assert t.duration_s == pytest.approx(len(t.x) * t.bin_s)
        if t.dataset == RECORDED:
            assert len(t.boundaries_s) == 0
        else:
            assert len(t.boundaries_s) == 2
            assert (np.diff([0, *t.boundaries_s, t.duration_s]) > 0.3 - 0.01).all()
    for name in ("ground_truth", "rejected_draws", "binning_left_out"):
        assert list(out.table(name, "m").columns) == tables.TABLES[name].names("m")
    truth = out.table("ground_truth", "m")
    assert truth["recording"].tolist() == ["good_0"] * 3 + ["good_1"] * 3
    assert truth["segment"].tolist() == [1, 2, 3] * 2
    ends = truth["duration_s"].groupby(truth["recording"]).cumsum()
    assert truth["end_s"].to_numpy() == pytest.approx(ends.to_numpy())
    rejected = out.table("rejected_draws", "m")
    drawn = truth.groupby("recording")["draws"].first()
    for name, rows in rejected.groupby("recording"):
        assert rows["rejected"].sum() == drawn[name] - 1


def test_a_recording_does_not_depend_on_the_others():
    recordings = [recording_of(f"r{i}", arc(seed=i)) for i in range(3)]
    corpus = corpus_of([r.name for r in recordings])
    whole = single_signs(corpus, recordings, cut_settings(), 3).trajectories
    alone = single_signs(corpus, recordings[2:], cut_settings(), 3).trajectories
    for a, b in zip(whole[4:], alone, strict=True):
        assert (a.x == b.x).all() and (a.boundaries_s == b.boundaries_s).all()
    other = single_signs(corpus, recordings[2:], cut_settings(), 4).trajectories
    assert (other[0].x == alone[0].x).all()
    assert (other[1].boundaries_s != alone[1].boundaries_s).all()


def test_flat_recordings_have_two_dimensions():
    path = 1000 * arc()
    path[:, 2] = 0
    recording = recording_of("flat", path, unit="px")
    corpus = corpus_of(["flat"], noise_sd=1.0, unit="px")
    out = single_signs(corpus, [recording], cut_settings(), 3)
    assert [t.x.shape for t in out.trajectories] == [(100, 2), (100, 2)]
    assert "top_speed_px_per_s" in out.table("ground_truth", "px").columns
    points = example_points(corpus, recording, cut_settings(), 3)
    assert list(points.columns) == tables.TABLES["fig01_powerlaw"].names("px")
    assert points["z_px"].isna().all() and points["x_px"].notna().all()


def test_an_axis_that_never_moves_is_no_data_and_the_others_keep_their_names():
    path = arc(seconds=2.0)
    path[:, 1] = 0.4  # a depth that the tracker never gave
    recording, corpus = recording_of("a", path), corpus_of(["a"])
    out = single_signs(corpus, [recording], cut_settings(), 3)
    assert [t.x.shape[1] for t in out.trajectories] == [2, 2]
    points = example_points(corpus, recording, cut_settings(), 3)
    assert points["y_m"].isna().all()
    before = points[points["dataset"] == RECORDED]
    movement = movement_of(recording, cut_settings())
    assert before[["x_m", "z_m"]].to_numpy() == pytest.approx(movement.path)


def test_a_movement_along_one_axis_has_bins_but_no_ground_truth():
    path = arc()
    path[:, 1:] = 0
    out = single_signs(corpus_of(["a"]), [recording_of("a", path)], cut_settings(), 3)
    assert [(t.dataset, t.x.shape[1]) for t in out.trajectories] == [(RECORDED, 1)]
    (row,) = out.left_out
    assert row["dataset"] == POWERLAW and "(160, 1)" in row["reason"]


def test_points_of_the_first_figure_are_path_and_warped_path():
    recording = recording_of("a", arc())
    corpus = corpus_of(["a"])
    points = example_points(corpus, recording, cut_settings(), 3)
    assert list(points.columns) == tables.TABLES["fig01_powerlaw"].names("m")
    movement = movement_of(recording, cut_settings())
    before = points[points["dataset"] == RECORDED]
    assert before[["x_m", "y_m", "z_m"]].to_numpy() == pytest.approx(movement.path)
    assert set(before["segment"]) == {1, 2, 3}
    truth = single_signs(corpus, [recording], cut_settings(), 3).table("ground_truth", "m")
    after = points[points["dataset"] == POWERLAW]
    assert after.groupby("segment")["time_s"].max().to_numpy() == pytest.approx(
        truth["end_s"].to_numpy(), abs=1 / 240 + 1e-9
    )
    unwarped = example_points(corpus, recording_of("a", arc(seconds=0.7)), cut_settings(), 3)
    assert unwarped.empty and list(unwarped.columns) == list(points.columns)


def test_trajectories_come_back_from_their_files(tmp_path):
    recordings = [recording_of(f"r{i}", arc(seed=i)) for i in range(2)]
    corpus = corpus_of([r.name for r in recordings])
    cut = single_signs(corpus, recordings, cut_settings(bins=30), 3).trajectories
    write_trajectories(tmp_path / "a.parquet", cut[:1])
    write_trajectories(tmp_path / "b.parquet", cut[1:])
    write_trajectories(tmp_path / "none.parquet", [])
    names = ("none", "a", "b")
    back = read_trajectories([tmp_path / f"{n}.parquet" for n in names])
    for a, b in zip(cut, back, strict=True):
        assert (a.recording, a.hand, a.dataset, a.bin_s) == (
            b.recording, b.hand, b.dataset, b.bin_s,
        )  # fmt: skip
        assert (a.x == b.x).all() and (a.boundaries_s == b.boundaries_s).all()
    some = read_trajectories([tmp_path / f"{n}.parquet" for n in names], dataset="powerlaw")
    assert [t.recording for t in some] == [t.recording for t in cut if t.dataset == "powerlaw"]
