"""The command line.

`signkin run` runs the workflow of the folder it is called in, `signkin utterance` makes an
utterance from a list of glosses, `signkin audit` checks a ledger of claims, `signkin corpus` looks
at corpora before a run, `signkin score` compares two segmentations, `signkin compare` two trees of
results, `signkin verify` tells what in results/ is not what the run wrote, `signkin simulate`
writes a corpus of any size.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from importlib.util import find_spec
from pathlib import Path
from pkgutil import iter_modules
from shlex import quote

from signkin.growth import commands as growth
from signkin.results import commands as results
from signkin.segments import commands as segments
from signkin.survey.commands import add_parser, run_corpus

PROGRESS = "snakemake_logger_plugin_signkin"  # what Snakemake finds, by its name
RUN_EXAMPLES = """examples:
  signkin run                          all corpora whose recordings are there
  signkin run -n                       what would be done
  signkin run --cores 4 -- naert2017   one study, on four cores
"""
FIRST = """examples:
  signkin corpus check mine         what is suspicious in your recordings
  signkin run                       everything; then open results/report/index.html
  signkin audit papers/naert2017    can a paper's printed numbers be right?
  signkin COMMAND --help            more of a command, with examples
"""
SPEAK_EXAMPLES = """examples:
  signkin utterance dgs-1984189 CAT3 BIRD1
  signkin utterance boston104 "JOHN BUY HOUSE" --method interpolation
  signkin utterance lsf-sim ONE-07,TWO-07 --config other.yaml --name mine
"""


def main(arguments: list[str] | None = None) -> int:
    """Run a command; returns the exit status."""
    words = sys.argv[1:] if arguments is None else arguments
    if words[:1] == ["audit"]:
        from signkin.audit import commands as audit
        from signkin.pages.audit_paper import audit_papers

        return audit.main(words[1:], audit_papers)
    plain = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(
        prog="signkin", description=__doc__, epilog=FIRST, formatter_class=plain
    )
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("run", help="run the workflow; further arguments go to snakemake",
                        epilog=RUN_EXAMPLES, formatter_class=plain)  # fmt: skip
    speak = commands.add_parser("utterance", help="an utterance from the signs of a corpus",
                                epilog=SPEAK_EXAMPLES, formatter_class=plain)  # fmt: skip
    speak.add_argument("--config", type=Path, default=Path("config.yaml"), metavar="FILE",
                       help="instead of this folder's config.yaml")  # fmt: skip
    speak.add_argument("corpus", help="a corpus of this folder's config.yaml")
    speak.add_argument("glosses", nargs="+", help="glosses in order; one text with spaces, or "
                       "commas where glosses hold spaces, is taken apart")  # fmt: skip
    speak.add_argument("--name", help="of the files; by default made from the glosses")
    for key in ("method", "duration", "retrieval"):
        speak.add_argument(f"--{key}", help=f"instead of synthesis.{key} in config.yaml")
    commands.add_parser("audit", help="check the claims of a paper; `audit list`, `check`, `init`")
    add_parser(commands)
    segments.add_parser(commands)
    results.add_parsers(commands)
    growth.add_parser(commands)
    told, for_snakemake = parser.parse_known_args(arguments)
    if told.command == "run":
        return run_workflow(for_snakemake)
    if for_snakemake:
        parser.error(f"unknown arguments: {' '.join(for_snakemake)}")
    others = {
        "score": segments.run_score, "compare": results.run_compare,
        "verify": results.run_verify, "simulate": growth.run_simulate,
    }  # fmt: skip
    if told.command in others:
        return others[told.command](told)
    return run_corpus(told) if told.command == "corpus" else say(told)


def say(told: argparse.Namespace) -> int:
    """Make one utterance; what it wants of the workflow is run first."""
    from signkin.checkout import workflow_home
    from signkin.errors import SignkinError
    from signkin.studies.naert2017.synthesis.speak import glosses_of, prerequisites, speak

    changes = {k: v for k in ("method", "duration", "retrieval") if (v := getattr(told, k))}
    try:
        home = workflow_home()
        targets = prerequisites(told.corpus, changes, home, told.config)
        # This corpus alone: another one that is broken is none of its business.
        only = ["--config", f'corpora=["{told.corpus}"]']
        if told.config.is_file() and told.config != Path("config.yaml"):
            only = ["--configfile", str(told.config), *only]
        status = run_workflow([*only, "--", *targets], brief=True)
        if status:
            return status
        glosses = glosses_of(told.glosses)
        for line in speak(told.corpus, glosses, told.name, changes, home, told.config):
            print(line)
    except SignkinError as error:
        print(f"signkin: {error}", file=sys.stderr)
        return 1
    return 0


def refuse_unquotable(interpreter: str) -> None:
    """Refuse a Python whose path a shell takes apart.

    Where jobs are not forked (forked.py), Snakemake calls it without quotes.
    """
    from signkin.errors import SignkinError

    if quote(interpreter) != interpreter:
        raise SignkinError(
            f"the path of Python holds a space or a sign that a shell takes for its own: "
            f"{interpreter}",
            expected="letters, digits and . _ - + = : , @ % /",
            todo="Move the checkout to such a path, or set up its .venv anew there.",
        )


def _told_by(brief: bool) -> list[str]:
    """Return Snakemake's options for the line of progress, where it finds the package of it."""
    if all(found.name != PROGRESS for found in iter_modules()):
        return []
    return ["--logger", "signkin", *(["--logger-signkin-brief"] if brief else [])]


def run_workflow(extra: list[str], folder: Path | None = None, brief: bool = False) -> int:
    """Run Snakemake in a folder (its config.yaml, its results), one run at a time.

    brief: whether nothing is said where there is nothing to do.
    Snakemake's own lock outlives a run that was killed and then stops the next one. The lock
    taken here is the kernel's: it goes with this process and Snakemake's, so a killed run can
    simply go on, and none starts beside a Snakemake that is still at work.
    """
    from signkin.binning.compiled import forget_stale_kernels
    from signkin.checkout import workflow_home
    from signkin.child import run_child
    from signkin.cost import failure
    from signkin.errors import SignkinError
    from signkin.forked import FORKS
    from signkin.lock import held
    from signkin.memory import check_memory, limits, limits_of_jobs
    from signkin.options import executors, profiles, refuse_options, values
    from signkin.pages.times import write_times
    from signkin.results.written import STATE, take_out_changed
    from signkin.slurm import slurm_arguments
    from signkin.yaml_file import read_yaml

    folder = folder or Path.cwd()
    try:
        home = workflow_home()
        if (folder / "config.yaml").is_file():
            read_yaml(folder / "config.yaml")  # Snakemake would end in a traceback
        if not FORKS or executors(extra, folder):
            refuse_unquotable(sys.executable)
        refuse_options(extra, folder)
        extra = [*slurm_arguments(extra, folder), *extra]
        elsewhere = bool(executors(extra, folder))
        found = limits_of_jobs(profiles(extra, folder)) if elsewhere else limits(extra)
        cores = values(extra, "--cores", "-c", "--jobs", "-j")[-1:]
        at_once = int(cores[0]) if cores and cores[0].isdigit() else os.cpu_count() or 1
        if told := check_memory(folder / "logs", found, at_once):
            print(f"signkin: {told}", file=sys.stderr)
        if find_spec("snakemake") is None:
            raise SignkinError(
                "Snakemake, which runs the workflow, is not installed",
                todo="Install the extra: pip install 'signkin[workflow]'.",
            )
    except SignkinError as error:
        print(f"signkin: {error}", file=sys.stderr)
        return 1
    started = time.time()
    state = folder / ".snakemake"
    state.mkdir(exist_ok=True)
    with held(state / "signkin.lock") as alone:
        if alone is None:
            print(f"signkin: another run is at work in {folder}. Wait for it.", file=sys.stderr)
            return 1
        for path in take_out_changed(folder / STATE, folder):
            print(f"signkin: {path} is not what its job wrote; it is deleted, and made anew where "
                  "it is wanted.", file=sys.stderr)  # fmt: skip
        forget_stale_kernels()  # no job may run machine code of other sources
        command = [sys.executable, "-m", "signkin.forked", "--snakefile", str(home / "Snakefile")]
        command += _told_by(brief)
        command += ["--profile", str(home / "profiles" / "default"), "--nolock", *extra]
        # One thread a job: sums in another order would change last digits.
        threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MPLBACKEND": "Agg"}
        status = run_child(command, folder, {**os.environ, **threads}, alone)
    page = folder / "results" / "report" / "index.html"
    if status == 0 and page.exists() and "--" not in extra:
        write_times(folder / "logs", page.parent)
        summary = page.with_name("summary.txt")
        if summary.is_file():
            print(summary.read_text(encoding="utf-8").rstrip())
        print(f"The report: {page}")
    if status and (failed := failure(folder / "logs", started)):
        print(failed, file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
