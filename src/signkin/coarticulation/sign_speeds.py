"""Mean speed of the signs around a transition (Naert et al. 2017, section 5.2, eq. 3).

The paper says "mean velocity of the two surrounding signs": here the mean over the joints and
frames of a sign of the speed of joints (distance unit a second) and of their orientations. The
angle between two orientations is the one of eq. 1, half the rotation angle, so that distance
over speed is a time.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.annotation import Interval
from signkin.recording import Recording

SIDES = ("previous", "next")
ONE_FRAME = "a sign of one frame has no speed"
NO_ORIENTATIONS = "no orientations in the sign: no angular speed"


def sign_speeds(
    positions: NDArray[np.float64],
    orientations: NDArray[np.float64] | None,
    signs: Sequence[Interval],
    recording: Recording,
) -> NDArray[np.float64]:
    """Return linear and angular speed of each sign, (N, 2); NaN where there is none.

    positions: (F, J, 3), orientations: (F, J, 4) or None, both low-passed (noise adds to a path
    and so to a speed). Joints and frames with gaps are left out of the mean.
    """
    return mean_speeds(step_speeds(positions, orientations, recording.rate_hz), signs, recording)


def step_speeds(
    positions: NDArray[np.float64], orientations: NDArray[np.float64] | None, rate_hz: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return linear and angular speeds from each frame to the next, (F - 1, J) each.

    Without orientations the angular ones are (F - 1, 1), NaN.
    """
    linear = np.linalg.norm(np.diff(positions, axis=0), axis=2) * rate_hz
    angular = np.full((len(positions) - 1, 1), np.nan)
    if orientations is not None:
        angular = step_angles(orientations) * rate_hz
    return linear, angular


def mean_speeds(
    speeds: tuple[NDArray[np.float64], NDArray[np.float64]],
    signs: Sequence[Interval],
    recording: Recording,
) -> NDArray[np.float64]:
    """Return the means of `step_speeds` within each sign, as `sign_speeds` does."""
    out = np.full((len(signs), 2), np.nan)
    for i, sign in enumerate(signs):
        first, last = recording.frame_at(sign.start_s), recording.frame_at(sign.end_s)
        for k, steps in enumerate(speeds):
            piece = steps[first:last]
            if np.isfinite(piece).any():
                out[i, k] = np.nanmean(piece)
    return out


def step_angles(orientations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return half the rotation angle from each frame to the next, (F - 1, J), rad."""
    a, b = orientations[:-1], orientations[1:]
    # |a - b| of unit quaternions is 2 sin(angle / 4): exact for the small angles of a frame.
    chord = np.minimum(np.linalg.norm(a - b, axis=2), np.linalg.norm(a + b, axis=2))
    return np.asarray(2 * np.arcsin(np.clip(chord / 2, 0, 1)))


def continuous(orientations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the same orientations with the signs of q and -q chosen without jumps, (F, J, 4)."""
    dots = (orientations[1:] * orientations[:-1]).sum(axis=2)
    flips = np.cumprod(np.where(dots < 0, -1.0, 1.0), axis=0)
    out = orientations.copy()
    out[1:] *= flips[:, :, None]
    return out


def transition_speed_rows(
    speeds: NDArray[np.float64], utterances: Sequence[str], unit: str
) -> pd.DataFrame:
    """Return the speeds around each transition, numbered as `transition_rows` numbers them."""
    pairs = [
        i for i in range(len(speeds) - 1) if utterances[i] and utterances[i] == utterances[i + 1]
    ]
    kinds = (f"linear_speed_{unit}_per_s", "angular_speed_rad_per_s")
    columns = [f"{side}_{kind}" for kind in kinds for side in SIDES]
    rows = []
    for number, i in enumerate(pairs, start=1):
        values = [speeds[i + j, k] for k in (0, 1) for j in (0, 1)]
        note = ONE_FRAME if np.isnan(values[:2]).any() else ""
        if not note and np.isnan(values[2:]).any():
            note = NO_ORIENTATIONS
        rows.append((number, *values, note))
    return pd.DataFrame(rows, columns=["transition", *columns, "note"])
