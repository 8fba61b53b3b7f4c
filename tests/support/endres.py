"""Single signs small enough to be binned in a moment: recordings, corpora, settings."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from signkin.corpus import Corpus, Entry, load_corpus
from signkin.recording import Recording
from signkin.settings import Settings, load_settings
from signkin.simulate.isl import RATE_HZ, simulate
from signkin.studies.endres2013.settings import CutSettings
from support.runs import ROOT

JOINTS = ("right_wrist", "left_wrist")


def settings(choices: dict[str, Any] | None = None, **binning: Any) -> Settings:
    """Return the shipped settings, the section `binning` and what is varied changed."""
    changed = {"binning": binning, "open_choices": {"endres2013": choices or {}}}
    return load_settings(changed)


def cut(**binning: Any) -> CutSettings:
    """Return what trajectories take of the shipped settings."""
    return CutSettings.of(settings(**binning))


def corpus_of(names: list[str], noise_sd: float = 0.001, unit: str = "m") -> Corpus:
    """Return a corpus in memory: two signers by turns, one sign."""
    entries = tuple(
        Entry(
            recording=name, signer=f"s{i % 2 + 1}", motion=f"{name}.csv", annotation="", part="",
            line=i + 2, sign="wave", repetition=i // 2 + 1,
        )
        for i, name in enumerate(names)
    )  # fmt: skip
    described = {"noise_sd": noise_sd, "motion": {"unit": unit}}
    return Corpus("tiny", Path("tiny"), described, entries, ())


def recording_of(
    name: str, right: np.ndarray, left: np.ndarray | None = None, rate_hz: float = 100.0,
    unit: str = "m",
) -> Recording:  # fmt: skip
    """Return a recording of two wrists, the left one at rest unless given."""
    still = np.zeros_like(right) if left is None else left
    return Recording(
        name=name, rate_hz=rate_hz, joints=JOINTS, positions=np.stack([right, still], axis=1),
        unit=unit,
    )  # fmt: skip


def arc(seconds: float = 1.6, rate_hz: float = 100.0, seed: int = 0) -> np.ndarray:
    """Return a bent path with rest at both ends, (F, 3) m."""
    rng = np.random.default_rng(seed)
    u = np.clip(np.linspace(-0.1, 1.1, round(seconds * rate_hz)), 0, 1)
    u = 10 * u**3 - 15 * u**4 + 6 * u**5
    turn = rng.uniform(4.5, 5.5)
    path = [0.2 * np.sin(turn * u), 0.15 * np.cos(turn * u), 0.1 * u + 0.06 * np.sin(9 * u)]
    return np.column_stack(path)


def simulated(count: int, seed: int = 2017) -> tuple[Corpus, list[Recording]]:
    """Return the corpus isl-sim with some of its recordings, evenly over signs and signers."""
    whole = load_corpus(ROOT / "corpora" / "isl-sim")
    step = len(whole.entries) // count
    corpus = replace(whole, entries=whole.entries[::step][:count])
    takes = simulate(corpus.entries, corpus.name, corpus.noise_sd, seed)
    recordings = [
        recording_of(t.recording, t.measured["right"], t.measured["left"], RATE_HZ) for t in takes
    ]
    return corpus, recordings
