"""Specification curves of the papers' claims: a figure and two tables for each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.figure import Figure

from signkin.audit.expressions import evaluate
from signkin.audit.ledger import evidence_for
from signkin.audit.paper import Curve, Paper
from signkin.audit.registry import Evidence, Missing, OnCorpus
from signkin.audit.specifications import NONE, by_choice, levels_of, specifications
from signkin.figures import specification, style


@dataclass(frozen=True, eq=False)
class DrawnCurve:
    """A curve: its name (`naert2017_N05`), figure, specifications and shares by choice."""

    name: str
    figure: Figure
    points: pd.DataFrame
    levels: pd.DataFrame


def draw_curves(
    papers: Sequence[Paper], corpora: Mapping[str, bool], files: Sequence[Path], results: Path
) -> Iterator[DrawnCurve]:
    """Yield the curve of each claim that a corpus has specifications of.

    corpora, files, results: as `ledger.ledger_of`. A table that lies in results/<study>
    itself serves the corpora named in its column `corpus`.
    """
    for paper in papers:
        evidence = evidence_for(paper.study, corpora, files, results)
        for curve in paper.curves:
            specs, left_out = {}, {}
            for part in evidence:
                table = table_of(paper, curve, part, files, results)
                if table is None:
                    continue
                found = specifications(table, curve.choices, curve.estimate, curve.reference)
                if len(found):
                    specs[part.name] = found
                    left_out[part.name] = len(table) - len(found)
            if specs:
                yield _drawn(paper, curve, specs, left_out, corpora)


def table_of(
    paper: Paper, curve: Curve, evidence: Evidence, files: Sequence[Path], results: Path
) -> pd.DataFrame | None:
    """Return a curve's table for one corpus, with its column `holds`; None where there is none."""
    shared = results / paper.study / f"{curve.table}.csv"
    if curve.table not in evidence.files and shared in files:
        known = {**evidence.files, curve.table: shared}
        evidence = Evidence(evidence.name, evidence.simulated, known, results)
    claim = next(c for c in paper.claims if c.id == curve.claim)
    try:
        table = OnCorpus(paper, claim, evidence).table(curve.table)
    except Missing:
        return None
    if "corpus" in table.columns:
        table = table[table["corpus"] == evidence.name]
    if curve.where:
        table = table[evaluate(curve.where, {str(c): table[c] for c in table.columns})]
    if curve.holds:
        answers = evaluate(curve.holds, {str(c): table[c] for c in table.columns})
        table = table.assign(holds=answers)
    return table


def _drawn(
    paper: Paper,
    curve: Curve,
    specs: Mapping[str, pd.DataFrame],
    left_out: Mapping[str, int],
    corpora: Mapping[str, bool],
) -> DrawnCurve:
    names = list(curve.choices.values())
    whole = pd.concat(specs.values())
    levels = {name: levels_of(whole[name]) for name in names}
    levels = {name: [v for v in values if v != NONE] for name, values in levels.items()}
    levels = {name: values for name, values in levels.items() if len(values) > 1}
    rows = sum(map(len, levels.values()))
    figure, axes = plt.subplots(
        2, len(specs), figsize=(style.WIDTH_IN, 1.9 + 0.15 * rows), squeeze=False, sharey="row",
        sharex="col", height_ratios=[1.7, 0.15 * rows],
    )  # fmt: skip
    for column, (corpus, found) in enumerate(specs.items()):
        label = curve.label if column == 0 else ""
        specification.plot_estimates(found, label, not curve.reference, ax=axes[0, column])
        specification.plot_choices(found, levels, ax=axes[1, column])
        if column:
            axes[1, column].tick_params(labelleft=False)
        share = found["holds"].mean()
        kind = "simulated" if corpora[corpus] else "real"
        axes[0, column].set_title(f"{corpus}\n({kind}), holds in {share:.0%}", loc="left")
    handles: dict[str, object] = {}
    for ax in axes[0]:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    figure.legend(
        handles.values(), handles.keys(), loc="outside lower right", ncols=3, markerscale=1.6
    )
    points = pd.concat(
        [found.assign(corpus=corpus) for corpus, found in specs.items()], ignore_index=True
    )
    points.insert(0, "corpus", points.pop("corpus"))
    parts = [
        by_choice(found, paper.folder.name, curve.claim, corpus, names, left_out[corpus])
        for corpus, found in specs.items()
    ]
    name = f"{paper.folder.name}_{curve.claim}"
    return DrawnCurve(name, figure, points, pd.concat(parts, ignore_index=True))
