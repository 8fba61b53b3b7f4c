"""Rules of EAFv2.8 and EAFv3.0.xsd that a written file can break, checked without the schema.

Compared with the schemas by 3,000 changes of valid files (docs/reliability.md). What no writer here
touches is left out: languages, lexicons, entries of controlled vocabularies.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections import Counter

ORDER = (
    "LICENSE", "HEADER", "TIME_ORDER", "TIER", "LINGUISTIC_TYPE", "LOCALE", "LANGUAGE",
    "CONSTRAINT", "CONTROLLED_VOCABULARY", "LEXICON_REF", "REF_LINK_SET", "EXTERNAL_REF",
)  # fmt: skip
# Attributes of type xsd:ID share one space of names.
IDS = ("TIME_SLOT_ID", "ANNOTATION_ID", "STEREOTYPE", "LANGUAGE_CODE", "EXT_REF_ID")
NEEDED = {
    "ANNOTATION_DOCUMENT": ("AUTHOR", "DATE", "VERSION"),
    "TIME_SLOT": ("TIME_SLOT_ID",),
    "TIER": ("TIER_ID", "LINGUISTIC_TYPE_REF"),
    "ALIGNABLE_ANNOTATION": ("ANNOTATION_ID", "TIME_SLOT_REF1", "TIME_SLOT_REF2"),
    "REF_ANNOTATION": ("ANNOTATION_ID", "ANNOTATION_REF"),
    "LINGUISTIC_TYPE": ("LINGUISTIC_TYPE_ID",),
    "MEDIA_DESCRIPTOR": ("MEDIA_URL", "MIME_TYPE"),
    "CONSTRAINT": ("STEREOTYPE",),
}
# Elements within others, in this order.
WITHIN = {
    "ANNOTATION_DOCUMENT": ORDER,
    "HEADER": ("MEDIA_DESCRIPTOR", "LINKED_FILE_DESCRIPTOR", "PROPERTY"),
    "TIME_ORDER": ("TIME_SLOT",),
    "TIER": ("ANNOTATION",),
    "ANNOTATION": ("ALIGNABLE_ANNOTATION", "REF_ANNOTATION"),
    "ALIGNABLE_ANNOTATION": ("ANNOTATION_VALUE",),
    "REF_ANNOTATION": ("ANNOTATION_VALUE",),
    **dict.fromkeys(("TIME_SLOT", "LINGUISTIC_TYPE", "CONSTRAINT"), ()),
    **dict.fromkeys(("MEDIA_DESCRIPTOR", "PROPERTY", "ANNOTATION_VALUE"), ()),
}  # fmt: skip
ONCE = ("HEADER", "TIME_ORDER")
_BOOLEAN = re.compile(r"\s*(true|false|0|1)\s*")
VALUES = {
    ("LINGUISTIC_TYPE", "TIME_ALIGNABLE"): _BOOLEAN,
    ("LINGUISTIC_TYPE", "GRAPHIC_REFERENCES"): _BOOLEAN,
    ("HEADER", "TIME_UNITS"): re.compile("NTSC-frames|PAL-frames|milliseconds"),
    ("MEDIA_DESCRIPTOR", "TIME_ORIGIN"): re.compile(r"\s*[+-]?\d{1,18}\s*"),
    ("ANNOTATION_DOCUMENT", "DATE"): re.compile(
        r"\s*-?\d{4,}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d)?\s*"
    ),
}
KNOWN = {
    "TIER": {
        "TIER_ID", "PARTICIPANT", "ANNOTATOR", "LINGUISTIC_TYPE_REF", "DEFAULT_LOCALE",
        "PARENT_REF", "EXT_REF", "LANG_REF",
    },
    "TIME_SLOT": {"TIME_SLOT_ID", "TIME_VALUE"},
    "LINGUISTIC_TYPE": {
        "LINGUISTIC_TYPE_ID", "TIME_ALIGNABLE", "CONSTRAINTS", "GRAPHIC_REFERENCES",
        "CONTROLLED_VOCABULARY_REF", "EXT_REF", "LEXICON_REF",
    },
    "ANNOTATION_DOCUMENT": {"AUTHOR", "DATE", "FORMAT", "VERSION"},
    "HEADER": {"MEDIA_FILE", "TIME_UNITS"},
    "MEDIA_DESCRIPTOR": {
        "MEDIA_URL", "RELATIVE_MEDIA_URL", "MIME_TYPE", "TIME_ORIGIN", "EXTRACTED_FROM",
    },
    "PROPERTY": {"NAME"},
    "CONSTRAINT": {"STEREOTYPE", "DESCRIPTION"},
    "ALIGNABLE_ANNOTATION": {
        "ANNOTATION_ID", "TIME_SLOT_REF1", "TIME_SLOT_REF2", "SVG_REF", "EXT_REF", "LANG_REF",
        "CVE_REF",
    },
    "REF_ANNOTATION": {
        "ANNOTATION_ID", "ANNOTATION_REF", "PREVIOUS_ANNOTATION", "EXT_REF", "LANG_REF", "CVE_REF",
    },
    **{tag: set() for tag in ("TIME_ORDER", "ANNOTATION", "ANNOTATION_VALUE")},
}  # fmt: skip


def broken(content: bytes) -> list[str]:
    """Return which rules a file breaks: order, needed attributes, ids, keys and references."""
    root = ET.fromstring(content)
    out = []
    for tag in ONCE:
        if [child.tag for child in root].count(tag) != 1:
            out.append(f"one {tag}")
    for element in root.iter():
        out += _within(element)
        missing = [a for a in NEEDED.get(element.tag, ()) if element.get(a) is None]
        own = {key for key in element.keys() if not key.startswith("{")}  # noqa: SIM118
        unknown = own - KNOWN.get(element.tag, own)
        out += [f"{element.tag} without {a}" for a in missing]
        out += [f"{element.tag} with {a}" for a in unknown]
    ids = [e.get(a) for e in root.iter() for a in IDS if e.get(a) is not None]
    out += [f"id twice: {k}" for k, n in Counter(ids).items() if n > 1]
    out += [f"id is no name: {k}" for k in ids if not re.fullmatch(r"[^\W\d][\w.-]*", k)]
    slots = {s.get("TIME_SLOT_ID") for s in root.iter("TIME_SLOT")}
    used = [e.get(a) for e in root.iter() for a in ("TIME_SLOT_REF1", "TIME_SLOT_REF2")]
    out += [f"no slot {k}" for k in used if k is not None and k not in slots]
    for value in (s.get("TIME_VALUE") for s in root.iter("TIME_SLOT")):
        if value is not None and not 0 <= int(value) < 2**32:
            out.append(f"time {value}")
    for tag, key in (("TIER", "TIER_ID"), ("LINGUISTIC_TYPE", "LINGUISTIC_TYPE_ID")):
        names = Counter(e.get(key) for e in root.iter(tag))
        out += [f"{tag} twice: {k}" for k, n in names.items() if n > 1]
    types = {t.get("LINGUISTIC_TYPE_ID") for t in root.iter("LINGUISTIC_TYPE")}
    tiers = {t.get("TIER_ID") for t in root.iter("TIER")}
    annotations = {e.get("ANNOTATION_ID") for e in root.iter()}
    for tier in root.iter("TIER"):
        if tier.get("LINGUISTIC_TYPE_REF") not in types:
            out.append(f"no type {tier.get('LINGUISTIC_TYPE_REF')}")
        if tier.get("PARENT_REF") is not None and tier.get("PARENT_REF") not in tiers:
            out.append(f"no tier {tier.get('PARENT_REF')}")
    stereotypes = {e.get("STEREOTYPE") for e in root.iter("CONSTRAINT")}
    for kind in root.iter("LINGUISTIC_TYPE"):
        if kind.get("CONSTRAINTS") is not None and kind.get("CONSTRAINTS") not in stereotypes:
            out.append(f"no constraint {kind.get('CONSTRAINTS')}")
    for e in root.iter("REF_ANNOTATION"):
        if e.get("ANNOTATION_REF") not in annotations:
            out.append(f"no annotation {e.get('ANNOTATION_REF')}")
    return out


def _within(element: ET.Element) -> list[str]:
    """Return which rules an element breaks by itself: what stands in it, and its values."""
    out = []
    order = WITHIN.get(element.tag)
    if order is not None:
        ranks = [order.index(child.tag) if child.tag in order else -1 for child in element]
        if ranks != sorted(ranks) or -1 in ranks:
            out.append(f"order of elements in {element.tag}")
        single = ("ANNOTATION", "ALIGNABLE_ANNOTATION", "REF_ANNOTATION")
        if element.tag in single and len(element) != 1:
            out.append(f"one element in {element.tag}")
    for (tag, key), rule in VALUES.items():
        value = element.get(key)
        if element.tag == tag and value is not None and not rule.fullmatch(value):
            out.append(f"{tag} with {key} {value}")
    return out
