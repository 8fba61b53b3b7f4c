"""Exhibits of a paper as a page shows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from signkin.exhibits import Exhibit
from signkin.report.page import FigureView, View, figure_files


def exhibit_view(exhibit: Exhibit, folder: Path, caption: str) -> FigureView:
    """Return a figure of the list, whose files lie in `folder` under its stem."""
    base = folder / exhibit.stem
    return FigureView(
        label=exhibit.label,
        title=exhibit.title,
        caption=caption,
        svg=base.with_suffix(".svg"),
        files=figure_files(base),
        differs=exhibit.differs,
    )


def by_exhibit(views: Sequence[View], order: Mapping[str, int]) -> list[View]:
    """Return views of several corpora in the paper's order, those of one exhibit together.

    order: label -> place in the paper. What has no label follows the exhibit that it stands
    below, again with that of the same title in other corpora.
    """
    places = []
    before: tuple[str, int] = ("", -1)  # a new corpus starts anew
    for view in views:
        place = order.get(view.label, before[1] if view.of == before[0] else -1)
        before = (view.of, place)
        places.append(place)
    ranks: dict[tuple[int, str], int] = {}
    for view, place in zip(views, places, strict=True):
        ranks.setdefault((place, view.title), len(ranks))
    keyed = zip(views, places, strict=True)
    return [v for v, place in sorted(keyed, key=lambda p: (p[1], ranks[(p[1], p[0].title)]))]
