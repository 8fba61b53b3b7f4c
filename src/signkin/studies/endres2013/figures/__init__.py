"""Figures of Endres et al. 2013, a file each: the numbers drawn, the drawing, the caption.

papers/endres2013/exhibits.yaml lists them; rules, this package and the report follow it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from signkin.errors import SignkinError
from signkin.exhibits import Exhibit
from signkin.report.drawn import Drawn, drawings
from signkin.studies.endres2013.figures import (
    fig01,
    fig03,
    fig04,
    fig05,
    fig06,
    fig07,
    fig_a1,
)
from signkin.studies.endres2013.figures.sources import Sources, no_truth
from signkin.studies.endres2013.single_signs import POWERLAW

Draw = Callable[[Sources], Drawn]


def _with_truth(draw_it: Draw) -> Draw:
    """Refuse to draw hit rates where no trajectory has true boundaries."""

    def drawn(sources: Sources) -> Drawn:
        rates = sources.rates[sources.rates["dataset"] == POWERLAW]
        if not (rates["n"] > rates["without_truth"]).any():
            raise no_truth(f"corpus {sources.corpus}")
        return draw_it(sources)

    return drawn


def _binned(draw_it: Draw) -> Draw:
    """Refuse to draw posteriors of orders where no trajectory was binned."""

    def drawn(sources: Sources) -> Drawn:
        if sources.orders.empty:
            raise SignkinError(
                "no recording could be binned",
                place=f"corpus {sources.corpus}",
                expected="one or more; results/endres2013/<corpus>/left_out.csv tells why not",
            )
        return draw_it(sources)

    return drawn


DRAWINGS: dict[str, Callable[[Sources], Drawn]] = {
    "fig01": fig01.drawn,
    "fig03": fig03.drawn,
    "fig04": fig04.drawn,
    "fig05": _with_truth(fig05.drawn),
    "fig06": _with_truth(fig06.drawn),
    "fig07": _binned(fig07.drawn),
    "figA1": _binned(fig_a1.drawn),
}


def draw(sources: Sources, listing: Iterable[Exhibit]) -> dict[str, Drawn]:
    """Draw the listed figures of a corpus of single signs, by the stem of their files."""
    return drawings(DRAWINGS, sources, listing)
