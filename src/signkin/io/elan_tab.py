"""ELAN's tab-delimited export (File > Export As > Tab-delimited Text), with or without header.

Two layouts: a row an annotation (tier, participant, times, text), and, with `separate column for
each tier`, a row an interval with a column a tier. Times come in up to five spellings at once; the
finest that is there is read (ms, then seconds, then h:m:s.ms), and the others must agree with it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from signkin.annotation import Annotation, TierWish
from signkin.errors import SignkinError, listed
from signkin.io.collecting import Collected, TierName, choose_tiers, told_apart
from signkin.io.registry import annotation_reader
from signkin.io.text_rows import Row, TimeFormat, read_text

_SPELLINGS = {
    "ms": re.compile(r"-?[0-9]+"),
    "s": re.compile(r"-?[0-9]+[.,][0-9]+"),
    "timecode": re.compile(r"-?[0-9]+:[0-9]{2}:[0-9]{2}[.,][0-9]+"),
}
_FRAMES = re.compile(r"[0-9]+:[0-9]{2}:[0-9]{2}[:;][0-9]+")  # SMPTE, beside another spelling
_COLUMN = re.compile(r"(?P<what>begin|end|duration)(?: time)?(?: - (?P<how>.+))?", re.IGNORECASE)
_OFFSET = re.compile(r"offset:\s*([0-9]{1,12})", re.IGNORECASE)
_HOW = {"msec": "ms", "ss.msec": "s", "hh:mm:ss.ms": "timecode"}
_TOLERANCE_S = 0.0015  # two spellings may be rounded differently
EXPECTED = "ELAN's tab-delimited text: tier, participant, begin, end, (duration,) text"


@annotation_reader("elan_tab", suffixes=())
def read_elan_tab(
    path: Path,
    *,
    tiers: tuple[TierWish, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    encoding: str | None = None,
    media_offset: str | None = None,
) -> Annotation:
    """Read tiers of an export; None reads every tier.

    media_offset: where a remark tells that a medium starts later, whether ELAN `added` it to the
    times (a choice in its dialogue) or `not_added`; times count in the medium that it names.
    """
    # ELAN puts no quotes around cells. Media and their offsets are remarks at the start.
    lines = read_text(path, encoding).split("\n")
    offset_s = _media_offset(lines, media_offset)
    rows = [
        Row(number, tuple(line.split("\t")))
        for number, line in enumerate(lines, start=1)
        if line.strip() and not re.match(r'"?#', line)
    ]
    if not rows:
        raise SignkinError("nothing in it", place="line 1", expected=EXPECTED)
    found = _with_header(rows) if _is_header(rows[0]) else _without_header(rows)
    names = told_apart([TierName(tag.tier, tag.participant) for tag in found])
    chosen = choose_tiers(tiers, list(dict.fromkeys(names)))
    wanted = {tier for those in chosen.values() for tier in those}
    collected = Collected()
    seen: dict[tuple[float, float, str, str], int] = {}
    for tag, tier in zip(found, names, strict=True):
        if tier.name in wanted:
            first = seen.setdefault((tag.start_s, tag.end_s, tag.text, tier.name), tag.line)
            if first != tag.line:
                collected.leave_out(tier.name, f"line {tag.line}", f"the same as line {first}")
                continue
            start, end = tag.start_s + offset_s, tag.end_s + offset_s
            collected.add(start, end, tag.text, tier.name, f"line {tag.line}")
    return collected.annotation(name or path.stem, tiers, chosen)


def _media_offset(lines: Sequence[str], declared: str | None) -> float:
    """Return what to add to times (s); media that start later than others want a word."""
    if declared not in (None, "added", "not_added"):
        raise SignkinError(
            f"media_offset is {str(declared)[:40]!r}",
            place="media_offset",
            expected="added or not_added",
        )
    found = [
        (number, int(match[1]))
        for number, line in enumerate(lines, start=1)
        if re.match(r'"?#', line) and (match := _OFFSET.search(line))
    ]
    offsets = {ms for _, ms in found}
    if not offsets - {0}:
        return 0.0
    if declared is None or (declared == "not_added" and len(offsets) > 1):
        line, ms = next((n, ms) for n, ms in found if ms)
        raise SignkinError(
            f"a medium with an offset of {ms} ms",
            place=f"line {line}",
            expected="one clock, and whether ELAN added it to the times",
            todo="Declare options: {media_offset: added} or not_added"
            + (", and clock_offset_s in recordings.csv." if len(offsets) > 1 else "."),
        )
    return offsets.pop() / 1000 if declared == "not_added" else 0.0


@dataclass(frozen=True)
class _Tag:
    line: int
    tier: str
    participant: str
    start_s: float
    end_s: float
    text: str


def _spelling(cell: str) -> str | None:
    text = cell.strip()
    if _FRAMES.fullmatch(text):
        return "frames"
    return next((name for name, rule in _SPELLINGS.items() if rule.fullmatch(text)), None)


def _is_header(row: Row) -> bool:
    found = [m for cell in row.cells if (m := _COLUMN.fullmatch(cell.strip()))]
    return {m["what"].lower() for m in found} >= {"begin"} and not any(map(_spelling, row.cells))


def _with_header(rows: Sequence[Row]) -> list[_Tag]:
    head = [cell.strip() for cell in rows[0].cells]
    times: dict[str, list[int]] = {"begin": [], "end": [], "duration": []}
    for i, cell in enumerate(head):
        found = _COLUMN.fullmatch(cell)
        if found and (found["how"] or "msec").lower() in _HOW:
            times[found["what"].lower()].append(i)
        elif found:
            times.setdefault("other", []).append(i)
    columns = {i for places in times.values() for i in places}
    lower = [cell.lower() for cell in head]
    tier_at = lower.index("tier") if "tier" in lower else None
    person_at = lower.index("participant") if "participant" in lower else None
    texts = [i for i in range(len(head)) if i not in columns and i not in (tier_at, person_at)]
    if tier_at is not None and len(texts) != 1:
        raise SignkinError(
            f"the columns {listed(head[i] for i in texts)} beside tier and times",
            place=f"line {rows[0].line}",
            expected="one with the annotations' text",
        )
    out = []
    for row in rows[1:]:
        # ELAN leaves out the empty cells at the end of a line.
        cells = [*row.cells, *[""] * (len(head) - len(row.cells))]
        if len(cells) > len(head):
            raise SignkinError(
                f"{len(cells)} cells", place=f"line {row.line}", expected=f"{len(head)} at most"
            )
        start, end = _times(cells, [times[what] for what in ("begin", "end", "duration")], row.line)
        person = "" if person_at is None else cells[person_at].strip()
        for i in texts:
            if tier_at is not None:
                out.append(_Tag(row.line, cells[tier_at], person, start, end, cells[i]))
            elif cells[i]:
                out.append(_Tag(row.line, head[i], person, start, end, cells[i]))
    return out


def _without_header(rows: Sequence[Row]) -> list[_Tag]:
    out = []
    for row in rows:
        kinds = [_spelling(cell) for cell in row.cells]
        last = next((i for i in range(2, len(kinds)) if kinds[i] is None), len(kinds))
        if last == len(kinds) and len(kinds) > 2:
            last -= 1  # a text that looks like a time
        groups = _grouped(kinds[2:last]) if last + 1 == len(kinds) else None
        if groups is None:
            raise SignkinError(
                f"found {chr(9).join(row.cells)[:60]!r}",
                place=f"line {row.line}",
                expected=EXPECTED,
            )
        usable = [[i + 2 for i in group if kinds[i + 2] != "frames"] for group in groups]
        start, end = _times(row.cells, [*usable, []][:3], row.line)
        tier, person = row.cells[0], row.cells[1].strip()
        out.append(_Tag(row.line, tier, person, start, end, row.cells[last]))
    return out


def _grouped(kinds: Sequence[str | None]) -> list[list[int]] | None:
    """Return the cells of begin, end and duration: each in the same spellings, in one order."""
    for groups in (3, 2):
        if len(kinds) < groups or len(kinds) % groups:
            continue
        size = len(kinds) // groups
        parts = [list(range(k * size, (k + 1) * size)) for k in range(groups)]
        shapes = {tuple(kinds[i] for i in part) for part in parts}
        if len(shapes) == 1 and len(set(next(iter(shapes)))) == size:
            return parts
    return None


def _times(cells: Sequence[str], groups: Sequence[Sequence[int]], line: int) -> tuple[float, float]:
    begin, end, duration = (_time(cells, group, line) for group in groups)
    if begin is None or (end is None and duration is None):
        raise SignkinError("no begin, or no end", place=f"line {line}", expected=EXPECTED)
    if end is None:
        assert duration is not None
        return begin, begin + duration
    if duration is not None and abs(end - begin - duration) > 2 * _TOLERANCE_S:
        raise SignkinError(
            f"{begin:.3f} s to {end:.3f} s, which is no duration of {duration:.3f} s",
            place=f"line {line}",
            expected="times that agree",
        )
    return begin, end


def _time(cells: Sequence[str], places: Sequence[int], line: int) -> float | None:
    found = []
    for i in places:
        kind = _spelling(cells[i])
        if kind is None or kind == "frames":
            raise SignkinError(
                f"found {cells[i][:40]!r}", place=f"line {line}", expected="a time, as ELAN writes"
            )
        found.append((list(_SPELLINGS).index(kind), TimeFormat(kind, None).seconds(
            cells[i].strip().replace(",", "."), f"line {line}")))  # fmt: skip
    if not found:
        return None
    values = [value for _, value in sorted(found)]
    if max(values) - min(values) > _TOLERANCE_S:
        raise SignkinError(
            f"one time is {min(values):.3f} s and {max(values):.3f} s",
            place=f"line {line}",
            expected="spellings that agree",
        )
    return values[0]
