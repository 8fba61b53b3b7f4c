"""The prior's values as the data have them: empirical Bayes (for Endres et al. 2013, 3.2).

The evidence of a corpus, summed over segmentations, is a function of the prior's degrees of
freedom nu, its scale V and the concentration b. Where it is greatest is what the
recordings themselves say of values that a paper does not print. The order is shared: all
trajectories of a group are of the same order S, each order as probable beforehand,

    ln p(D) = sum over groups of ln( mean over S of prod over trajectories of p(D_n | S) ).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from signkin.binning.all_counts import log_sum
from signkin.binning.fitting import log_evidences_of_many
from signkin.binning.prior import Prior
from signkin.errors import SignkinError

Floats = NDArray[np.float64]

# In nats, and in logarithms of the parameters: what neither changes a table nor a verdict.
TOLERANCE_NATS, TOLERANCE_LOG = 0.2, 0.03
# Beyond these the evidence is flat: degrees of freedom so many that the noise is fixed.
MOST_DOF, CONCENTRATIONS = 1e5, (1e-9, 1e9)


@dataclass(frozen=True, eq=False)
class LearntPrior:
    """A prior learnt from trajectories.

    prior: its values, scale `expected`, noise_sd one a dimension. orders: the orders that it was
    learnt with. order_probability: (groups, orders), P(S | D) of each group, as `groups` names
    them. log_evidence: ln p(D) at the prior. evaluations: of the evidence. note: what the reader
    must know, e.g. that a value stands at the end of its range.
    """

    prior: Prior
    orders: tuple[int, ...]
    groups: tuple[str, ...]
    order_probability: Floats
    log_evidence: float
    evaluations: int
    note: str


def learn_prior(
    trajectories: Sequence[Floats], orders: Sequence[int], start: Prior,
    dt_s: float | Sequence[float] | None = None, groups: Sequence[str] | None = None,
    names: Sequence[str] | None = None, workers: int = 1, most_evaluations: int = 600,
) -> LearntPrior:  # fmt: skip
    """Return the prior under which the evidence of all trajectories together is greatest.

    trajectories: each (T, L), centred, of the same L. start: where the search starts; its
    time_unit is kept. groups: whose order is shared, one name a trajectory (its signer); None:
    all. Searched: ln(nu - L + 1), ln SD of the noise, one a dimension, and ln b, by the simplex of
    Nelder and Mead, started again from its end until the evidence stays.

    Raises SignkinError for no trajectory, trajectories of different L, what `fit_many` refuses,
    and a search that does not settle within `most_evaluations`.
    """
    from scipy.optimize import minimize

    dims = _dimensions(trajectories)
    labels = ["all"] * len(trajectories) if groups is None else [str(g) for g in groups]
    if len(labels) != len(trajectories):
        raise SignkinError(
            f"{len(labels)} groups", place="learn_prior", expected=f"one of {len(trajectories)}"
        )
    seen: dict[bytes, Floats] = {}

    def evidence(place: Floats) -> Floats:
        key = place.tobytes()
        if key not in seen:
            seen[key] = log_evidences(
                trajectories, orders, _prior(place, start), dt_s, names, workers
            )
        return seen[key]

    def cost(place: Floats) -> float:
        return -_shared(evidence(place), labels)

    at = _place(start, dims)
    best, settled = cost(at), False
    while not settled and len(seen) < most_evaluations:
        found = minimize(
            cost, at, method="Nelder-Mead", bounds=_bounds(dims),
            options={
                "initial_simplex": _simplex(at, _bounds(dims)), "xatol": TOLERANCE_LOG,
                "fatol": TOLERANCE_NATS, "maxfev": most_evaluations - len(seen) + 1,
            },
        )  # fmt: skip
        settled = bool(found.success) and best - found.fun < 1.0
        at, best = found.x, float(found.fun)
    if not settled:
        raise SignkinError(
            f"the evidence still grows after {len(seen)} evaluations",
            place="learn_prior", expected="a maximum",
            todo="Start from another prior, or allow more evaluations.",
        )  # fmt: skip
    by_group = _by_group(evidence(at), labels)
    return LearntPrior(
        prior=_prior(at, start),
        orders=tuple(orders),
        groups=tuple(by_group),
        order_probability=np.array([np.exp(v - log_sum(v)) for v in by_group.values()]),
        log_evidence=-best,
        evaluations=len(seen),
        note=_edges(at, dims),
    )


def log_evidences(
    trajectories: Sequence[Floats], orders: Sequence[int], prior: Prior | Sequence[Prior],
    dt_s: float | Sequence[float] | None = None, names: Sequence[str] | None = None,
    workers: int = 1,
) -> Floats:  # fmt: skip
    """Return ln P(D_n | S) of trajectories under one prior, or one each, (trajectories, orders)."""
    return np.array(log_evidences_of_many(trajectories, orders, prior, dt_s, workers, names))


def held_out(train: Floats, other: Floats) -> Floats:
    """Return the log predictive density of other trajectories, (other trajectories,).

    train, other: as `log_evidences` of both under the same prior. The order is shared, and known
    as far as the training trajectories tell it: ln sum over S of P(S | train) P(D_n | S).
    """
    total = train.sum(axis=0)
    return np.array([log_sum(row + total) - log_sum(total) for row in other])


def _dimensions(trajectories: Sequence[Floats]) -> int:
    found = {np.shape(x)[1] if np.ndim(x) == 2 else 1 for x in trajectories}
    if len(found) != 1:
        told = " and ".join(map(str, sorted(found))) or "no"
        raise SignkinError(
            f"trajectories of {told} dimensions" if found else "no trajectory",
            place="learn_prior", expected="one or more, all of the same dimensions",
        )  # fmt: skip
    return int(next(iter(found)))


def _by_group(evidence: Floats, labels: Sequence[str]) -> dict[str, Floats]:
    return {
        name: evidence[[label == name for label in labels]].sum(axis=0)
        for name in dict.fromkeys(labels)
    }


def _shared(evidence: Floats, labels: Sequence[str]) -> float:
    orders = evidence.shape[1]
    each = (log_sum(total) for total in _by_group(evidence, labels).values())
    return float(sum(each)) - len(set(labels)) * float(np.log(orders))


def _place(prior: Prior, dims: int) -> Floats:
    """Return a prior as a place of the search."""
    free = prior.degrees(dims) - dims + 1
    return np.log([free, *prior.expected_noise(dims), prior.concentration])


def _prior(place: Floats, start: Prior) -> Prior:
    free, *noise, b = np.exp(place)
    return replace(
        start, noise_sd=tuple(map(float, noise)), dof=float(free) + len(noise) - 1,
        concentration=float(b), scale="expected", length_unit=None,
    )  # fmt: skip


def _bounds(dims: int) -> list[tuple[float | None, float | None]]:
    low, high = np.log(CONCENTRATIONS)
    return [(np.log(1e-3), np.log(MOST_DOF)), *[(None, None)] * dims, (low, high)]


def _simplex(at: Floats, bounds: Sequence[tuple[float | None, float | None]]) -> Floats:
    """Return corners around a place, each parameter moved by a factor of 2, within bounds."""
    out = np.tile(at, (len(at) + 1, 1))
    for i, (_, high) in enumerate(bounds):
        inside = high is None or at[i] + np.log(2) < high
        out[i + 1, i] += np.log(2) if inside else -np.log(2)
    return out


def _edges(place: Floats, dims: int) -> str:
    names = ("degrees of freedom", *["noise"] * dims, "concentration")
    told = [
        f"{name} at the end of the range searched"
        for name, value, (low, high) in zip(names, place, _bounds(dims), strict=True)
        if (low is not None and value - low < 0.05) or (high is not None and high - value < 0.05)
    ]
    return "; ".join(told)
