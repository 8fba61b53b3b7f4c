"""`signkin simulate`: a corpus of any size, to see how a run grows."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

EXAMPLES = """examples:
  signkin simulate growth --recordings 1000
  signkin simulate growth --recordings 1000 --kind signs
  cd growth && signkin run
"""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    parser = commands.add_parser(
        "simulate", help="write a simulated corpus of any size", epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("folder", type=Path, help="where to; a run can be started there")
    parser.add_argument("--recordings", type=int, required=True, metavar="N")
    parser.add_argument(
        "--kind", choices=("tagged", "signs"), default="tagged",
        help="signing with tags (as lsf-sim), or single signs (as isl-sim)",
    )  # fmt: skip
    parser.add_argument("--seed", type=int, default=1)


def run_simulate(told: argparse.Namespace) -> int:
    """Write the corpus; returns the exit status."""
    from signkin.checkout import workflow_home
    from signkin.errors import SignkinError
    from signkin.growth.corpus import write_corpus

    def tell(done: int) -> None:
        if sys.stderr.isatty():
            print(f"\r{done} of {told.recordings}", end="", file=sys.stderr)

    try:
        corpus = write_corpus(
            told.folder, told.kind, told.recordings, told.seed, workflow_home(), tell
        )
    except SignkinError as error:
        print(f"signkin: {error}", file=sys.stderr)
        return 1
    print(f"{told.recordings} recordings: {corpus}. To analyse them: cd {told.folder}; signkin run")
    return 0
