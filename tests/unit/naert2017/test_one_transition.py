"""A corpus with one transition: sentences, no interval, and no mean's error of itself."""

import warnings

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from signkin import tables
from signkin.figures.style import paper_style
from signkin.settings import Settings
from signkin.studies.naert2017 import durations_figures, durations_models, durations_surface
from signkin.studies.naert2017.durations_statistics import statistics
from signkin.studies.naert2017.settings import DurationSettings

OWN = DurationSettings.of(Settings())


@pytest.fixture(scope="module")
def made(root):
    """The tables of one corpus with one transition, and what is learnt from it."""
    row = {
        "corpus": "one", "recording": "r", "signer": "s", "segmentation": "manual", "hand": "both",
        "transition": 1, "previous_gloss": "A", "next_gloss": "B", "type": "0010",
        "type_source": "lexicon", "start_s": 1.0, "end_s": 1.3, "duration_s": 0.3, "status": "ok",
        "geodesic_rad": 0.2, "euclidean_m": 0.06, "note": "",
    }  # fmt: skip
    transitions = pd.DataFrame([row]).reindex(columns=tables.TABLES["transitions"].names("m"))
    names = tables.TABLES["transition_speeds"].names("m")
    known = {name: row.get(name, 0.5) for name in names}
    speeds = pd.DataFrame([known])
    constants = pd.read_csv(
        root / "papers/naert2017/constants.csv", dtype=str, keep_default_na=False
    )
    printed = dict(zip(constants["name"], constants["value"], strict=True))
    return transitions, speeds, printed


def test_no_test_of_durations_has_a_number(made):
    found = statistics("one", made[0], "m", OWN, 1)
    tests = found[found["kind"] == "difference"] if "kind" in found else found
    assert len(tests) and tests["p"].isna().all()
    assert tests["note"].str.contains("not testable|nothing can be tested").all()


def test_models_have_no_interval_and_the_figure_a_sentence(made):
    transitions, speeds, printed = made
    with warnings.catch_warnings(), paper_style():
        warnings.simplefilter("error")
        learn = durations_models.learnable(transitions, speeds, "m", OWN)
        errors, predicted = durations_models.models("one", learn, OWN, printed, 1)
        fitted = durations_surface.coefficients("one", learn, OWN, printed, 1)
        figure = durations_figures.draw_predictions(predicted)
        plt.close(figure)
    assert len(learn.data) == 1 and predicted.empty
    rows = errors.set_index(["model", "evaluation"])
    mean = rows.loc[("MEAN", "in_sample")]
    assert np.isnan(mean["mean_error_s"])
    assert mean["note"] == "not testable: one transition is its own mean"
    assert errors["mean_error_low_s"].isna().all()
    assert fitted["fitted"].isna().all() and fitted["note"].str.startswith("not testable").all()
