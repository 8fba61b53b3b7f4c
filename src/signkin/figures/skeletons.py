"""Postures as stick figures, and how transitions are made of them (Naert et al. 2017, Fig. 1, 2,
12, 13)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle, Polygon, Rectangle
from numpy.typing import NDArray

from signkin.figures.style import ACCENT, LEFT, MANUAL, NEUTRAL, RIGHT, SPEED_UNITS
from signkin.joints import FINGERS, bones

FIRST, SECOND, BETWEEN = RIGHT, MANUAL, ACCENT
TRUTH = "0.45"
MODEL_STYLES = {
    "simple": (LEFT, "--"),
    "simple_bounded": (ACCENT, (0, (1, 1))),
    "linear": (MANUAL, "-."),
    "surface": (RIGHT, "-"),
}
METHOD_COLOURS = {"interpolation": ACCENT, "blending": RIGHT}


def plot_posture(
    positions: NDArray[np.float64],
    joints: Sequence[str],
    *,
    ax: Axes,
    colour: str,
    width: float = 1.2,
    alpha: float = 1.0,
    label: str | None = None,
    unit: str = "m",
) -> Axes:
    """Draw one posture, (J, 3), seen from in front: the signer's right hand is on the left."""
    x, z = -positions[:, 0], positions[:, 2]
    fine = {i for i, joint in enumerate(joints) if _is_finger(joint)}
    ends = np.array(bones(joints), dtype=int).reshape(-1, 2)
    thin = [0.55 if a in fine or b in fine else 1.0 for a, b in ends.tolist()]
    lines = LineCollection(
        list(np.stack([x[ends], z[ends]], axis=-1)), colors=colour,
        linewidths=[width * t for t in thin],
        alpha=alpha, capstyle="round", zorder=2, label=label if len(ends) else None,
    )  # fmt: skip
    ax.add_collection(lines)
    wrists = [i for i, joint in enumerate(joints) if joint.endswith("_wrist")]
    small = len(joints) <= 4  # hands only: points are all there is
    ax.scatter(
        x[wrists], z[wrists], s=26 if small else 6 * width, color=colour, alpha=alpha, lw=0,
        label=None if len(ends) else label, zorder=3,
    )  # fmt: skip
    _plot_head(positions, joints, colour, width, alpha, unit, ax)
    ax.set_aspect("equal")
    return ax


def _is_finger(joint: str) -> bool:
    return any(f"_{finger}_" in joint for finger in FINGERS)


def _plot_head(
    positions: NDArray[np.float64],
    joints: Sequence[str],
    colour: str,
    width: float,
    alpha: float,
    unit: str,
    ax: Axes,
) -> None:
    name = next((j for j in ("head", "nose") if j in joints), None)
    if name is None:
        return
    at = positions[list(joints).index(name)]
    if np.isnan(at).any():
        return
    radius = _head_radius(positions, joints, unit)
    lift = 0.6 * radius if name == "head" else 0.0
    ax.add_patch(
        Circle((-at[0], at[2] + lift), radius, fill=False, ec=colour, lw=width, alpha=alpha)
    )


def _head_radius(positions: NDArray[np.float64], joints: Sequence[str], unit: str) -> float:
    """Return a quarter of the shoulders' width, for a head that goes with its body."""
    place = {joint: i for i, joint in enumerate(joints)}
    if "right_shoulder" in place and "left_shoulder" in place:
        across = positions[place["right_shoulder"]] - positions[place["left_shoulder"]]
        width = float(np.hypot(across[0], across[2]))
        if width > 0:
            return 0.27 * width
    return 0.1 if unit == "m" else 14.0


def frame_on(
    axes: Sequence[Axes], postures: NDArray[np.float64], joints: Sequence[str], unit: str
) -> None:
    """Give axes the same limits, which hold all postures (K, J, 3) and the head."""
    x, z = -postures[..., 0], postures[..., 2]
    radius = max(_head_radius(posture, joints, unit) for posture in postures)
    low, high = np.nanmin(z) - radius / 3, np.nanmax(z) + radius / 3
    head = next((j for j in ("head", "nose") if j in joints), None)
    if head is not None:
        lift = 1.7 if head == "head" else 1.1
        high = max(high, np.nanmax(z[..., list(joints).index(head)]) + lift * radius)
    for ax in axes:
        ax.set_xlim(np.nanmin(x) - 0.7 * radius, np.nanmax(x) + 0.7 * radius)
        ax.set_ylim(low, high)


def plot_scheme(
    steps: Mapping[str, float], labels: Mapping[str, str], method: str, *, ax: Axes
) -> Axes:
    """Draw what a transition is made of, over time: the counterpart of Fig. 1 and 2.

    steps: start, first_end, second_start, end (s from the end of the first sign), and rate_hz.
    labels: first, second: the glosses.
    """
    start, end = steps["start"], steps["end"]
    d = steps["second_start"]
    height = 0.8
    n = round(d * steps["rate_hz"])
    if method == "interpolation":
        tracks = {"result": 0.0}
        middle = f"interpolation, n = {n}"
    else:
        tracks = {"first": 2.0, "second": 1.0, "result": 0.0}
        middle = f"blending, n = {n}"
        _bar(ax, start, 0, 2.0, height, FIRST, f"M₁ {labels['first']}")
        _bar(ax, 0, d, 2.0, height, FIRST, "R₁", light=True, fades=-1)
        _bar(ax, 0, d, 1.0, height, SECOND, "P₂", light=True, fades=1)
        _bar(ax, d, end, 1.0, height, SECOND, f"M₂ {labels['second']}")
    _bar(ax, start, 0, 0.0, height, FIRST, f"M₁ {labels['first']}")
    # A short transition has room for its number of frames alone.
    narrow = d < 0.2 * (end - start)
    _bar(ax, 0, d, 0.0, height, BETWEEN, f"n = {n}" if narrow else middle)
    _bar(ax, d, end, 0.0, height, SECOND, f"M₂ {labels['second']}")
    names = {"result": "result", "first": "first motion", "second": "second motion"}
    ax.set_yticks([y + height / 2 for y in tracks.values()], [names[t] for t in tracks])
    ax.set_ylim(-0.15, max(tracks.values()) + height + 0.15)
    ax.set_xlim(start, end)
    ax.set_xlabel("time from the last posture of the first sign (s)")
    ax.tick_params(axis="y", length=0)
    ax.spines["left"].set_visible(False)
    return ax


def _bar(
    ax: Axes,
    left: float,
    right: float,
    low: float,
    height: float,
    colour: str,
    text: str,
    light: bool = False,
    fades: int = 0,
) -> None:
    """Draw a bar; fades: a wedge shows the weight falling (-1) or rising (1)."""
    ax.add_patch(
        Rectangle((left, low), right - left, height, fc=colour, ec="white", lw=1,
                  alpha=0.25 if light else 0.85)
    )  # fmt: skip
    if fades:
        top = left if fades < 0 else right
        corners = [(left, low), (right, low), (top, low + height)]
        ax.add_patch(Polygon(corners, fc=colour, alpha=0.55, lw=0))
    ax.text(
        (left + right) / 2, low + height / 2, text, ha="center", va="center", fontsize=7,
        color="black" if light or colour == BETWEEN else "white", weight="bold", clip_on=True,
    )  # fmt: skip


def plot_transition_speed(
    curves: Mapping[str, tuple[NDArray[np.float64], NDArray[np.float64], float]],
    truth: tuple[NDArray[np.float64], NDArray[np.float64], float] | None,
    unit: str,
    *,
    ax: Axes,
) -> Axes:
    """Draw the wrist's speed through a transition for each duration model, and the captured one.

    curves: model -> (time_s, speed, duration_s), times from the end of the first sign. A mark on
    each curve shows where the second sign begins.
    """
    if truth is not None:
        time, speed, duration = truth
        ax.plot(time, speed, color=TRUTH, lw=3, alpha=0.55, label=f"captured, {duration:.2f} s")
        _mark(ax, time, speed, duration, TRUTH)
    for model, (time, speed, duration) in curves.items():
        colour, line = MODEL_STYLES[model]
        name = model.upper().replace("_", " ")
        # The full line is wide and below: others that run along it stay to be seen.
        wide = line == "-"
        ax.plot(
            time, speed, color=colour, ls=line, lw=2.0 if wide else 1.3,
            zorder=2.1 if wide else 2.5, label=f"{name}, {duration:.2f} s",
        )  # fmt: skip
        _mark(ax, time, speed, duration, colour)
    ax.axvline(0, color=NEUTRAL, lw=0.8, ls=":")
    ax.set(xlabel="time (s)", ylabel=f"speed ({SPEED_UNITS[unit]})")
    return ax


def _mark(
    ax: Axes, time: NDArray[np.float64], speed: NDArray[np.float64], at: float, colour: str
) -> None:
    ax.scatter([at], [np.interp(at, time, speed)], color=colour, s=22, zorder=4, ec="white", lw=0.6)


def plot_durations(
    durations: Mapping[str, float], bounds_s: tuple[float, float], *, ax: Axes
) -> Axes:
    """Draw the duration that each model gives one transition (Fig. 13)."""
    names = list(durations)
    for i, name in enumerate(names):
        ax.barh(i, durations[name], color=MODEL_STYLES[name][0], height=0.6)
        ax.text(durations[name], i, f" {durations[name]:.2f} s", va="center", fontsize=7.5)
    for bound in bounds_s:
        ax.axvline(bound, color=NEUTRAL, lw=0.9, ls=":")
    ax.set_yticks(range(len(names)), [name.upper().replace("_", "\n") for name in names])
    ax.invert_yaxis()
    ax.set_xlim(0, 1.25 * max(*durations.values(), bounds_s[1]))
    ax.set_xlabel("duration (s)")
    return ax
