"""How the manual tags lie to the speed minima, against random tags: a panel a hand."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import refinement, style


def draw_quality(
    boundaries: pd.DataFrame, chance: Mapping[str, np.ndarray], window_s: float
) -> Figure:
    """Draw the tags' distances to the minima against chance, a panel a hand."""
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH_IN, 2.9), sharey=True)
    for hand, ax in zip(("left", "right"), axes, strict=True):
        rows = boundaries[boundaries["hand"] == hand]
        distances = rows["distance_s"].fillna(np.inf).to_numpy(dtype=float)
        refinement.plot_chance(distances, chance[hand], window_s, hand, ax=ax)
    axes[0].get_legend().remove()
    axes[1].set_ylabel("")
    return figure
