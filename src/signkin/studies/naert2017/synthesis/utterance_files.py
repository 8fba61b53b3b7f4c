"""Utterances as files: BVH with the skeleton of a recording, or a table of positions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from signkin import tables
from signkin.coarticulation.synthesis import moved
from signkin.corpus import Corpus
from signkin.io import read_recording
from signkin.io.bvh import channel_values, parse_bvh, write_bvh
from signkin.io.registry import in_file_axes
from signkin.io.wide_csv import write_positions
from signkin.recording import Recording
from signkin.settings.sections import Utterance as Wanted
from signkin.studies.naert2017.settings import SynthesisSettings
from signkin.studies.naert2017.synthesis.database import Database
from signkin.studies.naert2017.synthesis.duration_models import timing
from signkin.studies.naert2017.synthesis.retrieval import retrieved
from signkin.studies.naert2017.synthesis.stock import Place, placement
from signkin.studies.naert2017.synthesis.utterance import Utterance, make_utterance, parts_table


def wanted_of(corpus: str, utterances: Iterable[Wanted]) -> dict[str, list[str]]:
    """Return the utterances of a corpus, name -> glosses; utterances: config's list of them."""
    return {u.name: list(u.glosses) for u in utterances if u.corpus == corpus}


def is_bvh(corpus: Corpus) -> bool:
    """Return whether utterances of a corpus are written as BVH; else as a wide table."""
    first = corpus.entries[0].motion
    return corpus.settings["motion"].get("format") == "bvh" or first.lower().endswith(".bvh")


def whole_takes(
    corpus: Corpus, folder: Path, base: Database, names: Sequence[str], align: bool
) -> dict[str, Recording]:
    """Return recordings with every joint of their BVH files, at the database's place.

    align: config's `align_takes`. Raises SignkinError where a file cannot be read.
    """
    out = {}
    first = next(iter(base.recordings))
    entries = {entry.recording: entry for entry in corpus.entries}
    home = None
    for name in dict.fromkeys((first, *names)):
        entry = entries[name]
        spec = corpus.motion_spec(entry)
        take = read_recording(folder / entry.motion, **{**spec, "joints": None})
        if align:
            mapped = read_recording(folder / entry.motion, **spec)
            if home is None:
                home = Place.of(mapped)
            elif name != first:
                take = moved(take, *placement(mapped, home))
        out[name] = take
    return out


def write_utterance(
    utterance: Utterance, corpus: Corpus, folder: Path, recording: str, stem: Path
) -> Path:
    """Write the motion beside `stem`: BVH with the skeleton of a recording's file, or a table.

    folder: of the corpus's data. recording: whose hierarchy the BVH file gets. Returns the path.
    """
    if not is_bvh(corpus):
        path = stem.with_name(f"{stem.name}.csv")
        write_positions(path, utterance.motion)
        return path
    path = stem.with_name(f"{stem.name}.bvh")
    entry = next(e for e in corpus.entries if e.recording == recording)
    hierarchy, _, _ = parse_bvh(folder / entry.motion)
    motion = corpus.settings["motion"]
    axes = {key: motion[key] for key in ("up", "right") if key in motion}
    positions, turns = in_file_axes(utterance.motion, unit=motion["unit"], **axes)
    assert turns is not None
    write_bvh(
        path, hierarchy, channel_values(hierarchy, positions, turns), utterance.motion.rate_hz
    )
    return path


def utterance_files(
    corpus: Corpus,
    folder: Path,
    base: Database,
    wanted: Mapping[str, Sequence[str]],
    settings: SynthesisSettings,
    printed: np.ndarray,
    out: Path,
) -> pd.DataFrame:
    """Make and write some utterances (name -> glosses); returns their table `utterances`.

    out: folder of the files, which is made.
    """
    chosen = settings.synthesis
    out.mkdir(parents=True, exist_ok=True)
    clock = timing(base, chosen.duration, settings.durations, printed)
    tables_of = []
    for name, glosses in wanted.items():
        tokens = retrieved(base, list(glosses), chosen.retrieval)
        names = [base.tokens[t].sign.recording.name for t in tokens]
        idle = corpus.settings.get("synthesis", {}).get("idle")
        takes = None
        if is_bvh(corpus):
            more = [idle["recording"]] if idle and idle["recording"] in base.recordings else []
            takes = whole_takes(corpus, folder, base, [*names, *more], chosen.align_takes)
        made = make_utterance(base, tokens, clock, chosen, takes)
        write_utterance(made, corpus, folder, names[0], out / name)
        parts = parts_table(made, corpus, name)
        tables.write_table(parts, out / f"{name}_parts.csv", "utterances", corpus.unit)
        tables_of.append(parts)
    if not tables_of:
        return tables.empty("utterances", corpus.unit)
    return pd.concat(tables_of, ignore_index=True)
