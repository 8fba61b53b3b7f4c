"""Methods over many recordings, gamma, and annotators: closed forms and known simulated taggers."""

import itertools
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signkin import seeds, tables
from signkin.annotation import Interval
from signkin.io.eaf import write_eaf
from signkin.segments import Part, disorder, score, score_methods
from signkin.simulate import lsf
from signkin.simulate.lsf import second_tagger
from signkin.studies.naert2017 import agreement as study
from signkin.studies.naert2017.annotators import pair_rows, pairs_of
from signkin.studies.naert2017.posterior_durations import posterior_durations
from signkin.studies.one_wrist.scores import NOTHING, segmentation_scores

LENGTHS = st.lists(st.integers(1, 9), min_size=0, max_size=8)


def segments_of(lengths):
    cuts = np.cumsum(lengths) / 10
    return cuts[: len(cuts) // 2 * 2].reshape(-1, 2)


def least_disorder(a, b):
    """The definition, as it stands: every way of putting segments beside one another."""
    few, many = sorted((a, b), key=len)
    best = np.inf
    for size in range(len(few) + 1):
        for chosen in itertools.combinations(range(len(few)), size):
            for partners in itertools.permutations(range(len(many)), size):
                cost = len(few) + len(many) - 2 * size
                for i, j in zip(chosen, partners, strict=True):
                    apart = np.abs(few[i] - many[j]).sum()
                    cost += (apart / (np.diff(few[i]) + np.diff(many[j]))[0]) ** 2
                best = min(best, cost)
    return best / ((len(a) + len(b)) / 2)


@given(LENGTHS.map(segments_of), LENGTHS.map(segments_of))
@settings(max_examples=40, deadline=None)
def test_disorder_is_that_of_the_best_of_all_alignments(a, b):
    if len(a) + len(b):
        assert disorder(a, b) == pytest.approx(least_disorder(a, b))
    else:
        assert np.isnan(disorder(a, b))


def test_gamma_is_one_for_the_same_and_nothing_for_shuffled():
    cuts = np.cumsum(np.random.default_rng(1).uniform(0.15, 0.9, 40)).reshape(-1, 2)

    def gamma(first, second):
        table = score(first, second, draws=40, rng=2)
        return table[table["measure"] == "gamma"].iloc[0]

    assert gamma(cuts, cuts)["value"] == 1.0
    near, far = gamma(cuts + 0.02, cuts)["value"], gamma(cuts + 0.08, cuts)["value"]
    assert 0.3 < far < near < 1
    assert gamma(cuts, cuts)["chance"] == pytest.approx(0.0, abs=1e-9)
    assert not (score(cuts, cuts)["measure"] == "gamma").any()


def value(table, measure, of):
    row = table[(table["measure"] == measure) & (table["of"] == of)]
    assert len(row) == 1
    return row.iloc[0]


def test_recordings_are_pooled_and_times_are_scored_by_any_edge():
    tags = np.array([[1.0, 1.5], [2.0, 2.6]])
    parts = [Part(np.array([1.02, 1.47, 2.3]), tags), Part(np.empty(0), tags + 5)]
    table = score_methods(parts, 5, np.random.default_rng(0))
    assert value(table, "boundary hit rate", "any edge, 0.05 s")["value"] == 2 / 8
    assert value(table, "boundary precision", "any edge, 0.05 s")["value"] == 2 / 3
    assert not (table["measure"] == "IoU").any()
    same = score_methods([Part(tags, tags), Part(tags, tags + 5)], 0, np.random.default_rng(0))
    # The second recording's segments lie outside of its tags' span, so nothing of it is found.
    assert value(same, "boundary hit rate", "any edge, 0.05 s")["value"] == 0.5
    assert value(same, "IoU", "sign")["value"] == pytest.approx(0.5)
    assert score_methods([], 5, np.random.default_rng(0)).empty


def test_every_method_has_its_rows_and_a_hand_without_motion_is_told():
    rng = np.random.default_rng(4)
    signs = np.cumsum(rng.uniform(0.3, 0.6, 40)).reshape(-1, 2)
    rows = [
        {"recording": "r", "sign": k + 1, "edge": edge, "hand": hand, "manual_s": time,
         "refined_s": time + 0.02, "mean_s": time + 0.01}
        for k, sign in enumerate(signs)
        for edge, time in zip(("start", "end"), sign, strict=True)
        for hand in ("right", "left")
    ]  # fmt: skip
    tags = pd.DataFrame(rows)
    minima = pd.DataFrame({"recording": "r", "hand": "right", "minimum_s": signs.ravel() + 0.06})
    wrists = pd.DataFrame({"recording": ["r"], "hand": ["right"], "order": [3]})
    cuts = pd.DataFrame({"recording": "r", "hand": "right", "boundary_s": signs.ravel() + 0.2})
    binned = {"wrist_posteriors": wrists, "wrist_boundaries": cuts}
    table = segmentation_scores("c", tags, tags, minima, binned, 1)
    assert list(table.columns) == tables.TABLES["segmentation_scores"].names()
    right = table[(table["hand"] == "right") & (table["of"] == "any edge, 0.05 s")]
    f1 = right[right["measure"] == "boundary F1"].set_index("method")["value"]
    assert f1.iloc[:3].tolist() == [1.0, 1.0, 0.0]
    assert f1["Bayesian binning, order 3"] < 0.6
    left = table[(table["hand"] == "left") & (table["method"] == "speed minima")]
    assert left["note"].tolist() == [NOTHING]


def test_durations_carry_what_is_known_of_their_ends(monkeypatch):
    monkeypatch.setattr("signkin.studies.naert2017.posterior_durations.DRAWS", 80)
    rng = np.random.default_rng(6)
    ends, durations = np.arange(40.0), rng.uniform(0.2, 0.5, 40)
    lead = {"recording": "r", "hand": "right", "status": "ok", "type": ["0000", "1111"] * 20}
    moves = pd.DataFrame({"transition": range(40), "start_s": ends, "end_s": ends + durations,
                          "duration_s": durations, "euclidean_m": durations * 0.3,
                          "geodesic_rad": np.nan, **lead})  # fmt: skip
    both = pd.concat([moves.assign(segmentation=s) for s in ("manual", "refined")])
    width = np.array([-1.6449, -0.6745, 0.6745, 1.6449]) * 0.02

    def posteriors_of(times, edge):
        bands = dict(zip(("low90_s", "low50_s", "high50_s", "high90_s"),
                         times[None] + 0.01 + width[:, None], strict=True))  # fmt: skip
        return pd.DataFrame({"recording": "r", "hand": "right", "edge": edge, "manual_s": times,
                             **bands})  # fmt: skip

    posteriors = pd.concat([posteriors_of(ends, "end"), posteriors_of(ends + durations, "start")])
    table = posterior_durations("c", both, posteriors, "m", 0.1, 1)
    right = table[table["hand"] == "right"].set_index("measure")
    mean = right.loc["mean duration"]
    assert mean["manual"] == pytest.approx(durations.mean())
    assert mean["posterior"] == pytest.approx(durations.mean(), abs=0.001)
    # The mean of 40 differences of two normal errors of 20 ms.
    half = 1.96 * 0.02 * np.sqrt(2 / 40)
    assert mean["high"] - mean["low"] == pytest.approx(2 * half, rel=0.25)
    linear = right.loc["LINEAR, mean absolute error in sample"]
    assert linear["manual"] < 1e-6 < 0.01 < linear["low"]
    assert np.isnan(right.loc["SURFACE, mean absolute error in sample", "manual"])
    assert table[table["hand"] == "left"]["note"].str.contains("no transition").all()


def tokens_of(rng, signs):
    """Signs with true boundaries, and the first tagger's tags by the simulation's jitter."""
    times = np.cumsum(rng.uniform(0.3, 0.7, 2 * signs)).reshape(-1, 2) + 1
    tags = times + rng.normal(0, 0.03, times.shape)
    return [SimpleNamespace(gloss="ABC"[k % 3], true_s={"right": tuple(t)}, tag=tuple(tags[k]))
            for k, t in enumerate(times)]  # fmt: skip


def test_the_second_tagger_has_its_known_lag_and_jitter():
    tokens = tokens_of(np.random.default_rng(2), 300)
    found = lsf.second_tags([tokens], seeds.stream(1, "second tagger"))
    off = np.array([(i.start_s, i.end_s) for i in found]) - [t.true_s["right"] for t in tokens]
    assert off.mean() == pytest.approx(second_tagger.LAG_S, abs=0.006)
    assert off.std() == pytest.approx(second_tagger.JITTER_S, rel=0.1)
    times = np.array([(i.start_s, i.end_s) for i in found]).ravel()
    assert (np.diff(times) > 0).all()


def test_signs_of_two_annotators_are_paired_by_the_time_they_share():
    def at(*spans):
        return [Interval(a, b, "A", "t") for a, b in spans]

    first, second = at((0, 1), (1, 2), (3, 4)), at((0.9, 2.1), (0.1, 0.9), (5, 6))
    assert pairs_of(first, second) == [(0, 1), (1, 0)]
    assert pairs_of(first, []) == []
    types = pd.DataFrame({"recording": ["r"] * 3, "sign": [1, 2, 3], "type": ["00", "11", "10"]})
    rows = pair_rows({"r": first}, {"r": second}, types)
    assert rows["hands"].tolist() == ["one", "two"]
    assert rows["start"].tolist() == pytest.approx([-0.1, 0.1])


@pytest.fixture
def session(tmp_path):
    """Two annotators of one recording, and what the analyses have of it."""
    tokens = tokens_of(np.random.default_rng(7), 40)
    second = lsf.second_tags([tokens], seeds.stream(3, "second tagger"))
    write_eaf(tmp_path / "r-two.eaf", author="t", date="2020-01-01T00:00:00+00:00",
              media_url="m.bvh", tiers=[("sign", None, second)])  # fmt: skip
    intervals = pd.DataFrame(
        [{"recording": "r", "role": "sign", "label": t.gloss, "tier": "sign",
          "start_s": round(t.tag[0], 3), "end_s": round(t.tag[1], 3)} for t in tokens]
    )  # fmt: skip
    true = np.array([t.true_s["right"] for t in tokens]).ravel()
    minima = pd.DataFrame({"recording": "r", "hand": "right", "minimum_s": true, "rest_s": true,
                           "rest_sd_s": 0.01, "prominence_m_per_s": 0.3})  # fmt: skip
    types = pd.DataFrame({"recording": "r", "sign": range(1, 41), "type": "00"})
    about = pd.DataFrame({"recording": ["r"], "rate_hz": [100.0]})
    corpus = SimpleNamespace(
        name="c", unit="m", annotators={"two": {}}, by_name={"r": None},
        annotator_spec=lambda entry, name: {"format": "eaf", "tiers": ("sign",)},
        annotator_file=lambda entry, name: "r-two.eaf",
    )  # fmt: skip
    return corpus, tmp_path, about, intervals, minima, types


def test_two_annotators_lead_and_come_nearer(session, monkeypatch):
    monkeypatch.setattr(study, "DRAWS", 10)
    monkeypatch.setattr("signkin.studies.naert2017.annotators_refined.DRAWS",
                        {"rule": 40, "posterior": 3})  # fmt: skip
    made = study.agreement(*session, 0.15, 1, 700)
    for name, table in made.items():
        assert list(table.columns) == tables.TABLES[name].names()
    scores = made["annotator_agreement"]
    assert {"gamma", "Cohen's kappa", "mF1S"} <= set(scores["measure"])
    assert value(scores, "gamma", "sign")["value"] > 0.4
    every = made["annotator_offsets"].query("group == 'all'")
    assert (every["lead"] == study.FIRST).all() and (every["n"] == 40).all()
    assert every["mean_s"].mean() == pytest.approx(-second_tagger.LAG_S, abs=0.015)
    assert set(made["annotator_offsets"]["group"]) == {"all", "recording", "hands", "length",
                                                       "gloss"}  # fmt: skip
    refined = made["annotator_refined"]
    rule = refined[(refined["hand"] == "right") & (refined["method"] == "rule")]
    assert (rule["nearer_s"] > rule["chance_high"]).all() and (rule["p"] < 0.05).all()
    still = refined[(refined["hand"] == "left") & (refined["method"] == "rule")]
    assert (still["nearer_s"] == 0).all() and (still["p"] == 1).all()


def test_one_annotator_only_is_told(session):
    corpus, folder, *rest = session
    (folder / "r-two.eaf").unlink()
    made = study.agreement(corpus, folder, *rest, 0.15, 1, 700)
    note = made["annotator_agreement"]["note"].iloc[0]
    assert note.startswith("two, r: ")
    assert made["annotator_offsets"].empty
    assert (made["annotator_refined"]["note"] != "").all()
