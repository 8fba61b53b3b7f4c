"""Compiled: which drawn laws are clearly rejected, before a path is warped by them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from signkin.jit import kernel

F = NDArray[np.float64]
I = NDArray[np.int64]  # noqa: E741

OPEN, TOO_FAST, TOO_SHORT, TOO_LONG = range(4)  # TOO_LONG: or too short beside the recorded
NEAR = 1e-9  # a limit missed or met by less, relative, is for `ground_truth._timing` to tell


@kernel
def verdict(
    nodes: I, beta: F, log_gain: F, log_top: F, top_recorded: F, speed: F, log_k: F, time_s: F,
    by_duration: bool, most_speed_ratio: float, least_segment_s: float, most_duration_ratio: float,
) -> int:  # fmt: skip
    """Return why a draw is rejected, or OPEN.

    nodes: (N + 1,) at which segments begin and end. beta, log_gain, log_top, top_recorded: (N,).
    speed, log_k, time_s: of the path's nodes. by_duration: whether the first gain follows from
    the duration of the whole. The numbers are those of `ground_truth._timing`, but for rounding.
    """
    segments = len(beta)
    durations = np.zeros(segments)
    whole = 0.0
    for j in range(segments):
        last = 0.0
        for at in range(nodes[j], nodes[j + 1] + 1):
            rate = speed[at] * math.exp(-beta[j] * log_k[at] - log_gain[j])
            if at > nodes[j]:
                durations[j] += 0.5 * (rate + last) * (time_s[at] - time_s[at - 1])
            last = rate
        whole += durations[j]
    gain = whole / time_s[-1] if by_duration else speed[0] * math.exp(-beta[0] * log_k[0])
    far = beyond = False
    for j in range(segments):
        ratio = gain * math.exp(log_top[j]) / top_recorded[j]
        far = far or outside(ratio, most_speed_ratio * (1 + NEAR))
        beyond = beyond or outside(ratio, most_speed_ratio * (1 - NEAR))
    if far or beyond:
        return TOO_FAST if far else OPEN
    for j in range(segments):
        far = far or durations[j] / gain < least_segment_s * (1 - NEAR)
        beyond = beyond or durations[j] / gain < least_segment_s * (1 + NEAR)
    if far or beyond:
        return TOO_SHORT if far else OPEN
    for j in range(segments):
        ratio = durations[j] / gain / (time_s[nodes[j + 1]] - time_s[nodes[j]])
        far = far or outside(ratio, most_duration_ratio * (1 + NEAR))
    return TOO_LONG if far else OPEN


@kernel
def outside(ratio: float, most: float) -> bool:
    """Return whether a ratio is above the most, or below its inverse."""
    return ratio > most or ratio * most < 1.0
