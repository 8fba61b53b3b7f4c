"""What is to be simulated: the transitions of the printed Table 2, in utterances of signs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.simulate.chains import chains
from signkin.simulate.lsf.signs import FRAME_S, Token, Transition
from signkin.simulate.printed import integers_with, sums_from_print
from signkin.simulate.surface import design_distances

DURATION_RANGE = (10, 50)  # frames; claims N03 and N04 of the paper, the outlier aside
UTTERANCES = 14
MOST_TRANSITIONS = 9  # in one utterance


def design(
    table2: pd.DataFrame,
    theta: NDArray[np.float64],
    mean_error_s: float,
    unit_m: float,
    rng: np.random.Generator,
) -> list[Transition]:
    """Return the transitions of the printed Table 2, with distances about the printed surface.

    table2, theta, mean_error_s: as printed. unit_m: of the surface's Euclidean distance.
    """
    kinds, frames = [], []
    for row in table2.itertuples(index=False):
        n = int(row.n)
        if not n:
            continue
        values = _row_durations(row, rng)
        kinds += [str(row.type)] * n
        frames += values
    durations = np.array(frames) * FRAME_S
    dropped = np.array([kind[:2] in ("10", "11") and kind[2:] == "00" for kind in kinds])
    geodesic, euclidean = design_distances(durations, theta, mean_error_s, dropped, rng)
    return [
        Transition(kind, f, float(g), float(e * unit_m * 100))
        for kind, f, g, e in zip(kinds, frames, geodesic, euclidean, strict=True)
    ]


def _row_durations(row: object, rng: np.random.Generator) -> list[int]:
    """Return integer durations with the row's printed number, mean and SD."""
    grain = str(FRAME_S)
    n, mean, sd = int(row.n), row.mean, row.sd  # type: ignore[attr-defined]
    total, squares = sums_from_print(n, mean, sd, grain)
    without = row.n_without_outlier  # type: ignore[attr-defined]
    if not without:
        return integers_with(n, total, squares, *DURATION_RANGE, rng)
    kept = sums_from_print(
        int(without),
        row.mean_without_outlier,  # type: ignore[attr-defined]
        row.sd_without_outlier,  # type: ignore[attr-defined]
        grain,
    )
    outlier = total - kept[0]
    if int(without) != n - 1 or outlier**2 != squares - kept[1]:
        raise SignkinError(
            f"{n} and {without} values do not differ by one outlier",
            place=f"printed row {row.type}",  # type: ignore[attr-defined]
            expected="sums and sums of squares that leave one value",
        )
    return [*integers_with(int(without), *kept, *DURATION_RANGE, rng), outlier]


def utterances_of(
    designed: Sequence[Transition], lexicon: Mapping[str, str], rng: np.random.Generator
) -> list[tuple[list[Token], list[Transition]]]:
    """Return utterances: signs, and the transitions between them."""
    pool: dict[tuple[str, str], list[Transition]] = {}
    for transition in designed:
        pool.setdefault((transition.kind[:2], transition.kind[2:]), []).append(transition)
    for transitions in pool.values():
        order = rng.permutation(len(transitions))
        transitions[:] = [transitions[i] for i in order]
    counts = {edge: len(transitions) for edge, transitions in pool.items()}
    glosses: dict[str, list[str]] = {}
    for gloss, kind in lexicon.items():
        glosses.setdefault(kind, []).append(gloss)
    out = []
    for chain in chains(counts, UTTERANCES, MOST_TRANSITIONS, rng):
        tokens = [Token(str(rng.choice(glosses[kind])), kind) for kind in chain]
        between = [pool[edge].pop() for edge in pairwise(chain)]
        out.append((tokens, between))
    return out
