"""Orientations: relative to the parent joint, and made from positions where none were recorded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

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
        of_parent = Rotation.from_quat(recording.orientations[there, parent])
        of_joint = Rotation.from_quat(recording.orientations[there, joint])
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
        out[there] = Rotation.from_matrix(matrices[there]).as_quat()
    return out
