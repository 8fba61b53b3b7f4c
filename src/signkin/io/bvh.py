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
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from signkin.errors import SignkinError, listed
from signkin.io.registry import SourceMotion, motion_reader, pick
from signkin.io.text import NOT_A_NUMBER, half_digit, number, quoted, text_lines

_CHANNELS = ("Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation")
_CHANNEL_OF = {name.lower(): name for name in _CHANNELS}
# Angles and lengths beyond this are broken numbers, for which a sine has no digits left.
_LARGEST = 1e9


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


@dataclass(frozen=True, eq=False)
class _Parsed:
    """A BVH file: what `parse_bvh` returns, what its printed digits allow, what is to be said."""

    hierarchy: Hierarchy
    values: NDArray[np.float64]
    frame_time: float
    rate_range: tuple[float, float]
    line: int
    notes: tuple[str, ...]


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
    parsed = _parse(path, encoding)
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


def parse_bvh(
    path: Path, encoding: str | None = None
) -> tuple[Hierarchy, NDArray[np.float64], float]:
    """Return the hierarchy, the channel values (F, C) and the rate in Hz of a BVH file."""
    parsed = _parse(Path(path), encoding)
    return parsed.hierarchy, parsed.values, 1.0 / parsed.frame_time


def _parse(path: Path, encoding: str | None) -> _Parsed:
    lines = list(text_lines(path, encoding))
    hierarchy, line = _parse_hierarchy(lines)
    header = _parse_motion_header(lines, line)
    values, notes = _parse_frames(lines, header, hierarchy.n_channels)
    # Of one digit (0.01) it cannot be told whether it was rounded: it is taken as it stands.
    digits = header.frame_time_text.lower().partition("e")[0].replace(".", "").strip("+0")
    padded = header.frame_time_text.endswith("0") and "." in header.frame_time_text
    half = half_digit(header.frame_time_text) if len(digits) > 1 or padded else 0.0
    low = header.frame_time + half
    high = max(header.frame_time - half, 0.1 * header.frame_time)
    return _Parsed(hierarchy, values, header.frame_time, (1 / low, 1 / high), header.line, notes)


class _Words:
    """The words of a hierarchy with their lines; braces are words of their own."""

    def __init__(self, lines: list[str]) -> None:
        self._words = self._split(lines)
        self._next: tuple[int, str] | None = next(self._words, None)
        self.line = 1

    @staticmethod
    def _split(lines: list[str]) -> Iterator[tuple[int, str]]:
        for line, text in enumerate(lines, start=1):
            for word in text.replace("{", " { ").replace("}", " } ").split():
                yield line, word

    def peek(self) -> str | None:
        """Return the next word, None at the end."""
        return None if self._next is None else self._next[1]

    def same_line(self) -> bool:
        """Return whether the next word stands on the line of the last one."""
        return self._next is not None and self._next[0] == self.line

    def take(self) -> str:
        """Return the next word and go on; the end of the file is an error."""
        if self._next is None:
            raise _broken(self.line, "the file ends in its hierarchy", "MOTION and the frames")
        self.line, word = self._next
        self._next = next(self._words, None)
        return word

    def take_brace(self, what: str) -> None:
        """Take an opening brace."""
        if self.peek() != "{":
            found = self.peek() or "the end"
            raise _broken(self.line, f"found {quoted(found)} after {what}", "{")
        self.take()


def _parse_hierarchy(lines: list[str]) -> tuple[Hierarchy, int]:
    joints: list[str] = []
    parents: list[int] = []
    offsets: list[list[float]] = []
    channels: list[tuple[str, ...]] = []
    open_joints: list[int] = []
    words = _Words(lines)
    while True:
        word = words.take()
        keyword = word.upper()
        if keyword == "HIERARCHY" and not joints:
            continue
        if keyword == "MOTION":
            if open_joints or not joints:
                raise _broken(words.line, "MOTION before the hierarchy is closed", "a }")
            skeleton = (tuple(joints), tuple(parents), np.array(offsets), tuple(channels))
            return Hierarchy(*skeleton), words.line
        if keyword in ("ROOT", "JOINT", "END") and (keyword == "ROOT") != bool(open_joints):
            parent = open_joints[-1] if open_joints else -1
            name = _joint_name(words, keyword)
            if keyword == "END":
                name = _end_name(joints, parent)
            words.take_brace(f"{word} {name}")
            open_joints.append(len(joints))
            joints.append(name)
            parents.append(parent)
            offsets.append([0.0, 0.0, 0.0])
            channels.append(())
        elif keyword == "OFFSET" and open_joints:
            found = [words.take() for _ in range(3) if words.peek() not in (None, "{", "}")]
            offsets[open_joints[-1]] = _numbers(found, 3, words.line, gaps=False)
        elif keyword == "CHANNELS" and open_joints:
            channels[open_joints[-1]] = _channel_names(words)
        elif keyword == "}" and open_joints:
            open_joints.pop()
        else:
            raise _broken(
                words.line, f"found {quoted(word)}", "ROOT, JOINT, OFFSET, CHANNELS, End Site or }"
            )


def _joint_name(words: _Words, keyword: str) -> str:
    """Return the rest of the line, up to a brace: names may hold blanks."""
    line, parts = words.line, []
    while words.same_line() and words.peek() != "{":
        parts.append(words.take())
    if keyword == "END":
        if [part.upper() for part in parts[:1]] != ["SITE"]:
            raise _broken(line, f"found {quoted(' '.join(['End', *parts]))}", "End Site")
        return ""
    if not parts:
        raise _broken(line, f"{keyword} without a name", "a name")
    return " ".join(parts)


def _end_name(joints: list[str], parent: int) -> str:
    name = f"{joints[parent]}_end"
    count = sum(joint == name or joint.startswith(f"{name}_") for joint in joints)
    return f"{name}_{count + 1}" if count and joints[parent + 1 :].count(name) else name


def _channel_names(words: _Words) -> tuple[str, ...]:
    count = words.take()
    line = words.line
    found: list[str] = []
    if count.isascii() and count.isdigit() and int(count[:9]) <= len(_CHANNELS):
        while len(found) < int(count) and (words.peek() or "").lower() in _CHANNEL_OF:
            found.append(words.take())
    while words.same_line() and words.peek() not in ("{", "}"):
        if (words.peek() or "").upper() in ("OFFSET", "JOINT", "END", "MOTION"):
            break
        found.append(words.take())
    unknown = [name for name in found if name.lower() not in _CHANNEL_OF]
    if unknown:
        raise _broken(line, f"the channel {quoted(unknown[0])}", listed(_CHANNELS))
    if not (count.isascii() and count.isdigit()) or int(count[:9]) != len(found):
        raise _broken(
            line, f"CHANNELS {quoted(' '.join([count, *found]))[1:-1]}",
            "a count and as many channels",
        )  # fmt: skip
    names = tuple(_CHANNEL_OF[name.lower()] for name in found)
    if len(set(names)) != len(names):
        raise _broken(line, f"CHANNELS {' '.join(names)}", "each at most once")
    return names


@dataclass(frozen=True)
class _MotionHeader:
    frames: int
    frame_time: float
    frame_time_text: str
    line: int  # of the frame time
    first: int  # index of the first line after it


def _parse_motion_header(lines: list[str], line: int) -> _MotionHeader:
    found: dict[str, tuple[str, int]] = {}
    for place in range(line, len(lines)):
        text = lines[place].strip()
        if not text:
            continue
        key, _, value = text.partition(":")
        if ":" not in text:  # some leave the colon out
            key, _, value = text.rpartition(" ")
        name = " ".join(key.lower().split())
        if name not in ("frames", "frame time"):
            break
        found[name] = (value.strip(), place + 1)
        if len(found) == 2:
            frames, at = found["frames"]
            time, here = found["frame time"]
            count = number(frames)
            if count is None or count != int(count) or count < 0:
                raise _broken(at, f"{quoted(frames)} frames", "a whole number")
            seconds = _numbers(time.split(), 1, here, gaps=False)[0]
            if not seconds > 0:
                raise _broken(here, f"the frame time is {time} s", "more than 0 s")
            return _MotionHeader(int(count), seconds, time, here, place + 1)
    raise _broken(line, "no frame count and frame time after MOTION", "Frames: and Frame Time:")


def _parse_frames(
    lines: list[str], header: _MotionHeader, n_channels: int
) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    first = header.first
    rows = [(n, text.split()) for n, text in enumerate(lines[first:], first + 1) if text.strip()]
    if not n_channels:
        raise _broken(first, "no channel in the hierarchy", "joints that move")
    for place, words in rows:
        if len(words) != n_channels:
            _numbers(words, n_channels, place)
    if len(rows) < header.frames:
        raise _broken(
            len(lines),
            f"{len(rows)} frames, where the header says {header.frames}",
            "as many; the file may be truncated",
        )
    values = np.array([_numbers(words, n_channels, n) for n, words in rows], dtype=float)
    extra = len(rows) - header.frames
    note = f"the file has {extra} frames more than the {header.frames} of its header; all are read"
    return values.reshape(len(rows), n_channels), (note,) if extra else ()


def _numbers(words: list[str], count: int, line: int, gaps: bool = True) -> list[float]:
    """Return the numbers of a line; `nan` is one where gaps are allowed, infinity never is."""
    values = []
    for word in words:
        value = number(word)
        if value is None and gaps and word.lower() in NOT_A_NUMBER:
            value = float("nan")
        if value is None or abs(value) > _LARGEST:
            raise _broken(line, f"found {quoted(word)}", "a number, up to 1e9")
        values.append(value)
    if len(values) != count:
        fewer = "; the file may be truncated" if len(values) < count else ""
        raise _broken(line, f"{len(values)} numbers", f"{count}{fewer}")
    return values


def _broken(line: int, found: str, expected: str) -> SignkinError:
    return SignkinError(found, place=f"line {line}", expected=expected)


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
            Rotation.from_euler(order, np.where(lost[:, None], 0.0, angles), degrees=True)
            if turning
            else Rotation.identity(frames)
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
