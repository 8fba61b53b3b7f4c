"""An exhibit of a paper as the page shows it."""

from __future__ import annotations

from pathlib import Path

from signkin.exhibits import Exhibit
from signkin.report.page import FigureView, figure_files


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
