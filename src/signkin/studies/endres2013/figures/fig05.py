"""Fig. 5: hit rates on power-law ground truth, for signers and signs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import binning as drawing
from signkin.figures.style import WIDTH_IN
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures.points import (
    chance_points,
    frame_of,
    group,
    hit_points,
    panel_of,
    told_orders,
)
from signkin.studies.endres2013.figures.sources import Sources
from signkin.studies.endres2013.single_signs import POWERLAW
from signkin.studies.endres2013.summaries import ALL

MOST_PANELS = 2  # signers and signs, each


@dataclass(frozen=True)
class Groups:
    """The signers and signs drawn, and (signer, sign) -> number of trajectories of any."""

    signers: tuple[str, ...]
    signs: tuple[str, ...]
    sizes: Mapping[tuple[str, str], int]


def drawn(sources: Sources) -> Drawn:
    """Draw the groups with most trajectories."""
    mine = sources.rates[(sources.rates["dataset"] == POWERLAW) & (sources.rates["signer"] != ALL)]
    groups = groups_of(mine)
    points = data(sources, groups)
    return Drawn(draw(points, groups), points, caption(mine, groups))


def groups_of(rates: pd.DataFrame) -> Groups:
    """Return the signers, and of these the signs, with most trajectories that have a truth.

    rates: rows of `hit_rates`, a group of trajectories at one order.
    """
    counted = rates[rates["n"] > rates["without_truth"]]
    sizes = counted.groupby(["signer", "sign"])["n"].max()
    signers = _largest(sizes, "signer")
    return Groups(
        tuple(signers),
        tuple(_largest(sizes.loc[signers], "sign")),
        {(str(signer), str(sign)): int(n) for (signer, sign), n in sizes.items()},
    )


def _largest(sizes: pd.Series, level: str) -> list[str]:
    totals = sizes.groupby(level=level).sum().sort_values(ascending=False, kind="stable")
    return sorted(str(name) for name in totals.index[:MOST_PANELS])


def data(sources: Sources, groups: Groups) -> pd.DataFrame:
    """Return the points, a panel a signer and sign."""
    rows = []
    for signer in groups.signers:
        for sign in groups.signs:
            name = f"{signer}, {sign}"
            rates, lines = (
                group(table, POWERLAW, signer=signer, sign=sign)
                for table in (sources.rates, sources.lines)
            )
            rows += hit_points(rates, name, name)
            rows += chance_points(lines, name)
    return frame_of(sources.corpus, rows)


def draw(points: pd.DataFrame, groups: Groups) -> Figure:
    """Draw a row of panels a signer, a column a sign, all with the same axes."""
    figure, axes = plt.subplots(
        len(groups.signers), len(groups.signs), figsize=(WIDTH_IN, 0.4 + 2.5 * len(groups.signers)),
        squeeze=False, sharex=True, sharey=True,
    )  # fmt: skip
    marks = points[~points["series"].isin(drawing.CHANCE_SERIES)]
    right = float(np.nanmax([1.0, *(marks["x"] + marks["x_error"].fillna(0))])) * 1.12
    first = True
    for i, signer in enumerate(groups.signers):
        for j, sign in enumerate(groups.signs):
            part = panel_of(points, f"{signer}, {sign}")
            ax = axes[i, j]
            if not part.empty:
                drawing.plot_hit_rates(part, ax=ax, right=right, legend=False)
                if first:
                    handles, labels = ax.get_legend_handles_labels()
                    ax.legend(handles[:2], labels[:2], loc="lower right")
                    first = False
            n = groups.sizes.get((signer, sign), 0)
            ax.set_title(f"signer {signer}, sign {sign} (n = {n})", loc="left")
            ax.label_outer()
    return figure


def caption(rates: pd.DataFrame, groups: Groups) -> str:
    """Return what stands below the figure. rates: as `groups_of` takes them."""
    return (
        "Hit rate against false positives a second on power-law ground truth, for "
        f"{told_orders(rates['order'])} (numbers at the marks), ± standard errors; "
        f"{len(groups.signers)} of {rates['signer'].nunique()} "
        f"signers and {len(groups.signs)} of {rates['sign'].nunique()} signs, those with most "
        "trajectories (hit_rates.csv has all). Dashed: Poisson events through the same matcher "
        "(grey: 95 % of sets of as many trajectories), dotted: the closed form."
    )
