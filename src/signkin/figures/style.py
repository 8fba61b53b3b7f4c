"""How every figure looks, and how it is saved: the same bytes each time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from signkin.figures.fonts import cut_fonts

# As in the papers: the right hand blue, the left one red, the annotator green.
RIGHT = "#1f5fa8"
LEFT = "#c8322b"
MANUAL = "#2e8b3d"
NEUTRAL = "#5a5a5a"
PALE = "#b9c4d0"
ACCENT = "#d98a1f"
VIOLET = "#8a4f9e"
TEAL = "#1a9aa8"
HAND_COLOURS = {"right": RIGHT, "left": LEFT}
# Endres et al. 2013. Series: bars and marks of groups of trajectories (Fig. 3, 6, 7, A1), and the
# segments of Fig. 2; orders: fits and densities (Fig. 3A, 4); segments of the ground truth
# (Fig. 1); settings of what is not printed.
SERIES_COLOURS = (RIGHT, ACCENT, MANUAL, LEFT, VIOLET, TEAL)
SERIES_MARKERS = ("o", "s", "^", "D", "v", "P")
ORDER_COLOURS = {0: LEFT, 3: RIGHT, 6: TEAL}
SEGMENT_COLOURS = (RIGHT, ACCENT, MANUAL, VIOLET, NEUTRAL)
SETTING_COLOURS = (RIGHT, MANUAL, ACCENT, LEFT, VIOLET, TEAL, NEUTRAL)

STYLE = Path(__file__).with_name("paper.mplstyle")
PLACES = 6  # decimals of a place in a figure
WIDTH_IN = 6.9  # a text column of 175 mm
NO_LAYOUT = {"figure.constrained_layout.use": False, "figure.autolayout": False}
SPEED_UNITS = {"m": "m/s", "px": "px/s"}


@contextmanager
def paper_style() -> Iterator[None]:
    """Set fonts, lines and reproducible SVG identifiers for the figures drawn inside."""
    with mpl.rc_context(fname=STYLE):
        yield


def save(figure: Figure, svg: str | Path, pdf: str | Path) -> None:
    """Write a figure as SVG and PDF, without the date that would change every time."""
    settle(figure)
    with mpl.rc_context(NO_LAYOUT):  # saving sets the layout engine that there was, or the style's
        figure.savefig(svg, metadata={"Date": None, "Creator": "signkin"})
        told = {"CreationDate": None, "Creator": "signkin", "Producer": None}
        with cut_fonts():
            figure.savefig(pdf, metadata=told)
    plt.close(figure)


def settle(figure: Figure) -> None:
    """Lay a figure out once, and round where its axes came to lie.

    The constrained layout's solver adds up in an order that goes by places in memory: last
    digits differ from run to run, and SVG identifiers are made of them. Nothing is drawn for it,
    unless axes keep a ratio, which drawing alone brings about; and no engine is left: with one,
    even if it does nothing, matplotlib draws twice a file.
    """
    engine = figure.get_layout_engine()
    if any(ax.get_aspect() != "auto" or ax.get_box_aspect() is not None for ax in figure.axes):
        figure.draw_without_rendering()
    elif engine is not None:
        engine.execute(figure)
    with mpl.rc_context(NO_LAYOUT):
        figure.set_layout_engine(None)
    for ax in figure.axes:
        for which in ("original", "active"):
            place = ax.get_position(original=which == "original")
            ax.set_position(np.round(place.bounds, PLACES).tolist(), which=which)
