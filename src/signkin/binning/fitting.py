"""Fit trajectories: data and settings are checked here, and the parts put together."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from signkin.binning.all_counts import Found, counted, in_band, log_sum
from signkin.binning.evidence import Engine
from signkin.binning.evidence_alone import log_evidences_of
from signkin.binning.longer import bound_on_longer
from signkin.binning.posterior import Posterior
from signkin.binning.prior import HIGHEST_ORDER, Prior, tables
from signkin.binning.segmentation_prior import log_uniform
from signkin.binning.stretches import Stretches, in_stretches
from signkin.errors import SignkinError, listed
from signkin.masked import unmasked

Floats = NDArray[np.float64]
Done = TypeVar("Done")

# Above so many bins not every M is worked out unless asked for: the cost grows with M T^2.
EVERY_COUNT_UP_TO = 256
# Without a longest segment, a series of more bins has those left out that are unlikely long.
LEFT_OUT_ABOVE = 2000
LOOKED_AT = 256  # bins of the longest that are looked at at first
# Above so many bins (200 s of 20 ms) a series with a longest segment is binned in stretches.
WHOLE_UP_TO = 10_000
LEAST_STRETCHES = 8  # of the longest segment


def fit(
    X: Floats,
    orders: Sequence[int] = tuple(range(8)),
    prior: Prior | None = None,
    dt_s: float | None = None,
    max_count: int | None = None,
    max_segment_bins: int | None = None,
    expectations: bool | Sequence[int] = True,
    name: str = "trajectory",
    sample_at: float = 0.5,
    whole_up_to: int = WHOLE_UP_TO,
    every_count: bool = True,
) -> Posterior:
    """Return the posterior of one trajectory for all orders at once.

    X: (T, L), taken as given: the prior's coefficients are around 0, so centre it first.
    Masked values are gaps.
    orders: polynomial orders. prior: mandatory. dt_s: duration of a bin, for
    Prior(time_unit="second") and `Posterior.boundaries_s`. sample_at: where in its bin a sample
    stands, as a share of the bin: in the middle, or 0 where bins are frames.
    max_count: the largest M worked out; None is every M up to 256 bins, and above those around
    the likely M, the others being -inf; either way `cut_mass` bounds the share of P(M | D) that
    is left out. A count takes 128 bytes of memory a bin.
    every_count: whether short series have the M worked out whose share is below 1e-12, too: without
    them a fit takes half the time.
    max_segment_bins: the longest segment; segmentations with longer ones have no prior
    probability, the others share it evenly.
    whole_up_to: a series of more bins, and with a longest segment of no more than an eighth of it,
    is gone through in stretches, in little memory (stretches.py): what differs is less than 1e-6
    in the log evidence, and elsewhere less than `cut_mass`, which then bounds it.
    expectations: whether to work out expected trajectories and noise too, or of which orders.

    Raises SignkinError that names the trajectory for gaps, too few bins, impossible orders.
    """
    prior = _a_prior(prior, name)
    if dt_s is not None:
        dt_s = _positive(dt_s, "dt_s", name)
    x, wanted = _checked(X, orders, name)
    bins = len(x)
    longest = bins
    if max_segment_bins is not None:
        longest = min(_whole(max_segment_bins, "max_segment_bins", 1, name), bins)
    if max_count is not None:
        max_count = _whole(max_count, "max_count", 0, name)
    try:
        engine = Engine(x, prior, longest, max(wanted) + 1, dt_s)
    except SignkinError as error:
        raise error.at(file=name) from error
    every = max_count is not None or bins <= EVERY_COUNT_UP_TO
    expected = _expected(expectations, wanted, name)
    mean = noise = None
    if not every and bins > whole_up_to and longest <= bins // LEAST_STRETCHES:
        series = Stretches.of(x, prior, longest, max(wanted) + 1, dt_s)
        cut = in_stretches(series, wanted, expected)
        found, mean, noise = cut.found, cut.mean, cut.noise
    elif every:
        found = counted(engine.by_segment(), wanted, bins, longest, max_count, not every_count)
    else:
        found, engine = _likely_counts(x, prior, wanted, dt_s, engine)
    if expected and mean is None:
        mean, noise = engine.expect(found.segments, expected)
    return Posterior(
        x=x,
        prior=prior,
        dt_s=dt_s,
        sample_at=float(sample_at),
        orders=wanted,
        max_segment_bins=longest,
        log_evidence_by_count=found.log_by_count - log_uniform(bins),
        log_evidence=found.log_evidence,
        order_probability=np.exp(found.log_evidence - log_sum(found.log_evidence)),
        cut_mass=found.cut_mass,
        _count_probability=found.probability,
        _boundary=found.boundary,
        _expected=expected,
        _mean=mean,
        _noise=noise,
    )


def _likely_counts(
    x: Floats, prior: Prior, wanted: tuple[int, ...], dt_s: float | None, engine: Engine
) -> tuple[Found, Engine]:
    """Return the likely counts of a long series, and the kernels for the segments looked at.

    Those too long to be likely are left out where a bound says that they add nothing.
    """
    bins, longest, orders = engine.bins, engine.longest, engine.n_orders
    if longest == bins and bins > LEFT_OUT_ABOVE:
        longer = bound_on_longer(tables(prior, bins, bins, engine.dims, orders, dt_s), bins)
        looked_at = LOOKED_AT
        while 4 * looked_at < 3 * bins:
            short = Engine(x, prior, looked_at, orders, dt_s)
            found = in_band(short.by_order(), wanted, bins, bins, longer)
            if found is not None:
                return found, short
            looked_at += looked_at // 2
    found = in_band(engine.by_order(), wanted, bins, longest)
    assert found is not None
    return found, engine


def _expected(
    expectations: bool | Sequence[int], wanted: tuple[int, ...], name: str
) -> tuple[int, ...]:
    """Return the orders of which expectations are to be worked out."""
    if isinstance(expectations, bool):
        return wanted if expectations else ()
    asked = tuple(expectations)
    if not set(asked) <= set(wanted):
        raise SignkinError(
            f"expectations of the orders {listed(asked)}", file=name,
            expected=f"of {listed(wanted)}, which are fitted",
        )  # fmt: skip
    return asked


def fit_many(
    trajectories: Sequence[Floats],
    orders: Sequence[int] = tuple(range(8)),
    prior: Prior | Sequence[Prior] | None = None,
    dt_s: float | Sequence[float] | None = None,
    workers: int = 1,
    names: Sequence[str] | None = None,
    sample_at: float | Sequence[float] = 0.5,
    **options: Any,
) -> list[Posterior]:
    """Fit many trajectories, on `workers` cores; the results do not depend on how many.

    The kernels run without Python's lock, so threads share the work. prior, dt_s,
    sample_at: one for all, or one each. options: as for `fit`.
    """
    n = len(trajectories)
    places = [sample_at] * n if np.ndim(sample_at) == 0 else _each(sample_at, "sample_at", n)

    def one(job: tuple[Floats, Any, Any, str, Any]) -> Posterior:
        x, of_it, step, name, place = job
        return fit(x, orders, of_it, step, name=name, sample_at=place, **options)

    told = _told(n, prior, dt_s, names)
    return _on_cores(workers, one, zip(trajectories, *told, places, strict=True))


def log_evidences_of_many(
    trajectories: Sequence[Floats], orders: Sequence[int], prior: Prior | Sequence[Prior],
    dt_s: float | Sequence[float] | None = None, workers: int = 1,
    names: Sequence[str] | None = None,
) -> list[Floats]:  # fmt: skip
    """Return the `log_evidence` of each of many trajectories; arguments as for `fit_many`."""

    def one(job: tuple[Floats, Any, Any, str]) -> Floats:
        x, of_it, step, name = job
        return log_evidence(x, orders, of_it, step, name)

    told = _told(len(trajectories), prior, dt_s, names)
    return _on_cores(workers, one, zip(trajectories, *told, strict=True))


def _told(n: int, prior: Any, dt_s: Any, names: Any) -> tuple[list[Any], list[Any], list[str]]:
    """Return a prior, a duration of bins and a name for each of n trajectories."""
    priors = [prior] * n if prior is None or isinstance(prior, Prior) else _each(prior, "prior", n)
    steps = [dt_s] * n if dt_s is None or np.ndim(dt_s) == 0 else _each(dt_s, "dt_s", n)
    called = (
        [f"trajectory {i + 1}" for i in range(n)] if names is None else _each(names, "names", n)
    )
    return priors, steps, called


def _on_cores(workers: int, one: Callable[[Any], Done], jobs: Iterable[Any]) -> list[Done]:
    if workers <= 1:
        return [one(job) for job in jobs]
    return list(_pool(workers).map(one, jobs))


@cache
def _pool(workers: int) -> ThreadPoolExecutor:
    """Return threads that stay, with the memory that each of them works in (room.py)."""
    return ThreadPoolExecutor(max_workers=workers, thread_name_prefix="binning")


def log_evidence(
    X: Floats, orders: Sequence[int], prior: Prior, dt_s: float | None = None,
    name: str = "trajectory",
) -> Floats:  # fmt: skip
    """Return `fit(...).log_evidence`, ln P(D | S) of the orders, in half its time."""
    if len(X) > EVERY_COUNT_UP_TO:
        return fit(X, orders, prior, dt_s, expectations=False, name=name).log_evidence
    prior = _a_prior(prior, name)
    step = None if dt_s is None else _positive(dt_s, "dt_s", name)
    x, wanted = _checked(X, orders, name)
    bins = len(x)
    try:
        engine = Engine(x, prior, bins, max(wanted) + 1, step)
    except SignkinError as error:
        raise error.at(file=name) from error
    return log_evidences_of(engine.by_segment(), wanted, bins, bins)


def segment_log_evidence(X: Floats, order: int, prior: Prior, dt_s: float | None = None) -> Floats:
    """Return ln P(X[i..j]) of every segment, (T, T) at [i, j], inclusive; -inf for j < i.

    Local time runs from 1 to the segment's number of bins. X is taken as given.
    """
    prior = _a_prior(prior, "trajectory")
    x, _ = _checked(X, [order], "trajectory", least_bins=1)
    bins = len(x)
    by_length = Engine(x, prior, bins, order + 1, dt_s).by_order()[order]
    out = np.full((bins, bins), -np.inf)
    for i in range(bins):
        out[i, i:] = by_length[i, : bins - i]
    return out


def _checked(
    X: Floats, orders: Sequence[int], name: str, least_bins: int = 2
) -> tuple[Floats, tuple[int, ...]]:
    try:
        x: Floats  # a copy: the caller may go on with his own
        x = np.array(unmasked(X), dtype=float, order="C")
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
    wanted = _orders(orders, name)
    if max(wanted) >= x.shape[0]:
        raise SignkinError(
            f"order {max(wanted)} with {x.shape[0]} bins",
            file=name,
            expected="more bins than the order",
            todo="Leave out the high orders, or take more bins.",
        )
    return x, wanted


def _orders(orders: object, name: str) -> tuple[int, ...]:
    expected = f"different orders from 0 to {HIGHEST_ORDER}, as (0, 1, 3)"
    try:
        given = [float(order) for order in orders]  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        raise SignkinError(f"the orders are {orders!r}", file=name, expected=expected) from None
    wanted = tuple(int(order) if order.is_integer() else -1 for order in given)
    if (
        not wanted
        or min(wanted) < 0
        or max(wanted) > HIGHEST_ORDER
        or len(set(wanted)) < len(wanted)
    ):
        raise SignkinError(f"the orders are {orders!r}", file=name, expected=expected)
    return wanted


def _a_prior(prior: object, name: str) -> Prior:
    if isinstance(prior, Prior):
        return prior
    raise SignkinError(
        "no prior" if prior is None else f"the prior is {prior!r:.60}",
        file=name,
        expected="Prior(noise_sd=...)",
    )


def _positive(value: Any, what: str, name: str) -> float:
    if isinstance(value, (int, float, np.number)) and 0 < value < np.inf:
        return float(value)
    raise SignkinError(f"{what} is {value!r}", file=name, expected="a number above 0")


def _whole(value: Any, what: str, least: int, name: str) -> int:
    try:
        whole = int(value)
        if whole == value and whole >= least:
            return whole
    except (TypeError, ValueError, OverflowError):
        pass
    raise SignkinError(
        f"{what} is {value!r}", file=name, expected=f"a whole number from {least}"
    ) from None


def _each(values: Any, what: str, n: int) -> list[Any]:
    if isinstance(values, str) or not hasattr(values, "__len__") or len(values) != n:
        raise SignkinError(
            f"{what} is {values!r:.60}", place="fit_many", expected=f"one for all, or {n}"
        )
    return list(values)
