"""Figures of Endres et al. 2013, a file each: the numbers drawn, the drawing, the caption.

papers/endres2013/exhibits.yaml lists them; rules, this package and the report follow it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from signkin.errors import SignkinError, listed
from signkin.exhibits import FILE, Exhibit
from signkin.report.drawn import Drawn
from signkin.studies.endres2013.figures import (
    fig01,
    fig03,
    fig04,
    fig05,
    fig06,
    fig07,
    fig_a1,
)
from signkin.studies.endres2013.figures.sources import Sources

DRAWINGS: dict[str, Callable[[Sources], Drawn]] = {
    "fig01": fig01.drawn,
    "fig03": fig03.drawn,
    "fig04": fig04.drawn,
    "fig05": fig05.drawn,
    "fig06": fig06.drawn,
    "fig07": fig07.drawn,
    "figA1": fig_a1.drawn,
}


def draw(sources: Sources, listing: Iterable[Exhibit]) -> dict[str, Drawn]:
    """Draw the listed figures of a corpus of single signs, by the stem of their files."""
    wanted = [exhibit.stem for exhibit in listing]
    if unknown := [stem for stem in wanted if stem not in DRAWINGS]:
        raise SignkinError(
            f"{listed(unknown)} in the list, but not drawn",
            file=FILE,
            expected=listed(DRAWINGS),
            todo="Add the figure to studies/endres2013/figures.",
        )
    return {stem: DRAWINGS[stem](sources) for stem in wanted}
