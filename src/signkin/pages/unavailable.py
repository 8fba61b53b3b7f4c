"""What the report says of analyses that could not be made."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import pandas as pd

from signkin.errors import listed
from signkin.report.page import Section, TableView
from signkin.unavailable import rows_of

ANCHOR = "not-available"


def unavailable_rows(results: Path, corpora: Iterable[str]) -> pd.DataFrame:
    """Return the rows of the table `not_available` of corpora of this run."""
    return pd.concat([rows_of(results / name / "not_available") for name in corpora])


def unavailable_notices(results: Path, corpora: Iterable[str]) -> Iterator[str]:
    """Yield a sentence a corpus of which something could not be made."""
    rows = unavailable_rows(results, corpora)
    for name, of_corpus in rows.groupby("corpus", sort=True):
        analyses = list(dict.fromkeys(of_corpus["analysis"]))
        yield f"{name}: not available, or in part: {listed(analyses, 20)}. The reasons stand below."


def unavailable_section(results: Path, corpora: Iterable[str]) -> Iterator[Section]:
    """Yield the section that tells what could not be made, and why; none where all could."""
    rows = unavailable_rows(results, corpora)
    if rows.empty:
        return
    view = TableView(
        label="",
        title="Analyses, and parts of them, that could not be made",
        caption="Their tables are there without rows, and their figures say the same.",
        frame=rows,
        columns={
            "corpus": ("corpus", ""),
            "analysis": ("analysis", ""),
            "part": ("part", ""),
            "reason": ("not available because", ""),
        },
        most=60,
    )
    yield Section(ANCHOR, "Not available", exhibits=(view,))
