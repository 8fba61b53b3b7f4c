"""Exponents of recorded segments beside what noise gives, and of known laws after a filter."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from signkin.figures.style import NEUTRAL, PALE, SERIES_COLOURS, SERIES_MARKERS

LAW = -1 / 3  # of ellipses, the two-thirds power law


def plot_exponents(
    laws: pd.DataFrame, names: Mapping[str, str], noise: pd.DataFrame, ax: Axes
) -> None:
    """Draw medians, quartiles and 90 % of the exponents of segments, one place an estimator.

    laws: table `recorded_laws`. names: estimator -> its column. noise: rows of `law_pitfalls`
    of noise alone, whose range over durations is a grey bar; none where it has no exponent.
    """
    for place, (name, column) in enumerate(names.items()):
        found = laws[column].dropna()
        of_noise = noise.loc[noise["estimator"] == name, "found"].dropna()
        if len(of_noise):
            low, high = of_noise.min(), of_noise.max()
            ax.fill_between([place - 0.35, place + 0.35], low - 0.01, high + 0.01, color=PALE,
                            label="noise alone" if place == 0 else None)  # fmt: skip
        if found.empty:
            continue
        five, quarter, middle, three, most = np.quantile(found, [0.05, 0.25, 0.5, 0.75, 0.95])
        colour = SERIES_COLOURS[place]
        ax.plot([place, place], [five, most], color=colour, lw=1)
        ax.plot([place, place], [quarter, three], color=colour, lw=5, solid_capstyle="butt")
        ax.plot(place, middle, "o", color="white", mec=colour, ms=5)
    ax.axhline(LAW, color=NEUTRAL, ls="--", lw=0.9)
    ax.set_xticks(range(len(names)), [name.replace(" ", "\n", 1) for name in names])
    ax.set_xlim(-0.6, len(names) - 0.4)
    ax.set_ylabel("exponent of a segment")
    ax.legend(loc="best")


def plot_known(known: pd.DataFrame, estimator: str, ax: Axes) -> None:
    """Draw exponents found over true ones, a mark a duration: filled without noise, open with it.

    known: rows of `law_pitfalls` of ellipses.
    """
    chosen = known[known["estimator"] == estimator]
    for i, (duration, part) in enumerate(chosen.groupby("duration_s")):
        colour = SERIES_COLOURS[i]
        for noisy, rows in part.groupby(part["noise_sd"] > 0):
            rows = rows.sort_values("beta")
            ax.errorbar(
                rows["beta"] + 0.012 * noisy, rows["found"], yerr=rows["sd"] if noisy else None,
                ls="none" if noisy else "-", lw=0.9, marker=SERIES_MARKERS[i], ms=5, color=colour,
                mfc="white" if noisy else colour,
                label=None if noisy else f"{duration:g} s a turn",
            )  # fmt: skip
    ends = [chosen["beta"].min() - 0.05, chosen["beta"].max() + 0.05]
    ax.plot(ends, ends, color=NEUTRAL, ls="--", lw=0.9)
    ax.set_xlabel("exponent of the ellipse")
    ax.set_ylabel(f"exponent found ({estimator})")
    ax.legend(loc="best")
