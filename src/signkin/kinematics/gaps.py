"""Gaps: short ones are filled, long ones stay, every frame is counted.

Nothing else in the package fills a gap, and nothing is extrapolated: a gap at
the start or end of a recording stays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy  # loads its parts when they are used
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.joints import wrists_of
from signkin.masked import unmasked
from signkin.recording import Recording


def stretches(there: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the runs of True as (first, last + 1)."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], there.astype(np.int8), [0]))))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def fill_gaps(
    track: NDArray[np.float64], rate_hz: float, longest_gap_s: float
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Fill the gaps of a track that are no longer than `longest_gap_s`.

    track: (F, 3), NaN in gaps; a frame with any NaN is a gap.
    Returns the filled track and which frames were filled, (F,). The filling is a
    shape-preserving cubic (PCHIP), which does not overshoot.
    """
    track = unmasked(track)
    gap = np.asarray(np.isnan(track).any(axis=1))
    filled = np.zeros(len(track), dtype=bool)
    longest = longest_gap_s * rate_hz + 1e-9
    for first, end in stretches(gap):
        if first > 0 and end < len(track) and end - first <= longest:
            filled[first:end] = True
    out = track.copy()
    if filled.any():
        frames = np.arange(len(track))
        out[filled] = scipy.interpolate.PchipInterpolator(frames[~gap], track[~gap])(frames[filled])
    out[gap & ~filled] = np.nan
    return out, filled


def longest_stretch_s(gap: NDArray[np.bool_], rate_hz: float) -> float:
    """Return the length of the longest gap in seconds."""
    return max((b - a for a, b in stretches(gap)), default=0) / rate_hz


def cut_at_gaps(
    recording: Recording,
    longest_gap_s: float,
    joints: Sequence[str] | None = None,
    shortest_s: float = 0.5,
) -> list[Recording]:
    """Return the pieces of a recording between gaps of its joints longer than `longest_gap_s`.

    joints: the wrists, if not told. A frame where any of them is missing is a gap; shorter gaps
    stay in their piece. Pieces shorter than `shortest_s` are left out. Each is named
    `<name>-<number>` from 1, and notes where it starts. A recording that has no such gap is
    returned as it is; none left is an error.
    """
    chosen = joints or wrists_of(recording.joints)
    tracks = np.concatenate([recording.track(joint) for joint in chosen], axis=1)
    gap = np.asarray(np.isnan(tracks).any(axis=1))
    rate = recording.rate_hz
    lost = np.zeros(recording.frames, dtype=bool)
    for first, end in stretches(gap):
        # At the ends, too, nothing is known of a gap: a short one stays there.
        lost[first:end] = end - first > longest_gap_s * rate + 1e-9
    if not lost.any():
        return [recording]
    pieces = [
        (first, end)
        for first, end in stretches(~lost)
        if end - first >= max(2.0, shortest_s * rate - 1e-9)
    ]
    if not pieces:
        raise SignkinError(
            f"no stretch of {shortest_s:g} s without a gap over {longest_gap_s:g} s",
            file=f"recording {recording.name}",
            expected="one or more",
        )
    turned = recording.orientations
    return [
        replace(
            recording,
            name=f"{recording.name}-{number}",
            positions=recording.positions[first:end],
            orientations=None if turned is None else turned[first:end],
            notes=(*recording.notes, f"cut from {first / rate:.3f} s to {end / rate:.3f} s"),
        )
        for number, (first, end) in enumerate(pieces, start=1)
    ]
