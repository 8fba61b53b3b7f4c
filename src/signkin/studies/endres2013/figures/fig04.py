"""Fig. 4: one coordinate of a ground-truth trajectory with fits, and segmentation densities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from signkin.binning.posterior import boundary_times
from signkin.figures import binning as drawing
from signkin.figures.style import ORDER_COLOURS, WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures.points import curve, frame_of, panel_of, point
from signkin.studies.endres2013.figures.sources import Example, Sources
from signkin.studies.endres2013.single_signs import POWERLAW

ORDERS = (0, 3, 6)


@dataclass(frozen=True)
class Shown:
    """What the figure says beside its points.

    axis: the coordinate that varies most, of x, y, z. duration_s: of the trajectory. counts:
    order -> most probable number of boundaries.
    """

    axis: str
    duration_s: float
    counts: Mapping[int, int]


def drawn(sources: Sources) -> Drawn:
    """Draw the example's ground truth, its fits and the densities of their boundaries."""
    example = sources.example
    shown, points = shown_of(example), data(sources.corpus, example)
    return Drawn(draw(points, shown, sources.unit), points, caption(points, example.recording))


def _fits(example: Example) -> tuple[pd.DataFrame, list[int]]:
    """Return the fits of the ground truth by order, and the orders drawn: of these, those run."""
    fits = example.fits[example.fits["dataset"] == POWERLAW].set_index("order")
    return fits, [order for order in ORDERS if order in fits.index]


def shown_of(example: Example) -> Shown:
    """Return what is said of the example."""
    (fits, orders), x = _fits(example), example.powerlaw
    axis = example.axes[int(np.argmax(x.std(axis=0)))]
    counts = {order: int(fits.loc[order, "map_count"]) for order in orders}
    return Shown(axis, len(x) * float(fits["bin_s"].iloc[0]), counts)


def data(corpus: str, example: Example) -> pd.DataFrame:
    """Return the points: the coordinate that varies most, its fits, and the densities."""
    (fits, orders), x = _fits(example), example.powerlaw
    axis = int(np.argmax(x.std(axis=0)))
    bin_s = float(fits["bin_s"].iloc[0])
    sample_at = float(fits["sample_at"].iloc[0])
    time_s = (np.arange(len(x)) + sample_at) * bin_s
    truth = np.asarray(fits["true_boundaries_s"].iloc[0])
    rows = curve("trajectory", "trajectory", time_s, x[:, axis] - x[:, axis].mean())
    for order in orders:
        fit = fits.loc[order]
        expected = np.asarray(fit["expected"]).reshape(x.shape)[:, axis]
        rows += curve("trajectory", f"order {order}", time_s, expected)
        density = np.asarray(fit["boundary_probability"], dtype=float) / bin_s
        ends = boundary_times(range(len(density)), bin_s, sample_at)
        rows += curve(f"order {order}", "density", ends, density)
        rows += [point(f"order {order}", "true boundaries", t, 0) for t in truth]
    rows += [point("trajectory", "true boundaries", t, 0) for t in truth]
    return frame_of(corpus, rows)


def draw(points: pd.DataFrame, shown: Shown, unit: str) -> Figure:
    """Draw the trajectory with its fits above the density of each order."""
    orders = list(shown.counts)
    figure, axes = plt.subplots(
        1 + len(orders), 1, figsize=(WIDTH_IN, 1.9 + 1.15 * len(orders)), sharex=True,
        height_ratios=[1.9, *[1.0] * len(orders)],
    )  # fmt: skip
    drawing.plot_curves(
        panel_of(points, "trajectory"), ax=axes[0],
        colours={f"order {order}": ORDER_COLOURS[order] for order in orders},
        ylabel=f"{shown.axis}, centred ({unit})",
    )  # fmt: skip
    axes[0].set_xlabel("")
    _legend(axes[0], orders)
    for ax, (order, count) in zip(axes[1:], shown.counts.items(), strict=True):
        drawing.plot_density(panel_of(points, f"order {order}"), ORDER_COLOURS[order], ax=ax)
        ax.set_title(f"order {order}: most probable M = {count}", loc="left")
    axes[-1].set_xlabel("time (s)")
    axes[0].set_xlim(0, shown.duration_s)
    return figure


def _legend(ax: Axes, orders: list[int]) -> None:
    for order in orders:
        ax.plot([], [], color=ORDER_COLOURS[order], label=f"order {order}")
    ax.plot([], [], color="0.05", lw=2.2, alpha=0.45, label="trajectory")
    ax.plot([], [], color="0.15", ls=":", label="true boundary")
    ax.legend(loc="best", ncols=2)


def caption(points: pd.DataFrame, recording: str) -> str:
    """Return what stands below the figure."""
    truth = (panel_of(points, "trajectory")["series"] == "true boundaries").sum()
    return (
        f"Power-law ground truth of recording {recording}: the coordinate that "
        "varies most, with posterior expectations; below, the probability density of a boundary. "
        f"{truth} true boundaries, dotted."
    )
