"""Holm's correction: of many tests that ask one question, one is soon significant by chance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from statsmodels.stats.multitest import multipletests

from signkin.statistics.findings import Finding

METHOD = "Holm"


def holm_of(p: ArrayLike) -> NDArray[np.float64]:
    """Return the p of a family, (K,), adjusted by Holm's step-down procedure."""
    values = np.asarray(p, dtype=float)
    return np.asarray(multipletests(values, method="holm")[1]) if len(values) else values


def holm(findings: Sequence[Finding], belongs: Callable[[Finding], bool]) -> list[Finding]:
    """Return all findings, those of one family with p adjusted by Holm's step-down procedure.

    belongs: whether a finding is of the family; those without a p are not. The chance that any
    true hypothesis of the family has an adjusted p below alpha is at most alpha, whatever their
    dependence (Holm 1979). The note tells how many tests the family has.
    """
    family = [i for i, f in enumerate(findings) if belongs(f) and np.isfinite(f.p)]
    out = list(findings)
    if not family:
        return out
    adjusted = holm_of([findings[i].p for i in family])
    for i, p in zip(family, adjusted, strict=True):
        out[i] = replace(findings[i], p_holm=float(p)).noted(
            f"{METHOD}: one of {len(family)} tests"
        )
    return out
