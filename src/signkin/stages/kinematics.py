"""Canonical recordings to wrist paths, speeds and their minima, with gaps and plausibility."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from signkin import tables
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.joints import HANDS, hands_of
from signkin.kinematics.derivatives import speed
from signkin.kinematics.filters import lowpass
from signkin.kinematics.gaps import fill_gaps, longest_stretch_s
from signkin.kinematics.minima import minima_with_depth
from signkin.kinematics.plausibility import check_recording
from signkin.kinematics.rests import rest_times
from signkin.recording import Recording
from signkin.settings.sections import Kinematics as KinematicsSettings
from signkin.stages.ingest import excluded_row, lead


@dataclass
class Kinematics:
    """Wrist kinematics of a shard: one frame table a recording, and rows of small tables."""

    frames: list[pd.DataFrame] = field(default_factory=list)
    minima: list[dict[str, Any]] = field(default_factory=list)
    gaps: list[dict[str, Any]] = field(default_factory=list)
    plausibility: list[dict[str, Any]] = field(default_factory=list)
    excluded: list[dict[str, Any]] = field(default_factory=list)

    def table(self, name: str, unit: str) -> pd.DataFrame:
        """Return one of the tables minima, gaps, plausibility, excluded as a frame."""
        return pd.DataFrame(getattr(self, name), columns=tables.TABLES[name].names(unit))


def kinematics(
    corpus: Corpus, recordings: Iterable[Recording], settings: KinematicsSettings
) -> Kinematics:
    """Analyse the wrists of each recording; settings: the section `kinematics` of config.yaml.

    A wrist with too many gaps ends the run or leaves the recording out, as the corpus says.
    """
    out = Kinematics()
    for recording in recordings:
        start = lead(corpus, recording.name)
        try:
            findings = [{**start, **asdict(f)} for f in check_recording(recording)]
            gaps = [{**start, **row} for row in _gap_rows(recording, settings.longest_gap_s)]
            out.plausibility += findings
            out.gaps += gaps
            frame, minima = _wrists(recording, settings)
        except Exception as error:
            out.excluded.append(excluded_row(corpus, recording.name, "wrists", error))
            continue
        out.frames.append(frame)
        out.minima += [{**start, **row} for row in minima]
    return out


def _gap_rows(recording: Recording, longest_gap_s: float) -> list[dict[str, Any]]:
    rows = []
    for joint in recording.joints:
        track = recording.track(joint)
        gap = np.asarray(np.isnan(track).any(axis=1))
        if gap.any():
            filled = fill_gaps(track, recording.rate_hz, longest_gap_s)[1]
            rows.append(
                {
                    "joint": joint,
                    "missing_frames": int(gap.sum()),
                    "filled_frames": int(filled.sum()),
                    "longest_gap_s": longest_stretch_s(gap, recording.rate_hz),
                }
            )
    return rows


def _wrists(
    recording: Recording, settings: KinematicsSettings
) -> tuple[pd.DataFrame, list[dict[str, Any]]]:
    unit, rate = recording.unit, recording.rate_hz
    columns: dict[str, Any] = {
        "recording": recording.name,
        "frame": np.arange(recording.frames, dtype=np.int32),
        "time_s": recording.times_s,
    }
    speeds = {}
    there = hands_of(recording.joints)
    for hand in HANDS:
        if hand not in there:  # a one-handed recording: the columns are there, without numbers
            columns |= {f"{hand}_wrist_{letter}_{unit}": np.nan for letter in "xyz"}
            columns |= {f"{hand}_speed_{unit}_per_s": np.nan, f"{hand}_filled": False}
            continue
        filled, was_gap = fill_gaps(recording.track(f"{hand}_wrist"), rate, settings.longest_gap_s)
        _refuse_riddled(recording, hand, filled, settings)
        path = lowpass(filled, rate, **dict(settings.lowpass))
        speeds[hand] = speed(path, rate)
        for axis, letter in enumerate("xyz"):
            columns[f"{hand}_wrist_{letter}_{unit}"] = path[:, axis]
        columns[f"{hand}_speed_{unit}_per_s"] = speeds[hand]
        columns[f"{hand}_filled"] = was_gap
    fastest = max(float(np.nanpercentile(s, 95)) for s in speeds.values())
    minima = []
    for hand, values in speeds.items():
        times, lows, depths = minima_with_depth(
            values,
            rate,
            prominence=settings.minima.prominence * fastest,
            spacing_s=settings.minima.spacing_s,
        )
        rests = rest_times(recording.track(f"{hand}_wrist"), rate, times)
        minima += [
            {
                "hand": hand,
                "minimum_s": time,
                f"speed_{unit}_per_s": low,
                f"prominence_{unit}_per_s": depth,
                "rest_s": rest,
                "rest_sd_s": sd,
            }
            for time, low, depth, rest, sd in zip(times, lows, depths, *rests, strict=True)
        ]
    return pd.DataFrame(columns), minima


def _refuse_riddled(
    recording: Recording, hand: str, filled: np.ndarray, settings: KinematicsSettings
) -> None:
    missing = float(np.isnan(filled).any(axis=1).mean())
    if missing > settings.most_missing:
        raise SignkinError(
            f"{missing:.0%} of the frames have no position, gaps up to "
            f"{settings.longest_gap_s:g} s filled",
            file=f"recording {recording.name}",
            place=f"joint {hand}_wrist",
            expected=f"at most {settings.most_missing:.0%} (kinematics.most_missing)",
            todo="Mend the tracking, or set `on_error: skip` in corpus.yaml to leave such "
            "recordings out.",
        )
