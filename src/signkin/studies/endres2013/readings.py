"""What is printed where a rule of ours adds to it: the study without each such rule.

Four rules of ours decide claims and stand nowhere in the paper: less of the prior's noise for
fitted trajectories (`binning.recovery_noise`), a first gain that keeps the duration
(`powerlaw.first_gain`), no ground truth with an R squared below 0.97
(`powerlaw.least_r_squared`), and 90 ms as half the width of a hit's window. Each is taken out on
the same recordings, and the claims are told under both. Beside them stand recorded movements and
ground truth at equal T.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from signkin import tables
from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.io.store import read_recordings
from signkin.powerlaw import LeftOut
from signkin.recording import Recording
from signkin.studies.endres2013.posteriors import (
    FITTED,
    FITTED_MAP,
    Data,
    Fitted,
    Study,
    chosen,
    rows_of,
)
from signkin.studies.endres2013.settings import ReadingSettings
from signkin.studies.endres2013.single_signs import (
    POWERLAW,
    KnownTruths,
    SingleSigns,
    Trajectory,
    ground_truth,
    movement_of,
    recorded,
    single_signs,
    warped,
)
from signkin.studies.endres2013.summaries import Drawn, hit_rates, order_posteriors

OURS = "as configured"
NOISE = "the recordings' noise for fitted trajectories"
WINDOW = "half the window"
GAIN = "gain of the first sample"
ANY_FIT = "any R squared"
GAIN_ANY_FIT = "gain of the first sample, any R squared"
EQUAL = "equal bins"
EQUAL_PRINTED = "equal bins, gain of the first sample, any R squared"
ANY = -1e9  # an R squared that every law has
LAWS: dict[str, dict[str, object]] = {
    GAIN: {"first_gain": "first_sample"},
    ANY_FIT: {"least_r_squared": ANY},
    GAIN_ANY_FIT: {"first_gain": "first_sample", "least_r_squared": ANY},
}
NAMES = ("binning", "hit_rates", "order_posteriors", "ground_truth")


@dataclass(frozen=True, eq=False)
class _Read:
    """Fits under one reading, and half the width of its window for hits in s."""

    name: str
    fits: Sequence[Fitted]
    window_s: float


def readings(
    corpus: Corpus, paths: Iterable[str | Path], settings: ReadingSettings, seed: int, workers: int
) -> dict[str, pd.DataFrame]:
    """Return the tables equal_bins, readings_binning, _hit_rates, _order_posteriors, _ground_truth.

    paths: the recordings of all shards; at most `fitted_recordings` are taken, evenly spread.
    Rows of fitted trajectories stand in the summaries alone.
    """
    names = chosen([e.recording for e in corpus.entries], settings.fit.fitted_recordings)
    recordings = [one for path in paths for one in read_recordings(Path(path), names)]
    runs = Study(corpus, settings.fit, workers, every_count=False)
    truths, drawn = KnownTruths(), Drawn()
    cuts = {OURS: single_signs(corpus, recordings, settings.cut, seed, truths)}
    for name, change in LAWS.items():
        law = settings.cut.powerlaw.model_copy(update=change)
        cut = replace(settings.cut, powerlaw=law)
        cuts[name] = single_signs(corpus, recordings, cut, seed, truths)
    parts = [_summary(corpus, one, settings, seed, drawn) for one in _reads(runs, cuts, settings)]
    equal: dict[str, pd.DataFrame] = {}
    for name, change in ((EQUAL, {}), (EQUAL_PRINTED, LAWS[GAIN_ANY_FIT])):
        fits = runs.run(_data(equal_bins(corpus, recordings, settings, change, seed, truths)))
        rows = [row for one in fits for row in rows_of(corpus, settings.fit, one)]
        equal[name] = pd.DataFrame(rows, columns=tables.TABLES["binning"].names())
    parts.append({"binning": equal[EQUAL_PRINTED].assign(reading=EQUAL_PRINTED)})
    out = {"equal_bins": equal[EQUAL]} | {
        f"readings_{name}": pd.concat([part[name] for part in parts if name in part])
        for name in NAMES[:3]
    }
    laws = [
        found.table("ground_truth", corpus.unit).assign(reading=name)
        for name, found in cuts.items()
    ]
    out[f"readings_{NAMES[3]}"] = pd.concat(laws, ignore_index=True)
    return {
        name: table.reindex(columns=tables.TABLES[name].names(corpus.unit))
        for name, table in out.items()
    }


def _reads(runs: Study, cuts: dict[str, SingleSigns], settings: ReadingSettings) -> Iterator[_Read]:
    window = settings.fit.hit_window_s
    fits = runs.run(_data(cuts[OURS].trajectories))
    again = [
        item
        for one in fits
        if one.data.dataset != POWERLAW
        for order in settings.fit.fitted_orders
        for item in runs.fitted_data(one, order)
    ]
    refits = runs.run(again)
    yield _Read(OURS, [*fits, *refits], window)
    yield _Read(WINDOW, [*fits, *refits], window / 2)
    yield _Read(NOISE, runs.run([replace(item, noise_share=1.0) for item in again]), window)
    for name in LAWS:
        warps = [t for t in cuts[name].trajectories if t.dataset == POWERLAW]
        yield _Read(name, runs.run(_data(warps)), window)


def _data(trajectories: Iterable[Trajectory]) -> list[Data]:
    none = np.empty(0)
    return [
        Data(t, t.dataset, t.x, None, t.boundaries_s if t.dataset == POWERLAW else none)
        for t in trajectories
    ]


def equal_bins(
    corpus: Corpus, recordings: Iterable[Recording], settings: ReadingSettings,
    change: Mapping[str, object], seed: int, truths: KnownTruths | None = None,
) -> list[Trajectory]:  # fmt: skip
    """Return recorded movements and their ground truth in as many bins each, pair by pair.

    change: settings of the ground truth that are not as configured. truths: those known already.

    Ground truth has 240 Hz and so a hundred bins, where a recording of 25 Hz has as few as it has
    samples: orders of the two are to be compared at equal T.
    """
    out = []
    truth_of = ground_truth if truths is None else truths.of
    law = settings.cut.powerlaw.model_copy(update=dict(change))
    for recording in recordings:
        try:
            movement = movement_of(recording, settings.cut)
            as_recorded = recorded(movement, settings.cut.bins)
        except SignkinError:  # listed where trajectories are made: left_out.csv
            continue
        truth = truth_of(corpus.name, movement.wrist, law, seed)
        if not isinstance(truth, LeftOut):
            out += [as_recorded, warped(movement.wrist, truth, len(as_recorded.x))]
    return out


def _summary(
    corpus: Corpus, read: _Read, settings: ReadingSettings, seed: int, drawn: Drawn
) -> dict[str, pd.DataFrame]:
    fit = replace(settings.fit, hit_window_s=read.window_s)
    rows = [row for one in read.fits for row in rows_of(corpus, fit, one)]
    frame = pd.DataFrame(rows, columns=tables.TABLES["binning"].names())
    refitted = frame["dataset"].isin([FITTED, FITTED_MAP])
    binning = settings.binning.model_copy(update={"hit_window_s": read.window_s})
    rates, _ = hit_rates(
        corpus.name, frame, _truths(read.fits), binning, seed, parts=False, drawn=drawn
    )
    found = {
        "binning": frame[~refitted],
        "order_posteriors": order_posteriors(corpus.name, frame, parts=False),
        "hit_rates": rates,
    }
    return {name: table.assign(reading=read.name) for name, table in found.items()}


def _truths(fits: Sequence[Fitted]) -> dict[tuple[str, int | None, str], Sequence[float]]:
    return {
        (one.data.dataset, one.data.true_order, one.data.source.recording): [
            float(time) for time in one.data.truth_s
        ]
        for one in fits
    }
