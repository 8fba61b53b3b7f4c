"""Figures of the duration models, judged by what is drawn; and their part of the report."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from signkin.figures import durations
from signkin.figures.style import paper_style
from signkin.studies.naert2017.durations_figures import draw_predictions, draw_surface


def predictions(values, model="SIMPLE"):
    return pd.DataFrame({"model": model, "duration_s": [0.2, 0.3, 0.4], "predicted_s": values})


def points():
    g, e = np.meshgrid([0.1, 0.2, 0.3], [0.2, 0.6])
    return pd.DataFrame(
        {
            "geodesic_rad": g.ravel(),
            "euclidean_units": e.ravel(),
            "duration_s": np.r_[[0.2, 0.5] * 3],
        }
    )


def test_predictions_beyond_the_axis_are_drawn_at_its_edge_and_counted():
    with paper_style():
        figure, ax = plt.subplots()
        durations.plot_predictions(predictions([0.2, 0.3, 1.5]), "SIMPLE", (0.5, 0.8), ax=ax)
        inside, edge = (c.get_offsets() for c in ax.collections)
        plt.close(figure)
    assert inside.tolist() == [[0.2, 0.2], [0.3, 0.3]]
    assert edge[0][0] == 0.4
    assert [t.get_text() for t in ax.texts] == ["1 above, up to 1.50 s"]
    assert ax.get_xlabel() == "true duration (s)"


def test_a_panel_for_each_tested_model_and_none_empty():
    both = pd.concat([predictions([0.2, 0.3, 0.4]), predictions([0.3] * 3, "MEAN")])
    with paper_style():
        figure = draw_predictions(both)
        titles = [ax.get_title() for ax in figure.axes]
        plt.close(figure)
    assert titles == ["MEAN (baseline)", "SIMPLE"]


def test_without_a_prediction_there_is_a_sentence():
    with paper_style():
        figure = draw_predictions(predictions([0.2, 0.3, 0.4]).head(0))
        told = [text.get_text() for ax in figure.axes for text in ax.texts]
        plt.close(figure)
    assert told == ["No model predicts a transition that it did not see: too few transitions."]


@pytest.mark.parametrize("theta", [np.array([0.1, 0.6, 0.3]), None])
def test_the_surface_has_units_and_all_transitions(theta):
    with paper_style():
        figure = draw_surface(points(), theta, "units of 0.1 m")
        space, levels = figure.axes[:2]
        drawn = sum(len(c.get_offsets()) for c in space.collections if hasattr(c, "_offsets3d"))
        plt.close(figure)
    assert drawn == 6
    assert space.get_zlabel() == "duration (s)"
    assert levels.get_xlabel() == "geodesic distance (rad)"
    assert levels.get_ylabel() == "Euclidean distance (units of 0.1 m)"
