"""The pipeline as boxes and arrows: the counterpart of Naert et al. 2017, Fig. 3."""

from __future__ import annotations

import textwrap

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch, Patch

STAGE_COLOURS = {
    "ingest": "#dbe7f3",
    "kinematics": "#d5ecdf",
    "coarticulation": "#fbe3cf",
    "binning": "#ece0f5",
    "audit": "#f7d9dc",
    "report": "#e6e6e6",
}
BOX = (0.88, 0.66)


def plot_overview(rules: pd.DataFrame, *, ax: Axes) -> Axes:
    """Draw the rules (table `overview`) from left to right, coloured by stage."""
    place = {str(r.rule): (float(r.column), -float(r.row)) for r in rules.itertuples()}
    for rule in rules.itertuples():
        x, y = place[str(rule.rule)]
        passing = ">" in str(rule.rule)
        for before in str(rule.after).split():
            x0, y0 = place[before]
            ax.add_patch(
                FancyArrowPatch(
                    (x0 + BOX[0] / 2, y0), (x - BOX[0] / 2, y),
                    arrowstyle="-" if passing else "-|>",
                    mutation_scale=8, color="0.45", lw=0.9, shrinkA=0, shrinkB=0, zorder=1,
                )
            )  # fmt: skip
        if passing:
            ax.plot((x - BOX[0] / 2, x + BOX[0] / 2), (y, y), color="0.45", lw=0.9, zorder=1)
            continue
        ax.add_patch(
            FancyBboxPatch(
                (x - BOX[0] / 2, y - BOX[1] / 2), *BOX, boxstyle="round,pad=0,rounding_size=0.06",
                fc=STAGE_COLOURS.get(str(rule.stage), "white"), ec="0.35", lw=0.8, zorder=2,
            )
        )  # fmt: skip
        name = str(rule.rule).replace("_", " ")
        note = textwrap.fill(str(rule.note).rstrip("."), 19)
        lines = note.count("\n") + 1 if note else 0
        ax.text(
            x, y + BOX[1] / 2 - 0.11, name, ha="center", va="center", fontsize=6.8,
            weight="bold", zorder=3,
        )  # fmt: skip
        if lines:
            ax.text(x, y - 0.08, note, ha="center", va="center", fontsize=5.6, zorder=3)
    stages = [s for s in dict.fromkeys(rules["stage"]) if s]
    ax.legend(
        handles=[Patch(fc=STAGE_COLOURS.get(s, "white"), ec="0.35", label=s) for s in stages],
        loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=len(stages),
        title="rules of one stage (workflow/rules)",
    )  # fmt: skip
    ax.set_xlim(-0.55, rules["column"].max() + 0.55)
    ax.set_ylim(-rules["row"].max() - 0.45, -rules["row"].min() + 0.45)
    ax.set_axis_off()
    return ax
