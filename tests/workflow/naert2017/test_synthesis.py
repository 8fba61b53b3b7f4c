"""Synthesis in the workflow, and from the command line."""

import subprocess
import sys

import numpy as np
import pytest

from signkin import read_recording, tables
from support.runs import environment

SAY = [sys.executable, "-m", "signkin", "utterance", "lsf-sim"]


def said(done, *words):
    return subprocess.run(
        [*SAY, *words], cwd=done.folder, env=environment(None), text=True, timeout=300,
        capture_output=True, check=False,
    )  # fmt: skip


def test_every_figure_and_table_is_there(simulated_run):
    folder = simulated_run.results / "naert2017/lsf-sim"
    for figure in ("fig01", "fig02", "fig12", "fig13"):
        drawn = tables.read_table(folder / f"{figure}.csv", "skeletons")
        assert len(drawn) and (folder / f"{figure}.svg").stat().st_size > 10_000
    rows = tables.read_table(folder / "synthesis/synthesis.csv", "synthesis")
    own = rows[rows["material"] == "own"]
    assert own.groupby(["recording", "transition"]).size().eq(10).all() and len(own) == 890
    printed = tables.read_table(folder / "synthesis/readings_synthesis.csv", "readings_synthesis")
    error = printed[printed["measure"] == "position error"].set_index("reading")["mean"]
    assert error["slerp"] > 0 and error["linear"] == pytest.approx(error["slerp"], rel=0.02)
    assert set(printed["printed"]) == {"yes", "no"}
    page = (simulated_run.results / "report/papers/naert2017.html").read_text()
    assert "Synthesis against the captured motion" in page and "Figure 13" in page


def test_an_utterance_from_the_command_line(own_copy):
    done = said(own_copy, "ONE-07 TWO-07", "--name", "two", "--method", "interpolation")
    assert done.returncode == 0, done.stderr
    folder = own_copy.results / "naert2017/lsf-sim/synthesis"
    parts = tables.read_table(folder / "two_parts.csv", "utterances")
    assert list(parts["kind"]) == ["sign", "transition", "sign"]
    assert set(parts["method"]) == {"", "interpolation"}
    motion = read_recording(folder / "two.bvh", unit="cm", up="y", right="-x")
    assert motion.rate_hz == pytest.approx(100)
    assert motion.duration_s == pytest.approx(parts["end_s"].iloc[-1] + 0.01)
    assert np.isfinite(motion.positions).all()


def test_a_gloss_that_does_not_occur_is_told_in_one_sentence(own_copy):
    done = said(own_copy, "ONE-7")
    assert done.returncode == 1
    assert "the gloss 'ONE-7' does not occur" in done.stderr and "ONE-07" in done.stderr
    assert "Traceback" not in done.stderr
