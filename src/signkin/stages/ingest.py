"""Raw files to canonical recordings and intervals."""

from __future__ import annotations

import traceback
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pandas as pd

from signkin import tables
from signkin.annotation import Annotation, Interval, LeftOut
from signkin.annotation_rules import signs_of_hands
from signkin.corpus import Corpus, Entry
from signkin.corpus_checksums import check_checksum
from signkin.corpus_files import data_file
from signkin.errors import SignkinError
from signkin.io import read_annotation, read_recording, wants_rate
from signkin.kinematics.rotations import with_limb_frames
from signkin.ratings import tag_ratings
from signkin.recording import Recording

MOST_TOLD = 5  # tags left out that a table names; the others it counts


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
    is left out and listed, whatever went wrong in it or its tags.
    """
    out = Ingested()
    checked: set[str] = set()
    for entry in entries:
        if entry.rating == "exclude":
            out.excluded.append(rated_row(corpus, entry))
            continue
        try:
            for name in (entry.motion, entry.annotation):
                if name and name not in checked:
                    if not corpus.made_by_run:
                        data_file(corpus, folder, entry, name)
                    check_checksum(corpus, folder, name)
                    checked.add(name)
            recording, annotation = read_entry(corpus, folder, entry)
            intervals = _interval_rows(corpus, entry, annotation)
            about = _about(corpus, entry, recording, annotation, intervals)
        except Exception as error:
            out.excluded.append(excluded_row(corpus, entry.recording, "reading", error))
            continue
        out.recordings.append(recording)
        out.intervals += intervals
        out.about.append(about)
    return out


def refuse_none(corpus: Corpus, excluded: Sequence[dict[str, Any]], left: int) -> None:
    """Refuse a shard of which no recording is left; its tables are written by then."""
    if not left:
        first = excluded[0]["reason"] if excluded else "there was none before"
        raise SignkinError(
            f"no recording can be used; the first: {str(first).rstrip('.')}",
            file=corpus.folder,
        )


def read_entry(corpus: Corpus, folder: Path, entry: Entry) -> tuple[Recording, Annotation | None]:
    """Return a recording as the corpus describes it, and its tags where the corpus has tags."""
    recording = _recording(corpus, folder, entry)
    return recording, _annotation(corpus, folder, entry, recording)


def rated_row(corpus: Corpus, entry: Entry) -> dict[str, Any]:
    """Return the row that lists a recording as left out because its owner says so."""
    why = f": {entry.rating_note}" if entry.rating_note else ""
    reason = f"rated `exclude` in recordings.csv, line {entry.line}{why}"
    return {**lead(corpus, entry.recording), "stage": "rating", "reason": reason}


def excluded_row(corpus: Corpus, recording: str, stage: str, error: Exception) -> dict[str, Any]:
    """Return the row that lists a recording as left out, or raise where that is not allowed.

    What is no SignkinError is a fault of this package: it is listed with its kind, and its
    traceback stands in the log.
    """
    if not corpus.skips:
        raise error
    reason = str(error)
    if not isinstance(error, SignkinError):
        traceback.print_exception(error)
        reason = f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
    return {**lead(corpus, recording), "stage": stage, "reason": reason}


def lead(corpus: Corpus, recording: str) -> dict[str, str]:
    """Return the first columns of every table: corpus, recording, signer."""
    signer = corpus.by_name[recording].signer
    return {"corpus": corpus.name, "recording": recording, "signer": signer}


def _recording(corpus: Corpus, folder: Path, entry: Entry) -> Recording:
    recording = read_recording(folder / entry.motion, **corpus.motion_spec(entry))
    if recording.unit != corpus.unit:
        raise SignkinError(
            f"the positions are in {recording.unit}",
            file=folder / entry.motion,
            place="key motion.unit",
            expected=f"unit: {recording.unit} in corpus.yaml",
        )
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
    others = {r: own for r, own in corpus.tiers_of(entry).items() if r != "sign"}
    spec["clip"] = [wish for own in others.values() for wish in own.values()]
    if wants_rate(str(spec["format"])):
        spec.setdefault("rate_hz", recording.rate_hz)
    path = folder / entry.annotation
    annotation = read_annotation(path, **spec)
    try:
        annotation = _one_line_of_signs(corpus, entry, annotation)
        annotation = _without_excluded(corpus, entry, annotation)
        if not of_role(corpus, entry, annotation, "sign"):
            raise SignkinError("no sign", place="key annotation", expected="one or more")
        # Annotators tag video, whose last frame may end one frame after the motion does.
        annotation.refuse_past(recording.duration_s, 1.0 / recording.rate_hz)
    except SignkinError as error:
        raise SignkinError(
            error.found, file=path, place=error.place, expected=error.expected,
            todo=error.todo or "Is this the motion's annotation, and its rate right? Where it is "
            "that of a longer recording, tell from_s and to_s in recordings.csv.",
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
            "tier": interval.tier,
            "label": interval.label,
            "written": interval.as_written,
            "start_s": interval.start_s,
            "end_s": interval.end_s,
        }
        for role in corpus.tiers
        for interval in of_role(corpus, entry, annotation, role)
    ]


def of_role(
    corpus: Corpus, entry: Entry, annotation: Annotation, role: str
) -> tuple[Interval, ...]:
    """Return the intervals of a role (`sign`), of all hands, in order of time."""
    by_hand = corpus.tiers_of(entry)[role]
    return tuple(sorted(interval for wish in by_hand.values() for interval in annotation.of(wish)))


def _one_line_of_signs(corpus: Corpus, entry: Entry, annotation: Annotation) -> Annotation:
    """Return the annotation with the sign tiers of both hands made one sequence of signs."""
    by_hand = corpus.tiers_of(entry)["sign"]
    if set(by_hand) == {"both"}:
        return annotation
    tiers = {hand: annotation.of(wish) for hand, wish in by_hand.items()}
    signs, left_out = signs_of_hands(tiers, corpus.dominant_hand(entry))
    ours = {id(interval) for own in tiers.values() for interval in own}
    others = [interval for interval in annotation.intervals if id(interval) not in ours]
    return replace(
        annotation,
        intervals=(*others, *signs),
        left_out=(*annotation.left_out, *left_out),
    )


def _without_excluded(corpus: Corpus, entry: Entry, annotation: Annotation) -> Annotation:
    """Return the annotation without signs that are rated `exclude`, which are noted."""
    rated = tag_ratings(corpus.folder).get(entry.recording, [])
    ratings = [rating for rating in rated if rating.rating == "exclude"]
    if not ratings:
        return annotation
    signs = {id(interval) for interval in of_role(corpus, entry, annotation, "sign")}
    kept, left_out = [], []
    for interval in annotation.intervals:
        names = (interval.label, interval.as_written)
        found = next(
            (r for r in ratings if any(r.matches(interval.start_s, name) for name in names)), None
        )
        if found is None or id(interval) not in signs:
            kept.append(interval)
            continue
        place = f"{interval.label} at {interval.start_s:.3f} s"
        why = f"rated `exclude`{': ' + found.note if found.note else ''}"
        left_out.append(LeftOut(interval.tier, place, why))
    return replace(annotation, intervals=tuple(kept), left_out=(*annotation.left_out, *left_out))


def tags_of(intervals: pd.DataFrame | tables.ByRecording, recording: str) -> tuple[Interval, ...]:
    """Return the tags of a recording from the table `intervals`, as the annotation writes them."""
    rows = tables.rows_of(intervals, recording)
    columns = zip(rows["start_s"], rows["end_s"], rows["written"], rows["tier"], strict=True)
    # A label may be empty, which a table read from a file has as missing.
    found = [
        Interval(float(start), float(end), "" if pd.isna(label) else str(label), str(tier))
        for start, end, label, tier in columns
    ]
    return tuple(dict.fromkeys(found))  # a tier may have two roles


def _tags_note(annotation: Annotation | None) -> str:
    """Return which tags were left out and which tiers are empty, the first few by name."""
    if annotation is None:
        return ""
    notes = [str(one) for one in annotation.left_out[:MOST_TOLD]]
    if len(annotation.left_out) > MOST_TOLD:
        notes.append(f"and {len(annotation.left_out) - MOST_TOLD} more")
    notes += [f"tier {tier} is empty" for tier in annotation.empty_tiers]
    return "; ".join(" ".join(note.split()) for note in notes)


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
        "tags_left_out": len(annotation.left_out) if annotation else 0,
        "tags_note": _tags_note(annotation),
        "motion_file": entry.motion,
        "annotation_file": entry.annotation,
        "notes": " | ".join(recording.notes),
    }
