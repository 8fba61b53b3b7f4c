"""What a table is, and columns that many tables have.

A `{u}` in a column's name stands for the corpus's unit of length, m or px.
"""

from __future__ import annotations

from dataclasses import dataclass

LENGTH_UNITS = ("m", "px")


@dataclass(frozen=True)
class Column:
    """One column: name, unit (empty where it has none), meaning."""

    name: str
    unit: str
    meaning: str
    text: bool = False


@dataclass(frozen=True)
class Table:
    """One kind of table: where it lies, what a row is, its columns."""

    name: str
    path: str
    row: str
    columns: tuple[Column, ...]

    def names(self, unit: str = "m") -> list[str]:
        """Return the column names for a corpus in metres or pixels."""
        return [column.name.format(u=unit) for column in self.columns]


def text(name: str, meaning: str) -> Column:
    """Return a column of text."""
    return Column(name, "", meaning, text=True)


LEAD = (
    text("corpus", "corpus, as its folder is called"),
    text("recording", "recording, one take"),
    text("signer", "signer, as recordings.csv names them"),
)
HAND = text("hand", "right or left, the signer's own")
SIGN = Column("sign", "", "place of the sign in its recording, from 1, in order of start")
EDGE = text("edge", "start or end of the sign")
NOTE = text("note", "why a value is missing or special")
