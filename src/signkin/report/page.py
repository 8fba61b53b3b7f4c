"""The report: one self-contained HTML page from tables, figures and captions.

Tables and figures come in as data and files; nothing is computed here but counts
of rows. The page asks the network for nothing: styles and figures are in it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

WORDS = ("verdict", "link")  # formats of columns that hold text


@dataclass(frozen=True)
class TableView:
    """A table as it is shown: what is above it, the columns shown, the file with all of it.

    columns: column -> (heading, format); the format is empty for text, `verdict` for a verdict,
    `link` for files relative to the page, else as in `format()`.
    most: rows shown before the rest is folded away; the file has all.
    """

    label: str
    title: str
    caption: str
    frame: pd.DataFrame
    columns: Mapping[str, tuple[str, str]]
    file: Path | None = None
    differs: str = ""
    most: int = 24
    emphasis: str = ""  # a column whose value `yes` or `no` colours the row


@dataclass(frozen=True)
class FigureView:
    """A figure as it is shown, with its caption, its files and how it differs from the paper's."""

    label: str
    title: str
    caption: str
    svg: Path
    files: Sequence[Path] = ()
    differs: str = ""


@dataclass(frozen=True)
class Section:
    """A part of the page: text, then exhibits in order."""

    anchor: str
    title: str
    text: Sequence[str] = ()
    badge: str = ""  # `simulated`, `real` or nothing
    exhibits: Sequence[TableView | FigureView] = ()
    notices: Sequence[str] = ()
    links: Sequence[tuple[str, Path]] = ()


@dataclass(frozen=True)
class Page:
    """The whole page."""

    title: str
    lead: Sequence[str]
    sections: Sequence[Section]
    version: str
    missing: Mapping[str, str] = field(default_factory=dict)


def figure_files(base: Path, *suffixes: str) -> tuple[Path, ...]:
    """Return the files of a figure: SVG, PDF and the drawn data as CSV, or those asked for."""
    return tuple(base.with_suffix(s) for s in (suffixes or (".svg", ".pdf", ".csv")))


def render(page: Page, home: Path) -> str:
    """Return the page as HTML; home: the folder it will lie in, for links to files."""
    environment = Environment(
        loader=PackageLoader("signkin.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["data_uri"] = data_uri
    environment.filters["link"] = lambda path: Path(os.path.relpath(path, home)).as_posix()
    environment.filters["suffix"] = lambda path: Path(path).suffix.lstrip(".").upper()
    environment.tests["figure"] = lambda view: isinstance(view, FigureView)
    environment.tests["numeric"] = lambda form: bool(form) and form not in WORDS
    environment.globals["cell"] = cell
    environment.globals["rows_of"] = rows_of
    environment.globals["notes_of"] = notes_of
    return environment.get_template("page.html.j2").render(page=page)


def data_uri(svg: Path) -> Markup:
    """Return an SVG file as a data address, so that identifiers of figures cannot clash."""
    content = lighter(Path(svg).read_text(encoding="utf-8"))
    for sign in '%#"&\n':  # the only ones that an address between double quotes cannot hold
        content = content.replace(sign, f"%{ord(sign):02X}")
    return Markup(f"data:image/svg+xml,{content}")


_PLACES = re.compile(r'(?<= )(d|x|y)="([^"]*)"')
_LONG = re.compile(r"-?\d+\.\d{3,}")


def lighter(svg: str) -> str:
    """Return an SVG with places to a hundredth of its unit, a point as matplotlib writes it.

    The page holds all figures; their files keep every digit.
    """

    def rounded(number: re.Match[str]) -> str:
        return f"{float(number[0]):.2f}".rstrip("0").rstrip(".")

    def shorter(found: re.Match[str]) -> str:
        places = _LONG.sub(rounded, " ".join(found[2].split()))
        return f"{found[1]}='{places}'"

    body = svg[max(svg.find("<svg"), 0) :]  # an image in a page needs no prologue
    body = re.sub(r"<!--.*?-->|<metadata>.*?</metadata>", "", body, flags=re.DOTALL)
    body = re.sub(r">\s+<", "><", _PLACES.sub(shorter, body).strip())
    # Single quotes stay as they are in the page, double ones would take three letters each.
    return body if re.search(r'="[^"\']*\'', body) else body.replace('"', "'")


def rows_of(view: TableView) -> list[dict[str, Any]]:
    """Return the rows of a table as dictionaries."""
    return view.frame.to_dict("records")


MOST_NOTES = 20  # more of them stay in their rows


def notes_of(view: TableView) -> list[str]:
    """Return the different notes of a table, which stand below it with numbers; none if many.

    A column of sentences would make the rows of all others tall.
    """
    if "note" not in view.columns:
        return []
    notes = [str(note) for note in dict.fromkeys(view.frame["note"]) if note and pd.notna(note)]
    return notes if len(notes) <= MOST_NOTES else []


def cell(value: object, form: str) -> str:
    """Return a value as it is printed; what is missing is a dash."""
    if value is None or (isinstance(value, float) and pd.isna(value)) or value == "":
        return "–"
    if not form or form in WORDS or isinstance(value, str):
        return str(value)
    # A column of counts with gaps comes as floats.
    return format(int(value) if form == "d" else value, form)  # type: ignore[call-overload]
