"""Gathers what the report shows: tables, figures and captions of every corpus."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

import signkin
from signkin.corpus import Corpus
from signkin.errors import listed
from signkin.pages.audit import audit_section
from signkin.pages.corpora import design, first_rows, origin, sign_columns, titled
from signkin.report.page import FigureView, Page, Section, TableView
from signkin.studies.endres2013 import report as endres_report
from signkin.studies.naert2017.durations_report import duration_views
from signkin.studies.naert2017.synthesis import report as synthesis_report
from signkin.tables import read_table

S3 = ".3f"
SPEED_PANELS = 4  # recordings drawn of a corpus without tags


@dataclass(frozen=True)
class Sources:
    """Where a report's parts lie.

    results: the results folder. corpora: those of this run. missing: corpus -> reason.
    paper, endres: the folders papers/naert2017 and papers/endres2013. config: config.yaml.
    """

    results: Path
    corpora: Mapping[str, Corpus]
    missing: Mapping[str, str]
    paper: Path
    endres: Path
    config: Mapping[str, Any]

    @property
    def constants(self) -> Mapping[str, str]:
        """Numbers that the paper prints in its text, as strings."""
        frame = pd.read_csv(self.paper / "constants.csv", dtype=str, keep_default_na=False)
        return dict(zip(frame["name"], frame["value"], strict=True))

    @property
    def published_n(self) -> int:
        """Number of transitions in the paper's Table 2."""
        frame = pd.read_csv(self.paper / "table2.csv", dtype=str, keep_default_na=False)
        return int(frame["n"].astype(int).sum())

    def shared(self, corpus: str, table: str) -> Path:
        """Return the file of a table that both studies share."""
        return self.results / corpus / f"{table}.csv"

    def naert(self, corpus: str, name: str) -> Path:
        """Return a file of Naert et al. 2017 for a corpus."""
        return self.results / "naert2017" / corpus / name


def make_page(sources: Sources) -> Page:
    """Return the report of a run."""
    text = (sources.paper / "exhibits.yaml").read_text(encoding="utf-8")
    exhibits = yaml.safe_load(text)["exhibits"]
    labels = {exhibit["id"]: exhibit for exhibit in exhibits}
    sections = [_summary(sources), _overview(sources, labels), audit_section(sources.results)]
    for name, corpus in sources.corpora.items():
        if corpus.tagged:
            sections.append(_corpus_section(sources, name, labels))
        elif part := synthesis_report.section(name, corpus, sources.naert(name, ""), labels):
            sections.append(part)
    sections += endres_report.sections(
        sources.results, sources.endres, sources.corpora, sources.config
    )
    sections.append(_data_section(sources))
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
        f"{sources.published_n} transitions, mean {sources.constants['mean_duration']} s, SD "
        f"{sources.constants['sd_duration']} s.",
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
    table2 = read_table(sources.naert(name, "table2.csv"), "table2").set_index("type")
    everything = table2.loc["all"]
    return {
        **row,
        "signs": int(about["signs"].sum()),
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


def _overview(sources: Sources, labels: Mapping[str, Any]) -> Section:
    base = sources.results / "naert2017" / "fig03"
    view = FigureView(
        label=labels["fig03"]["label"],
        title=labels["fig03"]["title"],
        caption="The rules of this run from raw motion to the report, each after those whose "
        "output it takes; the number in brackets is the paper's section.",
        svg=base.with_suffix(".svg"),
        files=_files(base),
        differs=labels["fig03"]["differs"],
    )
    return Section("overview", "The pipeline", exhibits=(view,))


def _files(base: Path) -> tuple[Path, ...]:
    return tuple(base.with_suffix(s) for s in (".svg", ".pdf", ".csv"))


# --- one corpus ------------------------------------------------------------------------------


def _corpus_section(sources: Sources, name: str, labels: Mapping[str, Any]) -> Section:
    corpus = sources.corpora[name]
    captions = json.loads(sources.naert(name, "captions.json").read_text(encoding="utf-8"))
    captions |= synthesis_report.captions(sources.naert(name, ""))
    views: list[TableView | FigureView] = []
    for identity, exhibit in labels.items():
        if identity == "table1":
            views.append(_table1(sources, name, exhibit))
        elif identity == "table2":
            views.append(_table2(sources, name, exhibit))
        elif identity in captions:
            base = sources.naert(name, identity)
            views.append(
                FigureView(
                    label=exhibit["label"],
                    title=exhibit["title"],
                    caption=captions[identity],
                    svg=base.with_suffix(".svg"),
                    files=_files(base),
                    differs=exhibit["differs"],
                )
            )
        if identity == "fig06":
            views += _refinement(sources, name)
        if identity == "fig11":
            views += duration_views(
                sources.naert(name, ""), sources.config, sources.constants, exhibit,
                corpus.simulator is not None,
            )  # fmt: skip
    views += _left_out(sources, name)
    views.append(_sign_types(sources, name))
    views += synthesis_report.views(sources.naert(name, ""), corpus.unit)
    if corpus.simulator:
        views += _simulation(sources, name)
    text = [str(corpus.settings["title"]) + ".", str(corpus.settings.get("description", ""))]
    text.append(f"Licence: {corpus.settings['licence']}. Source: {corpus.settings['citation']}.")
    return Section(
        anchor=name,
        title=name,
        text=[line for line in text if line],
        badge="simulated" if corpus.simulator else "real",
        exhibits=views,
        notices=_unused_glosses(sources, name),
    )


def _unused_glosses(sources: Sources, name: str) -> list[str]:
    frame = read_table(sources.naert(name, "lexicon.csv"), "lexicon")
    unused = frame.loc[frame["occurrences"] == 0, "gloss"]
    if unused.empty:
        return []
    return [
        f"signs.csv has {len(unused)} glosses that occur in no recording: {listed(unused)}. "
        "Misspelt, or not needed."
    ]


def _table1(sources: Sources, name: str, exhibit: Mapping[str, str]) -> TableView:
    path = sources.naert(name, "table1.csv")
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
        label=exhibit["label"],
        title=exhibit["title"],
        caption=f"{len(frame)} utterances, {int(frame['signs'].sum())} signs; {told}.",
        frame=frame,
        columns=columns,
        file=path,
        differs=exhibit["differs"],
        most=8,
    )


def _table2(sources: Sources, name: str, exhibit: Mapping[str, str]) -> TableView:
    path = sources.naert(name, "table2.csv")
    frame = read_table(path, "table2")
    simulated = sources.corpora[name].simulator is not None
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
        label=exhibit["label"],
        title=exhibit["title"],
        caption=caption,
        frame=frame,
        columns=columns,
        file=path,
        differs=exhibit["differs"],
        emphasis="equal" if simulated else "",
        most=40,
    )


def _refinement(sources: Sources, name: str) -> Iterator[TableView | FigureView]:
    path = sources.naert(name, "refinement.csv")
    settings = sources.config["refinement"]
    columns = {
        "hand": ("hand", ""),
        "measure": ("measure", ""),
        "value": ("manual tags", S3),
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
        caption=f"Window {settings['window_s']:g} s. Chance: {settings['draws']} sets of as many "
        "tags, placed at random over the annotated frames of each recording; mean and 95 % of "
        "the sets.",
        frame=read_table(path, "refinement"),
        columns=columns,
        file=path,
    )
    base = sources.naert(name, "fig_refinement")
    yield FigureView(
        label="",
        title="Tags and speed minima against chance",
        caption="Share of manual tags (coloured) with a speed minimum of the hand at most so far "
        "away, against random tags (grey band: 95 % of the sets). Where the coloured line runs in "
        "the band, tags are no nearer to minima than chance has it; below the band, farther.",
        svg=base.with_suffix(".svg"),
        files=[base.with_suffix(s) for s in (".svg", ".pdf")],
    )


def _left_out(sources: Sources, name: str) -> Iterator[TableView]:
    path = sources.naert(name, "transitions_left_out.csv")
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


def _sign_types(sources: Sources, name: str) -> TableView:
    path = sources.naert(name, "sign_types.csv")
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


def _simulation(sources: Sources, name: str) -> Iterator[TableView | FigureView]:
    error_path = sources.naert(name, "truth_error.csv")
    yield TableView(
        label="",
        title="Error of the tags to the true boundaries",
        caption="Mean absolute error before and after refinement, with 95 % bootstrap intervals.",
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
    )
    path = sources.naert(name, "surface.csv")
    frame = read_table(path, "surface")
    unit = sources.config["transitions"]["euclidean_unit_m"]
    yield TableView(
        label="",
        title="The duration surface found again (eq. 4)",
        caption=f"Least squares on {int(frame['n'].iloc[0])} manual transitions, Euclidean "
        f"distance in units of {unit:g} m; mean error {frame['mean_error_s'].iloc[0]:.5f} s (the "
        f"paper: {sources.constants['mean_error']} s). Designed: the same fit on the distances "
        "that the simulation was made to have between the true boundaries; the tags stand off "
        "these, which shifts the fit.",
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
    )
    base = sources.naert(name, "fig_simulation")
    yield FigureView(
        label="",
        title="Truth found again",
        caption="Left: share of tags over their error to the true boundary, before (dashed) and "
        "after refinement. Right: coefficients of the surface over the printed ones.",
        svg=base.with_suffix(".svg"),
        files=[base.with_suffix(s) for s in (".svg", ".pdf")],
    )


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
    lowpass = sources.config["kinematics"]["lowpass"]
    shown = min(recordings, SPEED_PANELS)
    return FigureView(
        label="",
        title=titled("Wrist speed", sources.corpora[name]),
        caption="Speed of the right (blue) and left (red) wrist with their local minima (dots) in "
        f"{shown} of {recordings} recordings, spread over the list; low-pass: {lowpass['method']}, "
        f"half gain at {lowpass['cutoff_hz']:g} Hz. The corpus has no tags, so there is nothing to "
        "refine.",
        svg=base.with_suffix(".svg"),
        files=[base.with_suffix(s) for s in (".svg", ".pdf")],
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
            f"{sources.config['kinematics']['longest_gap_s']:g} s); the longest gap lasts "
            f"{worst['longest_gap_s']:.2f} s ({worst['joint']}, {worst['recording']})."
        )
    told = ", ".join(
        f"{int(verdicts.get(v, 0))} {v}" for v in ("plausible", "implausible", "not testable")
    )
    parts.append(f"Plausibility checks of lengths and speeds: {told}.")
    return " ".join(parts)


def _choices(sources: Sources) -> Section:
    rows = list(_flat(sources.config))
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
