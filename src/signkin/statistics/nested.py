"""The likelihood of a linear model with nested random intercepts, and its maximum.

y = X beta + u(outer) + w(inner) + e, all three normal; inner levels (recordings) lie in outer
ones (signers). With H the covariance over the residual variance, both the determinant of H and
the quadratic forms in its inverse follow from means by level, as sums of squares: nothing
cancels, and a variance of 0 is an ordinary point. (statsmodels' mixedlm is singular there, and
its optimisers stop short of it.) beta and the residual variance are profiled out, as in lme4
(Bates et al. 2015, J. Stat. Softw. 67(1), section 3.4); what is searched are the SDs of the
random effects over that of the residuals.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from signkin.errors import SignkinError

Array = NDArray[np.float64]
Deviance = Callable[[Array], float]
# Differences in log-likelihood below this are none.
EDGE = 1e-5
STARTS = (0.1, 1.0)  # SDs of random effects over that of the residuals


@dataclass(frozen=True, eq=False)
class Nested:
    """Data of the model: X (N, P), y (N,), the levels (N,) of one or two nested factors.

    outer: an inner level lies in one outer level; None where there is one factor only.
    """

    x: Array
    y: Array
    inner: NDArray[np.intp]
    outer: NDArray[np.intp] | None = None

    def log_likelihood(self, ratios: Array) -> float:
        """Return the profiled log-likelihood. ratios: SDs (inner[, outer]) over the residuals'."""
        rss, log_det, _ = self._solved(ratios)
        n = len(self.y)
        return float(-0.5 * (n * (np.log(2 * np.pi * rss / n) + 1) + log_det))

    def residual_variance(self, ratios: Array) -> float:
        """Return the maximum-likelihood estimate of the residual variance."""
        return float(self._solved(ratios)[0] / len(self.y))

    def effects(self, ratios: Array) -> Array:
        """Return beta, (P,)."""
        return self._solved(ratios)[2]

    @cached_property
    def _sums(self) -> tuple[Array, Array, Array, NDArray[np.intp]]:
        """Return scatter within inner levels, their sizes and means, and their outer levels."""
        both = np.column_stack([self.x, self.y - self.y.mean()])
        counts = np.bincount(self.inner).astype(float)
        means = _by_level(self.inner, both) / counts[:, None]
        deep = both - means[self.inner]
        parent = np.zeros(len(counts), dtype=np.intp)
        if self.outer is not None:
            parent[self.inner] = self.outer
        return deep.T @ deep, counts, means, parent

    def _solved(self, ratios: Array) -> tuple[float, float, Array]:
        """Return the residual sum of squares, the log-determinant of H and beta."""
        within, counts, means, parent = self._sums
        a = float(ratios[0]) ** 2
        log_det = np.log1p(a * counts).sum()
        weights = counts / (1 + a * counts)
        if self.outer is None:
            scatter = within + (weights[:, None] * means).T @ means
        else:
            b = float(ratios[1]) ** 2
            sums = np.bincount(parent, weights)
            centres = _by_level(parent, weights[:, None] * means) / sums[:, None]
            between = means - centres[parent]
            scatter = within + (weights[:, None] * between).T @ between
            scatter = scatter + ((sums / (1 + b * sums))[:, None] * centres).T @ centres
            log_det += np.log1p(b * sums).sum()
        p = self.x.shape[1]
        beta = np.linalg.solve(scatter[:p, :p], scatter[:p, p])
        rss = max(float(scatter[p, p] - scatter[:p, p] @ beta), 0.0)
        return rss, float(log_det), np.asarray(beta, dtype=float)


def _by_level(level: NDArray[np.intp], rows: Array) -> Array:
    return np.column_stack([np.bincount(level, column) for column in rows.T])


# --- the maximum -----------------------------------------------------------------------------


def _scipy(method: str, deviance: Deviance, start: Array) -> tuple[Array, bool]:
    options = {"Nelder-Mead": {"xatol": 1e-7, "fatol": 1e-9, "maxiter": 4000}}.get(method, {})
    found = minimize(
        deviance, start, method=method, bounds=[(0.0, 1e4)] * len(start), options=options
    )
    return np.asarray(found.x, dtype=float), bool(found.success)


OPTIMISERS: Mapping[str, Callable[[Deviance, Array], tuple[Array, bool]]] = {
    method: partial(_scipy, method) for method in ("L-BFGS-B", "Nelder-Mead", "Powell", "SLSQP")
}


@dataclass(frozen=True, eq=False)
class Maximum:
    """The best maximum that any optimiser settled on.

    ratios: SDs (inner[, outer]) over the residuals', exactly 0 where that is as likely. short:
    optimiser -> how far below the maximum (log-likelihood) it stopped; empty where all agree.
    """

    log_likelihood: float
    ratios: Array
    short: Mapping[str, float]


def maximum(
    model: Nested,
    optimisers: Mapping[str, Callable[[Deviance, Array], tuple[Array, bool]]] = OPTIMISERS,
) -> Maximum:
    """Maximise the likelihood by several optimisers from several starts.

    The best point counts only where an optimiser says that it has converged and no step along a
    ratio, up or down, is more likely. Raises SignkinError where none settles so.
    """
    k = 1 if model.outer is None else 2

    def deviance(ratios: Array) -> float:
        return -2 * model.log_likelihood(np.abs(ratios))

    best: dict[str, float] = {}
    settled: list[tuple[float, Array]] = []
    for name, optimise in optimisers.items():
        for start in product(STARTS, repeat=k):
            at, converged = optimise(deviance, np.array(start))
            at = _onto_edges(model, np.abs(at))
            reached = model.log_likelihood(at)
            if not np.isfinite(reached):
                continue
            best[name] = max(best.get(name, -np.inf), reached)
            if converged and _is_top(model, at, reached):
                settled.append((reached, at))
    top = max(best.values(), default=-np.inf)
    if not settled or max(s[0] for s in settled) < top - EDGE:
        raise SignkinError("no optimiser settles on a maximum of the likelihood")
    value, at = max(settled, key=lambda s: s[0])
    short = {name: value - reached for name, reached in best.items() if reached < value - EDGE}
    short |= {name: np.inf for name in optimisers if name not in best}
    return Maximum(value, at, short)


def _onto_edges(model: Nested, ratios: Array) -> Array:
    """Put ratios to exactly 0 where that is as likely."""
    for i in np.flatnonzero(ratios):
        edge = ratios.copy()
        edge[i] = 0.0
        if model.log_likelihood(edge) >= model.log_likelihood(ratios) - EDGE:
            ratios = edge
    return ratios


def _is_top(model: Nested, ratios: Array, reached: float) -> bool:
    """Tell whether no small step along one ratio gains more than what is no difference."""
    steps = (1e-3, 0.03, 0.3)
    for i, step, sign in product(range(len(ratios)), steps, (-1, 1)):
        beside = ratios.copy()
        beside[i] = max(0.0, beside[i] + sign * step * max(beside[i], 0.1))
        if model.log_likelihood(beside) > reached + 10 * EDGE:
            return False
    return True
