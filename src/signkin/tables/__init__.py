"""The tables that the pipeline writes: their columns, units and meaning.

A file a subject; `docs/data-dictionary.md` is made from them (`python -m signkin.tables`), and a
table whose columns differ from its description is not written.
"""

from signkin.tables.by_recording import ByRecording, rows_of
from signkin.tables.dictionary import dictionary
from signkin.tables.kinds import TABLES
from signkin.tables.schema import LENGTH_UNITS, Column, Table
from signkin.tables.store import concatenated, empty, read_table, write_table

__all__ = [
    "LENGTH_UNITS",
    "TABLES",
    "ByRecording",
    "Column",
    "Table",
    "concatenated",
    "dictionary",
    "empty",
    "read_table",
    "rows_of",
    "write_table",
]
