"""Test statistics in running text, as APA style prints them: t(38) = 2.10, p = .04.

F, t, chi-squared, r, z, H, Q and U's z, each with its degrees of freedom and its p. Text layers
of PDF files break signs apart (`χ 2 (1, N = 52)`), lose them (`t(12) 5 2.3`) and wrap lines; what
is read is kept with its place, and what looks like a statistic and is not read is told, too.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

_NUM = r"(?:\d{1,3}(?:,\d{3})+(?:\.\d+)?|\d+(?:\.\d+)?|\.\d+)"
_SIGNED = rf"[-\u2212\u2013\u2012]?\s?{_NUM}"
_SUB = r"(?P<sub>\d{1,4}(?:\.\d+)?(?:,\s?\d{1,4}(?:\.\d+)?)?)"  # t38 = 2.1: df below the line
_DF = (
    rf"\s?[(\[]\s*(?P<df>{_NUM}(?:\s*[,;]\s*{_NUM})?)\s*"
    rf"(?:[,;]\s*[Nn]\s*=\s*(?P<n>{_NUM}))?\s*[)\]]"
)
_KIND = (
    r"(?P<kind>(?<![A-Za-z])(?:[tF]|[rzZQH]|(?:χ|X|chi|Chi|\u03c7|\U0001d712|\u2e31)\s?[-\s]?"
    r"(?:\^?\s?2|\u00b2|square[d]?)|(?<![\w.,;=]\s)(?<![\w.,])2(?=\s?\()))"  # a lost chi
)
_SCI = r"(?:[eE][-+\u2212]?\d+|\s?[x×*·]\s?10\s?\^?\s?[-\u2212\u2013]?\s?\d+)?"
_TAILS = r"(?:one|two|1|2)[- ]?(?:tailed|sided)"
_P = (
    rf"(?P<p>n\.?\s?s\.?|(?:{_TAILS}\s)?[pP](?:[- ]values?)?\s?(?:\(?{_TAILS}\)?\s?)?"
    rf"(?:[<>=≤≥]\s?=?|\bis\b)\s?(?:10\s?\^?\s?[-\u2212\u2013]\s?\d+|{_NUM}{_SCI})"
    r"|[pP]\s?=?\s?n\.?\s?s\.?)"
)
_BETWEEN = (  # its df, an effect size or two and an interval may stand before the p
    rf"(?:\s?[,;]\s?(?:df|d\.f\.|DF)\s?=\s?(?P<told>{_NUM}(?:\s?[,;/]\s?{_NUM}(?=\s?[,;]))?))?"
    r"(?:\s?[,;]|\s)\s?\(?"
    r"(?:(?:[^\W\d][^=<>()\[\],;]{0,24})?\s?=\s?[-\u2212\u2013]?\s?(?:\d{1,3}(?:,\d{3})+|\d*)(?:\.?\d+)"
    r"\s?%?\s?[,;]\s?|\d\d(?:\.\d)?\s?%\s?CI\s?[:=]?\s?[\[(][^\])]{3,40}[\])]\s?[,;]\s?){0,4}"
)
STATISTIC = re.compile(
    rf"{_KIND}(?:{_DF}|(?<=[tF]){_SUB})?\s?(?P<sign>[=<>])\s?(?P<value>{_SIGNED})"
    rf"(?P<between>{_BETWEEN}){_P}(?P<after>\s?[(,]?\s?{_TAILS})?"
)
# A letter, perhaps degrees of freedom, and a sign: perhaps a statistic that was not read.
_LOOKS = re.compile(
    r"(?<![A-Za-z])(?:(?:[tFrzQHUW]|χ\s?[2²])\s?(?:[(\[][^()\[\]\n]{1,24}[)\]])?"
    r"|[tF]\s?\d{1,4}(?:,\s?\d{1,4})?|(?:r_?s|[A-Za-zχρτ][\w²'\u2019]{0,9})"
    r"\s?[(\[]\s?\d[\d., ]*[)\]]|(?:r_?s|[ρτ]))\s?[=<>]\s?[-\u2212]?[\d.]+"
)
_COMMA = re.compile(r"[=<>]\s?[-\u2212\u2013]?\d*,\d(?!\d\d[.,]\d)")
_POINT = re.compile(r"[=<>]\s?[-\u2212\u2013]?\d*\.\d")
_SIGN_OF_COMMA = re.compile(
    r"(?P<kept>[Fχ2²]\s?[(\[]\s?\d+,\d+\s?[)\]])|(?<=\d),(?=\d)|(?<![\w,.]),(?=\d)"
)
_WITHOUT = {"t": 1, "F": 2, "r": 1, "chi2": 1, "H": 1, "Q": 1, "z": 0}
MOST_TEXT = 5_000_000


@dataclass(frozen=True)
class FoundStatistic:
    """A statistic as a text prints it. kind: F, t, chi2, r, z, H or Q; p: with its sign."""

    kind: str
    df: tuple[str, ...]
    statistic: str
    p: str
    raw: str
    line: int
    column: int
    tails: str = ""  # `one` or `two`, where it stands beside the p
    note: str = ""  # what was taken for what

    @property
    def place(self) -> str:
        """`line 12, column 5`."""
        return f"line {self.line}, column {self.column}"


@dataclass(frozen=True)
class NotRead:
    """What looks like a statistic and was not read, with why."""

    raw: str
    line: int
    why: str


def statistics_in(text: str) -> tuple[list[FoundStatistic], list[NotRead]]:
    """Return the statistics of a text in order, and what looks like one but was not read."""
    text = text[:MOST_TEXT]
    # One sign a sign, so that places stay: line breaks are spaces.
    flat = re.sub(r"[\n\r\t\u00a0\u2009\u202f\u2002\u2003]", " ", text)
    found: list[FoundStatistic] = []
    missed: list[NotRead] = []
    taken: list[tuple[int, int]] = []
    for match in STATISTIC.finditer(flat):
        one = _read(match, text)
        if isinstance(one, NotRead):
            missed.append(one)
        else:
            found.append(one)
        taken.append(match.span())
    missed += _left_over(flat, text, taken)
    return found, sorted(missed, key=lambda m: m.line)


def with_points(text: str) -> tuple[str, bool]:
    """Return a text with decimal points where all its numbers have commas, and whether it has.

    No sign is added or taken away, so that places stay.
    """
    if len(_COMMA.findall(text)) == 0 or _POINT.search(text):
        return text, False
    return _SIGN_OF_COMMA.sub(lambda m: m["kept"] or ".", text), True


def _left_over(flat: str, text: str, taken: list[tuple[int, int]]) -> Iterator[NotRead]:
    at = 0
    for match in _LOOKS.finditer(flat):
        while at < len(taken) and taken[at][1] <= match.start():
            at += 1
        if at < len(taken) and taken[at][0] <= match.start():
            continue
        line = text.count("\n", 0, match.start()) + 1
        why = "no p stands behind it in a form that is read"
        if not re.match(r"(?:[tFrzQHUW]|χ\s?[2²])(?![A-Za-z_])", match[0]):
            why = "a statistic of another kind than F, t, chi-squared, z, r, H and Q"
        yield NotRead(match[0].strip(), line, why)


def kind_of(sign: str) -> str:
    """Return the kind of a statistic by its sign in the text."""
    bare = sign.strip()
    if bare in ("t", "F", "r", "Q", "H"):
        return bare
    return "z" if bare in ("z", "Z") else "chi2"


def _read(match: re.Match[str], text: str) -> FoundStatistic | NotRead:
    raw = " ".join(match[0].split())
    line = text.count("\n", 0, match.start()) + 1
    column = match.start() - (text.rfind("\n", 0, match.start()) + 1) + 1
    kind = kind_of(match["kind"])
    # `10, 200` is two degrees of freedom, `1,200` one number only where the kind wants one.
    df = _numbers(match["df"] or match["sub"] or match["told"] or "", _WITHOUT[kind])
    note = ""
    if kind == "r" and not df and (size := re.search(r"(?<![A-Za-z])[nN]\s?=\s?(\d+)", raw)):
        df, note = (str(int(size[1]) - 2),), "df is n - 2, as of a plain correlation"
    if kind == "F" and len(df) == 1:
        return NotRead(raw, line, "F has one number of degrees of freedom, and wants two")
    if kind in ("chi2", "Q", "H") and len(df) == 2:  # (1, 52): the number of people, without N =
        df = df[:1]
    if kind == "z":
        df = ()
    if len(df) != _WITHOUT[kind]:
        return NotRead(raw, line, f"{kind} has {len(df)} degrees of freedom")
    value = plain(match["value"])
    sign = match["sign"] if match["sign"] != "=" else ""
    beside = re.search(
        r"(one|1|two|2)[- ]?(?:tailed|sided)", f"{match['p']} {match['after'] or ''}"
    )
    tails = {"1": "one", "2": "two"}.get(beside[1], beside[1]) if beside else ""
    return FoundStatistic(
        kind, df, sign + value, p_text(match["p"]), raw, line, column, tails, note
    )


def _numbers(text: str, wanted: int) -> tuple[str, ...]:
    parts = [p.strip() for p in re.split(r"[;,]", text) if p.strip()]
    if len(parts) == 2 and wanted == 1 and re.fullmatch(r"\d{1,3},\d{3}(\.\d+)?", text.strip()):
        parts = ["".join(parts)]
    if len(parts) > 2 and wanted == 2:  # 1, 1,181
        parts = [parts[0], "".join(parts[1:])]
    return tuple(parts)


def plain(text: str) -> str:
    """Return a printed number with a plain minus, without thousands' commas and spaces."""
    bare = re.sub(r"\s", "", text)
    bare = re.sub(r"^[\u2212\u2013\u2012]", "-", bare)
    return re.sub(r"(?<=\d),(?=\d{3})", "", bare)


def p_text(text: str) -> str:
    """Return a p as `.03`, `<.001` or `ns`."""
    bare = re.sub(rf"\(?{_TAILS}\)?\s?", "", text.strip())
    bare = re.sub(r"^[pP](?:[- ]values?)?\s?", "", bare)
    if re.match(r"=?\s?n", bare):
        return "ns"
    bare = re.sub(r"^(=|is)\s?", "", bare).replace("\u2212", "-").replace("\u2013", "-")
    bare = re.sub(r"\s", "", bare)
    power = re.fullmatch(r"([<>≤≥]?=?)(?:([\d.,]+)[x×*·])?10\^?(-\d+)", bare)
    return f"{power[1]}{power[2] or 1}e{power[3]}" if power else bare
