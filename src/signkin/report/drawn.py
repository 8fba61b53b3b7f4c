"""A drawn figure with the numbers in it and what its caption tells, and writing them."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import pandas as pd
from matplotlib.figure import Figure

from signkin import exhibits, tables
from signkin.errors import SignkinError, listed
from signkin.exhibits import Exhibit
from signkin.figures.style import save
from signkin.job import Work
from signkin.unavailable import SENTENCE

Source = TypeVar("Source")


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure with the numbers in it and the facts its caption tells.

    A figure that cannot be drawn is None, with the error.
    """

    figure: Figure | None
    data: pd.DataFrame
    caption: str
    error: Exception | None = None


def drawings(
    known: Mapping[str, Callable[[Source], Drawn]], source: Source, listing: Iterable[Exhibit]
) -> dict[str, Drawn]:
    """Draw the figures of a list: stem -> figure.

    known: stem -> what draws it from the source. A figure that nothing draws is an error; one that
    cannot be drawn of this source does not stop the others.
    """
    out = {}
    for exhibit in listing:
        if exhibit.stem not in known:
            raise SignkinError(
                f"nothing draws {exhibit.stem}",
                file=exhibits.FILE,
                place=f"group {exhibit.group}",
                expected=listed(known),
            )
        try:
            out[exhibit.stem] = known[exhibit.stem](source)
        except Exception as error:
            out[exhibit.stem] = Drawn(None, pd.DataFrame(), "", error)
    return out


def write_figures(
    drawn: Mapping[str, Drawn],
    listing: Iterable[Exhibit],
    folder: str | Path,
    captions: str | Path,
    unit: str,
    work: Work | None = None,
) -> None:
    """Write figures with their numbers below `folder`, and all captions as JSON.

    drawn: stem -> figure; exactly what is listed. unit: of the corpus, for the tables' columns.
    work: the job, which notes the figures that could not be drawn; without it, they are errors.
    """
    wanted = {exhibit.stem: exhibit for exhibit in listing}
    if set(wanted) != set(drawn):
        raise SignkinError(
            f"{listed(sorted(wanted))} are listed, {listed(sorted(drawn))} are drawn",
            file=exhibits.FILE,
            expected="a drawing for each figure of the list",
        )
    told = {stem: drawn[stem].caption for stem in wanted}
    for stem, exhibit in wanted.items():
        base, one = Path(folder) / stem, drawn[stem]
        if one.figure is None:
            why = one.error or SignkinError("not drawn", place=stem)
            if work is None:
                raise why
            files = (base.with_suffix(suffix) for suffix in exhibits.SUFFIXES)
            told[stem] = SENTENCE.format(work.lacks(stem, why, *files, kind=exhibit.table))
            continue
        save(one.figure, base.with_suffix(".svg"), base.with_suffix(".pdf"))
        tables.write_table(one.data, base.with_suffix(".csv"), exhibit.table, unit)
    Path(captions).write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
