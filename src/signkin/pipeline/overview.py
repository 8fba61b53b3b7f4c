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
    """Return a row a rule: rule, stage (its file), note, column, row.

    The column is the length of the longest path to the rule; rows follow the stages and the
    mean row of the rules before.
    """
    rules = sorted({rule for edge in edges for rule in edge})
    before = {rule: sorted(a for a, b in edges if b == rule) for rule in rules}
    column: dict[str, int] = {}

    def depth(rule: str) -> int:
        if rule not in column:
            column[rule] = 1 + max((depth(a) for a in before[rule]), default=-1)
        return column[rule]

    for rule in rules:
        depth(rule)
    stages = list(dict.fromkeys(stage for stage, _ in notes.values()))
    row: dict[str, float] = {}
    for place in range(max(column.values(), default=-1) + 1):
        here = [rule for rule in rules if column[rule] == place]

        def key(rule: str) -> tuple[float, int, str]:
            above = [row[a] for a in before[rule]]
            stage = notes.get(rule, ("", ""))[0]
            return (
                sum(above) / len(above) if above else 0.0,
                stages.index(stage) if stage in stages else len(stages),
                rule,
            )

        for i, rule in enumerate(sorted(here, key=key)):
            row[rule] = i - (len(here) - 1) / 2
    rows = [
        {
            "rule": rule,
            "stage": notes.get(rule, ("", ""))[0],
            "note": notes.get(rule, ("", ""))[1],
            "column": column[rule],
            "row": row[rule],
            "after": " ".join(_direct(rule, before)),
        }
        for rule in rules
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
