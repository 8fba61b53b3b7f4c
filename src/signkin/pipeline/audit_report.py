"""What the pages show of the audit: the ledger, every claim with its checks, the curves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import pandas as pd

import signkin
from signkin.audit.ledger import PRINT
from signkin.audit.paper import Claim, Curve, Paper
from signkin.report.page import FigureView, Page, Section, TableView
from signkin.tables import read_table

VERDICTS = ("consistent", "holds", "inconsistent", "fails", "not testable")
NOTHING = "not testable"


def audit_page(
    papers: Sequence[Paper], claims: pd.DataFrame, checks: pd.DataFrame, folder: Path
) -> Page:
    """Return the page of the audit; folder: results/audit, with its tables and `curves`."""
    sections = [_guide(), _overview(papers, claims, folder)]
    for paper in papers:
        sections.append(_claims(paper, claims, checks, folder))
    curves = list(_curves(papers, folder / "curves"))
    if curves:
        sections.append(_rest_on(curves))
    return Page(
        title="Audit: can the printed numbers be right, and do they hold on other data?",
        lead=(
            "Every quantitative claim of the papers, tested on the numbers that the papers print "
            "and on every corpus of this run. Each verdict can be rechecked: the reading of the "
            "claim, the number recomputed, and the table behind it stand beside it.",
        ),
        sections=sections,
        version=signkin.__version__,
    )


def audit_section(results: Path) -> Section:
    """Return what the main report tells of the audit."""
    audit = results / "audit"
    claims = read_table(audit / "claims.csv", "claims")
    bad = claims[(claims["evidence"] == PRINT) & (claims["verdict"] == "inconsistent")]
    text = [
        f"{claims['id'].nunique()} claims of {claims['paper'].nunique()} papers, each on the "
        "printed numbers and on every corpus. On printed numbers a claim is consistent (it can be "
        "right) or inconsistent; on a corpus it holds or fails.",
    ]
    text += [f"Inconsistent on its own numbers: {row.id}. {row.note}." for row in bad.itertuples()]
    return Section(
        "audit",
        "The audit of the claims",
        text=text,
        exhibits=(_counts(claims, audit / "claims.csv"),),
        links=(("All claims, their checks and what they rest on", audit / "index.html"),),
    )


def _guide() -> Section:
    return Section(
        "guide",
        "How to read the verdicts",
        text=(
            "Published numbers. A printed number stands for an interval: 0.303 is anything that "
            "rounds to it. What follows from such numbers is an interval, too. Consistent: the "
            "print allows the claim (it can be right, which does not make it so). Inconsistent: no "
            "rounding does. Ties may have been rounded either way, so that nothing is accused that "
            "a usual rule allows.",
            "Corpora. A claim about signing is tested on other signers, in other languages and "
            "with other cameras; holds and fails tell whether it is so there, not whether the "
            "paper was right about its own recordings. A simulated corpus was made to carry the "
            "paper's printed numbers: it tests whether the programs find them, and is no evidence "
            "about people.",
            "Not testable: a number, a table or a definition is missing; the note says which. "
            "Where a claim's words leave room ('near', 'visibly'), the reading beside each check "
            "says how they were taken.",
        ),
    )


def _heading(evidence: str, kind: str) -> str:
    return evidence if kind == PRINT else f"{evidence} ({kind})"


def _overview(papers: Sequence[Paper], claims: pd.DataFrame, folder: Path) -> Section:
    views: list[TableView | FigureView] = []
    notices = []
    for paper in papers:
        rows = claims[claims["paper"] == paper.folder.name]
        kinds = rows.drop_duplicates("evidence").set_index("evidence")["evidence_kind"]
        tested = rows[rows["verdict"] != NOTHING]["evidence"].unique()
        shown = [e for e in kinds.index if e in tested]
        silent = [e for e in kinds.index if e not in tested]
        if silent:
            notices.append(
                f"{paper.title}: no claim can be tested on {', '.join(silent)}: the tables that "
                "the claims need are not there."
            )
        wide = rows.pivot(index="id", columns="evidence", values="verdict").reset_index()
        first = rows.drop_duplicates("id").set_index("id")
        for column in ("claim", "location", "printed"):
            wide[column] = wide["id"].map(first[column])
        order = {claim.id: i for i, claim in enumerate(paper.claims)}
        wide = wide.sort_values("id", key=lambda s, order=order: s.map(order))
        columns = {"id": ("claim", ""), "claim": ("what is claimed", ""), "location": ("place", "")}
        columns |= {e: (_heading(e, kinds[e]), "verdict") for e in shown}
        counts = rows[rows["evidence"] == PRINT]["verdict"].value_counts()
        told = ", ".join(f"{counts[v]} {v}" for v in VERDICTS if v in counts)
        views.append(
            TableView(
                label=paper.title,
                title="all claims",
                caption=f"On the printed numbers: {told}.",
                frame=wide,
                columns=columns,
                file=folder / "claims.csv",
                most=60,
            )
        )
    views.append(_counts(claims, folder / "claims.csv"))
    return Section("verdicts", "Verdicts", exhibits=views, notices=notices)


def _counts(claims: pd.DataFrame, file: Path) -> TableView:
    table = pd.crosstab([claims["paper"], claims["evidence"]], claims["verdict"])
    pairs = claims[["paper", "evidence", "evidence_kind"]].drop_duplicates()
    rows = []
    for pair in pairs.itertuples(index=False):
        counts = table.loc[(pair.paper, pair.evidence)]
        about = {"paper": pair.paper, "evidence": _heading(pair.evidence, pair.evidence_kind)}
        rows.append({**about, **{v: int(counts.get(v, 0)) for v in VERDICTS}})
    columns = {"paper": ("paper", ""), "evidence": ("evidence", "")}
    columns |= {v: (v, "d") for v in VERDICTS}
    return TableView(
        label="",
        title="How many claims have which verdict",
        caption="Claims by evidence. Simulated: a test of the method, no evidence about people.",
        frame=pd.DataFrame(rows),
        columns=columns,
        file=file,
    )


def _claims(paper: Paper, claims: pd.DataFrame, checks: pd.DataFrame, folder: Path) -> Section:
    of_claims = claims[claims["paper"] == paper.folder.name]
    of_checks = checks[checks["paper"] == paper.folder.name]
    tested = of_claims[of_claims["verdict"] != NOTHING]["evidence"].unique()
    views = [
        _claim(claim, of_claims[of_claims["id"] == claim.id],
               of_checks[of_checks["id"] == claim.id], tested, folder)
        for claim in paper.claims
    ]  # fmt: skip
    return Section(
        paper.folder.name,
        f"{paper.title}, claim by claim",
        text=(
            "For each claim its checks: how the claim is read, the number recomputed with what "
            "rounding allows (on corpora: 95 % by bootstrap), and why the verdict is what it is.",
        ),
        exhibits=views,
    )


def _claim(
    claim: Claim, verdicts: pd.DataFrame, checks: pd.DataFrame, tested: Sequence[str], folder: Path
) -> TableView:
    rows = []
    for verdict in verdicts.itertuples(index=False):
        if verdict.evidence != PRINT and verdict.evidence not in tested:
            continue
        heading = _heading(str(verdict.evidence), str(verdict.evidence_kind))
        found = checks[checks["evidence"] == verdict.evidence]
        if found.empty:
            rows.append({"evidence": heading, "verdict": NOTHING, "why": verdict.note})
            continue
        for i, row in enumerate(found.to_dict("records")):
            rows.append({**row, "evidence": heading if i == 0 else "", "reads": row["reads"]})
    frame = pd.DataFrame(
        rows, columns=["evidence", "item", "reads", "recomputed", "interval", "verdict", "why",
                       "source"],
    ).fillna("")  # fmt: skip
    # A reading is told once for the rows of one check.
    frame.loc[frame["reads"].eq(frame["reads"].shift()) & frame["evidence"].eq(""), "reads"] = ""
    frame["source"] = frame["source"].map(_relative)
    columns = {
        "evidence": ("evidence", ""),
        "item": ("row", ""),
        "reads": ("how it is read", ""),
        "recomputed": ("recomputed", ""),
        "interval": ("may be", ""),
        "verdict": ("finding", "verdict"),
        "why": ("why", ""),
        "source": ("table", "link"),
    }
    for optional in ("item", "recomputed", "interval", "source"):
        if not frame[optional].ne("").any():
            del columns[optional]
    printed = ", ".join(f"{name} {text}" for name, text in claim.printed.items())
    caption = f"Section {claim.location}." if claim.location[0].isdigit() else f"{claim.location}."
    caption += f" Printed: {printed}." if printed else ""
    caption += f" A corpus needs: {claim.needs}."
    return TableView(
        label=claim.id,
        title=claim.claim,
        caption=caption,
        frame=frame,
        columns=columns,
        file=folder / "checks.csv",
        most=9,
    )


def _relative(source: str) -> str:
    """Return a result table's address as seen from results/audit; other files have none."""
    return source.replace("results/", "../", 1) if source.startswith("results/") else ""


def _curves(papers: Sequence[Paper], folder: Path) -> Iterator[tuple[Paper, Curve, Path]]:
    for paper in papers:
        for curve in paper.curves:
            base = folder / f"{paper.folder.name}_{curve.claim}"
            if base.with_suffix(".svg").is_file():
                yield paper, curve, base


def _rest_on(curves: Sequence[tuple[Paper, Curve, Path]]) -> Section:
    views: list[TableView | FigureView] = []
    for paper, curve, base in curves:
        levels_file = base.with_name(f"{base.name}_levels.csv")
        levels = read_table(levels_file, "specifications")
        whole = levels[levels["choice"] == "all"]
        told = "; ".join(
            f"{row.corpus}: holds in {row.holding} of {row.specifications} ({row.share:.0%}), "
            f"{row.note}"
            for row in whole.itertuples()
        )
        claim = next(c for c in paper.claims if c.id == curve.claim)
        views.append(
            FigureView(
                label=curve.claim,
                title=claim.claim,
                caption=f"{curve.reads} Above: the estimates of all specifications in order, "
                "filled where the claim holds; below: the choices of each. "
                f"{told}.",
                svg=base.with_suffix(".svg"),
                files=[base.with_suffix(s) for s in (".svg", ".pdf", ".csv")],
            )
        )
        views.append(
            TableView(
                label="",
                title=f"{curve.claim}: by choice",
                caption="In which share of the specifications with a level the claim holds. The "
                "last column: how much of the variance of holds (yes or no) lies between the "
                "levels of a choice; the largest decides.",
                frame=levels,
                columns={
                    "corpus": ("corpus", ""),
                    "choice": ("choice", ""),
                    "level": ("level", ""),
                    "specifications": ("specifications", "d"),
                    "holding": ("holding", "d"),
                    "share": ("share", ".2f"),
                    "median_estimate": ("median estimate", ".3g"),
                    "share_decided": ("decides", ".2f"),
                },
                file=levels_file,
                most=0,
            )
        )
    return Section(
        "rest-on",
        "What the claims rest on",
        text=(
            "Some claims hang on choices that the paper leaves open. Here every combination of the "
            "choices in config.yaml (multiverse) is run: in which share of them does the claim "
            "hold, and which choice decides?",
        ),
        exhibits=views,
    )
