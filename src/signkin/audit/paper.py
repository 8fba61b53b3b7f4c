"""A paper's folder: claims.yaml and the printed tables beside it, all digits as text."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from signkin.audit.claims_file import GUIDE, MOST_BYTES, read_claims
from signkin.errors import SignkinError, listed
from signkin.text_file import text_of

PRINT_ALONE = "it is about the paper's own data"
OWN = (
    "check",
    "reads",
    "decisive",
    "only",
    "gate",
    "beside",
)  # keys of a check that are no arguments of it


@dataclass(frozen=True)
class PrintedRow:
    """A row of a printed table, as text, and the line it stands in."""

    cells: Mapping[str, str]
    file: Path
    line: int

    def __getitem__(self, column: str) -> str:
        """Return a cell; an unknown column is an error."""
        if column not in self.cells:
            raise SignkinError(
                f"no column {column!r}",
                file=self.file,
                place="line 1",
                expected=listed(self.cells, 30),
            )
        return self.cells[column]

    @property
    def place(self) -> str:
        """`line 3`."""
        return f"line {self.line}"


@dataclass(frozen=True)
class Check:
    """A check as a claim asks for it: its name, its arguments, how the claim is read."""

    name: str
    arguments: Mapping[str, Any]
    reads: str
    decisive: bool
    only: str  # `simulated` or `real`: corpora it can be run on; empty for all
    gate: bool  # without it the claim cannot be tested
    beside: bool  # told with the claim, without a say in its verdict
    line: int


@dataclass(frozen=True)
class Claim:
    """A claim of a paper, and how it is tested on print and on corpora."""

    id: str
    location: str
    claim: str
    printed: Mapping[str, str]
    published: tuple[Check, ...]
    published_missing: str
    corpora: tuple[Check, ...]
    corpora_missing: str
    needs: str
    line: int
    made_with_print: tuple[str, ...] = ()  # corpora made with the printed numbers; or `all`
    made_why: str = ""


@dataclass(frozen=True)
class Curve:
    """A specification curve: which table has a claim's specifications, and its columns."""

    claim: str
    table: str
    choices: Mapping[str, str]
    estimate: str
    label: str
    reads: str
    where: str
    reference: str
    holds: str
    line: int
    keeps: str = ""  # the specifications that keep all that is printed
    checks: tuple[int, ...] | None = None  # of the claim, that it speaks of; None: all
    each: str = ""  # a choice that is none: the claim is about each of its levels
    fails: str = ""  # where it fails; what neither holds nor fails is undecided


@dataclass(frozen=True)
class Reading:
    """What is printed where a rule of ours adds to it: the same checks on other tables.

    adds: the rule, as config.yaml has it. printed: what stands there instead. claims: those
    that the rule can move. tables: table -> the one that was made without the rule. where: its
    rows. ours: the rows made with the rule from the same recordings, so that both readings have
    the same n. checks: of the claim (from 1), which then count even if they stand beside it.
    """

    name: str
    adds: str
    printed: str
    claims: tuple[str, ...]
    tables: Mapping[str, str]
    where: str
    ours: str
    line: int
    checks: tuple[int, ...] | None = None


@dataclass(frozen=True)
class Paper:
    """A paper with its claims.

    study: the folder of its results, `results/<study>`; without one the print alone is audited.
    """

    folder: Path
    title: str
    study: str
    claims: tuple[Claim, ...]
    curves: tuple[Curve, ...]
    tables: dict[str, list[PrintedRow]] = field(default_factory=dict)
    faults: tuple[SignkinError, ...] = ()  # claims that cannot be used, and are left out
    readings: tuple[Reading, ...] = ()  # without what our rules add to the print

    @property
    def file(self) -> Path:
        """The file claims.yaml."""
        return self.folder / "claims.yaml"

    def table(self, name: str) -> list[PrintedRow]:
        """Return the rows of a printed table of the paper."""
        if name not in self.tables:
            self.tables[name] = list(_rows(self.folder / name, self.folder))
        return self.tables[name]

    def printed(self) -> dict[str, str]:
        """Return every printed number by `claim.name`."""
        return {f"{c.id}.{name}": text for c in self.claims for name, text in c.printed.items()}


def _rows(path: Path, folder: Path) -> Iterator[PrintedRow]:
    if not path.is_file():
        there = sorted(p.name for p in folder.glob("*.csv"))
        raise SignkinError(f"there is no table {path.name}", expected=listed(there))
    reader = csv.DictReader(text_of(path, MOST_BYTES).splitlines(), strict=True)
    try:
        header = reader.fieldnames or ()
        doubled = sorted({name for name in header if list(header).count(name) > 1})
        if doubled or not any(name.strip() for name in header):
            raise SignkinError(
                f"the columns {listed(doubled)} stand there twice" if doubled
                else "there is no header", file=path, place="line 1",
                expected="a header with each column once",
                todo="A merged header wants a name for each of its columns.",
            )  # fmt: skip
        for cells in reader:
            if None in cells or None in cells.values():
                raise SignkinError(
                    "the row has more or fewer cells than the header",
                    file=path,
                    place=f"line {reader.line_num}",
                    expected=listed(header),
                    todo="A decimal comma wants a point.",
                )
            yield PrintedRow(cells, path, reader.line_num)
    except csv.Error as error:
        raise SignkinError(
            str(error), file=path, place=f"line {reader.line_num}", expected="a table in CSV"
        ) from None


def read_paper(folder: str | Path) -> Paper:
    """Read and check a folder `papers/<paper>`; the error names the line of claims.yaml."""
    folder = Path(folder)
    path = folder / "claims.yaml"
    if not folder.is_dir():
        raise SignkinError(
            f"there is no folder {folder}", expected="a paper: claims.yaml and its tables",
            todo=GUIDE,
        )  # fmt: skip
    if not path.is_file():
        raise SignkinError("there is no claims.yaml", file=folder, todo=GUIDE)
    file = read_claims(path)
    content, lines = file.content, file.lines
    claims = tuple(_claims(content, lines, file.numbers))
    seen = {claim.id: claim.line for claim in claims}
    curves = tuple(
        Curve(
            claim=c["claim"], table=c["table"], choices=c["choices"], estimate=c["estimate"],
            label=c["label"], reads=c["reads"], where=c.get("where", ""),
            reference=c.get("reference", ""), holds=c.get("holds", ""),
            line=lines[("specification_curves", i)], keeps=c.get("keeps", ""),
            fails=c.get("fails", ""),
            checks=tuple(c["checks"]) if "checks" in c else None, each=c.get("each", ""),
        )
        for i, c in enumerate(content.get("specification_curves", []))
    )  # fmt: skip
    for curve in curves:
        if curve.claim not in seen and not file.faults:
            raise SignkinError(
                f"the curve's claim {curve.claim} is not a claim of the paper",
                file=path,
                place=f"line {curve.line}",
                expected=listed(seen, 40),
            )
    curves = tuple(curve for curve in curves if curve.claim in seen)
    sizes = {claim.id: len(claim.corpora) for claim in claims}
    for curve in curves:
        if max(curve.checks or (0,)) > sizes[curve.claim]:
            raise SignkinError(
                f"the curve of {curve.claim} speaks of check {max(curve.checks or (0,))}",
                file=path, place=f"line {curve.line}",
                expected=f"1 to {sizes[curve.claim]}, the claim's checks on corpora",
            )  # fmt: skip
    readings = tuple(_readings(content, lines, path, {} if file.faults else sizes))
    return Paper(folder, content["paper"], content.get("study", ""), claims, curves,
                 faults=tuple(file.faults), readings=readings)  # fmt: skip


def _readings(
    content: Mapping[str, Any], lines: Mapping[tuple[Any, ...], int], path: Path,
    sizes: Mapping[str, int],
) -> Iterator[Reading]:  # fmt: skip
    """Yield the readings as printed. sizes: claim -> its checks on corpora; empty: any claim."""
    for i, r in enumerate(content.get("readings", [])):
        line = lines[("readings", i)]
        for claim in r["claims"] if sizes else ():
            highest = max(r.get("checks", (0,)))
            if claim not in sizes or highest > sizes[claim]:
                found = f"check {highest} of claim {claim}" if claim in sizes else f"claim {claim}"
                raise SignkinError(
                    f"the reading {r['name']!r} speaks of {found}, which is not there",
                    file=path, place=f"line {line}", expected=listed(sizes, 40),
                )  # fmt: skip
        yield Reading(
            name=r["name"], adds=r["adds"], printed=r["printed"], claims=tuple(r["claims"]),
            tables=r["tables"], where=r["where"], ours=r.get("ours", ""), line=line,
            checks=tuple(r["checks"]) if "checks" in r else None,
        )  # fmt: skip


def _claims(
    content: Mapping[str, Any], lines: Mapping[tuple[Any, ...], int], numbers: Sequence[int]
) -> Iterator[Claim]:
    for i, claim in zip(numbers, content["claims"], strict=True):
        checks = {}
        for side in ("published", "corpora"):
            checks[side] = tuple(
                Check(
                    name=c["check"],
                    arguments={k: v for k, v in c.items() if k not in OWN},
                    reads=c.get("reads", ""),
                    decisive=c.get("decisive", True),
                    only=c.get("only", ""),
                    gate=c.get("gate", False),
                    beside=c.get("beside", False),
                    line=lines[("claims", i, side, "checks", j)],
                )
                for j, c in enumerate(claim.get(side, {}).get("checks", []))
            )
        yield Claim(
            id=claim["id"],
            location=str(claim["location"]),
            claim=claim["claim"],
            printed=claim.get("printed", {}),
            published=checks["published"],
            published_missing=claim["published"].get("missing", ""),
            corpora=checks["corpora"],
            corpora_missing=claim.get("corpora", {}).get("missing", PRINT_ALONE),
            needs=claim.get("needs", ""),
            line=lines[("claims", i)],
            made_with_print=tuple(claim.get("by_construction", {}).get("corpora", ())),
            made_why=claim.get("by_construction", {}).get("why", ""),
        )
