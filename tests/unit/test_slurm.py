"""What a SLURM cluster lacks is one sentence; `squeue` is asked where no accounts are kept."""

from __future__ import annotations

import pytest

from signkin.errors import SignkinError
from signkin.slurm import slurm_arguments

ACCOUNTS = "AccountingStorageType   = accounting_storage/{}\nMinJobAge               = {}\n"


@pytest.fixture
def cluster(tmp_path, monkeypatch):
    """Return a maker of a folder of commands that answer as a cluster's."""

    def make(accounts="none", age="300 sec", partitions="long\nshort", status=0):
        for name, text in (
            ("sbatch", ""), ("sinfo", partitions), ("scontrol", ACCOUNTS.format(accounts, age)),
        ):  # fmt: skip
            path = tmp_path / "bin" / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(f"#!/bin/sh\ncat <<'X'\n{text}\nX\nexit {status}\n")
            path.chmod(0o755)
        monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:/usr/bin:/bin")
        return tmp_path

    return make


def profile(folder, text="executor: slurm\n"):
    (folder / "mine").mkdir(exist_ok=True)
    (folder / "mine" / "profile.yaml").write_text(text)
    return ["--workflow-profile", "mine", "--cores", "2"]


def test_squeue_is_asked_where_no_accounts_are_kept(cluster):
    folder = cluster()
    assert slurm_arguments(profile(folder), folder) == ["--slurm-status-command", "squeue"]
    assert slurm_arguments(["--executor=slurm"], folder) == ["--slurm-status-command", "squeue"]
    assert slurm_arguments(["--cores", "4"], folder) == []
    own = [*profile(folder), "--slurm-status-command", "sacct"]
    assert slurm_arguments(own, folder) == []


def test_with_accounts_the_executor_chooses(cluster):
    folder = cluster(accounts="slurmdbd", age="2 sec")
    assert slurm_arguments(profile(folder), folder) == []


def test_jobs_that_are_forgotten_at_once_are_refused(cluster):
    folder = cluster(age="5 sec")
    with pytest.raises(SignkinError, match=r"forgets a finished job after 5 s \(MinJobAge\)"):
        slurm_arguments(profile(folder), folder)


def test_an_unknown_partition_is_refused(cluster):
    folder = cluster()
    text = "executor: slurm\nset-resources:\n  ingest:\n    slurm_partition: fast\n"
    with pytest.raises(SignkinError, match=r"slurm_partition 'fast' .* expected long, short"):
        slurm_arguments(profile(folder, text), folder)


@pytest.mark.parametrize(
    "words",
    [
        ["--default-resources", "mem_mb=1000", "slurm_partition=fast"],
        ["--default-resources=slurm_partition='fast'"],
        ["--set-resources", "ingest:slurm_partition=fast,short"],
    ],
)
def test_an_unknown_partition_of_the_command_line_is_refused(cluster, words):
    folder = cluster()
    told = r"'fast' of --default-resources or --set-resources is not a partition of this cluster"
    with pytest.raises(SignkinError, match=told):
        slurm_arguments([*profile(folder), *words], folder)


def test_default_resources_of_the_command_line_go_before_the_profiles(cluster):
    folder = cluster()
    text = "executor: slurm\ndefault-resources:\n- mem_mb=1000\n- slurm_partition=fast\n"
    with pytest.raises(SignkinError, match="'fast' of the profile is not a partition"):
        slurm_arguments(profile(folder, text), folder)
    words = [*profile(folder, text), "--default-resources", "slurm_partition=long"]
    assert slurm_arguments(words, folder) == ["--slurm-status-command", "squeue"]


def test_a_controller_that_is_down_is_told(cluster):
    folder = cluster(status=1)
    with pytest.raises(SignkinError, match="does not answer `scontrol show config`"):
        slurm_arguments(profile(folder), folder)


def test_no_slurm_at_all_is_told(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(SignkinError, match="no command sbatch"):
        slurm_arguments(profile(tmp_path), tmp_path)
