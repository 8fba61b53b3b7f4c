"""Histograms of samples that a printed mean and SD allow."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from signkin.figures.style import NEUTRAL, PALE

MOST_TICKS = 9


def plot_copies(
    values: Sequence[str], copies: Sequence[tuple[float, float, float]], ax: Axes
) -> None:
    """Draw how often each value stands in samples: the mean as a bar, least to most as a line.

    values: a value or a class of values each; copies: (least, mean, most) of each.
    """
    at = np.arange(len(values))
    least, mean, most = np.array(copies, dtype=float).T
    ax.bar(at, mean, width=0.9, color=PALE)
    ax.vlines(at, least, most, color=NEUTRAL, linewidth=1)
    step = -(-len(values) // MOST_TICKS)
    ax.set_xticks(at[::step], [name.partition(" to ")[0] for name in values[::step]])
    ax.set_ylim(bottom=0)
