"""Does the duration rise with the distance more than for any interval (Naert et al. 2017, 5.1)?

The longer any two instants of a movement are apart, the farther apart are its postures. So r of
the transitions is set against r of random intervals: each transition's duration, placed anywhere
in its stretch of signing.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import seeds, tables
from signkin.coarticulation.posture import normalised
from signkin.statistics import nulls
from signkin.studies.naert2017.open_choices import LEAST, Take, distances_between

Floats = NDArray[np.float64]
NULL = "random intervals of the same durations"
MEASURE = "Pearson r of duration and mean distance"


def interval_chance(corpus: str, takes: Iterable[Take], draws: int, seed: int) -> pd.DataFrame:
    """Return the table `interval_chance` of a corpus; no rows where r cannot be had.

    Transitions between manual tags of the whole body; overlapping signs are left out.
    """
    durations: list[Floats] = []
    observed: list[Floats] = []  # (2, n): geodesic, Euclidean
    random: list[Floats] = []  # (draws, 2, n)
    for take in takes:
        start, end = take.manual[take.before, 1], take.manual[take.before + 1, 0]
        kept = end >= start
        start, end = start[kept], end[kept]
        if not len(start):
            continue
        rng = seeds.stream(seed, corpus, take.name, "interval_chance")
        joints = list(range(len(take.filled.joints)))
        durations.append(np.round(end - start, 9))
        observed.append(np.stack(distances_between(take.filled, take.turns, start, end, joints)))
        moved = _placed(take, start, end, draws, rng)
        flat = distances_between(
            take.filled, take.turns, moved.ravel(), (moved + (end - start)).ravel(), joints
        )
        random.append(np.stack([part.reshape(draws, -1) for part in flat], axis=1))
    rows = _row(corpus, durations, observed, random, draws) if durations else []
    return pd.DataFrame(rows, columns=tables.TABLES["interval_chance"].names())


def _placed(take: Take, start: Floats, end: Floats, draws: int, rng: np.random.Generator) -> Floats:
    """Return random starts (draws, n), on whole frames, each within the stretch it comes from."""
    rate = take.filled.rate_hz
    spans = np.array([part.span_s for part in nulls.stretches(take.manual, [], rate)])
    of = np.clip(np.searchsorted(spans[:, 0], start, side="right") - 1, 0, len(spans) - 1)
    low, high = spans[of, 0], np.maximum(spans[of, 1] - (end - start), spans[of, 0])
    frames = np.rint((high - low) * rate).astype(int) + 1
    return np.asarray(low + rng.integers(0, frames, (draws, len(start))) / rate)


def _row(
    corpus: str,
    durations: list[Floats],
    observed: list[Floats],
    random: list[Floats],
    draws: int,
) -> list[dict[str, object]]:
    time = np.concatenate(durations)
    value = _r(time, np.concatenate(observed, axis=1))
    chance = np.array([_r(time, one) for one in np.concatenate(random, axis=2)])
    about = {"corpus": corpus, "null": NULL, "measure": MEASURE, "n": len(time), "draws": draws}
    if np.isnan(value) or np.isnan(chance).any():
        return [{**about, "note": "too few transitions, or no spread: no correlation"}]
    low, high = np.quantile(chance, [0.025, 0.975], method="nearest")
    p = (1 + int((chance >= value - 1e-12).sum())) / (1 + draws)
    return [{**about, "value": value, "chance": chance.mean(), "chance_low": low,
             "chance_high": high, "p": p, "note": ""}]  # fmt: skip


def _r(durations: Floats, distances: Floats) -> float:
    """Return r of durations (n,) and the mean of both distances (2, n), each over its range."""
    both = np.stack([normalised(row) for row in distances])
    known = ~np.isnan(both)
    there = known.any(axis=0)
    mean = np.where(known, both, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    x, y = mean[there], durations[there]
    if len(x) < LEAST or not np.ptp(x) or not np.ptp(y):
        return float("nan")
    return float(np.corrcoef(x, y)[0, 1])
