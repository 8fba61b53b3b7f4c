"""What the report shows of Naert et al. 2017: tables, figures and captions of one corpus."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path

import pandas as pd

from signkin.corpus import Corpus
from signkin.errors import listed
from signkin.exhibits import Exhibit, exhibits
from signkin.report.attempts import attempted
from signkin.report.exhibit_views import by_exhibit, exhibit_view
from signkin.report.page import FigureView, Section, TableView, View, figure_files
from signkin.settings import Settings
from signkin.studies.naert2017.durations_report import model_views, statistics_views
from signkin.studies.naert2017.settings import DurationSettings
from signkin.studies.naert2017.synthesis import report as synthesis_report
from signkin.tables import read_table

S3 = ".3f"


@dataclass(frozen=True)
class Shown:
    """Where the parts of these sections lie.

    results: results/naert2017. paper: papers/naert2017. corpora: those of this run.
    """

    results: Path
    paper: Path
    corpora: Mapping[str, Corpus]
    settings: Settings

    @cached_property
    def constants(self) -> Mapping[str, str]:
        """Numbers that the paper prints in its text, as strings."""
        frame = pd.read_csv(self.paper / "constants.csv", dtype=str, keep_default_na=False)
        return dict(zip(frame["name"], frame["value"], strict=True))

    @cached_property
    def listing(self) -> tuple[Exhibit, ...]:
        """What the paper shows."""
        return exhibits(self.paper)

    def file(self, corpus: str, name: str) -> Path:
        """Return a file of a corpus."""
        return self.results / corpus / name


@dataclass(frozen=True)
class Source:
    """One corpus of these sections; folder: results/naert2017/<corpus>."""

    corpus: Corpus
    folder: Path
    shown: Shown


CHAPTERS = {
    "overview": "The pipeline",
    "synthesis": "3.1 Making a transition: interpolation and blending",
    "speed": "4.1 Utterances and wrist speed",
    "refinement": "4.2 Tags moved to minima of speed",
    "durations": "5.1 Durations and distances of transitions",
    "models": "5.2 Models of duration",
    "truth": "5.2 Made against captured",
}
# Which chapter a figure or table of the paper belongs to; those not named are in `durations`.
_CHAPTER = {
    "fig01": "synthesis", "fig02": "synthesis", "fig03": "overview", "table1": "speed",
    "fig04": "speed", "fig05": "speed", "fig06": "refinement", "fig11": "models",
    "fig12": "truth", "fig13": "truth",
}  # fmt: skip


def sections(shown: Shown) -> Iterator[Section]:
    """Yield a section a chapter of the paper, with what every corpus has of it, in its order."""
    found: dict[str, list[View]] = {chapter: [] for chapter in CHAPTERS}
    for name, corpus in shown.corpora.items():
        source = Source(corpus, shown.file(name, ""), shown)
        badge = "simulated" if corpus.simulator else "real"
        parts = _views(source) if corpus.tagged else _untagged(source)
        for chapter, view in parts:
            found[chapter].append(replace(view, of=name, badge=badge))
    order = {exhibit.label: i for i, exhibit in enumerate(shown.listing)}
    for chapter, title in CHAPTERS.items():
        if found[chapter]:
            yield Section(chapter, title, exhibits=by_exhibit(found[chapter], order))


def _untagged(source: Source) -> Iterator[tuple[str, View]]:
    yield from synthesis_report.chapters(source.folder, source.corpus, source.shown.listing)


def _views(source: Source) -> Iterator[tuple[str, View]]:
    """Yield the exhibits in the paper's order with their chapter, each with what belongs to it."""
    captions = json.loads((source.folder / "captions.json").read_text(encoding="utf-8"))
    captions |= synthesis_report.captions(source.folder)
    for exhibit in source.shown.listing:
        chapter = _CHAPTER.get(exhibit.stem, "durations")
        if exhibit.stem in _TABLES:
            table = partial(_TABLES[exhibit.stem], source, exhibit)
            yield from ((chapter, view) for view in attempted(exhibit.title, table))
        elif exhibit.stem in captions:
            yield chapter, exhibit_view(exhibit, source.folder, captions[exhibit.stem])
        below = partial(_following, source, exhibit)
        yield from ((chapter, view) for view in attempted(f"Below {exhibit.title}", below))
    made = partial(synthesis_report.views, source.folder, source.corpus.unit)
    yield from (("truth", view) for view in attempted("Made against captured", made))
    if source.corpus.made_by_run:  # others have no known truth
        yield from _simulation(source)


def _following(source: Source, exhibit: Exhibit) -> Iterator[View]:
    """Yield what stands below a figure or table of the paper."""
    told = {"label": exhibit.label, "title": exhibit.title, "differs": exhibit.differs}
    simulated = source.corpus.simulator is not None
    chosen = DurationSettings.of(source.shown.settings)
    if exhibit.stem == "fig06":
        yield from refinement_views(source)
    if exhibit.stem == "fig10":
        yield from statistics_views(source.folder, chosen, simulated)
        yield from left_out_views(source)
        yield sign_types_view(source)
    if exhibit.stem == "fig11":
        constants = source.shown.constants
        yield from model_views(source.folder, chosen, constants, told, simulated)


def unused_glosses(source: Source) -> list[str]:
    """Return what is to be told of glosses of signs.csv that no recording has."""
    frame = read_table(source.folder / "lexicon.csv", "lexicon")
    unused = frame.loc[frame["occurrences"] == 0, "gloss"]
    if unused.empty:
        return []
    return [
        f"signs.csv has {len(unused)} glosses that occur in no recording: {listed(unused)}. "
        "Misspelt, or not needed."
    ]


def _table1(source: Source, exhibit: Exhibit) -> TableView:
    path = source.folder / "table1.csv"
    frame = read_table(path, "table1")
    translated = int((frame["translation"] != "").sum())
    told = f"{translated} with a translation" if translated else "the corpus has no translations"
    columns = {
        "recording": ("recording", ""),
        "utterance": ("utterance", ""),
        "start_s": ("start (s)", ".2f"),
        "end_s": ("end (s)", ".2f"),
        "signs": ("signs", "d"),
        "glosses": ("glosses", ""),
        "translation": ("translation", ""),
    }
    return TableView(
        label=exhibit.label,
        title=exhibit.title,
        caption=f"{len(frame)} utterances, {int(frame['signs'].sum())} signs; {told}.",
        frame=frame,
        columns=columns,
        file=path,
        differs=exhibit.differs,
        most=8,
    )


def _table2(source: Source, exhibit: Exhibit) -> TableView:
    path = source.folder / "table2.csv"
    frame = read_table(path, "table2")
    simulated = source.corpus.simulator is not None
    rows = frame[frame["published_n"] != ""]
    caption = (
        f"Durations in s between manual tags, n = {int(frame['n'].iloc[-1])}, by four-digit type "
        "(hands and symmetry of the sign before, then of the sign after); SD with divisor n - 1; "
        "in brackets without outliers. Right: the paper's Table 2"
    )
    columns = {
        "type": ("type", ""),
        "printed_n": ("number", ""),
        "printed_mean": ("mean (s)", ""),
        "printed_sd": ("SD (s)", ""),
        "published_n": ("paper: number", ""),
        "published_mean": ("paper: mean (s)", ""),
        "published_sd": ("paper: SD (s)", ""),
    }
    if simulated:
        columns["equal"] = ("equal in every digit", "")
        caption += f"; {int((rows['equal'] == 'yes').sum())} of {len(rows)} rows are equal."
    else:
        caption += ", another language and corpus: shown for comparison, not expected to agree."
    single = frame[frame["note"].str.startswith("one value")]
    if len(single):
        caption += " A single value has no SD; it is printed as 0, as in the paper."
    return TableView(
        label=exhibit.label,
        title=exhibit.title,
        caption=caption,
        frame=frame,
        columns=columns,
        file=path,
        differs=exhibit.differs,
        emphasis="equal" if simulated else "",
        most=40,
    )


_TABLES: dict[str, Callable[[Source, Exhibit], TableView]] = {"table1": _table1, "table2": _table2}


def refinement_views(source: Source) -> Iterator[View]:
    """Yield what tells how the tags of a corpus lie to the minima of wrist speed."""
    path = source.folder / "refinement.csv"
    settings = source.shown.settings.refinement
    columns = {
        "hand": ("hand", ""),
        "measure": ("measure", ""),
        "value": ("manual tags", S3),
        "low": ("low", S3),
        "high": ("high", S3),
        "unit": ("unit", ""),
        "chance": ("random tags", S3),
        "chance_low": ("2.5 %", S3),
        "chance_high": ("97.5 %", S3),
        "n": ("n", "d"),
        "note": ("note", ""),
    }
    yield TableView(
        label="",
        title="How the tags lie to the speed minima",
        caption=f"Window {settings.search_window_s:g} s. Chance: {settings.draws} sets of as many "
        "tags, placed at random over the annotated frames of each recording; mean and 95 % of "
        "the sets. Low, high: 95 % interval of the value, tags taken as independent.",
        frame=read_table(path, "refinement"),
        columns=columns,
        file=path,
    )
    yield _tag_chance(source)
    base = source.folder / "fig_refinement"
    yield FigureView(
        label="",
        title="Tags and speed minima against chance",
        caption="Share of manual tags (coloured) with a speed minimum of the hand at most so far "
        "away, against random tags (grey band: 95 % of the sets). Where the coloured line runs in "
        "the band, tags are no nearer to minima than chance has it; below the band, farther.",
        svg=base.with_suffix(".svg"),
        files=figure_files(base, ".svg", ".pdf"),
    )


def _tag_chance(source: Source) -> TableView:
    path = source.folder / "tag_chance.csv"
    frame = read_table(path, "tag_chance")
    window = source.shown.settings.refinement.search_window_s
    told = frame["window_s"].isna() | ((frame["window_s"] - window).abs() < 1e-9)
    return TableView(
        label="",
        title="Tags against nulls that keep their structure",
        caption=f"Within stretches of signing, {source.shown.settings.refinement.draws} draws of "
        "each null: all tags shifted in a circle, signs and gaps permuted, tags anywhere; and what "
        f"minima without any order would give (Poisson). The share is that within {window:g} s, "
        "the mean share that over windows from 0.02 to 0.2 s (every window is in the file). p: as "
        "near or nearer by chance, one-sided; by Holm for both hands, both sets of tags and three "
        "nulls. Transition: without the first and last tag of a stretch. The median change is that "
        "of the times between signs (s) where each tag goes to its nearest minimum in the window: "
        "tags by chance move, too.",
        frame=frame[told],
        columns={
            "hand": ("hand", ""),
            "tags": ("tags", ""),
            "null": ("null", ""),
            "measure": ("measure", ""),
            "value": ("manual tags", S3),
            "chance": ("chance", S3),
            "chance_low": ("2.5 %", S3),
            "chance_high": ("97.5 %", S3),
            "p": ("p", S3),
            "p_holm": ("p (Holm)", S3),
            "n": ("n", "d"),
            "note": ("note", ""),
        },
        file=path,
        most=12,
    )


def left_out_views(source: Source) -> Iterator[TableView]:
    """Yield the table of transitions of zero length and overlapping signs, where there are any."""
    path = source.folder / "transitions_left_out.csv"
    frame = read_table(path, "transitions")
    if frame.empty:
        return
    counts = frame["status"].value_counts()
    told = [
        f"{counts.get('zero_length', 0)} of zero length (one sign ends where the next starts; "
        "counted in all tables)",
        f"{counts.get('overlap', 0)} overlapping (the next sign starts before the last one ends; "
        "in no statistic, negative durations)",
    ]
    yield TableView(
        label="",
        title="Transitions of zero length, and overlapping signs",
        caption="; ".join(told) + ".",
        frame=frame,
        columns={
            "recording": ("recording", ""),
            "transition": ("transition", "d"),
            "previous_gloss": ("sign before", ""),
            "next_gloss": ("sign after", ""),
            "start_s": ("from (s)", S3),
            "end_s": ("to (s)", S3),
            "duration_s": ("duration (s)", S3),
            "status": ("status", ""),
        },
        file=path,
        most=6,
    )


def sign_types_view(source: Source) -> TableView:
    """Return the table of types of signs, by the lexicon and by motion."""
    path = source.folder / "sign_types.csv"
    frame = read_table(path, "sign_types")
    known = frame[frame["lexicon"] != ""]
    table = pd.crosstab(frame["lexicon"].replace("", "not in signs.csv"), frame["kinematic"])
    agree = int((known["lexicon"] == known["kinematic"]).sum())
    told = (
        f"Of {len(known)} signs with a type in signs.csv, motion alone gives the same type to "
        f"{agree} ({agree / len(known):.0%}). "
        if len(known)
        else "No gloss stands in signs.csv. "
    )
    columns: dict[str, tuple[str, str]] = {"lexicon": ("lexicon \\ from motion", "")}
    columns |= {str(kind): (str(kind) or "none", "d") for kind in table.columns}
    return TableView(
        label="",
        title="Sign types: lexicon and motion",
        caption=told + "The lexicon goes first; types from motion are marked kinematic in "
        "transitions.csv. Two digits: hands (0 one, 1 two, 2 one with the other keeping the "
        "context), symmetry.",
        frame=table.reset_index(),
        columns=columns,
        file=path,
    )


def _simulation(source: Source) -> Iterator[tuple[str, View]]:
    error_path = source.folder / "truth_error.csv"
    yield (
        "refinement",
        TableView(
            label="",
            title="Error of the tags to the true boundaries",
            caption="Mean absolute error before and after refinement, with 95 % bootstrap "
            "intervals.",
            frame=read_table(error_path, "truth_error"),
            columns={
                "hand": ("hand", ""),
                "segmentation": ("tags", ""),
                "n": ("n", "d"),
                "mean_error_s": ("mean error (s)", ".4f"),
                "low_s": ("2.5 %", ".4f"),
                "high_s": ("97.5 %", ".4f"),
                "median_error_s": ("median (s)", ".4f"),
                "within_20ms": ("within 0.02 s", ".0%"),
            },
            file=error_path,
        ),
    )
    path = source.folder / "surface.csv"
    frame = read_table(path, "surface")
    unit = source.shown.settings.transitions.euclidean_unit_m
    yield (
        "models",
        TableView(
            label="",
            title="The duration surface found again (eq. 4)",
            caption=f"Least squares on {int(frame['n'].iloc[0])} manual transitions, Euclidean "
            f"distance in units of {unit:g} m; mean error {frame['mean_error_s'].iloc[0]:.5f} s "
            f"(the paper: {source.shown.constants['mean_error']} s). Designed: the same fit on the "
            "distances that the simulation was made to have between the true boundaries; the tags "
            "stand off these, which shifts the fit.",
            frame=frame,
            columns={
                "coefficient": ("coefficient", ""),
                "published": ("printed", ""),
                "designed": ("designed", ".6f"),
                "fitted": ("fitted", ".6f"),
                "low": ("95 % low", ".4f"),
                "high": ("95 % high", ".4f"),
                "shift_percent": ("shift (%)", "+.1f"),
            },
            file=path,
        ),
    )
    base = source.folder / "fig_simulation"
    yield (
        "models",
        FigureView(
            label="",
            title="Truth found again",
            caption="Left: share of tags over their error to the true boundary, before (dashed) "
            "and after refinement. Right: coefficients of the surface over the printed ones.",
            svg=base.with_suffix(".svg"),
            files=figure_files(base, ".svg", ".pdf"),
        ),
    )
