"""Inter-annotator gamma of two annotators (Mathet, Widloecher & Metivier 2015)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
EMPTY = 1.0  # disorder of a segment that the other side lacks (delta empty)
DISORDER = ("disorder", "sign", "")
GAMMA = ("gamma", "sign", "")


def dissimilarity(first: Floats, second: Floats) -> Floats:
    """Return how far each two segments are apart, (N, M): the positional one of Mathet et al.

    The square of the differences of starts and of ends by both lengths; 0 for the same segment.
    """
    apart = np.abs(first[:, None] - second).sum(axis=2)
    lengths = np.diff(first, axis=1) + np.diff(second, axis=1).T
    return np.asarray((apart / lengths) ** 2 * EMPTY)


def disorder(first: Floats, second: Floats) -> float:
    """Return the disorder of the best alignment of two segmentations; NaN where both are empty.

    first, second: (N, 2), (M, 2) starts and ends, s. Each segment stands with one of the other
    side, at their dissimilarity, or alone, at EMPTY; the sum is least, and told by the mean number
    of segments a side.
    """
    from scipy.optimize import linear_sum_assignment

    segments = len(first) + len(second)
    if not segments:
        return float("nan")
    gain = np.minimum(dissimilarity(first, second) - 2 * EMPTY, 0.0)
    rows, columns = linear_sum_assignment(gain)
    return float((EMPTY * segments + gain[rows, columns].sum()) / (segments / 2))


def gamma_of(
    found: Mapping[tuple[str, str, str], float], drawn: list[dict[tuple[str, str, str], float]]
) -> tuple[dict[tuple[str, str, str], float], list[dict[tuple[str, str, str], float]]]:
    """Return scores, and those of the draws, with gamma in place of the disorder.

    Gamma is 1 for the same segments and 0 for the mean disorder of the draws; without draws there
    is none. What is drawn here has the same lengths and gaps in another order; Mathet et al. cut
    and turn a segmentation instead.
    """
    expected = float(np.mean([d[DISORDER] for d in drawn])) if drawn else float("nan")

    def of(scores: Mapping[tuple[str, str, str], float]) -> dict[tuple[str, str, str], float]:
        out = {key: value for key, value in scores.items() if key != DISORDER}
        if drawn and expected > 0:
            out[GAMMA] = 1.0 - scores[DISORDER] / expected
        return out

    return of(found), [of(d) for d in drawn]
