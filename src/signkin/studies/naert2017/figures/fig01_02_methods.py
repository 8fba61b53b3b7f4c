"""Fig. 1 and 2: a transition by interpolation, and by blending, with what it is made of."""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin.coarticulation.synthesis import Transition
from signkin.figures import skeletons, style
from signkin.report.drawn import Drawn
from signkin.studies.naert2017.figures.skeleton_parts import (
    SIDE_S,
    Array,
    Signs,
    at,
    joint_rows,
    make,
    signs_of,
    skeletons_table,
    space,
    takes_of,
    track,
)
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.database import Database
from signkin.studies.naert2017.synthesis.duration_models import Timing
from signkin.studies.naert2017.synthesis.joining import INTERPOLATION

COLOURS = [skeletons.FIRST] * 2 + [skeletons.BETWEEN] * 4 + [skeletons.SECOND] * 2


@dataclass(frozen=True, eq=False)
class Shown:
    """A transition, and the postures (K, J, 3) at some instants (s) in and beside it."""

    signs: Signs
    method: str
    made: Transition
    instants: list[float]
    postures: Array

    @property
    def duration_s(self) -> float:
        """Length of the transition."""
        return self.made.steps / self.signs[0].recording.rate_hz

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints."""
        return self.signs[0].recording.joints


def drawn(
    base: Database,
    pair: tuple[int, int],
    method: str,
    clock: Timing,
    settings: SynthesisSettings,
) -> Drawn:
    """Draw the transition between two tokens."""
    shown = what_is_shown(base, pair, method, clock, settings)
    return Drawn(draw(shown, base.corpus.unit), data(base, shown), caption(base, shown, clock))


def what_is_shown(
    base: Database,
    pair: tuple[int, int],
    method: str,
    clock: Timing,
    settings: SynthesisSettings,
) -> Shown:
    """Return the transition, and its postures at eight instants."""
    signs = signs_of(base, pair)
    wanted, _ = clock.ask(base.features([pair[0]], [pair[1]]))
    made = make(method, signs, wanted, settings)
    duration = made.steps / signs[0].recording.rate_hz
    times, path = track(signs, made.motion.positions, SIDE_S)
    instants = [-0.9 * SIDE_S, 0.0, *(duration * np.array([0.2, 0.4, 0.6, 0.8])), duration,
                duration + 0.9 * SIDE_S]  # fmt: skip
    return Shown(signs, method, made, instants, np.array([at(times, path, t) for t in instants]))


def data(base: Database, shown: Shown) -> pd.DataFrame:
    """Return the postures as the table `skeletons`."""
    rows = []
    for instant, posture in zip(shown.instants, shown.postures, strict=True):
        rows += joint_rows(
            shown.joints, posture, "postures", shown.made.method, instant, base.corpus.unit
        )
    return skeletons_table(base, rows)


def draw(shown: Shown, unit: str) -> Figure:
    """Draw the postures above, what the transition is made of below."""
    short = shown.method == INTERPOLATION
    count = len(shown.instants)
    figure = plt.figure(figsize=(style.WIDTH_IN, 2.5 if short else 3.1))
    grid = figure.add_gridspec(2, count, height_ratios=[1.5, 0.55 if short else 1.1])
    axes = [figure.add_subplot(grid[0, k]) for k in range(count)]
    for ax, instant, posture, colour in zip(
        axes, shown.instants, shown.postures, COLOURS, strict=True
    ):
        skeletons.plot_posture(posture, shown.joints, ax=ax, colour=colour, unit=unit)
        ax.set_axis_off()
        ax.set_title(f"{instant:.2f} s", fontsize=7.5, color=colour)
    skeletons.frame_on(axes, shown.postures, shown.joints, unit)
    below = figure.add_subplot(grid[1, :])
    first, second = shown.signs
    steps = {"start": -SIDE_S, "second_start": shown.duration_s, "end": shown.duration_s + SIDE_S,
             "rate_hz": first.recording.rate_hz}  # fmt: skip
    labels = {"first": first.gloss, "second": second.gloss}
    skeletons.plot_scheme(steps, labels, shown.method, ax=below)
    for instant, colour in zip(shown.instants, COLOURS, strict=True):
        below.plot([instant], [-0.08], marker="^", ms=4, color=colour, clip_on=False, lw=0)
    return figure


def caption(base: Database, shown: Shown, clock: Timing) -> str:
    """Tell how the transition is made, of which recordings, and how long by which model."""
    first, second = shown.signs
    how = (
        f"between the last posture of {first.gloss} (blue) and the first of {second.gloss} "
        "(green); neither retraction nor preparation is used"
        if shown.method == INTERPOLATION
        else f"of the n frames after {first.gloss} (retraction R₁, weight falling) with the n "
        f"frames before {second.gloss} (preparation P₂, weight rising)"
    )
    text = (
        f"Transition by {shown.method} {how}. Recording {takes_of(shown.signs)}; "
        f"{shown.duration_s:.2f} s by {clock.told}. {space(base)} Postures from in front at the "
        "triangles' times."
    )
    if shown.made.idle:
        text += f" {shown.made.idle} frames were not captured: idle posture."
    return text
