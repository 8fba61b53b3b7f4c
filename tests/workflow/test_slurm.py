"""Jobs on a SLURM cluster: two nodes on loopback, which lose jobs and daemons on the way.

The short form (one table, one job cancelled) runs where Debian's packages are installed; `make
test-slurm` installs them and runs the whole report, a node's death and a drained node besides.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import threading
import time
from pathlib import Path

import psutil
import pytest

from support.loopback_slurm import Cluster, asked, loopback, why_not
from support.runs import ROOT, checked, run, signkin

WHOLE = os.environ.get("SIGNKIN_SLURM") == "whole"
TABLE = "results/mini/shards/0001/minima.csv"
LIMIT_S = 7200 if WHOLE else 1200  # a job takes half a minute to start on a busy machine
PROFILE = [
    "--workflow-profile", str(ROOT / "profiles" / "slurm"), "--latency-wait", "10",
    "--slurm-init-seconds-before-status-checks", "2",
]  # fmt: skip

pytestmark = pytest.mark.skipif(bool(why_not()), reason=why_not())


@pytest.fixture
def cluster():
    """A cluster; its socket's path has to be short."""
    folder = Path(tempfile.mkdtemp(prefix="slurm-", dir="/tmp"))
    try:
        with loopback(folder / "c") as running:
            yield running
    finally:
        shutil.rmtree(folder, ignore_errors=True)


class Trouble(threading.Thread):
    """What happens to the cluster while the workflow runs on it."""

    def __init__(self, cluster: Cluster):
        super().__init__(daemon=True)
        self.cluster, self.over, self.told = cluster, threading.Event(), []

    def run(self) -> None:
        if not (job := self.until(lambda: self.cluster.running()[:1])):
            return
        asked("scancel", job[0])
        self.told.append(f"cancelled job {job[0]}")
        if not WHOLE:
            return
        if not (node_job := self.until(lambda: self.on("n1"))):
            return
        self.cluster.kill("n1")
        _kill_job(node_job[0])
        self.until(lambda: self.cluster.states()["n1"].startswith("down"))
        self.told.append(f"killed n1 under job {node_job[0]}")
        self.until(lambda: self.on("n2"))
        self.cluster.start_node("n1")
        self.until(lambda: self.cluster.states()["n1"] == "idle" and self.on("n2"))
        asked("scontrol", "update", "nodename=n2", "state=drain", "reason=test")
        self.until(lambda: self.cluster.states()["n2"].startswith("drain") and self.on("n1"))
        self.told.append("drained n2")
        asked("scontrol", "update", "nodename=n2", "state=resume")

    def on(self, node: str) -> list[str]:
        return asked("squeue", "--noheader", "--states=RUNNING", f"--nodelist={node}",
                     "--format=%i").split()  # fmt: skip

    def until(self, true):
        while not self.over.is_set():
            if found := true():
                return found
            time.sleep(0.2)
        return None


def _kill_job(number: str) -> None:
    """Kill what a job left on its node: a dead node runs nothing."""
    for step in psutil.process_iter(["cmdline"]):
        if f"slurmstepd: [{number}." in " ".join(step.info["cmdline"] or []):
            for process in [*step.children(recursive=True), step]:
                try:
                    process.kill()
                except psutil.NoSuchProcess:
                    continue


def test_a_cluster_that_loses_jobs_makes_the_tables_of_one_machine(mini, tmp_path, cluster):
    folder, data = mini()
    on_cluster = tmp_path / "on_cluster"
    shutil.copytree(folder, on_cluster)
    target = [] if WHOLE else ["--", TABLE]
    checked(run(folder, *target, data=data, timeout=LIMIT_S))
    trouble = Trouble(cluster)
    trouble.start()
    checked(run(on_cluster, *PROFILE, *target, data=data, timeout=LIMIT_S))
    trouble.over.set()
    trouble.join()
    assert len(trouble.told) == (3 if WHOLE else 1), trouble.told
    compared = signkin("compare", str(folder / "results"), str(on_cluster / "results"),
                       folder=tmp_path)  # fmt: skip
    assert compared.status == 0, compared.text
    ours, theirs = (f / TABLE for f in (folder, on_cluster))
    assert ours.read_bytes() == theirs.read_bytes()


def test_a_partition_that_is_not_there_is_told_before_the_first_job(mini, cluster, tmp_path):
    folder, data = mini()
    profile = tmp_path / "mine"
    profile.mkdir()
    text = (ROOT / "profiles/slurm/profile.yaml").read_text()
    (profile / "profile.yaml").write_text(text.replace("  # slurm_partition: short",
                                                       "  slurm_partition: short"))  # fmt: skip
    done = run(folder, "--workflow-profile", str(profile), data=data)
    assert done.status == 1
    assert done.text.strip() == (
        "signkin: the slurm_partition 'short' of the profile is not a partition of this cluster; "
        "expected all. Correct slurm_partition in the profile."
    )
    assert not asked("squeue", "--noheader")
