"""Runs of the workflow in folders of their own, and a corpus small enough to spoil."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Run:
    """A finished run: where, its exit status, what it printed."""

    folder: Path
    status: int
    text: str

    @property
    def results(self) -> Path:
        return self.folder / "results"


def command(*extra: str) -> list[str]:
    return [sys.executable, "-m", "signkin", "run", *extra]


def environment(data: Path | None) -> dict[str, str]:
    env = {k: v for k, v in os.environ.items() if k != "SIGNKIN_DATA"}
    if data is not None:
        env["SIGNKIN_DATA"] = str(data)
    return env


# The same rules on less: fewer settings, draws and fitted recordings than the shipped ones.
QUICK = {
    "report": {"explorer_recordings": 4},
    "binning": {"fitted_recordings": 6, "bootstrap_draws": 200, "chance_trajectories": 400},
    "open_choices": {
        "endres2013": {
            "recordings": 2,
            "dof": [None],
            "noise": ["sensor expected", "data plain"],
            "concentration": [0.1],
            "literal_dof": [None],
            "literal_unit": ["mm"],
            "learnt_recordings": 4,
            "time_unit": ["bin", "second"],
            "bins": [100],
        },
    },
}


def merged(old: dict, new: dict) -> dict:
    """Return a dictionary with another's values put in, level by level."""
    out = dict(old)
    for key, value in new.items():
        nested = isinstance(value, dict) and isinstance(old.get(key), dict)
        out[key] = merged(old[key], value) if nested else value
    return out


def prepare(folder: Path, **changes: object) -> Path:
    """Write config.yaml of a run: the shipped one, quicker, with changes (`corpora=[...]`)."""
    config = yaml.safe_load((ROOT / "config.yaml").read_text())
    config = {**merged(config, QUICK), **changes}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "config.yaml").write_text(yaml.safe_dump(config))
    return folder


def run(folder: Path, *extra: str, data: Path | None = None, timeout: float = 600) -> Run:
    return signkin("run", *extra, folder=folder, data=data, timeout=timeout)


def signkin(*words: str, folder: Path, data: Path | None = None, timeout: float = 600) -> Run:
    done = subprocess.run(
        [sys.executable, "-m", "signkin", *words], cwd=folder, env=environment(data), text=True,
        timeout=timeout, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
    )  # fmt: skip
    return Run(folder, done.returncode, done.stdout)


def checked(done: Run) -> Run:
    assert done.status == 0, done.text
    return done


# --- a corpus small enough to spoil ----------------------------------------------------------

JOINTS = ("shoulder", "elbow", "wrist")
RATE = 50


def mini_motion(seconds: float, seed: int) -> str:
    """Return a wide CSV of two arms whose wrists stop at tags and move between them."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(seconds * RATE)) / RATE
    header = [f"{s}_{j}_{a}" for s in ("right", "left") for j in JOINTS for a in "xyz"]
    columns = []
    for side in (1, -1):
        shoulder = np.array([0.18 * side, 0.0, 1.4])
        elbow = shoulder + np.array([0.05 * side, 0.05, -0.28])
        beat = 0.12 * np.cos(2 * np.pi * t) + 0.03 * np.cos(5 * t + side)
        direction = np.column_stack([-0.1 * side + beat * side, 0.2 + 0 * t, 0.05 + beat])
        direction /= np.linalg.norm(direction, axis=1)[:, None]
        for points in (shoulder + 0 * direction, elbow + 0 * direction, elbow + 0.25 * direction):
            columns.append(points + rng.normal(0, 0.0003, points.shape))
    rows = np.hstack(columns)
    return (
        "\n".join([",".join(header), *(",".join(f"{v:.5f}" for v in row) for row in rows)]) + "\n"
    )


MINI = {
    "title": "Mini", "language": "none", "licence": "none", "citation": "none", "noise_sd": 0.001,
    "data_folder": "mini",
    "motion": {
        "format": "csv", "unit": "m", "rate_hz": RATE, "orientations": "limb_frames",
        "joints": {
            f"{s}_{j}": [f"{s}_{j}_{a}" for a in "xyz"] for s in ("right", "left") for j in JOINTS
        },
    },
    "annotation": {
        "format": "csv", "sign_tier": "sign", "utterance_gap_s": 1.0,
        "options": {"start_column": "start", "end_column": "end", "label_column": "gloss"},
    },
}  # fmt: skip


def write_mini(
    folder: Path, data: Path, name: str = "mini", **settings: object
) -> tuple[Path, Path]:
    """Write a mini corpus of two recordings; returns the folders of its description and its files.

    folder: that of the run. data: the folder of all data. settings: of corpus.yaml.
    """
    corpus, files = folder / "corpora" / name, data / name
    corpus.mkdir(parents=True)
    files.mkdir(parents=True)
    (corpus / "corpus.yaml").write_text(yaml.safe_dump({**MINI, **settings}))
    (corpus / "recordings.csv").write_text(
        "recording,signer,motion,annotation\nm1,s1,m1.csv,t1.csv\nm2,s2,m2.csv,t2.csv\n"
    )
    (corpus / "signs.csv").write_text("gloss,hands,symmetric\nCAKE,1,1\nIX,0,0\n")
    for i in (1, 2):
        (files / f"m{i}.csv").write_text(mini_motion(12, i))
        tags = [(k + 0.05 * i, k + 0.6, ("CAKE", "IX", "NEW")[k % 3]) for k in range(1, 10)]
        rows = "".join(f"{a:.2f},{b:.2f},{g}\n" for a, b, g in tags)
        (files / f"t{i}.csv").write_text("start,end,gloss\n" + rows)
    return corpus, files


def files_of(folder: Path) -> dict[str, bytes]:
    """Return the bytes of every file below a folder, by its place in it."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }
