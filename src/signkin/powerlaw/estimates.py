"""Exponents of the power law by three regressions, and what noise and filters do to them.

Section 2.3 of Endres et al. 2013 fits speed to curvature. Both come from derivatives of one
path: noise in it moves both at once, curvature as an acceleration over a squared speed. So an
exponent is found in noise alone (Maoz, Portugaly, Flash & Weiss 2006), and a filter that
shortens sharp bends changes it without any noise. Three regressions stand side by side: the
non-linear one of the paper, the straight line through the logarithms, and that line with errors
in both variables.

The last takes the noise's share out of the moments of the logarithms (Fuller 1987, Measurement
Error Models, section 2.2). It leaves room for movement that keeps no exact law: Deming's line does
not, and turns upright where scatter that is not noise outweighs a weak slope. Where noise makes
half or more of what is seen of curvature nothing is left to draw a line through, and there is no
exponent: so in noise alone, whose errors so reckoned exceed what is seen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from signkin.errors import SignkinError
from signkin.kinematics.curvature import curvature
from signkin.kinematics.derivatives import speed
from signkin.powerlaw.fit import fit_power_law

Floats = NDArray[np.float64]
Filter = Callable[[Floats], Floats]
NON_LINEAR, LOGARITHMS, BOTH_ERRORS = "non-linear", "logarithms", "errors in both"
NAN = float("nan")
ESTIMATORS = (NON_LINEAR, LOGARITHMS, BOTH_ERRORS)
AXES_M = (0.10, 0.05)  # half axes of the ellipse of the pitfalls
POWER, LEVEL = 0.8, 0.05
LEAST_RELIABILITY = 0.5


@dataclass(frozen=True)
class Estimates:
    """What a segment of a path says of the exponent.

    beta: estimator -> exponent (NaN: none, as `note` tells). r: correlation coefficient of the
    logarithms of speed and curvature. r_squared: eq. 5 of the non-linear fit. n: samples.
    reliability: share of the variance of log curvature that is not noise; below 0 where noise
    alone would vary more.
    """

    beta: dict[str, float]
    r: float
    r_squared: float
    n: int
    reliability: float

    @property
    def note(self) -> str:
        """Why there is no exponent with errors in both; empty where there is one."""
        if np.isfinite(self.beta[BOTH_ERRORS]):
            return ""
        return (
            "no exponent with errors in both: noise makes "
            f"{min(1 - self.reliability, 1):.0%} of what is seen of curvature"
        )


def noise_gains(filtered: Filter, rate_hz: float) -> tuple[float, float]:
    """Return the SDs of first and second differences (1/s, 1/s^2) of filtered noise of SD 1."""
    impulse = np.zeros((2 * int(np.ceil(2 * rate_hz)) + 1, 2))
    impulse[len(impulse) // 2] = 1
    response = filtered(impulse)[:, 0]
    first = np.gradient(response) * rate_hz
    second = np.diff(response, 2) * rate_hz**2
    return float(np.sqrt(np.sum(first**2))), float(np.sqrt(np.sum(second**2)))


def estimates(
    speeds: Floats, curvatures: Floats, noise_sd: float, gains: tuple[float, float]
) -> Estimates:
    """Return the exponent of one segment by each regression.

    speeds, curvatures: (F,), finite, above 0. noise_sd: of the path before the filter. gains: of
    `noise_gains`. Raises SignkinError for what `fit_power_law` refuses.
    """
    law = fit_power_law(speeds, curvatures)
    moving = speeds > 0
    y, x = np.log(speeds[moving]), np.log(curvatures[moving])
    r = float(np.corrcoef(x, y)[0, 1]) if np.ptp(y) > 0 else float("nan")
    of_x, of_both, _, _ = np.cov(x, y, ddof=0).flat
    line = float(of_both / of_x) if of_x > 0 else NAN  # least squares
    of_speed, of_curvature = _error_variances(speeds[moving], curvatures[moving], noise_sd, gains)
    spread = float(np.var(x))
    reliability = 1 - of_curvature / spread if spread > 0 else NAN
    both = NAN
    if reliability > LEAST_RELIABILITY:
        # Curvature has the square of speed below its line: an error of one is one of the other.
        together = float(np.cov(x, y, ddof=0)[0, 1]) + 2 * of_speed
        both = together / (spread - of_curvature)
    beta = {NON_LINEAR: law.beta, LOGARITHMS: line, BOTH_ERRORS: both}
    return Estimates(beta, r, law.r_squared, len(speeds), reliability)


def _error_variances(
    v: Floats, k: Floats, noise_sd: float, gains: tuple[float, float]
) -> tuple[float, float]:
    """Return the variances of the errors of log speed and log curvature, medians over samples."""
    of_speed = (noise_sd * gains[0] / v) ** 2
    of_curvature = (noise_sd * gains[1] / (v**2 * k)) ** 2 + 4 * of_speed
    return float(np.median(of_speed)), float(np.median(of_curvature))


# --- what noise, filter and duration do ------------------------------------------------------


@dataclass(frozen=True)
class Pitfall:
    """Exponents found on one kind of path. values: estimator -> (draws,), NaN: none; r: (draws,).

    Where half of the draws or more have no exponent there is no number for all of them: those
    that have one are a choice.
    """

    beta: float
    duration_s: float
    noise_sd: float
    values: dict[str, Floats]
    r: Floats

    def told(self, estimator: str) -> int:
        """Return how many draws have an exponent."""
        return int(np.isfinite(self.values[estimator]).sum())

    def mean(self, estimator: str) -> float:
        """Return the mean exponent; NaN where half of the draws or more have none."""
        return float(np.nanmean(self.values[estimator])) if self._enough(estimator) else NAN

    def sd(self, estimator: str) -> float:
        """Return the SD over draws; NaN where half of them or more have no exponent, or of one."""
        if not self._enough(estimator) or self.told(estimator) < 2:
            return NAN
        return float(np.nanstd(self.values[estimator], ddof=1))

    def smallest_difference(self, estimator: str) -> float:
        """Return the difference of two segments' exponents that is told with a power of 0.8."""
        reach = stats.norm.ppf(1 - LEVEL / 2) + stats.norm.ppf(POWER)
        return float(reach * np.sqrt(2) * self.sd(estimator))

    def _enough(self, estimator: str) -> bool:
        return 2 * self.told(estimator) > len(self.r)


def ellipse(beta: float, duration_s: float, rate_hz: float, turns: int = 3) -> Floats:
    """Return an ellipse (F, 2) in m, gone round `turns` times with v = alpha kappa^beta.

    duration_s: of one turn. beta = -1/3 is the ellipse of two harmonic motions.
    """
    if not duration_s * rate_hz >= 8:
        raise SignkinError(
            f"a turn of {duration_s:g} s at {rate_hz:g} Hz", place="ellipse",
            expected="eight samples or more",
        )  # fmt: skip
    a, b = AXES_M
    angle = np.linspace(0, 2 * np.pi, 20001)
    step = np.hypot(a * np.sin(angle), b * np.cos(angle))  # length over angle
    slow = step * (a * b / step**3) ** -beta
    time = np.concatenate([[0], np.cumsum((slow[1:] + slow[:-1]) / 2)])
    time *= duration_s / time[-1]
    at = np.arange(round(turns * duration_s * rate_hz) + 1) / rate_hz
    where = np.interp(at % duration_s, time, angle)
    return np.column_stack([a * np.cos(where), b * np.sin(where)])


def pitfall(
    beta: float, duration_s: float, noise_sd: float, rate_hz: float, filtered: Filter,
    rng: np.random.Generator, draws: int,
) -> Pitfall:  # fmt: skip
    """Find the exponent of one turn of an ellipse with noise of this SD (m), filtered.

    beta: NaN for a hand that rests, whose path is noise alone. Without noise there is one draw.
    """
    gains = noise_gains(filtered, rate_hz)
    still = np.isnan(beta)
    path = np.zeros((round(3 * duration_s * rate_hz) + 1, 2)) if still else ellipse(
        beta, duration_s, rate_hz)  # fmt: skip
    middle = slice(round(duration_s * rate_hz), round(2 * duration_s * rate_hz))
    found = []
    for _ in range(draws if noise_sd else 1):
        smooth = filtered(path + noise_sd * rng.standard_normal(path.shape))
        found.append(
            estimates(speed(smooth, rate_hz)[middle], curvature(smooth)[middle], noise_sd, gains)
        )
    values = {name: np.array([one.beta[name] for one in found]) for name in ESTIMATORS}
    return Pitfall(beta, duration_s, noise_sd, values, np.array([one.r for one in found]))


def pitfalls(
    betas: Sequence[float], durations_s: Sequence[float], noise_sd: float, rate_hz: float,
    filtered: Filter, rng: np.random.Generator, draws: int,
) -> list[Pitfall]:  # fmt: skip
    """Return ellipses without noise and with it, and noise alone, for each duration of a turn."""
    out = [
        pitfall(beta, duration, sd, rate_hz, filtered, rng, draws)
        for sd in (0.0, noise_sd) for beta in betas for duration in durations_s
    ]  # fmt: skip
    alone = float("nan")
    return out + [
        pitfall(alone, duration, noise_sd, rate_hz, filtered, rng, draws)
        for duration in durations_s
    ]
