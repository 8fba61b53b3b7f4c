"""What long series take of config.yaml: a changed key reruns what depends on it alone."""

from __future__ import annotations

from dataclasses import dataclass

from signkin.settings import Settings
from signkin.settings.sections import BinningLowpass, Continuous, Prior


@dataclass(frozen=True)
class SeriesSettings:
    """The settings that long series depend on: kinematics.longest_gap_s, and keys of `binning`."""

    longest_gap_s: float
    lowpass: BinningLowpass
    prior: Prior
    continuous: Continuous

    @classmethod
    def of(cls, settings: Settings) -> SeriesSettings:
        """Return those of a run."""
        binning = settings.binning
        return cls(
            settings.kinematics.longest_gap_s, binning.lowpass, binning.prior, binning.continuous
        )
