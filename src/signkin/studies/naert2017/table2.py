"""Table 2: durations by transition type (Naert et al. 2017)."""

from __future__ import annotations

import pandas as pd

from signkin.settings.sections import Transitions
from signkin.statistics import descriptive
from signkin.studies.naert2017.transitions import counted


def table2(
    corpus: str, transitions: pd.DataFrame, published: pd.DataFrame, settings: Transitions
) -> pd.DataFrame:
    """Return the table `table2` of a corpus."""
    rows = counted(transitions)
    durations = rows["duration_s"].to_numpy(dtype=float)
    out = descriptive.table2(rows, descriptive.outliers(durations, settings.outlier_iqr), published)
    out.insert(0, "corpus", corpus)
    return out
