"""The page of a paper: its sections in its order, the print beside what was found here."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pandas as pd

import signkin
from signkin.exhibits import exhibits, of_groups
from signkin.pages.sources import Sources
from signkin.report.exhibit_views import exhibit_view
from signkin.report.page import Page, Section, TableView
from signkin.studies.endres2013 import report as endres_report
from signkin.studies.naert2017 import report as naert_report
from signkin.studies.one_wrist import report as one_wrist_report

NAERT = "Naert et al. 2017"
ENDRES = "Endres et al. 2013"
ONE_WRIST = "One wrist"


def naert_page(sources: Sources, site: list[tuple[str, Path]]) -> Page:
    """Return the page of Naert, Larboulette & Gibet 2017."""
    parts = [_folded(part) for part in naert_report.sections(sources.naert)]
    return _page(
        sources, site, NAERT,
        "Naert, Larboulette & Gibet 2017: Coarticulation Analysis for Sign Language Synthesis",
        "The paper's tables and figures in its order, made of every corpus with tags. Its own "
        "recordings (Sign3D, French Sign Language, motion capture) are not public; no corpus here "
        "is theirs, and lsf-sim is made by a program to carry the printed numbers.",
        [*_printed(sources), *_overview(sources), *parts],
    )  # fmt: skip


# Not of the paper, but what a reader of it asks first.
SHOWN = ("Printed, and found here", "Fig. 3 to 7 under two readings of the prior")


def _folded(section: Section) -> Section:
    """Return a section with most of what the paper does not have behind its title.

    How a figure differs from the print is told at the first corpus alone.
    """
    told: set[str] = set()
    views = []
    for view in section.exhibits:
        differs = "" if view.label in told else view.differs
        told |= {view.label} if view.label else set()
        folded = not view.label and view.title not in SHOWN
        views.append(replace(view, folded=folded, differs=differs))
    return replace(section, exhibits=views)


def endres_page(sources: Sources, site: list[tuple[str, Path]]) -> Page:
    """Return the page of Endres, Meirovitch, Flash & Giese 2013."""
    window = sources.settings.binning.hit_window_s
    parts = endres_report.sections(sources.results, sources.endres, sources.corpora, window)
    return _page(
        sources, site, ENDRES,
        "Endres, Meirovitch, Flash & Giese 2013: Segmenting sign language into motor primitives "
        "with Bayesian binning",
        "The paper's analyses of single signs, run on every corpus of single signs. Its own "
        "recordings (Israeli Sign Language, 240 Hz) are not public. What it does not print of the "
        "prior decides its results: each corpus has a figure of how far.",
        [_folded(part) for part in parts],
    )  # fmt: skip


def one_wrist_page(sources: Sources, site: list[tuple[str, Path]]) -> Page:
    """Return the page of both papers' cuts on the same wrists."""
    parts = list(one_wrist_report.sections(sources.results, sources.corpora))
    return _page(
        sources, site, ONE_WRIST, "Two papers, one wrist",
        "Do the pieces into which Bayesian binning cuts a wrist's path start and end where the "
        "other paper puts its minima of speed, and the annotator the tags?",
        parts or [Section("none", "Nothing", text=("No corpus is of continuous recordings.",))],
    )  # fmt: skip


def _page(
    sources: Sources, site: list[tuple[str, Path]], here: str, title: str, lead: str,
    sections: list[Section],
) -> Page:  # fmt: skip
    return Page(
        title=title, lead=(lead,), sections=sections, version=signkin.__version__, site=site,
        here=here, docs=sources.docs,
    )  # fmt: skip


def _overview(sources: Sources) -> Iterator[Section]:
    caption = (
        "The rules of this run from raw motion to the report, each after those whose output it "
        "takes; the number in brackets is the paper's section."
    )
    for exhibit in of_groups(exhibits(sources.paper), "overview"):
        view = exhibit_view(exhibit, sources.results / "naert2017", caption)
        yield Section("overview", "The pipeline", exhibits=(view,))


_FOUND = {
    "mean_duration": "mean duration of a transition",
    "sd_duration": "standard deviation of durations",
    "shortest_duration": "shortest duration",
    "longest_duration": "longest duration",
    "theta_constant": "surface of duration: constant",
    "theta_geodesic": "surface of duration: geodesic",
    "theta_euclidean": "surface of duration: Euclidean",
    "mean_error": "mean error of the surface, in sample",
}


def _printed(sources: Sources) -> Iterator[Section]:
    tagged = [name for name, corpus in sources.corpora.items() if corpus.tagged]
    if not tagged:
        return
    frame = pd.read_csv(sources.paper / "constants.csv", dtype=str, keep_default_na=False)
    frame = frame[frame["name"].isin(_FOUND)]
    frame = frame.assign(what=frame["name"].map(_FOUND))
    columns = {"what": ("what", ""), "unit": ("unit", ""), "location": ("place", ""),
               "value": ("paper", "")}  # fmt: skip
    for name in tagged:
        found = _found(sources, name)
        frame[name] = frame["name"].map(found)
        columns[name] = (f"{name} ({sources.badge(name)})", ".3f")
    view = TableView(
        label="",
        title="Printed, and found here",
        caption="Numbers of the paper's text beside those of every corpus with tags. Simulated: "
        "made to carry the printed numbers, a test of the programs only.",
        frame=frame,
        columns=columns,
        file=sources.tagged_file(tagged[0], "table2") if len(tagged) == 1 else None,
    )
    yield Section("printed", "Printed, and found here", exhibits=(view,))


def _found(sources: Sources, name: str) -> dict[str, float]:
    whole = sources.tagged_table(name, "table2").set_index("type")
    out: dict[str, float] = {}
    if "all" in whole.index:
        everything = whole.loc["all"]
        out |= {"mean_duration": float(everything["mean_s"]),
                "sd_duration": float(everything["sd_s"])}  # fmt: skip
    points = sources.tagged_table(name, "transitions")
    kept = points[
        (points["segmentation"] == "manual") & (points["hand"] == "both")
        & (points["status"] == "ok")
    ]["duration_s"]  # fmt: skip
    out |= {"shortest_duration": kept.min(), "longest_duration": kept.max()}
    fitted = sources.tagged_table(name, "duration_coefficients")
    for row in fitted[fitted["model"] == "SURFACE"].itertuples():
        key = str(row.coefficient).partition("_")[0]
        out[f"theta_{key}"] = float(row.fitted)
    models = sources.tagged_table(name, "duration_models").set_index(["model", "evaluation"])
    if ("SURFACE", "in_sample") in models.index:
        out["mean_error"] = float(models.loc[("SURFACE", "in_sample"), "mean_error_s"])
    return out
