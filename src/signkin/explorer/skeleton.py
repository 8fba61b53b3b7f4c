"""The joints of a recording as the page plays them: which, how often, how fine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.explorer.packing import packed, weight
from signkin.joints import FINGERS, bones, split
from signkin.recording import Recording

Floats = NDArray[np.float64]

MOST_HZ = 60.0  # a screen shows no more
LEAST_HZ = 12.0  # below, fingers go before frames do: signs are fast
EXTENT_SHARE = 1 / 1600  # of the extent: a step is less than a pixel of the drawing
_HANDS_ONLY = 4  # joints; with no more there is no body to draw


def skeleton(recording: Recording, most_bytes: int) -> Mapping[str, Any]:
    """Return the joints of a recording for the page, within so many bytes.

    As many frames a second as fit, at most 60. A recording so long that fewer than 12 would fit
    loses its inner finger joints first, then all but arms and head, then frames; `told` says so.
    """
    step = _step(recording.positions)
    for kept, told in _thinner(recording.joints):  # noqa: B007 - the last one tried is taken
        every = _every(recording, kept, step, most_bytes)
        if recording.rate_hz / every >= min(LEAST_HZ, recording.rate_hz):
            break
    pack = _packed(recording, kept, step, every)
    while weight(pack) > most_bytes:  # the sample that told the weight was a quiet one
        every = int(np.ceil(every * 1.2)) if every > 1 else 2
        pack = _packed(recording, kept, step, every)
    joints = [recording.joints[i] for i in kept]
    return {
        "joints": joints,
        "bones": bones(joints),
        "rate": recording.rate_hz / every,
        "flat": flat(recording.positions),
        "handsOnly": len(joints) <= _HANDS_ONLY and not bones(joints),
        "told": told,
        "positions": pack,
    }


def flat(positions: Floats) -> bool:
    """Return whether a recording (F, J, 3) has no depth: all joints lie in one upright plane."""
    depth = positions[..., 1]
    # fmin and fmax pass over gaps; without any number they give NaN, in silence.
    low = float(np.fmin.reduce(depth, axis=None))
    high = float(np.fmax.reduce(depth, axis=None))
    return not high > low


FRAMES_OF_EXTENT = 5000  # tell the extent of a recording well enough


def _step(positions: Floats) -> float:
    """Return the size of a step that no one sees: by the extent of the middle 98 % of places."""
    some = positions[:: max(1, len(positions) // FRAMES_OF_EXTENT)]
    there = some[np.isfinite(some).all(axis=2)]
    if not len(there):
        return 1.0
    low, high = np.percentile(there, (1, 99), axis=0)
    return max(float((high - low).max()) * EXTENT_SHARE, 1e-9)


def _thinner(joints: Sequence[str]) -> list[tuple[list[int], str]]:
    """Return choices of joints, each with fewer than the one before, and how to tell it."""
    everything = list(range(len(joints)))
    tips = [i for i in everything if not _inner_finger(joints[i], joints)]
    large = [i for i in everything if not _finger(joints[i])]
    choices = [(everything, "")]
    if len(tips) < len(everything):
        choices.append((tips, "of the fingers only the last joints, for the length of it"))
    if len(large) < len(tips):
        choices.append((large, "without fingers, for the length of it"))
    return choices


def _finger(joint: str) -> bool:
    return split(joint)[1].rsplit("_", 1)[0] in FINGERS


def _inner_finger(joint: str, joints: Sequence[str]) -> bool:
    """Return whether another joint of the same finger lies nearer to its tip."""
    if not _finger(joint):
        return False
    stem, number = joint.rsplit("_", 1)
    further = [f"{stem}_tip", *(f"{stem}_{n}" for n in range(4, 0, -1))]
    present = [name for name in further if name in joints]
    return number != present[0].rsplit("_", 1)[1]


SAMPLE = 3000  # frames that tell how heavy the others will be


def _every(recording: Recording, kept: Sequence[int], step: float, most_bytes: int) -> int:
    """Return of how many frames one is taken, so that all fit."""
    every = max(1, int(np.ceil(recording.rate_hz / MOST_HZ)))
    while True:
        taken = range(0, recording.frames, every)
        part = recording.positions[::every][:SAMPLE, kept]
        sample = weight(packed(part.reshape(len(part), -1), step))
        if sample * len(taken) / len(part) <= most_bytes or len(part) < 3:
            return every
        every = max(every + 1, int(every * 1.15))


def _packed(
    recording: Recording, kept: Sequence[int], step: float, every: int
) -> Mapping[str, Any]:
    part = recording.positions[::every][:, kept]
    return packed(part.reshape(len(part), -1), step)
