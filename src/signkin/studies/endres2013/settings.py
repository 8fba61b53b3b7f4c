"""What each step takes of config.yaml: a changed key reruns what depends on it alone."""

from __future__ import annotations

from dataclasses import dataclass, fields

from signkin.settings import Settings
from signkin.settings.sections import Binning, BinningLowpass, EndresChoices, PowerLaw, Prior


@dataclass(frozen=True)
class CutSettings:
    """The settings that trajectories depend on, and no others.

    longest_gap_s: kinematics.longest_gap_s. lowpass, bins: of `binning`. powerlaw: the section.
    """

    longest_gap_s: float
    lowpass: BinningLowpass
    bins: int
    powerlaw: PowerLaw

    @classmethod
    def of(cls, settings: Settings) -> CutSettings:
        """Return those of a run."""
        binning = settings.binning
        return cls(
            settings.kinematics.longest_gap_s, binning.lowpass, binning.bins, settings.powerlaw
        )


@dataclass(frozen=True)
class FitSettings:
    """The settings that posteriors depend on beside the trajectories: keys of `binning`."""

    orders: tuple[int, ...]
    prior: Prior
    hit_window_s: float
    fitted_orders: tuple[int, ...]
    fitted_recordings: int
    recovery_noise: float

    @classmethod
    def of(cls, settings: Settings) -> FitSettings:
        """Return those of a run."""
        return cls(**{one.name: getattr(settings.binning, one.name) for one in fields(cls)})


@dataclass(frozen=True)
class ReadingSettings:
    """The settings that readings as printed start from, and those of their summaries."""

    cut: CutSettings
    fit: FitSettings
    binning: Binning

    @classmethod
    def of(cls, settings: Settings) -> ReadingSettings:
        """Return those of a run."""
        return cls(CutSettings.of(settings), FitSettings.of(settings), settings.binning)


@dataclass(frozen=True)
class ChoiceSettings:
    """What is varied, and the settings of the study, of which the rest is taken."""

    choices: EndresChoices
    cut: CutSettings
    fit: FitSettings

    @classmethod
    def of(cls, settings: Settings) -> ChoiceSettings:
        """Return those of a run."""
        choices = settings.open_choices.endres2013
        return cls(choices, CutSettings.of(settings), FitSettings.of(settings))
