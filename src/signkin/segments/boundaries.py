"""Boundaries of two segmentations: hits within a tolerance, distances, offsets. All in seconds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from signkin.errors import SignkinError

Floats = NDArray[np.float64]
SLACK_S = 1e-6  # times on a frame grid are floating-point numbers: this much more is on the edge


@dataclass(frozen=True)
class Hits:
    """Pairs of boundaries within a tolerance, each boundary in one pair at most."""

    hits: int
    predicted: int
    reference: int

    @property
    def hit_rate(self) -> float:
        """Share of the reference's boundaries that are hit (recall); NaN where it has none."""
        return self.hits / self.reference if self.reference else float("nan")

    @property
    def precision(self) -> float:
        """Share of the predicted boundaries that hit; NaN where there are none."""
        return self.hits / self.predicted if self.predicted else float("nan")

    @property
    def f1(self) -> float:
        """Harmonic mean of both; NaN where neither side has a boundary."""
        both = self.predicted + self.reference
        return 2 * self.hits / both if both else float("nan")

    def __add__(self, other: Hits) -> Hits:
        """Pool the counts, as of starts and ends."""
        return Hits(
            self.hits + other.hits,
            self.predicted + other.predicted,
            self.reference + other.reference,
        )


def boundary_hits(predicted_s: ArrayLike, reference_s: ArrayLike, tolerance_s: float) -> Hits:
    """Count the most pairs of boundaries that are at most `tolerance_s` apart (inclusive).

    predicted_s, reference_s: (N,), (M,) times in any order. Each boundary is in one pair at
    most; giving each, in order of time, the earliest partner still free makes the most pairs.
    """
    if not (np.isfinite(tolerance_s) and tolerance_s >= 0):
        raise SignkinError(
            f"a tolerance of {tolerance_s:g} s", place="boundaries", expected="0 or more"
        )
    p, r = _times(predicted_s).tolist(), _times(reference_s).tolist()  # numbers, quick to compare
    most = tolerance_s + SLACK_S
    hits = i = j = 0
    while i < len(p) and j < len(r):
        if abs(p[i] - r[j]) <= most:
            hits, i, j = hits + 1, i + 1, j + 1
        elif p[i] < r[j]:
            i += 1
        else:
            j += 1
    return Hits(hits, len(p), len(r))


def hausdorff_s(predicted_s: ArrayLike, reference_s: ArrayLike) -> float:
    """Return the largest distance of a boundary to the nearest of the other side; NaN without."""
    p, r = _times(predicted_s), _times(reference_s)
    if not len(p) or not len(r):
        return float("nan")
    return float(max(np.abs(_to_nearest(p, r)).max(), np.abs(_to_nearest(r, p)).max()))


def offsets_s(predicted_s: ArrayLike, reference_s: ArrayLike) -> Floats:
    """Return how far each reference boundary's nearest predicted one comes after it, (M,).

    Negative: the predicted one leads. NaN where nothing is predicted.
    """
    p, r = _times(predicted_s), _times(reference_s)
    return _to_nearest(r, p) if len(p) else np.full(len(r), np.nan)


def _to_nearest(times: Floats, others: Floats) -> Floats:
    """Return nearest other minus time (the earlier of two equally near); others: sorted."""
    after = np.searchsorted(others, times)
    right = others[np.minimum(after, len(others) - 1)]
    left = others[np.maximum(after - 1, 0)]
    return np.where(np.abs(times - left) <= np.abs(right - times), left, right) - times


def _times(values: ArrayLike) -> Floats:
    times = np.asarray(values, dtype=float)
    if times.ndim != 1 or not np.isfinite(times).all():
        raise SignkinError(
            f"boundaries of shape {times.shape}, {np.count_nonzero(~np.isfinite(times))} "
            "without a time",
            place="boundaries",
            expected="(N,) times in seconds",
        )
    return np.sort(times)
