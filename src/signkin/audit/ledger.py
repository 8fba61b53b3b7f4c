"""The ledger: every claim of a paper with its verdict on each piece of evidence.

On printed numbers a claim is `consistent` or `inconsistent`; on a corpus it `holds` or
`fails`, is `undecided` where the data allow both, `depends` on what is not printed, or is so `by
construction`; else it is `not testable`, with what is missing. A simulated corpus tests the method.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

import pandas as pd

from signkin.audit import at_n, corpus_checks, uncertain_checks
from signkin.audit import checks as checks_on_print
from signkin.audit.findings import (
    BY_CONSTRUCTION,
    CONSISTENT,
    DEPENDS,
    DIGITS,
    FAILS,
    HOLDS,
    INCONSISTENT,
    NOT_TESTABLE,
    UNDECIDABLE,
    UNDECIDED,
    Finding,
    unusable,
)
from signkin.audit.paper import Check, Claim, Paper, Reading
from signkin.audit.readings import under_readings
from signkin.audit.registry import CORPUS, PUBLISHED, Evidence, Missing, OnCorpus, OnPrint, run
from signkin.errors import SignkinError
from signkin.tables import TABLES

PRINT = "published numbers"
SIMULATED, REAL = "simulated", "real"
__all__ = [
    "CORPUS", "PUBLISHED", "Evidence", "Ledger", "at_n", "audit", "checks_on_print",
    "corpus_checks", "uncertain_checks",
]  # fmt: skip


_SHOWN = [f.name for f in fields(Finding) if f.name != "item"]


@dataclass(frozen=True)
class Ledger:
    """Verdicts (table `claims`: a row a claim and evidence) and findings (table `checks`)."""

    claims: pd.DataFrame
    checks: pd.DataFrame
    faults: tuple[str, ...] = ()  # what could not be used, a sentence each
    details: pd.DataFrame = field(default_factory=pd.DataFrame)  # checks, with all that is known


@dataclass(frozen=True)
class _Done:
    """A check with its findings; `missing`: why there are none."""

    check: Check
    findings: Sequence[Finding]
    missing: str = ""

    @property
    def verdict(self) -> str:
        verdicts = {finding.verdict for finding in self.findings}
        for verdict in (INCONSISTENT, FAILS, DEPENDS, UNDECIDED, CONSISTENT, HOLDS):
            if verdict in verdicts:
                return verdict
        return UNDECIDABLE


def audit(papers: Iterable[Paper], corpora: Iterable[Evidence] = ()) -> Ledger:
    """Run every check of every claim, on print and on each corpus.

    corpora: their `files` are the tables of the study that the paper's claims read; see
    `evidence_for`. What cannot be used (unknown checks, tables, arguments, bad cells)
    is a fault with its file and line; the other checks go on.
    """
    corpora = list(corpora)
    claims: list[dict[str, str]] = []
    checks: list[dict[str, str]] = []
    faults: list[str] = []
    for paper in papers:
        faults += [str(fault) for fault in paper.faults]
        for claim in paper.claims:
            for evidence in (None, *(corpora if paper.study else ())):
                done = _run(paper, claim, evidence)
                verdict, note = _verdict(claim, evidence, done)
                printed = ""
                if evidence is not None:
                    plain = verdict
                    verdict, note = _no_sharper(paper, claim, evidence, done, verdict, note)
                    verdict, note, printed = _as_printed(
                        paper, claim, evidence, plain, verdict, note
                    )
                lead = {
                    "paper": paper.folder.name,
                    "id": claim.id,
                    "location": claim.location,
                    "evidence": PRINT if evidence is None else evidence.name,
                    "evidence_kind": PRINT if evidence is None
                    else SIMULATED if evidence.simulated else REAL,
                }  # fmt: skip
                claims.append({**_claim_row(lead, claim, done, verdict, note),
                               "as_printed": printed})  # fmt: skip
                checks += [row for d in done for row in _check_rows(lead, d)]
                faults += [f.why for d in done for f in d.findings if f.fault]
    details = pd.DataFrame(checks)
    return Ledger(
        pd.DataFrame(claims, columns=TABLES["claims"].names()),
        details.reindex(columns=TABLES["checks"].names()),
        tuple(dict.fromkeys(faults)),
        details,
    )


def evidence_for(
    study: str, corpora: Mapping[str, bool], files: Iterable[Path], results: Path
) -> list[Evidence]:
    """Return the corpora with the tables that a study's claims may read.

    corpora: name -> whether simulated. files: result tables, `results/<study>/<corpus>/*.csv`
    and `results/<corpus>/*.csv`; the study's own go before the shared ones. Those of another
    study are called `<study>/<table>`.
    """
    there: dict[str, dict[str, Path]] = {name: {} for name in corpora}
    for path in sorted(map(Path, files), key=lambda p: p.as_posix()):
        if path.suffix != ".csv" or not path.is_relative_to(results):
            continue
        parts = path.relative_to(results).parts
        if len(parts) == 3 and parts[1] in there:
            name = path.stem if parts[0] == study else f"{parts[0]}/{path.stem}"
            there[parts[1]][name] = path
        elif len(parts) == 2 and parts[0] in there:
            there[parts[0]].setdefault(path.stem, path)
    return [Evidence(name, simulated, there[name], results) for name, simulated in corpora.items()]


def _run(paper: Paper, claim: Claim, evidence: Evidence | None) -> list[_Done]:
    if evidence is None:
        on_print = OnPrint(paper, claim)
        return [_Done(check, _unless_bad(check, on_print)) for check in claim.published]
    return _run_on(claim, OnCorpus(paper, claim, evidence))


def _run_on(claim: Claim, on_corpus: OnCorpus) -> list[_Done]:
    evidence, out = on_corpus.evidence, []
    kind = SIMULATED if evidence.simulated else REAL
    for check in claim.corpora:
        if check.only and check.only != kind:
            out.append(_Done(check, (), f"a check for {check.only} corpora"))
            continue
        try:
            out.append(_Done(check, _unless_bad(check, on_corpus)))
        except Missing as missing:
            out.append(_Done(check, (), str(missing)))
            if check.gate:
                return out[-1:]
    return out


def _unless_bad(check: Check, context: OnPrint | OnCorpus) -> list[Finding]:
    """Run a check; input that cannot be used is its finding, and the others go on."""
    try:
        return run(check, context)
    except SignkinError as error:
        return [unusable(error)]


def _verdict(claim: Claim, evidence: Evidence | None, done: Sequence[_Done]) -> tuple[str, str]:
    """Return the verdict over all checks of a claim, and what is to be said about it."""
    done = [d for d in done if not d.check.beside]
    if not done:
        missing = claim.published_missing if evidence is None else claim.corpora_missing
        return NOT_TESTABLE, missing
    bad, good = (INCONSISTENT, CONSISTENT) if evidence is None else (FAILS, HOLDS)
    told = [_told(d) for d in done]
    if any(d.verdict == bad for d in done):
        return bad, "; ".join(t for t, d in zip(told, done, strict=True) if d.verdict == bad)
    open_ = [(t, d) for t, d in zip(told, done, strict=True) if d.verdict == UNDECIDABLE]
    if all(d.verdict == UNDECIDABLE for d in done) or any(d.check.decisive for _, d in open_):
        missing = claim.published_missing
        if evidence is not None and claim.needs:
            missing = f"needs {claim.needs}"
        words = list(dict.fromkeys(t for t, _ in open_))
        if missing and missing not in words:
            words.append(missing)
        return NOT_TESTABLE, "; ".join(words)
    for level in (DEPENDS, UNDECIDED):
        if any(d.verdict == level for d in done):
            parts = [t for t, d in zip(told, done, strict=True) if d.verdict == level]
            return level, "; ".join(dict.fromkeys(parts))
    return good, "; ".join(dict.fromkeys(told))


def _no_sharper(
    paper: Paper, claim: Claim, evidence: Evidence, done: Sequence[_Done], verdict: str, note: str
) -> tuple[str, str]:
    """Return the verdict on a corpus as far as how it was made, and open readings, allow it."""
    counted = [d for d in done if not d.check.beside]
    if {"all", evidence.name} & set(claim.made_with_print):
        kept = [d for d in done if d.verdict != UNDECIDABLE]
        ruled = not counted and kept and all(d.verdict == HOLDS for d in kept)
        if verdict in (HOLDS, UNDECIDED) or ruled:  # what fails even there tells of the method
            told = claim.made_why if ruled else f"{claim.made_why} ({verdict}: {note})"
            return BY_CONSTRUCTION, told
    for curve in paper.curves:
        if curve.claim != claim.id or verdict not in (HOLDS, FAILS, UNDECIDED):
            continue
        found = under_readings(curve, OnCorpus(paper, claim, evidence))
        if found is None:
            continue
        spoken = claim.corpora if curve.checks is None else [
            claim.corpora[i - 1] for i in curve.checks if i <= len(claim.corpora)]  # fmt: skip
        other = any(d.verdict == FAILS and d.check not in spoken for d in counted)
        open_ = f"of the readings that keep the print, {found.why(1)}"
        # Our settings are a reading, too: against all others it depends as well.
        differ = found.verdict == DEPENDS or {found.verdict, verdict} == {HOLDS, FAILS}
        if differ and not other and (verdict != FAILS or spoken):
            return DEPENDS, f"{open_}; under our settings: {verdict}, {note}"
        note = f"{note}; {open_}"
    return verdict, note


def _as_printed(
    paper: Paper, claim: Claim, evidence: Evidence, plain: str, verdict: str, note: str
) -> tuple[str, str, str]:
    """Return verdict and note with what the claim is without the rules that we add to the print.

    plain: the verdict before readings of what is not printed are looked at. Where a reading as
    printed says something else, from the same recordings, the claim depends on our rule. Also
    returns what each reading says, as text.
    """
    made = verdict == BY_CONSTRUCTION
    ours, word = (HOLDS, verdict) if made else (plain, plain)
    if ours == NOT_TESTABLE:
        return verdict, note, ""
    told, apart = [], []
    for reading in paper.readings:
        if claim.id not in reading.claims:
            continue
        found, why = _read_so(paper, claim, evidence, reading, reading.where)
        same = {ours, NOT_TESTABLE}
        if reading.ours:
            same.add(_read_so(paper, claim, evidence, reading, reading.ours)[0])
        told.append(f"{reading.name}: {found}")
        if found not in same:
            apart.append(
                f"with our rule ({reading.adds}) {word}, "
                f"as printed ({reading.printed}) {found}: {why}"
            )
    printed = "; ".join(told)
    if apart:
        return DEPENDS, "; ".join([*apart, note]), printed
    return verdict, f"{note}; as printed, {printed}" if told else note, printed


def _read_so(
    paper: Paper, claim: Claim, evidence: Evidence, reading: Reading, where: str
) -> tuple[str, str]:
    """Return the verdict of a claim's checks on the tables of a reading, and why."""
    if reading.checks is not None:
        kept = [claim.corpora[i - 1] for i in reading.checks]
        claim = replace(claim, corpora=tuple(replace(check, beside=False) for check in kept))
    context = OnCorpus(paper, claim, evidence, reading.tables, where)
    return _verdict(claim, evidence, _run_on(claim, context))


def _told(done: _Done) -> str:
    """Return one sentence about a check: of many rows, those that are not as the rest."""
    if done.missing:
        return done.missing
    if len(done.findings) == 1:
        return done.findings[0].why
    good = [f for f in done.findings if f.verdict in (CONSISTENT, HOLDS)]
    others = [f for f in done.findings if f not in good]
    told = (
        f"{done.check.name}: {len(good)} of {len(done.findings)} {good[0].verdict if good else ''}"
    )
    if len(done.findings) <= 3:
        told = "; ".join(f.why for f in good)
    parts = [told] + [f"{f.item}: {f.verdict}, {f.why}" for f in others]
    if any(f.verdict == INCONSISTENT for f in others):  # what does not fit comes first
        parts = [*parts[1:], f"{len(good)} of {len(done.findings)} consistent" if good else ""]
    return "; ".join(part for part in parts if part)


def _claim_row(
    lead: Mapping[str, str], claim: Claim, done: Sequence[_Done], verdict: str, note: str
) -> dict[str, str]:
    single = [f for d in done if not d.check.beside and len(d.findings) <= 3 for f in d.findings]
    sources = list(dict.fromkeys(f.source for d in done for f in d.findings if f.source))
    printed = ", ".join(f"{name} {text}" for name, text in claim.printed.items())
    return {
        **lead,
        "claim": claim.claim,
        "printed": printed,
        "recomputed": "; ".join(f.recomputed for f in single if f.recomputed),
        "interval": "; ".join(f.interval for f in single if f.interval),
        "verdict": verdict,
        "note": note,
        "source": " ".join(sources),
    }


def _check_rows(lead: Mapping[str, str], done: _Done) -> list[dict[str, str]]:
    findings = done.findings or (Finding(NOT_TESTABLE, done.missing),)
    return [
        {
            **lead,
            "check": done.check.name,
            "counts": "beside the claim" if done.check.beside else "yes",
            "item": f.item,
            "reads": done.check.reads,
            **{name: getattr(f, name) for name in _SHOWN},
            **({"severity": f.severity or DIGITS} if f.verdict == INCONSISTENT else {}),
        }
        for f in findings
    ]
