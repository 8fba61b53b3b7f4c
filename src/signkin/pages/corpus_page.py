"""The page of a corpus, made for its owner: durations, tags, what to look at, what is lacking."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

import signkin
from signkin import tables
from signkin.pages.corpora import design, origin
from signkin.pages.corpus_durations import counted, durations_of
from signkin.pages.corpus_elan import MOST_FILES, Looked, write_check_files
from signkin.pages.corpus_list import overview_of, todo_of
from signkin.pages.corpus_segments import agreement_section, boundaries_section
from signkin.pages.corpus_tags import against_chance, tags_of, worst_tags
from signkin.pages.corpus_views import (
    duration_views,
    recordings_views,
    speed_view,
    tag_views,
    todo_view,
)
from signkin.pages.sources import Sources
from signkin.pages.unavailable import unavailable_lines
from signkin.pages.warnings import counted as counted_words
from signkin.pages.warnings import groups
from signkin.ratings import Rating, tag_ratings
from signkin.report.attempts import CANNOT
from signkin.report.page import Page, Section
from signkin.studies.naert2017.report import left_out_views, refinement_views, sign_types_view
from signkin.tables import read_table, write_table
from signkin.unavailable import rows_of


@dataclass(frozen=True)
class Owner:
    """What the owner's page of a corpus is made of."""

    sources: Sources
    name: str

    @property
    def tagged(self) -> bool:
        """Whether the corpus has tags of signs."""
        return self.sources.corpora[self.name].tagged

    @cached_property
    def about(self) -> pd.DataFrame:
        """The table `recordings`."""
        return self.sources.table(self.name, "recordings")

    @cached_property
    def transitions(self) -> pd.DataFrame | None:
        """The table `transitions`; None without tags."""
        return self.sources.tagged_table(self.name, "transitions") if self.tagged else None

    @cached_property
    def durations(self) -> pd.DataFrame | None:
        """Durations by group; None without tags."""
        if self.transitions is None:
            return None
        return durations_of(self.name, self.transitions, self.sources.settings.seed)

    @cached_property
    def boundaries(self) -> pd.DataFrame | None:
        """The table `boundaries`; None without tags."""
        return self.sources.tagged_table(self.name, "boundaries") if self.tagged else None

    @cached_property
    def tags(self) -> pd.DataFrame | None:
        """How good the tags are, by group; None without tags."""
        if self.boundaries is None:
            return None
        return tags_of(self.name, self.boundaries, self.window_s)

    @property
    def window_s(self) -> float:
        """How far from a tag a minimum counts as near."""
        return self.sources.settings.refinement.search_window_s

    @cached_property
    def overview(self) -> pd.DataFrame:
        """A row a recording."""
        gaps = self.sources.table(self.name, "gaps")
        plausibility = self.sources.table(self.name, "plausibility")
        return overview_of(self.about, gaps, plausibility, self.durations, self.tags)

    @cached_property
    def ratings(self) -> dict[str, list[Rating]]:
        """Recording -> ratings of it and of its tags, as this run read them."""
        corpus = self.sources.corpora[self.name]
        out = {name: list(own) for name, own in tag_ratings(corpus.folder).items()}
        for entry in corpus.entries:
            if entry.rating or entry.rating_note:
                rating = Rating(entry.recording, entry.rating, entry.rating_note)
                out.setdefault(entry.recording, []).append(rating)
        return out

    def rating(self, row: Any) -> Rating | None:
        """Return the rating of a row of a table: of its tag, or of its recording."""
        tag = getattr(row, "what", "recording") == "tag"
        for one in self.ratings.get(row.recording, ()):
            if one.of_tag == tag and (not tag or one.matches(row.start_s, row.gloss)):
                return one
        return None

    @cached_property
    def todo(self) -> pd.DataFrame:
        """What to look at; what is rated ok goes last."""
        worst = outliers = None
        if self.boundaries is not None:
            worst = worst_tags(self.boundaries, self.sources.table(self.name, "intervals"))
            outliers = read_table(self.sources.tagged_file(self.name, "fig07"), "distances")
        found = todo_of(
            self.overview, self.sources.table(self.name, "excluded"),
            self.sources.table(self.name, "plausibility"), worst, self.transitions, outliers,
            self.window_s,
        )  # fmt: skip
        ok = [
            (r := self.rating(row)) is not None and r.rating == "ok" for row in found.itertuples()
        ]
        found.loc[ok, "rank"] = 4
        return found.sort_values("rank", kind="stable", ignore_index=True)

    def looked(self) -> dict[str, Looked]:
        """Return recording -> what a file with a tier `check` is made of."""
        corpus = self.sources.corpora[self.name]
        copies = self.sources.naert.file(self.name, "eaf")
        elan = corpus.tagged and corpus.settings["annotation"]["format"] == "eaf"
        out = {e.recording: Looked(1.0, e.motion, None) for e in corpus.entries}
        for row in self.about.itertuples():
            copy = copies / f"{row.recording}.eaf"
            offset = float(row.clock_offset_s) if elan else 0.0
            out[str(row.recording)] = Looked(
                float(row.duration_s),
                str(row.motion_file),
                copy if copy.is_file() else None,
                offset,
            )
        return out

    def write_elan(self, folder: Path) -> dict[str, Path]:
        """Write an ELAN file with a tier `check` for what is in the list; recording -> file."""
        try:
            return write_check_files(self.todo, self.looked(), folder / f"{self.name}_check")
        except CANNOT as error:
            traceback.print_exception(error)  # in the log of the job
            return {}

    def write(self, folder: Path) -> dict[str, Path]:
        """Write the tables of the page into a folder; returns what -> file."""
        files = {}
        for what, kind in (
            ("recordings", "corpus_overview"), ("todo", "corpus_todo"),
            ("durations", "corpus_durations"), ("tags", "corpus_tags"),
        ):  # fmt: skip
            try:
                frame = getattr(self, {"recordings": "overview"}.get(what, what))
            except CANNOT:  # what it is made of is not available
                frame = tables.empty(kind)
            if frame is not None:
                files[what] = folder / f"{self.name}_{what}.csv"
                write_table(frame[tables.TABLES[kind].names()], files[what], kind)
        return files


def corpus_page(
    owner: Owner, files: dict[str, Path], elan: dict[str, Path], site: list[tuple[str, Path]]
) -> Page:
    """Return the page; files, elan: what `Owner.write`, `write_elan` wrote. site: other pages."""
    name = owner.name
    corpus = owner.sources.corpora[name]
    sections = [
        _attempted("short", "In short", _short, owner),
        _attempted("todo", "To work through", _todo, owner, files, elan),
        _attempted("recordings", "Recordings", _recordings, owner, files),
    ]
    if owner.tagged:
        sections += [
            _attempted("durations", "Durations of transitions", _durations, owner, files),
            _attempted("tags", "Quality of the tags", _tags, owner, files),
            _attempted("boundaries", "Where signs start and end", boundaries_section, owner),
        ]
        if corpus.annotators:
            sections.append(
                _attempted("annotators", "Agreement of annotators", agreement_section, owner)
            )
    else:
        sections.append(Section("speed", "Wrist speed", exhibits=(speed_view(owner),)))
    sections.append(Section("lacking", "What is not available, and why", text=_lacking(owner)))
    sections.append(_files(owner))
    return Page(
        title=f"{name}: {corpus.settings['title']}",
        lead=(origin(corpus),),
        sections=sections,
        version=signkin.__version__,
        site=site,
        here=name,
        docs=owner.sources.docs,
        ratings=name,
    )


def _attempted(anchor: str, title: str, make: Callable[..., Section], *given: Any) -> Section:
    """Return a section, or one that points to what is not available where it cannot be made."""
    try:
        return make(*given)
    except CANNOT as error:
        traceback.print_exception(error)  # in the log of the job
        return Section(anchor, title, text=("Not available; see below what lacks, and why.",))


def _short(owner: Owner) -> Section:
    corpus = owner.sources.corpora[owner.name]
    about = owner.about
    minutes = float(about["duration_s"].sum()) / 60
    text = [
        f"{_counted(len(about), 'recording')} of {_counted(about['signer'].nunique(), 'signer')}, "
        f"{minutes:.1f} minutes at {_range(about['rate_hz'])} Hz."
    ]
    if corpus.single_signs:
        text.append(design(about))
    if owner.durations is not None and len(owner.durations):
        whole = owner.durations.iloc[0]
        signers = owner.durations[owner.durations["group"] == "signer"]
        told = (
            f"A transition lasts {whole['mean_s']:.3f} s on average (95 % interval "
            f"{whole['low_s']:.3f} to {whole['high_s']:.3f} s; {int(whole['n'])} transitions, "
            f"nine of ten between {whole['p5_s']:.2f} and {whole['p95_s']:.2f} s)"
        )
        if len(signers) > 1:
            told += (
                f"; by signer the means go from {signers['mean_s'].min():.3f} to "
                f"{signers['mean_s'].max():.3f} s"
            )
        text.append(told + ".")
    elif owner.tagged:
        text.append("There is no transition between two signs of one utterance.")
    if owner.tags is not None:
        chance = owner.sources.tagged_table(owner.name, "tag_chance")
        text += against_chance(chance, owner.window_s, owner.sources.settings.durations.alpha)
    many = int((owner.todo["rank"] < 4).sum())
    grave = int((owner.todo["rank"] == 1).sum())
    text.append(
        f"{counted_words(many, 'thing', 'things')} to look at; "
        + ("none makes results wrong." if not grave
           else "each may make results wrong." if grave == many > 1
           else "it may make results wrong." if many == 1
           else f"because of {grave} of them results may be wrong.")
        if many else "Nothing in it looks odd."
    )  # fmt: skip
    return Section(
        "short", "In short", text=text, badge=owner.sources.badge(owner.name),
        groups=groups(owner.sources, owner.name),
    )  # fmt: skip


def _counted(n: int, one: str) -> str:
    return counted_words(n, one, one + "s")


def _range(values: pd.Series) -> str:
    low, high = values.min(), values.max()
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"


def _recordings(owner: Owner, files: dict[str, Path]) -> Section:
    text = (
        "A row a recording. Choose one here, or a point in a plot, and it is marked in all tables "
        "and plots of this page.",
    )
    views = tuple(recordings_views(owner, files["recordings"]))
    return Section("recordings", "Recordings", text=text, exhibits=views)


def _todo(owner: Owner, files: dict[str, Path], elan: dict[str, Path]) -> Section:
    text = [
        "The gravest first. Rate each row when you have looked (ok, check, exclude, with a note), "
        "and save the ratings above: a recording or tag that is rated exclude is left out of the "
        "next run, and listed there.",
    ]
    if owner.todo.empty:
        return Section("todo", "To work through", text=("Nothing looks odd.",))
    if elan:
        more = "; the gravest have one" if len(elan) == MOST_FILES else ""
        text.append(
            "ELAN: the recording's file with a tier “check”, an annotation for each row of this "
            f"list ({_counted(len(elan), 'file')} in all{more})."
        )
    view = todo_view(owner, files["todo"], elan)
    return Section("todo", "To work through", text=text, exhibits=(view,))


def _durations(owner: Owner, files: dict[str, Path]) -> Section:
    source = owner.sources.naert_source(owner.name)
    assert owner.transitions is not None
    if counted(owner.transitions).empty:
        text = ("No two signs follow one another in an utterance: there are no transitions.",)
        return Section("durations", "Durations of transitions", text=text)
    views = [*duration_views(owner, files["durations"]), sign_types_view(source)]
    views += left_out_views(source)
    return Section("durations", "Durations of transitions", exhibits=views)


def _tags(owner: Owner, files: dict[str, Path]) -> Section:
    quality, nulls, curve = refinement_views(owner.sources.naert_source(owner.name))
    views = [curve, *tag_views(owner, files["tags"]), nulls, quality]
    text = (
        "An annotator marks the start and end of a sign where the hand rests or turns: there its "
        "speed has a minimum. How near tags lie to minima, compared with tags put there by chance, "
        "tells how exactly they were set. A hand that does not make the sign need not slow down.",
    )
    return Section("tags", "Quality of the tags", text=text, exhibits=views)


def _lacking(owner: Owner) -> list[str]:
    corpus = owner.sources.corpora[owner.name]
    motion = corpus.settings["motion"]
    out = []
    if not corpus.tagged:
        out.append(
            "No tags of signs: durations of transitions, tag quality and refined tags need them. "
            "corpus.yaml would name them under `annotation`."
        )
    if not corpus.single_signs:
        out.append(
            "Not one sign a recording: the analyses of single signs (ground truth, orders) are "
            "not made; wrists are cut as long series instead (page One wrist)."
        )
    if corpus.tagged and not corpus.tiers.get("translation"):
        out.append("No tier of translations is named, so utterances have none.")
    if corpus.tagged and not corpus.tiers.get("utterance"):
        out.append("No tier of utterances is named: a recording counts as one utterance.")
    if motion.get("orientations", "none") == "none":
        out.append(
            "No orientations of limbs: geodesic distances, and the surface of duration over both "
            "distances, are not available."
        )
    if corpus.unit == "px":
        out.append("Positions are in pixels: speeds and distances cannot be told in metres.")
    if corpus.tagged and not corpus.signs:
        out.append("No signs.csv: the types of all signs come from their motion.")
    pages = owner.sources.home / "recordings" / owner.name
    if not pages.is_dir():
        out.append("No page of each recording was made in this run, so rows have no excerpt.")
    rows = rows_of(owner.sources.results / owner.name / "not_available")
    out += unavailable_lines(rows)
    return out or ["All analyses could be made."]


def _files(owner: Owner) -> Section:
    shared = [
        (f"{table}.csv", owner.sources.shared(owner.name, table))
        for table in ("recordings", "intervals", "minima", "gaps", "plausibility", "excluded")
    ]
    own = []
    if owner.tagged:
        names = ("transitions", "boundaries", "boundary_posteriors", "sign_types", "lexicon")
        own = [(f"{name}.csv", owner.sources.tagged_file(owner.name, name)) for name in names]
        folder = owner.sources.naert.file(owner.name, "eaf")
        files = sorted(folder.glob("*.eaf"))
        own += [(f"ELAN: {file.name}", file) for file in files[:20]]
        if len(files) > 20:
            own.append((f"all {len(files)} ELAN files", folder))
    listing = owner.sources.home / "recordings" / f"{owner.name}.html"
    if listing.is_file():
        shared.insert(0, ("The pages of single recordings", listing))
    text = (
        "All tables of the corpus, to go on with. ELAN files have the refined tags in tiers of "
        "their own."
        if owner.tagged
        else "All tables of the corpus, to go on with.",
    )
    return Section("files", "Files", text=text, links=[*shared, *own])
