"""Tables and figures of Naert et al. 2017 for one corpus, with their captions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin import tables
from signkin.coarticulation.excerpts import RULES, Excerpt, choose_excerpts, excerpt_points
from signkin.corpus import Corpus
from signkin.figures import distance, hands, refinement, speed, style
from signkin.report.drawn import Drawn
from signkin.statistics import descriptive

FIGURES = ("fig04", "fig05", "fig06", "fig07", "fig08", "fig09", "fig10")
FIGURE_TABLES = {
    "fig04": "excerpt", "fig05": "excerpt", "fig06": "excerpt", "fig07": "distances",
    "fig08": "distances", "fig09": "segmentations", "fig10": "fig10",
}  # fmt: skip


def counted(transitions: pd.DataFrame) -> pd.DataFrame:
    """Return the transitions between manual tags, whole body, overlapping signs left out."""
    whole = (transitions["segmentation"] == "manual") & (transitions["hand"] == "both")
    return transitions[whole & (transitions["status"] != "overlap")].reset_index(drop=True)


def left_out(transitions: pd.DataFrame) -> pd.DataFrame:
    """Return the transitions between manual tags that overlap or have zero length."""
    whole = (transitions["segmentation"] == "manual") & (transitions["hand"] == "both")
    return transitions[whole & (transitions["status"] != "ok")].reset_index(drop=True)


def with_flags(
    transitions: pd.DataFrame, settings: Mapping[str, Any]
) -> tuple[pd.DataFrame, descriptive.Diamond | None]:
    """Return the counted transitions as the table `distances`, and the diamond of Fig. 8."""
    rows = counted(transitions)
    rows["outlier"] = descriptive.outliers(
        rows["duration_s"].to_numpy(dtype=float), settings["outlier_iqr"]
    )
    rows["in_diamond"] = False
    there = rows["mean_distance"].notna()
    shape = None
    if there.sum() >= 3:
        shape = descriptive.diamond(
            rows.loc[there, "mean_distance"].to_numpy(dtype=float),
            rows.loc[there, "duration_s"].to_numpy(dtype=float),
            settings["diamond_share"],
        )
        rows.loc[there, "in_diamond"] = shape.inside
    return rows[tables.TABLES["distances"].names()], shape


def table2(
    corpus: str, transitions: pd.DataFrame, published: pd.DataFrame, settings: Mapping[str, Any]
) -> pd.DataFrame:
    """Return the table `table2` of a corpus."""
    rows = counted(transitions)
    durations = rows["duration_s"].to_numpy(dtype=float)
    out = descriptive.table2(
        rows, descriptive.outliers(durations, settings["outlier_iqr"]), published
    )
    out.insert(0, "corpus", corpus)
    return out


def diamond_table(
    corpus: str, transitions: pd.DataFrame, settings: Mapping[str, Any]
) -> pd.DataFrame:
    """Return the corners of the diamond as the table `diamond`; no rows without a diamond."""
    names = tables.TABLES["diamond"].names()
    _, shape = with_flags(transitions, settings)
    if shape is None:
        return pd.DataFrame(columns=names)
    rows = [
        (corpus, c, x, y, shape.share, len(shape.inside)) for c, (x, y) in shape.corners.items()
    ]
    return pd.DataFrame(rows, columns=names)


# --- figures ---------------------------------------------------------------------------------


def draw(
    corpus: Corpus,
    transitions: pd.DataFrame,
    boundaries: pd.DataFrame,
    sign_types: pd.DataFrame,
    minima: pd.DataFrame,
    frames: Sequence[Path],
    published: pd.DataFrame,
    settings: Mapping[str, Any],
) -> dict[str, Drawn]:
    """Draw Fig. 4 to 10 of a corpus.

    frames: the files of its kinematics. settings: config.yaml (kinematics, transitions).
    """
    out: dict[str, Drawn] = {}
    excerpts = choose_excerpts(boundaries, sign_types, corpus.settings.get("examples", {}))
    for name, excerpt in excerpts.items():
        out[name] = _speed_figure(corpus, name, excerpt, boundaries, minima, frames, settings)
    points, shape = with_flags(transitions, settings["transitions"])
    out["fig07"] = _distance_figure(corpus, points, settings)
    out["fig08"] = _diamond_figure(corpus, points, shape, settings)
    out["fig09"] = _segmentation_figure(corpus, transitions)
    out["fig10"] = _hands_figure(corpus, counted(transitions), published)
    return out


def _speed_figure(
    corpus: Corpus,
    name: str,
    excerpt: Excerpt,
    boundaries: pd.DataFrame,
    minima: pd.DataFrame,
    frames: Sequence[Path],
    settings: Mapping[str, Any],
) -> Drawn:
    unit = corpus.unit
    column = f"speed_{unit}_per_s"
    kinematics = pd.read_parquet(
        [str(path) for path in frames],
        columns=["recording", "time_s", f"right_{column}", f"left_{column}"],
        filters=[("recording", "==", excerpt.recording)],
    ).rename(columns={f"right_{column}": "right", f"left_{column}": "left"})
    rate = 1.0 / float(np.median(np.diff(kinematics["time_s"])))
    data = excerpt_points(excerpt, kinematics, boundaries, minima, column)
    data.insert(0, "corpus", corpus.name)
    figure, ax = plt.subplots(figsize=(style.WIDTH_IN, 3.3))
    marks = "refined" if name == "fig06" else "minima"
    speed.plot_speed(data, unit, round(rate, 3), ax=ax, marks=marks)
    lowpass = settings["kinematics"]["lowpass"]
    what = "refined tags of each hand" if marks == "refined" else "local minima of each hand"
    caption = (
        f"Speed of the right (blue) and left (red) wrist in {style.SPEED_UNITS[unit]}, recording "
        f"{excerpt.recording}, {excerpt.from_s:.2f}-{excerpt.to_s:.2f} s; manual tags green, "
        f"{what}. Low-pass: {lowpass['method']}, half gain at {lowpass['cutoff_hz']:g} Hz, no "
        f"delay. Excerpt: {RULES[excerpt.rule]}."
    )
    return Drawn(figure, data, caption)


def _counts(points: pd.DataFrame) -> str:
    drawn = int(points["mean_distance"].notna().sum())
    text = f"n = {drawn} transitions between manual tags"
    without = len(points) - drawn
    return text + (f" ({without} more have no distance: gaps in the motion)" if without else "")


def _distance_note(corpus: Corpus) -> str:
    source = corpus.settings["motion"].get("orientations", "none")
    return {
        "recorded": "Geodesic and Euclidean distance, whole body.",
        "limb_frames": "Geodesic distance of limb and palm frames (no recorded orientations) and "
        "Euclidean distance, whole body.",
        "none": "Euclidean distance only: the corpus has no orientations.",
    }[source]


def _distance_figure(corpus: Corpus, points: pd.DataFrame, settings: Mapping[str, Any]) -> Drawn:
    drawn = points[points["mean_distance"].notna()]
    x, y = (drawn[c].to_numpy(dtype=float) for c in ("mean_distance", "duration_s"))
    line = descriptive.trend(x, y)
    figure, ax = plt.subplots(figsize=(4.6, 3.4))
    distance.plot_distances(drawn, None if line is None else (line.slope, line.intercept), ax=ax)
    caption = (
        "Duration of the transitions over the mean of the two normalised distances; "
        f"{_counts(points)}."
    )
    if line is not None:
        caption += f" Least-squares line: {line.slope:.3f} s a unit, Pearson r = {line.r:.2f}."
    fences = settings["transitions"]["outlier_iqr"]
    caption += (
        f" Outliers: {int(drawn['outlier'].sum())}, more than {fences:g} interquartile ranges "
    )
    caption += f"outside the quartiles. {_distance_note(corpus)}"
    return Drawn(figure, points, caption)


def _diamond_figure(
    corpus: Corpus,
    points: pd.DataFrame,
    shape: descriptive.Diamond | None,
    settings: Mapping[str, Any],
) -> Drawn:
    drawn = points[points["mean_distance"].notna()]
    figure, ax = plt.subplots(figsize=(4.6, 3.4))
    distance.plot_diamond(drawn, {} if shape is None else shape.corners, ax=ax)
    share = (
        ""
        if shape is None
        else f" It holds {int(shape.inside.sum())} of {len(drawn)} ({shape.share:.1%})."
    )
    caption = (
        f"The smallest diamond that holds more than {settings['transitions']['diamond_share']:.0%} "
        f"of the transitions; {_counts(points)}.{share} Its sides rise and fall by the ratio of "
        "the two interquartile ranges (the paper prints neither corners nor a rule). Corners in "
        "diamond.csv."
    )
    return Drawn(figure, points, caption)


def segmentation_pairs(transitions: pd.DataFrame, unit: str) -> pd.DataFrame:
    """Return each transition of one hand with manual and refined tags (table `segmentations`)."""
    keys = ["corpus", "recording", "signer", "transition", "hand"]
    values = [f"euclidean_{unit}", "duration_s"]
    sides = []
    for segmentation in ("manual", "refined"):
        rows = transitions[
            (transitions["segmentation"] == segmentation) & (transitions["hand"] != "both")
        ]
        names = {value: f"{segmentation}_{value}" for value in values}
        sides.append(rows[[*keys, *values]].rename(columns=names))
    pairs = sides[0].merge(sides[1], on=keys, validate="one_to_one")
    return pairs[tables.TABLES["segmentations"].names(unit)]


def _segmentation_figure(corpus: Corpus, transitions: pd.DataFrame) -> Drawn:
    unit = corpus.unit
    pairs = segmentation_pairs(transitions, unit)
    whole = pairs.dropna()
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH_IN, 3.3), sharey=True)
    for hand, ax in zip(("left", "right"), axes, strict=True):
        distance.plot_segmentations(whole, hand, unit, ax=ax)
    axes[1].set_ylabel("")
    axes[1].legend(loc="best")
    changed = {
        hand: (g["refined_duration_s"] - g["manual_duration_s"]).abs().median()
        for hand, g in whole.groupby("hand")
    }
    told = ", ".join(
        f"{hand} {changed[hand]:.3f} s" for hand in ("left", "right") if hand in changed
    )
    caption = (
        f"Duration over the mean Euclidean distance of one arm's joints, manual (blue diamonds) "
        f"and refined tags (red disks); {len(whole)} pairs over both hands, overlapping signs "
        f"with their negative durations. Median change of the duration: {told}."
    )
    if unit == "px":
        caption += " Distances in image pixels; the hand's centre is the arm's only point."
    lost = len(pairs) - len(whole)
    if lost:
        caption += f" {lost} pairs have no distance: gaps in the motion."
    return Drawn(figure, pairs, caption)


def _hands_figure(corpus: Corpus, rows: pd.DataFrame, published: pd.DataFrame) -> Drawn:
    groups = descriptive.hand_changes(rows, published)
    groups.insert(0, "corpus", corpus.name)
    typed = rows[rows["type"] != ""]
    changes = typed["type"].map(descriptive.hand_change)
    durations = pd.DataFrame({"change": changes, "duration_s": typed["duration_s"]})
    figure, ax = plt.subplots(figsize=(5.4, 3.3))
    hands.plot_hand_changes(groups, durations, ax=ax)
    sources = typed["type_source"].value_counts().to_dict()
    told = ", ".join(f"{n} {source}" for source, n in sorted(sources.items()))
    caption = (
        f"Mean duration by the number of hands of the signs before and after (type 2 counts as "
        f"two-handed), manual tags, whole body; n = {len(typed)}. Types from: {told} (kinematic: "
        "inferred from motion). Orange: the paper's means, weighted from its Table 2."
    )
    return Drawn(figure, groups, caption)


def draw_quality(
    boundaries: pd.DataFrame, chance: Mapping[str, np.ndarray], window_s: float
) -> Figure:
    """Draw the tags' distances to the minima against chance, a panel a hand."""
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH_IN, 2.9), sharey=True)
    for hand, ax in zip(("left", "right"), axes, strict=True):
        rows = boundaries[boundaries["hand"] == hand]
        distances = rows["distance_s"].fillna(np.inf).to_numpy(dtype=float)
        refinement.plot_chance(distances, chance[hand], window_s, hand, ax=ax)
    axes[0].get_legend().remove()
    axes[1].set_ylabel("")
    return figure


def draw_simulation(errors: pd.DataFrame, surface: pd.DataFrame) -> Figure:
    """Draw the error to truth before and after refinement, and the surface found again."""
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH_IN, 2.9))
    refinement.plot_truth(errors, ax=axes[0])
    refinement.plot_surface_check(surface, ax=axes[1])
    return figure


def spread(names: Sequence[str], most: int) -> list[str]:
    """Return up to `most` names from the first to the last at even steps: not four of one sign."""
    places = np.linspace(0, len(names) - 1, min(most, len(names))).round().astype(int)
    return [names[place] for place in places]


def draw_speeds(frames: Sequence[Path], minima: pd.DataFrame, unit: str, most: int) -> Figure:
    """Draw wrist speeds and minima, a panel a recording, of `most` spread over a corpus."""
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
