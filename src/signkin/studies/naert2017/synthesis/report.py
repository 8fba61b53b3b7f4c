"""What the report shows of synthesis (Naert et al. 2017, sections 3.1 and 5.2)."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path

import pandas as pd

from signkin.corpus import Corpus
from signkin.exhibits import Exhibit
from signkin.report.exhibit_views import exhibit_view
from signkin.report.page import TableView, View
from signkin.tables import read_table


def captions(folder: Path) -> dict[str, str]:
    """Return the captions of Fig. 1, 2, 12 and 13 of a corpus; folder: results/.../<corpus>."""
    path = folder / "synthesis" / "captions.json"
    if not path.is_file():
        return {}
    told: dict[str, str] = json.loads(path.read_text(encoding="utf-8"))
    return told


def views(folder: Path, unit: str) -> Iterator[View]:
    """Yield the tables of a corpus's synthesis: which method is nearest, and utterances."""
    path = folder / "synthesis" / "synthesis_summary.csv"
    if path.is_file():
        frame = read_table(path, "synthesis_summary")
        for material in ("own", "other"):
            part = frame[frame["material"] == material]
            if len(part):
                yield _summary(part, material, path, unit)
    path = folder / "synthesis" / "readings_synthesis.csv"
    if path.is_file():
        yield _readings(path)
    path = folder / "synthesis" / "utterances.csv"
    if path.is_file():
        frame = read_table(path, "utterances")
        if len(frame):
            yield _utterances(frame, path, folder / "synthesis" / "utterances", unit)


def _readings(path: Path) -> TableView:
    return TableView(
        label="",
        title="Synthesis with two rules of ours, and as printed",
        caption="Orientations along the arc (slerp) or linear, of captured transitions "
        "interpolated in their true time; signs of 300 random lists of five glosses chosen for the "
        "whole list (chain) or each the nearest to the one before (greedy). No claim rests on "
        "either.",
        frame=read_table(path, "readings_synthesis"),
        columns={
            "rule": ("rule", ""),
            "reading": ("how", ""),
            "printed": ("as printed", ""),
            "measure": ("measure", ""),
            "unit": ("unit", ""),
            "mean": ("mean", ".4g"),
            "n": ("n", "d"),
            "note": ("note", ""),
        },
        file=path,
    )


def chapters(
    folder: Path, corpus: Corpus, listing: Iterable[Exhibit]
) -> Iterator[tuple[str, View]]:
    """Yield chapter and exhibit of a corpus without tags; nothing where none was synthesised."""
    told = captions(folder)
    if not told:
        return
    for exhibit in listing:
        if exhibit.stem in told:
            chapter = "truth" if exhibit.stem in ("fig12", "fig13") else "synthesis"
            yield chapter, exhibit_view(exhibit, folder, told[exhibit.stem])
    path = folder / "synthesis" / "found_signs.csv"
    found = read_table(path, "found_signs")
    yield (
        "synthesis",
        TableView(
            label="",
            title="Signs found",
            caption="The sign of each take, between two rest parts: from where the raised hand "
            "has come to rest to where it begins to fall (config.yaml, synthesis.found_*); or as "
            "corpus.yaml says. The corpus has no tags: nothing is compared with captured "
            "transitions.",
            frame=found,
            columns={
                "recording": ("recording", ""),
                "gloss": ("gloss", ""),
                "start_s": ("start (s)", ".3f"),
                "end_s": ("end (s)", ".3f"),
                "source": ("source", ""),
            },
            file=path,
        ),
    )
    for view in views(folder, corpus.unit):
        yield "synthesis", view


_ABOUT = {
    "own": "The two signs of each captured transition, joined anew. Blending is made of the "
    "captured transition itself here (with the true duration it is that transition), so it starts "
    "with an advantage that it does not have in practice.",
    "other": "Each captured transition made of other signs of the same two glosses, so that no "
    "method sees it: as in practice. The errors hold what one signing of a gloss differs from "
    "another as well.",
}


def _summary(frame: pd.DataFrame, material: str, path: Path, unit: str) -> TableView:
    nearest = [
        f"{row.measure}: {row.method} with {row.duration_model}"
        for row in frame[frame["nearest"] == "nearest"].itertuples()
    ]
    ties = int((frame["nearest"] == "as near").sum())
    missing = sorted(set(frame.loc[frame["n"] == 0, "duration_model"]))
    caption = (
        f"{_ABOUT[material]} {int(frame['transitions'].max())} transitions made; n have a value "
        "for every method. Mean error with 95 % bootstrap interval over transitions; position "
        f"errors in {unit} after time alignment; models learnt without the transition's recording "
        "(or without the transition, where there is one recording). "
        f"Nearest: {'; '.join(nearest) or 'none'}. As near ({ties}): the paired interval of the "
        "difference to the nearest holds 0. The true duration is a reference, not ranked."
    )
    if missing:
        caption += f" Without a duration in this corpus: {', '.join(missing)}."
    shown = frame[frame["n"] > 0]
    return TableView(
        label="",
        title="Synthesis against the captured motion, "
        + ("the signs' own motion" if material == "own" else "other signs of the same glosses"),
        caption=caption,
        frame=shown,
        columns={
            "measure": ("error", ""),
            "unit": ("unit", ""),
            "method": ("method", ""),
            "duration_model": ("duration", ""),
            "n": ("n", "d"),
            "mean": ("mean", ".4g"),
            "low": ("2.5 %", ".4g"),
            "high": ("97.5 %", ".4g"),
            "over_best": ("over the nearest", ".4g"),
            "over_best_low": ("2.5 %", ".4g"),
            "over_best_high": ("97.5 %", ".4g"),
            "nearest": ("", ""),
        },
        file=path,
        most=20,
    )


def _utterances(frame: pd.DataFrame, path: Path, folder: Path, unit: str) -> TableView:
    files = sorted(
        p.name for p in folder.glob("*") if p.suffix in (".bvh", ".csv") and "_parts" not in p.name
    )
    return TableView(
        label="",
        title="Utterances",
        caption=f"Synthetic utterances of config.yaml, each sign the one nearest to its "
        f"neighbours over the whole sequence; files in synthesis/utterances: {', '.join(files)}. "
        'Others: make utterance CORPUS=... GLOSSES="...".',
        frame=frame,
        columns={
            "utterance": ("utterance", ""),
            "kind": ("part", ""),
            "gloss": ("gloss", ""),
            "recording": ("recording", ""),
            "from_s": ("from (s)", ".2f"),
            "to_s": ("to (s)", ".2f"),
            "start_s": ("start (s)", ".2f"),
            "end_s": ("end (s)", ".2f"),
            "candidates": ("candidates", "d"),
            f"euclidean_{unit}": (f"distance ({unit})", ".3g"),
            "duration_model": ("duration", ""),
            "note": ("note", ""),
        },
        file=path,
        most=12,
    )
