"""Two papers, one wrist: binning of continuous recordings against speed minima and tags.

The wrists of recordings that hold many signs are binned as long series, with a
longest segment; the boundaries are held against the speed minima of the same
hand, the manual tags and the tags refined to minima (Naert et al. 2017, 4.1, 4.2).
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from signkin import tables
from signkin.annotation import Interval
from signkin.binning import Posterior, fit_many
from signkin.binning.hit_rate import HitRate, chance_line, group_rates, hit_rate
from signkin.binning.posterior import CLEARANCE_BINS
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.figures import binning as drawing
from signkin.figures.one_wrist import plot_excerpt
from signkin.figures.style import WIDTH_IN
from signkin.io.eaf import NewTier, elan_copy
from signkin.joints import HANDS
from signkin.kinematics.filters import lowpass
from signkin.kinematics.gaps import fill_gaps
from signkin.recording import Recording
from signkin.seeds import stream
from signkin.stages.ingest import lead, tags_of
from signkin.studies.endres2013.posteriors import boundary_times, explained_variance, prior_of
from signkin.studies.endres2013.single_signs import in_bins

Floats = NDArray[np.float64]

DRAWS = 400  # sets of Poisson events
EXCERPT_S = 6.0
FOUND = {
    ("boundaries", "manual tags"): "boundaries (binning) → manual tags",
    ("minima", "manual tags"): "speed minima → manual tags",
    ("boundaries", "refined tags"): "boundaries (binning) → refined tags",
    ("boundaries", "minima"): "boundaries (binning) → speed minima",
}


@dataclass
class LongSeries:
    """Rows of the tables wrist_posteriors, wrist_boundaries and binning_left_out."""

    posteriors: list[dict[str, Any]] = field(default_factory=list)
    boundaries: list[dict[str, Any]] = field(default_factory=list)
    left_out: list[dict[str, Any]] = field(default_factory=list)

    def table(self, name: str, unit: str) -> pd.DataFrame:
        """Return one of the tables."""
        rows = {
            "wrist_posteriors": self.posteriors,
            "wrist_boundaries": self.boundaries,
            "binning_left_out": self.left_out,
        }[name]
        return pd.DataFrame(rows, columns=tables.TABLES[name].names(unit))


def long_series(
    corpus: Corpus, recordings: Iterable[Recording], settings: Mapping[str, Any], workers: int
) -> LongSeries:
    """Bin both wrists of each recording. settings: the sections `kinematics` and `binning`."""
    out = LongSeries()
    own = settings["binning"]["continuous"]
    order = int(own["order"])
    jobs: list[tuple[str, str, Floats, float]] = []
    for recording in recordings:
        for hand in HANDS:
            start = {**lead(corpus, recording.name), "dataset": f"{hand} wrist"}
            try:
                jobs.append((recording.name, hand, *_wrist_in_bins(recording, hand, settings)))
            except SignkinError as error:
                out.left_out.append({**start, "reason": str(error)})
    for longest, some in _by_longest(jobs, own["longest_segment_s"]).items():
        fits = fit_many(
            [x for _, _, x, _ in some],
            [order],
            [prior_of(settings["binning"]["prior"], corpus.noise_sd, x) for _, _, x, _ in some],
            [bin_s for _, _, _, bin_s in some],
            workers=workers,
            names=[f"recording {name}, {hand} wrist" for name, hand, _, _ in some],
            max_segment_bins=longest,
        )
        for (name, hand, x, bin_s), posterior in zip(some, fits, strict=True):
            _take(out, corpus, name, hand, x, bin_s, posterior, order)
    key = {entry.recording: i for i, entry in enumerate(corpus.entries)}
    for rows in (out.posteriors, out.boundaries):
        rows.sort(key=lambda row: (key[row["recording"]], row["hand"] != HANDS[0]))
    return out


def _wrist_in_bins(
    recording: Recording, hand: str, settings: Mapping[str, Any]
) -> tuple[Floats, float]:
    where = f"recording {recording.name}"
    rate = recording.rate_hz
    path, _ = fill_gaps(
        recording.track(f"{hand}_wrist"), rate, settings["kinematics"]["longest_gap_s"]
    )
    gaps = int(np.isnan(path).any(axis=1).sum())
    if gaps:
        raise SignkinError(
            f"{gaps} frames without a position",
            file=where,
            place=f"{hand}_wrist",
            expected="a path without long gaps (kinematics.longest_gap_s)",
        )
    moving = path.std(axis=0) > 0  # the third coordinate of a 2-D corpus is 0 throughout
    if not moving.any():
        raise SignkinError(
            "the wrist does not move", file=where, place=f"{hand}_wrist", expected="a movement"
        )
    try:
        smooth = lowpass(path[:, moving], rate, **settings["binning"]["lowpass"])
    except SignkinError as error:
        raise error.at(file=where) from error
    bins = min(
        len(smooth), round((len(smooth) - 1) / rate / settings["binning"]["continuous"]["bin_s"])
    )
    order = settings["binning"]["continuous"]["order"]
    if bins <= order:
        raise SignkinError(f"{bins} bins", file=where, expected=f"more than the order, {order}")
    x, bin_s = in_bins(smooth, rate, bins)
    return x - x.mean(axis=0), bin_s


def _by_longest(
    jobs: Sequence[tuple[str, str, Floats, float]], longest_s: float
) -> dict[int, list[tuple[str, str, Floats, float]]]:
    out: dict[int, list[tuple[str, str, Floats, float]]] = {}
    for job in jobs:
        out.setdefault(max(2, round(longest_s / job[3])), []).append(job)
    return out


def _take(
    out: LongSeries, corpus: Corpus, name: str, hand: str, x: Floats, bin_s: float,
    posterior: Posterior, order: int,
) -> None:  # fmt: skip
    start = {**lead(corpus, name), "hand": hand}
    ends = posterior.boundaries(order)
    probability = posterior.boundary_probability(order)
    found = len(ends)
    out.posteriors.append(
        {
            **start,
            "n_bins": len(x),
            "bin_s": bin_s,
            "order": order,
            "map_count": posterior.map_count(order),
            "boundaries_per_s": found / (len(x) * bin_s),
            "cut_mass": posterior.cut_mass[0],
            "explained_variance": explained_variance(x, posterior.expected_trajectory(order)),
            "note": ""
            if found == posterior.map_count(order)
            else f"only {found} local maxima of the boundary posterior",
        }
    )
    for end, time in zip(ends, boundary_times(ends, bin_s), strict=True):
        near = probability[max(0, end - CLEARANCE_BINS) : end + CLEARANCE_BINS + 1]
        out.boundaries.append(
            {**start, "boundary_s": time, "probability": min(1.0, float(near.sum()))}
        )


# --- against the other study -----------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Events:
    """Times of one kind of event in s, by (recording, hand)."""

    times: Mapping[tuple[str, str], Floats]

    def of(self, recording: str, hand: str) -> Floats:
        """Return those of a hand of a recording, none where there are none."""
        return self.times.get((recording, hand), np.empty(0))


def _events(frame: pd.DataFrame, column: str) -> Events:
    return Events(
        {
            (str(recording), str(hand)): np.sort(rows[column].dropna().to_numpy(dtype=float))
            for (recording, hand), rows in frame.groupby(["recording", "hand"])
        }
    )


def _distinct(events: Events) -> Events:
    """Return each instant once: one sign may end where the next one starts."""
    return Events({key: np.unique(np.round(times, 6)) for key, times in events.times.items()})


def events_of(
    found: pd.DataFrame, minima: pd.DataFrame, tags: pd.DataFrame | None
) -> dict[str, Events]:
    """Return what is found on wrists, by kind. tags: the table `boundaries` of the other study."""
    out = {
        "boundaries": _events(found, "boundary_s"),
        "minima": _events(minima, "minimum_s"),
    }
    if tags is not None:
        out["manual tags"] = _distinct(_events(tags, "manual_s"))
        out["refined tags"] = _distinct(_events(tags, "refined_s"))
    return out


def one_wrist(
    corpus: Corpus, about: pd.DataFrame, posteriors: pd.DataFrame,
    events: Mapping[str, Events], window_s: float, seed: int,
) -> tuple[pd.DataFrame, pd.DataFrame]:  # fmt: skip
    """Return the tables `one_wrist` and `endres_figure` (marks and chance lines to be drawn).

    about: table `recordings`. posteriors: table `wrist_posteriors`, of the wrists binned.
    """
    rows: list[dict[str, Any]] = []
    points: list[dict[str, Any]] = []
    durations = dict(zip(about["recording"], about["duration_s"], strict=True))
    for hand in HANDS:
        names = list(posteriors.loc[posteriors["hand"] == hand, "recording"])
        for (found, truth), label in FOUND.items():
            if found not in events or truth not in events:
                continue
            row, drawn = _compared(
                corpus.name, hand, names, durations, events[found], events[truth], window_s,
                stream(seed, corpus.name, "one wrist", hand, found, truth),
            )  # fmt: skip
            rows.append(
                {
                    "corpus": corpus.name,
                    "hand": hand,
                    "found": found,
                    "truth": truth,
                    "window_s": window_s,
                    **row,
                }
            )
            panel = f"{hand} wrist: {truth}"
            # Whatever is held against one truth, chance is the same.
            known = any(point["panel"] == panel for point in points)
            points += [
                {"panel": panel, **p}
                for p in _named(drawn, label)
                if not known or p["series"] == label
            ]
    frame = pd.DataFrame(points, columns=tables.TABLES["endres_figure"].names()[1:])
    frame["label"] = frame["label"].astype(object).fillna("")
    frame.insert(0, "corpus", corpus.name)
    return pd.DataFrame(rows, columns=tables.TABLES["one_wrist"].names()), frame


def _named(drawn: Sequence[Mapping[str, Any]], label: str) -> list[dict[str, Any]]:
    return [{**p, "series": label if p["series"] == "found" else p["series"]} for p in drawn]


def _compared(
    corpus: str, hand: str, names: Sequence[str], durations: Mapping[str, float], found: Events,
    truth: Events, window_s: float, rng: np.random.Generator,
) -> tuple[dict[str, Any], list[dict[str, Any]]]:  # fmt: skip
    rates: list[HitRate] = [
        hit_rate(found.of(n, hand), truth.of(n, hand), window_s, duration_s=durations[n])
        for n in names
    ]
    truths = [truth.of(n, hand) for n in names]
    n_found = sum(len(found.of(n, hand)) for n in names)
    n_truth = sum(map(len, truths))
    row: dict[str, Any] = {
        "hits": sum(r.hits for r in rates),
        "n_found": n_found,
        "n_truth": n_truth,
        "recordings": len(names),
        "note": "",
    }
    if not n_truth:
        return {**row, "note": "nothing to be hit"}, []
    mean = group_rates(rates)
    seconds = [durations[n] for n in names]
    rate = n_found / sum(seconds)
    draws = int(np.clip(round(DRAWS * 20 / len(names)), 20, DRAWS))
    line = chance_line(
        truths, seconds, rng, np.append(np.linspace(0, 8, 13), rate), window_s, draws
    )
    row |= {
        "hit_rate": mean.hit_rate,
        "false_positives_per_s": mean.false_positives_per_s,
        "chance_hit_rate": line.hit_rate[-1],
        "chance_low": line.hit_rate_low[-1],
        "chance_high": line.hit_rate_high[-1],
    }
    points: list[dict[str, Any]] = [
        {
            "series": "found", "x": mean.false_positives_per_s, "y": mean.hit_rate,
            "x_error": mean.false_positives_per_s_se, "y_error": mean.hit_rate_se, "label": "",
        }
    ]  # fmt: skip
    for series, values in (
        ("chance", line.hit_rate), ("chance low", line.hit_rate_low),
        ("chance high", line.hit_rate_high),
    ):  # fmt: skip
        points += [
            {"series": series, "x": x, "y": y}
            for x, y in zip(line.false_positives_per_s[:-1], values[:-1], strict=True)
        ]
    points += [
        {"series": "closed form", "x": x, "y": y}
        for x, y in zip(line.rate_per_s[:-1], line.closed_form[:-1], strict=True)
    ]
    return row, points


# --- drawn -----------------------------------------------------------------------------------


def draw(
    corpus: Corpus, points: pd.DataFrame, frames: pd.DataFrame, events: Mapping[str, Events],
    recording: str,
) -> Figure:  # fmt: skip
    """Draw an excerpt of both wrists with all events, and hit rates against chance.

    points: from `one_wrist`. frames: kinematics of the recording that is drawn.
    """
    panels = list(dict.fromkeys(points["panel"]))
    columns = max(len(panels) // len(HANDS), 1)
    figure = plt.figure(figsize=(WIDTH_IN * 1.2, 3.6 + 2.5 * len(HANDS)))
    grid = figure.add_gridspec(4, columns, height_ratios=[1, 1, 1.55, 1.55])
    last = float(frames["time_s"].max())
    first = max(0.0, min(last / 3, last - EXCERPT_S))
    window = (first, min(first + EXCERPT_S, last))
    for i, hand in enumerate(HANDS):
        ax = figure.add_subplot(grid[i, :])
        mine = {kind: known.of(recording, hand) for kind, known in events.items()}
        plot_excerpt(frames, mine, hand, corpus.unit, window, ax=ax, legend=i == 0)
        ax.set_xlabel("time in the recording (s)" if i else "")
    named: dict[str, Any] = {}
    for i, panel in enumerate(panels):
        ax = figure.add_subplot(grid[2 + i // columns, i % columns])
        part = points[points["panel"] == panel]
        drawing.plot_hit_rates(part, ax=ax, legend=False, right=6.0, by="series")
        ax.set_title(panel, loc="left")
        if i % columns:
            ax.set_ylabel("")
        named |= dict(zip(*reversed(ax.get_legend_handles_labels()), strict=True))
    # One legend for all panels: in them it would lie on the lines.
    figure.legend(named.values(), named.keys(), loc="outside lower center", ncols=3)
    return figure


def example(about: pd.DataFrame, posteriors: pd.DataFrame, with_frames: Container[str]) -> str:
    """Return the recording to be drawn: the longest one that was binned and has kinematics."""
    binned = set(posteriors["recording"])
    there = about[[name in binned and name in with_frames for name in about["recording"]]]
    if there.empty:
        raise SignkinError(
            "no recording has both a wrist in bins and a speed",
            place="one wrist",
            expected="one or more; wrists_left_out.csv and excluded.csv tell why not",
        )
    return str(there.loc[there["duration_s"].idxmax(), "recording"])


def caption(frame: pd.DataFrame, recording: str, settings: Mapping[str, Any]) -> str:
    """Return what the figure says below it. frame: table `one_wrist`."""
    own = settings["continuous"]
    told = "; ".join(
        f"{row.hand}, {row.found} → {row.truth}: {row.hit_rate:.2f} "
        f"(chance {row.chance_low:.2f} to {row.chance_high:.2f})"
        for row in frame.itertuples()
        if pd.notna(row.hit_rate)
    )
    return (
        f"Top: {EXCERPT_S:g} s of recording {recording}. Below: share of tags or minima that are "
        f"hit within ±{settings['window_s']:g} s, one to one, against events that hit nothing; "
        f"binning with order {own['order']}, bins of {own['bin_s']:g} s or a frame, segments up "
        f"to {own['longest_segment_s']:g} s. Dashed: as many Poisson events (grey: 95 %). {told}."
    )


# --- ELAN ------------------------------------------------------------------------------------


def tiers(found: pd.DataFrame, recording: str) -> list[NewTier]:
    """Return a tier for each hand whose annotations are the segments between boundaries."""
    out = []
    for hand in HANDS:
        here = (found["recording"] == recording) & (found["hand"] == hand)
        times = np.sort(found.loc[here, "boundary_s"].to_numpy(dtype=float))
        segments = tuple(
            Interval(float(a), float(b), str(i), hand)
            for i, (a, b) in enumerate(pairwise(times), start=1)
        )
        out.append(NewTier(f"signkin binning {hand}", segments))
    return out


def copies(
    folder: Path,
    about: pd.DataFrame,
    found: pd.DataFrame,
    intervals: pd.DataFrame,
    *,
    elan: bool = True,
) -> dict[str, bytes]:
    """Return, by file name, each ELAN file with a tier of segments for each hand.

    intervals: table of this name; elan: whether the originals are ELAN files.
    """
    return {
        f"{row.recording}.eaf": elan_copy(
            folder / str(row.annotation_file),
            tiers(found, str(row.recording)),
            elan=elan,
            clock_offset_s=float(row.clock_offset_s),
            tags=tags_of(intervals, str(row.recording)),
            media_url=str(row.motion_file),
        )
        for row in about.itertuples(index=False)
    }
