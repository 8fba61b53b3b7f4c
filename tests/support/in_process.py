"""All jobs of a run in this process: Snakemake says which, their scripts run one after the other.

A job costs about 1.5 s of start-up in a run of its own. What is tested with this is what the
scripts make of input, not how Snakemake runs them.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
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


@contextlib.contextmanager
def _inside(folder: Path, data: Path) -> Iterator[None]:
    before, old = Path.cwd(), os.environ.get("SIGNKIN_DATA")
    os.environ["SIGNKIN_DATA"] = str(data)
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)
        os.environ.pop("SIGNKIN_DATA")
        if old is not None:
            os.environ["SIGNKIN_DATA"] = old


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
    out: list[Done] = []
    with _inside(folder, data):
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
