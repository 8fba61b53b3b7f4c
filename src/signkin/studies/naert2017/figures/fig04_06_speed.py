"""Fig. 4, 5 and 6: wrist speed with manual tags, and with speed minima or refined tags."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin.coarticulation.excerpts import RULES, Excerpt, excerpt_points
from signkin.corpus import Corpus
from signkin.figures import speed, style
from signkin.report.drawn import Drawn
from signkin.settings.sections import Lowpass

REFINED = ("fig06",)  # shows refined tags; the others show minima


def drawn(
    corpus: Corpus,
    stem: str,
    excerpt: Excerpt,
    boundaries: pd.DataFrame,
    minima: pd.DataFrame,
    frames: Sequence[Path],
    lowpass: Lowpass,
) -> Drawn:
    """Draw an excerpt. frames: files of the kinematics."""
    kinematics = speeds_of(excerpt.recording, frames, corpus.unit)
    rate_hz = 1.0 / float(np.median(np.diff(kinematics["time_s"])))
    points = data(corpus, excerpt, kinematics, boundaries, minima)
    marks = "refined" if stem in REFINED else "minima"
    return Drawn(
        draw(points, corpus.unit, round(rate_hz, 3), marks),
        points,
        caption(excerpt, corpus.unit, marks, lowpass),
    )


def speeds_of(recording: str, frames: Sequence[Path], unit: str) -> pd.DataFrame:
    """Return time_s, right, left: both wrists' speed in a recording."""
    column = f"speed_{unit}_per_s"
    return pd.read_parquet(
        [str(path) for path in frames],
        columns=["recording", "time_s", f"right_{column}", f"left_{column}"],
        filters=[("recording", "==", recording)],
    ).rename(columns={f"right_{column}": "right", f"left_{column}": "left"})


def data(
    corpus: Corpus,
    excerpt: Excerpt,
    kinematics: pd.DataFrame,
    boundaries: pd.DataFrame,
    minima: pd.DataFrame,
) -> pd.DataFrame:
    """Return the table `excerpt`; kinematics: as `speeds_of` returns them."""
    column = f"speed_{corpus.unit}_per_s"
    points = excerpt_points(excerpt, kinematics, boundaries, minima, column)
    points.insert(0, "corpus", corpus.name)
    return points


def draw(points: pd.DataFrame, unit: str, rate_hz: float, marks: str) -> Figure:
    """Draw the table `excerpt`; marks: minima or refined."""
    figure, ax = plt.subplots(figsize=(style.WIDTH_IN, 3.3))
    speed.plot_speed(points, unit, rate_hz, ax=ax, marks=marks)
    return figure


def caption(excerpt: Excerpt, unit: str, marks: str, lowpass: Lowpass) -> str:
    """Tell what is drawn, how it was filtered, and by which rule it was chosen."""
    what = "refined tags of each hand" if marks == "refined" else "local minima of each hand"
    return (
        f"Speed of the right (blue) and left (red) wrist in {style.SPEED_UNITS[unit]}, recording "
        f"{excerpt.recording}, {excerpt.from_s:.2f}-{excerpt.to_s:.2f} s; manual tags green, "
        f"{what}. Low-pass: {lowpass.method}, half gain at {lowpass.cutoff_hz:g} Hz, no "
        f"delay. Excerpt: {RULES[excerpt.rule]}."
    )
