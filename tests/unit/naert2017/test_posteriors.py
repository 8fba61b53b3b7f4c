"""The table of posteriors and its ELAN tiers, from the tables of a corpus."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from signkin import read_annotation, tables
from signkin.annotation import Interval
from signkin.io.eaf import write_eaf
from signkin.studies.naert2017 import posteriors
from signkin.studies.naert2017.elan import refined_copies


@pytest.fixture
def made(monkeypatch):
    """Twenty signs of one recording; the right hand has a minimum 20 ms after each tag."""
    monkeypatch.setattr(
        "signkin.studies.naert2017.tagged.lead",
        lambda corpus, name: {"corpus": corpus.name, "recording": name, "signer": "s"},
    )
    starts = 1 + np.cumsum(np.random.default_rng(3).uniform(0.6, 0.9, 20))
    signs = np.round(np.column_stack([starts, starts + 0.3]), 3)
    intervals = pd.DataFrame(signs, columns=["start_s", "end_s"]).assign(
        recording="r", role="sign", label="A", tier="t", written="A"
    )
    minima = pd.DataFrame(
        {"recording": "r", "hand": "right", "minimum_s": signs.ravel() + 0.02,
         "prominence_m_per_s": 0.5, "rest_s": signs.ravel() + 0.02, "rest_sd_s": 0.005}
    )  # fmt: skip
    corpus = SimpleNamespace(
        name="c", unit="m", by_name={"r": None}, dominant_hand=lambda entry: "right"
    )
    types = pd.DataFrame({"recording": "r", "sign": range(1, 21), "type": ["00", "11"] * 10})
    models = posteriors.tag_models(corpus, ["r"], intervals, minima, types)
    models = posteriors.models_of(posteriors.models_text(models))
    table = posteriors.boundary_posteriors(corpus, ["r"], intervals, minima, types, models)
    return signs, intervals, table


def test_a_row_a_tag_and_hand(made):
    signs, _, table = made
    assert list(table.columns) == tables.TABLES["boundary_posteriors"].names()
    assert len(table) == 2 * 2 * len(signs)
    right = table[table["hand"] == "right"]
    assert right["manual_s"].tolist() == signs.ravel().tolist()
    assert right["bias_s"].iloc[0] == pytest.approx(0.02, abs=0.003)
    assert (right["mean_s"] - right["manual_s"]).to_numpy() == pytest.approx(0.02, abs=0.005)
    order = right[["low90_s", "low50_s", "mean_s", "high50_s", "high90_s"]].to_numpy()
    assert (np.diff(order) > 0).all()
    assert right["acts"].all()
    left = table[table["hand"] == "left"]
    assert left["acts"].tolist() == [False, False, True, True] * 10
    assert left["note"].str.contains("no speed minimum").all()
    assert left["note"].str.contains(posteriors.NOT_LEARNT).all()


def test_intervals_as_tiers(made, tmp_path):
    signs, intervals, table = made
    tags = [Interval(a, b, "A", "t") for a, b in signs]
    write_eaf(tmp_path / "r.eaf", author="t", date="2020-01-01T00:00:00+00:00",
              media_url="m.bvh", tiers=[("t", None, tags)])  # fmt: skip
    about = pd.DataFrame({"recording": ["r"], "annotation_file": ["r.eaf"],
                          "motion_file": ["m.bvh"], "clock_offset_s": [0.0]})  # fmt: skip
    boundaries = table.assign(refined_s=table["mean_s"])
    copy = refined_copies(tmp_path, about, boundaries, intervals, posteriors=table)["r.eaf"]
    (tmp_path / "new.eaf").write_bytes(copy)
    back = read_annotation(tmp_path / "new.eaf")
    names = {f"signkin posterior {h} {e}" for h in ("right", "left") for e in ("start", "end")}
    assert names < set(back.tiers)
    first = back.tier("signkin posterior right start")[0]
    row = table[(table["hand"] == "right") & (table["edge"] == "start")].iloc[0]
    assert (first.start_s, first.end_s) == pytest.approx((row.low90_s, row.high90_s), abs=0.001)
    assert first.label.startswith(f"A start {row.mean_s:.3f} s ({row.low90_s:.3f}-")
    for name in names:
        times = back.times_s(name)
        assert len(times) == len(signs)
        assert (times[1:, 0] >= times[:-1, 1]).all()
