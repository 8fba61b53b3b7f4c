"""Bayesian binning the slow way, straight from its formulas: shares no code with the engine.

A segment of n bins, X (n, L), has the marginal density of a matrix Student t: with the
coefficients summed out, its rows have the covariance K = I + Phi Phi' / b, and

    ln p(X) = ln G_L((nu + n)/2) - ln G_L(nu/2) - nL/2 ln pi - L/2 ln|K|
              + nu/2 ln|V^-1| - (nu + n)/2 ln|V^-1 + X' K^-1 X|

The posterior mean of its trajectory is X - K^-1 X. Segmentations are enumerated one by one.
K is inverted with 60 digits: it is as good as singular in floating point.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, pairwise

import mpmath as mp
import numpy as np
from scipy.special import logsumexp, multigammaln
from scipy.stats import wishart

DIGITS = 60


@dataclass(frozen=True)
class Model:
    """The prior of a segment by what stands in the formulas, for a trajectory of `bins` bins."""

    inverse_scale: np.ndarray  # (L, L), V^-1
    dof: float
    b: float
    step: float  # the polynomials' time of one bin


def exact_log_evidence(X, order, model):
    """Return ln p(segment) as mpmath number, by the normal equations, with 60 digits."""
    with mp.workdps(DIGITS):
        n, dims = X.shape
        phi, inverse, log_det = normal_equations(n, order, model.b, model.step)
        x = [[mp.mpf(float(value)) for value in row] for row in X]
        moments = [
            [mp.fsum(phi[k][i] * x[k][p] for k in range(n)) for p in range(dims)]
            for i in range(order + 1)
        ]
        scale = mp.matrix(dims, dims)
        for p in range(dims):
            for q in range(dims):
                fitted = mp.fsum(
                    moments[i][p] * inverse[i, j] * moments[j][q]
                    for i in range(order + 1)
                    for j in range(order + 1)
                )
                scale[p, q] = mp.mpf(float(model.inverse_scale[p, q])) - fitted
                scale[p, q] += mp.fsum(x[k][p] * x[k][q] for k in range(n))
        nu, b = mp.mpf(model.dof), mp.mpf(model.b)
        prior_scale = mp.matrix(model.inverse_scale.tolist())
        return (
            -mp.mpf(n * dims) / 2 * mp.log(mp.pi)
            + mp.mpf(dims) / 2 * ((order + 1) * mp.log(b) - log_det)
            + nu / 2 * mp.log(mp.det(prior_scale))
            - (nu + n) / 2 * mp.log(mp.det(scale))
            + _log_gamma((nu + n) / 2, dims)
            - _log_gamma(nu / 2, dims)
        )


@lru_cache(maxsize=512)
def normal_equations(n, order, b, step):
    """Return Phi (lists), (b I + Phi'Phi)^-1 and the log of that matrix's determinant."""
    with mp.workdps(DIGITS):
        phi = [[(mp.mpf(step) * (k + 1)) ** i for i in range(order + 1)] for k in range(n)]
        a = mp.matrix(order + 1, order + 1)
        for i in range(order + 1):
            for j in range(order + 1):
                a[i, j] = mp.fsum(row[i] * row[j] for row in phi)
            a[i, i] += mp.mpf(b)
        return phi, mp.inverse(a), mp.log(mp.det(a))


def _log_gamma(a, dims):
    each = mp.fsum(mp.loggamma(a - mp.mpf(j) / 2) for j in range(dims))
    return mp.mpf(dims * (dims - 1)) / 4 * mp.log(mp.pi) + each


@lru_cache(maxsize=512)
def row_precision(n, order, b, step):
    """Return K^-1 (n, n) and ln|K|, rounded from 60 digits."""
    with mp.workdps(DIGITS):
        phi = mp.matrix(n, order + 1)
        for k in range(n):
            for i in range(order + 1):
                phi[k, i] = (mp.mpf(step) * (k + 1)) ** i
        k = mp.eye(n) + phi * phi.T / mp.mpf(b)
        return np.array(mp.inverse(k).tolist(), dtype=float), float(mp.log(mp.det(k)))


def drawn(rng, lengths, order, dims, prior):
    """Return a trajectory drawn from the prior, of segments of so many bins, (T, dims)."""
    parts = []
    for n in lengths:
        precision = np.atleast_2d(
            wishart(prior.degrees(dims), np.diag(1 / prior.inverse_scale(dims))).rvs(
                random_state=rng
            )
        )
        root = np.linalg.cholesky(np.linalg.inv(precision))
        weights = rng.normal(size=(order + 1, dims)) @ root.T / np.sqrt(prior.concentration)
        time = np.arange(1, n + 1)[:, None] ** np.arange(order + 1.0)
        parts.append(time @ weights + rng.normal(size=(n, dims)) @ root.T)
    return np.concatenate(parts)


def segment(X, order, model):
    """Return ln p(X), the mean trajectory (n, L) and the noise covariance of one segment."""
    n, dims = X.shape
    precision, log_det = row_precision(n, order, model.b, model.step)
    residual = precision @ X
    scale = model.inverse_scale + X.T @ residual
    log_p = (
        multigammaln((model.dof + n) / 2, dims)
        - multigammaln(model.dof / 2, dims)
        - n * dims / 2 * math.log(math.pi)
        - dims / 2 * log_det
        + model.dof / 2 * np.linalg.slogdet(model.inverse_scale)[1]
        - (model.dof + n) / 2 * np.linalg.slogdet(scale)[1]
    )
    return log_p, X - residual, scale / (model.dof + n)


def segmentations(bins, count, longest=None):
    """Yield all ways to put `count` inner boundaries, as segments (first bin, last bin)."""
    for cut in combinations(range(bins - 1), count):
        edges = [-1, *cut, bins - 1]
        parts = [(a + 1, b) for a, b in pairwise(edges)]
        if longest is None or all(b - a < longest for a, b in parts):
            yield parts


@dataclass
class Enumerated:
    """What the sum over all segmentations gives for one order."""

    log_evidence_by_count: np.ndarray
    log_evidence: float
    count: np.ndarray
    boundary: np.ndarray
    mean: np.ndarray
    noise: np.ndarray
    best: dict[int, list[int]]


def enumerate_all(X, order, model, longest=None):
    """Return the posterior for one order from every segmentation of X, one by one."""
    bins, dims = X.shape
    made = {
        (i, j): segment(X[i : j + 1], order, model)
        for i in range(bins)
        for j in range(i, min(bins, i + (longest or bins)))
    }
    ways, log_by_count, best = [], np.full(bins, -np.inf), {}
    for count in range(bins):
        each = list(segmentations(bins, count, longest))
        if not each:
            continue
        log_p = np.array([sum(made[part][0] for part in parts) for parts in each])
        log_by_count[count] = logsumexp(log_p) - math.log(len(each))
        best[count] = [b for _, b in each[int(np.argmax(log_p))][:-1]]
        # P(M) = 1/T (eq. 8) and one over the number of segmentations with M boundaries (eq. 7).
        weights = log_p - math.log(len(each)) - math.log(bins)
        ways += [(parts, count, w) for parts, w in zip(each, weights, strict=True)]
    total = float(logsumexp([w for _, _, w in ways]))
    out = Enumerated(
        log_by_count, total, np.zeros(bins), np.zeros(bins - 1), np.zeros((bins, dims)),
        np.zeros((dims, dims)), best,
    )  # fmt: skip
    for parts, count, w in ways:
        chance = math.exp(w - total)
        out.count[count] += chance
        for i, j in parts:
            if j < bins - 1:
                out.boundary[j] += chance
            _, mean, noise = made[i, j]
            out.mean[i : j + 1] += chance * mean
            out.noise += chance * noise * (j - i + 1) / bins
    return out
