"""The checks on tests, counts, intervals and matrices against figures of R 4.2.2.

Each test names its call. Printed numbers are R's, rounded; a digit off, and the check says so.
"""

import pytest

from signkin.audit import kruskal_limit
from signkin.audit.checks.counts import chi_squared
from signkin.audit.commands import findings_of
from signkin.audit.findings import summary
from signkin.audit.kruskal import exact_distribution, exact_tail
from signkin.audit.pvalues import p_agrees, p_from, p_range, statistic_from
from signkin.audit.summaries import groups
from signkin.audit.two_groups import compare, hedges


@pytest.fixture
def says(tmp_path):
    def verdict(name, table="", **given):
        if table:
            (tmp_path / "t.csv").write_text(table)
            given["table"] = "t.csv"
        return summary(findings_of(name, given, tmp_path))

    return verdict


# x <- c(1.2,3.4,2.2,5.1,4.4,3.9,2.8); y <- c(2.1,3.0,3.3,6.2,5.5,3.1,2.0,4.4)
# z <- y[1:5] + 1.5; mean, sd of each
THREE = {"n": ["7", "8", "5"], "mean": ["3.285714286", "3.700000000", "5.520000000"],
         "sd": ["1.334701679", "1.532504952", "1.745565811"]}  # fmt: skip
TWO = {key: values[:2] for key, values in THREE.items()}


def test_t_of_two_groups_is_that_of_r():
    of = groups(TWO["n"], TWO["mean"], TWO["sd"])
    welch, student = compare(of, False), compare(of, True)
    # t.test(x, y); t.test(x, y, var.equal = TRUE)
    assert welch.t.value == pytest.approx(-0.5596099394, abs=1e-8)
    assert welch.df.value == pytest.approx(12.9995878245, abs=1e-7)
    assert welch.p.value == pytest.approx(0.5852591738, abs=1e-8)
    assert student.t.value == pytest.approx(-0.5541234834, abs=1e-8)
    assert student.p.value == pytest.approx(0.5888998882, abs=1e-8)
    for found in (welch, student):
        assert found.t.low < found.t.value < found.t.high
        assert found.p.low < found.p.value < found.p.high
    # exp(lgamma(6.5) - lgamma(6)) / sqrt(6.5)
    assert hedges(13) == pytest.approx(0.940982467, abs=1e-8)


@pytest.mark.parametrize(
    "printed, verdict",
    [
        ({"t": "0.56", "df": "13.00", "p": ".585"}, "consistent"),
        ({"t": "0.55", "df": "13", "p": ".589"}, "consistent"),
        ({"t": "1.56"}, "inconsistent"),
        ({"p": ".29"}, "consistent"),  # one-tailed
        ({"p": ".29", "tails": "two"}, "inconsistent"),
        ({"t": "<0.6"}, "consistent"),
    ],
)
def test_printed_t_tests_are_judged(says, printed, verdict):
    # Student's t with Welch's p is neither's.
    assert says("test_of_groups", **TWO, t="0.554", p=".5853") == "inconsistent"
    rounded = {key: [f"{float(v):.2f}" if key != "n" else v for v in values]
               for key, values in TWO.items()}  # fmt: skip
    assert says("test_of_groups", **rounded, **printed) == verdict


@pytest.mark.parametrize(
    "printed, verdict",
    [
        ({"F": "3.42", "p": ".056"}, "consistent"),  # summary(aov(v ~ g)): 3.42482, 0.056263
        ({"F": "2.76", "df": "9.71", "p": ".112"}, "consistent"),  # oneway.test(v ~ g)
        ({"F": "3.42", "p": ".112"}, "inconsistent"),
        ({"F": ".15"}, "inconsistent"),
        ({"F": "3.24", "test": "anova"}, "inconsistent"),
    ],
)
def test_printed_f_tests_are_judged(says, printed, verdict):
    assert says("test_of_groups", **THREE, **printed) == verdict


# m <- matrix(c(12,8,5,15), 2, byrow = TRUE); chisq.test(m, correct = FALSE), chisq.test(m),
# 2 * sum(m * log(m / expected)), fisher.test(m)
@pytest.mark.parametrize(
    "printed, verdict",
    [
        ({"chi2": "5.01", "p": ".025"}, "consistent"),
        ({"chi2": "3.68", "p": ".055"}, "consistent"),
        ({"chi2": "5.13", "p": ".023"}, "consistent"),
        ({"p": ".054"}, "consistent"),
        ({"chi2": "5.01", "p": ".054"}, "consistent"),  # chi-squared, with Fisher's p beside it
        ({"chi2": "5.01", "p": ".055"}, "inconsistent"),
        ({"chi2": "4.01"}, "inconsistent"),
        ({"p": ".055", "test": "fisher"}, "inconsistent"),
        ({"chi2": "3.68", "test": "pearson"}, "inconsistent"),
    ],
)
def test_chi_squared_of_four_counts(says, printed, verdict):
    assert says("chi_squared", counts=[["12", "8"], ["5", "15"]], **printed) == verdict


def test_larger_and_single_tables(says):
    # chisq.test(matrix(c(10,14,9,21,6,12), 2, byrow = TRUE)): 7.08097, df 2, 0.028999
    counts = [["10", "14", "9"], ["21", "6", "12"]]
    assert says("chi_squared", counts=counts, chi2="7.08", df="2", p=".029") == "consistent"
    assert says("chi_squared", counts=counts, chi2="7.08", df="3") == "inconsistent"
    # chisq.test(c(20, 30, 25)): 2, 0.3678794
    assert says("chi_squared", counts=[["20", "30", "25"]], chi2="2.00", p=".37") == "consistent"
    table = "g,yes,no\na,12,8\nb,5,15\n"
    assert says("chi_squared", table, columns=["yes", "no"], chi2="5.01") == "consistent"
    assert chi_squared.__name__ == "chi_squared"


def test_odds_ratio_with_its_interval(says):
    # exp(log(12 * 15 / (8 * 5)) + c(0, -1, 1) * 1.959964 * sqrt(1/12 + 1/8 + 1/5 + 1/15))
    counts = [["12", "8"], ["5", "15"]]
    ends = {"low": "1.17", "high": "17.37"}
    assert says("odds_ratio", counts=counts, odds_ratio="4.50", **ends) == "consistent"
    assert says("odds_ratio", counts=counts, odds_ratio="0.22") == "consistent"  # turned
    assert says("odds_ratio", counts=counts, odds_ratio="4.50", low="1.27") == "inconsistent"
    assert says("odds_ratio", counts=counts, risk_ratio="2.40") == "consistent"
    assert says("odds_ratio", counts=[["0", "8"], ["5", "15"]], odds_ratio="1.0") == "undecidable"


def test_a_row_of_a_regression(says):
    # lm(y ~ xx), xx = c(1,2,3,4,5,6,7,9): coefficients and confint, to three decimals
    row = {"b": "3.181", "se": "1.208", "t": "2.63", "p": ".039", "df": "6"}
    ends = {"low": "0.224", "high": "6.137"}
    assert says("regression_row", **row, **ends) == "consistent"
    assert says("regression_row", **{**row, "t": "2.36"}) == "inconsistent"
    assert says("regression_row", **{**row, "p": ".009"}) == "inconsistent"
    assert says("regression_row", **row, low="0.224", high="5.137") == "inconsistent"


def test_intervals_on_three_scales(says):
    # cor.test(xx, y): 0.1955670416, -0.5904804732 to 0.7912035728
    ends = {"estimate": ".196", "low": "-.590", "high": ".791"}
    assert says("confidence_interval", **ends) == "consistent"
    assert says("confidence_interval", **ends, scale="linear") == "inconsistent"
    odds = {"estimate": "4.50", "low": "1.17", "high": "17.37"}
    assert says("confidence_interval", **odds) == "consistent"
    assert says("confidence_interval", **odds, scale="linear") == "inconsistent"
    b = {"estimate": "3.18", "low": "0.22", "high": "6.14", "se": "1.21", "df": "6"}
    assert says("confidence_interval", **b, p=".039") == "consistent"
    assert says("confidence_interval", **b, p=".139") == "inconsistent"
    assert says("confidence_interval", **{**b, "se": "0.81"}) == "inconsistent"
    assert says("confidence_interval", estimate="7", low="1", high="3") == "inconsistent"


def test_changes(says):
    # pre <- c(10,12,9,14,11,8); post <- c(12,13,12,15,15,9): means, sds, cor
    given = {"pre": "10.67", "post": "12.67", "change": "2.00", "sd_pre": "2.16",
             "sd_post": "2.25", "sd_change": "1.26"}  # fmt: skip
    assert says("change_scores", **given, r=".836") == "consistent"
    assert says("change_scores", **given, r=".736") == "inconsistent"
    assert says("change_scores", **{**given, "change": "2.20"}) == "inconsistent"
    assert says("change_scores", **{**given, "sd_change": "5.26"}) == "inconsistent"


def test_exact_kruskal_wallis_is_every_order_of_ranks():
    # All 1680 orders of 3, 3, 3 by combn: P(H >= 5.6) = 0.05, P(H >= 7.2) = 0.003571429
    assert exact_tail("5.600", ["3", "3", "3"]).value == pytest.approx(0.05, abs=1e-12)
    assert exact_tail("7.20", ["3", "3", "3"]).value == pytest.approx(1 / 280, abs=1e-12)
    assert exact_distribution((3, 3, 3))[1].sum() == pytest.approx(1)
    assert exact_distribution((9, 9, 7)) is None  # too many: chi-squared then
    by_chi = p_agrees("H", "5.60", ["2"], ".050")
    assert by_chi.verdict == "inconsistent"  # .0608
    exact = p_agrees("H", "5.60", ["2"], ".050", groups=["3", "3", "3"])
    assert exact.verdict == "consistent"
    assert "only read as the exact test" in exact.why
    assert kruskal_limit([3, 3, 3])[0] == pytest.approx(7.2)


def test_p_of_every_kind_is_that_of_r():
    assert p_from("r", ".34", 56).value == pytest.approx(0.009020069681, abs=1e-10)
    assert p_from("Q", "17.184", 18).value == pytest.approx(0.5104904411, abs=1e-10)
    assert p_from("F", "4.55", "1.8", "86.7").value == pytest.approx(0.01604954408, abs=1e-10)
    one = p_range("t", "2.31", ["18"], tails="one")
    assert one.value == pytest.approx(0.01647694948, abs=1e-10)
    least = p_from("t", "<2.31", 18)
    assert (least.low, least.high) == (pytest.approx(2 * 0.0163, abs=4e-4), 1.0)


def test_what_a_paper_leaves_open_is_tried_and_named():
    one = p_agrees("t", "2.31", [18], ".016")
    assert one.verdict == "consistent"
    assert "only read as one-tailed" in one.why
    assert p_agrees("t", "2.31", [18], ".016", tails="two").verdict == "inconsistent"
    hangs = p_agrees("t", "1.74", [24], ".047")  # .0947 two-tailed
    assert hangs.verdict == "consistent"
    assert hangs.severity == "the decision changes if read as two-tailed"
    assert "disagree about 0.05" in hangs.why
    assert p_agrees("z", "2.79", [], "n.s.").verdict == "inconsistent"
    assert p_agrees("t", "-0.23", [193], ".591").verdict == "consistent"  # the other way
    # 2 * pt(-4.3, 2.4) = .0364; with 2 printed, Student's p is .0500
    whole = p_agrees("t", "4.30", ["2"], ".036", tails="two")
    assert whole.verdict == "consistent"
    assert "rounded degrees of freedom" in whole.why
    assert p_agrees("t", "4.30", ["2.0"], ".036", tails="two").verdict == "inconsistent"


@pytest.mark.parametrize(
    "statistic, p, wrong, decides",
    [
        ("1.97", "<.05", True, True),  # .0552
        ("1.19", "<.05", True, True),  # .24
        ("1.97", "<0.05", True, True),
        ("2.60", ".010", True, False),
        ("2.60", "ns", True, True),
        ("2.60", ">.05", True, True),
        ("1.00", "ns", False, False),
        ("2.60", "<.05", False, False),
    ],
)
def test_decisions_are_told(statistic, p, wrong, decides):
    found = p_agrees("t", statistic, [32], p, tails="two")
    assert (found.verdict == "inconsistent") == wrong
    assert (found.severity == "the decision changes") == decides
    assert ("disagree about 0.05" in found.why) == decides


def test_the_rounding_rule_holds_for_every_statistic():
    for kind, df in (("F", [2, 30]), ("chi2", [3]), ("H", [3]), ("t", [9]), ("r", [9])):
        near = p_range(kind, "0.50", df, "nearest")
        cut = p_range(kind, "0.50", df, "truncated")
        assert cut.low < near.low < cut.value < near.high  # cut off: from 0.50 to 0.51
        assert cut.value == pytest.approx(cut.high)
        assert cut.value == near.value  # by hand from the printed digits


def test_a_p_of_zero_has_a_statistic_without_end():
    for kind, df in (("F", (2, 30)), ("chi2", (3,)), ("t", (9,)), ("z", ())):
        found = statistic_from(kind, "0.000", *df)
        assert found.high == found.value == float("inf")
        assert found.low == pytest.approx(statistic_from(kind, "0.0005", *df).value)


@pytest.mark.parametrize(
    "cells, verdict",
    [
        (",a,b,c\na,1,,\nb,.90,1,\nc,.90,-.90,1\n", "inconsistent"),  # eigenvalues 1.9 1.9 -0.8
        (",a,b,c\na,1,,\nb,.90,1,\nc,.90,.70,1\n", "consistent"),
        (",a,b,c\na,,.6,.6\nb,,,-.3\nc,,,\n", "consistent"),  # 2 x .36 - 1 = -.28, printed -.3
        (",a,b,c\na,,.6,.6\nb,,,-.5\nc,,,\n", "inconsistent"),
        (",a,b,c,d\na,,.9,,\nb,,,.9,\nc,,,,.9\nd,,,,\n", "consistent"),  # not all printed
    ],
)
def test_matrices_that_no_data_have(says, cells, verdict):
    assert says("correlation_matrix", cells) == verdict


def test_counts_and_their_percentages(says):
    assert says("percentage", count="12", n="37", percent="32.4") == "consistent"
    assert says("percentage", count="12", n="37", percent="32.5") == "inconsistent"
    assert says("percentage", count="1", n="8", percent="12.5%") == "consistent"
    assert says("percentage", count="9", n="8", percent="112.5") == "inconsistent"
    table = "g,yes,no,sum\na,5,7,12\nb,3,9,{}\nall,8,16,24\n"
    given = {"columns": ["yes", "no"], "total": "sum", "total_row": "all"}
    assert says("margins", table.format(12), **given) == "consistent"
    assert says("margins", table.format(13), **given) == "inconsistent"


def test_effect_sizes_name_their_variant(tmp_path):
    given = {"effect": "d", "value": "0.68", "kind": "t", "statistic": "2.10", "df": ["38"]}
    (found,) = findings_of("effect_size", given, tmp_path)
    assert found.verdict == "consistent"
    assert found.settings == "2 t / sqrt(df)"  # 0.6813
    # 2.10 / sqrt(39): the effect size of a paired test
    (found,) = findings_of("effect_size", {**given, "value": "0.34"}, tmp_path)
    assert "paired" in found.why
    (found,) = findings_of("effect_size", {**given, "value": "0.50"}, tmp_path)
    assert found.verdict == "inconsistent"
    f = {"effect": "partial_eta2", "value": ".12", "kind": "F", "statistic": "5.20"}
    (found,) = findings_of("effect_size", {**f, "df": ["1", "38"]}, tmp_path)
    assert found.verdict == "consistent"  # 5.2 / 43.2 = .1204


def test_last_digits_are_a_question_with_their_power(says, tmp_path):
    rounded = "x\n" + "".join(f"{i}.{'05'[i % 2]}\n" for i in range(100))
    assert says("last_digits", rounded, columns=["x"]) == "undecidable"
    assert says("last_digits", "x\n1.1\n2.2\n", columns=["x"]) == "undecidable"
    (found,) = findings_of("last_digits", {"table": "t.csv", "columns": ["x"]}, tmp_path)
    assert "too few" in found.why
