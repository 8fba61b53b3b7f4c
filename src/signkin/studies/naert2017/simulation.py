"""What a simulated corpus is for: errors to the truth, and the surface found again."""

from __future__ import annotations

import numpy as np
import pandas as pd

from signkin import seeds, tables
from signkin.coarticulation.duration import TERMS, SurfaceDuration, Transitions
from signkin.coarticulation.segmentation import truth_errors, truth_summary
from signkin.studies.naert2017.transitions import counted


def truth_error(
    corpus: str, bounds: pd.DataFrame, truth: pd.DataFrame, draws: int, seed: int
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the table `truth_error` and the error of every tag (recording, sign, edge, hand)."""
    errors = truth_errors(bounds, truth)
    summary = truth_summary(errors, draws, seeds.stream(seed, corpus, "truth"))
    summary.insert(0, "corpus", corpus)
    return summary, errors


def surface(
    corpus: str,
    transitions: pd.DataFrame,
    design: pd.DataFrame,
    constants: pd.DataFrame,
    euclidean_unit_m: float,
) -> pd.DataFrame:
    """Return the surface fitted to the manual transitions, to the design, and as printed.

    constants: papers/naert2017/constants.csv, all text.
    """
    found = _fit(counted(transitions), euclidean_unit_m)
    designed = _fit(design, euclidean_unit_m)
    printed = constants.set_index("name")["value"]
    interval = found.interval()
    rows = []
    for i, term in enumerate(TERMS):
        published = printed[f"theta_{term}"]
        rows.append(
            {
                "corpus": corpus,
                "coefficient": term,
                "published": published,
                "fitted": found.theta[i],
                "low": interval[i, 0],
                "high": interval[i, 1],
                "designed": designed.theta[i],
                "shift_percent": 100 * (found.theta[i] / float(published) - 1),
                "n": found.n,
                "mean_error_s": found.mean_error_s,
            }
        )
    return pd.DataFrame(rows, columns=tables.TABLES["surface"].names())


def _fit(rows: pd.DataFrame, euclidean_unit_m: float) -> SurfaceDuration:
    def column(name: str) -> np.ndarray:
        return rows[name].to_numpy(dtype=float)

    return SurfaceDuration().fit(
        Transitions(
            column("geodesic_rad"), column("euclidean_m") / euclidean_unit_m, column("duration_s")
        )
    )
