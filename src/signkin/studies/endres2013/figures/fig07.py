"""Fig. 7: order posterior of the recorded trajectories."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures.binning import plot_orders
from signkin.figures.style import WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures.points import (
    frame_of,
    group,
    order_points,
    pooled_and_signers,
)
from signkin.studies.endres2013.figures.sources import Sources
from signkin.studies.endres2013.single_signs import RECORDED


def drawn(sources: Sources) -> Drawn:
    """Draw the order posterior."""
    points = data(sources)
    return Drawn(draw(points), points, caption(sources.orders))


def data(sources: Sources) -> pd.DataFrame:
    """Return the points, a series for all trajectories and, where there are few, each group."""
    rows = []
    for name, part in pooled_and_signers(sources.orders, RECORDED):
        rows += order_points(part, "order posterior", name)
    return frame_of(sources.corpus, rows)


def draw(points: pd.DataFrame) -> Figure:
    """Draw bars over orders."""
    figure, ax = plt.subplots(figsize=(WIDTH_IN * 0.8, 2.9))
    plot_orders(points, ax=ax)
    return figure


def caption(orders: pd.DataFrame) -> str:
    """Return what stands below the figure. orders: table `order_posteriors`."""
    pooled = group(orders, RECORDED).set_index("order")
    share = float(pooled["mean_probability"].reindex([3, 4, 5]).sum())
    return (
        f"{int(pooled['n'].max())} recorded trajectories, mean order posterior ± standard error. "
        f"Peak at order {int(pooled['mean_probability'].idxmax())}; P(3 ≤ S ≤ 5) = {share:.3f} "
        "(paper: peak at 4, above 0.95)."
    )
