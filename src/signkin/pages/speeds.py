"""Wrist speed of a corpus without tags: some of its recordings, a panel each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin.figures import speed, style

SPEED_PANELS = 4  # recordings drawn of a corpus


def spread(names: Sequence[str], most: int) -> list[str]:
    """Return up to `most` names from the first to the last at even steps: not four of one sign."""
    places = np.linspace(0, len(names) - 1, min(most, len(names))).round().astype(int)
    return [names[place] for place in places]


def draw_speeds(
    frames: Sequence[Path], minima: pd.DataFrame, unit: str, most: int = SPEED_PANELS
) -> Figure:
    """Draw wrist speeds and minima, a panel a recording, of `most` spread over a corpus.

    frames: files of the kinematics. minima: the table of the corpus. unit: m or px.
    """
    there = [pd.read_parquet(path, columns=["recording"])["recording"] for path in frames]
    names = spread(list(dict.fromkeys(pd.concat(there))), most)
    wanted = [("recording", "in", names)]
    kinematics = pd.concat([pd.read_parquet(path, filters=wanted) for path in frames])
    figure, axes = plt.subplots(
        len(names), 1, figsize=(style.WIDTH_IN, 0.6 + 1.7 * len(names)), squeeze=False
    )
    for name, ax in zip(names, axes[:, 0], strict=True):
        chosen = kinematics[kinematics["recording"] == name]
        speed.plot_recording(chosen, minima[minima["recording"] == name], unit, ax=ax)
        ax.set_title(name, loc="left")
    axes[-1, 0].set_xlabel("time in the recording (s)")
    return figure
