"""Utterances from a list of glosses: retrieval, transitions, and the file (Naert et al., 3.1)."""

from __future__ import annotations

import difflib
import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from signkin import tables
from signkin.coarticulation.duration import (
    TERMS,
    DurationModel,
    MeanDuration,
    SurfaceDuration,
    Transitions,
)
from signkin.coarticulation.retrieval import Scale, best_chain, distances, greedy_chain
from signkin.coarticulation.synthesis import (
    Sign,
    Transition,
    blend,
    fitted,
    idle_frame,
    interpolate,
    moved,
)
from signkin.corpus import Corpus
from signkin.errors import SignkinError, listed
from signkin.io import read_recording
from signkin.io.bvh import channel_values, parse_bvh, write_bvh
from signkin.io.registry import in_file_axes
from signkin.io.store import read_recordings
from signkin.io.wide_csv import write_positions
from signkin.recording import Recording
from signkin.studies.naert2017.synthesis.comparison import (
    Database,
    Token,
    captured,
    database,
    maker,
    of_tokens,
    usable,
)
from signkin.studies.naert2017.synthesis.found import found_signs
from signkin.studies.naert2017.synthesis.stock import Place, placement

METRES = "m"


@dataclass(frozen=True, eq=False)
class Utterance:
    """A synthetic utterance: the motion, and the table of its parts (without corpus and name)."""

    motion: Recording
    parts: pd.DataFrame
    transitions: tuple[Transition, ...]


# --- the database, with or without tags ------------------------------------------------------


def sign_database(
    corpus: Corpus,
    takes: Sequence[Recording],
    intervals: pd.DataFrame,
    settings: Mapping[str, Any],
) -> tuple[Database, pd.DataFrame]:
    """Return the signs of a corpus and the table `found_signs` (empty for a corpus with tags)."""
    base = database(corpus, takes, intervals, settings)
    if corpus.tagged:
        return base, tables.empty("found_signs", corpus.unit)
    found = found_signs(corpus, list(base.recordings.values()), settings)
    tokens = [
        Token(
            Sign(
                recording=base.recordings[str(row.recording)],
                gloss=str(row.gloss),
                start_s=float(row.start_s),
                end_s=float(row.end_s),
            ),
            1,
            "",
        )
        for row in found.itertuples()
    ]
    return of_tokens(corpus, base.recordings, tokens, settings), found


def load_database(
    corpus: Corpus,
    files: Sequence[str | Path],
    intervals: str | Path,
    excluded: str | Path,
    settings: Mapping[str, Any],
) -> tuple[Database, pd.DataFrame]:
    """Read canonical recordings and tags, those left out aside; returns as `sign_database`."""
    without = set(tables.read_table(excluded, "excluded")["recording"])
    takes = [take for file in files for take in read_recordings(Path(file))]
    return sign_database(
        corpus,
        [take for take in takes if take.name not in without],
        tables.read_table(intervals, "intervals"),
        settings,
    )


def printed_theta(constants: str | Path) -> np.ndarray:
    """Return theta of eq. 4 as the paper prints it, (3,), from papers/naert2017/constants.csv."""
    frame = pd.read_csv(constants, dtype=str, keep_default_na=False).set_index("name")
    return np.array([float(frame.loc[f"theta_{term}", "value"]) for term in TERMS])


# --- retrieval -------------------------------------------------------------------------------


def retrieved(base: Database, glosses: Sequence[str], how: str) -> list[int]:
    """Return the token taken for each gloss; how: chain, greedy or first (config's `retrieval`).

    An unknown gloss is an error that suggests near ones.
    """
    known = base.glosses()
    for gloss in glosses:
        if gloss not in known:
            raise unknown_gloss(gloss, known, base.corpus.name)
    slots = [known[gloss] for gloss in glosses]
    if how == "first":
        return [slot[0] for slot in slots]
    scale = distance_scale(base)
    costs = []
    for before, after in itertools.pairwise(slots):
        cost = distances(base.candidates(before), base.candidates(after), scale)
        same = np.equal.outer(before, after)
        if not same.all():  # a gloss twice: another sign of it, where there is one
            cost = np.where(same, np.inf, cost)
        costs.append(cost)
    if how == "greedy" and len(slots) > 1:
        first = int(np.argmin(costs[0].min(axis=1)))
        chosen, _ = greedy_chain(costs, first)
    else:
        chosen, _ = best_chain(costs)
    return [slot[i] for slot, i in zip(slots, chosen, strict=True)]


def unknown_gloss(gloss: str, known: Mapping[str, Any], corpus: str) -> SignkinError:
    """Return the error of a gloss that does not occur, with those that look like it."""
    folded: dict[str, list[str]] = {}
    for name in known:
        folded.setdefault(name.casefold(), []).append(name)
    near = difflib.get_close_matches(gloss.casefold(), list(folded), n=5, cutoff=0.5)
    names = [name for word in near for name in folded[word]]
    return SignkinError(
        f"the gloss {gloss!r} does not occur",
        file=f"corpus {corpus}",
        expected=f"a gloss of the corpus{'; near ones: ' + listed(names) if names else ''}",
        todo=None if names else f"It has {listed(sorted(known), 30)}.",
    )


def distance_scale(base: Database) -> Scale:
    """Return the ranges of the two distances over the captured transitions (5.1)."""
    pairs = base.pairs()
    if len(pairs) < 2:
        return Scale()
    data = base.features([p.first for p in pairs], [p.second for p in pairs])
    euclidean = float(np.ptp(data.euclidean[np.isfinite(data.euclidean)])) * base.euclidean_unit
    turned = data.geodesic[np.isfinite(data.geodesic)]
    geodesic = float(np.ptp(turned)) if len(turned) else 0.0
    return Scale(euclidean if euclidean > 0 else 1.0, geodesic if geodesic > 0 else None)


# --- durations -------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Timing:
    """The model that tells how long transitions last, what it learnt from, and what stands in."""

    model: DurationModel
    name: str
    told: str
    fallback: DurationModel

    def ask(self, data: Transitions) -> tuple[float, str]:
        """Return the duration of one transition, and a note where the model had none."""
        value, note = float("nan"), ""
        if usable(self.name, data).all():
            value = float(data.ask(self.model)[0])
        if not np.isfinite(value):
            value = float(data.ask(self.fallback)[0])
            note = f"{self.name} has no duration for these postures: {value:.3f} s instead"
        return value, note


def timing(base: Database, model: str, settings: Mapping[str, Any], printed: np.ndarray) -> Timing:
    """Return the duration model, learnt from all captured transitions of the corpus.

    printed: theta of the paper's surface, for corpora without transitions to learn from.
    settings: config's `durations`.
    """
    pairs = base.pairs()
    usual = MeanDuration((settings["lowest_s"] + settings["highest_s"]) / 2)
    if pairs:
        known = captured(base, pairs)
        usual = MeanDuration(float(known.duration_s.mean()))
        geodesic = bool(np.isfinite(known.geodesic).any())
        for name in dict.fromkeys((model, "linear")):
            learn = known[usable(name, known)]
            try:
                fitted_model = learn.teach(maker(name, settings, geodesic)())
            except SignkinError:
                continue
            told = f"{name}, from {len(learn)} transitions of the corpus"
            if name != model:
                told += f" ({model} cannot be fitted)"
            return Timing(fitted_model, name, told, usual)
    has_turns = all(turns is not None for turns in base.turns.values())
    if model in ("surface", "linear") and has_turns and base.corpus.unit == METRES:
        told = "surface as printed in the paper (no captured transition to learn from)"
        return Timing(SurfaceDuration(theta=printed), "surface", told, usual)
    name = model if model == "simple" else "simple_bounded"
    bounded = maker(name, settings, has_turns)()
    return Timing(bounded, name, f"{name} (nothing to learn)", usual)


# --- the motion ------------------------------------------------------------------------------


def make_utterance(
    base: Database,
    tokens: Sequence[int],
    clock: Timing,
    settings: Mapping[str, Any],
    takes: Mapping[str, Recording] | None = None,
) -> Utterance:
    """Join the signs of some tokens by synthetic transitions.

    settings: config's `synthesis`. takes: recordings with all joints to make the motion from
    (the file's skeleton); None: the canonical ones, from which distances always come.
    """
    whole = takes or base.recordings
    signs: list[Sign] = []
    notes = []
    for token in tokens:
        sign = base.tokens[token].sign
        sign = replace(sign, recording=whole[sign.recording.name])
        sign, changed = fitted(sign, signs[0].recording) if signs else (sign, ())
        signs.append(sign)
        notes.append("; ".join(changed))
    rate, made, rows = signs[0].recording.rate_hz, [], []
    positions, turns = [], []
    frame = 0
    known = base.glosses()
    for k, sign in enumerate(signs):
        source = base.tokens[tokens[k]].sign
        rows.append(
            {
                "kind": "sign",
                "gloss": sign.gloss,
                "recording": source.recording.name,
                "from_s": source.start_s,
                "to_s": source.end_s,
                "start_s": frame / rate,
                "end_s": (frame + sign.last - sign.first) / rate,
                "candidates": len(known[sign.gloss]),
                "note": notes[k],
            }
        )
        positions.append(sign.recording.positions[sign.motion])
        turned = sign.recording.orientations if _keeps_turns(sign.recording) else None
        turns.append(None if turned is None else turned[sign.motion])
        frame += sign.last - sign.first
        if k + 1 == len(signs):
            break
        step, row = _transition(base, tokens[k : k + 2], signs[k : k + 2], clock, settings, whole)
        made.append(step)
        rows.append({**row, "start_s": frame / rate, "end_s": (frame + step.steps) / rate})
        positions.append(step.motion.positions[1:-1])
        turns.append(None if step.motion.orientations is None else step.motion.orientations[1:-1])
        frame += step.steps
    first = signs[0].recording
    kept = [t for t in turns if t is not None]
    motion = replace(
        first,
        positions=np.concatenate(positions),
        orientations=np.concatenate(kept) if len(kept) == len(turns) else None,
        orientation_source="recorded" if len(kept) == len(turns) else "none",
    )
    parts = pd.DataFrame(rows)
    parts.insert(0, "part", np.arange(1, len(parts) + 1))
    return Utterance(motion, parts, tuple(made))


def _keeps_turns(recording: Recording) -> bool:
    """Limb frames are made from positions: a mixed motion has none of its own."""
    return recording.orientation_source == "recorded"


def _transition(
    base: Database,
    tokens: Sequence[int],
    signs: Sequence[Sign],
    clock: Timing,
    settings: Mapping[str, Any],
    takes: Mapping[str, Recording],
) -> tuple[Transition, dict[str, Any]]:
    data = base.features([tokens[0]], [tokens[1]])
    wanted, note = clock.ask(data)
    rate = signs[0].recording.rate_hz
    notes = [note] if note else []
    if wanted < 1 / rate:
        notes.append(f"{wanted:.3f} s predicted: one frame step made")
        wanted = 1 / rate
    form = {"orientations": settings["orientations"], "keep_limbs": settings["keep_limbs"]}
    if settings["method"] == "interpolation":
        made = interpolate(signs[0], signs[1], wanted, **form)
    else:
        made = blend(signs[0], signs[1], wanted, **form, idle=_idle(base, signs[0], takes))
    notes += made.notes
    row = {
        "kind": "transition",
        "gloss": f"{signs[0].gloss} {signs[1].gloss}",
        "recording": "",
        "method": made.method,
        "duration_model": clock.told,
        f"euclidean_{base.corpus.unit}": float(data.euclidean[0]) * base.euclidean_unit,
        "geodesic_rad": float(data.geodesic[0]),
        "idle_frames": made.idle,
        "note": "; ".join(notes),
    }
    return made, row


def _idle(base: Database, beside: Sign, takes: Mapping[str, Recording]) -> tuple[Recording, int]:
    """Return the idle posture: of corpus.yaml, else where the hands hang lowest in a take."""
    told = base.corpus.settings.get("synthesis", {}).get("idle")
    name = told["recording"] if told else beside.recording.name
    if name not in takes:
        raise SignkinError(
            f"no recording {name!r}",
            file=base.corpus.folder / "corpus.yaml",
            place="key synthesis.idle",
            expected=listed(sorted(takes)),
        )
    take = base.recordings[name]
    return takes[name], take.frame_at(told["time_s"]) if told else idle_frame(take)


def parts_table(utterance: Utterance, corpus: Corpus, name: str) -> pd.DataFrame:
    """Return the table `utterances` of one utterance."""
    parts = utterance.parts.copy()
    parts.insert(0, "utterance", name)
    parts.insert(0, "corpus", corpus.name)
    parts = parts.reindex(columns=tables.TABLES["utterances"].names(corpus.unit))
    texts = ["recording", "method", "duration_model", "note"]
    parts[texts] = parts[texts].fillna("")
    return parts


# --- files -----------------------------------------------------------------------------------


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
    settings: Mapping[str, Any],
    printed: np.ndarray,
    out: Path,
) -> pd.DataFrame:
    """Make and write some utterances (name -> glosses); returns their table `utterances`.

    settings: config.yaml (durations, synthesis). out: folder of the files, which is made.
    """
    chosen = settings["synthesis"]
    out.mkdir(parents=True, exist_ok=True)
    clock = timing(base, chosen["duration"], settings["durations"], printed)
    tables_of = []
    for name, glosses in wanted.items():
        tokens = retrieved(base, list(glosses), chosen["retrieval"])
        names = [base.tokens[t].sign.recording.name for t in tokens]
        idle = corpus.settings.get("synthesis", {}).get("idle")
        takes = None
        if is_bvh(corpus):
            more = [idle["recording"]] if idle and idle["recording"] in base.recordings else []
            takes = whole_takes(corpus, folder, base, [*names, *more], chosen["align_takes"])
        made = make_utterance(base, tokens, clock, chosen, takes)
        write_utterance(made, corpus, folder, names[0], out / name)
        parts = parts_table(made, corpus, name)
        tables.write_table(parts, out / f"{name}_parts.csv", "utterances", corpus.unit)
        tables_of.append(parts)
    if not tables_of:
        return tables.empty("utterances", corpus.unit)
    return pd.concat(tables_of, ignore_index=True)
