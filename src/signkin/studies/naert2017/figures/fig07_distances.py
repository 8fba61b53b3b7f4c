"""Fig. 7: duration over the mean of the two normalised distances."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.corpus import Corpus
from signkin.figures import distance
from signkin.report.drawn import Drawn
from signkin.statistics import descriptive

DISTANCES = {
    "recorded": "Geodesic and Euclidean distance, whole body.",
    "limb_frames": "Geodesic distance of limb and palm frames (no recorded orientations) and "
    "Euclidean distance, whole body.",
    "none": "Euclidean distance only: the corpus has no orientations.",
}


def drawn(corpus: Corpus, points: pd.DataFrame, outlier_iqr: float) -> Drawn:
    """Draw the table `distances`; outlier_iqr: config's transitions.outlier_iqr."""
    known = with_distance(points)
    x, y = (known[c].to_numpy(dtype=float) for c in ("mean_distance", "duration_s"))
    line = descriptive.trend(x, y)
    source = corpus.settings["motion"].get("orientations", "none")
    return Drawn(draw(known, line), points, caption(points, line, outlier_iqr, source))


def with_distance(points: pd.DataFrame) -> pd.DataFrame:
    """Return the transitions that have a distance: the drawn ones."""
    return points[points["mean_distance"].notna()]


def draw(known: pd.DataFrame, line: descriptive.Trend | None) -> Figure:
    """Draw transitions and their least-squares line."""
    figure, ax = plt.subplots(figsize=(4.6, 3.4))
    distance.plot_distances(known, None if line is None else (line.slope, line.intercept), ax=ax)
    return figure


def caption(
    points: pd.DataFrame, line: descriptive.Trend | None, outlier_iqr: float, source: str
) -> str:
    """Tell numbers, line and outliers; source: of orientations, as corpus.yaml names it."""
    told = [
        "Duration of the transitions over the mean of the two normalised distances; "
        f"{counts(points)}."
    ]
    if line is not None:
        told.append(f"Least-squares line: {line.slope:.3f} s a unit, Pearson r = {line.r:.2f}.")
    outliers = int(with_distance(points)["outlier"].sum())
    told.append(
        f"Outliers: {outliers}, more than {outlier_iqr:g} interquartile ranges outside the "
        f"quartiles. {DISTANCES[source]}"
    )
    return " ".join(told)


def counts(points: pd.DataFrame) -> str:
    """Tell how many transitions are drawn, and how many have no distance."""
    known = len(with_distance(points))
    text = f"n = {known} transitions between manual tags"
    without = len(points) - known
    return text + (f" ({without} more have no distance: gaps in the motion)" if without else "")
