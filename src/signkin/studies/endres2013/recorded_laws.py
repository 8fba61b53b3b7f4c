"""Power laws fitted to recorded movement, segment by segment as binning cuts it (section 2.3).

Beside them stands what the same filter, rate and noise make of known exponents, and of noise
alone: an exponent, and a high correlation, come out there, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
from numpy.typing import NDArray

from signkin import seeds, tables
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.io.store import read_recordings
from signkin.kinematics.curvature import curvature
from signkin.kinematics.derivatives import speed
from signkin.kinematics.filters import lowpass
from signkin.powerlaw.estimates import (
    BOTH_ERRORS,
    ESTIMATORS,
    LOGARITHMS,
    NON_LINEAR,
    Filter,
    estimates,
    noise_gains,
    pitfalls,
)
from signkin.stages.ingest import lead
from signkin.studies.endres2013.posteriors import chosen
from signkin.studies.endres2013.settings import CutSettings
from signkin.studies.endres2013.single_signs import RECORDED, Movement, movement_of

Floats = NDArray[np.float64]
ORDER = 3
FEWEST = 8  # samples of a segment that an exponent is told from
COLUMNS = {NON_LINEAR: "beta", LOGARITHMS: "log_beta", BOTH_ERRORS: "both_beta"}
# The law of ellipses, none, and twice as far on; a turn as long as a stroke, and as a sign.
BETAS = (0.0, -1 / 3, -1 / 2)
DURATIONS_S = (0.4, 0.8, 1.6)
DRAWS = 60


def recorded_laws(
    corpus: Corpus, paths: Iterable[str | Path], posteriors: Iterable[str | Path],
    settings: CutSettings, most: int,
) -> pd.DataFrame:  # fmt: skip
    """Return the table `recorded_laws`: a law for each segment of at most so many recordings.

    paths: recordings of all shards. posteriors: files of `write_posteriors`.
    """
    cuts = _boundaries(posteriors)
    names = chosen(list(cuts), most)
    rows: list[dict[str, Any]] = []
    for path in paths:
        for recording in read_recordings(Path(path), names):
            movement = movement_of(recording, settings)
            gains = noise_gains(_filter(settings, movement.wrist.rate_hz), movement.wrist.rate_hz)
            start = {**lead(corpus, recording.name), "sign": corpus.by_name[recording.name].sign}
            found = _segments(movement, cuts[recording.name], corpus.noise_sd, gains)
            rows += [{**start, **row} for row in found]
    return pd.DataFrame(rows, columns=tables.TABLES["recorded_laws"].names())


def _boundaries(posteriors: Iterable[str | Path]) -> dict[str, Floats]:
    wanted = [("dataset", "=", RECORDED), ("order", "=", ORDER)]
    out = {}
    for path in posteriors:
        part = pq.read_table(path, columns=["recording", "boundaries_s"], filters=wanted)
        for row in part.to_pylist():
            out[row["recording"]] = np.asarray(row["boundaries_s"], dtype=float)
    return out


def _filter(settings: CutSettings, rate_hz: float) -> Filter:
    return lambda x: lowpass(x, rate_hz, **dict(settings.lowpass))


def _segments(
    movement: Movement, cuts_s: Floats, noise_sd: float, gains: tuple[float, float]
) -> Iterator[dict[str, Any]]:
    """Yield a row a segment; times from the start of the movement."""
    wrist, active = movement.wrist, movement.active
    speeds, curvatures = speed(wrist.path, wrist.rate_hz)[active], curvature(wrist.path)[active]
    time = np.arange(len(speeds)) / wrist.rate_hz
    ends = np.concatenate([[0.0], np.sort(cuts_s), [len(speeds) / wrist.rate_hz]])
    for number, (first, last) in enumerate(pairwise(ends), start=1):
        inside = (time >= first) & (time < last) & (curvatures > 0)
        row = {"segment": number, "start_s": first, "end_s": last, "n": int(inside.sum())}
        if row["n"] < FEWEST:
            yield {**row, "note": f"fewer than {FEWEST} samples with a curvature"}
            continue
        try:
            found = estimates(speeds[inside], curvatures[inside], noise_sd, gains)
        except SignkinError as error:
            yield {**row, "note": str(error)}
            continue
        beta = {column: found.beta[name] for name, column in COLUMNS.items()}
        told = {"r": found.r, "r_squared": found.r_squared, "reliability": found.reliability}
        yield {**row, **beta, **told, "note": found.note}


def law_pitfalls(corpus: Corpus, rate_hz: float, settings: CutSettings, seed: int) -> pd.DataFrame:
    """Return the table `law_pitfalls`: what filter, noise and rate make of known exponents."""
    rng = seeds.stream(seed, corpus.name, "law_pitfalls")
    filtered = _filter(settings, rate_hz)
    found = pitfalls(BETAS, DURATIONS_S, corpus.noise_sd, rate_hz, filtered, rng, DRAWS)
    rows = [
        {
            "corpus": corpus.name,
            "path": "ellipse" if one.beta == one.beta else "noise alone",
            "beta": one.beta,
            "duration_s": one.duration_s,
            "noise_sd": one.noise_sd,
            "estimator": name,
            "found": one.mean(name),
            "sd": one.sd(name) if one.noise_sd else None,
            "r": float(np.nanmean(one.r)),
            "smallest_difference": one.smallest_difference(name) if one.noise_sd else None,
            "draws": len(one.r),
            "told": one.told(name),
        }
        for one in found
        for name in ESTIMATORS
    ]
    return pd.DataFrame(rows, columns=tables.TABLES["law_pitfalls"].names())
