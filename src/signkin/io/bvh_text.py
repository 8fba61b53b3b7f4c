"""The text of a BVH file: hierarchy, header of the motion, frames. See `bvh`.

Keywords and channels are read in any case, braces and OFFSET on any line. Each frame is one line
of as many numbers as there are channels.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.io.text import NOT_A_NUMBER, half_digit, number, quoted, text_lines

_CHANNELS = ("Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation")
_WORDS = ("{", "}", "ROOT", "JOINT", "END", "OFFSET", "CHANNELS", "MOTION")
_CHANNEL_OF = {name.lower(): name for name in _CHANNELS}
# Angles and lengths beyond this are broken numbers, for which a sine has no digits left.
_LARGEST = 1e9
_MOST_JOINTS = 5000
_DIGITS = set("0123456789+-.eE \t")


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
class Parsed:
    """A BVH file: what `parse_bvh` returns, what its printed digits allow, what is to be said."""

    hierarchy: Hierarchy
    values: NDArray[np.float64]
    frame_time: float
    rate_range: tuple[float, float]
    line: int
    notes: tuple[str, ...]


def parse_bvh(
    path: Path, encoding: str | None = None
) -> tuple[Hierarchy, NDArray[np.float64], float]:
    """Return the hierarchy, the channel values (F, C) and the rate in Hz of a BVH file."""
    parsed = parse(Path(path), encoding)
    return parsed.hierarchy, parsed.values, 1.0 / parsed.frame_time


def parse(path: Path, encoding: str | None) -> Parsed:
    """Return what a BVH file says; errors name the line."""
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
    return Parsed(hierarchy, values, header.frame_time, (1 / low, 1 / high), header.line, notes)


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
    offsets: list[list[float] | None] = []
    channels: list[tuple[str, ...] | None] = []
    open_joints: list[int] = []
    ends: dict[int, int] = {}  # end sites of each joint
    words = _Words(lines)
    while True:
        word = words.take()
        keyword = word.upper()
        if keyword == "HIERARCHY" and not joints:
            continue
        if keyword == "MOTION":
            if open_joints or not joints:
                raise _broken(words.line, "MOTION before the hierarchy is closed", "a }")
            moved = tuple(names or () for names in channels)
            at = np.array(offsets, dtype=float)
            return Hierarchy(tuple(joints), tuple(parents), at, moved), words.line
        if keyword in ("ROOT", "JOINT", "END") and (keyword == "ROOT") != bool(open_joints):
            parent = open_joints[-1] if open_joints else -1
            name = _joint_name(words, keyword)
            if keyword == "END":
                ends[parent] = ends.get(parent, 0) + 1
                name = f"{joints[parent]}_end" + (f"_{ends[parent]}" if ends[parent] > 1 else "")
            words.take_brace(f"{word} {name}")
            if len(joints) >= _MOST_JOINTS:
                raise _broken(words.line, f"more than {_MOST_JOINTS} joints", "a skeleton")
            open_joints.append(len(joints))
            joints.append(name)
            parents.append(parent)
            offsets.append(None)
            channels.append(None)
        elif keyword == "OFFSET" and open_joints and offsets[open_joints[-1]] is None:
            found = [words.take() for _ in range(3) if (words.peek() or "}").upper() not in _WORDS]
            offsets[open_joints[-1]] = _numbers(found, 3, words.line, gaps=False)
        elif keyword == "CHANNELS" and open_joints and channels[open_joints[-1]] is None:
            channels[open_joints[-1]] = _channel_names(words)
        elif keyword == "}" and open_joints:
            if offsets[open_joints[-1]] is None:
                raise _broken(words.line, f"no OFFSET of {joints[open_joints[-1]]}", "OFFSET x y z")
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


def _channel_names(words: _Words) -> tuple[str, ...]:
    count = words.take()
    line = words.line
    found: list[str] = []
    if count.isascii() and count.isdigit() and int(count[:9]) <= len(_CHANNELS):
        while len(found) < int(count) and (words.peek() or "").lower() in _CHANNEL_OF:
            found.append(words.take())
    while words.same_line() and words.peek() not in ("{", "}"):
        if (words.peek() or "").upper() in _WORDS:
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
        if name in found:
            raise _broken(place + 1, f"{quoted(text)}, a second time", "Frames and Frame Time once")
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
    if not n_channels:
        raise _broken(header.first, "no channel in the hierarchy", "joints that move")
    # Line by line: the words of a long take at once would fill the memory.
    rows = [
        _frame(text, n_channels, line)
        for line, text in enumerate(lines[header.first :], header.first + 1)
        if text.strip()
    ]
    if len(rows) < header.frames:
        raise _broken(
            len(lines),
            f"{len(rows)} frames, where the header says {header.frames}",
            "as many; the file may be truncated",
        )
    values = np.array(rows, dtype=float).reshape(len(rows), n_channels)
    extra = len(rows) - header.frames
    note = f"the file has {extra} frames more than the {header.frames} of its header; all are read"
    return values, (note,) if extra else ()


def _frame(text: str, n_channels: int, line: int) -> NDArray[np.float64]:
    words = text.split()
    if len(words) == n_channels and set(text) <= _DIGITS:
        try:
            values = np.array(words, dtype=float)
        except ValueError:
            pass
        else:
            if np.abs(values).max(initial=0.0) <= _LARGEST:
                return values
    return np.array(_numbers(words, n_channels, line))


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
