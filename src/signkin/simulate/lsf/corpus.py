"""The recordings of lsf-sim, the truth behind them, and their files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.annotation import Interval
from signkin.io.bvh import write_bvh
from signkin.io.eaf import write_eaf
from signkin.simulate.body import Body
from signkin.simulate.lsf.design import design, utterances_of
from signkin.simulate.lsf.motion import channel_values, coordinates_of
from signkin.simulate.lsf.postures import choose_postures
from signkin.simulate.lsf.second_tagger import second_tags
from signkin.simulate.lsf.signs import FRAME_S, RATE_HZ, Token, Transition
from signkin.simulate.lsf.tags import place_tags, true_times

TERMS = ("constant", "geodesic", "euclidean")  # order of theta
PAUSE_FRAMES = (140, 200)  # between utterances, hands down and up again


@dataclass(frozen=True, eq=False)
class SimulatedRecording:
    """One recording as it is written: channel values in degrees and cm, and its signs."""

    name: str
    values: NDArray[np.float64]
    utterances: tuple[tuple[Token, ...], ...]


@dataclass(frozen=True, eq=False)
class SimulatedCorpus:
    """The recordings, the true boundaries and the design behind them."""

    recordings: tuple[SimulatedRecording, ...]
    truth: pd.DataFrame
    design: pd.DataFrame


def simulate(
    names: Sequence[str],
    lexicon: Mapping[str, str],
    table2: pd.DataFrame,
    theta: NDArray[np.float64],
    mean_error_s: float,
    euclidean_unit_m: float,
    rng: np.random.Generator,
    parts: int | None = None,
) -> SimulatedCorpus:
    """Simulate the corpus.

    names: of the recordings. parts: how many recordings the design is cut into, of which the first
    have names; None: as many as names. lexicon: gloss -> two digits. table2: the printed table, all
    text. theta (3,), mean_error_s: the printed surface and its mean error, for geodesic
    distances in radians and Euclidean ones in `euclidean_unit_m`.
    """
    designed = design(table2, theta, mean_error_s, euclidean_unit_m, rng)
    body = Body()
    utterances = utterances_of(designed, lexicon, rng)
    order = rng.permutation(len(utterances))
    groups = np.array_split(order, parts or len(names))[: len(names)]
    recordings, truth, design_rows = [], [], []
    for name, group in zip(names, groups, strict=True):
        chosen = [utterances[i] for i in sorted(group)]
        recording = _recording(name, chosen, body, rng)
        recordings.append(recording)
        truth += _truth_rows(recording)
        design_rows += _design_rows(name, chosen)
    return SimulatedCorpus(tuple(recordings), pd.DataFrame(truth), pd.DataFrame(design_rows))


def _recording(
    name: str,
    utterances: Sequence[tuple[list[Token], list[Transition]]],
    body: Body,
    rng: np.random.Generator,
) -> SimulatedRecording:
    clock = int(rng.integers(*PAUSE_FRAMES))
    for tokens, between in utterances:
        clock = place_tags(tokens, between, clock, rng)
        true_times(tokens, rng)
        choose_postures(tokens, between, body, rng)
        clock += int(rng.integers(*PAUSE_FRAMES))
    signs = [tokens for tokens, _ in utterances]
    coordinates = coordinates_of(signs, clock, rng)
    values = channel_values(coordinates, body, rng)
    return SimulatedRecording(name, values, tuple(tuple(tokens) for tokens in signs))


def _truth_rows(recording: SimulatedRecording) -> list[dict[str, object]]:
    tokens = [token for utterance in recording.utterances for token in utterance]
    return [
        {
            "recording": recording.name,
            "sign": number,
            "edge": edge,
            "hand": hand,
            "true_s": round(token.true_s[hand][i], 6),
        }
        for number, token in enumerate(tokens, start=1)
        for i, edge in enumerate(("start", "end"))
        for hand in token.hands
    ]


def _design_rows(
    name: str, utterances: Sequence[tuple[list[Token], list[Transition]]]
) -> list[dict[str, object]]:
    transitions = [transition for _, between in utterances for transition in between]
    return [
        {
            "recording": name,
            "transition": number,
            "type": transition.kind,
            "duration_s": transition.frames * FRAME_S,
            "geodesic_rad": transition.geodesic_rad,
            "euclidean_m": transition.euclidean_cm / 100,
        }
        for number, transition in enumerate(transitions, start=1)
    ]


def write_motion(recording: SimulatedRecording, path: Path) -> None:
    """Write the motion as BVH (cm, degrees)."""
    write_bvh(path, Body().hierarchy, recording.values, RATE_HZ)


def write_second_tags(recording: SimulatedRecording, path: Path, rng: np.random.Generator) -> None:
    """Write the signs as a second annotator tags them, as ELAN: one tier, `sign`."""
    write_eaf(
        path,
        author="signkin simulator, second annotator",
        date="2017-07-09T00:00:00+00:00",
        media_url=f"{recording.name}.bvh",
        tiers=[("sign", None, second_tags(recording.utterances, rng))],
    )


def write_tags(recording: SimulatedRecording, path: Path) -> None:
    """Write the manual tags as ELAN: utterance, and included in it translation and sign."""
    utterances, translations, signs = [], [], []
    for number, tokens in enumerate(recording.utterances, start=1):
        start, end = tokens[0].start * FRAME_S, tokens[-1].end * FRAME_S
        label = f"utterance {number}"
        utterances.append(Interval(start, end, label, "utterance"))
        text = f"(simulated: {label} of {len(recording.utterances)}, no meaning)"
        translations.append(Interval(start, end, text, "translation"))
        signs += [Interval(t.start * FRAME_S, t.end * FRAME_S, t.gloss, "sign") for t in tokens]
    write_eaf(
        path,
        author="signkin simulator",
        date="2017-07-09T00:00:00+00:00",
        media_url=f"{recording.name}.bvh",
        tiers=[
            ("utterance", None, utterances),
            ("translation", "utterance", translations),
            ("sign", "utterance", signs),
        ],
    )
