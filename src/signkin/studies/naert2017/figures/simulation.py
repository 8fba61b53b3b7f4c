"""What was put into a simulated corpus, found again: errors of tags, and the surface."""

from __future__ import annotations

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import refinement, style


def draw_simulation(errors: pd.DataFrame, surface: pd.DataFrame) -> Figure:
    """Draw the error to truth before and after refinement, and the surface found again."""
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH_IN, 2.9))
    refinement.plot_truth(errors, ax=axes[0])
    refinement.plot_surface_check(surface, ax=axes[1])
    return figure
