"""Bayesian binning of trajectories with polynomial segments (Endres et al. 2013)."""

from signkin.binning.posterior import Posterior, fit, fit_many, segment_log_evidence
from signkin.binning.prior import Prior

__all__ = ["Posterior", "Prior", "fit", "fit_many", "segment_log_evidence"]
