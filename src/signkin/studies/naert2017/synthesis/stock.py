"""Takes of one corpus brought to one place, so that signs of different takes can be joined."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from signkin.coarticulation.synthesis import moved
from signkin.joints import HANDS
from signkin.recording import Recording

MIDLINE = ("pelvis", "chest", "neck", "head", "nose")


@dataclass(frozen=True, eq=False)
class Place:
    """Where a signer stands in a take: origin (3,) and heading about the vertical (rad)."""

    origin: NDArray[np.float64]
    heading_rad: float

    @classmethod
    def of(cls, take: Recording) -> Place:
        """Return the median middle and direction of the shoulders, else a joint of the midline."""
        shoulders = [f"{hand}_shoulder" for hand in HANDS]
        if all(joint in take.joints for joint in shoulders):
            right, left = (take.track(joint) for joint in shoulders)
            across = np.nanmedian(right - left, axis=0)
            origin = np.nanmedian((right + left) / 2, axis=0)
            return cls(origin, float(np.arctan2(across[1], across[0])))
        joint = next((j for j in MIDLINE if j in take.joints), take.joints[0])
        return cls(np.nanmedian(take.track(joint), axis=0), 0.0)


def placed(take: Recording, to: Place) -> Recording:
    """Return a take turned and shifted to another take's place.

    Metres: about the vertical and along the floor, so that heights stay; pixels: shifted only.
    """
    turn, shift = placement(take, to)
    return moved(take, turn, shift)


def placement(take: Recording, to: Place) -> tuple[float, NDArray[np.float64]]:
    """Return the turn (rad) and the shift (3,) that `placed` applies."""
    own = Place.of(take)
    if take.unit == "px":
        return 0.0, to.origin - own.origin
    turn = to.heading_rad - own.heading_rad
    cosine, sine = np.cos(turn), np.sin(turn)
    x, y, _ = own.origin
    at = np.array([cosine * x - sine * y, sine * x + cosine * y, 0.0])
    return turn, np.array([to.origin[0], to.origin[1], 0.0]) - at
