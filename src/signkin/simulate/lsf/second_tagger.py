"""A second annotator of lsf-sim, whose tags have a known lag and jitter."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signkin.annotation import Interval
from signkin.simulate.lsf.signs import FRAME_S, Token
from signkin.simulate.lsf.tags import LEAST_TRUE_SIGN_S

LAG_S = 0.04  # of starts and ends alike, after the right hand's true boundary
JITTER_S = 0.04  # SD; the first tagger's is 0.03
MOST_JITTER_S = 0.1


def second_tags(utterances: Sequence[Sequence[Token]], rng: np.random.Generator) -> list[Interval]:
    """Return the second annotator's signs of a recording, on frames, in order and apart.

    Each tag is the right hand's true boundary, LAG_S later, with its jitter; it comes at least a
    frame after the tag before, a sign's end LEAST_TRUE_SIGN_S after its start.
    """
    out: list[Interval] = []
    last = 0.0
    for token in (token for utterance in utterances for token in utterance):
        jitter = np.clip(rng.normal(0, JITTER_S, 2), -MOST_JITTER_S, MOST_JITTER_S)
        start, end = np.array(token.true_s["right"]) + LAG_S + jitter
        start = max(_on_frame(start), last + FRAME_S)
        end = max(_on_frame(end), start + LEAST_TRUE_SIGN_S)
        last = end
        out.append(Interval(_on_frame(start), _on_frame(end), token.gloss, "sign"))
    return out


def _on_frame(time_s: float) -> float:
    return round(round(time_s / FRAME_S) * FRAME_S, 6)
