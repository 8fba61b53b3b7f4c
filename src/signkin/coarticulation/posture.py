"""Distances between two postures (Naert et al. 2017, section 5.1, equations 1 and 2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.masked import unmasked


def geodesic_distance(q1: NDArray[np.float64], q2: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the mean over joints of ||log(q1^-1 q2)||, in radians (eq. 1).

    q1, q2: (..., J, 4) unit quaternions, scalar-last. The logarithm of a unit quaternion
    has the norm of *half* the rotation angle; that is what is returned. q and -q are one
    rotation. Joints with a gap in either posture are left out of the mean; without any
    joint the result is NaN.
    """
    q1, q2 = unmasked(q1), unmasked(q2)
    cosine = np.abs((q1 * q2).sum(axis=-1))
    # The vector part of q1^-1 q2; atan2 keeps small angles exact, where arccos does not.
    a, b = q1[..., :3], q2[..., :3]
    vector = q1[..., 3:] * b - q2[..., 3:] * a - np.cross(a, b)
    return _mean_over_joints(np.arctan2(np.linalg.norm(vector, axis=-1), cosine))


def euclidean_distance(p1: NDArray[np.float64], p2: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the mean over joints of ||p1 - p2||, in the positions' unit (eq. 2).

    p1, p2: (..., J, 3). Joints with a gap in either posture are left out of the mean.
    """
    return _mean_over_joints(np.linalg.norm(unmasked(p1) - unmasked(p2), axis=-1))


def _mean_over_joints(values: NDArray[np.float64]) -> NDArray[np.float64]:
    there = ~np.isnan(values)
    count = there.sum(axis=-1)
    total = np.where(there, values, 0.0).sum(axis=-1)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def normalised(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Take the mean off and divide by the range (section 5.1); NaN stays, a range of 0 gives 0."""
    finite = values[np.isfinite(values)]
    if not len(finite):
        return np.full_like(values, np.nan)
    span = finite.max() - finite.min()
    return (values - finite.mean()) / (span if span > 0 else 1.0)
