"""Fig. 9: transitions of each hand with manual and with refined tags."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin import tables
from signkin.corpus import Corpus
from signkin.figures import distance, style
from signkin.report.drawn import Drawn


def drawn(corpus: Corpus, transitions: pd.DataFrame) -> Drawn:
    """Draw each transition of one hand twice, joined. transitions: the table."""
    pairs = data(transitions, corpus.unit)
    told = caption(pairs, corpus.unit, points_of_an_arm(transitions))
    return Drawn(draw(pairs, corpus.unit), pairs, told)


def points_of_an_arm(transitions: pd.DataFrame) -> int:
    """Return from how many joints of one arm a distance is made, gaps aside; 0 without any."""
    arms = transitions.loc[transitions["hand"] != "both", "n_joints"]
    return int(arms.max()) if arms.notna().any() else 0


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


def draw(pairs: pd.DataFrame, unit: str) -> Figure:
    """Draw a panel a hand of the pairs that have both distances."""
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH_IN, 3.3), sharey=True)
    for hand, ax in zip(("left", "right"), axes, strict=True):
        distance.plot_segmentations(pairs.dropna(), hand, unit, ax=ax)
    axes[1].set_ylabel("")
    axes[1].legend(loc="best")
    return figure


def caption(pairs: pd.DataFrame, unit: str, points: int) -> str:
    """Tell how many pairs are drawn, and how far refinement changes their durations.

    points: joints of an arm; with one there is no mean over joints.
    """
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
        text += " Distances in image pixels."
    if points == 1:
        text += " An arm has one point: its wrist, or what corpus.yaml puts in its place."
    lost = len(pairs) - len(whole)
    if lost:
        text += f" {lost} pairs have no distance: gaps in the motion."
    return text
