"""The front page: what ran on what, what to look at first, what holds and what is open."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pandas as pd

from signkin.audit.ledger import PRINT
from signkin.corpus import Corpus
from signkin.pages.corpus_tags import against_chance
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


def summary_lines(sources: Sources) -> list[str]:
    """Return what a run says at its end: what to look at, then the lines that matter."""
    warned = [group.told for group in groups(sources) if group.warns]
    claims = read_table(sources.results / "audit" / "claims.csv", "claims")
    printed = claims[claims["evidence"] == PRINT].drop_duplicates(["paper", "id"])
    verdicts = printed["verdict"].value_counts()
    found = outcomes(claims)["outcome"].value_counts()
    whole = ", ".join(f"{n} {word}" for word, n in verdicts.items())
    plural = {"holds": "hold", "fails": "fail", "mixed": "hold on some and fail on others"}
    real = ", ".join(
        f"{found[word]} {word if found[word] == 1 else plural.get(word, word)}"
        for word in OUTCOMES if word in found
    )  # fmt: skip
    return [
        *(f"Look at: {told}." for told in warned),
        front_lead(sources)[0].partition(". ")[0] + ".",
        f"Claims on print: {whole}.",
        f"Claims on real recordings: {real}.",
    ]


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


QUESTIONS = {  # of the tests of durations, those that a first reader has
    "type": "Do durations differ by the types of the two signs?",
    "isochrony": "Do longer ways take longer?",
}


def _owner_findings(sources: Sources) -> Section:
    order = sorted(sources.corpora, key=lambda name: sources.corpora[name].simulator is not None)
    rows = [row for name in order for row in _tag_findings(sources, name)]
    rows += [row for name in order for row in _duration_findings(sources, name)]
    rows += [row for name in order for row in _piece_findings(sources, name)]
    questions = list(dict.fromkeys(row["question"] for row in rows))
    rows.sort(key=lambda row: questions.index(row["question"]))
    view = TableView(
        label="",
        title="Findings by question and corpus",
        caption="A sentence each; numbers, intervals and tests stand where the link leads.",
        frame=pd.DataFrame(rows, columns=["page", "evidence", "question", "found", "more"]),
        columns={
            "question": ("question", ""),
            "page": ("corpus", "link"),
            "evidence": ("evidence", ""),
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
    settings = sources.settings
    chance = sources.tagged_table(name, "tag_chance")
    window, alpha = settings.refinement.search_window_s, settings.durations.alpha
    for told in against_chance(chance, window, alpha):
        question = "Do tags lie where the hand slows down?"
        yield _finding(sources, name, question, told, f"corpora/{name}.html#tags")


def _duration_findings(sources: Sources, name: str) -> Iterator[dict[str, str]]:
    if not sources.corpora[name].tagged:
        return
    frame = sources.tagged_table(name, "statistics")
    words = frame[frame["kind"] == "words"].drop_duplicates("comparison")
    for row in words.itertuples():
        if row.comparison not in QUESTIONS:
            continue
        told = (
            str(row.note)
            .replace("_rad:", " distance:")
            .replace("_m:", " distance:")
            .replace("_px:", " distance:")
        )
        if row.comparison == "type":
            told = re.split(r"(?<=[a-z)])[.:] ", told, maxsplit=1)[0].rstrip(".") + "."
        question = QUESTIONS[str(row.comparison)]
        yield _finding(sources, name, question, told, "papers/naert2017.html#durations")


def _piece_findings(sources: Sources, name: str) -> Iterator[dict[str, str]]:
    folder = sources.results / "endres2013" / name
    if sources.corpora[name].single_signs:
        frame = read_table(folder / "order_posteriors.csv", "order_posteriors")
        whole = (frame["signer"] == "all") & (frame["sign"] == "all")
        kept = frame[whole & (frame["dataset"] == "recorded")]
        if kept["mean_probability"].notna().any():
            best = kept.loc[kept["mean_probability"].idxmax()]
            told = (
                f"Order {int(best['order'])} is the most probable (P = "
                f"{best['mean_probability']:.2f} on average), with {best['mean_count']:.1f} "
                "boundaries a movement; the paper has order 4. A prior that it does not print "
                "decides this."
            )
            question = "Which polynomials are the pieces of a movement?"
            yield _finding(sources, name, question, told, "papers/endres2013.html#found")
        return
    frame = read_table(folder / "one_wrist.csv", "one_wrist")
    kept = frame[(frame["found"] == "boundaries") & (frame["truth"] == "manual tags")]
    for row in kept[kept["hit_rate"].notna()].itertuples():
        more = row.hit_rate > row.chance_high
        told = (
            f"{row.hit_rate:.0%} of the tags have a boundary of the {row.hand} wrist within "
            f"{row.window_s:g} s, by chance {row.chance_low:.0%} to {row.chance_high:.0%}: "
            + ("more than chance." if more else "no more than chance.")
        )
        question = "Do pieces of a wrist's path start and end where signs do?"
        yield _finding(sources, name, question, told, f"papers/one_wrist.html#{name}")


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
        f"{len(claims.drop_duplicates(['paper', 'id']))} claims of {claims['paper'].nunique()} "
        "papers were tested: can "
        "the printed numbers be right, and is it so in other people's signing?"
    ]
    text += [
        f"Inconsistent on the paper's own numbers: {row.id} of {row.paper} ({row.location}), that "
        f"“{row.claim.rstrip('.')}”: {row.note}."
        for row in bad.itertuples()
    ]
    view = TableView(
        label="",
        title="Claims on real recordings",
        caption="Each claim by what the corpora of real recordings say. Holds: in all of them that "
        "can tell; mixed: in some and not in others; open: the data allow both, or a choice that "
        "is not printed decides.",
        frame=outcomes(claims),
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


OUTCOMES = ("holds", "fails", "mixed", "open", "not testable here")


def outcomes(claims: pd.DataFrame) -> pd.DataFrame:
    """Return a row a claim; a paper that is audited on its print alone asks nothing of corpora."""
    asked = claims.groupby("paper")["evidence"].transform(lambda e: (e != PRINT).any())
    rows = []
    for (_, claim), own in claims[asked].groupby(["paper", "id"], sort=False):
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
    frame = pd.DataFrame(rows, columns=["outcome", "id", "claim", "print", "told"])
    return frame.sort_values("outcome", key=lambda c: c.map(OUTCOMES.index), kind="stable")
