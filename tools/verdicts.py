"""The verdicts of two runs side by side, with the reason for each change: docs/verdicts.md.

python -m tools.verdicts OLD/audit/claims.csv NEW/audit/claims.csv

Both are ledgers of runs on the same corpora. Papers that only one of them has are left out.
"""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterable
from pathlib import Path

import pandas as pd

from tools.numbers import table

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "verdicts.md"
PRINT = "published numbers"
SHORT = {
    "not testable": "–", "by construction": "constr.", "consistent": "consistent",
    "inconsistent": "inconsistent",
}  # fmt: skip
LENGTH = 330
HEAD = """# Verdicts: before and now

Made by `python -m tools.verdicts OLD NEW` from the ledgers (`audit/claims.csv`) of two runs on the
same corpora: before verdicts had levels, and now. What the levels mean: [claims.md](claims.md);
what rules of ours add to the print, and how far that moves a claim:
[interpretations.md](interpretations.md).

A cell is `before → now`, or one verdict where it stayed; – is not testable, constr. by
construction.
Corpora that can test no claim of a paper are left out of its table.
"""


def ledger(path: Path) -> pd.DataFrame:
    """Return a ledger by paper, claim and evidence."""
    frame = pd.read_csv(path, dtype=str, keep_default_na=False)
    return frame.set_index(["paper", "id", "evidence"])


def cell(before: str, now: str) -> str:
    """Return `before → now`; one of them where both are the same, or there was none."""
    a, b = (SHORT.get(verdict, verdict) for verdict in (before, now))
    return b if a == b or not before else f"{a} → **{b}**"


def matrix(old: pd.DataFrame, new: pd.DataFrame, paper: str) -> str:
    """Return the table of a paper's claims over evidence."""
    here = new.loc[paper]
    told = here["verdict"].unstack("evidence")
    before = old.loc[paper]["verdict"].unstack("evidence").reindex_like(told).fillna("")
    seen = [
        name for name in dict.fromkeys(here.index.get_level_values("evidence"))
        if name == PRINT or not {*told[name], *before[name]} <= {"not testable", ""}
    ]  # fmt: skip
    rows = (
        (claim, *(cell(before.loc[claim, name], told.loc[claim, name]) for name in seen))
        for claim in told.index
    )
    return table(("claim", *(name if name != PRINT else "print" for name in seen)), rows)


def shortened(note: str) -> str:
    """Return a note as it fits into a cell."""
    text = " ".join(note.split()).replace("|", "/")
    return textwrap.shorten(text, LENGTH, placeholder=" ...")


def changes(old: pd.DataFrame, new: pd.DataFrame) -> str:
    """Return the table of verdicts that changed, or are new, and why they are as they are."""
    rows = []
    for key, row in new.iterrows():
        before = old["verdict"].get(key, "")
        if before != row["verdict"] and not (not before and row["verdict"] == "not testable"):
            _, claim, evidence = key
            why = shortened(row["note"])
            rows.append((claim, evidence, before or "no such claim", row["verdict"], why))
    return table(("claim", "evidence", "before", "now", "why"), rows)


def printed(new: pd.DataFrame) -> str:
    """Return the table of what claims are without the rules that we add to the print."""
    told = new[new["as_printed"] != ""]
    rows = (
        (claim, evidence, row["verdict"], row["as_printed"])
        for (_, claim, evidence), row in told.iterrows()
    )
    return table(("claim", "corpus", "verdict", "without each rule of ours"), rows)


def page(old: pd.DataFrame, new: pd.DataFrame) -> str:
    """Return the whole page."""
    papers = set(old.index.get_level_values("paper"))
    new = new[new.index.get_level_values("paper").isin(papers)]
    parts: Iterable[str] = (
        HEAD,
        *(
            f"## {paper}\n\n{matrix(old, new, paper)}\n"
            for paper in dict.fromkeys(new.index.get_level_values("paper"))
        ),
        "## What changed, and why\n\nThe note of the new ledger, shortened.\n\n"
        f"{changes(old, new)}\n",
        f"## With and without what we add to the print\n\n{printed(new)}\n",
    )
    return "\n".join(parts)


if __name__ == "__main__":
    if len(sys.argv) != 3 or not all(Path(file).is_file() for file in sys.argv[1:]):
        sys.exit("python -m tools.verdicts OLD NEW: two files audit/claims.csv")
    text = page(*(ledger(Path(file)) for file in sys.argv[1:]))
    PAGE.write_text(text, encoding="utf-8")
    print(PAGE.relative_to(ROOT))
