"""Data that exist are never accused: some draws a check here, 10,000 by the command."""

import numpy as np
import pytest

from signkin.audit.registry import PUBLISHED
from support.audit_draws import DRAWS, accused

# No data to draw: a comparison, a bound of a design, a count of chains, rows told as a question.
NONE = {"relation", "p_reachable", "chains", "rows_twice"}
SLOW = {"grimmer": 60, "left_out": 60, "groups_differ": 60, "test_of_groups": 80}


def test_every_check_has_its_draws():
    assert set(DRAWS) - {"observed_range"} | NONE == set(PUBLISHED)


@pytest.mark.parametrize("name", sorted(DRAWS))
def test_what_exists_is_not_accused(tmp_path, name):
    rng = np.random.default_rng(3)
    wrong = [line for _ in range(SLOW.get(name, 120)) for line in accused(name, rng, tmp_path)]
    assert wrong == []
