"""Scores on frames as the evaluation of Renz et al. (2021) defines them: mF1B and mF1S.

Their repository, RenzKa/sign-segmentation, labels each frame as sign (0) or boundary (1). A run of
boundary frames is one boundary, which stands at its middle; a run of sign frames is one segment.
Predicted and true ones are paired greedily, the nearest (or the one that overlaps most) first.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.segments.boundaries import Hits

Labels = NDArray[np.int8]
SIGN, BOUNDARY = 0, 1
RATE_HZ = 25.0  # of the videos that the scores were made for
BOUNDARY_FRAMES = (1, 2, 3, 4)
# As that repository steps through them: its 0.65 is a hair less, so 13 of 20 frames are enough.
LEAST_IOU = tuple(float(least) for least in np.arange(0.4, 0.76, 0.05))


def frame_labels(
    segments: NDArray[np.float64], span_s: tuple[float, float], rate_hz: float = RATE_HZ
) -> Labels:
    """Return the label of each frame of a span, 0 in signs and 1 at and between boundaries.

    segments: (N, 2) starts and ends in s. The frames next to a start and an end are boundary
    frames, as in that repository, so that signs without a gap are two segments. Differing from
    it, all frames between two signs are boundary, also where a pause is long.
    """
    first = int(np.rint(span_s[0] * rate_hz))
    frames = int(np.rint(span_s[1] * rate_hz)) - first + 1
    labels = np.full(frames, BOUNDARY, dtype=np.int8)
    edges = np.clip(np.rint(segments * rate_hz).astype(int) - first, 0, frames - 1)
    for start, end in edges.tolist():
        labels[start + 1 : end] = SIGN
    labels[edges.ravel()] = BOUNDARY
    return labels


def runs(labels: Labels, label: int) -> NDArray[np.int64]:
    """Return first frame and frame after the last of each run of a label, (R, 2)."""
    there = np.concatenate([[False], labels == label, [False]]).astype(np.int8)
    change = np.diff(there)
    return np.column_stack([np.flatnonzero(change == 1), np.flatnonzero(change == -1)])


def boundary_f1(
    predicted: Labels, reference: Labels, frames: tuple[int, ...] = BOUNDARY_FRAMES
) -> dict[int, Hits]:
    """Return the boundary hits at each tolerance in frames; mF1B is the mean of their F1.

    predicted, reference: (F,) labels. Pairs are made once, nearest first, and a pair hits where
    it is at most the tolerance apart.
    """
    p, r = (runs(labels, BOUNDARY).mean(axis=1) for labels in (predicted, reference))
    i, j, apart = _near(p, r, max(frames))
    kept = apart[_greedy(i, j, apart)]
    return {k: Hits(int((kept <= k).sum()), len(p), len(r)) for k in frames}


def segment_f1(
    predicted: Labels, reference: Labels, least_iou: tuple[float, ...] = LEAST_IOU
) -> dict[float, Hits]:
    """Return the segment hits at each least overlap; mF1S is the mean of their F1.

    A pair hits where its intersection over union is above (not at) the least; see LEAST_IOU.
    """
    p, r = (runs(labels, SIGN) for labels in (predicted, reference))
    if not len(p) or not len(r):
        return {least: Hits(0, len(p), len(r)) for least in least_iou}
    # Runs of one side are apart, so those of the other that meet one stand next to each other.
    low = np.searchsorted(r[:, 1], p[:, 0], side="right")
    high = np.searchsorted(r[:, 0], p[:, 1], side="left")
    i, j = _ranges(low, high)
    shared = np.minimum(p[i, 1], r[j, 1]) - np.maximum(p[i, 0], r[j, 0])
    iou = shared / (np.maximum(p[i, 1], r[j, 1]) - np.minimum(p[i, 0], r[j, 0]))
    kept = iou[_greedy(i, j, -iou)]
    return {least: Hits(int((kept > least).sum()), len(p), len(r)) for least in least_iou}


def mean_f1(hits: dict[int, Hits] | dict[float, Hits]) -> float:
    """Return the mean F1 over tolerances (mF1B, mF1S as shares); 0 where nothing hits."""
    return float(np.mean([0.0 if not h.hits else h.f1 for h in hits.values()]))


def _near(
    p: NDArray[np.float64], r: NDArray[np.float64], most: float
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Return all pairs at most so far apart: indices and distances. A pair further cannot hit."""
    i, j = _ranges(
        np.searchsorted(r, p - most, side="left"), np.searchsorted(r, p + most, side="right")
    )
    return i, j, np.abs(p[i] - r[j])


def _ranges(
    low: NDArray[np.int64], high: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return (i, j) for each j from low[i] up to high[i]."""
    count = np.maximum(high - low, 0)
    i = np.repeat(np.arange(len(low)), count)
    within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    return i, low[i] + within


def _greedy(
    i: NDArray[np.int64], j: NDArray[np.int64], cost: NDArray[np.float64]
) -> NDArray[np.int64]:
    """Return which pairs are taken: the cheapest first, each side once; ties by i, then j."""
    order = np.lexsort((j, i, cost))
    kept: list[int] = []
    used_i: set[int] = set()
    used_j: set[int] = set()
    for k, one, other in zip(order.tolist(), i[order].tolist(), j[order].tolist(), strict=True):
        if one not in used_i and other not in used_j:
            used_i.add(one)
            used_j.add(other)
            kept.append(k)
    return np.array(kept, dtype=np.int64)
