"""Models of duration: predictions over truth, and the surface (Naert et al. 2017, Fig. 11)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from signkin.figures.style import ACCENT, LEFT, NEUTRAL, RIGHT

# Light to dark, the same order in grey print.
SHADES = "viridis_r"
DURATION = "duration (s)"


def plot_predictions(
    rows: pd.DataFrame, title: str, reach: tuple[float, float], *, ax: Axes
) -> Axes:
    """Draw one model: predicted over true duration, with the line of equality.

    rows: of the table `duration_predictions`, one model. reach: top of both axes, in s;
    predictions above it are drawn at the top edge as triangles and counted.
    """
    x, y = (rows[c].to_numpy(dtype=float) for c in ("duration_s", "predicted_s"))
    beyond = y > reach[1]
    size = 12 if len(rows) < 200 else 6
    ax.plot([0, max(reach)], [0, max(reach)], color=NEUTRAL, lw=0.9, ls="--", zorder=1)
    ax.scatter(x[~beyond], y[~beyond], s=size, color=RIGHT, alpha=0.65, lw=0, zorder=2)
    if beyond.any():
        top = np.full(int(beyond.sum()), reach[1] * 0.985)
        ax.scatter(x[beyond], top, s=18, marker="^", color=LEFT, lw=0, zorder=3, clip_on=False)
        ax.annotate(
            f"{int(beyond.sum())} above, up to {y.max():.2f} s", (0.97, 0.9),
            xycoords="axes fraction", ha="right", fontsize=7, color=LEFT,
        )  # fmt: skip
    ax.set(xlim=(0, reach[0]), ylim=(0, reach[1]), title=title, xlabel="true duration (s)")
    return ax


def plot_surface(
    points: pd.DataFrame,
    theta: Sequence[float] | NDArray[np.float64] | None,
    unit: str,
    *,
    ax: Axes,
) -> Axes:
    """Draw the surface in space with the transitions, each joined to the surface.

    points: rows of the table `surface_points`. theta: (3,), or None. ax: a 3-D Axes.
    """
    g, e, d = (
        points[c].to_numpy(dtype=float) for c in ("geodesic_rad", "euclidean_units", "duration_s")
    )
    if theta is not None:
        a, b = np.meshgrid(*(np.linspace(v.min(), v.max(), 9) for v in (g, e)), indexing="ij")
        height = theta[0] + theta[1] * a + theta[2] * b
        ax.plot_surface(  # type: ignore[attr-defined]
            a, b, height, color=ACCENT, alpha=0.25, lw=0, shade=False
        )
        ax.plot_wireframe(a, b, height, color=ACCENT, lw=0.5)  # type: ignore[attr-defined]
        on = theta[0] + theta[1] * g + theta[2] * e
        for below, colour in ((True, LEFT), (False, RIGHT)):
            for i in np.flatnonzero((d < on) == below):
                ax.plot([g[i]] * 2, [e[i]] * 2, [on[i], d[i]], color=colour, lw=0.5, alpha=0.7)
    else:
        on = np.full(len(d), -np.inf)
    for below, colour, marker, label in (
        (False, RIGHT, "o", "above"),
        (True, LEFT, "v", "below"),
    ):
        held = (d < on) == below
        if held.any():
            name = f"transition {label} the surface" if theta is not None else "transition"
            ax.scatter(  # type: ignore[misc]
                g[held], e[held], d[held], s=9, color=colour, marker=marker, depthshade=False,
                lw=0, label=name,
            )  # fmt: skip
    ax.set_xlabel("geodesic distance (rad)", labelpad=-2)
    ax.set_ylabel(f"Euclidean distance ({unit})", labelpad=-2)
    ax.set_zlabel(DURATION, labelpad=-6)  # type: ignore[attr-defined]
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):  # type: ignore[attr-defined]
        axis.set_major_locator(MaxNLocator(4))
        axis.set_tick_params(pad=-2, labelsize=7)
    ax.view_init(elev=16, azim=-128)  # type: ignore[attr-defined]
    ax.set_box_aspect((4, 4, 3.2), zoom=0.86)  # type: ignore[call-arg, arg-type]
    ax.legend(loc="upper left", bbox_to_anchor=(0.02, 1.1), handletextpad=0.2)
    return ax


def plot_levels(
    points: pd.DataFrame,
    theta: Sequence[float] | NDArray[np.float64] | None,
    unit: str,
    *,
    ax: Axes,
) -> Axes:
    """Draw the same seen from above: the surface's levels, transitions shaded by duration."""
    g, e, d = (
        points[c].to_numpy(dtype=float) for c in ("geodesic_rad", "euclidean_units", "duration_s")
    )
    norm = Normalize(float(np.quantile(d, 0.02)), float(np.quantile(d, 0.98)))
    if theta is not None:
        spans = [(v.min() - 0.04 * np.ptp(v), v.max() + 0.04 * np.ptp(v)) for v in (g, e)]
        a, b = np.meshgrid(*(np.linspace(*span, 60) for span in spans), indexing="ij")
        lines = ax.contour(
            a, b, theta[0] + theta[1] * a + theta[2] * b, levels=6, colors=[NEUTRAL],
            linewidths=0.8,
        )  # fmt: skip
        ax.clabel(lines, fmt="%.2f s", fontsize=6.5)
    shades = ax.scatter(g, e, c=d, s=20, cmap=SHADES, norm=norm, edgecolors="0.25", lw=0.4)
    ax.figure.colorbar(shades, ax=ax, label=DURATION, extend="both", shrink=0.9)
    ax.set(xlabel="geodesic distance (rad)", ylabel=f"Euclidean distance ({unit})")
    return ax
