"""The report as a site: its pages, how they lead to one another, and writing them."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path

import signkin
from signkin.pages.corpus_page import Owner, corpus_page
from signkin.pages.front import front_lead, front_sections, summary_lines
from signkin.pages.methods import METHODS, methods_page
from signkin.pages.origins import PROVENANCE, origins_page, write_data_files
from signkin.pages.papers import (
    ENDRES,
    NAERT,
    ONE_WRIST,
    endres_page,
    naert_page,
    one_wrist_page,
)
from signkin.pages.sources import Sources
from signkin.pages.warnings import groups
from signkin.report.attempts import CANNOT
from signkin.report.images import Images
from signkin.report.page import Page, Section, render
from signkin.unavailable import reason_of

FRONT = "Front page"
SUMMARY = "summary.txt"  # what a run says at its end
Maker = Callable[[Sources, list[tuple[str, Path]]], Page]


def site_of(sources: Sources) -> list[tuple[str, Path]]:
    """Return the pages of the report, title and file, in the order of its contents."""
    home = sources.home
    real_first = sorted(sources.corpora, key=lambda name: bool(sources.corpora[name].simulator))
    return [
        (FRONT, home / "index.html"),
        *((name, home / "corpora" / f"{name}.html") for name in real_first),
        (NAERT, home / "papers" / "naert2017.html"),
        (ENDRES, home / "papers" / "endres2013.html"),
        (ONE_WRIST, home / "papers" / "one_wrist.html"),
        ("Audit", sources.results / "audit" / "index.html"),
        (METHODS, home / "methods.html"),
        (PROVENANCE, home / "provenance.html"),
    ]


def front_page(sources: Sources, site: list[tuple[str, Path]]) -> Page:
    """Return the front page."""
    return Page(
        title="How hands move from sign to sign, and what movements are made of",
        lead=front_lead(sources),
        sections=front_sections(sources),
        version=signkin.__version__,
        missing=sources.missing,
        site=site,
        here=FRONT,
        docs=sources.docs,
    )


PAGES: dict[str, Maker] = {
    FRONT: front_page, NAERT: naert_page, ENDRES: endres_page, ONE_WRIST: one_wrist_page,
    METHODS: methods_page,
}  # fmt: skip


def _attempted(
    name: str, sources: Sources, site: list[tuple[str, Path]], make: Callable[[], Page]
) -> Page:
    """Return a page, or one that says that it is not available: the others are written."""
    try:
        return make()
    except CANNOT as error:
        traceback.print_exception(error)  # in the log of the job
        sections = [
            Section("first", "What to look at first", groups=groups(sources)),
            Section("lacking", "Not available", text=(f"This page: {reason_of(error, 'report')}",)),
        ]
        return Page(
            title=name, lead=(), sections=sections, version=signkin.__version__, site=site,
            here=name, docs=sources.docs,
        )  # fmt: skip


def write_site(sources: Sources, commit: str) -> None:
    """Write all pages below `sources.home`, with their tables and figures beside them."""
    site = site_of(sources)
    files = dict(site)
    images = Images(sources.home / "images", sources.results)
    for folder in ("corpora", "papers", "images"):
        (sources.home / folder).mkdir(parents=True, exist_ok=True)
    pages = {
        name: _attempted(name, sources, site, partial(make, sources, site))
        for name, make in PAGES.items()
    }
    data = write_data_files(sources, sources.home / "data_files.csv")
    pages[PROVENANCE] = origins_page(sources, commit, data, site)
    for name in sources.corpora:
        owner = Owner(sources, name)
        written = owner.write(files[name].parent)
        elan = owner.write_elan(files[name].parent)
        make = partial(corpus_page, owner, written, elan, site)
        pages[name] = _attempted(name, sources, site, make)
    told = "\n".join(summary_lines(sources)) + "\n"
    (sources.home / SUMMARY).write_text(told, encoding="utf-8")
    for name, page in pages.items():
        file = files[name]
        file.write_text(render(page, file.parent, images), encoding="utf-8")
