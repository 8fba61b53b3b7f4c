"""Where boundaries are, and how sure that is: speed, manual tags and posteriors, a panel a hand."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from signkin.figures.style import HAND_COLOURS, MANUAL, SPEED_UNITS

BAND_90, BAND_50 = 0.16, 0.38  # opacity


def plot_posterior(
    points: pd.DataFrame, posteriors: pd.DataFrame, unit: str, hand: str, *, ax: Axes
) -> Axes:
    """Draw one hand of an excerpt: its speed, the tags, 90 and 50 % intervals of boundaries.

    points: table `excerpt`. posteriors: the recording's rows of `boundary_posteriors`.
    """
    column = f"speed_{unit}_per_s"
    colour = HAND_COLOURS[hand]
    curve = points[(points["kind"] == "speed") & (points["hand"] == hand)]
    ax.plot(curve["time_s"], curve[column], color="0.25", lw=1.1, zorder=3)
    low, high = points["time_s"].min(), points["time_s"].max()
    rows = posteriors[(posteriors["hand"] == hand) & posteriors["mean_s"].between(low, high)]
    for row in rows.itertuples():
        ax.axvspan(row.low90_s, row.high90_s, color=colour, alpha=BAND_90, lw=0)
        ax.axvspan(row.low50_s, row.high50_s, color=colour, alpha=BAND_50, lw=0)
        ax.axvline(
            row.mean_s, 0, 0.9, color=colour, lw=1.0, ls="-" if row.edge == "start" else "--"
        )
    top = float(curve[column].max()) * 1.25 if len(curve) else 1.0
    for row in points[points["kind"] == "tag"].itertuples():
        ax.axvline(row.time_s, 0, 0.9, color=MANUAL, lw=1.3,
                   ls="-" if row.edge == "start" else "--")  # fmt: skip
    signs = rows.pivot_table(index=["sign", "gloss"], columns="edge", values="manual_s")
    if {"start", "end"} <= set(signs.columns):
        for (_, gloss), sign in signs.dropna().iterrows():
            room = max(3, int((sign["end"] - sign["start"]) / (high - low) * 90))
            name = str(gloss)
            told = name if len(name) <= room else name[: room - 1] + "…"
            ax.text((sign["start"] + sign["end"]) / 2, 0.955, told, ha="center", va="center",
                    fontsize=6.5, color=MANUAL, transform=ax.get_xaxis_transform())  # fmt: skip
    ax.set(xlim=(low, high), ylim=(0, top), ylabel=f"{hand} wrist ({SPEED_UNITS[unit]})")
    return ax


def handles() -> list[Line2D | Patch]:
    """Return what the legend of both panels shows."""
    return [
        Line2D([], [], color="0.25", lw=1.1, label="speed"),
        Line2D([], [], color=MANUAL, lw=1.3, label="manual tag: start"),
        Line2D([], [], color=MANUAL, lw=1.3, ls="--", label="manual tag: end"),
        Line2D([], [], color="0.35", lw=1.0, label="boundary, on average"),
        Patch(color="0.35", alpha=BAND_50, lw=0, label="boundary here: 50 %"),
        Patch(color="0.35", alpha=BAND_90, lw=0, label="boundary here: 90 %"),
    ]
