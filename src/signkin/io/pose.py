"""pose-format files (.pose): landmarks tracked in video, as MediaPipe Holistic gives them.

Joints are named `COMPONENT.POINT` (`POSE_WORLD_LANDMARKS.RIGHT_WRIST`). The
joint map picks the components, and these decide the unit:

- world landmarks alone: metres. The loader that writes such files multiplies
  x and y of every component, the world landmarks too, by the image's width and
  height; they are divided out here, and z is left alone.
- image components alone: pixels, with z (in image widths) times the width.
- world landmarks with hand components: each hand is scaled from pixels to
  metres by the shoulders' width in both, and set on the world wrist.

A masked or zero-confidence point is a gap (NaN).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pose_format import Pose

from signkin.errors import SignkinError, listed
from signkin.io.registry import SourceMotion, motion_reader, pick

WORLD = "POSE_WORLD_LANDMARKS"
IMAGE = "POSE_LANDMARKS"
HAND_COMPONENTS = {"LEFT_HAND_LANDMARKS": "LEFT", "RIGHT_HAND_LANDMARKS": "RIGHT"}


@motion_reader("pose", suffixes=(".pose",))
def read_pose(
    path: Path, *, joints: Mapping[str, str] | None = None, part: str | None = None
) -> SourceMotion:
    """Read the first person of a .pose file.

    Returns positions (F, J, 3) in metres or pixels, by the components that the
    joint map picks; rate as the file's float (a header before 0.2 has whole
    numbers only: the rate must then be declared). Raises SignkinError.
    """
    pose = _load(path)
    names = tuple(f"{c.name}.{point}" for c in pose.header.components for point in c.points)
    canonical, indices = pick(names, joints)
    components = {names[i].partition(".")[0] for i in indices}
    data = _points(pose)
    positions, unit = _in_one_unit(data, names, indices, components, pose.header.dimensions)
    whole_rate_only = float(pose.header.version) < 0.199
    return SourceMotion(
        rate_hz=None if whole_rate_only else _shortest_float(pose.body.fps),
        joints=canonical,
        positions=positions,
        unit=unit,
    )


def _load(path: Path) -> Any:
    content = Path(path).read_bytes()
    try:
        pose = Pose.read(content)
    except Exception as error:  # the library lets struct, value and index errors through
        raise SignkinError(
            f"not readable as a .pose file ({type(error).__name__}: {error})",
            place=f"{len(content)} bytes",
            expected="a whole file; this one may be truncated",
        ) from error
    if pose.body.data.shape[0] < 2 or pose.body.data.shape[1] < 1:
        raise SignkinError(
            f"{pose.body.data.shape[0]} frames of {pose.body.data.shape[1]} people",
            expected="2 frames of 1 person or more",
        )
    return pose


def _shortest_float(rate: float) -> float:
    """Return 29.97, not 29.969999313: the file keeps 32-bit floats."""
    return float(str(np.float32(rate)))


def _points(pose: Any) -> NDArray[np.float64]:
    """Return (F, points, 3) with NaN where the tracker saw nothing."""
    person = pose.body.data[:, 0, :, :3]
    points = np.ma.getdata(person).astype(float)
    seen = np.asarray(pose.body.confidence[:, 0]) > 0
    points[~seen | np.ma.getmaskarray(person).any(axis=2)] = np.nan
    return points


def _in_one_unit(
    data: NDArray[np.float64],
    names: tuple[str, ...],
    indices: list[int],
    components: set[str],
    size: Any,
) -> tuple[NDArray[np.float64], str]:
    world = _component(names, WORLD)
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

    return float(np.nanmedian(width(metres, WORLD) / width(pixels, IMAGE)))
