"""A wrist's speed with the boundaries, minima and tags found on it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from signkin.figures.style import ACCENT, HAND_COLOURS, MANUAL, SPEED_UNITS


def plot_excerpt(
    frames: pd.DataFrame, events: Mapping[str, ArrayLike], hand: str, unit: str,
    window: tuple[float, float], *, ax: Axes, legend: bool,
) -> Axes:  # fmt: skip
    """Draw a window of a wrist's speed; boundaries as lines, minima as dots, tags as ticks above.

    frames: kinematics of one recording. events: kind -> times in s.
    """
    here = frames["time_s"].between(*window)
    time, value = frames.loc[here, "time_s"], frames.loc[here, f"{hand}_speed_{unit}_per_s"]
    ax.plot(time, value, color=HAND_COLOURS[hand], lw=1.2)
    top = float(value.max())
    for t in _within(events.get("boundaries", ()), window):
        ax.axvline(t, 0, 0.8, color=ACCENT, lw=1.1, ls="--", zorder=1)
    minima = _within(events.get("minima", ()), window)
    ax.scatter(minima, np.interp(minima, time, value), s=14, color=HAND_COLOURS[hand], zorder=4)
    for kind, height, marker in (("manual tags", 1.2, "|"), ("refined tags", 1.1, "x")):
        times = _within(events.get(kind, ()), window)
        ax.plot(times, np.full(len(times), top * height), marker, ms=7, mew=1.4, color=MANUAL)
    ax.set(xlim=window, ylim=(0, top * 1.28), ylabel=f"{hand} wrist ({SPEED_UNITS[unit]})")
    if legend:
        names = {
            "boundary (binning)": {"color": ACCENT, "ls": "--"},
            "speed minimum": {"color": "0.3", "marker": "o", "ls": "none", "ms": 4},
        }
        if "manual tags" in events:
            names["manual tag"] = {"color": MANUAL, "marker": "|", "ls": "none", "ms": 7}
            names["refined tag"] = {"color": MANUAL, "marker": "x", "ls": "none", "ms": 5}
        handles = [Line2D([], [], label=name, **kind) for name, kind in names.items()]  # type: ignore[arg-type]
        ax.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    return ax


def _within(times: ArrayLike, window: tuple[float, float]) -> np.ndarray:
    values = np.asarray(times, dtype=float)
    return values[(values >= window[0]) & (values <= window[1])]
