"""The power law of speed and curvature (Endres et al. 2013), and ground truth that obeys it."""

from signkin.powerlaw.fit import PowerLaw, active_part, fit_power_law
from signkin.powerlaw.ground_truth import (
    REASONS,
    GroundTruth,
    LeftOut,
    WarpSettings,
    warp_to_power_law,
)

__all__ = [
    "REASONS",
    "GroundTruth",
    "LeftOut",
    "PowerLaw",
    "WarpSettings",
    "active_part",
    "fit_power_law",
    "warp_to_power_law",
]
