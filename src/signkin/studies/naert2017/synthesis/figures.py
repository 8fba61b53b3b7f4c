"""Figures 1, 2, 12 and 13 of Naert et al. 2017, from the signs of a corpus."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import tables
from signkin.coarticulation.duration import DurationModel, SurfaceDuration
from signkin.coarticulation.retrieval import distances
from signkin.coarticulation.synthesis import (
    METHODS,
    Sign,
    Transition,
    blend,
    fitted,
    interpolate,
)
from signkin.errors import SignkinError
from signkin.figures import skeletons, style
from signkin.joints import HANDS
from signkin.kinematics.filters import lowpass
from signkin.report.drawn import Drawn
from signkin.studies.naert2017.synthesis.comparison import (
    CONTEXT_S,
    MODELS,
    OWN,
    Database,
    captured,
    maker,
    usable,
)
from signkin.studies.naert2017.synthesis.utterance import Timing, distance_scale, timing

FIGURES = ("fig01", "fig02", "fig12", "fig13")
WITHOUT_TRUTH = ("fig01", "fig02", "fig13")
SHOWN_S = (0.2, 0.5)  # durations of transitions that Fig. 12 may show
FAR = 0.95  # Fig. 13: farther apart than this share of all pairs
SIDE_S = 0.22  # of each sign shown in Fig. 1 and 2
INSTANTS = (0.25, 0.5, 0.75, 1.0)
Array = NDArray[np.float64]


def draw(
    base: Database, rows: pd.DataFrame | None, settings: Mapping[str, Any], printed: Array
) -> dict[str, Drawn]:
    """Draw Fig. 1, 2, 13, and 12 where there are captured transitions (rows: `synthesis`).

    settings: config.yaml (kinematics, transitions, durations, synthesis). printed: theta of the
    paper.
    """
    if len(base.tokens) < 2:
        names = WITHOUT_TRUTH if rows is None else FIGURES
        return {name: _notice(base, "The corpus has fewer than two signs.") for name in names}
    clock = timing(base, settings["synthesis"]["duration"], settings["durations"], printed)
    shown = _shown(base, rows)
    out = {
        "fig01": _scheme(base, shown, "interpolation", clock, settings),
        "fig02": _scheme(base, shown, "blending", clock, settings),
        "fig13": _composition(base, settings, printed),
    }
    if rows is not None:
        out["fig12"] = _against_truth(base, rows, settings)
    return out


def _notice(base: Database, text: str) -> Drawn:
    """Return a figure that says why there is nothing to draw."""
    figure, ax = plt.subplots(figsize=(style.WIDTH_IN, 1))
    ax.text(0.5, 0.5, text, ha="center", va="center")
    ax.set_axis_off()
    return Drawn(figure, _frame(base, []), text)


# --- which signs -----------------------------------------------------------------------------


def _shown(base: Database, rows: pd.DataFrame | None) -> tuple[int, int]:
    """Return the tokens that Fig. 1, 2 and 12 show."""
    if rows is None or rows.empty:
        return 0, 1
    key = chosen_transition(rows, base.corpus.unit)
    for pair in base.pairs():
        if (base.tokens[pair.first].sign.recording.name, pair.transition) == key:
            return pair.first, pair.second
    return 0, 1


def chosen_transition(rows: pd.DataFrame, unit: str) -> tuple[str, int]:
    """Return recording and number of the transition shown: of usual length and usual error.

    Among the captured transitions of 0.2 to 0.5 s (all, where there is none) that every fitted
    model has a duration for, the one whose position error by interpolation is the median.
    """
    own = rows[(rows["material"] == OWN) & (rows["method"] == "interpolation")]
    models = [m for m in MODELS if own.loc[own["duration_model"] == m, "duration_s"].notna().any()]
    told = own[own["duration_model"].isin(models)].groupby(["recording", "transition"])
    complete = told["duration_s"].apply(lambda s: bool(s.notna().all()))
    error = told[f"error_{unit}"].mean()
    length = told["true_s"].first()
    usual = complete & error.notna() & length.between(*SHOWN_S)
    for candidates in (usual, error.notna(), length.notna()):
        if candidates.any():
            values = error[candidates].fillna(0.0)
            place = (values - values.median()).abs().idxmin()
            return str(place[0]), int(place[1])
    raise SignkinError("no transition", place="Fig. 12", expected="one or more")


def far_pair(base: Database) -> tuple[int, int]:
    """Return two signs that do not follow one another, farther apart than most pairs."""
    count = len(base.tokens)
    everything = base.candidates(range(count))
    cost = distances(everything, everything, distance_scale(base))
    cost[np.arange(count), np.arange(count)] = np.inf
    cost[np.arange(count - 1), np.arange(1, count)] = np.inf
    if count == 2 or not np.isfinite(cost).any():
        return 0, 1
    flat = np.flatnonzero(np.isfinite(cost))
    order = flat[np.argsort(cost.ravel()[flat], kind="stable")]
    pick = order[min(len(order) - 1, int(np.ceil(FAR * len(order))) - 1)]
    return int(pick // count), int(pick % count)


# --- motions ---------------------------------------------------------------------------------


def _make(
    method: str, signs: tuple[Sign, Sign], duration_s: float, settings: Mapping[str, Any]
) -> Transition:
    form = {k: settings["synthesis"][k] for k in ("orientations", "keep_limbs")}
    shown = max(duration_s, 1 / signs[0].recording.rate_hz)
    return (interpolate if method == "interpolation" else blend)(*signs, shown, **form)


def _track(signs: tuple[Sign, Sign], between: Array, context_s: float) -> tuple[Array, Array]:
    """Return times (s from the end of the first sign) and postures through a transition."""
    a, b = signs
    rate = a.recording.rate_hz
    many = round(context_s * rate)
    head = a.recording.positions[max(0, a.last - many) : a.last]
    tail = b.recording.positions[b.first + 1 : b.first + 1 + many]
    track = np.concatenate([head, between, tail])
    return (np.arange(len(track)) - len(head)) / rate, track


def _speed(
    signs: tuple[Sign, Sign], between: Array, hand: str, settings: Mapping[str, Any]
) -> tuple[Array, Array]:
    take = signs[0].recording
    times, track = _track(signs, between, 2 * CONTEXT_S)
    path = lowpass(track[:, take.index(f"{hand}_wrist")], take.rate_hz,
                   **settings["kinematics"]["lowpass"])  # fmt: skip
    speed = np.linalg.norm(np.gradient(path, 1 / take.rate_hz, axis=0), axis=1)
    duration = (len(between) - 1) / take.rate_hz
    inside = (times >= -SIDE_S) & (times <= duration + SIDE_S)
    return times[inside], speed[inside]


def _busier(signs: tuple[Sign, Sign]) -> str:
    """Return the hand that has the longer way between two signs."""
    a, b = (s.recording.positions[f] for s, f in zip(signs, (signs[0].last, signs[1].first),
                                                   strict=True))  # fmt: skip
    ways = {
        hand: float(np.linalg.norm(a[i] - b[i]))
        for hand in HANDS
        for i in [signs[0].recording.index(f"{hand}_wrist")]
    }
    known = {hand: way for hand, way in ways.items() if np.isfinite(way)}
    return max(known, key=lambda hand: known[hand]) if known else HANDS[0]


def _at(times: Array, track: Array, instant: float) -> Array:
    return np.asarray(track[int(np.argmin(np.abs(times - instant)))])


# --- Fig. 1 and 2 ----------------------------------------------------------------------------


def _scheme(
    base: Database,
    shown: tuple[int, int],
    method: str,
    clock: Timing,
    settings: Mapping[str, Any],
) -> Drawn:
    signs = _signs(base, shown)
    take, unit = signs[0].recording, base.corpus.unit
    wanted, _ = clock.ask(base.features([shown[0]], [shown[1]]))
    made = _make(method, signs, wanted, settings)
    duration = made.steps / take.rate_hz
    times, track = _track(signs, made.motion.positions, SIDE_S)
    instants = [-0.9 * SIDE_S, 0.0, *(duration * np.array([0.2, 0.4, 0.6, 0.8])), duration,
                duration + 0.9 * SIDE_S]  # fmt: skip
    postures = np.array([_at(times, track, t) for t in instants])
    colours = [skeletons.FIRST] * 2 + [skeletons.BETWEEN] * 4 + [skeletons.SECOND] * 2
    figure = plt.figure(figsize=(style.WIDTH_IN, 2.5 if method == "interpolation" else 3.1))
    grid = figure.add_gridspec(
        2, len(instants), height_ratios=[1.5, 0.55 if method == "interpolation" else 1.1]
    )
    axes = [figure.add_subplot(grid[0, k]) for k in range(len(instants))]
    rows = []
    for ax, instant, posture, colour in zip(axes, instants, postures, colours, strict=True):
        skeletons.plot_posture(posture, take.joints, ax=ax, colour=colour, unit=unit)
        ax.set_axis_off()
        ax.set_title(f"{instant:.2f} s", fontsize=7.5, color=colour)
        rows += _joint_rows(take.joints, posture, "postures", made.method, instant, unit)
    skeletons.frame_on(axes, postures, take.joints, unit)
    below = figure.add_subplot(grid[1, :])
    steps = {"start": -SIDE_S, "second_start": duration, "end": duration + SIDE_S,
             "rate_hz": take.rate_hz}  # fmt: skip
    labels = {"first": signs[0].gloss, "second": signs[1].gloss}
    skeletons.plot_scheme(steps, labels, method, ax=below)
    for instant, colour in zip(instants, colours, strict=True):
        below.plot([instant], [-0.08], marker="^", ms=4, color=colour, clip_on=False, lw=0)
    how = (
        f"between the last posture of {signs[0].gloss} (blue) and the first of {signs[1].gloss} "
        "(green); neither retraction nor preparation is used"
        if method == "interpolation"
        else f"of the n frames after {signs[0].gloss} (retraction R₁, weight falling) with the n "
        f"frames before {signs[1].gloss} (preparation P₂, weight rising)"
    )
    caption = (
        f"Transition by {method} {how}. Recording {_takes(signs)}; {duration:.2f} s by "
        f"{clock.told}. {_space(base)} Postures from in front at the triangles' times."
    )
    if made.idle:
        caption += f" {made.idle} frames were not captured: idle posture."
    return Drawn(figure, _frame(base, rows), caption)


def _signs(base: Database, shown: tuple[int, int]) -> tuple[Sign, Sign]:
    first, second = (base.tokens[t].sign for t in shown)
    return first, fitted(second, first.recording)[0]


def _takes(signs: tuple[Sign, Sign]) -> str:
    return " and ".join(dict.fromkeys(s.recording.name for s in signs))


def _space(base: Database) -> str:
    take = next(iter(base.recordings.values()))
    if take.orientation_source == "recorded":
        return "Orientations of joints in their parents' frames, by slerp; limbs keep their length."
    if take.unit == "px":
        return "Image positions in pixels."
    return "Positions (no recorded orientations); limbs are given their length back."


# --- Fig. 12 ---------------------------------------------------------------------------------


def _against_truth(base: Database, rows: pd.DataFrame, settings: Mapping[str, Any]) -> Drawn:
    if rows.empty:
        return _notice(base, "The corpus has no captured transition.")
    shown = _shown(base, rows)
    signs, unit = _signs(base, shown), base.corpus.unit
    take = signs[0].recording
    key = chosen_transition(rows, unit)
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
    models = list(dict.fromkeys([by_error[0], by_error[-1]])) if by_error else []
    figure = plt.figure(figsize=(style.WIDTH_IN, 1.5 * len(models) + 2.3))
    grid = figure.add_gridspec(
        len(models) + 1, 2 * len(INSTANTS), height_ratios=[1.35] * len(models) + [1.6]
    )
    hand = _busier(signs)
    panels, shown_postures, out = [], [], []
    true_times, true_track = _track(signs, recorded, CONTEXT_S)
    for i, model in enumerate(models):
        for k, share in enumerate(INSTANTS):
            ax = figure.add_subplot(grid[i, 2 * k : 2 * k + 2])
            instant = share * true_s
            truth = _at(true_times, true_track, instant)
            skeletons.plot_posture(
                truth, take.joints, ax=ax, colour=skeletons.TRUTH, width=3.2, alpha=0.5,
                label="captured", unit=unit,
            )  # fmt: skip
            panel = f"{model}, {instant:.2f} s"
            out += _joint_rows(take.joints, truth, panel, "captured", instant, unit)
            shown_postures.append(truth)
            for method in METHODS:
                made = _make(method, signs, durations[model], settings)
                posture = _at(*_track(signs, made.motion.positions, CONTEXT_S), instant)
                skeletons.plot_posture(
                    posture, take.joints, ax=ax, colour=skeletons.METHOD_COLOURS[method],
                    label=method, unit=unit,
                )  # fmt: skip
                name = f"{method}, {durations[model]:.3f} s"
                out += _joint_rows(take.joints, posture, panel, name, instant, unit)
                shown_postures.append(posture)
            _bare(ax)
            ax.set_title(f"{instant:.2f} s", fontsize=8)
            if k == 0:
                side = "nearest" if i == 0 else "farthest"
                ax.set_ylabel(
                    f"{model.upper().replace('_', ' ')}\n({side}: {durations[model]:.2f} s)",
                    fontsize=7.5,
                )
            panels.append(ax)
    if panels:
        skeletons.frame_on(panels, np.array(shown_postures), take.joints, unit)
        handles, names = panels[0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside upper center", ncols=3)
    half = len(INSTANTS)
    before = None
    for j, method in enumerate(METHODS):
        ax = figure.add_subplot(grid[len(models), j * half : (j + 1) * half], sharey=before)
        curves = {}
        for model, wanted in durations.items():
            made = _make(method, signs, wanted, settings)
            times, speed = _speed(signs, made.motion.positions, hand, settings)
            curves[model] = (times, speed, made.steps / take.rate_hz)
            out += _speed_rows(times, speed, method, model, hand, unit)
        times, speed = _speed(signs, recorded, hand, settings)
        out += _speed_rows(times, speed, method, "captured", hand, unit)
        skeletons.plot_transition_speed(curves, (times, speed, true_s), unit, ax=ax)
        ax.set_title(f"{method}", fontsize=8.5)
        if before is None:
            before = ax
        else:
            ax.set_ylabel("")
            figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    if before is not None:
        before.set_ylim(bottom=0)
    caption = (
        f"Transition from {signs[0].gloss} to {signs[1].gloss}, recording {take.name}: captured "
        f"({true_s:.2f} s, grey) and synthesised. Above: postures from in front at one time after "
        "the first sign, for the duration model nearest to the truth and the one farthest from "
        f"it; below: speed of the {hand} wrist, a dot where the second sign begins. Models learnt "
        "without this transition or its recording. Blending is made of the captured transition "
        f"itself here. {_space(base)} Chosen: the transition of {SHOWN_S[0]:g} to {SHOWN_S[1]:g} s "
        "whose position error by interpolation is the median."
    )
    return Drawn(figure, _frame(base, out), caption)


# --- Fig. 13 ---------------------------------------------------------------------------------


def model_durations(
    base: Database, pair: tuple[int, int], settings: Mapping[str, Any], printed: Array
) -> tuple[dict[str, float], str]:
    """Return what each model says about two signs, and what the models have learnt from."""
    asked = base.features([pair[0]], [pair[1]])
    pairs = base.pairs()
    known, told = None, "no captured transitions: LINEAR is left out, SURFACE is the printed one"
    if pairs:
        known = captured(base, pairs)
        told = f"models learnt from the {len(pairs)} captured transitions of the corpus"
    source = asked if known is None else known
    geodesic = bool(np.isfinite(source.geodesic).any())
    out = {}
    for name in MODELS:
        make, model = maker(name, settings["durations"], geodesic), None
        try:
            if known is not None:
                model = known[usable(name, known)].teach(make())
            elif name.startswith("simple"):
                model = make()
            elif name == "surface" and base.corpus.unit == "m":
                model = _printed_surface(printed)
        except SignkinError:
            continue
        if model is not None and usable(name, asked).all():
            out[name] = max(float(asked.ask(model)[0]), 0.0)
    return out, told


def _printed_surface(printed: Array) -> DurationModel:
    return SurfaceDuration(theta=printed)


def _composition(base: Database, settings: Mapping[str, Any], printed: Array) -> Drawn:
    pair = far_pair(base)
    signs, unit = _signs(base, pair), base.corpus.unit
    take = signs[0].recording
    durations, told = model_durations(base, pair, settings, printed)
    if not durations:
        durations = {"simple_bounded": float(settings["durations"]["highest_s"])}
    hand = _busier(signs)
    ends = [take.positions[signs[0].last], signs[1].recording.positions[signs[1].first]]
    figure = plt.figure(figsize=(style.WIDTH_IN, 4.7))
    above, below = figure.subfigures(2, 1, height_ratios=[1.2, 1])
    left, key, right = above.subplots(1, 3, width_ratios=[1.0, 0.75, 1.25])
    panels = below.subplots(1, 2, sharey=True)
    rows = []
    for posture, colour, name in zip(
        ends, (skeletons.FIRST, skeletons.SECOND),
        (f"last posture of\n{signs[0].gloss}", f"first posture of\n{signs[1].gloss}"), strict=True,
    ):  # fmt: skip
        skeletons.plot_posture(
            posture, take.joints, ax=left, colour=colour, width=1.6, label=name, unit=unit
        )
        rows += _joint_rows(take.joints, posture, "postures", name.replace("\n", " "), 0.0, unit)
    shown = "surface" if "surface" in durations else next(reversed(durations))
    wrists = [take.index(f"{h}_wrist") for h in HANDS]
    paths = []
    for method in METHODS:
        path = _make(method, signs, durations[shown], settings).motion.positions[:, wrists]
        paths.append(path)
        for w in range(2):
            left.plot(
                -path[:, w, 0], path[:, w, 2], color=skeletons.METHOD_COLOURS[method], lw=1.1,
                ls=":" if method == "interpolation" else "-",
                label=f"wrists by\n{method}" if w == 0 else None,
            )  # fmt: skip
    _bare(left)
    around = np.concatenate([np.array(ends).reshape(-1, 3), *(p.reshape(-1, 3) for p in paths)])
    skeletons.frame_on([left], np.array(ends), take.joints, unit)
    x, z = -around[:, 0], around[:, 2]
    left.set_xlim(min(left.get_xlim()[0], np.nanmin(x)), max(left.get_xlim()[1], np.nanmax(x)))
    left.set_ylim(min(left.get_ylim()[0], np.nanmin(z)), left.get_ylim()[1])
    key.set_axis_off()
    key.legend(*left.get_legend_handles_labels(), loc="center", borderaxespad=0)
    low, high = (settings["durations"][key] for key in ("lowest_s", "highest_s"))
    skeletons.plot_durations(durations, (low, high), ax=right)
    for method, ax in zip(METHODS, panels, strict=True):
        curves = {}
        for model, wanted in durations.items():
            made = _make(method, signs, wanted, settings)
            times, speed = _speed(signs, made.motion.positions, hand, settings)
            curves[model] = (times, speed, made.steps / take.rate_hz)
            rows += _speed_rows(times, speed, method, model, hand, unit)
        skeletons.plot_transition_speed(curves, None, unit, ax=ax)
        ax.set_title(method, fontsize=8.5)
    panels[1].set_ylabel("")
    panels[0].set_ylim(bottom=0)
    handles, names = panels[0].get_legend_handles_labels()
    below.legend(
        handles, [name.split(",")[0] for name in names], loc="outside lower center", ncols=4
    )
    features = base.features([pair[0]], [pair[1]])
    far = f"{float(features.euclidean[0]) * base.euclidean_unit:.3g} {unit}"
    if np.isfinite(features.geodesic[0]):
        far += f" and {float(features.geodesic[0]):.3f} rad"
    why = (
        f"farther apart than {FAR:.0%} of all pairs that do not follow one another"
        if len(base.tokens) > 2
        else "the corpus's two signs, of two takes"
    )
    caption = (
        f"Composition of {signs[0].gloss} and {signs[1].gloss} ({_takes(signs)}), {far} apart "
        f"(mean over joints): {why}. Duration by each model (dotted: the bounds of SIMPLE BOUNDED; "
        f"{told}); below: speed of the {hand} wrist by both methods, a dot where the second sign "
        f"begins. Wrist paths: duration by {shown.upper()}. There is no captured motion to compare "
        "with."
    )
    return Drawn(figure, _frame(base, rows), caption)


def _bare(ax: Any) -> None:
    ax.set_xticks([])
    ax.set_yticks([])
    for side in ("left", "bottom"):
        ax.spines[side].set_visible(False)


# --- the numbers drawn -----------------------------------------------------------------------


def _joint_rows(
    joints: tuple[str, ...], posture: Array, panel: str, motion: str, time_s: float, unit: str
) -> list[dict[str, Any]]:
    return [
        {"panel": panel, "motion": motion, "kind": "joint", "joint": joint, "time_s": time_s,
         **{f"{axis}_{unit}": value for axis, value in zip("xyz", at, strict=True)}}
        for joint, at in zip(joints, posture, strict=True)
    ]  # fmt: skip


def _speed_rows(
    times: Array, speed: Array, panel: str, motion: str, hand: str, unit: str
) -> list[dict[str, Any]]:
    return [
        {"panel": panel, "motion": motion, "kind": "speed", "joint": hand, "time_s": time,
         f"speed_{unit}_per_s": value}
        for time, value in zip(times, speed, strict=True)
    ]  # fmt: skip


def _frame(base: Database, rows: list[dict[str, Any]]) -> pd.DataFrame:
    frame = pd.DataFrame(rows)
    frame["corpus"] = base.corpus.name
    return frame.reindex(columns=tables.TABLES["skeletons"].names(base.corpus.unit))
