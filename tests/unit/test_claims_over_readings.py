"""Which claims hold under which readings: from tables of open choices to a figure and words."""

import pandas as pd
import pytest

from signkin import tables
from signkin.audit.paper import read_paper
from signkin.figures.specification import UNJUDGED
from signkin.figures.style import paper_style
from signkin.pages.readings import draw_readings, told

NOISES = ("data plain", "data literal mm", "data literal cm", "sensor expected")


def choices(corpus, peaks):
    """Return a table order_choices: a noise a row; peaks: of recorded trajectories."""
    rows = [
        {
            "corpus": corpus, "dof": "L", "noise": noise, "concentration": 0.1, "time_unit": "bin",
            "bins": 100, "printed": "no" if noise.startswith("sensor") else "yes", "default": "no",
            "order_peak_recorded": peak, "probability_3_to_5_recorded": 0.99,
            "order_peak_powerlaw": 3, "recovered_probability": 0.5, "recovered_hit_rate": 0.95,
            "mean_count_order_0": 13.0, "mean_count_order_7": 2.0,
            "explained_variance_order_3": 0.999, "recordings": 8, "note": "",
        }
        for noise, peak in zip(NOISES, peaks, strict=True)
    ]  # fmt: skip
    return pd.DataFrame(rows, columns=tables.TABLES["order_choices"].names("m"))


@pytest.fixture
def drawn(root, tmp_path):
    files = []
    for corpus, peaks in (("isl-sim", (2, 4, 3, 4)), ("isl-kinect", (2, 2, 2, 2))):
        path = tmp_path / "endres2013" / corpus / "order_choices.csv"
        path.parent.mkdir(parents=True)
        tables.write_table(choices(corpus, peaks), path, "order_choices", "m")
        files.append(path)
    papers = [read_paper(root / "papers" / name) for name in ("endres2013", "naert2017")]
    corpora = {"isl-sim": True, "isl-kinect": False}
    with paper_style():
        return list(draw_readings(papers, corpora, files, tmp_path))


def test_what_keeps_the_print_is_judged_claim_by_claim(drawn):
    (one,) = drawn  # the other paper's claims have no choices in common
    assert one.name == "endres2013_readings"
    assert len(one.points) == 6  # the sensor's noise does not keep the print
    points = one.points.set_index(["corpus", "noise"])
    assert points.loc[("isl-sim", "data literal mm"), "E10"] == "yes"
    assert points.loc[("isl-sim", "data plain"), "E10"] == "no"
    assert (points["E09"] == "yes").all() and (points["E02"] == "no").all()
    assert (points["E08"] == "").all()  # without a ratio there is nothing to judge
    assert len(one.figure.axes) == 3
    (legend,) = one.figure.legends
    assert [t.get_text() for t in legend.get_texts()] == ["holds", "fails", UNJUDGED]


def test_the_words_count_what_the_figure_shows(drawn):
    text = told(drawn[0].points)
    assert text.startswith("isl-sim: of 3 readings hold E02 0, E03 3, E04 3, E05 3, E07 0, E08 0")
    assert "E10 1, E14 1; at most 6 of 9 claims hold under one reading (under 1)" in text
    assert "isl-kinect: of 3 readings" in text and "(under 3)" in text
