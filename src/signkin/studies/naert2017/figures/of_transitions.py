"""Fig. 4 to 10 of a corpus, as papers/naert2017/exhibits.yaml lists them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pandas as pd

from signkin import tables
from signkin.coarticulation.excerpts import Excerpt, choose_excerpts
from signkin.corpus import Corpus
from signkin.exhibits import Exhibit
from signkin.report.drawn import Drawn, drawings
from signkin.statistics.descriptive import Diamond
from signkin.studies.naert2017.distances import with_flags
from signkin.studies.naert2017.figures import (
    fig04_06_speed,
    fig07_distances,
    fig08_diamond,
    fig09_segmentations,
    fig10_hands,
)
from signkin.studies.naert2017.figures.notice import notice
from signkin.studies.naert2017.sampling import sample
from signkin.studies.naert2017.settings import FigureSettings
from signkin.studies.naert2017.transitions import counted

NO_SIGNS = "No utterance of the corpus has three signs in a row."


@dataclass(frozen=True, eq=False)
class Measured:
    """What the figures are drawn from: tables of a corpus by name, and more.

    frames: the files of its kinematics. published: Table 2 as printed.
    """

    corpus: Corpus
    boundaries: pd.DataFrame
    sign_types: pd.DataFrame
    transitions: pd.DataFrame
    minima: pd.DataFrame
    frames: Sequence[Path]
    published: pd.DataFrame
    settings: FigureSettings
    seed: int

    @cached_property
    def excerpts(self) -> dict[str, Excerpt]:
        """Which stretch of which recording Fig. 4, 5 and 6 show."""
        named = self.corpus.settings.get("examples", {})
        used = self.settings.samples.transitions
        signs = self.sign_types.assign(role="sign")
        chosen = sample(self.corpus.name, self.boundaries["recording"], signs, used, self.seed)
        return choose_excerpts(chosen.rows(self.boundaries), chosen.rows(self.sign_types), named)

    @cached_property
    def distances(self) -> tuple[pd.DataFrame, Diamond | None]:
        """The table `distances`, and the diamond."""
        chosen = self.settings.transitions
        return with_flags(self.transitions, chosen.outlier_iqr, chosen.diamond_share)


def draw(measured: Measured, listing: Iterable[Exhibit]) -> dict[str, Drawn]:
    """Draw the figures of a list: stem -> figure. One that nothing here draws is an error."""
    return drawings(DRAWINGS, measured, listing)


def _speed(stem: str) -> Callable[[Measured], Drawn]:
    def drawn(of: Measured) -> Drawn:
        if stem not in of.excerpts:
            return Drawn(notice(NO_SIGNS), tables.empty("excerpt", of.corpus.unit), NO_SIGNS)
        return fig04_06_speed.drawn(
            of.corpus,
            stem,
            of.excerpts[stem],
            of.boundaries,
            of.minima,
            of.frames,
            of.settings.kinematics.lowpass,
        )

    return drawn


def _distance(of: Measured) -> Drawn:
    return fig07_distances.drawn(of.corpus, of.distances[0], of.settings.transitions.outlier_iqr)


def _diamond(of: Measured) -> Drawn:
    return fig08_diamond.drawn(*of.distances, of.settings.transitions.diamond_share)


def _segmentations(of: Measured) -> Drawn:
    return fig09_segmentations.drawn(of.corpus, of.transitions)


def _hands(of: Measured) -> Drawn:
    return fig10_hands.drawn(of.corpus.name, counted(of.transitions), of.published)


DRAWINGS: dict[str, Callable[[Measured], Drawn]] = {
    "fig04": _speed("fig04"),
    "fig05": _speed("fig05"),
    "fig06": _speed("fig06"),
    "fig07": _distance,
    "fig08": _diamond,
    "fig09": _segmentations,
    "fig10": _hands,
}
