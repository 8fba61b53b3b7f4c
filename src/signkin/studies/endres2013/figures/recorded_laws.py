"""Power laws of recorded segments (2.3), and what noise, filter and duration do to exponents."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures.recorded_laws import plot_exponents, plot_known
from signkin.figures.style import WIDTH_IN
from signkin.powerlaw.estimates import NON_LINEAR
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.recorded_laws import COLUMNS


def drawn(laws: pd.DataFrame, known: pd.DataFrame) -> Drawn:
    """Draw the tables `recorded_laws` and `law_pitfalls` of one corpus."""
    return Drawn(draw(laws, known), laws, caption(laws, known))


def draw(laws: pd.DataFrame, known: pd.DataFrame) -> Figure:
    """Draw exponents of segments beside noise (left), and of ellipses (right)."""
    figure, axes = plt.subplots(1, 2, figsize=(WIDTH_IN, 3.0))
    alone = known["path"] == "noise alone"
    plot_exponents(laws, COLUMNS, known[alone], axes[0])
    plot_known(known[~alone], NON_LINEAR, axes[1])
    return figure


def caption(laws: pd.DataFrame, known: pd.DataFrame) -> str:
    """Return what stands below the figure, with its numbers."""
    there = laws.dropna(subset=["beta"])
    alone = known[known["path"] == "noise alone"]
    noise = alone.groupby("estimator", sort=False)["found"].mean()
    of_noise = ", ".join(
        f"{name} {'none' if np.isnan(value) else f'{value:.2f}'}" for name, value in noise.items()
    )
    exact = known[(known["path"] == "ellipse") & (known["estimator"] == NON_LINEAR)]
    clean = exact[(exact["noise_sd"] == 0) & (exact["duration_s"] == 0.8)]
    told = ", ".join(f"{row.found:.3f} for {row.beta:.3g}" for row in clean.itertuples())
    least = exact["smallest_difference"].dropna()
    return (
        f"{_recorded(there, len(laws) - len(there))} Noise alone, through the same filter, gives "
        f"{of_noise} (grey) and r = {alone['r'].mean():.2f}: speed and curvature share "
        "derivatives. Right: an ellipse of known exponent through the same filter, without noise "
        f"(filled; a turn of 0.8 s: {told}) and with that of the corpus (open, ± SD). The "
        "smallest difference of two segments' exponents that noise lets one tell (power 0.8) is "
        f"{least.min():.3f} to {least.max():.3f}. Dashed: -1/3 (left), equal (right)."
    )


def _recorded(there: pd.DataFrame, lost: int) -> str:
    if there.empty:
        return f"Left: none of {lost} segments of recorded movement has an exponent."
    parts = []
    for name, column in COLUMNS.items():
        low, middle, high = there[column].quantile([0.25, 0.5, 0.75])
        without = int(there[column].isna().sum())
        told = f"{name} {middle:.2f} ({low:.2f} to {high:.2f})"
        if without == len(there):
            told = f"{name} none"
        elif without:
            told += f", of {len(there) - without} where noise leaves enough of curvature"
        parts.append(told)
    return (
        f"Left: exponents of {len(there)} segments of recorded movement between the boundaries of "
        f"order 3 ({lost} more have none: too few samples, or no curvature), median and quartiles "
        f"by three regressions: {'; '.join(parts)}; lines hold 90 %. The logarithms of speed and "
        f"curvature correlate with r = {there['r'].median():.2f} (median)."
    )
