"""What the report and the audit's page tell of both papers' cuts on the same wrists."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

import pandas as pd

from signkin.corpus import Corpus
from signkin.report.attempts import attempted
from signkin.report.page import FigureView, Section, TableView, View, figure_files
from signkin.studies.endres2013.report import P3, SIMULATED, badge, left_out
from signkin.tables import read_table

KINDS = {"boundaries": "boundaries by binning", "minima": "speed minima"}


# --- the report -------------------------------------------------------------------------------


def sections(results: Path, corpora: Mapping[str, Corpus]) -> Iterator[Section]:
    """Yield a section for each corpus of continuous recordings."""
    for name, corpus in corpora.items():
        if not corpus.single_signs:
            yield _continuous(results / "endres2013" / name, name, corpus)


def _continuous(folder: Path, name: str, corpus: Corpus) -> Section:
    path = folder / "one_wrist.csv"
    compared = TableView(
        label="",
        title="Boundaries, minima and tags of one hand",
        caption="Hit rates within the window, one to one, mean over recordings; chance: as many "
        "Poisson events over the whole recording, 95 % of the sets; shifted: what is found itself, "
        "moved in a circle, which keeps its gaps.",
        frame=read_table(path, "one_wrist"),
        columns={
            "hand": ("hand", ""),
            "found": ("found", ""),
            "truth": ("held against", ""),
            "hit_rate": ("hit rate", P3),
            "chance_hit_rate": ("chance", P3),
            "chance_low": ("2.5 %", P3),
            "chance_high": ("97.5 %", P3),
            "shifted_hit_rate": ("shifted", P3),
            "shifted_low": ("2.5 %", P3),
            "shifted_high": ("97.5 %", P3),
            "false_positives_per_s": ("no hit, a second", P3),
            "n_found": ("found", "d"),
            "n_truth": ("of", "d"),
            "recordings": ("recordings", "d"),
            "note": ("note", ""),
        },
        file=path,
    )
    figure = FigureView(
        label="",
        title="Two papers, one wrist",
        caption=(folder / "one_wrist.txt").read_text(encoding="utf-8").strip()
        + (SIMULATED if corpus.simulator else ""),
        svg=folder / "fig_one_wrist.svg",
        files=figure_files(folder / "fig_one_wrist"),
    )
    views: list[View] = [figure, compared]
    views += attempted("Wrists in bins", partial(_wrists, folder))
    views += left_out(folder / "wrists_left_out.csv")
    text: Sequence[str] = [
        "The wrists of continuous recordings, binned as long series: do the segments of one paper "
        "start and end where the other puts its minima and tags?"
    ]
    return Section(
        anchor=name,
        title=name,
        text=text,
        badge=badge(corpus),
        exhibits=views,
    )


def _wrists(folder: Path) -> TableView:
    path = folder / "wrist_posteriors.csv"
    return TableView(
        label="",
        title="Wrists as long series",
        caption="Cut mass bounds the share of P(M | data) outside of the counts worked out. "
        "Misfit: how far the wrist lies off the expected path, in SDs of the noise that the prior "
        "expects; the note tells where it is too far, and where the longest segment makes the "
        "boundaries.",
        frame=read_table(path, "wrist_posteriors"),
        columns={
            "recording": ("recording", ""),
            "hand": ("hand", ""),
            "n_bins": ("bins", "d"),
            "bin_s": ("bin (s)", ".4f"),
            "order": ("order", "d"),
            "map_count": ("boundaries", "d"),
            "boundaries_per_s": ("a second", ".2f"),
            "explained_variance": ("explained variance", ".4f"),
            "cut_mass": ("cut mass", ".1g"),
            "noise_misfit": ("misfit (SDs)", ".2f"),
            "note": ("note", ""),
        },
        file=path,
        most=8,
    )


# --- the audit's page -------------------------------------------------------------------------


def two_papers(files: Mapping[str, Path], simulated: Mapping[str, bool]) -> Section | None:
    """Return the section; None where no corpus has both papers' cuts.

    files: corpus -> its table `one_wrist`. simulated: corpus -> whether it is.
    """
    if not files:
        return None
    whole = pd.concat([read_table(path, "one_wrist") for path in files.values()], ignore_index=True)
    rows = whole[whole["truth"].str.endswith("tags")]
    if rows.empty:
        return None
    kind = rows["corpus"].map(lambda name: "simulated" if simulated[name] else "real")
    above = rows["hit_rate"] > rows["chance_high"]
    frame = rows.assign(
        kind=kind,
        corpus=rows["corpus"] + " (" + kind + ")",
        found=rows["found"].map(KINDS),
        above=above.map({True: "yes", False: "no"}).where(rows["chance_high"].notna(), "unknown"),
        above_shifted=(rows["hit_rate"] > rows["shifted_high"])
        .map({True: "yes", False: "no"})
        .where(rows["shifted_high"].notna(), "unknown"),
    )
    columns = {
        "corpus": ("corpus", ""),
        "hand": ("wrist", ""),
        "found": ("what is found", ""),
        "truth": ("set against", ""),
        "hit_rate": ("share hit", ".2f"),
        "chance_low": ("chance, from", ".2f"),
        "chance_high": ("to", ".2f"),
        "above": ("above chance", ""),
        "shifted_low": ("shifted, from", ".2f"),
        "shifted_high": ("to", ".2f"),
        "above_shifted": ("above shifted", ""),
        "n_truth": ("tags", "d"),
        "recordings": ("recordings", "d"),
        "note": ("note", ""),
    }
    if not frame["note"].ne("").any():
        del columns["note"]
    window = " or ".join(f"{w:g}" for w in sorted(rows["window_s"].unique()))
    files_told = list(files.values())
    view = TableView(
        label="",
        title="Do the two papers cut the same movement in the same places?",
        caption="Share hit: of the tags, those with a boundary (or minimum) of their own within "
        f"{window} s, mean over recordings. Chance: as many boundaries thrown at random on the "
        "same recordings, through the same matching; 95 % of the sets lie between the two numbers. "
        "Shifted: the boundaries (or minima) themselves, moved in a circle: their gaps stay.",
        frame=frame,
        columns=columns,
        file=files_told[0] if len(files_told) == 1 else None,
        emphasis="above",
        most=40,
    )
    text = (
        "The two papers cut signing into pieces in ways that know nothing of each other. Naert et "
        "al. start from tags that a person set at the ends of signs, and move each to the nearest "
        "minimum of the wrist's speed (refined tags). Endres et al. let Bayesian binning cut the "
        "wrist's path into pieces that each follow one polynomial; it sees neither tags nor speed. "
        "Where both mean the same joints in the movement, a boundary should lie at a tag more "
        "often than by chance. No claim of either paper says so: the findings stand beside N19 "
        "and N21, without a say in their verdicts.",
        " ".join(_told(frame)),
    )
    return Section(
        "two-papers",
        "The two papers on the same wrists",
        text=text,
        exhibits=(view,),
        links=[(f"{name}: one_wrist.csv", path) for name, path in files.items()],
    )


def _told(frame: pd.DataFrame) -> list[str]:
    out = []
    for kind, what in (("real", "real recordings"), ("simulated", "simulated recordings")):
        parts = []
        for truth in ("manual tags", "refined tags"):
            here = frame[
                (frame["kind"] == kind)
                & (frame["truth"] == truth)
                & (frame["found"] == KINDS["boundaries"])
            ]
            if len(here):
                good, kept = (int((here[c] == "yes").sum()) for c in ("above", "above_shifted"))
                parts.append(
                    f"{truth} are hit above chance on {good} of {len(here)} wrists ({kept} where "
                    "the boundaries themselves are shifted)"
                )
        if parts:
            out.append(f"On {what}, {', '.join(parts)}.")
    return out
