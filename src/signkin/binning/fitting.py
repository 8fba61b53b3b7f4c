"""Fit trajectories: data and settings are checked here, and the parts put together."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from signkin.binning.all_counts import counted, in_band, log_sum
from signkin.binning.evidence import by_order, by_segment, expect, whitened_by
from signkin.binning.posterior import Posterior
from signkin.binning.prior import HIGHEST_ORDER, Prior, tables
from signkin.binning.segmentation_prior import log_uniform
from signkin.errors import SignkinError

Floats = NDArray[np.float64]

# Above so many bins not every M is worked out unless asked for: the cost grows with M T^2.
EVERY_COUNT_UP_TO = 256
MOST_NOISES = 1e30  # products of squares overflow above


def fit(
    X: Floats,
    orders: Sequence[int] = tuple(range(8)),
    prior: Prior | None = None,
    dt_s: float | None = None,
    max_count: int | None = None,
    max_segment_bins: int | None = None,
    expectations: bool = True,
    name: str = "trajectory",
) -> Posterior:
    """Return the posterior of one trajectory for all orders at once.

    X: (T, L), taken as given: the prior's coefficients are around 0, so centre it first.
    orders: polynomial orders. prior: mandatory. dt_s: duration of a bin, for
    Prior(time_unit="second"). max_count: the largest M worked out; None is every M up to 256
    bins, and above those around the likely M, the others being -inf; either way `cut_mass`
    bounds the share of P(M | D) that is left out. A count takes 128 bytes of memory a bin.
    max_segment_bins: the longest segment; segmentations with longer ones have no prior
    probability, the others share it evenly.
    expectations: whether to work out expected trajectories and noise too.

    Raises SignkinError that names the trajectory for gaps, too few bins, impossible orders.
    """
    if prior is None:
        raise SignkinError("no prior", file=name, expected="Prior(noise_sd=...)")
    x, wanted = _checked(X, orders, name)
    bins, dims = x.shape
    longest = bins if max_segment_bins is None else int(max_segment_bins)
    if longest < 1:
        raise SignkinError(
            f"max_segment_bins is {longest}", file=name, expected="a whole number from 1"
        )
    longest = min(longest, bins)
    if max_count is not None and (max_count != int(max_count) or max_count < 0):
        raise SignkinError(f"max_count is {max_count}", file=name, expected="a whole number from 0")
    n_orders = max(wanted) + 1
    try:
        made = tables(prior, bins, longest, dims, n_orders, dt_s)
    except SignkinError as error:
        raise error.at(file=name) from error
    whitened = whitened_by(x, prior)
    if not np.abs(whitened).max() < MOST_NOISES:
        raise SignkinError(
            f"positions up to {np.abs(whitened).max():.1e} times the prior's noise",
            file=name,
            expected=f"less than {MOST_NOISES:.0e}",
            todo="Check the unit of the data against that of noise_sd.",
        )
    every = max_count is not None or bins <= EVERY_COUNT_UP_TO
    if every:
        evidence = by_segment(whitened, bins, made, longest)
        found = counted(evidence, wanted, bins, longest, max_count)
    else:
        found = in_band(by_order(whitened, bins, made, longest), wanted, bins, longest)
    mean = noise = None
    if expectations:
        inverse_scale = prior.inverse_scale(dims)
        mean, noise = expect(whitened, bins, made, found.segments, wanted, inverse_scale)
    return Posterior(
        x=x,
        prior=prior,
        dt_s=dt_s,
        orders=wanted,
        max_segment_bins=longest,
        log_evidence_by_count=found.log_by_count - log_uniform(bins),
        log_evidence=found.log_evidence,
        order_probability=np.exp(found.log_evidence - log_sum(found.log_evidence)),
        cut_mass=found.cut_mass,
        _count_probability=found.probability,
        _boundary=found.boundary,
        _mean=mean,
        _noise=noise,
    )


def fit_many(
    trajectories: Sequence[Floats],
    orders: Sequence[int] = tuple(range(8)),
    prior: Prior | Sequence[Prior] | None = None,
    dt_s: float | Sequence[float] | None = None,
    workers: int = 1,
    names: Sequence[str] | None = None,
    **options: object,
) -> list[Posterior]:
    """Fit many trajectories, on `workers` cores; the results do not depend on how many.

    The kernels run without Python's lock, so threads share the work. prior, dt_s: one for all,
    or one each. options: as for `fit`.
    """
    n = len(trajectories)
    priors = [prior] * n if prior is None or isinstance(prior, Prior) else list(prior)
    steps = list(dt_s) if isinstance(dt_s, Sequence) else [dt_s] * n
    called = [f"trajectory {i + 1}" for i in range(n)] if names is None else list(names)

    def one(job: tuple[Floats, Prior | None, float | None, str]) -> Posterior:
        x, of_it, step, name = job
        return fit(x, orders, of_it, dt_s=step, name=name, **options)  # type: ignore[arg-type]

    jobs = zip(trajectories, priors, steps, called, strict=True)
    if workers <= 1:
        return [one(job) for job in jobs]
    with ThreadPoolExecutor(max_workers=workers) as pool:
        return list(pool.map(one, jobs))


def segment_log_evidence(X: Floats, order: int, prior: Prior, dt_s: float | None = None) -> Floats:
    """Return ln P(X[i..j]) of every segment, (T, T) at [i, j], inclusive; -inf for j < i.

    Local time runs from 1 to the segment's number of bins. X is taken as given.
    """
    x, _ = _checked(X, [order], "trajectory", least_bins=1)
    bins, dims = x.shape
    made = tables(prior, bins, bins, dims, order + 1, dt_s)
    by_length = by_order(whitened_by(x, prior), bins, made, bins)[order]
    out = np.full((bins, bins), -np.inf)
    for i in range(bins):
        out[i, i:] = by_length[i, : bins - i]
    return out


def _checked(
    X: Floats, orders: Sequence[int], name: str, least_bins: int = 2
) -> tuple[Floats, tuple[int, ...]]:
    try:
        x = np.array(X, dtype=float, order="C")  # a copy: the caller may go on with his own
    except (TypeError, ValueError) as error:
        raise SignkinError(
            f"the data are not an array of numbers ({error})",
            file=name,
            expected="(bins, dimensions)",
        ) from None
    if x.ndim == 1:
        x = x[:, np.newaxis]
    if x.ndim != 2 or x.shape[0] < least_bins or x.shape[1] < 1:
        raise SignkinError(
            f"the data have shape {np.shape(X)}",
            file=name,
            expected=f"(bins, dimensions) with {least_bins} bins or more",
        )
    bad = ~np.isfinite(x).all(axis=1)
    if bad.any():
        raise SignkinError(
            f"{int(bad.sum())} bins have no value",
            file=name,
            place=f"bin {int(np.argmax(bad))}",
            expected="finite values; fill or cut out gaps first",
        )
    wanted = tuple(int(order) if order == int(order) else -1 for order in orders)
    if (
        not wanted
        or min(wanted) < 0
        or max(wanted) > HIGHEST_ORDER
        or len(set(wanted)) < len(wanted)
    ):
        raise SignkinError(
            f"the orders are {list(orders)}",
            file=name,
            expected=f"different orders from 0 to {HIGHEST_ORDER}",
        )
    if max(wanted) >= x.shape[0]:
        raise SignkinError(
            f"order {max(wanted)} with {x.shape[0]} bins",
            file=name,
            expected="more bins than the order",
            todo="Leave out the high orders, or take more bins.",
        )
    return x, wanted
