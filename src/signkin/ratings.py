"""What the owner of a corpus thinks of its recordings and tags: ok, check or exclude, with a note.

The page of a corpus saves ratings as CSV; `signkin corpus rate` puts them where the next run reads
them: those of recordings into recordings.csv (columns `rating` and `rating_note`), those of tags
into tag_ratings.csv beside it. What is rated `exclude` is left out, counted and listed.
"""

from __future__ import annotations

import csv
import io
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from signkin.errors import SignkinError, listed
from signkin.owner_rows import read_owner_table
from signkin.text_file import text_of

RATINGS = ("ok", "check", "exclude")
COLUMNS = ("corpus", "recording", "start_s", "end_s", "gloss", "rating", "note")
TAG_COLUMNS = COLUMNS[1:]
TAG_FILE = "tag_ratings.csv"
TOLERANCE_S = 0.002  # times are saved to a millisecond


@dataclass(frozen=True)
class Rating:
    """What is thought of a recording, or, with times and gloss, of one of its tags."""

    recording: str
    rating: str
    note: str = ""
    start_s: float | None = None
    end_s: float | None = None
    gloss: str = ""

    @property
    def of_tag(self) -> bool:
        """Whether a tag is rated."""
        return self.start_s is not None

    def matches(self, start_s: float, gloss: str) -> bool:
        """Return whether a tag is the one that is rated."""
        start = self.start_s
        near = start is not None and abs(start_s - start) <= TOLERANCE_S
        return near and unicodedata.normalize("NFC", gloss) == self.gloss


def read_ratings(path: Path, columns: tuple[str, ...] = COLUMNS) -> dict[str, list[Rating]]:
    """Return corpus -> ratings of a CSV file; '' for a file without the column `corpus`.

    Raises SignkinError with the line of what is no rating.
    """
    reader = csv.DictReader(io.StringIO(text_of(path)), strict=True)
    if tuple(reader.fieldnames or ()) != columns:
        raise SignkinError(
            f"columns {listed(reader.fieldnames or ['none'])}", file=path, place="line 1",
            expected=", ".join(columns),
            todo="Save the ratings anew on the page of the corpus.",
        )  # fmt: skip
    out: dict[str, list[Rating]] = {}
    for row in reader:
        place = f"line {reader.line_num}"
        if None in row or None in row.values():
            raise SignkinError("the row has more or fewer cells than the header", file=path,
                               place=place, expected=", ".join(columns))  # fmt: skip
        if row["rating"] not in ("", *RATINGS):
            raise SignkinError(f"the rating {row['rating']!r}", file=path, place=place,
                               expected=", ".join(RATINGS))  # fmt: skip
        times = [_time(row[key], key, path, place) for key in ("start_s", "end_s")]
        rating = Rating(
            row["recording"], row["rating"], row["note"], times[0], times[1],
            unicodedata.normalize("NFC", row["gloss"]),
        )  # fmt: skip
        out.setdefault(row.get("corpus", ""), []).append(rating)
    return out


def _time(text: str, key: str, path: Path, place: str) -> float | None:
    if not text:
        return None
    try:
        return float(text)
    except ValueError:
        raise SignkinError(
            f"{key} is {text[:40]!r}", file=path, place=place, expected="seconds, or nothing"
        ) from None


def tag_ratings(folder: Path) -> dict[str, list[Rating]]:
    """Return recording -> ratings of its tags, from a corpus's folder; often there are none."""
    path = folder / TAG_FILE
    if not path.is_file():
        return {}
    out: dict[str, list[Rating]] = {}
    for rating in read_ratings(path, TAG_COLUMNS).get("", []):
        out.setdefault(rating.recording, []).append(rating)
    return out


def put(ratings: Iterable[Rating], folder: Path) -> Mapping[str, int]:
    """Put ratings into a corpus's recordings.csv and tag_ratings.csv; returns counts by word.

    A rating replaces the one that was there; one without a word takes it back. What else stands in
    the files stays as it is. Raises SignkinError for a recording that the corpus does not have.
    """
    given = list(ratings)
    path = folder / "recordings.csv"
    table = read_owner_table(path, as_written=("sign",))
    head, body = list(table.columns), [list(row.values()) for _, row in table.rows]
    for column in ("rating", "rating_note"):
        if column not in head:
            head.append(column)
            body = [[*row, ""] for row in body]
    at = {name: head.index(name) for name in ("recording", "rating", "rating_note")}
    lines = {row[at["recording"]]: row for row in body}
    unknown = sorted({r.recording for r in given} - set(lines))
    if unknown:
        raise SignkinError(
            f"no recording {listed(unknown)}", file=path, expected="recordings of this corpus",
            todo="Are these the ratings of another corpus?",
        )  # fmt: skip
    for one in given:
        if not one.of_tag:
            lines[one.recording][at["rating"]] = one.rating
            lines[one.recording][at["rating_note"]] = " ".join(one.note.split())
    _write(path, [head, *body])
    _put_tags([one for one in given if one.of_tag], folder)
    counts: dict[str, int] = {}
    for one in given:
        word = f"{'tags' if one.of_tag else 'recordings'} {one.rating or 'without a rating'}"
        counts[word] = counts.get(word, 0) + 1
    return counts


def _put_tags(given: list[Rating], folder: Path) -> None:
    kept = {
        (r.recording, r.start_s, r.end_s, r.gloss): r
        for own in tag_ratings(folder).values()
        for r in own
    }
    for one in given:
        key = (one.recording, one.start_s, one.end_s, one.gloss)
        kept[key] = one
    rows = [
        [r.recording, f"{r.start_s:.3f}", "" if r.end_s is None else f"{r.end_s:.3f}", r.gloss,
         r.rating, " ".join(r.note.split())]
        for r in sorted(kept.values(), key=lambda r: (r.recording, r.start_s or 0.0, r.gloss))
        if r.rating or r.note
    ]  # fmt: skip
    if rows or (folder / TAG_FILE).is_file():
        _write(folder / TAG_FILE, [list(TAG_COLUMNS), *rows])


def _write(path: Path, rows: list[list[str]]) -> None:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    path.write_text(text.getvalue(), encoding="utf-8")
