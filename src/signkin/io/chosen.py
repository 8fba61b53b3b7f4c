"""Which joints of a file are wanted, and whether the numbers can be those of a body."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io.text import quoted
from signkin.rows import composed

# Beyond this, in any unit, a coordinate is a broken number and no place.
FURTHEST = 1e9
# Pixels of which nearly all are nearer to 0 than this are shares of the image.
LARGEST_SHARE = 2.0
LEAST_FRAMES = 10  # fewer show too little of an image to judge by


def check_joint_map(joints: object) -> None:
    """Refuse a joint map that is none, and one that gives two joints one place in the file."""
    if joints is None:
        return
    if not isinstance(joints, Mapping):
        raise SignkinError(
            f"the joint map is {quoted(joints)}",
            place="joints",
            expected="canonical name: name in the file",
        )
    taken: dict[Any, str] = {}
    for joint, place in joints.items():
        for column in place if isinstance(place, list | tuple) else (place,):
            if not isinstance(column, str | int):
                raise SignkinError(
                    f"{joint} has {quoted(column)}", place="joints", expected="names of the file"
                )
            if column in taken:
                both = f"{taken[column]} and {joint}" if taken[column] != joint else str(joint)
                raise SignkinError(
                    f"{quoted(column)} stands twice, for {both}",
                    place="joints",
                    expected="each joint its own place in the file",
                )
            taken[column] = str(joint)


def check_positions(positions: NDArray[np.float64], joints: Sequence[str]) -> None:
    """Refuse what is no coordinate, before the axes are turned: infinity times 0 is a gap."""
    if len(positions) < 2:
        raise SignkinError(f"{len(positions)} frames", place="frames", expected="2 frames or more")
    with np.errstate(invalid="ignore"):
        bad = np.abs(positions) > FURTHEST
    if bad.any():
        frame, joint, axis = (int(i) for i in np.argwhere(bad)[0])
        value = positions[frame, joint, axis]
        infinite = "the positions hold an infinite value"
        raise SignkinError(
            f"a coordinate of {value:g}" if np.isfinite(value) else infinite,
            place=f"joint {joints[joint]}, frame {frame}",
            expected="a finite value, or NaN for a gap",
        )


def check_shares(positions: NDArray[np.float64], unit: str, sized: bool) -> None:
    """Refuse shares of an image that are called pixels.

    positions: (F, J, 3), canonical. sized: whether the format has an image_size.
    """
    if unit == "px" and len(positions) >= LEAST_FRAMES:
        there = np.abs(positions[np.isfinite(positions) & (positions != 0)])
        if there.size and np.percentile(there, 95) <= LARGEST_SHARE:
            raise SignkinError(
                f"coordinates of {np.median(there):.3g}, which are shares of the image",
                place="unit",
                expected="pixels, or the image's size",
                todo="Declare options: {image_size: [WIDTH, HEIGHT]}." if sized else None,
            )


def check_wrists(positions: NDArray[np.float64], joints: Sequence[str]) -> None:
    """Refuse two wrists that are one; positions: (F, J, 3)."""
    hands = [joints.index(j) for j in ("right_wrist", "left_wrist") if j in joints]
    if len(hands) == 2:
        right, left = positions[:, hands[0]], positions[:, hands[1]]
        there = np.isfinite(right).all(axis=1)
        if (
            np.array_equal(right, left, equal_nan=True)
            and there.sum() > 1
            and np.ptp(right[there], axis=0).any()
        ):
            raise SignkinError(
                "right_wrist and left_wrist are at one place in every frame",
                place="joints",
                expected="each wrist its own track; leave one out where one hand was recorded",
            )


def pick(
    available: tuple[str, ...], wanted: Mapping[str, Any] | None
) -> tuple[tuple[str, ...], list[int]]:
    """Return canonical names and the file's indices of the wanted joints (None: all)."""
    if wanted is None:
        twice = sorted(name for name, count in Counter(available).items() if count > 1)
        if twice:
            raise _stands_twice(twice)
        return available, list(range(len(available)))
    wanted = {joint: _as_in_file(name, available) for joint, name in wanted.items()}
    unknown = [str(name) for name in wanted.values() if name not in available]
    if unknown:
        raise SignkinError(
            f"no joint {listed(unknown)} in the file",
            place="joints",
            expected=listed(available, 200),
        )
    twice = [name for name in wanted.values() if available.count(name) > 1]
    if twice:
        raise _stands_twice(twice)
    shared = [name for name, count in Counter(wanted.values()).items() if count > 1]
    if shared:
        joints = [joint for joint, name in wanted.items() if name == shared[0]]
        raise SignkinError(
            f"{quoted(shared[0])} stands twice, for {' and '.join(joints)}",
            place="joints",
            expected="each joint its own place in the file",
        )
    return tuple(wanted), [available.index(name) for name in wanted.values()]


def _as_in_file(name: Any, available: Sequence[str]) -> Any:
    """Return a name as the file has it, where only the coding of accents differs."""
    if name in available or not isinstance(name, str):
        return name
    same = [there for there in available if composed(there) == composed(name)]
    return same[0] if len(same) == 1 else name


def _stands_twice(names: list[str]) -> SignkinError:
    return SignkinError(
        f"joint {listed(names, 5)} stands twice in the file",
        place="joints",
        expected="each joint once; two people of the same names are told apart by `part`",
    )
