"""What the data do not allow is said, never a bare NaN; and what follows is said in words."""

import warnings

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signkin import tables
from signkin.coarticulation.sign_speeds import continuous, sign_speeds, step_angles
from signkin.settings import Settings
from signkin.statistics import anova, association, equivalence, mixed, posthoc
from signkin.statistics.effects import cohens_d, share_interval
from signkin.statistics.findings import Finding, Kind, grouped
from signkin.statistics.multiplicity import holm
from signkin.studies.naert2017 import (
    durations_models,
    durations_statistics,
    durations_surface,
)
from signkin.studies.naert2017.settings import DurationSettings

NAN = float("nan")


def explained(findings):
    """Every finding has its numbers, or a reason."""
    return all(
        np.isfinite(f.p) or np.isfinite(f.effect) or "not testable: " in f.note for f in findings
    )


@pytest.mark.parametrize(
    "groups",
    [
        {},
        {"a": np.array([0.3])},
        {"a": np.array([0.3, 0.2])},
        {"a": np.array([0.3]), "b": np.array([0.2])},
        {"a": np.full(4, 0.3), "b": np.full(3, 0.3)},
        {"a": np.full(4, 0.3), "b": np.full(3, 0.2)},
        {"a": np.array([0.3]), "b": np.array([0.2, 0.4, 0.3])},
    ],
    ids=["none", "one value", "one group", "single values", "all equal", "nothing varies", "mixed"],
)
def test_what_cannot_be_tested_has_its_reason(groups):
    for findings in (
        anova.one_way(groups, "x", 0.05, 0.25),
        posthoc.pairwise(groups, "x", 0.05),
        equivalence.tost_pairs(groups, "x", 0.05, 0.05),
        [equivalence.omnibus(groups, "x", 0.05, 0.05)],
    ):
        assert explained(findings)


def test_groups_of_one_value_are_named_where_they_are_left_out():
    groups = {"a": np.array([0.3, 0.2, 0.25]), "b": np.array([0.2, 0.4]), "c": np.array([0.5])}
    found = {f.test: f for f in anova.one_way(groups, "x", 0.05, 0.25)}
    assert found["one-way ANOVA"].n == 6
    assert found["Welch's ANOVA"].n == 5
    assert found["Welch's ANOVA"].note == "left out, one value each: c"


def test_a_factor_of_one_level_cannot_be_crossed():
    y, one, two = np.arange(4.0), np.full(4, "1", object), np.array(list("0011"), object)
    found = anova.factorial(y, one, two, ("hands before", "hands after"), 0.05, 0.25)
    assert all("hands before: one level only" in f.note for f in found)


def test_the_mixed_model_needs_recordings_that_differ():
    y = np.random.default_rng(1).normal(0.3, 0.05, 60)
    data = pd.DataFrame({"duration_s": y, "group": ["a", "b"] * 30, "signer": "s"})
    (one,) = mixed.mixed_model(data.assign(recording="r"), "x")
    assert "one recording only" in one.note
    shift = np.repeat([0.0, 0.3, 0.6], 20)
    found = mixed.mixed_model(
        data.assign(recording=np.repeat(list("pqr"), 20), duration_s=y + shift), "x"
    )
    assert found[0].p > 0.001  # recordings differ, groups do not
    between = next(f for f in found if f.comparison == "x: recording")
    assert between.statistic == pytest.approx(np.std([0, 0.3, 0.6]), rel=0.15)


def test_equal_means_are_equivalent_only_with_enough_transitions():
    rng = np.random.default_rng(2)
    few, many = (equivalence.tost(*rng.normal(0.3, 0.1, (2, n)), "x", 0.05, 0.05) for n in (6, 400))
    assert few.p > 0.05 > many.p
    assert few.power < 0.2 and many.power > 0.99
    assert -0.05 < many.effect_low < many.effect < many.effect_high < 0.05


@settings(max_examples=40, deadline=None)
@given(st.floats(0, 20), st.integers(1, 12), st.integers(2, 100))
def test_shares_of_variance_lie_in_0_to_1(f, df1, df2):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        low, high = share_interval(f, df1, df2, df1 + df2 + 1, 0.05)
    assert 0 <= low <= high < 1


def test_cohens_d_of_a_known_shift():
    a, b = np.array([1.0, 2, 3]), np.array([2.0, 3, 4])
    d, low, high = cohens_d(a, b, 0.05)
    assert d == pytest.approx(-1)
    assert low < -1 < high


def test_the_isochrony_exponent_of_a_power_law():
    distance = np.linspace(0.1, 1, 30)
    jitter = np.exp(0.02 * np.sin(np.arange(30.0)))
    found = association.isochrony(distance, 0.4 * distance**0.3 * jitter, "x", 0.05)
    assert found.effect == pytest.approx(0.3, abs=0.02)
    zeros = association.isochrony(np.r_[0, distance], np.r_[0.1, distance], "x", 0.05)
    assert "1 of zero length or distance left out" in zeros.note
    assert zeros.n == 30


def test_bootstrap_draws_whole_recordings():
    """With two recordings of constant values, a mean is one of three values."""
    values = np.r_[np.zeros(5), np.ones(5)]
    low, high = association.bootstrap(
        lambda rows: float(values[rows].mean()), ["a"] * 5 + ["b"] * 5, 200, 0.05,
        np.random.default_rng(0),
    )  # fmt: skip
    assert (low, high) == (0, 1)


# --- speeds of the signs


def test_speeds_of_signs_that_move_and_turn_steadily():
    from scipy.spatial.transform import Rotation

    from signkin import Interval, Recording

    t = np.arange(50) / 50
    positions = np.zeros((50, 1, 3))
    positions[:, 0, 0] = 0.8 * t
    turned = Rotation.from_rotvec(np.outer(6.0 * t, [0, 0, 1])).as_quat()[:, None]
    turned[::2] *= -1  # the same rotations
    recording = Recording(name="r", rate_hz=50, joints=("right_wrist",), positions=positions)
    signs = [Interval(0.2, 0.6, "A", "t"), Interval(0.7, 0.7, "B", "t")]
    found = sign_speeds(positions, turned, signs, recording)
    assert found[0] == pytest.approx([0.8, 3.0])  # half the angle a second, as eq. 1
    assert np.isnan(found[1]).all()
    assert (np.sum(np.diff(continuous(turned), axis=0) ** 2, axis=2) < 0.1).all()
    assert step_angles(turned) == pytest.approx(0.06)


# --- the tables of a corpus


@pytest.fixture(scope="module")
def config():
    return DurationSettings.of(Settings(durations={"draws": 100}))


def corpus(n=40, recordings=2, seed=3, **changes):
    rng = np.random.default_rng(seed)
    g, e = rng.uniform(0.05, 0.3, n), rng.uniform(0.01, 0.1, n)
    lead = {
        "corpus": "c", "recording": [f"r{i % recordings}" for i in range(n)], "signer": "s",
        "transition": np.arange(n) // recordings + 1,
    }  # fmt: skip
    rows = pd.DataFrame(
        {
            **lead, "type": rng.choice(["0000", "1011", "1110", "0010"], n),
            "type_source": "lexicon", "hand": "both", "segmentation": "manual", "status": "ok",
            "duration_s": np.round(0.15 + 0.6 * g + 2.7 * e + rng.normal(0, 0.03, n), 3),
            "geodesic_rad": g, "euclidean_m": e, "mean_distance": (g - g.mean()) + (e - e.mean()),
        }
    ).assign(**changes)  # fmt: skip
    speeds = pd.DataFrame({**lead, "note": ""})
    for side in ("previous", "next"):
        speeds[f"{side}_linear_speed_m_per_s"] = rng.uniform(0.1, 0.4, n)
        speeds[f"{side}_angular_speed_rad_per_s"] = rng.uniform(0.3, 1, n)
    return rows, speeds


CONSTANTS = {
    "theta_constant": "0.148777", "theta_geodesic": "0.663958", "theta_euclidean": "0.275229",
}  # fmt: skip


def test_statistics_of_a_corpus_leave_no_bare_gap(config):
    rows, _ = corpus()
    found = durations_statistics.statistics("c", rows, "m", config, 1)
    assert list(found.columns) == tables.TABLES["statistics"].names()
    bare = found["p"].isna() & found["effect"].isna() & (found["note"] == "")
    assert not bare.any()
    words = found[found["test"] == "in words"]
    assert set(words["question"]) == {"type", "change of hands", "hands", "symmetry", "distance"}
    again = durations_statistics.statistics("c", rows, "m", config, 1)
    pd.testing.assert_frame_equal(found, again)


def test_an_outlier_is_counted_and_left_out_once(config):
    rows, _ = corpus()
    rows.loc[0, "duration_s"] = 2.0
    found = durations_statistics.statistics("c", rows, "m", config, 1)
    anovas = found[(found["test"] == "one-way ANOVA") & (found["question"] == "type")]
    assert dict(zip(anovas["outliers"], anovas["n"], strict=True)) == {"kept": 40, "left out": 39}


@pytest.mark.parametrize("spoilt", [{"duration_s": 0.3}, {"type": "1010"}, {"type": ""}])
def test_equal_durations_one_type_and_no_type_are_told(config, spoilt):
    rows, _ = corpus(**spoilt)
    found = durations_statistics.statistics("c", rows, "m", config, 1)
    bare = found["p"].isna() & found["effect"].isna() & (found["note"] == "")
    assert not bare.any()
    assert found["note"].str.contains("not testable: ").any()


def test_in_words_no_difference_is_no_equivalence(config):
    rng = np.random.default_rng(0)
    # Twelve transitions that scatter by 0.3 s: too few to show anything.
    rows, _ = corpus(n=12, duration_s=rng.normal(1, 0.3, 12))
    found = durations_statistics.statistics("c", rows, "m", config, 1)
    words = found[(found["test"] == "in words") & (found["question"] == "hands")]["note"].iloc[0]
    assert words.startswith("No difference was found, which is no evidence that there is none")
    assert "80% power" in words


def test_symmetry_is_that_of_two_handed_signs(config):
    """One-handed signs are long here; they are no asymmetric ones, so symmetry plays no part."""
    kinds = ["0000", "0010", "0011", "1000", "1010", "1011", "1100", "1110", "1111", "2020"] * 12
    rng = np.random.default_rng(8)
    one = np.array([(k[0] == "0") + (k[2] == "0") for k in kinds])
    y = np.round(0.3 + 0.2 * one + rng.normal(0, 0.01, 120), 4)
    rows, _ = corpus(n=120, type=kinds, duration_s=y)
    found = durations_statistics.statistics("c", rows, "m", config, 1)
    found = found[(found["question"] == "symmetry") & (found["kind"] != "words")]
    crossed = found[found["decisive"]]
    assert set(crossed["n"]) == {48} and (crossed["p"] > 0.05).all()
    assert crossed["note"].str.contains("72 transitions left out: a sign that is not two-").all()
    (before,) = found.loc[
        (found["comparison"] == "symmetry before: asymmetric - symmetric")
        & (found["kind"] == "equivalence"), "n",
    ]  # fmt: skip
    assert before == 72  # the sign before is two-handed in six of ten types


def test_deciding_tests_of_a_corpus_are_corrected_together(config):
    rows, _ = corpus(n=120)
    found = durations_statistics.statistics("c", rows, "m", config, 1)
    decisive = found[found["decisive"] & (found["outliers"] != "left out")]
    p, m = np.sort(decisive["p"]), len(decisive)
    by_hand = np.minimum(np.maximum.accumulate(p * (m - np.arange(m))), 1)
    assert np.sort(decisive["p_holm"]) == pytest.approx(by_hand)
    assert decisive["note"].str.contains(f"Holm: one of {m} tests").all()
    pearson = found[(found["test"] == "Pearson") & found["p"].notna()]
    assert pearson["p_holm"].min() == pytest.approx(min(1, pearson["p"].min() * len(pearson)))
    assert not found.loc[found["p_holm"].isna(), "note"].str.contains("Holm").any()


def test_holm_keeps_its_level_where_nothing_differs(monkeypatch):
    """Of 400 families of ten true hypotheses, 5 % have any adjusted p below 0.05, not 40 %."""
    # statsmodels collects garbage in every call: half a second each in a process of tests.
    monkeypatch.setattr("gc.collect", lambda *_: 0)
    rng = np.random.default_rng(11)
    raw, adjusted = 0, 0
    for p in rng.uniform(size=(400, 10)):
        family = holm([Finding("t", Kind.DIFFERENCE, p=x) for x in p], lambda f: True)
        raw += min(p) < 0.05
        adjusted += min(f.p_holm for f in family) < 0.05
    assert raw / 400 > 0.3
    assert 0.02 < adjusted / 400 < 0.085


def test_models_on_a_corpus(config):
    rows, speeds = corpus()
    learn = durations_models.learnable(rows, speeds, "m", config)
    found, predicted = durations_models.models("c", learn, config, CONSTANTS, 1)
    assert set(found["model"]) == set(durations_models.MODELS)
    assert (found["mean_error_s"].notna() | found["note"].str.startswith("not testable")).all()
    rows = found.set_index(["model", "evaluation"]).loc[("MEAN", "in_sample")]
    assert rows["bias_low_s"] < 0 < rows["bias_high_s"]  # the mean is no bias, in sample
    assert rows["share_too_long_low"] < rows["share_too_long"] < rows["share_too_long_high"]
    errors = found.set_index(["model", "evaluation"])["mean_error_s"]
    assert errors["SURFACE", "leave_one_out"] < errors["MEAN", "leave_one_out"]
    assert errors["SURFACE", "in_sample"] <= errors["SURFACE", "leave_one_out"]
    assert set(predicted["model"]) == set(durations_models.MODELS)
    theta = durations_surface.coefficients("c", learn, config, CONSTANTS, 1)
    inside = theta[theta["coefficient"] == "euclidean"].iloc[0]
    assert inside["low"] < 0.27 < inside["high"]  # 2.7 s/m in units of 0.1 m


def test_models_that_a_corpus_does_not_allow_say_why(config):
    rows, speeds = corpus(recordings=1, geodesic_rad=NAN)
    learn = durations_models.learnable(rows, speeds, "m", config)
    found, _ = durations_models.models("c", learn, config, CONSTANTS, 1)
    notes = found.set_index(["model", "evaluation"])["note"]
    assert "no orientations" in notes["SURFACE", "leave_one_out"]
    assert "one recording only" in notes["LINEAR", "leave_one_recording_out"]
    assert notes["SIMPLE", "in_sample"].endswith("no geodesic distance: its Euclidean part alone")
    _, predicted = durations_models.models("c", learn, config, CONSTANTS, 1)
    simple = predicted.loc[predicted["model"] == "SIMPLE", "predicted_s"].to_numpy()
    # Eq. 3 with alpha 1; 0.1 m over m/s is the same time.
    linear = learn.data.linear_speed.sum(axis=1)
    assert simple == pytest.approx(2 * learn.data.euclidean / linear)
    assert np.isfinite(
        found.set_index(["model", "evaluation"])["mean_error_s"]["LINEAR", "in_sample"]
    )
    theta = durations_surface.coefficients("c", learn, config, CONSTANTS, 1)
    assert theta[theta["model"] == "SURFACE"]["note"].str.startswith("not testable").all()


def test_collinear_distances_have_no_surface_but_a_figure(config):
    rows, speeds = corpus()
    rows["geodesic_rad"] = 2 * rows["euclidean_m"]
    learn = durations_models.learnable(rows, speeds, "m", config)
    found, _ = durations_models.models("c", learn, config, CONSTANTS, 1)
    surface = found[found["model"] == "SURFACE"]
    assert surface["note"].str.contains("singular").all()
    points, theta, reason = durations_surface.surface_points(learn)
    assert theta is None and "singular" in reason and len(points) == 40


def test_transitions_without_a_distance_or_speed_are_counted(config):
    rows, speeds = corpus()
    rows.loc[0, "euclidean_m"] = NAN
    speeds.loc[1, "previous_linear_speed_m_per_s"] = NAN
    learn = durations_models.learnable(rows, speeds, "m", config)
    assert len(learn.data) == 38
    assert (
        learn.note == "1 left out: no Euclidean distance (gaps); 1 left out: a sign without speed"
    )


def test_grouping_keeps_every_value():
    groups = grouped(np.arange(5.0), ["b", "a", "b", "c", "a"])
    assert {k: v.tolist() for k, v in groups.items()} == {"a": [1, 4], "b": [0, 2], "c": [3]}
    assert Finding("t", Kind.CHECK).noted("x", "", "y").note == "x; y"
