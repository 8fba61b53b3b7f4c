"""A wrist ready for bins: which hand, its gaps, its flat axes, its low-pass, and the bins.

Single signs (Endres et al. 2013, section 2.2) and long series start from here alike: short gaps
are filled, long ones refused, an axis along which the wrist never moves is left out, and the
path is low-passed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy  # loads its parts when they are used
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.joints import HANDS
from signkin.kinematics.filters import lowpass
from signkin.kinematics.gaps import fill_gaps
from signkin.recording import Recording
from signkin.settings.sections import BinningLowpass

Floats = NDArray[np.float64]

AXES = "xyz"
SPLINE_ORDER = 5


@dataclass(frozen=True, eq=False)
class Wrist:
    """The wrist of one recording, ready for bins.

    path: (F, L) positions, low-passed, without gaps, in the recording's unit. axes: the L axes
    of the path, `xyz` or fewer: those along which the wrist moves.
    """

    recording: str
    hand: str
    path: Floats
    rate_hz: float
    axes: str


def ready_wrist(
    recording: Recording, hand: str, longest_gap_s: float, low: BinningLowpass
) -> Wrist:
    """Return a hand's wrist: gaps filled, flat axes left out, low-passed.

    longest_gap_s: kinematics.longest_gap_s; low: binning.lowpass.
    An axis is flat where all its values are the same: the third coordinate of flat recordings
    (always 0), or one that a tracker never gave. It is no data: in binning, an axis without
    variance would count as a dimension that every polynomial fits.
    Raises SignkinError on a long gap, on a wrist that does not move, and on a low rate.
    """
    where, joint = f"recording {recording.name}", f"{hand}_wrist"
    filled, _ = fill_gaps(recording.track(joint), recording.rate_hz, longest_gap_s)
    gaps = int(np.isnan(filled).any(axis=1).sum())
    if gaps:
        raise SignkinError(
            f"{gaps} frames without a position",
            file=where,
            place=joint,
            expected="a path without long gaps (kinematics.longest_gap_s)",
        )
    moving = np.ptp(filled, axis=0) > 0
    if not moving.any():
        raise SignkinError(
            "the wrist does not move", file=where, place=joint, expected="a movement"
        )
    try:
        path = lowpass(np.ascontiguousarray(filled[:, moving]), recording.rate_hz, **dict(low))
    except SignkinError as error:
        raise error.at(file=where) from error
    axes = "".join(axis for axis, moves in zip(AXES, moving, strict=True) if moves)
    return Wrist(recording.name, hand, path, recording.rate_hz, axes)


def moving_hand(recording: Recording, longest_gap_s: float) -> str:
    """Return the hand whose wrist has the longer path, gaps up to `longest_gap_s` filled."""
    moved = {}
    for hand in HANDS:
        joint = f"{hand}_wrist"
        if joint in recording.joints:
            track = fill_gaps(recording.track(joint), recording.rate_hz, longest_gap_s)[0]
            moved[hand] = float(np.nansum(np.linalg.norm(np.diff(track, axis=0), axis=1)))
    return max(moved, key=lambda name: moved[name])


def in_bins(path: Floats, rate_hz: float, bins: int) -> tuple[Floats, float]:
    """Return a path (F, L) at the middle of T bins, by a spline, and the bins' duration in s.

    As many bins as samples are the samples.
    """
    frames = len(path)
    if frames == bins:
        return np.array(path, dtype=float), 1 / rate_hz
    duration = (frames - 1) / rate_hz
    bin_s = duration / bins
    middle = (np.arange(bins) + 0.5) * bin_s
    curve = scipy.interpolate.make_interp_spline(
        np.arange(frames) / rate_hz, path, k=min(SPLINE_ORDER, frames - 1)
    )
    return np.asarray(curve(middle)), bin_s


def sample_at(frames: int, bins: int) -> float:
    """Return where in its bin a position of `in_bins` is, as a share of the bin.

    In the middle; at the start where each frame is a bin: frame i stands at i / rate.
    """
    return 0.0 if bins == frames else 0.5
