"""Transitions as Fig. 7 and 8 show them: duration and distance, outliers, the diamond."""

from __future__ import annotations

import pandas as pd

from signkin import tables
from signkin.settings.sections import Transitions
from signkin.statistics import descriptive
from signkin.studies.naert2017.transitions import counted


def with_flags(
    transitions: pd.DataFrame, outlier_iqr: float, diamond_share: float
) -> tuple[pd.DataFrame, descriptive.Diamond | None]:
    """Return the counted transitions as the table `distances`, and the diamond of Fig. 8.

    outlier_iqr, diamond_share: as in config's `transitions`. None where fewer than three
    transitions have a distance.
    """
    rows = counted(transitions)
    rows["outlier"] = descriptive.outliers(rows["duration_s"].to_numpy(dtype=float), outlier_iqr)
    rows["in_diamond"] = False
    there = rows["mean_distance"].notna()
    shape = None
    if there.sum() >= 3:
        shape = descriptive.diamond(
            rows.loc[there, "mean_distance"].to_numpy(dtype=float),
            rows.loc[there, "duration_s"].to_numpy(dtype=float),
            diamond_share,
        )
        rows.loc[there, "in_diamond"] = shape.inside
    return rows[tables.TABLES["distances"].names()], shape


def diamond_table(corpus: str, transitions: pd.DataFrame, settings: Transitions) -> pd.DataFrame:
    """Return the corners of the diamond as the table `diamond`; no rows without a diamond."""
    names = tables.TABLES["diamond"].names()
    _, shape = with_flags(transitions, settings.outlier_iqr, settings.diamond_share)
    if shape is None:
        return pd.DataFrame(columns=names)
    rows = [
        (corpus, c, x, y, shape.share, len(shape.inside)) for c, (x, y) in shape.corners.items()
    ]
    return pd.DataFrame(rows, columns=names)
