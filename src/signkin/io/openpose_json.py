"""A folder of OpenPose's JSON files: one file a frame, `<video>_<frame>_keypoints.json`.

Points are named as .pose files name them: `pose_keypoints_2d.RWrist`,
`hand_right_keypoints_2d.BASE`. They are pixels; a point of confidence 0 is a gap, and so is a frame
without the person. OpenPose does not follow people from frame to frame: where a frame has several,
`part` says which one, by place in the file (1, 2, ...), and the order may change.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.io.chosen import pick
from signkin.io.landmarks import OPENPOSE_BODY_25, OPENPOSE_COCO, OPENPOSE_HAND, OPENPOSE_MPI
from signkin.io.points import Points, check_confidence, source_motion
from signkin.io.pose import which_person
from signkin.io.registry import SourceMotion, motion_reader
from signkin.io.text import quoted, text_lines

_FRAME = re.compile(r"(?:^|.*_)([0-9]{1,15})_keypoints\.json", re.DOTALL)
_BODIES = {25: OPENPOSE_BODY_25, 18: OPENPOSE_COCO, 15: OPENPOSE_MPI}
_PARTS = ("pose", "face", "hand_left", "hand_right")


@motion_reader("openpose_json", folder=True)
def read_openpose_json(
    path: Path,
    *,
    joints: Mapping[str, str] | None = None,
    part: str | None = None,
    confidence_threshold: float = 0.0,
    image_size: Sequence[float] | None = None,
) -> SourceMotion:
    """Read the frames of a folder in order of their numbers, which must follow one another.

    image_size: [width, height], where the files hold 0 to 1 instead of pixels.
    """
    if not path.is_dir():
        raise SignkinError("this is a file", file=path, expected="a folder of *_keypoints.json")
    files = _files(path)
    first = int(_FRAME.fullmatch(files[0].name)[1])  # type: ignore[index]
    note = f"the first frame is number {first}; times count from there"
    people = [_people(file) for file in files]
    most = max((len(frame) for frame in people), default=0)
    if not most:
        if joints is not None:
            raise SignkinError("no person in any frame", file=path, expected="one or more")
        most = 1
    person = which_person(_seen(people, most), part)
    chosen = [frame[person] if person < len(frame) else {} for frame in people]
    names = _names(chosen)
    canonical, indices = pick(names, joints) if names else ((), [])
    if not names:
        raise SignkinError("no person in any frame", file=path, expected="one or more")
    table = np.full((len(chosen), len(names), 3), np.nan)
    widths = _widths(chosen)
    for frame, keypoints in enumerate(chosen):
        at = 0
        for key, width in widths.items():
            values = keypoints.get(key)
            if values is not None and len(values) != width:
                raise SignkinError(
                    f"{len(values)} points in {key}",
                    place=files[frame].name,
                    expected=f"{width}, as in the other frames",
                )
            if values is not None:
                table[frame, at : at + width] = values
            at += width
    table = table[:, indices]
    trust = table[..., 2].copy()
    check_confidence(trust, canonical)
    positions = table.copy()
    positions[..., 2] = 0.0
    positions[~(trust > 0)] = np.nan
    return source_motion(
        Points(
            joints=canonical,
            positions=positions,
            flat=(True,) * len(canonical),
            confidence={joint: trust[:, j] for j, joint in enumerate(canonical)},
            unit="px",
            notes=(note,) if first > 1 else (),
        ),
        confidence_threshold=confidence_threshold,
        image_size=image_size,
    )


def _files(folder: Path) -> list[Path]:
    numbered: dict[int, Path] = {}
    video: dict[str, str] = {}
    for file in sorted(folder.iterdir()):
        found = _FRAME.fullmatch(file.name)
        if found is None:
            continue
        frame = int(found[1])
        if frame in numbered:
            raise SignkinError(
                f"frame {frame} is there twice",
                place=file.name,
                expected="the frames of one video",
                todo="Give each video a folder of its own.",
            )
        numbered[frame] = file
        name = file.name[: found.start(1)]
        if video.setdefault("name", name) != name:
            raise SignkinError(
                f"frames of {quoted(video['name'])} and of {quoted(name)}",
                place=file.name,
                expected="the frames of one video",
                todo="Give each video a folder of its own.",
            )
    if not numbered:
        raise SignkinError(
            "no file *_keypoints.json in this folder", file=folder, expected="one a frame"
        )
    first, last = min(numbered), max(numbered)
    if last - first + 1 != len(numbered):
        missing = next(i for i in range(first, last) if i not in numbered)
        raise SignkinError(
            f"no file of frame {missing}",
            file=folder,
            expected=f"every frame from {first} to {last}",
        )
    return [numbered[frame] for frame in sorted(numbered)]


def _people(file: Path) -> list[dict[str, NDArray[np.float64]]]:
    """Return the key points, (points, 3), of each person of a frame, by part of the body."""
    try:
        text = "\n".join(text_lines(file))
        content: Any = json.loads(text, object_pairs_hook=_once)
        people = content["people"]
        return [
            {
                f"{name}_keypoints_2d": _triples(person[f"{name}_keypoints_2d"])
                for name in _PARTS
                if person.get(f"{name}_keypoints_2d")
            }
            for person in people
        ]
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as e:
        raise SignkinError(
            f"not readable as OpenPose's JSON ({type(e).__name__}: {e})",
            place=file.name,
            expected="people: [{pose_keypoints_2d: [x, y, confidence, ...]}]",
        ) from e
    except SignkinError as error:
        raise SignkinError(
            error.found, place=f"{file.name}, {error.place}", expected=error.expected
        ) from error


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return a JSON object; a key that stands twice is an error, not the last one's value."""
    twice = [key for key, count in Counter(key for key, _ in pairs).items() if count > 1]
    if twice:
        raise ValueError(f"{quoted(twice[0])} stands twice")
    return dict(pairs)


def _triples(values: Any) -> NDArray[np.float64]:
    if not isinstance(values, list) or len(values) % 3:
        raise ValueError(f"{len(values)} values, which are not x, y, confidence")
    wrong = [v for v in values if isinstance(v, bool) or not isinstance(v, int | float)]
    if wrong:
        raise ValueError(f"found {quoted(wrong[0])} instead of a number")
    table = np.array(values, dtype=float).reshape(-1, 3)
    if not np.isfinite(table).all():
        raise ValueError("a value that is not finite")
    return table


def _seen(people: Sequence[Sequence[Mapping[str, Any]]], most: int) -> NDArray[np.bool_]:
    seen = np.zeros(most, dtype=bool)
    for frame in people:
        for place, keypoints in enumerate(frame):
            seen[place] |= any((values[:, 2] > 0).any() for values in keypoints.values())
    return seen


def _widths(frames: Sequence[Mapping[str, NDArray[np.float64]]]) -> dict[str, int]:
    """Return the number of points of each part of the body, as its first frame has it."""
    widths: dict[str, int] = {}
    for frame in frames:
        for key, values in frame.items():
            widths.setdefault(key, len(values))
    return {key: widths[key] for name in _PARTS if (key := f"{name}_keypoints_2d") in widths}


def _names(frames: Sequence[Mapping[str, NDArray[np.float64]]]) -> tuple[str, ...]:
    names: list[str] = []
    for key, width in _widths(frames).items():
        numbers = tuple(str(i) for i in range(width))
        points: tuple[str, ...] = numbers
        if key.startswith("pose"):
            points = _BODIES.get(width, numbers)
        elif key.startswith("hand") and width == len(OPENPOSE_HAND):
            points = OPENPOSE_HAND
        names += [f"{key}.{point}" for point in points]
    return tuple(names)
