"""Which claims hold under which readings that keep all that a paper prints: a figure a paper.

Claims whose curves rest on one table and the same choices stand together: a row a claim, a
column a specification, below it what was chosen.
"""

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
from signkin.audit.specifications import levels_of, specifications
from signkin.figures import specification, style
from signkin.pages.curves import table_of
from signkin.report.page import FigureView

NAME = "readings"
WHITE = (
    "White: what the claim compares has no value under that reading (such as hits by no false "
    "positives), so that it cannot be judged. "
)


@dataclass(frozen=True, eq=False)
class DrawnReadings:
    """A figure of one paper: its name (`endres2013_readings`), and its numbers.

    points: a row a corpus and reading; the choices by their names, and a column a claim (yes, no,
    or empty where there is nothing to judge it by).
    """

    name: str
    figure: Figure
    points: pd.DataFrame


def draw_readings(
    papers: Sequence[Paper], corpora: Mapping[str, bool], files: Sequence[Path], results: Path
) -> Iterator[DrawnReadings]:
    """Yield a figure for each paper that has two claims or more on the same readings.

    corpora, files, results: as `curves.draw_curves`.
    """
    for paper in papers:
        curves = _together(paper)
        if len(curves) < 2:
            continue
        found = {}
        for evidence in evidence_for(paper.study, corpora, files, results):
            tables = [table_of(paper, curve, evidence, files, results) for curve in curves]
            if all(table is not None for table in tables):
                kept = _kept(curves, [table for table in tables if table is not None])
                if len(kept):
                    found[evidence.name] = kept
        if found:
            points = pd.concat(
                [frame.assign(corpus=name) for name, frame in found.items()], ignore_index=True
            )
            points.insert(0, "corpus", points.pop("corpus"))
            figure = _draw(curves, found, corpora)
            yield DrawnReadings(f"{paper.folder.name}_{NAME}", figure, points)


def _together(paper: Paper) -> list[Curve]:
    """Return the curves of the table and choices that most claims rest on."""
    groups: dict[tuple[str, tuple[str, ...]], list[Curve]] = {}
    for curve in paper.curves:
        if curve.keeps and curve.holds and not curve.where:
            groups.setdefault((curve.table, tuple(curve.choices)), []).append(curve)
    return max(groups.values(), key=len, default=[])


def _kept(curves: Sequence[Curve], tables: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Return the readings that keep what is printed, sorted by choice, and what holds there."""
    names = list(curves[0].choices.values())
    out: pd.DataFrame | None = None
    for curve, table in zip(curves, tables, strict=True):
        answers = evaluate(curve.keeps, {str(c): table[c] for c in table.columns})
        told = table[answers].assign(holds=table["holds"])
        specs = specifications(told, curve.choices, curve.estimate, curve.reference)
        one = specs.assign(**{curve.claim: specs["holds"].map({True: "yes", False: "no"})})
        one = one[[*names, curve.claim]]
        out = one if out is None else out.merge(one, how="outer", on=names)
    assert out is not None
    ranks = [out[name].map({v: i for i, v in enumerate(levels_of(out[name]))}) for name in names]
    order = pd.concat(ranks, axis=1, keys=names)
    # What has fewest levels changes slowest: neighbours are readings that differ in one choice.
    by = sorted(names, key=lambda name: (name != names[1], order[name].nunique()))
    return out.loc[order.sort_values(by, kind="stable").index].reset_index(drop=True).fillna("")


def _draw(
    curves: Sequence[Curve], found: Mapping[str, pd.DataFrame], corpora: Mapping[str, bool]
) -> Figure:
    whole = pd.concat(found.values())
    levels = {name: levels_of(whole[name]) for name in curves[0].choices.values()}
    levels = {name: values for name, values in levels.items() if len(values) > 1}
    rows = sum(map(len, levels.values()))
    claims = [curve.claim for curve in curves]
    heights = [0.2 * len(claims) + 0.1, *[0.2 * len(claims) + 0.1] * (len(found) - 1), 0.15 * rows]
    figure, axes = plt.subplots(
        len(found) + 1, 1, figsize=(style.WIDTH_IN, sum(heights) + 0.5 * len(found) + 0.5),
        height_ratios=heights, sharex=True,
    )  # fmt: skip
    for ax, (corpus, frame) in zip(axes, found.items(), strict=False):
        specification.plot_claims(frame, claims, ax=ax)
        ax.set_title(f"{corpus} ({'simulated' if corpora[corpus] else 'real'})", loc="left")
    last = list(found.values())[-1]
    specification.plot_choices(last.assign(holds=False), levels, ax=axes[-1])
    axes[-1].set_xlabel(f"{len(last)} readings that keep all that is printed")
    named = {
        label: handle
        for ax in axes[:-1]
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)
    }
    figure.legend(list(named.values()), list(named), loc="outside lower right", ncols=len(named))
    return figure


def _claims_of(points: pd.DataFrame) -> list[str]:
    return [c for c in points.columns if (points[c].isin(["yes", "no", ""])).all()]


def _unjudged(points: pd.DataFrame) -> bool:
    """Whether some claim has, under some reading, nothing to judge it by."""
    return bool((points[_claims_of(points)] == "").any(axis=None))


def told(points: pd.DataFrame) -> str:
    """Return what the figure shows, in words: how many readings hold each claim, and most at once.

    points: as `DrawnReadings.points`.
    """
    claims = _claims_of(points)
    out = []
    for corpus, part in points.groupby("corpus", sort=False):
        shares = ", ".join(f"{c} {int((part[c] == 'yes').sum())}" for c in claims)
        together = (part[claims] == "yes").sum(axis=1)
        best = int(together.max())
        n = int((together == best).sum())
        out.append(
            f"{corpus}: of {len(part)} readings hold {shares}; at most {best} of {len(claims)} "
            f"claims hold under one reading (under {n})"
        )
    return ". ".join(out)


def views(papers: Sequence[Paper], folder: Path) -> Iterator[FigureView]:
    """Yield the figures that lie in a folder, as the page of the audit shows them."""
    for paper in papers:
        base = folder / f"{paper.folder.name}_{NAME}"
        if not base.with_suffix(".svg").is_file():
            continue
        points = pd.read_csv(base.with_suffix(".csv"), dtype=str, keep_default_na=False)
        yield FigureView(
            label="",
            title=f"{paper.title}: which claims hold under which reading",
            caption="Readings that keep all that the paper prints, a column each; below, what was "
            "chosen of what it does not print. Claims are judged as in their curves. "
            + (WHITE if _unjudged(points) else "")
            + f"{told(points)}.",
            svg=base.with_suffix(".svg"),
            files=[base.with_suffix(s) for s in (".svg", ".pdf", ".csv")],
        )
