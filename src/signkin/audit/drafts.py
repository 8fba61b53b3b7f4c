"""Claims drafted from what a text says: as YAML, with questions as comments.

What decides a verdict (the grain, the tails, the divisor) is asked for, never guessed.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from signkin.audit.apa import FoundStatistic, NotRead, statistics_in, with_points
from signkin.audit.found_numbers import FoundInterval, FoundMean, intervals_in, means_in

_ONE_TAILED = re.compile(r"one[- ](?:tailed|sided)|directional", re.IGNORECASE)
_CORRECTED = re.compile(r"Greenhouse|Huynh|[Ss]phericity")
_SKEWED = re.compile(r"bootstrap|percentile interval|profile likelihood|credible|bayes", re.I)


@dataclass
class Draft:
    """What was found: claims as text, tables to write beside them, and what was not understood."""

    claims: list[str] = field(default_factory=list)
    tables: dict[str, str] = field(default_factory=dict)
    not_understood: list[str] = field(default_factory=list)
    numbers: dict[str, int] = field(default_factory=dict)

    def name(self, letter: str) -> str:
        """Return the next id of a kind of claim: S001."""
        self.numbers[letter] = self.numbers.get(letter, 0) + 1
        return f"{letter}{self.numbers[letter]:03d}"

    def add(self, letter: str, location: str, claim: str, body: Iterator[str]) -> None:
        """Add a claim; body: the lines below `published:`."""
        lines = [f"  - id: {self.name(letter)}", f"    location: {location}", f"    claim: {claim}",
                 "    published:", *(f"      {line}" for line in body)]  # fmt: skip
        self.claims.append("\n".join(lines))


def from_text(text: str, draft: Draft | None = None, page: str = "") -> Draft:
    """Draft a claim for every test statistic, interval, and mean with its SD in a text.

    page: told before each line (`page 3, `). draft: an earlier page's, which is added to.
    """
    draft = draft or Draft()
    text, commas = with_points(text)
    if commas:
        told = "decimal commas, read as points (no number has a point)"
        draft.not_understood.append(f"{page or 'the text: '}{told}")
    found, missed = statistics_in(text)
    tailed = _ONE_TAILED.search(text)
    asked = "tails: two or one, where the paper says so; else both are tried"
    if tailed:
        line = text.count("\n", 0, tailed.start()) + 1
        asked = f"`{tailed[0]}` stands in {page}line {line}: {asked}"
    for one in found:
        correction = _CORRECTED.search(text)
        word = correction[0] if correction else ""
        draft.add("S", f"{page}{one.place}", _quoted(one.raw), _statistic(one, asked, word))
    intervals, without = intervals_in(text)
    skewed = _SKEWED.search(text)
    for each in intervals:
        word = skewed[0] if skewed else ""
        draft.add("I", f"{page}line {each.line}", _quoted(each.raw), _interval(each, word))
    for mean in means_in(text):
        draft.add("M", f"{page}line {mean.line}", _quoted(mean.raw), _mean(mean))
    draft.not_understood += [
        f"{page}line {one.line}: {' '.join(one.raw.split())[:80]} ({one.why})"
        for one in sorted([*missed, *without], key=_line)
    ]
    return draft


def _line(one: NotRead) -> int:
    return one.line


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _statistic(one: FoundStatistic, asked: str, correction: str) -> Iterator[str]:
    yield "checks:"
    if one.kind == "F" and correction and one.df[0] != "1" and "." not in "".join(one.df):
        yield f"  # ? `{correction}` stands in the text: is p corrected, df not? Then epsilon: open"
    if one.kind in ("t", "z", "r") and not one.tails:
        yield f"  # ? {asked}"
    if one.note:
        yield f"  # ? {one.note}"
    if one.kind == "H":
        yield '  # ? groups: ["n1", "n2", ...], if they are few: the exact p is tried'
    df = f", df: {json.dumps(list(one.df))}" if one.df else ""
    df += f", tails: {one.tails}" if one.tails else ""
    yield (f"  - {{check: p_value, kind: {one.kind}, statistic: {json.dumps(one.statistic)}{df}, "
           f"p: {json.dumps(one.p)},")  # fmt: skip
    yield '     reads: "The printed p belongs to the printed statistic."}'


def _interval(one: FoundInterval, skewed: str) -> Iterator[str]:
    more = "".join(f", {k}: {json.dumps(v)}" for k, v in (("se", one.se), ("p", one.p)) if v)
    check = (f"{{check: confidence_interval, estimate: {json.dumps(one.value)}, "
             f"low: {json.dumps(one.low)}, high: {json.dumps(one.high)}, "
             f"level: {json.dumps(one.level)}{more},")  # fmt: skip
    reads = 'reads: "The estimate lies in the middle of its interval, as it is or as a logarithm."}'
    if skewed:
        yield "missing: whether the interval is symmetric is not known"
        yield f"# ? `{skewed}` stands in the text: such intervals are skewed. If this is none:"
        yield "# checks:"
        yield f"#   - {check}"
        yield f"#      {reads}"
        return
    yield "checks:"
    yield "  # ? A bootstrapped or profile interval need not be symmetric: then take this out."
    yield f"  - {check}"
    yield f"     {reads}"


def _mean(one: FoundMean) -> Iterator[str]:
    yield "missing: the step of the values is not told"
    n = json.dumps(one.n) if one.n else '"?"'
    spread = "" if one.of == "sd" else ", spread: se"
    what = "" if one.n else " n does not stand beside it."
    yield f"# ? Do the values come in steps (points, frames)? Then, with the step as grain:{what}"
    yield "# checks:"
    yield (f"#   - {{check: grimmer, mean: {json.dumps(one.mean)}, sd: {json.dumps(one.sd)}, "
           f'n: {n}, grain: "1"{spread}, divisor: either,')  # fmt: skip
    yield '#      reads: "Points."}'
