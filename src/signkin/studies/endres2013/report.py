"""What the report shows of Bayesian binning (Endres et al. 2013)."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import pandas as pd

from signkin.corpus import Corpus
from signkin.exhibits import Exhibit, exhibits, of_groups
from signkin.report.attempts import CANNOT, attempted
from signkin.report.exhibit_views import by_exhibit
from signkin.report.page import FigureView, Section, TableView, View, figure_files
from signkin.studies.endres2013 import report_beside
from signkin.tables import read_table

ALL = "all"
P3 = ".3f"
SIMULATED = " Simulated: a test of the method, no evidence about people."


CHAPTERS = {
    "found": "Printed, and found here",
    "power-laws": "2.3, 2.4 Power laws, and ground truth made with them",
    "model": "2.5 The model",
    "recovered": "3.1 Known boundaries found again",
    "truth": "3.2 Ground truth of power laws",
    "recorded": "3.3 Recorded movements",
    "choices": "What the paper does not print decides its results",
    "left-out": "Left out",
}
_CHAPTER = {
    "fig01": "power-laws", "fig02": "model", "fig03": "recovered", "fig04": "recovered",
    "figA1": "recovered", "fig05": "truth", "fig06": "truth", "fig07": "recorded",
}  # fmt: skip


def sections(
    results: Path, paper: Path, corpora: Mapping[str, Corpus], hit_window_s: float
) -> Iterator[Section]:
    """Yield a section a chapter of the paper, with what every corpus of single signs has of it.

    paper: the folder papers/endres2013. hit_window_s: binning.hit_window_s.
    """
    listing = exhibits(paper)
    folder = results / "endres2013"
    found: dict[str, list[View]] = {chapter: [] for chapter in CHAPTERS}
    found["model"] += figure_views(folder, of_groups(listing, "scheme"))
    printed = partial(_printed_and_found, folder, corpora)
    found["found"] += attempted("Printed, and found here", printed)
    for name, corpus in corpora.items():
        if corpus.single_signs:
            shown = of_groups(listing, "figures")
            for chapter, view in _single_signs(folder / name, corpus, shown, hit_window_s):
                found[chapter].append(replace(view, of=name, badge=badge(corpus)))
    order = {exhibit.label: i for i, exhibit in enumerate(listing)}
    for chapter, title in CHAPTERS.items():
        if found[chapter]:
            yield Section(chapter, title, exhibits=by_exhibit(found[chapter], order))


def figure_views(folder: Path, listing: Iterable[Exhibit], told: str = "") -> Iterator[FigureView]:
    """Yield the figures of a list, whose files and captions lie in a folder.

    told: what is added to each caption.
    """
    captions = json.loads((folder / "captions.json").read_text(encoding="utf-8"))
    for exhibit in listing:
        base = folder / exhibit.stem
        yield FigureView(
            label=exhibit.label,
            title=exhibit.title,
            caption=captions[exhibit.stem] + told,
            svg=base.with_suffix(".svg"),
            files=figure_files(base),
            differs=exhibit.differs,
        )


def badge(corpus: Corpus) -> str:
    """Return whether a corpus is real or simulated."""
    return "simulated" if corpus.simulator else "real"


def _single_signs(
    folder: Path, corpus: Corpus, listing: Iterable[Exhibit], hit_window_s: float
) -> Iterator[tuple[str, View]]:
    for view in figure_views(folder, listing, SIMULATED if corpus.simulator else ""):
        yield _CHAPTER.get(view.svg.stem, "recorded"), view
        if view.svg.stem == "fig06":
            rates, tests = partial(_rates, folder, hit_window_s), partial(_tests, folder)
            yield from (("truth", view) for view in attempted("Hit rates", rates))
            yield from (("truth", view) for view in attempted("Tests of orders", tests))
        if view.svg.stem == "fig07":
            learnt = partial(report_beside.learnt, folder)
            yield from (("recorded", one) for one in attempted("The prior learnt", learnt))
    yield "choices", report_beside.figure(folder, "order_choices", "Orders under all choices")
    priors, doubts = (
        partial(of, folder) for of in (report_beside.two_priors, report_beside.doubts)
    )
    yield from (("choices", one) for one in attempted("Two readings of the prior", priors))
    yield from (("found", one) for one in attempted("Does the noise fit?", doubts))
    title = "Power laws of recorded movement, and of noise"
    yield "power-laws", report_beside.figure(folder, "recorded_laws", title, "law_pitfalls.csv")
    out = partial(left_out, folder / "left_out.csv")
    yield from (("left-out", view) for view in attempted("Left out", out))
    rejected = partial(_rejected, folder)
    yield from (("power-laws", view) for view in attempted("Rejected draws", rejected))


# --- tables ----------------------------------------------------------------------------------


def _of(table: pd.DataFrame, dataset: str, true_order: int | None = None) -> pd.DataFrame:
    here = (table["dataset"] == dataset) & (table["signer"] == ALL) & (table["sign"] == ALL)
    if true_order is not None:
        here &= table["true_order"] == true_order
    return table[here].set_index("order")


def _printed_and_found(folder: Path, corpora: Mapping[str, Corpus]) -> Iterator[TableView]:
    frame = pd.DataFrame(columns=["what", "where", "printed"])
    columns: dict[str, tuple[str, str]] = {
        "what": ("what", ""), "where": ("where", ""), "printed": ("paper", ""),
    }  # fmt: skip
    for name, corpus in corpora.items():
        if not corpus.single_signs:
            continue
        orders = read_table(folder / name / "order_posteriors.csv", "order_posteriors")
        rates = read_table(folder / name / "hit_rates.csv", "hit_rates")
        try:
            rows = list(_comparisons(orders, rates))
        except CANNOT:  # not available, as the page of the corpus tells
            rows = []
        own = pd.DataFrame(rows, columns=["what", "where", "printed", name])
        frame = frame.merge(own, how="outer", on=["what", "where", "printed"], sort=False)
        columns[name] = (f"{name} ({badge(corpus)})", "")
    if len(columns) > 3:
        yield TableView(
            label="",
            title="Printed, and found here",
            caption="Means over trajectories; order posteriors of each corpus, with the prior of "
            "config.yaml. The paper's recordings are others. Simulated: a test of the method, no "
            "evidence about people.",
            frame=frame,
            columns=columns,
        )


def _comparisons(orders: pd.DataFrame, rates: pd.DataFrame) -> Iterator[tuple[str, str, str, str]]:
    recorded = _of(orders, "recorded")
    peak = int(recorded["mean_probability"].idxmax())
    share = recorded["mean_probability"].reindex([3, 4, 5]).sum()
    yield "order posterior of recorded trajectories, peak", "Fig. 7", "4", str(peak)
    yield "P(3 ≤ S ≤ 5), recorded", "3.3", "> 0.95", f"{share:.3f}"
    counts = recorded["mean_count"]
    for order, printed in ((0, "13"), (3, "7 (one example)"), (7, "2")):
        if order in counts.index:
            yield (
                f"mean number of boundaries, order {order}",
                "3.1",
                printed,
                f"{counts[order]:.1f}",
            )
    variance = recorded["mean_explained_variance"]
    for order, printed in ((0, "> 0.95"), (3, "> 0.99")):
        if order in variance.index:
            found = f"{variance[order]:.4f}"
            yield f"explained variance, order {order}", "Fig. 3D", printed, found
    truth = _of(orders, "powerlaw")
    if len(truth):
        best = int(truth["mean_probability"].idxmax())
        yield "order posterior of power-law ground truth, peak", "Fig. 6", "3", str(best)
        ratio = _of(rates, "powerlaw")["hpfpps"].dropna()
        if len(ratio):
            where = str(int(ratio.idxmax()))
            yield "hits for each false positive a second, peak", "Fig. 6", "3", where
        over = _of(rates, "powerlaw")["over_shifted"].dropna()
        if len(over):
            where = str(int(over.idxmax()))
            yield "hit rate less chance (boundaries shifted), peak", "", "not told", where
    for dataset, told in (("fitted", "averaged"), ("fitted_map", "most probable")):
        found = _of(orders, dataset, 3)
        hits = _of(rates, dataset, 3)
        if 3 in found.index:
            probability = found.loc[3, "mean_probability"]
            yield (
                f"P(S = 3), fitted with order 3, {told}",
                "Fig. 3B",
                "near 1",
                f"{probability:.3f}",
            )
            yield (
                f"hit rate, false positives a second, {told}",
                "Fig. 3C",
                "near 1, almost none",
                f"{hits.loc[3, 'hit_rate']:.3f}, {hits.loc[3, 'false_positives_per_s']:.3f}",
            )


def _rates(folder: Path, hit_window_s: float) -> TableView:
    path = folder / "hit_rates.csv"
    frame = read_table(path, "hit_rates")
    here = (frame["dataset"] == "powerlaw") & (frame["signer"] == ALL)
    return TableView(
        label="",
        title="Hit rates on power-law ground truth",
        caption=f"Window ±{hit_window_s:g} s, one to one. Chance: Poisson events "
        "with as many false positives, and (shifted) the same boundaries, each trajectory's moved "
        "in a circle; an order is informative where its hit rate is above the 97.5 %. Eq. 17 by "
        "chance is not the same at all orders: the hit rate less chance stands beside it.",
        frame=frame[here],
        columns={
            "order": ("order", "d"),
            "hit_rate": ("hit rate", P3),
            "hit_rate_se": ("± SE", P3),
            "false_positives_per_s": ("false pos. a second", P3),
            "false_positives_per_s_se": ("± SE", P3),
            "chance_hit_rate": ("chance", P3),
            "chance_high": ("97.5 %", P3),
            "over_chance": ("less chance", P3),
            "shifted_hit_rate": ("shifted", P3),
            "shifted_high": ("97.5 %", P3),
            "over_shifted": ("less shifted", P3),
            "hpfpps": ("eq. 17 (s)", P3),
            "hpfpps_low": ("2.5 %", P3),
            "hpfpps_high": ("97.5 %", P3),
            "chance_hpfpps": ("by chance", P3),
            "shifted_hpfpps": ("shifted", P3),
            "n": ("n", "d"),
            "note": ("note", ""),
        },
        file=path,
    )


def _tests(folder: Path) -> TableView:
    path = folder / "order_tests.csv"
    return TableView(
        label="",
        title="Do orders differ in eq. 17?",
        caption="By ranks of trajectories; hits without a false positive are a tied top rank, "
        "neither hit nor false positive is left out and counted. Kruskal-Wallis takes as "
        "independent what is not: the same trajectories stand in every order's group.",
        frame=read_table(path, "order_tests"),
        columns={
            "question": ("question", ""),
            "test": ("test", ""),
            "statistic": ("statistic", ".2f"),
            "df": ("df", "d"),
            "p": ("p", ".2g"),
            "n": ("n", "d"),
            "left_out": ("left out", "d"),
            "without_truth": ("without truth", "d"),
            "note": ("note", ""),
        },
        file=path,
    )


def left_out(path: Path) -> Iterator[TableView]:
    """Yield the table of what was not binned, by reason; nothing where all was.

    path: of a table `binning_left_out`.
    """
    frame = read_table(path, "binning_left_out")
    if frame.empty:
        return
    # One sentence for each kind of reason: what is a recording's own is taken out.
    kinds = frame["reason"].str.replace(r"recording \S+:? ?", "", regex=True)
    kinds = kinds.str.replace(r"\d+(\.\d+)?", "#", regex=True)
    counted = frame.groupby(["dataset", kinds], sort=True).agg(
        n=("recording", "size"), example=("recording", "first"), reason_of=("reason", "first")
    )
    yield TableView(
        label="",
        title="Left out",
        caption=f"{len(frame)} trajectories, by reason; the file lists each.",
        frame=counted.reset_index(level=0),
        columns={
            "dataset": ("data", ""),
            "n": ("trajectories", "d"),
            "reason_of": ("reason, of the first", ""),
            "example": ("first recording", ""),
        },
        file=path,
    )


def _rejected(folder: Path) -> Iterator[TableView]:
    path = folder / "rejected_draws.csv"
    frame = read_table(path, "rejected_draws")
    if frame.empty:
        return
    draws = int(frame.drop_duplicates("recording")["draws"].sum())
    counted = frame.groupby("reason", sort=False).agg(
        rejected=("rejected", "sum"), recordings=("recording", "nunique")
    )
    yield TableView(
        label="",
        title="Rejected draws of ground truth",
        caption=f"Of {draws} draws of boundaries and exponents (section 2.4).",
        frame=counted.sort_values("rejected", ascending=False).reset_index(),
        columns={
            "reason": ("reason", ""),
            "rejected": ("draws rejected", "d"),
            "recordings": ("recordings", "d"),
        },
        file=path,
    )
