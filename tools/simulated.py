"""The simulated corpora, written as the rules simulate_lsf and simulate_isl write them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from signkin import seeds
from signkin.corpus import load_corpus
from signkin.io.wide_csv import write_wide_csv
from signkin.simulate import isl, lsf
from tools.shipped import shipped

ROOT = Path(__file__).resolve().parents[1]
SETTINGS = shipped()


def simulate_lsf(seed: int = SETTINGS.seed, parts: int | None = None) -> lsf.SimulatedCorpus:
    """Simulate lsf-sim from the printed tables of Naert et al. 2017.

    parts: into how many recordings the design is cut, of which lsf-sim's are made; None: as many.
    """
    text = {"dtype": str, "keep_default_na": False}
    printed = ROOT / "papers" / "naert2017"
    constants = pd.read_csv(printed / "constants.csv", **text).set_index("name")["value"]
    corpus = load_corpus(ROOT / "corpora" / "lsf-sim")
    return lsf.simulate(
        names=[entry.recording for entry in corpus.entries],
        lexicon=corpus.lexicon,
        table2=pd.read_csv(printed / "table2.csv", **text),
        theta=np.array([float(constants[f"theta_{t}"]) for t in lsf.TERMS]),
        mean_error_s=float(constants["mean_error"]),
        euclidean_unit_m=SETTINGS.transitions.euclidean_unit_m,
        rng=seeds.stream(seed, corpus.name),
        parts=parts,
    )


def write_lsf(folder: Path) -> None:
    """Write lsf-sim: motion, tags, true boundaries and the design."""
    folder.mkdir(parents=True)
    simulated = simulate_lsf()
    corpus = load_corpus(ROOT / "corpora" / "lsf-sim")
    for entry, recording in zip(corpus.entries, simulated.recordings, strict=True):
        lsf.write_motion(recording, folder / entry.motion)
        lsf.write_tags(recording, folder / entry.annotation)
        rng = seeds.stream(SETTINGS.seed, corpus.name, "second tagger", recording.name)
        for annotator in corpus.annotators:
            path = folder / corpus.annotator_file(entry, annotator)
            lsf.write_second_tags(recording, path, rng)
    simulated.truth.to_csv(folder / "truth.csv", index=False)
    simulated.design.to_csv(folder / "design.csv", index=False)


def write_isl(folder: Path) -> None:
    """Write isl-sim: the motion of every recording."""
    folder.mkdir(parents=True)
    corpus = load_corpus(ROOT / "corpora" / "isl-sim")
    recipe = isl.Recipe(**dict(SETTINGS.simulation.isl))
    takes = isl.simulate(corpus.entries, corpus.name, corpus.noise_sd, SETTINGS.seed, recipe)
    for entry, take in zip(corpus.entries, takes, strict=True):
        write_wide_csv(folder / entry.motion, isl.motion_columns(take), corpus.noise_sd)
