"""What a check says: a verdict, why, and the numbers it rests on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

CONSISTENT, INCONSISTENT, UNDECIDABLE = "consistent", "inconsistent", "undecidable"
HOLDS, FAILS, NOT_TESTABLE = "holds", "fails", "not testable"


@dataclass(frozen=True)
class Finding:
    """The outcome of one check.

    verdict: consistent, inconsistent or undecidable (printed numbers); holds, fails or
    undecidable (corpora). why: one sentence. printed, recomputed: as text. interval: what
    rounding, or chance, allows the recomputed number to be. source: a file with the numbers.
    item: the row of a table that the finding is about.
    """

    verdict: str
    why: str
    printed: str = ""
    recomputed: str = ""
    interval: str = ""
    source: str = ""
    item: str = ""


def summary(findings: Iterable[Finding]) -> str:
    """Return one verdict for several findings on printed numbers."""
    verdicts = {finding.verdict for finding in findings}
    if INCONSISTENT in verdicts:
        return INCONSISTENT
    return CONSISTENT if CONSISTENT in verdicts else UNDECIDABLE
