"""Compiled: the log evidence of orders, where nothing else of the posterior is wanted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from signkin.binning.all_counts import LIKELY_CUT, asked_lanes, likely_counts
from signkin.binning.counts import fill_counts, log_sum_of, tail_shares
from signkin.binning.evidence import ROOM
from signkin.binning.lanes import WIDTH
from signkin.binning.segmentation_prior import log_prior_of
from signkin.binning.sum_product import columns_for
from signkin.jit import kernel

F = NDArray[np.float64]
I = NDArray[np.int64]  # noqa: E741


def log_evidences_of(evidence: F, wanted: tuple[int, ...], bins: int, longest: int) -> F:
    """Return ln P(D | S) of the wanted orders, (orders,), as `all_counts.counted` with every M.

    evidence: (G, T, W, 8) of all segments. Half of what a posterior costs is not worked out, nor
    are counts whose share is below `all_counts.LIKELY_CUT`.
    """
    log_prior = np.ascontiguousarray(log_prior_of(bins, longest)[:bins])
    groups = len(evidence)
    out, cut = np.empty((2, groups * WIDTH))
    asked = asked_lanes(groups, wanted)
    best = ROOM.array("best", bins + 1, WIDTH)
    weight = ROOM.array("probabilities", *evidence.shape)
    spare = ROOM.array("spare", *evidence.shape[1:])
    fewest = -(-bins // longest) - 1
    for most in likely_counts(evidence, wanted, fewest, bins - 1):
        columns = columns_for(most + 1)
        ways, spare_ways = (
            ROOM.array(name, bins + 1, columns, WIDTH) for name in ("ways", "before")
        )  # fmt: skip
        for g in range(groups):
            own = slice(g * WIDTH, (g + 1) * WIDTH)
            _fill(
                evidence[g], asked[own], log_prior[: most + 1], out[own], cut[own], weight[g], best,
                ways, spare_ways, spare,
            )  # fmt: skip
        if cut.max() <= LIKELY_CUT:
            break
    return out[list(wanted)]


@kernel
def _fill(
    evidence: F, wanted: I, log_prior: F, log_evidence: F, cut: F, weight: F, best: F, ways: F,
    spare_ways: F, spare: F,
) -> None:  # fmt: skip
    """Fill log_evidence and cut (8,) as `counts.fit_orders` does. The arrays are those of it."""
    counts = len(log_prior)
    log_by_count = np.empty((counts, WIDTH))
    penalty = np.empty(WIDTH)
    low, high = np.empty((2, WIDTH), dtype=np.int64)
    fill_counts(
        evidence, wanted, log_prior, log_by_count, weight, penalty, best, ways, low, high,
        spare_ways, spare, True,
    )  # fmt: skip
    tail_shares(evidence, wanted, log_by_count, best, cut)
    for lane in range(WIDTH):
        log_evidence[lane] = log_sum_of(log_by_count[:, lane])
