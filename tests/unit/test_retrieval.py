"""Which of a gloss's signs is taken."""

from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from signkin.coarticulation import retrieve
from signkin.coarticulation.retrieval import (
    Candidates,
    Scale,
    best_chain,
    distances,
    greedy_chain,
)
from signkin.errors import SignkinError


def candidates(*pairs):
    """Signs of one joint on a line: (first, last) in metres."""
    first, last = np.array(pairs, dtype=float).T
    at = [np.column_stack([x, 0 * x, 0 * x])[:, None] for x in (first, last)]
    return Candidates(first=at[0], last=at[1])


@given(st.integers(0, 10_000), st.lists(st.integers(1, 4), min_size=2, max_size=5))
def test_the_best_chain_is_the_one_that_trying_all_finds(seed, sizes):
    rng = np.random.default_rng(seed)
    costs = [rng.integers(0, 5, (a, b)) / 4 for a, b in pairwise(sizes)]

    def total(chain):
        return sum(c[i, j] for c, i, j in zip(costs, chain, chain[1:], strict=False))

    chain, cost = best_chain(costs)
    assert cost == pytest.approx(min(total(c) for c in product(*map(range, sizes))))
    assert total(chain) == pytest.approx(cost)
    assert greedy_chain(costs)[1] >= cost - 1e-12


def test_the_nearest_step_first_is_not_always_the_best_chain():
    costs = [np.array([[1.0, 2.0]]), np.array([[9.0], [1.0]])]
    assert greedy_chain(costs) == ([0, 0, 0], 10.0)
    assert best_chain(costs) == ([0, 1, 0], 3.0)


def test_one_sign_alone_is_a_chain():
    assert best_chain([]) == ([0], 0.0)


def test_retrieval_minimises_the_mean_distance_to_both_neighbours():
    before, after = candidates((0, 1.0)), candidates((3.0, 0))
    # Distances before and after: 0.1 and 2; 1 and 0.5; 1.5 and 0.
    choice = candidates((1.1, 1.0), (2.0, 2.5), (2.5, 3.0))
    assert retrieve(choice, before, after) == 1
    assert retrieve(choice, previous=before) == 0
    assert retrieve(choice, following=after) == 2
    assert retrieve(choice) == 0


def test_orientations_count_by_their_range():
    half = np.array([np.sin(0.2), 0, 0, np.cos(0.2)])
    still = np.array([0, 0, 0, 1.0])
    before = Candidates(first=np.zeros((1, 1, 3)), last=np.zeros((1, 1, 3)),
                        first_turns=still[None, None], last_turns=still[None, None])  # fmt: skip
    after = Candidates(first=np.zeros((1, 1, 3)), last=np.zeros((1, 1, 3)),
                       first_turns=half[None, None], last_turns=half[None, None])  # fmt: skip
    assert distances(before, after, Scale(1.0, 0.4)) == pytest.approx(np.array([[0.25]]))
    assert distances(before, after, Scale()) == pytest.approx(np.array([[0.0]]))


def test_postures_of_gaps_alone_are_infinitely_far():
    gap = candidates((np.nan, np.nan))
    assert np.isinf(distances(candidates((0, 0)), gap, Scale())).all()


def test_no_candidate_and_two_neighbours_are_refused():
    with pytest.raises(SignkinError, match="no candidate"):
        retrieve(Candidates(first=np.empty((0, 1, 3)), last=np.empty((0, 1, 3))))
    with pytest.raises(SignkinError, match="2 neighbours on one side"):
        retrieve(candidates((0, 0)), previous=candidates((0, 0), (1, 1)))
