"""`python -m tools.readme [RESULTS]`: what is reproduced and what is not, into README.md.

Fills the marked place from the ledger of a finished run over all corpora, so that README, report
and audit tell the same.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pandas as pd

from signkin.audit.ledger import PRINT
from signkin.exhibits import exhibits
from signkin.pages.front import outcomes
from signkin.tables import read_table
from tools.marked import fill

ROOT = Path(__file__).resolve().parents[1]
PLACE = "reproduced"
PAPERS = {"naert2017": "Naert et al. 2017", "endres2013": "Endres et al. 2013"}
DECIDED = ("holds", "fails", "mixed")
REST = {
    "open": "Open, since the data allow both or a choice that is not printed decides",
    "not testable here": "Not testable on these recordings",
}
WORDS = {"holds": "holds", "fails": "fails", "undecided": "undecided", "depends": "depends"}


def reproduced(claims: pd.DataFrame, root: Path = ROOT) -> str:
    """Return the text of the place: counts, a row a claim that is decided, and the others' names.

    claims: the ledger of a run (`claims`), in which papers audited on print alone ask nothing of
    corpora and are left out.
    """
    found = outcomes(claims)
    kinds = claims[claims["evidence_kind"].isin(["real", "simulated"])]
    corpora = kinds.drop_duplicates("evidence")["evidence_kind"].value_counts()
    head = (
        f"From the ledger of a run over {corpora.get('real', 0)} corpora of real recordings and "
        f"{corpora.get('simulated', 0)} made by a program. {_made(root)}"
    )
    lines = [head, "", "| claim | the paper | can the print be right? | real recordings |",
             "|---|---|---|---|"]  # fmt: skip
    for outcome in DECIDED:
        for row in found[found["outcome"] == outcome].itertuples():
            text = row.claim.rstrip(".").replace("|", "\\|")
            lines.append(f"| {row.id} | {text} | {_print(row.print)} | {_told(row)} |")
    lines.append("")
    for outcome, words in REST.items():
        ids = found.loc[found["outcome"] == outcome, "id"]
        if len(ids):
            lines.append(f"{words} ({len(ids)}): {', '.join(ids)}.")
    return "\n".join(lines)


def _made(root: Path) -> str:
    parts = []
    for paper, name in PAPERS.items():
        made = exhibits(root / "papers" / paper)
        counts = pd.Series([e.kind for e in made]).value_counts()
        kinds = " and ".join(f"{n} {kind}s" for kind, n in counts.items())
        parts.append(f"{kinds} of {name}")
    return f"Every figure and table is made again: {'; '.join(parts)}."


def _print(verdict: str) -> str:
    return {"consistent": "yes", "inconsistent": "**no**"}.get(verdict, "not testable")


def _told(row: object) -> str:
    """Return `fails on boston104, dgs-1984189`, outcome by outcome."""
    by: dict[str, list[str]] = {}
    for part in str(row.told).split("; "):  # type: ignore[attr-defined]
        corpus, _, verdict = part.rpartition(": ")
        by.setdefault(verdict, []).append(corpus)
    return "; ".join(f"{WORDS[verdict]} on {', '.join(there)}" for verdict, there in by.items())


def main(results: str = "results") -> None:
    """Fill the place in README.md."""
    claims = read_table(Path(results) / "audit" / "claims.csv", "claims")
    if not (claims["evidence"] == PRINT).any():
        sys.exit("readme: the ledger has no verdict on print")
    print("written" if fill(ROOT / "README.md", {PLACE: reproduced(claims)}) else "unchanged")


if __name__ == "__main__":
    main(*sys.argv[1:])
