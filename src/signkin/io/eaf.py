"""ELAN annotation files (.eaf): read through pympi, written by insertion.

Reading adds what pympi leaves open: times of nested tiers (a symbolic child
has its parent's interval; children that subdivide it share it evenly), times
that the file leaves open, and the offset of the media clock (TIME_ORIGIN).

Writing never rewrites the file: new time slots, tiers and one linguistic type
are inserted at their places in the bytes that are there, and what an earlier
run inserted is taken out first. So everything else stays as it was, and a
second run changes no byte.
"""

from __future__ import annotations

import re
import xml.parsers.expat
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape, quoteattr

from pympi.Elan import Eaf

from signkin.annotation import Annotation, Interval
from signkin.errors import SignkinError, listed
from signkin.io.registry import annotation_reader

# Every identifier that signkin inserts starts with this, so that a later run finds its own.
MARK = "signkin"
LINGUISTIC_TYPE = f"{MARK}-segmentation"


@annotation_reader("eaf", suffixes=(".eaf",))
def read_eaf(
    path: Path,
    *,
    tiers: tuple[str, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    unaligned: str = "refuse",
    clock_media: str | None = None,
) -> Annotation:
    """Read tiers of an ELAN file; None reads every tier.

    unaligned: what to do with times that the file leaves open: `refuse`, or
    `interpolate` (evenly between the aligned times around them on the tier).
    clock_media: file name of the medium whose clock the motion shares, where the
    media of the file start at different times.
    """
    eaf = _load(path)
    wanted = tuple(eaf.tiers) if tiers is None else tiers
    for tier in wanted:
        if tier not in eaf.tiers:
            raise SignkinError(
                f"no tier {tier!r}",
                place="tiers",
                expected=listed(eaf.tiers, 60),
                todo="Tier names are case-sensitive.",
            )
    offset_s = clock_offset_s(eaf.media_descriptors, clock_media)
    times = _TierTimes(eaf, unaligned)
    intervals = [
        Interval(round(start + offset_s, 6), round(end + offset_s, 6), label, tier)
        for tier in wanted
        for start, end, label in times.of(tier)
    ]
    for tier in wanted:
        if tiers is not None and not any(i.tier == tier for i in intervals):
            raise SignkinError("the tier is empty", place=f"tier {tier!r}", expected="intervals")
    return Annotation(
        name=name or path.stem,
        intervals=tuple(intervals),
        clock_offset_s=offset_s,
        interpolated=times.interpolated,
    )


def _load(path: Path) -> Any:
    try:
        return Eaf(str(path), suppress_version_warning=True)
    except Exception as error:  # pympi raises bare exceptions and lets key errors through
        raise SignkinError(
            f"not readable as an ELAN file ({type(error).__name__}: {error})",
            expected="an .eaf that ELAN opens",
        ) from error


def clock_offset_s(media: Sequence[Mapping[str, str]], clock_media: str | None) -> float:
    """Return what to add to the file's times: the TIME_ORIGIN of the medium that motion shares."""
    origins = {
        Path(medium.get("MEDIA_URL", "")).name: int(medium.get("TIME_ORIGIN") or 0)
        for medium in media
    }
    if clock_media is not None:
        if clock_media not in origins:
            raise SignkinError(
                f"no medium {clock_media!r}", place="clock_media", expected=listed(origins)
            )
        return origins[clock_media] / 1000
    if len(set(origins.values())) > 1:
        told = listed(f"{medium} at {origin} ms" for medium, origin in origins.items())
        raise SignkinError(
            f"the media start at different times ({told})",
            place="TIME_ORIGIN",
            expected="one clock",
            todo="Name the medium that the motion shares its clock with as `clock_media`.",
        )
    return next(iter(origins.values()), 0) / 1000


class _TierTimes:
    """Times of a tier's annotations in the file's own clock, in seconds."""

    def __init__(self, eaf: Any, unaligned: str) -> None:
        if unaligned not in ("refuse", "interpolate"):
            raise SignkinError(
                f"unaligned is {unaligned!r}", place="unaligned", expected="refuse or interpolate"
            )
        self.eaf = eaf
        self.unaligned = unaligned
        self.interpolated = 0
        self._spans: dict[str, dict[str, tuple[float, float]]] = {}

    def of(self, tier: str) -> list[tuple[float, float, str]]:
        spans = self.spans(tier)
        aligned, referring = self.eaf.tiers[tier][:2]
        labels = {key: row[2] for key, row in aligned.items()}
        labels.update({key: row[1] for key, row in referring.items()})
        return [(*spans[key], labels[key]) for key in labels]

    def spans(self, tier: str) -> dict[str, tuple[float, float]]:
        if tier not in self._spans:
            self._spans[tier] = {}  # a tier that is its own ancestor finds nothing here
            self._spans[tier] = {**self._aligned(tier), **self._referring(tier)}
        return self._spans[tier]

    def _aligned(self, tier: str) -> dict[str, tuple[float, float]]:
        rows = self.eaf.tiers[tier][0]
        slots: dict[str, float | None] = {
            slot: None if ms is None else ms / 1000 for slot, ms in self.eaf.timeslots.items()
        }
        used = [slot for row in rows.values() for slot in row[:2]]
        missing = [slot for slot in used if slots.get(slot) is None]
        if missing and self.unaligned == "refuse":
            raise SignkinError(
                f"{len(set(missing))} times are left open (the first is slot {missing[0]})",
                place=f"tier {tier!r}",
                expected="aligned times",
                todo="Align them in ELAN, or set `unaligned: interpolate`.",
            )
        if missing:
            self._fill(tier, used, slots)
        return {key: (slots[row[0]] or 0.0, slots[row[1]] or 0.0) for key, row in rows.items()}

    def _fill(self, tier: str, used: list[str], slots: dict[str, float | None]) -> None:
        """Spread runs of open slots evenly; an annotation's end may be the next one's start."""
        order = list(dict.fromkeys(used))
        known = [i for i, slot in enumerate(order) if slots.get(slot) is not None]
        for i, slot in enumerate(order):
            if slots.get(slot) is not None:
                continue
            before = max((k for k in known if k < i), default=None)
            after = min((k for k in known if k > i), default=None)
            if before is None or after is None:
                raise SignkinError(
                    f"the time of slot {slot} is open and no aligned time stands on both sides",
                    place=f"tier {tier!r}",
                    expected="aligned times around it",
                )
            low, high = slots[order[before]], slots[order[after]]
            assert low is not None and high is not None
            slots[slot] = low + (high - low) * (i - before) / (after - before)
            self.interpolated += 1

    def _referring(self, tier: str) -> dict[str, tuple[float, float]]:
        rows = self.eaf.tiers[tier][1]
        if not rows:
            return {}
        parents = {key: self._parent_span(tier, row[0]) for key, row in rows.items()}
        siblings: dict[str, list[str]] = {}
        for key in _in_chain_order(rows):
            siblings.setdefault(rows[key][0], []).append(key)
        out = {}
        for children in siblings.values():
            subdivides = any(rows[key][2] for key in children)
            for i, key in enumerate(children):
                start, end = parents[key]
                width = (end - start) / len(children)
                out[key] = (start + i * width, start + (i + 1) * width) if subdivides else (
                    start,
                    end,
                )  # fmt: skip
        return out

    def _parent_span(self, tier: str, parent: str) -> tuple[float, float]:
        owner = self.eaf.annotations.get(parent)
        spans = self.spans(owner) if owner is not None else {}
        if parent not in spans:
            raise SignkinError(
                f"an annotation refers to {parent}, which is not in the file",
                place=f"tier {tier!r}",
                expected="a parent annotation",
            )
        return spans[parent]


def _in_chain_order(rows: Mapping[str, tuple[str, str, str | None, Any]]) -> list[str]:
    """Order children by PREVIOUS_ANNOTATION; the file may list them in any order."""
    after = {row[2]: key for key, row in rows.items() if row[2]}
    order: list[str] = []
    for key, row in rows.items():
        if row[2]:
            continue
        link: str | None = key
        while link is not None and link not in order:
            order.append(link)
            link = after.get(link)
    return order + [key for key in rows if key not in order]


# --- writing ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class NewTier:
    """A tier to insert; intervals in seconds of the recording's clock."""

    name: str
    intervals: tuple[Interval, ...]


def insert_tiers(content: bytes, tiers: Sequence[NewTier], clock_offset_s: float = 0.0) -> bytes:
    """Return an ELAN file's bytes with tiers added and everything else untouched.

    Tiers that an earlier call inserted are replaced. Each time becomes a time slot
    of its own, put into TIME_ORDER by its value; milliseconds, as ELAN keeps them.
    """
    content = _without_own(content)
    layout = _layout(content)
    insertions: list[tuple[int, str]] = []
    tier_blocks = []
    for t, tier in enumerate(tiers, start=1):
        if tier.name in layout.tier_names:
            raise SignkinError(
                f"the file has a tier {tier.name!r} already",
                place="tiers",
                expected="a name that is free",
            )
        annotations = []
        for i, interval in enumerate(tier.intervals, start=1):
            slots = []
            for edge, time_s in (("a", interval.start_s), ("b", interval.end_s)):
                # ELAN has no times before its media: a tag there is put at their start.
                ms = max(0, round((time_s - clock_offset_s) * 1000))
                slot = f"{MARK}_ts{t}_{i}{edge}"
                slots.append(slot)
                text = f'<TIME_SLOT TIME_SLOT_ID="{slot}" TIME_VALUE="{ms}"/>'
                insertions.append((layout.slot_place(ms), text))
            annotations.append(
                f'<ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="{MARK}_a{t}_{i}" '
                f'TIME_SLOT_REF1="{slots[0]}" TIME_SLOT_REF2="{slots[1]}">'
                f"<ANNOTATION_VALUE>{escape(interval.label)}</ANNOTATION_VALUE>"
                "</ALIGNABLE_ANNOTATION></ANNOTATION>"
            )
        tier_blocks.append(
            f"<TIER TIER_ID={quoteattr(tier.name)} "
            f'LINGUISTIC_TYPE_REF="{LINGUISTIC_TYPE}">{"".join(annotations)}</TIER>'
        )
    insertions.append((layout.tier_place, "".join(tier_blocks)))
    insertions.append(
        (
            layout.type_place,
            f'<LINGUISTIC_TYPE LINGUISTIC_TYPE_ID="{LINGUISTIC_TYPE}" TIME_ALIGNABLE="true" '
            'GRAPHIC_REFERENCES="false"/>',
        )
    )
    return _inserted(content, insertions)


def _inserted(content: bytes, insertions: Sequence[tuple[int, str]]) -> bytes:
    out, done = bytearray(), 0
    # Slots at one place are told apart by their value: TIME_ORDER is kept in order of time.
    for place, text in sorted(insertions, key=lambda item: (item[0], _slot_value(item[1]))):
        out += content[done:place] + text.encode("utf-8")
        done = place
    return bytes(out + content[done:])


def _slot_value(text: str) -> int:
    value = re.match(r'<TIME_SLOT [^>]*TIME_VALUE="(-?\d+)"', text)
    return int(value.group(1)) if value else -1


_OWN = re.compile(
    rb'<TIME_SLOT TIME_SLOT_ID="signkin_[^>]*/>'
    rb'|<TIER TIER_ID=(?:"[^"]*"|\'[^\']*\') LINGUISTIC_TYPE_REF="signkin-segmentation">.*?</TIER>'
    rb'|<LINGUISTIC_TYPE LINGUISTIC_TYPE_ID="signkin-segmentation"[^>]*/>',
    re.DOTALL,
)


def _without_own(content: bytes) -> bytes:
    return _OWN.sub(b"", content)


@dataclass
class _Layout:
    """Byte places of an ELAN file at which something can be inserted."""

    slots: list[tuple[int, int]] = field(default_factory=list)  # (value in ms, place)
    slots_end: int = -1
    tier_place: int = -1
    type_place: int = -1
    tier_names: list[str] = field(default_factory=list)

    def slot_place(self, ms: int) -> int:
        """Return the place before the first slot that is later than `ms`."""
        return next((place for value, place in self.slots if value > ms), self.slots_end)


def _layout(content: bytes) -> _Layout:
    layout = _Layout()
    parser = xml.parsers.expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        if tag == "TIME_SLOT" and attributes.get("TIME_VALUE"):
            layout.slots.append((int(attributes["TIME_VALUE"]), parser.CurrentByteIndex))
        elif tag == "TIER":
            layout.tier_names.append(attributes["TIER_ID"])

    def end(tag: str) -> None:
        # The parser stands at `</A>`, or right behind `<A/>`.
        place = parser.CurrentByteIndex
        closing = content.startswith(f"</{tag}".encode(), place)
        after = content.index(b">", place) + 1 if closing else place
        if tag == "TIME_ORDER":
            layout.slots_end = place if closing else -1
            layout.tier_place = after
        elif tag == "TIER":
            layout.tier_place = after
        elif tag == "LINGUISTIC_TYPE":
            layout.type_place = after

    def declaration(version: str, encoding: str | None, standalone: int) -> None:
        if encoding is not None and encoding.lower() not in ("utf-8", "us-ascii"):
            raise SignkinError(
                f"the file is written in {encoding}",
                expected="UTF-8, as ELAN writes it",
                todo="Open and save it in ELAN.",
            )

    parser.XmlDeclHandler = declaration
    parser.StartElementHandler = start
    parser.EndElementHandler = end
    try:
        parser.Parse(content, True)
    except xml.parsers.expat.ExpatError as error:
        raise SignkinError(f"not well-formed XML ({error})", expected="an ELAN file") from error
    if layout.slots_end < 0 or layout.tier_place < 0 or layout.type_place < 0:
        raise SignkinError(
            "no TIME_ORDER with time slots, or no LINGUISTIC_TYPE",
            expected="an ELAN file with at least one tagged tier",
        )
    return layout


def write_eaf(
    path: Path,
    *,
    author: str,
    date: str,
    media_url: str,
    tiers: Sequence[tuple[str, str | None, Sequence[Interval]]],
) -> None:
    """Write a new ELAN file: (tier, parent tier or None, intervals), same input, same bytes.

    A tier with a parent is included in it (its intervals have times of their own).
    """
    eaf = Eaf(author=author)
    eaf.adocument["DATE"] = date
    eaf.add_linked_file(media_url, mimetype="unknown")
    eaf.remove_tier("default")
    eaf.add_linguistic_type("included", constraints="Included_In")
    for name, parent, intervals in tiers:
        if parent is None:
            eaf.add_tier(name)
        else:
            eaf.add_tier(name, ling="included", parent=parent)
        for interval in intervals:
            eaf.add_annotation(
                name,
                round(interval.start_s * 1000),
                round(interval.end_s * 1000),
                interval.label,
            )
    path.unlink(missing_ok=True)  # pympi would keep the old file as a .bak
    eaf.to_file(str(path))
