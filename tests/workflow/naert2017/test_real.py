"""The workflow on the real recordings: counts that were known before."""

import pytest

from signkin import tables
from signkin.studies.naert2017.transitions import counted
from support.less import LESS
from support.runs import checked, prepare, run

pytestmark = pytest.mark.usefixtures("real_corpora")


@pytest.fixture(scope="module")
def real_run(tmp_path_factory, real_corpora):
    corpora = ["dgs-1984189", "boston104", "libras"]
    folder = prepare(tmp_path_factory.mktemp("real") / "run", corpora=corpora, **LESS)
    return checked(run(folder, "--cores", "2", data=real_corpora))


def naert(done, corpus, name, kind=None):
    path = done.results / "naert2017" / corpus / f"{name}.csv"
    return tables.read_table(path, kind or name)


def test_dgs_has_61_transitions(real_run):
    moves = counted(naert(real_run, "dgs-1984189", "transitions"))
    d = moves["duration_s"]
    assert (len(d), round(d.mean(), 3), round(d.std(ddof=1), 3)) == (61, 0.347, 0.208)
    left_out = naert(real_run, "dgs-1984189", "transitions_left_out", "transitions")
    assert left_out["status"].tolist() == ["zero_length"]
    assert moves["geodesic_rad"].notna().all()
    table1 = naert(real_run, "dgs-1984189", "table1")
    assert len(table1) == 17
    assert table1["signs"].sum() == 62
    assert (table1["translation"] != "").all()


def test_boston_lists_its_zero_length_and_overlapping_transitions(real_run):
    moves = naert(real_run, "boston104", "transitions")
    whole = moves[(moves["segmentation"] == "manual") & (moves["hand"] == "both")]
    assert len(whole) == 687
    listed = naert(real_run, "boston104", "transitions_left_out", "transitions")
    assert listed["status"].value_counts().to_dict() == {"overlap": 121, "zero_length": 112}
    assert (listed.loc[listed["status"] == "overlap", "duration_s"] < 0).all()
    # 113 of the overlaps share one frame.
    shared = (listed["duration_s"] * 30).round().astype(int) == -1
    assert shared.sum() == 113
    assert "euclidean_px" in moves.columns
    assert moves["geodesic_rad"].isna().all()


def test_corpora_without_tags_are_read_and_shown(real_run):
    about = tables.read_table(real_run.results / "libras/recordings.csv", "recordings")
    assert about["frames"].tolist() == [948, 647]
    assert (real_run.results / "libras/fig_speed.svg").stat().st_size > 10_000
    # Synthesis wants no tags; transitions do.
    assert not list((real_run.results / "naert2017/libras").glob("transitions*"))


def test_refined_tags_keep_their_order_in_every_recording(real_run):
    for corpus in ("dgs-1984189", "boston104"):
        table = naert(real_run, corpus, "boundaries")
        for _, rows in table.groupby(["recording", "hand"]):
            times = rows.pivot(index="sign", columns="edge", values="refined_s")
            assert (times["start"] < times["end"]).all()
            used = rows.loc[rows["moved"].astype(bool)].groupby("refined_s")["manual_s"].nunique()
            assert (used == 1).all()


def test_nothing_is_nan_without_a_reason(real_run):
    for corpus in ("dgs-1984189", "boston104"):
        moves = naert(real_run, corpus, "transitions")
        assert (moves.loc[moves["mean_distance"].isna(), "note"] != "").all()
        assert (moves.loc[moves["geodesic_norm"].isna(), "note"] != "").all()
        table2 = naert(real_run, corpus, "table2")
        assert (table2.loc[table2["sd_s"].isna(), "note"] != "").all()
