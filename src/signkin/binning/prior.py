"""The prior of a segment (Endres et al. 2013, section 2.5.5) and what follows from it alone.

A segment's mean is a polynomial of order S in its local time u = step, 2 step,
..., n step; its noise is Gaussian with a full covariance. The coefficients have
the prior N(0, (b I (x) P)^-1), the precision P a Wishart prior with `dof` degrees of
freedom and inverse scale V^-1. On a regular grid the design matrix of a segment
depends on its length alone, and so do the rotations that bring it to
triangular form: they are made once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from decimal import Decimal, localcontext
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed

TIME_UNITS = ("bin", "second", "trajectory")
SCALES = ("expected", "plain", "literal")
HIGHEST_ORDER = 9
ROUND = 25  # bins: geometries are made for a multiple of it
LEAST_SD, MOST_SD = 1e-150, 1e150  # of noise: beyond, squares are 0 or infinite


@dataclass(frozen=True)
class Prior:
    """The Gauss-Wishart prior of every segment.

    noise_sd: standard deviation of the noise in the data's unit, one or one a dimension.
    dof: degrees of freedom of the Wishart density; None stands for the number of dimensions.
    concentration: b, the printed B = b I (0.1 in the paper).
    time_unit: what a step of the polynomials' time is: `bin` (1), `second` (the bin's duration)
    or `trajectory` (one over the number of bins). The paper does not say.
    scale: `expected`, V^-1 = dof noise_sd^2 I, so that noise_sd is the noise a segment is
    expected to have; `plain`, V^-1 = noise_sd^2 I, another reading of "prior covariance"; or
    `literal`, V = noise_sd^2 I: 2.5.5 calls V the scale matrix of a density of *precisions*, and
    3.2 gives it the data's variances. Variances in the place of precisions are numbers without a
    meaning until a unit of length is told: in mm they say 1/mm^2.
    length_unit: that unit, in the data's unit (0.001 for mm where the data are in m). Mandatory
    with `literal`, and refused with the others, which do not depend on it.
    """

    noise_sd: float | tuple[float, ...]
    dof: float | None = None
    concentration: float = 0.1
    time_unit: str = "bin"
    scale: str = "expected"
    length_unit: float | None = None

    def __post_init__(self) -> None:
        """Refuse values that make no density."""
        deviations = _numbers("noise_sd", self.noise_sd, "a standard deviation above 0")
        if np.ndim(self.noise_sd):  # lists and arrays, too
            object.__setattr__(self, "noise_sd", tuple(deviations.tolist()))
        if not (len(deviations) and np.isfinite(deviations).all() and (deviations > 0).all()):
            raise _error("noise_sd", self.noise_sd, "a standard deviation above 0")
        if not ((deviations > LEAST_SD) & (deviations < MOST_SD)).all():  # their squares are used
            told = f"a standard deviation between {LEAST_SD:g} and {MOST_SD:g}"
            raise _error("noise_sd", self.noise_sd, told)
        b = _numbers("concentration", self.concentration, "a number above 0")
        if not (len(b) == 1 and np.isfinite(b[0]) and b[0] > 0):
            raise _error("concentration", self.concentration, "a number above 0")
        if self.dof is not None:
            _numbers("dof", self.dof, "a number, or None for that of dimensions")
        if self.time_unit not in TIME_UNITS:
            raise _error("time_unit", self.time_unit, listed(TIME_UNITS))
        if self.scale not in SCALES:
            raise _error("scale", self.scale, listed(SCALES))
        self._check_length_unit()

    def _check_length_unit(self) -> None:
        given = self.length_unit
        if self.scale != "literal":
            if given is not None:
                raise _error("length_unit", given, f"None with scale {self.scale}: it needs none")
            return
        wanted = "the unit of length of V in the data's unit (0.001: mm of data in m), for literal"
        if given is None:
            raise _error("length_unit", given, wanted)
        unit = _numbers("length_unit", given, wanted)
        if not (len(unit) == 1 and np.isfinite(unit[0]) and unit[0] > 0):
            raise _error("length_unit", given, wanted)

    def with_noise(self, share: float) -> Prior:
        """Return the prior that expects `share` times the noise of this one."""
        if share == 1:
            return self
        # Read literally, the greater the variances the less noise is expected.
        factor = 1 / share if self.scale == "literal" else share
        deviations = np.asarray(self.noise_sd) * factor
        noise = float(deviations) if deviations.ndim == 0 else tuple(map(float, deviations))
        return replace(self, noise_sd=noise)

    def expected_noise(self, dimensions: int) -> NDArray[np.float64]:
        """Return the noise that a segment is expected to have: an SD a dimension, (L,).

        From the expected precision, dof V: noise_sd itself with scale `expected`.
        """
        return _expected_noise(self, dimensions)

    def degrees(self, dimensions: int) -> float:
        """Return the degrees of freedom for data of so many dimensions."""
        degrees = float(dimensions if self.dof is None else self.dof)
        if not (np.isfinite(degrees) and degrees > dimensions - 1):
            raise _error("dof", self.dof, f"more than {dimensions - 1} for {dimensions} dimensions")
        return degrees

    def inverse_scale(self, dimensions: int) -> NDArray[np.float64]:
        """Return the diagonal of V^-1, (L,)."""
        return _inverse_scale(self, dimensions)

    def step(self, bins: int, dt_s: float | None) -> float:
        """Return the polynomials' time of one bin, for a trajectory of so many bins."""
        if self.time_unit == "bin":
            return 1.0
        if self.time_unit == "trajectory":
            return 1.0 / bins
        if dt_s is None or not dt_s > 0:
            raise _error("dt_s", dt_s, "the duration of a bin in seconds, for time_unit second")
        return float(dt_s)


def _numbers(place: str, found: object, expected: str) -> NDArray[np.float64]:
    if isinstance(found, (str, bool)):
        raise _error(place, repr(found), expected)
    try:
        return np.atleast_1d(np.asarray(found, dtype=float))
    except (TypeError, ValueError):
        raise _error(place, repr(found), expected) from None


def _error(place: str, found: object, expected: str) -> SignkinError:
    return SignkinError(f"{place} is {found}", place="prior", expected=expected)


@lru_cache(maxsize=256)
def _inverse_scale(prior: Prior, dimensions: int) -> NDArray[np.float64]:
    """Return the diagonal of V^-1, not to be written to: each fit asks for it several times."""
    deviations = np.atleast_1d(np.asarray(prior.noise_sd, dtype=float))
    if len(deviations) not in (1, dimensions):
        raise _error("noise_sd", prior.noise_sd, f"one value, or {dimensions}")
    if prior.length_unit is not None:  # V = sd^2 in that unit, so V^-1 = unit^4 / sd^2
        return np.asarray(np.broadcast_to((prior.length_unit**2 / deviations) ** 2, dimensions))
    factor = prior.degrees(dimensions) if prior.scale == "expected" else 1.0
    return np.asarray(np.broadcast_to(factor * deviations**2, (dimensions,)), dtype=float)


@lru_cache(maxsize=256)
def _expected_noise(prior: Prior, dimensions: int) -> NDArray[np.float64]:
    """Return the noise that a segment is expected to have, not to be written to."""
    noise = np.sqrt(prior.inverse_scale(dimensions) / prior.degrees(dimensions))
    noise.flags.writeable = False
    return np.asarray(noise)


@dataclass(frozen=True, eq=False)
class Tables:
    """What a prior says about segments of n = 1..N bins, at [n - 1], for orders 0..D-1.

    cosine, sine: (N, D) Givens rotations that append sample n to the triangular factor of
    [sqrt(B); Phi]. inverse: (N, D, D) inverse of that factor. powers: (N, D) of local time.
    constant: (N, D) and half: (N,), so that with the L x L matrix R of the residuals (whitened
    by V) the log evidence is constant - half * ln|I + R|.
    """

    cosine: NDArray[np.float64]
    sine: NDArray[np.float64]
    inverse: NDArray[np.float64]
    powers: NDArray[np.float64]
    constant: NDArray[np.float64]
    half: NDArray[np.float64]


def tables(prior: Prior, bins: int, longest: int, dimensions: int, n_orders: int,
           dt_s: float | None) -> Tables:  # fmt: skip
    """Return the tables for segments of up to `longest` bins."""
    return _tables(
        longest, n_orders, dimensions, prior.concentration, prior.step(bins, dt_s),
        prior.degrees(dimensions), tuple(prior.inverse_scale(dimensions)),
    )  # fmt: skip


@lru_cache(maxsize=128)
def _tables(
    longest: int, n_orders: int, dimensions: int, b: float, step: float, dof: float,
    inverse_scale: tuple[float, ...],
) -> Tables:  # fmt: skip
    geometry = _geometry(longest, n_orders, b, step)
    n = np.arange(1, longest + 1)
    log_scale = float(np.sum(np.log(inverse_scale)))
    # ln p = -nL/2 ln pi + L/2 (ln|B| - ln|A|) - n/2 ln|V^-1| + ln G((dof + n)/2) - ln G(dof/2)
    #        - (dof + n)/2 ln|I + R|
    gamma = _log_gamma_ratio(longest, dimensions, dof)
    rest = gamma - 0.5 * n * (dimensions * np.log(np.pi) + log_scale)
    constant = rest[:, None] + dimensions * geometry.log_ratio
    return Tables(
        geometry.cosine, geometry.sine, geometry.inverse, geometry.powers,
        np.ascontiguousarray(constant), (dof + n) / 2,
    )  # fmt: skip


@lru_cache(maxsize=128)
def _log_gamma_ratio(longest: int, dimensions: int, dof: float) -> NDArray[np.float64]:
    """Return ln G((dof + n)/2) - ln G(dof/2) for n = 1..N, of multivariate gamma functions."""
    from scipy.special import multigammaln  # takes half as long to import as numba

    n = np.arange(1, longest + 1)
    ratio = multigammaln((dof + n) / 2, dimensions) - multigammaln(dof / 2, dimensions)
    return np.asarray(ratio, dtype=float)


@dataclass(frozen=True, eq=False)
class _Geometry:
    cosine: NDArray[np.float64]
    sine: NDArray[np.float64]
    inverse: NDArray[np.float64]
    powers: NDArray[np.float64]
    log_ratio: NDArray[np.float64]  # (ln|B| - ln|A|) / 2 for each order


@lru_cache(maxsize=128)
def _geometry(longest: int, n_orders: int, b: float, step: float) -> _Geometry:
    """Return what segments of up to `longest` bins have in common, of all priors with b and step.

    Shorter segments and lower orders are the beginning of what longer and higher ones have: it is
    worked out for a round number of bins, which is that of many trajectories, and for eight orders.
    """
    whole = _whole_geometry(-(-longest // ROUND) * ROUND, max(n_orders, 8), b, step)
    return _Geometry(
        np.ascontiguousarray(whole.cosine[:longest, :n_orders]),
        np.ascontiguousarray(whole.sine[:longest, :n_orders]),
        np.ascontiguousarray(whole.inverse[:longest, :n_orders, :n_orders]),
        np.ascontiguousarray(whole.powers[:longest, :n_orders]),
        np.ascontiguousarray(whole.log_ratio[:longest, :n_orders]),
    )


@lru_cache(maxsize=128)  # a study of priors goes through some 20 of them, again and again
def _whole_geometry(longest: int, n_orders: int, b: float, step: float) -> _Geometry:
    """Rotate one row after the other into the factor, in extended precision.

    Row n meets order d when row n - 1 has, and when it has met order d - 1: all (n, d) of one sum
    n + d are done together. Before the first row and after the last one rows of 0 change nothing.
    """
    wide = np.longdouble
    root_b = np.sqrt(wide(b))
    steps = longest + n_orders - 1
    c, s = np.empty((2, steps, n_orders), dtype=wide)
    factors = np.empty((steps, n_orders, n_orders), dtype=wide)
    times = wide(step) * np.arange(1, longest + 1, dtype=wide)
    powers = times[:, None] ** np.arange(n_orders)
    factor = np.eye(n_orders, dtype=wide) * root_b  # what lies below its diagonal is not read
    rows = np.zeros((n_orders, n_orders), dtype=wide)  # the one that meets each order
    for at in range(steps):
        rows[0] = powers[at] if at < longest else 0
        old, new = factor.diagonal(), rows.diagonal()
        size = np.hypot(old, new)
        c[at], s[at] = old / size, new / size
        cosine, sine = c[at, :, None], s[at, :, None]
        factors[at] = cosine * factor + sine * rows
        rows[1:] = (cosine * rows - sine * factor)[:-1]
        factor = factors[at]
    d = np.arange(n_orders)
    n = np.arange(longest)[:, None] + d
    cosine, sine, factors = c[n, d], s[n, d], factors[n, d]
    diagonal = np.diagonal(factors, axis1=1, axis2=2)
    log_ratio = np.cumsum(np.log(root_b) - np.log(diagonal), axis=1)
    return _Geometry(
        np.ascontiguousarray(cosine, dtype=np.float64),
        np.ascontiguousarray(sine, dtype=np.float64),
        np.ascontiguousarray(_inverse(factors), dtype=np.float64),
        np.ascontiguousarray(powers, dtype=np.float64),
        np.asarray(log_ratio, dtype=np.float64),
    )


@lru_cache(maxsize=16)
def exact_rotations(longest: int, n_orders: int, b: float, step: float) -> NDArray[np.float64]:
    """Return the rotations with 32 digits: (4, N, D), cosines, sines, and second halves of both."""
    out = np.empty((4, longest, n_orders))
    with localcontext() as context:
        context.prec = 50
        root_b = Decimal(b).sqrt()
        factor = [[root_b * (i == j) for j in range(n_orders)] for i in range(n_orders)]
        for n in range(longest):
            time = Decimal(step) * (n + 1)
            row = [time**i if i else Decimal(1) for i in range(n_orders)]
            for d, old in enumerate(factor):
                size = (old[d] * old[d] + row[d] * row[d]).sqrt()
                c, s = old[d] / size, row[d] / size
                for j in range(d, n_orders):
                    old[j], row[j] = c * old[j] + s * row[j], c * row[j] - s * old[j]
                for i, exact in enumerate((c, s)):
                    out[i, n, d] = float(exact)
                    out[i + 2, n, d] = float(exact - Decimal(float(exact)))
    return out


def _inverse(upper: NDArray[np.longdouble]) -> NDArray[np.longdouble]:
    """Return the inverses of upper triangular matrices (N, D, D)."""
    size = upper.shape[1]
    out = np.zeros_like(upper)
    for column in range(size):
        out[:, column, column] = 1 / upper[:, column, column]
        for row in range(column - 1, -1, -1):
            total = (
                upper[:, row, row + 1 : column + 1] * out[:, row + 1 : column + 1, column]
            ).sum(1)
            out[:, row, column] = -total / upper[:, row, row]
    return out
