"""What follows from the tests of a question, as a sentence made from the findings' fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from signkin.settings.sections import Durations
from signkin.statistics import anova, mixed
from signkin.statistics.findings import Finding, Kind, p_text
from signkin.statistics.power import spread_text

IN_WORDS = "in words"
# Tests of a question that do not decide it, told where they come out the other way.
BESIDE = (anova.CLASSIC, anova.KRUSKAL, mixed.TEST)


@dataclass(frozen=True)
class Question:
    """One question about durations.

    name: as in the table. title: what is compared. same: what equivalence would mean; `{bound}`
    and `{half}` stand for the bound and half of it. together: whether equivalence is shown by one
    test of all groups, where there is one (else every pair has to be equivalent).
    """

    name: str
    title: str
    same: str
    together: bool


def in_words(
    question: Question,
    findings: Sequence[Finding],
    n: int,
    inferred: int,
    chosen: Durations,
) -> Finding:
    """Say what follows: a difference, equivalence, or neither.

    findings: with `p_holm` of those that decide: it is what decides, since several questions ask
    whether the types matter. n: transitions. inferred: those of them with a type from motion.
    """
    alpha = chosen.alpha
    tests = [f for f in findings if f.decisive]
    if not tests:
        return _words(question.title, n, "nothing can be tested: see the reasons")
    found = [f for f in tests if f.p_holm < alpha]
    others = _others(findings, bool(found), alpha)
    text = _verdict(question, findings, found, bool(others), chosen) + others
    checks = next((f.assumptions for f in findings if f.assumptions), "")
    if inferred:
        text += (
            f" {inferred} of {n} types are inferred from motion, a stand-in "
            "for what a signer knows."
        )
    return _words(question.title, n, text, checks)


def _words(title: str, n: int, text: str, assumptions: str = "") -> Finding:
    return Finding(IN_WORDS, Kind.WORDS, title, n=n, assumptions=assumptions, notes=(text,))


def _verdict(
    question: Question,
    findings: Sequence[Finding],
    found: Sequence[Finding],
    contested: bool,
    chosen: Durations,
) -> str:
    bound = chosen.equivalence_s
    same = _equivalence(question, findings, chosen.alpha, bound)
    none = "The deciding test finds no difference" if contested else "No difference was found"
    if found:
        told = "; ".join(map(_difference, found))
        start = "The deciding test finds a difference" if contested else "Durations differ"
        small = f" The difference is small: {same}." if same else ""
        return f"{start}. {told}.{small}"
    if same:
        return f"{none}, and {same}."
    return (
        f"{none}, which is no evidence that there is none: equivalence within "
        f"± {bound:g} s was not shown either. {_smallest(findings)}"
    )


def _difference(f: Finding) -> str:
    return (
        f"{f.comparison}: {f.test} F({f.df1:g}, {f.df2:.4g}) = {f.statistic:.2f}, "
        f"{p_text(f.p)} ({p_text(f.p_holm)} by Holm), {f.effect_name} {f.effect:.3f} "
        f"({f.effect_low:.3f} to {f.effect_high:.3f})"
    )


def _others(findings: Sequence[Finding], found: bool, alpha: float) -> str:
    """Name the tests of the same question that come out the other way."""
    against = {f.test: f.p for f in findings if f.test in BESIDE and (f.p < alpha) != found}
    told = [f"{test} {p_text(p)}" for test, p in against.items() if np.isfinite(p)]
    return f" Others say otherwise: {', '.join(told)}." if told else ""


def _equivalence(
    question: Question, findings: Sequence[Finding], alpha: float, bound: float
) -> str:
    """Return that the groups are the same, with its p; empty where that is not shown."""
    tests = [f for f in findings if f.kind is Kind.EQUIVALENCE]
    if question.together:
        tests = [f for f in tests if not f.groups] or tests
    if not tests or not all(f.p < alpha for f in tests):
        return ""
    text = question.same.format(bound=f"{bound:g}", half=f"{bound / 2:g}")
    return f"{text} ({p_text(max(f.p for f in tests))})"


def _smallest(findings: Sequence[Finding]) -> str:
    """Tell what the design could have found, in seconds where two groups are compared."""
    could = [f for f in findings if f.kind is Kind.SENSITIVITY and f.effect > 0]
    general = [f for f in could if not f.groups]
    pairs = [f for f in could if f.groups]
    parts = []
    if general:
        f = general[0]
        spread = spread_text(f.spread_s, f.spread_s / f.effect)
        parts.append(f"At {f.power:.0%} power it finds f = {f.effect:.2f} ({spread})")
    if pairs:
        told = ", ".join(f"{f.comparison} {f.effect:.3f} s" for f in pairs)
        parts.append(f"Smallest differences found at {pairs[0].power:.0%} power: {told}")
    return ". ".join(parts) + "." if parts else ""


def isochrony_in_words(exponents: Mapping[str, Finding]) -> Finding:
    """Say what the isochrony exponents mean. exponents: distance -> finding, of the whole body."""
    whole = {name: f for name, f in exponents.items() if np.isfinite(f.effect)}
    if not whole:
        return _words("isochrony", 0, "no exponent can be fitted: see the reasons")
    told = []
    for name, f in whole.items():
        if f.effect_low > 1:
            what = "duration grows faster than the distance: no isochrony"
        elif f.effect_low > 0 and f.effect_high < 1:
            what = "longer ways are faster, but not of the same duration: isochrony in part"
        elif f.effect_low <= 0 and f.effect_high < 1:
            what = "no growth with the distance is shown"
        else:
            what = "neither constant speed nor isochrony in part is excluded"
        told.append(
            f"{name}: duration as distance to the power {f.effect:.2f} ({f.effect_low:.2f} to "
            f"{f.effect_high:.2f}), {what}"
        )
    return _words("isochrony", next(iter(whole.values())).n, "; ".join(told) + ".")
