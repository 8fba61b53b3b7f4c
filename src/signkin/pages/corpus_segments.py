"""Where boundaries are, how sure that is, and how far annotators agree: for a corpus's page."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING

import pandas as pd

from signkin.report.attempts import attempted
from signkin.report.page import FigureView, Section, TableView, View, figure_files
from signkin.tables import read_table

if TYPE_CHECKING:
    from signkin.pages.corpus_page import Owner

S3 = ".3f"
DIGITS = ".3g"  # p-values stand among the rows
SHOWN = ("boundary F1", "mF1S")  # of the scores of every method; the file has the others
CHANCE = {
    "value": ("score", S3),
    "unit": ("unit", ""),
    "chance": ("chance", S3),
    "chance_low": ("2.5 %", S3),
    "chance_high": ("97.5 %", S3),
    "note": ("note", ""),
}


def boundaries_section(owner: Owner) -> Section:
    """Return the section on boundaries with their uncertainty, and on every method's scores."""
    text = (
        "A tag is set by hand, and so a little beside the boundary. From the tags of the whole "
        "corpus and the minima of speed follows how far tags lie from boundaries, and for each tag "
        "where its boundary probably is. The paper's rule (the nearest minimum) stays what figures "
        "and tables are made with.",
    )
    views = _views(owner, {
        "Tags and where their boundaries are": _figure,
        "What changes with tags moved, or uncertain": _durations,
        "Every way of finding boundaries against the manual tags": _scores,
    })  # fmt: skip
    return Section("boundaries", "Where signs start and end, and how sure that is", text=text,
                   exhibits=views)  # fmt: skip


def agreement_section(owner: Owner) -> Section:
    """Return the section on several annotators of a corpus."""
    text = [*_in_words(owner)]
    views = _views(owner, {
        "Does refinement bring annotators nearer to each other?": _refined,
        "Offsets between annotators": _offsets,
        "Agreement of annotators": _agreement,
    })  # fmt: skip
    return Section("annotators", "Agreement of annotators", text=text, exhibits=views)


def _views(
    owner: Owner, makers: Mapping[str, Callable[[Owner, str], Iterator[View]]]
) -> list[View]:
    """Return the views by title that can be made."""
    return [
        view
        for title, make in makers.items()
        for view in attempted(title, partial(make, owner, title))
    ]


def _figure(owner: Owner, title: str) -> Iterator[View]:
    base = owner.sources.naert.file(owner.name, "fig_posterior")
    if not base.with_suffix(".svg").stat().st_size:
        return
    yield FigureView(
        label="",
        title=title,
        caption="The excerpt of Figure 6. Green: the tags as set by hand (starts solid, ends "
        "dashed). Bands: the hand's boundary lies in the dark one with 50 %, in the pale one with "
        "90 % probability; a line at the mean. A narrow band at a minimum of speed: tag and "
        "motion agree on it. A wide one: nothing but the tag tells.",
        svg=base.with_suffix(".svg"),
        files=figure_files(base, ".svg", ".pdf"),
    )


def _durations(owner: Owner, title: str) -> Iterator[View]:
    path = owner.sources.tagged_file(owner.name, "posterior_durations")
    yield TableView(
        label="",
        title=title,
        caption="Transitions between signs of an utterance, by hand. Posterior: mean over 200 "
        "draws of all boundaries from their posteriors, with 95 % of the draws. A p that goes from "
        "below to above 0.05 within them depends on where the tags are put. Distances stay those "
        "at the manual tags.",
        frame=read_table(path, "posterior_durations"),
        columns={
            "hand": ("hand", ""), "measure": ("measure", ""), "unit": ("unit", ""),
            "manual": ("manual tags", DIGITS), "refined": ("refined", DIGITS),
            "posterior": ("posterior", DIGITS), "low": ("2.5 %", DIGITS),
            "high": ("97.5 %", DIGITS),
            "n": ("n", "d"), "note": ("note", ""),
        },
        file=path,
    )  # fmt: skip


def _scores(owner: Owner, title: str) -> Iterator[View]:
    path = owner.sources.results / "endres2013" / owner.name / "segmentation_scores.csv"
    frame = read_table(path, "segmentation_scores")
    boundary, segment = (_of_measure(frame, measure) for measure in SHOWN)
    near = ", ".join(of.split(", ")[-1] for of in boundary["of"].dropna().unique() if of)
    rows = boundary.merge(segment, on=["hand", "method"], how="left",
                          suffixes=("", "_segment"))  # fmt: skip
    yield TableView(
        label="",
        title=title,
        caption="Boundary F1: the harmonic mean of how many starts and ends of signs are found and "
        f"how many that are found are right, within {near}. Segment F1 (mF1S): the same of whole "
        "signs; minima and binning find boundaries, no signs. Manual tags would have 1. Refined "
        "tags are made of them, so theirs tell how far they were moved; minima and binning do not "
        "know the tags. By chance: the same lengths and gaps in another order within each "
        "recording, 95 %. The file has all other measures.",
        frame=rows,
        columns={
            "hand": ("hand", ""), "method": ("method", ""),
            "value": ("boundary F1", S3), "chance_told": ("by chance", ""),
            "value_segment": ("segment F1", S3), "chance_told_segment": ("by chance", ""),
            "note": ("note", ""),
        },
        file=path,
        most=12,
    )  # fmt: skip


def _of_measure(frame: pd.DataFrame, measure: str) -> pd.DataFrame:
    """Return the rows of a measure, at the least tolerance where there are several.

    With those of a hand and method that say only why there is none (in `note`).
    """
    own = frame[(frame["measure"] == measure) | frame["measure"].isna() | (frame["measure"] == "")]
    own = own.drop_duplicates(["hand", "method"])
    told = [
        "" if pd.isna(row.chance_low) else f"{row.chance_low:.3f} to {row.chance_high:.3f}"
        for row in own.itertuples()
    ]
    return own.assign(chance_told=told)[["hand", "method", "of", "value", "chance_told", "note"]]


def _in_words(owner: Owner) -> Iterator[str]:
    frame = read_table(owner.sources.tagged_file(owner.name, "annotator_offsets"),
                       "annotator_offsets")  # fmt: skip
    for row in frame[frame["group"] == "all"].itertuples():
        lead = row.lead if isinstance(row.lead, str) else ""
        told = f"{lead} is earlier, by" if lead else "neither is earlier than the other:"
        yield (
            f"{row.edge.capitalize()}s of {row.n} signs, {row.first} and {row.second}: {told} "
            f"{abs(row.mean_s):.3f} s on average (95 % interval of first less second "
            f"{row.low_s:.3f} to {row.high_s:.3f} s); half of all lie at most "
            f"{row.median_absolute_s:.3f} s apart."
        )
    if frame.empty:
        yield "No sign of one annotator overlaps a sign of another."


def _refined(owner: Owner, title: str) -> Iterator[View]:
    path = owner.sources.tagged_file(owner.name, "annotator_refined")
    yield TableView(
        label="",
        title=title,
        caption="Mean absolute offset between two annotators' tags of the same sign, before and "
        "after refinement of both. Chance: the same with minima shifted in time: any rule that "
        "moves two tags to one place brings them nearer. p: as near by chance, one-sided.",
        frame=read_table(path, "annotator_refined"),
        columns={
            "first": ("annotator", ""), "second": ("and", ""), "hand": ("minima of", ""),
            "edge": ("edge", ""), "method": ("refined by", ""), "n": ("n", "d"),
            "before_s": ("before (s)", S3), "after_s": ("after (s)", S3),
            "nearer_s": ("nearer by (s)", S3), "chance": ("chance", S3),
            "chance_low": ("2.5 %", S3), "chance_high": ("97.5 %", S3), "p": ("p", S3),
            "note": ("note", ""),
        },
        file=path,
    )  # fmt: skip


def _offsets(owner: Owner, title: str) -> Iterator[View]:
    path = owner.sources.tagged_file(owner.name, "annotator_offsets")
    frame: pd.DataFrame = read_table(path, "annotator_offsets")
    yield TableView(
        label="",
        title=title,
        caption="First less second annotator, s: below 0 the first is earlier. Groups of three "
        "pairs of signs or more; 5 to 95 %: quantiles of the offset.",
        frame=frame,
        columns={
            "first": ("first", ""), "second": ("second", ""), "edge": ("edge", ""),
            "group": ("by", ""), "name": ("of", ""), "n": ("n", "d"), "mean_s": ("mean", S3),
            "low_s": ("low", S3), "high_s": ("high", S3), "sd_s": ("SD", S3),
            "q5_s": ("5 %", S3), "q25_s": ("25 %", S3), "q75_s": ("75 %", S3),
            "q95_s": ("95 %", S3), "lead": ("earlier", ""),
        },
        file=path,
        most=12,
    )  # fmt: skip


def _agreement(owner: Owner, title: str) -> Iterator[View]:
    path = owner.sources.tagged_file(owner.name, "annotator_agreement")
    yield TableView(
        label="",
        title=title,
        caption="Signs of one annotator against those of another (docs/scoring.md); gamma is 1 for "
        "the same signs, 0 for chance. Chance: the same lengths and gaps in another order within "
        "each recording.",
        frame=read_table(path, "annotator_agreement"),
        columns={"first": ("scored", ""), "second": ("against", ""), "measure": ("score of", ""),
                 "of": ("of which", ""), **CHANCE},
        file=path,
        most=12,
    )  # fmt: skip
