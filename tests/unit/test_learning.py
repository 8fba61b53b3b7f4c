"""The prior learnt from draws of a prior that is known, and what cannot be learnt from."""

import numpy as np
import pytest
from scipy.special import logsumexp

from signkin.binning import Prior, fit, held_out, learn_prior, log_evidences
from signkin.errors import SignkinError
from support.binning_model import drawn

BINS, ORDERS, ORDER = 30, (0, 1, 2), 1
TRUE = Prior(noise_sd=(0.4, 1.5), dof=6.0, concentration=0.02)
START = Prior(noise_sd=1.0)


def draws(count, seed, prior=TRUE, order=ORDER):
    rng = np.random.default_rng(seed)
    out = []
    for _ in range(count):
        inner = np.sort(rng.choice(BINS - 1, size=int(rng.integers(BINS)), replace=False))
        out.append(drawn(rng, np.diff([-1, *inner, BINS - 1]), order, 2, prior))
    return out


@pytest.fixture(scope="module")
def learnt():
    return learn_prior(draws(20, 1), ORDERS, START)


def test_the_prior_of_the_draws_is_found_again(learnt):
    """Some 300 segments: the values within what so many tell."""
    prior = learnt.prior
    assert np.log(np.array(prior.noise_sd) / TRUE.noise_sd) == pytest.approx(0, abs=0.25)
    assert 4.0 < prior.dof < 9.0
    assert np.log(prior.concentration / TRUE.concentration) == pytest.approx(0, abs=0.5)
    assert (prior.scale, prior.time_unit) == ("expected", "bin")
    assert learnt.order_probability.shape == (1, 3) and learnt.order_probability[0, 1] > 0.99
    assert learnt.note == ""


def test_no_prior_near_it_has_more_evidence(learnt):
    x = draws(20, 1)

    def shared(prior):
        total = log_evidences(x, ORDERS, prior).sum(axis=0)
        return logsumexp(total) - np.log(len(ORDERS))

    assert shared(learnt.prior) == pytest.approx(learnt.log_evidence, abs=1e-9)
    assert learnt.log_evidence > shared(TRUE) and learnt.log_evidence > shared(START)
    for change in ({"dof": learnt.prior.dof * 1.3}, {"concentration": 0.03}, {"noise_sd": 0.8}):
        own = Prior(**{"noise_sd": learnt.prior.noise_sd, "dof": learnt.prior.dof,
                       "concentration": learnt.prior.concentration, **change})  # fmt: skip
        assert shared(own) < learnt.log_evidence + 0.1


def test_it_predicts_other_draws_better_than_where_it_started(learnt):
    train, other = draws(20, 1), draws(10, 2)

    def predicted(prior):
        return held_out(
            log_evidences(train, ORDERS, prior), log_evidences(other, ORDERS, prior)
        ).sum()

    truth = predicted(TRUE)
    assert predicted(learnt.prior) > predicted(START) + 10
    assert predicted(learnt.prior) > truth - 15


def test_the_predictive_density_is_the_evidence_of_both_over_that_of_one():
    rng = np.random.default_rng(5)
    train, other = rng.normal(-40, 3, (4, 3)), rng.normal(-40, 3, (2, 3))
    for row, found in zip(other, held_out(train, other), strict=True):
        both, one = (logsumexp(v.sum(axis=0)) for v in (np.vstack([train, row]), train))
        assert found == pytest.approx(both - one)
    assert log_evidences(draws(1, 3), ORDERS, TRUE)[0] == pytest.approx(
        fit(draws(1, 3)[0], ORDERS, TRUE).log_evidence
    )


def test_each_group_has_an_order_of_its_own():
    x = [*draws(6, 7, order=0), *draws(6, 8, order=2)]
    groups = ["one"] * 6 + ["two"] * 6
    found = learn_prior(x, (0, 2), TRUE, groups=groups, most_evaluations=400)
    assert found.groups == ("one", "two")
    assert found.order_probability.round(2).tolist() == [[1, 0], [0, 1]]


@pytest.mark.parametrize(
    ("x", "more", "told"),
    [
        ([], {}, "no trajectory"),
        ([np.zeros((9, 2)), np.zeros((9, 3))], {}, "trajectories of 2 and 3 dimensions"),
        ([np.zeros((9, 2))], {"groups": ["a", "b"]}, "2 groups"),
        (draws(2, 1), {"most_evaluations": 9}, r"still grows after \d+ evaluations"),
    ],
)
def test_what_cannot_be_learnt_from_is_said(x, more, told):
    with pytest.raises(SignkinError, match=told):
        learn_prior(x, (0, 1), START, **more)
