"""What a test found, in one shape for all tests: a row of statistics.csv.

An empty number is one that the test does not have, or that these data do not allow; the note
says which.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

NAN = float("nan")
Groups = Mapping[str, NDArray[np.float64]]


@dataclass(frozen=True)
class Finding:
    """One test, and one of its effect sizes.

    comparison: what is set against what. statistic: of the kind `statistic_name` (F, H, t, ...).
    effect: of the kind `effect_name`, with its interval. power: of this test at this n, for the
    effect named in `power_for`. assumptions: checks in words. note: why a value is missing, and
    what else must be known to read the row.
    """

    test: str
    comparison: str = ""
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
    note: str = field(default="")

    def noted(self, *notes: str) -> Finding:
        """Return the finding with more notes."""
        return replace(self, note="; ".join(part for part in (self.note, *notes) if part))


NAMES = tuple(f.name for f in fields(Finding))


def untestable(test: str, comparison: str, n: int, reason: str) -> Finding:
    """Return a row that says that, and why, a test cannot be made."""
    return Finding(test, comparison, n=n, note=f"not testable: {reason}")


def table(findings: Iterable[Finding]) -> pd.DataFrame:
    """Return findings as a frame, one row each."""
    return pd.DataFrame([[getattr(f, n) for n in NAMES] for f in findings], columns=list(NAMES))


def grouped(values: NDArray[np.float64], labels: Iterable[str]) -> dict[str, NDArray[np.float64]]:
    """Return label -> values, labels in order."""
    series = pd.Series(values).groupby(np.asarray(list(labels), dtype=object), sort=True)
    return {str(label): group.to_numpy(dtype=float) for label, group in series}


def p_text(p: float) -> str:
    """Return `p = 0.031`, or `p < 0.001`."""
    return "p < 0.001" if p < 0.001 else f"p = {p:.3f}"
