"""A tagged recording as all analyses take it: signs, utterances, motion without short gaps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd

from signkin import tables
from signkin.annotation import Interval
from signkin.coarticulation.sign_speeds import continuous
from signkin.coarticulation.transitions import utterance_names
from signkin.corpus import Corpus
from signkin.joints import HANDS
from signkin.kinematics.filters import lowpass
from signkin.kinematics.gaps import fill_gaps
from signkin.kinematics.rotations import parent_relative
from signkin.recording import Recording
from signkin.settings.sections import Lowpass
from signkin.stages.ingest import lead
from signkin.tables import ByRecording, rows_of


def intervals_of(
    intervals: pd.DataFrame | ByRecording, recording: str, role: str
) -> list[Interval]:
    """Return the intervals of one role of a recording, in order of start."""
    rows = rows_of(intervals, recording)
    rows = rows[rows["role"] == role]
    return sorted(
        Interval(float(r.start_s), float(r.end_s), str(r.label), str(r.tier))
        for r in rows.itertuples(index=False)
    )


def hands_tagged(corpus: Corpus) -> tuple[str, ...]:
    """Return the hands that a corpus's tags of signs are of: both, unless it tells of one."""
    told = corpus.settings.get("tagged_hand")
    if told:
        return (str(told),)
    by_hand = {hand for entry in corpus.entries for hand in corpus.tiers_of(entry).get("sign", {})}
    if not by_hand or "both" in by_hand:
        return HANDS
    return tuple(hand for hand in HANDS if hand in by_hand)


def signs_of_hand(
    corpus: Corpus, intervals: pd.DataFrame | ByRecording, recording: str, hand: str
) -> list[Interval]:
    """Return the signs of a recording but those of the other hand's own tier."""
    other = next(name for name in HANDS if name != hand)
    apart = corpus.tiers_of(corpus.by_name[recording]).get("sign", {}).get(other)
    return [s for s in intervals_of(intervals, recording, "sign") if s.tier != apart]


def kept(about: pd.DataFrame, excluded: pd.DataFrame) -> list[str]:
    """Return the recordings of the table `recordings` that the table `excluded` does not name."""
    without = set(excluded["recording"])
    return [str(name) for name in about["recording"] if name not in without]


def utterances_of(
    corpus: Corpus, intervals: pd.DataFrame | ByRecording, name: str, signs: list[Interval]
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


def turns_of(recording: Recording, geodesic_frame: str) -> np.ndarray | None:
    """Return the orientations that the geodesic distance takes, (F, J, 4), or None without any.

    geodesic_frame: config's transitions.geodesic_frame, `world` or `parent`.
    """
    if recording.orientations is not None and geodesic_frame == "parent":
        return parent_relative(recording)
    return recording.orientations


def smoothed(
    recording: Recording, orientations: np.ndarray | None, filter_: Lowpass
) -> tuple[np.ndarray, np.ndarray | None]:
    """Return positions and orientations low-passed, as the speeds of signs are taken from them."""
    positions = lowpass(recording.positions, recording.rate_hz, **dict(filter_))
    smooth = None
    if orientations is not None:
        smooth = lowpass(continuous(orientations), recording.rate_hz, **dict(filter_))
        smooth /= np.linalg.norm(smooth, axis=2, keepdims=True)
    return positions, smooth


def with_lead(corpus: Corpus, recording: str, rows: pd.DataFrame) -> pd.DataFrame:
    """Put corpus, recording and signer before the columns of `rows`, which is changed."""
    for place, (column, value) in enumerate(lead(corpus, recording).items()):
        rows.insert(place, column, value)
    return rows


def together(parts: list[pd.DataFrame], table: str, unit: str) -> pd.DataFrame:
    """Return the parts of a table below one another; without rows, the empty table."""
    kept = [part for part in parts if len(part)]
    if not kept:
        return tables.empty(table, unit)
    return pd.concat(kept, ignore_index=True)
