"""A signing body: a skeleton as BVH has it, and arm coordinates that pose it.

Each arm has twelve coordinates (radians): shoulder x, y, z, elbow flexion,
forearm twist, wrist flexion, wrist tilt, and the flexion of five fingers. The
same numbers on both arms make mirror images. Centimetres, y up, the signer
faces +z, so that the signer's right is -x.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from signkin.io.bvh import Hierarchy

ARM_COORDINATES = 12
ARM_MOVES = slice(0, 4)  # coordinates that carry the wrist
HAND_MOVES = slice(4, 12)  # coordinates that turn the hand and shape it
RELAXED_FINGERS = 0.25  # flexion of each finger joint at coordinate 0, radians

Offset = tuple[float, float, float]

_TORSO: tuple[tuple[str, str | None, Offset], ...] = (
    ("Hips", None, (0, 95, 0)),
    ("Spine", "Hips", (0, 12, 0)),
    ("Chest", "Spine", (0, 15, 0)),
    ("Neck", "Chest", (0, 22, 0)),
    ("Head", "Neck", (0, 10, 1)),
)
# The right arm in a T-pose; the left one is its mirror image.
_ARM: tuple[tuple[str, str, Offset], ...] = (
    ("Collar", "Chest", (-3, 17, 1)),
    ("Arm", "Collar", (-14, 0, 0)),
    ("ForeArm", "Arm", (-28, 0, 0)),
    ("Hand", "ForeArm", (-25, 0, 0)),
)
_FINGERS: dict[str, tuple[Offset, ...]] = {
    "Thumb": ((-3, -1, 3), (-3.5, 0, 1.5), (-3, 0, 1)),
    "Index": ((-9, 0, 2.5), (-4, 0, 0), (-2.5, 0, 0)),
    "Middle": ((-9.2, 0, 0.5), (-4.5, 0, 0), (-2.8, 0, 0)),
    "Ring": ((-8.8, 0, -1.5), (-4.2, 0, 0), (-2.6, 0, 0)),
    "Pinky": ((-8.2, 0, -3.5), (-3.3, 0, 0), (-2, 0, 0)),
}
_TIP: dict[str, Offset] = {"Thumb": (-2.5, 0, 0.5), "Pinky": (-1.8, 0, 0)}
_MIRROR = np.array([-1.0, 1.0, 1.0])


def skeleton() -> Hierarchy:
    """Return the hierarchy: torso, arms, three joints a finger, end sites at the tips."""
    rows: list[tuple[str, str | None, NDArray[np.float64], bool]] = []
    for name, parent, offset in _TORSO:
        rows.append((name, parent, np.array(offset, dtype=float), False))
    rows.append(("Head_end", "Head", np.array([0.0, 18.0, 0.0]), True))
    for side, mirror in (("Right", np.ones(3)), ("Left", _MIRROR)):
        for name, parent, offset in _ARM:
            above = parent if parent == "Chest" else f"{side}{parent}"
            rows.append((f"{side}{name}", above, np.array(offset, dtype=float) * mirror, False))
        for finger, offsets in _FINGERS.items():
            above = f"{side}Hand"
            for i, offset in enumerate(offsets, start=1):
                rows.append(
                    (f"{side}{finger}{i}", above, np.array(offset, dtype=float) * mirror, False)
                )
                above = f"{side}{finger}{i}"
            tip = np.array(_TIP.get(finger, (-2.2, 0, 0))) * mirror
            rows.append((f"{above}_end", above, tip, True))
    names = [row[0] for row in rows]
    rotations = ("Zrotation", "Xrotation", "Yrotation")
    positions = ("Xposition", "Yposition", "Zposition")
    return Hierarchy(
        joints=tuple(names),
        parents=tuple(-1 if row[1] is None else names.index(row[1]) for row in rows),
        offsets=np.array([row[2] for row in rows], dtype=float),
        channels=tuple(
            () if row[3] else ((*positions, *rotations) if row[1] is None else rotations)
            for row in rows
        ),
    )


# Neutral signing space: the right upper arm hangs a little forward, the forearm points ahead.
_UPPER_ARM = np.array([-0.30, -0.90, 0.32])
_FOREARM = np.array([0.30, 0.20, 0.93])


def _home() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return rotations of shoulder and elbow that take the T-pose to neutral signing space.

    The elbow is a hinge about its own y axis, which is laid across the arm's plane.
    """
    upper = _UPPER_ARM / np.linalg.norm(_UPPER_ARM)
    fore = _FOREARM / np.linalg.norm(_FOREARM)
    hinge = np.cross(upper, fore)
    hinge /= np.linalg.norm(hinge)
    shoulder = np.column_stack([-upper, hinge, np.cross(-upper, hinge)])
    bend = np.arccos(upper @ fore)
    return shoulder, _rodrigues(np.array([0.0, bend, 0.0]))


class Body:
    """Poses a skeleton: coordinates of both arms -> local rotations -> positions."""

    def __init__(self) -> None:
        """Prepare the places of the joints that the coordinates move."""
        self.hierarchy = skeleton()
        self._home_shoulder, self._home_elbow = _home()
        index = {name: i for i, name in enumerate(self.hierarchy.joints)}
        self.moving = [i for i, c in enumerate(self.hierarchy.channels) if c]
        self._arm = {s: [index[f"{s}{n}"] for n in ("Arm", "ForeArm", "Hand")] for s in _SIDES}
        self._fingers = {
            s: [[index[f"{s}{f}{i}"] for i in (1, 2, 3)] for f in _FINGERS] for s in _SIDES
        }
        self._generations = _generations(self.hierarchy.parents)

    def rotations(
        self, right: NDArray[np.float64], left: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return local rotation matrices (N, J, 3, 3) for arm coordinates (N, 12) each."""
        n = len(right)
        zero = np.zeros(n)
        vectors = [
            vector
            for arm in (right, left)
            for vector in (
                arm[:, 0:3],
                np.column_stack([arm[:, 4], arm[:, 3], zero]),
                np.column_stack([zero, arm[:, 6], arm[:, 5]]),
                *(
                    np.column_stack([zero, zero, RELAXED_FINGERS + arm[:, 7 + f]])
                    for f in range(len(_FINGERS))
                ),
            )
        ]
        # scipy takes longer to look at what it is given than to turn it: all at once.
        turned = iter(_rodrigues(np.concatenate(vectors)).reshape(-1, n, 3, 3))
        out = np.tile(np.eye(3), (n, len(self.hierarchy.joints), 1, 1))
        for side in _SIDES:
            flip = np.diag(_MIRROR) if side == "Left" else np.eye(3)
            arm, forearm, hand = self._arm[side]
            out[:, arm] = flip @ (self._home_shoulder @ next(turned)) @ flip
            out[:, forearm] = flip @ (self._home_elbow @ next(turned)) @ flip
            out[:, hand] = flip @ next(turned) @ flip
            for joints in self._fingers[side]:
                out[:, joints] = (flip @ next(turned) @ flip)[:, None]
        return out

    def place(
        self, rotations: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return world positions (N, J, 3) in cm and world rotations (N, J, 3, 3)."""
        positions = np.empty(rotations.shape[:3])
        world = np.empty_like(rotations)
        for joints, parents in self._generations:
            if parents[0] < 0:
                positions[:, joints] = self.hierarchy.offsets[joints]
                world[:, joints] = rotations[:, joints]
            else:
                above = world[:, parents]
                shift = (above @ self.hierarchy.offsets[joints][..., None])[..., 0]
                positions[:, joints] = positions[:, parents] + shift
                world[:, joints] = above @ rotations[:, joints]
        return positions, world

    def distances(
        self, first: NDArray[np.float64], second: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return geodesic (rad, half the angle) and Euclidean (cm) means over the moving joints.

        first, second: coordinates (N, 24) of both arms, right then left.
        """
        p1, r1 = self.place(self.rotations(first[:, :12], first[:, 12:]))
        p2, r2 = self.place(self.rotations(second[:, :12], second[:, 12:]))
        euclidean = np.linalg.norm(p1 - p2, axis=2)[:, self.moving].mean(axis=1)
        trace = (r1 * r2).sum(axis=(2, 3))[:, self.moving]
        geodesic = np.arccos(np.clip((trace - 1) / 2, -1, 1)) / 2
        return geodesic.mean(axis=1), euclidean


_SIDES = ("Right", "Left")


def _generations(parents: Sequence[int]) -> list[tuple[list[int], list[int]]]:
    """Return joints as far from a root as one another, with their parents: (joints, parents)."""
    depth: list[int] = []
    for parent in parents:
        depth.append(0 if parent < 0 else depth[parent] + 1)
    joints = [[j for j, d in enumerate(depth) if d == level] for level in range(max(depth) + 1)]
    return [(level, [parents[j] for j in level]) for level in joints]


def _rodrigues(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(Rotation.from_rotvec(vectors).as_matrix())
