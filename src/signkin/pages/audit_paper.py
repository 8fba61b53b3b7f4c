"""The audit of a paper on its own printed numbers: a page to send, with CSV and JSON beside it."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import pandas as pd

import signkin
from signkin.audit.findings import CONSISTENT, INCONSISTENT
from signkin.audit.ledger import PRINT, Ledger
from signkin.audit.paper import Claim, Paper, read_paper
from signkin.errors import SignkinError
from signkin.pages.audit_samples import sample_views
from signkin.pages.ledger import run_ledger, told
from signkin.report.page import FigureView, Page, Section, TableView, render
from signkin.tables import write_table

COLUMNS = {  # what a telephone shows first comes first
    "check": "check",
    "item": "row",
    "verdict": "finding",
    "why": "why",
    "printed": "printed",
    "recomputed": "recomputed",
    "interval": "rounding allows",
    "nearest": "would be consistent",
    "severity": "severity",
    "settings": "with",
    "reads": "how it is read",
    "hand": "by hand",
}


def audit_papers(told_: argparse.Namespace) -> int:
    """Audit folders of papers: print the verdicts, write the pages.

    Returns 1 where the print of a paper contradicts itself, or some input cannot be used.
    """
    folders = [folder for given in told_.papers for folder in _folders(given)]
    parts: list[Ledger] = []
    papers: list[Paper] = []
    faults: list[str] = []
    for folder in folders:
        try:
            papers.append(read_paper(folder))
            parts.append(run_ledger([folder], told_.results))
            faults += parts[-1].faults
        except SignkinError as error:
            papers = papers[: len(parts)]
            faults.append(str(error))
    for fault in dict.fromkeys(faults):
        print(f"signkin: {fault}", file=sys.stderr)
    if not parts:
        return 1
    ledger = Ledger(
        pd.concat([part.claims for part in parts], ignore_index=True),
        pd.concat([part.checks for part in parts], ignore_index=True),
    )
    for frame, name, path in (
        (ledger.claims, "claims", told_.out), (ledger.checks, "checks", told_.checks)
    ):  # fmt: skip
        if path is not None:
            write_table(frame, path, name)
    many = len(papers) > 1
    to = told_.to or Path("audit" if many else f"audit-{papers[0].folder.resolve().name}")
    for paper, part in zip(papers, parts, strict=True):
        write_paper(paper, part, to / paper.folder.resolve().name if many else to)
    if many:
        _write(_summary(papers, parts, to), to)
    print(told(ledger))
    print(f"The page: {to / 'index.html'}")
    bad = (ledger.claims["evidence"] == PRINT) & (ledger.claims["verdict"] == INCONSISTENT)
    return int(bool(bad.any()) or bool(faults))


def _folders(given: Path) -> list[Path]:
    """Return a paper's folder, or those of a folder of papers."""
    if (given / "claims.yaml").is_file() or not given.is_dir():
        return [given]
    return sorted(p.parent for p in given.glob("*/claims.yaml")) or [given]


def write_paper(paper: Paper, ledger: Ledger, folder: Path) -> None:
    """Write a paper's page with claims.csv, checks.csv and audit.json into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    write_table(ledger.claims, folder / "claims.csv", "claims")
    write_table(ledger.checks, folder / "checks.csv", "checks")
    content = {
        "paper": paper.title,
        "signkin": signkin.__version__,
        "claims": ledger.claims.to_dict("records"),
        "checks": ledger.details.to_dict("records"),
        "faults": list(ledger.faults),
    }
    text = json.dumps(content, indent=1, ensure_ascii=False, default=str)
    (folder / "audit.json").write_text(text + "\n", encoding="utf-8")
    _write(paper_page(paper, ledger, folder), folder)


def _write(page: Page, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "index.html").write_text(render(page, folder), encoding="utf-8")


def paper_page(paper: Paper, ledger: Ledger, folder: Path) -> Page:
    """Return the page of a paper: verdicts, what is contradicted, every claim with its checks."""
    here = f"{paper.folder}/"  # a long path would make the page wider than a telephone
    ledger = replace(
        ledger,
        claims=ledger.claims.assign(note=ledger.claims["note"].str.replace(here, "", regex=False)),
        details=ledger.details.assign(why=ledger.details["why"].str.replace(here, "", regex=False)),
        faults=tuple(fault.replace(here, "") for fault in ledger.faults),
    )
    sections = [_verdicts(paper, ledger, folder), *_contradictions(paper, ledger)]
    sections += [_guide(), _claims(paper, ledger, folder)]
    if ledger.faults:
        sections.append(
            Section("faults", "What could not be used",
                    text=("Each of these is left out of the checks above.", *ledger.faults))
        )  # fmt: skip
    corpora = sorted(set(ledger.claims["evidence"]) - {PRINT})
    return Page(
        title=f"Audit of {paper.title}",
        lead=(
            "Can the printed numbers be right? Each check below recomputes a number from others "
            "that the paper prints, and lets every digit be what rounding, either way, allows.",
            *([f"Also tested on the corpora {', '.join(corpora)}."] if corpora else ()),
        ),
        sections=sections,
        version=signkin.__version__,
    )


def _verdicts(paper: Paper, ledger: Ledger, folder: Path) -> Section:
    claims = ledger.claims
    counts = claims[claims["evidence"] == PRINT]["verdict"].value_counts()
    checks = ledger.details[ledger.details["evidence"] == PRINT]
    done = checks[checks["verdict"].isin([CONSISTENT, INCONSISTENT])]
    by_check = done.groupby("check")["verdict"].value_counts().unstack(fill_value=0)
    told_checks = ", ".join(f"{name} ({int(row.sum())})" for name, row in by_check.iterrows())
    rows = claims.rename(columns={"note": "why"})  # notes would stand below the table
    columns = {"id": ("claim", ""), "verdict": ("verdict", "verdict"),
               "claim": ("what is claimed", ""), "location": ("place", ""),
               "why": ("why", "")}  # fmt: skip
    if rows["evidence"].nunique() > 1:
        columns = {"evidence": ("evidence", ""), **columns}
    return Section(
        "verdicts",
        "Verdicts",
        text=(
            f"{len(paper.claims)} claims: "
            + ", ".join(f"{n} {verdict}" for verdict, n in counts.items())
            + f". {len(done)} findings of {len(checks)} asked for could be decided"
            + (f": {told_checks}." if told_checks else "."),
        ),
        exhibits=(
            TableView(label="", title="all claims", caption="", frame=rows, columns=columns,
                      file=folder / "claims.csv", most=80),
        ),
    )  # fmt: skip


def _contradictions(paper: Paper, ledger: Ledger) -> list[Section]:
    claims = ledger.claims[ledger.claims["evidence"] == PRINT]
    accused = claims.loc[claims["verdict"] == INCONSISTENT, "id"]
    # What stands beside a claim, as another reading of it, contradicts nothing.
    found = ledger.details[
        (ledger.details["verdict"] == INCONSISTENT)
        & (ledger.details["evidence"] == PRINT)
        & ledger.details["id"].isin(accused)
        & (ledger.details["counts"] == "yes")
    ]
    if found.empty:
        text = ["No check finds two printed numbers that cannot both be right."]
        return [Section("contradictions", "Contradictions", text=text)]
    text = [
        "Numbers that cannot all be right as printed, whatever the rounding. Which of them is "
        "wrong, and why, the print does not tell: a slip in typing is as possible as one in the "
        "calculation.",
    ]
    for row in found.to_dict("records"):
        about = f"{row['id']}" + (f", {row['item']}" if row["item"] else "")
        line = f"{about} ({row['check']}): {row['why']}."
        line += f" Would be consistent: {row['nearest']}." if row["nearest"] else ""
        line += f" By hand: {row['hand']}." if row["hand"] else ""
        line += f" Severity: {row['severity']}." if row["severity"] else ""
        text.append(line)
    return [Section("contradictions", "Contradictions", text=text)]


def _guide() -> Section:
    return Section(
        "guide",
        "How to read the verdicts",
        text=(
            "A printed number stands for all values that round to it, ties either way: 0.303 is "
            "0.3025 to 0.3035. Recomputed is what a hand calculation with the printed digits "
            "gives; beside it stands what rounding allows.",
            "Consistent: the print allows the claim, which does not make it right. Inconsistent: "
            "no rounding does, nor any reading that the paper leaves open (SD or standard error, "
            "divisor n or n - 1, Student or Welch, one or two tails), where the check tries them. "
            "Not testable: a number is missing, or any would fit.",
            "Severity tells whether a decision (significant or not) changes, or digits only.",
        ),
    )


def _claims(paper: Paper, ledger: Ledger, folder: Path) -> Section:
    views: list[TableView | FigureView] = []
    for claim in paper.claims:
        rows = ledger.details[ledger.details["id"] == claim.id]
        views += [_claim(claim, rows, folder), *sample_views(claim.id, rows, folder)]
    return Section("claims", "Claim by claim", exhibits=views)


def _claim(claim: Claim, rows: pd.DataFrame, folder: Path) -> TableView:
    frame = rows.copy() if len(rows) else pd.DataFrame(
        [{"verdict": "not testable", "why": claim.published_missing}]
    )  # fmt: skip
    frame = frame.reindex(columns=["evidence", *COLUMNS]).astype(object).fillna("")
    several = frame["evidence"].nunique() > 1
    columns: Mapping[str, tuple[str, str]] = {
        name: (head, "verdict" if name == "verdict" else "")
        for name, head in {**({"evidence": "evidence"} if several else {}), **COLUMNS}.items()
        if frame[name].ne("").any()
    }
    printed = ", ".join(f"{name} {text}" for name, text in claim.printed.items())
    caption = f"{claim.location}." + (f" Printed: {printed}." if printed else "")
    return TableView(label=claim.id, title=claim.claim, caption=caption, frame=frame,
                     columns=columns, file=folder / "checks.csv", most=24)  # fmt: skip


def _summary(papers: Sequence[Paper], parts: Sequence[Ledger], folder: Path) -> Page:
    rows = []
    for paper, part in zip(papers, parts, strict=True):
        name = paper.folder.resolve().name
        print_ = part.claims[part.claims["evidence"] == PRINT]["verdict"].value_counts()
        rows.append({
            "paper": paper.title, "claims": len(paper.claims),
            **{v: int(print_.get(v, 0)) for v in ("consistent", "inconsistent", "not testable")},
            "faults": len(part.faults), "page": f"{name}/index.html",
        })  # fmt: skip
    columns = {"paper": ("paper", ""), "claims": ("claims", "d"), "consistent": ("consistent", "d"),
               "inconsistent": ("inconsistent", "d"), "not testable": ("not testable", "d"),
               "faults": ("could not be used", "d"), "page": ("page", "link")}  # fmt: skip
    view = TableView(label="", title="papers", caption="Claims by their verdict on print.",
                     frame=pd.DataFrame(rows), columns=columns, most=200)  # fmt: skip
    links = tuple(
        (paper.title, folder / paper.folder.resolve().name / "index.html") for paper in papers
    )
    return Page(
        title="Audit of papers",
        lead=("Each paper on its own printed numbers; the pages tell every check.",),
        sections=[Section("papers", "Papers", exhibits=(view,), links=links)],
        version=signkin.__version__,
    )
