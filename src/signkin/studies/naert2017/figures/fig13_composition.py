"""Fig. 13: two signs that do not follow one another, composed."""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from signkin.coarticulation.synthesis import METHODS
from signkin.figures import skeletons, style
from signkin.joints import wrists_of
from signkin.report.drawn import Drawn
from signkin.studies.naert2017.figures.chosen_signs import FAR, far_pair
from signkin.studies.naert2017.figures.skeleton_parts import (
    Array,
    Curve,
    Signs,
    bare,
    busier,
    joint_rows,
    make,
    model_curves,
    signs_of,
    skeletons_table,
    speed_rows,
    takes_of,
)
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.database import Database
from signkin.studies.naert2017.synthesis.duration_models import model_durations
from signkin.studies.naert2017.synthesis.joining import INTERPOLATION


@dataclass(frozen=True, eq=False)
class Shown:
    """Two signs and what the models and methods make between them.

    durations: model -> s; told: what the models learnt from. ends: the postures joined, (2, J, 3).
    paths: method -> wrists (n + 1, H, 3) with the duration of `model`. curves: method -> model ->
    speed of the wrist of `hand`.
    """

    signs: Signs
    pair: tuple[int, int]
    hand: str
    durations: dict[str, float]
    told: str
    ends: Array
    model: str
    paths: dict[str, Array]
    curves: dict[str, dict[str, Curve]]

    @property
    def names(self) -> tuple[str, str]:
        """What the two postures are."""
        first, second = self.signs
        return f"last posture of\n{first.gloss}", f"first posture of\n{second.gloss}"


def drawn(base: Database, settings: SynthesisSettings, printed: Array) -> Drawn:
    """Draw the composition of two distant signs; printed: theta of the paper."""
    shown = what_is_shown(base, settings, printed)
    bounds = (settings.durations.lowest_s, settings.durations.highest_s)
    return Drawn(draw(shown, base.corpus.unit, bounds), data(base, shown), caption(base, shown))


def what_is_shown(base: Database, settings: SynthesisSettings, printed: Array) -> Shown:
    """Return the two signs chosen, and all that is made between them."""
    pair = far_pair(base)
    signs = signs_of(base, pair)
    take = signs[0].recording
    durations, told = model_durations(base, pair, settings.durations, printed)
    if not durations:
        durations = {"simple_bounded": float(settings.durations.highest_s)}
    hand = busier(signs)
    model = "surface" if "surface" in durations else next(reversed(durations))
    wrists = [take.index(wrist) for wrist in wrists_of(take.joints)]
    return Shown(
        signs=signs,
        pair=pair,
        hand=hand,
        durations=durations,
        told=told,
        ends=np.array(
            [take.positions[signs[0].last], signs[1].recording.positions[signs[1].first]]
        ),
        model=model,
        paths={
            method: make(method, signs, durations[model], settings).motion.positions[:, wrists]
            for method in METHODS
        },
        curves={
            method: model_curves(signs, durations, method, hand, settings) for method in METHODS
        },
    )


def data(base: Database, shown: Shown) -> pd.DataFrame:
    """Return postures, the wrists' paths, durations and speeds as the table `skeletons`."""
    unit, take = base.corpus.unit, shown.signs[0].recording
    joints, wrists = take.joints, wrists_of(take.joints)
    rows = []
    for posture, name in zip(shown.ends, shown.names, strict=True):
        rows += joint_rows(joints, posture, "postures", name.replace("\n", " "), 0.0, unit)
    for method, path in shown.paths.items():
        for frame, posture in enumerate(path):
            rows += joint_rows(wrists, posture, "postures", method, frame / take.rate_hz, unit)
    for model, duration in shown.durations.items():
        rows.append({"panel": "durations", "motion": model, "kind": "duration", "time_s": duration})
    for method, curves in shown.curves.items():
        for model, curve in curves.items():
            rows += speed_rows(curve, method, model, shown.hand, unit)
    return skeletons_table(base, rows)


def draw(shown: Shown, unit: str, bounds_s: tuple[float, float]) -> Figure:
    """Draw postures and durations above, speed by each method below.

    bounds_s: of SIMPLE BOUNDED.
    """
    figure = plt.figure(figsize=(style.WIDTH_IN, 4.7))
    above, below = figure.subfigures(2, 1, height_ratios=[1.2, 1])
    left, key, right = above.subplots(1, 3, width_ratios=[1.0, 0.75, 1.25])
    panels = below.subplots(1, 2, sharey=True)
    _draw_postures(left, shown, unit)
    key.set_axis_off()
    key.legend(*left.get_legend_handles_labels(), loc="center", borderaxespad=0)
    skeletons.plot_durations(shown.durations, bounds_s, ax=right)
    _draw_speeds(below, panels, shown, unit)
    return figure


def _draw_postures(ax: Axes, shown: Shown, unit: str) -> None:
    joints = shown.signs[0].recording.joints
    for posture, colour, name in zip(
        shown.ends, (skeletons.FIRST, skeletons.SECOND), shown.names, strict=True
    ):
        skeletons.plot_posture(
            posture, joints, ax=ax, colour=colour, width=1.6, label=name, unit=unit
        )
    for method, path in shown.paths.items():
        for w in range(path.shape[1]):
            ax.plot(
                -path[:, w, 0], path[:, w, 2], color=skeletons.METHOD_COLOURS[method], lw=1.1,
                ls=":" if method == INTERPOLATION else "-",
                label=f"wrists by\n{method}" if w == 0 else None,
            )  # fmt: skip
    bare(ax)
    skeletons.frame_on([ax], shown.ends, joints, unit)
    # Room for the wrists' paths, which may leave the frame of the postures.
    around = np.concatenate([a.reshape(-1, 3) for a in (shown.ends, *shown.paths.values())])
    x, z = -around[:, 0], around[:, 2]
    ax.set_xlim(min(ax.get_xlim()[0], np.nanmin(x)), max(ax.get_xlim()[1], np.nanmax(x)))
    ax.set_ylim(min(ax.get_ylim()[0], np.nanmin(z)), ax.get_ylim()[1])


def _draw_speeds(below: SubFigure, panels: list[Axes], shown: Shown, unit: str) -> None:
    for (method, curves), ax in zip(shown.curves.items(), panels, strict=True):
        drawn = {model: curve.drawn for model, curve in curves.items()}
        skeletons.plot_transition_speed(drawn, None, unit, ax=ax)
        ax.set_title(method, fontsize=8.5)
    panels[1].set_ylabel("")
    panels[0].set_ylim(bottom=0)
    handles, names = panels[0].get_legend_handles_labels()
    below.legend(
        handles, [name.split(",")[0] for name in names], loc="outside lower center", ncols=4
    )


def caption(base: Database, shown: Shown) -> str:
    """Tell which signs, how far apart, and what is drawn."""
    first, second = shown.signs
    features = base.features([shown.pair[0]], [shown.pair[1]])
    far = f"{float(features.euclidean[0]) * base.euclidean_unit:.3g} {base.corpus.unit}"
    if np.isfinite(features.geodesic[0]):
        far += f" and {float(features.geodesic[0]):.3f} rad"
    why = (
        f"farther apart than {FAR:.0%} of all pairs that do not follow one another"
        if len(base.tokens) > 2
        else "the corpus's two signs, of two takes"
    )
    return (
        f"Composition of {first.gloss} and {second.gloss} ({takes_of(shown.signs)}), {far} apart "
        f"(mean over joints): {why}. Duration by each model (dotted: the bounds of SIMPLE BOUNDED; "
        f"{shown.told}); below: speed of the {shown.hand} wrist by both methods, a dot where the "
        f"second sign begins. Wrist paths: duration by {shown.model.upper()}. There is no captured "
        "motion to compare with."
    )
