"""Tags and kinematics to boundaries, sign types and transitions (Naert et al. 2017, 4.2, 5.1)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from signkin import seeds, tables
from signkin.annotation import Interval
from signkin.coarticulation.segmentation import (
    boundary_rows,
    chance_distances,
    refinement_quality,
)
from signkin.coarticulation.sign_speeds import continuous, sign_speeds, transition_speed_rows
from signkin.coarticulation.sign_types import TypeRule, Wrists, reach_of, sign_type_rows
from signkin.coarticulation.transitions import transition_rows, utterance_names
from signkin.corpus import Corpus
from signkin.joints import HANDS
from signkin.kinematics.filters import lowpass
from signkin.kinematics.gaps import fill_gaps
from signkin.kinematics.rotations import parent_relative
from signkin.recording import Recording
from signkin.stages.ingest import lead


def intervals_of(intervals: pd.DataFrame, recording: str, role: str) -> list[Interval]:
    """Return the intervals of one role of a recording, in order of start."""
    rows = intervals[(intervals["recording"] == recording) & (intervals["role"] == role)]
    return sorted(
        Interval(float(r.start_s), float(r.end_s), str(r.label), str(r.tier))
        for r in rows.itertuples(index=False)
    )


def _with_lead(corpus: Corpus, recording: str, rows: pd.DataFrame) -> pd.DataFrame:
    for place, (column, value) in enumerate(lead(corpus, recording).items()):
        rows.insert(place, column, value)
    return rows


def _together(parts: list[pd.DataFrame], table: str, unit: str) -> pd.DataFrame:
    kept = [part for part in parts if len(part)]
    if not kept:
        return tables.empty(table, unit)
    return pd.concat(kept, ignore_index=True)


def boundaries(
    corpus: Corpus,
    names: Iterable[str],
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    settings: Mapping[str, Any],
) -> pd.DataFrame:
    """Return the table `boundaries` of some recordings; settings: config's `refinement`."""
    parts = []
    for name in names:
        signs = intervals_of(intervals, name, "sign")
        of_recording = minima[minima["recording"] == name]
        times = {
            hand: of_recording.loc[of_recording["hand"] == hand, "minimum_s"].to_numpy(dtype=float)
            for hand in HANDS
        }
        rows = boundary_rows(signs, times, settings["window_s"], settings["tolerance_s"])
        parts.append(_with_lead(corpus, name, rows))
    return _together(parts, "boundaries", corpus.unit)


def transitions(
    corpus: Corpus,
    recordings: Iterable[Recording],
    wrist_frames: Mapping[str, pd.DataFrame],
    intervals: pd.DataFrame,
    refined: pd.DataFrame,
    settings: Mapping[str, Any],
) -> tuple[pd.DataFrame, pd.DataFrame, pd.DataFrame]:
    """Return sign types, transitions (not yet normalised) and the speeds around them.

    wrist_frames: recording -> its frames of kinematics. refined: the table `boundaries`.
    settings: config.yaml (kinematics, transitions, sign_types).
    """
    rule = TypeRule(**settings["sign_types"])
    types, moves, speeds = [], [], []
    for recording in recordings:
        if recording.name not in wrist_frames:
            continue
        signs = intervals_of(intervals, recording.name, "sign")
        utterances = utterances_of(corpus, intervals, recording.name, signs)
        filled = filled_recording(recording, settings["kinematics"]["longest_gap_s"])
        wrists = _wrists(filled, wrist_frames[recording.name], settings["kinematics"]["lowpass"])
        kinds = sign_type_rows(signs, utterances, wrists, corpus.lexicon, rule)
        orientations = filled.orientations
        if orientations is not None and settings["transitions"]["geodesic_frame"] == "parent":
            orientations = parent_relative(filled)
        tags = {hand: _tags(refined, recording.name, hand) for hand in HANDS}
        rows = transition_rows(filled, orientations, signs, utterances, kinds, tags)
        kinds.insert(4, "utterance", utterances)
        types.append(_with_lead(corpus, recording.name, kinds))
        moves.append(_with_lead(corpus, recording.name, rows))
        around = _speeds(filled, orientations, signs, utterances, settings["kinematics"]["lowpass"])
        speeds.append(_with_lead(corpus, recording.name, around))
    return (
        _together(types, "sign_types", corpus.unit),
        _together(moves, "raw_transitions", corpus.unit),
        _together(speeds, "transition_speeds", corpus.unit),
    )


def _speeds(
    recording: Recording,
    orientations: np.ndarray | None,
    signs: list[Interval],
    utterances: list[str],
    filter_: Mapping[str, Any],
) -> pd.DataFrame:
    """Return the mean speeds of the signs around each transition, motion low-passed."""
    speeds = sign_speeds(*smoothed(recording, orientations, filter_), signs, recording)
    return transition_speed_rows(speeds, utterances, recording.unit)


def smoothed(
    recording: Recording, orientations: np.ndarray | None, filter_: Mapping[str, Any]
) -> tuple[np.ndarray, np.ndarray | None]:
    """Return positions and orientations low-passed, as the speeds of signs are taken from them."""
    positions = lowpass(recording.positions, recording.rate_hz, **filter_)
    smooth = None
    if orientations is not None:
        smooth = lowpass(continuous(orientations), recording.rate_hz, **filter_)
        smooth /= np.linalg.norm(smooth, axis=2, keepdims=True)
    return positions, smooth


def utterances_of(
    corpus: Corpus, intervals: pd.DataFrame, name: str, signs: list[Interval]
) -> list[str]:
    """Return the utterance of each sign of a recording, by the corpus's own rule."""
    if "utterance" in corpus.tiers:
        return utterance_names(signs, intervals_of(intervals, name, "utterance"))
    return utterance_names(signs, gap_s=corpus.settings["annotation"].get("utterance_gap_s"))


def filled_recording(recording: Recording, longest_gap_s: float) -> Recording:
    """Return the recording with the short gaps of every joint filled."""
    positions = recording.positions.copy()
    for joint in range(len(recording.joints)):
        if np.isnan(positions[:, joint]).any():
            positions[:, joint] = fill_gaps(positions[:, joint], recording.rate_hz, longest_gap_s)[
                0
            ]
    return replace(recording, positions=positions)


def _wrists(recording: Recording, frames: pd.DataFrame, filter_: Mapping[str, Any]) -> Wrists:
    """Return the wrists' paths relative to the trunk: a body that sways moves no hand."""
    trunk: np.ndarray | float = 0.0
    shoulders = [f"{hand}_shoulder" for hand in HANDS]
    if all(joint in recording.joints for joint in shoulders):
        middle = (recording.track(shoulders[0]) + recording.track(shoulders[1])) / 2
        trunk = lowpass(middle, recording.rate_hz, **filter_)

    def path(hand: str) -> np.ndarray:
        columns = [f"{hand}_wrist_{axis}_{recording.unit}" for axis in "xyz"]
        return frames[columns].to_numpy(dtype=float) - trunk

    right, left = path("right"), path("left")
    reach = reach_of(right, left, _arm_length(recording))
    return Wrists(right, left, recording.rate_hz, reach)


def _arm_length(recording: Recording) -> float | None:
    parts = ("right_shoulder", "right_elbow", "right_wrist")
    if any(joint not in recording.joints for joint in parts):
        return None
    shoulder, elbow, wrist = (recording.track(joint) for joint in parts)
    length = np.linalg.norm(elbow - shoulder, axis=1) + np.linalg.norm(wrist - elbow, axis=1)
    return float(np.nanmedian(length))


def _tags(refined: pd.DataFrame, recording: str, hand: str) -> np.ndarray:
    rows = refined[(refined["recording"] == recording) & (refined["hand"] == hand)]
    return rows["refined_s"].to_numpy(dtype=float).reshape(-1, 2)


UNUSED = "occurs in no recording: misspelt?"
UNTYPED = "not in signs.csv: typed from motion"


def lexicon_use(corpus: Corpus, sign_types: pd.DataFrame) -> pd.DataFrame:
    """Return the table `lexicon`: which glosses signs.csv and the annotation have in common."""
    counts = sign_types["gloss"].value_counts()
    glosses = sorted(set(counts.index) | set(corpus.lexicon))
    rows = []
    for gloss in glosses:
        occurrences, digits = int(counts.get(gloss, 0)), corpus.lexicon.get(gloss, "")
        note = UNUSED if not occurrences else "" if digits else UNTYPED
        rows.append((corpus.name, gloss, digits, occurrences, note))
    return pd.DataFrame(rows, columns=tables.TABLES["lexicon"].names())


def table1(corpus: Corpus, intervals: pd.DataFrame, sign_types: pd.DataFrame) -> pd.DataFrame:
    """Return utterances with their glosses and, where there is a tier for it, a translation.

    Without an utterance tier the translation tier tells the utterances, without both the
    utterance rule that the transitions follow.
    """
    rows = []
    for name in dict.fromkeys(sign_types["recording"]):
        signs = sign_types[sign_types["recording"] == name]
        role = next((r for r in ("utterance", "translation") if r in corpus.tiers), None)
        translations = (
            intervals_of(intervals, name, "translation") if "translation" in corpus.tiers else []
        )
        for number, start, end, chosen in _stretches(name, signs, intervals, role):
            middle = (start + end) / 2
            text = [t.label for t in translations if t.start_s <= middle < t.end_s]
            rows.append(
                {
                    **lead(corpus, name),
                    "utterance": number,
                    "start_s": start,
                    "end_s": end,
                    "signs": len(chosen),
                    "glosses": " ".join(chosen["gloss"]),
                    "translation": text[0] if text else "",
                }
            )
    return pd.DataFrame(rows, columns=tables.TABLES["table1"].names())


def _stretches(
    name: str, signs: pd.DataFrame, intervals: pd.DataFrame, role: str | None
) -> Iterator[tuple[str, float, float, pd.DataFrame]]:
    """Yield (utterance, start, end, its signs)."""
    if role is None:
        for number, chosen in signs.groupby("utterance", sort=False):
            yield str(number), float(chosen["start_s"].min()), float(chosen["end_s"].max()), chosen
        return
    middle = (signs["start_s"] + signs["end_s"]) / 2
    for number, span in enumerate(intervals_of(intervals, name, role), start=1):
        inside = (middle >= span.start_s) & (middle < span.end_s)
        yield str(number), span.start_s, span.end_s, signs[inside]


def refinement(
    corpus: Corpus,
    about: pd.DataFrame,
    intervals: pd.DataFrame,
    minima: pd.DataFrame,
    bounds: pd.DataFrame,
    settings: Mapping[str, Any],
    seed: int,
) -> tuple[pd.DataFrame, dict[str, np.ndarray]]:
    """Return the table `refinement`, and all chance distances (draws, tags) of each hand.

    about: the table `recordings`. bounds: the table `boundaries`. settings: config's
    `refinement`.
    """
    chance = {}
    rates = about.set_index("recording")["rate_hz"]
    for name in dict.fromkeys(bounds["recording"]):
        signs = intervals_of(intervals, name, "sign")
        for hand in HANDS:
            chosen = (minima["recording"] == name) & (minima["hand"] == hand)
            chance[(name, hand)] = chance_distances(
                signs,
                minima.loc[chosen, "minimum_s"].to_numpy(dtype=float),
                float(rates[name]),
                settings["draws"],
                seeds.stream(seed, corpus.name, name, hand, "chance"),
            )
    rows = refinement_quality(bounds, chance, settings["window_s"], settings["tolerance_s"])
    rows.insert(0, "corpus", corpus.name)
    pooled = {
        hand: np.concatenate([d for (_, h), d in chance.items() if h == hand], axis=1)
        for hand in HANDS
    }
    return rows, pooled
