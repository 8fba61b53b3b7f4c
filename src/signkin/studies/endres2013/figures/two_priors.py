"""Fig. 3B, 3C and 5 to 7 of a corpus under two readings of the prior, side by side."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import binning as drawing
from signkin.figures.style import WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures.points import frame_of, hit_points, order_points, point
from signkin.studies.endres2013.posteriors import FITTED_MAP
from signkin.studies.endres2013.single_signs import POWERLAW, RECORDED
from signkin.studies.endres2013.two_priors import FITTED_ORDER, printed_beside, told_prior

TITLES = {
    "3B": "3B  orders of refound order 3 (paper: 3)",
    "3C": "3C  hits on refound order 3",
    "6": "6  orders of ground truth (paper: 3)",
    "7": "7  orders, recorded (paper: 4)",
    "5": "5  hits on ground truth, pooled",
    "ratio": "6  eq. 17 (paper: highest at 3)",
}
MARKED = {"3B": 3.0, "6": 3.0, "7": 4.0}


def drawn(corpus: str, table: pd.DataFrame) -> Drawn:
    """Draw the table `two_priors` of one corpus."""
    points = data(corpus, table)
    return Drawn(draw(points), points, caption(table))


def data(corpus: str, table: pd.DataFrame) -> pd.DataFrame:
    """Return the points, a series a prior."""
    rows = []
    for prior, part in table.groupby("prior", sort=False):
        for panel, dataset in (("3B", FITTED_MAP), ("6", POWERLAW), ("7", RECORDED)):
            rows += order_points(part[part["dataset"] == dataset], panel, str(prior))
        for panel, dataset in (("3C", FITTED_MAP), ("5", POWERLAW)):
            rows += hit_points(part[part["dataset"] == dataset], panel, str(prior))
        rows += [
            point("ratio", str(prior), row.order, row.hpfpps)
            for row in part[part["dataset"] == POWERLAW].itertuples()
        ]
    return frame_of(corpus, rows)


def draw(points: pd.DataFrame) -> Figure:
    """Draw six panels, both readings in each; panels without a point say so."""
    figure, axes = plt.subplots(3, 2, figsize=(WIDTH_IN, 8.2))
    for ax, (panel, title) in zip(axes.flat, TITLES.items(), strict=True):
        part = points[points["panel"] == panel]
        ax.set_title(title, loc="left", fontsize=8)
        if part["y"].notna().sum() == 0:
            ax.text(0.5, 0.5, "nothing to draw", ha="center", va="center", color="0.5",
                    transform=ax.transAxes)  # fmt: skip
            ax.set_axis_off()
        elif panel in MARKED:
            drawing.plot_orders(part, ax=ax, marked=MARKED[panel])
        elif panel == "ratio":
            drawing.plot_ratio(part, ax=ax)
        else:
            drawing.plot_hit_rates(part, ax=ax, by="series", legend=False)
            for row in part.itertuples():
                ax.annotate(row.label, (row.x, row.y), xytext=(4, 3), fontsize=6,
                            textcoords="offset points", color="0.3")  # fmt: skip
    _one_legend(figure)
    return figure


def _one_legend(figure: Figure) -> None:
    """Put the panels' legends, which say the same, below all of them once."""
    legends = [legend for ax in figure.axes if (legend := ax.get_legend()) is not None]
    for legend in legends[1:]:
        legend.remove()
    if legends:
        handles = [h for h in legends[0].legend_handles if h is not None]
        labels = [told_prior(text.get_text()) for text in legends[0].get_texts()]
        legends[0].remove()
        figure.legend(handles, labels, loc="outside lower center", ncols=1)


def caption(table: pd.DataFrame) -> str:
    """Return what stands below the figure."""
    priors = " and under ".join(
        f"{told_prior(prior)} (`{prior}`)" for prior in dict.fromkeys(table["prior"])
    )
    told = "; ".join(
        f"{row.what}: {row[4] or 'none'} and {row[5] or 'none'} (paper: {row.printed})"
        for row in printed_beside(table).itertuples()
        if "peak" in row.what  # the others stand in the table
    )
    n = int(table.loc[table["dataset"] == RECORDED, "n"].max())
    return (
        f"Fig. 3 to 7 on {n} recordings under {priors}, in this order; trajectories of order "
        f"{FITTED_ORDER} are the most probable ones. Red lines: the paper's order. {told}."
    )
