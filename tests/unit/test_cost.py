"""Time and memory of jobs: noted beside their logs, told on a page of their own."""

import json
import os

from signkin.cost import failure, noted, read_costs
from signkin.pages.times import write_times


def test_what_a_job_costs_is_noted_even_where_it_fails(tmp_path):
    for rule, about in (("ingest", "a 0001"), ("ingest", "b 0001"), ("report", "")):
        with noted(tmp_path / "logs" / f"{rule}-{about}.log", rule, about):
            sum(range(10_000))
    try:
        with noted(tmp_path / "logs/x.log", "x"):
            raise ValueError
    except ValueError:
        pass
    costs = read_costs(tmp_path / "logs")
    assert [c["rule"] for c in costs] == ["ingest", "ingest", "report", "x"]
    assert all(c["seconds"] >= 0 and c["peak_mb"] > 1 for c in costs)
    page = write_times(tmp_path / "logs", tmp_path / "report").read_text(encoding="utf-8")
    assert "4 jobs" in page and "a 0001" in page
    assert json.loads((tmp_path / "logs/x.cost.json").read_text())["about"] == ""


def test_without_a_run_there_is_no_page(tmp_path):
    assert write_times(tmp_path / "logs", tmp_path / "report") is None


def test_the_step_that_failed_is_told_with_why_and_its_log(tmp_path):
    logs = tmp_path / "logs"
    for i, (name, text) in enumerate(
        (("fine", "all well\n"), ("second", "signkin: later.\n"), ("old", "signkin: before.\n"),
         ("first", "some words\nsignkin: f.csv, line 3: found this.\n"))
    ):  # fmt: skip
        with noted(logs / f"{name}.log", name, "mini 0001"):
            (logs).mkdir(exist_ok=True)
            (logs / f"{name}.log").write_text(text, encoding="utf-8")
        os.utime(logs / f"{name}.log", (1000 - i, 1000 - i))
    os.utime(logs / "old.log", (10, 10))
    told = failure(logs, since=100.0)
    assert told.splitlines() == [
        "signkin: the step first (mini 0001) failed: f.csv, line 3: found this.",
        f"Its log: {logs / 'first.log'}",
    ]
    assert failure(logs, since=5000.0) == "" == failure(tmp_path / "none", 0.0)


def test_of_a_fault_of_ours_the_last_line_is_told(tmp_path):
    """A traceback ends in an empty line: a full disk was told without a word."""
    log = tmp_path / "step.log"
    with noted(log, "ingest"):
        log.write_text("Traceback (most recent call last):\nOSError: No space left\n\n")
    assert failure(tmp_path, 0.0).startswith("signkin: the step ingest failed: OSError: No space")
