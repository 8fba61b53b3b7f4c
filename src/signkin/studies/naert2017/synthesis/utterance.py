"""An utterance: signs joined by synthetic transitions (Naert et al. 2017, 3.1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from signkin import tables
from signkin.coarticulation.synthesis import (
    Sign,
    Transition,
    fitted,
    idle_frame,
)
from signkin.corpus import Corpus
from signkin.errors import SignkinError, listed
from signkin.recording import Recording
from signkin.settings.sections import Synthesis
from signkin.studies.naert2017.synthesis.database import Database
from signkin.studies.naert2017.synthesis.duration_models import Timing
from signkin.studies.naert2017.synthesis.joining import INTERPOLATION, joined


@dataclass(frozen=True, eq=False)
class Utterance:
    """A synthetic utterance: the motion, and the table of its parts (without corpus and name)."""

    motion: Recording
    parts: pd.DataFrame
    transitions: tuple[Transition, ...]


def make_utterance(
    base: Database,
    tokens: Sequence[int],
    clock: Timing,
    settings: Synthesis,
    takes: Mapping[str, Recording] | None = None,
) -> Utterance:
    """Join the signs of some tokens by synthetic transitions.

    takes: recordings with all joints to make the motion from
    (the file's skeleton); None: the canonical ones, from which distances always come.
    """
    whole = takes or base.recordings
    signs, notes = _on_one_skeleton(base, tokens, whole)
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
    parts = pd.DataFrame(rows)
    parts.insert(0, "part", np.arange(1, len(parts) + 1))
    return Utterance(_motion(signs[0].recording, positions, turns), parts, tuple(made))


def _on_one_skeleton(
    base: Database, tokens: Sequence[int], takes: Mapping[str, Recording]
) -> tuple[list[Sign], list[str]]:
    """Return the signs in the takes given, fitted to the first one's, and what that changed."""
    signs: list[Sign] = []
    notes = []
    for token in tokens:
        sign = base.tokens[token].sign
        sign = replace(sign, recording=takes[sign.recording.name])
        sign, changed = fitted(sign, signs[0].recording) if signs else (sign, ())
        signs.append(sign)
        notes.append("; ".join(changed))
    return signs, notes


def _motion(
    first: Recording, positions: Sequence[np.ndarray], turns: Sequence[np.ndarray | None]
) -> Recording:
    """Return the pieces as one recording like the first; orientations where all have them."""
    kept = [t for t in turns if t is not None]
    whole = len(kept) == len(turns)
    return replace(
        first,
        positions=np.concatenate(positions),
        orientations=np.concatenate(kept) if whole else None,
        orientation_source="recorded" if whole else "none",
    )


def _keeps_turns(recording: Recording) -> bool:
    """Limb frames are made from positions: a mixed motion has none of its own."""
    return recording.orientation_source == "recorded"


def _transition(
    base: Database,
    tokens: Sequence[int],
    signs: Sequence[Sign],
    clock: Timing,
    settings: Synthesis,
    takes: Mapping[str, Recording],
) -> tuple[Transition, dict[str, Any]]:
    data = base.features([tokens[0]], [tokens[1]])
    wanted, note = clock.ask(data)
    rate = signs[0].recording.rate_hz
    notes = [note] if note else []
    if wanted < 1 / rate:
        notes.append(f"{wanted:.3f} s predicted: one frame step made")
        wanted = 1 / rate
    method = settings.method
    idle = None if method == INTERPOLATION else _idle(base, signs[0], takes)
    made = joined(signs, wanted, method, settings, idle)
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
