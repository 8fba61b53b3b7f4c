"""Specification curves: an estimate under every combination of open choices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import wrap

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from signkin.figures.style import ACCENT, NEUTRAL, PALE, RIGHT


def plot_estimates(specs: pd.DataFrame, label: str, zero: bool = False, *, ax: Axes) -> Axes:
    """Draw the estimates in their order, filled where the claim holds.

    specs: columns estimate, reference (NaN for none), holds; one row a specification.
    """
    at = np.arange(len(specs))
    holds = specs["holds"].to_numpy(dtype=bool)
    size = float(np.clip(900 / max(len(specs), 1), 5, 22))
    values = specs["estimate"].to_numpy(dtype=float)
    bounds = specs["reference"].to_numpy(dtype=float)
    if np.isfinite(bounds).any():
        ax.scatter(at, bounds, marker="_", s=2 * size, color=ACCENT, lw=1, label="bound")
    elif zero:
        ax.axhline(0, color="0.6", lw=0.8)
    ax.scatter(at[holds], values[holds], s=size, color=RIGHT, lw=0, label="holds")
    ax.scatter(
        at[~holds], values[~holds], s=size, facecolor="white", edgecolor=NEUTRAL, lw=0.7,
        label="fails",
    )  # fmt: skip
    ax.set(ylabel="\n".join(wrap(label, 22)), xlim=(-1, len(specs)))
    ax.tick_params(axis="x", labelbottom=False, length=0)
    return ax


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
            ax.vlines(at[part], y - 0.36, y + 0.36, color=colour, lw=0.9)
    for edge in edges[1:]:
        ax.axhline(edge - 0.5, color=PALE, lw=0.6)
    ax.set_yticks(np.arange(len(rows)), labels)
    ax.set(ylim=(len(rows) - 0.5, -0.5), xlim=(-1, len(specs)))
    ax.set_xlabel(f"{len(specs)} specifications")
    ax.tick_params(axis="y", length=0)
    ax.tick_params(axis="x", labelbottom=False, length=0)
    return ax
