"""Which sections of config.yaml the study's rules take: a changed key reruns what rests on it."""

from __future__ import annotations

from typing import Self

from signkin.settings import Settings
from signkin.settings.base import Section
from signkin.settings.sections import (
    Durations,
    Kinematics,
    NaertChoices,
    Refinement,
    Samples,
    SignTypes,
    Synthesis,
    Transitions,
)


class Sections(Section):
    """Some sections of the settings, by the names they have there."""

    @classmethod
    def of(cls, settings: Settings) -> Self:
        """Return these sections of the settings."""
        return cls(**{name: getattr(settings, name) for name in cls.model_fields})


class TransitionSettings(Sections):
    """What transitions, their types and the speeds around them are made with."""

    kinematics: Kinematics
    transitions: Transitions
    sign_types: SignTypes


class TableSettings(Sections):
    """What the tables of a corpus, and the check of a simulation, are made with."""

    kinematics: Kinematics
    refinement: Refinement
    transitions: Transitions
    samples: Samples


class FigureSettings(Sections):
    """What Fig. 4 to 10 are drawn with."""

    kinematics: Kinematics
    transitions: Transitions
    samples: Samples


class DurationSettings(Sections):
    """What durations are tested and modelled with."""

    transitions: Transitions
    durations: Durations


class SynthesisSettings(Sections):
    """What synthetic transitions and utterances are made with."""

    kinematics: Kinematics
    transitions: Transitions
    durations: Durations
    synthesis: Synthesis
    samples: Samples


class GridSettings(Sections):
    """The open choices that are varied, and the settings that stay."""

    kinematics: Kinematics
    refinement: Refinement
    transitions: Transitions
    samples: Samples
    choices: NaertChoices

    @classmethod
    def of(cls, settings: Settings) -> Self:
        """Return these sections of the settings, with the study's own open choices."""
        kept = {name: getattr(settings, name) for name in cls.model_fields if name != "choices"}
        return cls(**kept, choices=settings.open_choices.naert2017)
