"""What the paper does not print, varied: outcomes of all settings beside the printed ones."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import order_choices as drawing
from signkin.figures.style import WIDTH_IN
from signkin.report.drawn import Drawn

OUTCOMES: dict[str, tuple[str, float | None]] = {
    "mean_count_order_0": ("mean M, order 0", 13),
    "mean_count_order_3": ("mean M, order 3", 7),
    "mean_count_order_7": ("mean M, order 7", 2),
    "explained_variance_order_3": ("explained variance,\norder 3", 0.99),
    "order_peak_recorded": ("order peak,\nrecorded", 4),
    "order_peak_powerlaw": ("order peak,\nground truth", 3),
    "hit_rate_order_3": ("hit rate,\nground truth", None),
    "hpfpps_order_3": ("hits / false pos.\na second (s)", None),
    "recovered_hit_rate": ("hit rate, refound\norder 3", 1.0),
}
MOST_COLUMNS = 12  # whose labels can be read at the usual width
PANEL_IN = (1.15, 0.85)  # height of a panel: of one band of columns, of several


def drawn(frame: pd.DataFrame) -> Drawn:
    """Draw the table `order_choices` of one corpus."""
    return Drawn(draw(frame), frame, caption(frame))


def draw(frame: pd.DataFrame) -> Figure:
    """Draw the table `order_choices` of one corpus; points on one another differ in bins alone."""
    points = frame.copy()
    points["group"] = points["noise"].str.replace(" ", "\n") + "\n" + points["time_unit"]
    groups = list(dict.fromkeys(points["group"]))
    bands = _bands(groups)
    height = PANEL_IN[len(bands) > 1] * len(OUTCOMES) + 0.6
    figure, axes = plt.subplots(
        len(OUTCOMES) * len(bands), 1, figsize=(WIDTH_IN * 1.25, len(bands) * height + 0.6)
    )
    for b, band in enumerate(bands):
        rows = points[points["group"].isin(band)]
        for o, (column, (label, paper)) in enumerate(OUTCOMES.items()):
            ax = axes[b * len(OUTCOMES) + o]
            drawing.plot_settings(
                rows, column, ax=ax, groups=band, colour="dof", marker="concentration",
                paper=paper, whole=points,
            )  # fmt: skip
            if b:
                ax.sharey(axes[o])
            if column.startswith("mean_count"):
                ax.set_yscale("symlog", linthresh=10, linscale=2)  # few find a boundary a bin
                ax.set_yticks([0, 5, 10, 100], ["0", "5", "10", "100"])
                ax.set_ylim(-1.5, 160)
            ax.set_ylabel(label, fontsize=7.5 if len(bands) == 1 else 6.5)
            ax.tick_params(axis="x", labelsize=7, labelbottom=column == list(OUTCOMES)[-1])
    figure.legend(
        handles=drawing.handles(
            points, "dof", "concentration", {"dof": "dof", "concentration": "b"}
        ),
        loc="outside upper center", ncols=5,
    )  # fmt: skip
    return figure


def _bands(groups: list[str]) -> list[list[str]]:
    """Return the columns in bands, one below the other, of as many columns as labels allow."""
    return [groups[i : i + MOST_COLUMNS] for i in range(0, len(groups), MOST_COLUMNS)]


def caption(frame: pd.DataFrame) -> str:
    """Return what a figure of the table says below it."""
    n = len(frame)
    peaks = frame["order_peak_recorded"].value_counts().sort_index()
    told = ", ".join(f"{int(order)} in {count}" for order, count in peaks.items())
    seven = int((frame["mean_count_order_3"].round() == 7).sum())
    paper = frame[(frame["order_peak_recorded"] == 4)]
    printed = frame[frame["printed"] == "yes"]
    return (
        f"{n} settings of what section 3.2 leaves open, on "
        f"{int(frame['recordings'].max())} recordings: degrees of freedom (colour), "
        "concentration b (shape), noise and its scale, unit of time (columns), T = "
        f"{', '.join(str(b) for b in sorted(frame['bins'].unique()))} bins (two marks each). The "
        f"{len(printed)} ringed ones agree with all that is printed. The order posterior of "
        f"recorded trajectories peaks at order {told} settings; {len(paper)} settings peak at 4 "
        f"as the paper's, and {seven} have a mean M of 7 at order 3, "
        f"{int((paper['mean_count_order_3'].round() == 7).sum())} both."
    )
