"""ELAN annotation files (.eaf), 2.0 to 3.0: read by structure, each annotation kept.

Annotations are kept in lists, since real files use an id twice; a parent is looked up in the
parent tier alone. A symbolic child has its parent's interval; children that subdivide it share
it evenly; times that the file leaves open are spread by `open_slots`. Only what is used must
be there: names of properties, descriptions of constraints or the schema's address need not.

Schema: EAFv3.0.xsd; behaviour where files break it: ELAN's own parser.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

from signkin.annotation import Annotation, TierWish
from signkin.errors import SignkinError, listed
from signkin.io.collecting import Collected, TierName, choose_tiers
from signkin.io.eaf_write import WHOLE, NewTier, elan_copy, insert_tiers, write_eaf
from signkin.io.open_slots import fill_open
from signkin.io.registry import annotation_reader
from signkin.io.xml_tree import Element, parse
from signkin.rows import composed

__all__ = ["NewTier", "clock_offset_s", "elan_copy", "insert_tiers", "read_eaf", "write_eaf"]

# Seconds of one unit of TIME_VALUE, by the header's TIME_UNITS.
SECONDS_PER_UNIT = {"milliseconds": 0.001, "PAL-frames": 0.04, "NTSC-frames": 1001 / 30000}
EXPECTED = "an .eaf that ELAN opens"


@annotation_reader("eaf", suffixes=(".eaf",))
def read_eaf(
    path: Path,
    *,
    tiers: tuple[TierWish, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    unaligned: str = "refuse",
    clock_media: str | None = None,
    time_units: str | None = None,
) -> Annotation:
    """Read tiers of an ELAN file; None reads every tier.

    unaligned: what to do with times that the file leaves open: `refuse`, or
    `interpolate` (evenly between the aligned times around them on the tier).
    clock_media: name or address of the medium or linked file whose clock the motion shares,
    where those of the file start at different times.
    time_units: what the times are where the header does not say milliseconds (ELAN itself
    takes them for milliseconds then): milliseconds, PAL-frames or NTSC-frames.
    """
    if unaligned not in ("refuse", "interpolate"):
        raise SignkinError(
            f"unaligned is {unaligned!r}", place="unaligned", expected="refuse or interpolate"
        )
    root = parse(path.read_bytes(), EXPECTED).root
    if root.tag != "ANNOTATION_DOCUMENT":
        raise SignkinError(f"the root is {root.tag[:40]}", place="line 1", expected=EXPECTED)
    file = _File(root)
    offset_s = clock_offset_s(root, clock_media)
    chosen = choose_tiers(tiers, [TierName(t.name, t.participant) for t in file.tiers.values()])
    times = _Times(file, _seconds_per_unit(root, time_units), unaligned == "interpolate")
    collected = Collected()
    for wanted in dict.fromkeys(name for names in chosen.values() for name in names):
        tier = file.tiers[wanted]
        for tag, span in zip(tier.tags, times.spans(tier), strict=True):
            place = f"annotation {tag.key}, line {tag.line}"
            if isinstance(span, str):
                collected.leave_out(wanted, place, span)
                continue
            if tag.value is None:
                raise SignkinError(
                    f"annotation {tag.key} has no ANNOTATION_VALUE",
                    place=f"tier {wanted!r}, line {tag.line}",
                    expected="one, which may be empty",
                )
            # Microseconds: what even shares of milliseconds leave behind them is no time.
            start, end = (round(t + offset_s, 6) for t in span)
            collected.add(start, end, tag.value, wanted, place)
    return collected.annotation(
        name or path.stem, tiers, chosen, clock_offset_s=offset_s, interpolated=times.interpolated
    )


def _seconds_per_unit(root: Element, declared: str | None) -> float:
    header = next(iter(root.all("HEADER")), None)
    found = (header.get("TIME_UNITS") if header is not None else None) or "milliseconds"
    unit = declared or found
    if unit not in SECONDS_PER_UNIT or (declared is None and found != "milliseconds"):
        raise SignkinError(
            f"TIME_UNITS is {unit!r}",
            place="HEADER" if declared is None else "time_units",
            expected=listed(SECONDS_PER_UNIT) if declared else "milliseconds",
            todo="Say what the times are as `time_units`; ELAN takes them for milliseconds.",
        )
    return SECONDS_PER_UNIT[unit]


# --- the clock ---------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Clock:
    """A medium or linked file: its addresses, and where its start lies (ms)."""

    addresses: tuple[str, ...]
    origin_ms: int
    binding: bool  # whether it must agree with the others where none is chosen

    @property
    def names(self) -> tuple[str, ...]:
        plain = (unquote(address).replace("\\", "/") for address in self.addresses)
        return tuple(dict.fromkeys(PurePosixPath(address).name for address in plain))


def clock_offset_s(root: Element, clock_media: str | None) -> float:
    """Return what to add to the file's times: the TIME_ORIGIN of the file that motion shares.

    Media and linked files count alike; a linked file without a TIME_ORIGIN (settings of ELAN,
    say) has no clock of its own, but can be named.
    """
    clocks = [_clock(e) for header in root.all("HEADER") for e in header.children
              if e.tag in ("MEDIA_DESCRIPTOR", "LINKED_FILE_DESCRIPTOR")]  # fmt: skip
    told = [f"{clock.addresses[0] if clock.addresses else '?'} at {clock.origin_ms} ms"
            for clock in clocks]  # fmt: skip
    if clock_media is not None:
        wanted = composed(clock_media)
        found = [c for c in clocks if wanted in map(composed, c.addresses)]
        found = found or [c for c in clocks if wanted in map(composed, c.names)]
        if not found:
            names = dict.fromkeys(name for clock in clocks for name in clock.names)
            raise SignkinError(
                f"no medium {clock_media!r}", place="clock_media", expected=listed(names)
            )
        origins = {clock.origin_ms for clock in found}
        if len(origins) > 1:
            raise SignkinError(
                f"several media are called {clock_media!r} ({listed(told)})",
                place="clock_media",
                expected="the whole MEDIA_URL of one",
            )
        return origins.pop() / 1000
    origins = {clock.origin_ms for clock in clocks if clock.binding}
    if len(origins) > 1:
        raise SignkinError(
            f"the media start at different times ({listed(told)})",
            place="TIME_ORIGIN",
            expected="one clock",
            todo="Name the medium that the motion shares its clock with as `clock_media`.",
        )
    return next(iter(origins), 0) / 1000


def _clock(element: Element) -> _Clock:
    medium = element.tag == "MEDIA_DESCRIPTOR"
    kind = "MEDIA_URL" if medium else "LINK_URL"
    addresses = (element.get(kind), element.get(f"RELATIVE_{kind}"))
    written = element.get("TIME_ORIGIN") or "0"
    if not re.fullmatch(r"\s*[+-]?[0-9]{1,15}\s*", written, re.ASCII):
        raise SignkinError(
            f"TIME_ORIGIN is {written[:40]!r}",
            place=f"line {element.line}",
            expected="whole milliseconds",
        )
    own = medium or element.get("TIME_ORIGIN") is not None
    return _Clock(tuple(a for a in addresses if a), int(written), own)


# --- what is in the file -------------------------------------------------------------------------


@dataclass(slots=True)
class Tag:
    """An annotation: two slots, or a parent and perhaps the one before it."""

    key: str
    line: int
    value: str | None
    slots: tuple[str, str] | None
    parent: str = ""
    previous: str = ""


@dataclass(eq=False)
class Tier:
    """A tier with its annotations in the file's order."""

    name: str
    parent: str | None
    participant: str
    line: int
    subdivides: bool
    tags: list[Tag] = field(default_factory=list)


class _File:
    """Slots and tiers of a document."""

    def __init__(self, root: Element) -> None:
        self.values: dict[str, str | None] = {}
        self.slot_lines: dict[str, int] = {}
        for order in root.all("TIME_ORDER"):
            for slot in order.all("TIME_SLOT"):
                self._add_slot(slot)
        kinds = {
            kind.get("LINGUISTIC_TYPE_ID"): kind.get("CONSTRAINTS")
            for kind in root.all("LINGUISTIC_TYPE")
        }
        self.tiers: dict[str, Tier] = {}
        for element in root.all("TIER"):
            tier = Tier(
                name=element.need("TIER_ID"),
                parent=element.get("PARENT_REF") or None,
                participant=element.get("PARTICIPANT") or "",
                line=element.line,
                subdivides=_is(kinds.get(element.get("LINGUISTIC_TYPE_REF")), "subdivision"),
            )
            if tier.name in self.tiers:
                raise SignkinError(
                    f"the tier {tier.name!r} stands in line {self.tiers[tier.name].line} already",
                    place=f"line {tier.line}",
                    expected="each tier once",
                )
            tier.tags = [_tag(annotation) for annotation in element.all("ANNOTATION")]
            self.tiers[tier.name] = tier

    def _add_slot(self, slot: Element) -> None:
        key, value = slot.need("TIME_SLOT_ID"), slot.get("TIME_VALUE")
        if key in self.values and self.values[key] != value:
            raise SignkinError(
                f"slot {key} has another time in line {self.slot_lines[key]}",
                place=f"line {slot.line}",
                expected="each slot once",
            )
        self.values.setdefault(key, value)
        self.slot_lines.setdefault(key, slot.line)


def _is(constraint: str | None, kind: str) -> bool:
    return constraint is not None and constraint.lower() == f"symbolic_{kind}"


def _tag(annotation: Element) -> Tag:
    inside = annotation.all("ALIGNABLE_ANNOTATION", "REF_ANNOTATION")
    if len(inside) != 1:
        raise SignkinError(
            f"an ANNOTATION holds {len(inside)} annotations",
            place=f"line {annotation.line}",
            expected="one, ALIGNABLE_ANNOTATION or REF_ANNOTATION",
        )
    element = inside[0]
    values = element.all("ANNOTATION_VALUE")
    if len(values) > 1 or any(value.children for value in values):
        raise SignkinError(
            f"an annotation with {len(values)} values, or elements inside its text",
            place=f"line {element.line}",
            expected="one ANNOTATION_VALUE, of text",
        )
    value = None if not values else values[0].text
    key = element.get("ANNOTATION_ID") or "without id"
    if element.tag == "REF_ANNOTATION":
        previous = element.get("PREVIOUS_ANNOTATION") or ""
        return Tag(key, element.line, value, None, element.need("ANNOTATION_REF"), previous)
    slots = (element.need("TIME_SLOT_REF1"), element.need("TIME_SLOT_REF2"))
    return Tag(key, element.line, value, slots)


# --- times ---------------------------------------------------------------------------------------

# The times of an annotation (s, the file's clock), or why it has none.
Span = tuple[float, float] | str


class _Times:
    """Times of tiers in the file's own clock, each tier's worked out once."""

    def __init__(self, file: _File, seconds_per_unit: float, interpolate: bool) -> None:
        self.file = file
        self.interpolate = interpolate
        self.faults: dict[str, str] = {}
        self.known: dict[str, float | None] = {}
        for key, value in file.values.items():
            self.known[key] = None
            if value is None:
                continue
            if WHOLE.fullmatch(value):
                self.known[key] = int(value) * seconds_per_unit
            else:
                self.faults[key] = (
                    f"slot {key} has TIME_VALUE {value[:40]} in line {file.slot_lines[key]}, "
                    "expected whole milliseconds"
                )
        self._filled: dict[str, float] | None = None
        self._used: set[str] = set()
        self._spans: dict[str, list[Span]] = {}

    @property
    def interpolated(self) -> int:
        """Number of times that were interpolated and used."""
        return len(self._used)

    def spans(self, tier: Tier) -> list[Span]:
        """Return the times of a tier's annotations, in the tier's order."""
        line: list[Tier] = []
        while tier.name not in self._spans and tier not in line:
            line.append(tier)
            if all(tag.slots is not None for tag in tier.tags):
                break
            tier = self._parent_of(tier)
        else:
            if tier in line:
                raise SignkinError(
                    "the tier is its own ancestor",
                    place=f"tier {tier.name!r}, line {tier.line}",
                    expected="a parent tier that does not hang on it",
                )
        while line:  # ancestors first
            tier = line.pop()
            self._spans[tier.name] = self._of(tier)
        return self._spans[tier.name]

    def _parent_of(self, tier: Tier) -> Tier:
        if tier.parent is not None:
            if tier.parent not in self.file.tiers:
                raise SignkinError(
                    f"the parent tier {tier.parent!r} is not there",
                    place=f"tier {tier.name!r}, line {tier.line}",
                    expected=listed(self.file.tiers, 60),
                )
            return self.file.tiers[tier.parent]
        wanted = next(tag.parent for tag in tier.tags if tag.slots is None)
        owners = [
            t
            for t in self.file.tiers.values()
            if t is not tier and any(tag.key == wanted for tag in t.tags)
        ]
        if len(owners) != 1:
            raise SignkinError(
                f"annotations refer to others ({wanted}), and the tier names no parent tier",
                place=f"tier {tier.name!r}, line {tier.line}",
                expected="a PARENT_REF",
            )
        return owners[0]

    def _of(self, tier: Tier) -> list[Span]:
        out: list[Span] = ["" for _ in tier.tags]
        for i, tag in enumerate(tier.tags):
            if tag.slots is not None:
                out[i] = self._aligned(tier, tag, tag.slots)
        if any(tag.slots is None for tag in tier.tags):
            for i, span in _shares(tier, self._parents(tier)).items():
                out[i] = span
        return out

    def _aligned(self, tier: Tier, tag: Tag, slots: tuple[str, str]) -> Span:
        for slot in slots:
            if slot not in self.known:
                raise SignkinError(
                    f"annotation {tag.key} refers to slot {slot}, which is not in the file",
                    place=f"tier {tier.name!r}, line {tag.line}",
                    expected="a slot of TIME_ORDER",
                )
            if slot in self.faults:
                return self.faults[slot]
        start, end = (self._time(tier, slot) for slot in slots)
        return start, end

    def _time(self, tier: Tier, slot: str) -> float:
        time = self.known[slot]
        if time is not None:
            return time
        if not self.interpolate:
            open_slots = [
                s for tag in tier.tags for s in tag.slots or ()
                if s not in self.faults and self.known.get(s, 0.0) is None
            ]  # fmt: skip
            raise SignkinError(
                f"{len(set(open_slots))} times are left open (the first is slot {slot})",
                place=f"tier {tier.name!r}",
                expected="aligned times",
                todo="Align them in ELAN, or set `unaligned: interpolate`.",
            )
        if self._filled is None:
            self._filled = fill_open(self._edges(), self.known)
        if slot not in self._filled:
            raise SignkinError(
                f"the time of slot {slot} is open and no aligned time stands on both sides",
                place=f"tier {tier.name!r}",
                expected="aligned times around it",
            )
        self._used.add(slot)
        return self._filled[slot]

    def _edges(self) -> list[list[tuple[str, str]]]:
        """Return the pairs of slots of each tier, parents before their children."""
        depth: dict[str, int] = {}
        for tier in self.file.tiers.values():
            line = [tier.name]
            while line[-1] not in depth:
                up = self.file.tiers[line[-1]].parent
                if up is None or up not in self.file.tiers or up in line:
                    depth[line[-1]] = 0
                else:
                    line.append(up)
            for below, above in zip(line[-2::-1], line[:0:-1], strict=True):
                depth[below] = depth[above] + 1
        order = sorted(self.file.tiers.values(), key=lambda tier: depth[tier.name])
        usable = self.known.keys() - self.faults.keys()
        return [
            [tag.slots for tag in tier.tags if tag.slots and usable.issuperset(tag.slots)]
            for tier in order
        ]

    def _parents(self, tier: Tier) -> dict[str, Span]:
        """Return the times of each parent that the tier's annotations refer to."""
        above = self._parent_of(tier)
        wanted = {tag.parent for tag in tier.tags if tag.slots is None}
        found: dict[str, tuple[int, Span]] = {}
        for tag, span in zip(above.tags, self._spans[above.name], strict=True):
            if tag.key not in wanted:
                continue
            if tag.key in found and found[tag.key][1] != span:
                raise SignkinError(
                    f"{tag.key} is used twice (lines {found[tag.key][0]} and {tag.line}), and "
                    f"tier {tier.name!r} refers to it",
                    place=f"tier {above.name!r}",
                    expected="each id once",
                    todo="Save the file in ELAN, which gives new ids.",
                )
            found.setdefault(tag.key, (tag.line, span))
        for tag in tier.tags:
            if tag.slots is None and tag.parent not in found:
                raise SignkinError(
                    f"annotation {tag.key} refers to {tag.parent}, which is not on the tier "
                    f"{above.name!r}",
                    place=f"tier {tier.name!r}, line {tag.line}",
                    expected="a parent annotation",
                )
        return {
            key: f"its parent {key}: {span}" if isinstance(span, str) else span
            for key, (_, span) in found.items()
        }


def _shares(tier: Tier, parents: Mapping[str, Span]) -> dict[int, Span]:
    """Return the times of annotations that refer to others: the parent's, or a share of them."""
    children: dict[str, list[int]] = {}
    for i, tag in enumerate(tier.tags):
        if tag.slots is None:
            children.setdefault(tag.parent, []).append(i)
    out: dict[int, Span] = {}
    for parent, own in children.items():
        span = parents[parent]
        if isinstance(span, str):
            out.update(dict.fromkeys(own, span))
            continue
        start, end = span
        divided = tier.subdivides or any(tier.tags[i].previous for i in own)
        width = (end - start) / len(own)
        for place, i in enumerate(_in_chain_order(tier.tags, own)):
            # The last one ends where the parent does, whatever the sum of the shares.
            last = end if place == len(own) - 1 else start + (place + 1) * width
            out[i] = (start + place * width, last) if divided else (start, end)
    return out


def _in_chain_order(tags: list[Tag], own: list[int]) -> list[int]:
    """Order children by PREVIOUS_ANNOTATION; the file may list them in any order."""
    ids = {tags[i].key for i in own}
    after: dict[str, list[int]] = {}
    for i in own:
        if tags[i].previous in ids:
            after.setdefault(tags[i].previous, []).append(i)
    order: dict[int, None] = {}
    heads = [i for i in own if tags[i].previous not in ids]
    for head in [*heads, *own]:
        stack = [head]
        while stack:
            i = stack.pop()
            if i not in order:
                order[i] = None
                stack += reversed(after.get(tags[i].key, []))
    return list(order)
