"""What the pages show of the audit: the ledger, every claim with its checks, the curves."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import pandas as pd

import signkin
from signkin.audit.findings import INCONSISTENT
from signkin.audit.ledger import PRINT, SIMULATED
from signkin.audit.paper import Claim, Curve, Paper
from signkin.pages import readings
from signkin.report.page import FigureView, Page, Section, TableView
from signkin.studies.one_wrist.report import two_papers
from signkin.tables import read_table

VERDICTS = ("consistent", "holds", "inconsistent", "fails", "undecided", "depends",
            "by construction", "not testable")  # fmt: skip
NOTHING = "not testable"


def audit_page(
    papers: Sequence[Paper],
    claims: pd.DataFrame,
    checks: pd.DataFrame,
    wrists: Mapping[str, Path],
    folder: Path,
) -> Page:
    """Return the page of the audit; folder: results/audit, with its tables and `curves`.

    wrists: corpus -> its table `one_wrist`, with both papers' cuts.
    """
    papers = sorted(papers, key=lambda paper: not paper.study)  # those on print alone come last
    sections = [_guide(), _overview(papers, claims, folder)]
    for paper in papers:
        sections.append(_claims(paper, claims, checks, folder))
    kinds = dict(zip(claims["evidence"], claims["evidence_kind"] == SIMULATED, strict=True))
    if both := two_papers(wrists, kinds):
        sections.append(both)
    curves = list(_curves(papers, folder / "curves"))
    if curves:
        sections.append(_rest_on(curves, readings.views(papers, folder / "curves")))
    return Page(
        title="Audit: can the printed numbers be right, and do they hold on other data?",
        lead=(
            "Every quantitative claim of the papers, tested on the numbers that the papers print "
            "and on every corpus of this run. Each verdict can be rechecked: the reading of the "
            "claim, the number recomputed, and the table behind it stand beside it.",
        ),
        sections=sections,
        version=signkin.__version__,
        site=(
            ("Front page", folder.parent / "report" / "index.html"),
            ("Audit", folder / "index.html"),
        ),
        here="Audit",
        docs=docs if (docs := folder.parents[1] / "docs").is_dir() else None,
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
            "Undecided: the data allow both; the interval of the difference holds 0, or a peak is "
            "not sure to be where it is claimed. Depends: readings that keep all that is printed, "
            "or what is meant by chance, decide; the note tells how many say what. By "
            "construction: the data were made with the printed number, so that agreement is none.",
            "Not testable: a number, a table or a definition is missing; the note says which. "
            "Where a claim's words leave room ('near', 'visibly'), the reading beside each check "
            "says how they were taken.",
            "Beside a claim stand findings without a say in its verdict: cross-checks that no "
            "paper claims, and rules that our own programs keep, which cannot confirm anything.",
        ),
    )


def _heading(evidence: str, kind: str) -> str:
    return evidence if kind == PRINT else f"{evidence} ({kind})"


def _overview(papers: Sequence[Paper], claims: pd.DataFrame, folder: Path) -> Section:
    views: list[TableView | FigureView] = []
    silent_in = []
    for paper in papers:
        rows = claims[claims["paper"] == paper.folder.name]
        kinds = rows.drop_duplicates("evidence").set_index("evidence")["evidence_kind"]
        tested = rows[rows["verdict"] != NOTHING]["evidence"].unique()
        shown = [e for e in kinds.index if e in tested]
        silent = [e for e in kinds.index if e not in tested]
        if silent:
            silent_in.append(
                f"No claim of {paper.title} can be tested on {', '.join(silent)}: these have none "
                "of the tables that the claims need, and no column here."
            )
        wide = rows.pivot(index="id", columns="evidence", values="verdict").reset_index()
        first = rows.drop_duplicates("id").set_index("id")
        for column in ("claim", "location", "printed"):
            wide[column] = wide["id"].map(first[column])
        order = {claim.id: i for i, claim in enumerate(paper.claims)}
        wide = wide.sort_values("id", key=lambda s, order=order: s.map(order))
        columns = {"id": ("claim", ""), "claim": ("what is claimed", ""), "location": ("place", "")}
        columns |= {e: (_heading(e, kinds[e]), "verdict") for e in shown}
        views.append(
            TableView(
                label=paper.title,
                title="all claims",
                caption=f"On the printed numbers: {_told(rows)}.",
                frame=wide,
                columns=columns,
                file=folder / "claims.csv",
                most=60,
            )
        )
    views.append(_counts(claims, folder / "claims.csv"))
    return Section("verdicts", "Verdicts", text=silent_in, exhibits=views)


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
        folded=True,
    )


def _claims(paper: Paper, claims: pd.DataFrame, checks: pd.DataFrame, folder: Path) -> Section:
    of_claims = claims[claims["paper"] == paper.folder.name]
    of_checks = checks[checks["paper"] == paper.folder.name]
    tested = of_claims[of_claims["verdict"] != NOTHING]["evidence"].unique()
    views: list[TableView | FigureView] = []
    accused = of_claims[(of_claims["evidence"] == PRINT) & (of_claims["verdict"] == INCONSISTENT)]
    bad = set(accused["id"])
    for claim in sorted(paper.claims, key=lambda claim: claim.id not in bad):
        found = of_checks[of_checks["id"] == claim.id]
        verdicts = of_claims[of_claims["id"] == claim.id]
        view = _claim(claim, verdicts, found, tested, folder)
        rows = tuple(_rows(claim, found, folder))
        folded = replace(view, folded=True, opened=claim.id in bad, verdicts=brief(verdicts))
        views.append(replace(folded, inner=rows))
    first = " What is inconsistent stands first, and open." if bad else ""
    return Section(
        paper.folder.name,
        f"{paper.title}, claim by claim",
        text=(
            "For each claim its checks: how the claim is read, the number recomputed with what "
            "rounding allows (on corpora: 95 % by bootstrap, where it is an estimate), and why the "
            "finding is what it is.",
            f"On the printed numbers: {_told(of_claims)}.{first}",
        ),
        exhibits=views,
    )


def _told(claims: pd.DataFrame) -> str:
    """Return how many of a paper's claims have which verdict on print."""
    counts = claims[claims["evidence"] == PRINT]["verdict"].value_counts()
    return ", ".join(f"{counts[v]} {v}" for v in VERDICTS if v in counts)


def brief(verdicts: pd.DataFrame) -> list[tuple[str, str]]:
    """Return a claim's verdicts, each with the evidence that it was come to on.

    verdicts: the claim's rows of the table `claims`. What is not testable is told where nothing is.
    """
    decided = verdicts[verdicts["verdict"] != NOTHING]
    if decided.empty:
        return [("", NOTHING)]
    print_first = decided.sort_values("evidence", key=lambda e: e != PRINT, kind="stable")
    return [
        (", ".join(rows["evidence"]), str(verdict))
        for verdict, rows in print_first.groupby("verdict", sort=False)
    ]


FEW = 3  # findings of one check that are told one by one
COLUMNS = {
    "evidence": ("evidence", ""),
    "item": ("row", ""),
    "reads": ("how it is read", ""),
    "counts": ("in the verdict", ""),
    "printed": ("printed", ""),
    "recomputed": ("recomputed", ""),
    "interval": ("interval", ""),
    "verdict": ("finding", "verdict"),
    "why": ("why", ""),
    "source": ("table", "link"),
}


def _claim(
    claim: Claim, verdicts: pd.DataFrame, checks: pd.DataFrame, tested: Sequence[str], folder: Path
) -> TableView:
    """Return a claim's checks, one row each; of checks of many rows, how many are so."""
    rows = []
    for verdict in verdicts.itertuples(index=False):
        if verdict.evidence != PRINT and verdict.evidence not in tested:
            continue
        about = {"evidence": _heading(str(verdict.evidence), str(verdict.evidence_kind))}
        found = checks[checks["evidence"] == verdict.evidence]
        if (found["counts"] != "yes").all():  # none, or none that counts
            rows.append({**about, "verdict": NOTHING, "why": verdict.note, "counts": ""})
        for _, part in found.groupby((found["reads"] != found["reads"].shift()).cumsum()):
            if len(part) <= FEW:
                rows += [{**row, **about} for row in part.to_dict("records")]
            else:
                rows.append({**part.iloc[0].to_dict(), **about, **_many(part)})
    rows = _by_reading(rows)
    if all(row["counts"] in ("", "yes") for row in rows):
        rows = [{**row, "counts": ""} for row in rows]
    columns = {name: head for name, head in COLUMNS.items() if name != "printed"}
    caption = f"Section {claim.location}." if claim.location[0].isdigit() else f"{claim.location}."
    printed = ", ".join(f"{name} {text}" for name, text in claim.printed.items())
    caption += f" Printed: {printed}." if printed else ""
    caption += f" A corpus needs: {claim.needs}." if claim.needs else ""
    return _view(claim.id, claim.claim, caption, rows, columns, folder)


def _by_reading(rows: Sequence[Mapping[str, object]]) -> list[dict[str, object]]:
    """Return the rows check by check, what is not testable first; a reading is told once."""
    readings = list(dict.fromkeys(str(row.get("reads", "")) for row in rows))
    readings.sort(key=bool)  # those without one first
    out: list[dict[str, object]] = []
    for reading in readings:
        same = [dict(row) for row in rows if str(row.get("reads", "")) == reading]
        out += [same[0], *({**row, "reads": "as above"} if reading else row for row in same[1:])]
    return out


def _many(part: pd.DataFrame) -> dict[str, str]:
    counts = part["verdict"].value_counts()
    bad = [v for v in ("inconsistent", "fails", "depends", "undecided") if v in counts]
    best = bad[0] if bad else str(counts.index[0])
    told = ", ".join(f"{n} {verdict}" for verdict, n in counts.items())
    others = part[part["verdict"] != counts.index[0]]
    why = [f"{row.item}: {row.why}" for row in others.itertuples()]
    return {
        "item": f"{len(part)} rows",
        "recomputed": "",
        "interval": "",
        "verdict": best,
        "why": "; ".join([f"{told} (below, row by row)", *why]),
    }


def _rows(claim: Claim, checks: pd.DataFrame, folder: Path) -> Iterator[TableView]:
    """Yield the findings of checks of many rows, row by row."""
    published = checks[checks["evidence"] == PRINT]
    for check, part in published.groupby("check", sort=False):
        if len(part) > FEW:
            names = ("item", "printed", "recomputed", "interval", "verdict", "why")
            yield _view(
                "", f"{claim.id}, row by row: {check}", str(part["reads"].iloc[0]),
                part.to_dict("records"), {name: COLUMNS[name] for name in names}, folder, FEW,
            )  # fmt: skip


def _view(
    label: str,
    title: str,
    caption: str,
    rows: Sequence[Mapping[str, object]],
    columns: Mapping[str, tuple[str, str]],
    folder: Path,
    most: int = 12,
) -> TableView:
    frame = pd.DataFrame(rows, columns=list(COLUMNS)).fillna("")
    frame["source"] = frame["source"].map(_address)
    kept = {
        name: head
        for name, head in columns.items()
        if frame[name].ne("").any() or name in ("verdict", "why")
    }
    return TableView(
        label=label, title=title, caption=caption, frame=frame, columns=kept,
        file=folder / "checks.csv", most=most,
    )  # fmt: skip


def _address(source: str) -> str:
    """Return a table's address as seen from results/audit: results, or the copy of the print."""
    for start, to in (("results/", "../"), ("papers/", "printed/")):
        if source.startswith(start):
            return source.replace(start, to, 1)
    return source


def _curves(papers: Sequence[Paper], folder: Path) -> Iterator[tuple[Paper, Curve, Path]]:
    for paper in papers:
        for curve in paper.curves:
            base = folder / f"{paper.folder.name}_{curve.claim}"
            if base.with_suffix(".svg").is_file():
                yield paper, curve, base


def _rest_on(curves: Sequence[tuple[Paper, Curve, Path]], kept: Iterable[FigureView]) -> Section:
    views: list[TableView | FigureView] = [*kept]
    for paper, curve, base in curves:
        levels_file = base.with_name(f"{base.name}_levels.csv")
        levels = read_table(levels_file, "specifications")
        levels = levels.sort_values("choice", key=lambda c: c != "all", kind="stable")
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
                folded=True,
                inner=(_by_choice(curve, levels, levels_file, len(whole)),),
            )
        )
    return Section(
        "rest-on",
        "What the claims rest on",
        text=(
            "Some claims hang on choices that the paper leaves open. Here every combination of the "
            "choices in config.yaml (open_choices) is run: in which share of them does the claim "
            "hold, and which choice decides?",
        ),
        exhibits=views,
    )


def _by_choice(curve: Curve, levels: pd.DataFrame, file: Path, most: int) -> TableView:
    return TableView(
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
        file=file,
        most=most,
    )
