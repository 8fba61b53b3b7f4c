"""What a run says on the way: a line that a person reads, and what went wrong."""

import io
import logging
import pkgutil
from types import SimpleNamespace

import pytest
from snakemake_interface_logger_plugins.common import LogEvent
from snakemake_interface_logger_plugins.registry import LoggerPluginRegistry

from signkin.__main__ import PROGRESS, _told_by
from signkin.progress import Progress, clock_words, watched
from snakemake_logger_plugin_signkin import LogHandler, LogHandlerSettings


class Clock:
    def __init__(self):
        self.time = 100.0

    def __call__(self):
        return self.time


@pytest.mark.parametrize(
    "seconds, words", [(7.9, "0:07"), (750, "12:30"), (3723, "1:02:03"), (0, "0:00")]
)
def test_times_are_as_a_clock_has_them(seconds, words):
    assert clock_words(seconds) == words


def test_where_nobody_watches_there_is_a_line_at_most_each_minute():
    out, clock = io.StringIO(), Clock()
    progress = Progress(out, live=False, now=clock)
    progress.planned(100)
    for step in range(100):
        progress.start(step, f"ingest (mini {step:04d})")
        clock.time += 3
        progress.end(step)
        progress.count(step + 1, 100)
    progress.close()
    progress.close()
    lines = out.getvalue().splitlines()
    assert lines[0] == "100 steps to do."
    assert lines[-1] == "100 of 100 steps done in 5:00."
    assert len(lines) == 2 + 4  # of five minutes, the last is the end
    assert lines[1].startswith("20 of 100 steps done, 80 left, 1:00")


def test_the_line_on_a_terminal_is_drawn_in_place_and_goes_at_the_end(monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    out, clock = io.StringIO(), Clock()
    progress = Progress(out, live=True, now=clock)
    progress.total = 12  # without the thread that draws it each second
    progress.start(1, "naert_tables (lsf-sim)")
    clock.time += 75
    progress.tell()
    drawn = out.getvalue().split("\r\x1b[K")[-1]
    assert drawn == "0 of 12 steps done, 12 left, 1:15; now naert_tables (lsf-sim) 1:15"[:58] + "…"
    progress.say("A warning.")
    progress.end(1)
    progress.count(12, 12)
    progress.close()
    assert "\n" not in out.getvalue().split("A warning.")[0]
    assert out.getvalue().endswith("\r\x1b[K12 of 12 steps done in 1:15.\n")


def test_only_a_terminal_outside_ci_is_watched():
    terminal = SimpleNamespace(isatty=lambda: True)
    assert watched(terminal, {})
    assert not watched(terminal, {"CI": "true"}) and not watched(terminal, {"TERM": "dumb"})
    assert not watched(io.StringIO(), {})


# --- Snakemake's messages ---------------------------------------------------------------------


def handler(out, brief=False, **settings):
    common = {"stdout": False, "dryrun": False, "verbose": False, "quiet": None, **settings}
    made = LogHandler(SimpleNamespace(**common), LogHandlerSettings(brief))
    made.progress = Progress(out, live=False, now=Clock())
    return made


def told(plugin, message, level=logging.INFO, **more):
    record = logging.makeLogRecord({"msg": message, "levelno": level, **more})
    plugin.handle(record)


def a_run(plugin, log):
    told(plugin, "Building DAG of jobs...")
    told(plugin, "Job stats", event=LogEvent.RUN_INFO, stats={"ingest": 2, "total": 2})
    told(plugin, "Select jobs to execute...")
    for job in (1, 2):
        told(plugin, "Rule", event=LogEvent.JOB_INFO, jobid=job, rule_name="ingest",
             wildcards={"corpus": "mini", "shard": f"000{job}"})  # fmt: skip
    told(plugin, "Finished", event=LogEvent.JOB_FINISHED, job_id=1)
    told(plugin, "", event=LogEvent.PROGRESS, done=1, total=2)
    told(
        plugin,
        "Error in rule",
        logging.ERROR,
        event=LogEvent.JOB_ERROR,
        jobid=2,
        log=[log],
        rule_name="ingest",
    )  # without wildcards, as Snakemake writes it


def test_of_snakemakes_messages_a_person_sees_steps_and_what_went_wrong(tmp_path):
    out, log = io.StringIO(), tmp_path / "ingest.log"
    plugin = handler(out)
    log.write_text("")  # killed, before it could say why
    a_run(plugin, log)
    assert plugin.progress.running == {} and plugin.progress.done == 1
    told(plugin, "Command 'x' returned non-zero exit status 1.", logging.ERROR)
    told(plugin, "Command 'x' died with <Signals.SIGKILL: 9>.", logging.ERROR)
    told(plugin, "Exiting because a job execution failed. Look below", logging.ERROR)
    plugin.close()
    assert out.getvalue().splitlines() == [
        "2 steps to do.",
        "The step ingest (mini 0002) failed.",
        "Command 'x' died with <Signals.SIGKILL: 9>.",
        "1 of 2 steps done in 0:00.",
    ]
    log.write_text("signkin: f.csv, line 2: why.\n")
    plugin = handler(out := io.StringIO())
    a_run(plugin, log)
    assert "failed" not in out.getvalue()  # the job has said it, and the end of the run will


@pytest.mark.parametrize(
    "settings, lines", [({}, 1), ({"brief": True}, 0), ({"quiet": ["all"]}, 0)]
)
def test_nothing_to_do_is_said_unless_asked_not_to(settings, lines):
    plugin = handler(out := io.StringIO(), **settings)
    told(plugin, "Nothing to be done (all requested files are present).")
    plugin.close()
    assert len(out.getvalue().splitlines()) == lines


def test_a_dry_run_and_quiet_runs_are_as_snakemake_has_them():
    plugin = handler(io.StringIO(), dryrun=True)
    plugin.stream = io.StringIO()
    told(plugin, "what would be done")
    assert plugin.stream.getvalue() == "what would be done\n" and not plugin.has_filter
    plugin = handler(out := io.StringIO(), quiet=["progress"])
    a_run(plugin, "no.log")
    assert out.getvalue() == "The step ingest (mini 0002) failed.\n"


def test_snakemake_finds_the_plugin_and_a_run_asks_for_it(monkeypatch):
    assert "signkin" in LoggerPluginRegistry().plugins
    assert _told_by(True) == ["--logger", "signkin", "--logger-signkin-brief"]
    others = [found for found in pkgutil.iter_modules() if found.name != PROGRESS]
    monkeypatch.setattr("signkin.__main__.iter_modules", lambda: others)
    assert _told_by(True) == []  # an installation of before: as Snakemake tells it
