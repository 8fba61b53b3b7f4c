"""The signs of a corpus, with what their postures tell: what a synthesis is made from."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import tables
from signkin.annotation import Interval
from signkin.coarticulation.duration import Transitions
from signkin.coarticulation.posture import euclidean_distance, geodesic_distance
from signkin.coarticulation.retrieval import Candidates
from signkin.coarticulation.sign_speeds import mean_speeds, step_speeds
from signkin.coarticulation.synthesis import Sign
from signkin.coarticulation.transitions import SAME_INSTANT_S
from signkin.corpus import Corpus
from signkin.io.store import read_recordings, recording_names
from signkin.recording import Recording
from signkin.settings.sections import Lowpass
from signkin.studies.naert2017.sampling import Sample, sample
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.found import found_signs
from signkin.studies.naert2017.synthesis.stock import Place, placed
from signkin.studies.naert2017.tagged import (
    filled_recording,
    intervals_of,
    smoothed,
    turns_of,
    utterances_of,
)

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

    tokens: in order of recording and time. turns: recording -> orientations that the geodesic
    distance takes (world or parent), or None. lowpass, angle: of the signs' speeds
    (eq. 3): config's kinematics.lowpass, and 1 for half the angle, 2 for the full one.
    """

    corpus: Corpus
    recordings: Mapping[str, Recording]
    tokens: tuple[Token, ...]
    turns: Mapping[str, Array | None]
    euclidean_unit: float
    lowpass: Lowpass
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
        linear, angular = mean_speeds(self._step_speeds(take.name), [interval], take)[0]
        return float(linear), float(angular) * self.angle

    @cache  # noqa: B019
    def _step_speeds(self, take: str) -> tuple[Array, Array]:
        recording = self.recordings[take]
        return step_speeds(*smoothed(recording, self.turns[take], self.lowpass), recording.rate_hz)


def database(
    corpus: Corpus,
    recordings: Iterable[Recording],
    intervals: pd.DataFrame,
    settings: SynthesisSettings,
) -> Database:
    """Gather the tagged signs of a corpus; short gaps filled, all takes at one place."""
    takes: dict[str, Recording] = {}
    tokens: list[Token] = []
    tags = tables.ByRecording(intervals)
    for recording in recordings:
        filled = filled_recording(recording, settings.kinematics.longest_gap_s)
        if settings.synthesis.align_takes and takes:
            filled = placed(filled, Place.of(next(iter(takes.values()))))
        takes[filled.name] = filled
        signs = intervals_of(tags, filled.name, "sign")
        names = utterances_of(corpus, tags, filled.name, signs) if signs else []
        tokens += [
            Token(Sign(recording=filled, gloss=s.label, start_s=s.start_s, end_s=s.end_s), n, name)
            for n, (s, name) in enumerate(zip(signs, names, strict=True), start=1)
        ]
    return of_tokens(corpus, takes, tokens, settings)


def of_tokens(
    corpus: Corpus,
    takes: Mapping[str, Recording],
    tokens: Sequence[Token],
    settings: SynthesisSettings,
) -> Database:
    """Return the database of signs that are known already."""
    unit = settings.transitions.euclidean_unit_m if corpus.unit == "m" else 1.0
    frame = settings.transitions.geodesic_frame
    turns = {name: turns_of(take, frame) for name, take in takes.items()}
    angle = 1.0 if settings.durations.simple_angle == "half" else 2.0
    return Database(corpus, takes, tuple(tokens), turns, unit, settings.kinematics.lowpass, angle)


def sign_database(
    corpus: Corpus,
    takes: Sequence[Recording],
    intervals: pd.DataFrame,
    settings: SynthesisSettings,
) -> tuple[Database, pd.DataFrame]:
    """Return the signs of a corpus and the table `found_signs` (empty for a corpus with tags)."""
    base = database(corpus, takes, intervals, settings)
    if corpus.tagged:
        return base, tables.empty("found_signs", corpus.unit)
    found = found_signs(corpus, list(base.recordings.values()), settings)
    tokens = [
        Token(
            Sign(
                recording=base.recordings[str(row.recording)],
                gloss=str(row.gloss),
                start_s=float(row.start_s),
                end_s=float(row.end_s),
            ),
            1,
            "",
        )
        for row in found.itertuples()
    ]
    return of_tokens(corpus, base.recordings, tokens, settings), found


def load_database(
    corpus: Corpus,
    files: Sequence[str | Path],
    intervals: str | Path,
    excluded: str | Path,
    settings: SynthesisSettings,
    seed: int,
    glosses: Iterable[str] = (),
) -> tuple[Database, pd.DataFrame, Sample]:
    """Read canonical recordings and tags, those left out aside; returns as `sign_database`.

    Of a corpus beyond samples.transitions a sample of half as many is taken, since each is made
    anew some 16 times. It is returned as well, with a recording of each of the glosses in it.
    """
    without = set(tables.read_table(excluded, "excluded")["recording"])
    names = [name for file in files for name in recording_names(Path(file)) if name not in without]
    tags = tables.read_table(intervals, "intervals")
    most = settings.samples.transitions
    chosen = sample(corpus.name, names, tags, most, seed, glosses)
    if not chosen.whole:
        chosen = sample(corpus.name, names, tags, most // 2, seed, glosses)
    takes = [take for file in files for take in read_recordings(Path(file), chosen.names)]
    return *sign_database(corpus, takes, tags, settings), chosen
