"""Power laws of recorded segments: the table, the figure, what has none."""

import numpy as np
import pytest

from signkin import tables
from signkin.figures.style import paper_style
from signkin.io.store import write_recordings
from signkin.studies.endres2013.figures.recorded_laws import caption, drawn
from signkin.studies.endres2013.posteriors import study, write_posteriors
from signkin.studies.endres2013.recorded_laws import law_pitfalls, recorded_laws
from signkin.studies.endres2013.settings import CutSettings, FitSettings
from signkin.studies.endres2013.single_signs import single_signs
from support.endres import settings, simulated

OWN = settings(bins=60, orders=[0, 3], fitted_orders=[3], fitted_recordings=1)
CUT = CutSettings.of(OWN)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    corpus, recordings = simulated(2)
    folder = tmp_path_factory.mktemp("laws")
    write_recordings(folder / "recordings.parquet", recordings)
    fits = study(
        corpus, single_signs(corpus, recordings, CUT, 1).trajectories, FitSettings.of(OWN), 1
    ).fits
    write_posteriors(folder / "posteriors.parquet", fits)
    laws = recorded_laws(
        corpus, [folder / "recordings.parquet"], [folder / "posteriors.parquet"], CUT, 2
    )
    return fits, laws, law_pitfalls(corpus, 240.0, CUT, 1)


def test_each_segment_between_boundaries_of_order_3_has_a_law(made):
    fits, laws, _ = made
    assert list(laws.columns) == tables.TABLES["recorded_laws"].names("m")
    recorded = [one for one in fits if one.data.dataset == "recorded"]
    assert len(laws) == sum(len(one.boundaries_s(3)) + 1 for one in recorded)
    first = laws[laws["recording"] == recorded[0].data.source.recording]
    assert first["end_s"].tolist()[:-1] == pytest.approx(sorted(recorded[0].boundaries_s(3)))
    assert first["start_s"].tolist()[1:] == first["end_s"].tolist()[:-1]
    told = laws[laws["note"] == ""]
    assert len(told) > 2
    assert (np.abs(told["r"]) <= 1).all()
    assert (told["r_squared"] <= 1).all()
    assert (told["n"] >= 8).all()


def test_known_exponents_stand_beside_them(made):
    known = made[2]
    assert list(known.columns) == tables.TABLES["law_pitfalls"].names("m")
    assert len(known) == (3 * 3 * 2 + 3) * 3
    assert known.loc[known["path"] == "noise alone", "beta"].isna().all()
    assert (known.loc[known["noise_sd"] == 0, "smallest_difference"].isna()).all()


def test_the_caption_tells_what_noise_alone_gives(made):
    _, laws, known = made
    with paper_style():
        figure = drawn(laws, known)
    assert len(figure.figure.axes) == 2
    assert "Noise alone, through the same filter, gives non-linear -0." in figure.caption
    assert "The smallest difference" in figure.caption
    none = laws.assign(beta=np.nan)
    assert f"none of {len(laws)} segments" in caption(none, known)
