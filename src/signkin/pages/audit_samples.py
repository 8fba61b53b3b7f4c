"""The samples that checks of a claim found, drawn for a paper's page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pandas as pd

from signkin.figures import style
from signkin.figures.samples import plot_copies
from signkin.report.page import FigureView

ACROSS, MOST_PANELS = 3, 12


def sample_views(identifier: str, rows: pd.DataFrame, folder: Path) -> Iterator[FigureView]:
    """Yield a figure for each check of a claim that found samples; writes its files.

    rows: of `Ledger.details`.
    """
    if rows.empty:
        return
    found = rows[[isinstance(h, tuple) and bool(h) for h in rows["histogram"]]]
    for number, (check, part) in enumerate(found.groupby("check", sort=False), 1):
        base = folder / f"samples-{identifier}-{number}"
        files = (base.with_suffix(".svg"), base.with_suffix(".pdf"))
        records = part.to_dict("records")
        _draw(records[:MOST_PANELS], base)
        left = len(records) - MOST_PANELS
        more = f" {left} more rows are in audit.json." if left > 0 else ""
        over = "all samples" if check == "closure" else "the samples made"
        yield FigureView(
            label="", title=f"{identifier}: samples that print so ({check})",
            caption=f"Bars: mean number of copies of each value over {over}; lines: from the least "
            f"to the greatest. Possible data, not likely data.{more}",
            svg=files[0], files=files,
        )  # fmt: skip


def _draw(records: Sequence[Mapping[Any, Any]], base: Path) -> None:
    across = min(ACROSS, len(records))
    down = -(-len(records) // across)
    size = (style.WIDTH_IN * max(across, 2) / ACROSS, 1.75 * down + 0.2)
    with style.paper_style():
        figure, axes = plt.subplots(down, across, figsize=size, squeeze=False)
        for ax, row in zip(axes.flat, records, strict=False):
            bars = row["histogram"]
            plot_copies([b.value for b in bars], [b[1:] for b in bars], ax)
            name = f"{row['item']}: " if row["item"] else ""
            ax.set_title(f"{name}{row['printed']}", loc="left")
        for ax in axes.flat[len(records) :]:
            ax.set_axis_off()
        for ax in axes[:, 0]:
            ax.set_ylabel("copies")
        for ax in axes[-1]:
            ax.set_xlabel("value")
        style.save(figure, base.with_suffix(".svg"), base.with_suffix(".pdf"))
