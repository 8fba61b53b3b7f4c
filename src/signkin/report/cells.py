"""A table's cells as text: those that a page writes out, and those that its script shows."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd
from markupsafe import Markup

WORDS = ("verdict", "link", "rating", "open")  # formats of columns that hold text
MOST_NOTES = 20  # more of them stay in their rows
MOST_LETTERS = 700_000  # of the rows that a page has of a table; the file has all
LONGEST = 400  # letters of a cell; the file has all


def cell(value: object, form: str) -> str:
    """Return a value as it is printed; what is missing is a dash."""
    if value is None or (isinstance(value, float) and pd.isna(value)) or value == "":
        return "–"
    if not form or form in WORDS or isinstance(value, str):
        text = str(value)
        return text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
    # A column of counts with gaps comes as floats.
    return format(int(value) if form == "d" else value, form)  # type: ignore[call-overload]


def notes_of(frame: pd.DataFrame, columns: Mapping[str, Any]) -> list[str]:
    """Return the different notes of a table, which stand below it with numbers; none if many.

    A column of sentences would make the rows of all others tall.
    """
    if "note" not in columns:
        return []
    notes = [str(note) for note in dict.fromkeys(frame["note"]) if note and pd.notna(note)]
    return notes if len(notes) <= MOST_NOTES else []


def texts_of(
    rows: Sequence[Mapping[str, Any]],
    columns: Mapping[str, tuple[str, str]],
    notes: Sequence[str],
    keys: Sequence[str] = (),
) -> list[list[str]]:
    """Return the cells of rows as text: the columns, then the keys that mark a row."""
    numbered = {note: str(i + 1) for i, note in enumerate(notes)}
    out = []
    for row in rows:
        cells = [
            numbered.get(str(row[name]), "") if name == "note" and notes
            else str(row[name] or "") if form in ("link", "open")
            else cell(row[name], form)
            for name, (_, form) in columns.items()
        ]  # fmt: skip
        out.append(cells + [str(row[key]) for key in keys])
    return out


def first_that_fit(rows: Sequence[Sequence[str]], most: int = MOST_LETTERS) -> int:
    """Return how many rows, from the first, have no more than so many letters together."""
    letters = 0
    for i, row in enumerate(rows):
        letters += sum(len(text) + 3 for text in row)
        if letters > most:
            return i
    return len(rows)


def as_json(value: object) -> Markup:
    """Return a value as JSON that may stand in a script element."""
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c").replace("\u2028", " "))
