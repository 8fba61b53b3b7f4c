"""What each step takes of the settings: all that it depends on, and nothing else."""

import pytest

from signkin.settings import load_settings
from signkin.studies.endres2013.settings import ChoiceSettings, CutSettings, FitSettings
from signkin.studies.one_wrist.settings import SeriesSettings

STEPS = {
    "cut": CutSettings,
    "fit": FitSettings,
    "choices": ChoiceSettings,
    "series": SeriesSettings,
}


@pytest.mark.parametrize(
    ("changes", "reruns"),
    [
        ({"kinematics": {"longest_gap_s": 0.1}}, {"cut", "choices", "series"}),
        ({"kinematics": {"lowpass": {"cutoff_hz": 5.0}}}, set()),
        ({"powerlaw": {"segments": 4}}, {"cut", "choices"}),
        ({"binning": {"bins": 50}}, {"cut", "choices"}),
        ({"binning": {"lowpass": {"cutoff_hz": 5.0}}}, {"cut", "choices", "series"}),
        ({"binning": {"prior": {"dof": 5.0}}}, {"fit", "choices", "series"}),
        ({"binning": {"hit_window_s": 0.1}}, {"fit", "choices"}),
        ({"binning": {"continuous": {"order": 2}}}, {"series"}),
        ({"binning": {"bootstrap_draws": 100}}, set()),
        ({"open_choices": {"endres2013": {"bins": [50]}}}, {"choices"}),
    ],
)
def test_a_changed_key_reruns_what_depends_on_it_alone(changes, reruns):
    shipped, changed = load_settings({}), load_settings(changes)
    assert {name for name, of in STEPS.items() if of.of(shipped) != of.of(changed)} == reruns
    # Snakemake compares parameters by how they are written.
    told = {name for name, of in STEPS.items() if repr(of.of(shipped)) != repr(of.of(changed))}
    assert told == reruns
