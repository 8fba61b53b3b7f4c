"""Motion on a recorded path that obeys known power laws (Endres et al. 2013, section 2.4).

The path stays as recorded; the time along it is changed, so that each of a few segments follows
its own law v = alpha kappa^beta. Boundaries and exponents are drawn at random, the gains follow
from the speed being continuous. Draws that no arm would make are rejected and counted by reason.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, PchipInterpolator, make_interp_spline

from signkin.errors import SignkinError, listed
from signkin.kinematics.curvature import curvature
from signkin.kinematics.derivatives import speed
from signkin.powerlaw.fit import PowerLaw, active_part, fit_power_law

Floats = NDArray[np.float64]

FIRST_GAINS = ("duration", "first_sample")
# Why a draw is rejected, in the order in which it is asked.
EXPONENTS = "exponents of neighbours too alike"
SPEED = "top speed of a segment not comparable"
SHORT = "segment too short after warping"
DURATION = "duration of a segment not comparable"
NOT_FOUND = "law not found again on the samples"
CLEAR = ("", SPEED, SHORT, DURATION)  # by the numbers of screening.py
REASONS = (EXPONENTS, SPEED, SHORT, DURATION, NOT_FOUND)

NODES_HZ = 960.0  # the path is integrated at least this finely ...
LOG_STEP = 0.1  # ... and where the logarithm of the curvature changes by more between nodes, finer
HALVINGS = 5
BLOCK = 256  # draws made at once
FEWEST_FRAMES = 6  # of a quintic spline


@dataclass(frozen=True, kw_only=True)
class WarpSettings:
    """How ground truth is drawn. Sections are those of Endres et al. 2013.

    active_share: the ends of the movement below this share of its top speed are left out (2.4).
    segments: number of segments (2.4: N = 3). least_segment_s: their least duration, before and
    after warping (2.4: 300 ms). least_exponent, most_exponent: range of beta (2.4: [-1, 0]).
    least_exponent_step: neighbours' exponents differ by more than this (2.4: 0.1).
    first_gain: the gain of the first segment follows from the `duration` of the whole, which
    stays, or from speed and curvature at the `first_sample`, as printed (2.4).
    most_speed_ratio, most_duration_ratio: top speed and duration of each segment lie within
    this factor of the recorded ones, either way (2.4: "comparable", no number).
    straight_turn_rad: curvatures below this over the path's length are warped as if they were
    that: a path that turns by less on its whole length is straight, and the law has no speed
    on it. least_r_squared: R^2 of the law fitted again in each segment, to the curvature as it
    is (Fig. 1: above 0.97).
    most_draws: after so many rejected draws the trajectory is left out.
    output_rate_hz: rate of the warped samples, None for that of the recording (2.2: 240 Hz).
    """

    active_share: float = 0.15
    segments: int = 3
    least_segment_s: float = 0.3
    least_exponent: float = -1.0
    most_exponent: float = 0.0
    least_exponent_step: float = 0.1
    first_gain: str = "duration"
    most_speed_ratio: float = 2.0
    most_duration_ratio: float = 2.0
    straight_turn_rad: float = 0.05
    least_r_squared: float = 0.97
    most_draws: int = 3000
    output_rate_hz: float | None = 240.0

    def __post_init__(self) -> None:
        """Refuse settings that leave nothing to draw."""
        if self.first_gain not in FIRST_GAINS:
            raise _error(f"first_gain is {self.first_gain!r}", listed(FIRST_GAINS))
        if self.segments < 1 or self.most_draws < 1 or not self.least_segment_s > 0:
            raise _error("segments, most_draws or least_segment_s is 0 or less", "numbers above 0")
        if not self.least_exponent <= self.most_exponent:
            raise _error("least_exponent above most_exponent", "a range")
        if not 0 <= self.least_exponent_step < (self.most_exponent - self.least_exponent) / 2:
            raise _error(
                f"least_exponent_step is {self.least_exponent_step:g}",
                "from 0 to less than half the range of exponents, so that there are some to draw",
            )
        if not (self.most_speed_ratio > 1 and self.most_duration_ratio > 1):
            raise _error("most_speed_ratio or most_duration_ratio is 1 or less", "above 1")
        if not self.straight_turn_rad > 0:
            raise _error(f"straight_turn_rad is {self.straight_turn_rad:g}", "above 0")
        if self.output_rate_hz is not None and not self.output_rate_hz > 0:
            raise _error(f"output_rate_hz is {self.output_rate_hz:g}", "above 0, or null")


@dataclass(frozen=True, eq=False, kw_only=True)
class GroundTruth:
    """A recorded path with power-law timing. N segments, M samples, L dimensions.

    positions: (M, L), unit of the recording, at rate_hz. time_s: (M,), from 0.
    boundaries_s: (N - 1,), ends of all segments but the last, in warped time.
    boundary_positions: (N - 1, L), where on the path they lie. boundaries_recorded_s: (N - 1,),
    the same in seconds from the recording's start. active: the recorded frames that were used.
    drawn: (N,) laws as drawn, which hold for the continuous path; fitted: (N,) laws fitted again
    on the samples, with their R^2.
    durations_s, durations_recorded_s, top_speeds, top_speeds_recorded: (N,).
    segment: (M,), index of each sample's segment. speed: (M,), by central differences.
    curvature: (M,), from three samples; NaN at the first and last, which have no three.
    predicted_speed: (M,), by the fitted laws, NaN there too. least_curvature: below it the path
    was warped as if it had that; straight_share: share of the path's length where it was.
    draws: number of draws, of which all but the last were rejected; rejected: how many for
    which reason.
    """

    positions: Floats
    rate_hz: float
    time_s: Floats
    boundaries_s: Floats
    boundary_positions: Floats
    boundaries_recorded_s: Floats
    active: slice
    drawn: tuple[PowerLaw, ...]
    fitted: tuple[PowerLaw, ...]
    durations_s: Floats
    durations_recorded_s: Floats
    top_speeds: Floats
    top_speeds_recorded: Floats
    segment: NDArray[np.int64]
    speed: Floats
    curvature: Floats
    predicted_speed: Floats
    least_curvature: float
    straight_share: float
    draws: int
    rejected: Mapping[str, int]

    @property
    def duration_s(self) -> float:
        """Duration of the whole, which may end within a sample after the last."""
        return float(self.durations_s.sum())


@dataclass(frozen=True, kw_only=True)
class LeftOut:
    """A trajectory without ground truth: the reason, and what its draws were rejected for."""

    reason: str
    draws: int = 0
    rejected: Mapping[str, int] = field(default_factory=dict)


def warp_to_power_law(
    positions: Floats,
    rate_hz: float,
    rng: np.random.Generator | int,
    settings: WarpSettings | None = None,
) -> GroundTruth | LeftOut:
    """Give a recorded path the timing of random power laws (section 2.4).

    positions: (F, L), L = 2 or 3, low-passed, without gaps, any unit of length.
    rng: a random generator (`signkin.seeds.stream`), or a seed.
    Returns the ground truth, or why there is none. Raises SignkinError for gaps, a path of one
    point or less than 6 frames.
    """
    settings = settings or WarpSettings()
    rng = np.random.default_rng(rng)
    x = _checked(positions, rate_hz)
    active = active_part(speed(x, rate_hz), settings.active_share)
    frames = active.stop - active.start
    duration = (frames - 1) / rate_hz
    spare = duration - settings.segments * (settings.least_segment_s + 1 / NODES_HZ)
    if spare <= 0 or frames < FEWEST_FRAMES:
        return LeftOut(
            reason=f"the active part of {duration:.3f} s has no room for {settings.segments} "
            f"segments of more than {settings.least_segment_s:g} s"
        )
    path = _Path(x[active], rate_hz, settings)
    rejected = dict.fromkeys(REASONS, 0)
    for first in range(0, settings.most_draws, BLOCK):
        draws = _draw(path, spare, min(BLOCK, settings.most_draws - first), rng, settings)
        for i, reason in enumerate(draws.rejected):
            reason = reason or _clearly(path, draws, i, settings)
            found: GroundTruth | _Timing | str = reason or _timing(path, draws, i, settings)
            if isinstance(found, _Timing):
                found = _sampled(path, found, active, rate_hz, settings)
            if isinstance(found, GroundTruth):
                return replace(found, draws=first + i + 1, rejected=_some(rejected))
            rejected[str(found)] += 1
    return LeftOut(
        reason=f"none of {settings.most_draws} draws was accepted",
        draws=settings.most_draws,
        rejected=_some(rejected),
    )


def _some(counts: dict[str, int]) -> dict[str, int]:
    return {reason: n for reason, n in counts.items() if n}


class _Path:
    """A recorded path as a smooth curve: nodes in time with speed and curvature at each."""

    def __init__(self, x: Floats, rate_hz: float, settings: WarpSettings) -> None:
        frames = np.arange(len(x)) / rate_hz
        self.curve = make_interp_spline(frames, x, k=5)
        first, second = self.curve.derivative(1), self.curve.derivative(2)
        per_frame = int(np.ceil(NODES_HZ / rate_hz))
        time_s = np.linspace(0, frames[-1], per_frame * (len(x) - 1) + 1)
        v, k = _speed_curvature(first, second, time_s)
        length = float(np.sum((v[1:] + v[:-1]) * np.diff(time_s)) / 2)
        self.least_curvature = settings.straight_turn_rad / length
        for _ in range(HALVINGS):
            # Sharp bends taken slowly are passed within milliseconds.
            log_k = np.log(np.maximum(k, self.least_curvature))
            coarse = np.flatnonzero(np.abs(np.diff(log_k)) > LOG_STEP)
            if not len(coarse):
                break
            between = (time_s[coarse] + time_s[coarse + 1]) / 2
            v_new, k_new = _speed_curvature(first, second, between)
            time_s = np.insert(time_s, coarse + 1, between)
            v, k = np.insert(v, coarse + 1, v_new), np.insert(k, coarse + 1, k_new)
        self.time_s, self.speed = time_s, v
        self.log_k = np.log(np.maximum(k, self.least_curvature))
        self.steps = np.diff(time_s)
        straight = np.where(k < self.least_curvature, v, 0.0)
        self.straight_share = (
            float(np.sum((straight[1:] + straight[:-1]) * self.steps) / 2) / length
        )
        self.least_log_k = _Least(self.log_k)
        self.least_minus_log_k = _Least(-self.log_k)
        self.least_minus_speed = _Least(-self.speed)


class _Least:
    """Least value of any stretch of an array, many stretches at once (a sparse table)."""

    def __init__(self, values: Floats) -> None:
        levels = [values]
        while 2 ** len(levels) <= len(values):
            half = 2 ** (len(levels) - 1)
            row = levels[-1].copy()
            row[:-half] = np.minimum(row[:-half], row[half:])
            levels.append(row)
        self.table = np.array(levels)

    def __call__(self, first: NDArray[np.int64], last: NDArray[np.int64]) -> Floats:
        """Return the least of values[first..last], last included, for each pair."""
        level = np.frexp(last - first + 1)[1] - 1
        return np.minimum(self.table[level, first], self.table[level, last + 1 - 2**level])


def _speed_curvature(first: BSpline, second: BSpline, time_s: Floats) -> tuple[Floats, Floats]:
    """Return speed and curvature of a curve; where it stands still, the curvature beside."""
    d1, d2 = first(time_s), second(time_s)
    v = np.linalg.norm(d1, axis=1)
    if d1.shape[1] == 2:
        cross = np.abs(d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0])
    else:
        cross = np.linalg.norm(np.cross(d1, d2), axis=1)
    moving = v > 1e-9 * v.max()
    k = np.empty_like(v)
    k[moving] = cross[moving] / v[moving] ** 3
    if not moving.all():
        k[~moving] = np.interp(time_s[~moving], time_s[moving], k[moving])
    return v, k


@dataclass(frozen=True, eq=False)
class _Draws:
    """Draws of boundaries and exponents, D of them, and what can be said before any warping.

    nodes: (D, N + 1), at which segments begin and end. beta: (D, N). log_gain: (D, N), log of
    alpha if the first were 1, by continuity. log_top: (D, N), log of the top speeds then.
    top_recorded: (D, N). rejected: a reason or an empty string each.
    """

    nodes: NDArray[np.int64]
    beta: Floats
    log_gain: Floats
    log_top: Floats
    top_recorded: Floats
    rejected: list[str]


@dataclass(frozen=True, eq=False)
class _Timing:
    """A draw with the warped time of every node, from 0."""

    nodes: NDArray[np.int64]
    laws: tuple[PowerLaw, ...]
    tau_s: Floats
    durations_s: Floats
    durations_recorded_s: Floats
    top_speeds: Floats
    top_speeds_recorded: Floats


def _draw(path: _Path, spare: float, n: int, rng: np.random.Generator, s: WarpSettings) -> _Draws:
    """Draw n sets of boundaries and exponents.

    Boundaries are uniform over all partitions whose segments are longer than the least: the
    order of uniform cuts of the time to spare.
    """
    cuts = np.sort(rng.uniform(0, spare, (n, s.segments - 1)), axis=1)
    beta = rng.uniform(s.least_exponent, s.most_exponent, (n, s.segments))
    alike = (np.abs(np.diff(beta)) <= s.least_exponent_step).any(axis=1)
    least = s.least_segment_s + 1 / NODES_HZ  # boundaries are moved to the next node
    inner = np.searchsorted(path.time_s, cuts + least * np.arange(1, s.segments))
    nodes = np.pad(inner, ((0, 0), (1, 1)))
    nodes[:, -1] = len(path.time_s) - 1
    log_gain = np.zeros((n, s.segments))
    log_gain[:, 1:] = np.cumsum(path.log_k[inner] * (beta[:, :-1] - beta[:, 1:]), axis=1)
    first, last = nodes[:, :-1], nodes[:, 1:]
    # The law is fastest where the curvature is least (or, with beta above 0, greatest).
    straightest, sharpest = path.least_log_k(first, last), -path.least_minus_log_k(first, last)
    log_top = log_gain + np.maximum(beta * straightest, beta * sharpest)
    top_recorded = -path.least_minus_speed(first, last)
    # Whatever the first gain, the segments' ratios to the recorded speeds keep their spread.
    spread = np.ptp(log_top - np.log(top_recorded), axis=1)
    hopeless = spread > 2 * np.log(s.most_speed_ratio)
    rejected = np.where(alike, EXPONENTS, np.where(hopeless, SPEED, ""))
    return _Draws(nodes, beta, log_gain, log_top, top_recorded, rejected.tolist())


def _clearly(path: _Path, draws: _Draws, i: int, s: WarpSettings) -> str:
    """Return why draw i is clearly rejected; empty where `_timing` has to tell."""
    from signkin.powerlaw import screening  # numba, half a second for those who only fit laws

    found = screening.verdict(
        draws.nodes[i], draws.beta[i], draws.log_gain[i], draws.log_top[i], draws.top_recorded[i],
        path.speed, path.log_k, path.time_s, s.first_gain == "duration",
        float(s.most_speed_ratio), float(s.least_segment_s), float(s.most_duration_ratio),
    )  # fmt: skip
    return CLEAR[found]


def _timing(path: _Path, draws: _Draws, i: int, s: WarpSettings) -> _Timing | str:
    """Warp time as draw i wants it (2.4: d tau / dt = v kappa^-beta / alpha), or reject it."""
    nodes, beta, log_gain = draws.nodes[i], draws.beta[i], draws.log_gain[i]
    parts = list(pairwise(nodes))
    slowness, durations = [], np.empty(len(parts))
    for j, (a, b) in enumerate(parts):
        rate = path.speed[a : b + 1] * np.exp(-beta[j] * path.log_k[a : b + 1] - log_gain[j])
        slowness.append(rate)
        durations[j] = (rate[1:] @ path.steps[a:b] + rate[:-1] @ path.steps[a:b]) / 2
    if s.first_gain == "duration":
        gain = float(durations.sum()) / path.time_s[-1]
    else:
        gain = path.speed[0] * np.exp(-beta[0] * path.log_k[0])
    durations /= gain
    recorded = np.diff(path.time_s[nodes])
    tops = gain * np.exp(draws.log_top[i])
    if _beyond(tops / draws.top_recorded[i], s.most_speed_ratio):
        return SPEED
    if (durations <= s.least_segment_s).any():
        return SHORT
    if _beyond(durations / recorded, s.most_duration_ratio):
        return DURATION
    steps = [
        (r[1:] + r[:-1]) / 2 * path.steps[a:b] for r, (a, b) in zip(slowness, parts, strict=True)
    ]
    tau = np.concatenate([[0.0], np.cumsum(np.concatenate(steps))]) / gain
    alpha = gain * np.exp(log_gain)
    laws = tuple(PowerLaw(float(a), float(b)) for a, b in zip(alpha, beta, strict=True))
    return _Timing(nodes, laws, tau, durations, recorded, tops, draws.top_recorded[i])


def _beyond(ratio: Floats, most: float) -> bool:
    return bool((ratio > most).any() or (ratio * most < 1).any())


def _sampled(
    path: _Path, timing: _Timing, active: slice, rate_hz: float, s: WarpSettings
) -> GroundTruth | str:
    """Sample the warped motion and fit the laws again; the reason where they are not found."""
    rate = rate_hz if s.output_rate_hz is None else s.output_rate_hz
    samples = int(np.floor(timing.tau_s[-1] * rate + 1e-9)) + 1
    time_s = np.arange(samples) / rate
    # Where the recorded hand stood still, warped time does too: one node of each such instant.
    ahead = np.concatenate([[True], np.diff(timing.tau_s) > 0])
    back = PchipInterpolator(timing.tau_s[ahead], path.time_s[ahead])
    recorded_s = back(np.minimum(time_s, timing.tau_s[-1]))
    positions = np.asarray(path.curve(recorded_s))
    v = speed(positions, rate)
    k = curvature(positions)
    boundaries = timing.tau_s[timing.nodes[1:-1]]
    segment = np.searchsorted(boundaries, time_s, side="right")
    predicted = np.full(samples, np.nan)
    fitted = []
    for i in range(s.segments):
        here = (segment == i) & np.isfinite(k)
        try:
            law = fit_power_law(v[here], k[here])
        except SignkinError:
            return NOT_FOUND
        if not law.r_squared >= s.least_r_squared:
            return NOT_FOUND
        predicted[here] = law.speed(k[here])
        fitted.append(law)
    inner = timing.nodes[1:-1]
    return GroundTruth(
        positions=positions,
        rate_hz=rate,
        time_s=time_s,
        boundaries_s=boundaries,
        boundary_positions=np.asarray(path.curve(path.time_s[inner])),
        boundaries_recorded_s=path.time_s[inner] + active.start / rate_hz,
        active=active,
        drawn=timing.laws,
        fitted=tuple(fitted),
        durations_s=timing.durations_s,
        durations_recorded_s=timing.durations_recorded_s,
        top_speeds=timing.top_speeds,
        top_speeds_recorded=timing.top_speeds_recorded,
        segment=segment,
        speed=v,
        curvature=k,
        predicted_speed=predicted,
        least_curvature=path.least_curvature,
        straight_share=path.straight_share,
        draws=0,
        rejected={},
    )


def _checked(positions: Floats, rate_hz: float) -> Floats:
    x = np.asarray(positions, dtype=float)
    if x.ndim != 2 or x.shape[1] not in (2, 3) or len(x) < FEWEST_FRAMES:
        raise _error(f"positions of shape {x.shape}", f"(F, 2) or (F, 3), F from {FEWEST_FRAMES}")
    gaps = int(np.count_nonzero(~np.isfinite(x).all(axis=1)))
    if gaps:
        raise _error(f"{gaps} of {len(x)} frames without a position", "a path without gaps")
    if not rate_hz > 0:
        raise _error(f"a rate of {rate_hz:g} Hz", "above 0")
    if (x == x[0]).all():
        raise _error("all positions are one point", "a path")
    return x


def _error(found: str, expected: str) -> SignkinError:
    return SignkinError(found, place="warp_to_power_law", expected=expected)
