"""Speed of both wrists with tags and minima (Naert et al. 2017, Fig. 4, 5 and 6)."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from signkin.figures.style import HAND_COLOURS, MANUAL, SPEED_UNITS


def plot_speed(points: pd.DataFrame, unit: str, rate_hz: float, *, ax: Axes, marks: str) -> Axes:
    """Draw the excerpt of a recording on the Axes given.

    points: rows of the table `excerpt`. unit: m or px. marks: `minima` (Fig. 4, 5: the local
    minima of each hand, dotted) or `refined` (Fig. 6: the refined tags of each hand).
    Seconds below, frames above, as the paper counts them.
    """
    column = f"speed_{unit}_per_s"
    for hand, marker, width in (("right", "", 1.3), ("left", ".", 1.0)):
        curve = points[(points["kind"] == "speed") & (points["hand"] == hand)]
        ax.plot(
            curve["time_s"], curve[column], color=HAND_COLOURS[hand], lw=width, marker=marker,
            ms=2.5, zorder=3,
        )  # fmt: skip
    tags = points[points["kind"] == "tag"]
    for tag in tags.itertuples():
        ax.axvline(tag.time_s, color=MANUAL, lw=1.3, ls="-" if tag.edge == "start" else "--")
    kind = "minimum" if marks == "minima" else "refined"
    for row in points[points["kind"] == kind].itertuples():
        # The hands' marks end at different heights, so that one on the other stays visible.
        span = (0.0, 0.86) if row.hand == "right" else (0.0, 0.80)
        solid = kind == "refined" and row.edge == "start"
        dashes = "-" if solid else "--" if kind == "refined" else ":"
        ax.axvline(row.time_s, *span, color=HAND_COLOURS[row.hand], lw=1.0, ls=dashes, alpha=0.9)
    stays = points[(points["kind"] == "refined") & (points["status"] == "far")]
    if kind == "refined":
        for row in stays.itertuples():
            height = 0.89 if row.hand == "right" else 0.83
            ax.plot(
                row.time_s, height, marker="x", ms=5, mew=1.4, color=HAND_COLOURS[row.hand],
                transform=ax.get_xaxis_transform(), zorder=5,
            )  # fmt: skip
    if not points.empty:
        ax.set_xlim(points["time_s"].min(), points["time_s"].max())
    top = points.loc[points["kind"] == "speed", column].max()
    ax.set_ylim(0, top * 1.28)
    _name_signs(tags, ax)
    ax.set(xlabel="time in the recording (s)", ylabel=f"wrist speed ({SPEED_UNITS[unit]})")

    def to_frames(time_s: Any) -> Any:
        return time_s * rate_hz

    def to_seconds(frame: Any) -> Any:
        return frame / rate_hz

    frames = ax.secondary_xaxis("top", functions=(to_frames, to_seconds))
    frames.set_xlabel(f"frame ({rate_hz:g} Hz)")
    ax.legend(
        handles=_handles(marks), loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=4,
        handlelength=2.4,
    )  # fmt: skip
    return ax


def _name_signs(tags: pd.DataFrame, ax: Axes) -> None:
    """Write each gloss between its tags, as long as both are in view; long ones are shortened."""
    starts = tags[tags["edge"] == "start"]
    ends = tags[tags["edge"] == "end"]
    low, high = ax.get_xlim()
    for start in starts.itertuples():
        later = ends[(ends["gloss"] == start.gloss) & (ends["time_s"] > start.time_s)]
        if later.empty:
            continue
        end = float(later["time_s"].min())
        room = (end - start.time_s) / (high - low)
        letters = max(3, int(room * 95))
        gloss = str(start.gloss)
        text = gloss if len(gloss) <= letters else gloss[: letters - 1] + "…"
        ax.text(
            (start.time_s + end) / 2, 0.965, text, transform=ax.get_xaxis_transform(),
            ha="center", va="center", fontsize=7, color=MANUAL, clip_on=True,
        )  # fmt: skip


def _handles(marks: str) -> list[Line2D]:
    def line(label: str, colour: str, ls: str = "-", **extra: object) -> Line2D:
        return Line2D([], [], color=colour, ls=ls, label=label, **extra)  # type: ignore[arg-type]

    right, left = HAND_COLOURS["right"], HAND_COLOURS["left"]
    wrists = [line("right wrist", right), line("left wrist", left, marker=".", ms=4)]
    tags = [line("sign starts (manual)", MANUAL), line("sign ends (manual)", MANUAL, "--")]
    if marks == "minima":
        minima = [line(f"minimum, {hand} hand", HAND_COLOURS[hand], ":") for hand in HAND_COLOURS]
        return [*wrists, *tags, *minima]
    refined = [
        line(f"{edge}, refined ({hand})", HAND_COLOURS[hand], dashes)
        for hand in HAND_COLOURS
        for edge, dashes in (("starts", "-"), ("ends", "--"))
    ]
    stays = line("stays: no minimum near", "0.3", "none", marker="x", ms=5, mew=1.4)
    return [*wrists, stays, *tags, *refined]


def plot_recording(frames: pd.DataFrame, minima: pd.DataFrame, unit: str, *, ax: Axes) -> Axes:
    """Draw the speed of both wrists over a whole recording, with dots at the minima.

    frames: kinematics of one recording. minima: its rows of the table `minima`.
    """
    for hand, colour in HAND_COLOURS.items():
        ax.plot(frames["time_s"], frames[f"{hand}_speed_{unit}_per_s"], color=colour, lw=1)
        low = minima[minima["hand"] == hand]
        ax.scatter(low["minimum_s"], low[f"speed_{unit}_per_s"], s=9, color=colour, lw=0, zorder=3)
    ax.set(ylabel=f"speed ({SPEED_UNITS[unit]})", xlim=(0, frames["time_s"].max()))
    ax.set_ylim(bottom=0)
    return ax
