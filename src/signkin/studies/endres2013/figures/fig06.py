"""Fig. 6: order posterior on ground truth, hits for each false positive a second, and chance."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import binning as drawing
from signkin.figures.style import WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.statistics.findings import p_text
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

# Kind of chance -> the columns of eq. 17 by chance, and of the hit rate without it.
CHANCE = (
    ("Poisson events", "chance_hpfpps", "over_chance"),
    ("boundaries shifted", "shifted_hpfpps", "over_shifted"),
)


def drawn(sources: Sources) -> Drawn:
    """Draw the order posterior above eq. 17, and hit rates less those of chance."""
    points = data(sources)
    return Drawn(draw(points), points, caption(sources.orders, sources.rates, sources.tests))


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
    pooled = group(sources.rates, POWERLAW)
    for name, ratio, over in CHANCE:
        for row in pooled.to_dict("records"):
            rows.append(point("ratio by chance", name, row["order"], row[ratio]))
            error = row["hit_rate_se"]
            rows.append(point("over chance", name, row["order"], row[over], y_error=error))
    return frame_of(sources.corpus, rows)


def draw(points: pd.DataFrame) -> Figure:
    """Draw the three panels."""
    figure, axes = plt.subplots(3, 1, figsize=(WIDTH_IN, 7.6))
    drawing.plot_orders(panel_of(points, "order posterior"), ax=axes[0])
    drawing.plot_ratio(
        panel_of(points, "ratio"), ax=axes[1], chance=panel_of(points, "ratio by chance")
    )
    drawing.plot_over_chance(panel_of(points, "over chance"), ax=axes[2])
    return figure


def caption(orders: pd.DataFrame, rates: pd.DataFrame, tests: pd.DataFrame) -> str:
    """Return what stands below the figure. rates, tests: tables `hit_rates`, `order_tests`."""
    told = "; ".join(
        f"{row.test}, {row.question}: "
        + (f"statistic {row.statistic:.1f}, {p_text(row.p)}" if not row.note else str(row.note))
        for row in tests.itertuples()
    )
    n = int(group(orders, POWERLAW)["n"].max())
    return (
        f"{n} power-law ground-truth trajectories. Top: mean order posterior ± standard error. "
        "Middle: hit rate over false positives a second (eq. 17), pooled over trajectories, ± "
        "bootstrap standard error; no mark where there was no false positive. Lines: what chance "
        "gives, Poisson events with as many false positives, and the same boundaries, each "
        "trajectory's shifted in a circle, so that they keep their number and spacing. It is not "
        "the same at all orders: fewer boundaries make a larger ratio by themselves. Bottom: hit "
        f"rate less that of chance{_peaks(rates)}, ± standard error of the hit rate. {told}."
    )


def _peaks(rates: pd.DataFrame) -> str:
    """Return at which orders what is left over chance is greatest."""
    pooled = group(rates, POWERLAW).set_index("order")
    told = [
        f"{name}: order {pooled[over].idxmax()}, {pooled[over].max():.3f}"
        for name, _, over in CHANCE if pooled[over].notna().any()
    ]  # fmt: skip
    return f" (greatest against {'; '.join(told)})" if told else ""
