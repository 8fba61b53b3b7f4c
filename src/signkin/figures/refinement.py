"""How tags lie to speed minima, against chance; and to the truth, where it is known."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from numpy.typing import NDArray

from signkin.figures.style import HAND_COLOURS, LEFT, MANUAL, NEUTRAL


def plot_chance(
    distances_s: NDArray[np.float64],
    chance_s: NDArray[np.float64],
    window_s: float,
    hand: str,
    *,
    ax: Axes,
) -> Axes:
    """Draw the cumulative share of tags over their distance to the nearest minimum.

    distances_s: of the manual tags, (N,). chance_s: of random tags, (draws, N); the band
    holds 95 % of the sets of random tags.
    """
    grid = np.linspace(0, 2 * window_s, 121)
    observed = np.searchsorted(np.sort(distances_s), grid + 1e-9) / len(distances_s)
    ordered = np.sort(chance_s, axis=1)
    draws = np.array([np.searchsorted(row, grid + 1e-9) for row in ordered]) / chance_s.shape[1]
    low, middle, high = np.quantile(draws, [0.025, 0.5, 0.975], axis=0)
    ax.fill_between(grid, low, high, color="0.82", lw=0, label="random tags, 95 % of sets")
    ax.plot(grid, middle, color=NEUTRAL, lw=1, ls="--", label="random tags, median")
    ax.plot(grid, observed, color=HAND_COLOURS[hand], lw=1.6, label="manual tags")
    ax.axvline(window_s, color=MANUAL, lw=1, ls=":", label="refinement window")
    ax.set(
        xlabel="distance to the nearest minimum (s)",
        ylabel="share of tags",
        title=f"{hand} hand",
        ylim=(0, 1.02),
        xlim=(0, grid[-1]),
    )
    ax.title.set_color(HAND_COLOURS[hand])
    ax.legend(loc="lower right")
    return ax


def plot_truth(errors: pd.DataFrame, *, ax: Axes) -> Axes:
    """Draw the cumulative share of tags over their absolute error to the truth, before and after.

    errors: columns hand, manual_error_s, refined_error_s.
    """
    for hand in ("right", "left"):
        chosen = errors[errors["hand"] == hand]
        for kind, style in (("manual", "--"), ("refined", "-")):
            error = np.sort(chosen[f"{kind}_error_s"].abs())
            share = np.arange(1, len(error) + 1) / len(error)
            ax.step(
                error, share, where="post", color=HAND_COLOURS[hand], ls=style, lw=1.4,
                label=f"{hand}, {kind}",
            )  # fmt: skip
    ax.set(xlabel="error to the true boundary (s)", ylabel="share of tags", ylim=(0, 1.02))
    ax.set_xlim(left=0)
    ax.legend(loc="lower right")
    return ax


def plot_surface_check(surface: pd.DataFrame, *, ax: Axes) -> Axes:
    """Draw each fitted coefficient with its interval, as a ratio to the printed one."""
    published = surface["published"].astype(float)
    at = np.arange(len(surface))
    ratio = surface["fitted"] / published
    ax.errorbar(
        at, ratio, yerr=[(surface["fitted"] - surface["low"]) / published,
                         (surface["high"] - surface["fitted"]) / published],
        fmt="o", color=HAND_COLOURS["right"], capsize=3, ms=4, label="fitted, 95 % interval",
    )  # fmt: skip
    ax.scatter(
        at, surface["designed"] / published, marker="x", color=LEFT, s=30, zorder=4,
        label="fitted to the designed distances",
    )  # fmt: skip
    ax.axhline(1, color="0.4", lw=1, ls="--", label="printed")
    ax.set_xticks(at, [f"θ {term}" for term in surface["coefficient"]])
    ax.set_xlim(-0.5, len(surface) - 0.5)
    ax.set(ylabel="coefficient / printed coefficient")
    # Room above the intervals for the legend.
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.45 * (high - low))
    ax.legend(loc="upper center")
    return ax
