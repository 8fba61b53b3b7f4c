"""Mean duration by number of hands (Naert et al. 2017, Fig. 10)."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from signkin.figures.style import ACCENT, NEUTRAL, PALE


def plot_hand_changes(groups: pd.DataFrame, durations: pd.DataFrame, *, ax: Axes) -> Axes:
    """Draw the mean of each change of hands, its SD, every transition, and the paper's mean.

    groups: rows of the table `fig10`. durations: columns change, duration_s.
    """
    import seaborn as sns  # takes as long to import as numba: only where bars are drawn

    order = list(groups["change"])
    sns.barplot(data=groups, x="change", y="mean_s", order=order, color=PALE, width=0.62, ax=ax)
    shown = durations[durations["change"].isin(order)]
    if not shown.empty:
        # Points spread by their rank, not at random: the same bytes every time.
        for i, change in enumerate(order):
            values = np.sort(shown.loc[shown["change"] == change, "duration_s"].to_numpy())
            spread = ((np.arange(len(values)) * 0.618034) % 1 - 0.5) * 0.42
            ax.scatter(i + spread, values, s=7, color=NEUTRAL, alpha=0.45, lw=0, zorder=2)
    at = np.arange(len(order))
    ax.errorbar(
        at, groups["mean_s"], yerr=groups["sd_s"].fillna(0), fmt="none", ecolor="0.15", lw=1.1,
        capsize=3, zorder=3, label="± 1 SD",
    )  # fmt: skip
    ax.scatter(
        at, groups["published_mean_s"], marker="_", s=420, color=ACCENT, lw=2, zorder=4,
        label="Naert et al. 2017, from Table 2",
    )  # fmt: skip
    labels = [
        f"{change.replace(' to ', ' → ')}\nn = {n}" + ("" if n else " (none)")
        for change, n in zip(order, groups["n"], strict=True)
    ]
    ax.set_xticks(at, labels)
    ax.set(xlabel="hands of the sign before → of the sign after", ylabel="mean duration (s)")
    ax.set_ylim(bottom=0)
    ax.legend(loc="upper left", bbox_to_anchor=(0, 1.12), ncols=2)
    return ax
