"""Drafts of claims from tables of many shapes: what is n, mean and SD of what, and what is open."""

import re

import pytest
import yaml

from signkin.audit.commands import findings_of
from signkin.audit.init import draft_of

GROUPS = "Accuracy, Deaf|20|5.10|1.50;Accuracy, Hearing|22|4.20|1.40;" \
         "Speed, Deaf|20|3.35|0.81;Speed, Hearing|22|3.05|0.95"  # fmt: skip
SHAPES = {
    "groups as columns, statistics as rows": (
        "t.csv", ",Deaf,Hearing\nn,20,22\nM,5.10,4.20\nSD,1.50,1.40\n",
        "Deaf|20|5.10|1.50;Hearing|22|4.20|1.40"),
    "n in the header, both numbers in a cell": (
        "t.csv", "Measure,Deaf (n = 20) M (SD),Hearing (n = 22) M (SD)\n"
        "Accuracy,5.10 (1.50),4.20 (1.40)\nSpeed,3.35 ± 0.81,3.05 ± 0.95\n", GROUPS),
    "two lines of headers, merged": (
        "t.csv", "Table 1,,,,,\nMeasure,Deaf (N=20),,Hearing (N=22),,p\n,M,SD,M,SD,\n"
        "Accuracy,5.10a,1.50,4.20b,1.40,.051\nSpeed,3.35,0.81,3.05,0.95,.279\n", GROUPS),
    "a column that names the statistic": (
        "t.csv", "Measure,Statistic,Deaf,Hearing\nAccuracy,N,20,22\n,Mean,5.10,4.20\n"
        ",SD,1.50,1.40\nSpeed,N,20,22\n,Mean,3.35,3.05\n,SD,0.81,0.95\n", GROUPS),
    "decimal commas": (
        "t.csv", ";Deaf;Hearing\nN;20;22\nMean;5,10;4,20\nSD;1,50;1,40\n",
        "Deaf|20|5.10|1.50;Hearing|22|4.20|1.40"),
    "groups as rows, n in their names": (
        "t.csv", "Group,Mean,Std. Deviation\nDeaf (n = 20),5.10,1.50\nHearing (n = 22),4.20,1.40\n",
        "Deaf|20|5.10|1.50;Hearing|22|4.20|1.40"),
    "SDs below their means": (
        "t.csv", "Measure,Deaf (n = 20),Hearing (n = 22)\nAccuracy,5.10,4.20\n,(1.50),(1.40)\n",
        "Accuracy, Deaf|20|5.10|1.50;Accuracy, Hearing|22|4.20|1.40"),
    "a text with columns by their place": (
        "t.txt", "Table 1. Scores\n\n"
        "                  Deaf (n = 20)      Hearing (n = 22)\n"
        "Measure           M       SD         M        SD       t(40)     p\n"
        "-----------------------------------------------------------------\n"
        "Accuracy        5.10     1.50       4.20     1.40      2.01    .051\n"
        "Speed           3.35     0.81       3.05     0.95      1.10    .279\n", GROUPS),
    "a text with single spaces": (
        "t.txt", "Table 2 Scores\nDeaf (n = 20) Hearing (n = 22)\nMeasure M SD M SD t p\n"
        "Accuracy 5.10 1.50 4.20 1.40 2.01 .051\nSpeed 3.35 0.81 3.05 0.95 1.10 .279\n", GROUPS),
    "a text with a heading within": (
        "t.txt", "Variable            Deaf             Hearing\n"
        "n                   20               22\nAccuracy\n"
        "  Mean              5.10             4.20\n  SD                1.50             1.40\n"
        "Speed, M (SD)       3.35 (0.81)      3.05 (0.95)\n", GROUPS),
    "labels that end in numbers": (
        "t.txt", "Group N M SD\nSession 1 20 5.10 1.50\nSession 2 22 4.20 1.40\n",
        "Session 1|20|5.10|1.50;Session 2|22|4.20|1.40"),
}  # fmt: skip


def drafted(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    draft = draft_of(tmp_path / name)
    for table, content in draft.tables.items():
        (tmp_path / table).write_text(content)
    return draft


def asked_and_run(draft, folder):
    """Run every check of a draft, those that stand in questions too: none may lack an argument."""
    text = re.sub(r"\n\s*#?\s+reads:", " reads:", "\n".join(draft.claims))
    checks = [yaml.safe_load(c) for c in re.findall(r"\{check: .*reads: .*?\"\}", text)]
    found = {}
    for check in checks:
        check.pop("reads")
        name = check.pop("check")
        found[name] = findings_of(name, check, folder)
        assert not [f.why for f in found[name] if f.fault]
    return found


@pytest.mark.parametrize("shape", SHAPES)
def test_numbers_of_every_shape_are_brought_to_their_measure_and_group(tmp_path, shape):
    name, text, wanted = SHAPES[shape]
    draft = drafted(tmp_path, name, text)
    (table,) = [t for n, t in draft.tables.items() if re.fullmatch(r"t(-table1)?\.csv", n)]
    rows = [re.sub(r'"([^"]*)"', lambda m: m[1].replace(",", ";"), r) for r in table.split("\n")]
    told = [r.replace(",", "|").replace(";", ",") for r in rows[1:] if r]
    assert told == wanted.split(";")
    assert "rows_twice" in asked_and_run(draft, tmp_path)


def test_what_stands_in_brackets_without_a_name_is_not_called_an_sd(tmp_path):
    draft = drafted(tmp_path, "t.csv", "Measure,A (n = 20),B (n = 22)\nAge,5.1 (1.5),4.2 (1.4)\n")
    assert draft.tables["t.csv"].startswith("row,n,value,in_brackets\n")
    assert "is not told" in draft.not_understood[0]


def test_tests_regressions_counts_and_correlations_of_tables(tmp_path):
    draft = drafted(tmp_path, "t.txt", """
Table 3
                 Deaf signers      Hearing signers
                   (n = 20)           (n = 22)        F(1, 40)      p
Accuracy         5.10 (1.50)        4.20 (1.40)         4.04      .051

Measure     t      df       p
Accuracy   2.01    40     .051
Speed     −2.26    31.5   .030*

Predictor        B      SE B     β       t       p
Constant       1.20    0.40            3.00    .004
Age            0.42    0.16    .25     2.63    .010

                 1       2       3
1. Age           —
2. Speed       .42**     —
3. Signing    −.11     .35*     —

Variable        Boys (n = 20)     Girls (n = 22)
Right-handed n (%)   18 (90)      20 (90.9)
""")  # fmt: skip
    assert draft.tables["t-table1-F-tests.csv"].split() == [
        "row,F,df1,df,p",
        "Accuracy,4.04,1,40,.051",
    ]
    assert draft.tables["t-table2-t-tests.csv"].split() == [
        "row,t,df,p", "Accuracy,2.01,40,.051", "Speed,-2.26,31.5,.030"]  # fmt: skip
    assert draft.tables["t-table3-regression.csv"].split()[1:] == [
        "Constant,1.20,0.40,3.00,.004,", "Age,0.42,0.16,2.63,.010,"]  # fmt: skip
    assert draft.tables["t-table4-correlations.csv"].split()[2:] == [
        "speed,.42,,", "signing,-.11,.35,"]  # fmt: skip
    assert draft.tables["t-table5-counts.csv"].splitlines()[1] == '"Right-handed, Boys",18,20,90'
    assert {"p_values", "regression_row", "correlation_matrix", "percentage"} <= set(
        asked_and_run(draft, tmp_path))  # fmt: skip
    # What a verdict hangs on is asked: brackets, the same people, of how many.
    checks = [c.split("published:")[1].strip().partition(":")[0] for c in draft.claims]
    assert checks.count("missing") == 2


def test_what_is_not_understood_is_told(tmp_path):
    draft = drafted(tmp_path, "t.csv", "Measure,t,p\nSpeed,2.10,.04\nAge,1.1,.28,x\n")
    assert not draft.claims
    assert [line.partition(": ")[2] for line in draft.not_understood[1:]] == [
        "t of Speed stands without degrees of freedom (df)",
        "no n with means, no test with its df and p among Measure, t, p",
    ]
    assert "row 3: more or fewer cells" in draft.not_understood[0]
    (tmp_path / "p.txt").write_text("Smith, J. (2010). Things. Journal, 12, 345-350.\n"
                                    "Jones, K. (2011). More. Journal, 13, 45-50.\n")  # fmt: skip
    assert not draft_of(tmp_path / "p.txt").not_understood  # references are no tables
