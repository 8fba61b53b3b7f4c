"""Words and cells of printed tables: which column is n, mean or SD, and what a cell says.

A header such as `Group A (n = 20) M (SD)` has a size, two roles and a rest, the group's name.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

NAMES = {
    "n": "n number count participants subjects size samplesize noofparticipants sample_n "
    "numberofparticipants noofsubjects numberofsubjects no",
    "mean": "mean m average avg meanscore means x̄ mw",
    "sd": "sd std stdev standarddeviation stddev stddeviation sds",
    "se": "se sem standarderror stderror stderr stderrormean standarderrormean "
    "standarderrorofthemean standarderrorofmean seb",
    "t": "t tvalue tstatistic tratio",
    "F": "f fvalue fratio fstatistic",
    "chi2": "χ2 χ² chi2 chi² chisquare chisquared x2 x²",
    "z": "z zvalue zscore",
    "df": "df dof degreesoffreedom",
    "p": "p pvalue sig sig2tailed probability",
    "d": "d cohensd",
    "b": "b estimate coef coefficient unstandardizedb unstandardisedb",
    "beta": "β beta standardizedβ standardisedβ standardizedbeta standardisedbeta",
    "percent": "% percent percentage",
    "low": "min minimum",
    "high": "max maximum",
}  # fmt: skip
ROLE_OF = {name: role for role, names in NAMES.items() for name in names.split()}
TESTS = ("t", "F", "chi2", "z", "df", "p", "d")
_SIZE = re.compile(r"[(\[,;]?\s*\b[nN]\s*=\s*(?P<n>\d[\d,]*)\s*[)\]]?")
_SD = r"(?:SDs?|S\.D\.|s\.d\.|[Ss]tandard [Dd]eviations?|[Ss]td\.? ?[Dd]ev(?:iation|\.)?)"
_SE = r"(?:SEM?|S\.E\.(?:M\.)?|s\.e\.(?:m\.)?|[Ss]tandard [Ee]rrors?)"
_MEAN = r"(?:[Mm]eans?(?: [Ss]cores?)?|M|[Aa]verage|MW)"
_N = r"(?:[Nn]|[Nn]o\.?|[Nn]umber|[Cc]ount|[Ff]requency)"
_PAIRS = (
    (("mean", "sd"), re.compile(rf"\b{_MEAN}\s*[,;]?\s*[(\[±/,]\s*±?\s*{_SD}\s*[)\]]?")),
    (("mean", "se"), re.compile(rf"\b{_MEAN}\s*[,;]?\s*[(\[±/,]\s*±?\s*{_SE}\s*[)\]]?")),
    (("count", "percent"), re.compile(rf"\b{_N}\s*[(\[/,]\s*%\s*[)\]]?")),
    (("percent", "count"), re.compile(rf"%\s*[(\[/,]\s*{_N}\s*[)\]]?")),
)  # fmt: skip
_EDGE = {"mean": _MEAN, "sd": _SD, "se": _SE, "n": "[Nn]"}
_DF = re.compile(
    r"(?P<sign>[tFzH]|χ\s?[2²])\s*[(\[]\s*(?:df\s*=\s*)?"
    r"(?P<df>[\d.]+(?:\s*[,;]\s*[\d.]+)?)\s*[)\]]"
)

_DIGITS = r"(?:\d{1,3}(?:,\d{3})+(?:\.\d+)?|\d+(?:[.,]\d+)?|[.,]\d+)"
_MARKS = r"(?:\s?[*†‡§#]+|[a-e](?:,\s?[a-e])*)?"  # stars of significance, letters of footnotes
_BARE = re.compile(rf"(?P<number>[-+]?{_DIGITS})\s?%?{_MARKS}")
_PAIR = re.compile(
    rf"(?P<first>[-+]?{_DIGITS})\s?%?{_MARKS}\s*(?:[(\[]\s*±?\s*(?P<second>{_DIGITS})\s?%?\s*[)\]]"
    rf"|(?:±|\+/-)\s*(?P<other>{_DIGITS})){_MARKS}"
)
_BRACKETED = re.compile(rf"[(\[]\s*±?\s*{_DIGITS}\s*[)\]]")
_OTHER = re.compile(
    r"[-\u2013\u2014]+|n\.?\s?s\.?|[\[(][-\u2212\d.,;\s\u2013]{3,24}[\])]"
)  # a dash, ns, an interval
_SPACES = re.compile("[\u00a0\u2007\u2008\u2009\u200a\u202f\u2002\u2003]")


@dataclass(frozen=True)
class Header:
    """What a header cell, or a row's label, says: roles, n, degrees of freedom, and the rest."""

    roles: tuple[str, ...] = ()
    rest: str = ""
    n: str = ""
    df: str = ""


def tidy(cell: str) -> str:
    """Return a cell with plain spaces and a plain minus."""
    bare = _SPACES.sub(" ", cell).strip()
    return re.sub(r"^[\u2212\u2013\u2012](?=\s?[\d.,])\s?", "-", bare)


def role_of(text: str) -> str:
    """Return the role that a whole cell names, or nothing."""
    bare = re.sub(r"[\s_.\-'\u2019()]", "", text)
    if bare == "T":  # Student's is small
        return ""
    return ROLE_OF.get(bare.lower(), "")


def header_of(text: str) -> Header:
    """Return what a header cell says."""
    bare = tidy(text)
    if role := role_of(bare):
        return Header((role,))
    if match := _DF.fullmatch(bare):
        sign = "chi2" if match["sign"].startswith("χ") else match["sign"]
        return Header((sign,), df=match["df"])
    size = _SIZE.search(bare)
    n = size["n"].replace(",", "") if size else ""
    if size:
        bare = f"{bare[: size.start()]} {bare[size.end() :]}".strip()
        if role := role_of(bare):
            return Header((role,), n=n)
    for roles, pattern in _PAIRS:
        if match := pattern.search(bare):
            return Header(roles, _rest(bare[: match.start()], bare[match.end() :]), n)
    for role, edge in _EDGE.items():
        match = re.match(rf"{edge}\b\.?(?=[\s,:;(])", bare) or re.search(
            rf"(?:(?<=[\s,:;_])|(?<=\())\b{edge}\)?$", bare
        )
        if match and match[0].strip("() ") != bare:
            return Header((role,), _rest(bare[: match.start()], bare[match.end() :]), n)
    return Header((), _rest(bare), n)


def names_a_test(text: str) -> bool:
    """Whether a header names a test's number: t, F(2, 57), p."""
    roles = header_of(text).roles
    return len(roles) == 1 and roles[0] in TESTS


def _rest(*parts: str) -> str:
    words = " ".join(part.strip(" ,;:()[]_-\u2013\u2014") if part.count("(") != part.count(")")
                     else part.strip(" ,;:_-\u2013\u2014") for part in parts)  # fmt: skip
    return re.sub(r"\s+", " ", words.replace("()", " ")).strip()


def bare_number(cell: str) -> str:
    """Return a cell's number without stars, footnote letters and percent signs, or nothing."""
    match = _BARE.fullmatch(tidy(cell))
    return _plain(match["number"]) if match else ""


def pair_of(cell: str) -> tuple[str, str] | None:
    """Return both numbers of `5.1 (1.2)`, `5.1 [1.2]` or `5.1 ± 1.2`."""
    match = _PAIR.fullmatch(tidy(cell))
    return (_plain(match["first"]), _plain(match["second"] or match["other"])) if match else None


def in_brackets(cell: str) -> bool:
    """Whether a cell is one number in brackets, as under a mean."""
    return _BRACKETED.fullmatch(tidy(cell)) is not None


def is_numeric(cell: str) -> bool:
    """Whether a cell has one or two numbers, a p or a dash."""
    text = tidy(cell)
    bare = re.sub(r"^[<>=≤≥]\s?", "", text)
    return bool(bare_number(bare) or pair_of(text) or in_brackets(text) or _OTHER.fullmatch(text))


def _plain(number: str) -> str:
    """Take thousands' commas out: `1,204`; `0,204` is a decimal comma, and stays."""
    return number.replace(",", "") if re.fullmatch(r"[-+]?[1-9]\d{0,2}(,\d{3})+(\.\d+)?", number) \
        else number  # fmt: skip


def decimal_commas(rows: Iterable[Sequence[str]]) -> tuple[int, int]:
    """Return how many cells have a decimal comma, and how many a decimal point."""
    texts = [tidy(cell) for row in rows for cell in row if is_numeric(cell)]
    commas = sum(bool(re.search(r"(?<![\d,])(?:\d*,\d{1,2}|0,\d+|\d*,\d{4,}|,\d+)(?![\d,])", t))
                 for t in texts)  # fmt: skip
    return commas, sum(bool(re.search(r"\d*\.\d", t)) for t in texts)
