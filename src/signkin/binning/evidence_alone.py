"""Compiled: the log evidence of orders, where nothing else of the posterior is wanted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.binning.counts import _log_sum, fill_counts
from signkin.binning.evidence import ROOM
from signkin.binning.lanes import WIDTH
from signkin.binning.segmentation_prior import log_prior_of
from signkin.binning.sum_product import columns_for
from signkin.jit import kernel

F = NDArray[np.float64]
I = NDArray[np.int64]  # noqa: E741


def log_evidences_of(evidence: F, wanted: tuple[int, ...], bins: int, longest: int) -> F:
    """Return ln P(D | S) of the wanted orders, with every M, (orders,): as `all_counts.counted`.

    evidence: (G, T, W, 8) of all segments. Half of what a posterior costs is not worked out.
    """
    log_prior = np.ascontiguousarray(log_prior_of(bins, longest)[:bins])
    held = len(evidence) * WIDTH
    out = np.empty(held)
    asked = np.zeros(held, dtype=np.int64)
    asked[list(wanted)] = 1
    columns = columns_for(bins)
    ways, spare_ways = (
        ROOM.array(name, bins + 1, columns, WIDTH) for name in ("ways", "before")
    )  # fmt: skip
    best = ROOM.array("best", bins + 1, WIDTH)
    weight = ROOM.array("probabilities", *evidence.shape)
    spare = ROOM.array("spare", *evidence.shape[1:])
    for g in range(len(evidence)):
        own = slice(g * WIDTH, (g + 1) * WIDTH)
        _fill(
            evidence[g], asked[own], log_prior, out[own], weight[g], best, ways, spare_ways, spare
        )
    return out[list(wanted)]


@kernel
def _fill(
    evidence: F, wanted: I, log_prior: F, log_evidence: F, weight: F, best: F, ways: F,
    spare_ways: F, spare: F,
) -> None:  # fmt: skip
    """Fill log_evidence (8,) as `counts.fit_orders` does. The arrays are those of it."""
    counts = len(log_prior)
    log_by_count = np.empty((counts, WIDTH))
    penalty = np.empty(WIDTH)
    low, high = np.empty((2, WIDTH), dtype=np.int64)
    fill_counts(
        evidence, wanted, log_prior, log_by_count, weight, penalty, best, ways, low, high,
        spare_ways, spare,
    )  # fmt: skip
    for lane in range(WIDTH):
        log_evidence[lane] = _log_sum(log_by_count[:, lane])
