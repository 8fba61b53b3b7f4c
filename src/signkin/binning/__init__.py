"""Bayesian binning of trajectories with polynomial segments (Endres et al. 2013)."""

from signkin.binning.checks import noise_coverage, residual_autocorrelation, residuals
from signkin.binning.fitting import fit, fit_many, segment_log_evidence
from signkin.binning.hit_rate import (
    ChanceLine,
    GroupRates,
    HitRate,
    Hpfpps,
    OrderTests,
    RankTest,
    chance_line,
    compare_orders,
    group_rates,
    hit_rate,
    hpfpps,
    match,
)
from signkin.binning.learning import LearntPrior, held_out, learn_prior, log_evidences
from signkin.binning.posterior import Posterior
from signkin.binning.prior import Prior

__all__ = [
    "ChanceLine",
    "GroupRates",
    "HitRate",
    "Hpfpps",
    "LearntPrior",
    "OrderTests",
    "Posterior",
    "Prior",
    "RankTest",
    "chance_line",
    "compare_orders",
    "fit",
    "fit_many",
    "group_rates",
    "held_out",
    "hit_rate",
    "hpfpps",
    "learn_prior",
    "log_evidences",
    "match",
    "noise_coverage",
    "residual_autocorrelation",
    "residuals",
    "segment_log_evidence",
]
