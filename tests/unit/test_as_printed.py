"""Claims with and without the rules that we add to the print, and tests at the printed n."""

import numpy as np
import pandas as pd
import pytest
import yaml
from scipy import stats

from signkin import SignkinError
from signkin.audit.at_n import _kruskal
from signkin.audit.ledger import audit, evidence_for
from signkin.audit.paper import read_paper

ABOVE = {"check": "every", "table": "t", "holds": "x > 0", "reads": "So."}
READING = {"name": "plain", "adds": "key: 0.1", "printed": "no share", "claims": ["C1"],
           "tables": {"t": "plain"}, "where": "reading == 'plain'"}  # fmt: skip


@pytest.fixture
def told(tmp_path):
    """Return a maker of a claim's row on one made-up corpus."""

    def make(checks, tables, readings=(), **claim):
        paper = tmp_path / "papers/mine"
        paper.mkdir(parents=True, exist_ok=True)
        full = {"id": "C1", "location": "p. 1", "claim": "It is so.", "needs": "a table",
                "published": {"missing": "nothing is printed"}, "corpora": {"checks": checks},
                **claim}  # fmt: skip
        content = {"paper": "Me 2026", "study": "mine", "claims": [full]}
        content |= {"readings": list(readings)} if readings else {}
        (paper / "claims.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
        here = tmp_path / "results/mine/here"
        here.mkdir(parents=True, exist_ok=True)
        for name, table in tables.items():
            pd.DataFrame(table).to_csv(here / f"{name}.csv", index=False)
        corpora = evidence_for("mine", {"here": True}, here.glob("*.csv"), tmp_path / "results")
        ledger = audit([read_paper(paper)], corpora)
        assert not ledger.faults
        return ledger.claims.set_index("evidence").loc["here"]

    return make


def plain(value, ours=1.0):
    return {"reading": ["plain", "ours"], "x": [value, ours]}


@pytest.mark.parametrize(
    "x, table, extra, verdict, printed",
    [
        (1.0, plain(1.0), {}, "holds", "plain: holds"),
        (1.0, plain(-1.0), {}, "depends", "plain: fails"),
        (-1.0, plain(1.0), {}, "depends", "plain: holds"),
        # Fewer recordings alone make the difference: the rule itself does not.
        (1.0, plain(-1.0, -1.0), {"ours": "reading == 'ours'"}, "holds", "plain: fails"),
        (1.0, {"reading": ["other"], "x": [1.0]}, {}, "holds", "plain: not testable"),
        (1.0, {"x": [1.0]}, {}, "holds", "plain: not testable"),
    ],
)
def test_a_claim_is_told_with_and_without_a_rule_of_ours(told, x, table, extra, verdict, printed):
    row = told([ABOVE], {"t": {"x": [x]}, "plain": table}, [READING | extra])
    assert (row["verdict"], row["as_printed"]) == (verdict, printed)
    if verdict == "depends":
        assert "with our rule (key: 0.1)" in row["note"]
        assert "as printed (no share)" in row["note"]
    else:
        assert f"as printed, {printed}" in row["note"]


def test_a_rule_that_makes_a_claim_true_is_no_evidence(told):
    """By construction under our rule; without it the check beside the claim counts."""
    made = {"by_construction": {"corpora": ["all"], "why": "draws below are not taken"}}
    checks, reading = [{**ABOVE, "beside": True}], {**READING, "checks": [1]}
    tables = {"t": {"x": [1.0]}}
    assert told(checks, tables, **made)["verdict"] == "by construction"
    row = told(checks, {**tables, "plain": plain(-1.0)}, [reading], **made)
    assert row["verdict"] == "depends"
    assert "by construction, as printed (no share) fails" in row["note"]
    assert told(checks, {**tables, "plain": plain(1.0)}, [reading], **made)["verdict"] == \
        "by construction"  # fmt: skip


def test_a_corpus_that_cannot_test_the_claim_has_no_reading_of_it(told):
    row = told([ABOVE], {"t": {"y": [1.0]}, "plain": plain(1.0)}, [READING])
    assert (row["verdict"], row["as_printed"]) == ("not testable", "")


@pytest.mark.parametrize("change", [{"claims": ["C2"]}, {"checks": [2]}])
def test_a_reading_of_what_is_not_there_is_told(told, change):
    with pytest.raises(SignkinError, match="which is not there"):
        told([ABOVE], {"t": {"x": [1.0]}}, [READING | change])


# --- the printed n


def ratios(n, gain):
    """Return hits and false positives of n recordings at orders 2 to 4; gain: of order 3."""
    rng = np.random.default_rng(3)
    rows = [
        {"recording": f"r{i}", "order": order, "false": 1,
         "hits": rng.gamma(4) + gain * (order == 3)}
        for i in range(n) for order in (2, 3, 4)
    ]  # fmt: skip
    return pd.DataFrame(rows)


KRUSKAL = {"check": "kruskal_at_n", "table": "t", "key": "order", "unit": ["recording"],
           "over": ["hits"], "under": ["false"], "n": "n", "p": "p", "against_rest": "3",
           "reads": "So."}  # fmt: skip


@pytest.mark.parametrize(
    "n, gain, verdict", [(400, 0.0, "fails"), (400, 12.0, "holds"), (400, 0.9, "fails")]
)
def test_a_printed_p_is_compared_at_its_own_n(told, n, gain, verdict):
    """With 400 recordings a gain of 0.9 has p < 1e-7, with the printed 20 it cannot have."""
    row = told([KRUSKAL], {"t": ratios(n, gain)}, printed={"n": "20", "p": "<1e-7"})
    assert row["verdict"] == verdict
    assert "at the printed n = 20" in row["note"]
    if gain == 0.9:
        assert float(row["note"].rsplit("another n, ", 1)[1].rstrip(")")) < 1e-7


@pytest.mark.parametrize(
    "change, words",
    [(lambda t: t.head(9), "fewer than half of the printed 20"),
     (lambda t: t.assign(hits=0, false=0), "without any ratio to rank"),
     (lambda t: t[t["order"] == 2], "no groups to compare")],
)  # fmt: skip
def test_what_cannot_be_ranked_is_no_number(told, change, words):
    row = told([KRUSKAL], {"t": change(ratios(30, 0.0))}, printed={"n": "20", "p": "<1e-7"})
    assert row["verdict"] == "not testable"
    assert words in row["note"]


@pytest.mark.parametrize("at_n, verdict", [("", "fails"), ("n", "holds")])
def test_no_effect_is_not_refuted_by_a_larger_corpus(told, at_n, verdict):
    rng = np.random.default_rng(5)
    kinds = np.repeat(["a", "b"], 2000)
    table = {"kind": kinds, "x": rng.normal(size=4000) + 0.15 * (kinds == "b")}
    check = {"check": "groups_differ", "table": "t", "value": "x", "by": "kind", "differ": False,
             "reads": "So."}  # fmt: skip
    row = told([check | ({"at_n": at_n} if at_n else {})], {"t": table}, printed={"n": "89"})
    assert row["verdict"] == verdict
    if at_n:
        assert "At the printed n = 89 it is significant in" in row["note"]


def test_a_small_corpus_tells_what_it_would_have_missed(told):
    table = {"kind": ["a", "a", "b", "b"], "x": [1.0, 2.0, 1.5, 2.5]}
    check = {"check": "groups_differ", "table": "t", "value": "x", "by": "kind", "differ": False,
             "at_n": "n", "reads": "So."}  # fmt: skip
    note = told([check], {"t": table}, printed={"n": "89"})["note"]
    assert "with 80 % power it finds effects from f = " in note
    assert "the print had 89" in note


@pytest.mark.parametrize("one", [None, 1])
def test_p_of_groups_is_scipys_with_ties_gaps_and_infinite_values(one):
    rng = np.random.default_rng(8)
    for _ in range(20):
        values = rng.integers(0, 6, (rng.integers(4, 30), 3)).astype(float)
        values[rng.random(values.shape) < 0.15] = np.nan
        values[0] = 1.0, 2.0, np.inf
        groups = [column[~np.isnan(column)] for column in values.T]
        if one is not None:
            groups = [groups[one], np.concatenate([groups[0], groups[2]])]
        pooled = stats.rankdata(np.concatenate(groups))
        expected = stats.kruskal(*np.split(pooled, np.cumsum([len(g) for g in groups])[:-1])).pvalue
        assert _kruskal(values, one) == pytest.approx(expected, rel=1e-12)
