"""Each captured transition made anew by each method (Naert et al. 2017, section 5.2, Fig. 12)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from signkin import tables
from signkin.coarticulation.retrieval import Scale, best_chain, distances
from signkin.coarticulation.synthesis import (
    METHODS,
    Sign,
    Transition,
    steps_of,
)
from signkin.joints import wrists_of
from signkin.settings.sections import Kinematics
from signkin.stages.ingest import lead
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.database import Array, Database, Pair
from signkin.studies.naert2017.synthesis.duration_models import captured, groups_of, predictions
from signkin.studies.naert2017.synthesis.joining import joined
from signkin.studies.naert2017.synthesis.measures import (
    Measures,
    aligned_errors,
    least_depth,
    measures,
)

TRUE = "true"
OWN, OTHER = "own", "other"
# Methods that differ by rounding alone are to count as equal.
DECIMALS = 12
_MEASURED = (
    "error_{u}", "wrist_error_{u}", "peak_speed_{u}_per_s", "true_peak_speed_{u}_per_s",
    "rms_jerk_{u}_per_s3", "true_rms_jerk_{u}_per_s3", "minima", "true_minima", "extra_minima",
    "overrun_s", "idle_frames",
)  # fmt: skip


def comparison(base: Database, settings: SynthesisSettings) -> pd.DataFrame:
    """Return the table `synthesis`: each captured transition made anew by each method."""
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
    depth = {name: least_depth(take, settings.kinematics) for name, take in base.recordings.items()}
    rows = []
    for material, tokens in chosen.items():
        stand_ins = [t or p for t, p in zip(tokens, own, strict=True)]
        asked = base.features([a for a, _ in stand_ins], [b for _, b in stand_ins])
        predicted = predictions(known, groups, asked, settings.durations)
        for i, (pair, ends) in enumerate(zip(pairs, tokens, strict=True)):
            if ends is None:
                continue
            durations = {model: float(values[i]) for model, values in predicted.items()}
            durations[TRUE] = pair.true_s
            least = depth[base.tokens[pair.first].sign.recording.name]
            rows += _rows(base, pair, ends, material, durations, least, settings)
    return pd.DataFrame(rows)[tables.TABLES["synthesis"].names(base.corpus.unit)]


def in_true_time(base: Database, settings: SynthesisSettings, most: int) -> pd.DataFrame:
    """Return rows of `synthesis` of so many transitions at most: of themselves, in true time."""
    pairs = base.pairs()
    if len(pairs) > most:
        pairs = [pairs[i] for i in np.linspace(0, len(pairs) - 1, most).round().astype(int)]
    depth = {name: least_depth(take, settings.kinematics) for name, take in base.recordings.items()}
    rows = [
        row
        for pair in pairs
        for row in _rows(
            base, pair, (pair.first, pair.second), OWN, {TRUE: pair.true_s},
            depth[base.tokens[pair.first].sign.recording.name], settings,
        )
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=tables.TABLES["synthesis"].names(base.corpus.unit))


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


@dataclass(frozen=True, eq=False)
class _Captured:
    """A captured transition.

    signs: around it. postures: (n + 1, J, 3), from the first sign's last to the second's first.
    measures: None where no time lies between the tags.
    """

    signs: tuple[Sign, Sign]
    postures: Array
    measures: Measures | None

    @classmethod
    def of(cls, base: Database, pair: Pair, depth: float, kinematic: Kinematics) -> _Captured:
        first, second = (base.tokens[i].sign for i in (pair.first, pair.second))
        take = first.recording
        postures = take.positions[first.last : second.first + 1]
        got = None
        if len(postures) > 1:
            got = measures(take, first.last, postures, take, second.first, kinematic, depth)
        return cls((first, second), postures, got)


def _rows(
    base: Database,
    pair: Pair,
    ends: tuple[int, int],
    material: str,
    durations: Mapping[str, float],
    depth: float,
    settings: SynthesisSettings,
) -> list[dict[str, Any]]:
    """Return the rows of one captured transition, made of two signs: a model and method each.

    durations: model -> s, NaN where it has none. depth: least one of a minimum of speed.
    """
    unit = base.corpus.unit
    captured_one = _Captured.of(base, pair, depth, settings.kinematics)
    take = captured_one.signs[0].recording
    first, second = (base.tokens[i].sign for i in ends)
    gap_s = _room(base, ends)
    rows = []
    made_before: dict[tuple[str, int], tuple[Transition, Measures]] = {}
    for model, wanted in durations.items():
        for method in METHODS:
            row: dict[str, Any] = {
                **lead(base.corpus, take.name),
                "transition": pair.transition,
                "previous_gloss": captured_one.signs[0].gloss,
                "next_gloss": captured_one.signs[1].gloss,
                "material": material,
                "method": method,
                "duration_model": model,
                "true_s": pair.true_s,
                "duration_s": wanted,
                "duration_error_s": wanted - pair.true_s,
                **{name.format(u=unit): np.nan for name in _MEASURED},
                "note": "the model has no duration for these signs",
            }
            rows.append(row)
            if not np.isfinite(wanted):
                continue
            shown, notes = _at_least_a_frame(wanted, model, take.rate_hz)
            key = (method, steps_of(shown, take.rate_hz))
            if key not in made_before:
                made_before[key] = _made(method, first, second, shown, depth, settings)
            made, got = made_before[key]
            row |= _measured(made, got, unit)
            errors, more = _errors(captured_one, made, got, unit)
            row |= errors
            notes += [*made.notes, *more]
            if method == "blending":
                row["overrun_s"] = max(0.0, shown - gap_s)
                if material == OWN and model == TRUE:
                    notes.append("the captured motion itself")
            row["note"] = "; ".join(notes)
    return rows


def _at_least_a_frame(wanted_s: float, model: str, rate_hz: float) -> tuple[float, list[str]]:
    """Return the duration made, and what is to be told where it is not the one wanted."""
    shown = max(wanted_s, 1.0 / rate_hz)
    if shown <= wanted_s:
        return shown, []
    why = "no time between the tags" if model == TRUE else "predicted under one frame"
    return shown, [f"{why}: one frame step made"]


def _measured(made: Transition, got: Measures, unit: str) -> dict[str, Any]:
    return {
        f"peak_speed_{unit}_per_s": got.peak_speed,
        f"rms_jerk_{unit}_per_s3": got.rms_jerk,
        "minima": got.minima,
        "idle_frames": made.idle,
    }


def _errors(
    true: _Captured, made: Transition, got: Measures, unit: str
) -> tuple[dict[str, Any], list[str]]:
    """Return how a transition differs from the captured one, and notes on what has no value."""
    if true.measures is None:
        return {}, ["zero length: nothing captured to compare with"]
    out = {
        f"true_peak_speed_{unit}_per_s": true.measures.peak_speed,
        f"true_rms_jerk_{unit}_per_s3": true.measures.rms_jerk,
        "true_minima": true.measures.minima,
        "extra_minima": got.minima - true.measures.minima,
    }
    notes = []
    if len(true.postures) < 3:
        notes.append("no frame between the tags: no position error")
    else:
        take = true.signs[0].recording
        wrists = [take.index(wrist) for wrist in wrists_of(take.joints)]
        errors = aligned_errors(made.motion.positions, true.postures)
        out[f"error_{unit}"] = round(_mean(errors), DECIMALS)
        out[f"wrist_error_{unit}"] = round(_mean(errors[:, wrists]), DECIMALS)
    if np.isnan(true.measures.peak_speed) or np.isnan(got.peak_speed):
        notes.append("gaps at a wrist: no speed")
    return out, notes


def _made(
    method: str,
    first: Sign,
    second: Sign,
    duration_s: float,
    depth: float,
    settings: SynthesisSettings,
) -> tuple[Transition, Measures]:
    made = joined((first, second), duration_s, method, settings.synthesis)
    got = measures(
        first.recording,
        first.last,
        made.motion.positions,
        second.recording,
        second.first,
        settings.kinematics,
        depth,
    )
    return made, got


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


def _mean(values: Array) -> float:
    there = values[np.isfinite(values)]
    return float(there.mean()) if len(there) else float("nan")
