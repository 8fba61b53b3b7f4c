"""Results over settings that a paper does not print: one mark a setting."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from signkin.figures.style import NEUTRAL, SETTING_COLOURS

CLOUD = 2000  # settings that are saved as a picture, which takes 40 MB a panel
MARKERS = ("v", "o", "^", "s", "D")
PRINTED: dict[str, Any] = {
    "marker": "o", "ms": 8, "mfc": "none", "mec": "0.1", "mew": 0.9, "ls": "none", "zorder": 4,
}  # fmt: skip
DEFAULT: dict[str, Any] = {
    "marker": "*", "ms": 13, "mfc": "white", "mec": "0.1", "mew": 0.9, "ls": "none", "zorder": 3,
}  # fmt: skip


def plot_settings(
    points: pd.DataFrame, column: str, *, ax: Axes, groups: Sequence[str], colour: str, marker: str,
    paper: float | None = None, whole: pd.DataFrame | None = None,
) -> Axes:  # fmt: skip
    """Draw one outcome of all settings in columns, one a group; grey bars between them.

    points: rows of the table `order_choices`, with a column `group`. colour, marker: columns
    whose values are told by colour and by shape. paper: the printed value, a dashed line. whole:
    the rows that colours and shapes are dealt out over, where `points` are a part of them.
    """
    dealt = points if whole is None else whole
    colours = _kinds(dealt[colour], SETTING_COLOURS)
    shapes = _kinds(dealt[marker], MARKERS)
    spread = np.linspace(-0.33, 0.33, max(len(colours) * len(shapes), 2))
    places = {(c, m): x for (c, m), x in zip(product(colours, shapes), spread, strict=False)}
    for (c, m), place in places.items():
        kind = (points[colour].astype(str) == c) & (points[marker].astype(str) == m)
        here = points[kind & points[column].notna()]
        if here.empty:
            continue
        at = here["group"].map(groups.index).astype(float) + place
        for flag, ring in (("printed", PRINTED), ("default", DEFAULT)):
            told = here[flag] == "yes"
            if told.any():
                ax.plot(at[told], here.loc[told, column], **ring)
        ax.plot(
            at, here[column], shapes[m], ms=3.6, color=colours[c], mec="none", alpha=0.9, zorder=5,
            rasterized=len(dealt) > CLOUD,
        )  # fmt: skip
    if paper is not None:
        ax.axhline(paper, color="0.3", ls="--", lw=0.9, zorder=1)
    for edge in range(1, len(groups)):
        ax.axvline(edge - 0.5, color="0.88", lw=0.8, zorder=0)
    ax.margins(y=0.16)  # rings at the highest and lowest values stay whole
    ax.set_xlim(-0.5, len(groups) - 0.5)
    ax.set_xticks(range(len(groups)), groups)
    return ax


def handles(
    points: pd.DataFrame, colour: str, marker: str, names: Mapping[str, str]
) -> list[Line2D]:
    """Return legend handles; names: column -> what it is called."""
    out = [
        Line2D([], [], ls="none", marker="o", ms=4, color=c, label=f"{names[colour]} {value}")
        for value, c in _kinds(points[colour], SETTING_COLOURS).items()
    ]
    out += [
        Line2D([], [], ls="none", marker=m, ms=4, color=NEUTRAL, label=f"{names[marker]} {value}")
        for value, m in _kinds(points[marker], MARKERS).items()
    ]
    out.append(Line2D([], [], label="as printed", **PRINTED))
    out.append(Line2D([], [], label="default", **{**DEFAULT, "ms": 11}))
    out.append(Line2D([], [], color="0.3", ls="--", lw=0.9, label="paper"))
    return out


def _kinds(values: pd.Series, palette: Sequence[str]) -> dict[str, str]:
    kinds = list(dict.fromkeys(str(value) for value in values))
    return {kind: palette[i % len(palette)] for i, kind in enumerate(kinds)}
