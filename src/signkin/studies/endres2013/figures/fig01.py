"""Fig. 1: a recorded path, and its power-law timing."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import powerlaw as drawing
from signkin.figures.style import WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures.sources import Sources
from signkin.studies.endres2013.single_signs import POWERLAW, RECORDED

Laws = Mapping[int, tuple[float, float]]  # segment -> (beta, R squared)

TITLES = {
    "a": "a  recorded", "b": "b  recorded", "c": "c  warped, by time",
    "d": "d  warped: segments of the ground truth", "e": "e  warped, by segment",
}  # fmt: skip


def drawn(sources: Sources) -> Drawn:
    """Draw the example's path as recorded and with power-law timing."""
    points, laws = sources.example.points, laws_of(sources.example.segments)
    return Drawn(draw(points, laws, sources.unit), points, caption(points, laws))


def laws_of(segments: pd.DataFrame) -> Laws:
    """Return the laws fitted again. segments: rows of the table `ground_truth`."""
    return {
        int(row.segment): (float(row.fitted_beta), float(row.r_squared))
        for row in segments.itertuples()
    }


def draw(points: pd.DataFrame, laws: Laws, unit: str) -> Figure:
    """Draw the table `fig01_powerlaw`, in the plane of the recorded path's two widest axes."""
    before, after = (
        points[points["dataset"] == dataset].reset_index(drop=True)
        for dataset in (RECORDED, POWERLAW)
    )
    spread = {axis: float(before[f"{axis}_{unit}"].std()) for axis in "xyz"}
    there = [axis for axis in "xyz" if np.isfinite(spread[axis])]
    a, b = sorted(sorted(there, key=lambda axis: -spread[axis])[:2])
    figure, axes = plt.subplot_mosaic(
        [["a", "a", "b"], ["a", "a", "c"], ["d", "d", "e"], ["d", "d", "e"]],
        figsize=(WIDTH_IN, 6.6),
    )
    drawing.plot_path(before, unit, (a, b), ax=axes["a"], by="time")
    drawing.plot_path(after, unit, (a, b), ax=axes["d"], by="segment")
    axes["a"].legend(handles=drawing.start_and_end(), loc="best")
    drawing.plot_law(before, laws, unit, ax=axes["b"], by="time")
    drawing.plot_law(after, laws, unit, ax=axes["c"], by="time")
    drawing.plot_law(after, laws, unit, ax=axes["e"], by="segment")
    for name, title in TITLES.items():
        axes[name].set_title(title, loc="left")
    return figure


def caption(points: pd.DataFrame, laws: Laws) -> str:
    """Return what stands below the figure."""
    betas = ", ".join(f"{beta:.2f}" for beta, _ in laws.values())
    least = min(r2 for _, r2 in laws.values())
    return (
        f"Recording {points['recording'].iloc[0]} before (a, b) and after (c, d, e) time warping, "
        "in the plane of its two widest axes. Laws fitted again to the "
        f"{(points['dataset'] == POWERLAW).sum()} warped samples: β = {betas}; "
        f"R² from {least:.3f} (draws below powerlaw.least_r_squared are rejected, so a high R² "
        "says nothing about people). The path stays, the speed along it changes. Black lines in "
        "e: the laws."
    )
