"""The excerpt of Fig. 6 with posteriors of its tags, in place of refined ones: a panel a hand."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import posterior, style
from signkin.joints import HANDS


def draw_posteriors(points: pd.DataFrame, posteriors: pd.DataFrame, unit: str) -> Figure:
    """Draw it, a panel for each hand that has a speed.

    points: the table of Fig. 6. posteriors: the table `boundary_posteriors`.
    """
    speeds = points[points["kind"] == "speed"].dropna(subset=[f"speed_{unit}_per_s"])
    hands = [hand for hand in HANDS if (speeds["hand"] == hand).any()]
    figure, panels = plt.subplots(
        len(hands), 1, figsize=(style.WIDTH_IN, 0.6 + 1.8 * len(hands)), sharex=True, squeeze=False
    )
    axes = panels[:, 0]
    recording = str(points["recording"].iloc[0])
    rows = posteriors[posteriors["recording"] == recording]
    for hand, ax in zip(hands, axes, strict=True):
        posterior.plot_posterior(points, rows, unit, hand, ax=ax)
    axes[-1].set_xlabel(f"time in the recording {recording} (s)")
    axes[-1].legend(handles=posterior.handles(), loc="upper center", bbox_to_anchor=(0.5, -0.28),
                    ncols=3, handlelength=2.4)  # fmt: skip
    return figure
