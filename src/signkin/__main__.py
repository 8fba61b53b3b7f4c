"""The command line: `signkin run` runs the workflow, `signkin audit` a ledger of claims."""

from __future__ import annotations

import argparse
import fcntl
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def main(arguments: list[str] | None = None) -> int:
    """Run a command; returns the exit status."""
    parser = argparse.ArgumentParser(prog="signkin", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("run", help="run the workflow; further arguments go to snakemake")
    ledger = commands.add_parser("audit", help="check the claims of a paper's folder")
    ledger.add_argument("papers", nargs="+", type=Path, help="folders with claims.yaml and tables")
    ledger.add_argument("--out", type=Path, help="write the verdicts to this CSV file")
    ledger.add_argument("--checks", type=Path, help="write every check's findings to this one")
    ledger.add_argument("--results", type=Path, help="test on the corpora of this folder, too")
    known, for_snakemake = parser.parse_known_args(arguments)
    if known.command == "audit":
        if for_snakemake:
            parser.error(f"unrecognized arguments: {' '.join(for_snakemake)}")
        return run_audit(known.papers, known.out, known.checks, known.results)
    return run_workflow(for_snakemake)


def run_audit(
    papers: list[Path], out: Path | None, checks: Path | None, results: Path | None
) -> int:
    """Print the verdicts of claims; returns 1 where the input cannot be used, else 0."""
    from signkin.errors import SignkinError
    from signkin.pipeline.audit import run_ledger, told
    from signkin.tables import write_table

    try:
        ledger = run_ledger(papers, results)
        for frame, name, path in (
            (ledger.claims, "claims", out),
            (ledger.checks, "checks", checks),
        ):
            if path is not None:
                write_table(frame, path, name)
    except SignkinError as error:
        print(f"signkin: {error}", file=sys.stderr)
        return 1
    print(told(ledger))
    return 0


def run_workflow(extra: list[str], folder: Path | None = None) -> int:
    """Run Snakemake in a folder (its config.yaml, its results), one run at a time.

    Snakemake's own lock outlives a run that was killed and then stops the next one. The lock
    taken here is the kernel's: it goes with the process, so a killed run can simply go on.
    """
    folder = folder or Path.cwd()
    state = folder / ".snakemake"
    state.mkdir(exist_ok=True)
    with (state / "signkin.lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print(f"signkin: another run is at work in {folder}. Wait for it.", file=sys.stderr)
            return 1
        command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
        command += ["--profile", str(ROOT / "profiles" / "default"), "--nolock", *extra]
        # One thread a job: sums in another order would change last digits.
        threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MPLBACKEND": "Agg"}
        done = subprocess.run(command, cwd=folder, env={**os.environ, **threads}, check=False)
    page = folder / "results" / "report" / "index.html"
    if done.returncode == 0 and page.exists():
        print(f"The report: {page}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
