"""What stands on the time line of a recording: tags, minima, refined tags, transitions, gaps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.joints import HANDS
from signkin.kinematics.gaps import stretches

MS = 1000.0


class Labels:
    """Texts that the page holds once, however often they occur: a gloss may have 200 letters."""

    def __init__(self) -> None:
        """Begin with none."""
        self.texts: dict[str, int] = {}

    def place(self, text: object) -> int:
        """Return the number of a text; what a table has as missing is the empty text."""
        known = "" if pd.isna(text) else str(text)
        return self.texts.setdefault(known, len(self.texts))


def ms(time_s: float) -> int | None:
    """Return a time in whole milliseconds, None for a missing one."""
    return None if not np.isfinite(time_s) else round(float(time_s) * MS)


def lanes(intervals: pd.DataFrame, labels: Labels) -> list[dict[str, Any]]:
    """Return the tags of a recording, a lane a role: sign, utterance, translation.

    intervals: its rows of the table `intervals`. Each tag is [start ms, end ms, label].
    """
    out: list[dict[str, Any]] = []
    for role in dict.fromkeys(intervals["role"]):
        rows = intervals[intervals["role"] == role].sort_values(["start_s", "end_s"], kind="stable")
        columns = zip(rows["start_s"], rows["end_s"], rows["label"], strict=True)
        out.append(
            {"role": str(role), "tags": [[ms(a), ms(b), labels.place(c)] for a, b, c in columns]}
        )
    return out


def refined(boundaries: pd.DataFrame, posteriors: pd.DataFrame) -> Mapping[str, list[Any]]:
    """Return the refined tags of each hand: hand -> [sign, edge, ms, status, off in %].

    boundaries, posteriors: the recording's rows of the tables `boundaries`, `boundary_posteriors`.
    sign counts from 0; edge: 0 start, 1 end; status: its first letter, `m` moved, `f` far, `t`
    taken; off: probability that the boundary is more than 0.1 s from the tag.
    """
    key = ["sign", "edge", "hand"]
    rows = boundaries.assign(off=np.nan)
    if len(posteriors):
        rows = boundaries.merge(posteriors[[*key, "off"]], on=key, how="left")
    out: dict[str, list[Any]] = {}
    for hand in HANDS:
        mine = rows[rows["hand"] == hand]
        columns = zip(mine["sign"], mine["edge"], mine["refined_s"], mine["status"], mine["off"],
                      strict=True)  # fmt: skip
        out[hand] = [
            [int(sign) - 1, int(edge == "end"), ms(at), str(status)[:1], _percent(off)]
            for sign, edge, at, status, off in columns
        ]
    return out


def _percent(share: float) -> int | None:
    return None if not np.isfinite(share) else round(100 * float(share))


def minima(rows: pd.DataFrame) -> Mapping[str, list[int]]:
    """Return the speed minima of each hand, in ms, each as its distance from the one before."""
    out = {}
    for hand in HANDS:
        times = np.sort(rows.loc[rows["hand"] == hand, "minimum_s"].to_numpy(dtype=float))
        out[hand] = np.diff(np.rint(times * MS), prepend=0).astype(int).tolist()
    return out


def transitions(
    rows: pd.DataFrame, outliers: Sequence[int], unit: str, labels: Labels
) -> list[dict[str, Any]]:
    """Return the transitions of a recording, with their durations by each segmentation and hand.

    rows: its part of the table `transitions`. outliers: numbers of those that the outlier rule
    marks in the whole corpus.
    """
    marked = set(outliers)
    refined_ends = {
        (int(number), str(hand)): (ms(a), ms(b))
        for number, hand, a, b in rows.loc[
            rows["segmentation"] == "refined", ["transition", "hand", "start_s", "end_s"]
        ].itertuples(index=False)
    }
    whole = rows[(rows["segmentation"] == "manual") & (rows["hand"] == "both")]
    out: list[dict[str, Any]] = []
    for row in whole.sort_values("start_s").to_dict("records"):
        number = int(row["transition"])
        out.append(
            {
                "number": number,
                "labels": [labels.place(row["previous_gloss"]), labels.place(row["next_gloss"])],
                "type": str(row["type"]),
                "kinematic": row["type_source"] == "kinematic",
                "manual": [ms(row["start_s"]), ms(row["end_s"])],
                "status": str(row["status"]),
                "outlier": number in marked,
                **{hand: refined_ends.get((number, hand)) for hand in HANDS},
                "geodesic": _short(row["geodesic_rad"]),
                "euclidean": _short(row[f"euclidean_{unit}"]),
            }
        )
    return out


def _short(value: float) -> float | None:
    return None if not np.isfinite(value) else float(f"{value:.4g}")


def gaps(kinematics: pd.DataFrame, unit: str) -> Mapping[str, list[Any]]:
    """Return where a wrist has no position: hand -> [first ms, last ms, whether it was filled]."""
    out: dict[str, list[Any]] = {hand: [] for hand in HANDS}
    if not len(kinematics):
        return out
    times = kinematics["time_s"].to_numpy(dtype=float)
    for hand in HANDS:
        if f"{hand}_filled" not in kinematics:
            continue
        filled = kinematics[f"{hand}_filled"].to_numpy(dtype=bool)
        missing: NDArray[np.bool_] = np.isnan(
            kinematics[f"{hand}_wrist_x_{unit}"].to_numpy(dtype=float)
        )
        found = [(a, b, 0) for a, b in stretches(missing)]
        found += [(a, b, 1) for a, b in stretches(filled & ~missing)]
        out[hand] = [[ms(times[a]), ms(times[b - 1]), kind] for a, b, kind in sorted(found)]
    return out


# --- what is to be looked at -----------------------------------------------------------------

OFF_SHARE = 50  # %


def flags(data: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return what should be looked at, in order of time: when, and why.

    data: what the page holds of a recording: `lanes`, `refined`, `transitions`, `gaps`. A flag
    is a tag far from the minima of both hands, or that the posterior puts elsewhere for both; a
    transition that overlaps, has no length or is an outlier; a wrist without position.
    """
    found = [*_tag_flags(data["refined"]), *_transition_flags(data["transitions"])]
    for hand, stretched in data["gaps"].items():
        found += [
            {"at": a, "why": f"{hand} wrist: no position for {(b - a) / MS:.2f} s"}
            for a, b, filled in stretched
            if not filled
        ]
    return sorted(found, key=lambda flag: (flag["at"], flag["why"]))


def _tag_flags(by_hand: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Return the tags that lie at no hand's minimum, by status or posterior."""
    states: dict[tuple[int, int], list[tuple[str, int | None]]] = {}
    times: dict[tuple[int, int], int] = {}
    for rows in by_hand.values():
        for sign, edge, at, status, off in rows:
            states.setdefault((sign, edge), []).append((status, off))
            if status != "m" or (sign, edge) not in times:
                times[sign, edge] = at
    out: list[dict[str, Any]] = []
    for (sign, edge), found in states.items():
        which = f"{'end' if edge else 'start'} of sign {sign + 1}"
        offs = [off for _, off in found if off is not None]
        if all(status == "f" for status, _ in found):
            out.append(
                {"at": times[sign, edge], "why": f"{which}: no speed minimum of either hand near"}
            )
        elif offs and min(offs) >= OFF_SHARE:
            why = f"{which}: more than 0.1 s from its boundary, probability {min(offs)} %"
            out.append({"at": times[sign, edge], "why": why})
    return out


def _transition_flags(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    told = {"overlap": "the signs overlap", "zero_length": "no time between the tags"}
    out: list[dict[str, Any]] = []
    for row in rows:
        number, at = row["number"], row["manual"][0]
        if row["status"] in told:
            out.append({"at": at, "why": f"transition {number}: {told[row['status']]}"})
        if row["outlier"]:
            length = (row["manual"][1] - row["manual"][0]) / MS
            out.append({"at": at, "why": f"transition {number}: an outlier, {length:.2f} s"})
    return out
