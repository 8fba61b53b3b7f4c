"""The binning study: trajectories in, rows and posteriors out."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest

from signkin import tables
from signkin.binning import Prior, fit
from signkin.binning.posterior import boundary_times
from signkin.studies.endres2013.posteriors import (
    FITTED,
    FITTED_MAP,
    Data,
    Study,
    chosen,
    explained_variance,
    prior_id,
    prior_of,
    read_posteriors,
    rows_of,
    study,
    write_posteriors,
)
from signkin.studies.endres2013.settings import FitSettings
from signkin.studies.endres2013.single_signs import POWERLAW, RECORDED, Trajectory
from support.endres import corpus_of, settings

BINS, BIN_S = 24, 0.04
PIECES = (9, 17)  # bins that end the first two segments


def piecewise(seed=0, order=1, bins=BINS, ends=PIECES):
    """Return a trajectory of three pieces of polynomials that do not join, (T, 3)."""
    rng = np.random.default_rng(seed)
    x = np.empty((bins, 3))
    for a, b in pairwise([0, *(end + 1 for end in ends), bins]):
        t = np.linspace(-1, 1, b - a)
        x[a:b] = np.polynomial.polynomial.polyval(t, rng.normal(0, 0.2, (order + 1, 3))).T
    return x + rng.normal(0, 1e-3, x.shape)


def trajectory(name="a", dataset=RECORDED, truth=(), **how):
    return Trajectory(name, "right", dataset, piecewise(**how), BIN_S, np.array(truth, dtype=float))


def small(**changes):
    return FitSettings.of(settings(orders=[0, 1, 2], fitted_orders=[1, 2], **changes))


PRIOR = settings().binning.prior


def changed(**keys):
    return PRIOR.model_copy(update=keys)


def test_the_prior_is_as_the_configuration_says():
    x = piecewise()
    assert prior_of(PRIOR, 0.003, x) == Prior(
        noise_sd=0.003, dof=None, concentration=0.1, time_unit="bin", scale="expected"
    )
    data = prior_of(changed(noise="data", dof=7.0, scale="plain"), 0.003, x)
    mean = x.sum(axis=0) / len(x)
    variance = ((x - mean) ** 2).sum(axis=0) / (len(x) - 1)
    assert np.square(data.noise_sd) == pytest.approx(variance)
    assert (data.dof, data.scale) == (7, "plain")


def test_priors_have_different_names():
    assert prior_id(PRIOR) == "dofL sensor expected b0.1 bin"
    assert prior_id(PRIOR, 0.1) == "dofL 0.1xsensor expected b0.1 bin"
    others = [
        changed(dof=5.0), changed(noise="data"), changed(scale="plain"),
        changed(concentration=0.001), changed(time_unit="second"),
    ]  # fmt: skip
    names = {prior_id(PRIOR), prior_id(PRIOR, 0.1), *map(prior_id, others)}
    assert len(names) == 7


def test_chosen_names_are_spread_evenly():
    names = [f"{i:02d}" for i in range(10)]
    assert chosen(names, 10) == names == chosen(names, 99)
    assert chosen(names, 2) == ["00", "09"]
    assert chosen(names, 4) == ["00", "03", "06", "09"]
    for most in range(2, 10):
        found = chosen(names, most)
        assert len(set(found)) == most and found == sorted(found)
        assert (found[0], found[-1]) == ("00", "09")
        steps = np.diff([int(name) for name in found])
        assert steps.max() - steps.min() <= 1


def test_boundaries_are_at_the_end_of_their_bin():
    assert boundary_times(np.array([0, 4]), 0.02) == pytest.approx([0.02, 0.10])
    assert boundary_times(np.array([], dtype=np.int64), 0.02).shape == (0,)


def test_explained_variance_by_hand():
    x = np.array([[1.0, 0], [3, 0], [5, 0], [7, 2]])
    assert explained_variance(x, x) == 1
    assert explained_variance(x, np.tile(x.mean(axis=0), (4, 1))) == pytest.approx(0)
    # Total: 9 + 1 + 1 + 9 + 0.25 * 3 + 2.25 = 23; residual: 1.
    off = np.array([[1, 0], [0, 0], [0, 0], [0, 0]])
    assert explained_variance(x, x + off) == pytest.approx(1 - 1 / 23)


def test_a_study_centres_and_leaves_out_with_a_reason():
    corpus = corpus_of(["a", "still", "tiny", "gap"])
    good = trajectory()
    moved = replace(good, x=good.x + np.array([3.0, -2.0, 1.0]))
    still = replace(good, recording="still", x=np.ones((BINS, 3)))
    tiny = replace(good, recording="tiny", x=good.x[:2])
    gap = replace(good, recording="gap", x=good.x.copy())
    gap.x[5:7, 1] = np.nan
    runs = Study(corpus, small())
    items = [Data(t, t.dataset, t.x, None, t.boundaries_s) for t in (good, still, moved, tiny, gap)]
    one, other = runs.run(items)
    assert (one.data is items[0]) and (other.data is items[2])
    assert one.posterior.log_evidence == pytest.approx(other.posterior.log_evidence, rel=1e-9)
    assert [(row["recording"], row["signer"], row["dataset"]) for row in runs.left_out] == [
        ("still", "s2", RECORDED), ("tiny", "s1", RECORDED), ("gap", "s2", RECORDED),
    ]  # fmt: skip
    assert "recording still: all bins are equal" in runs.left_out[0]["reason"]
    assert (
        "recording tiny: 2 bins; expected more than the highest order, 2"
        in (runs.left_out[1]["reason"])
    )
    assert "recording gap: 2 bins without a position" in runs.left_out[2]["reason"]


def test_fits_have_the_priors_noise_or_a_share_of_it():
    corpus = corpus_of(["a"], noise_sd=0.004)
    t = trajectory()
    x = t.x - t.x.mean(axis=0)
    for share in (1.0, 0.25):
        (found,) = Study(corpus, small()).run([Data(t, RECORDED, t.x, None, np.empty(0), share)])
        expected = fit(x, [0, 1, 2], Prior(noise_sd=0.004 * share), dt_s=BIN_S)
        assert (found.posterior.log_evidence == expected.log_evidence).all()
    data = small(prior={"noise": "data"})
    (found,) = Study(corpus, data).run([Data(t, RECORDED, t.x, None, np.empty(0), 0.5)])
    expected = fit(x, [0, 1, 2], Prior(noise_sd=tuple(0.5 * x.std(axis=0, ddof=1))), dt_s=BIN_S)
    assert found.posterior.log_evidence == pytest.approx(expected.log_evidence, rel=1e-12)


@pytest.mark.parametrize("order", [1, 2, 4])
def test_the_most_probable_fit_is_a_polynomial_in_each_piece(order):
    corpus = corpus_of(["a"])
    runs = Study(corpus, FitSettings.of(settings(orders=list(range(order + 1)))))
    bins, ends = 45, (13, 29)
    t = replace(trajectory(), x=piecewise(seed=order, order=order, bins=bins, ends=ends))
    (found,) = runs.run([Data(t, RECORDED, t.x, None, np.empty(0))])
    mean, exact = runs.fitted_data(found, order)
    assert (mean.dataset, exact.dataset) == (FITTED, FITTED_MAP)
    assert mean.true_order == exact.true_order == order
    assert mean.noise_share == exact.noise_share == 0.1
    assert exact.truth_s == pytest.approx((np.array(ends) + 1) * BIN_S)
    assert mean.truth_s == pytest.approx(exact.truth_s)
    assert (mean.x == found.posterior.expected_trajectory(order)).all()
    for a, b in pairwise([0, *(end + 1 for end in ends), bins]):
        u = np.linspace(-1, 1, b - a)
        for values in exact.x[a:b].T:
            for degree in (order, order - 1):
                missed = np.polyval(np.polyfit(u, values, degree), u) - values
                # One degree less does not do.
                assert (np.abs(missed).max() < 1e-10) == (degree == order)
    # Binned again as data, its boundaries are found.
    (again,) = runs.run([exact])
    assert again.boundaries_s(order) == pytest.approx(exact.truth_s)
    assert again.posterior.orders[int(again.posterior.order_probability.argmax())] == order


def test_rows_are_those_of_the_table_and_hits_are_against_the_own_truth():
    corpus = corpus_of(["a", "b"])
    chosen_settings = small(hit_window_s=0.05)
    runs = Study(corpus, chosen_settings)
    truth = (np.array(PIECES) + 1) * BIN_S
    recorded = trajectory()
    # One true boundary is found, one is elsewhere.
    warped = trajectory("b", POWERLAW, [truth[0] + 0.04, truth[1] + 0.2])
    items = [Data(t, t.dataset, t.x, None, t.boundaries_s) for t in (recorded, warped)]
    fits = runs.run(items)
    exact = list(runs.fitted_data(fits[0], 1))[1]
    frames = [
        pd.DataFrame(list(rows_of(corpus, chosen_settings, one)))
        for one in (*fits, *runs.run([exact]))
    ]
    for frame in frames:
        columns = tables.TABLES["binning"].names()
        whole = pd.DataFrame(frame, columns=columns)
        assert set(frame.columns) <= set(columns)
        assert whole["order"].tolist() == [0, 1, 2]
        assert whole["order_probability"].sum() == pytest.approx(1)
        assert (whole["n_bins"] == BINS).all()
        assert whole["duration_s"].to_numpy() == pytest.approx(BINS * BIN_S)
        assert (whole["note"][whole["hpfpps"].isna()] != "").all()
    first, second, third = frames
    assert "hit_rate" not in first
    unknown = "boundaries of recorded movements are not known"
    off = "SDs of the prior's noise off"  # steps cannot follow a slope
    for row in first.itertuples():
        assert row.note.startswith(unknown) and (off in row.note) == (row.noise_misfit > 3)
        assert row.at_floor == "no"
    assert first["note"].str.contains(off).any()
    row = second.set_index("order").loc[1]
    assert row["map_count"] == 2
    assert (row["hits"], row["misses"], row["false_positives"]) == (1, 1, 1)
    assert row["hit_rate"] == 0.5
    assert row["false_positives_per_s"] == pytest.approx(1 / (BINS * BIN_S))
    assert row["hpfpps"] == pytest.approx(0.5 * BINS * BIN_S)
    assert 0 < row["shifted_hits"] < 2 and row["shifted_sd"] > 0
    assert (row["sign"], row["signer"], row["repetition"]) == ("wave", "s2", 1)
    row = third.set_index("order").loc[1]
    assert (row["hits"], row["misses"], row["false_positives"]) == (2, 0, 0)
    assert (row["dataset"], row["true_order"]) == (FITTED_MAP, 1)
    assert row["prior_id"] == "dofL 0.1xsensor expected b0.1 bin"
    assert row["note"].split("; ")[0] == "no false positive"


def test_a_trajectory_without_a_true_boundary_says_so():
    corpus = corpus_of(["a"])
    runs = Study(corpus, small())
    t = trajectory("a", POWERLAW)
    (one,) = runs.run([Data(t, POWERLAW, t.x, None, t.boundaries_s)])
    rows = list(rows_of(corpus, small(), one))
    assert {row["note"].split("; ")[0] for row in rows} == {"no true boundary"}
    assert all(np.isnan(row["hit_rate"]) for row in rows)


@pytest.fixture(scope="module")
def studied():
    names = ["a", "b", "c"]
    corpus = corpus_of(names)
    cut = [
        trajectory(name, dataset, truth, seed=i, order=2)
        for i, name in enumerate(names)
        for dataset, truth in ((RECORDED, ()), (POWERLAW, (np.array(PIECES) + 1) * BIN_S))
    ]
    chosen_settings = small(fitted_recordings=2)
    return corpus, cut, {n: study(corpus, cut, chosen_settings, n) for n in (1, 2)}


def test_a_study_has_every_trajectory_and_those_fitted_to_some(studied):
    _, _, found = studied
    frame = found[1].table("binning")
    assert list(frame.columns) == tables.TABLES["binning"].names()
    sizes = frame.groupby(["dataset", "true_order"], dropna=False).size().to_dict()
    counted = {(d, None if np.isnan(o) else int(o)): n for (d, o), n in sizes.items()}
    assert counted == {
        (RECORDED, None): 9, (POWERLAW, None): 9, (FITTED, 1): 6, (FITTED, 2): 6,
        (FITTED_MAP, 1): 6, (FITTED_MAP, 2): 6,
    }  # fmt: skip
    fitted = frame[frame["dataset"].isin([FITTED, FITTED_MAP])]
    assert set(fitted["recording"]) == {"a", "c"}
    truths = found[1].table("fitted_truths")
    for key, rows in fitted.groupby(["recording", "dataset", "true_order"]):
        own = truths[(truths[["recording", "dataset", "true_order"]] == list(key)).all(axis=1)]
        assert ((rows["hits"] + rows["misses"]) == len(own)).all()
    assert found[1].table("binning_left_out").empty
    assert [(f.data.source.recording, f.data.dataset) for f in found[1].fits] == [
        (name, dataset) for name in "abc" for dataset in (RECORDED, POWERLAW)
    ]


def test_the_number_of_workers_changes_no_bit(studied, tmp_path):
    found = studied[2]
    for name in ("binning", "fitted_truths", "binning_left_out"):
        pd.testing.assert_frame_equal(found[1].table(name), found[2].table(name), check_exact=True)
    for n in (1, 2):
        write_posteriors(tmp_path / f"{n}.parquet", found[n].fits)
    assert (tmp_path / "1.parquet").read_bytes() == (tmp_path / "2.parquet").read_bytes()


def test_posteriors_come_back_from_their_file(studied, tmp_path):
    found = studied[2]
    fits = found[1].fits
    write_posteriors(tmp_path / "1.parquet", fits[:3])
    write_posteriors(tmp_path / "2.parquet", fits[3:])
    back = read_posteriors([tmp_path / "1.parquet", tmp_path / "2.parquet"], "b")
    own = [one for one in fits if one.data.source.recording == "b"]
    assert back[["dataset", "order"]].apply(tuple, axis=1).tolist() == [
        (one.data.dataset, order) for one in own for order in (0, 1, 2)
    ]
    for i, one in enumerate(own):
        for order in (0, 1, 2):
            row = back.iloc[3 * i + order]
            posterior = one.posterior
            assert row["log_evidence"] == posterior.log_evidence[order]
            assert row["map_count"] == posterior.map_count(order)
            assert (row["boundaries_s"] == one.boundaries_s(order)).all()
            assert (row["true_boundaries_s"] == one.data.truth_s).all()
            assert row["boundary_probability"] == pytest.approx(
                posterior.boundary_probability(order), abs=1e-6
            )
            expected = posterior.expected_trajectory(order)
            assert row["expected"].reshape(-1, 3) == pytest.approx(expected, abs=1e-6)
            assert row["centre"] == pytest.approx(one.data.x.mean(axis=0))
            assert row["noise_covariance"].reshape(3, 3) == pytest.approx(
                posterior.noise_covariance(order)
            )
            by_count = row["log_evidence_by_count"]
            assert len(by_count) == BINS and np.isfinite(by_count).all()
