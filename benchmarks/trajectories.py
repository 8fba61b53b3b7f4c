"""Trajectories with known boundaries, and what a method's boundaries are worth on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import linear_sum_assignment

NOISE_SD = 0.8e-3  # m, the tracker of Endres et al. 2013
BIN_S = 0.015  # 1.5 s in 100 bins
SHORTEST_BINS = 15
TOLERANCE_S = 0.09  # half-width of the window of a hit


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Positions x (T, 3) in m, centred, and the true boundaries in s."""

    x: NDArray[np.float64]
    boundaries_s: NDArray[np.float64]


def simulate(rng: np.random.Generator, bins: int, segments: int) -> Trajectory:
    """Return cubic segments, position and velocity continuous at their joins, with noise.

    The joins are uniform among those that leave each segment 15 bins or more.
    """
    spare = bins - segments * SHORTEST_BINS
    cuts = np.sort(rng.choice(spare + segments - 1, segments - 1, replace=False))
    joins = cuts - np.arange(segments - 1) + SHORTEST_BINS * np.arange(1, segments)
    edges_s = np.array([0, *joins, bins]) * BIN_S
    position = rng.normal(0, 0.1, (segments + 1, 3))
    velocity = rng.normal(0, 0.5, (segments + 1, 3))
    curve = CubicHermiteSpline(edges_s, position, velocity)
    x = curve((np.arange(bins) + 0.5) * BIN_S) + rng.normal(0, NOISE_SD, (bins, 3))
    return Trajectory(x - x.mean(0), edges_s[1:-1])


def score(found: NDArray[np.int64], truth: Trajectory) -> tuple[int, int]:
    """Return the hits and the false positives of boundaries, given as first bins of segments.

    One to one: a true boundary is hit once, by the assignment with the most hits.
    """
    found_s = np.asarray(found, dtype=float) * BIN_S
    near = np.abs(found_s[:, None] - truth.boundaries_s) <= TOLERANCE_S + 1e-9
    rows, columns = linear_sum_assignment(-near.astype(float))
    hits = int(near[rows, columns].sum())
    return hits, len(found_s) - hits
