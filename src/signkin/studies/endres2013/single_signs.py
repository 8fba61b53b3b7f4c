"""Trajectories of single signs for Bayesian binning (Endres et al. 2013, sections 2.2 to 2.4).

From canonical recordings to bins: the wrist low-passed, its initial and terminal
rest left out, the recorded trajectory and its power-law ground truth cut into T
bins. What cannot be used is left out with the reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from signkin import tables
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.kinematics.curvature import curvature
from signkin.kinematics.derivatives import speed
from signkin.powerlaw import GroundTruth, LeftOut, WarpSettings, active_part, warp_to_power_law
from signkin.recording import Recording
from signkin.seeds import stream
from signkin.settings.sections import PowerLaw
from signkin.stages.ingest import lead
from signkin.stages.wrists import AXES, Wrist, in_bins, moving_hand, ready_wrist, sample_at
from signkin.studies.endres2013.settings import CutSettings

Floats = NDArray[np.float64]

RECORDED, POWERLAW = "recorded", "powerlaw"


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
class Movement:
    """The wrist that makes a sign, and the frames of its movement without the rest around it."""

    wrist: Wrist
    active: slice

    @property
    def path(self) -> Floats:
        """The movement's path, (F, L)."""
        return self.wrist.path[self.active]


def single_signs(
    corpus: Corpus, recordings: Iterable[Recording], settings: CutSettings, seed: int,
    truths: KnownTruths | None = None,
) -> SingleSigns:  # fmt: skip
    """Cut the recordings of a shard into bins, as recorded and with power-law timing.

    truths: those that other cuts of the same recordings have worked out already.
    """
    out = SingleSigns()
    truth_of = ground_truth if truths is None else truths.of
    bins = settings.bins
    for recording in recordings:
        start = lead(corpus, recording.name)

        def leave_out(dataset: str, reason: str, start: dict[str, Any] = start) -> None:
            out.left_out.append({**start, "dataset": dataset, "reason": reason})

        try:
            movement = movement_of(recording, settings)
            trajectory = recorded(movement, bins)
        except SignkinError as error:
            for dataset in (RECORDED, POWERLAW):
                leave_out(dataset, str(error))
            continue
        out.trajectories.append(trajectory)
        truth = truth_of(corpus.name, movement.wrist, settings.powerlaw, seed)
        if isinstance(truth, LeftOut):
            leave_out(POWERLAW, truth.reason)
        else:
            out.trajectories.append(warped(movement.wrist, truth, bins))
            out.segments += [{**start, **row} for row in _segments(truth, corpus.unit)]
        out.rejected += [
            {**start, "draws": truth.draws, "reason": reason, "rejected": n}
            for reason, n in truth.rejected.items()
        ]
    return out


def movement_of(recording: Recording, settings: CutSettings) -> Movement:
    """Return the movement of the hand that moves more (sections 2.2, 2.4)."""
    hand = moving_hand(recording, settings.longest_gap_s)
    wrist = ready_wrist(recording, hand, settings.longest_gap_s, settings.lowpass)
    moving = speed(wrist.path, wrist.rate_hz)
    return Movement(wrist, active_part(moving, settings.powerlaw.active_share))


def recorded(movement: Movement, bins: int) -> Trajectory:
    """Return the movement in bins; as many bins as samples where there are fewer samples."""
    path, wrist = movement.path, movement.wrist
    if len(path) < 2:
        raise SignkinError(
            f"the movement has {len(path)} samples",
            file=f"recording {wrist.recording}",
            expected="2 or more",
        )
    x, bin_s = in_bins(path, wrist.rate_hz, min(bins, len(path)))
    at = sample_at(len(path), len(x))
    return Trajectory(wrist.recording, wrist.hand, RECORDED, x, bin_s, np.empty(0), at)


def ground_truth(corpus: str, wrist: Wrist, law: PowerLaw, seed: int) -> GroundTruth | LeftOut:
    """Return the recorded path with the timing of random power laws, or why there is none."""
    rng = stream(seed, corpus, wrist.recording, "powerlaw")
    try:
        return warp_to_power_law(wrist.path, wrist.rate_hz, rng, WarpSettings(**dict(law)))
    except SignkinError as error:
        return LeftOut(reason=str(error))


class KnownTruths:
    """Ground truths by recording and law, each worked out once for all cuts into bins."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, str, str, int], GroundTruth | LeftOut] = {}

    def of(self, corpus: str, wrist: Wrist, law: PowerLaw, seed: int) -> GroundTruth | LeftOut:
        """Return `ground_truth`; the wrist of a recording is to be made ready in one way."""
        key = (corpus, wrist.recording, law.model_dump_json(), seed)
        if key not in self._known:
            self._known[key] = ground_truth(corpus, wrist, law, seed)
        return self._known[key]


def warped(wrist: Wrist, truth: GroundTruth, bins: int) -> Trajectory:
    """Return the path with power-law timing in bins; as many as samples where those are fewer."""
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
    corpus: Corpus, recording: Recording, settings: CutSettings, seed: int
) -> pd.DataFrame:
    """Return the samples of Fig. 1: path, speed and curvature, as recorded and warped.

    Empty where the recording has no ground truth.
    """
    movement = movement_of(recording, settings)
    wrist = movement.wrist
    truth = ground_truth(corpus.name, wrist, settings.powerlaw, seed)
    if isinstance(truth, LeftOut):
        return tables.empty("fig01_powerlaw", corpus.unit)
    path = movement.path
    time_s = np.arange(len(path)) / wrist.rate_hz
    cuts = truth.boundaries_recorded_s - movement.active.start / wrist.rate_hz
    samples = (
        Samples(
            RECORDED, path, time_s, np.searchsorted(cuts, time_s, side="right"),
            speed(path, wrist.rate_hz), np.maximum(curvature(path), truth.least_curvature),
            np.full(len(path), np.nan),
        ),
        Samples(
            POWERLAW, truth.positions, truth.time_s, truth.segment, truth.speed,
            truth.curvature, truth.predicted_speed,
        ),
    )  # fmt: skip
    parts = [_points(one, wrist.axes, corpus.unit) for one in samples]
    frame = pd.concat(parts, ignore_index=True)
    for column, value in reversed(lead(corpus, recording.name).items()):
        frame.insert(0, column, value)
    return frame


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples of a path (F, L), their times and segments, speed, curvature and speed by the law."""

    dataset: str
    path: Floats
    time_s: Floats
    segment: NDArray[np.int64]
    speed: Floats
    curvature: Floats
    predicted_speed: Floats


def _points(of: Samples, axes: str, unit: str) -> pd.DataFrame:
    there = dict(zip(axes, of.path.T, strict=True))
    return pd.DataFrame(
        {
            "dataset": of.dataset,
            "time_s": of.time_s,
            "segment": of.segment + 1,
            **{f"{axis}_{unit}": there.get(axis, np.nan) for axis in AXES},
            f"speed_{unit}_per_s": of.speed,
            f"curvature_per_{unit}": of.curvature,
            f"predicted_speed_{unit}_per_s": of.predicted_speed,
        }
    )


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


def read_trajectories(paths: Iterable[str | Path], **of: str) -> list[Trajectory]:
    """Read trajectories that `write_trajectories` wrote, of several files in their order.

    of: what they must be, such as dataset="powerlaw" or recording="r0001"; the others stay unread.
    """
    out = []
    wanted = [(column, "==", value) for column, value in of.items()] or None
    for path in paths:
        for row in pq.read_table(path, filters=wanted).to_pylist():
            x = np.asarray(row["x"], dtype=float).reshape(-1, row["dimensions"])
            out.append(
                Trajectory(
                    row["recording"], row["hand"], row["dataset"], x, row["bin_s"],
                    np.asarray(row["boundaries_s"], dtype=float), row["sample_at"],
                )
            )  # fmt: skip
    return out
