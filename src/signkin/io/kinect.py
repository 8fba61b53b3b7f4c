"""Kinect skeletons as text: a row a frame, x, y, z in metres, of 20 joints or of 25 (Kinect v2).

The 25 joints stand in the order of Microsoft's SDK 2 (enumeration JointType). The 20 joints stand
in an order of their own; Microsoft's SDK starts at the hips. The order was inferred from the
lengths between joints, which are those of arms and legs in this order alone; a test on the
recordings holds it to that. y points up as the sensor stands, z away from it, x to its left, which
is the right of someone who faces it. The file tells no rate.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.io.archive import read_numbers
from signkin.io.chosen import FURTHEST, pick
from signkin.io.registry import SourceMotion, motion_reader

JOINTS = (
    "head", "neck", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow",
    "left_wrist", "right_wrist", "left_hand", "right_hand", "spine", "hip_centre",
    "left_hip", "right_hip", "left_knee", "right_knee", "left_ankle", "right_ankle",
    "left_foot", "right_foot",
)  # fmt: skip

# Kinect for Windows SDK 2.0, enumeration JointType.
JOINTS_V2 = (
    "hip_centre", "spine", "neck", "head", "left_shoulder", "left_elbow", "left_wrist",
    "left_hand", "right_shoulder", "right_elbow", "right_wrist", "right_hand", "left_hip",
    "left_knee", "left_ankle", "left_foot", "right_hip", "right_knee", "right_ankle",
    "right_foot", "spine_shoulder", "left_hand_tip", "left_thumb", "right_hand_tip",
    "right_thumb",
)  # fmt: skip


# The sensor sees bodies up to 4.5 m away; beyond this, the numbers are no metres.
FURTHEST_M = 50.0


@motion_reader("kinect_v2")
def read_kinect_v2(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    face_sensor: bool = False,
) -> SourceMotion:
    """Read one recording of the second Kinect: 75 columns, names in `JOINTS_V2`.

    Otherwise as `read_kinect`.
    """
    return _read(path, JOINTS_V2, joints, part, face_sensor)


@motion_reader("kinect")
def read_kinect(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    face_sensor: bool = False,
) -> SourceMotion:
    """Read one recording, a text file or a member of an archive of them.

    joints: canonical name -> name in `JOINTS`. part: the member of the archive.
    face_sensor: turn the skeleton about the vertical until the shoulders, by their median over
    the recording, lie along x: for signers who stood at an angle to the sensor.
    """
    return _read(path, JOINTS, joints, part, face_sensor)


def _read(
    path: Path,
    order: tuple[str, ...],
    joints: Mapping[str, str] | None,
    part: str | None,
    face_sensor: bool,
) -> SourceMotion:
    table = read_numbers(path, part, 3 * len(order))
    positions = table.reshape(len(table), len(order), 3)
    there = np.abs(positions[(positions != 0) & np.isfinite(positions)])
    if there.size and (far := float(np.median(there))) > FURTHEST_M:
        raise SignkinError(
            f"coordinates of {far:.4g} (the median), which no sensor sees in metres",
            expected="metres",
            todo="Read it as csv with header_rows: 0 and the unit declared.",
        )
    if face_sensor:
        positions = _facing(positions, order)
    names, chosen = pick(order, joints)
    return SourceMotion(
        rate_hz=None, joints=names, positions=np.ascontiguousarray(positions[:, chosen]), unit="m"
    )


def _facing(positions: NDArray[np.float64], order: tuple[str, ...]) -> NDArray[np.float64]:
    """Turn positions (F, J, 3) about y, around the hips."""
    right, left = order.index("right_shoulder"), order.index("left_shoulder")
    x, _, z = np.median(positions[:, right] - positions[:, left], axis=0)
    width = float(np.hypot(x, z))
    if not 0 < width < FURTHEST:
        raise SignkinError(
            "both shoulders at one place" if width == 0 else f"shoulders {width:g} m apart",
            expected="shoulders apart, to turn by",
        )
    cos, sin = x / width, z / width
    turn = np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
    centre = np.median(positions[:, order.index("hip_centre")], axis=0)
    return np.asarray((positions - centre) @ turn.T + centre)
