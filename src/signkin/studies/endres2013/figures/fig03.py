"""Fig. 3: trajectories fitted with order 3, and what binning recovers from them."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import binning as drawing
from signkin.figures.style import ORDER_COLOURS, WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures.points import (
    Row,
    chance_points,
    curve,
    frame_of,
    group,
    hit_points,
    order_points,
    panel_of,
    point,
)
from signkin.studies.endres2013.figures.sources import Example, Sources
from signkin.studies.endres2013.posteriors import FITTED, FITTED_MAP
from signkin.studies.endres2013.single_signs import RECORDED

FITTED_ORDER = 3
KINDS = {FITTED: "averaged", FITTED_MAP: "most probable"}
TITLES = {
    "A": "A  recorded (grey) and order 3 (red)", "B": "B  order posterior of fitted trajectories",
    "C": "C  hit rates of fitted trajectories", "D": "D  explained variance, mean M below",
}  # fmt: skip


def drawn(sources: Sources) -> Drawn:
    """Draw fitted trajectories and what binning recovers from them."""
    points = data(sources)
    return Drawn(draw(points, sources.unit), points, caption(sources))


def data(sources: Sources) -> pd.DataFrame:
    """Return the points: A the example and its fit, B and C the recovery, D the fits of all."""
    rows = _fit_rows(sources.example)
    for kind, series in KINDS.items():
        rows += order_points(group(sources.orders, kind, FITTED_ORDER), "B", series)
        rows += hit_points(group(sources.rates, kind, FITTED_ORDER), "C", series)
    rows += chance_points(group(sources.lines, FITTED, FITTED_ORDER), "C")
    rows += [
        point(
            "D", "explained variance", row.order, row.mean_explained_variance,
            y_error=row.sd_explained_variance, label=f"{row.mean_count:.1f}",
        )
        for row in group(sources.orders, RECORDED).itertuples()
    ]  # fmt: skip
    return frame_of(sources.corpus, rows)


def _fit_rows(example: Example) -> list[Row]:
    fits, x = example.fits, example.recorded
    fit = fits[(fits["dataset"] == RECORDED) & (fits["order"] == FITTED_ORDER)].iloc[0]
    time_s = (np.arange(len(x)) + fit["sample_at"]) * fit["bin_s"]
    expected = np.asarray(fit["expected"]).reshape(x.shape)
    centred = x - x.mean(axis=0)
    rows = []
    for i, axis in enumerate(example.axes):
        rows += curve("A", axis, time_s, centred[:, i])
        rows += curve("A", f"{axis}, order {FITTED_ORDER}", time_s, expected[:, i])
    return rows + [point("A", "boundaries", t, 0) for t in fit["boundaries_s"]]


def draw(points: pd.DataFrame, unit: str) -> Figure:
    """Draw the four panels."""
    figure, axes = plt.subplots(2, 2, figsize=(WIDTH_IN, 5.8))
    of = dict(zip(TITLES, axes.flat, strict=True))
    colours = {f"{axis}, order {FITTED_ORDER}": ORDER_COLOURS[0] for axis in "xyz"}
    drawing.plot_curves(
        panel_of(points, "A"), ax=of["A"], colours=colours, ylabel=f"position, centred ({unit})"
    )
    drawing.plot_orders(panel_of(points, "B"), ax=of["B"], marked=FITTED_ORDER)
    drawing.plot_hit_rates(panel_of(points, "C"), ax=of["C"])
    drawing.plot_explained(panel_of(points, "D"), ax=of["D"])
    for name, title in TITLES.items():
        of[name].set_title(title, loc="left")
    return figure


def caption(sources: Sources) -> str:
    """Return what stands below the figure."""
    kept = int(group(sources.orders, FITTED, FITTED_ORDER)["n"].max())
    recorded = int(group(sources.orders, RECORDED)["n"].max())
    return (
        f"A: the coordinates of recording {sources.example.recording}; dotted: its boundaries at "
        f"order 3. B, C: {kept} trajectories fitted with order 3, taken as data: the paper's, "
        "averaged over segmentations, and those of the most probable segmentation, which are "
        "exactly piecewise cubic; both with the prior's noise at binning.recovery_noise. Numbers "
        "at the marks of C are orders; dashed: Poisson events through the same matcher (grey: "
        f"95 %), dotted: the closed form. D: {recorded} recorded trajectories, "
        "± SD; numbers: mean M. Errors in B and C are standard errors."
    )
