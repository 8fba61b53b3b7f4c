"""Kinematics of a transition among the signs around it, and its distance to the captured one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signkin.joints import wrists_of
from signkin.kinematics.filters import lowpass
from signkin.kinematics.minima import minima_with_depth
from signkin.recording import Recording
from signkin.settings.sections import Kinematics
from signkin.studies.naert2017.synthesis.database import Array

CONTEXT_S = 0.5  # of the signs around a transition, for filter and minima


@dataclass(frozen=True)
class Measures:
    """Kinematics of a transition, both wrists, low-passed: see the table `synthesis`."""

    peak_speed: float
    rms_jerk: float
    minima: float


def measures(
    before: Recording,
    last: int,
    between: Array,
    after: Recording,
    first: int,
    settings: Kinematics,
    depth: float,
) -> Measures:
    """Measure a transition among the signs around it.

    between: positions (n + 1, J, 3) from posture `last` of `before` to posture `first` of
    `after`. depth: least one of a minimum, as `least_depth` tells.
    """
    path, start, end = spliced(before, last, between, after, first)
    if np.isnan(path).any() or len(path) < 5:
        return Measures(float("nan"), float("nan"), float("nan"))
    rate = before.rate_hz
    smooth = lowpass(path, rate, **dict(settings.lowpass))
    speed = np.linalg.norm(np.gradient(smooth, 1 / rate, axis=0), axis=-1)
    jerk = np.linalg.norm(np.diff(smooth, n=3, axis=0), axis=-1) * rate**3
    # The third difference of frames k to k + 3 belongs between k + 1 and k + 2.
    inside = jerk[max(0, start - 1) : max(start, end - 1)]
    count = 0
    for hand in range(speed.shape[1]):
        times = minima_with_depth(speed[:, hand], rate, depth, settings.minima.spacing_s)[0]
        frames = np.rint(times * rate)
        count += int(((frames > start) & (frames < end)).sum())
    return Measures(
        peak_speed=float(speed[start : end + 1].max()),
        rms_jerk=float(np.sqrt((inside**2).mean())) if inside.size else float("nan"),
        minima=count,
    )


def spliced(
    before: Recording, last: int, between: Array, after: Recording, first: int
) -> tuple[Array, int, int]:
    """Return the wrists' paths (F, H, 3) through a transition, and its first and last frame."""
    wrists = [before.index(wrist) for wrist in wrists_of(before.joints)]
    context = round(CONTEXT_S * before.rate_hz)
    head = before.positions[max(0, last - context) : last, wrists]
    tail = after.positions[first + 1 : first + 1 + context, wrists]
    path = np.concatenate([head, between[:, wrists], tail])
    return path, len(head), len(head) + len(between) - 1


def least_depth(recording: Recording, settings: Kinematics) -> float:
    """Return how deep a minimum must be: the share of config of the faster hand's speed."""
    wrists = [recording.index(wrist) for wrist in wrists_of(recording.joints)]
    smooth = lowpass(recording.positions[:, wrists], recording.rate_hz, **dict(settings.lowpass))
    speed = np.linalg.norm(np.gradient(smooth, 1 / recording.rate_hz, axis=0), axis=-1)
    fastest = max((float(np.nanpercentile(s, 95)) for s in speed.T if not np.isnan(s).all()),
                  default=0.0)  # fmt: skip
    return settings.minima.prominence * fastest


def aligned_errors(found: Array, truth: Array) -> Array:
    """Return the distances (frames, J) of the joints between the ends, after time alignment.

    found (n + 1, J, 3), truth (m + 1, J, 3): both are run through in the same time, frame k of
    the truth is compared with the found posture at the same share of its duration.
    """
    share = np.arange(1, len(truth) - 1) / (len(truth) - 1)
    at = share * (len(found) - 1)
    low = np.minimum(at.astype(int), len(found) - 2)
    part = (at - low)[:, None, None]
    there = found[low] + part * (found[low + 1] - found[low])
    return np.asarray(np.linalg.norm(there - truth[1:-1], axis=-1))
