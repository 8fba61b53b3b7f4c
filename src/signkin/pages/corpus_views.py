"""Tables and plots of the page of a corpus."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from signkin.pages.corpora import sign_columns
from signkin.pages.corpus_durations import counted, untyped_glosses
from signkin.pages.corpus_elan import address_of
from signkin.pages.speeds import SPEED_PANELS
from signkin.report.page import FigureView, PlotView, TableView, View, figure_files
from signkin.report.plots import Point, scatter, thinned

if TYPE_CHECKING:
    from signkin.pages.corpus_page import Owner

S3 = ".3f"
ROW_KEYS = ("recording", "signer")
RATED = ("rated", "noted")


# --- recordings ------------------------------------------------------------------------------


def recordings_views(owner: Owner, file: Path) -> Iterator[View]:
    """Yield the table of recordings and the plots that belong to it."""
    yield from _plots(owner)
    frame = owner.overview.assign(
        page=[owner.sources.excerpt(owner.name, r) for r in owner.overview["recording"]],
        rating="",
    )
    frame = rated(owner, frame)
    extra = owner.about.set_index("recording")
    own = sign_columns(owner.sources.corpora[owner.name])
    for column in own:
        frame[column] = frame["recording"].map(extra[column])
    columns: dict[str, tuple[str, str]] = {
        "recording": ("recording", ""), "signer": ("signer", ""), **own,
        "rate_hz": ("Hz", "g"), "duration_s": ("length (s)", ".2f"),
        "gap_share": ("missing", ".1%"), "longest_gap_s": ("longest gap (s)", ".2f"),
    }  # fmt: skip
    if owner.tagged:
        columns |= {
            "transitions": ("transitions", "d"), "mean_s": ("mean (s)", S3),
            "near": ("tags at minima", ".0%"),
        }  # fmt: skip
    columns |= {"flags": ("odd", "d"), "odd": ("what looks odd", "")}
    if frame["page"].ne("").any():
        columns["page"] = ("open", "open")
    columns["rating"] = ("your rating", "rating")
    yield TableView(
        label="",
        title="All recordings",
        caption="Missing: share of all positions, before gaps are filled."
        + (
            " Mean: of the durations of its transitions (interval: Durations of transitions, by "
            "recording). Tags at minima: of the hand that has more."
            if owner.tagged
            else ""
        ),
        frame=frame,
        columns=columns,
        file=file,
        most=25,
        keys=(*ROW_KEYS, *RATED),
    )


def _plots(owner: Owner) -> Iterator[PlotView]:
    if owner.transitions is not None and len(counted(owner.transitions)):
        if owner.overview["mean_s"].notna().sum() > 1:
            yield _means(owner)
        yield _distances(owner)
    elif len(owner.overview):
        yield _lengths(owner)


def _means(owner: Owner) -> PlotView:
    rows = owner.overview[owner.overview["mean_s"].notna()].sort_values("mean_s", kind="stable")
    points = [
        Point(
            rank, row.mean_s, row.recording, row.signer,
            f"{row.recording}, {row.signer}: {row.mean_s:.3f} s, {int(row.transitions)} "
            "transitions", row.low_s, row.high_s,
        )
        for rank, row in enumerate(rows.itertuples(), start=1)
    ]  # fmt: skip
    shown, told = thinned(points)
    finding = (
        f"Mean duration of transitions in {len(rows)} recordings, from {rows['mean_s'].min():.3f} "
        f"to {rows['mean_s'].max():.3f} s; half of them above {rows['mean_s'].median():.3f} s."
    )
    return PlotView(
        label="",
        title="Mean duration of each recording",
        caption=f"{finding} Shortest first; lines: 95 % intervals.{told}",
        drawing=scatter(shown, "recordings, shortest mean first", "mean duration (s)", finding,
                        numbers=False),
    )  # fmt: skip


def _distances(owner: Owner) -> PlotView:
    assert owner.transitions is not None
    rows = counted(owner.transitions)
    rows = rows[rows["mean_distance"].notna()]
    points = [
        Point(
            row.mean_distance, row.duration_s, row.recording, row.signer,
            f"{row.previous_gloss} → {row.next_gloss}, {row.recording} at {row.start_s:.2f} s: "
            f"{row.duration_s:.2f} s",
            address=owner.sources.excerpt(owner.name, row.recording, row.start_s),
        )
        for row in rows.itertuples()
    ]  # fmt: skip
    shown, told = thinned(points)
    if any(point.address for point in shown):
        told += " A point that is chosen leads to its transition; a double click goes there."
    several = rows["mean_distance"].nunique() > 1 and rows["duration_s"].nunique() > 1
    correlation = (
        np.corrcoef(rows["mean_distance"], rows["duration_s"])[0, 1] if several else np.nan
    )
    finding = f"Duration over distance of {len(rows)} transitions"
    finding += f", correlation {correlation:.2f}." if np.isfinite(correlation) else "."
    return PlotView(
        label="",
        title="Duration and distance of each transition",
        caption=f"{finding} It is Figure 7 of Naert et al. (2017). Distance: how far apart the two "
        "postures are, mean of the normalised distances of position and orientation (where there "
        f"are orientations).{told}",
        drawing=scatter(shown, "mean normalised distance", "duration (s)", finding),
        files=[owner.sources.tagged_file(owner.name, "transitions")],
    )


def _lengths(owner: Owner) -> PlotView:
    rows = owner.overview
    if not rows["gap_share"].any():
        return _whole(owner)
    points = [
        Point(
            row.duration_s, row.gap_share * 100, row.recording, row.signer,
            f"{row.recording}, {row.signer}: {row.duration_s:.2f} s, {row.gap_share:.1%} missing",
        )
        for row in rows.itertuples()
    ]  # fmt: skip
    shown, told = thinned(points)
    worst = rows.loc[rows["gap_share"].idxmax()]
    finding = (
        f"Lengths of {len(rows)} recordings go from {rows['duration_s'].min():.2f} to "
        f"{rows['duration_s'].max():.2f} s; most is missing in {worst['recording']} "
        f"({worst['gap_share']:.1%} of its positions)."
    )
    return PlotView(
        label="",
        title="Length and missing positions of each recording",
        caption=finding + told,
        drawing=scatter(shown, "length (s)", "positions missing (%)", finding),
    )


def rated(owner: Owner, frame: pd.DataFrame) -> pd.DataFrame:
    """Return rows with what their owner thought of them before this run."""
    found = [owner.rating(row) for row in frame.itertuples()]
    return frame.assign(
        rated=[one.rating if one else "" for one in found],
        noted=[one.note if one else "" for one in found],
    )


URGENCY = {1: "results may be wrong", 2: "look", 3: "if there is time", 4: "rated ok"}


def _whole(owner: Owner) -> PlotView:
    """Return lengths alone, where nothing is missing."""
    rows = owner.overview.sort_values("duration_s", kind="stable")
    points = [
        Point(rank, row.duration_s, row.recording, row.signer,
              f"{row.recording}, {row.signer}: {row.duration_s:.2f} s")
        for rank, row in enumerate(rows.itertuples(), start=1)
    ]  # fmt: skip
    shown, told = thinned(points)
    finding = (
        f"Lengths of {len(rows)} recordings go from {rows['duration_s'].min():.2f} to "
        f"{rows['duration_s'].max():.2f} s; half of them are longer than "
        f"{rows['duration_s'].median():.2f} s. No position is missing."
    )
    return PlotView(
        label="",
        title="Length of each recording",
        caption=f"{finding} Shortest first.{told}",
        drawing=scatter(shown, "recordings, shortest first", "length (s)", finding, numbers=False),
    )


def todo_view(owner: Owner, file: Path, elan: dict[str, Path]) -> TableView:
    """Return the list of what to look at; elan: recording -> its file with a tier `check`."""
    frame = owner.todo
    frame = frame.assign(
        page=[
            owner.sources.excerpt(owner.name, row.recording, row.start_s)
            for row in frame.itertuples()
        ],
        rating="",
        start=_key(frame["start_s"], frame["what"]),
        end=_key(frame["end_s"], frame["what"]),
        urgency=frame["rank"].map(URGENCY),
        elan=[
            address_of(elan[name], file.parent) if name in elan else ""
            for name in frame["recording"]
        ],
    )
    frame = rated(owner, frame)
    columns: dict[str, tuple[str, str]] = {
        "urgency": ("how urgent", ""), "why": ("why", ""), "what": ("what", ""),
        "recording": ("recording", ""), "signer": ("signer", ""), "gloss": ("sign", ""),
        "start_s": ("from (s)", ".2f"), "end_s": ("to (s)", ".2f"),
    }  # fmt: skip
    if frame["page"].ne("").any():
        columns["page"] = ("excerpt", "open")
    if elan:
        columns["elan"] = ("ELAN", "open")
    columns["rating"] = ("your rating", "rating")
    return TableView(
        label="",
        title="Recordings, tags and transitions that look odd",
        caption="A tag counts as odd where neither hand has a minimum of speed within "
        f"{owner.window_s:g} s; a transition where it is an outlier, of no length, or where signs "
        "overlap; a recording where lengths or speeds cannot be a body's, much is missing, or it "
        "stands apart from the others.",
        frame=frame,
        columns=columns,
        file=file,
        most=20,
        keys=("recording", "signer", "what", "start", "end", "gloss", *RATED),
    )


def _key(times: pd.Series, what: pd.Series) -> list[str]:
    return [
        "" if pd.isna(t) or kind == "recording" else f"{t:.3f}"
        for t, kind in zip(times, what, strict=True)
    ]


# --- durations -------------------------------------------------------------------------------

DURATION_COLUMNS = {
    "n": ("transitions", "d"), "recordings": ("recordings", "d"), "mean_s": ("mean (s)", S3),
    "low_s": ("low", S3), "high_s": ("high", S3), "sd_s": ("SD (s)", S3),
    "median_s": ("median (s)", S3), "p5_s": ("5 %", S3), "p95_s": ("95 %", S3),
    "note": ("note", ""),
}  # fmt: skip
FROM = {
    "lexicon": "types of both signs from signs.csv",
    "motion": "a type from motion",
    "none": "without a type",
}


def duration_views(owner: Owner, file: Path) -> Iterator[TableView]:
    """Yield durations overall, by where types come from, by type, signer and recording."""
    frame = owner.durations
    assert frame is not None
    yield _durations(
        frame[frame["group"].isin(["all", "types from"])], file, "All transitions",
        "Low, high: 95 % interval of the mean, over recordings where there are enough of them. "
        "Told apart by where the types of the signs come from.",
        {"told": ("which", "")},
    )  # fmt: skip
    types = frame[frame["group"] == "type"]
    if len(types):
        yield _durations(
            types, file, "By type",
            "Two digits of the sign before, two of the sign after: hands (0 one, 1 two, 2 one "
            "with the other keeping the context), symmetry. Types that come from signs.csv and "
            "those that motion gives stand apart: the latter are wrong now and then (table of "
            "agreement below). The commonest first.",
            {"name": ("type", ""), "types_from": ("types from", "")},
        )  # fmt: skip
    untyped = untyped_glosses(owner.sources.tagged_table(owner.name, "sign_types"))
    if len(untyped):
        yield _untyped(owner, untyped)
    for group, title in (("signer", "By signer"), ("recording", "By recording")):
        rows = frame[frame["group"] == group]
        keyed = rows.assign(**{group: rows["name"]})
        if group == "recording":
            signer = owner.about.set_index("recording")["signer"]
            keyed["signer"] = keyed["recording"].map(signer)
        yield _durations(
            keyed, file, title, "Low, high: 95 % interval of the mean.",
            {"name": (group, "")}, ROW_KEYS if group == "recording" else ("signer",),
        )  # fmt: skip


def _durations(
    rows: pd.DataFrame, file: Path, title: str, caption: str,
    first: dict[str, tuple[str, str]], keys: tuple[str, ...] = (),
) -> TableView:  # fmt: skip
    told = rows["name"].map(lambda name: FROM.get(name, name))
    several = set(rows["group"]) != {"recording"}
    columns = {k: v for k, v in DURATION_COLUMNS.items() if several or k != "recordings"}
    return TableView(
        label="",
        title=title,
        caption=caption,
        frame=rows.assign(told=told),
        columns={**first, **columns},
        file=file,
        most=20,
        keys=keys,
    )


def _untyped(owner: Owner, frame: pd.DataFrame) -> TableView:
    frame = frame.assign(
        page=[
            owner.sources.excerpt(owner.name, row.recording, row.start_s)
            for row in frame.itertuples()
        ]
    )
    columns: dict[str, tuple[str, str]] = {
        "gloss": ("gloss", ""), "n": ("signs", "d"), "commonest": ("commonest type by motion", ""),
        "agreement": ("of its signs", ".0%"), "recording": ("first in", ""),
        "start_s": ("at (s)", ".2f"),
    }  # fmt: skip
    if frame["page"].ne("").any():
        columns["page"] = ("excerpt", "open")
    share = frame["n"].cumsum() / frame["n"].sum()
    half = int((share < 0.5).sum()) + 1
    return TableView(
        label="",
        title="Glosses without a type in signs.csv",
        caption=f"{len(frame)} glosses, {int(frame['n'].sum())} signs, the commonest first: typing "
        f"the first {half} by hand covers half of the signs.",
        frame=frame,
        columns=columns,
        file=owner.sources.tagged_file(owner.name, "lexicon"),
        most=10,
    )


# --- tags ------------------------------------------------------------------------------------


def tag_views(owner: Owner, file: Path) -> Iterator[TableView]:
    """Yield how near tags lie to minima, by hand and signer, and by recording."""
    frame = owner.tags
    assert frame is not None
    columns = {
        "hand": ("hand", ""), "n": ("tags", "d"), "near": ("near a minimum", ".0%"),
        "low": ("low", ".0%"), "high": ("high", ".0%"), "moved": ("moved", ".0%"),
        "median_distance_s": ("median distance (s)", S3),
    }  # fmt: skip
    signer = owner.about.set_index("recording")["signer"]
    for groups, title, most in ((("all", "signer"), "By hand and signer", 24),
                                (("recording",), "By recording", 10)):  # fmt: skip
        rows = frame[frame["group"].isin(groups)]
        if groups == ("recording",):
            rows = rows.assign(recording=rows["name"], signer=rows["name"].map(signer))
            rows = rows.sort_values("near", kind="stable")
        else:
            rows = rows.assign(signer=rows["name"])
        yield TableView(
            label="",
            title=f"Tags at minima of speed: {title.lower()}",
            caption=f"Starts and ends of signs with a minimum of that hand's speed within "
            f"{owner.window_s:g} s; low, high: 95 % interval (Wilson, tags taken as independent). "
            "Moved: refinement found a minimum that no other tag has."
            + (" The fewest first." if groups == ("recording",) else ""),
            frame=rows,
            columns={"name": (groups[-1], ""), **columns},
            file=file,
            most=most,
            keys=ROW_KEYS if groups == ("recording",) else ("signer",),
        )


def speed_view(owner: Owner) -> FigureView:
    """Return wrist speeds of some recordings of a corpus without tags."""
    base = owner.sources.results / owner.name / "fig_speed"
    lowpass = owner.sources.settings.kinematics.lowpass
    shown = min(len(owner.about), SPEED_PANELS)
    return FigureView(
        label="",
        title="Wrist speed",
        caption="Speed of the right (blue) and left (red) wrist with their local minima (dots) in "
        f"{shown} of {len(owner.about)} recordings, spread over the list; low-pass: "
        f"{lowpass.method}, half gain at {lowpass.cutoff_hz:g} Hz.",
        svg=base.with_suffix(".svg"),
        files=figure_files(base, ".svg", ".pdf"),
    )
