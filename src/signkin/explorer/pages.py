"""Writes the pages of a corpus: one a recording, and the list of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow.parquet as pq
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

import signkin
from signkin.explorer.content import as_json, content
from signkin.explorer.sources import Sources
from signkin.io.store import read_recordings
from signkin.studies.endres2013.single_signs import RECORDED

VENDOR = ("uPlot.min.css", "uPlot.iife.min.js", "uPlot.LICENSE")
# In this order: each uses what stands before it.
SCRIPTS = ("data.js", "time.js", "tracks.js", "pointer.js", "plots.js", "lanes.js", "density.js",
           "overview.js", "body.js", "compare.js", "lists.js", "main.js")  # fmt: skip
# What is taken of posteriors.parquet.
DENSITY = ["recording", "hand", "order", "bin_s", "sample_at", "order_probability",
           "boundaries_s", "boundary_probability"]  # fmt: skip


@dataclass(frozen=True)
class Listed:
    """A recording in the list: with a page (and what to look at in it), or without."""

    recording: str
    signer: str
    duration_s: float
    signs: int
    troubles: int
    page: bool


def write_pages(sources: Sources, folder: Path, listing: Path) -> None:
    """Write the pages of a corpus into a folder, RECORDING.html, and the list of them.

    Only as many as report.explorer_recordings allows; the list names the others.
    """
    folder.mkdir(parents=True, exist_ok=True)
    troubles = sources.troubles()
    names = sources.shown()
    beside = dict(zip(names, zip([None, *names], [*names[1:], None], strict=False), strict=True))
    for name, data in _contents(sources, names):
        html = render(data, *beside[name], listing.name)
        (folder / f"{name}.html").write_text(html, encoding="utf-8")
    rows = [
        Listed(
            recording=str(row["recording"]),
            signer=str(row["signer"]),
            duration_s=float(row["duration_s"]),
            signs=int(row["signs"]),
            troubles=troubles.get(str(row["recording"]), 0),
            page=str(row["recording"]) in beside,
        )
        for row in sources.tables["recordings"].to_dict("records")
    ]
    html = (
        _environment()
        .get_template("list.html.j2")
        .render(
            corpus=sources.corpus.name, folder=folder.name, rows=rows, made=len(names),
            most=sources.settings.most_recordings, version=signkin.__version__,
            css=_parts()["css"],
        )
    )  # fmt: skip
    listing.write_text(html, encoding="utf-8")


def render(data: Mapping[str, Any], before: str | None, after: str | None, listing: str) -> str:
    """Return a page as HTML. before, after: recordings beside it that have one. listing: a file."""
    return (
        _environment()
        .get_template("explorer.html.j2")
        .render(
            data=data,
            json=Markup(as_json(data)),
            before=before,
            after=after,
            listing=listing,
            version=signkin.__version__,
            **_parts(),
        )
    )


def _contents(sources: Sources, names: Sequence[str]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the content of each page, one shard after the other."""
    binned: Sequence[Path | None] = sources.posteriors or [None] * len(sources.recordings)
    for recordings, frames, posteriors in zip(
        sources.recordings, sources.frames, binned, strict=True
    ):
        kinematics = _by_recording(frames, names)
        densities = {}
        if posteriors is not None:
            densities = _by_recording(posteriors, names, DENSITY, [("dataset", "==", RECORDED)])
        for recording in read_recordings(recordings, names):
            name, none = recording.name, pd.DataFrame()
            mine = kinematics.get(name, none), densities.get(name, none)
            yield name, content(sources, recording, *mine)


def _by_recording(
    path: Path, names: Sequence[str], columns: list[str] | None = None, more: Sequence[Any] = ()
) -> dict[str, pd.DataFrame]:
    """Return the rows of some recordings; none of a file that an analysis left without content."""
    if "recording" not in pq.read_schema(path).names:
        return {}
    filters = [("recording", "in", list(names)), *more]
    frame = pd.read_parquet(path, filters=filters, columns=columns)
    return {str(name): rows for name, rows in frame.groupby("recording", sort=False)}


def _environment() -> Environment:
    return Environment(
        loader=PackageLoader("signkin.explorer"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _parts() -> Mapping[str, Markup]:
    """Return the styles and scripts that every page holds, the plotting library's among them."""
    package = files("signkin.explorer")
    vendor = {name: (package / "vendor" / name).read_text("utf-8") for name in VENDOR}
    own = {name: (package / "templates" / name).read_text("utf-8")
           for name in (*SCRIPTS, "explorer.css")}  # fmt: skip
    notice = " ".join(vendor["uPlot.LICENSE"].split())
    return {
        "css": Markup(own["explorer.css"]),
        "vendor_css": Markup(vendor["uPlot.min.css"]),
        "vendor_js": Markup(f"/* uPlot 1.6.32. {notice} */\n{vendor['uPlot.iife.min.js']}"),
        "js": Markup("\n".join(own[name] for name in SCRIPTS)),
    }
