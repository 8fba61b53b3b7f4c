"""What an analysis that cannot run leaves behind: its declared files, empty, and why.

A table keeps its columns and has no row, a figure says why there is nothing to see, and a row of
the table `not_available` tells the reason; whatever reads these files goes on, and the report lists
the rows. They lie in `results/<corpus>/not_available/`, a file a job, written by the job alone.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from functools import cache
from html import escape
from pathlib import Path

import pandas as pd

from signkin.errors import SignkinError
from signkin.tables import TABLES, empty, read_table, write_table

KIND = "not_available"
SENTENCE = "Not available: {}"
LONGEST = 600  # letters of a reason that is another program's
_FIGURE_WIDTH_IN = 6.9


def reason_of(error: BaseException, log: str | Path) -> str:
    """Return why, as a sentence. What is no SignkinError is told to be a fault of this package."""
    if isinstance(error, SignkinError):
        return " ".join(str(error).split())
    told = f"{type(error).__name__}: {' '.join(str(error).split())}"[:LONGEST]
    return f"{told} (a fault of signkin; its traceback is in {log})"


def rows_of(folder: Path) -> pd.DataFrame:
    """Return all rows of `results/<corpus>/not_available`, none where the folder is not there."""
    parts = [read_table(path, KIND) for path in sorted(folder.glob("*.csv"))]
    return pd.concat(parts, ignore_index=True) if parts else empty(KIND)


def write_rows(rows: Iterable[Mapping[str, str]], path: Path) -> None:
    """Write the rows of a job; without any, there is no file."""
    frame = pd.DataFrame(list(rows), columns=TABLES[KIND].names())
    if frame.empty:
        path.unlink(missing_ok=True)
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    write_table(frame, path, KIND)


def lacking(files: Iterable[str | Path], rows: pd.DataFrame) -> str:
    """Return why the first of some files that is not available is not, empty where all are."""
    wanted = {Path(file).as_posix() for file in files}
    for listed, reason in zip(rows["files"], rows["reason"], strict=True):
        if wanted & set(str(listed).split(" ")):
            return str(reason)
    return ""


def write_placeholder(
    path: Path, reason: str, unit: str, kind: str = "", figures: Iterable[str] = ()
) -> None:
    """Write a file that has nothing in it, so that what reads it can go on.

    kind: of the table; found by the file's place where it is not told. figures: the stems that a
    file of captions tells of.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    sentence = SENTENCE.format(reason)
    match path.suffix:
        case ".csv" | ".parquet":
            if kind := kind or kind_at(path):
                write_table(empty(kind, unit), path, kind, unit)
            elif path.suffix == ".parquet":
                pd.DataFrame().to_parquet(path)
            else:
                path.write_text("", encoding="utf-8")
        case ".svg" | ".pdf":
            _notice(sentence, path)
        case ".json":  # captions of the figures
            path.write_text(json.dumps(dict.fromkeys(figures, sentence)) + "\n", encoding="utf-8")
        case ".html":
            page = f"<!doctype html><title>Not available</title><p>{escape(sentence)}</p>\n"
            path.write_text(page, encoding="utf-8")
        case ".txt":
            path.write_text(sentence + "\n", encoding="utf-8")
        case _:
            path.mkdir(exist_ok=True)


@cache
def _places() -> list[tuple[re.Pattern[str], str]]:
    """Where each kind of table lies, as patterns of paths."""
    out = []
    for name, table in TABLES.items():
        for place in table.path.split(", "):
            if place.endswith((".csv", ".parquet")) and " " not in place:
                folder = "" if "/" in place else f"{Path(table.path.split(', ')[0]).parent}/"
                pattern = re.sub(r"<[^>]+>", "[^/]+", re.escape(f"{folder}{place}"))
                out.append((re.compile(f"(?:.*/)?{pattern}"), name))
    return out


def kind_at(path: Path) -> str:
    """Return the kind of the table that lies at a path, empty where none is declared there."""
    place = path.as_posix()
    whole = re.sub(r"/shards/[^/]+/", "/", place)
    for wanted in (place, whole):
        for pattern, name in _places():
            if pattern.fullmatch(wanted):
                return name
    return ""


def _notice(sentence: str, path: Path) -> None:
    """Draw a sentence, the same bytes each time."""
    import textwrap

    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    lines = textwrap.wrap(sentence, 110)
    with mpl.rc_context({"svg.hashsalt": "signkin", "font.family": "DejaVu Sans"}):
        figure = Figure(figsize=(_FIGURE_WIDTH_IN, 0.5 + 0.18 * len(lines)))
        FigureCanvasAgg(figure)
        figure.text(0.5, 0.5, "\n".join(lines), ha="center", va="center", fontsize=8.5)
        date = "Date" if path.suffix == ".svg" else "CreationDate"
        figure.savefig(path, metadata={date: None, "Creator": "signkin"})
