"""Bayesian binning drawn: fits, order posteriors, hit rates (Endres et al. 2013, Fig. 2 to 7).

Points come as rows of the table `endres_figure` of one panel: series, x, y, errors.
"""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from signkin.figures.style import LEFT, PALE, RIGHT, SERIES_COLOURS, SERIES_MARKERS

CHANCE, CLOSED = "chance", "closed form"
CHANCE_SERIES = (CHANCE, "chance low", "chance high", CLOSED)


def plot_curves(points: pd.DataFrame, *, ax: Axes, colours: dict[str, str], ylabel: str) -> Axes:
    """Draw curves over time; dotted lines stand at the series `boundaries` and `true boundaries`.

    colours: series -> colour, in the order of the legend; others are drawn black.
    """
    for series, rows in points.groupby("series", sort=False):
        name = str(series)
        if name in ("boundaries", "true boundaries"):
            for x in rows["x"]:
                ax.axvline(x, color="0.15", ls=":", lw=1.1)
            continue
        colour = colours.get(name, "0.05")
        width = 1.0 if name in colours else 2.2
        ax.plot(
            rows["x"], rows["y"], color=colour, lw=width, zorder=3 if name in colours else 2,
            alpha=1.0 if name in colours else 0.45,
        )  # fmt: skip
    ax.set(xlabel="time (s)", ylabel=ylabel, xlim=(0, float(points["x"].max())))
    return ax


def plot_density(points: pd.DataFrame, colour: str, *, ax: Axes) -> Axes:
    """Draw the probability density of a boundary over time (Fig. 4, lower panels)."""
    density = points[points["series"] == "density"]
    ax.fill_between(density["x"], density["y"], step="mid", color=colour, alpha=0.35, lw=0)
    ax.step(density["x"], density["y"], where="mid", color=colour, lw=0.9)
    for x in points.loc[points["series"] == "true boundaries", "x"]:
        ax.axvline(x, color="0.15", ls=":", lw=1.1)
    ax.set(xlim=(0, float(points["x"].max())), ylabel="boundaries (1/s)")
    ax.set_ylim(bottom=0)
    return ax


def plot_orders(
    points: pd.DataFrame, *, ax: Axes, marked: float | None = None, legend: bool = True
) -> Axes:
    """Draw bars of a probability over orders, a group of bars for each series (Fig. 3B, 6, 7).

    marked: an order at which a vertical line stands.
    """
    names = list(dict.fromkeys(points["series"]))
    width = 0.8 / len(names)
    for i, name in enumerate(names):
        rows = points[points["series"] == name]
        x = rows["x"] + (i - (len(names) - 1) / 2) * width
        ax.bar(
            x, rows["y"], width * 0.94, yerr=rows["y_error"].fillna(0.0),
            color=SERIES_COLOURS[i % len(SERIES_COLOURS)], label=name, error_kw={"lw": 0.8},
            hatch="///" if i % 2 else None, edgecolor="white", lw=0.3,
        )  # fmt: skip
    if marked is not None:
        ax.axvline(marked, color=LEFT, lw=1.2, zorder=0)
    ax.set(xlabel="polynomial order S", ylabel="P(S | data)", ylim=(0, 1.03))
    ax.set_xticks(sorted(points["x"].unique()))
    if legend and len(names) > 1:
        # The highest bar may stand anywhere: room for the legend above all of them.
        ax.set_ylim(0, 1.08 + 0.11 * -(-len(names) // 2))
        ax.set_yticks(np.linspace(0, 1, 6))
        ax.legend(loc="upper center", ncols=2)
    return ax


def plot_hit_rates(
    points: pd.DataFrame, *, ax: Axes, right: float | None = None, legend: bool = True,
    by: str = "order",
) -> Axes:  # fmt: skip
    """Draw hit rate against false positives a second, one mark an order (Fig. 3C, 5, A1).

    The series `chance` is the line of no discrimination, `chance low` and `chance high` its
    95 % band, `closed form` the Poisson formula. by: marks are coloured by `order`, which is
    written beside them, or by `series`.
    """
    _plot_chance(points, ax)
    # Series are names of signers and signs too: whole names tell the lines from the marks.
    marks = points[~points["series"].isin(CHANCE_SERIES)]
    cmap = mpl.colormaps["cividis"]
    for i, (name, rows) in enumerate(marks.groupby("series", sort=False)):
        marker = SERIES_MARKERS[i % len(SERIES_MARKERS)]
        if by == "order":
            orders = rows["label"].astype(float).to_numpy()
            colours = [cmap(order / max(float(orders.max()), 1.0)) for order in orders]
        else:
            colours = [SERIES_COLOURS[i % len(SERIES_COLOURS)]] * len(rows)
        for row, colour in zip(rows.itertuples(), colours, strict=True):
            ax.errorbar(
                row.x, row.y, xerr=_error(row.x_error), yerr=_error(row.y_error),
                marker=marker, ms=5.5, color=colour, mec="0.2", mew=0.4, lw=0.9, zorder=3 + i,
            )  # fmt: skip
        shown = "0.4" if by == "order" else colours[0]
        ax.plot([], [], marker=marker, ls="none", color=shown, ms=5, label=str(name))
        if by == "order":
            _write_orders(rows, ax)
    if right is None:
        right = float(np.nanmax([1.0, *(marks["x"] + marks["x_error"].fillna(0))])) * 1.12
    ax.set(xlim=(-0.03 * right, right), ylim=(-0.03, 1.06))
    ax.set(xlabel="false positives a second", ylabel="hit rate")
    if legend:
        ax.legend(loc="upper center", bbox_to_anchor=(0.45, -0.2), ncols=2, columnspacing=1.0)
    return ax


def _plot_chance(points: pd.DataFrame, ax: Axes) -> None:
    """Draw the line of no discrimination with its band and the closed form, where there is one."""
    low, high = (points[points["series"] == f"{CHANCE} {end}"]["y"] for end in ("low", "high"))
    line, closed = (points[points["series"] == name] for name in (CHANCE, CLOSED))
    if line.empty:
        return
    ax.fill_between(line["x"], low, high, color=PALE, alpha=0.5, lw=0)
    ax.plot(line["x"], line["y"], color="0.2", ls="--", lw=1.1, label="no discrimination")
    ax.plot(closed["x"], closed["y"], color="0.55", ls=":", lw=1.0, label="1 − exp(−2wλ)")


def _error(value: float) -> float:
    return 0.0 if pd.isna(value) else float(value)


def _write_orders(rows: pd.DataFrame, ax: Axes) -> None:
    """Write the orders beside their marks; marks on one spot share a label."""
    spots: dict[tuple[float, float], list[str]] = {}
    for row in rows.itertuples():
        if pd.notna(row.x) and pd.notna(row.y):
            spots.setdefault((round(row.x, 1), round(row.y, 2)), []).append(str(row.label))
    for (x, y), labels in spots.items():
        ax.annotate(
            ",".join(labels), (x, y), xytext=(4, 3), textcoords="offset points", fontsize=6.5,
            color="0.2",
        )  # fmt: skip


def plot_explained(points: pd.DataFrame, *, ax: Axes) -> Axes:
    """Draw explained variance over orders, with standard deviations (Fig. 3D)."""
    ax.errorbar(
        points["x"], points["y"], yerr=points["y_error"].fillna(0.0), marker="o", ms=4, color=RIGHT,
        lw=1.1, capsize=2,
    )  # fmt: skip
    for row in points.itertuples():
        ax.annotate(
            str(row.label), (row.x, row.y), xytext=(0, -11), textcoords="offset points",
            ha="center", fontsize=6.5, color="0.3",
        )  # fmt: skip
    low = float((points["y"] - points["y_error"].fillna(0.0)).min())
    ax.set(xlabel="polynomial order S", ylabel="explained variance")
    ax.set_ylim(min(0.9, low - 0.06), 1.02)
    ax.set_xlim(points["x"].min() - 0.7, points["x"].max() + 0.7)
    ax.set_xticks(sorted(points["x"].unique()))
    return ax


def plot_ratio(points: pd.DataFrame, *, ax: Axes, chance: pd.DataFrame | None = None) -> Axes:
    """Draw hits for each false positive a second over orders (Fig. 6, bottom).

    chance: points of what chance gives, a line a series.
    """
    names = list(dict.fromkeys(points["series"]))
    for i, name in enumerate(names):
        rows = points[points["series"] == name]
        shift = (i - (len(names) - 1) / 2) * 0.1
        ax.errorbar(
            rows["x"] + shift, rows["y"], yerr=rows["y_error"].fillna(0.0),
            marker=SERIES_MARKERS[i % len(SERIES_MARKERS)], ms=4, lw=1.0, capsize=2,
            color=SERIES_COLOURS[i % len(SERIES_COLOURS)], label=name,
        )  # fmt: skip
    kinds = {} if chance is None else dict(tuple(chance.groupby("series", sort=False)))
    for (name, rows), dashes in zip(kinds.items(), ("--", ":"), strict=False):
        ax.plot(rows["x"], rows["y"], color="0.35", ls=dashes, lw=1.1, label=f"chance: {name}")
    ax.set(xlabel="polynomial order S", ylabel="hit rate / false positives a second (s)")
    ax.set_xticks(sorted(points["x"].unique()))
    ax.set_ylim(bottom=0)
    if len(names) + len(kinds) > 1:
        ax.legend(loc="best")
    return ax


def plot_over_chance(points: pd.DataFrame, *, ax: Axes) -> Axes:
    """Draw hit rates less those of chance over orders, a line a kind of chance."""
    for i, (name, rows) in enumerate(points.groupby("series", sort=False)):
        ax.errorbar(
            rows["x"] + 0.06 * (i - 0.5), rows["y"], yerr=rows["y_error"].fillna(0.0),
            marker=SERIES_MARKERS[i % len(SERIES_MARKERS)], ms=4, lw=1.0, capsize=2,
            color=("0.35", SERIES_COLOURS[0])[i % 2], label=str(name),
        )  # fmt: skip
    ax.axhline(0, color="0.6", lw=0.8)
    ax.set(xlabel="polynomial order S", ylabel="hit rate less chance")
    ax.set_xticks(sorted(points["x"].unique()))
    ax.legend(loc="best")
    return ax


def plot_scheme(ends: Sequence[int], bins: int, *, ax: Axes) -> Axes:
    """Draw the model: T bins cut into M + 1 segments, each with its polynomial (Fig. 2).

    ends: the inclusive upper boundaries q_0 .. q_M of the segments, the last one T - 1.
    """
    starts = [0, *(end + 1 for end in ends[:-1])]
    heights = [(0.9, 1.9), (1.7, 0.7), (0.8, 1.3), (1.5, 0.9)]
    for bin_ in range(bins):
        ax.add_patch(mpl.patches.Rectangle((bin_, -0.35), 1, 0.35, fc="white", ec="0.5", lw=0.7))
        ax.text(bin_ + 0.5, -0.175, str(bin_), ha="center", va="center", fontsize=6.5, color="0.3")
    for m, (start, end) in enumerate(zip(starts, ends, strict=True)):
        colour = SERIES_COLOURS[m % len(SERIES_COLOURS)]
        u = np.linspace(0, 1, 60)
        low, high = heights[m % len(heights)]
        curve = low + (high - low) * u + 0.45 * np.sin(np.pi * u) * (1 if m % 2 else -1)
        ax.plot(start + u * (end + 1 - start), curve, color=colour, lw=2)
        ax.add_patch(
            mpl.patches.Rectangle(
                (start, -0.35), end + 1 - start, 0.35, fc=colour, alpha=0.18, lw=0, zorder=0
            )
        )
        middle = (start + end + 1) / 2
        ax.text(middle, 2.45, f"segment {m}", ha="center", color=colour)
        ax.text(
            middle, 2.2, rf"$\mu_{m}(t)=\sum_{{i=0}}^{{S}} a_{{i,{m}}}\,(t-t_{m})^i$",
            ha="center", fontsize=7, color="0.25",
        )  # fmt: skip
        name = rf"$q_{m}={end}$" if m < len(ends) - 1 else rf"$q_M=T-1={end}$"
        ax.plot([end + 1] * 2, [-0.5, 2.1], color="0.2", ls=":", lw=1.1)
        ax.text(end + 1, -0.55, name, ha="center", va="top", fontsize=7.5)
    ax.plot([0, 0], [-0.5, 2.1], color="0.2", ls=":", lw=1.1)
    ax.text(0, -0.55, r"$q_{-1}=-1$", ha="center", va="top", fontsize=7.5)
    ax.set(xlim=(-0.6, bins + 0.9), ylim=(-1.05, 2.75), ylabel="wrist position")
    ax.set_xlabel(rf"time: T = {bins} bins of duration $\Delta t$, M = {len(ends) - 1} boundaries")
    ax.set_xticks([])
    ax.set_yticks([])
    for side in ("left", "bottom"):
        ax.spines[side].set_visible(False)
    return ax
