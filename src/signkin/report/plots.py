"""Plots that stand in a page as SVG, whose points a reader can choose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup, escape
from matplotlib.ticker import MaxNLocator

WIDTH, HEIGHT = 760, 300
LEFT, RIGHT, TOP, BOTTOM = 58, 12, 10, 42
MOST_POINTS = 3000  # more are thinned evenly
LONGEST_NAME = 60  # of a recording in the words of a point


@dataclass(frozen=True)
class Point:
    """A point: where, of what; low, high: an interval of y. told: what a reader sees on it.

    address: of the page that shows what it stands for.
    """

    x: float
    y: float
    recording: str
    signer: str
    told: str
    low: float | None = None
    high: float | None = None
    address: str = ""


def thinned(points: Sequence[Point], most: int = MOST_POINTS) -> tuple[Sequence[Point], str]:
    """Return no more than so many points, evenly chosen, and what a caption says of the rest."""
    if len(points) <= most:
        return points, ""
    chosen = np.linspace(0, len(points) - 1, most).round().astype(int)
    return [points[i] for i in chosen], f" Drawn: {most} of {len(points)} points, evenly chosen."


def scatter(
    points: Sequence[Point], x_label: str, y_label: str, finding: str, numbers: bool = True
) -> Markup:
    """Return a drawing of points; finding: its words for who does not see it.

    numbers: whether x is a scale (not just a rank).
    """
    finite = [p for p in points if np.isfinite(p.x) and np.isfinite(p.y)]
    ends = [v for p in finite for v in (p.low, p.high) if v is not None and np.isfinite(v)]
    x_ticks, x_of = _scale([p.x for p in finite], LEFT, WIDTH - RIGHT)
    y_ticks, y_of = _scale([*(p.y for p in finite), *ends], HEIGHT - BOTTOM, TOP)
    parts = [
        f'<svg class="plot" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
        f'aria-label="{escape(finding)}" xmlns="http://www.w3.org/2000/svg">'
    ]
    for tick in y_ticks:
        y = _at(y_of, tick)
        parts.append(f'<path class="grid" d="M{LEFT} {y}H{WIDTH - RIGHT}"/>')
        parts.append(f'<text x="{LEFT - 6}" y="{y}" dy="4" text-anchor="end">{tick:.4g}</text>')
    for tick in x_ticks if numbers else ():
        x = _at(x_of, tick)
        parts.append(f'<path class="axis" d="M{x} {HEIGHT - BOTTOM}v5"/>')
        place = f'x="{x}" y="{HEIGHT - BOTTOM + 17}"'
        parts.append(f'<text {place} text-anchor="middle">{tick:.4g}</text>')
    parts.append(f'<path class="axis" d="M{LEFT} {TOP}V{HEIGHT - BOTTOM}H{WIDTH - RIGHT}"/>')
    middle = (LEFT + WIDTH - RIGHT) / 2
    parts.append(
        f'<text x="{middle}" y="{HEIGHT - 6}" text-anchor="middle">{escape(x_label)}</text>'
    )
    turned = f'transform="translate(13 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)"'
    parts.append(f'<text {turned} text-anchor="middle">{escape(y_label)}</text>')
    for p in finite:
        x, y = _at(x_of, p.x), _at(y_of, p.y)
        line = ""
        if p.low is not None and p.high is not None and np.isfinite([p.low, p.high]).all():
            line = f'<path d="M{x} {_at(y_of, p.low)}V{_at(y_of, p.high)}"/>'
        about = f'data-recording="{escape(p.recording)}" data-signer="{escape(p.signer)}"'
        about += f' data-open="{escape(p.address)}"' if p.address else ""
        parts.append(
            f'<g {about}><title>{escape(p.told)}</title>{line}<circle cx="{x}" cy="{y}" r="3"/></g>'
        )
    parts.append("</svg>")
    return Markup("".join(parts))


Scale = tuple[float, float, float, float]  # low, high of the values; start, end on the drawing


def _scale(values: Sequence[float], start: float, end: float) -> tuple[list[float], Scale]:
    low, high = (min(values), max(values)) if values else (0.0, 1.0)
    if low == high:
        low, high = low - 0.5, high + 0.5
    room = (high - low) * 0.03
    low, high = low - room, high + room
    ticks = [float(t) for t in MaxNLocator(6).tick_values(low, high) if low <= t <= high]
    return ticks, (low, high, start, end)


def _at(scale: Scale, value: float) -> float:
    low, high, start, end = scale
    return round(start + (value - low) / (high - low) * (end - start), 1)
