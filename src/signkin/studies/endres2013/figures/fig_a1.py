"""Fig. A1: what is recovered from trajectories fitted with each order (section A.1)."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from signkin.figures import binning as drawing
from signkin.figures.style import WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures.fig03 import KINDS
from signkin.studies.endres2013.figures.points import (
    chance_points,
    frame_of,
    group,
    hit_points,
    order_points,
    panel_of,
    told_orders,
)
from signkin.studies.endres2013.figures.sources import Sources
from signkin.studies.endres2013.posteriors import FITTED, FITTED_MAP

COLUMNS = 4


def drawn(sources: Sources) -> Drawn:
    """Draw the recovery of each order."""
    fitted = sources.orders[sources.orders["dataset"] == FITTED]
    orders = sorted(int(order) for order in fitted["true_order"].unique())
    points = data(sources, orders)
    return Drawn(draw(points, orders), points, caption(fitted))


def _panels(order: int) -> tuple[str, str]:
    """Return the names of the panels of an order: posterior, hit rates."""
    return f"P, order {order}", f"hits, order {order}"


def data(sources: Sources, orders: list[int]) -> pd.DataFrame:
    """Return the points, two panels an order that trajectories were fitted with."""
    rows = []
    for true in orders:
        upper, lower = _panels(true)
        for kind, series in KINDS.items():
            rows += order_points(group(sources.orders, kind, true), upper, series)
            rows += hit_points(group(sources.rates, kind, true), lower, series)
        rows += chance_points(group(sources.lines, FITTED, true), lower)
    return frame_of(sources.corpus, rows)


def draw(points: pd.DataFrame, orders: list[int]) -> Figure:
    """Draw blocks of two rows: order posteriors above hit rates."""
    blocks = -(-len(orders) // COLUMNS)
    figure, axes = plt.subplots(
        2 * blocks, COLUMNS, figsize=(WIDTH_IN * 1.35, 3.6 * blocks), squeeze=False
    )
    pairs = [(axes[2 * (i // COLUMNS), i % COLUMNS], axes[2 * (i // COLUMNS) + 1, i % COLUMNS])
             for i in range(blocks * COLUMNS)]  # fmt: skip
    hits = points["panel"].isin([_panels(order)[1] for order in orders])
    marks = points[hits & (points["series"] == KINDS[FITTED_MAP])]
    right = float(np.nanmax([1.0, *marks["x"]])) * 1.12
    for i, (true, (top, bottom)) in enumerate(zip(orders, pairs, strict=False)):
        upper, lower = _panels(true)
        drawing.plot_orders(panel_of(points, upper), ax=top, marked=true, legend=False)
        drawing.plot_hit_rates(panel_of(points, lower), ax=bottom, right=right, legend=False)
        top.set_title(f"true order {true}", loc="left")
        if i % COLUMNS:
            top.set_ylabel("")
            bottom.set_ylabel("")
    spare = [ax for pair in pairs[len(orders) :] for ax in pair]
    for ax in spare:
        ax.set_axis_off()
    _legend(pairs[0], spare[0] if spare else axes[0, 0])
    return figure


def _legend(pair: tuple[Axes, Axes], where: Axes) -> None:
    """Tell the series of both panels of an order in one legend."""
    handles, labels = pair[0].get_legend_handles_labels()
    more, names = pair[1].get_legend_handles_labels()
    where.legend(
        [*handles, *more], [*(f"P: {n}" for n in labels), *names], loc="center left", fontsize=7
    )


def caption(fitted: pd.DataFrame) -> str:
    """Return what stands below the figure. fitted: rows of `order_posteriors`."""
    kept = int(fitted["n"].max()) if len(fitted) else 0
    return (
        f"{kept} recorded trajectories fitted with each order, and binned again with "
        f"{told_orders(fitted['order'])}. Upper rows: order posterior, the red line at the true "
        "order. Lower rows: hit rate "
        "against false positives a second, orders at the marks, in the range of the most probable "
        "segmentation's (marks of the averaged ones may lie outside; figA1.csv has all)."
    )
