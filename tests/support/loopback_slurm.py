"""A SLURM cluster of two nodes on this machine's loopback, from Debian's packages."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

DAEMONS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol")
# A job's own srun looks here alone: the executor hides SLURM_CONF from it.
CONFIG = Path("/etc/slurm/slurm.conf")
NODES = ("n1", "n2")

TEMPLATE = """ClusterName=loopback
SlurmctldHost=localhost
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmctldPort={port}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmdSpoolDir={folder}/spool.%n
StateSaveLocation={folder}/state
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
MinJobAge={min_job_age}
SlurmdTimeout=10
MpiDefault=none
SwitchType=switch/none
{nodes}
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""


def why_not() -> str:
    """Return why no cluster can be started here; '' where one can."""
    if missing := [name for name in DAEMONS if shutil.which(name) is None]:
        return f"SLURM is not installed ({missing[0]}): make test-slurm installs Debian's"
    if os.geteuid():
        return "the daemons of a cluster of one's own need root"
    if CONFIG.exists() or CONFIG.is_symlink():
        return f"this machine has a SLURM of its own ({CONFIG})"
    return ""


@dataclass
class Cluster:
    """A running cluster."""

    folder: Path
    daemons: dict[str, subprocess.Popen] = field(default_factory=dict)

    def start(self, name: str, *command: str) -> None:
        with (self.folder / f"{name}.out").open("ab") as out:
            self.daemons[name] = subprocess.Popen(command, stdout=out, stderr=out)

    def start_node(self, node: str) -> None:
        self.start(node, "slurmd", "-D", "-N", node)

    def kill(self, name: str) -> None:
        self.daemons[name].kill()
        self.daemons[name].wait()

    def states(self) -> dict[str, str]:
        """Return the state of each node, `idle`, `down*`."""
        lines = asked("sinfo", "--noheader", "--Node", "--format=%N %t").splitlines()
        return {line.split()[0]: line.split()[1] for line in lines if line.strip()}

    def running(self) -> list[str]:
        """Return the numbers of the jobs that run."""
        return asked("squeue", "--noheader", "--states=RUNNING", "--format=%i").split()


def asked(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


@contextmanager
def loopback(folder: Path, min_job_age: int = 300) -> Iterator[Cluster]:
    """Start a cluster, wait until its nodes are idle, take it down at the end."""
    folder.mkdir(parents=True)
    ports = _free_ports(1 + len(NODES))
    nodes = "\n".join(
        f"NodeName={name} NodeHostname=localhost NodeAddr=127.0.0.1 Port={port} CPUs=2 "
        "RealMemory=8000 State=UNKNOWN"
        for name, port in zip(NODES, ports[1:], strict=True)
    )
    for name in ("state", *(f"spool.{node}" for node in NODES)):
        (folder / name).mkdir()
    text = TEMPLATE.format(folder=folder, port=ports[0], nodes=nodes, min_job_age=min_job_age)
    (folder / "slurm.conf").write_text(text)
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o400)
    CONFIG.parent.mkdir(exist_ok=True)
    CONFIG.symlink_to(folder / "slurm.conf")
    cluster = Cluster(folder)
    try:
        munge = [f"--{k}={folder}/munge.{k.split('-')[0]}" for k in ("socket", "pid-file",
                 "log-file", "seed-file")]  # fmt: skip
        cluster.start("munged", "munged", "--foreground", "--force", f"--key-file={key}", *munge)
        _until(lambda: (folder / "munge.socket").exists(), cluster)
        cluster.start("slurmctld", "slurmctld", "-D", "-c")
        for node in NODES:
            cluster.start_node(node)
        _until(lambda: cluster.states() == dict.fromkeys(NODES, "idle"), cluster)
        yield cluster
    finally:
        asked("scancel", "--state=RUNNING", "--user=root")
        for daemon in reversed(list(cluster.daemons.values())):
            if daemon.poll() is None:
                daemon.send_signal(signal.SIGTERM)
        for daemon in cluster.daemons.values():
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
        CONFIG.unlink()


def _free_ports(count: int) -> list[int]:
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def _until(ready, cluster: Cluster, seconds: float = 180) -> None:
    end = time.monotonic() + seconds
    while not ready():
        if time.monotonic() > end:
            said = [p.read_text(errors="replace")[-400:] for p in cluster.folder.glob("*.out")]
            raise RuntimeError(f"the cluster did not come up: {said}")
        time.sleep(0.2)
