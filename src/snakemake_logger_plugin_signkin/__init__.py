"""What a run says on the way: Snakemake's logger plugin `signkin` (`signkin run` asks for it).

Snakemake finds plugins as packages of this name. Its own words ("Select jobs to execute...") are
left out; errors and warnings are told. All of them stay in `.snakemake/log/`.
"""

import logging
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from logging import LogRecord
from pathlib import Path
from typing import Any

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent
from snakemake_interface_logger_plugins.settings import LogHandlerSettingsBase

from signkin.progress import Progress, watched

# What follows from a failed step, which its own job has told already.
CONSEQUENCES = (
    "Exiting because a job execution failed", "Shutting down",
    "At least one job did not complete successfully", "returned non-zero exit status 1",
)  # fmt: skip
NOTHING = "Nothing to be done"


# Snakemake reads the type of each field, so that it must be no text: no `annotations` above.
@dataclass
class LogHandlerSettings(LogHandlerSettingsBase):
    """What the command line may choose."""

    brief: bool = field(
        default=False,
        metadata={"help": "Say nothing where there is nothing to do.", "required": False},
    )


class LogHandler(LogHandlerBase):
    """A line that tells how far the run is, and what goes wrong."""

    settings: LogHandlerSettings | None
    progress: Progress

    def __post_init__(self) -> None:
        """Write where Snakemake would: standard error, a dry run to standard output."""
        self.stream = sys.stdout if self.common_settings.stdout else sys.stderr
        self.progress = Progress(self.stream, live=watched(self.stream))
        self.quiet = {str(kind).lower() for kind in self.common_settings.quiet or ()}

    def emit(self, record: LogRecord) -> None:
        """Take one of Snakemake's messages."""
        try:
            if self.common_settings.dryrun or self.common_settings.verbose:
                self._as_snakemake(record)
            else:
                self._tell(getattr(record, "event", None), record)
        except Exception:
            self.handleError(record)

    def _tell(self, event: LogEvent | None, record: LogRecord) -> None:
        job: Any = getattr(record, "jobid", getattr(record, "job_id", None))
        if str(record.msg).startswith("Building DAG") and not self._silent:
            self.progress.plan()
        elif event == LogEvent.RUN_INFO and not self.progress.total:
            if not self._silent:
                self.progress.planned(int(record.stats["total"]))  # type: ignore[attr-defined]
        elif event == LogEvent.JOB_INFO:
            self.progress.start(job, _name(record))
        elif event == LogEvent.JOB_FINISHED:
            self.progress.end(job)
        elif event == LogEvent.PROGRESS and not self._silent:
            self.progress.count(record.done, record.total)  # type: ignore[attr-defined]
        elif event == LogEvent.JOB_ERROR:
            # The record of an error has no wildcards: the step is known from its start.
            what = self.progress.end(job) or getattr(record, "rule_name", "unknown")
            if not _tells_why(record):
                self.progress.say(f"The step {what} failed.")
        elif record.levelno >= logging.WARNING:
            text = str(record.msg)
            if not any(words in text for words in CONSEQUENCES):
                self.progress.say(text)
        elif str(record.msg).startswith(NOTHING) and not (self._silent or self._brief):
            self.progress.say(str(record.msg))

    @property
    def _silent(self) -> bool:
        return any(kind.endswith(("all", "progress")) for kind in self.quiet)

    @property
    def _brief(self) -> bool:
        return self.settings is not None and self.settings.brief

    def _as_snakemake(self, record: LogRecord) -> None:
        text = self.format(record)
        if text and text != "None":
            self.stream.write(text + "\n")
            self.stream.flush()

    def close(self) -> None:
        """End the line."""
        self.progress.close()
        super().close()

    @property
    def writes_to_stream(self) -> bool:
        """Instead of Snakemake's own messages."""
        return True

    @property
    def writes_to_file(self) -> bool:
        """Snakemake's own log file is written as ever."""
        return False

    @property
    def has_filter(self) -> bool:
        """It chooses itself, but for a dry run."""
        return not self.common_settings.dryrun

    @property
    def has_formatter(self) -> bool:
        """Snakemake's, for a dry run."""
        return False

    @property
    def needs_rulegraph(self) -> bool:
        """No."""
        return False


def _tells_why(record: LogRecord) -> bool:
    """Return whether a failed step's own log has its reason: the end of the run tells it."""
    logs = [Path(name) for name in getattr(record, "log", None) or ()]
    texts = [log.read_text(encoding="utf-8", errors="replace") for log in logs if log.is_file()]
    return any("signkin: " in text or "Traceback" in text for text in texts)


def _name(record: LogRecord) -> str:
    """Return a step as the end of a failed run calls it: `naert_tables (lsf-sim)`."""
    known: Any = record
    wildcards = known.wildcards
    values = wildcards.values() if isinstance(wildcards, Mapping) else list(wildcards or ())
    about = " ".join(map(str, values))
    return f"{known.rule_name} ({about})" if about else str(known.rule_name)
