"""Fig. 1, 2, 12 and 13 of a corpus, as papers/naert2017/exhibits.yaml lists them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from signkin.exhibits import Exhibit
from signkin.report.drawn import Drawn, drawings
from signkin.studies.naert2017.figures import (
    fig01_02_methods,
    fig12_captured,
    fig13_composition,
)
from signkin.studies.naert2017.figures.chosen_signs import shown_pair
from signkin.studies.naert2017.figures.skeleton_parts import Array, nothing_to_draw
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.database import Database
from signkin.studies.naert2017.synthesis.duration_models import Timing, timing

NO_TRUTH = "The corpus has no captured transition."


@dataclass(frozen=True, eq=False)
class Synthesised:
    """What the figures are drawn from.

    rows: the table `synthesis`, None for a corpus without tags. printed: theta of the paper.
    """

    base: Database
    rows: pd.DataFrame | None
    printed: Array
    settings: SynthesisSettings

    @cached_property
    def clock(self) -> Timing:
        """How long transitions last."""
        chosen = self.settings.synthesis.duration
        return timing(self.base, chosen, self.settings.durations, self.printed)


def draw(of: Synthesised, listing: Iterable[Exhibit]) -> dict[str, Drawn]:
    """Draw the figures of a list: stem -> figure. One that nothing here draws is an error."""
    if len(of.base.tokens) < 2:
        why = "The corpus has fewer than two signs."
        return {exhibit.stem: nothing_to_draw(of.base, why) for exhibit in listing}
    return drawings(DRAWINGS, of, listing)


def _method(name: str) -> Callable[[Synthesised], Drawn]:
    def drawn(of: Synthesised) -> Drawn:
        return fig01_02_methods.drawn(
            of.base, shown_pair(of.base, of.rows), name, of.clock, of.settings
        )

    return drawn


def _captured(of: Synthesised) -> Drawn:
    if of.rows is None:
        return nothing_to_draw(of.base, NO_TRUTH)
    return fig12_captured.drawn(of.base, of.rows, of.settings)


def _composition(of: Synthesised) -> Drawn:
    return fig13_composition.drawn(of.base, of.settings, of.printed)


DRAWINGS: dict[str, Callable[[Synthesised], Drawn]] = {
    "fig01": _method("interpolation"),
    "fig02": _method("blending"),
    "fig12": _captured,
    "fig13": _composition,
}
