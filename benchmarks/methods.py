"""The methods that are compared: data in, boundaries out (as first bins of segments)."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from benchmarks.cubic_cost import CompiledCost, MomentsCost
from benchmarks.trajectories import BIN_S, NOISE_SD
from signkin.binning import Prior, fit
from signkin.binning.maxima import greedy_maxima

F = NDArray[np.float64]
Boundaries = NDArray[np.int64]
Run = Callable[[F, int], Boundaries]  # data (T, L) and the true number of boundaries
PRIOR = Prior(noise_sd=NOISE_SD)
ORDERS = range(8)


@dataclass(frozen=True)
class Method:
    """One method. told: what it knows beside the data. sizes: the T at which it is run."""

    name: str
    told: str
    run: Run
    sizes: tuple[int, ...]
    needs: str = ""  # the module without which it is left out
    score: bool = True

    @property
    def there(self) -> bool:
        """Whether its package is installed."""
        return not self.needs or importlib.util.find_spec(self.needs) is not None


def ours(x: F, _: int, **options: object) -> Boundaries:
    """Return the boundaries at the most probable order; everything else is worked out too."""
    found = fit(x, ORDERS, PRIOR, **options)  # type: ignore[arg-type]
    order = found.orders[int(np.argmax(found.order_probability))]
    return found.boundaries(order) + 1


def one_order(x: F, _: int) -> Boundaries:
    """Return what PELT is asked for, no more: boundaries at order 3, no trajectories."""
    return fit(x, (3,), PRIOR, max_count=20, expectations=False).boundaries(3) + 1


def bic(x: F) -> float:
    """Return the penalty of a segment: 4 coefficients an axis and one boundary."""
    return (4 * x.shape[1] + 1) * float(np.log(len(x)))


def pelt(x: F, _: int, cost: type) -> Boundaries:
    """Return the boundaries of ruptures' PELT, every bin a candidate."""
    import ruptures

    search = ruptures.Pelt(custom_cost=cost(NOISE_SD), min_size=5, jump=1)
    return np.array(search.fit_predict(x, pen=bic(x))[:-1], dtype=np.int64)


def dynp(x: F, count: int) -> Boundaries:
    """Return the best cut into as many segments as there truly are."""
    import ruptures

    search = ruptures.Dynp(custom_cost=CompiledCost(NOISE_SD), min_size=5, jump=1)
    return np.array(search.fit_predict(x, n_bkps=count)[:-1], dtype=np.int64)


def pelt_normal(x: F, _: int) -> Boundaries:
    """Return the boundaries of ruptures-rs' PELT: jumps of mean and covariance."""
    import ruptures_rs

    search = ruptures_rs.Pelt(model="normal", min_size=5, jump=1)
    return np.array(search.fit_predict(x, pen=(9 + 1) * np.log(len(x)))[:-1], dtype=np.int64)


def regression(x: F, _: int) -> Boundaries:
    """Return the boundaries of skchange's PELT with a cubic in time, of the first axis alone."""
    from skchange.detectors import PELT
    from skchange.interval_scorers import LinearRegressionCost

    time = np.linspace(-1, 1, len(x))[:, None] ** np.arange(4)
    search = PELT(LinearRegressionCost(), penalty=5 * float(np.log(len(x))))
    return np.asarray(search.fit_predict(np.column_stack([x[:, 0] / NOISE_SD, time])), np.int64)


def on_acceleration(x: F, _: int) -> Boundaries:
    """Return bayesian-changepoint's boundaries: jumps of mean and covariance of acceleration.

    As many maxima as it expects boundaries. Acceleration is that of local cubics of 9 bins.
    """
    import torch
    from bayesian_changepoint_detection import const_prior, offline_changepoint_detection
    from bayesian_changepoint_detection.offline_likelihoods import MultivariateT

    acceleration = savgol_filter(x, 9, 3, deriv=2, delta=BIN_S, axis=0)
    scaled = torch.from_numpy(acceleration / acceleration.std())
    prior = partial(const_prior, p=1 / (len(x) + 1))
    _, _, by_rank = offline_changepoint_detection(scaled, prior, MultivariateT(dims=x.shape[1]))
    probability = by_rank.exp().sum(0).numpy()
    return greedy_maxima(probability, round(float(probability.sum()))) + 1


def beast(x: F, _: int) -> Boundaries:
    """Return Rbeast's boundaries: trends of orders 0 to 3, each axis alone, then put together."""
    import Rbeast

    found: list[int] = []
    for axis in x.T:
        out = Rbeast.beast(
            axis, season="none", torder_minmax=[0, 3], tcp_minmax=[0, max(10, len(x) // 25)],
            tseg_minlength=5, quiet=True, print_param=False, print_progress=False,
            print_warning=False, mcmc_seed=1,
        )  # fmt: skip
        count = int(np.atleast_1d(out.trend.ncp_median)[0])
        found += [int(cp) - 1 for cp in np.atleast_1d(out.trend.cp)[:count] if np.isfinite(cp)]
    kept: list[int] = []
    for at in sorted(found):
        if not kept or at - kept[-1] > 3:
            kept.append(at)
    return np.array(kept, dtype=np.int64)


METHODS = (
    Method("signkin, M <= 20", "noise", partial(ours, max_count=20), (100, 1000)),
    Method("signkin, every M", "noise", ours, (100,)),
    Method("signkin, likely M", "noise", partial(ours, every_count=False), (100, 1000)),
    Method("signkin, segments <= 200 bins", "noise", partial(ours, max_segment_bins=200),
           (1000, 5000)),
    Method("signkin, order 3 only, M <= 20", "noise, order", one_order, (100, 1000)),
    Method("ruptures PELT, cubic in numpy", "noise, order", partial(pelt, cost=MomentsCost),
           (100,), "ruptures"),
    Method("ruptures PELT, cubic compiled", "noise, order", partial(pelt, cost=CompiledCost),
           (100, 1000, 5000), "ruptures"),
    Method("ruptures Dynp, cubic compiled", "true M, order", dynp, (100,), "ruptures"),
    Method("skchange PELT, cubic", "noise, order; one axis", regression, (100, 1000, 5000),
           "skchange"),
    Method("bayesian-changepoint", "acceleration", on_acceleration, (100, 1000), "torch"),
    Method("Rbeast", "each axis alone", beast, (100, 1000), "Rbeast"),
    Method("ruptures-rs PELT, normal", "nothing", pelt_normal, (100, 1000, 5000), "ruptures_rs"),
)  # fmt: skip
