"""The front page: what ran on what, what to look at first, what holds and what is open."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pandas as pd

from signkin.audit.ledger import PRINT
from signkin.corpus import Corpus
from signkin.pages.sources import Sources
from signkin.pages.warnings import counted, groups
from signkin.report.page import Section, TableView
from signkin.tables import read_table

S3 = ".3f"


def front_sections(sources: Sources) -> list[Section]:
    """Return the sections of the front page."""
    return [
        _first(sources),
        _summary(sources),
        _owner_findings(sources),
        _claims(sources),
    ]


def front_lead(sources: Sources) -> tuple[str, ...]:
    """Return what ran on what, in plain words."""
    about = {name: sources.table(name, "recordings") for name in sources.corpora}
    real = [name for name, corpus in sources.corpora.items() if not corpus.simulator]
    made = [name for name in sources.corpora if name not in real]
    hours = sum(float(frame["duration_s"].sum()) for frame in about.values()) / 60
    many = sum(len(frame) for frame in about.values())
    signs = sum(
        len(frame) if sources.corpora[name].single_signs else int(frame["signs"].sum())
        for name, frame in about.items()
    )
    failed = (
        f" {counted(len(sources.missing), 'corpus', 'corpora')} could not be used."
        if sources.missing else ""
    )  # fmt: skip
    return (
        f"{many} recordings of signing, {hours:.1f} minutes with {signs} signs, were read from "
        f"{counted(len(real), 'corpus', 'corpora')} of real recordings and {len(made)} made by a "
        f"program.{failed} Two questions were asked of them: how do hands "
        "move from one sign to the next (after Naert, Larboulette & Gibet 2017), and does a "
        "movement fall into pieces of its own (after Endres, Meirovitch, Flash & Giese 2013)?",
        "The papers' own recordings are not public: their printed numbers stand beside ours, and "
        "no corpus here is theirs.",
    )


def _first(sources: Sources) -> Section:
    found = groups(sources)
    text = ["Nothing was left out, and nothing looks wrong."] if not found else []
    return Section("first", "What to look at first", text=text, groups=found)


# --- what ran on what ------------------------------------------------------------------------


def _summary(sources: Sources) -> Section:
    rows = [_row(sources, name, corpus) for name, corpus in sources.corpora.items()]
    rows.sort(key=lambda row: str(row["evidence"]))
    columns = {
        "page": ("corpus", "link"),
        "evidence": ("evidence", ""),
        "language": ("language", ""),
        "recordings": ("recordings", "d"),
        "left_out": ("left out", "d"),
        "signers": ("signers", "d"),
        "minutes": ("minutes", ".1f"),
        "signs": ("signs", "d"),
        "transitions": ("transitions", "d"),
        "mean_s": ("mean duration (s)", S3),
        "sd_s": ("SD (s)", S3),
        "asked": ("asked of it", ""),
    }
    view = TableView(
        label="",
        title="Corpora of this run",
        caption="Transitions: from the end of a sign to the start of the next, between manual "
        "tags; overlapping signs are left out, transitions of no length kept; SD with divisor "
        f"n - 1. The paper (Sign3D, LSF): {sources.published_n} transitions, mean "
        f"{sources.naert.constants['mean_duration']} s, SD "
        f"{sources.naert.constants['sd_duration']} s.",
        frame=pd.DataFrame(rows, columns=list(columns)),
        columns=columns,
    )
    return Section("summary", "What ran on what", exhibits=(view,))


def _row(sources: Sources, name: str, corpus: Corpus) -> dict[str, object]:
    about = sources.table(name, "recordings")
    asked = [
        word
        for word, yes in (
            ("transitions between signs", corpus.tagged),
            ("pieces of single signs", corpus.single_signs),
            ("pieces of continuous signing", not corpus.single_signs),
        )
        if yes
    ]
    row: dict[str, object] = {
        "page": f"corpora/{name}.html",
        "evidence": "simulated" if corpus.simulator else "real",
        "language": corpus.settings["language"],
        "recordings": len(about),
        "left_out": len(sources.table(name, "excluded")),
        "signers": about["signer"].nunique(),
        "minutes": float(about["duration_s"].sum()) / 60,
        "asked": ", ".join(asked),
    }
    if not corpus.tagged:
        signs = len(about) if corpus.single_signs else None
        return {**row, "signs": signs, "transitions": None, "mean_s": None, "sd_s": None}
    table2 = sources.tagged_table(name, "table2").set_index("type")
    row["signs"] = int(about["signs"].sum())
    if "all" not in table2.index:  # transitions are not available
        return {**row, "transitions": None, "mean_s": None, "sd_s": None}
    everything = table2.loc["all"]
    return {
        **row,
        "transitions": int(everything["n"]),
        "mean_s": float(everything["mean_s"]),
        "sd_s": float(everything["sd_s"]),
    }


# --- what holds, what is open ----------------------------------------------------------------


QUESTIONS = {
    "type": "Do durations differ by the types of the two signs?",
    "change of hands": "Do durations differ by how many hands the signs have?",
    "hands before x hands after": "Does the number of hands matter, before and after?",
    "symmetry before x symmetry after": "Does symmetry of two-handed signs matter?",
    "isochrony": "Do longer ways take longer?",
}


def _owner_findings(sources: Sources) -> Section:
    order = sorted(sources.corpora, key=lambda name: sources.corpora[name].simulator is not None)
    rows = [row for name in order for row in _tag_findings(sources, name)]
    rows += [row for name in order for row in _duration_findings(sources, name)]
    view = TableView(
        label="",
        title="Findings by corpus",
        caption="A sentence each; numbers, intervals and tests stand where the link leads.",
        frame=pd.DataFrame(rows, columns=["page", "evidence", "question", "found", "more"]),
        columns={
            "page": ("corpus", "link"),
            "evidence": ("evidence", ""),
            "question": ("question", ""),
            "found": ("found", ""),
            "more": ("numbers", "open"),
        },
        most=60,
    )
    if not rows:
        return Section("findings", "What was found", text=["No corpus of this run has tags."])
    return Section("findings", "What was found", exhibits=(view,))


def _tag_findings(sources: Sources, name: str) -> Iterator[dict[str, str]]:
    if not sources.corpora[name].tagged:
        return
    window = sources.settings.refinement.search_window_s
    frame = sources.tagged_table(name, "tag_chance")
    kept = frame[
        (frame["tags"] == "all") & (frame["null"] == "circular shift")
        & (frame["measure"] == "share within the window")
        & ((frame["window_s"] - window).abs() < 1e-9)
    ]  # fmt: skip
    for row in kept.itertuples():
        better = row.value > row.chance_high
        told = (
            f"{row.value:.0%} of {row.n} tags lie within {window:g} s of a minimum of speed of the "
            f"{row.hand} hand; by chance {row.chance_low:.0%} to {row.chance_high:.0%}: "
            + ("nearer than chance." if better else "no nearer than chance.")
        )
        yield _finding(
            sources,
            name,
            "Do tags lie where the hand slows down?",
            told,
            f"corpora/{name}.html#tags",
        )


def _duration_findings(sources: Sources, name: str) -> Iterator[dict[str, str]]:
    if not sources.corpora[name].tagged:
        return
    frame = sources.tagged_table(name, "statistics")
    words = frame[frame["kind"] == "words"].drop_duplicates("comparison")
    for row in words.itertuples():
        question = QUESTIONS.get(str(row.comparison), str(row.comparison))
        first = re.split(r"(?<=[a-z)])[.;:] ", str(row.note), maxsplit=1)[0].rstrip(".") + "."
        yield _finding(sources, name, question, first, "papers/naert2017.html#durations")


def _finding(sources: Sources, name: str, question: str, found: str, more: str) -> dict[str, str]:
    return {
        "page": f"corpora/{name}.html",
        "evidence": "simulated" if sources.corpora[name].simulator else "real",
        "question": question,
        "found": found,
        "more": more,
    }


ORDER = ("holds", "fails", "undecided", "depends", "by construction", "not testable")


def _claims(sources: Sources) -> Section:
    audit = sources.results / "audit"
    claims = read_table(audit / "claims.csv", "claims")
    bad = claims[(claims["evidence"] == PRINT) & (claims["verdict"] == "inconsistent")]
    text = [
        f"{claims['id'].nunique()} claims of {claims['paper'].nunique()} papers were tested: can "
        "the printed numbers be right, and is it so in other people's signing?"
    ]
    text += [
        f"Inconsistent on the paper's own numbers: {row.id} ({row.location}), that "
        f"“{row.claim.rstrip('.')}”: {row.note}."
        for row in bad.itertuples()
    ]
    view = TableView(
        label="",
        title="Claims on real recordings",
        caption="Each claim by what the corpora of real recordings say. Holds: in all of them that "
        "can tell; mixed: in some and not in others; open: the data allow both, or a choice that "
        "is not printed decides.",
        frame=_outcomes(claims),
        columns={
            "outcome": ("outcome", ""),
            "id": ("claim", ""),
            "claim": ("what is claimed", ""),
            "print": ("on print", "verdict"),
            "told": ("corpora", ""),
        },
        file=audit / "claims.csv",
        most=40,
    )
    links: tuple[tuple[str, Path], ...] = (
        ("The audit: all claims, their checks and what they rest on", audit / "index.html"),
    )
    return Section("audit", "What holds, what is open", text=text, exhibits=(view,), links=links)


def _outcomes(claims: pd.DataFrame) -> pd.DataFrame:
    rows = []
    for (_, claim), own in claims.groupby(["paper", "id"], sort=False):
        real = own[(own["evidence_kind"] == "real") & own["verdict"].isin(ORDER[:4])]
        found = set(real["verdict"])
        outcome = (
            "not testable here" if not found
            else "holds" if found == {"holds"}
            else "fails" if found == {"fails"}
            else "mixed" if {"holds", "fails"} <= found
            else "open"
        )  # fmt: skip
        printed = own.loc[own["evidence"] == PRINT, "verdict"]
        rows.append(
            {
                "outcome": outcome,
                "id": claim,
                "claim": own["claim"].iloc[0],
                "print": printed.iloc[0] if len(printed) else "not testable",
                "told": "; ".join(f"{r.evidence}: {r.verdict}" for r in real.itertuples()),
            }
        )
    order = ["holds", "fails", "mixed", "open", "not testable here"]
    frame = pd.DataFrame(rows, columns=["outcome", "id", "claim", "print", "told"])
    return frame.sort_values("outcome", key=lambda c: c.map(order.index), kind="stable")
