"""Specification curves: an estimate under every combination of open choices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import wrap

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from signkin.figures.style import ACCENT, NEUTRAL, PALE, RIGHT

UNJUDGED = "white: not to be judged"  # under a reading
CLOUD = 150  # points of one panel that are saved as a picture, not one by one


def plot_estimates(specs: pd.DataFrame, label: str, zero: bool = False, *, ax: Axes) -> Axes:
    """Draw the estimates in their order, filled where the claim holds.

    specs: columns estimate, reference (NaN for none), holds; one row a specification.
    """
    at = np.arange(len(specs))
    holds = specs["holds"].to_numpy(dtype=bool)
    size = float(np.clip(900 / max(len(specs), 1), 5, 22))
    cloud = len(specs) > CLOUD
    values = specs["estimate"].to_numpy(dtype=float)
    bounds = specs["reference"].to_numpy(dtype=float)
    if np.isfinite(bounds).any():
        ax.scatter(
            at, bounds, marker="_", s=2 * size, color=ACCENT, lw=1, label="bound", rasterized=cloud
        )
    elif zero:
        ax.axhline(0, color="0.6", lw=0.8)
    ax.scatter(at[holds], values[holds], s=size, color=RIGHT, lw=0, label="holds", rasterized=cloud)
    ax.scatter(
        at[~holds], values[~holds], s=size, facecolor="white", edgecolor=NEUTRAL, lw=0.7,
        label="fails", rasterized=cloud,
    )  # fmt: skip
    ax.set(ylabel="\n".join(wrap(label, 22)), xlim=(-1, len(specs)))
    ax.tick_params(axis="x", labelbottom=False, length=0)
    return ax


def plot_claims(readings: pd.DataFrame, claims: Sequence[str], *, ax: Axes) -> Axes:
    """Draw a row a claim and a column a reading: dark where it holds, pale where it fails.

    What is left white has nothing to judge it by; the legend says so where there is any.

    readings: a column a claim, `yes`, `no` or empty where there is nothing to judge it by.
    """
    at = np.arange(len(readings))
    for y, claim in enumerate(claims):
        for value, colour in (("yes", RIGHT), ("no", PALE)):
            here = at[(readings[claim] == value).to_numpy()]
            if len(here):
                ax.add_artist(_bars(here, y, colour))
    for value, colour in (("holds", RIGHT), ("fails", PALE)):
        ax.plot([], [], marker="s", ls="none", color=colour, label=value)
    if not readings[list(claims)].isin(["yes", "no"]).all(axis=None):
        ax.plot([], [], marker="s", ls="none", mfc="white", mec=NEUTRAL, mew=0.7, label=UNJUDGED)
    ax.set_yticks(np.arange(len(claims)), claims)
    ax.set(ylim=(len(claims) - 0.5, -0.5), xlim=(-1, len(readings)))
    ax.tick_params(axis="y", length=0)
    ax.tick_params(axis="x", labelbottom=False, length=0)
    return ax


def _bars(at: NDArray[np.intp], y: int, colour: str) -> PathPatch:
    """Return bars at places, as one shape; each keeps to its place, neighbours are one bar.

    To be added as an artist: `add_patch` looks for the limits of each, and limits are set here.
    """
    breaks = np.flatnonzero(np.diff(at) > 1)
    left = np.append(at[0], at[breaks + 1]) - 0.5
    right = np.append(at[breaks], at[-1]) + 0.5
    low, high = np.full(len(left), y - 0.36), np.full(len(left), y + 0.36)
    corners = [(left, low), (right, low), (right, high), (left, high), (left, low)]
    vertices = np.stack([np.column_stack(corner) for corner in corners], axis=1)
    codes = [Path.MOVETO, *[Path.LINETO] * 3, Path.CLOSEPOLY]
    return PathPatch(Path(vertices.reshape(-1, 2), codes * len(left)), fc=colour, lw=0)


def plot_choices(specs: pd.DataFrame, levels: Mapping[str, Sequence[str]], *, ax: Axes) -> Axes:
    """Draw which level of each choice every specification has, below its estimate.

    levels: choice -> its levels in order.
    """
    rows: list[tuple[str, str]] = []
    labels: list[str] = []
    edges: list[int] = []
    for choice, values in levels.items():
        edges.append(len(rows))
        for value in values:
            rows.append((choice, value))
            labels.append(f"{choice}: {value}" if value == values[0] else value)
    holds = specs["holds"].to_numpy(dtype=bool)
    for y, (choice, value) in enumerate(rows):
        at = np.flatnonzero(specs[choice].to_numpy() == value)
        for part, colour in ((holds[at], RIGHT), (~holds[at], NEUTRAL)):
            if part.any():
                ax.add_artist(_bars(at[part], y, colour))
    for edge in edges[1:]:
        ax.axhline(edge - 0.5, color=PALE, lw=0.6)
    ax.set_yticks(np.arange(len(rows)), labels)
    ax.set(ylim=(len(rows) - 0.5, -0.5), xlim=(-1, len(specs)))
    ax.set_xlabel(f"{len(specs)} specifications")
    ax.tick_params(axis="y", length=0)
    ax.tick_params(axis="x", labelbottom=False, length=0)
    return ax
