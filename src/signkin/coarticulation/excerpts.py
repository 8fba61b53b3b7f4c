"""Excerpts for the speed figures (Naert et al. 2017, Fig. 4-6), chosen by rule.

The paper shows sequences of two or three signs. Here each figure takes three
consecutive signs of one utterance, by a rule that its caption states; a corpus may
name its own excerpts in corpus.yaml.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

SIGNS_SHOWN = 3
MARGIN_S = 0.35

RULES = {
    "fig04": "three consecutive signs whose tags lie as near to speed minima as is usual in the "
    "corpus (median distance)",
    "fig05": "the three consecutive signs with the largest mean offset between the two hands' "
    "minima",
    "fig06": "three consecutive signs of which at least one tag stays, since no minimum is near "
    "enough, and most move",
    "corpus": "chosen in corpus.yaml",
}


@dataclass(frozen=True)
class Excerpt:
    """A stretch of one recording and why it is shown."""

    recording: str
    from_s: float
    to_s: float
    rule: str


def choose_excerpts(
    boundaries: pd.DataFrame, sign_utterances: pd.DataFrame, named: Mapping[str, Any]
) -> dict[str, Excerpt]:
    """Return an excerpt for fig04, fig05 and fig06.

    boundaries: the table `boundaries` of a corpus. sign_utterances: recording, sign, utterance.
    named: the corpus's own choice, `fig04: {recording, from_s, to_s}`.
    """
    runs = _runs(boundaries, sign_utterances)
    out: dict[str, Excerpt] = {}
    for figure in ("fig04", "fig05", "fig06"):
        if figure in named:
            chosen = named[figure]
            out[figure] = Excerpt(chosen["recording"], chosen["from_s"], chosen["to_s"], "corpus")
        elif runs:
            run = _CHOICES[figure](runs, {e.from_s for e in out.values()})
            out[figure] = Excerpt(run.recording, run.from_s, run.to_s, figure)
    return out


@dataclass(frozen=True)
class _Run:
    recording: str
    from_s: float
    to_s: float
    distance: float
    offset: float
    stays: int
    moves: int


def _runs(boundaries: pd.DataFrame, sign_utterances: pd.DataFrame) -> list[_Run]:
    utterance = sign_utterances.set_index(["recording", "sign"])["utterance"].to_dict()
    runs = []
    for recording, rows in boundaries.groupby("recording", sort=True):
        last = int(rows["sign"].max())
        shown = min(SIGNS_SHOWN, last)
        by_sign = {int(sign): group for sign, group in rows.groupby("sign")}
        for first in range(1, last - shown + 2):
            signs = range(first, first + shown)
            names = {utterance.get((recording, sign), "") for sign in signs}
            if len(names) == 1 and "" not in names:
                runs.append(_run(str(recording), pd.concat([by_sign[sign] for sign in signs])))
    return runs


def _run(recording: str, rows: pd.DataFrame) -> _Run:
    times = rows.pivot(index=["sign", "edge"], columns="hand", values="refined_s")
    moved = rows.pivot(index=["sign", "edge"], columns="hand", values="moved").astype(bool)
    offset = (times["left"] - times["right"]).abs()[moved.all(axis=1)]
    return _Run(
        recording=recording,
        from_s=max(0.0, float(rows["manual_s"].min()) - MARGIN_S),
        to_s=float(rows["manual_s"].max()) + MARGIN_S,
        distance=float(rows["distance_s"].mean()),
        # Offsets are compared where most tags have one; a single far pair is no example.
        offset=float(offset.mean()) if len(offset) >= len(moved) - 1 else -1.0,
        stays=int((rows["status"] == "far").sum()),
        moves=int(rows["moved"].sum()),
    )


def _usual(runs: list[_Run], taken: set[float]) -> _Run:
    known = [run for run in runs if np.isfinite(run.distance)] or runs
    middle = float(np.median([run.distance for run in known]))
    return min(known, key=lambda run: (abs(run.distance - middle), run.recording, run.from_s))


def _offset(runs: list[_Run], taken: set[float]) -> _Run:
    free = [run for run in runs if run.from_s not in taken] or runs
    return min(free, key=lambda run: (-run.offset, run.recording, run.from_s))


def _mixed(runs: list[_Run], taken: set[float]) -> _Run:
    free = [run for run in runs if run.from_s not in taken] or runs
    mixed = [run for run in free if run.stays and run.moves > run.stays] or free
    return min(mixed, key=lambda run: (abs(run.stays - 2), run.recording, run.from_s))


_CHOICES = {"fig04": _usual, "fig05": _offset, "fig06": _mixed}


def excerpt_points(
    excerpt: Excerpt,
    speeds: pd.DataFrame,
    boundaries: pd.DataFrame,
    minima: pd.DataFrame,
    speed_column: str,
) -> pd.DataFrame:
    """Return what a speed figure draws, one row a point (table `excerpt` without the corpus).

    speeds: time_s, right, left of the recording. boundaries, minima: tables of the corpus.
    """
    inside = (speeds["time_s"] >= excerpt.from_s) & (speeds["time_s"] <= excerpt.to_s)
    parts = [
        pd.DataFrame(
            {"kind": "speed", "hand": hand, "edge": "", "gloss": "",
             "time_s": speeds.loc[inside, "time_s"], speed_column: speeds.loc[inside, hand]}
        )
        for hand in ("right", "left")
    ]  # fmt: skip
    tags = boundaries[boundaries["recording"] == excerpt.recording]
    manual = tags[tags["hand"] == "right"].rename(columns={"manual_s": "time_s"})
    parts.append(manual.assign(kind="tag", hand="both", status=""))
    low = minima[minima["recording"] == excerpt.recording]
    parts.append(low.rename(columns={"minimum_s": "time_s"}).assign(kind="minimum"))
    parts.append(tags.rename(columns={"refined_s": "time_s"}).assign(kind="refined"))
    columns = ["kind", "hand", "edge", "gloss", "status", "time_s", speed_column]
    points = pd.concat([part.reindex(columns=columns) for part in parts], ignore_index=True)
    texts = ["edge", "gloss", "status"]
    points[texts] = points[texts].fillna("")
    seen = (points["time_s"] >= excerpt.from_s) & (points["time_s"] <= excerpt.to_s)
    points = points[seen].reset_index(drop=True)
    points.insert(0, "recording", excerpt.recording)
    return points
