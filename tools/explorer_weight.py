"""`python -m tools.explorer_weight RESULTS CORPUS RECORDING MINUTES RATE [PAGES]`.

Makes the page of a recording that is as long as is asked for: a recording of a finished run, its
motion and its tags one after the other as often as it takes, at the rate given. Tells the page's
bytes, what of it takes most, how many frames a second of the skeleton it holds, and the time and
memory (of Linux) of making it and of what it is made of. PAGES: the
folder that the page is written to, `build/explorer` if none is given.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from signkin.corpus import load_corpus
from signkin.explorer.content import as_json, content
from signkin.explorer.pages import render
from signkin.explorer.sources import OTHERS, SHARED, ExplorerSettings, Sources, read_sources
from signkin.io.store import read_recordings
from signkin.recording import Recording
from signkin.settings import Settings
from signkin.stages.kinematics import kinematics

TIMES = ("start_s", "end_s", "manual_s", "refined_s", "minimum_s", "boundary_s")
NUMBERS = ("sign", "transition")


def longer(recording: Recording, minutes: float, rate_hz: float) -> tuple[Recording, int]:
    """Return a recording repeated to a length, and how often it is there.

    Every second time it runs backwards, so that nothing jumps; noise of half a millimetre (or
    pixel) keeps the packing from finding the same bytes again.
    """
    old = recording.times_s
    new = np.arange(0, old[-1], 1 / rate_hz)
    flat = recording.positions.reshape(len(old), -1)
    once = np.column_stack([np.interp(new, old, column) for column in flat.T])
    frames = round(minutes * 60 * rate_hz)
    often = -(-frames // len(once))
    noise = np.random.default_rng(1)
    sd = 0.0005 if recording.unit == "m" else 0.5
    parts = [
        (once if i % 2 == 0 else once[::-1]) + noise.normal(0, sd, once.shape).astype(np.float32)
        for i in range(often)
    ]
    positions = np.concatenate(parts)[:frames].reshape(frames, -1, 3)
    motion = replace(
        recording, positions=positions, orientations=None, orientation_source="none",
        rate_hz=rate_hz,
    )  # fmt: skip
    return motion, often


def repeated(frame: pd.DataFrame, often: int, lasts_s: float, most_s: float) -> pd.DataFrame:
    """Return a table's rows, moved on by the recording's length each time, numbers going on."""
    times = [column for column in TIMES if column in frame]
    if not times:
        return frame
    numbers = [column for column in NUMBERS if column in frame and frame[column].dtype != object]
    parts = []
    for i in range(often):
        part = frame.copy()
        part[times] += i * lasts_s
        for column in numbers:
            part[column] += i * (frame[column].max() if len(frame) else 0)
        parts.append(part)
    out = pd.concat(parts, ignore_index=True)
    return out[out[times].max(axis=1) < most_s]


def files_of(results: Path, corpus: str) -> Mapping[str, list[str]]:
    """Return the files of a finished run that the explorer takes."""
    places = {name: f"{corpus}/{name}.csv" for name in SHARED}
    places |= {name: f"naert2017/{corpus}/{name}.csv" for name in OTHERS}
    places |= {name: f"endres2013/{corpus}/{name}.csv" for name in OTHERS if "wrist" in name}
    places["synthesis"] = f"naert2017/{corpus}/synthesis/synthesis.csv"
    places["recordings_of"] = f"{corpus}/recordings/*.parquet"
    return {name: [str(f) for f in sorted(results.glob(p))] for name, p in places.items()}


def main(results: str, corpus_name: str, name: str, minutes: str, rate: str, pages: str) -> None:
    """Make the page and tell its weight."""
    corpus = load_corpus(Path("corpora") / corpus_name)
    settings = Settings()
    sources = read_sources(
        corpus, ExplorerSettings.of(settings), files_of(Path(results), corpus_name)
    )
    given = next(r for file in sources.recordings for r in read_recordings(file, [name]))
    recording, often = longer(given, float(minutes), float(rate))
    known = {
        table: repeated(sources.of(table, name), often, given.duration_s, recording.duration_s)
        for table in sources.tables
    }
    found = kinematics(corpus, [recording], settings.kinematics)
    known["minima"] = found.table("minima", corpus.unit)
    long = Sources(corpus, sources.settings, [], [], [], known)
    began = time.perf_counter()
    data = content(long, recording, found.frames[0], pd.DataFrame())
    html = render(data, None, None, f"{corpus_name}.html")
    took = time.perf_counter() - began
    file = Path(pages) / f"{name}-{minutes}min-{rate}Hz.html"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(html, encoding="utf-8")
    parts = {key: len(json.dumps(value)) for key, value in data.items()}
    heaviest = sorted(parts.items(), key=lambda part: -part[1])[:6]
    used = resource.getrusage(resource.RUSAGE_SELF)
    print(f"{file}: {file.stat().st_size:,} bytes, made in {took:.1f} s")
    print(
        f"{len(recording.times_s):,} frames; in all {used.ru_utime + used.ru_stime:.0f} s of CPU, "
        f"{used.ru_maxrss / 1024:.0f} MB"
    )
    print(", ".join(f"{key} {size:,}" for key, size in heaviest), f"; all {len(as_json(data)):,}")
    body, methods = data["skeleton"], list((data["syntheses"] or {}).get("methods", {}))
    print(
        f"{len(data['transitions']['rows'])} transitions; skeleton {body['rate']:.3g} frames a "
        f"second, {len(body['joints'])} of {len(recording.joints)} joints; speed "
        f"{data['speeds']['rate']:.3g} Hz; synthesised by {', '.join(methods) or 'none'}"
    )


if __name__ == "__main__":
    if not 6 <= len(sys.argv) <= 7:
        sys.exit(__doc__)
    main(*sys.argv[1:6], sys.argv[6] if len(sys.argv) == 7 else "build/explorer")
