"""What the audit's page tells of both papers' cuts on the same wrists."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from signkin.report.page import Section, TableView
from signkin.tables import read_table

KINDS = {"boundaries": "boundaries by binning", "minima": "speed minima"}


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
        "same recordings, through the same matching; 95 % of the sets lie between the two numbers.",
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
                good = int((here["above"] == "yes").sum())
                parts.append(f"{truth} are hit above chance on {good} of {len(here)} wrists")
        if parts:
            out.append(f"On {what}, {', '.join(parts)}.")
    return out
