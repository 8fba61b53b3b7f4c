"""Tables in running text: rows of numbers, with the lines of names above them.

Cells stand apart by tabs, bars or two spaces; where a PDF's text layer left one space, the
numbers at a line's end are its cells, and columns are found by their place, or their number.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from signkin.audit.table_words import header_of, names_a_test, role_of

MOST_TABLES, MOST_LINE, MOST_HEADERS = 100, 400, 3
_RULE = re.compile(r"[-=_+|:\s\u2013\u2014\u2500\u2502]+")
_NUMBER = r"[-+\u2212\u2013]?\s?(?:\d+(?:[.,]\d+)*|[.,]\d+)\s?%?"
_MARKS = r"(?:\s?[*†‡]{1,3}|[a-e](?![A-Za-z]))?"
CELL = re.compile(
    rf"(?<![^\s])(?:[<>=≤≥]\s?)?{_NUMBER}{_MARKS}"
    rf"(?:\s?(?:\(\s?{_NUMBER}\)|\[\s?{_NUMBER}\]|±\s?{_NUMBER}){_MARKS})?(?![^\s])"
    rf"|(?<![^\s])(?:\(\s?{_NUMBER}\)|[\u2013\u2014-]|n\.?s\.?)(?![^\s])"
    rf"|(?<![^\s])\[\s?{_NUMBER}\s?[,;]\s?{_NUMBER}\s?\](?![^\s])"
    rf"|(?<![^\s])\(?\d+(?:\.\d+)?\s?[-\u2013]\s?\d+(?:\.\d+)?\)?(?![^\s])"  # a range
)
_WORD = re.compile(
    r"(?:M|Mean|mean|%|n|N|No\.)\s?(?:\(\s?(?:SD|SE|SEM|s\.d\.|%|n|N)\s?\)|±\s?(?:SD|SE|SEM))"
    r"|[tFzH]\s?\(\s?[\d.]+(?:\s?,\s?[\d.]+)?\s?\)|Std\. (?:Deviation|Error(?: Mean)?)|\S+"
)
_GROUP = re.compile(r"[^()]*?\(\s?[nN]\s?=\s?\d+\s?\)")
_TITLE = re.compile(r"\s*(?:Table|Tab\.|Figure|Fig\.|Note)\b")


@dataclass(frozen=True)
class Span:
    """A cell of a line, and the places of its first sign and of that after its last."""

    text: str
    start: int
    end: int

    @property
    def middle(self) -> float:
        """Half way."""
        return (self.start + self.end) / 2


@dataclass
class TextTable:
    """A table of a text: its rows, those of its header first, and the line where it starts."""

    rows: list[list[str]]
    line: int
    lost: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class _Line:
    """A row of numbers: its label, its cells, and the number of its line."""

    label: str
    cells: tuple[Span, ...]
    number: int
    exact: bool  # tabs or bars part its cells


def tables_in(text: str) -> Iterator[TextTable]:
    """Yield the tables of a text: two rows of two numbers or more, with names above them.

    Lines of one row are rows too, where the line above names n, means or SDs.
    """
    lines = [line[:MOST_LINE] for line in text.splitlines()]
    at = found = 0
    while at < len(lines) and found < MOST_TABLES:
        block, after = _block(lines, at)
        if not block:
            at += 1
            continue
        table = _table(lines, block, at)
        at = after
        if table is not None:
            found += 1
            yield table


def _block(lines: Sequence[str], start: int) -> tuple[list[_Line], int]:
    """Return the rows of numbers that start at a line, and where they end."""
    rows: list[_Line] = []
    at = start
    while at < len(lines):
        row = _row(lines[at], at)
        if row is None:
            bare = lines[at].strip()
            if not rows or not (bare and (_RULE.fullmatch(bare) or _heading(lines, at))):
                break
            if not _RULE.fullmatch(bare):
                rows.append(_Line(bare.strip("|").strip(), (), at, False))
        else:
            rows.append(row)
        at += 1
    while rows and not rows[-1].cells:
        rows.pop()
    return rows, at


def _heading(lines: Sequence[str], at: int) -> bool:
    """Whether a line without numbers is a heading within a table: rows follow it."""
    bare = lines[at].strip()
    if len(bare) > 40 or bare.endswith((".", ",")) or _TITLE.match(bare) or at + 1 >= len(lines):
        return False
    words = [role_of(word) for word in bare.split()]
    return _row(lines[at + 1], at + 1) is not None and sum(map(bool, words)) < 2


def _row(line: str, number: int) -> _Line | None:
    if "\t" in line or line.count("|") > 1:
        parts = line.split("\t") if "\t" in line else line.strip().strip("|").split("|")
        cells = [part.strip() for part in parts]
        if sum(bool(CELL.fullmatch(c)) for c in cells[1:]) < max(1, (len(cells) - 1) / 2):
            return None
        spans = tuple(Span(c, i, i + 1) for i, c in enumerate(cells[1:]))
        return _Line(cells[0], spans, number, True)
    found = list(CELL.finditer(line))
    # Only those at the end of the line, one after the other.
    kept: list[re.Match[str]] = []
    end = len(line.rstrip())
    for match in reversed(found):
        if line[match.end() : end].strip():
            break
        kept.insert(0, match)
        end = match.start()
    texts = [match[0].strip() for match in kept]
    if len(kept) > 1 and texts == [str(k) for k in range(1, len(kept) + 1)]:
        return None  # the names of columns: the variables of a matrix
    if len(kept) < 2 and not (kept and re.search(r"\S\s{2,}$", line[: kept[0].start()])):
        return None
    label = line[: kept[0].start()].strip()
    if len(label) > 80 or not (label or any(any(map(str.isdigit, m[0])) for m in kept)):
        return None
    return _Line(label, tuple(Span(m[0].strip(), *m.span()) for m in kept), number, False)


def _table(lines: Sequence[str], block: list[_Line], start: int) -> TextTable | None:
    heads = _headers(lines, start)
    rows = [row for row in block if row.cells]
    if not heads or not rows:
        return None
    widths = [len(row.cells) for row in rows]
    tried = sorted(set(widths), key=lambda w: (-widths.count(w), -w))
    if re.search(r"(?<![\d.(])1\s+2(?:\s+\d+)*$", heads[-1].strip()):  # a triangle of correlations
        tried = [max(widths)]
    if not rows[0].exact and len(set(widths)) == 1:  # labels that end in a number
        tried.append(widths[0] - 1)
    lower = None
    for width in tried:
        if width and (lower := _lower(heads[-1], width, rows)) is not None:
            break
    if lower is None:
        return None
    label, names = lower
    upper = [_upper(line, names, rows, width) for line in heads[:-1]]
    table = [[label, *over] for over in upper] + [[label, *names]]
    out = TextTable(table, start - len(heads) + 1)
    for row in block:
        if not row.cells:
            out.rows.append([row.label, *[""] * width])
        elif len(row.cells) == width:
            out.rows.append([row.label, *(cell.text for cell in row.cells)])
        elif len(row.cells) == width + 1 and not row.exact:  # a label that ends in a number
            words = f"{row.label} {row.cells[0].text}".strip()
            out.rows.append([words, *(cell.text for cell in row.cells[1:])])
        elif (placed := _placed(row, rows, width)) is not None:
            out.rows.append([row.label, *placed])
        else:
            told = " ".join(lines[row.number].split())
            out.lost.append(f"line {row.number + 1}: {told[:60]} (has {len(row.cells)} cells, and "
                            f"the table {width})")  # fmt: skip
    return out


def _headers(lines: Sequence[str], start: int) -> list[str]:
    """Return the lines of names above a row, from the upper one on."""
    out: list[str] = []
    blank = 0
    for at in range(start - 1, max(-1, start - 9), -1):
        bare = lines[at].strip()
        if not bare:
            blank += 1
            if out or blank > 1:
                break
            continue
        if _RULE.fullmatch(bare):
            continue
        names = [w for w in _WORD.findall(bare) if role_of(w) or header_of(w).roles]
        sentence = bare.endswith((".", ",", ":")) and len(names) < 2
        if _TITLE.match(bare) or sentence or len(out) == MOST_HEADERS or len(bare) > 300:
            break
        if out and not _over(bare):
            break
        out.insert(0, lines[at])
    return out


def _over(line: str) -> bool:
    """Whether a line may stand over the names of columns: groups, or words far apart."""
    return bool(re.search(r"\S(?:\s{2,}|\t|\s*\|\s*)\S", line) or _GROUP.search(line)) or len(
        line.split()
    ) <= 4  # fmt: skip


def _spans(line: str) -> list[Span]:
    if "\t" in line or line.count("|") > 1:
        parts = line.split("\t") if "\t" in line else line.strip().strip("|").split("|")
        return [Span(part.strip(), i - 1, i) for i, part in enumerate(parts)]
    return [Span(m[0], *m.span()) for m in re.finditer(r"\S+(?: \S+)*", line)]


def _lower(line: str, width: int, rows: Sequence[_Line]) -> tuple[str, list[str]] | None:
    """Return the label's name and those of the columns, from the line above the rows."""
    spans = _spans(line)
    texts = [span.text for span in spans]
    if len(texts) == width + 1:
        return texts[0], texts[1:]
    if len(texts) == width and not rows[0].exact and not _over_label(spans, rows):
        return "row", texts
    words = _WORD.findall(line.strip())
    if len(words) >= width and all(role_of(w) or header_of(w).roles for w in words[-width:]):
        return " ".join(words[:-width]) or "row", words[-width:]
    groups = [m[0].strip() for m in _GROUP.finditer(line)]
    if len(groups) == width:
        return "row", groups
    placed = _by_place(spans, rows, width)
    return None if placed is None else ("row", placed)


def _over_label(spans: Sequence[Span], rows: Sequence[_Line]) -> bool:
    """Whether the first name stands over the labels, and not over the first column."""
    full = max(rows, key=lambda row: len(row.cells))
    return spans[0].end < full.cells[0].start - 3 and spans[0].start <= len(full.label)


def _by_place(spans: Sequence[Span], rows: Sequence[_Line], width: int) -> list[str] | None:
    """Give each column the names that stand over it; none where a name stands over nothing."""
    columns = _columns(rows, width)
    if columns is None or len(spans) < 2 <= width:
        return None
    names = [""] * width
    for span in spans:
        over = [j for j, (a, b) in enumerate(columns) if span.start < b + 1 and a - 1 < span.end]
        if not over:
            if span.end <= columns[0][0]:
                continue  # over the labels
            over = [min(range(width), key=lambda j: abs(sum(columns[j]) / 2 - span.middle))]
        for j in over[:1] if len(over) > 1 and role_of(span.text) else over:
            names[j] = f"{names[j]} {span.text}".strip()
    return names if any(names) else None


def _columns(rows: Sequence[_Line], width: int) -> list[tuple[int, int]] | None:
    full = [row for row in rows if len(row.cells) == width]
    if not full:
        return None
    columns = [
        (min(row.cells[j].start for row in full), max(row.cells[j].end for row in full))
        for j in range(width)
    ]
    apart = all(a[1] <= b[0] for a, b in pairwise(columns))
    return columns if apart else None


def _upper(line: str, names: Sequence[str], rows: Sequence[_Line], width: int) -> list[str]:
    """Return what an upper line says of each column; columns of tests have no group."""
    tests = {j for j, name in enumerate(names) if names_a_test(name)}
    own = [j for j in range(width) if j not in tests]
    spans = _spans(line)
    groups = [m[0].strip() for m in _GROUP.finditer(line)] if len(spans) == 1 else []
    if not groups and rows[0].exact:
        out, last = [""] * width, ""
        for j in range(width):
            text = spans[j + 1].text if j + 1 < len(spans) else ""
            last = text or last
            out[j] = "" if j in tests else last
        return out
    texts = groups or [span.text for span in spans]
    columns = _columns(rows, width)
    if not groups and columns is not None:
        spans = [s for s in spans if s.end > columns[0][0]]
        if not spans:
            return [""] * width
        return [
            "" if j in tests
            else min(spans, key=lambda s: abs(s.middle - sum(columns[j]) / 2)).text
            for j in range(width)
        ]  # fmt: skip
    if texts and len(own) % len(texts) == 0:
        each = len(own) // len(texts)
        return [texts[own.index(j) // each] if j in own else "" for j in range(width)]
    return [""] * width


def _placed(row: _Line, rows: Sequence[_Line], width: int) -> list[str] | None:
    """Return a row's cells by their place, where it has fewer than there are columns."""
    columns = _columns(rows, width)
    if columns is None or row.exact or len(row.cells) > width:
        return None
    out = [""] * width
    for cell in row.cells:
        over = [j for j, (a, b) in enumerate(columns) if cell.start < b and a < cell.end]
        if len(over) != 1 or out[over[0]]:
            return None
        out[over[0]] = cell.text
    return out
