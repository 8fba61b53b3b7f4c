"""Biovision hierarchy (.bvh): skeleton, channels and forward kinematics.

Each joint's channels are applied in the order the file lists them. A position
channel replaces the joint's OFFSET (as Blender and MotionBuilder do; files
whose root has an OFFSET of its own repeat it in the channel). Rotations in
the file are degrees; rest orientations are the world's axes, so the product of
the rotations down the chain is the joint's orientation in the world. An `End
Site` is a joint named `<parent>_end`, with its parent's orientation.

Keywords and channels are read in any case, braces and OFFSET on any line, one
or two rotation channels too. Each frame is one line of as many numbers as there
are channels; `nan` makes a gap of what it moves. More frames than the header
says are read, with a note; fewer are an error, and so are two joints of a name
where they are wanted: `part` (1, 2, ...) picks one ROOT of several.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import scipy  # loads its parts when they are used
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.io.bvh_text import Hierarchy, parse, parse_bvh
from signkin.io.chosen import pick
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.text import quoted

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

__all__ = [
    "Hierarchy",
    "channel_values",
    "forward_kinematics",
    "parse_bvh",
    "read_bvh",
    "write_bvh",
]


@motion_reader("bvh", suffixes=(".bvh",))
def read_bvh(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    encoding: str | None = None,
) -> SourceMotion:
    """Read a BVH file: positions by forward kinematics and world orientations.

    part: number of the ROOT, from 1, in a file with several. encoding: of the joints' names,
    where it is not UTF-8.

    Returns positions (F, J, 3) in the file's unit (which BVH does not tell) and
    orientations (F, J, 4). Raises SignkinError for a broken or truncated file.
    """
    parsed = parse(path, encoding)
    hierarchy = parsed.hierarchy
    positions, orientations = forward_kinematics(hierarchy, parsed.values)
    chosen = _of_root(hierarchy, part)
    names, indices = pick(tuple(hierarchy.joints[i] for i in chosen), joints)
    indices = [chosen[i] for i in indices]
    return SourceMotion(
        rate_hz=1.0 / parsed.frame_time,
        rate_range=parsed.rate_range,
        clock_place=f"line {parsed.line}",
        joints=names,
        positions=positions[:, indices],
        orientations=orientations[:, indices],
        parents=_parents_among(hierarchy.parents, indices),
        notes=parsed.notes,
    )


def _of_root(hierarchy: Hierarchy, part: str | None) -> list[int]:
    """Return the joints of the chosen ROOT: all, where the file has one, or each name once."""
    root = -1
    roots = []
    for parent in hierarchy.parents:
        root += parent < 0
        roots.append(root)
    count = root + 1
    if count == 1 or part is None:
        return list(range(len(roots)))
    if not (part.isascii() and part.isdigit() and 1 <= int(part) <= count):
        raise SignkinError(
            f"the part is {quoted(part)}",
            place="part",
            expected=f"1 to {count}: which ROOT of the file",
        )
    return [i for i, at in enumerate(roots) if at == int(part) - 1]


def forward_kinematics(
    hierarchy: Hierarchy, values: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return world positions (F, J, 3) and orientations (F, J, 4) for channel values (F, C).

    A value that is NaN makes NaN of what it moves: a position the joint and all below it, an angle
    the joint's orientation and all below it.
    """
    frames = len(values)
    lost_turns: list[NDArray[np.bool_]] = []
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
        angles = block[:, turning]
        lost = np.asarray(np.isnan(angles).any(axis=1))
        local = (
            scipy.spatial.transform.Rotation.from_euler(
                order, np.where(lost[:, None], 0.0, angles), degrees=True
            )
            if turning
            else scipy.spatial.transform.Rotation.identity(frames)
        )
        if parent >= 0:
            lost = np.asarray(lost | lost_turns[parent])
        lost_turns.append(lost)
        if parent < 0:
            positions[:, joint] = shift
            world.append(local)
        else:
            positions[:, joint] = positions[:, parent] + world[parent].apply(shift)
            positions[lost_turns[parent], joint] = np.nan
            world.append(world[parent] * local)
        orientations[:, joint] = world[joint].as_quat()
        orientations[lost, joint] = np.nan
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
        turn, shift = (
            scipy.spatial.transform.Rotation.from_quat(orientations[:, joint]),
            positions[:, joint],
        )
        if parent >= 0:
            above = scipy.spatial.transform.Rotation.from_quat(orientations[:, parent])
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
    spoilt = [
        n for n in hierarchy.joints if n != " ".join(n.split()) or not n or set(n) & set("{}")
    ]
    if spoilt:
        raise SignkinError(
            f"the joint {quoted(spoilt[0])}", file=path, expected="a name without braces and breaks"
        )
    lines = ["HIERARCHY", *_hierarchy_lines(hierarchy), "MOTION", f"Frames: {len(values)}"]
    lines.append(f"Frame Time: {1.0 / rate_hz:.10g}")
    # Eight decimals of a degree: below 1e-9 rad, so that a written file reads back the same.
    form = " ".join(["%.8f"] * hierarchy.n_channels)
    lines.extend(form % tuple(row) for row in values)
    # Encoded before the file is opened, so that what cannot be written leaves none behind.
    content = ("\n".join(lines) + "\n").encode("utf-8")
    Path(path).write_bytes(content)


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
