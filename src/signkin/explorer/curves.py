"""The curves of a recording: speed of both wrists, and where binning sees boundaries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from signkin.explorer.densities import in_ms
from signkin.explorer.packing import packed
from signkin.joints import HANDS

MOST_POINTS = 180_000  # of a curve: ten minutes at 300 Hz, two hours at 25 Hz
SPEED_STEPS = 4000  # of the greatest speed
DENSITY_STEP = 1 / 1000


def speeds(kinematics: pd.DataFrame, rate_hz: float, unit: str) -> Mapping[str, Any]:
    """Return the low-passed speed of both wrists of one recording, as the page draws it.

    kinematics: its frames, as the rule `kinematics` writes them. Of a recording with more than
    180,000 frames every second, third, ... is taken: the speed is low-passed, so that little lies
    between them, and the page tells the rate. A hand whose wrist has no column is left out.
    """
    every = -(-len(kinematics) // MOST_POINTS)
    frames = kinematics.iloc[::every]
    hands = [hand for hand in HANDS if f"{hand}_speed_{unit}_per_s" in kinematics]
    values = frames[[f"{hand}_speed_{unit}_per_s" for hand in hands]].to_numpy(dtype=float)
    values = values.reshape(len(frames), len(hands))
    top = float(np.nanmax(values)) if np.isfinite(values).any() else 0.0
    return {
        "hands": hands,
        "rate": rate_hz / every,
        "whole": every == 1,
        "top": float(f"{top:.6g}"),
        "values": packed(values, max(top / SPEED_STEPS, 1e-9)),
    }


def single_sign_densities(posteriors: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the posterior of boundaries of a recording of one sign, by order.

    posteriors: its rows of posteriors.parquet, of the recorded trajectory. Values stand between
    two bins, where a segment may end; first runs from the start of the movement, times (in ms, each
    as its distance from the one before) too.
    """
    recorded = posteriors.sort_values("order")
    out: list[dict[str, Any]] = []
    for row in recorded.itertuples():
        values = np.asarray(row.boundary_probability, dtype=float)
        bin_s = float(row.bin_s)
        out.append(
            {
                "hand": str(row.hand),
                "order": int(row.order),
                "probability": float(f"{row.order_probability:.4g}"),
                "first": (0.5 + float(row.sample_at)) * bin_s,
                "bin": bin_s,
                "times": in_ms(row.boundaries_s),
                "values": packed(values.reshape(-1, 1), DENSITY_STEP),
            }
        )
    return out


def series_boundaries(boundaries: pd.DataFrame, posteriors: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the boundaries that binning finds in both wrists of a continuous recording.

    boundaries, posteriors: its rows of the tables `wrist_boundaries` and `wrist_posteriors`.
    times: in ms, each as its distance from the one before; values: posteriors in %.
    """
    out: list[dict[str, Any]] = []
    for row in posteriors.itertuples():
        mine = boundaries[boundaries["hand"] == row.hand].sort_values("boundary_s")
        out.append(
            {
                "hand": str(row.hand),
                "order": int(row.order),
                "times": in_ms(mine["boundary_s"]),
                "values": np.rint(100 * mine["probability"]).astype(int).tolist(),
            }
        )
    return out
