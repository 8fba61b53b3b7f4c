"""The data's variances as the scale matrix itself, in a unit of length; both priors in a table."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.stats import wishart

from signkin import tables
from signkin.binning import Prior, fit
from signkin.errors import SignkinError
from signkin.figures.style import paper_style
from signkin.studies.endres2013 import report_beside
from signkin.studies.endres2013.figures.two_priors import TITLES, drawn
from signkin.studies.endres2013.open_choices import priors
from signkin.studies.endres2013.posteriors import prior_of, study
from signkin.studies.endres2013.settings import ChoiceSettings, CutSettings, FitSettings
from signkin.studies.endres2013.single_signs import RECORDED, single_signs
from signkin.studies.endres2013.two_priors import BESIDE, SHIPPED, printed_beside, two_priors
from support.endres import arc, corpus_of, recording_of, settings

SD = (0.08, 0.1, 0.05)  # m
LITERAL = {"noise": "data", "scale": "literal", "length_unit": "mm"}


@pytest.mark.parametrize("unit", [1e-3, 1e-2, 1.0])
def test_v_is_the_variance_in_the_unit_told(unit):
    prior = Prior(noise_sd=SD, dof=5, scale="literal", length_unit=unit)
    v = np.diag((np.array(SD) / unit) ** 2)  # numbers in that unit
    precision = wishart(df=5, scale=v).mean()
    assert prior.expected_noise(3) == pytest.approx(unit / np.sqrt(np.diag(precision)))
    assert prior.inverse_scale(3) == pytest.approx(unit**2 / np.diag(v))


def test_positions_in_millimetres_or_in_metres_tell_the_same():
    rng = np.random.default_rng(1)
    x = np.cumsum(rng.normal(0, 0.01, (30, 3)), axis=0)
    x -= x.mean(axis=0)
    sd = tuple(x.std(axis=0, ddof=1))
    literal = Prior(noise_sd=sd, scale="literal", length_unit=1e-3)
    in_mm = replace(literal, noise_sd=tuple(1e3 * s for s in sd), length_unit=1.0)
    one, other = fit(x, (0, 1, 3), literal), fit(1e3 * x, (0, 1, 3), in_mm)
    assert one.order_probability == pytest.approx(other.order_probability, rel=1e-9)
    assert one.log_evidence - other.log_evidence == pytest.approx(90 * np.log(1e3))
    # In another unit it is another prior.
    coarse = fit(x, (0, 1, 3), replace(literal, length_unit=1e-2))
    assert abs(np.diff(coarse.log_evidence - one.log_evidence)).max() > 1
    # It is the reading `plain` of the noise that it expects.
    plain = Prior(noise_sd=tuple(1e-6 / s for s in sd), scale="plain")
    assert fit(x, (3,), plain).log_evidence == pytest.approx(one.log_evidence[[2]], rel=1e-12)


@pytest.mark.parametrize("scale", ["expected", "plain", "literal"])
def test_a_share_of_the_noise_is_one_of_the_noise_expected(scale):
    prior = Prior(SD, 5, scale=scale, length_unit=1e-3 if scale == "literal" else None)
    less = prior.with_noise(0.1)
    assert less.expected_noise(3) == pytest.approx(0.1 * prior.expected_noise(3))


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"scale": "literal"}, "length_unit is None; expected the unit of length of V"),
        ({"scale": "literal", "length_unit": 0.0}, "length_unit is 0.0"),
        ({"scale": "literal", "length_unit": "mm"}, "length_unit is 'mm'"),
        ({"length_unit": 1e-3}, "length_unit is 0.001; expected None with scale expected"),
    ],
)
def test_a_prior_without_its_unit_is_one_sentence(given, told):
    with pytest.raises(SignkinError, match=re.escape(told)) as error:
        Prior(noise_sd=1.0, **given)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("prior", "told"),
    [
        ({"noise": "data", "scale": "literal"}, "no unit of length with scale literal"),
        ({"scale": "literal", "length_unit": "mm"}, "sensor with scale literal"),
        ({"length_unit": "cm"}, "cm with scale expected"),
    ],
)
def test_settings_name_the_key_that_lacks_or_is_too_many(prior, told):
    with pytest.raises(SignkinError, match=rf"key binning\.prior\.\w+: {told}"):
        settings(prior=prior)
    with pytest.raises(SignkinError, match=rf"beside\.\w+: {told}"):
        settings({"beside": prior})


def test_pixels_have_no_millimetres():
    prior = settings(prior=LITERAL).binning.prior
    x = np.random.default_rng(0).normal(size=(20, 2))
    with pytest.raises(SignkinError, match="a prior in mm, and positions are in px"):
        prior_of(prior, 1.0, x, "px")
    grid = settings().open_choices.endres2013
    lengths = {one.length_unit for one in priors(grid, "px")}
    assert lengths == {None} and {one.length_unit for one in priors(grid, "m")} > lengths
    combinations = list(priors(grid, "m"))
    assert len(set(combinations)) == len(combinations)


@pytest.fixture(scope="module")
def both():
    names = ["a", "b", "c"]
    own = settings(orders=[0, 1, 3], fitted_orders=[3], bins=30, fitted_recordings=2)
    corpus = corpus_of(names)
    takes = [recording_of(name, arc(seed=i)) for i, name in enumerate(names)]
    cut = single_signs(corpus, takes, CutSettings.of(own), 3).trajectories
    binning = study(corpus, cut, FitSettings.of(own), 1).table("binning")
    return own, binning, two_priors(corpus, cut, binning, ChoiceSettings.of(own), 1)


def test_both_readings_are_of_the_same_recordings(both):
    _, binning, table = both
    assert list(table.columns) == tables.TABLES["two_priors"].names("m")
    assert table.groupby("reading")["prior"].unique().map(list).to_dict() == {
        SHIPPED: ["dofL sensor expected b0.1 bin"], BESIDE: ["dofL data literal mm b0.1 bin"],
    }  # fmt: skip
    assert set(table["n"]) == {2}  # of three, as fitted_recordings says
    assert (table.groupby(["reading", "dataset"]).size() == 3).all()
    here = binning[(binning["dataset"] == RECORDED) & binning["recording"].isin(["a", "c"])]
    own = table[(table["reading"] == SHIPPED) & (table["dataset"] == RECORDED)]
    means = here.groupby("order")["order_probability"].mean()
    assert own["mean_probability"].tolist() == pytest.approx(means.tolist())
    told = printed_beside(table).set_index("what")
    assert told.loc["recorded: P(3 ≤ S ≤ 5)", SHIPPED] == f"{means[3]:.3f}"
    assert told.loc["mean M, orders 0, 3, 7", SHIPPED] == ""  # no order 7


@pytest.mark.filterwarnings("error")
def test_the_figure_shows_both(both):
    _, _, table = both
    with paper_style():
        one = drawn("tiny", table)
        one.figure.canvas.draw()
    assert len(one.figure.axes) == len(TITLES)
    assert set(one.data["series"]) == set(table["prior"])
    assert "nan" not in one.caption and "2 recordings" in one.caption


def test_the_report_shows_both_and_whether_the_noise_fits(both, tmp_path):
    _, binning, table = both
    tables.write_table(table, tmp_path / "two_priors.csv", "two_priors", "m")
    tables.write_table(binning, tmp_path / "binning.csv", "binning", "m")
    (tmp_path / "two_priors.txt").write_text("Both.\n")
    for kind in (".svg", ".pdf"):
        (tmp_path / f"fig_two_priors{kind}").write_text("drawn")
    figure, compared = report_beside.two_priors(tmp_path)
    assert figure.caption == "Both." and figure.files[-1].name == "two_priors.csv"
    assert set(compared.columns) <= set(compared.frame.columns)
    (noise,) = report_beside.doubts(tmp_path)
    shown = binning[binning["dataset"].isin([RECORDED, "powerlaw"])]
    assert noise.frame["off"].sum() == (shown["noise_misfit"] > 3).sum()
    assert f"of {len(shown)} fits lie above 3" in noise.caption
    empty = pd.DataFrame(columns=tables.TABLES["learnt_prior"].names("m"))
    tables.write_table(empty, tmp_path / "learnt_prior.csv", "learnt_prior", "m")
    assert list(report_beside.learnt(tmp_path)) == []
    row = {"corpus": "tiny", "held_out": "first", "prior": "learnt", "noise_sd_m": 2e-5, "note": ""}
    tables.write_table(
        pd.DataFrame([row], columns=empty.columns), tmp_path / "learnt_prior.csv", "learnt_prior",
        "m",
    )  # fmt: skip
    (one,) = report_beside.learnt(tmp_path)
    assert one.frame["noise_mm"].tolist() == pytest.approx([0.02])
