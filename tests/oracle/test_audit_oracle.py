"""The audit's arithmetic against R, brute force and statsmodels.

R 4.2.2 figures: one sample of each row of Table 2 (whole frames with the row's only sum and sum
of squares, so that any such sample gives the same figures) in a data frame d(type, d), then
    mean(d$d); sd(d$d); summary(aov(d ~ type, d)); without 2010: oneway.test(d ~ type);
    0000 against 0010: t.test(d ~ type), the same with var.equal = TRUE
and power.anova.test(groups = 4, n = 20, between.var = var(1:4) * 0.05, within.var = 1),
pf, pchisq, pt, pnorm, kruskal.test(list(1:4, 5:10)).
"""

import csv
from fractions import Fraction
from itertools import combinations_with_replacement

import numpy as np
import pytest
from scipy import stats
from statsmodels.stats.oneway import anova_generic

from signkin import audit
from signkin.audit import summaries
from signkin.audit.whole import possible

GRAIN = "0.01"


@pytest.fixture(scope="module")
def rows(root):
    with (root / "papers/naert2017/table2.csv").open() as file:
        return [row for row in csv.DictReader(file) if row["n"] != "0"]


def columns(rows):
    return [[row[name] for row in rows] for name in ("n", "mean", "sd")]


# --- Table 2, the golden case


def test_all_filled_rows_pass_grim(rows):
    found = [audit.grim(r["mean"], r["n"], GRAIN) for r in rows]
    assert len(found) == 13
    assert {f.verdict for f in found} == {"consistent"}
    edge = next(f for f, r in zip(found, rows, strict=True) if r["type"] == "1110")
    assert list(edge.sums) == [413]
    # On the rounding edge: 413 / 16 = 25.8125 frames prints ...13 rounded half up only.
    assert audit.grim("0.25813", 16, GRAIN, "half_up").verdict == "consistent"
    assert audit.grim("0.25813", 16, GRAIN, "half_even").verdict == "inconsistent"


def test_twelve_rows_pass_grimmer_with_n_minus_1_alone_and_one_pair_each(rows):
    many = [r for r in rows if r["n"] != "1"]
    assert len(many) == 12
    for row in many:
        found = audit.grimmer(row["mean"], row["sd"], row["n"], GRAIN)
        assert found.verdict == "consistent"
        assert len(found.pairs["n-1"]) == 1
        assert found.pairs["n"] == ()
        # The print comes back from the pair.
        (total, squares), n = found.pairs["n-1"][0], int(row["n"])
        variance = (Fraction(squares) - Fraction(total**2, n)) / (n - 1) / 10_000
        places = len(row["sd"].partition(".")[2])
        assert abs(float(variance) ** 0.5 - float(row["sd"])) <= 0.5 * 10**-places + 1e-12
    single = next(r for r in rows if r["n"] == "1")
    assert audit.grimmer(single["mean"], single["sd"], 1, GRAIN).verdict == "undecidable"


def test_the_outlier_is_79_frames_by_sum_and_by_squares(rows):
    row = next(r for r in rows if r["type"] == "1000")
    whole = (row["n"], row["mean"], row["sd"])
    without = tuple(row[f"{k}_without_outlier"] for k in ("n", "mean", "sd"))
    pair = summaries.groups(*zip(whole, without, strict=True), grain=GRAIN)
    for value in summaries.left_out(*pair):
        assert (value.low, value.high) == (Fraction(79, 100), Fraction(79, 100))
    rough = summaries.groups(*zip(whole, without, strict=True))
    assert all(Fraction(79, 100) in value for value in summaries.left_out(*rough))


def test_totals_and_anova_are_those_of_r(rows):
    of = summaries.groups(*columns(rows), grain=GRAIN)
    assert sum(g.n for g in of) == 89
    mean = summaries.pooled_mean(of)
    assert mean.low == mean.high
    assert float(mean.low) == pytest.approx(0.303033707865, abs=1e-12)
    assert summaries.pooled_sd(of).value == pytest.approx(0.098458626456, abs=1e-12)
    test = audit.anova_from_summary(*columns(rows), grain=GRAIN)
    assert (test.df1, test.df2.value) == (12, 76)
    between, within = summaries.sums_of_squares(of)
    assert between.value == pytest.approx(0.0905795226, abs=5e-11)
    assert within.value == pytest.approx(0.7625013763, abs=5e-11)
    assert test.statistic.value == pytest.approx(0.75235, abs=5e-6)
    assert test.p.value == pytest.approx(0.69618, abs=5e-6)
    assert test.effect.value == pytest.approx(0.106179288193, abs=1e-12)
    # Without the grain: a range, which holds R's figures.
    rough = audit.anova_from_summary(*columns(rows))
    assert rough.statistic.low < 0.75235 < rough.statistic.high
    assert rough.p.low < 0.69618 < rough.p.high
    assert rough.statistic.high - rough.statistic.low < 1e-3


def test_welch_and_t_are_those_of_r(rows):
    many = [r for r in rows if r["n"] != "1"]
    test = audit.welch_from_summary(*columns(many), grain=GRAIN)
    assert test.statistic.value == pytest.approx(0.5700752308, abs=1e-9)
    assert test.df2.value == pytest.approx(23.18708684, abs=1e-7)
    assert test.p.value == pytest.approx(0.833257359, abs=1e-8)
    two = [r for r in rows if r["type"] in ("0000", "0010")]
    test = audit.t_from_summary(*columns(two), grain=GRAIN)
    assert test.statistic.value == pytest.approx(-0.8068835377, abs=1e-9)
    assert test.df2.value == pytest.approx(10.47464268, abs=1e-7)
    assert test.p.value == pytest.approx(0.437671192, abs=1e-8)
    pooled = audit.t_from_summary(*columns(two), grain=GRAIN, equal_variances=True)
    assert pooled.p.value == pytest.approx(0.434744390961, abs=1e-10)


def test_welch_is_that_of_statsmodels(rows):
    many = [r for r in rows if r["n"] != "1"]
    n, mean, sd = (np.array(c, dtype=float) for c in columns(many))
    other = anova_generic(mean, sd**2, n, use_var="unequal")
    ours = audit.welch_from_summary(*columns(many))
    assert ours.statistic.value == pytest.approx(other.statistic, rel=1e-4)


def test_the_transitions_come_from_five_chains_or_more(rows):
    least, kinds = audit.chains({r["type"]: int(r["n"]) for r in rows})
    assert least == 5
    assert kinds == {"11": (32, 27), "10": (29, 33), "00": (18, 19), "20": (10, 10)}


# --- other figures of R


def test_p_and_power_are_those_of_r():
    assert audit.p_from("F", "4.2", 1, 50).value == pytest.approx(0.0456885396291, abs=1e-12)
    assert audit.p_from("chi2", "12.3", 7).value == pytest.approx(0.0911148860003, abs=1e-12)
    assert audit.p_from("t", "-2.1", 17).value == pytest.approx(0.0509598472291, abs=1e-12)
    assert audit.p_from("z", "-1.96").value == pytest.approx(0.0499957902964, abs=1e-12)
    # R's between.var has the divisor groups - 1; f^2 has groups.
    f = (np.var([1, 2, 3, 4]) * 0.05) ** 0.5
    assert audit.power_of([20] * 4, f) == pytest.approx(0.420390090695, abs=1e-6)
    h, p = audit.kruskal_limit([4, 6])
    assert h == pytest.approx(6.54545454545, abs=1e-10)
    assert p == pytest.approx(0.0105152459359, abs=1e-12)


@pytest.mark.parametrize("kind, df", [("F", (3, 20)), ("t", (9,)), ("chi2", (4,)), ("z", ())])
def test_statistics_come_back_from_their_p(kind, df):
    p = audit.p_from(kind, "2.50", *df)
    back = audit.statistic_from(kind, f"{p.value:.12f}", *df)
    assert back.value == pytest.approx(2.5, abs=1e-8)


# --- brute force


@pytest.mark.parametrize("n", [2, 3, 4, 5, 6])
def test_whole_numbers_exist_exactly_where_brute_force_finds_them(n):
    low, high = -2, 5
    found = {
        (sum(v), sum(x * x for x in v))
        for v in combinations_with_replacement(range(low, high + 1), n)
    }
    for total in range(n * low, n * high + 1):
        for squares in range(0, 25 * n + 1):
            assert possible(n, total, squares, low, high) == ((total, squares) in found)


def test_all_samples_are_those_of_brute_force():
    wanted = {
        v
        for v in combinations_with_replacement(range(10, 51), 4)
        if f"{sum(v) / 400:.4f}" == "0.2850" and f"{np.std(v, ddof=1) / 100:.4f}" == "0.0794"
    }
    found = audit.samples("0.2850", "0.0794", 4, GRAIN, "0.10", "0.50")
    assert found.complete
    assert set(found.values) == wanted
    assert len(wanted) > 1


def test_drawn_samples_are_spread_as_all_samples_are():
    everything = audit.samples("0.26833", "0.095167", 6, GRAIN, "0.10", "0.50", most=10_000)
    assert everything.complete
    drawn = audit.samples("0.26833", "0.095167", 6, GRAIN, "0.10", "0.50", most=150, seed=3)
    assert not drawn.complete
    assert set(drawn.values) <= set(everything.values)
    assert len(set(drawn.values)) > 60
    assert drawn == audit.samples("0.26833", "0.095167", 6, GRAIN, "0.10", "0.50", most=150, seed=3)
    assert stats.ks_2samp(
        np.ravel([v[-1] for v in drawn.values]), np.ravel([v[-1] for v in everything.values])
    ).pvalue > 1e-4  # fmt: skip
