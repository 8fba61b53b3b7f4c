"""The power law of speed and curvature, v = alpha kappa^beta (Endres et al. 2013, section 2.3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from signkin.errors import SignkinError
from signkin.masked import unmasked

FEWEST_SAMPLES = 4  # two parameters, and two samples that can disagree
# Below this spread (SD of the logarithm) a curvature is constant, and tells no exponent.
LEAST_SPREAD = 1e-6


@dataclass(frozen=True)
class PowerLaw:
    """A power law that was fitted, or is to be followed.

    alpha: velocity gain factor, in the unit of speed times that of the path to the power beta.
    beta: exponent. r_squared: compliance with the fitted speeds (eq. 5); NaN where the speed
    is constant, since it then explains nothing, or where nothing was fitted.
    """

    alpha: float
    beta: float
    r_squared: float = float("nan")

    def speed(self, curvature: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the speed that the law predicts (eq. 4), in the unit alpha was fitted in."""
        return np.asarray(self.alpha * np.asarray(curvature, dtype=float) ** self.beta)


def fit_power_law(speed: NDArray[np.float64], curvature: NDArray[np.float64]) -> PowerLaw:
    """Fit v = alpha kappa^beta to the samples of one segment (eq. 4) and rate the fit (eq. 5).

    speed, curvature: (F,), same samples, in any unit; finite, speed not negative, curvature
    above 0. The sum of squared differences of *speed* is least (non-linear regression,
    trust-region reflective: Coleman & Li 1994, 1996, the paper's source), started from the
    straight line through the logarithms.

    Raises SignkinError for too few samples, gaps, curvatures that are 0 or constant.
    """
    v, k = _checked(speed, curvature)
    # In units of the geometric mean the two parameters are of size 1 and hardly correlated.
    log_k = np.log(k)
    centre = float(log_k.mean())
    x = log_k - centre
    scale = float(np.sqrt(np.mean(v**2)))
    y = v / scale
    moving = v > 0
    slope, level = _line(x[moving], np.log(y[moving]))

    def residuals(p: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(p[0] * np.exp(p[1] * x) - y)

    def jacobian(p: NDArray[np.float64]) -> NDArray[np.float64]:
        power = np.exp(p[1] * x)
        return np.column_stack([power, p[0] * x * power])

    done = least_squares(
        residuals, [np.exp(level), slope], jacobian, method="trf",
        ftol=1e-14, xtol=1e-14, gtol=1e-14, max_nfev=500,
    )  # fmt: skip
    if not done.success:
        raise SignkinError(
            "the regression did not come to an end", place="fit_power_law",
            expected="speeds and curvatures of one smooth segment",
        )  # fmt: skip
    gain, beta = (float(p) for p in done.x)
    alpha = gain * scale * float(np.exp(-beta * centre))
    return PowerLaw(alpha, beta, compliance(v, alpha * k**beta))


def compliance(speed: NDArray[np.float64], predicted: NDArray[np.float64]) -> float:
    """Return R squared of predicted speeds (eq. 5); NaN where the speed is constant."""
    total = float(np.sum((speed - speed.mean()) ** 2))
    rest = float(np.sum((speed - predicted) ** 2))
    if total <= len(speed) * (1e-12 * float(np.max(np.abs(speed)))) ** 2:
        return float("nan")
    return 1 - rest / total


def active_part(speed: NDArray[np.float64], share: float = 0.15) -> slice:
    """Return the frames from the first to the last with at least `share` of the top speed.

    speed: (F,), finite. The paper leaves out the initial and terminal parts of a movement
    below 15 % of its top speed (section 2.4); pauses inside stay.
    """
    v = np.asarray(speed, dtype=float)
    if v.ndim != 1 or not len(v) or not np.isfinite(v).all():
        raise SignkinError(
            f"speeds of shape {v.shape}, {np.count_nonzero(~np.isfinite(v))} of them no numbers",
            place="active_part", expected="(F,), at least one, all finite", todo="Fill gaps first.",
        )  # fmt: skip
    if not 0 <= share <= 1:
        raise SignkinError(
            f"a share of {share:g}", place="active_part", expected="a number from 0 to 1"
        )
    fast = np.flatnonzero(v >= share * v.max())
    return slice(int(fast[0]), int(fast[-1]) + 1)


def _line(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float]:
    """Return slope and intercept of the least-squares line."""
    spread = float(np.sum((x - x.mean()) ** 2))
    slope = float(np.sum((x - x.mean()) * (y - y.mean()))) / spread if spread > 0 else 0.0
    return slope, float(y.mean()) - slope * float(x.mean())


def _checked(
    speed: NDArray[np.float64], curvature: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    v, k = unmasked(speed), unmasked(curvature)
    if v.ndim != 1 or v.shape != k.shape:
        raise _error(f"speeds of shape {v.shape}, curvatures of shape {k.shape}", "(F,) and (F,)")
    if len(v) < FEWEST_SAMPLES:
        raise _error(f"{len(v)} samples", f"at least {FEWEST_SAMPLES}")
    gaps = np.count_nonzero(~(np.isfinite(v) & np.isfinite(k)))
    if gaps:
        raise _error(
            f"{gaps} of {len(v)} samples without a speed or a curvature",
            "numbers alone; a path's ends have no curvature, leave them out",
        )
    if (v < 0).any() or not v.any():
        raise _error("speeds below 0, or 0 throughout", "speeds from 0, some above")
    if (k <= 0).any():
        raise _error(
            f"{np.count_nonzero(k <= 0)} of {len(k)} curvatures are 0 or less",
            "curvatures above 0: the law has no speed on a straight line",
        )
    if float(np.std(np.log(k))) < LEAST_SPREAD:
        raise _error(f"a constant curvature of {k[0]:g}", "one that varies, to tell an exponent")
    return v, k


def _error(found: str, expected: str) -> SignkinError:
    return SignkinError(found, place="fit_power_law", expected=expected)
