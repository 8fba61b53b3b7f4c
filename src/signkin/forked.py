"""Snakemake, whose jobs are forked from a process that has imported what they import.

A job in a Python of its own takes two to four seconds before it does anything: Snakemake, pandas,
matplotlib, scipy and numba are imported anew for each. Here they are imported once, by a process
that does nothing else (the fork server of `multiprocessing`); a job is a fork of it, in which no
other job has run. No shell stands between, so paths may hold what a shell takes for its own.

    python -m signkin.forked [arguments of snakemake]

Where there are no such forks (Windows; macOS, whose libraries do not survive them), on a cluster,
and in containers, jobs start as Snakemake starts them.
"""

from __future__ import annotations

import multiprocessing
import os
import runpy
import signal
import subprocess
import sys
import threading
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

from signkin.child import end_with_parent

FORKS = sys.platform == "linux"
_STARTING = threading.Lock()


def main() -> None:
    """Run Snakemake; does not return."""
    from snakemake.cli import main as snakemake

    if FORKS:
        _fork_scripts()
    snakemake()


def _fork_scripts() -> None:
    """Let Snakemake run Python scripts as forks."""
    from snakemake.script import PythonScript

    started_by_shell = PythonScript.execute_script

    def execute_script(self: Any, fname: str, edit: bool = False) -> None:
        apart = (self.container_img, self.conda_env, self.env_modules, self.bench_record)
        if any(one is not None for one in apart):
            started_by_shell(self, fname, edit)
            return
        status = run_forked(Path(fname))
        if status == -signal.SIGKILL:
            told = f"signkin: a job of the step {self.rulename} was killed (signal 9)"
            print(f"\n{told}: the kernel does that where memory runs out.\n", file=sys.stderr)
        if status:
            raise subprocess.CalledProcessError(status, [sys.executable, str(fname)])

    PythonScript.execute_script = execute_script


def run_forked(script: Path) -> int:
    """Run a script as a fork, in the current folder, and return its exit status.

    Below 0 where a signal ended it. Linux alone.
    """
    forks = multiprocessing.get_context("forkserver")
    with _STARTING:  # a start asks other processes, too, whether they are at an end
        forks.set_forkserver_preload(["signkin.preloaded"])
        process = forks.Process(target=_run, args=(str(script), str(Path.cwd())))
        process.start()
    wait([process.sentinel])
    with _STARTING:
        process.join()
        status = process.exitcode
        process.close()
    return 1 if status is None else status


def _run(script: str, folder: str) -> None:
    end_with_parent()  # that is the fork server, which ends with Snakemake
    os.chdir(folder)
    sys.argv = [script]
    runpy.run_path(script, run_name="__main__")


if __name__ == "__main__":
    main()
