"""The prior learnt on half of a corpus's recordings, in a table beside those that are told."""

import numpy as np
import pytest

from signkin import tables
from signkin.studies.endres2013 import learnt
from signkin.studies.endres2013.learnt import LEARNT, learnt_priors
from signkin.studies.endres2013.settings import ChoiceSettings
from signkin.studies.endres2013.single_signs import RECORDED, Trajectory
from support.endres import corpus_of, settings

NAMES = list("abcdefgh")


def walks(noise=0.002, bins=24):
    """Return trajectories of two bent pieces in noise, one a name."""
    rng = np.random.default_rng(6)
    t = np.linspace(0, 1, bins // 2)[:, None]
    out = []
    for name in NAMES:
        pieces = [t * rng.normal(0, 0.2, 3) + t**2 * rng.normal(0, 0.2, 3) for _ in range(2)]
        x = np.vstack([pieces[0], pieces[0][-1] + pieces[1]])
        x += rng.normal(0, noise, x.shape)
        out.append(Trajectory(name, "right", RECORDED, x, 0.04, np.empty(0)))
    return out


def table_of(trajectories, corpus=None):
    own = settings({"orders": [1, 2], "learnt_recordings": 8}, orders=[1, 2])
    return learnt_priors(corpus or corpus_of(NAMES), trajectories, ChoiceSettings.of(own), 1)


@pytest.fixture(scope="module")
def found():
    return table_of(walks())


def test_each_half_is_predicted_from_the_other(found):
    assert list(found.columns) == tables.TABLES["learnt_prior"].names("m")
    assert found["held_out"].value_counts().to_dict() == {"first": 4, "second": 4}
    assert (found["n_train"] == 4).all() and (found["n_held_out"] == 4).all()
    assert found.groupby("held_out")["gain"].first().tolist() == [0, 0]  # the one configured
    own = found[found["prior"] == LEARNT].set_index("held_out")
    assert (own["gain"] > 0).all() and (own["evaluations"] > 20).all()
    others = found[found["prior"] != LEARNT].groupby("held_out")["log_density_train"].max()
    assert (own["log_density_train"] > others).all()
    assert own["noise_sd_m"].between(0.001, 0.004).all()  # 0.002 was put in
    assert (own["order"] == 2).all()


@pytest.fixture
def short(monkeypatch):
    """A search that is given no time."""
    learn = learnt.learn_prior

    def stopped(*given, **more):
        return learn(*given, **more, most_evaluations=5)

    monkeypatch.setattr(learnt, "learn_prior", stopped)


@pytest.mark.usefixtures("short")
def test_what_is_left_out_is_counted_and_too_few_have_no_row():
    odd = walks()
    odd[0] = Trajectory("a", "right", RECORDED, odd[0].x[:, :2], 0.04, np.empty(0))
    assert table_of(odd[:3]).empty
    table = table_of(odd)
    assert table["note"].str.contains("1 of other dimensions or too few bins left out").all()
    there = table[table["prior"] != LEARNT]
    assert (there["n_train"] + there["n_held_out"] == 7).all()


@pytest.mark.usefixtures("short")
def test_a_search_that_does_not_settle_is_a_sentence():
    rows = table_of(walks())
    told = rows[rows["prior"] == LEARNT]
    assert told["note"].str.contains("the evidence still grows").all()
    assert told[["dof", "gain", "log_density_held_out"]].isna().all(axis=None)
