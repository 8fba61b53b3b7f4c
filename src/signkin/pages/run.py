"""Gathers what the report shows: tables, figures and captions of every corpus."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

import signkin
from signkin.corpus import Corpus
from signkin.errors import listed
from signkin.exhibits import exhibits, of_groups
from signkin.pages.audit import audit_section
from signkin.pages.corpora import design, first_rows, origin, sign_columns, titled
from signkin.pages.speeds import SPEED_PANELS
from signkin.pages.unavailable import unavailable_notices, unavailable_section
from signkin.report.exhibit_views import exhibit_view
from signkin.report.page import FigureView, Page, Section, TableView, figure_files
from signkin.settings import Settings
from signkin.studies.endres2013 import report as endres_report
from signkin.studies.naert2017 import report as naert_report
from signkin.studies.naert2017.report import Shown
from signkin.studies.one_wrist import report as one_wrist_report
from signkin.tables import read_table

S3 = ".3f"


@dataclass(frozen=True)
class Sources:
    """Where a report's parts lie.

    results: the results folder. corpora: those of this run. missing: corpus -> reason.
    paper, endres: the folders papers/naert2017 and papers/endres2013. settings: config.yaml.
    """

    results: Path
    corpora: Mapping[str, Corpus]
    missing: Mapping[str, str]
    paper: Path
    endres: Path
    settings: Settings

    @property
    def published_n(self) -> int:
        """Number of transitions in the paper's Table 2."""
        frame = pd.read_csv(self.paper / "table2.csv", dtype=str, keep_default_na=False)
        return int(frame["n"].astype(int).sum())

    def shared(self, corpus: str, table: str) -> Path:
        """Return the file of a table that both studies share."""
        return self.results / corpus / f"{table}.csv"

    @property
    def naert(self) -> Shown:
        """Where the parts of Naert et al. 2017 lie."""
        return Shown(self.results / "naert2017", self.paper, self.corpora, self.settings)


def make_page(sources: Sources) -> Page:
    """Return the report of a run."""
    sections = [_summary(sources), *_overview(sources), audit_section(sources.results)]
    sections += naert_report.sections(sources.naert)
    sections += endres_report.sections(
        sources.results, sources.endres, sources.corpora, sources.settings.binning.hit_window_s
    )
    sections += one_wrist_report.sections(sources.results, sources.corpora)
    sections.append(_data_section(sources))
    sections += unavailable_section(sources.results, sources.corpora)
    sections.append(_choices(sources))
    return Page(
        title="Sign-language motion: transitions between signs, and motor primitives in them",
        lead=(
            "The tables and figures of Naert, Larboulette & Gibet 2017 and of Endres, Meirovitch, "
            "Flash & Giese 2013, from the corpora of this run. The papers' own recordings are not "
            "public: their printed numbers stand beside ours, and no corpus here is theirs.",
        ),
        sections=sections,
        version=signkin.__version__,
        missing=sources.missing,
    )


# --- summary ---------------------------------------------------------------------------------


def _summary(sources: Sources) -> Section:
    rows = [_summary_row(sources, name, corpus) for name, corpus in sources.corpora.items()]
    columns = {
        "corpus": ("corpus", ""),
        "evidence": ("evidence", ""),
        "language": ("language", ""),
        "recordings": ("recordings", "d"),
        "signers": ("signers", "d"),
        "minutes": ("minutes", ".1f"),
        "signs": ("signs", "d"),
        "transitions": ("transitions", "d"),
        "mean_s": ("mean duration (s)", S3),
        "sd_s": ("SD (s)", S3),
    }
    view = TableView(
        label="",
        title="Corpora of this run",
        caption="Transitions between manual tags, overlapping signs left out, zero-length ones "
        "kept; SD with divisor n - 1. The paper (Sign3D, LSF): "
        f"{sources.published_n} transitions, mean {sources.naert.constants['mean_duration']} s, SD "
        f"{sources.naert.constants['sd_duration']} s.",
        frame=pd.DataFrame(rows, columns=list(columns)),
        columns=columns,
    )
    notices = [f"{name} is not in this run: {why}." for name, why in sources.missing.items()]
    for name in sources.corpora:
        excluded = read_table(sources.shared(name, "excluded"), "excluded")
        notices += [
            f"{name}: recording {row.recording} is left out. {row.reason}"
            for row in excluded.itertuples()
        ]
        notices += _read_with_notes(sources, name)
        notices += _implausible(sources, name)
    notices += unavailable_notices(sources.results, sources.corpora)
    return Section("summary", "Corpora", exhibits=(view,), notices=notices)


def _read_with_notes(sources: Sources, name: str) -> list[str]:
    """Return what was decided in reading, each kind once with the recordings it was decided in."""
    about = read_table(sources.shared(name, "recordings"), "recordings")
    where: dict[str, list[str]] = {}
    for recording, notes in zip(about["recording"], about["notes"].fillna(""), strict=True):
        for note in str(notes).split(" | ") if notes else ():
            where.setdefault(note, []).append(str(recording))
    return [f"{name}: {note} ({listed(there, 5)})." for note, there in where.items()]


def _summary_row(sources: Sources, name: str, corpus: Corpus) -> dict[str, object]:
    about = read_table(sources.shared(name, "recordings"), "recordings")
    row: dict[str, object] = {
        "corpus": name,
        "evidence": "simulated" if corpus.simulator else "real",
        "language": corpus.settings["language"],
        "recordings": len(about),
        "signers": about["signer"].nunique(),
        "minutes": float(about["duration_s"].sum()) / 60,
    }
    if not corpus.tagged:
        signs = len(about) if corpus.single_signs else None
        return {**row, "signs": signs, "transitions": None, "mean_s": None, "sd_s": None}
    table2 = read_table(sources.naert.file(name, "table2.csv"), "table2").set_index("type")
    row["signs"] = int(about["signs"].sum())
    if "all" not in table2.index:  # transitions are not available
        return {**row, "transitions": None, "mean_s": None, "sd_s": None}
    everything = table2.loc["all"]
    return {
        **row,
        "transitions": int(everything["n"]),
        "mean_s": float(everything["mean_s"]),
        "sd_s": float(everything["sd_s"]),
    }


def _implausible(sources: Sources, name: str) -> Iterator[str]:
    findings = read_table(sources.shared(name, "plausibility"), "plausibility")
    bad = findings[findings["verdict"] == "implausible"]
    for check, rows in bad.groupby("check", sort=True):
        worst = rows.iloc[0]
        yield (
            f"{name}: {check} is implausible in {len(rows)} of "
            f"{findings['recording'].nunique()} recordings (e.g. {worst['recording']}: "
            f"{worst['value']:.3g} {worst['unit']}, plausible {worst['low']:g} to "
            f"{worst['high']:g}): {worst['note']}."
        )


def _overview(sources: Sources) -> Iterator[Section]:
    caption = (
        "The rules of this run from raw motion to the report, each after those whose output it "
        "takes; the number in brackets is the paper's section."
    )
    for exhibit in of_groups(exhibits(sources.paper), "overview"):
        view = exhibit_view(exhibit, sources.results / "naert2017", caption)
        yield Section("overview", "The pipeline", exhibits=(view,))


# --- data and choices ------------------------------------------------------------------------


def _data_section(sources: Sources) -> Section:
    frames = {
        name: read_table(sources.shared(name, "recordings"), "recordings")
        for name in sources.corpora
    }
    views: list[TableView | FigureView] = []
    for name, frame in frames.items():
        views.append(_recordings(sources, name, frame))
        if not sources.corpora[name].tagged:
            views.append(_speeds(sources, name, len(frame)))
    text = (
        "What was read, with its gaps, and whether rate and unit are possible for a human body.",
    )
    return Section("data", "Data and quality", text=text, exhibits=views)


def _recordings(sources: Sources, name: str, frame: pd.DataFrame) -> TableView:
    shown, told = first_rows(frame)
    return TableView(
        label="",
        title=titled("Recordings", sources.corpora[name]),
        caption=_about(sources, name, frame) + told,
        frame=shown,
        columns={
            "recording": ("recording", ""),
            "signer": ("signer", ""),
            **sign_columns(sources.corpora[name]),
            "frames": ("frames", "d"),
            "rate_hz": ("rate (Hz)", "g"),
            "duration_s": ("length (s)", ".2f"),
            "unit": ("unit", ""),
            "joints": ("joints", "d"),
            "orientations": ("orientations", ""),
        },
        file=sources.shared(name, "recordings"),
        most=6,
    )


def _speeds(sources: Sources, name: str, recordings: int) -> FigureView:
    base = sources.results / name / "fig_speed"
    lowpass = sources.settings.kinematics.lowpass
    shown = min(recordings, SPEED_PANELS)
    return FigureView(
        label="",
        title=titled("Wrist speed", sources.corpora[name]),
        caption="Speed of the right (blue) and left (red) wrist with their local minima (dots) in "
        f"{shown} of {recordings} recordings, spread over the list; low-pass: {lowpass.method}, "
        f"half gain at {lowpass.cutoff_hz:g} Hz. The corpus has no tags, so there is nothing to "
        "refine.",
        svg=base.with_suffix(".svg"),
        files=figure_files(base, ".svg", ".pdf"),
    )


def _about(sources: Sources, name: str, frame: pd.DataFrame) -> str:
    gaps = read_table(sources.shared(name, "gaps"), "gaps")
    findings = read_table(sources.shared(name, "plausibility"), "plausibility")
    verdicts = findings["verdict"].value_counts()
    many = "recordings" if len(frame) > 1 else "recording"
    parts = [] if sources.corpora[name].tagged else [origin(sources.corpora[name])]
    parts.append(f"{len(frame)} {many}, {int(frame['frames'].sum())} frames.")
    if sources.corpora[name].single_signs:
        parts.append(design(frame))
    if gaps.empty:
        parts.append("No gaps.")
    else:
        worst = gaps.loc[gaps["longest_gap_s"].idxmax()]
        parts.append(
            f"Gaps at {gaps['joint'].nunique()} joints: {int(gaps['missing_frames'].sum())} "
            f"missing positions, {int(gaps['filled_frames'].sum())} of them filled (gaps up to "
            f"{sources.settings.kinematics.longest_gap_s:g} s); the longest gap lasts "
            f"{worst['longest_gap_s']:.2f} s ({worst['joint']}, {worst['recording']})."
        )
    told = ", ".join(
        f"{int(verdicts.get(v, 0))} {v}" for v in ("plausible", "implausible", "not testable")
    )
    parts.append(f"Plausibility checks of lengths and speeds: {told}.")
    return " ".join(parts)


def _choices(sources: Sources) -> Section:
    rows = list(_flat(sources.settings.model_dump()))
    view = TableView(
        label="",
        title="config.yaml",
        caption="What the papers leave open, as this run decided it; config.yaml tells units and "
        "sections, docs/interpretations.md why, and how much the results move.",
        frame=pd.DataFrame(rows, columns=["key", "value"]),
        columns={"key": ("key", ""), "value": ("value", "")},
        most=60,
    )
    return Section("choices", "Choices of this run", exhibits=(view,))


def _flat(config: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, str]]:
    for key, value in config.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", "null" if value is None else str(value)
