"""A figure that says why there is nothing to draw."""

from __future__ import annotations

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from signkin.figures import style


def notice(text: str) -> Figure:
    """Return a figure that holds a sentence."""
    figure, ax = plt.subplots(figsize=(style.WIDTH_IN, 1))
    ax.text(0.5, 0.5, text, ha="center", va="center")
    ax.set_axis_off()
    return figure
