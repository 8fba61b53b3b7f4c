"""The audit in a whole run: the ledger, the curves and the open choices beside the pipeline."""

import shutil

import numpy as np
import pytest

from signkin.pages.ledger import run_ledger
from signkin.tables import read_table


def test_every_claim_has_a_verdict_on_every_corpus_of_the_run(simulated_run):
    found = read_table(simulated_run.results / "audit/claims.csv", "claims")
    of_both = found[found["paper"].isin(["naert2017", "endres2013"])]
    assert of_both["id"].nunique() == 37
    evidence = of_both.groupby("evidence")["id"].nunique()
    assert "lsf-sim" in evidence.index
    assert (evidence == 37).all()
    others = found[~found["paper"].isin(["naert2017", "endres2013"])]
    assert others["paper"].nunique() == 3
    assert set(others["evidence"]) == {"published numbers"}  # no corpus is asked for
    assert (found[["verdict", "note"]] != "").all().all()
    assert set(found.loc[found["evidence"] == "lsf-sim", "evidence_kind"]) == {"simulated"}
    for source in found["source"].str.split().explode().dropna().unique():
        if source.startswith("results/"):
            assert (simulated_run.folder / source).is_file(), source


def test_the_simulation_carries_what_it_was_made_to_carry(simulated_run):
    found = read_table(simulated_run.results / "audit/claims.csv", "claims")
    there = found[found["evidence"] == "lsf-sim"].set_index("id")["verdict"]
    of_print = ("N02", "N03", "N04", "N05", "N07", "N09", "N10", "N11", "N12", "N13", "N15")
    for claim in of_print:
        assert there[claim] == "by construction", claim
    assert there["N19"] == "holds"  # the positive control of its nulls
    assert there["N18"] == "fails"  # the outlier of 79 frames is in it


def test_the_open_choices_have_the_pipelines_own_numbers(simulated_run):
    base = simulated_run.results / "naert2017/lsf-sim"
    many = read_table(base / "claim_choices.csv", "claim_choices")
    own = many[(many["cutoff_hz"] == 6) & (many["prominence"] == 0.05) & (many["window_s"] == 0.15)]
    tags = read_table(base / "tag_chance.csv", "tag_chance")
    shares = tags[(tags["measure"] == "share within the window") & (tags["window_s"] == 0.15)]
    shares = shares[shares["null"] == "uniform"].set_index(["hand", "tags"])
    pairs = read_table(base / "fig09.csv", "segmentations")
    moves = read_table(base / "transitions.csv", "transitions")
    for hand in ("right", "left"):
        rows = own[own["hand"] == hand].drop_duplicates("claim").set_index("claim")
        for claim, which in (("N19", "transition"), ("N20", "all")):
            value = shares.loc[(hand, which), "value"]
            assert rows.loc[claim, "estimate"] == pytest.approx(value, abs=1e-8)
        change = (pairs["refined_duration_s"] - pairs["manual_duration_s"])[pairs["hand"] == hand]
        assert rows.loc["N21", "estimate"] == pytest.approx(change.abs().median(), abs=1e-6)
        refined = moves[(moves["segmentation"] == "refined") & (moves["hand"] == hand)]
        kept = refined[refined["status"] != "overlap"]
        r = np.corrcoef(kept["mean_distance"], kept["duration_s"])[0, 1]
        assert rows.loc["N05", "estimate"] == pytest.approx(r, abs=1e-6)


def test_each_curve_has_a_figure_and_its_tables(simulated_run):
    folder = simulated_run.results / "audit/curves"
    for claim in ("N05", "N12", "N19", "N20", "N21"):
        name = f"naert2017_{claim}"
        levels = read_table(folder / f"{name}_levels.csv", "specifications")
        whole = levels[(levels["choice"] == "all") & (levels["corpus"] == "lsf-sim")].iloc[0]
        assert whole["specifications"] >= 72
        assert (folder / f"{name}.svg").stat().st_size > 5000


def test_a_new_paper_is_a_folder(simulated_run, root, tmp_path):
    paper = tmp_path / "papers/other"
    shutil.copytree(root / "papers/naert2017", paper)
    text = (paper / "claims.yaml").read_text().replace("0.303", "0.503")
    (paper / "claims.yaml").write_text(text)
    found = run_ledger([paper], simulated_run.results).claims
    rows = found[(found["id"] == "N02")].set_index("evidence")
    assert rows.loc["published numbers", "verdict"] == "inconsistent"
    assert rows.loc["lsf-sim", "verdict"] == "fails"
    assert set(found["paper"]) == {"other"}
