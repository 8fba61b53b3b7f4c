"""A recorded path and its power-law timing (Endres et al. 2013, Fig. 1)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from signkin.figures.style import SEGMENT_COLOURS

TIME_MAP = "cividis"


def plot_path(
    points: pd.DataFrame, unit: str, plane: tuple[str, str], *, ax: Axes, by: str
) -> Axes:
    """Draw a path in one plane, coloured by `time` or by `segment` (Fig. 1 a, d).

    points: rows of the table `fig01_powerlaw` of one dataset. plane: two of x, y, z.
    """
    a, b = (points[f"{axis}_{unit}"].to_numpy(dtype=float) for axis in plane)
    if by == "time":
        _gradient(a, b, points["time_s"].to_numpy(dtype=float), ax)
    else:
        for segment, rows in points.groupby("segment"):
            last = rows.index[-1] + 1
            until = points.loc[rows.index[0] : last]  # up to the next segment's first sample
            ax.plot(
                until[f"{plane[0]}_{unit}"], until[f"{plane[1]}_{unit}"], lw=2,
                color=colour_of(int(segment)),
            )  # fmt: skip
    ax.plot(a[0], b[0], "o", ms=5, mfc="white", mec="0.2", zorder=4)
    ax.plot(a[-1], b[-1], "s", ms=5, mfc="0.2", mec="0.2", zorder=4)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel=f"{plane[0]} ({unit})", ylabel=f"{plane[1]} ({unit})")
    return ax


def plot_law(
    points: pd.DataFrame, laws: Mapping[int, tuple[float, float]], unit: str, *, ax: Axes, by: str
) -> Axes:
    """Draw speed against curvature, both logarithmic (Fig. 1 b, c, e).

    by: `time` or `segment`. laws: segment -> (beta, R squared), told where by segment.
    """
    there = points[f"curvature_per_{unit}"].notna() & (points[f"speed_{unit}_per_s"] > 0)
    rows = points[there]
    k = rows[f"curvature_per_{unit}"].to_numpy(dtype=float)
    v = rows[f"speed_{unit}_per_s"].to_numpy(dtype=float)
    if by == "time":
        ax.scatter(k, v, c=rows["time_s"], cmap=TIME_MAP, s=7, lw=0)
    else:
        for segment, part in rows.groupby("segment"):
            beta, r2 = laws[int(segment)]
            ax.scatter(
                part[f"curvature_per_{unit}"], part[f"speed_{unit}_per_s"], s=9, lw=0,
                color=colour_of(int(segment)), alpha=0.6,
                label=f"segment {segment}: β = {beta:.2f}, R² = {r2:.3f}",
            )  # fmt: skip
            order = part.sort_values(f"curvature_per_{unit}")
            law = order[f"predicted_speed_{unit}_per_s"]
            ax.plot(order[f"curvature_per_{unit}"], law, color="0.15", lw=0.9)
        ax.legend(loc="upper center", bbox_to_anchor=(0.45, -0.2), handletextpad=0.2)
    ax.set(xscale="log", yscale="log")
    for axis in (ax.xaxis, ax.yaxis):
        low, high = axis.get_view_interval()
        subs = (1.0,) if high > 30 * low else (1.0, 2.0, 3.0, 5.0)
        axis.set_major_locator(LogLocator(subs=subs))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    ax.set(xlabel=f"curvature (1/{unit})", ylabel=f"speed ({unit}/s)")
    return ax


def colour_of(segment: int) -> str:
    """Return the colour of a segment, from 1."""
    return SEGMENT_COLOURS[(segment - 1) % len(SEGMENT_COLOURS)]


def start_and_end() -> list[Line2D]:
    """Return legend handles for a path's start and end."""
    return [
        Line2D([], [], marker="o", ls="none", mfc="white", mec="0.2", ms=5, label="start"),
        Line2D([], [], marker="s", ls="none", mfc="0.2", mec="0.2", ms=5, label="end"),
    ]


def _gradient(a: np.ndarray, b: np.ndarray, values: np.ndarray, ax: Axes) -> None:
    points = np.column_stack([a, b])
    lines = LineCollection(
        list(np.stack([points[:-1], points[1:]], axis=1)), cmap=TIME_MAP, array=values[:-1], lw=2
    )
    ax.add_collection(lines)
    ax.autoscale_view()
    ax.figure.colorbar(lines, ax=ax, label="time (s)", pad=0.01, aspect=30)
