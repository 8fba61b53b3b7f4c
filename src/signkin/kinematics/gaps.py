"""Gaps: short ones are filled, long ones stay, every frame is counted.

Nothing else in the package fills a gap, and nothing is extrapolated: a gap at
the start or end of a recording stays.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator


def stretches(there: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the runs of True as (first, last + 1)."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], there.astype(np.int8), [0]))))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def fill_gaps(
    track: NDArray[np.float64], rate_hz: float, longest_gap_s: float
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Fill the gaps of a track that are no longer than `longest_gap_s`.

    track: (F, 3), NaN in gaps; a frame with any NaN is a gap.
    Returns the filled track and which frames were filled, (F,). The filling is a
    shape-preserving cubic (PCHIP), which does not overshoot.
    """
    gap = np.asarray(np.isnan(track).any(axis=1))
    filled = np.zeros(len(track), dtype=bool)
    longest = longest_gap_s * rate_hz + 1e-9
    for first, end in stretches(gap):
        if first > 0 and end < len(track) and end - first <= longest:
            filled[first:end] = True
    out = track.copy()
    if filled.any():
        frames = np.arange(len(track))
        out[filled] = PchipInterpolator(frames[~gap], track[~gap])(frames[filled])
    out[gap & ~filled] = np.nan
    return out, filled


def longest_stretch_s(gap: NDArray[np.bool_], rate_hz: float) -> float:
    """Return the length of the longest gap in seconds."""
    return max((b - a for a, b in stretches(gap)), default=0) / rate_hz
