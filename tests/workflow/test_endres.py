"""Endres et al. 2013 in the workflow: a mini corpus of single signs, one of continuous signing."""

import csv
import shutil

import numpy as np
import pandas as pd
import pympi
import pytest
import yaml

from signkin import Interval, tables
from signkin.io.eaf import write_eaf
from signkin.studies.endres2013.figures import DRAWINGS
from support.endres import simulated
from support.runs import MINI, ROOT, checked, mini_motion, prepare, run

GOOD = 4
ORDERS = [0, 1, 2, 3]


def study_config():
    """Return the shipped configuration with a study that is over in a moment."""
    config = yaml.safe_load((ROOT / "config.yaml").read_text())
    config["binning"].update(
        bins=40, orders=ORDERS, fitted_orders=[1, 3], fitted_recordings=2, bootstrap_draws=100,
        chance_trajectories=200,
    )  # fmt: skip
    config["open_choices"]["endres2013"] = {
        "recordings": 2, "orders": [0, 3], "dof": [None], "bins": [40], "time_unit": ["bin"],
        "noise": ["sensor expected"], "concentration": [0.1], "literal_dof": [],
        "learnt_recordings": 4,
    }  # fmt: skip
    return config


def write_signs(corpora, data):
    """Write single signs: four simulated ones, one that is too short, one with a long gap."""
    source, recordings = simulated(GOOD)
    folder = corpora / "signs"
    folder.mkdir(parents=True)
    described = {k: v for k, v in source.settings.items() if k != "simulator"}
    described["motion"] = {**described["motion"], "options": {}}
    (folder / "corpus.yaml").write_text(yaml.safe_dump({**described, "data_folder": "signs"}))
    (data / "signs").mkdir(parents=True)
    rows = []
    for entry, recording in zip(source.entries, recordings, strict=True):
        rows.append([entry.recording, entry.signer, entry.sign, entry.repetition])
        write_motion(data / "signs", recording.name, recording.positions)
    moving = recordings[0].positions[200:296]  # 0.4 s out of the movement, rest before and after
    short = np.concatenate([np.repeat(moving[:1], 40, 0), moving, np.repeat(moving[-1:], 40, 0)])
    write_motion(data / "signs", "short", short)
    gap = recordings[0].positions.copy()
    gap[200:300, 0] = np.nan
    write_motion(data / "signs", "gap", gap)
    rows += [["short", "sim-1", "loop", 30], ["gap", "sim-1", "loop", 31]]
    with (folder / "recordings.csv").open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["recording", "signer", "motion", "sign", "repetition"])
        out.writerows([[name, who, f"{name}.csv", sign, n] for name, who, sign, n in rows])


def write_motion(folder, name, positions):
    columns = [f"{hand}_wrist_{axis}" for hand in ("right", "left") for axis in "xyz"]
    frame = pd.DataFrame(positions.reshape(len(positions), 6), columns=columns)
    frame.to_csv(folder / f"{name}.csv", index=False, float_format="%.5f")


def write_continuous(corpora, data):
    """Write two recordings of continuous signing with ELAN files."""
    folder = corpora / "mini"
    folder.mkdir(parents=True)
    (data / "mini").mkdir(parents=True)
    annotation = {"format": "eaf", "sign_tier": "Gloss", "utterance_gap_s": 1.0}
    (folder / "corpus.yaml").write_text(yaml.safe_dump({**MINI, "annotation": annotation}))
    (folder / "recordings.csv").write_text(
        "recording,signer,motion,annotation\nm1,s1,m1.csv,m1.eaf\nm2,s2,m2.csv,m2.eaf\n"
    )
    for i in (1, 2):
        (data / f"mini/m{i}.csv").write_text(mini_motion(6, i))
        signs = [
            Interval(k + 0.05 * i, k + 0.6, ("CAKE", "IX")[k % 2], "Gloss") for k in range(1, 5)
        ]
        write_eaf(
            data / f"mini/m{i}.eaf", author="t", date="2020", media_url="v.mp4",
            tiers=[("Gloss", None, signs)],
        )  # fmt: skip


@pytest.fixture(scope="session")
def signs_run(tmp_path_factory):
    """A run of the study on both mini corpora, on two cores; and its folder of data."""
    base = tmp_path_factory.mktemp("signs")
    folder = prepare(
        base / "run", **{**study_config(), "corpora": ["signs", "mini"], "recordings_per_job": 3}
    )
    write_signs(folder / "corpora", base / "data")
    write_continuous(folder / "corpora", base / "data")
    return checked(run(folder, "--cores", "2", "endres2013", data=base / "data")), base / "data"


def table(done, corpus, name, kind=None):
    return tables.read_table(done.results / f"endres2013/{corpus}/{name}.csv", kind or name)


def test_every_sign_is_binned_or_listed(signs_run):
    done, _ = signs_run
    left_out = table(done, "signs", "left_out", "binning_left_out")
    told = {(row.recording, row.dataset): row.reason for row in left_out.itertuples()}
    assert set(told) == {("short", "powerlaw"), ("gap", "recorded"), ("gap", "powerlaw")}
    assert "has no room for 3 segments of more than 0.3 s" in told["short", "powerlaw"]
    assert "recording gap, right_wrist: 100 frames without a position" in told["gap", "recorded"]
    rows = table(done, "signs", "binning")
    recorded = rows[rows["dataset"] == "recorded"]
    assert recorded.groupby("recording").size().to_dict() == dict.fromkeys(
        [*sorted(set(recorded["recording"]) - {"short"}), "short"], len(ORDERS)
    )
    assert recorded["recording"].nunique() == GOOD + 1  # of both shards
    assert rows[rows["dataset"] == "powerlaw"]["recording"].nunique() == GOOD
    sums = rows.groupby(["recording", "dataset", "true_order"], dropna=False)["order_probability"]
    assert sums.sum().to_numpy() == pytest.approx(1)
    truth = table(done, "signs", "ground_truth")
    assert truth.groupby("recording").size().tolist() == [3] * GOOD
    grid = table(done, "signs", "order_choices")
    assert len(grid) == 1 and grid["recordings"].iloc[0] == 2


def test_each_figure_has_its_numbers(signs_run):
    done, _ = signs_run
    folder = done.results / "endres2013/signs"
    for name in DRAWINGS:
        kind = "fig01_powerlaw" if name == "fig01" else "endres_figure"
        assert len(table(done, "signs", name, kind)) > 5
        assert (folder / f"{name}.svg").stat().st_size > 10_000
        assert (folder / f"{name}.pdf").read_bytes().startswith(b"%PDF")
    captions = yaml.safe_load((folder / "captions.json").read_text())
    assert set(captions) == set(DRAWINGS)
    assert f"{GOOD} power-law ground-truth trajectories" in captions["fig06"]
    assert f"{GOOD + 1} recorded trajectories" in captions["fig07"]
    assert not any("nan" in text for text in captions.values())


def test_continuous_wrists_stand_beside_tags_and_in_elan(signs_run):
    done, data = signs_run
    posteriors = table(done, "mini", "wrist_posteriors")
    assert posteriors[["recording", "hand"]].to_numpy().tolist() == [
        [m, h] for m in ("m1", "m2") for h in ("right", "left")
    ]
    found = table(done, "mini", "wrist_boundaries")
    assert found.groupby(["recording", "hand"]).size().sum() == len(found) > 8
    compared = table(done, "mini", "one_wrist")
    assert len(compared) == 8 and (compared["hit_rate"].notna()).all()
    manual = compared[compared["truth"] == "manual tags"]
    assert set(manual["n_truth"]) == {16}  # 2 recordings, 4 signs, 2 edges
    for name in ("m1", "m2"):
        new = pympi.Elan.Eaf(str(done.results / f"endres2013/mini/eaf/{name}.eaf"))
        for hand in ("right", "left"):
            own = found[(found["recording"] == name) & (found["hand"] == hand)]
            segments = sorted(new.get_annotation_data_for_tier(f"signkin binning {hand}"))
            starts = [a for a, *_ in segments]
            assert starts == pytest.approx(1000 * own["boundary_s"].to_numpy()[:-1], abs=0.51)
        old = pympi.Elan.Eaf(str(data / f"mini/{name}.eaf"))
        assert new.get_annotation_data_for_tier("Gloss") == old.get_annotation_data_for_tier(
            "Gloss"
        )


def test_one_core_gives_the_same_bytes(signs_run, tmp_path):
    """What comes before the study is left as it is; lsf-sim and isl-sim are compared as a whole."""
    done, data = signs_run
    folder = shutil.copytree(done.folder, tmp_path / "run")
    shutil.rmtree(folder / "results/endres2013")
    again = checked(run(folder, "--cores", "1", "endres2013", data=data))
    made = [
        {p.relative_to(r): p.read_bytes() for p in sorted(r.rglob("*")) if p.is_file()}
        for r in (done.results / "endres2013", again.results / "endres2013")
    ]
    assert made[0].keys() == made[1].keys() and len(made[0]) > 50
    assert [str(name) for name in made[0] if made[0][name] != made[1][name]] == []
