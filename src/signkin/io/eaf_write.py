"""ELAN files written: tiers inserted into a file that is there, and whole new files.

Insertion never rewrites a file: new slots, tiers and one linguistic type are put at their places
in the bytes that are there, in the file's own encoding. What an earlier call inserted is known by
what it is, not by how one program writes it, so that a copy which ELAN saved is as good:

- an own tier has the name asked for, stands by itself (no parent tier, nothing that refers to
  it), and has either the own type or nothing but own annotations. It is replaced;
- its slots go with it unless another annotation uses them;
- the own type is used again where it is there, and a free name is taken where another is called so.

Every other element is the user's and stays as it is; ids are free ones (EAFv3.0.xsd: each once).
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

from signkin.annotation import Interval
from signkin.errors import SignkinError
from signkin.io.xml_tree import Document, Element, parse

# Every identifier that signkin inserts starts with this.
MARK = "signkin"
LINGUISTIC_TYPE = f"{MARK}-segmentation"
WHOLE = re.compile(r"\s*\+?[0-9]{1,15}\s*", re.ASCII)
# XML 1.0 has no way to write these.
NOT_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


@dataclass(frozen=True)
class NewTier:
    """A tier to insert; intervals in seconds of the recording's clock."""

    name: str
    intervals: tuple[Interval, ...]


def insert_tiers(content: bytes, tiers: Sequence[NewTier], clock_offset_s: float = 0.0) -> bytes:
    """Return an ELAN file's bytes with tiers added and everything else untouched.

    Tiers that an earlier call inserted are replaced. A tier that is called so and on which the
    user has built (child tiers) is kept, and the new one gets a free name, `NAME (2)`; a tier of
    that name that signkin did not make is an error. Each time becomes a time slot of its own,
    put into TIME_ORDER by its value; milliseconds, as ELAN keeps them.
    """
    document = _parsed(content)
    names = [_name_for(document.root, tier.name) for tier in tiers]
    content = _without(document, names)
    document = _parsed(content)
    ids = _FreeIds(document.root)
    kind = _own_type(document.root)
    type_name = ids.take(LINGUISTIC_TYPE) if kind is None else kind.need("LINGUISTIC_TYPE_ID")
    slots: list[tuple[int, str]] = []
    blocks = []
    for t, (name, tier) in enumerate(zip(names, tiers, strict=True), start=1):
        annotations = []
        for i, interval in enumerate(tier.intervals, start=1):
            # ELAN has no times before its media: a tag there is put at their start.
            start = max(0, round((interval.start_s - clock_offset_s) * 1000))
            end = max(start + 1, round((interval.end_s - clock_offset_s) * 1000))
            edges = [
                (ms, ids.take(f"{MARK}_ts{t}_{i}{edge}")) for ms, edge in ((start, "a"), (end, "b"))
            ]
            slots += edges
            key = ids.take(f"{MARK}_a{t}_{i}")
            annotations.append(_annotation(key, edges[0][1], edges[1][1], interval.label))
        blocks.append(
            f"<TIER TIER_ID={quoteattr(_writable(name))} "
            f"LINGUISTIC_TYPE_REF={quoteattr(type_name)}>{''.join(annotations)}</TIER>"
        )
    return _inserted(document, slots, "".join(blocks), type_name if kind is None else None)


def _parsed(content: bytes) -> Document:
    document = parse(content, "an ELAN file", places=True)
    if document.root.tag != "ANNOTATION_DOCUMENT" or not document.root.all("TIME_ORDER"):
        raise SignkinError(
            f"the root is {document.root.tag[:40]}, or it has no TIME_ORDER",
            place="line 1",
            expected="an ELAN file",
        )
    return document


def _annotation(key: str, start: str, end: str, label: str) -> str:
    return (
        f'<ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="{key}" TIME_SLOT_REF1="{start}" '
        f'TIME_SLOT_REF2="{end}"><ANNOTATION_VALUE>{_text(label)}</ANNOTATION_VALUE>'
        "</ALIGNABLE_ANNOTATION></ANNOTATION>"
    )


def _text(label: str) -> str:
    return escape(_writable(label), {"\r": "&#13;"})


def _writable(text: str) -> str:
    found = NOT_XML.search(text)
    if found:
        raise SignkinError(
            f"{text[:40]!r} has a character that XML cannot hold (U+{ord(found.group()):04X})",
            place="labels",
            expected="text",
            todo="Correct the label in the annotation.",
        )
    return text


# --- what is ours --------------------------------------------------------------------------------


def _name_for(root: Element, name: str) -> str:
    """Return the name for a new tier: the one asked for, or a free one beside the user's."""
    tiers = root.all("TIER")
    for number in range(1, len(tiers) + 2):
        candidate = name if number == 1 else f"{name} ({number})"
        there = [tier for tier in tiers if tier.get("TIER_ID") == candidate]
        if not there:
            return candidate
        if not all(_is_made_here(root, tier) for tier in there):
            raise SignkinError(
                f"the file has a tier {candidate!r} already, which signkin did not make",
                place="tiers",
                expected="a name that is free",
                todo="Rename that tier in ELAN.",
            )
        if not any(_is_built_on(root, tier) for tier in there):
            return candidate
    raise AssertionError("more tiers are in the way than there are")


def _is_made_here(root: Element, tier: Element) -> bool:
    if tier.get("PARENT_REF"):
        return False
    keys = [e.get("ANNOTATION_ID") or "" for e in _annotations(tier)]
    if any(e.tag != "ALIGNABLE_ANNOTATION" for e in _annotations(tier)):
        return False
    kind = _own_type(root)
    own_type = kind is not None and (
        tier.get("LINGUISTIC_TYPE_REF") == kind.get("LINGUISTIC_TYPE_ID")
    )
    return own_type or (bool(keys) and all(key.startswith(f"{MARK}_") for key in keys))


def _is_built_on(root: Element, tier: Element) -> bool:
    """Whether the user added to it: annotations, a tier that hangs on it, references to it."""
    if any(other.get("PARENT_REF") == tier.get("TIER_ID") for other in root.all("TIER")):
        return True
    keys = {e.get("ANNOTATION_ID") for e in _annotations(tier)} - {None}
    own = [key.startswith(f"{MARK}_") for key in keys if key]
    if any(own) and not all(own):  # the user added annotations
        return True
    return any(
        value in keys
        for element in root.walk()
        for name, value in element.attributes.items()
        if name != "ANNOTATION_ID" and ("ANNOTATION" in name or name.startswith("REF"))
    )


def _annotations(tier: Element) -> Iterator[Element]:
    for annotation in tier.all("ANNOTATION"):
        yield from annotation.all("ALIGNABLE_ANNOTATION", "REF_ANNOTATION")


def _own_type(root: Element) -> Element | None:
    """Return the linguistic type for own tiers: called so, and for aligned tiers by themselves."""
    name = re.compile(rf"{LINGUISTIC_TYPE}(-\d+)?")
    for kind in root.all("LINGUISTIC_TYPE"):
        if not name.fullmatch(kind.get("LINGUISTIC_TYPE_ID") or ""):
            continue
        restricted = ("CONSTRAINTS", "CONTROLLED_VOCABULARY_REF", "LEXICON_REF")
        aligned = (kind.get("TIME_ALIGNABLE") or "true").strip().lower() in ("true", "1")
        if aligned and not any(kind.get(key) for key in restricted):
            return kind
    return None


def _without(document: Document, names: Sequence[str]) -> bytes:
    """Return the file without the own tiers of these names and the slots they alone use."""
    root = document.root
    gone = [tier for tier in root.all("TIER") if tier.get("TIER_ID") in names]
    uses = Counter(_slots_of(root))
    theirs = Counter(slot for tier in gone for slot in _slots_of(tier))
    free = {slot for slot, count in theirs.items() if uses[slot] == count}
    slots = [
        slot
        for order in root.all("TIME_ORDER")
        for slot in order.all("TIME_SLOT")
        if slot.get("TIME_SLOT_ID") in free
    ]
    out, done = bytearray(), 0
    for element in sorted([*gone, *slots], key=lambda e: e.start):
        out += document.content[done : element.start]
        done = element.end
    return bytes(out + document.content[done:])


def _slots_of(element: Element) -> Iterator[str]:
    for inner in element.walk():
        for name in ("TIME_SLOT_REF1", "TIME_SLOT_REF2"):
            if inner.get(name) is not None:
                yield inner.attributes[name]


class _FreeIds:
    """Ids that nothing in the file is called by; every attribute counts as a name in use."""

    def __init__(self, root: Element) -> None:
        self.taken = {v.strip() for element in root.walk() for v in element.attributes.values()}

    def take(self, wish: str) -> str:
        """Return the wish, or with the first free number behind it."""
        name, number = wish, 1
        while name in self.taken:
            number += 1
            name = f"{wish}-{number}"
        self.taken.add(name)
        return name


# --- putting it in -------------------------------------------------------------------------------


def _inserted(
    document: Document, slots: Sequence[tuple[int, str]], blocks: str, new_type: str | None
) -> bytes:
    root = document.root
    order = root.all("TIME_ORDER")[0]
    pieces: list[tuple[int, int, str]] = []  # place, rank at that place, text
    by_value = [
        (ms, f'<TIME_SLOT TIME_SLOT_ID="{key}" TIME_VALUE="{ms}"/>')
        for ms, key in sorted(slots, key=lambda slot: slot[0])
    ]
    replaced: tuple[int, int] | None = None
    if order.inner_end is None:  # `<TIME_ORDER/>`
        text = "".join(slot for _, slot in by_value)
        replaced = (order.end - len(document.encoded("/>")), order.end)
        pieces.append((replaced[0], 0, f">{text}</TIME_ORDER>"))
    else:
        there = [s for s in order.all("TIME_SLOT") if WHOLE.fullmatch(s.get("TIME_VALUE") or "")]
        latest = list(accumulate((int(slot.attributes["TIME_VALUE"]) for slot in there), max))
        places = [slot.start for slot in there]
        for rank, (ms, text) in enumerate(by_value):
            # Before the first slot that is later: TIME_ORDER is kept in order of time.
            k = bisect_right(latest, ms)
            pieces.append((places[k] if k < len(there) else order.inner_end, rank, text))
    tiers, kinds = root.all("TIER"), root.all("LINGUISTIC_TYPE")
    behind_tiers = tiers[-1].end if tiers else order.end
    pieces.append((behind_tiers, 0, blocks))
    if new_type is not None:
        text = (
            f"<LINGUISTIC_TYPE LINGUISTIC_TYPE_ID={quoteattr(new_type)} "
            'TIME_ALIGNABLE="true" GRAPHIC_REFERENCES="false"/>'
        )
        pieces.append((kinds[-1].end if kinds else behind_tiers, 1, text))
    out, done = bytearray(), 0
    for place, _, text in sorted(pieces, key=lambda piece: piece[:2]):
        out += document.content[done:place] + document.encoded(text)
        done = replaced[1] if replaced is not None and place == replaced[0] else place
    return bytes(out + document.content[done:])


def elan_copy(
    path: Path,
    tiers: Sequence[NewTier],
    *,
    elan: bool,
    clock_offset_s: float,
    tags: Sequence[Interval],
    media_url: str,
) -> bytes:
    """Return an ELAN file with a recording's tags and new tiers.

    elan: whether the annotation at `path` is one, which is then copied with the tiers inserted.
    Else a new file is made of `tags` (all of the recording, in its clock), with the motion's file
    as its medium; what overlaps on a tier stands on a further one, `NAME (2)`, since ELAN allows
    no overlap. Errors name the file.
    """
    try:
        if elan:
            return insert_tiers(path.read_bytes(), tiers, clock_offset_s)
        own = [(name, None, lane) for name, lane in _lanes(tags)]
        # No date: the same input gives the same bytes.
        content = new_eaf(
            author=MARK, date="1970-01-01T00:00:00+00:00", media_url=media_url, tiers=own
        )
        return insert_tiers(content, tiers)
    except SignkinError as error:
        raise error.at(file=path) from error


def _lanes(tags: Sequence[Interval]) -> list[tuple[str, list[Interval]]]:
    """Return tags by tier, those that overlap on further tiers with free names."""
    names = list(dict.fromkeys(tag.tier for tag in tags))
    taken = set(names)
    out: list[tuple[str, list[Interval]]] = []
    for name in names:
        lanes: list[list[Interval]] = []
        for tag in sorted(tag for tag in tags if tag.tier == name):
            lane = next((own for own in lanes if own[-1].end_s <= tag.start_s), None)
            if lane is None:
                lanes.append([tag])
            else:
                lane.append(tag)
        number = 1
        for i, lane in enumerate(lanes):
            called = name
            while i and called in taken:
                number += 1
                called = f"{name} ({number})"
            out.append((called, lane))
            taken.add(called)
    return out


# --- new files -----------------------------------------------------------------------------------

_NEW = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<ANNOTATION_DOCUMENT AUTHOR={author} DATE={date} FORMAT="3.0" VERSION="3.0" '
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    'xsi:noNamespaceSchemaLocation="http://www.mpi.nl/tools/elan/EAFv3.0.xsd">\n'
    '<HEADER MEDIA_FILE="" TIME_UNITS="milliseconds">\n'
    '<MEDIA_DESCRIPTOR MEDIA_URL={media} MIME_TYPE="unknown"/>\n</HEADER>\n'
)
_TYPES = (
    '<LINGUISTIC_TYPE LINGUISTIC_TYPE_ID="default-lt" TIME_ALIGNABLE="true" '
    'GRAPHIC_REFERENCES="false"/>\n'
    '<LINGUISTIC_TYPE LINGUISTIC_TYPE_ID="included" TIME_ALIGNABLE="true" '
    'GRAPHIC_REFERENCES="false" CONSTRAINTS="Included_In"/>\n'
    '<CONSTRAINT STEREOTYPE="Included_In" DESCRIPTION="Time alignable annotations within the '
    "parent annotation's time interval, gaps are allowed\"/>\n</ANNOTATION_DOCUMENT>\n"
)


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
    path.write_bytes(new_eaf(author=author, date=date, media_url=media_url, tiers=tiers))


def new_eaf(
    *,
    author: str,
    date: str,
    media_url: str,
    tiers: Sequence[tuple[str, str | None, Sequence[Interval]]],
) -> bytes:
    """Return the bytes of a new ELAN file; see `write_eaf`. date: as xsd:dateTime writes it."""
    slots: list[tuple[int, str]] = []
    blocks = []
    number = 0
    for name, parent, intervals in tiers:
        of = "" if parent is None else f" PARENT_REF={quoteattr(_writable(parent))}"
        kind = "default-lt" if parent is None else "included"
        body = []
        for interval in intervals:
            number += 1
            start = max(0, round(interval.start_s * 1000))
            edges = [start, max(start + 1, round(interval.end_s * 1000))]
            keys = [f"ts{2 * number - 1}", f"ts{2 * number}"]
            slots += zip(edges, keys, strict=True)
            body.append(_annotation(f"a{number}", keys[0], keys[1], interval.label))
        blocks.append(
            f'<TIER LINGUISTIC_TYPE_REF="{kind}" TIER_ID={quoteattr(_writable(name))}{of}>'
            f"{''.join(body)}</TIER>\n"
        )
    order = "".join(
        f'<TIME_SLOT TIME_SLOT_ID="{key}" TIME_VALUE="{ms}"/>\n'
        for ms, key in sorted(slots, key=lambda slot: slot[0])
    )
    head = _NEW.format(
        author=quoteattr(_writable(author)),
        date=quoteattr(_writable(date)),
        media=quoteattr(_writable(media_url)),
    )
    text = f"{head}<TIME_ORDER>\n{order}</TIME_ORDER>\n{''.join(blocks)}{_TYPES}"
    return text.encode("utf-8")
