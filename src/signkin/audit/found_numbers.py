"""Means with their SDs, and estimates with their confidence intervals, in running text."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from signkin.audit.apa import NotRead, p_text, plain

_NUM = r"[-\u2212\u2013]?\s?(?:\d+(?:\.\d+)?|\.\d+)"
_INTERVAL = re.compile(
    rf"(?P<level>\d\d(?:\.\d)?)\s?%\s?(?:CI|confidence interval)s?\s?[:=]?\s?[\[(]?\s?"
    rf"(?P<low>{_NUM})\s?(?:,|;|to|\u2013|\u2014)\s?(?P<high>{_NUM})(?![\d.]*\d)\s?[\])]?"
    rf"(?:\s?[,;]\s?(?P<p>p\s?[=<>]\s?(?:\d*\.\d+|\d)))?"
)
_ESTIMATE = re.compile(
    rf"(?<![A-Za-z])(?P<name>[bB\u03b2MdgrR]|beta|OR|RR|HR|aOR|MD|M\s?diff|[Ee]stimate|[Dd]ifference)"
    rf"\s?(?:=|of)\s?(?P<value>{_NUM})(?![\d.]*\s?%)"
)
_SE = re.compile(rf"(?<![A-Za-z])(?:SE|S\.E\.|s\.e\.)\s?=\s?(?P<se>{_NUM})")
_SKEW = ("d", "g", "R")  # their intervals need not be symmetric
REACH = 90  # signs before an interval in which its estimate is looked for
_MEAN = re.compile(
    rf"(?<![A-Za-z])M\s?=\s?(?P<mean>{_NUM})\s?[,;]?\s?\(?(?P<of>SD|SE|SEM)\s?=\s?(?P<sd>{_NUM})"
)
_SIZE = re.compile(r"(?<![A-Za-z])[nN]\s?=\s?(\d{1,6})(?![\d.])")


@dataclass(frozen=True)
class FoundInterval:
    """An estimate with its interval, digits as printed; `se` and `p` may be empty."""

    name: str
    value: str
    low: str
    high: str
    level: str
    se: str
    p: str
    raw: str
    line: int


@dataclass(frozen=True)
class FoundMean:
    """A mean with its SD or standard error; n is empty where none stands beside it."""

    mean: str
    sd: str
    of: str
    n: str
    raw: str
    line: int


def _flat(text: str) -> str:
    return re.sub(r"[\n\r\t\u00a0\u2009\u202f]", " ", text)


def intervals_in(text: str) -> tuple[list[FoundInterval], list[NotRead]]:
    """Return the confidence intervals that have an estimate before them, and those without."""
    flat, found, missed = _flat(text), [], []
    last = 0
    for match in _INTERVAL.finditer(flat):
        line = text.count("\n", 0, match.start()) + 1
        before = flat[max(last, match.start() - REACH) : match.start()]
        last = match.end()
        estimates = list(_ESTIMATE.finditer(before))
        raw = " ".join(match[0].split())
        if not estimates:
            missed.append(NotRead(raw, line, "no estimate stands before this interval"))
            continue
        one = estimates[-1]
        if one["name"] in _SKEW:
            why = f"the interval of {one['name']} need not be symmetric"
            missed.append(NotRead(raw, line, why))
            continue
        se = _SE.search(before, one.end())
        found.append(FoundInterval(
            one["name"], plain(one["value"]), plain(match["low"]), plain(match["high"]),
            match["level"], plain(se["se"]) if se else "", p_text(match["p"]) if match["p"] else "",
            " ".join(f"{before[one.start() :]}{raw}".split()), line,
        ))  # fmt: skip
    return found, missed


def means_in(text: str) -> Iterator[FoundMean]:
    """Yield each `M = 5.19, SD = 1.20`, with the n that stands in the same brackets."""
    flat = _flat(text)
    for match in _MEAN.finditer(flat):
        opened = flat.rfind("(", max(0, match.start() - REACH), match.start() + 1)
        closed = flat.find(")", match.end(), match.end() + REACH)
        around = flat[opened if opened >= 0 else match.start() : closed if closed >= 0 else None]
        sizes = _SIZE.findall(around[: 3 * REACH]) if opened >= 0 else []
        yield FoundMean(
            plain(match["mean"]), plain(match["sd"]), "sd" if match["of"] == "SD" else "se",
            sizes[0] if len(sizes) == 1 else "", " ".join(match[0].split()),
            text.count("\n", 0, match.start()) + 1,
        )  # fmt: skip
