"""Praat TextGrid files, long and short form, as text in UTF-8 or UTF-16: the interval tiers.

Read as Praat reads them: of the whole text only free-standing numbers, texts in double quotes (a
quote inside is doubled) and flags in angle brackets count, so that both forms are one. An interval
without text is a gap between tags. Source: Praat manual, "TextGrid file formats".
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

from signkin.annotation import Annotation, TierWish
from signkin.errors import SignkinError
from signkin.io.collecting import Collected, TierName, choose_tiers
from signkin.io.registry import annotation_reader
from signkin.io.text_rows import decoded

_TOKEN = re.compile(r'"(?:[^"]|"")*"|"|![^\n]*|[^\s"]+')
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?", re.ASCII)
ROUNDING_S = 0.0015  # programs round ends of files and tiers differently
EXPECTED = "a TextGrid as Praat writes it (text, not binary)"


@annotation_reader("textgrid", suffixes=(".textgrid",))
def read_textgrid(
    path: Path,
    *,
    tiers: tuple[TierWish, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    encoding: str | None = None,
) -> Annotation:
    """Read interval tiers; times are those of the sound, whatever xmin says.

    Tiers of one name are told apart as `NAME (1)`, `NAME (2)`. Point tiers hold no intervals:
    one that is asked for is an error, in a reading of all tiers its points are listed.
    encoding: where the file is neither UTF-8 nor UTF-16.
    """
    content = path.read_bytes()
    if content.startswith(b"ooBinaryFile"):
        raise SignkinError("a binary TextGrid", place="line 1", expected=EXPECTED)
    tokens = _Tokens(decoded(content, encoding))
    found = _tiers(tokens)
    chosen = choose_tiers(tiers, [TierName(tier.name) for tier in found])
    wanted = {tier for names in chosen.values() for tier in names}
    collected = Collected()
    for tier in found:
        if tier.name not in wanted:
            continue
        if tier.points and tiers is not None:
            raise SignkinError(
                f"{tier.name!r} is a point tier", place=f"line {tier.line}", expected="intervals"
            )
        for start, end, text, line in tier.intervals:
            if tier.points:
                collected.leave_out(tier.name, f"line {line}", "a point, no interval")
            elif text.strip():
                collected.add(start, end, text, tier.name, f"line {line}")
    return collected.annotation(name or path.stem, tiers, chosen)


class _Tier:
    def __init__(self, name: str, points: bool, line: int) -> None:
        self.name = name
        self.points = points
        self.line = line
        self.intervals: list[tuple[float, float, str, int]] = []


def _tiers(tokens: _Tokens) -> list[_Tier]:
    kind, line = tokens.text("a file type")
    shape, _ = tokens.text("an object class")
    if not kind.startswith("ooTextFile") or shape != "TextGrid":
        raise SignkinError(
            f"the file type is {kind[:40]!r}, the class {shape[:40]!r}",
            place=f"line {line}",
            expected=EXPECTED,
        )
    tokens.number("xmin")
    tokens.number("xmax")
    flag, line = tokens.flag()
    if flag != "exists":
        raise SignkinError("no tiers", place=f"line {line}", expected="tiers <exists>")
    out = []
    for _ in range(tokens.count("the number of tiers")):
        shape, line = tokens.text("the class of a tier")
        if shape not in ("IntervalTier", "TextTier"):
            raise SignkinError(
                f"the class of a tier is {shape[:40]!r}",
                place=f"line {line}",
                expected="IntervalTier or TextTier",
            )
        name, _ = tokens.text("the name of a tier")
        tier = _Tier(name, shape == "TextTier", line)
        low, high = tokens.number("xmin")[0], tokens.number("xmax")[0]
        last = low
        for _ in range(tokens.count("the number of intervals")):
            start, line = tokens.number("a time")
            end = start if tier.points else tokens.number("a time")[0]
            text, _ = tokens.text("a text")
            if start < last - ROUNDING_S or end > high + ROUNDING_S:
                raise SignkinError(
                    f"an interval from {start:g} to {end:g} s, where the last one ends at "
                    f"{last:g} s and the tier at {high:g} s",
                    place=f"line {line}",
                    expected="intervals that follow one another within xmin and xmax",
                )
            last = end if end >= start else last
            tier.intervals.append((start, end, text, line))
        out.append(tier)
    tokens.end()
    names = Counter(tier.name for tier in out)
    number: Counter[str] = Counter()
    for tier in out:
        number[tier.name] += 1
        if names[tier.name] > 1:
            tier.name = f"{tier.name} ({number[tier.name]})"
    return out


class _Tokens:
    """What counts in a text, with the line it stands in."""

    def __init__(self, text: str) -> None:
        self._found: list[tuple[str, str, int]] = []  # kind, value, line
        line, done = 1, 0
        for match in _TOKEN.finditer(text):
            token = match.group()
            line += text.count("\n", done, match.start())
            done = match.start()
            if token == '"':
                raise SignkinError(
                    "a text in quotes does not end", place=f"line {line}", expected='a closing "'
                )
            if token.startswith('"'):
                self._found.append(("text", token[1:-1].replace('""', '"'), line))
            elif _NUMBER.fullmatch(token):
                self._found.append(("number", token, line))
            elif token.startswith("<") and token.endswith(">"):
                self._found.append(("flag", token[1:-1], line))
        self._last = line
        self._next = 0

    def _take(self, kind: str, what: str) -> tuple[str, int]:
        if self._next >= len(self._found):
            raise SignkinError(
                "the file ends early", place=f"line {self._last}", expected=f"{what} ({kind})"
            )
        found, value, line = self._found[self._next]
        if found != kind:
            raise SignkinError(
                f"found {value[:40]!r}", place=f"line {line}", expected=f"{what} ({kind})"
            )
        self._next += 1
        return value, line

    def text(self, what: str) -> tuple[str, int]:
        """Return the next text and its line."""
        return self._take("text", what)

    def flag(self) -> tuple[str, int]:
        """Return the next flag and its line."""
        return self._take("flag", "<exists>")

    def number(self, what: str) -> tuple[float, int]:
        """Return the next number and its line."""
        value, line = self._take("number", what)
        return float(value), line

    def count(self, what: str) -> int:
        """Return the next number, which is to be a whole one that the file can hold."""
        value, line = self._take("number", what)
        left = len(self._found) - self._next
        if not re.fullmatch(r"\+?[0-9]{1,12}", value) or int(value) > left:
            raise SignkinError(
                f"{what} is {value[:40]}, and {left} items follow",
                place=f"line {line}",
                expected="a whole number that fits",
            )
        return int(value)

    def end(self) -> None:
        """Refuse what follows the last tier."""
        if self._next < len(self._found):
            _, value, line = self._found[self._next]
            raise SignkinError(
                f"found {value[:40]!r} behind the last tier",
                place=f"line {line}",
                expected="the end, or a larger number of tiers or intervals",
            )
