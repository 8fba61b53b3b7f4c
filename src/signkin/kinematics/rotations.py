"""Orientations: relative to the parent joint, made from positions where none were recorded, and
between two postures."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import scipy  # loads its parts when they are used
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.recording import Recording

# A limb frame wants two directions; below this sine of their angle the second one is lost.
LEAST_SINE = 0.02


def parent_relative(recording: Recording) -> NDArray[np.float64]:
    """Return orientations relative to each joint's parent, (F, J, 4); roots stay in the world.

    Raises SignkinError where the recording has no orientations or no hierarchy.
    """
    if recording.orientations is None or recording.parents is None:
        raise SignkinError(
            "no orientations, or no hierarchy of joints",
            file=f"recording {recording.name}",
            expected="both, for orientations relative to the parent joint",
        )
    out = recording.orientations.copy()
    for joint, parent in enumerate(recording.parents):
        if parent < 0:
            continue
        there = ~np.isnan(recording.orientations[:, (joint, parent)]).any(axis=(1, 2))
        of_parent = scipy.spatial.transform.Rotation.from_quat(
            recording.orientations[there, parent]
        )
        of_joint = scipy.spatial.transform.Rotation.from_quat(recording.orientations[there, joint])
        out[:, joint] = np.nan
        out[there, joint] = (of_parent.inv() * of_joint).as_quat()
    return out


def with_limb_frames(recording: Recording) -> Recording:
    """Return the recording with orientations made from limbs and palms, NaN for other joints.

    Upper arm (at the shoulder): along the limb, and normal to the plane of the arm.
    Forearm (at the elbow): along the limb, and the palm's side-to-side direction where the
    knuckles of index and little finger are known, so that turning the forearm is seen,
    else the arm's plane. Palm (at the wrist): towards the middle of the knuckles, and from
    the little finger's to the index finger's. Where a limb's two directions are parallel,
    the frame is a gap.
    """
    orientations = np.full((recording.frames, len(recording.joints), 4), np.nan)
    for hand in ("right", "left"):
        frames = _arm_frames(recording, hand)
        for part, quaternions in frames.items():
            orientations[:, recording.index(f"{hand}_{part}")] = quaternions
    if np.isnan(orientations).all():
        raise SignkinError(
            "no limb frame can be made",
            file=f"recording {recording.name}",
            place="orientations",
            expected="shoulder, elbow and wrist, or wrist, index_1 and pinky_1, of one side",
            todo="Set `orientations: none` in corpus.yaml.",
        )
    return replace(recording, orientations=orientations, orientation_source="limb_frames")


def _arm_frames(recording: Recording, hand: str) -> dict[str, NDArray[np.float64]]:
    def track(part: str) -> NDArray[np.float64] | None:
        joint = f"{hand}_{part}"
        return recording.track(joint) if joint in recording.joints else None

    shoulder, elbow, wrist = track("shoulder"), track("elbow"), track("wrist")
    index, pinky = track("index_1"), track("pinky_1")
    out: dict[str, NDArray[np.float64]] = {}
    across = None if index is None or pinky is None else index - pinky
    if wrist is not None and index is not None and pinky is not None and across is not None:
        out["wrist"] = frame_of((index + pinky) / 2 - wrist, across)
    if shoulder is not None and elbow is not None and wrist is not None:
        normal = np.cross(elbow - shoulder, wrist - elbow)
        out["shoulder"] = frame_of(elbow - shoulder, normal)
        out["elbow"] = frame_of(wrist - elbow, normal if across is None else across)
    return out


def frame_of(along: NDArray[np.float64], beside: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return quaternions (F, 4) of frames with x along the first direction, y near the second."""
    with np.errstate(invalid="ignore", divide="ignore"):
        x = along / np.linalg.norm(along, axis=1, keepdims=True)
        z = np.cross(x, beside)
        sine = np.linalg.norm(z, axis=1) / np.linalg.norm(beside, axis=1)
        z = z / np.linalg.norm(z, axis=1, keepdims=True)
        there = sine > LEAST_SINE
    matrices = np.stack([x, np.cross(z, x), z], axis=2)
    out = np.full((len(along), 4), np.nan)
    if there.any():
        out[there] = scipy.spatial.transform.Rotation.from_matrix(matrices[there]).as_quat()
    return out


# --- quaternions as arrays -------------------------------------------------------------------
# For stacks of (frames, joints, 4), where scipy's Rotation takes flat lists only.


def multiply(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the product a b of scalar-last quaternions (..., 4): b first, then a."""
    av, aw, bv, bw = a[..., :3], a[..., 3:], b[..., :3], b[..., 3:]
    vector = aw * bv + bw * av + _cross(av, bv)
    scalar = aw * bw - (av * bv).sum(axis=-1, keepdims=True)
    return np.concatenate([vector, scalar], axis=-1)


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    # numpy's own takes five times as long for the few joints of a body.
    return a[..., (1, 2, 0)] * b[..., (2, 0, 1)] - a[..., (2, 0, 1)] * b[..., (1, 2, 0)]


def inverse(q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the inverse of unit quaternions (..., 4)."""
    return q * np.array([-1.0, -1.0, -1.0, 1.0])


def rotate(q: NDArray[np.float64], vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn vectors (..., 3) by unit quaternions (..., 4)."""
    axis, scalar = q[..., :3], q[..., 3:]
    twice = 2 * _cross(axis, vectors)
    return vectors + scalar * twice + _cross(axis, twice)


def unbroken(q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Choose between q and -q, one rotation, so that each frame (axis 0) follows the last one."""
    turns = np.where((q[1:] * q[:-1]).sum(axis=-1, keepdims=True) < 0, -1.0, 1.0)
    signs = np.concatenate([np.ones_like(q[:1, ..., :1]), np.cumprod(turns, axis=0)])
    return q * signs


def slerp(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    weight: NDArray[np.float64],
    shorter: bool = True,
) -> NDArray[np.float64]:
    """Return the rotations on the arcs from a (weight 0) to b (weight 1), at constant speed.

    a, b: (..., 4) unit quaternions; weight: broadcast against their last axis. shorter: go the
    shorter way round; else the signs of a and b tell the way.
    """
    cosine = (a * b).sum(axis=-1, keepdims=True)
    # Exactly opposite quaternions are one rotation, and have no arc between them.
    b = np.where(cosine < (0 if shorter else -1 + 1e-15), -b, b)
    # The half angle by its tangent: the arc cosine loses small angles.
    half = np.arctan2(np.linalg.norm(b - a, axis=-1), np.linalg.norm(b + a, axis=-1))[..., None]
    angle = 2 * half
    sine = np.sin(angle)
    near = sine < 1e-9
    safe = np.where(near, 1.0, sine)
    first = np.where(near, 1 - weight, np.sin((1 - weight) * angle) / safe)
    second = np.where(near, weight, np.sin(weight * angle) / safe)
    return _unit(first * a + second * b)


def linear(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    weight: NDArray[np.float64],
    shorter: bool = True,
) -> NDArray[np.float64]:
    """Return (1 - weight) a + weight b brought to length 1 (arguments as `slerp`).

    The same arcs as slerp's, faster in their middle.
    """
    if shorter:
        b = np.where((a * b).sum(axis=-1, keepdims=True) < 0, -b, b)
    return _unit((1 - weight) * a + weight * b)


def _unit(q: NDArray[np.float64]) -> NDArray[np.float64]:
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def local_pose(
    positions: NDArray[np.float64], orientations: NDArray[np.float64], parents: tuple[int, ...]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return shifts (F, J, 3) and rotations (F, J, 4) of joints in their parents' frames.

    Roots (parent -1) stay in the world. The inverse of `world_pose`.
    """
    at = np.array(parents)
    child = np.flatnonzero(at >= 0)
    shifts, rotations = positions.copy(), orientations.copy()
    back = inverse(orientations[:, at[child]])
    shifts[:, child] = rotate(back, positions[:, child] - positions[:, at[child]])
    rotations[:, child] = multiply(back, orientations[:, child])
    return shifts, rotations


def world_pose(
    shifts: NDArray[np.float64], rotations: NDArray[np.float64], parents: tuple[int, ...]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return world positions (F, J, 3) and orientations (F, J, 4): forward kinematics."""
    positions, orientations = shifts.copy(), rotations.copy()
    for joints, above in _levels(parents):
        turn = orientations[:, above]
        positions[:, joints] = positions[:, above] + rotate(turn, shifts[:, joints])
        orientations[:, joints] = multiply(turn, rotations[:, joints])
    return positions, orientations


@lru_cache(maxsize=64)
def _levels(parents: tuple[int, ...]) -> list[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Return the joints of each depth below the roots, and their parents: downwards."""

    def depth(joint: int) -> int:
        return 0 if parents[joint] < 0 else 1 + depth(parents[joint])

    depths = np.array([depth(joint) for joint in range(len(parents))])
    at = np.array(parents)
    levels = (np.flatnonzero(depths == d) for d in range(1, depths.max(initial=0) + 1))
    return [(joints, at[joints]) for joints in levels]
