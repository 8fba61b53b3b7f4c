"""Whether tags and motion run on one clock: the offset at which tags' edges lie nearest to minima.

Signs begin and end near minima of wrist speed (Naert et al. 2017, section 4): the mean speed at
the tags' edges, over shifts of all tags together, is lowest near the right clock.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

WIDEST_S = 10.0
STEP_S = 0.02
LEAST_TAGS = 10
CERTAIN = 4.0  # robust SDs of the profile: beyond the deepest of some hundred independent shifts
ALIKE_S = 0.25  # offsets up to this are how annotators tag, and no fault of the clock


@dataclass(frozen=True)
class Offset:
    """Shift to add to the tags (s), how far the profile dips there (robust SDs), and whether that
    is too far for chance. at_zero: how far it dips with the tags as they are."""

    offset_s: float
    depth: float
    at_zero: float

    @property
    def certain(self) -> bool:
        """Whether the dip is deeper than shifts by chance give."""
        return self.depth >= CERTAIN

    @property
    def wrong(self) -> bool:
        """Whether the tags are certainly on another clock."""
        return self.certain and abs(self.offset_s) > ALIKE_S and self.at_zero < self.depth / 2


def clock_offset(
    speed: NDArray[np.float64], rate_hz: float, edges_s: NDArray[np.float64]
) -> Offset | None:
    """Return the offset of tags to motion; None with too few tags or too short a recording.

    speed: (F,), of the faster hand, low-passed, NaN in gaps. edges_s: starts and ends of signs.
    """
    widest = min(WIDEST_S, len(speed) / rate_hz / 3)
    if len(edges_s) < 2 * LEAST_TAGS or widest < 1.0 or np.isnan(speed).all():
        return None
    shifts = np.arange(-round(widest / STEP_S), round(widest / STEP_S) + 1) * STEP_S
    # Ranks: a few fast movements must not decide.
    order = np.full(len(speed), np.nan)
    there = np.isfinite(speed)
    order[there] = np.argsort(np.argsort(speed[there])) / max(there.sum() - 1, 1)
    at = np.rint((edges_s[None, :] + shifts[:, None]) * rate_hz).astype(int)
    inside = (at >= 0) & (at < len(speed))
    values = np.where(inside, order[np.clip(at, 0, len(speed) - 1)], np.nan)
    enough = np.isfinite(values).sum(axis=1) >= 0.7 * len(edges_s)
    if enough.sum() < 20:
        return None
    profile = np.full(len(shifts), np.nan)
    profile[enough] = np.nanmean(values[enough], axis=1)
    middle = np.nanmedian(profile)
    scatter = 1.4826 * np.nanmedian(np.abs(profile - middle))
    if scatter == 0:
        return None
    depths = (middle - profile) / scatter
    best = int(np.nanargmax(depths))
    zero = int(np.argmin(np.abs(shifts)))
    near = depths[np.abs(shifts - shifts[zero]) <= ALIKE_S]
    at_zero = float(np.nanmax(near)) if np.isfinite(near).any() else 0.0
    return Offset(float(shifts[best]), float(depths[best]), at_zero)
