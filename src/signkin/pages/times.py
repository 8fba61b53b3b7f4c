"""Time and memory of each step: a page that `signkin run` writes at its end.

It differs from run to run, so no rule makes it.
"""

from __future__ import annotations

from pathlib import Path

import pandas as pd

import signkin
from signkin.cost import read_costs
from signkin.report.page import Page, Section, TableView, render

TIMES = "times.html"


def write_times(logs: Path, home: Path) -> Path | None:
    """Write the page of costs beside the logs; None where nothing was noted.

    home: the report's folder, for links. The results hold only what jobs wrote.
    """
    costs = pd.DataFrame(read_costs(logs)) if logs.is_dir() else pd.DataFrame()
    if costs.empty:
        return None
    site = [("Front page", home / "index.html"), ("Provenance", home / "provenance.html"),
            ("Time and memory", logs / TIMES)]  # fmt: skip
    page = Page(
        title="Time and memory of each step",
        lead=(
            "Of the last run of each job, without the start of its Python (about 2 s). These "
            "numbers depend on the machine and what else it does; nothing else in the results "
            "does.",
        ),
        sections=[_steps(costs), _jobs(costs)],
        version=signkin.__version__,
        site=site,
        here="Time and memory",
    )
    (logs / TIMES).write_text(render(page, logs), encoding="utf-8")
    return logs / TIMES


def _steps(costs: pd.DataFrame) -> Section:
    steps = costs.groupby("rule", sort=False).agg(
        jobs=("rule", "size"), seconds=("seconds", "sum"), cpu_s=("cpu_s", "sum"),
        longest_s=("seconds", "max"), peak_mb=("peak_mb", "max"),
    )  # fmt: skip
    steps = steps.reset_index().sort_values("seconds", ascending=False, kind="stable")
    view = TableView(
        label="",
        title="By step",
        caption=f"{len(costs)} jobs, {costs['seconds'].sum() / 60:.1f} minutes of work in all; "
        f"the most memory a job held: {costs['peak_mb'].max():.0f} MB.",
        frame=steps,
        columns={
            "rule": ("step", ""), "jobs": ("jobs", "d"), "seconds": ("seconds", ".1f"),
            "cpu_s": ("CPU seconds", ".1f"), "longest_s": ("longest job (s)", ".1f"),
            "peak_mb": ("most memory (MB)", ".0f"),
        },
        most=60,
    )  # fmt: skip
    return Section("steps", "Steps", exhibits=(view,))


def _jobs(costs: pd.DataFrame) -> Section:
    view = TableView(
        label="",
        title="By job",
        caption="Longest first.",
        frame=costs.sort_values("seconds", ascending=False, kind="stable"),
        columns={
            "rule": ("step", ""), "about": ("of", ""), "seconds": ("seconds", ".1f"),
            "cpu_s": ("CPU seconds", ".1f"), "peak_mb": ("most memory (MB)", ".0f"),
        },
        most=20,
    )  # fmt: skip
    return Section("jobs", "Jobs", exhibits=(view,))
