"""Axes of a file and canonical ones: right, forward, up; and rotations in either."""

from __future__ import annotations

import numpy as np
import scipy  # loads its parts when they are used
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.io.text import quoted


def axis_basis(up: str, right: str) -> NDArray[np.float64]:
    """Return the rotation (3, 3) that takes file axes to right, forward, up.

    Its rows are the signer's right, forward (up x right) and up, as the file
    names them; both axes are written `x`, `-y` and so on.
    """
    z, x = _axis(up, "up"), _axis(right, "right")
    if abs(z @ x) > 0:
        raise SignkinError(
            f"up is {up} and right is {right}", place="axes", expected="two different axes"
        )
    return np.array([x, np.cross(z, x), z])


def _axis(text: str, key: str) -> NDArray[np.float64]:
    name = text.removeprefix("-") if isinstance(text, str) else ""
    if name not in ("x", "y", "z"):
        raise SignkinError(
            f"{key} is {quoted(text)}",
            place="axes",
            expected="x, y or z, with or without a minus sign",
        )
    axis = np.zeros(3)
    axis["xyz".index(name)] = -1.0 if text.startswith("-") else 1.0
    return axis


def turned(orientations: NDArray[np.float64], basis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Express rotations of world space in turned axes: R q R^-1."""
    turn = scipy.spatial.transform.Rotation.from_matrix(basis)
    flat = orientations.reshape(-1, 4)
    out = np.full_like(flat, np.nan)
    there = ~np.isnan(flat).any(axis=1)
    if there.any():
        out[there] = (
            turn * scipy.spatial.transform.Rotation.from_quat(flat[there]) * turn.inv()
        ).as_quat()
    return continuous(out.reshape(orientations.shape))


def continuous(quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Choose between q and -q (the same rotation) so that each follows its predecessor smoothly.

    quaternions: (F, J, 4); the first of each joint gets w >= 0. NaN frames are passed over.
    """
    out: NDArray[np.float64] = quaternions.copy()
    for joint in range(out.shape[1]):
        track = out[:, joint]
        there = np.flatnonzero(~np.isnan(track).any(axis=1))
        if not there.size:
            continue
        valid = track[there]
        flips = np.ones(len(there))
        flips[0] = -1.0 if valid[0, 3] < 0 else 1.0
        flips[1:] = np.where((valid[1:] * valid[:-1]).sum(axis=1) < 0, -1.0, 1.0)
        out[there, joint] = valid * np.cumprod(flips)[:, None]
    return out
