"""The pipeline as boxes and arrows: the counterpart of Naert et al. 2017, Fig. 3."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch, Patch, Rectangle

# Lane and box: a pale and a stronger shade of one hue, of different greys in print.
STAGE_COLOURS = {
    "simulate": ("#f4f4ee", "#dcdcc8"),
    "ingest": ("#eef3f9", "#c3d8ee"),
    "kinematics": ("#ecf6f0", "#bfe3cd"),
    "naert2017": ("#fdf2e7", "#f9d3ad"),
    "one_wrist": ("#fdf8dc", "#f3e492"),
    "kernels": ("#e9f6f8", "#b4e0e6"),
    "endres2013": ("#f5effa", "#dcc4ee"),
    "audit": ("#fbeeef", "#f1bcc1"),
    "explorer": ("#eff7e6", "#cbe3a8"),
    "report": ("#f2f2f2", "#d5d5d5"),
    "store": ("#e8ecf0", "#bcc8d4"),
}
OTHER = ("#ffffff", "#eeeeee")
PITCH = (2.3, 0.58)  # from box to box, in inches
BOX = (2.0, 0.48)
GUTTER = 0.95  # left of the boxes: the lanes' names
FEW = 3  # rules of other stages that a box names one by one
LEGEND = 0.45


def size(rules: pd.DataFrame) -> tuple[float, float]:
    """Return width and height in inches that the drawing of a table `overview` wants."""
    columns, rows = int(rules["column"].max()) + 1, int(rules["row"].max()) + 1
    return GUTTER + PITCH[0] * columns, PITCH[1] * rows + LEGEND


def plot_overview(rules: pd.DataFrame, *, ax: Axes) -> Axes:
    """Draw the rules (table `overview`): a lane a stage, arrows within, names across.

    A rule that takes what other stages made says so in its last line; arrows between lanes
    would cross every box.
    """
    stage = dict(zip(rules["rule"], rules["stage"], strict=True))
    place = {
        str(r.rule): (GUTTER + PITCH[0] * (r.column + 0.5), -PITCH[1] * (r.row + 0.5))
        for r in rules.itertuples()
    }
    width, height = size(rules)
    for lane, part in rules.groupby("stage", sort=False):
        top, bottom = -PITCH[1] * part["row"].min(), -PITCH[1] * (part["row"].max() + 1)
        pale, _ = STAGE_COLOURS.get(str(lane), OTHER)
        ax.add_patch(Rectangle((0, bottom), width, top - bottom, fc=pale, ec="white", lw=2))
        ax.text(0.06, (top + bottom) / 2, lane, va="center", fontsize=7.2, weight="bold")
    for rule in rules.itertuples():
        x, y = place[str(rule.rule)]
        before = str(rule.after).split()
        for source in (a for a in before if stage[a] == rule.stage):
            x0, y0 = place[source]
            ax.add_patch(
                FancyArrowPatch(
                    (x0 + BOX[0] / 2, y0), (x - BOX[0] / 2, y), arrowstyle="-|>",
                    mutation_scale=8, color="0.25", lw=1.0, shrinkA=0, shrinkB=0, zorder=3,
                )
            )  # fmt: skip
        strong = STAGE_COLOURS.get(str(rule.stage), OTHER)[1]
        ax.add_patch(
            FancyBboxPatch(
                (x - BOX[0] / 2, y - BOX[1] / 2), *BOX, boxstyle="round,pad=0,rounding_size=0.05",
                fc=strong, ec="0.35", lw=0.7, zorder=2,
            )
        )  # fmt: skip
        note = textwrap.fill(str(rule.note).rstrip("."), 42)
        lines = [note] if note else []
        across = _across([a for a in before if stage[a] != rule.stage], stage)
        ax.text(
            x, y + BOX[1] / 2 - 0.075, str(rule.rule).replace("_", " "), ha="center", va="center",
            fontsize=6.6, weight="bold", zorder=4,
        )  # fmt: skip
        if lines:
            ax.text(
                x, y + 0.005, note, ha="center", va="center", fontsize=5.4, zorder=4,
                linespacing=1.05,
            )  # fmt: skip
        if across:
            ax.text(
                x, y - BOX[1] / 2 + 0.065, across, ha="center", va="center", fontsize=5.4,
                style="italic", color="0.15", zorder=4,
            )  # fmt: skip
    ax.legend(
        handles=[
            Patch(fc=STAGE_COLOURS.get(s, OTHER)[1], ec="0.35", label=s)
            for s in dict.fromkeys(rules["stage"])
        ],
        loc="lower center", ncols=10, bbox_to_anchor=(0.5, 0.0), handlelength=1.2,
        columnspacing=1.2, title="one colour a stage (a file of workflow/rules); in italics: "
        "what a rule takes from other stages", title_fontsize=6.8, fontsize=6.8,
    )  # fmt: skip
    ax.set(xlim=(0, width), ylim=(-height, 0))
    ax.set_axis_off()
    return ax


def _across(sources: list[str], stage: Mapping[str, str]) -> str:
    """Return what a box says of rules in other stages: their names, or those of the stages."""
    if not sources:
        return ""
    names = sources if len(sources) <= FEW else sorted({stage[a] for a in sources})
    return "from " + ", ".join(name.replace("_", " ") for name in names)
