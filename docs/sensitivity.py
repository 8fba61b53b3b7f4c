"""How far results move with the choices of docs/interpretations.md: prints Markdown tables.

python docs/sensitivity.py RESULTS DATA

RESULTS: the results folder of a finished run (its simulated corpus is used).
DATA: the folder of the real recordings.
"""

from __future__ import annotations

import copy
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from signkin.coarticulation.transitions import with_normalised
from signkin.corpus import Corpus, load_corpus
from signkin.settings import Settings, load_settings
from signkin.stages.ingest import Ingested, ingest
from signkin.stages.kinematics import kinematics
from signkin.statistics.descriptive import outliers, trend
from signkin.studies.naert2017 import simulation
from signkin.studies.naert2017.figures import fig09_segmentations
from signkin.studies.naert2017.refinement import boundaries, refinement
from signkin.studies.naert2017.settings import TransitionSettings
from signkin.studies.naert2017.transitions import counted, transitions

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


def changed(config: dict[str, Any], choice: dict[str, Any]) -> dict[str, Any]:
    """Return the configuration with some keys changed."""
    out = copy.deepcopy(config)
    for path, value in choice.items():
        *parents, key = path.split(".")
        place = out
        for parent in parents:
            place = place[parent]
        place[key] = value
    return out


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
    quality, _ = refinement(
        corpus, read.table("recordings"), intervals, minima, bounds,
        settings.refinement.model_copy(update={"draws": 300}), settings.seed,
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


def table(rows: dict[str, dict[str, str]]) -> str:
    """Return rows as Markdown."""
    columns = list(next(iter(rows.values())))
    lines = ["| choice | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    lines += [f"| {name} | " + " | ".join(r[c] for c in columns) + " |" for name, r in rows.items()]
    return "\n".join(lines)


def main() -> None:
    """Print the tables."""
    results, data = Path(sys.argv[1]), Path(sys.argv[2])
    config = yaml.safe_load((ROOT / "config.yaml").read_text())
    for name in ("lsf-sim", "dgs-1984189", "boston104"):
        corpus = load_corpus(ROOT / "corpora" / name)
        simulated = results / name / "simulated" if corpus.simulator else None
        read = ingest(corpus, simulated or data / name, corpus.entries)
        rows = {}
        for choice, keys in CHOICES.items():
            if "parent" in choice and corpus.settings["motion"]["orientations"] != "recorded":
                continue
            rows[choice] = measures(corpus, read, load_settings(changed(config, keys)), simulated)
        print(f"\n**{name}**\n\n{table(rows)}")
        moves = pd.read_csv(results / f"naert2017/{name}/transitions.csv", dtype={"type": str})
        durations = counted(moves)["duration_s"].to_numpy(dtype=float)
        counts = {f: int(np.sum(outliers(durations, f))) for f in (1.5, 3.0)}
        print(f"\nOutliers by fences of 1.5 and 3 interquartile ranges: {counts}")


if __name__ == "__main__":
    main()
