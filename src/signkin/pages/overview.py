"""The workflow's own graph, for the counterpart of Naert et al. 2017, Fig. 3."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from signkin import tables
from signkin.errors import SignkinError
from signkin.settings import Settings

TARGETS = ("all", "naert2017")


def rule_graph(snakefile: Path, settings: Settings, target: str) -> str:
    """Return the graph of the rules that a run consists of, in the DOT language.

    Asks Snakemake itself, with the run's settings, so that the figure shows the workflow
    as it is; but for the copy of results in a storage service, which is no result.
    """
    settings = settings.model_copy(update={"results_store": None})
    with tempfile.TemporaryDirectory() as folder:
        configfile = Path(folder) / "config.json"
        configfile.write_text(settings.model_dump_json(), encoding="utf-8")
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


ACROSS = 4  # boxes side by side of rules that follow no rule of their stage


def layout(edges: Sequence[tuple[str, str]], notes: dict[str, tuple[str, str]]) -> pd.DataFrame:
    """Return a row a rule: rule, stage (its file), note, column, row, the rules right before.

    Each stage is a lane of rows, below the stages that it needs. In it a rule stands right of
    those of its stage that it needs, in the row of the first where that is free; rules without
    such neighbours share rows at the lane's end.
    """
    rules = sorted({rule for edge in edges for rule in edge})
    before = {rule: sorted(a for a, b in edges if b == rule) for rule in rules}
    direct = {rule: _direct(rule, before) for rule in rules}
    stage = {rule: notes.get(rule, ("", ""))[0] for rule in rules}
    rows = []
    top = 0
    for lane in stage_order([(stage[a], stage[b]) for a, b in edges], sorted(set(stage.values()))):
        mine = [rule for rule in rules if stage[rule] == lane]
        places = _lane(mine, {r: [a for a in direct[r] if stage[a] == lane] for r in mine})
        for rule in sorted(mine, key=lambda r: (places[r][1], places[r][0])):
            rows.append(
                {
                    "rule": rule,
                    "stage": lane,
                    "note": notes.get(rule, ("", ""))[1],
                    "column": places[rule][0],
                    "row": top + places[rule][1],
                    "after": " ".join(direct[rule]),
                }
            )
        top += 1 + max(row for _, row in places.values())
    return pd.DataFrame(rows, columns=tables.TABLES["overview"].names())


def stage_order(edges: Sequence[tuple[str, str]], stages: Sequence[str]) -> list[str]:
    """Return the stages, each after those it needs; of a circle, the first by name goes first."""
    needs = {s: {a for a, b in edges if b == s and a != s} for s in stages}
    out: list[str] = []
    while len(out) < len(stages):
        left = [s for s in stages if s not in out]
        free = [s for s in left if needs[s] <= set(out)]
        # Beside the stage before rather than by name: what needs the last one comes first.
        out.append(
            max(free or left[:1], key=lambda s: (out[-1:] and out[-1] in needs[s], -left.index(s)))
        )
    return out


def _lane(rules: Sequence[str], before: Mapping[str, Sequence[str]]) -> dict[str, tuple[int, int]]:
    """Return rule -> (column, row) in a lane; before: the rules of the lane right before."""
    column: dict[str, int] = {}

    def place(rule: str) -> int:
        if rule not in column:
            column[rule] = 1 + max((place(a) for a in before[rule]), default=-1)
        return column[rule]

    alone = [r for r in rules if not before[r] and not any(r in b for b in before.values())]
    row: dict[str, int] = {}
    chained = sorted((r for r in rules if r not in alone), key=lambda r: (place(r), r))
    for rule in _along(chained, before):
        taken = {row[r] for r in row if column[r] == column[rule]}
        at = row[before[rule][0]] if before[rule] else 1 + max(row.values(), default=-1)
        while at in taken:
            at += 1
        row[rule] = at
    first = 1 + max(row.values(), default=-1)
    for i, rule in enumerate(alone):
        column[rule], row[rule] = i % ACROSS, first + i // ACROSS
    return {rule: (column[rule], row[rule]) for rule in rules}


def _along(rules: Sequence[str], before: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the rules chain by chain: each as soon as those before it are there."""
    out: list[str] = []
    left = list(rules)
    while left:
        ready = [r for r in left if set(before[r]) <= set(out)]
        following = [r for r in ready if before[r]]
        out.append((following or ready)[0])
        left.remove(out[-1])
    return out


def _direct(rule: str, before: dict[str, list[str]]) -> list[str]:
    """Return the rules right before, without those that a longer way leads from anyway."""

    def ancestors(name: str) -> set[str]:
        out = set(before[name])
        for above in before[name]:
            out |= ancestors(above)
        return out

    far = set().union(*(ancestors(a) for a in before[rule])) if before[rule] else set()
    return [a for a in before[rule] if a not in far]
