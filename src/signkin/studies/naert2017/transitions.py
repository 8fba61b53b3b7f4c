"""Sign types, transitions and the speeds around them (Naert et al. 2017, 5.1)."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd

from signkin.annotation import Interval
from signkin.coarticulation.sign_speeds import sign_speeds, transition_speed_rows
from signkin.coarticulation.sign_types import TypeRule, Wrists, reach_of, sign_type_rows
from signkin.coarticulation.transitions import transition_rows
from signkin.corpus import Corpus
from signkin.joints import HANDS
from signkin.kinematics.filters import lowpass
from signkin.recording import Recording
from signkin.settings.sections import Lowpass
from signkin.studies.naert2017.settings import TransitionSettings
from signkin.studies.naert2017.tagged import (
    filled_recording,
    intervals_of,
    smoothed,
    together,
    turns_of,
    utterances_of,
    with_lead,
)
from signkin.tables import ByRecording


def transitions(
    corpus: Corpus,
    recordings: Iterable[Recording],
    wrist_frames: pd.DataFrame,
    intervals: pd.DataFrame,
    refined: pd.DataFrame,
    settings: TransitionSettings,
) -> dict[str, pd.DataFrame]:
    """Return the tables `sign_types`, `raw_transitions` and `transition_speeds` of recordings.

    wrist_frames: the frames of kinematics; recordings that it lacks are left out. refined: the
    table `boundaries`.
    """
    frames = {str(name): part for name, part in wrist_frames.groupby("recording", sort=False)}
    rule = TypeRule(**dict(settings.sign_types))
    tags_by, bounds = ByRecording(intervals), ByRecording(refined)
    types, moves, speeds = [], [], []
    for recording in recordings:
        if recording.name not in frames:
            continue
        signs = intervals_of(tags_by, recording.name, "sign")
        utterances = utterances_of(corpus, tags_by, recording.name, signs)
        filled = filled_recording(recording, settings.kinematics.longest_gap_s)
        wrists = _wrists(filled, frames[recording.name], settings.kinematics.lowpass)
        kinds = sign_type_rows(signs, utterances, wrists, corpus.lexicon, rule)
        orientations = turns_of(filled, settings.transitions.geodesic_frame)
        tags = {hand: _tags(bounds[recording.name], hand) for hand in HANDS}
        rows = transition_rows(filled, orientations, signs, utterances, kinds, tags)
        kinds.insert(4, "utterance", utterances)
        types.append(with_lead(corpus, recording.name, kinds))
        moves.append(with_lead(corpus, recording.name, rows))
        around = _speeds(filled, orientations, signs, utterances, settings.kinematics.lowpass)
        speeds.append(with_lead(corpus, recording.name, around))
    made = {"sign_types": types, "raw_transitions": moves, "transition_speeds": speeds}
    return {kind: together(parts, kind, corpus.unit) for kind, parts in made.items()}


def _speeds(
    recording: Recording,
    orientations: np.ndarray | None,
    signs: list[Interval],
    utterances: list[str],
    filter_: Lowpass,
) -> pd.DataFrame:
    """Return the mean speeds of the signs around each transition, motion low-passed."""
    speeds = sign_speeds(*smoothed(recording, orientations, filter_), signs, recording)
    return transition_speed_rows(speeds, utterances, recording.unit)


def _wrists(recording: Recording, frames: pd.DataFrame, filter_: Lowpass) -> Wrists:
    """Return the wrists' paths relative to the trunk: a body that sways moves no hand."""
    trunk: np.ndarray | float = 0.0
    shoulders = [f"{hand}_shoulder" for hand in HANDS]
    if all(joint in recording.joints for joint in shoulders):
        middle = (recording.track(shoulders[0]) + recording.track(shoulders[1])) / 2
        trunk = lowpass(middle, recording.rate_hz, **dict(filter_))

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


def _tags(refined: pd.DataFrame, hand: str) -> np.ndarray:
    rows = refined[refined["hand"] == hand]
    return rows["refined_s"].to_numpy(dtype=float).reshape(-1, 2)


def between_manual(transitions: pd.DataFrame) -> pd.DataFrame:
    """Return the transitions between manual tags, whole body."""
    return transitions[(transitions["segmentation"] == "manual") & (transitions["hand"] == "both")]


def counted(transitions: pd.DataFrame) -> pd.DataFrame:
    """Return the transitions between manual tags, whole body, overlapping signs left out."""
    whole = between_manual(transitions)
    return whole[whole["status"] != "overlap"].reset_index(drop=True)


def left_out(transitions: pd.DataFrame) -> pd.DataFrame:
    """Return the transitions between manual tags that overlap or have zero length."""
    whole = between_manual(transitions)
    return whole[whole["status"] != "ok"].reset_index(drop=True)
