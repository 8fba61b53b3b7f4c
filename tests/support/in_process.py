"""All jobs of a run in one process: Snakemake says which, their scripts run one after the other.

A job costs about 1.5 s of start-up in a run of its own. What is tested with this is what the
scripts make of input, not how Snakemake runs them. The process is not that of the tests: Snakemake
runs beside no other event loop, and a browser's test leaves one.

    python -m support.in_process FOLDER OUT     (in the folder `tests`)
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from support.runs import ROOT


@dataclass(frozen=True)
class Done:
    """A job that ran. failed: what ended it, empty where it did not."""

    rule: str
    wildcards: dict[str, str]
    failed: str = ""


def jobs_of(folder: Path) -> list[Any]:
    """Return the jobs of a run in an order in which they can be run."""
    from snakemake.api import SnakemakeApi
    from snakemake.settings.types import (
        ConfigSettings,
        DAGSettings,
        ExecutionSettings,
        OutputSettings,
        Quietness,
        ResourceSettings,
    )

    with SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api:
        workflow = api.workflow(
            resource_settings=ResourceSettings(cores=1),
            config_settings=ConfigSettings(configfiles=[folder / "config.yaml"]),
            snakefile=ROOT / "Snakefile",
            workdir=folder,
        )
        workflow.dag(dag_settings=DAGSettings())
        inner = workflow._workflow  # the API has no way to ask for the jobs
        inner.dag_settings = DAGSettings()
        inner.execution_settings = ExecutionSettings(lock=False)
        inner._prepare_dag(forceall=False, ignore_incomplete=True, lock_warn_only=True)
        inner._build_dag()
        needed = set(inner.dag.needrun_jobs())
        return [
            job
            for level in inner.dag.toposorted()
            for job in sorted(level, key=lambda j: (j.rule.name, str(j.wildcards)))
            if job in needed and job.rule.script
        ]


def run_in_process(folder: Path, data: Path) -> list[Done]:
    """Run all jobs of a run; the first that ends with an error is the last."""
    out = folder / "jobs.json"
    path = os.pathsep.join([str(ROOT / "tests"), str(ROOT / "src")])
    done = subprocess.run(
        [sys.executable, "-m", "support.in_process", str(folder), str(out)], cwd=folder,
        env={**os.environ, "SIGNKIN_DATA": str(data), "PYTHONPATH": path}, text=True, check=False,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-3000:]
    return [Done(**job) for job in json.loads(out.read_text(encoding="utf-8"))]


def _run(folder: Path) -> list[Done]:
    out: list[Done] = []
    for job in jobs_of(folder):
        if job.rule.name == "compile_kernels":
            continue  # the tests' own process compiles what it calls
        for file in job.output:
            Path(file).parent.mkdir(parents=True, exist_ok=True)
        script = ROOT / "workflow" / "scripts" / str(job.rule.script).split("scripts/")[-1]
        told = SimpleNamespace(
            input=job.input, output=job.output, params=job.params, log=job.log,
            wildcards=job.wildcards, rule=job.rule.name, threads=1,
        )  # fmt: skip
        failed = ""
        try:
            exec(compile(script.read_text(), str(script), "exec"), {"snakemake": told})
            missing = [str(file) for file in job.output if not Path(file).exists()]
            failed = f"not written: {missing}" if missing else ""
        except SystemExit:
            failed = Path(job.log[0]).read_text()[-3000:]
        out.append(Done(job.rule.name, dict(job.wildcards_dict), failed))
        if failed:
            break
    return out


if __name__ == "__main__":
    finished = _run(Path(sys.argv[1]))
    Path(sys.argv[2]).write_text(json.dumps([vars(job) for job in finished]), encoding="utf-8")
