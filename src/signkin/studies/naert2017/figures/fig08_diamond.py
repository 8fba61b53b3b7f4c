"""Fig. 8: the diamond that holds most transitions."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import distance
from signkin.report.drawn import Drawn
from signkin.statistics import descriptive
from signkin.studies.naert2017.figures.fig07_distances import counts, with_distance


def drawn(points: pd.DataFrame, shape: descriptive.Diamond | None, share: float) -> Drawn:
    """Draw the table `distances` and the diamond; share: config's transitions.diamond_share."""
    return Drawn(draw(points, shape), points, caption(points, shape, share))


def draw(points: pd.DataFrame, shape: descriptive.Diamond | None) -> Figure:
    """Draw the transitions that have a distance, those outside the diamond hollow."""
    figure, ax = plt.subplots(figsize=(4.6, 3.4))
    distance.plot_diamond(with_distance(points), {} if shape is None else shape.corners, ax=ax)
    return figure


def caption(points: pd.DataFrame, shape: descriptive.Diamond | None, share: float) -> str:
    """Tell how many transitions the diamond holds, and by which rule it was found."""
    held = (
        ""
        if shape is None
        else f" It holds {int(shape.inside.sum())} of {len(with_distance(points))} "
        f"({shape.share:.1%})."
    )
    return (
        f"The smallest diamond that holds more than {share:.0%} "
        f"of the transitions; {counts(points)}.{held} Its sides rise and fall by the ratio of "
        "the two interquartile ranges (the paper prints neither corners nor a rule). Corners in "
        "diamond.csv."
    )
