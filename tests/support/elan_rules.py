"""Rules of EAFv2.7 to EAFv3.0.xsd that a written file can break, checked without the schema."""

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
}  # fmt: skip


def broken(content: bytes) -> list[str]:
    """Return which rules a file breaks: order, needed attributes, ids, keys and references."""
    root = ET.fromstring(content)
    out = []
    ranks = [ORDER.index(child.tag) if child.tag in ORDER else -1 for child in root]
    if ranks != sorted(ranks) or -1 in ranks:
        out.append("order of elements")
    if [c.tag for c in root].count("TIME_ORDER") != 1:
        out.append("one TIME_ORDER")
    for element in root.iter():
        missing = [a for a in NEEDED.get(element.tag, ()) if element.get(a) is None]
        unknown = set(element.keys()) - KNOWN.get(element.tag, set(element.keys()))
        out += [f"{element.tag} without {a}" for a in missing]
        out += [f"{element.tag} with {a}" for a in unknown]
        if element.tag in ("ALIGNABLE_ANNOTATION", "REF_ANNOTATION") and [
            child.tag for child in element
        ] != ["ANNOTATION_VALUE"]:
            out.append("one ANNOTATION_VALUE")
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
    for e in root.iter("REF_ANNOTATION"):
        if e.get("ANNOTATION_REF") not in annotations:
            out.append(f"no annotation {e.get('ANNOTATION_REF')}")
    return out
