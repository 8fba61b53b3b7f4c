"""The figure of both papers' cuts on one wrist: an excerpt, and hit rates against chance."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from signkin import tables
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.figures import binning as drawing
from signkin.figures.one_wrist import TAG_HEIGHTS, plot_excerpt
from signkin.figures.style import WIDTH_IN
from signkin.joints import HANDS
from signkin.report.drawn import Drawn
from signkin.settings.sections import Continuous
from signkin.studies.one_wrist.analysis import Events

EXCERPT_S = 6.0


@dataclass(frozen=True)
class Excerpt:
    """What is drawn of one recording.

    window: from, to in s. kinds: kinds of events that the corpus has, drawn or not.
    """

    recording: str
    window: tuple[float, float]
    kinds: tuple[str, ...]


def drawn(
    corpus: Corpus, compared: pd.DataFrame, rates: pd.DataFrame, frames: pd.DataFrame,
    events: Mapping[str, Events], continuous: Continuous, window_s: float,
) -> Drawn:  # fmt: skip
    """Draw both wrists of one recording, and hit rates of all.

    compared, rates: from `one_wrist`. frames: kinematics of the recording that is drawn.
    continuous, window_s: binning.continuous, binning.hit_window_s.
    """
    last = float(frames["time_s"].max())
    first = max(0.0, min(last / 3, last - EXCERPT_S))
    recording = str(frames["recording"].iloc[0])
    excerpt = Excerpt(recording, (first, min(first + EXCERPT_S, last)), tuple(events))
    data = pd.concat([rates, excerpt_points(corpus, frames, events, excerpt)], ignore_index=True)
    told = caption(compared, recording, continuous, window_s)
    return Drawn(draw(data, excerpt, corpus.unit), data, told)


def excerpt_points(
    corpus: Corpus, frames: pd.DataFrame, events: Mapping[str, Events], excerpt: Excerpt
) -> pd.DataFrame:
    """Return the speed of both wrists in a window and the events on it: table `endres_figure`.

    Panels `right wrist` and `left wrist`; boundaries have no height (0), minima lie on the speed,
    tags above it.
    """
    here = frames[frames["time_s"].between(*excerpt.window)]
    time = here["time_s"]
    rows: list[dict[str, Any]] = []
    for hand in HANDS:
        speed = here[f"{hand}_speed_{corpus.unit}_per_s"]
        if speed.isna().all():  # a hand that was not recorded
            continue
        top = float(speed.max())
        series: dict[str, tuple[Any, Any]] = {"speed": (time, speed)}
        for kind, known in events.items():
            times = known.of(excerpt.recording, hand)
            times = times[(times >= excerpt.window[0]) & (times <= excerpt.window[1])]
            heights = np.full(len(times), top * TAG_HEIGHTS.get(kind, 0.0))
            if kind == "minima":
                heights = np.interp(times, time, speed)
            series[kind] = (times, heights)
        rows += [
            {"panel": f"{hand} wrist", "series": name, "x": x, "y": y, "label": ""}
            for name, (across, up) in series.items()
            for x, y in zip(across, up, strict=True)
        ]
    frame = pd.DataFrame(rows, columns=tables.TABLES["endres_figure"].names()[1:])
    frame.insert(0, "corpus", corpus.name)
    return frame.astype({"x_error": float, "y_error": float})


def draw(points: pd.DataFrame, excerpt: Excerpt, unit: str) -> Figure:
    """Draw an excerpt of both wrists with all events, and hit rates against chance."""
    excerpts = {f"{hand} wrist": hand for hand in HANDS}
    shown = {p: hand for p, hand in excerpts.items() if (points["panel"] == p).any()}
    panels = [name for name in dict.fromkeys(points["panel"]) if name not in excerpts]
    columns = max(-(-len(panels) // len(HANDS)), 1)  # one hand may have an odd number of them
    figure = plt.figure(figsize=(WIDTH_IN * 1.2, 3.6 + 2.5 * len(HANDS)))
    grid = figure.add_gridspec(4, columns, height_ratios=[1, 1, 1.55, 1.55])
    for i, (panel, hand) in enumerate(shown.items()):
        ax = figure.add_subplot(grid[i, :])
        mine = points[points["panel"] == panel]
        plot_excerpt(mine, hand, unit, excerpt.window, ax=ax, legend=() if i else excerpt.kinds)
        ax.set_xlabel("time in the recording (s)" if i else "")
    named: dict[str, Any] = {}
    for i, panel in enumerate(panels):
        ax = figure.add_subplot(grid[2 + i // columns, i % columns])
        part = points[points["panel"] == panel]
        drawing.plot_hit_rates(part, ax=ax, legend=False, right=6.0, by="series")
        ax.set_title(panel, loc="left")
        if i % columns:
            ax.set_ylabel("")
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            named.setdefault(label.partition(" → ")[0], handle)  # titles tell what it is held to
    # One legend for all panels: in them it would lie on the lines.
    figure.legend(named.values(), named.keys(), loc="outside lower center", ncols=3)
    return figure


def example_frames(
    paths: Iterable[str | Path], about: pd.DataFrame, posteriors: pd.DataFrame
) -> pd.DataFrame:
    """Return the kinematics of the recording to be drawn, of the files of all shards.

    That is the longest recording that was binned and has kinematics. about: table `recordings`.
    posteriors: table `wrist_posteriors`.
    """
    # All shards' kinematics at once are more than memory should hold.
    place = {
        name: path
        for path in paths
        for name in pd.read_parquet(path, columns=["recording"])["recording"].unique()
    }
    usable = set(posteriors["recording"]) & set(place)
    there = about[about["recording"].isin(usable)]
    if there.empty:
        raise SignkinError(
            "no recording has both a wrist in bins and a speed",
            place="one wrist",
            expected="one or more; wrists_left_out.csv and excluded.csv tell why not",
        )
    longest = str(there.loc[there["duration_s"].idxmax(), "recording"])
    return pd.read_parquet(place[longest], filters=[("recording", "==", longest)])


def caption(frame: pd.DataFrame, recording: str, continuous: Continuous, window_s: float) -> str:
    """Return what the figure says below it. frame: table `one_wrist`."""
    told = "; ".join(
        f"{row.hand}, {row.found} → {row.truth}: {row.hit_rate:.2f} "
        f"(chance {row.chance_low:.2f} to {row.chance_high:.2f})"
        for row in frame.itertuples()
        if pd.notna(row.hit_rate)
    )
    return (
        f"Top: {EXCERPT_S:g} s of recording {recording}. Below: share of tags or minima that are "
        f"hit within ±{window_s:g} s, one to one, against events that hit nothing; "
        f"binning with order {continuous.order}, bins of {continuous.bin_s:g} s or a frame, "
        f"segments up to {continuous.longest_segment_s:g} s. Dashed: as many Poisson events (grey: "
        f"95 %). {told}."
    )
