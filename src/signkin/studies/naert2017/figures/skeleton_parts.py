"""What Fig. 1, 2, 12 and 13 are made of: postures and speeds through a transition, and their rows.

Postures are (J, 3); times run from the last posture of the first sign, in s.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from numpy.typing import NDArray

from signkin import tables
from signkin.coarticulation.synthesis import Sign, Transition, fitted
from signkin.joints import HANDS, hands_of
from signkin.kinematics.filters import lowpass
from signkin.report.drawn import Drawn
from signkin.studies.naert2017.figures.notice import notice
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.database import Database
from signkin.studies.naert2017.synthesis.joining import joined
from signkin.studies.naert2017.synthesis.measures import CONTEXT_S

SIDE_S = 0.22  # of each sign shown beside a transition
Array = NDArray[np.float64]
Signs = tuple[Sign, Sign]


@dataclass(frozen=True, eq=False)
class Curve:
    """Speed of a wrist through a transition, and how long the transition lasts."""

    times_s: Array
    speed: Array
    duration_s: float

    @property
    def drawn(self) -> tuple[Array, Array, float]:
        """As `figures.skeletons` takes it."""
        return self.times_s, self.speed, self.duration_s


# --- motions ---------------------------------------------------------------------------------


def signs_of(base: Database, shown: tuple[int, int]) -> Signs:
    """Return two signs of a database, the second fitted to the first's skeleton and rate."""
    first, second = (base.tokens[t].sign for t in shown)
    return first, fitted(second, first.recording)[0]


def make(method: str, signs: Signs, duration_s: float, settings: SynthesisSettings) -> Transition:
    """Return the transition between two signs, of one frame step at least."""
    shown = max(duration_s, 1 / signs[0].recording.rate_hz)
    return joined(signs, shown, method, settings.synthesis)


def track(signs: Signs, between: Array, context_s: float) -> tuple[Array, Array]:
    """Return times (s from the end of the first sign) and postures through a transition."""
    a, b = signs
    rate = a.recording.rate_hz
    many = round(context_s * rate)
    head = a.recording.positions[max(0, a.last - many) : a.last]
    tail = b.recording.positions[b.first + 1 : b.first + 1 + many]
    path = np.concatenate([head, between, tail])
    return (np.arange(len(path)) - len(head)) / rate, path


def at(times: Array, path: Array, instant_s: float) -> Array:
    """Return the posture nearest to an instant."""
    return np.asarray(path[int(np.argmin(np.abs(times - instant_s)))])


def speed_curve(
    signs: Signs,
    between: Array,
    hand: str,
    settings: SynthesisSettings,
    duration_s: float | None = None,
) -> Curve:
    """Return the low-passed speed of a wrist through a transition, with a part of both signs.

    between: postures of the transition, (n + 1, J, 3). duration_s: where its mark stands; None:
    n frame steps.
    """
    take = signs[0].recording
    times, path = track(signs, between, 2 * CONTEXT_S)
    wrist = lowpass(path[:, take.index(f"{hand}_wrist")], take.rate_hz,
                    **dict(settings.kinematics.lowpass))  # fmt: skip
    speed = np.linalg.norm(np.gradient(wrist, 1 / take.rate_hz, axis=0), axis=1)
    length = (len(between) - 1) / take.rate_hz
    inside = (times >= -SIDE_S) & (times <= length + SIDE_S)
    return Curve(times[inside], speed[inside], length if duration_s is None else duration_s)


def model_curves(
    signs: Signs,
    durations: Mapping[str, float],
    method: str,
    hand: str,
    settings: SynthesisSettings,
) -> dict[str, Curve]:
    """Return the speed by each duration model (model -> s), all by one method."""
    return {
        model: speed_curve(
            signs, make(method, signs, wanted, settings).motion.positions, hand, settings
        )
        for model, wanted in durations.items()
    }


def busier(signs: Signs) -> str:
    """Return the hand that has the longer way between two signs."""
    a, b = (s.recording.positions[f] for s, f in zip(signs, (signs[0].last, signs[1].first),
                                                   strict=True))  # fmt: skip
    ways = {
        hand: float(np.linalg.norm(a[i] - b[i]))
        for hand in hands_of(signs[0].recording.joints)
        for i in [signs[0].recording.index(f"{hand}_wrist")]
    }
    known = {hand: way for hand, way in ways.items() if np.isfinite(way)}
    return max(known, key=lambda hand: known[hand]) if known else HANDS[0]


# --- words -----------------------------------------------------------------------------------


def takes_of(signs: Signs) -> str:
    """Tell the recordings of two signs."""
    return " and ".join(dict.fromkeys(s.recording.name for s in signs))


def space(base: Database) -> str:
    """Tell in which space postures are joined."""
    take = next(iter(base.recordings.values()))
    if take.orientation_source == "recorded":
        return "Orientations of joints in their parents' frames, by slerp; limbs keep their length."
    if take.unit == "px":
        return "Image positions in pixels."
    return "Positions (no recorded orientations); limbs are given their length back."


# --- the numbers drawn -----------------------------------------------------------------------


def joint_rows(
    joints: Sequence[str], posture: Array, panel: str, motion: str, time_s: float, unit: str
) -> list[dict[str, Any]]:
    """Return the rows of a posture in the table `skeletons`."""
    return [
        {"panel": panel, "motion": motion, "kind": "joint", "joint": joint, "time_s": time_s,
         **{f"{axis}_{unit}": value for axis, value in zip("xyz", place, strict=True)}}
        for joint, place in zip(joints, posture, strict=True)
    ]  # fmt: skip


def speed_rows(curve: Curve, panel: str, motion: str, hand: str, unit: str) -> list[dict[str, Any]]:
    """Return the rows of a speed curve in the table `skeletons`."""
    return [
        {"panel": panel, "motion": motion, "kind": "speed", "joint": hand, "time_s": time,
         f"speed_{unit}_per_s": value}
        for time, value in zip(curve.times_s, curve.speed, strict=True)
    ]  # fmt: skip


def skeletons_table(base: Database, rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return rows as the table `skeletons`."""
    frame = pd.DataFrame(rows)
    frame["corpus"] = base.corpus.name
    return frame.reindex(columns=tables.TABLES["skeletons"].names(base.corpus.unit))


def nothing_to_draw(base: Database, why: str) -> Drawn:
    """Return a figure that says why there is nothing to draw."""
    return Drawn(notice(why), skeletons_table(base, []), why)


def bare(ax: Axes) -> None:
    """Take ticks and lines off the Axes of a posture."""
    ax.set_xticks([])
    ax.set_yticks([])
    for side in ("left", "bottom"):
        ax.spines[side].set_visible(False)
