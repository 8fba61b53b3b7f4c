"""Raw files to canonical recordings and intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from signkin import tables
from signkin.annotation import Annotation
from signkin.corpus import Corpus, Entry, check_checksum
from signkin.errors import SignkinError
from signkin.io import read_annotation, read_recording
from signkin.kinematics.rotations import with_limb_frames
from signkin.recording import Recording


@dataclass
class Ingested:
    """Recordings of a shard with the rows of the tables recordings, intervals and excluded."""

    recordings: list[Recording] = field(default_factory=list)
    about: list[dict[str, Any]] = field(default_factory=list)
    intervals: list[dict[str, Any]] = field(default_factory=list)
    excluded: list[dict[str, Any]] = field(default_factory=list)

    def table(self, name: str) -> pd.DataFrame:
        """Return one of the tables as a frame."""
        rows = {"recordings": self.about, "intervals": self.intervals, "excluded": self.excluded}
        return pd.DataFrame(rows[name], columns=tables.TABLES[name].names())


def ingest(corpus: Corpus, folder: Path, entries: Sequence[Entry]) -> Ingested:
    """Read the recordings of a shard with their tags.

    A recording that cannot be used ends the run, or, where the corpus says `on_error: skip`,
    is left out and listed.
    """
    out = Ingested()
    for name in dict.fromkeys(n for e in entries for n in (e.motion, e.annotation) if n):
        check_checksum(corpus, folder, name)
    for entry in entries:
        try:
            recording, annotation = read_entry(corpus, folder, entry)
        except SignkinError as error:
            out.excluded.append(excluded_row(corpus, entry.recording, "reading", error))
            continue
        out.recordings.append(recording)
        intervals = _interval_rows(corpus, entry, annotation)
        out.intervals += intervals
        out.about.append(_about(corpus, entry, recording, annotation, intervals))
    if not out.recordings:
        raise SignkinError(
            f"none of {len(entries)} recordings can be used; the first: "
            f"{out.excluded[0]['reason']}",
            file=corpus.folder,
            expected="one recording or more",
        )
    return out


def read_entry(corpus: Corpus, folder: Path, entry: Entry) -> tuple[Recording, Annotation | None]:
    """Return a recording as the corpus describes it, and its tags where the corpus has tags."""
    recording = _recording(corpus, folder, entry)
    return recording, _annotation(corpus, folder, entry, recording)


def excluded_row(corpus: Corpus, recording: str, stage: str, error: SignkinError) -> dict[str, Any]:
    """Return the row that lists a recording as left out, or raise where that is not allowed."""
    if corpus.settings.get("on_error", "stop") != "skip":
        raise error
    return {**lead(corpus, recording), "stage": stage, "reason": str(error)}


def lead(corpus: Corpus, recording: str) -> dict[str, str]:
    """Return the first columns of every table: corpus, recording, signer."""
    signer = corpus.by_name[recording].signer
    return {"corpus": corpus.name, "recording": recording, "signer": signer}


def _recording(corpus: Corpus, folder: Path, entry: Entry) -> Recording:
    recording = read_recording(folder / entry.motion, **corpus.motion_spec(entry))
    wanted = corpus.settings["motion"].get("orientations", "none")
    try:
        if wanted == "limb_frames":
            return with_limb_frames(recording)
        if wanted == "recorded" and recording.orientations is None:
            raise SignkinError(
                "the file has no orientations",
                place="key motion.orientations",
                expected="limb_frames or none in corpus.yaml",
            )
        if wanted == "none":
            return recording.without_orientations()
    except SignkinError as error:
        raise error.at(file=folder / entry.motion) from error
    return recording


def _annotation(
    corpus: Corpus, folder: Path, entry: Entry, recording: Recording
) -> Annotation | None:
    if not corpus.tagged:
        return None
    spec = corpus.annotation_spec(entry)
    if spec.get("time_unit") == "frames":
        spec["rate_hz"] = recording.rate_hz
    path = folder / entry.annotation
    annotation = read_annotation(path, **spec)
    try:
        # Annotators tag video, whose last frame may end one frame after the motion does.
        annotation.refuse_past(recording.duration_s, 1.0 / recording.rate_hz)
    except SignkinError as error:
        raise SignkinError(
            error.found, file=path, place=error.place, expected=error.expected,
            todo="Is this the motion's annotation, and its rate right?",
        ) from error  # fmt: skip
    return annotation


def _interval_rows(
    corpus: Corpus, entry: Entry, annotation: Annotation | None
) -> list[dict[str, Any]]:
    if annotation is None:
        return []
    return [
        {
            **lead(corpus, entry.recording),
            "role": role,
            "tier": tier,
            "label": interval.label,
            "start_s": interval.start_s,
            "end_s": interval.end_s,
        }
        for role, tier in corpus.tiers.items()
        for interval in annotation.tier(tier)
    ]


def _about(
    corpus: Corpus,
    entry: Entry,
    recording: Recording,
    annotation: Annotation | None,
    intervals: list[dict[str, Any]],
) -> dict[str, Any]:
    return {
        **lead(corpus, entry.recording),
        "sign": entry.sign,
        "repetition": entry.repetition,
        "frames": recording.frames,
        "rate_hz": recording.rate_hz,
        "duration_s": recording.duration_s,
        "unit": recording.unit,
        "joints": len(recording.joints),
        "orientations": recording.orientation_source,
        "signs": sum(row["role"] == "sign" for row in intervals),
        "clock_offset_s": annotation.clock_offset_s if annotation else 0.0,
        "times_interpolated": annotation.interpolated if annotation else 0,
        "motion_file": entry.motion,
        "annotation_file": entry.annotation,
    }
