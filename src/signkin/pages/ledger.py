"""The ledger of claims over papers and the corpora of a run."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import pandas as pd

from signkin.audit.ledger import Ledger, audit, evidence_for
from signkin.audit.paper import Paper, read_paper
from signkin.checkout import checkout
from signkin.corpus import load_corpora


def ledger_of(
    papers: Iterable[Paper], corpora: Mapping[str, bool], files: Sequence[Path], results: Path
) -> Ledger:
    """Return the ledger of papers; each reads the tables of its own study.

    corpora: name -> whether simulated. files: result tables that the claims may read.
    """
    parts = [audit([paper], evidence_for(paper.study, corpora, files, results)) for paper in papers]
    return Ledger(
        pd.concat([part.claims for part in parts], ignore_index=True),
        pd.concat([part.checks for part in parts], ignore_index=True),
        tuple(fault for part in parts for fault in part.faults),
        pd.concat([part.details for part in parts], ignore_index=True),
    )


def run_ledger(papers: Sequence[Path], results: Path | None = None) -> Ledger:
    """Run the ledger outside the workflow: on print alone, or on the corpora of `results`."""
    read = [read_paper(folder) for folder in papers]
    if results is None:
        return ledger_of(read, {}, [], Path("results"))
    folder = Path("corpora")
    if not folder.is_dir() and (shipped := checkout()) is not None:
        folder = shipped / "corpora"
    known = load_corpora(folder, None)
    there = {
        name: corpus.simulator is not None
        for name, corpus in known.items()
        if (results / name).is_dir()
    }
    return ledger_of(read, there, sorted(results.rglob("*.csv")), results)


def told(ledger: Ledger) -> str:
    """Return the verdicts as text for a terminal."""
    lines = []
    for row in ledger.claims.itertuples(index=False):
        where = "" if row.evidence_kind == "published numbers" else f" [{row.evidence}]"
        head = f"{row.id:5s} {row.verdict:15s}{where} "
        lines.append(
            textwrap.fill(
                f"{head}{row.note}", 110, subsequent_indent=" " * 20, max_lines=3,
                placeholder=" ...", break_on_hyphens=False,
            )
        )  # fmt: skip
    counts = ledger.claims.groupby("evidence", sort=False)["verdict"].value_counts(sort=False)
    lines.append("")
    for evidence in dict.fromkeys(ledger.claims["evidence"]):
        parts = ", ".join(f"{n} {verdict}" for verdict, n in counts[evidence].items())
        lines.append(f"{evidence}: {parts}")
    return "\n".join(lines)
