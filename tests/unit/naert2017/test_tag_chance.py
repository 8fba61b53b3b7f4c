"""The table of tags against nulls, from the tables of a corpus."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from signkin import tables
from signkin.settings import Settings
from signkin.statistics.nulls import MEAN_SHARE, MEDIAN, SHARE
from signkin.studies.naert2017.sampling import Sample
from signkin.studies.naert2017.tag_chance import tag_chance


def corpus_of(tiers, **told):
    return SimpleNamespace(name="c", settings=told, entries=["e"], by_name={"r": "e"},
                           tiers_of=lambda entry: {"sign": tiers})  # fmt: skip


CORPUS = corpus_of({"both": "t"})
REFINEMENT = Settings(refinement={"draws": 100}).refinement


def frames(signs, minima):
    """Tables of one recording `r` at 100 Hz; minima: hand -> times."""
    intervals = pd.DataFrame(signs, columns=["start_s", "end_s"]).assign(
        recording="r", role="sign", label="A", tier="t"
    )
    rows = [("r", hand, t) for hand, times in minima.items() for t in times]
    about = pd.DataFrame({"recording": ["r"], "rate_hz": [100.0]})
    return about, intervals, pd.DataFrame(rows, columns=["recording", "hand", "minimum_s"])


def found(signs, minima, corpus=CORPUS):
    return tag_chance(corpus, *frames(signs, minima), Sample(("r",), 1), REFINEMENT, 1)


def made():
    starts = 1 + np.cumsum(np.random.default_rng(3).integers(40, 90, 30)) / 100
    signs = np.round(np.column_stack([starts, starts + 0.25]), 2)
    apart = 1 + np.arange(0, 25, 0.37)
    return signs, {"right": signs.ravel(), "left": np.round(apart, 2)}


def test_a_hand_whose_minima_are_the_tags_and_one_whose_are_not():
    signs, minima = made()
    table = found(signs, minima)
    assert list(table.columns) == tables.TABLES["tag_chance"].names()
    one = table[table["measure"] == MEAN_SHARE].set_index(["hand", "tags", "null"]).sort_index()
    assert (one.loc["right", "value"] == 1).all()
    assert (one.loc["right", "p"].dropna() <= 0.05).all()
    assert one.loc[("right", "all", "uniform"), "n"] == 60
    assert one.loc[("right", "transition", "uniform"), "n"] == 58
    assert (one.loc["left", "p_holm"].dropna() > 0.05).all()
    assert one["p_holm"].notna().sum() == 12  # two hands, two sets of tags, three nulls
    assert one.loc[("right", "all", "Poisson"), ["p", "p_holm"]].isna().all()
    paper = table[(table["measure"] == SHARE) & np.isclose(table["window_s"], 0.15)]
    assert len(paper) == 16  # the paper's window is among them
    pd.testing.assert_frame_equal(table, found(signs, minima))


def test_a_tier_of_one_hand_is_held_against_that_hand_alone():
    signs, minima = made()
    whole = found(signs, minima)
    for corpus in (corpus_of({"both": "t"}, tagged_hand="right"), corpus_of({"right": "t"})):
        own = found(signs, minima, corpus)
        assert set(own["hand"]) == {"right"}
        pd.testing.assert_series_equal(own["chance"], whole.loc[own.index, "chance"])
    # A tier each: the right hand's tags are none of the left one's.
    each = found(signs, minima, corpus_of({"right": "t", "left": "u"}))
    told = each[each["hand"] == "left"]["note"].unique().tolist()
    assert told == ["not testable: no tag to compare with chance"]
    assert set(each.loc[each["hand"] == "right", "n"]) == {29, 58, 60}  # transitions, tags


def test_one_sign_has_no_transition_tags_and_a_hand_may_have_no_minimum():
    table = found([(1.0, 1.5)], {"right": [1.0, 1.5]})
    transition = table[table["tags"] == "transition"]
    assert transition["note"].tolist() == ["not testable: no tag to compare with chance"] * 2
    assert transition["p"].isna().all()
    left = table[(table["hand"] == "left") & (table["tags"] == "all")]
    assert (left["note"] == "this hand has no speed minimum").all()
    assert left.loc[left["measure"] == MEDIAN, "value"].isna().all()
    assert left.loc[left["measure"] == MEAN_SHARE, "value"].tolist() == pytest.approx([0] * 4)
