"""Claims of Naert et al. 2017 under every combination of choices that the paper leaves open.

The same library functions as the pipeline's, run over a grid: low-pass, depth of a minimum,
refinement window (config: open_choices.naert2017), each hand, outliers kept or left out.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise, product
from typing import Any

import numpy as np
import pandas as pd
import scipy  # loads scipy.stats when it is used: it takes as long to import as numba
from numpy.typing import NDArray

from signkin import seeds, tables
from signkin.annotation import Interval
from signkin.coarticulation.posture import euclidean_distance, geodesic_distance, normalised
from signkin.coarticulation.segmentation import refine
from signkin.corpus import Corpus
from signkin.joints import HANDS, arm_joints, hands_of
from signkin.kinematics.derivatives import speed
from signkin.kinematics.filters import lowpass
from signkin.kinematics.minima import minima_with_depth
from signkin.recording import Recording
from signkin.statistics import nulls
from signkin.statistics.descriptive import outliers
from signkin.studies.naert2017.settings import GridSettings
from signkin.studies.naert2017.tag_chance import ALL, TRANSITION
from signkin.studies.naert2017.tagged import (
    filled_recording,
    hands_tagged,
    intervals_of,
    turns_of,
    utterances_of,
)
from signkin.studies.naert2017.transitions import between_manual

ALPHA = 0.05
NEAR_TAGS = ("N19", "N20")  # of each hand's tags and its own minima
MAJORITY = 0.5  # 4.2: "a correct segmentation for a majority of cases"
VISIBLE_S = 0.03  # Fig. 9: a tenth of the mean transition
LEAST = 6  # transitions that a correlation is made from
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Setting:
    """One combination of the grid for one hand."""

    hand: str
    cutoff_hz: float
    prominence: float
    window_s: float


@dataclass
class Gathered:
    """What a setting gives, over all recordings of a corpus."""

    durations: list[Floats] = field(default_factory=list)
    changes: list[Floats] = field(default_factory=list)
    geodesic: list[Floats] = field(default_factory=list)
    euclidean: list[Floats] = field(default_factory=list)
    types: list[str] = field(default_factory=list)
    moved: int = 0
    tags: dict[str, int] = field(default_factory=dict)  # `all` or `transition`
    near: dict[str, int] = field(default_factory=dict)
    # Tags near a minimum in each set of random ones, by null and kind of tags.
    chance: dict[tuple[str, str], Floats] = field(default_factory=dict)

    def add_tags(self, near: _Near, reach_s: float) -> None:
        """Count tags, and sets of random ones, with a minimum so near."""
        for kind, distance in near.tags.items():
            self.near[kind] = self.near.get(kind, 0) + int((distance <= reach_s).sum())
            self.tags[kind] = self.tags.get(kind, 0) + distance.size
        for key, random in near.chance.items():
            hits = (random <= reach_s).sum(axis=1).astype(float)
            self.chance[key] = self.chance[key] + hits if key in self.chance else hits

    def share(self, kind: str) -> float:
        """Return the share of such tags with a minimum near; NaN without any."""
        return self.near[kind] / self.tags[kind] if self.tags[kind] else np.nan

    def chance_interval(self, null: str, kind: str) -> tuple[float, float]:
        """Return the shares that 95 % of sets of random tags lie between."""
        if not self.tags[kind]:
            return np.nan, np.nan
        hits = self.chance[null, kind] / self.tags[kind]
        low, high = np.quantile(hits, [0.025, 0.975], method="nearest")
        return float(low), float(high)

    def add_transitions(self, take: Take, refined: Floats, joints: list[int]) -> None:
        """Add the transitions of a recording between refined tags (N, 2), for one arm's joints."""
        start, end = refined[take.before, 1], refined[take.before + 1, 0]
        self.durations.append(np.round(end - start, 9))
        was = take.manual[take.before + 1, 0] - take.manual[take.before, 1]
        self.changes.append(np.round(np.abs(end - start - was), 6))
        geodesic, euclidean = distances_between(take.filled, take.turns, start, end, joints)
        self.geodesic.append(geodesic)
        self.euclidean.append(euclidean)
        self.types += take.types


@dataclass(frozen=True, eq=False)
class _Near:
    """Distances of tags to the nearest minimum, by kind; chance: by null and kind, (draws, N)."""

    tags: dict[str, Floats]
    chance: dict[tuple[str, str], Floats]


@dataclass(frozen=True, eq=False)
class Take:
    """A recording as the grid runs over it.

    manual: tags (signs, 2). before: signs with a transition after them. types: of these.
    turns: the orientations that distances take, or None.
    """

    name: str
    filled: Recording
    turns: Floats | None
    signs: list[Interval]
    manual: Floats
    before: NDArray[np.int_]
    types: list[str]

    @classmethod
    def of(
        cls,
        corpus: Corpus,
        recording: Recording,
        intervals: pd.DataFrame | tables.ByRecording,
        types: list[str],
        settings: GridSettings,
    ) -> Take:
        """Return a recording with its signs. types: of its transitions between manual tags."""
        signs = intervals_of(intervals, recording.name, "sign")
        utterances = utterances_of(corpus, intervals, recording.name, signs)
        follows = (u and u == v for u, v in pairwise(utterances))
        filled = filled_recording(recording, settings.kinematics.longest_gap_s)
        return cls(
            name=recording.name,
            filled=filled,
            turns=turns_of(filled, settings.transitions.geodesic_frame),
            signs=signs,
            manual=np.array([(sign.start_s, sign.end_s) for sign in signs]).reshape(-1, 2),
            before=np.array([i for i, there in enumerate(follows) if there], dtype=int),
            types=types,
        )


def takes_of(
    corpus: Corpus,
    recordings: Iterable[Recording],
    intervals: pd.DataFrame,
    transitions: pd.DataFrame,
    excluded: pd.DataFrame,
    settings: GridSettings,
) -> Iterator[Take]:
    """Yield the tagged recordings of a corpus; arguments as those of `claim_choices`."""
    manual, tags = tables.ByRecording(between_manual(transitions)), tables.ByRecording(intervals)
    signed = set(intervals.loc[intervals["role"] == "sign", "recording"])
    used = signed - set(excluded["recording"])
    for recording in recordings:
        if recording.name in used:
            types = manual[recording.name]["type"].tolist()
            yield Take.of(corpus, recording, tags, types, settings)


def claim_choices(
    corpus: Corpus,
    recordings: Iterable[Recording],
    intervals: pd.DataFrame,
    transitions: pd.DataFrame,
    excluded: pd.DataFrame,
    settings: GridSettings,
    seed: int,
    note: str = "",
) -> pd.DataFrame:
    """Return the table `claim_choices` of a corpus.

    transitions: the pipeline's table, which has the types and the manual transitions.
    excluded: the table of recordings that are left out. note: what every row tells.
    """
    grid = settings.choices
    gathered: dict[Setting, Gathered] = defaultdict(Gathered)
    for take in takes_of(corpus, recordings, intervals, transitions, excluded, settings):
        _add(corpus.name, take, settings, seed, gathered)
    rows = list(_manual_rows(between_manual(transitions), settings))
    for setting in (
        Setting(*s) for s in product(HANDS, grid.cutoff_hz, grid.prominence, grid.search_window_s)
    ):
        if setting in gathered:
            rows += _refined_rows(setting, gathered[setting], settings)
    own = hands_tagged(corpus)
    rows = [r for r in rows if r["claim"] not in NEAR_TAGS or r["hand"] in own]
    for row in rows:
        row["corpus"] = corpus.name
    frame = pd.DataFrame(rows).reindex(columns=tables.TABLES["claim_choices"].names())
    for column in ("segmentation", "hand", "outliers", "null", "note"):
        frame[column] = frame[column].fillna("")
    if note:
        frame["note"] = [f"{told}; {note}" if told else note for told in frame["note"]]
    return frame.sort_values("claim", kind="stable", ignore_index=True)


def _add(
    corpus: str,
    take: Take,
    settings: GridSettings,
    seed: int,
    gathered: dict[Setting, Gathered],
) -> None:
    """Add one recording to what each setting gathers."""
    grid, tolerance_s = settings.choices, settings.refinement.tolerance_s
    joints = take.filled.joints
    arms = {hand: [take.filled.index(j) for j in arm_joints(joints, hand)] for hand in HANDS}
    random = _random_tags(take, grid.draws, seed, corpus)
    for cutoff in grid.cutoff_hz:
        for hand, prominence, minima in _minima(take.filled, cutoff, settings):
            near = _near(take, minima, random, max(grid.search_window_s))
            for window in grid.search_window_s:
                refined, moved, _ = refine(take.manual, minima, window, tolerance_s)
                to = gathered[Setting(hand, cutoff, prominence, window)]
                to.add_tags(near, window + tolerance_s)
                to.moved += int(moved.sum())
                to.add_transitions(take, refined, arms[hand])


def _random_tags(take: Take, draws: int, seed: int, corpus: str) -> dict[str, list[Floats]]:
    """Return tags placed by chance under each null, (draws, N, 2) a stretch of signing.

    The same for every setting, whose minima alone differ.
    """
    parts = nulls.stretches(take.manual, [], take.filled.rate_hz)
    out = {}
    for null in nulls.Null:
        rng = seeds.stream(seed, corpus, take.name, str(null), "open choices")
        out[str(null)] = [nulls.placed(part, null, draws, rng) for part in parts]
    return out


def _near(take: Take, minima: Floats, random: dict[str, list[Floats]], margin_s: float) -> _Near:
    """Return how near the minima of a hand lie to tags, all and those that bound a transition."""
    parts = nulls.stretches(take.manual, minima, take.filled.rate_hz, margin_s=margin_s)
    observed = [nulls.distances(part.signs_s, part.minima_s) for part in parts]
    by_chance = {
        null: [nulls.distances(r, part.minima_s) for r, part in zip(tags, parts, strict=True)]
        for null, tags in random.items()
    }
    tags, chance = {}, {}
    for kind in (ALL, TRANSITION):
        flags = [part.counted(kind == TRANSITION) for part in parts]
        tags[kind] = np.concatenate([d[f] for d, f in zip(observed, flags, strict=True)])
        for null, found in by_chance.items():
            picked = [d[:, f] for d, f in zip(found, flags, strict=True)]
            chance[null, kind] = np.concatenate(picked, axis=1)
    return _Near(tags, chance)


def _minima(
    filled: Recording, cutoff_hz: float, settings: GridSettings
) -> Iterator[tuple[str, float, Floats]]:
    """Yield hand, prominence and minima (s) of a recording under one cut-off.

    Minima are found once and filtered by their depth, which gives the same as finding them
    anew: spacing goes before prominence.
    """
    rate = filled.rate_hz
    method = {**dict(settings.kinematics.lowpass), "cutoff_hz": min(cutoff_hz, 0.45 * rate)}
    speeds = {
        hand: speed(lowpass(filled.track(f"{hand}_wrist"), rate, **method), rate)
        for hand in hands_of(filled.joints)
    }
    fastest = max(float(np.nanpercentile(s, 95)) for s in speeds.values())
    spacing = settings.kinematics.minima.spacing_s
    for hand, values in speeds.items():
        times, _, depths = minima_with_depth(values, rate, 0.0, spacing)
        for prominence in settings.choices.prominence:
            yield hand, prominence, times[depths >= prominence * fastest]


def distances_between(
    filled: Recording, orientations: Floats | None, start: Floats, end: Floats, joints: list[int]
) -> tuple[Floats, Floats]:
    """Return the geodesic and Euclidean distances of the postures at two times (N,) each, in s."""
    first, second = (
        np.clip(np.rint(t * filled.rate_hz), 0, filled.frames - 1).astype(int) for t in (start, end)
    )
    a, b = (filled.positions[frames][:, joints] for frames in (first, second))
    geodesic = np.full(len(start), np.nan)
    if orientations is not None:
        geodesic = geodesic_distance(
            orientations[first][:, joints], orientations[second][:, joints]
        )
    return geodesic, euclidean_distance(a, b)


# --- rows ------------------------------------------------------------------------------------


def _manual_rows(manual: pd.DataFrame, settings: GridSettings) -> Iterator[dict[str, Any]]:
    counted = manual[manual["status"] != "overlap"]
    about = {"segmentation": "manual", "hand": "both"}
    yield from _duration_rows(
        about,
        counted["duration_s"].to_numpy(dtype=float),
        counted["mean_distance"].to_numpy(dtype=float),
        counted["type"].to_numpy(dtype=str),
        settings,
    )


def _refined_rows(
    setting: Setting, found: Gathered, settings: GridSettings
) -> Iterator[dict[str, Any]]:
    about = {"segmentation": "refined", **vars(setting)}
    durations = np.concatenate(found.durations)
    there = durations >= 0  # overlapping signs have no transition between them
    both = np.stack(
        [normalised(np.concatenate(d)[there]) for d in (found.geodesic, found.euclidean)]
    )
    known = ~np.isnan(both)
    mean = np.where(known, both, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    distance = np.where(known.any(axis=0), mean, np.nan)
    types = np.array(found.types, dtype=str)[there]
    yield from _duration_rows(about, durations[there], distance, types, settings)
    moved = found.moved / found.tags[ALL]
    for null in map(str, nulls.Null):
        where, how = {**about, "null": null}, f"bound: 97.5 % of sets of random tags, {null}"
        share, (low, bound) = found.share(TRANSITION), found.chance_interval(null, TRANSITION)
        yield {**where, "claim": "N19", "estimate": share, "low": low, "bound": bound,
               "statistic": "share of transitions' tags with a minimum in the window",
               "holds": share > bound, "n": found.tags[TRANSITION], "note": how}  # fmt: skip
        share, (low, bound) = found.share(ALL), found.chance_interval(null, ALL)
        yield {**where, "claim": "N20", "statistic": "share of tags with a minimum in the window",
               "estimate": share, "low": low, "bound": max(bound, MAJORITY),
               "holds": moved > MAJORITY and share > bound, "n": found.tags[ALL],
               "note": f"{moved:.3f} moved; {how}, or the majority"}  # fmt: skip
    change = float(np.median(np.concatenate(found.changes))) if len(durations) else np.nan
    yield {**about, "claim": "N21", "statistic": "median change of duration (s)",
           "estimate": change, "bound": VISIBLE_S, "holds": change >= VISIBLE_S,
           "n": len(durations)}  # fmt: skip


def _duration_rows(
    about: Mapping[str, Any],
    durations: Floats,
    distance: Floats,
    types: NDArray[np.str_],
    settings: GridSettings,
) -> Iterator[dict[str, Any]]:
    """Yield N05 and N12, with outliers and, where there are any, without."""
    out = outliers(durations, settings.transitions.outlier_iqr)
    for label, kept in (("kept", np.full(len(durations), True)), ("left out", ~out)):
        if label == "left out" and not out.any():
            continue
        yield {**about, "outliers": label, **_n05(durations[kept], distance[kept])}
        yield {**about, "outliers": label, **_n12(durations[kept], types[kept])}


def _n05(durations: Floats, distance: Floats) -> dict[str, Any]:
    there = ~np.isnan(distance)
    x, y = distance[there], durations[there]
    row: dict[str, Any] = {"claim": "N05", "statistic": "Pearson r", "bound": 0.0, "n": len(x)}
    if len(x) < LEAST or np.ptp(x) == 0 or np.ptp(y) == 0:
        return {**row, "estimate": np.nan, "holds": False, "note": "too few pairs, or no spread"}
    found = scipy.stats.pearsonr(x, y)
    holds = found.statistic > 0 and found.pvalue < ALPHA
    return {**row, "estimate": float(found.statistic), "holds": bool(holds)}


def _n12(durations: Floats, types: NDArray[np.str_]) -> dict[str, Any]:
    groups = [durations[types == kind] for kind in sorted(set(types) - {""})]
    kept = [group for group in groups if len(group) > 1]
    n = sum(map(len, kept))
    row: dict[str, Any] = {"claim": "N12", "statistic": "p of the ANOVA", "bound": ALPHA, "n": n}
    if len(kept) < 2 or n <= len(kept) or not any(np.ptp(group) for group in kept):
        return {**row, "estimate": np.nan, "holds": False, "note": "fewer than two groups"}
    p = float(scipy.stats.f_oneway(*kept).pvalue)
    return {**row, "estimate": p, "holds": p >= ALPHA}
