"""The workflow's own graph, for the counterpart of Naert et al. 2017, Fig. 3."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from signkin import tables
from signkin.errors import SignkinError

TARGETS = ("all", "naert2017")


def rule_graph(snakefile: Path, config: Mapping[str, Any], target: str) -> str:
    """Return the graph of the rules that a run consists of, in the DOT language.

    Asks Snakemake itself, with the run's configuration, so that the figure shows the workflow
    as it is.
    """
    with tempfile.TemporaryDirectory() as folder:
        configfile = Path(folder) / "config.json"
        configfile.write_text(json.dumps(config), encoding="utf-8")
        command = [sys.executable, "-m", "snakemake", "--snakefile", str(snakefile)]
        command += ["--configfile", str(configfile), "--forceall", "--nolock"]
        command += ["--rulegraph", "dot", "--", target]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode or "digraph" not in done.stdout:
        raise SignkinError(
            f"Snakemake drew no rule graph: {done.stderr.strip()[-300:]}",
            file=snakefile,
            expected="a graph in the DOT language",
        )
    return done.stdout


def parse_rule_graph(dot: str) -> list[tuple[str, str]]:
    """Return the edges (rule before, rule after), sorted, each once, without target rules."""
    names = dict(re.findall(r'^\s*(\d+)\[label = "(\w+)', dot, flags=re.MULTILINE))
    pairs = re.findall(r"^\s*(\d+) -> (\d+)", dot, flags=re.MULTILINE)
    edges = {(names[a], names[b]) for a, b in pairs}
    return sorted((a, b) for a, b in edges if a not in TARGETS and b not in TARGETS and a != b)


def rule_notes(rule_files: Sequence[Path]) -> dict[str, tuple[str, str]]:
    """Return rule -> (file it stands in, its docstring) for the files of the workflow."""
    notes = {}
    pattern = re.compile(r'^\s*rule (\w+):\n\s+"""(.*?)"""', flags=re.MULTILINE | re.DOTALL)
    for path in rule_files:
        for name, text in pattern.findall(path.read_text(encoding="utf-8")):
            notes[name] = (path.stem, " ".join(text.split()))
    return notes


def layout(edges: Sequence[tuple[str, str]], notes: dict[str, tuple[str, str]]) -> pd.DataFrame:
    """Return a row a rule: rule, stage (its file), note, column, row, the rules right before.

    Each rule stands as far right as the rules after it allow; rows follow the mean row of what
    is before. An arrow over several columns takes a place of its own in each column between
    (a row named `from>to`, without a stage), so that it runs beside the boxes.
    """
    rules = sorted({rule for edge in edges for rule in edge})
    before = {rule: sorted(a for a, b in edges if b == rule) for rule in rules}
    after = {rule: sorted(b for a, b in edges if a == rule) for rule in rules}
    to_go: dict[str, int] = {}

    def ahead(rule: str) -> int:
        if rule not in to_go:
            to_go[rule] = 1 + max((ahead(b) for b in after[rule]), default=-1)
        return to_go[rule]

    longest = max((ahead(rule) for rule in rules), default=0)
    column = {rule: longest - ahead(rule) for rule in rules}
    links: dict[str, list[str]] = {}
    for rule in rules:
        links[rule] = []
        for source in _direct(rule, before):
            link = source
            for between in range(column[source] + 1, column[rule]):
                passing = f"{source}>{rule}:{between}"
                column[passing], links[passing] = between, [link]
                link = passing
            links[rule].append(link)
    row: dict[str, float] = {}
    for place in range(longest + 1):
        here = [name for name, at in column.items() if at == place]
        # What comes from nowhere stands last: it is no part of the chain.
        height = {
            n: sum(row[a] for a in links[n]) / len(links[n]) if links[n] else len(column)
            for n in here
        }
        for i, name in enumerate(sorted(here, key=lambda n: (height[n], ">" in n, n))):
            row[name] = i - (len(here) - 1) / 2
    rows = [
        {
            "rule": name,
            "stage": notes.get(name, ("", ""))[0],
            "note": notes.get(name, ("", ""))[1],
            "column": column[name],
            "row": row[name],
            "after": " ".join(links[name]),
        }
        for name in sorted(column, key=lambda n: (column[n], row[n]))
    ]
    return pd.DataFrame(rows, columns=tables.TABLES["overview"].names())


def _direct(rule: str, before: dict[str, list[str]]) -> list[str]:
    """Return the rules right before, without those that a longer way leads from anyway."""

    def ancestors(name: str) -> set[str]:
        out = set(before[name])
        for above in before[name]:
            out |= ancestors(above)
        return out

    far = set().union(*(ancestors(a) for a in before[rule])) if before[rule] else set()
    return [a for a in before[rule] if a not in far]
