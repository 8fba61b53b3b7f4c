"""Recordings that lie in one file: what tells them apart must be said, or each is all of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from signkin.errors import SignkinError

if TYPE_CHECKING:
    from signkin.corpus import Corpus, Entry


def check_doubled(corpus: Corpus, file: Path) -> None:
    """Refuse two recordings that are one: the same file, part, stretch and tags."""
    seen: dict[object, Entry] = {}
    for entry in corpus.entries:
        tiers = str(corpus.tiers_of(entry))
        key = (entry.motion, entry.annotation, entry.part, entry.from_s, entry.to_s, tiers)
        first = seen.setdefault(key, entry)
        if first is not entry and entry.motion:
            raise SignkinError(
                f"{entry.recording} is {first.recording} (line {first.line}) once more",
                file=file,
                place=f"line {entry.line}",
                expected="each recording once; part, from_s or the names of tiers tell two apart",
            )


def check_shared_tables(corpus: Corpus, file: Path) -> None:
    """Refuse two recordings of one table of motion that nothing tells apart.

    A part that names tiers (`{part}`) tells the tags apart, and says nothing of the motion.
    """
    motion = corpus.settings["motion"]
    if motion["format"] != "csv" or "recording_column" in motion.get("options", {}):
        return
    if "{part}" in str(corpus.settings.get("annotation", "")):
        return
    parts: dict[str, Entry] = {}
    for entry in corpus.entries:
        first = parts.setdefault(entry.motion, entry)
        if first.part != entry.part:
            raise SignkinError(
                f"{entry.recording} and {first.recording} are parts of {entry.motion}",
                file=file,
                place=f"line {entry.line}",
                expected="motion.options.recording_column in corpus.yaml, which tells them apart",
            )


def check_shared_tags(corpus: Corpus, file: Path) -> None:
    """Refuse two parts of one annotation that would get the same tags."""
    annotation = corpus.settings.get("annotation")
    if annotation is None or "recording_column" in annotation.get("options", {}):
        return
    parts: dict[str, Entry] = {}
    for entry in corpus.entries:
        first = parts.setdefault(entry.annotation, entry)
        same = corpus.tiers_of(first) == corpus.tiers_of(entry)
        if (
            first.part != entry.part
            and same
            and (first.from_s, first.to_s) == (entry.from_s, entry.to_s)
        ):
            raise SignkinError(
                f"{entry.recording} and {first.recording} are parts of {entry.annotation} and "
                "would get the same tags",
                file=file,
                place=f"line {entry.line}",
                expected="what tells them apart: {part} or {signer} in the names of tiers, "
                "annotation.options.recording_column, or from_s and to_s",
            )
