"""Posture distances that follow a printed surface with a printed mean error.

Given durations d, finds geodesic distances g and Euclidean distances e such
that least squares of d on (1, g, e) gives theta exactly and the residuals have
the given mean absolute value (Naert et al. 2017, eq. 4 and 5).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from signkin.errors import SignkinError


@dataclass(frozen=True)
class DistanceRange:
    """Distances that postures can have (radians; Euclidean in the surface's unit).

    geodesic >= least_geodesic + slope * euclidean: moving an arm turns what hangs on it.
    """

    least_geodesic: float = 0.015
    most_geodesic: float = 0.30
    least_euclidean: float = 0.10
    most_euclidean: float = 1.10
    slope: float = 0.14


def design_distances(
    durations_s: NDArray[np.float64],
    theta: NDArray[np.float64],
    mean_error_s: float,
    far: NDArray[np.bool_],
    rng: np.random.Generator,
    limits: DistanceRange | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return geodesic (N,) and Euclidean (N,) distances for durations (N,).

    far: transitions that want their Euclidean distance as large as can be.
    """
    limits = limits or DistanceRange()
    fitted = _fitted(durations_s, theta, mean_error_s, rng, limits)
    residual = durations_s - fitted
    low, high = _euclidean_bounds(fitted, theta, limits)
    wish = low + (high - low) * np.where(far, 1.0, rng.uniform(0.15, 0.9, size=len(low)))
    euclidean = _solve(
        wish,
        np.column_stack([low, high]),
        [{"type": "eq", "fun": lambda e: residual @ e, "jac": lambda e: residual}],
    )
    geodesic = (fitted - theta[0] - theta[2] * euclidean) / theta[1]
    return geodesic, euclidean


def _euclidean_bounds(
    fitted: NDArray[np.float64], theta: NDArray[np.float64], limits: DistanceRange
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    rest = fitted - theta[0]
    low = np.maximum(limits.least_euclidean, (rest - theta[1] * limits.most_geodesic) / theta[2])
    high = (rest - theta[1] * limits.least_geodesic) / (theta[2] + theta[1] * limits.slope)
    return low, np.maximum(np.minimum(high, limits.most_euclidean), low)


def _fitted(
    durations_s: NDArray[np.float64],
    theta: NDArray[np.float64],
    mean_error_s: float,
    rng: np.random.Generator,
    limits: DistanceRange,
) -> NDArray[np.float64]:
    """Return fitted values: residuals orthogonal to 1 and to them, with the mean error."""
    floor = theta @ np.array(
        [
            1.0,
            limits.least_geodesic + limits.slope * limits.least_euclidean,
            limits.least_euclidean,
        ]
    )
    ceiling = theta @ np.array([1.0, limits.most_geodesic, limits.most_euclidean])
    centre = durations_s.mean()
    spread = durations_s.std()
    wish = centre + 0.4 * (durations_s - centre) + rng.uniform(-0.8, 0.8, len(durations_s)) * spread
    wish = np.clip(wish, floor + 0.01, ceiling)
    # |r| is smooth where its sign is known: the signs of the wished residuals are kept.
    sign = np.where(durations_s - wish >= 0, 1.0, -1.0)
    n = len(durations_s)
    bounds = np.column_stack(
        [
            np.where(sign > 0, floor, np.maximum(floor, durations_s)),
            np.where(sign > 0, np.minimum(ceiling, durations_s), ceiling),
        ]
    )
    bounds[:, 1] = np.maximum(bounds[:, 1], bounds[:, 0])
    # The scales make the three conditions comparable.
    return _solve(
        wish,
        bounds,
        [
            {
                "type": "eq",
                "fun": lambda f: (durations_s - f).mean(),
                "jac": lambda f: -np.ones(n) / n,
            },
            {
                "type": "eq",
                "fun": lambda f: ((durations_s - f) * (f - centre)).mean() / spread,
                "jac": lambda f: (durations_s + centre - 2 * f) / (n * spread),
            },
            {
                "type": "eq",
                "fun": lambda f: (sign * (durations_s - f)).mean() - mean_error_s,
                "jac": lambda f: -sign / n,
            },
        ],
    )


def _solve(
    wish: NDArray[np.float64], bounds: NDArray[np.float64], constraints: list[dict[str, object]]
) -> NDArray[np.float64]:
    """Return the point nearest to a wish that meets equality constraints within bounds."""
    result = minimize(
        lambda x: float(((x - wish) ** 2).sum()),
        np.clip(wish, bounds[:, 0], bounds[:, 1]),
        jac=lambda x: 2 * (x - wish),
        bounds=bounds,
        constraints=constraints,
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    worst = max(abs(c["fun"](result.x)) for c in constraints)  # type: ignore[operator]
    if worst > 1e-9:
        raise SignkinError(
            f"no distances meet the surface (off by {worst:.1e})",
            place="surface design",
            expected="durations that such a surface can have",
        )
    return np.asarray(result.x)
