"""Biovision hierarchy (.bvh): skeleton, channels and forward kinematics.

Each joint's channels are applied in the order the file lists them. A position
channel replaces the joint's OFFSET (as Blender and MotionBuilder do; files
whose root has an OFFSET of its own repeat it in the channel). Rotations in
the file are degrees; rest orientations are the world's axes, so the product of
the rotations down the chain is the joint's orientation in the world. An `End
Site` is a joint named `<parent>_end`, with its parent's orientation.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from signkin.errors import SignkinError
from signkin.io.registry import SourceMotion, motion_reader, pick

_CHANNELS = ("Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation")


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """A skeleton as a BVH file has it.

    joints: J names, parents before children; parents: index of each parent, -1 for the root.
    offsets: (J, 3) in the file's unit; channels: names for each joint, empty for end sites.
    """

    joints: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: NDArray[np.float64]
    channels: tuple[tuple[str, ...], ...]

    @property
    def n_channels(self) -> int:
        """Number of values in a frame."""
        return sum(len(channels) for channels in self.channels)


@motion_reader("bvh", suffixes=(".bvh",))
def read_bvh(
    path: Path, *, joints: Mapping[str, str] | None = None, part: str | None = None
) -> SourceMotion:
    """Read a BVH file: positions by forward kinematics and world orientations.

    Returns positions (F, J, 3) in the file's unit (which BVH does not tell) and
    orientations (F, J, 4). Raises SignkinError for a broken or truncated file.
    """
    hierarchy, values, rate_hz = parse_bvh(path)
    positions, orientations = forward_kinematics(hierarchy, values)
    names, indices = pick(hierarchy.joints, joints)
    return SourceMotion(
        rate_hz=rate_hz,
        joints=names,
        positions=positions[:, indices],
        orientations=orientations[:, indices],
        parents=_parents_among(hierarchy.parents, indices),
    )


def parse_bvh(path: Path) -> tuple[Hierarchy, NDArray[np.float64], float]:
    """Return the hierarchy, the channel values (F, C) and the rate in Hz of a BVH file."""
    lines = Path(path).read_text(encoding="utf-8", errors="replace").splitlines()
    hierarchy, line = _parse_hierarchy(lines)
    frames, frame_time, first = _parse_motion_header(lines, line)
    values = _parse_frames(lines, first, frames, hierarchy.n_channels)
    return hierarchy, values, 1.0 / frame_time


def _parse_hierarchy(lines: list[str]) -> tuple[Hierarchy, int]:
    joints: list[str] = []
    parents: list[int] = []
    offsets: list[list[float]] = []
    channels: list[tuple[str, ...]] = []
    open_joints: list[int] = []
    for number, text in enumerate(lines, start=1):
        words = text.split()
        if not words or words[0] in ("HIERARCHY", "{"):
            continue
        keyword = words[0]
        if keyword == "MOTION":
            if open_joints or not joints:
                raise _broken(number, "MOTION before the hierarchy is closed", "a }")
            return Hierarchy(tuple(joints), tuple(parents), np.array(offsets), tuple(channels)), (
                number
            )
        if keyword in ("ROOT", "JOINT", "End"):
            parent = open_joints[-1] if open_joints else -1
            name = f"{joints[parent]}_end" if keyword == "End" else " ".join(words[1:])
            open_joints.append(len(joints))
            joints.append(name)
            parents.append(parent)
            offsets.append([0.0, 0.0, 0.0])
            channels.append(())
        elif keyword == "OFFSET" and open_joints:
            offsets[open_joints[-1]] = _numbers(words[1:], 3, number)
        elif keyword == "CHANNELS" and open_joints:
            channels[open_joints[-1]] = _channel_names(words[1:], number)
        elif keyword == "}" and open_joints:
            open_joints.pop()
        else:
            raise _broken(number, f"found {keyword!r}", "JOINT, OFFSET, CHANNELS, End Site or }")
    raise _broken(len(lines), "the file ends in its hierarchy", "MOTION and the frames")


def _channel_names(words: list[str], number: int) -> tuple[str, ...]:
    names = tuple(words[1:])
    if not words or not words[0].isdigit() or int(words[0]) != len(names):
        raise _broken(number, f"CHANNELS {' '.join(words)}", "a count and as many channels")
    unknown = [name for name in names if name not in _CHANNELS]
    if unknown or len(set(names)) != len(names):
        raise _broken(number, f"CHANNELS {' '.join(names)}", f"each at most once: {_CHANNELS}")
    rotations = sum(name.endswith("rotation") for name in names)
    if rotations not in (0, 3):
        raise _broken(number, f"{rotations} rotation channels", "three, or none")
    return names


def _parse_motion_header(lines: list[str], line: int) -> tuple[int, float, int]:
    found: dict[str, float] = {}
    for number in range(line, len(lines)):
        key, colon, value = lines[number].partition(":")
        if not lines[number].strip():
            continue
        if not colon:
            break
        found[key.strip().lower()] = _numbers(value.split(), 1, number + 1)[0]
        if {"frames", "frame time"} <= set(found):
            if not found["frame time"] > 0:
                raise _broken(number + 1, f"the frame time is {value.strip()} s", "more than 0 s")
            return int(found["frames"]), found["frame time"], number + 1
    raise _broken(line, "no frame count and frame time after MOTION", "Frames: and Frame Time:")


def _parse_frames(
    lines: list[str], first: int, frames: int, n_channels: int
) -> NDArray[np.float64]:
    rows = [(number, text) for number, text in enumerate(lines[first:], first + 1) if text.strip()]
    if len(rows) != frames:
        raise _broken(
            len(lines),
            f"{len(rows)} frames, where the header says {frames}",
            "as many; the file may be truncated",
        )
    try:
        values = np.array(" ".join(text for _, text in rows).split(), dtype=float)
    except ValueError:
        values = np.empty(0)
    if values.size != frames * n_channels:
        for number, text in rows:
            _numbers(text.split(), n_channels, number)
    return values.reshape(frames, n_channels)


def _numbers(words: list[str], count: int, number: int) -> list[float]:
    values = []
    for word in words:
        try:
            values.append(float(word))
        except ValueError:
            raise _broken(number, f"found {word!r}", "a number") from None
    if len(values) != count:
        raise _broken(number, f"{len(values)} numbers", f"{count}; the file may be truncated")
    return values


def _broken(number: int, found: str, expected: str) -> SignkinError:
    return SignkinError(found, place=f"line {number}", expected=expected)


def forward_kinematics(
    hierarchy: Hierarchy, values: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return world positions (F, J, 3) and orientations (F, J, 4) for channel values (F, C)."""
    frames = len(values)
    positions = np.empty((frames, len(hierarchy.joints), 3))
    orientations = np.empty((frames, len(hierarchy.joints), 4))
    world: list[Rotation] = []
    column = 0
    for joint, parent in enumerate(hierarchy.parents):
        channels = hierarchy.channels[joint]
        block = values[:, column : column + len(channels)]
        column += len(channels)
        shift = np.tile(hierarchy.offsets[joint], (frames, 1))
        for i, channel in enumerate(channels):
            if channel.endswith("position"):
                shift[:, "XYZ".index(channel[0])] = block[:, i]
        turning = [i for i, channel in enumerate(channels) if channel.endswith("rotation")]
        order = "".join(channels[i][0] for i in turning)
        local = (
            Rotation.from_euler(order, block[:, turning], degrees=True)
            if turning
            else Rotation.identity(frames)
        )
        if parent < 0:
            positions[:, joint] = shift
            world.append(local)
        else:
            positions[:, joint] = positions[:, parent] + world[parent].apply(shift)
            world.append(world[parent] * local)
        orientations[:, joint] = world[joint].as_quat()
    return positions, orientations


def channel_values(
    hierarchy: Hierarchy, positions: NDArray[np.float64], orientations: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the channel values (F, C) of world positions and orientations: the way back.

    positions (F, J, 3), orientations (F, J, 4), of the hierarchy's joints in its order. A joint
    without position channels stays at its OFFSET, whatever its position says. Angles follow one
    another without jumps, so that a program may interpolate between frames.
    """
    if positions.shape[1] != len(hierarchy.joints):
        raise SignkinError(
            f"{positions.shape[1]} joints",
            place="hierarchy",
            expected=f"{len(hierarchy.joints)}, all joints and end sites of the hierarchy",
        )
    columns: list[NDArray[np.float64]] = []
    for joint, parent in enumerate(hierarchy.parents):
        channels = hierarchy.channels[joint]
        if not channels:
            continue
        turn, shift = Rotation.from_quat(orientations[:, joint]), positions[:, joint]
        if parent >= 0:
            above = Rotation.from_quat(orientations[:, parent])
            turn = above.inv() * turn
            shift = above.inv().apply(shift - positions[:, parent])
        order = "".join(name[0] for name in channels if name.endswith("rotation"))
        angles = _euler(turn, order) if order else np.empty((len(positions), 0))
        for name in channels:
            if name.endswith("position"):
                columns.append(shift[:, "XYZ".index(name[0])])
            else:
                columns.append(angles[:, order.index(name[0])])
    return np.column_stack(columns)


def _euler(turns: Rotation, order: str) -> NDArray[np.float64]:
    """Return Euler angles in degrees, (F, 3), each frame as near to the last one as it can be."""
    with warnings.catch_warnings():
        # Where two axes fall together scipy says that it takes the third angle for 0: as good.
        warnings.filterwarnings("ignore", message="Gimbal lock")
        angles = turns.as_euler(order, degrees=True)
    for frame in range(1, len(angles)):
        before, found = angles[frame - 1], angles[frame]
        # Turning the outer axes by 180 degrees and mirroring the middle one is the same rotation.
        other = np.array([found[0] + 180, 180 - found[1], found[2] + 180])
        near = [a - 360 * np.rint((a - before) / 360) for a in (found, other)]
        angles[frame] = min(near, key=lambda a: float(np.abs(a - before).sum()))
    return np.asarray(angles)


def _parents_among(parents: tuple[int, ...], chosen: list[int]) -> tuple[int, ...]:
    """Return, for chosen joints, the nearest chosen ancestor's place among them (-1: none)."""
    place = {joint: i for i, joint in enumerate(chosen)}
    out = []
    for joint in chosen:
        ancestor = parents[joint]
        while ancestor >= 0 and ancestor not in place:
            ancestor = parents[ancestor]
        out.append(place.get(ancestor, -1))
    return tuple(out)


def write_bvh(
    path: Path, hierarchy: Hierarchy, values: NDArray[np.float64], rate_hz: float
) -> None:
    """Write a BVH file; values (F, C) as `parse_bvh` returns them (degrees, the file's unit)."""
    if values.shape[1:] != (hierarchy.n_channels,):
        raise SignkinError(
            f"the values have shape {values.shape}",
            file=path,
            expected=f"(frames, {hierarchy.n_channels})",
        )
    lines = ["HIERARCHY", *_hierarchy_lines(hierarchy), "MOTION", f"Frames: {len(values)}"]
    lines.append(f"Frame Time: {1.0 / rate_hz:.10g}")
    # Eight decimals of a degree: below 1e-9 rad, so that a written file reads back the same.
    form = " ".join(["%.8f"] * hierarchy.n_channels)
    lines.extend(form % tuple(row) for row in values)
    Path(path).write_text("\n".join(lines) + "\n", encoding="ascii")


def _hierarchy_lines(hierarchy: Hierarchy) -> list[str]:
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(hierarchy.parents):
        children.setdefault(parent, []).append(joint)

    def block(joint: int, depth: int) -> list[str]:
        tab = "  " * depth
        channels = hierarchy.channels[joint]
        ends = hierarchy.joints[joint].endswith("_end") and not channels
        keyword = "ROOT" if depth == 0 else "JOINT"
        name = "End Site" if ends else f"{keyword} {hierarchy.joints[joint]}"
        offset = " ".join(f"{value:.8g}" for value in hierarchy.offsets[joint])
        lines = [f"{tab}{name}", f"{tab}{{", f"{tab}  OFFSET {offset}"]
        if channels:
            lines.append(f"{tab}  CHANNELS {len(channels)} {' '.join(channels)}")
        for child in children.get(joint, ()):
            lines.extend(block(child, depth + 1))
        return [*lines, f"{tab}}}"]

    return [line for root in children[-1] for line in block(root, 0)]
