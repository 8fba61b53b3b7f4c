"""Fig. 6: order posterior on ground truth, and hits for each false positive a second."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import binning as drawing
from signkin.figures.style import WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures.points import (
    frame_of,
    group,
    order_points,
    panel_of,
    point,
    pooled_and_signers,
)
from signkin.studies.endres2013.figures.sources import Sources
from signkin.studies.endres2013.single_signs import POWERLAW


def drawn(sources: Sources) -> Drawn:
    """Draw the order posterior above eq. 17."""
    points = data(sources)
    return Drawn(draw(points), points, caption(sources.orders, sources.tests))


def data(sources: Sources) -> pd.DataFrame:
    """Return the points, a series for all trajectories and, where there are few, each group."""
    rows = []
    for name, part in pooled_and_signers(sources.orders, POWERLAW):
        rows += order_points(part, "order posterior", name)
    for name, part in pooled_and_signers(sources.rates, POWERLAW):
        rows += [
            point("ratio", name, row.order, row.hpfpps, y_error=row.hpfpps_se)
            for row in part.itertuples()
        ]
    return frame_of(sources.corpus, rows)


def draw(points: pd.DataFrame) -> Figure:
    """Draw both panels."""
    figure, axes = plt.subplots(2, 1, figsize=(WIDTH_IN, 5.2))
    drawing.plot_orders(panel_of(points, "order posterior"), ax=axes[0])
    drawing.plot_ratio(panel_of(points, "ratio"), ax=axes[1])
    return figure


def caption(orders: pd.DataFrame, tests: pd.DataFrame) -> str:
    """Return what stands below the figure. tests: table `order_tests`."""
    told = "; ".join(
        f"{row.test}, {row.question}: "
        + (f"statistic {row.statistic:.1f}, p = {row.p:.1e}" if not row.note else str(row.note))
        for row in tests.itertuples()
    )
    n = int(group(orders, POWERLAW)["n"].max())
    return (
        f"{n} power-law ground-truth trajectories. Top: mean order posterior ± standard error. "
        "Bottom: hit rate over false positives a second (eq. 17), pooled over trajectories, ± "
        f"bootstrap standard error; no mark where there was no false positive. {told}."
    )
