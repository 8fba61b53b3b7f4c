"""The study's rules take sections; an utterance of the settings goes to its corpus."""

import pandas as pd
import pytest
from pydantic import ValidationError

from signkin.settings import Settings
from signkin.settings.sections import Utterance
from signkin.studies.naert2017.settings import GridSettings, SynthesisSettings, TransitionSettings
from signkin.studies.naert2017.synthesis.utterance_files import wanted_of
from signkin.studies.naert2017.tagged import kept


def test_sections_are_those_of_the_settings():
    settings = Settings()
    chosen = SynthesisSettings.of(settings)
    assert chosen.kinematics is settings.kinematics
    assert set(SynthesisSettings.model_fields) == {
        "kinematics", "transitions", "durations", "synthesis", "samples",
    }  # fmt: skip
    with pytest.raises(ValidationError):
        chosen.kinematics.longest_gap_s = 1.0


def test_the_grid_rests_on_the_studys_own_open_choices():
    settings = Settings()
    grid = GridSettings.of(settings)
    assert grid.choices is settings.open_choices.naert2017
    other = settings.model_copy(
        update={
            "open_choices": settings.open_choices.model_copy(
                update={
                    "endres2013": settings.open_choices.endres2013.model_copy(
                        update={"recordings": 3}
                    )
                }
            )
        }
    )
    assert GridSettings.of(other) == grid  # the other study's change reruns nothing here


def test_a_change_elsewhere_does_not_change_what_transitions_take():
    settings = Settings()
    moved = settings.model_copy(
        update={"durations": settings.durations.model_copy(update={"alpha": 0.01})}
    )
    assert TransitionSettings.of(moved) == TransitionSettings.of(settings)
    assert SynthesisSettings.of(moved) != SynthesisSettings.of(settings)


def test_utterances_go_to_their_corpus():
    utterances = (
        Utterance(corpus="a", name="one", glosses=("CAT", "DOG")),
        Utterance(corpus="b", name="two", glosses=("CAT",)),
    )
    assert wanted_of("a", utterances) == {"one": ["CAT", "DOG"]}
    assert wanted_of("c", utterances) == {}


def test_recordings_that_are_left_out_are_not_kept():
    about = pd.DataFrame({"recording": ["r1", "r2", "r3"]})
    assert kept(about, pd.DataFrame({"recording": ["r2", "r9"]})) == ["r1", "r3"]
