"""Limits on memory are said before a run, and a job without memory is one sentence."""

import json
import subprocess
import sys
from types import SimpleNamespace

import pytest

from signkin import SignkinError
from signkin.job import job
from signkin.memory import ADDRESSES_MB, LEAST_MB, Limit, check_memory, limits, limits_of_jobs

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="limits are read on Linux")


@LINUX
@pytest.mark.parametrize(
    ("group", "file"),
    [("0::/user/mine\n", "sys/fs/cgroup/user/memory.max"),
     ("5:cpu:/\n9:memory:/user/mine\n", "sys/fs/cgroup/memory/user/memory.limit_in_bytes")],
)  # fmt: skip
def test_the_least_of_the_groups_above_is_the_limit(tmp_path, group, file):
    (tmp_path / "proc/self").mkdir(parents=True)
    (tmp_path / "proc/self/cgroup").write_text(group)
    path = tmp_path / file
    (path.parent / "mine").mkdir(parents=True)
    (path.parent / "mine" / path.name).write_text("max\n")
    path.write_text("600000000\n")
    assert Limit(600.0, "the control group (cgroup)") in list(limits((), tmp_path))


@LINUX
def test_a_run_under_a_limit_below_need_is_refused_before_its_first_job(tmp_path):
    """By the shell's own limit, that of one process."""
    (tmp_path / "config.yaml").write_text("corpora: [lsf-sim]\n")
    run = f"ulimit -v 800000; exec {sys.executable} -m signkin run"
    done = subprocess.run(["bash", "-c", run], cwd=tmp_path, capture_output=True, text=True,
                          check=False)  # fmt: skip
    assert done.returncode == 1
    assert done.stderr.startswith(
        f"signkin: memory is limited to 819 MB by ulimit -v (RLIMIT_AS), and a job takes "
        f"{LEAST_MB + ADDRESSES_MB:.0f} MB before it has read anything"
    )
    assert not (tmp_path / ".snakemake").exists()


def test_what_jobs_of_the_last_run_held_is_asked_for(tmp_path):
    (tmp_path / "a.cost.json").write_text(json.dumps({"rule": "r", "peak_mb": 900.0}))
    assert check_memory(tmp_path, [Limit(2000, "x"), Limit(1500, "y", each=True)], 2) == ""
    told = check_memory(tmp_path, limits_of_jobs([{"default-resources": {"mem_mb": 800}}]), 50)
    assert told.startswith("A job may take 900 MB") and "800 MB by default-resources" in told
    told = check_memory(tmp_path, limits(["--resources", "mem_mb=1700"], tmp_path), 2)
    assert told == (
        "2 jobs at a time may take 1800 MB (the most a job of the last run held is 900 MB), and "
        "memory is limited to 1700 MB by --resources mem_mb. Raise it, or use --cores 1, should a "
        "job be killed."
    )
    with pytest.raises(SignkinError, match=r"300 MB by the cgroup, .* takes 350 MB.*least 900 MB"):
        check_memory(tmp_path, [Limit(300, "the cgroup")], 1)


@pytest.mark.parametrize("analysis", [True, False])
def test_a_job_without_memory_fails_in_one_sentence(tmp_path, capsys, analysis):
    """Also where an analysis may be left out: results do not hang on the memory there was."""
    snakemake = SimpleNamespace(log=[str(tmp_path / "j.log")], rule="r", wildcards=[], output=[])
    with pytest.raises(SystemExit), job(snakemake, analysis=analysis):
        raise MemoryError("Unable to allocate 30.0 GiB")
    told = capsys.readouterr().err.strip()
    assert told.startswith("signkin: no memory left (Unable to allocate 30.0 GiB). Raise the limit")
    assert "Traceback" in (tmp_path / "j.log").read_text()
