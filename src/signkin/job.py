"""The frame around a workflow script: its log, its warnings, its errors.

A user's error ends the job with one sentence on the terminal and in the log; anything else leaves
its traceback in both. An analysis that cannot run does not end the run: its files are there without
content, and the report says why (`signkin.unavailable`).
"""

from __future__ import annotations

import sys
import traceback
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from signkin.cost import noted
from signkin.errors import SignkinError
from signkin.results.written import forget, record
from signkin.unavailable import lacking, reason_of, rows_of, write_placeholder, write_rows
from signkin.yaml_file import read_yaml


@dataclass
class Work:
    """A job of an analysis of one corpus: what of it is not available, and why.

    snakemake: the script's own. optional: whether a failure leaves empty files and goes on.
    """

    snakemake: Any
    optional: bool = False
    terminal: Any = None
    rows: list[dict[str, str]] = field(default_factory=list)

    @contextmanager
    def part(self, name: str, *files: str, kind: str = "") -> Iterator[None]:
        """Make a part that others do not want: where it fails, its files are empty.

        kind: of the tables among them, where their place does not tell it.
        """
        try:
            yield
        except Exception as error:
            if not self.optional or isinstance(error, MemoryError):
                raise
            self.lacks(name, error, *files, kind=kind)

    def lacks(
        self, part: str, error: Exception, *files: str | Path, kind: str = "",
        figures: Iterable[str] = (),
    ) -> str:  # fmt: skip
        """Note that a part is not available, write its files without content, and return why.

        The traceback of a fault of ours is in the log. What fails for want of input that is not
        available has that input's reason. figures: stems that a file of captions tells of.
        """
        reason = lacking(self.snakemake.input, rows_of(self._folder))
        if not isinstance(error, SignkinError):
            traceback.print_exception(error)
        reason = reason or reason_of(error, self.snakemake.log[0])
        about = f"{self.snakemake.wildcards.corpus}: {self._analysis}{f', {part}' if part else ''}"
        for stream in (sys.stderr, self.terminal):
            print(f"\nsignkin: {about}: not available: {reason}\n", file=stream)
        self.rows.append(
            {
                "corpus": self.snakemake.wildcards.corpus,
                "analysis": self._analysis,
                "part": part,
                "reason": reason,
                "files": " ".join(Path(file).as_posix() for file in files),
            }
        )
        for file in map(Path, files):
            if not file.exists():
                write_placeholder(file, reason, self._unit(), kind, figures)
        return reason

    def fail(self, error: Exception) -> None:
        """Write every file of the job that is not there yet, without content."""
        missing = [str(file) for file in self.snakemake.output if not Path(file).exists()]
        figures = [Path(file).stem for file in missing if file.endswith(".svg")]
        self.lacks("", error, *missing, figures=figures)

    def end(self) -> None:
        """Write the rows of what is not available; without any, there is no file."""
        shard = self.snakemake.wildcards.get("shard")
        path = self._folder / f"{self.snakemake.rule}{f'.{shard}' if shard else ''}.csv"
        write_rows(self.rows, path)
        if self.rows:
            record([path])
        else:
            forget(path)

    @property
    def _analysis(self) -> str:
        return str(self.snakemake.rule).replace("_", " ")

    @property
    def _folder(self) -> Path:
        results = Path(self.snakemake.output[0]).parts[0]
        return Path(results) / self.snakemake.wildcards.corpus / "not_available"

    def _unit(self) -> str:
        """Return the corpus's unit of length, m or px."""
        if unit := self.snakemake.params.get("unit"):
            return str(unit)
        motion = read_yaml(Path(self.snakemake.params.corpus) / "corpus.yaml")["motion"]
        return "px" if motion.get("unit") == "px" else "m"


@contextmanager
def job(snakemake: Any, *, analysis: bool = False) -> Iterator[Work]:
    """Send what the script prints to the rule's log, and its errors to the terminal as well.

    analysis: of one corpus; where it cannot run, the run goes on without it.
    """
    terminal = sys.stderr
    log_path = Path(snakemake.log[0])
    log_path.parent.mkdir(parents=True, exist_ok=True)
    with (
        log_path.open("w", encoding="utf-8", buffering=1) as log,
        redirect_stdout(log),
        redirect_stderr(log),
        noted(log_path, str(snakemake.rule), " ".join(map(str, snakemake.wildcards))),
    ):
        warnings.simplefilter("default")
        work = Work(snakemake, analysis, terminal)
        try:
            yield work
        except MemoryError as error:
            # Of any job: what is made must not hang on how much memory there was.
            text = f"signkin: no memory left ({str(error).strip() or 'MemoryError'}). Raise the "
            text += "limit, or set recordings_per_job lower."
            traceback.print_exception(error, file=log)
            print(text, file=log)
            print(f"\n{text}\n", file=terminal)
            sys.exit(1)
        except SignkinError as error:
            if not work.optional:
                print(f"signkin: {error}", file=log)
                print(f"\nsignkin: {error}\n", file=terminal)
                sys.exit(1)
            work.fail(error)
        except Exception as error:
            if not work.optional:
                text = traceback.format_exc()
                print(text, file=log)
                print(f"\n{text}", file=terminal)
                sys.exit(1)
            work.fail(error)
        if work.optional:
            work.end()
        record(snakemake.output)
