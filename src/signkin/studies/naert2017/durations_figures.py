"""Figures of the duration models: predictions over truth, and Fig. 11."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import durations, style
from signkin.studies.naert2017.figures.notice import notice

TITLES = {
    "MEAN": "MEAN (baseline)",
    "SIMPLE": "SIMPLE",
    "SIMPLE_BOUNDED": "SIMPLE_BOUNDED",
    "LINEAR": "LINEAR",
    "SURFACE": "SURFACE",
    "SURFACE_PRINTED": "SURFACE as printed",
}


def draw_predictions(predictions: pd.DataFrame) -> Figure:
    """Draw a panel for each model that was tested, all on the same axes; none: why."""
    names = [name for name in TITLES if name in set(predictions["model"])]
    if not names:
        return notice("No model predicts a transition that it did not see: too few transitions.")
    wide = min(3, len(names))
    deep = -(-len(names) // wide)
    figure, axes = plt.subplots(
        deep, wide, figsize=(style.WIDTH_IN * wide / 3, 0.3 + 2.25 * deep), sharex=True,
        sharey=True, squeeze=False,
    )  # fmt: skip
    truth = float(predictions["duration_s"].max())
    # SIMPLE can be far off: the axis goes to twice the longest true duration, the rest is counted.
    longest = float(predictions["predicted_s"].max())
    reach = (truth * 1.05, min(longest * 1.05, truth * 2) if longest > truth else truth * 1.05)
    for ax in axes.flat[len(names) :]:
        ax.remove()
    for i, (name, ax) in enumerate(zip(names, axes.flat, strict=False)):
        chosen = predictions[predictions["model"] == name]
        durations.plot_predictions(chosen, TITLES[name], reach, ax=ax)
        if i % wide == 0:
            ax.set_ylabel("predicted duration (s)")
        if i + wide < len(names):
            ax.set_xlabel("")
    return figure


def draw_surface(points: pd.DataFrame, theta: np.ndarray | None, unit: str) -> Figure:
    """Draw Fig. 11: the surface in space with its transitions, and its levels from above."""
    # Placed by hand: the automatic layout does not see the labels of axes in space.
    figure = plt.figure(figsize=(style.WIDTH_IN, 3.5), layout="none")
    space = figure.add_axes((0.045, 0.05, 0.45, 0.86), projection="3d")
    durations.plot_surface(points, theta, unit, ax=space)
    levels = figure.add_axes((0.585, 0.14, 0.365, 0.80))
    durations.plot_levels(points, theta, unit, ax=levels)
    return figure
