"""What someone gets who has no real recordings, and what the pipeline promises of any run."""

import fcntl
import os
import re
import signal
import subprocess
import time

import numpy as np
import pandas as pd
import pytest
import yaml

from signkin import read_annotation, tables
from signkin.coarticulation.transitions import utterance_names
from signkin.exhibits import exhibits
from signkin.report.attempts import ABSENT
from signkin.statistics import descriptive
from signkin.studies.naert2017.transitions import counted
from support.runs import checked, command, environment, files_of, prepare, run, signkin


def table(done, name, kind=None):
    return tables.read_table(done.results / "naert2017/lsf-sim" / f"{name}.csv", kind or name)


def test_table2_is_the_printed_one_in_every_digit(simulated_run, root):
    found = table(simulated_run, "table2").set_index("type")
    published = pd.read_csv(
        root / "papers/naert2017/table2.csv", dtype=str, keep_default_na=False
    ).set_index("type")
    assert (found.loc[published.index, "equal"] == "yes").all()
    for kind, row in published.iterrows():
        told = found.loc[kind]
        if row["n_without_outlier"]:
            assert told["printed_mean"] == f"{row['mean']} ({row['mean_without_outlier']})"
            assert told["printed_sd"] == f"{row['sd']} ({row['sd_without_outlier']})"
        else:
            assert [told["printed_n"], told["printed_mean"], told["printed_sd"]] == [
                row["n"], row["mean"], row["sd"],
            ]  # fmt: skip
    assert found.loc["all", "printed_n"].startswith("89")


def test_shifting_one_tag_by_one_frame_changes_exactly_its_row(simulated_run, root, tmp_path):
    published = pd.read_csv(root / "papers/naert2017/table2.csv", dtype=str, keep_default_na=False)
    sim = simulated_run.results / "lsf-sim/simulated"
    lexicon = pd.read_csv(root / "corpora/lsf-sim/signs.csv", dtype=str).set_index("gloss")
    digits = (lexicon["hands"] + lexicon["symmetric"]).to_dict()

    def from_tags(files):
        rows = []
        for file in files:
            a = read_annotation(file, tiers=("sign", "utterance"))
            signs = a.tier("sign")
            names = utterance_names(signs, a.tier("utterance"))
            for before, after, u, v in zip(signs, signs[1:], names, names[1:], strict=False):
                if u == v:
                    kind = digits[before.label] + digits[after.label]
                    rows.append((kind, round(after.start_s - before.end_s, 9)))
        moves = pd.DataFrame(rows, columns=["type", "duration_s"])
        flags = descriptive.outliers(moves["duration_s"].to_numpy(), 3.0)
        return descriptive.table2(moves, flags, published).set_index("type")

    files = [sim / "lsf-sim-1.eaf", sim / "lsf-sim-2.eaf"]
    before = from_tags(files)
    assert (before.loc[published["type"], "equal"] == "yes").all()
    # The third sign's end, one frame later: the transition after it is one frame shorter.
    signs = read_annotation(files[0], tiers=("sign",)).tier("sign")
    kind = digits[signs[2].label] + digits[signs[3].label]
    text = files[0].read_text()
    slots = re.findall(rf'TIME_SLOT_ID="(ts\d+)" TIME_VALUE="{round(signs[2].end_s * 1000)}"', text)
    assert len(slots) == 1
    shifted = tmp_path / "shifted.eaf"
    old = round(signs[2].end_s * 1000)
    shifted.write_text(
        text.replace(
            f'TIME_SLOT_ID="{slots[0]}" TIME_VALUE="{old}"',
            f'TIME_SLOT_ID="{slots[0]}" TIME_VALUE="{old + 10}"',
        )
    )
    after = from_tags([shifted, files[1]])
    rows = after.loc[published["type"]]
    assert rows.index[rows["equal"] == "no"].tolist() == [kind]


def test_the_surface_is_found_again(simulated_run):
    surface = table(simulated_run, "surface")
    published = surface["published"].astype(float)
    assert surface["designed"].to_numpy() == pytest.approx(published.to_numpy(), abs=5e-6)
    assert (surface["shift_percent"].abs() < 10).all()
    assert (surface["low"] < published).all()
    assert (published < surface["high"]).all()


def test_refinement_brings_the_error_to_truth_down(simulated_run):
    error = table(simulated_run, "truth_error").set_index(["hand", "segmentation"])
    for hand in ("right", "left"):
        assert error.loc[(hand, "refined"), "high_s"] < error.loc[(hand, "manual"), "low_s"]


def test_transitions_of_every_segmentation_and_hand(simulated_run):
    moves = table(simulated_run, "transitions")
    counts = moves.groupby(["segmentation", "hand"]).size().to_dict()
    assert counts == {
        ("manual", "both"): 89, ("manual", "right"): 89, ("manual", "left"): 89,
        ("refined", "right"): 89, ("refined", "left"): 89,
    }  # fmt: skip
    assert set(moves["type_source"]) == {"lexicon"}
    whole = counted(moves)
    assert whole["geodesic_norm"].mean() == pytest.approx(0, abs=1e-9)
    assert np.ptp(whole["euclidean_norm"]) == pytest.approx(1)
    corners = tables.read_table(simulated_run.results / "naert2017/lsf-sim/diamond.csv", "diamond")
    assert corners["share_inside"].iloc[0] > 0.9


def test_what_is_missing_is_said(simulated_run):
    page = (simulated_run.results / "report/index.html").read_text(encoding="utf-8")
    for corpus in ("dgs-1984189", "boston104", "libras"):
        assert f"{corpus} is not in this run: no folder of real recordings is set" in page
    own = (simulated_run.results / "report/corpora/lsf-sim.html").read_text(encoding="utf-8")
    assert "SIMULATED" in own
    assert not re.search(r">\s*nan\s*<", page, flags=re.IGNORECASE)


def test_everything_can_be_made_of_the_simulated_corpora(simulated_run):
    """What cannot be made stops no run: so a fault of ours would hide where nobody looks."""
    assert list(simulated_run.results.glob("*/not_available/*.csv")) == []
    for page in (simulated_run.results / "report").rglob("*.html"):
        assert ABSENT not in page.read_text(encoding="utf-8"), page


def test_every_table_is_as_the_dictionary_says(simulated_run, root):
    drawn = {
        paper: {exhibit.stem: exhibit.table for exhibit in exhibits(root / "papers" / paper)}
        for paper in ("naert2017", "endres2013")
    }
    seen = 0
    for path in sorted(simulated_run.results.glob("**/*.csv")):
        if "printed" in path.parts:  # copies of the papers' own tables
            continue
        study = path.relative_to(simulated_run.results).parts[0]
        kind = path.stem if path.stem in tables.TABLES else drawn.get(study, {}).get(path.stem)
        if path.parent.parent.name == "shards" and path.stem == "transitions":
            kind = "raw_transitions"
        if study == "endres2013" and path.stem == "fig_one_wrist":
            kind = "endres_figure"
        if kind:
            columns = list(pd.read_csv(path, nrows=0).columns)
            assert columns == tables.TABLES[kind].names(), path
            seen += 1
    assert seen > 15


def test_the_tags_are_written_back_beside_the_old_ones(simulated_run):
    for name in ("lsf-sim-1", "lsf-sim-2"):
        old = simulated_run.results / f"lsf-sim/simulated/{name}.eaf"
        new = simulated_run.results / f"naert2017/lsf-sim/eaf/{name}.eaf"
        a, b = read_annotation(old), read_annotation(new)
        hands = ("right", "left")
        moved = {f"signkin refined {hand}" for hand in hands}
        posterior = {f"signkin posterior {h} {edge}" for h in hands for edge in ("start", "end")}
        assert set(b.tiers) - set(a.tiers) == moved | posterior
        for tier in a.tiers:
            assert a.tier(tier) == b.tier(tier)
        refined = table(simulated_run, "boundaries").query("recording == @name & hand == 'right'")
        times = b.times_s("signkin refined right").ravel()
        assert times == pytest.approx(refined["refined_s"].to_numpy(), abs=5e-4)


def test_a_second_run_does_nothing(own_copy):
    again = checked(run(own_copy.folder))
    assert "Nothing to be done" in again.text


def test_a_changed_key_makes_anew_what_depends_on_it_alone(own_copy):
    config = own_copy.folder / "config.yaml"
    told = yaml.safe_load(config.read_text())
    told.setdefault("refinement", {})["search_window_s"] = 0.16
    config.write_text(yaml.safe_dump(told))
    planned = checked(run(own_copy.folder, "-n")).text
    rules = {line.split()[0] for line in planned.splitlines() if re.fullmatch(r"\w+ +\d+", line)}
    assert {"refine", "transitions", "naert_tables", "claims", "report"} <= rules
    assert not rules & {"ingest", "kinematics", "single_signs", "bin_single_signs", "synthesis"}


def test_what_was_damaged_is_made_anew_and_said(simulated_run, own_copy):
    results = own_copy.results
    cut, flipped = results / "lsf-sim/shards/0001/intervals.csv", results / "lsf-sim/intervals.csv"
    gone = results / "lsf-sim/recordings.csv"
    cut.write_text(cut.read_text().splitlines()[0] + "\n")
    flipped.write_bytes(flipped.read_bytes()[:-20] + b"?" + flipped.read_bytes()[-19:])
    gone.unlink()
    told = signkin("verify", folder=own_copy.folder)
    assert told.status == 1
    for path, what in ((cut, "changed"), (flipped, "changed"), (gone, "missing")):
        assert f"{path.relative_to(own_copy.folder)}: {what}" in told.text
    again = checked(run(own_copy.folder, "--", str(flipped.relative_to(own_copy.folder))))
    for path in (cut, flipped):
        assert f"{path.relative_to(own_copy.folder)} is not what its job wrote" in again.text
    compared = signkin("compare", str(simulated_run.results), "results", folder=own_copy.folder)
    assert compared.text.startswith("No difference beyond 1e-09"), compared.text
    assert signkin("verify", folder=own_copy.folder).status == 0


def killed(folder, targets, jobs):
    """Run until so many more jobs have ended, and kill all of it."""
    records = folder / ".snakemake/signkin-written"  # one a job
    before = len(list(records.glob("*.json")))
    process = subprocess.Popen(
        command("--cores", "2", *targets), cwd=folder, env=environment(None),
        start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    deadline = time.monotonic() + 300
    while time.monotonic() < deadline and process.poll() is None:
        if len(list(records.glob("*.json"))) >= before + jobs:
            break
        time.sleep(0.02)
    assert process.poll() is None, "the run was over before it could be killed"
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def test_one_core_after_being_killed_gives_the_same_bytes(simulated_run, tmp_path):
    """The next run completes what five killed ones left, with other cores, to the same bytes.

    On the first study; tests of the second have their own comparison.
    """
    folder = prepare(tmp_path / "run")
    targets = ("naert2017", "naert2017_durations")
    for jobs in (1, 2, 2, 2, 2):
        killed(folder, targets, jobs)
    checked(run(folder, "--cores", "1", *targets))
    first, second = files_of(simulated_run.results), files_of(folder / "results")
    assert len(second) > 60
    assert second.keys() <= first.keys()
    differing = [name for name in second if first[name] != second[name]]
    assert differing == []


def test_two_runs_in_one_folder_do_not_collide(tmp_path):
    folder = prepare(tmp_path / "run")
    (folder / ".snakemake").mkdir()
    with (folder / ".snakemake/signkin.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        second = run(folder)
    assert second.status == 1
    assert "another run is at work" in second.text


def test_duration_models_find_the_printed_surface_and_simple_is_worse(simulated_run):
    theta = table(simulated_run, "duration_coefficients")
    assert (theta.loc[theta["model"] == "SURFACE", "published_inside"] == "yes").all()
    errors = table(simulated_run, "duration_models").set_index(["model", "evaluation"])
    for evaluation in ("leave_one_out", "leave_one_recording_out"):
        simple, surface = (errors.loc[(m, evaluation)] for m in ("SIMPLE", "SURFACE"))
        assert simple["mean_error_low_s"] > surface["mean_error_high_s"]
    statistics = table(simulated_run, "statistics")
    one = statistics[
        (statistics["test"] == "one-way ANOVA")
        & (statistics["question"] == "type")
        & (statistics["outliers"] == "kept")
        & (statistics["effect_name"] == "eta squared")
    ].iloc[0]
    # What the sums and sums of squares of the printed Table 2 give.
    assert (one["df1"], one["df2"]) == (12, 76)
    assert round(one["statistic"], 3) == 0.752 and round(one["p"], 3) == 0.696
