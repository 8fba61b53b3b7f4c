"""A wrist's speed with the boundaries, minima and tags found on it."""

from __future__ import annotations

from collections.abc import Collection

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from signkin.figures.style import ACCENT, HAND_COLOURS, MANUAL, SPEED_UNITS

TAG_HEIGHTS = {"manual tags": 1.2, "refined tags": 1.1}  # over the top speed
TAG_MARKERS = {"manual tags": "|", "refined tags": "x"}


def plot_excerpt(
    points: pd.DataFrame, hand: str, unit: str, window: tuple[float, float], *, ax: Axes,
    legend: Collection[str] = (),
) -> Axes:  # fmt: skip
    """Draw a window of a wrist's speed; boundaries as lines, minima as dots, tags as ticks above.

    points: rows of the table `endres_figure` of one panel, series `speed`, `boundaries`,
    `minima`, `manual tags`, `refined tags`. legend: the kinds of events it tells; none: no legend.
    """
    of = {str(name): rows for name, rows in points.groupby("series")}
    speed = of["speed"]
    nothing = speed[:0]
    ax.plot(speed["x"], speed["y"], color=HAND_COLOURS[hand], lw=1.2)
    for t in of.get("boundaries", nothing)["x"]:
        ax.axvline(t, 0, 0.8, color=ACCENT, lw=1.1, ls="--", zorder=1)
    minima = of.get("minima", nothing)
    ax.scatter(minima["x"], minima["y"], s=14, color=HAND_COLOURS[hand], zorder=4)
    for kind, marker in TAG_MARKERS.items():
        tags = of.get(kind, nothing)
        ax.plot(tags["x"], tags["y"], marker, ms=7, mew=1.4, color=MANUAL)
    top = float(speed["y"].max())
    ax.set(xlim=window, ylim=(0, top * 1.28), ylabel=f"{hand} wrist ({SPEED_UNITS[unit]})")
    if legend:
        names = {
            "boundary (binning)": {"color": ACCENT, "ls": "--"},
            "speed minimum": {"color": "0.3", "marker": "o", "ls": "none", "ms": 4},
        }
        if "manual tags" in legend:
            names["manual tag"] = {"color": MANUAL, "marker": "|", "ls": "none", "ms": 7}
            names["refined tag"] = {"color": MANUAL, "marker": "x", "ls": "none", "ms": 5}
        handles = [Line2D([], [], label=name, **kind) for name, kind in names.items()]  # type: ignore[arg-type]
        ax.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    return ax
