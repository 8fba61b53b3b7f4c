"""pose-format files (.pose): landmarks tracked in video, as MediaPipe Holistic gives them.

Joints are named `COMPONENT.POINT` (`POSE_WORLD_LANDMARKS.RIGHT_WRIST`). The
joint map picks the components, and these decide the unit:

- world landmarks alone: metres. The loader that writes such files multiplies
  x and y of every component, the world landmarks too, by the image's width and
  height; they are divided out here, and z is left alone.
- image components alone: pixels, with z (in image widths) times the width; components of two
  dimensions, as OpenPose has them, are flat (z is 0).
- world landmarks with hand components: each hand is scaled from pixels to
  metres by the shoulders' width in both, and set on the world wrist.

A masked or zero-confidence point is a gap (NaN). Where several people were seen, `part` (1, 2, ...)
says which one is the recording; trackers may change their order between frames.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pose_format import Pose

from signkin.errors import SignkinError, listed
from signkin.io.binary import damage_told
from signkin.io.chosen import pick
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.text import content_of, quoted

WORLD = "POSE_WORLD_LANDMARKS"
IMAGE = "POSE_LANDMARKS"
HAND_COMPONENTS = {"LEFT_HAND_LANDMARKS": "LEFT", "RIGHT_HAND_LANDMARKS": "RIGHT"}


@motion_reader("pose", suffixes=(".pose",))
def read_pose(
    path: Path, *, joints: Mapping[str, str] | None = None, part: str | None = None
) -> SourceMotion:
    """Read one person of a .pose file; part: which one, from 1, where there are several.

    Returns positions (F, J, 3) in metres or pixels, by the components that the
    joint map picks; rate as the file's float (a header before 0.2 has whole
    numbers only: the rate must then be declared). Raises SignkinError.
    """
    pose = _load(path)
    names = tuple(f"{c.name}.{point}" for c in pose.header.components for point in c.points)
    canonical, indices = pick(names, joints)
    components = {names[i].partition(".")[0] for i in indices}
    person = which_person(np.asarray(pose.body.confidence).max(axis=(0, 2), initial=0) > 0, part)
    data = _points(pose, person)
    positions, unit = _in_one_unit(data, names, indices, components, pose.header.dimensions)
    whole_rate_only = float(pose.header.version) < 0.199
    rate = _shortest_float(pose.body.fps)
    return SourceMotion(
        rate_hz=None if whole_rate_only else rate,
        rate_range=(rate - 0.5, rate + 0.5) if whole_rate_only and rate > 0 else None,
        joints=canonical,
        positions=positions,
        unit=unit,
    )


def _load(path: Path) -> Any:
    content = content_of(Path(path))
    with damage_told("a .pose file", content, "a whole file; this one may be truncated"):
        pose = Pose.read(content)
    if pose.body.data.shape[0] < 2 or pose.body.data.shape[1] < 1:
        raise SignkinError(
            f"{pose.body.data.shape[0]} frames of {pose.body.data.shape[1]} people",
            expected="2 frames of 1 person or more",
        )
    return pose


def _shortest_float(rate: float) -> float:
    """Return 29.97, not 29.969999313: the file keeps 32-bit floats."""
    return float(str(np.float32(rate)))


def which_person(seen: NDArray[np.bool_], part: str | None) -> int:
    """Return the index of the person to read: the one that `part` names, or the only one seen.

    seen: for each person, whether any point of them was seen.
    """
    if part is not None and not (part.isascii() and part.isdigit()) and len(seen) == 1:
        return 0  # the part names something else than a person
    if part is not None:
        if not (part.isascii() and part.isdigit() and 1 <= int(part) <= len(seen)):
            raise SignkinError(
                f"the part is {quoted(part)}",
                place="part",
                expected=f"1 to {len(seen)}: which person of the file",
            )
        return int(part) - 1
    there = np.flatnonzero(seen)
    if len(there) > 1:
        raise SignkinError(
            f"{len(there)} people in the file",
            place="people",
            expected="the one to read, 1 to " + str(len(seen)) + ", as `part`",
            todo="Trackers may change the order of people between frames: look at it.",
        )
    return int(there[0]) if len(there) else 0


def _points(pose: Any, person: int) -> NDArray[np.float64]:
    """Return (F, points, 3) with NaN where the tracker saw nothing; z is 0 in two dimensions."""
    data = pose.body.data[:, person, :, :3]
    with np.errstate(invalid="ignore"):  # a signalling NaN is a gap like any other
        found = np.ma.getdata(data).astype(float)
    points = np.zeros((*found.shape[:2], 3))
    points[..., : found.shape[2]] = found
    seen = np.asarray(pose.body.confidence[:, person]) > 0
    points[~seen | np.ma.getmaskarray(data).any(axis=2)] = np.nan
    return points


def _in_one_unit(
    data: NDArray[np.float64],
    names: tuple[str, ...],
    indices: list[int],
    components: set[str],
    size: Any,
) -> tuple[NDArray[np.float64], str]:
    world = _component(names, WORLD)
    if not (size.width > 0 and size.height > 0):
        raise SignkinError(
            f"an image of {size.width} x {size.height} pixels", place="header", expected="a size"
        )
    with np.errstate(over="ignore", under="ignore"):
        metres = data / np.array([size.width, size.height, 1.0])
        pixels = data * np.array([1.0, 1.0, size.width])
    if components == {WORLD}:
        return metres[:, indices], "m"
    if WORLD not in components:
        return pixels[:, indices], "px"
    others = components - {WORLD}
    if not others <= set(HAND_COMPONENTS):
        raise SignkinError(
            f"{WORLD} together with {listed(sorted(others - set(HAND_COMPONENTS)))}",
            place="joints",
            expected=f"{WORLD} with the hands only, or image components only",
        )
    scale = _metres_per_pixel(metres, pixels, names)
    out = metres.copy()
    for component, side in HAND_COMPONENTS.items():
        hand = _component(names, component)
        root = names.index(f"{component}.WRIST") if hand else None
        wrist = world.get(f"{side}_WRIST")
        if root is not None and wrist is not None:
            points = list(hand.values())
            shape = pixels[:, points] - pixels[:, [root]]
            out[:, points] = metres[:, [wrist]] + shape * scale
    return out[:, indices], "m"


def _component(names: tuple[str, ...], component: str) -> dict[str, int]:
    prefix = f"{component}."
    return {n.removeprefix(prefix): i for i, n in enumerate(names) if n.startswith(prefix)}


def _metres_per_pixel(
    metres: NDArray[np.float64], pixels: NDArray[np.float64], names: tuple[str, ...]
) -> float:
    """Return the median over frames of the shoulders' width in the image plane, m over px."""

    def width(points: NDArray[np.float64], component: str) -> NDArray[np.float64]:
        at = _component(names, component)
        if not {"LEFT_SHOULDER", "RIGHT_SHOULDER"} <= set(at):
            raise SignkinError(
                f"no shoulders in {component}",
                place="joints",
                expected="both shoulders, to scale the hands by",
            )
        span = points[:, at["LEFT_SHOULDER"], :2] - points[:, at["RIGHT_SHOULDER"], :2]
        return np.asarray(np.linalg.norm(span, axis=1))

    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio = width(metres, WORLD) / width(pixels, IMAGE)
    ratio = ratio[np.isfinite(ratio)]
    if not ratio.size:
        raise SignkinError(
            "no frame with both shoulders", place="joints", expected="shoulders, to scale hands by"
        )
    return float(np.median(ratio))
