"""Our least squares and rotations against libraries that had no part in them."""

import numpy as np
import pandas as pd
import pytest
import statsmodels.formula.api as smf
from scipy.spatial.transform import Rotation

from signkin.coarticulation import SurfaceDuration, geodesic_distance
from signkin.coarticulation.duration import Transitions


def test_surface_against_statsmodels_ols():
    rng = np.random.default_rng(5)
    data = pd.DataFrame({"g": rng.uniform(0, 0.3, 89), "e": rng.uniform(0, 1.1, 89)})
    data["d"] = 0.15 + 0.66 * data["g"] + 0.28 * data["e"] + rng.normal(0, 0.06, 89)
    ols = smf.ols("d ~ g + e", data).fit()
    ours = SurfaceDuration().fit(Transitions(*(data[c].to_numpy() for c in ("g", "e", "d"))))
    assert ours.theta == pytest.approx(ols.params.to_numpy(), rel=1e-9)
    assert ours.standard_error == pytest.approx(ols.bse.to_numpy(), rel=1e-9)
    assert ours.interval() == pytest.approx(ols.conf_int().to_numpy(), rel=1e-9)


def test_geodesic_against_the_rotation_matrix():
    rng = np.random.default_rng(2)
    a, b = Rotation.random(200, rng=rng), Rotation.random(200, rng=rng)
    trace = np.einsum("nij,nij->n", a.as_matrix(), b.as_matrix())
    half = np.arccos(np.clip((trace - 1) / 2, -1, 1)) / 2
    found = geodesic_distance(a.as_quat()[:, None], b.as_quat()[:, None])
    assert found == pytest.approx(half, abs=1e-7)
