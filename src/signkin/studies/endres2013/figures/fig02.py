"""Fig. 2: the model, a scheme of segments."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures.binning import plot_scheme
from signkin.figures.style import WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures.points import frame_of, point

ENDS = (4, 8, 14)  # last bins of the segments; 15 bins
CAPTION = (
    "A trajectory of T bins is cut into M + 1 segments by M inner boundaries; the mean "
    "of segment m is a polynomial of order S in the time since its start, its noise has a "
    "full covariance. Sums over all segmentations are exact."
)


def drawn() -> Drawn:
    """Draw the scheme."""
    points = data()
    return Drawn(draw(points), points, CAPTION)


def data() -> pd.DataFrame:
    """Return the boundaries drawn, at the ends of their bins."""
    rows = [point("scheme", "boundaries", q + 1, 0, label=f"q_{m}") for m, q in enumerate(ENDS)]
    return frame_of("", rows)


def draw(points: pd.DataFrame) -> Figure:
    """Draw segments with these boundaries; the last one ends the last bin."""
    ends = [int(end) - 1 for end in points["x"]]
    figure, ax = plt.subplots(figsize=(WIDTH_IN, 2.6))
    plot_scheme(ends, ends[-1] + 1, ax=ax)
    return figure
