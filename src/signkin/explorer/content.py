"""The content of a page: everything that is shown of one recording, and what is missing of it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from signkin.errors import SignkinError
from signkin.explorer import curves, events
from signkin.explorer.densities import series_densities
from signkin.explorer.skeleton import skeleton
from signkin.explorer.sources import Sources
from signkin.explorer.syntheses import syntheses
from signkin.joints import HANDS
from signkin.recording import Recording
from signkin.studies.endres2013.single_signs import movement_of
from signkin.studies.naert2017.synthesis.database import database

MOST_BYTES = 4_900_000  # of a page
FRAME_BYTES = 160_000  # the page without its content
SKELETON_BYTES = 3_200_000
SYNTHESES_BYTES = 1_300_000
LEAST_SKELETON_BYTES = 200_000


def content(
    sources: Sources, recording: Recording, kinematics: pd.DataFrame, posteriors: pd.DataFrame
) -> dict[str, Any]:
    """Return what the page of a recording holds, ready for JSON.

    kinematics: the recording's frames, none for one whose wrists cannot be used. posteriors: its
    rows of posteriors.parquet (recorded trajectory), none for one that is not of one sign.
    """
    corpus, name, unit = sources.corpus, recording.name, recording.unit
    labels = events.Labels()
    entry = corpus.by_name[name]
    intervals = sources.of("intervals", name)
    data: dict[str, Any] = {
        "corpus": corpus.name,
        "recording": name,
        "signer": entry.signer,
        "sign": entry.sign,
        "simulated": corpus.simulator is not None,
        "unit": unit,
        "rate": recording.rate_hz,
        "frames": recording.frames,
        "duration": recording.duration_s,
        "lanes": events.lanes(intervals, labels),
        "refined": events.refined(
            sources.of("boundaries", name), sources.of("boundary_posteriors", name)
        ),
        "minima": events.minima(sources.of("minima", name)),
        "transitions": events.transitions(
            sources.of("transitions", name), sources.outliers.get(name, []), unit, labels
        ),
        "gaps": events.gaps(kinematics, unit),
        "speeds": curves.speeds(kinematics, recording.rate_hz, unit) if len(kinematics) else None,
        "boundaries": curves.series_boundaries(
            sources.of("wrist_boundaries", name), sources.of("wrist_posteriors", name)
        ),
        "densities": _densities(sources, recording, posteriors),
    }
    data["flags"] = events.flags(data)
    data["transitions"] = _rows(data["transitions"])
    data["labels"] = list(labels.texts)
    data["troubles"] = _troubles(sources, name)
    room = MOST_BYTES - FRAME_BYTES - len(as_json(data))
    kept = SYNTHESES_BYTES if len(sources.of("synthesis", name)) else 0
    data["skeleton"] = _skeleton(recording, room - kept)
    data["syntheses"] = _syntheses(sources, recording, data["skeleton"])
    if kept and not data["syntheses"]["methods"]:  # what was kept for them is the skeleton's
        data["skeleton"] = _skeleton(recording, room)
    data["missing"] = _missing(sources, recording, data)
    return data


def as_json(data: Mapping[str, Any]) -> str:
    """Return the content as JSON that may stand in a page: no letter of it closes a tag."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _skeleton(recording: Recording, room: int) -> Mapping[str, Any]:
    return skeleton(recording, min(SKELETON_BYTES, max(room, LEAST_SKELETON_BYTES)))


def _densities(sources: Sources, recording: Recording, rows: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the boundary densities of a recording, in its own time.

    rows: its posteriors, of a recording of one sign.
    """
    if not len(rows):
        hands = list(sources.of("wrist_posteriors", recording.name)["hand"])
        return series_densities(sources.corpus, recording, hands, sources.settings.densities)
    movement = movement_of(recording, sources.settings.cut)
    start = movement.active.start / recording.rate_hz
    found = curves.single_sign_densities(rows)
    for one in found:
        one["first"] = float(f"{one['first'] + start:.9g}")
        if one["times"]:
            one["times"][0] += round(1000 * start)
    return found


def _syntheses(
    sources: Sources, recording: Recording, body: Mapping[str, Any]
) -> Mapping[str, Any] | None:
    table = sources.of("synthesis", recording.name)
    if not len(table):
        return None
    try:
        base = database(
            sources.corpus,
            [recording],
            sources.of("intervals", recording.name),
            sources.settings.synthesis,
        )
        return syntheses(
            base,
            table,
            sources.settings.synthesis,
            body["joints"],
            body["positions"]["step"],
            SYNTHESES_BYTES,
        )
    except SignkinError as error:
        return {"methods": {}, "told": str(error)}


def _rows(dictionaries: Sequence[Mapping[str, Any]]) -> Mapping[str, Any]:
    """Return dictionaries of the same keys with each key once: there may be thousands of them."""
    fields = list(dictionaries[0]) if dictionaries else []
    return {"fields": fields, "rows": [list(row.values()) for row in dictionaries]}


def _troubles(sources: Sources, name: str) -> list[str]:
    """Return what concerns the whole recording: left out, implausible, tags that were not read."""
    out = [
        f"Left out of the analyses: {reason}" for reason in sources.of("excluded", name)["reason"]
    ]
    rows = sources.of("plausibility", name)
    for row in rows[rows["verdict"] == "implausible"].to_dict("records"):
        out.append(
            f"Implausible: {row['check']} is {row['value']:.3g} {row['unit']}, plausible "
            f"{row['low']:g} to {row['high']:g}."
        )
    for row in sources.of("recordings", name).to_dict("records"):
        out += [f"Tags: {row['tags_note']}."] if row["tags_note"] else []
        out += [f"Reading: {note}." for note in str(row["notes"]).split(" | ") if note]
    return out


def _missing(sources: Sources, recording: Recording, data: Mapping[str, Any]) -> list[str]:
    """Return what the page does not show, and why."""
    out: list[str] = []
    if data["speeds"] is None:
        out.append("No speed: the wrists of this recording cannot be used.")
    else:
        shown = data["speeds"]["hands"]
        out += [f"No {hand} wrist in this recording." for hand in HANDS if hand not in shown]
        out += [f"The {hand} wrist has no position." for hand in shown if _unseen(recording, hand)]
        if not data["speeds"]["whole"]:
            out.append(f"Speed is drawn at {data['speeds']['rate']:.3g} Hz, for the length of it.")
    if not data["lanes"]:
        out.append("No tags: minima and binning are all that divides this recording.")
    elif not data["transitions"]["rows"]:
        out.append("No transition: no two signs of this recording belong to one utterance.")
    elif not (data["syntheses"] or {}).get("methods"):
        out.append("No transition of this recording was synthesised.")
    if not data["densities"] and not data["boundaries"]:
        out.append("No boundaries by binning for this recording.")
    elif len({one["order"] for one in data["densities"]}) == 1:
        out.append("The density of boundaries is of one order, for the length of the recording.")
    body = data["skeleton"]
    if body["flat"]:
        out.append("Flat (2-D) recording: seen from in front only.")
    if body["handsOnly"]:
        out.append("Few joints: points with their ways instead of a skeleton.")
    if body["told"] or body["rate"] < min(12.0, recording.rate_hz):
        out.append(
            f"Skeleton at {body['rate']:.3g} frames a second"
            f"{', ' + body['told'] if body['told'] else ''}."
        )
    told = (data["syntheses"] or {}).get("told")
    return [*out, *([f"Synthesis: {told}."] if told else [])]


def _unseen(recording: Recording, hand: str) -> bool:
    joint = f"{hand}_wrist"
    return joint in recording.joints and bool(np.isnan(recording.track(joint)).all())
