"""Fig. 9: transitions of each hand with manual and with refined tags."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin import tables
from signkin.corpus import Corpus
from signkin.figures import distance, style
from signkin.report.drawn import Drawn


def segmentation_figure(corpus: Corpus, transitions: pd.DataFrame) -> Drawn:
    """Draw each transition of one hand twice, joined. transitions: the table."""
    pairs = data(transitions, corpus.unit)
    return Drawn(drawing(pairs, corpus.unit), pairs, caption(pairs, corpus.unit))


def data(transitions: pd.DataFrame, unit: str) -> pd.DataFrame:
    """Return each transition of one hand with manual and refined tags (table `segmentations`)."""
    keys = ["corpus", "recording", "signer", "transition", "hand"]
    values = [f"euclidean_{unit}", "duration_s"]
    sides = []
    for segmentation in ("manual", "refined"):
        rows = transitions[
            (transitions["segmentation"] == segmentation) & (transitions["hand"] != "both")
        ]
        names = {value: f"{segmentation}_{value}" for value in values}
        sides.append(rows[[*keys, *values]].rename(columns=names))
    pairs = sides[0].merge(sides[1], on=keys, validate="one_to_one")
    return pairs[tables.TABLES["segmentations"].names(unit)]


def drawing(pairs: pd.DataFrame, unit: str) -> Figure:
    """Draw a panel a hand of the pairs that have both distances."""
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH_IN, 3.3), sharey=True)
    for hand, ax in zip(("left", "right"), axes, strict=True):
        distance.plot_segmentations(pairs.dropna(), hand, unit, ax=ax)
    axes[1].set_ylabel("")
    axes[1].legend(loc="best")
    return figure


def caption(pairs: pd.DataFrame, unit: str) -> str:
    """Tell how many pairs are drawn, and how far refinement changes their durations."""
    whole = pairs.dropna()
    changed = {
        hand: (g["refined_duration_s"] - g["manual_duration_s"]).abs().median()
        for hand, g in whole.groupby("hand")
    }
    told = ", ".join(
        f"{hand} {changed[hand]:.3f} s" for hand in ("left", "right") if hand in changed
    )
    text = (
        f"Duration over the mean Euclidean distance of one arm's joints, manual (blue diamonds) "
        f"and refined tags (red disks); {len(whole)} pairs over both hands, overlapping signs "
        f"with their negative durations. Median change of the duration: {told}."
    )
    if unit == "px":
        text += " Distances in image pixels; the hand's centre is the arm's only point."
    lost = len(pairs) - len(whole)
    if lost:
        text += f" {lost} pairs have no distance: gaps in the motion."
    return text
