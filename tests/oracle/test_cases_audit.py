"""GRIM, GRIMMER, ranges and printed statistics of other projects and papers, where they are there.

vectors.csv: inputs of other tools' tests, with what brute force over whole numbers says.
statistics.csv: statistics as printed in open papers, with statcheck's p and its verdict.
"""

import csv
import os
from pathlib import Path

import pytest

from signkin.audit import grim, grimmer, p_agrees
from signkin.audit.apa import statistics_in
from signkin.audit.pvalues import p_range

KINDS = {"t": "t", "F": "F", "Chi2": "chi2", "Z": "z", "r": "r", "Q": "Q"}


@pytest.fixture(scope="module")
def cases():
    data = os.environ.get("SIGNKIN_DATA")
    folder = os.environ.get("SIGNKIN_CASES") or (data and Path(data).parent / "cases")
    if not folder or not (Path(folder) / "audit").is_dir():
        pytest.skip("cases of the audit: no folder SIGNKIN_CASES, nor cases beside SIGNKIN_DATA")

    def rows(name):
        with (Path(folder) / "audit" / name).open(encoding="utf-8") as file:
            return list(csv.DictReader(file))

    return rows


def outcome(row):
    if row["kind"] == "grim":
        grain = "100" if "percent" in row["src"] else "1"
        return grim(row["mean"], row["n"], grain, items=row["items"])
    scale = {"low": "0", "high": "1"} if row["kind"] == "debit" else {}
    return grimmer(
        row["mean"], row["sd"], row["n"], divisor="n-1", items=row["items"], **scale
    )  # fmt: skip


def test_every_vector_is_as_brute_force_says(cases):
    rows = cases("vectors.csv")
    assert len(rows) > 200
    wrong = [
        row for row in rows
        if (outcome(row).verdict != "inconsistent") != (row["brute"] == "True")
    ]  # fmt: skip
    assert wrong == []


def test_statistics_are_read_and_their_p_is_statchecks(cases):
    rows = cases("statistics.csv")
    read = [(row, statistics_in(row["raw"])[0]) for row in rows]
    assert all(len(found) == 1 for _, found in read)
    for row, (one,) in read:
        assert one.kind == KINDS[row["test_type"]], row["raw"]
        p = p_range(one.kind, one.statistic, one.df).value
        assert p == pytest.approx(float(row["computed_p"]), abs=1e-9), row["raw"]


# Rounded degrees of freedom (1.8, 86.7) allow .017; 7.1423e-04 is the rounded p of 4.0728; .012 is
# that of r(54), so that 56 may be n.
ROUNDED = {"F(1.8, 86.7) = 4.55, p = .017", "t(18) = 4.0728, p = 7.1423e-04",
           "r(56) = .34, p = .012"}  # fmt: skip


def test_verdicts_are_statchecks_where_the_test_is_two_tailed(cases):
    accused = {"statcheck": 0, "two-tailed": 0, "any reading": 0}
    for row in cases("statistics.csv"):
        (one,), _ = statistics_in(row["raw"])
        two = p_agrees(one.kind, one.statistic, one.df, one.p, tails="two")
        either = p_agrees(one.kind, one.statistic, one.df, one.p)
        wrong = row["error"] == "TRUE"
        assert (two.verdict == "inconsistent") == wrong or row["raw"] in ROUNDED, row["raw"]
        if two.verdict == "inconsistent":
            told = two.severity == "the decision changes"
            assert told == (row["decision_error"] == "TRUE"), row["raw"]
        else:
            assert either.verdict == "consistent"
        accused["statcheck"] += wrong
        accused["two-tailed"] += two.verdict == "inconsistent"
        accused["any reading"] += either.verdict == "inconsistent"
    assert accused["any reading"] < accused["two-tailed"] <= accused["statcheck"]
