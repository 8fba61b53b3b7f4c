"""Tests of duration against R 4.2.2, which had no part in them.

The data and the R code that made the figures:

    d <- data.frame(y = c(...), a = c(...), b = c(...)); g <- factor(d$a)   # as Y, A, B below
    oneway.test(y ~ g, d); kruskal.test(y ~ g, data = d); TukeyHSD(aov(y ~ g, d))
    z <- abs(d$y - ave(d$y, g, FUN = median)); anova(lm(z ~ g))                       # Levene
    full <- lm(y ~ factor(paste0(a, b)), d); ab <- lm(y ~ a + b, d)                   # type II
    m <- lm(y ~ a * b, block, contrasts = list(a = "contr.sum", b = "contr.sum"))
    drop1(m, . ~ ., test = "F")                                                       # type III
    t.test(x, y, mu = -.05, alternative = "greater"); t.test(x, y, conf.level = .9)   # TOST
    power.anova.test(groups = 4, n = 20, within.var = 1, power = .8)
    power.t.test(n = 20, power = .8, sd = 1)
"""

import numpy as np
import pandas as pd
import pytest

from signkin.statistics import anova, equivalence, posthoc, power
from signkin.statistics.findings import grouped

Y = np.array([.21, .34, .28, .19, .30, .42, .25, .31, .27, .36, .33, .40, .22, .18, .29, .24, .26,
              .39, .35, .20, .23, .45, .32])  # fmt: skip
A = np.array(list("00000111111122221110022"), dtype=object)
B = np.array(list("00111000112211222101012"), dtype=object)


@pytest.fixture(scope="module")
def one_way():
    found = anova.one_way(grouped(Y, A), "a", 0.05, 0.25)
    return {f.test: f for f in found if "omega" not in f.effect_name}


def test_one_way_and_its_checks_against_r(one_way):
    expected = {
        "one-way ANOVA": (3.0699965821, 2, 20, 0.0687456559),
        "Welch's ANOVA": (4.0369031, 2, 10.82819, 0.04898352),
        "Levene": (0.6304482768, 2, 20, 0.5426055264),
    }
    for test, numbers in expected.items():
        f = one_way[test]
        assert (f.statistic, f.df1, f.df2, f.p) == pytest.approx(numbers, rel=1e-6), test
    kruskal, shapiro = one_way["Kruskal-Wallis"], one_way["Shapiro-Wilk"]
    assert (kruskal.statistic, kruskal.p) == pytest.approx((5.7043478, 0.05771871), rel=1e-6)
    assert (shapiro.statistic, shapiro.p) == pytest.approx((0.9625322, 0.5163625), rel=1e-4)


def test_tukey_against_r():
    found = [f for f in posthoc.pairwise(grouped(Y, A), "a", 0.05) if f.test == "Tukey HSD"]
    assert [f.comparison for f in found] == ["a: 0 - 1", "a: 0 - 2", "a: 1 - 2"]
    assert [f.statistic for f in found] == pytest.approx([-0.084, -0.0333333333, 0.0506666667])
    assert [f.p for f in found] == pytest.approx([0.0610946695, 0.6744468149, 0.3603039], rel=1e-5)


@pytest.fixture(scope="module")
def factors():
    found = anova.factorial(Y, A, B, ("a", "b"), 0.05, 0.25)
    return [f for f in found if "omega" not in f.effect_name]


def test_type_two_with_empty_cells_against_r(factors):
    found = [f for f in factors if f.test.endswith("type II")]
    assert [(f.comparison, f.df1, f.df2) for f in found] == [
        ("a", 2, 16), ("b", 2, 16), ("a x b", 2, 16),
    ]  # fmt: skip
    assert [f.statistic for f in found] == pytest.approx([2.29585995, 0.0120955993, 0.0444135288])
    assert [f.p for f in found] == pytest.approx([0.1328675371, 0.9879862834, 0.9566758132])
    assert all("empty cells: 0 before 2, 2 before 0" in f.note for f in found)


def test_type_three_on_the_block_without_empty_cells_against_r(factors):
    found = [f for f in factors if f.test.endswith("type III")]
    assert [f.n for f in found] == [14] * 3
    assert [f.statistic for f in found] == pytest.approx([5.87697001, 0.0203355364, 0.1270971021])
    assert [f.p for f in found] == pytest.approx([0.0358007288, 0.8894362639, 0.7288684251])
    assert all("9 transitions left out" in f.note for f in found)


def test_equivalence_against_r():
    f = equivalence.tost(Y[A == "0"], Y[A == "1"], "0 - 1", 0.05, 0.05)
    assert f.p == pytest.approx(0.8703704912, rel=1e-8)
    assert (f.effect_low, f.effect_high) == pytest.approx((-0.1349753148, -0.0330246852), rel=1e-8)


def test_smallest_effects_against_r():
    # R gives the variance of the means with divisor k - 1.
    expected = np.sqrt(0.191317 * 3 / 4)
    assert power.smallest_f(3, 76, 80, 0.05, 0.8) == pytest.approx(expected, rel=1e-5)
    assert power.smallest_d(20, 20, 0.05, 0.8) == pytest.approx(0.9091305661, rel=1e-5)


def test_equivalence_of_all_means_by_simulation():
    """At the margin itself, equivalence is claimed in about 5 % of samples, no more."""
    rng = np.random.default_rng(4)
    means = np.array([-0.025, 0.025, -0.025, 0.025])  # an SD of 0.025 around their mean
    claimed = [
        equivalence.omnibus(
            {str(i): rng.normal(m, 0.05, 15) for i, m in enumerate(means)}, "x", 0.05, 0.05
        ).p < 0.05
        for _ in range(400)
    ]  # fmt: skip
    assert 0.01 <= np.mean(claimed) <= 0.10


def test_the_printed_table_gives_the_papers_anova(root):
    """F(12, 76) = 0.752, p = 0.696 follow from the sums and sums of squares of Table 2."""
    rows = pd.read_csv(root / "papers" / "naert2017" / "table2.csv", dtype=str)
    groups = {}
    for row in rows[rows["n"] != "0"].itertuples():
        n, mean, sd = int(row.n), float(row.mean), float(row.sd)
        values = np.resize([-1.0, 1.0], n)
        values[-1] = 0 if n % 2 else values[-1]
        scale = sd / values.std(ddof=1) if n > 1 else 0
        groups[row.type] = mean + scale * values
    found = {
        (f.test, f.effect_name): f for f in anova.one_way(groups, "type", 0.05, 0.25)
    }  # fmt: skip
    f = found["one-way ANOVA", "eta squared"]
    assert (f.df1, f.df2, f.n) == (12, 76, 89)
    assert (f.statistic, f.p, f.effect) == pytest.approx((0.752, 0.696, 0.106), abs=5e-4)
    assert found["one-way ANOVA", "omega squared"].effect < 0 <= f.effect_low
    assert "2010" in f.note
