"""The figures and tables of a paper that a study makes again: papers/<paper>/exhibits.yaml.

One list a study: rules declare the files of what stands in it, the study draws it, the report
shows it in its order. Each entry has

id: stem of its files (`fig04`: fig04.svg, fig04.pdf, fig04.csv).
label: as the paper counts it, `Figure 4` or `Table 1`.
title: what it shows.
group: which rule makes it.
table: for figures, the kind of table (`signkin.tables`) that the drawn numbers are.
differs: how this pipeline's version differs from the print.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from signkin import tables
from signkin.errors import SignkinError, listed
from signkin.yaml_file import read_yaml

FILE = "exhibits.yaml"
KINDS = ("figure", "table")
SUFFIXES = (".svg", ".pdf", ".csv")
_NEEDED = ("id", "label", "title", "group", "differs")
_KNOWN = (*_NEEDED, "table")


@dataclass(frozen=True)
class Exhibit:
    """A figure or table of the paper.

    stem: of its files. kind: figure or table. number: as printed, `4` or `A1`. group: which rule
    makes it. table: kind of table of a figure's numbers, empty for a table. differs: from print.
    """

    stem: str
    kind: str
    number: str
    title: str
    group: str
    table: str
    differs: str

    @property
    def label(self) -> str:
        """As the paper calls it: `Figure 4`."""
        return f"{self.kind.capitalize()} {self.number}"


def exhibits(paper: str | Path) -> tuple[Exhibit, ...]:
    """Return what the paper shows, in its order; paper: the folder papers/<paper>.

    Raises SignkinError where the list cannot be read, or an entry lacks or doubles something.
    """
    path = Path(paper) / FILE
    entries = read_yaml(path).get("exhibits")
    if not isinstance(entries, list) or not entries:
        raise SignkinError("no list of exhibits", file=path, expected="a list under `exhibits`")
    out: dict[str, Exhibit] = {}
    for number, entry in enumerate(entries, start=1):
        exhibit = _exhibit(entry, path, f"exhibit {number}")
        if exhibit.stem in out:
            raise SignkinError(
                f"the id {exhibit.stem} stands twice",
                file=path,
                place=f"exhibit {number}",
                expected="each id once",
            )
        out[exhibit.stem] = exhibit
    return tuple(out.values())


def _exhibit(entry: Any, path: Path, place: str) -> Exhibit:
    if not isinstance(entry, dict):
        raise SignkinError("no mapping", file=path, place=place, expected=f"keys {listed(_NEEDED)}")
    place = f"{place} ({entry['id']})" if entry.get("id") else place
    lacking = [key for key in _NEEDED if not str(entry.get(key) or "").strip()]
    unknown = [key for key in entry if key not in _KNOWN]
    if lacking or unknown:
        found = f"no {listed(lacking)}" if lacking else f"unknown key {listed(unknown)}"
        raise SignkinError(found, file=path, place=place, expected=f"keys {listed(_KNOWN)}")
    kind, _, number = str(entry["label"]).partition(" ")
    if kind.lower() not in KINDS or not number.strip():
        raise SignkinError(
            f"the label {entry['label']!r}",
            file=path,
            place=place,
            expected="Figure or Table and its number, e.g. Figure 4",
        )
    table = str(entry.get("table") or "")
    if table and table not in tables.TABLES:
        raise SignkinError(
            f"no kind of table {table!r}",
            file=path,
            place=place,
            expected="a name of docs/data-dictionary.md",
        )
    return Exhibit(
        stem=str(entry["id"]),
        kind=kind.lower(),
        number=number.strip(),
        title=str(entry["title"]).strip(),
        group=str(entry["group"]),
        table=table,
        differs=str(entry["differs"]).strip(),
    )


def of_groups(listing: Iterable[Exhibit], *groups: str) -> tuple[Exhibit, ...]:
    """Return the exhibits of some groups, group by group, each in the paper's order.

    A group without exhibits is an error: the rule that asks would make nothing.
    """
    listing = tuple(listing)
    for group in groups:
        if all(exhibit.group != group for exhibit in listing):
            known = listed(sorted({exhibit.group for exhibit in listing}))
            raise SignkinError(
                f"no exhibit of the group {group!r}", file=FILE, expected=f"one of {known}"
            )
    return tuple(e for group in groups for e in listing if e.group == group)


def files(listing: Iterable[Exhibit], folder: str) -> list[str]:
    """Return the files of figures as a rule declares them: drawings and numbers of each.

    folder: with wildcards, e.g. `<results>/naert2017/{corpus}`.
    """
    return [f"{folder}/{e.stem}{s}" for e in listing for s in SUFFIXES]
