"""Several ways of finding boundaries, scored against the same tags over many recordings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.segments.boundaries import boundary_hits, offsets_s
from signkin.segments.frames import RATE_HZ
from signkin.segments.gamma import DISORDER, disorder, gamma_of
from signkin.segments.scores import (
    COLUMNS,
    Key,
    interval_of,
    of_frames,
    of_hits,
    of_segments,
    shuffled,
)

Floats = NDArray[np.float64]
TOLERANCES_S = (0.05, 0.1)
MARGIN_S = 0.4  # before the first and after the last tag of a recording


@dataclass(frozen=True, eq=False)
class Part:
    """What was found in one recording, and its tags.

    found: segments (N, 2) with starts and ends, or times of boundaries (N,), s. reference: (M, 2).
    """

    found: Floats
    reference: Floats

    @cached_property
    def span_s(self) -> tuple[float, float]:
        """Return the time that counts: about the tags."""
        return float(self.reference.min() - MARGIN_S), float(self.reference.max() + MARGIN_S)


def score_methods(
    parts: Sequence[Part], draws: int, rng: np.random.Generator, *, gamma: bool = False
) -> pd.DataFrame:
    """Score what was found in several recordings, all on one clock; columns as `score` has them.

    Recordings stand one behind the other, so each counts by what is in it. Times of boundaries
    are scored by how near they lie to any edge; segments by what they enclose, too. Chance: the
    same gaps and lengths in another order within each recording. Parts without a tag are left out.
    gamma: told, too, of segments (it takes longer than all others together).
    """
    kept = [_within(part) for part in parts if len(part.reference)]
    if not kept:
        return pd.DataFrame(columns=COLUMNS)
    found = _scores(kept, lambda part: part.found, gamma)
    drawn = [_scores(kept, lambda part: _in_another_order(part, rng), gamma) for _ in range(draws)]
    if gamma:
        found, drawn = gamma_of(found, drawn)
    rows = [
        [*key[:2], value, key[2], *interval_of(np.array([d[key] for d in drawn]))]
        for key, value in found.items()
    ]
    return pd.DataFrame(rows, columns=COLUMNS)


def _within(part: Part) -> Part:
    """Return the part with what lies within its span."""
    low, high = part.span_s
    if part.found.ndim == 1:
        return Part(part.found[(part.found >= low) & (part.found <= high)], part.reference)
    clipped = np.clip(part.found, low, high)
    return Part(clipped[clipped[:, 1] > clipped[:, 0]], part.reference)


def _in_another_order(part: Part, rng: np.random.Generator) -> Floats:
    if not len(part.found):
        return part.found
    if part.found.ndim == 2:
        return shuffled(part.found, part.span_s, rng)
    low, high = part.span_s
    gaps = np.diff(np.concatenate([[low], np.sort(part.found), [high]]))
    return np.asarray(low + np.cumsum(rng.permutation(gaps))[:-1])


def _scores(parts: Sequence[Part], of: Callable[[Part], Floats], gamma: bool) -> dict[Key, float]:
    clock, found, reference = 0.0, [], []
    for part in parts:
        low, high = part.span_s
        found.append(of(part) + (clock - low))
        reference.append(part.reference + (clock - low))
        clock += high - low
    a, b = np.concatenate(found), np.concatenate(reference)
    out = _of_boundaries(np.unique(a), np.unique(b))
    if a.ndim == 1:
        return out
    if gamma:
        out[DISORDER] = disorder(a, b)
    span = (0.0, clock)
    return out | of_frames(a, b, span) | of_segments(a, b, span, RATE_HZ)


def _of_boundaries(a: Floats, b: Floats) -> dict[Key, float]:
    out: dict[Key, float] = {}
    for tolerance in TOLERANCES_S:
        out |= of_hits(boundary_hits(a, b, tolerance), f"any edge, {tolerance:g} s")
    away = np.abs(offsets_s(a, b))
    out["median offset, absolute", "any edge", "s"] = float(np.median(away))
    out["boundaries, share of the tags'", "any edge", ""] = len(a) / len(b)
    return out
