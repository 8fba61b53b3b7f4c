"""The report: self-contained HTML pages from tables, figures and captions.

Tables and figures come in as data and files; nothing is computed here but counts
of rows. A page asks the network for nothing: styles and scripts are in it, figures
are in it or lie beside it.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from signkin.report.cells import (
    MOST_LETTERS,
    WORDS,
    as_json,
    cell,
    first_that_fit,
    notes_of,
    texts_of,
)
from signkin.report.images import Images, InPlace, data_uri, size_of


@dataclass(frozen=True)
class Captioned:
    """What every table, figure and plot of a page has above and below it.

    of: the corpus, where a page has several. badge: `simulated`, `real` or nothing. folded: it
    stands behind its title; opened: but is open at first. verdicts: (on what, verdict), told
    below the title. inner: what belongs to it and stands below it, folded with it.
    """

    label: str
    title: str
    caption: str
    differs: str = field(default="", kw_only=True)
    of: str = field(default="", kw_only=True)
    badge: str = field(default="", kw_only=True)
    folded: bool = field(default=False, kw_only=True)
    opened: bool = field(default=False, kw_only=True)
    verdicts: Sequence[tuple[str, str]] = field(default=(), kw_only=True)
    inner: Sequence[View] = field(default=(), kw_only=True)


@dataclass(frozen=True)
class TableView(Captioned):
    """A table as it is shown: what is above it, the columns shown, the file with all of it.

    columns: column -> (heading, format); the format is empty for text, `verdict` for a verdict,
    `link` for files relative to the page, `open` for one address, `rating` for what the reader
    thinks of a row, else as in `format()`. most: rows shown at once. keys: columns (recording,
    signer, ...) that a row is known by, for marks in plots and ratings.
    """

    frame: pd.DataFrame
    columns: Mapping[str, tuple[str, str]]
    file: Path | None = None
    most: int = 24
    emphasis: str = ""  # a column whose value `yes` or `no` colours the row
    keys: Sequence[str] = ()

    @property
    def shown(self) -> Mapping[str, tuple[str, str]]:
        """The columns without that of notes where there is no note."""
        if "note" not in self.columns or "note" not in self.frame:
            return self.columns
        notes = self.frame["note"]
        if len(notes) and (notes.notna() & notes.ne("")).any():
            return self.columns
        return {name: head for name, head in self.columns.items() if name != "note"}


@dataclass(frozen=True)
class FigureView(Captioned):
    """A figure as it is shown, with its caption, its files and how it differs from the paper's."""

    svg: Path
    files: Sequence[Path] = ()


@dataclass(frozen=True)
class PlotView(Captioned):
    """A plot whose points can be chosen: SVG that stands in the page.

    drawing: of `signkin.report.plots`.
    """

    drawing: Markup
    files: Sequence[Path] = ()


View = TableView | FigureView | PlotView


@dataclass(frozen=True)
class Group:
    """Lines of one kind, folded behind a sentence that counts them."""

    told: str
    lines: Sequence[str]
    warns: bool = True


@dataclass(frozen=True)
class Section:
    """A part of the page: text, then exhibits in order."""

    anchor: str
    title: str
    text: Sequence[str] = ()
    badge: str = ""  # `simulated`, `real` or nothing
    exhibits: Sequence[View] = ()
    notices: Sequence[str] = ()
    links: Sequence[tuple[str, Path]] = ()
    groups: Sequence[Group] = ()


@dataclass(frozen=True)
class Page:
    """A page. site: the other pages, title and file; `here`: this one's title there."""

    title: str
    lead: Sequence[str]
    sections: Sequence[Section]
    version: str
    missing: Mapping[str, str] = field(default_factory=dict)
    site: Sequence[tuple[str, Path]] = ()
    here: str = ""
    docs: Path | None = None
    ratings: str = ""  # the corpus whose recordings can be rated here


def figure_files(base: Path, *suffixes: str) -> tuple[Path, ...]:
    """Return the files of a figure: SVG, PDF and the drawn data as CSV, or those asked for."""
    return tuple(base.with_suffix(s) for s in (suffixes or (".svg", ".pdf", ".csv")))


def render(page: Page, home: Path, images: Images | InPlace | None = None) -> str:
    """Return the page as HTML; home: the folder it will lie in, for links to files.

    images: where its figures are written, or lie; without, they are in the page.
    """
    environment = Environment(
        loader=PackageLoader("signkin.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["address"] = lambda svg: (
        images.address(svg, home) if images else data_uri(svg)
    )
    environment.filters["size"] = size_of
    environment.filters["link"] = lambda path: Path(os.path.relpath(path, home)).as_posix()
    environment.filters["suffix"] = lambda path: Path(path).suffix.lstrip(".").upper()
    environment.filters["json"] = as_json
    environment.tests["figure"] = lambda view: isinstance(view, FigureView)
    environment.tests["plot"] = lambda view: isinstance(view, PlotView)
    environment.tests["numeric"] = lambda form: bool(form) and form not in WORDS
    environment.globals["cell"] = cell
    environment.globals["rows_of"] = rows_of
    environment.globals["shown_of"] = shown_of
    return environment.get_template("page.html.j2").render(page=page)


@dataclass(frozen=True)
class Shown:
    """A table as the page has it: the first rows written out, the others for its script."""

    first: Sequence[Mapping[str, Any]]
    notes: Sequence[str]
    more: Sequence[Sequence[str]]
    left_out: int

    @property
    def many(self) -> int:
        """Number of rows that the page has."""
        return len(self.first) + len(self.more)


def rows_of(view: TableView) -> list[dict[str, Any]]:
    """Return the rows of a table as dictionaries."""
    return [{str(k): v for k, v in row.items()} for row in view.frame.to_dict("records")]


def shown_of(view: TableView, most: int = MOST_LETTERS) -> Shown:
    """Return a table's rows as the page has them: no more than so many letters of them."""
    rows = rows_of(view)
    notes = notes_of(view.frame, view.shown)
    more = texts_of(rows[view.most :], view.shown, notes, view.keys)
    fit = first_that_fit(more, most)
    return Shown(rows[: view.most], notes, more[:fit], len(more) - fit)
