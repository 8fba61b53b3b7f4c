"""What the figures of one corpus are drawn from."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.corpus import Corpus
from signkin.errors import SignkinError
from signkin.io.store import read_recordings
from signkin.studies.endres2013.posteriors import read_posteriors
from signkin.studies.endres2013.settings import CutSettings
from signkin.studies.endres2013.single_signs import (
    POWERLAW,
    RECORDED,
    example_points,
    movement_of,
    read_trajectories,
)

Floats = NDArray[np.float64]

TABLES = ("ground_truth", "order_posteriors", "hit_rates", "chance_lines", "order_tests")


@dataclass(frozen=True, eq=False)
class Example:
    """The recording of Fig. 1, 3A and 4.

    axes: those of its path, L of x, y, z. points: table `fig01_powerlaw`. segments: its rows of
    the table `ground_truth`. fits: its posteriors. recorded, powerlaw: (T, L) in bins.
    """

    recording: str
    axes: str
    points: pd.DataFrame
    segments: pd.DataFrame
    fits: pd.DataFrame
    recorded: Floats
    powerlaw: Floats


@dataclass(frozen=True, eq=False)
class Sources:
    """The tables of a corpus of single signs, and the recording that is its example.

    orders, rates, lines, tests: the tables `order_posteriors`, `hit_rates`, `chance_lines`,
    `order_tests`. unit: of length, m or px. find_example: the example; a SignkinError where no
    recording can be one.
    """

    corpus: str
    unit: str
    orders: pd.DataFrame
    rates: pd.DataFrame
    lines: pd.DataFrame
    tests: pd.DataFrame
    find_example: Callable[[], Example]

    @cached_property
    def example(self) -> Example:
        """The recording of Fig. 1, 3A and 4."""
        return self.find_example()


def read_sources(
    corpus: Corpus, frames: Mapping[str, pd.DataFrame], shards: Mapping[str, Sequence[str]],
    settings: CutSettings, seed: int,
) -> Sources:  # fmt: skip
    """Return what is drawn of a corpus.

    frames: its tables, those of TABLES. shards: the files `recordings`, `trajectories` and
    `posteriors` of all shards. The example is the first recording that has a ground truth.
    """
    orders, rates, lines, tests = (frames[kind] for kind in TABLES[1:])
    found = partial(_example, corpus, frames["ground_truth"], shards, settings, seed)
    return Sources(corpus.name, corpus.unit, orders, rates, lines, tests, found)


def _example(
    corpus: Corpus, truth: pd.DataFrame, shards: Mapping[str, Sequence[str]],
    settings: CutSettings, seed: int,
) -> Example:  # fmt: skip
    if truth.empty:
        raise no_truth(corpus.folder)
    name = str(truth["recording"].iloc[0])
    (recording,) = (r for path in shards["recordings"] for r in read_recordings(Path(path), [name]))
    binned = {t.dataset: t.x for t in read_trajectories(shards["trajectories"], recording=name)}
    return Example(
        name,
        movement_of(recording, settings).wrist.axes,
        example_points(corpus, recording, settings, seed),
        truth[truth["recording"] == name],
        read_posteriors(shards["posteriors"], name),
        binned[RECORDED],
        binned[POWERLAW],
    )


def no_truth(where: str | Path) -> SignkinError:
    """Return the error of a corpus whose trajectories have no true boundaries."""
    return SignkinError(
        "no recording has a power-law ground truth",
        file=where,
        expected="one or more; results/endres2013/<corpus>/left_out.csv tells why not",
    )
