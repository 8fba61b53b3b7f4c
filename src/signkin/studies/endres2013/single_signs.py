"""Trajectories of single signs for Bayesian binning (Endres et al. 2013, sections 2.2 to 2.4).

From canonical recordings to bins: the wrist low-passed, its initial and terminal
rest left out, the recorded trajectory and its power-law ground truth cut into T
bins. What cannot be used is left out with the reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from signkin import tables
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.joints import HANDS
from signkin.kinematics.curvature import curvature
from signkin.kinematics.derivatives import speed
from signkin.kinematics.filters import lowpass
from signkin.kinematics.gaps import fill_gaps
from signkin.powerlaw import GroundTruth, LeftOut, WarpSettings, active_part, warp_to_power_law
from signkin.recording import Recording
from signkin.seeds import stream
from signkin.stages.ingest import lead

Floats = NDArray[np.float64]

RECORDED, POWERLAW = "recorded", "powerlaw"
SPLINE_ORDER = 5


@dataclass(frozen=True, eq=False)
class Trajectory:
    """A trajectory in bins, as binning takes it.

    dataset: recorded or powerlaw. x: (T, L) positions, one a bin, in the corpus's unit. bin_s:
    duration of a bin. boundaries_s: known boundaries, in s from the start. sample_at: where in
    its bin a position is (`in_bins`).
    """

    recording: str
    hand: str
    dataset: str
    x: Floats
    bin_s: float
    boundaries_s: Floats
    sample_at: float = 0.5

    @property
    def duration_s(self) -> float:
        """Duration of all bins."""
        return len(self.x) * self.bin_s


@dataclass
class SingleSigns:
    """What a shard of recordings gave: trajectories, ground truth, and what was left out."""

    trajectories: list[Trajectory] = field(default_factory=list)
    segments: list[dict[str, Any]] = field(default_factory=list)
    rejected: list[dict[str, Any]] = field(default_factory=list)
    left_out: list[dict[str, Any]] = field(default_factory=list)

    def table(self, name: str, unit: str) -> pd.DataFrame:
        """Return the rows of one of the tables ground_truth, rejected_draws, left_out."""
        rows = {
            "ground_truth": self.segments,
            "rejected_draws": self.rejected,
            "binning_left_out": self.left_out,
        }[name]
        return pd.DataFrame(rows, columns=tables.TABLES[name].names(unit))


@dataclass(frozen=True, eq=False)
class Wrist:
    """The wrist of one recording: low-passed path (F, L), the frames of the movement."""

    recording: str
    hand: str
    path: Floats
    rate_hz: float
    active: slice


def single_signs(
    corpus: Corpus,
    recordings: Iterable[Recording],
    settings: Mapping[str, Any],
    seed: int,
) -> SingleSigns:
    """Cut the recordings of a shard into bins, as recorded and with power-law timing.

    settings: the sections `kinematics`, `binning` and `powerlaw` of config.yaml.
    """
    out = SingleSigns()
    warp = WarpSettings(**settings["powerlaw"])
    bins = int(settings["binning"]["bins"])
    for recording in recordings:
        start = lead(corpus, recording.name)

        def leave_out(dataset: str, reason: str, start: dict[str, Any] = start) -> None:
            out.left_out.append({**start, "dataset": dataset, "reason": reason})

        try:
            wrist = wrist_of(recording, settings)
            trajectory = recorded(wrist, bins)
        except SignkinError as error:
            for dataset in (RECORDED, POWERLAW):
                leave_out(dataset, str(error))
            continue
        out.trajectories.append(trajectory)
        truth = ground_truth(corpus.name, wrist, warp, seed)
        if isinstance(truth, LeftOut):
            leave_out(POWERLAW, truth.reason)
        else:
            out.trajectories.append(_warped(wrist, truth, bins))
            out.segments += [{**start, **row} for row in _segments(truth, corpus.unit)]
        out.rejected += [
            {**start, "draws": truth.draws, "reason": reason, "rejected": n}
            for reason, n in truth.rejected.items()
        ]
    return out


def wrist_of(recording: Recording, settings: Mapping[str, Any]) -> Wrist:
    """Return the low-passed path of the hand that moves more, and the frames of its movement."""
    paths = {}
    for hand in HANDS:
        joint = f"{hand}_wrist"
        if joint in recording.joints:
            paths[hand] = fill_gaps(
                recording.track(joint), recording.rate_hz, settings["kinematics"]["longest_gap_s"]
            )[0]
    moved = {hand: _length(path) for hand, path in paths.items()}
    hand = max(moved, key=lambda name: moved[name])
    where = f"recording {recording.name}"
    if np.isnan(paths[hand]).any():
        raise SignkinError(
            f"{int(np.isnan(paths[hand]).any(axis=1).sum())} frames without a position",
            file=where,
            place=f"{hand}_wrist",
            expected="a path without long gaps (kinematics.longest_gap_s)",
        )
    if not moved[hand] > 0:
        raise SignkinError(
            "the wrist does not move", file=where, place=f"{hand}_wrist", expected="a movement"
        )
    here = paths[hand]
    if not here[:, 2].any():  # a flat recording: its third coordinate is 0, and no data
        here = here[:, :2]
    try:
        path = lowpass(here, recording.rate_hz, **settings["binning"]["lowpass"])
    except SignkinError as error:
        raise error.at(file=where) from error
    active = active_part(speed(path, recording.rate_hz), settings["powerlaw"]["active_share"])
    return Wrist(recording.name, hand, path, recording.rate_hz, active)


def _length(path: Floats) -> float:
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    return float(np.nansum(steps))


def recorded(wrist: Wrist, bins: int) -> Trajectory:
    """Return the movement in bins; as many bins as samples where there are fewer samples."""
    path = wrist.path[wrist.active]
    if len(path) < 2:
        raise SignkinError(
            f"the movement has {len(path)} samples",
            file=f"recording {wrist.recording}",
            expected="2 or more",
        )
    x, bin_s = in_bins(path, wrist.rate_hz, min(bins, len(path)))
    at = sample_at(len(path), len(x))
    return Trajectory(wrist.recording, wrist.hand, RECORDED, x, bin_s, np.empty(0), at)


def in_bins(path: Floats, rate_hz: float, bins: int) -> tuple[Floats, float]:
    """Return a path (F, L) at the middle of T bins, by a spline, and the bins' duration in s.

    As many bins as samples are the samples.
    """
    frames = len(path)
    if frames == bins:
        return np.array(path, dtype=float), 1 / rate_hz
    duration = (frames - 1) / rate_hz
    bin_s = duration / bins
    middle = (np.arange(bins) + 0.5) * bin_s
    curve = make_interp_spline(np.arange(frames) / rate_hz, path, k=min(SPLINE_ORDER, frames - 1))
    return np.asarray(curve(middle)), bin_s


def sample_at(frames: int, bins: int) -> float:
    """Return where in its bin a position of `in_bins` is, as a share of the bin.

    In the middle; at the start where each frame is a bin: frame i stands at i / rate.
    """
    return 0.0 if bins == frames else 0.5


def ground_truth(
    corpus: str, wrist: Wrist, settings: WarpSettings, seed: int
) -> GroundTruth | LeftOut:
    """Return the recorded path with the timing of random power laws, or why there is none."""
    rng = stream(seed, corpus, wrist.recording, "powerlaw")
    try:
        return warp_to_power_law(wrist.path, wrist.rate_hz, rng, settings)
    except SignkinError as error:
        return LeftOut(reason=str(error))


def _warped(wrist: Wrist, truth: GroundTruth, bins: int) -> Trajectory:
    x, bin_s = in_bins(truth.positions, truth.rate_hz, min(bins, len(truth.positions)))
    at = sample_at(len(truth.positions), len(x))
    return Trajectory(wrist.recording, wrist.hand, POWERLAW, x, bin_s, truth.boundaries_s, at)


def _segments(truth: GroundTruth, unit: str) -> Iterable[dict[str, Any]]:
    ends = [*truth.boundaries_s, truth.duration_s]
    for i, (drawn, fitted) in enumerate(zip(truth.drawn, truth.fitted, strict=True)):
        yield {
            "segment": i + 1,
            "end_s": ends[i],
            "duration_s": truth.durations_s[i],
            "recorded_duration_s": truth.durations_recorded_s[i],
            "beta": drawn.beta,
            "alpha": drawn.alpha,
            "fitted_beta": fitted.beta,
            "fitted_alpha": fitted.alpha,
            "r_squared": fitted.r_squared,
            f"top_speed_{unit}_per_s": truth.top_speeds[i],
            f"recorded_top_speed_{unit}_per_s": truth.top_speeds_recorded[i],
            "straight_share": truth.straight_share,
            "draws": truth.draws,
        }


# --- one recording, to be drawn (Fig. 1) ------------------------------------------------------


def example_points(
    corpus: Corpus, recording: Recording, settings: Mapping[str, Any], seed: int
) -> pd.DataFrame:
    """Return the samples of Fig. 1: path, speed and curvature, as recorded and warped.

    Empty where the recording has no ground truth.
    """
    wrist = wrist_of(recording, settings)
    warp = WarpSettings(**settings["powerlaw"])
    truth = ground_truth(corpus.name, wrist, warp, seed)
    if isinstance(truth, LeftOut):
        return tables.empty("fig01_powerlaw", corpus.unit)
    path = wrist.path[wrist.active]
    time_s = np.arange(len(path)) / wrist.rate_hz
    cuts = truth.boundaries_recorded_s - wrist.active.start / wrist.rate_hz
    parts = [
        _points(
            RECORDED, path, time_s, np.searchsorted(cuts, time_s, side="right"),
            speed(path, wrist.rate_hz), np.maximum(curvature(path), truth.least_curvature),
            np.full(len(path), np.nan), corpus.unit,
        ),
        _points(
            POWERLAW, truth.positions, truth.time_s, truth.segment, truth.speed,
            truth.curvature, truth.predicted_speed, corpus.unit,
        ),
    ]  # fmt: skip
    frame = pd.concat(parts, ignore_index=True)
    for column, value in reversed(lead(corpus, recording.name).items()):
        frame.insert(0, column, value)
    return frame


def _points(
    dataset: str, path: Floats, time_s: Floats, segment: NDArray[np.int64], v: Floats, k: Floats,
    predicted: Floats, unit: str,
) -> pd.DataFrame:  # fmt: skip
    columns: dict[str, Any] = {"dataset": dataset, "time_s": time_s, "segment": segment + 1}
    for axis, letter in enumerate("xyz"):
        columns[f"{letter}_{unit}"] = path[:, axis] if axis < path.shape[1] else np.nan
    columns[f"speed_{unit}_per_s"] = v
    columns[f"curvature_per_{unit}"] = k
    columns[f"predicted_speed_{unit}_per_s"] = predicted
    return pd.DataFrame(columns)


# --- files -----------------------------------------------------------------------------------


def write_trajectories(path: str | Path, trajectories: Sequence[Trajectory]) -> None:
    """Write trajectories to Parquet, one a row."""
    table = pa.table(
        {
            "recording": pa.array([t.recording for t in trajectories], pa.string()),
            "hand": pa.array([t.hand for t in trajectories], pa.string()),
            "dataset": pa.array([t.dataset for t in trajectories], pa.string()),
            "dimensions": pa.array([t.x.shape[1] for t in trajectories], pa.int32()),
            "bin_s": pa.array([t.bin_s for t in trajectories], pa.float64()),
            "sample_at": pa.array([t.sample_at for t in trajectories], pa.float64()),
            "x": pa.array([t.x.ravel() for t in trajectories], pa.list_(pa.float64())),
            "boundaries_s": pa.array(
                [np.asarray(t.boundaries_s) for t in trajectories], pa.list_(pa.float64())
            ),
        }
    )
    pq.write_table(table, path, compression="zstd")


def read_trajectories(paths: Iterable[str | Path]) -> list[Trajectory]:
    """Read trajectories that `write_trajectories` wrote, of several files in their order."""
    out = []
    for path in paths:
        for row in pq.read_table(path).to_pylist():
            x = np.asarray(row["x"], dtype=float).reshape(-1, row["dimensions"])
            out.append(
                Trajectory(
                    row["recording"], row["hand"], row["dataset"], x, row["bin_s"],
                    np.asarray(row["boundaries_s"], dtype=float), row["sample_at"],
                )
            )  # fmt: skip
    return out
