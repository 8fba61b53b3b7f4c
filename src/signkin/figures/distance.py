"""Duration of transitions against the distance between postures (Fig. 7, 8, 9)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from signkin.figures.style import ACCENT, HAND_COLOURS, LEFT, NEUTRAL, RIGHT

DISTANCE_LABEL = "mean of the normalised distances"
DURATION_LABEL = "duration (s)"


def plot_distances(points: pd.DataFrame, line: tuple[float, float] | None, *, ax: Axes) -> Axes:
    """Draw Fig. 7: each transition's duration over its mean distance, with the straight line.

    points: rows of the table `distances`. line: (slope, intercept) or None.
    """
    _scatter(points, points["outlier"].astype(bool), ax)
    if line is not None and len(points):
        x = np.array([points["mean_distance"].min(), points["mean_distance"].max()])
        ax.plot(x, line[0] * x + line[1], color=ACCENT, lw=1.3, label="least-squares line")
    _finish(ax)
    return ax


def plot_diamond(
    points: pd.DataFrame, corners: Mapping[str, tuple[float, float]], *, ax: Axes
) -> Axes:
    """Draw Fig. 8: the same points with the diamond, those outside it hollow."""
    inside = points["in_diamond"].astype(bool)
    ax.scatter(*_xy(points[inside]), s=14, color=RIGHT, alpha=0.75, lw=0, label="inside")
    ax.scatter(
        *_xy(points[~inside]), s=16, facecolors="none", edgecolors=LEFT, lw=0.9, label="outside"
    )
    if corners:
        outline = [corners[name] for name in ("left", "top", "right", "bottom", "left")]
        ax.plot(*zip(*outline, strict=True), color=NEUTRAL, lw=1.2)
    _finish(ax)
    return ax


def _scatter(points: pd.DataFrame, outlier: pd.Series, ax: Axes) -> None:
    ax.scatter(*_xy(points[~outlier]), s=14, color=RIGHT, alpha=0.75, lw=0, label="transition")
    if outlier.any():
        ax.scatter(
            *_xy(points[outlier]), s=22, marker="D", facecolors="none", edgecolors=LEFT, lw=1.0,
            label="outlier",
        )  # fmt: skip


def _xy(points: pd.DataFrame) -> tuple[pd.Series, pd.Series]:
    return points["mean_distance"], points["duration_s"]


def _finish(ax: Axes) -> None:
    ax.set(xlabel=DISTANCE_LABEL, ylabel=DURATION_LABEL)
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    ax.legend(loc="best")


def plot_segmentations(pairs: pd.DataFrame, hand: str, unit: str, *, ax: Axes) -> Axes:
    """Draw one panel of Fig. 9: manual (diamonds) and refined (disks) transitions, joined.

    pairs: rows of the table `segmentations`. Distances are of the joints of this arm.
    """
    chosen = pairs[pairs["hand"] == hand]
    x1, x2 = chosen[f"manual_euclidean_{unit}"], chosen[f"refined_euclidean_{unit}"]
    y1, y2 = chosen["manual_duration_s"], chosen["refined_duration_s"]
    ends = np.stack([np.column_stack([x1, y1]), np.column_stack([x2, y2])], axis=1)
    size = 9 if len(chosen) <= 200 else 5
    cloud = len(chosen) > 200  # saved as a picture, not one by one
    ax.add_collection(LineCollection(list(ends), colors="0.5", lw=0.7, zorder=1, rasterized=cloud))
    for x, y, more, marker, colour, label in (
        (x1, y1, 0, "D", RIGHT, "manual"), (x2, y2, 2, "o", LEFT, "refined"),
    ):  # fmt: skip
        ax.scatter(
            x, y, s=size + more, marker=marker, color=colour, lw=0, label=label,
            zorder=2 + more / 2, rasterized=cloud,
        )  # fmt: skip
    ax.axhline(0, color="0.85", lw=0.8, zorder=0)
    ax.set(
        xlabel=f"mean Euclidean distance, {hand} arm ({unit})",
        ylabel=DURATION_LABEL,
        title=f"{hand} hand",
    )
    ax.title.set_color(HAND_COLOURS[hand])
    return ax
