"""Recordings made up for the explorer's pages: short, long, flat, with gaps, with odd glosses."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from signkin import tables
from signkin.corpus import Corpus, Entry
from signkin.explorer.sources import ExplorerSettings, Sources, read_sources
from signkin.io.store import write_recordings
from signkin.recording import Recording
from signkin.settings import Settings
from signkin.stages.kinematics import kinematics
from signkin.studies.one_wrist.long_series import long_series
from signkin.studies.one_wrist.settings import SeriesSettings

JOINTS = ("chest", "neck", "head", "right_shoulder", "right_elbow", "right_wrist", "right_index_1",
          "right_index_tip", "left_shoulder", "left_elbow", "left_wrist")  # fmt: skip
PLACES = np.array([
    (0, 0, 1.2), (0, 0, 1.4), (0, 0, 1.5), (0.2, 0, 1.35), (0.25, 0.05, 1.1), (0.2, 0.25, 1.2),
    (0.2, 0.3, 1.22), (0.2, 0.33, 1.24), (-0.2, 0, 1.35), (-0.25, 0.05, 1.1), (-0.2, 0.2, 0.9),
])  # fmt: skip
HOSTILE = '<script>document.title="taken"</script>&"\'</td>'


def signer(name="one", seconds=6.0, rate_hz=50.0, unit="m", flat=False, seed=1) -> Recording:
    """Return a take in which the right hand moves, in starts and stops, and the left a little."""
    rng = np.random.default_rng(seed)
    frames = round(seconds * rate_hz)
    time = np.arange(frames) / rate_hz
    positions = np.repeat(PLACES[None], frames, axis=0)
    sway = np.stack([np.sin(2 * np.pi * 0.9 * time), np.cos(2 * np.pi * 0.7 * time),
                     np.sin(2 * np.pi * 0.5 * time)], axis=1)  # fmt: skip
    positions[:, 5:8] += 0.15 * sway[:, None]
    positions[:, 10] += 0.02 * sway
    positions += rng.normal(0, 0.0005, positions.shape)
    if flat:
        positions[..., 1] = 0.0
    scale = 200.0 if unit == "px" else 1.0
    return Recording(
        name=name, rate_hz=rate_hz, joints=JOINTS, positions=positions * scale, unit=unit
    )


def corpus_of(recordings, tagged=True) -> Corpus:
    """Return a corpus of these recordings."""
    settings = {"noise_sd": 0.001, "motion": {"unit": recordings[0].unit, "orientations": "none"}}
    if tagged:
        settings["annotation"] = {"format": "csv", "sign_tier": "sign"}
    entries = tuple(
        Entry(recording=r.name, signer="S1", motion="m.csv", annotation="", part="", line=2)
        for r in recordings
    )
    return Corpus("made-up", Path("made-up"), settings, entries, ())


def tag_tables(recording, signs):
    """Return the tables of tags (start_s, end_s, gloss), as the rules before would write them."""
    lead = {"corpus": "made-up", "recording": recording.name, "signer": "S1"}
    intervals = [
        {**lead, "role": "sign", "tier": "sign", "label": g, "written": g, "start_s": a, "end_s": b}
        for a, b, g in signs
    ]
    tags = [
        {**lead, "sign": n, "gloss": g, "edge": edge, "manual_s": at, "hand": hand,
         "minimum_s": at + 0.02, "refined_s": at + shift, "plain_s": at + shift,
         "moved": shift > 0, "distance_s": 0.02, "status": "moved" if shift else "far", "note": ""}
        for n, (a, b, g) in enumerate(signs, start=1)
        for edge, at in (("start", a), ("end", b))
        for hand, shift in (("right", 0.0 if n == 2 else 0.02), ("left", 0.0))
    ]  # fmt: skip
    pairs = []
    for n, ((_, end, first), (start, _, second)) in enumerate(itertools.pairwise(signs), start=1):
        for segmentation, hand, shift in (
            ("manual", "both", 0.0), ("refined", "right", 0.02), ("refined", "left", 0.0),
        ):  # fmt: skip
            pairs.append(
                {**lead, "transition": n, "previous_gloss": first, "next_gloss": second,
                 "type": "0010", "type_source": "lexicon", "hand": hand,
                 "segmentation": segmentation, "utterance": "1", "start_s": end + shift,
                 "end_s": start, "duration_s": start - end - shift,
                 "status": "ok" if start > end else "overlap", "geodesic_rad": np.nan,
                 f"euclidean_{recording.unit}": 0.1, "n_joints": 11, "geodesic_norm": np.nan,
                 "euclidean_norm": 0.1 * n, "mean_distance": 0.1 * n, "note": ""}
            )  # fmt: skip
    frames = {"intervals": intervals, "boundaries": tags, "transitions": pairs}
    return {
        name: pd.DataFrame(rows, columns=tables.TABLES[name].names(recording.unit))
        for name, rows in frames.items()
    }


def synthesis_table(recording, transitions):
    """Return the table `synthesis` with the durations of a model."""
    rows = transitions[transitions["hand"] == "both"]
    out = pd.DataFrame(
        [
            {"corpus": "made-up", "recording": recording.name, "signer": "S1",
             "transition": row.transition, "previous_gloss": row.previous_gloss,
             "next_gloss": row.next_gloss, "material": "own", "method": "interpolation",
             "duration_model": model, "true_s": row.duration_s, "duration_s": length, "note": ""}
            for row in rows.itertuples() if row.status == "ok"
            for model, length in (("true", row.duration_s), ("surface", 0.3))
        ]
    )  # fmt: skip
    return out.reindex(columns=tables.TABLES["synthesis"].names(recording.unit))


def made_up(folder, recordings, signs=(), most=50, binned=False) -> Sources:
    """Write what the rules before the explorer write for some takes, and read it as it does.

    binned: whether wrists are binned as long series, too.
    """
    corpus = corpus_of(recordings, bool(signs))
    unit = corpus.unit
    corpus.settings["on_error"] = "skip"
    folder.mkdir(parents=True, exist_ok=True)
    write_recordings(folder / "recordings.parquet", recordings)
    found = kinematics(corpus, recordings, Settings().kinematics)
    pd.concat(found.frames).to_parquet(folder / "frames.parquet")
    about = [
        {"corpus": "made-up", "recording": r.name, "signer": "S1", "frames": r.frames,
         "rate_hz": r.rate_hz, "duration_s": r.duration_s, "unit": unit, "joints": len(r.joints),
         "orientations": "none", "signs": len(signs), "tags_note": "", "notes": ""}
        for r in recordings
    ]  # fmt: skip
    frames = {
        "recordings": pd.DataFrame(about).reindex(columns=tables.TABLES["recordings"].names()),
        "minima": found.table("minima", unit),
        "plausibility": found.table("plausibility", unit),
        "excluded": found.table("excluded", unit),
        "intervals": tables.empty("intervals", unit),
    }
    if signs:
        frames |= tag_tables(recordings[0], signs)
        frames["synthesis"] = synthesis_table(recordings[0], frames["transitions"])
    if binned:
        series = long_series(corpus, recordings, SeriesSettings.of(Settings()), 1)
        frames |= {n: series.table(n, unit) for n in ("wrist_posteriors", "wrist_boundaries")}
    files = {name: str(folder / f"{name}.csv") for name in frames}
    for name, frame in frames.items():
        tables.write_table(frame, files[name], name, unit)
    files |= {
        "recordings_of": str(folder / "recordings.parquet"),
        "frames": str(folder / "frames.parquet"),
    }
    settings = replace(ExplorerSettings.of(Settings()), most_recordings=most)
    return read_sources(corpus, settings, files)
