"""The ledger: every claim has a verdict, the right one, and a changed digit changes it."""

import csv
import re
import shutil
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
import yaml

from signkin import SignkinError
from signkin.__main__ import main
from signkin.audit.__main__ import document
from signkin.audit.ledger import PRINT, audit, evidence_for
from signkin.audit.paper import read_paper
from signkin.audit.specifications import by_choice, specifications
from signkin.tables import read_table

# The golden facts of Table 2 and the worked example; what is not printed cannot be tested.
ON_PRINT = {
    **dict.fromkeys(
        ["N01", "N02", "N03", "N04", "N07", "N08", "N09", "N10", "N11", "N12", "N14", "N15", "N16",
         "N17", "N20", "E04", "E05", "E06", "E08", "E12"], "consistent",
    ),
    **dict.fromkeys(
        ["N05", "N06", "N13", "N19", "N21", "N22", "N23", "E01", "E02", "E03", "E07", "E09", "E10",
         "E11", "E13", "E14"], "not testable",
    ),
    "N18": "inconsistent",
}  # fmt: skip


@pytest.fixture(scope="session")
def papers(root):
    return [read_paper(root / "papers" / name) for name in ("naert2017", "endres2013")]


@pytest.fixture
def naert(root, tmp_path):
    """Return a maker of a copy of the paper with some cells of Table 2 changed."""

    def make(changes):
        folder = tmp_path / "naert2017"
        shutil.copytree(root / "papers/naert2017", folder, dirs_exist_ok=True)
        with (folder / "table2.csv").open() as file:
            rows = list(csv.DictReader(file))
        for kind, column, text in changes:
            next(r for r in rows if r["type"] == kind)[column] = text
        with (folder / "table2.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        return folder

    return make


def verdicts(folder):
    ledger = audit([read_paper(folder)])
    return dict(zip(ledger.claims["id"], ledger.claims["verdict"], strict=True))


# --- verdicts


def test_all_37_claims_have_a_verdict_with_a_reason(papers, tmp_path):
    corpora = evidence_for("naert2017", {"a": False, "b": True}, [], tmp_path)
    found = audit(papers, corpora).claims
    assert len(found) == 37 * 3
    assert (found["note"] != "").all()
    published = found[found["evidence"] == PRINT]
    assert dict(zip(published["id"], published["verdict"], strict=True)) == ON_PRINT
    assert set(found[found["evidence"] != PRINT]["verdict"]) == {"not testable"}


def test_the_golden_facts_are_in_the_ledger(papers):
    ledger = audit(papers)
    notes = ledger.claims.set_index("id")["note"]
    assert "adds up to 89" in notes["N01"]
    assert "5 unbroken chains" in notes["N01"]
    assert "0.3030337" in notes["N02"]
    assert "0.0984586" in notes["N02"]
    assert "F(12, 76) = 0.752, p = 0.696, eta squared 0.106" in notes["N12"]
    assert "by the sums the value left out is 0.79, by the squares 0.79" in notes["N08"]
    assert "0.51538" in notes["N14"]
    assert "0.79" in notes["N18"]
    rows = ledger.checks.query("id == 'N07' and check == 'grimmer'").set_index("item")
    assert rows["verdict"].drop("2010").eq("consistent").all()
    assert rows["why"].drop("2010").str.endswith("divisor n-1").all()
    assert rows.loc["2010", "verdict"] == "undecidable"
    assert "table2.csv, line 15" in rows.loc["2010", "why"]


def cells(root):
    with (root / "papers/naert2017/table2.csv").open() as file:
        for row in csv.DictReader(file):
            if row["n"] != "0":
                for column in list(row)[1:]:
                    if row[column] and (row["type"], column) != ("2010", "sd"):
                        yield row["type"], column, row[column]


def totals_print(folder):
    """Whether the rows still give the printed mean and SD, by plain floating point."""
    rows = pd.read_csv(folder / "table2.csv", dtype={"type": str}, na_values="/").query("n > 0")
    n, mean, sd = (rows[c].to_numpy(dtype=float) for c in ("n", "mean", "sd"))
    whole = n @ mean / n.sum()
    spread = np.sqrt(((n - 1) @ sd**2 + n @ (mean - whole) ** 2) / (n.sum() - 1))
    return (f"{whole:.3f}", f"{spread:.3f}") == ("0.303", "0.098")


def test_any_last_digit_changed_turns_the_right_claims_and_no_other(root, naert, tmp_path):
    before = verdicts(root / "papers/naert2017")
    changed = 0
    for kind, column, text in cells(root):
        other = text[:-1] + ("8" if text[-1] == "9" else str(int(text[-1]) + 1))
        after = verdicts(naert([(kind, column, other)]))
        turned = {c for c, v in after.items() if v == "inconsistent" and before[c] != v}
        # Two values of 0.30 have the SD 0: a row that can be.
        expected = set() if (kind, column) == ("2010", "n") else {"N07"}
        expected |= {"N01"} if column == "n" else set()
        expected |= {"N08"} if kind == "1000" else set()
        expected |= set() if totals_print(tmp_path / "naert2017") else {"N02"}
        assert turned == expected, (kind, column, other)
        naert([(kind, column, text)])
        changed += 1
    assert changed == 13 * 3 - 1 + 3


@pytest.mark.parametrize(
    "change, expected",
    [
        (("1110", "mean", "0.35813"), {"N02", "N09", "N10", "N11"}),  # the highest, not the lowest
        (("1010", "mean", "0.23444"), {"N02", "N09", "N10"}),  # the lowest; 2H to 2H stays low
        (("0000", "mean", "0.36833"), {"N02", "N09", "N10", "N11"}),
    ],
)
def test_first_digits_turn_what_rests_on_them(root, naert, change, expected):
    before = verdicts(root / "papers/naert2017")
    after = verdicts(naert([change]))
    turned = {c for c, v in after.items() if v == "inconsistent" and before[c] != v}
    assert turned - {"N07", "N03", "N04"} == expected - {"N03", "N04"}


@pytest.mark.parametrize(
    "check, verdict",
    [
        ({"check": "groups_differ", "differ": False, "test": "t", "rows": ["a", "b"]},
         "consistent"),
        ({"check": "groups_differ", "differ": True, "test": "t", "rows": ["a", "c"]}, "consistent"),
        ({"check": "groups_differ", "differ": False, "test": "welch"}, "inconsistent"),
        ({"check": "groups_differ", "differ": True}, "consistent"),
        ({"check": "p_value", "kind": "t", "statistic": "2.31", "df": [18], "p": "0.03"},
         "consistent"),
        ({"check": "p_value", "kind": "t", "statistic": "2.31", "df": [18], "p": "<0.01"},
         "inconsistent"),
        ({"check": "p_reachable", "groups": [3, 3], "p": "<0.01"}, "inconsistent"),
        ({"check": "total", "column": "n", "equals": "36"}, "consistent"),
        ({"check": "total", "column": "n", "equals": "35"}, "inconsistent"),
        ({"check": "grimmer", "grain": "1"}, "inconsistent"),
        ({"check": "grimmer", "grain": "0.1"}, "consistent"),
        ({"check": "relation", "holds": "m > 4.02"}, "not testable"),
    ],
)  # fmt: skip
def test_claims_about_another_papers_table_need_no_code(tmp_path, check, verdict):
    folder = tmp_path / "mine"
    folder.mkdir()
    # 12 values each: sums 49.2, 48.0, 84.0; SDs of samples in tenths.
    rows = [("a", "12", "4.10", "0.90"), ("b", "12", "4.00", "1.00"), ("c", "12", "7.00", "0.80")]
    text = "\n".join(["group,n,mean,sd", *(",".join(row) for row in rows)])
    (folder / "t.csv").write_text(text + "\n")
    if check["check"] in ("groups_differ", "total", "grimmer"):
        check = {"table": "t.csv", **check}
    claim = {"id": "C1", "location": "p. 1", "claim": "So.", "needs": "nothing",
             "printed": {"m": "4.0"}, "corpora": {"missing": "print only"},
             "published": {"checks": [{"reads": "So.", **check}]}}  # fmt: skip
    content = {"paper": "Me 2026", "study": "mine", "claims": [claim]}
    (folder / "claims.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
    found = audit([read_paper(folder)]).claims.iloc[0]
    assert found["verdict"] == verdict, found["note"]


def test_the_checks_are_documented(root):
    text = (root / "docs/claims.md").read_text(encoding="utf-8")
    assert document() in text, "run: python -m signkin.audit, and put it into docs/claims.md"


# --- corpora


def write(folder, name, frame):
    folder.mkdir(parents=True, exist_ok=True)
    pd.DataFrame(frame).to_csv(folder / f"{name}.csv", index=False)
    return folder / f"{name}.csv"


@pytest.fixture
def study(tmp_path):
    """Return a maker of verdicts: claims of a made-up paper on tables of made-up corpora."""

    def make(check, **tables):
        paper = tmp_path / "papers/mine"
        paper.mkdir(parents=True, exist_ok=True)
        claim = {"id": "C1", "location": "p. 1", "claim": "It is so.", "needs": "a table",
                 "printed": {"mean": "2.0"}, "published": {"missing": "nothing is printed"},
                 "corpora": {"checks": [{"reads": "So.", **check}]}}  # fmt: skip
        content = {"paper": "Me 2026", "study": "mine", "claims": [claim]}
        (paper / "claims.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
        results = tmp_path / "results"
        files = [write(results / "mine/here", name, frame) for name, frame in tables.items()]
        found = audit(
            [read_paper(paper)],
            evidence_for("mine", {"here": False, "nowhere": False}, files, results),
        ).claims.set_index("evidence")
        return found.loc["here"], found.loc["nowhere"]

    return make


NUMBERS = {"x": np.linspace(1, 3, 41), "kind": ["0010"] * 20 + ["1110"] * 21,
           "gap": [np.nan] * 41}  # fmt: skip


@pytest.mark.parametrize(
    "check, verdict",
    [
        ({"check": "measure", "value": "x", "contains": "mean"}, "holds"),
        ({"check": "measure", "value": "x + 1", "contains": "mean"}, "fails"),
        ({"check": "measure", "value": "x", "take": "min", "at_least": "1"}, "holds"),
        ({"check": "measure", "value": "x", "take": "max", "below": 3}, "fails"),
        ({"check": "measure", "value": "x > 2", "take": "number", "equals": "20"}, "holds"),
        ({"check": "measure", "value": "kind", "take": "distinct", "equals": "2"}, "holds"),
        # 23 of 41 are no majority yet.
        ({"check": "measure", "value": "x > 1.9", "take": "share", "above": 0.5}, "undecided"),
        ({"check": "measure", "value": "x > 1.4", "take": "share", "above": 0.5}, "holds"),
        ({"check": "measure", "value": "x > 2.7", "take": "share", "above": 0.5}, "fails"),
        ({"check": "every", "holds": "x >= 1 and not x > 3"}, "holds"),
        ({"check": "every", "holds": "x < 2", "where": "kind == '0010'"}, "holds"),
        ({"check": "every", "holds": "x < 2"}, "fails"),
        ({"check": "every", "holds": "x < 2", "share": 0.4}, "holds"),
        ({"check": "every", "by": ["kind"], "take": {"m": "mean x"}, "holds": "m > 2"}, "fails"),
        ({"check": "every", "holds": "x < 2", "show": "gap"}, "not testable"),
        ({"check": "order", "key": "kind", "take": {"m": "mean x"}, "highest": ["1110"]}, "holds"),
        ({"check": "order", "key": "kind", "take": {"m": "mean x"}, "lowest": ["1110"]}, "fails"),
        ({"check": "order", "key": "kind", "take": {"m": "mean x"}, "lowest": ["9"]},
         "not testable"),
        ({"check": "groups_differ", "value": "x", "by": "kind", "differ": True}, "holds"),
        ({"check": "groups_differ", "value": "x", "by": "kind", "differ": False,
          "test": "kruskal"}, "fails"),
        ({"check": "correlation", "x": "x", "y": "x * x"}, "holds"),
        ({"check": "correlation", "x": "x", "y": "-x", "method": "spearman"}, "fails"),
        ({"check": "measure", "value": "y", "above": 0}, "not testable"),
        ({"check": "every", "holds": "x < 2", "where": "kind == 'none'"}, "not testable"),
    ],
)  # fmt: skip
def test_claims_about_a_users_own_table_need_no_code(study, check, verdict):
    here, nowhere = study({"table": "numbers", **check}, numbers=NUMBERS)
    assert here["verdict"] == verdict, here["note"]
    assert here["source"] == ("results/mine/here/numbers.csv" if verdict != "not testable" else "")
    assert nowhere["verdict"] == "not testable"
    assert "no table numbers.csv" in nowhere["note"]
    assert "papers/mine/claims.yaml, line" in nowhere["note"]  # misspelt, perhaps


CHANCE = {
    "order": [0, 1, 2, 3],
    "rate": [0.5, 0.6, 0.3, 0.9],
    "low": [0.1, 0.2, 0.2, np.nan],
    "high": [0.4, 0.5, 0.3, np.nan],  # order 2 lies on the line, order 3 has none
}


@pytest.mark.parametrize(
    "extra, verdict, words",
    [
        ({}, "undecided", "above chance in 2 of 4 (order), not in 2; no chance interval for 3"),
        ({"where": "order < 2"}, "holds", "0: 0.50 (0.10 to 0.40), 1: 0.60"),
        ({"where": "order in [0, 3]"}, "not testable", "no chance interval for order 3"),
        ({"all_of": False, "more_than": 0.4}, "holds", "2 of 4"),
        ({"all_of": False, "more_than": 0.5}, "not testable", "no chance interval"),  # 3 decides
        ({"all_of": False, "more_than": 0.75}, "undecided", "2 of 4"),  # whatever 3 is
        ({"by": ["sign"]}, "not testable", "lacks the columns sign"),
    ],
)
def test_hit_rates_are_set_against_chance_order_by_order(study, extra, verdict, words):
    check = {"check": "beyond_chance", "table": "t", "value": "rate", "low": "low", "high": "high",
             "by": ["order"], **extra}  # fmt: skip
    here, _ = study(check, t=CHANCE)
    assert here["verdict"] == verdict
    assert words in here["note"]


def test_what_stands_beside_a_claim_has_no_say(tmp_path):
    paper = tmp_path / "papers/mine"
    paper.mkdir(parents=True)
    good = {"check": "every", "table": "t", "holds": "x > 0", "reads": "So."}
    beside = {"check": "every", "table": "other/t", "holds": "x < 0", "reads": "Too.",
              "beside": True}  # fmt: skip
    claim = {"location": "p. 1", "claim": "It is so.", "needs": "a table",
             "published": {"missing": "nothing is printed"}}  # fmt: skip
    claims = [
        {"id": "C1", **claim, "corpora": {"checks": [good, beside]}},
        {"id": "C2", **claim, "corpora": {"checks": [beside], "missing": "our own rule"}},
    ]
    content = {"paper": "Me 2026", "study": "mine", "claims": claims}
    (paper / "claims.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
    results = tmp_path / "results"
    files = [write(results / s / "here", "t", {"x": [1.0]}) for s in ("mine", "other")]
    ledger = audit([read_paper(paper)], evidence_for("mine", {"here": False}, files, results))
    found = ledger.claims[ledger.claims["evidence"] == "here"].set_index("id")
    assert found["verdict"].to_dict() == {"C1": "holds", "C2": "not testable"}
    assert found.loc["C2", "note"] == "our own rule"
    assert found.loc["C1", "recomputed"] == "1 of 1 rows"
    checks = ledger.checks.query("evidence == 'here'")
    assert checks["counts"].tolist() == ["yes", "beside the claim", "beside the claim"]
    assert checks["verdict"].tolist() == ["holds", "fails", "fails"]
    assert checks["source"].iloc[-1] == "results/other/here/t.csv"


def test_our_own_rule_confirms_no_claim(root, tmp_path):
    corpus = tmp_path / "endres2013/made"
    truth = {"recording": ["r"], "beta": [-0.3], "r_squared": [0.99], "duration_s": [0.5]}
    file = write(corpus, "ground_truth", truth)
    evidence = evidence_for("endres2013", {"made": False}, [file], tmp_path)
    found = audit([read_paper(root / "papers/endres2013")], evidence).claims
    row = found[(found["id"] == "E06") & (found["evidence"] == "made")].iloc[0]
    assert row["verdict"] == "by construction"
    assert "0.97 are not taken" in row["note"]


def test_the_bootstrap_interval_is_that_of_the_mean(study):
    x = np.random.default_rng(1).normal(5, 2, 400)
    here, _ = study({"check": "measure", "table": "t", "value": "x", "above": 0}, t={"x": x})
    low, high = map(float, here["interval"].split(" to "))
    half = 1.96 * x.std(ddof=1) / 20
    assert (low, high) == pytest.approx((x.mean() - half, x.mean() + half), abs=0.06)


# --- the command


def test_a_ledger_runs_alone(root, tmp_path):
    out = tmp_path / "claims.csv"
    done = subprocess.run(
        [sys.executable, "-m", "signkin", "audit", root / "papers/naert2017", "--out", out],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 1, done.stderr  # N18 is a contradiction
    assert (tmp_path / "audit-naert2017/index.html").is_file()
    assert "N18   inconsistent" in done.stdout
    assert "15 consistent" in done.stdout
    frame = read_table(out, "claims")
    assert len(frame) == 23
    assert frame.loc[frame["id"] == "N07", "verdict"].item() == "consistent"


# --- bad input


def spoiled(text, old, new):
    assert old in text
    return text.replace(old, new, 1)


BAD = {
    "a comma": (
        "table2.csv", "0.26833", "\"0,26833\"",
        r"table2.csv, line 2: '0,26833' is no number; expected digits with a decimal point. "
        r"Write a decimal point.",
    ),
    "a bare comma": (
        "table2.csv", "0.26833", "0,26833",
        r"table2.csv, line 2: the row has more or fewer cells than the header",
    ),
    "n of 0": (
        "table2.csv", "0000,6", "0000,0", r"table2.csv, line 2: n is 0 beside the mean 0.26833",
    ),
    "n of 2.5": (
        "table2.csv", "0000,6", "0000,2.5", r"table2.csv, line 2: n is '2.5'; expected a whole",
    ),
    "an SD of a single value": (
        "table2.csv", "0.30000,0,", "0.30000,0.1,",
        r"table2.csv, line 15: the SD 0.1 of a single value; expected 0, or an empty cell",
    ),
    "an unknown check": (
        "claims.yaml", "check: total", "check: totl",
        r"claims.yaml, line 12: claim N01 names an unknown check 'totl'; expected ",
    ),
    "an unknown table": (
        "claims.yaml", "table: table2.csv, column", "table: table3.csv, column",
        r"claims.yaml, line 12: there is no table table3.csv; expected constants.csv, table2.csv",
    ),
    "an unknown argument": (
        "claims.yaml", "column: n, equals", "columns: n, equals",
        r"claims.yaml, line 12: the check total of claim N01 has no argument columns",
    ),
    "an unknown name": (
        "claims.yaml", "equals: transitions", "equals: signs",
        r"claims.yaml, line 12: n is 'signs'; expected a whole number",
    ),
    "a printed number that is none": (
        "claims.yaml", 'transitions: "89"', "transitions: 89",
        r"claims.yaml, line 9: 89 is not of type 'string'; expected the printed digits in quotes",
    ),
    "a doubled claim": (
        "claims.yaml", "id: N02", "id: N01",
        r"claims.yaml, line 2\d: the claim N01 stands in line 6 already",
    ),
    "an unknown name in a formula": (
        "claims.yaml", "value: frames / rate", "value: frame / rate",
        r"claims.yaml, line \d+: the name 'frame' in 'frame / rate' is unknown",
    ),
    "code in a formula": (
        "claims.yaml", "value: frames / rate", "value: open('x')",
        r"claims.yaml, line \d+: the expression \"open\('x'\)\" has",
    ),
    "no YAML": ("claims.yaml", "claims:", "claims: [", r"claims.yaml, line \d+: "),
    "no reading": (
        "claims.yaml", "reads: \"The column", "read: \"The column",
        r"claims.yaml, line 12: 'reads' is a required property",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_sentence_with_file_and_line(root, tmp_path, capsys, case):
    name, old, new, expected = BAD[case]
    folder = tmp_path / "naert2017"
    shutil.copytree(root / "papers/naert2017", folder)
    text = (folder / name).read_text()
    (folder / name).write_text(spoiled(text, old, new))
    assert main(["audit", str(folder), "--to", str(tmp_path / "page")]) == 1
    sentences = capsys.readouterr().err.splitlines()
    assert all(line.startswith("signkin: ") for line in sentences)
    assert any(re.search(expected, line) for line in sentences), sentences
    if case not in WHOLE:  # the other claims go on
        ledger = audit([read_paper(folder)])
        assert len(sentences) == len(ledger.faults)
        assert (ledger.claims["verdict"] == "consistent").sum() >= 3


# Without the table, or the file's grammar, there is nothing to go on with.
WHOLE = ("no YAML",)


def test_an_n_below_0_is_bad(naert):
    faults = audit([read_paper(naert([("0000", "n", "-1")]))]).faults
    assert any("table2.csv, line 2: n is '-1'; expected a whole" in fault for fault in faults)


def test_a_missing_paper_is_told(tmp_path, capsys):
    assert main(["audit", str(tmp_path / "nobody")]) == 1
    assert "there is no folder" in capsys.readouterr().err
    (tmp_path / "empty").mkdir()
    with pytest.raises(SignkinError, match=r"there is no claims\.yaml"):
        read_paper(tmp_path / "empty")


# --- specification curves


def test_the_choice_that_decides_is_found():
    rows = [
        {"cut": cut, "depth": depth, "hand": "right" if cut else "", "r": cut + depth / 10,
         "holds": "yes" if cut > 5 else "no"}
        for cut in (2.0, 6.0, 8.0) for depth in (1, 2)
    ]  # fmt: skip
    specs = specifications(pd.DataFrame(rows), {"cut": "cut-off", "depth": "depth"}, "r")
    assert specs["estimate"].is_monotonic_increasing
    found = by_choice(specs, "p", "C1", "c", ["cut-off", "depth"])
    whole = found.iloc[0]
    assert (whole["specifications"], whole["holding"]) == (6, 4)
    assert "what decides most is cut-off (100%" in whole["note"]
    decided = found.drop_duplicates("choice").set_index("choice")["share_decided"]
    assert decided["cut-off"] == pytest.approx(1)
    assert decided["depth"] == pytest.approx(0)
    levels = found[found["choice"] == "cut-off"].set_index("level")["share"]
    assert levels.to_dict() == {"2": 0, "6": 1, "8": 1}


def test_a_claim_that_always_holds_hangs_on_nothing():
    frame = pd.DataFrame({"cut": [1, 2], "r": [0.1, 0.2], "holds": [True, True]})
    specs = specifications(frame, {"cut": "cut"}, "r")
    assert "holds in all" in by_choice(specs, "p", "C1", "c", ["cut"])["note"].iloc[0]
    with pytest.raises(SignkinError, match="the table lacks depth"):
        specifications(frame, {"depth": "depth"}, "r")
