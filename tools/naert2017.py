"""How far Naert et al.'s results move with the choices of docs/interpretations.md.

python -m tools.numbers RESULTS DATA naert2017
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from signkin.coarticulation.transitions import with_normalised
from signkin.corpus import Corpus, load_corpus
from signkin.settings import Settings
from signkin.stages.ingest import Ingested, ingest
from signkin.stages.kinematics import kinematics
from signkin.statistics.descriptive import outliers, trend
from signkin.studies.naert2017 import simulation
from signkin.studies.naert2017.figures import fig09_segmentations
from signkin.studies.naert2017.refinement import boundaries, refinement
from signkin.studies.naert2017.sampling import Sample
from signkin.studies.naert2017.settings import TransitionSettings
from signkin.studies.naert2017.transitions import counted, transitions
from tools.numbers import table
from tools.shipped import shipped

ROOT = Path(__file__).resolve().parents[1]
CHOICES: dict[str, dict[str, Any]] = {
    "as shipped": {},
    "low-pass 4 Hz": {"kinematics.lowpass.cutoff_hz": 4.0},
    "low-pass 8 Hz": {"kinematics.lowpass.cutoff_hz": 8.0},
    "low-pass 10 Hz": {"kinematics.lowpass.cutoff_hz": 10.0},
    "FIR 6 Hz": {"kinematics.lowpass.method": "fir"},
    "prominence 0": {"kinematics.minima.prominence": 0.0},
    "prominence 0.02": {"kinematics.minima.prominence": 0.02},
    "prominence 0.1": {"kinematics.minima.prominence": 0.1},
    "spacing 0.1 s": {"kinematics.minima.spacing_s": 0.1},
    "window 0.10 s": {"refinement.search_window_s": 0.10},
    "window 0.20 s": {"refinement.search_window_s": 0.20},
    "orientations to the parent": {"transitions.geodesic_frame": "parent"},
}
SHIPPED = "as shipped"
Measures = Mapping[str, str]


def measures(
    corpus: Corpus, read: Ingested, settings: Settings, simulated: Path | None
) -> dict[str, str]:
    """Return the measures of one corpus under one configuration."""
    found = kinematics(corpus, read.recordings, settings.kinematics)
    names = [r.name for r in read.recordings]
    intervals, minima = read.table("intervals"), found.table("minima", corpus.unit)
    bounds = boundaries(corpus, names, intervals, minima, settings.refinement)
    frames = pd.concat(found.frames)
    chosen = TransitionSettings.of(settings)
    made = transitions(corpus, read.recordings, frames, intervals, bounds, chosen)
    moves = with_normalised(made["raw_transitions"], corpus.unit)
    tagged = tuple(dict.fromkeys(bounds["recording"]))
    quality, _ = refinement(
        corpus, read.table("recordings"), intervals, minima, bounds,
        settings.refinement.model_copy(update={"draws": 300}), settings.seed,
        Sample(tagged, len(tagged)),
    )  # fmt: skip
    right = quality[quality["hand"] == "right"].set_index("measure")
    near = right.loc["tags with a minimum within the window"]
    pairs = fig09_segmentations.data(moves, corpus.unit).query("hand == 'right'")
    change = (pairs["refined_duration_s"] - pairs["manual_duration_s"]).abs()
    whole = counted(moves)
    there = whole[whole["mean_distance"].notna()]
    line = trend(there["mean_distance"].to_numpy(), there["duration_s"].to_numpy())
    out = {
        "minima a second": f"{len(minima) / 2 / sum(r.duration_s for r in read.recordings):.2f}",
        "tags near a minimum": f"{near['value']:.3f}",
        "chance": f"{near['chance']:.3f}",
        "tags moved": f"{right.loc['tags moved', 'value']:.3f}",
        "median change of duration (s)": f"{change.median():.3f}",
        "r (Fig. 7)": f"{line.r:.2f}" if line else "",
    }
    if simulated is not None:
        truth = pd.read_csv(simulated / "truth.csv", dtype={"recording": str})
        error, _ = simulation.truth_error(corpus.name, bounds, truth, 100, 1)
        refined = error[error["segmentation"] == "refined"].set_index("hand")["mean_error_s"]
        out["refined error to truth, right (s)"] = f"{refined['right']:.4f}"
        design = pd.read_csv(simulated / "design.csv", dtype={"type": str})
        constants = pd.read_csv(ROOT / "papers/naert2017/constants.csv", dtype=str)
        surface = simulation.surface(corpus.name, moves, design, constants, 0.1)
        out["theta"] = " ".join(f"{t:.3f}" for t in surface["fitted"])
    return out


def of_corpus(
    name: str, folder: Path, choices: Mapping[str, dict[str, Any]]
) -> dict[str, dict[str, str]]:
    """Return the measures of a corpus under each choice. folder: its recordings."""
    corpus = load_corpus(ROOT / "corpora" / name)
    read = ingest(corpus, folder, corpus.entries)
    simulated = folder if corpus.simulator else None
    recorded = corpus.settings["motion"]["orientations"] == "recorded"
    return {
        choice: measures(corpus, read, shipped(keys), simulated)
        for choice, keys in choices.items()
        if recorded or "parent" not in choice
    }


def near(found: Measures) -> str:
    """Format the share of tags near a minimum, with chance."""
    return f"{float(found['tags near a minimum']):.2f} ({float(found['chance']):.2f})"


def lowpass_row(label: str, sim: Measures, dgs: Measures) -> list[str]:
    """Return a row of the table of low-pass filters."""
    return [label, near(sim), near(dgs), f"{float(dgs['minima a second']):.1f}"]


def places(lsf: Mapping[str, Measures], dgs: Mapping[str, Measures]) -> dict[str, str]:
    """Return the tables of the page, by the name of their place."""
    lowpasses = {
        "4 Hz": "low-pass 4 Hz", "**6 Hz**": SHIPPED, "8 Hz": "low-pass 8 Hz",
        "10 Hz": "low-pass 10 Hz", "6 Hz, FIR": "FIR 6 Hz",
    }  # fmt: skip
    prominences = {
        "0": "prominence 0", "0.02": "prominence 0.02", "**0.05**": SHIPPED,
        "0.1": "prominence 0.1",
    }  # fmt: skip
    error = "refined error to truth, right (s)"
    return {
        "naert2017-lowpass": table(
            ("", "tags near a minimum (chance), lsf-sim", "dgs", "minima a second, dgs"),
            (lowpass_row(label, lsf[key], dgs[key]) for label, key in lowpasses.items()),
        ),
        "naert2017-prominence": table(
            ("prominence", "minima a second, dgs", "tags near a minimum (chance), dgs",
             "refined error to truth, lsf-sim"),
            (
                (label, f"{float(dgs[key]['minima a second']):.1f}", near(dgs[key]),
                 f"{1000 * float(lsf[key][error]):.0f} ms")
                for label, key in prominences.items()
            ),
        ),
    }  # fmt: skip


def main(results: Path, data: Path) -> dict[str, str]:
    """Print every table; returns those of the page."""
    found = {}
    for name in ("lsf-sim", "dgs-1984189", "boston104"):
        simulated = results / name / "simulated"
        folder = simulated if simulated.is_dir() else data / name
        found[name] = of_corpus(name, folder, CHOICES)
        columns = list(found[name][SHIPPED])
        rows = ([choice, *row.values()] for choice, row in found[name].items())
        print(f"\n**{name}**\n\n{table(['choice', *columns], rows)}")
        moves = pd.read_csv(results / f"naert2017/{name}/transitions.csv", dtype={"type": str})
        durations = counted(moves)["duration_s"].to_numpy(dtype=float)
        counts = {f: int(np.sum(outliers(durations, f))) for f in (1.5, 3.0)}
        print(f"\nOutliers by fences of 1.5 and 3 interquartile ranges: {counts}", flush=True)
    return places(found["lsf-sim"], found["dgs-1984189"])


def sample(results: Path) -> tuple[str, str]:
    """Return a place and the start of a row of it, from simulated recordings, to compare."""
    found = of_corpus("lsf-sim", results / "lsf-sim" / "simulated", {SHIPPED: {}})
    return "naert2017-lowpass", f"| **6 Hz** | {near(found[SHIPPED])} |"
