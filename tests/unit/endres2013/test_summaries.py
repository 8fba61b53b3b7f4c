"""Summaries of the binning study against counts and means worked out by hand."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import friedmanchisquare, kruskal

from signkin import tables
from signkin.settings.sections import Binning
from signkin.studies.endres2013.posteriors import FITTED, FITTED_MAP
from signkin.studies.endres2013.single_signs import POWERLAW, RECORDED, Trajectory
from signkin.studies.endres2013.summaries import (
    ALL,
    RATES_PER_S,
    groups,
    hit_rates,
    known_boundaries,
    order_posteriors,
    order_tests,
    rates_by_order,
)

SETTINGS = Binning().model_copy(update={"bootstrap_draws": 50, "chance_trajectories": 400})


def row(recording, dataset, order, probability, counts=(None, None, None), **more):
    hits, misses, false = counts
    return {
        "corpus": "c", "recording": recording, "signer": "s1", "sign": "wave", "repetition": 1,
        "dataset": dataset, "true_order": None, "prior_id": "p", "n_bins": 50, "duration_s": 2.0,
        "order": order, "log_evidence": 0.0, "order_probability": probability, "map_count": order,
        "explained_variance": 0.9, "hits": hits, "misses": misses, "false_positives": false,
        "note": "", **more,
    }  # fmt: skip


def frame_of(rows):
    frame = pd.DataFrame(rows, columns=tables.TABLES["binning"].names())
    frame["true_order"] = frame["true_order"].astype(float)
    return frame


@pytest.fixture
def binning():
    """Three recordings of two signers; order 2 finds more than order 3, and more that is false."""
    return frame_of(
        [
            row("a", RECORDED, 2, 0.2, map_count=4, explained_variance=0.7),
            row("a", RECORDED, 3, 0.8, map_count=3, explained_variance=0.9),
            row("b", RECORDED, 2, 0.6, map_count=6, explained_variance=0.8),
            row("b", RECORDED, 3, 0.4, map_count=2, explained_variance=1.0),
            row("a", POWERLAW, 2, 0.1, (2, 0, 4)),
            row("a", POWERLAW, 3, 0.9, (1, 1, 1)),
            row("b", POWERLAW, 2, 0.3, (1, 1, 2), duration_s=1.0),
            row("b", POWERLAW, 3, 0.7, (1, 1, 0), duration_s=1.0),
            row("d", POWERLAW, 2, 0.5, (2, 0, 5), signer="s2"),
            row("d", POWERLAW, 3, 0.5, (2, 0, 0), signer="s2"),
            row("a", FITTED, 2, 0.9, (3, 0, 0), true_order=2),
            row("a", FITTED, 3, 0.1, (2, 1, 0), true_order=2),
            row("a", FITTED_MAP, 2, 1.0, (3, 0, 0), true_order=2),
            row("a", FITTED_MAP, 3, 0.0, (1, 2, 0), true_order=2),
            row("b", FITTED_MAP, 2, 1.0, (0, 0, 0), true_order=2),
            row("b", FITTED_MAP, 3, 0.0, (0, 0, 2), true_order=2),
        ]
    )


def truths():
    cut = [
        Trajectory("a", "right", RECORDED, np.zeros((50, 3)), 0.04, np.empty(0)),
        Trajectory("a", "right", POWERLAW, np.zeros((50, 3)), 0.04, np.array([0.5, 1.2])),
        Trajectory("b", "right", POWERLAW, np.zeros((50, 3)), 0.02, np.array([0.3, 0.7])),
        Trajectory("d", "right", POWERLAW, np.zeros((50, 3)), 0.04, np.array([0.4, 1.5])),
    ]
    fitted = pd.DataFrame(
        [("a", kind, 2, t) for kind in (FITTED, FITTED_MAP) for t in (0.2, 0.9, 1.4)],
        columns=["recording", "dataset", "true_order", "boundary_s"],
    )
    return known_boundaries(cut, fitted)


def test_known_boundaries_by_dataset_order_and_recording():
    assert truths() == {
        (POWERLAW, None, "a"): [0.5, 1.2], (POWERLAW, None, "b"): [0.3, 0.7],
        (POWERLAW, None, "d"): [0.4, 1.5], (FITTED, 2, "a"): [0.2, 0.9, 1.4],
        (FITTED_MAP, 2, "a"): [0.2, 0.9, 1.4],
    }  # fmt: skip
    nothing = pd.DataFrame(columns=["recording", "dataset", "true_order", "boundary_s"])
    assert known_boundaries([], nothing) == {}


def test_groups_are_datasets_then_signers_and_signs(binning):
    found = {
        (key["dataset"], key["signer"], key["sign"]): sorted(set(part["recording"]))
        for key, part in groups(binning)
    }
    assert found == {
        (RECORDED, ALL, ALL): ["a", "b"], (RECORDED, "s1", "wave"): ["a", "b"],
        (POWERLAW, ALL, ALL): ["a", "b", "d"], (POWERLAW, "s1", "wave"): ["a", "b"],
        (POWERLAW, "s2", "wave"): ["d"],
        # Fitted trajectories are pooled: they are what the method is tested with.
        (FITTED, ALL, ALL): ["a"], (FITTED_MAP, ALL, ALL): ["a", "b"],
    }  # fmt: skip
    for key, part in groups(binning):
        whole = {FITTED, FITTED_MAP}
        assert (key["true_order"] == 2) == (key["dataset"] in whole)
        assert set(part["dataset"]) == {key["dataset"]}


def test_order_posteriors_by_hand(binning):
    found = order_posteriors("c", binning)
    assert list(found.columns) == tables.TABLES["order_posteriors"].names()
    assert len(found) == 14
    whole = found[(found["dataset"] == RECORDED) & (found["signer"] == ALL)].set_index("order")
    assert whole.loc[2, "mean_probability"] == pytest.approx(0.4)
    assert whole.loc[2, "se"] == pytest.approx(0.2)  # SD of 0.2 and 0.6 is 0.2828; over sqrt 2
    assert whole.loc[3, "mean_count"] == 2.5
    assert whole.loc[3, "mean_explained_variance"] == pytest.approx(0.95)
    assert whole.loc[3, "sd_explained_variance"] == pytest.approx(0.1 / np.sqrt(2))
    alone = found[(found["dataset"] == POWERLAW) & (found["signer"] == "s2")]
    assert (alone["n"] == 1).all()
    assert alone["se"].isna().all() and alone["sd_explained_variance"].isna().all()


def test_rates_keep_the_same_sequence_of_trajectories(binning):
    part = binning[binning["dataset"] == POWERLAW]
    rates = rates_by_order(part.sample(frac=1, random_state=1))
    assert [(r.hits, r.misses, r.false_positives) for r in rates[2]] == [
        (2, 0, 4), (1, 1, 2), (2, 0, 5),
    ]  # fmt: skip
    assert [r.duration_s for r in rates[3]] == [2.0, 1.0, 2.0]


def test_hit_rates_by_hand(binning):
    rates, _ = hit_rates("c", binning, truths(), SETTINGS, 7)
    assert list(rates.columns) == tables.TABLES["hit_rates"].names()
    assert RECORDED not in set(rates["dataset"])
    whole = rates[(rates["dataset"] == POWERLAW) & (rates["signer"] == ALL)].set_index("order")
    assert whole.loc[2, "hit_rate"] == pytest.approx((1 + 0.5 + 1) / 3)
    assert whole.loc[2, "false_positives_per_s"] == pytest.approx((2 + 2 + 2.5) / 3)
    spread = np.std([2, 2, 2.5], ddof=1) / np.sqrt(3)
    assert whole.loc[2, "false_positives_per_s_se"] == pytest.approx(spread)
    # Eq. 17, pooled: 5 of 6 boundaries hit, 11 false positives in 5 s.
    assert whole.loc[2, "hpfpps"] == pytest.approx((5 / 6) / (11 / 5))
    assert whole.loc[3, "hpfpps"] == pytest.approx((4 / 6) / (1 / 5))
    assert whole["n"].tolist() == [3, 3]
    alone = rates[(rates["dataset"] == POWERLAW) & (rates["signer"] == "s2")].set_index("order")
    assert np.isnan(alone.loc[3, "hpfpps"]) and alone.loc[3, "note"].startswith("no false positive")
    exact = rates[rates["dataset"] == FITTED_MAP].set_index("order")
    assert exact["without_truth"].tolist() == [1, 1]
    assert exact.loc[2, "hit_rate"] == 1.0
    assert exact.loc[3, "hit_rate"] == pytest.approx(1 / 3)
    assert exact.loc[3, "false_positives_per_s"] == pytest.approx(0.5)
    finite = rates["hpfpps"].notna()
    assert (rates.loc[~finite, "note"] != "").all()


def test_hit_rates_stand_beside_two_kinds_of_chance(binning):
    told = binning.assign(shifted_hits=0.5, shifted_sd=0.5)
    rates, _ = hit_rates("c", told, truths(), SETTINGS, 7)
    whole = rates[(rates["dataset"] == POWERLAW) & (rates["signer"] == ALL)].set_index("order")
    for order, hit in ((2, 2.5 / 3), (3, 2 / 3)):
        row = whole.loc[order]
        assert row["over_chance"] == pytest.approx(hit - row["chance_hit_rate"])
        assert row["chance_hpfpps"] == pytest.approx(
            row["chance_hit_rate"] / row["false_positives_per_s"]
        )
        assert row["shifted_hit_rate"] == pytest.approx(0.25)
        assert row["over_shifted"] == pytest.approx(hit - 0.25)
        assert 0 <= row["shifted_low"] < 0.25 < row["shifted_high"]
    # 16 boundaries found at order 2, of which 1.5 hit by chance, in 5 s.
    assert whole.loc[2, "shifted_hpfpps"] == pytest.approx((1.5 / 6) / ((16 - 1.5) / 5))


def test_chance_is_near_its_closed_form_and_within_its_band(binning):
    rates, lines = hit_rates("c", binning, truths(), SETTINGS, 7)
    assert list(lines.columns) == tables.TABLES["chance_lines"].names()
    for _, line in lines.groupby(["dataset", "signer"]):
        assert line["rate_per_s"].to_numpy() == pytest.approx(RATES_PER_S)
        closed = 1 - np.exp(-2 * 0.09 * line["rate_per_s"])
        assert line["closed_form"].to_numpy() == pytest.approx(closed.to_numpy())
        assert (line["hit_rate_low"] <= line["hit_rate"] + 1e-12).all()
        assert (line["hit_rate"] <= line["hit_rate_high"] + 1e-12).all()
        # Boundaries here are further apart than two windows, and away from the ends.
        assert line["hit_rate"].to_numpy() == pytest.approx(closed.to_numpy(), abs=0.1)
        assert line["false_positives_per_s"].is_monotonic_increasing
    # What is told beside a group's rate is the line at its false positives.
    whole = rates[(rates["dataset"] == POWERLAW) & (rates["signer"] == ALL)].iloc[0]
    line = lines[(lines["dataset"] == POWERLAW) & (lines["signer"] == ALL)]
    at = np.searchsorted(line["false_positives_per_s"], whole["false_positives_per_s"])
    around = line["hit_rate"].iloc[at - 1 : at + 1]
    assert around.min() <= whole["chance_hit_rate"] <= around.max()
    assert whole["chance_low"] <= whole["chance_hit_rate"] <= whole["chance_high"]


def test_streams_do_not_depend_on_the_other_groups(binning):
    whole = hit_rates("c", binning, truths(), SETTINGS, 7)
    part = hit_rates("c", binning[binning["dataset"] == POWERLAW], truths(), SETTINGS, 7)
    for a, b in zip(whole, part, strict=True):
        same = a[a["dataset"] == POWERLAW].reset_index(drop=True)
        pd.testing.assert_frame_equal(same, b, check_exact=True, check_dtype=False)
    other = hit_rates("c", binning, truths(), SETTINGS, 8)[1]
    assert (other["hit_rate"] != whole[1]["hit_rate"]).any()


def test_rates_above_the_line_are_not_compared_with_chance():
    frame = frame_of([row("a", POWERLAW, 3, 1.0, (1, 1, 80))])
    rates, _ = hit_rates("c", frame, truths(), SETTINGS, 7)
    assert rates["chance_hit_rate"].isna().all()
    assert "more false positives than the chance line has" in rates["note"].iloc[0]


def test_orders_are_tested_by_ranks_of_their_ratios():
    rng = np.random.default_rng(3)
    rows, ratios = [], {2: [], 3: [], 4: []}
    for i in range(12):
        for order in ratios:
            false = int(rng.integers(1, 4) + 3 * (order != 3))
            rows.append(row(f"r{i:02d}", POWERLAW, order, 1 / 3, (1 + i % 2, 1 - i % 2, false)))
            ratios[order].append((0.5 + 0.5 * (i % 2)) / (false / 2.0))
    found = order_tests("c", frame_of(rows)).set_index("question")
    assert list(found.reset_index().columns.sort_values()) == sorted(
        tables.TABLES["order_tests"].names()
    )
    one = kruskal(ratios[3], ratios[2] + ratios[4])
    assert found.loc["order 3 against the rest", "statistic"] == pytest.approx(one.statistic)
    assert found.loc["order 3 against the rest", "p"] == pytest.approx(one.pvalue)
    each = kruskal(*ratios.values())
    assert found.loc["all orders against each other", "p"] == pytest.approx(each.pvalue)
    within = friedmanchisquare(*ratios.values())
    assert found.loc["all orders against each other, within trajectories", "p"] == pytest.approx(
        within.pvalue
    )
    assert (found["left_out"] == 0).all() and (found["without_truth"] == 0).all()


def test_values_without_a_ratio_are_counted(binning):
    # a: neither hit nor false positive at order 3; without: no true boundary.
    rows = [
        row("a", POWERLAW, 2, 0.5, (1, 0, 1)), row("a", POWERLAW, 3, 0.5, (0, 1, 0)),
        row("b", POWERLAW, 2, 0.5, (1, 0, 2)), row("b", POWERLAW, 3, 0.5, (1, 0, 0)),
        row("n", POWERLAW, 2, 0.5, (0, 0, 2)), row("n", POWERLAW, 3, 0.5, (0, 0, 0)),
    ]  # fmt: skip
    found = order_tests("c", frame_of(rows))
    assert found["left_out"].tolist() == [1, 1, 1]
    assert found["without_truth"].tolist() == [1, 1, 1]
    # Two orders are too few for Friedman's test: said, not left empty.
    assert found["note"].iloc[2] != "" and np.isnan(found["p"].iloc[2])


def test_without_order_3_nothing_is_tested(binning):
    one = order_tests("c", binning[binning["order"] == 2])
    assert one.empty and list(one.columns) == tables.TABLES["order_tests"].names()
    assert order_tests("c", binning[binning["dataset"] == RECORDED]).empty
