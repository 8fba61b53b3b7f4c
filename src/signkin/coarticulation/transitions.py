"""Transitions between consecutive signs (Naert et al. 2017, section 5.1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.annotation import Interval
from signkin.coarticulation.posture import euclidean_distance, geodesic_distance, normalised
from signkin.joints import HANDS, arm_joints
from signkin.recording import Recording

# Durations are differences of times in seconds: below this they are one instant.
SAME_INSTANT_S = 1e-9


def utterance_names(
    signs: Sequence[Interval],
    utterances: Sequence[Interval] | None = None,
    gap_s: float | None = None,
) -> list[str]:
    """Return the utterance of each sign, named `1`, `2`, ... in order; '' for none.

    utterances: intervals of the utterance tier; a sign belongs to the one that holds its middle.
    gap_s: without a tier, a pause longer than this ends an utterance. With neither, the whole
    recording is one utterance.
    """
    if utterances is not None:
        names = []
        for sign in signs:
            middle = (sign.start_s + sign.end_s) / 2
            inside = [i for i, u in enumerate(utterances, 1) if u.start_s <= middle < u.end_s]
            names.append(str(inside[0]) if inside else "")
        return names
    count, latest, names = 1, -np.inf, []
    for sign in signs:
        if gap_s is not None and names and sign.start_s - latest > gap_s + SAME_INSTANT_S:
            count += 1
        latest = max(latest, sign.end_s)
        names.append(str(count))
    return names


def transition_rows(
    recording: Recording,
    orientations: NDArray[np.float64] | None,
    signs: Sequence[Interval],
    utterances: Sequence[str],
    sign_types: pd.DataFrame,
    refined: Mapping[str, NDArray[np.float64]],
) -> pd.DataFrame:
    """Return the transitions of one recording, for every segmentation and hand.

    recording: with short gaps filled. orientations: (F, J, 4) in the frame that distances are
    taken in, or None. sign_types: a row a sign. refined: hand -> (N, 2) refined tags.
    The manual segmentation has one row for the whole body and one for each arm; the refined
    one has one for each hand. Columns as the table `transitions` without its lead and without
    the normalised distances, which want the whole corpus.
    """
    manual = np.array([(sign.start_s, sign.end_s) for sign in signs]).reshape(-1, 2)
    everything = list(recording.joints)
    arms = {hand: arm_joints(recording.joints, hand) for hand in HANDS}
    parts = [("manual", "both", manual, everything)]
    parts += [("manual", hand, manual, arms[hand]) for hand in HANDS]
    parts += [("refined", hand, refined[hand], arms[hand]) for hand in HANDS]
    pairs = [
        i for i in range(len(signs) - 1) if utterances[i] and utterances[i] == utterances[i + 1]
    ]
    rows = []
    for segmentation, hand, times, joints in parts:
        chosen = [recording.index(joint) for joint in joints]
        for number, i in enumerate(pairs, start=1):
            start, end = float(times[i, 1]), float(times[i + 1, 0])
            digits = [str(sign_types["type"].iloc[k]) for k in (i, i + 1)]
            sources = [str(sign_types["type_source"].iloc[k]) for k in (i, i + 1)]
            rows.append(
                {
                    "transition": number,
                    "previous_gloss": signs[i].label,
                    "next_gloss": signs[i + 1].label,
                    "type": "".join(digits) if all(digits) else "",
                    "type_source": "kinematic" if "kinematic" in sources else "lexicon",
                    "hand": hand,
                    "segmentation": segmentation,
                    "utterance": utterances[i],
                    "start_s": start,
                    "end_s": end,
                    "duration_s": round(end - start, 9),
                    "status": _status(end - start),
                    **_distances(recording, orientations, start, end, chosen),
                }
            )
    unit = recording.unit
    columns = ["transition", "previous_gloss", "next_gloss", "type", "type_source", "hand",
               "segmentation", "utterance", "start_s", "end_s", "duration_s", "status",
               "geodesic_rad", f"euclidean_{unit}", "n_joints"]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


def _status(duration_s: float) -> str:
    if abs(duration_s) <= SAME_INSTANT_S:
        return "zero_length"
    return "overlap" if duration_s < 0 else "ok"


def _distances(
    recording: Recording,
    orientations: NDArray[np.float64] | None,
    start_s: float,
    end_s: float,
    joints: list[int],
) -> dict[str, float]:
    first, second = recording.frame_at(start_s), recording.frame_at(end_s)
    p1, p2 = recording.positions[first, joints], recording.positions[second, joints]
    geodesic = float("nan")
    if orientations is not None:
        geodesic = float(
            geodesic_distance(orientations[first, joints], orientations[second, joints])
        )
    return {
        "geodesic_rad": geodesic,
        f"euclidean_{recording.unit}": float(euclidean_distance(p1, p2)),
        "n_joints": int((~np.isnan(p1 + p2).any(axis=1)).sum()),
    }


def with_normalised(transitions: pd.DataFrame, unit: str) -> pd.DataFrame:
    """Add normalised distances and their mean, within each segmentation and hand of a corpus.

    Overlapping signs have no transition between them: they are left out of the mean and the
    range, and have no normalised distance; their note says so.
    """
    out = transitions.copy()
    for column in ("geodesic_norm", "euclidean_norm", "mean_distance"):
        out[column] = np.nan
    counted = out["status"] != "overlap"
    for _, group in out[counted].groupby(["segmentation", "hand"], sort=False):
        geodesic = normalised(group["geodesic_rad"].to_numpy(dtype=float))
        euclidean = normalised(group[f"euclidean_{unit}"].to_numpy(dtype=float))
        both = np.stack([geodesic, euclidean])
        there = ~np.isnan(both)
        mean = np.where(there, both, 0).sum(axis=0) / np.maximum(there.sum(axis=0), 1)
        out.loc[group.index, "geodesic_norm"] = geodesic
        out.loc[group.index, "euclidean_norm"] = euclidean
        out.loc[group.index, "mean_distance"] = np.where(there.any(axis=0), mean, np.nan)
    no_geodesic = "no orientations: the mean distance is the Euclidean one"
    no_distance = "gaps in the motion: no distance"
    out["note"] = np.select(
        [
            ~counted,
            out["mean_distance"].isna(),
            out["geodesic_norm"].isna(),
        ],
        ["signs overlap: no transition between them", no_distance, no_geodesic],
        default="",
    )
    return out
