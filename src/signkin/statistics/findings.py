"""What a test found, in one shape for all tests: a row of statistics.csv.

An empty number is one that the test does not have, or that these data do not allow; the note
says which. What others want to know of a finding stands in a field of its own: no text is taken
apart again. Sentences about several findings are made by those who ask the question.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
import pandas as pd
from numpy.typing import NDArray

NAN = float("nan")
Groups = Mapping[str, NDArray[np.float64]]


class Kind(StrEnum):
    """What a finding answers."""

    CHECK = "check"  # do the data meet what a test assumes?
    DIFFERENCE = "difference"  # do all these groups differ?
    PAIR = "pair"  # do these two, among many?
    EQUIVALENCE = "equivalence"  # are they the same within a bound?
    SENSITIVITY = "sensitivity"  # what could this design have found?
    VARIANCE = "variance"  # how much lies between signers, between recordings?
    ASSOCIATION = "association"  # does one number go with another?
    SHARE = "share"
    WORDS = "words"  # what follows from the others


@dataclass(frozen=True)
class Finding:
    """One test, and one of its effect sizes.

    comparison: what is set against what, in words. groups: the two labels compared, where it is
    two. statistic: of the kind `statistic_name` (F, H, t, ...). effect: of the kind
    `effect_name`, with its interval. assumptions: checks in words. power: of this test at this n,
    for the effect named in `power_for`. spread_s: the SD of the true means (s) that the effect
    stands for. decisive: whether the question is decided by it. p_holm: p adjusted for all tests
    that ask the same (`multiplicity.holm`). reason: why there is no test. notes: what else must be
    known to read the row.
    """

    test: str
    kind: Kind
    comparison: str = ""
    groups: tuple[str, ...] = ()
    statistic_name: str = ""
    statistic: float = NAN
    df1: float = NAN
    df2: float = NAN
    p: float = NAN
    effect_name: str = ""
    effect: float = NAN
    effect_low: float = NAN
    effect_high: float = NAN
    n: int = 0
    assumptions: str = ""
    power: float = NAN
    power_for: str = ""
    spread_s: float = NAN
    decisive: bool = False
    p_holm: float = NAN
    reason: str = ""
    notes: tuple[str, ...] = ()

    @property
    def note(self) -> str:
        """Reason and notes as one text."""
        why = (f"not testable: {self.reason}",) if self.reason else ()
        return joined(*why, *self.notes)

    def noted(self, *notes: str) -> Finding:
        """Return the finding with more notes; empty ones are none."""
        return replace(self, notes=(*self.notes, *filter(None, notes)))


# As in tables.TABLES["statistics"].
COLUMNS = ("test", "kind", "comparison", "statistic_name", "statistic", "df1", "df2", "p",
           "effect_name", "effect", "effect_low", "effect_high", "n", "assumptions", "power",
           "power_for", "spread_s", "decisive", "p_holm", "note")  # fmt: skip


def untestable(test: str, kind: Kind, comparison: str, n: int, reason: str) -> Finding:
    """Return a row that says that, and why, a test cannot be made."""
    return Finding(test, kind, comparison, n=n, reason=reason)


def table(findings: Iterable[Finding]) -> pd.DataFrame:
    """Return findings as a frame, one row each."""
    return pd.DataFrame([[getattr(f, n) for n in COLUMNS] for f in findings], columns=list(COLUMNS))


def grouped(values: NDArray[np.float64], labels: Iterable[str]) -> dict[str, NDArray[np.float64]]:
    """Return label -> values, labels in order."""
    series = pd.Series(values).groupby(np.asarray(list(labels), dtype=object), sort=True)
    return {str(label): group.to_numpy(dtype=float) for label, group in series}


def joined(*texts: str) -> str:
    """Return texts as one, empty ones left out."""
    return "; ".join(filter(None, texts))


def p_text(p: float) -> str:
    """Return `p = 0.031`, or `p < 0.001`."""
    return "p < 0.001" if p < 0.001 else f"p = {p:.3f}"
