"""Effect sizes in one another, and printed beside groups: closed forms by mpmath, and data."""

import numpy as np
import pytest
from mpmath import mp, mpf

from signkin.audit.commands import findings_of


def test_effect_sizes_in_one_another_are_as_in_closed_form_and_in_data(tmp_path):
    # d = 0.8, logit: OR = exp(0.8 pi / sqrt 3), r = 0.8 / sqrt(0.64 + 4), by mpmath.
    mp.dps = 30
    d = mpf("0.8")
    exact = {
        "odds_ratio": mp.exp(d * mp.pi / mp.sqrt(3)), "log_odds": d * mp.pi / mp.sqrt(3),
        "r": d / mp.sqrt(d**2 + 4), "cles": mp.ncdf(d / mp.sqrt(2)),
        "fisher_z": mp.atanh(d / mp.sqrt(d**2 + 4)), "eta2": d**2 / (d**2 + 4), "f": d / 2,
    }  # fmt: skip
    for name, value in exact.items():
        for one, other, given, wanted in (("d", name, d, value), (name, "d", value, d)):
            texts = {"value": mp.nstr(given, 15), "equals": mp.nstr(wanted, 8)}
            given_ = {"effect": one, "to": other, **texts}
            (found,) = findings_of("effect_conversion", given_, tmp_path)
            assert found.verdict == "consistent", found
            assert float(found.recomputed) == pytest.approx(float(wanted), rel=1e-5)
    # Of data, r of membership is d by the exact formula, and eta squared its square.
    rng = np.random.default_rng(2)
    a, b = rng.normal(0, 1, 9), rng.normal(1, 1, 23)
    r = np.corrcoef(np.r_[a, b], np.r_[np.zeros(9), np.ones(23)])[0, 1]
    sd = np.sqrt((8 * a.var(ddof=1) + 22 * b.var(ddof=1)) / 30)
    given = {"effect": "d", "value": f"{(b.mean() - a.mean()) / sd:.12f}", "to": "r"}
    given = {**given, "n": ["9", "23"]}
    (found,) = findings_of("effect_conversion", {**given, "equals": f"{r:.9f}"}, tmp_path)
    assert found.verdict == "consistent" and found.settings.endswith("df / n1 + df / n2)")
    (found,) = findings_of("effect_conversion", {**given, "equals": ".80"}, tmp_path)
    assert found.verdict == "inconsistent" and "or d " in found.nearest


def test_d_beside_groups_is_named_by_its_formula(tmp_path):
    # t.test and sd of R 4.2.2 on x <- 1:10, y <- c(3,5,5,6,8,9,9,12):
    # (mean(y) - mean(x)) / sd(x), / sd(y), / sqrt((var(x) + var(y)) / 2)
    groups = {"n": ["10", "8"], "mean": ["5.500", "7.125"], "sd": ["3.0277", "2.9001"]}
    for d, name in (
        ("0.547", ""),
        ("0.537", "group 1"),
        ("0.560", "group 2"),
        ("0.548", "mean var"),
    ):
        (found,) = findings_of("test_of_groups", {**groups, "d": d}, tmp_path)
        assert found.verdict == "consistent" and name in found.why, found
    (found,) = findings_of("test_of_groups", {**groups, "d": "0.60"}, tmp_path)
    assert found.verdict == "inconsistent"
