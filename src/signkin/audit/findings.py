"""What a check says: a verdict, why, and the numbers it rests on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from signkin.audit.verdicts import Verdict
from signkin.errors import SignkinError

CONSISTENT, INCONSISTENT = Verdict.CONSISTENT.value, Verdict.INCONSISTENT.value
HOLDS, FAILS, NOT_TESTABLE = Verdict.HOLDS.value, Verdict.FAILS.value, Verdict.NOT_TESTABLE.value
UNDECIDED, DEPENDS = Verdict.UNDECIDED.value, Verdict.DEPENDS.value
BY_CONSTRUCTION = Verdict.BY_CONSTRUCTION.value
UNDECIDABLE = "undecidable"  # of a single check: a claim it alone stands on is not testable
DECISION, DIGITS = "the decision changes", "digits only"


class Copies(NamedTuple):
    """A bar of a histogram over samples: a value, or a class of them, and how many copies.

    least, mean, most: over the samples.
    """

    value: str
    least: float
    mean: float
    most: float


@dataclass(frozen=True)
class Finding:
    """The outcome of one check.

    verdict: consistent, inconsistent or undecidable (printed numbers); holds, fails,
    undecided, depends or undecidable (corpora). why: one sentence. printed, recomputed: as text;
    what a hand calculation with the printed digits gives. interval: what rounding, or chance,
    allows the recomputed number to be. source: a file with the numbers. item: the row of a
    table that the finding is about. settings: grain, divisor, df and the like. hand: how to redo
    it by hand.
    nearest: what would be consistent. severity: whether a decision (significant or not) changes.
    fault: the input could not be used; `why` tells where and why. histogram: of samples that
    print so.
    """

    verdict: str
    why: str
    printed: str = ""
    recomputed: str = ""
    interval: str = ""
    source: str = ""
    item: str = ""
    settings: str = ""
    hand: str = ""
    nearest: str = ""
    severity: str = ""
    fault: bool = False
    histogram: tuple[Copies, ...] = ()


def unusable(error: SignkinError, item: str = "", source: str = "") -> Finding:
    """Return the finding of a row, or a check, whose input cannot be used."""
    return Finding(UNDECIDABLE, str(error), item=item, source=source, fault=True)


def summary(findings: Iterable[Finding]) -> str:
    """Return one verdict for several findings on printed numbers."""
    verdicts = {finding.verdict for finding in findings}
    if INCONSISTENT in verdicts:
        return INCONSISTENT
    return CONSISTENT if CONSISTENT in verdicts else UNDECIDABLE


def over_readings(
    readings: Sequence[tuple[str, Callable[[], Finding]]], others: str = ""
) -> Finding:
    """Try the readings that a paper leaves open: inconsistent only if none allows the print.

    readings: (what is read so, the check), the usual one first. The finding is that of the first
    reading that allows the print; if it is not the usual one, it names all that do. others: how
    to name in short what else was tried in vain.
    """
    first = readings[0][1]()
    if first.verdict == CONSISTENT:
        return first
    tried = [(readings[0][0], first), *((name, check()) for name, check in readings[1:])]
    for verdict in (CONSISTENT, UNDECIDABLE):
        fitting = [(name, f) for name, f in tried if f.verdict == verdict]
        if len(fitting) == len(tried):  # open under each reading: none is to be named
            return fitting[0][1]
        if fitting and (verdict == UNDECIDABLE or fitting[0][0] != tried[0][0]):
            names = " or ".join(name for name, _ in fitting)
            why = f"{fitting[0][1].why}; only read as {names}"
            if verdict == CONSISTENT:
                why += f" (as {tried[0][0]} not: {tried[0][1].why})"
            severity = fitting[0][1].severity
            if first.severity == DECISION:
                severity = f"{DECISION} if read as {tried[0][0]}"
            return replace(fitting[0][1], why=why, severity=severity)
        if fitting:
            return fitting[0][1]
    usual = tried[0][1]
    if len(tried) == 1:
        return usual
    others = others or ", ".join(name for name, _ in tried[1:])
    return replace(usual, why=f"{usual.why}; nor does another reading allow it ({others})")
