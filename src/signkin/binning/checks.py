"""Does the fitted model make data like these? Posterior predictive checks of the noise.

The model's noise is white and of one covariance a segment (Endres et al. 2013, eq. 12). A filter
makes neighbouring samples alike; a prior that expects too much or too little noise makes bands
that hold too many or too few of the samples.
"""

from __future__ import annotations

from statistics import NormalDist

import numpy as np

from signkin.binning.posterior import Floats, Posterior
from signkin.errors import SignkinError


def residuals(posterior: Posterior, order: int) -> Floats:
    """Return the data less the expected trajectory, (T, L), in the data's unit."""
    return posterior.x - posterior.expected_trajectory(order)


def residual_autocorrelation(posterior: Posterior, order: int, lag: int = 1) -> float:
    """Return the correlation of residuals `lag` bins apart, pooled over dimensions.

    White noise has 0 within about 1.96 / sqrt(T L), a little below it where many segments take
    degrees of freedom. NaN where nothing is left over.
    """
    rest = residuals(posterior, order)
    if not 1 <= lag < len(rest):
        raise SignkinError(
            f"a lag of {lag} bins", place="lag", expected=f"from 1 to {len(rest) - 1}"
        )
    # Dimensions count alike, whatever their noise.
    scale = np.sqrt((rest**2).mean(axis=0))
    if not (scale > 0).all():
        return float("nan")
    z = rest / scale
    return float((z[lag:] * z[:-lag]).sum() / (z**2).sum())


def noise_coverage(posterior: Posterior, order: int, level: float = 0.95) -> float:
    """Return the share of the samples within the band of the noise that holds `level` of it.

    The band lies around the expected trajectory, its width from the posterior's noise covariance.
    Far above `level`, the prior expects more noise than there is, or coefficients so large that
    they widen it (they share its covariance, eq. 15); far below, less.
    """
    if not 0 < level < 1:
        raise SignkinError(f"a level of {level:g}", place="level", expected="between 0 and 1")
    width = NormalDist().inv_cdf(0.5 + level / 2)
    sd = np.sqrt(np.diag(posterior.noise_covariance(order)))
    return float((np.abs(residuals(posterior, order)) <= width * sd).mean())
