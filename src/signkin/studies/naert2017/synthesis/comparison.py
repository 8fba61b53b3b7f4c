"""Synthetic transitions against the captured ones (Naert et al. 2017, section 5.2, Fig. 12)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import seeds, tables
from signkin.annotation import Interval
from signkin.coarticulation import duration
from signkin.coarticulation.duration import DurationModel, Transitions
from signkin.coarticulation.posture import euclidean_distance, geodesic_distance
from signkin.coarticulation.retrieval import Candidates, Scale, best_chain, distances
from signkin.coarticulation.sign_speeds import sign_speeds
from signkin.coarticulation.synthesis import (
    METHODS,
    Sign,
    Transition,
    blend,
    interpolate,
    steps_of,
)
from signkin.coarticulation.transitions import SAME_INSTANT_S
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.joints import HANDS
from signkin.kinematics.filters import lowpass
from signkin.kinematics.minima import minima_with_depth
from signkin.kinematics.rotations import parent_relative
from signkin.recording import Recording
from signkin.stages.ingest import lead
from signkin.studies.naert2017.coarticulation import (
    filled_recording,
    intervals_of,
    smoothed,
    utterances_of,
)
from signkin.studies.naert2017.synthesis.stock import Place, placed

MODELS = ("simple", "simple_bounded", "linear", "surface")
TRUE = "true"
OWN, OTHER = "own", "other"
DURATION_ERROR = "duration error"
# Methods that differ by rounding alone are to count as equal.
DECIMALS = 12
CONTEXT_S = 0.5  # of the signs around a transition, for filter and minima
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Token:
    """A sign of the database: where it stands, its motion, the utterance it belongs to."""

    sign: Sign
    number: int
    utterance: str


@dataclass(frozen=True, eq=False)
class Pair:
    """Two consecutive signs of one utterance, with the captured transition between them."""

    first: int
    second: int
    transition: int
    true_s: float


@dataclass(frozen=True, eq=False)
class Database:
    """The signs of a corpus and what their postures tell.

    tokens: in order of recording and time. geodesic_turns: recording -> orientations that the
    geodesic distance takes (world or parent), or None. lowpass, angle: of the signs' speeds
    (eq. 3): config's kinematics.lowpass, and 1 for half the angle, 2 for the full one.
    """

    corpus: Corpus
    recordings: Mapping[str, Recording]
    tokens: tuple[Token, ...]
    turns: Mapping[str, Array | None]
    euclidean_unit: float
    lowpass: Mapping[str, Any]
    angle: float

    def candidates(self, chosen: Sequence[int]) -> Candidates:
        """Return first and last postures of some tokens."""
        firsts, lasts, first_turns, last_turns = [], [], [], []
        for index in chosen:
            sign = self.tokens[index].sign
            firsts.append(sign.recording.positions[sign.first])
            lasts.append(sign.recording.positions[sign.last])
            turns = self.turns[sign.recording.name]
            if turns is not None:
                first_turns.append(turns[sign.first])
                last_turns.append(turns[sign.last])
        whole = len(first_turns) == len(chosen)
        return Candidates(
            first=np.array(firsts),
            last=np.array(lasts),
            first_turns=np.array(first_turns) if whole else None,
            last_turns=np.array(last_turns) if whole else None,
        )

    def glosses(self) -> dict[str, list[int]]:
        """Return the tokens of each gloss."""
        out: dict[str, list[int]] = {}
        for index, token in enumerate(self.tokens):
            out.setdefault(token.sign.gloss, []).append(index)
        return out

    def pairs(self) -> list[Pair]:
        """Return consecutive signs of one utterance, overlapping ones left out."""
        out: list[Pair] = []
        counts: dict[str, int] = {}
        for i, (a, b) in enumerate(zip(self.tokens, self.tokens[1:], strict=False)):
            name = a.sign.recording.name
            if name != b.sign.recording.name or not a.utterance or a.utterance != b.utterance:
                continue
            counts[name] = counts.get(name, 0) + 1
            true_s = b.sign.start_s - a.sign.end_s
            if true_s > -SAME_INSTANT_S:
                out.append(Pair(i, i + 1, counts[name], max(0.0, round(true_s, 9))))
        return out

    def features(self, first: Sequence[int], second: Sequence[int]) -> Transitions:
        """Return what the duration models want to know of pairs of tokens (no duration)."""
        a, b = self.candidates(first), self.candidates(second)
        geodesic = np.full(len(first), np.nan)
        if a.last_turns is not None and b.first_turns is not None:
            geodesic = geodesic_distance(a.last_turns, b.first_turns)
        speeds = np.array(
            [[self.speeds(i), self.speeds(j)] for i, j in zip(first, second, strict=True)]
        )
        speeds = speeds.reshape(-1, 2, 2)
        return Transitions(
            geodesic=geodesic,
            euclidean=euclidean_distance(a.last, b.first) / self.euclidean_unit,
            duration_s=np.full(len(first), np.nan),
            linear_speed=speeds[..., 0] / self.euclidean_unit,
            angular_speed=speeds[..., 1],
        )

    @cache  # noqa: B019 - a database lives as long as its job
    def speeds(self, token: int) -> tuple[float, float]:
        """Return the mean linear and angular speed of a sign (eq. 3), motion low-passed."""
        sign = self.tokens[token].sign
        take = sign.recording
        interval = Interval(sign.start_s, sign.end_s, sign.gloss, "")
        linear, angular = sign_speeds(*self._smooth(take.name), [interval], take)[0]
        return float(linear), float(angular) * self.angle

    @cache  # noqa: B019
    def _smooth(self, take: str) -> tuple[Array, Array | None]:
        return smoothed(self.recordings[take], self.turns[take], self.lowpass)


def _mean(values: Array) -> float:
    there = values[np.isfinite(values)]
    return float(there.mean()) if len(there) else float("nan")


def database(
    corpus: Corpus,
    recordings: Iterable[Recording],
    intervals: pd.DataFrame,
    settings: Mapping[str, Any],
) -> Database:
    """Gather the tagged signs of a corpus; short gaps filled, all takes at one place.

    settings: config.yaml (kinematics, transitions, durations, synthesis).
    """
    takes: dict[str, Recording] = {}
    tokens: list[Token] = []
    for recording in recordings:
        filled = filled_recording(recording, settings["kinematics"]["longest_gap_s"])
        if settings["synthesis"]["align_takes"] and takes:
            filled = placed(filled, Place.of(next(iter(takes.values()))))
        takes[filled.name] = filled
        signs = intervals_of(intervals, filled.name, "sign")
        names = utterances_of(corpus, intervals, filled.name, signs) if signs else []
        tokens += [
            Token(Sign(recording=filled, gloss=s.label, start_s=s.start_s, end_s=s.end_s), n, name)
            for n, (s, name) in enumerate(zip(signs, names, strict=True), start=1)
        ]
    return of_tokens(corpus, takes, tokens, settings)


def of_tokens(
    corpus: Corpus,
    takes: Mapping[str, Recording],
    tokens: Sequence[Token],
    settings: Mapping[str, Any],
) -> Database:
    """Return the database of signs that are known already."""
    unit = settings["transitions"]["euclidean_unit_m"] if corpus.unit == "m" else 1.0
    relative = settings["transitions"]["geodesic_frame"] == "parent"
    turns = {
        name: parent_relative(take) if relative and take.orientations is not None
        else take.orientations
        for name, take in takes.items()
    }  # fmt: skip
    angle = 1.0 if settings["durations"]["simple_angle"] == "half" else 2.0
    lowpass_settings = settings["kinematics"]["lowpass"]
    return Database(corpus, takes, tuple(tokens), turns, unit, lowpass_settings, angle)


# --- durations -------------------------------------------------------------------------------


def maker(model: str, settings: Mapping[str, Any], geodesic: bool) -> Callable[[], DurationModel]:
    """Return what makes a duration model; settings: config's `durations`.

    geodesic: whether the corpus has this distance; without, SIMPLE is its Euclidean part alone.
    """
    alpha = settings["simple_alpha"] if geodesic else 1.0
    low, high = settings["lowest_s"], settings["highest_s"]
    makers: dict[str, Callable[[], DurationModel]] = {
        "simple": lambda: duration.SimpleDuration(alpha),
        "simple_bounded": lambda: duration.SimpleBoundedDuration(alpha, low, high),
        "linear": duration.LinearDuration,
        "surface": duration.SurfaceDuration,
    }
    return makers[model]


def usable(model: str, data: Transitions) -> NDArray[np.bool_]:
    """Return for which transitions a model has what it wants, (N,)."""
    there = np.isfinite(data.euclidean)
    geodesic = np.isfinite(data.geodesic)
    if geodesic.any() or model == "surface":
        there = there & geodesic
    if model in ("simple", "simple_bounded"):
        there = there & (data.linear_speed.sum(axis=1) > 0)
        if geodesic.any():
            there = there & (data.angular_speed.sum(axis=1) > 0)
    return np.asarray(there)


def with_durations(data: Transitions, duration_s: Array) -> Transitions:
    """Return the same transitions with their durations."""
    return Transitions(
        data.geodesic, data.euclidean, duration_s, data.linear_speed, data.angular_speed
    )


def predictions(
    known: Transitions, groups: Sequence[str], asked: Transitions, settings: Mapping[str, Any]
) -> dict[str, Array]:
    """Return what each model predicts for `asked`, (N,), having learnt from other groups.

    settings: config's `durations`. known: the captured transitions. asked: what is to be
    predicted in their place, row by row. A model that cannot be fitted or asked predicts NaN.
    """
    labels = np.array(groups)
    geodesic = bool(np.isfinite(known.geodesic).any())
    out = {}
    for model in MODELS:
        make, values = maker(model, settings, geodesic), np.full(len(known), np.nan)
        learn, ask = usable(model, known), usable(model, asked)
        for group in dict.fromkeys(groups):
            held = (labels == group) & ask
            if held.any():
                try:
                    fitted = known[(labels != group) & learn].teach(make())
                except SignkinError:
                    continue
                values[held] = asked[held].ask(fitted)
        out[model] = values
    return out


def captured(base: Database, pairs: Sequence[Pair]) -> Transitions:
    """Return captured transitions as the duration models learn from them."""
    data = base.features([p.first for p in pairs], [p.second for p in pairs])
    return with_durations(data, np.array([p.true_s for p in pairs]))


def groups_of(database: Database, pairs: Sequence[Pair]) -> list[str]:
    """Return what is left out together: recordings; single transitions of a lone recording."""
    names = [database.tokens[p.first].sign.recording.name for p in pairs]
    if len(set(names)) > 1:
        return names
    return [f"{name} {pair.transition}" for name, pair in zip(names, pairs, strict=True)]


# --- measures --------------------------------------------------------------------------------


@dataclass(frozen=True)
class Measures:
    """Kinematics of a transition, both wrists, low-passed: see the table `synthesis`."""

    peak_speed: float
    rms_jerk: float
    minima: float


def measures(
    before: Recording,
    last: int,
    between: Array,
    after: Recording,
    first: int,
    settings: Mapping[str, Any],
) -> Measures:
    """Measure a transition among the signs around it.

    between: positions (n + 1, J, 3) from posture `last` of `before` to posture `first` of
    `after`. settings: config's `kinematics`, with the least `depth` of a minimum.
    """
    path, start, end = spliced(before, last, between, after, first)
    if np.isnan(path).any() or len(path) < 5:
        return Measures(float("nan"), float("nan"), float("nan"))
    rate = before.rate_hz
    smooth = lowpass(path, rate, **settings["lowpass"])
    speed = np.linalg.norm(np.gradient(smooth, 1 / rate, axis=0), axis=-1)
    jerk = np.linalg.norm(np.diff(smooth, n=3, axis=0), axis=-1) * rate**3
    # The third difference of frames k to k + 3 belongs between k + 1 and k + 2.
    inside = jerk[max(0, start - 1) : max(start, end - 1)]
    count = 0
    for hand in range(2):
        times = minima_with_depth(
            speed[:, hand], rate, settings["depth"], settings["minima"]["spacing_s"]
        )[0]
        frames = np.rint(times * rate)
        count += int(((frames > start) & (frames < end)).sum())
    return Measures(
        peak_speed=float(speed[start : end + 1].max()),
        rms_jerk=float(np.sqrt((inside**2).mean())) if inside.size else float("nan"),
        minima=count,
    )


def spliced(
    before: Recording, last: int, between: Array, after: Recording, first: int
) -> tuple[Array, int, int]:
    """Return the wrists' paths (F, 2, 3) through a transition, and its first and last frame."""
    wrists = [before.index(f"{hand}_wrist") for hand in HANDS]
    context = round(CONTEXT_S * before.rate_hz)
    head = before.positions[max(0, last - context) : last, wrists]
    tail = after.positions[first + 1 : first + 1 + context, wrists]
    path = np.concatenate([head, between[:, wrists], tail])
    return path, len(head), len(head) + len(between) - 1


def least_depth(recording: Recording, settings: Mapping[str, Any]) -> float:
    """Return how deep a minimum must be: the share of config of the faster hand's speed."""
    wrists = [recording.index(f"{hand}_wrist") for hand in HANDS]
    smooth = lowpass(recording.positions[:, wrists], recording.rate_hz, **settings["lowpass"])
    speed = np.linalg.norm(np.gradient(smooth, 1 / recording.rate_hz, axis=0), axis=-1)
    fastest = max((float(np.nanpercentile(s, 95)) for s in speed.T if not np.isnan(s).all()),
                  default=0.0)  # fmt: skip
    return float(settings["minima"]["prominence"]) * fastest


def aligned_errors(found: Array, truth: Array) -> Array:
    """Return the distances (frames, J) of the joints between the ends, after time alignment.

    found (n + 1, J, 3), truth (m + 1, J, 3): both are run through in the same time, frame k of
    the truth is compared with the found posture at the same share of its duration.
    """
    share = np.arange(1, len(truth) - 1) / (len(truth) - 1)
    at = share * (len(found) - 1)
    low = np.minimum(at.astype(int), len(found) - 2)
    part = (at - low)[:, None, None]
    there = found[low] + part * (found[low + 1] - found[low])
    return np.asarray(np.linalg.norm(there - truth[1:-1], axis=-1))


# --- the comparison --------------------------------------------------------------------------


def comparison(base: Database, settings: Mapping[str, Any]) -> pd.DataFrame:
    """Return the table `synthesis`: each captured transition made anew by each method.

    settings: config.yaml (kinematics, transitions, durations, synthesis).
    """
    pairs = base.pairs()
    if not pairs:
        return tables.empty("synthesis", base.corpus.unit)
    groups = groups_of(base, pairs)
    own = [(p.first, p.second) for p in pairs]
    chosen: dict[str, Sequence[tuple[int, int] | None]] = {
        OWN: own,
        OTHER: substitutes(base, pairs),
    }
    known = captured(base, pairs)
    depth = {
        name: least_depth(take, settings["kinematics"]) for name, take in base.recordings.items()
    }
    rows = []
    for material, tokens in chosen.items():
        stand_ins = [t or p for t, p in zip(tokens, own, strict=True)]
        asked = base.features([a for a, _ in stand_ins], [b for _, b in stand_ins])
        predicted = predictions(known, groups, asked, settings["durations"])
        for i, (pair, ends) in enumerate(zip(pairs, tokens, strict=True)):
            if ends is None:
                continue
            durations = {model: float(values[i]) for model, values in predicted.items()}
            durations[TRUE] = pair.true_s
            kinematic = {
                **settings["kinematics"],
                "depth": depth[base.tokens[pair.first].sign.recording.name],
            }
            rows += _rows(base, pair, ends, material, durations, kinematic, settings["synthesis"])
    return pd.DataFrame(rows)[tables.TABLES["synthesis"].names(base.corpus.unit)]


def substitutes(base: Database, pairs: Sequence[Pair]) -> list[tuple[int, int] | None]:
    """Return for each transition other signs of the same two glosses, the nearest to each other.

    None where a gloss occurs only once. A synthesis from these never sees the captured
    transition, as in practice.
    """
    glosses = base.glosses()
    out: list[tuple[int, int] | None] = []
    for pair in pairs:
        slots = []
        for own in (pair.first, pair.second):
            gloss = base.tokens[own].sign.gloss
            slots.append([t for t in glosses[gloss] if t not in (pair.first, pair.second)])
        if not all(slots):
            out.append(None)
            continue
        cost = distances(base.candidates(slots[0]), base.candidates(slots[1]), Scale())
        # A sign cannot be its own neighbour, nor the pair be a captured transition in reverse.
        for i, a in enumerate(slots[0]):
            for j, b in enumerate(slots[1]):
                if a == b:
                    cost[i, j] = np.inf
        best, total = best_chain([cost])
        out.append((slots[0][best[0]], slots[1][best[1]]) if np.isfinite(total) else None)
    return out


def _rows(
    base: Database,
    pair: Pair,
    ends: tuple[int, int],
    material: str,
    durations: Mapping[str, float],
    kinematic: Mapping[str, Any],
    settings: Mapping[str, Any],
) -> list[dict[str, Any]]:
    unit = base.corpus.unit
    own = [base.tokens[i].sign for i in (pair.first, pair.second)]
    first, second = (base.tokens[i].sign for i in ends)
    take = own[0].recording
    truth = take.positions[own[0].last : own[1].first + 1]
    true = None
    if len(truth) > 1:
        true = measures(take, own[0].last, truth, take, own[1].first, kinematic)
    wrists = [take.index(f"{hand}_wrist") for hand in HANDS]
    rows = []
    made_before: dict[tuple[str, int], tuple[Transition, Measures]] = {}
    for model, wanted in durations.items():
        for method in METHODS:
            row: dict[str, Any] = {
                **lead(base.corpus, take.name),
                "transition": pair.transition,
                "previous_gloss": own[0].gloss,
                "next_gloss": own[1].gloss,
                "material": material,
                "method": method,
                "duration_model": model,
                "true_s": pair.true_s,
                "duration_s": wanted,
                "duration_error_s": wanted - pair.true_s,
            }
            rows.append(row)
            notes = []
            row["note"] = ""
            for name in _MEASURED:
                row[name.format(u=unit)] = np.nan
            if not np.isfinite(wanted):
                row["note"] = "the model has no duration for these signs"
                continue
            shown = max(wanted, 1.0 / take.rate_hz)
            if shown > wanted:
                notes.append(
                    "no time between the tags: one frame step made"
                    if model == TRUE
                    else "predicted under one frame: one frame step made"
                )
            key = (method, steps_of(shown, take.rate_hz))
            if key not in made_before:
                made_before[key] = _made(method, first, second, shown, kinematic, settings)
            made, got = made_before[key]
            notes += made.notes
            row |= {
                f"peak_speed_{unit}_per_s": got.peak_speed,
                f"rms_jerk_{unit}_per_s3": got.rms_jerk,
                "minima": got.minima,
                "idle_frames": made.idle,
            }
            if true is None:
                notes.append("zero length: nothing captured to compare with")
            else:
                row |= {
                    f"true_peak_speed_{unit}_per_s": true.peak_speed,
                    f"true_rms_jerk_{unit}_per_s3": true.rms_jerk,
                    "true_minima": true.minima,
                    "extra_minima": got.minima - true.minima,
                }
                if len(truth) < 3:
                    notes.append("no frame between the tags: no position error")
                else:
                    errors = aligned_errors(made.motion.positions, truth)
                    row[f"error_{unit}"] = round(_mean(errors), DECIMALS)
                    row[f"wrist_error_{unit}"] = round(_mean(errors[:, wrists]), DECIMALS)
                if np.isnan(true.peak_speed) or np.isnan(got.peak_speed):
                    notes.append("gaps at a wrist: no speed")
            if method == "blending":
                gap = _room(base, ends)
                row["overrun_s"] = max(0.0, shown - gap)
                if material == OWN and model == TRUE:
                    notes.append("the captured motion itself")
            row["note"] = "; ".join(notes)
    return rows


def _made(
    method: str,
    first: Sign,
    second: Sign,
    duration_s: float,
    kinematic: Mapping[str, Any],
    settings: Mapping[str, Any],
) -> tuple[Transition, Measures]:
    made = (interpolate if method == "interpolation" else blend)(
        first,
        second,
        duration_s,
        orientations=settings["orientations"],
        keep_limbs=settings["keep_limbs"],
    )
    got = measures(
        first.recording,
        first.last,
        made.motion.positions,
        second.recording,
        second.first,
        kinematic,
    )
    return made, got


_MEASURED = (
    "error_{u}", "wrist_error_{u}", "peak_speed_{u}_per_s", "true_peak_speed_{u}_per_s",
    "rms_jerk_{u}_per_s3", "true_rms_jerk_{u}_per_s3", "minima", "true_minima", "extra_minima",
    "overrun_s", "idle_frames",
)  # fmt: skip


def _room(base: Database, ends: tuple[int, int]) -> float:
    """Return how long retraction and preparation are before another sign begins or ends, in s."""
    rooms = [np.inf]
    for index, step in ((ends[0], 1), (ends[1], -1)):
        sign, beside = base.tokens[index].sign, index + step
        if 0 <= beside < len(base.tokens):
            other = base.tokens[beside].sign
            if other.recording is sign.recording:
                gap = other.start_s - sign.end_s if step == 1 else sign.start_s - other.end_s
                rooms.append(max(0.0, gap))
    return float(min(rooms))


# --- the summary -----------------------------------------------------------------------------


def error_measures(unit: str) -> dict[str, tuple[str, Callable[[pd.DataFrame], pd.Series]]]:
    """Return the measures of the summary, all the better the smaller: unit and definition."""

    def ratio(name: str) -> Callable[[pd.DataFrame], pd.Series]:
        def of(rows: pd.DataFrame) -> pd.Series:
            with np.errstate(divide="ignore", invalid="ignore"):
                value = np.log(rows[name] / rows[f"true_{name}"]).abs()
            return value.where(np.isfinite(value))

        return of

    return {
        DURATION_ERROR: ("s", lambda rows: rows["duration_error_s"].abs()),
        "position error": (unit, lambda rows: rows[f"error_{unit}"]),
        "wrist position error": (unit, lambda rows: rows[f"wrist_error_{unit}"]),
        "peak speed, |ln ratio|": ("", ratio(f"peak_speed_{unit}_per_s")),
        "jerk, |ln ratio|": ("", ratio(f"rms_jerk_{unit}_per_s3")),
        "hesitations": ("extra minima", lambda rows: rows["extra_minima"].clip(lower=0)),
    }


def summary(rows: pd.DataFrame, corpus: Corpus, draws: int, seed: int) -> pd.DataFrame:
    """Return the table `synthesis_summary`: mean errors with 95 % bootstrap intervals.

    Within one measure and material all methods are compared on the same transitions: those that
    every one of them has a value for. The transitions are resampled, the same for all methods.
    """
    names = tables.TABLES["synthesis_summary"].names()
    out = []
    for material, part in rows.groupby("material", sort=False):
        total = part.groupby(["recording", "transition"]).ngroups
        for measure, (unit, define) in error_measures(corpus.unit).items():
            values = part.assign(value=define(part).round(DECIMALS)).pivot_table(
                index=["recording", "transition"], columns=["method", "duration_model"],
                values="value", dropna=False, observed=False, sort=False,
            )  # fmt: skip
            methods = METHODS[:1] if measure == DURATION_ERROR else METHODS
            values = values.reindex(columns=pd.MultiIndex.from_product([methods, (*MODELS, TRUE)]))
            known = values.dropna(axis=1, how="all")
            complete = known.dropna()
            rng = seeds.stream(seed, corpus.name, str(material), measure, "synthesis")
            means = _bootstrap(complete.to_numpy(dtype=float), draws, rng)
            ranked = [c for c in known.columns if c[1] != TRUE] if len(complete) else []
            best = min(ranked, key=lambda c: float(complete[c].mean())) if ranked else None
            for column in values.columns:
                out.append(
                    {
                        "corpus": corpus.name,
                        "material": material,
                        "measure": measure,
                        "unit": unit,
                        "method": "either" if measure == DURATION_ERROR else column[0],
                        "duration_model": column[1],
                        "transitions": total,
                        **_summary_row(column, complete, known, means, best),
                    }
                )
    return pd.DataFrame(out, columns=names)


def _bootstrap(values: Array, draws: int, rng: np.random.Generator) -> Array:
    """Return means (draws, columns) of resampled rows."""
    if not len(values):
        return np.full((draws, values.shape[1]), np.nan)
    weights = rng.multinomial(len(values), np.full(len(values), 1 / len(values)), size=draws)
    return np.asarray(weights @ values / len(values))


def _summary_row(
    column: tuple[str, str],
    complete: pd.DataFrame,
    known: pd.DataFrame,
    means: Array,
    best: tuple[str, str] | None,
) -> dict[str, Any]:
    nan = float("nan")
    row: dict[str, Any] = {"n": 0, "mean": nan, "low": nan, "high": nan, "over_best": nan,
                           "over_best_low": nan, "over_best_high": nan, "nearest": "",
                           "note": ""}  # fmt: skip
    if column not in known.columns or best is None:
        row["note"] = "the model has no duration in this corpus" if len(known) else "no transition"
        return row
    place = known.columns.get_loc(column)
    draws = means[:, place]
    over = draws - means[:, known.columns.get_loc(best)]
    values = complete[column]
    row |= {
        "n": len(values),
        "mean": float(values.mean()),
        "low": float(np.quantile(draws, 0.025)),
        "high": float(np.quantile(draws, 0.975)),
        "over_best": float(values.mean() - complete[best].mean()),
        "over_best_low": float(np.quantile(over, 0.025)),
        "over_best_high": float(np.quantile(over, 0.975)),
    }
    if column[1] == TRUE:
        row["nearest"] = "reference"
        row["note"] = "the true duration is not known in practice: not ranked"
    elif column == best:
        row["nearest"] = "nearest"
    else:
        row["nearest"] = "as near" if row["over_best_low"] <= 0 else "farther"
    return row
