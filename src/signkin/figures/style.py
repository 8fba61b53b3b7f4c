"""How every figure looks, and how it is saved: the same bytes each time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import seaborn as sns
from matplotlib.figure import Figure

# As in the papers: the right hand blue, the left one red, the annotator green.
RIGHT = "#1f5fa8"
LEFT = "#c8322b"
MANUAL = "#2e8b3d"
NEUTRAL = "#5a5a5a"
PALE = "#b9c4d0"
ACCENT = "#d98a1f"
HAND_COLOURS = {"right": RIGHT, "left": LEFT}

PLACES = 6  # decimals of a place in a figure
WIDTH_IN = 6.9  # a text column of 175 mm
SPEED_UNITS = {"m": "m/s", "px": "px/s"}


@contextmanager
def paper_style() -> Iterator[None]:
    """Set fonts, lines and reproducible SVG identifiers for the figures drawn inside."""
    settings = {
        "svg.hashsalt": "signkin",
        "pdf.fonttype": 42,
        "savefig.dpi": 250,  # of what is rasterized: clouds of points, nothing else
        "font.family": "DejaVu Sans",
        "font.size": 8.5,
        "axes.titlesize": 9,
        "axes.labelsize": 8.5,
        "legend.fontsize": 7.5,
        "xtick.labelsize": 8,
        "ytick.labelsize": 8,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "figure.constrained_layout.use": True,
    }
    with sns.axes_style("ticks"), mpl.rc_context(settings):
        yield


def save(figure: Figure, svg: str | Path, pdf: str | Path) -> None:
    """Write a figure as SVG and PDF, without the date that would change every time."""
    settle(figure)
    figure.savefig(svg, metadata={"Date": None, "Creator": "signkin"})
    figure.savefig(pdf, metadata={"CreationDate": None, "Creator": "signkin", "Producer": None})
    plt.close(figure)


def settle(figure: Figure) -> None:
    """Lay a figure out once, and round where its axes came to lie.

    The constrained layout's solver adds up in an order that goes by places in memory: last
    digits differ from run to run, and SVG identifiers are made of them.
    """
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for ax in figure.axes:
        for which in ("original", "active"):
            place = ax.get_position(original=which == "original")
            ax.set_position(np.round(place.bounds, PLACES).tolist(), which=which)
