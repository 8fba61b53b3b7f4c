"""The posterior of all orders, given the evidence of all segments: with every M, or the likely."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from signkin.binning import band
from signkin.binning.counts import fit_orders, likely_most, price_of_boundary
from signkin.binning.evidence import ROOM
from signkin.binning.lanes import WIDTH
from signkin.binning.longer import Longer
from signkin.binning.segmentation_prior import log_prior_of
from signkin.binning.sum_product import columns_for
from signkin.errors import SignkinError

Floats = NDArray[np.float64]

# At each bin of a long series, numbers of segments within this of the best path's are kept; the
# band is widened until the bound on what it leaves out is below BAND_CUT_MASS.
BAND = 32
BAND_CUT_MASS = 1e-9
LIKELY_CUT = 1e-12
TAIL_STEPS = 4
ROUNDING = 2e-15  # the least share that two sums can differ by and it be told


@dataclass(frozen=True, eq=False)
class Found:
    """Rows for the wanted orders. log_by_count: ln(P(M) P(D | M)).

    segments: probabilities of segments, by segment or by order (segments.py), of all orders.
    """

    log_by_count: Floats
    probability: Floats
    boundary: Floats
    log_evidence: Floats
    cut_mass: Floats
    segments: Floats


def counted(
    evidence: Floats, wanted: tuple[int, ...], bins: int, longest: int, max_count: int | None,
    likely: bool = False,
) -> Found:  # fmt: skip
    """Work out M = 0..max_count of all orders together.

    likely: of these only those that can matter, the share of the others being below LIKELY_CUT.
    """
    fewest = -(-bins // longest) - 1
    end = bins - 1 if max_count is None else min(max(int(max_count), fewest), bins - 1)
    if not likely:
        return _counted(evidence, wanted, bins, longest, end, likely)
    for most in likely_counts(evidence, wanted, fewest, end):
        found = _counted(evidence, wanted, bins, longest, most, likely)
        if found.cut_mass.max() <= LIKELY_CUT:
            break
    return found


def likely_counts(
    evidence: Floats, wanted: tuple[int, ...], fewest: int, end: int
) -> Iterator[int]:
    """Yield numbers of boundaries that the likely ones hardly exceed: one, then larger ones."""
    best = ROOM.array("best", evidence.shape[1] + 1, WIDTH)
    asked = asked_lanes(len(evidence), wanted).reshape(-1, WIDTH)
    likely = max(likely_most(*each, best) for each in zip(evidence, asked, strict=True))
    most = min(end, max(fewest, likely))
    yield most
    while most < end:
        most = min(end, 2 * most)
        yield most


def asked_lanes(groups: int, wanted: tuple[int, ...]) -> NDArray[np.int64]:
    """Return which lanes are wanted orders, (8 groups,)."""
    asked = np.zeros(groups * WIDTH, dtype=np.int64)
    asked[list(wanted)] = 1
    return asked


def _counted(
    evidence: Floats, wanted: tuple[int, ...], bins: int, longest: int, most: int, likely: bool
) -> Found:
    """Work out M = 0..most of all orders together."""
    counts = most + 1
    log_prior = np.ascontiguousarray(log_prior_of(bins, longest)[:counts])
    groups = len(evidence)
    held = groups * WIDTH
    log_by_count = np.empty((groups, counts, WIDTH))
    probability = np.empty((held, counts))
    boundary = np.empty((groups, bins, WIDTH))
    log_evidence, lost, cut = np.empty((3, held))
    chances = ROOM.array("probabilities", *evidence.shape)
    best = ROOM.array("best", bins + 1, WIDTH)
    columns = columns_for(counts)
    ways = ROOM.array("ways", bins + 1, columns, WIDTH)
    before = ROOM.array("before", bins + 1, columns, WIDTH)
    spare = ROOM.array("spare", *evidence.shape[1:])
    asked = asked_lanes(groups, wanted)
    for g in range(groups):
        own = slice(g * WIDTH, (g + 1) * WIDTH)
        fit_orders(
            evidence[g], asked[own], log_prior, log_by_count[g], probability[own], boundary[g],
            log_evidence[own], lost[own], cut[own], chances[g],
            best, ways, before, spare, likely,
        )  # fmt: skip
    rows = list(wanted)
    _refuse_lost(lost[rows])
    return Found(
        np.moveaxis(log_by_count, 1, 2).reshape(held, counts)[rows],
        probability[rows],
        np.moveaxis(boundary, 1, 2).reshape(held, bins)[rows],
        log_evidence[rows],
        cut[rows],
        chances,
    )


def in_band(
    evidence: Floats, wanted: tuple[int, ...], bins: int, longest: int, longer: Longer | None = None
) -> Found | None:
    """Work out the likely M of a long series, with a bound on what is left out.

    `evidence` (D, T, W) becomes probabilities of segments. longer: what bounds segments of more
    than W bins, where those are left out (longer.py); None is returned where they must not be.
    """
    log_prior = log_prior_of(bins, longest)
    rows = len(wanted)
    log_by_count, probability = np.empty((2, rows, bins))
    boundary = np.empty((rows, bins))
    log_evidence, cut = np.empty((2, rows))
    # The lowest and the highest go first: those want the longest segments, if any does.
    for i in sorted(range(rows), key=lambda i: min(i, rows - 1 - i)):
        d = wanted[i]
        half_width, before = BAND, (0, np.inf)
        while True:
            kept = evidence[d].copy()
            log_evidence[i], lost, left_out, price = band.fit_order_in_band(
                kept, log_prior, half_width, log_by_count[i], probability[i], boundary[i]
            )
            _refuse_lost(np.array([lost]))
            beyond = partial(longer, evidence[d], d) if longer else None
            if beyond:
                left_out += float(np.expm1(beyond(price)))
                if left_out > BAND_CUT_MASS:
                    return None
            cut[i] = _band_cut(
                evidence[d], log_by_count[i], log_prior, log_evidence[i], left_out, price, beyond
            )
            # What a wider band lacks, too, is below what sums can hold: widening adds nothing.
            held = (int(np.isfinite(log_by_count[i]).sum()), left_out)
            if cut[i] <= BAND_CUT_MASS or 2 * half_width >= bins or (held[0] and held == before):
                break
            half_width, before = 2 * half_width, held
        if longer and cut[i] > BAND_CUT_MASS:
            return None
        evidence[d] = kept
    return Found(log_by_count, probability, boundary, log_evidence, cut, evidence)


def _band_cut(
    evidence: Floats, log_by_count: Floats, log_prior: Floats, log_evidence: float,
    left_out: float, price: float, longer: Callable[[float], float] | None = None,
) -> float:  # fmt: skip
    """Return a bound on the share of P(M | D) that a band leaves out.

    Outside of the window of counts everything is left out, inside of it the paths that leave
    the band. Their sum at the pass's price of a segment is `left_out` of the sum over all, which
    bounds what any one M lacks (as small as rounding lets it be told), and Chernoff's bound
    holds for each M as well: the lesser of the two counts. Prices are added until the bound is
    good enough.
    """
    bins = len(evidence)
    m = np.arange(bins)
    inside = np.flatnonzero(np.isfinite(log_by_count))
    if len(inside) == 0:
        return 1.0
    low, high = int(inside[0]), int(inside[-1]) + 1
    at_price = log_by_count[low:high] - log_prior[low:high] - (inside + 1) * price
    strayed = np.full(bins, np.inf)
    strayed[low:high] = np.log(max(left_out, ROUNDING)) + log_sum(at_price)
    strayed += (m + 1) * price
    bound = np.full(bins, np.inf)
    share = np.inf
    for step in range(TAIL_STEPS + 1):
        last = step == TAIL_STEPS
        tilts = _edge_prices(log_by_count, log_prior, low, high) if last else None
        for tilt in tilts or _prices(bins, low, high, min(step, TAIL_STEPS - 1)):
            all_ways = _log_bound(evidence, tilt) + (longer(tilt) if longer else 0.0)
            bound = np.minimum(bound, all_ways + (m + 1) * tilt)
        lacking = np.minimum(bound, strayed) + log_prior - log_evidence
        share = float(np.exp(np.minimum(0.0, log_sum(lacking))))
        if share <= BAND_CUT_MASS:
            break
    return share


def _edge_prices(log_by_count: Floats, log_prior: Floats, low: int, high: int) -> list[float]:
    """Return the prices at which counts near the window's ends weigh most.

    Of a very long series the likely counts are so few of all that prices for other counts bound
    nothing just outside of the window. Near its very ends sums run out of digits.
    """
    ways = log_by_count[low:high] - log_prior[low:high]
    inward = max(1, len(ways) // 10)
    if len(ways) < 2 * inward + 2:
        return []
    return [
        float(ways[inward + 1] - ways[inward]), float(ways[-1 - inward] - ways[-2 - inward]),
    ]  # fmt: skip


def _prices(bins: int, low: int, high: int, step: int) -> list[float]:
    """Return prices of a segment at which few, and many segments weigh most.

    At first for the counts below the window, at twice its end and near one segment a bin; then
    in between, and higher still for the low side, where few segments fit badly.
    """
    at_low = price_of_boundary(bins, max(low - 1, 0)) * 4.0 * 8.0**step
    at_top = bins - 1 - (bins >> 6)
    ratio = at_top / (2 * high)
    shares = ((0.0, 1.0), (0.5,), (0.25, 0.75), (0.125, 0.375, 0.625, 0.875))[step]
    places = [min(int(2 * high * ratio**share), bins - 1) for share in shares]
    return [at_low, *(price_of_boundary(bins, at) for at in places)]


def _log_bound(evidence: Floats, price: float) -> float:
    """Return the log of the sum over all segmentations, each segment paying the price.

    With M + 1 prices put back it bounds the sum over those with M boundaries (Chernoff).
    """
    best, weight = np.empty(len(evidence) + 1), np.empty(evidence.shape)
    return float(band.log_all_ways(evidence, price, best, weight))


def log_sum(values: Floats) -> float:
    """Return the log of the sum of exponentials. SciPy's has a start of its own of 50 us."""
    top = values.max()
    return float(top + np.log(np.exp(values - top).sum())) if np.isfinite(top) else float(top)


def _refuse_lost(lost: Floats) -> None:
    if lost.max() > 1e-9:
        raise SignkinError(
            f"{lost.max():.1e} of the posterior was lost to underflow",
            place="sum-product",
            expected="less than 1e-9",
            todo="Report this trajectory: the pass should have found its peak.",
        )
