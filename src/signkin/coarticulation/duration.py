"""Models of transition duration (Naert et al. 2017, section 5.2)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from signkin.errors import SignkinError

TERMS = ("constant", "geodesic", "euclidean")


@dataclass
class SurfaceDuration:
    """SURFACE_DURATION (eq. 4): duration = theta_0 + theta_1 geodesic + theta_2 Euclidean.

    The least-squares solution of the paper's normal equations, by a QR decomposition, which
    gives the same theta without squaring the condition number. Distances in the units that
    theta is wanted in (the pipeline: radians, and Euclidean over `euclidean_unit_m`).
    """

    theta: NDArray[np.float64] = field(default_factory=lambda: np.full(3, np.nan))
    standard_error: NDArray[np.float64] = field(default_factory=lambda: np.full(3, np.nan))
    n: int = 0
    mean_error_s: float = float("nan")

    def fit(
        self,
        geodesic: NDArray[np.float64],
        euclidean: NDArray[np.float64],
        duration_s: NDArray[np.float64],
    ) -> SurfaceDuration:
        """Fit to transitions: arrays (N,). Singular or too few equations are an error."""
        x = np.column_stack([np.ones(len(duration_s)), geodesic, euclidean])
        y = np.asarray(duration_s, dtype=float)
        if not (np.isfinite(x).all() and np.isfinite(y).all()):
            raise SignkinError(
                "a distance or duration is missing",
                place="surface",
                expected="transitions with both distances and a duration",
            )
        if len(y) < 4 or np.linalg.matrix_rank(_scaled(x)) < 3:
            raise SignkinError(
                f"the normal equations of {len(y)} transitions are singular",
                place="surface",
                expected="four transitions or more whose distances do not lie on one line",
            )
        q, r = np.linalg.qr(x)
        self.theta = np.linalg.solve(r, q.T @ y)
        residual = y - x @ self.theta
        self.n = len(y)
        self.mean_error_s = float(np.mean(np.abs(residual)))
        inverse = np.linalg.inv(r)
        variance = residual @ residual / (self.n - 3)
        self.standard_error = np.sqrt(variance * (inverse**2).sum(axis=1))
        return self

    def interval(self, level: float = 0.95) -> NDArray[np.float64]:
        """Return the confidence interval of each coefficient, (3, 2), by Student's t."""
        half = stats.t.ppf(0.5 + level / 2, self.n - 3) * self.standard_error
        return np.column_stack([self.theta - half, self.theta + half])

    def predict(
        self, geodesic: NDArray[np.float64], euclidean: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return predicted durations in seconds, (N,)."""
        return np.asarray(
            self.theta[0] + self.theta[1] * geodesic + self.theta[2] * euclidean, dtype=float
        )


def _scaled(x: NDArray[np.float64]) -> NDArray[np.float64]:
    size = np.linalg.norm(x, axis=0)
    return x / np.where(size > 0, size, 1.0)
