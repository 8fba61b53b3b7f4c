"""README's table of what is reproduced is the ledger's, and names every claim once."""

import re

import pandas as pd
import pytest
import yaml

from signkin import tables
from tools import marked
from tools.readme import PAPERS, PLACE, reproduced


def ledger(rows):
    frame = pd.DataFrame(
        [
            {"paper": "naert2017", "id": name, "claim": f"Claim | {name}.", "evidence": evidence,
             "evidence_kind": kind, "verdict": verdict}
            for name, evidence, kind, verdict in rows
        ]
    )  # fmt: skip
    return frame.reindex(columns=tables.TABLES["claims"].names())


def test_claims_are_told_by_outcome_with_the_corpora_they_rest_on(root):
    print_, real, made = "published numbers", "real", "simulated"
    told = reproduced(
        ledger([
            ("N1", print_, print_, "consistent"), ("N1", "a", real, "holds"),
            ("N1", "b", real, "holds"), ("N2", print_, print_, "inconsistent"),
            ("N2", "a", real, "holds"), ("N2", "b", real, "fails"),
            ("N3", print_, print_, "not testable"), ("N3", "s", made, "holds"),
            ("N4", print_, print_, "consistent"), ("N4", "a", real, "depends"),
        ]),
        root,
    )  # fmt: skip
    assert "2 corpora of real recordings and 1 made by a program" in told
    assert "| N1 | Claim \\| N1 | yes | holds on a, b |" in told
    assert "| N2 | Claim \\| N2 | **no** | holds on a; fails on b |" in told
    assert "(1): N4." in told and "(1): N3." in told
    assert "13 figures and 2 tables of Naert et al. 2017" in told


@pytest.mark.parametrize("paper", PAPERS)
def test_readme_names_every_claim_of_both_papers_once(root, paper):
    place = marked.content((root / "README.md").read_text(encoding="utf-8"), PLACE)
    ids = [
        claim["id"]
        for claim in yaml.safe_load((root / "papers" / paper / "claims.yaml").read_text())["claims"]
    ]
    assert ids
    for name in ids:
        named = re.findall(rf"(?:\| |[:,] ){name}(?: \||[,.])", place)
        assert len(named) == 1, name
