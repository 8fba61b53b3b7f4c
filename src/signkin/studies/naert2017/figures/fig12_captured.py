"""Fig. 12: a captured transition, and the same one synthesised."""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec

from signkin.coarticulation.synthesis import METHODS
from signkin.figures import skeletons, style
from signkin.report.drawn import Drawn
from signkin.studies.naert2017.figures.chosen_signs import SHOWN_S, chosen_transition, shown_pair
from signkin.studies.naert2017.figures.skeleton_parts import (
    Array,
    Curve,
    Signs,
    at,
    bare,
    busier,
    joint_rows,
    make,
    model_curves,
    nothing_to_draw,
    signs_of,
    skeletons_table,
    space,
    speed_curve,
    speed_rows,
    track,
)
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.comparison import OWN
from signkin.studies.naert2017.synthesis.database import Database
from signkin.studies.naert2017.synthesis.duration_models import MODELS
from signkin.studies.naert2017.synthesis.measures import CONTEXT_S

INSTANTS = (0.25, 0.5, 0.75, 1.0)  # of the captured duration


@dataclass(frozen=True, eq=False)
class Panel:
    """Postures (J, 3) at one instant: captured, and by each method with one model's duration."""

    model: str
    instant_s: float
    captured: Array
    made: dict[str, Array]


@dataclass(frozen=True, eq=False)
class Shown:
    """A captured transition and its syntheses.

    durations: model -> s. panels: for the nearest model, then the farthest, in order of time.
    curves: method -> model -> speed. captured: the captured speed.
    """

    signs: Signs
    hand: str
    durations: dict[str, float]
    panels: list[Panel]
    curves: dict[str, dict[str, Curve]]
    captured: Curve

    @property
    def models(self) -> list[str]:
        """The models whose postures are shown: the nearest to the truth, and the farthest."""
        return list(dict.fromkeys(panel.model for panel in self.panels))


def drawn(base: Database, rows: pd.DataFrame, settings: SynthesisSettings) -> Drawn:
    """Draw a transition of usual length and error; rows: the table `synthesis`."""
    if rows.empty:
        return nothing_to_draw(base, "The corpus has no captured transition.")
    shown = what_is_shown(base, rows, settings)
    return Drawn(draw(shown, base.corpus.unit), data(base, shown), caption(base, shown))


def what_is_shown(base: Database, rows: pd.DataFrame, settings: SynthesisSettings) -> Shown:
    """Return the transition chosen, its postures and its speeds."""
    signs = signs_of(base, shown_pair(base, rows))
    take = signs[0].recording
    key = chosen_transition(rows, base.corpus.unit)
    own = rows[
        (rows["recording"] == key[0]) & (rows["transition"] == key[1]) & (rows["material"] == OWN)
    ]
    durations = {
        model: float(own.loc[own["duration_model"] == model, "duration_s"].iloc[0])
        for model in MODELS
    }
    durations = {m: d for m, d in durations.items() if np.isfinite(d)}
    recorded = take.positions[signs[0].last : signs[1].first + 1]
    true_s = float(own["true_s"].iloc[0])
    by_error = sorted(durations, key=lambda m: abs(durations[m] - true_s))
    hand = busier(signs)
    return Shown(
        signs=signs,
        hand=hand,
        durations=durations,
        panels=[
            _panel(signs, model, durations[model], share * true_s, recorded, settings)
            for model in dict.fromkeys([*by_error[:1], *by_error[-1:]])
            for share in INSTANTS
        ],
        curves={
            method: model_curves(signs, durations, method, hand, settings) for method in METHODS
        },
        captured=speed_curve(signs, recorded, hand, settings, true_s),
    )


def _panel(
    signs: Signs,
    model: str,
    duration_s: float,
    instant_s: float,
    recorded: Array,
    settings: SynthesisSettings,
) -> Panel:
    made = {
        method: make(method, signs, duration_s, settings).motion.positions for method in METHODS
    }
    return Panel(
        model=model,
        instant_s=instant_s,
        captured=at(*track(signs, recorded, CONTEXT_S), instant_s),
        made={m: at(*track(signs, path, CONTEXT_S), instant_s) for m, path in made.items()},
    )


def data(base: Database, shown: Shown) -> pd.DataFrame:
    """Return postures and speeds as the table `skeletons`."""
    unit, joints = base.corpus.unit, shown.signs[0].recording.joints
    rows = []
    for panel in shown.panels:
        instant, name = panel.instant_s, f"{panel.model}, {panel.instant_s:.2f} s"
        rows += joint_rows(joints, panel.captured, name, "captured", instant, unit)
        for method, posture in panel.made.items():
            motion = f"{method}, {shown.durations[panel.model]:.3f} s"
            rows += joint_rows(joints, posture, name, motion, instant, unit)
    for method, curves in shown.curves.items():
        for model, curve in curves.items():
            rows += speed_rows(curve, method, model, shown.hand, unit)
        rows += speed_rows(shown.captured, method, "captured", shown.hand, unit)
    return skeletons_table(base, rows)


def draw(shown: Shown, unit: str) -> Figure:
    """Draw postures above, a row a model; below, speed by each method."""
    rows = len(shown.models)
    figure = plt.figure(figsize=(style.WIDTH_IN, 1.5 * rows + 2.3))
    grid = figure.add_gridspec(rows + 1, 2 * len(INSTANTS), height_ratios=[1.35] * rows + [1.6])
    _draw_postures(figure, grid, shown, unit)
    _draw_speeds(figure, grid, shown, unit)
    return figure


def _draw_postures(figure: Figure, grid: GridSpec, shown: Shown, unit: str) -> None:
    joints = shown.signs[0].recording.joints
    axes: list[Axes] = []
    for i, model in enumerate(shown.models):
        for k, panel in enumerate(p for p in shown.panels if p.model == model):
            ax = figure.add_subplot(grid[i, 2 * k : 2 * k + 2])
            skeletons.plot_posture(
                panel.captured, joints, ax=ax, colour=skeletons.TRUTH, width=3.2, alpha=0.5,
                label="captured", unit=unit,
            )  # fmt: skip
            for method, posture in panel.made.items():
                skeletons.plot_posture(
                    posture, joints, ax=ax, colour=skeletons.METHOD_COLOURS[method],
                    label=method, unit=unit,
                )  # fmt: skip
            bare(ax)
            ax.set_title(f"{panel.instant_s:.2f} s", fontsize=8)
            if k == 0:
                side = "nearest" if i == 0 else "farthest"
                name = model.upper().replace("_", " ")
                ax.set_ylabel(f"{name}\n({side}: {shown.durations[model]:.2f} s)", fontsize=7.5)
            axes.append(ax)
    if axes:
        postures = [q for p in shown.panels for q in (p.captured, *p.made.values())]
        skeletons.frame_on(axes, np.array(postures), joints, unit)
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)


def _draw_speeds(figure: Figure, grid: GridSpec, shown: Shown, unit: str) -> None:
    half = len(INSTANTS)
    before: Axes | None = None
    for j, (method, curves) in enumerate(shown.curves.items()):
        ax = figure.add_subplot(grid[len(shown.models), j * half : (j + 1) * half], sharey=before)
        skeletons.plot_transition_speed(
            {model: curve.drawn for model, curve in curves.items()},
            shown.captured.drawn,
            unit,
            ax=ax,
        )
        ax.set_title(f"{method}", fontsize=8.5)
        if before is None:
            before = ax
        else:
            ax.set_ylabel("")
            figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    if before is not None:
        before.set_ylim(bottom=0)


def caption(base: Database, shown: Shown) -> str:
    """Tell which transition, what is compared, and how it was chosen."""
    first, second = shown.signs
    return (
        f"Transition from {first.gloss} to {second.gloss}, recording {first.recording.name}: "
        f"captured ({shown.captured.duration_s:.2f} s, grey) and synthesised. Above: postures from "
        "in front at one time after "
        "the first sign, for the duration model nearest to the truth and the one farthest from "
        f"it; below: speed of the {shown.hand} wrist, a dot where the second sign begins. Models "
        "learnt without this transition or its recording. Blending is made of the captured "
        f"transition itself here. {space(base)} Chosen: the transition of {SHOWN_S[0]:g} to "
        f"{SHOWN_S[1]:g} s whose position error by interpolation is the median."
    )
