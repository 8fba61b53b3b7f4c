"""When signs begin and end: manual tags, and each hand's true boundaries beside them."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from signkin.simulate.lsf.signs import FRAME_S, Token, Transition

SIGN_FRAMES = (22, 75)
TAG_JITTER_S = 0.03  # SD of manual tag against the right hand's boundary
MOST_JITTER_S = 0.08
LEFT_LAG_S = (0.025, 0.018)  # mean and SD of the left hand's boundary against the right's
LEAST_TRUE_SIGN_S = 0.14
LEAST_TRUE_TRANSITION_S = 0.05


def place_tags(
    tokens: list[Token], between: list[Transition], clock: int, rng: np.random.Generator
) -> int:
    """Put the manual tags of an utterance on frames from `clock` on; return the frame it ends."""
    for i, token in enumerate(tokens):
        token.start = clock
        token.end = clock + int(rng.integers(*SIGN_FRAMES))
        clock = token.end + (between[i].frames if i < len(between) else 0)
    return clock


def true_times(tokens: list[Token], rng: np.random.Generator) -> None:
    """Draw the hands' true boundaries beside the manual tags, in the order they must have."""

    def jitter() -> float:
        return float(np.clip(rng.normal(0, TAG_JITTER_S), -MOST_JITTER_S, MOST_JITTER_S))

    edges = np.array([(token.start, token.end) for token in tokens]).ravel() * FRAME_S
    gaps = np.tile([LEAST_TRUE_SIGN_S, LEAST_TRUE_TRANSITION_S], len(tokens))[:-1]
    right = _drawn_in_order(edges, gaps, jitter)
    mean, sd = LEFT_LAG_S
    left = _drawn_in_order(right, gaps, lambda: float(np.clip(rng.normal(mean, sd), -0.02, 0.07)))
    for i, token in enumerate(tokens):
        token.true_s = {
            "right": (right[2 * i], right[2 * i + 1]),
            "left": (left[2 * i], left[2 * i + 1]),
        }


def _drawn_in_order(
    edges: Iterable[float], gaps: NDArray[np.float64], draw: Callable[[], float]
) -> list[float]:
    """Move each time by a draw, so that the next one still comes late enough after it."""
    out: list[float] = []
    for i, edge in enumerate(edges):
        for _ in range(100):
            time = edge + draw()
            if not out or time - out[-1] >= gaps[i - 1]:
                break
        else:
            time = out[-1] + gaps[i - 1]
        out.append(float(time))
    return out
