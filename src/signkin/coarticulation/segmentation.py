"""Refinement of manual tags by speed minima (Naert et al. 2017, section 4.2), and its quality."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.annotation import Interval
from signkin.joints import HANDS

EDGES = ("start", "end")


def refine(
    intervals_s: NDArray[np.float64],
    minima_s: NDArray[np.float64],
    window_s: float = 0.15,
    tolerance_s: float = 1e-6,
) -> tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.float64]]:
    """Move each tag to the nearest speed minimum within the window, else leave it.

    intervals_s: (N, 2) manual starts and ends of signs, seconds. minima_s: (M,) minima of one
    hand. window_s: how far a tag may move (inclusive, with a tolerance for floating point).

    Returns refined times (N, 2), whether each tag moved (N, 2), and the nearest minimum at
    any distance (N, 2; NaN where there is none).

    The paper is silent on tags that compete. Here the order of the tags in time stays as the
    annotator had it, and two tags never end on one minimum, unless they stood at one instant
    to begin with (one boundary then, which moves as one). Among all moves that keep this, the
    one with the least total displacement is taken, where a tag that stays counts as displaced
    by the whole window. Without competition this is the nearest minimum for each tag.
    """
    tags = np.asarray(intervals_s, dtype=float).reshape(-1, 2)
    minima = np.unique(np.asarray(minima_s, dtype=float))
    times, event_of = np.unique(tags.ravel(), return_inverse=True)
    chosen, event_moved = _assign(times, minima, window_s + tolerance_s)
    refined = chosen[event_of].reshape(tags.shape)
    moved = event_moved[event_of].reshape(tags.shape)
    return refined, moved, nearest(tags, minima)


def _assign(
    times: NDArray[np.float64], minima: NDArray[np.float64], reach: float
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Choose a minimum, or staying, for each time: strictly rising, least total displacement."""
    options: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = []
    for time in times:
        near = minima[np.abs(minima - time) <= reach]
        values = np.append(near, time)
        costs = np.append(np.abs(near - time), reach)
        order = np.lexsort((costs, values))  # by value; at one value the cheaper first
        options.append((values[order], costs[order]))
    totals: list[NDArray[np.float64]] = []
    back: list[NDArray[np.int64]] = []
    for k, (values, costs) in enumerate(options):
        if k == 0:
            totals.append(costs)
            back.append(np.full(len(values), -1))
            continue
        earlier = options[k - 1][0]
        total = np.full(len(values), np.inf)
        link = np.full(len(values), -1)
        for j, value in enumerate(values):
            feasible = int(np.searchsorted(earlier, value, side="left"))
            if feasible:
                link[j] = int(np.argmin(totals[-1][:feasible]))
                total[j] = costs[j] + totals[-1][link[j]]
        totals.append(total)
        back.append(link)
    chosen = np.empty(len(times))
    moved = np.zeros(len(times), dtype=bool)
    j = int(np.argmin(totals[-1])) if len(times) else -1
    for k in range(len(times) - 1, -1, -1):
        values, costs = options[k]
        chosen[k] = values[j]
        moved[k] = costs[j] < reach or values[j] != times[k]
        j = int(back[k][j])
    return chosen, moved


def nearest(times: NDArray[np.float64], minima: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the minimum nearest to each time (the earlier of two equally near), NaN if none."""
    if not len(minima):
        return np.full(np.shape(times), np.nan)
    after = np.clip(np.searchsorted(minima, times), 1, max(len(minima) - 1, 1))
    before = minima[after - 1]
    beyond = minima[np.minimum(after, len(minima) - 1)]
    return np.where(np.abs(times - before) <= np.abs(beyond - times), before, beyond)


def boundary_rows(
    signs: Sequence[Interval],
    minima_s: Mapping[str, NDArray[np.float64]],
    window_s: float,
    tolerance_s: float,
) -> pd.DataFrame:
    """Refine the signs of one recording for both hands; one row a tag and hand.

    signs: in order of start. Columns as the table `boundaries` without its lead.
    """
    manual = np.array([(sign.start_s, sign.end_s) for sign in signs]).reshape(-1, 2)
    frames = []
    for hand in HANDS:
        refined, moved, closest = refine(manual, minima_s[hand], window_s, tolerance_s)
        distance = np.abs(closest - manual)
        reachable = distance <= window_s + tolerance_s
        status = np.where(moved, "moved", np.where(reachable, "taken", "far"))
        second = moved & (np.abs(refined - closest) > tolerance_s)
        note = np.where(
            second,
            "another tag has the nearest minimum: moved to the next",
            np.where(~moved & reachable, "another tag has the minimum: stays", ""),
        )
        note = np.where(np.isnan(closest), "this hand has no speed minimum", note)
        frames.append(
            pd.DataFrame(
                {
                    "sign": np.repeat(np.arange(1, len(signs) + 1), 2),
                    "gloss": np.repeat([sign.label for sign in signs], 2),
                    "edge": list(EDGES) * len(signs),
                    "manual_s": manual.ravel(),
                    "hand": hand,
                    "minimum_s": closest.ravel(),
                    "refined_s": refined.ravel(),
                    "moved": moved.ravel(),
                    "distance_s": distance.ravel(),
                    "status": status.ravel(),
                    "note": note.ravel(),
                }
            )
        )
    return pd.concat(frames, ignore_index=True)


def chance_distances(
    signs: Sequence[Interval],
    minima_s: NDArray[np.float64],
    rate_hz: float,
    draws: int,
    rng: np.random.Generator,
) -> NDArray[np.float64]:
    """Return distances to the nearest minimum of tags placed at random, (draws, tags).

    As many tags as the annotator placed, uniform over the annotated part of the recording, on
    whole frames: tags and minima stand on frames too, and within a window of a few frames the
    difference counts.
    """
    low = min(sign.start_s for sign in signs)
    high = max(sign.end_s for sign in signs)
    frames = rng.integers(round(low * rate_hz), round(high * rate_hz) + 1, (draws, 2 * len(signs)))
    random_tags = frames / rate_hz
    return np.abs(nearest(random_tags, minima_s) - random_tags)


def refinement_quality(
    boundaries: pd.DataFrame,
    chance: Mapping[tuple[str, str], NDArray[np.float64]],
    window_s: float,
    tolerance_s: float,
) -> pd.DataFrame:
    """Summarise how the tags of a corpus lie to the minima, per hand, against random tags.

    chance: (recording, hand) -> `chance_distances`. Columns as the table `refinement`
    without the corpus.
    """
    rows: list[dict[str, object]] = []
    for hand in HANDS:
        of_hand = boundaries[boundaries["hand"] == hand]
        distance = of_hand["distance_s"].to_numpy(dtype=float)
        pieces = [d for (_, h), d in chance.items() if h == hand]
        random_distance = np.concatenate(pieces, axis=1) if pieces else np.empty((1, 0))
        reach = window_s + tolerance_s
        for measure, unit, statistic in (
            ("tags with a minimum within the window", "share", partial(_share, reach=reach)),
            ("median distance to the nearest minimum", "s", _median),
        ):
            draws = np.array([statistic(row) for row in random_distance])
            rows.append(
                {
                    "hand": hand,
                    "measure": measure,
                    "value": statistic(distance),
                    "unit": unit,
                    **_interval(draws),
                    "n": len(distance),
                    "note": "" if np.isfinite(distance).any() else "no speed minimum",
                }
            )
        rows.append(
            {
                "hand": hand,
                "measure": "tags moved",
                "value": float(of_hand["moved"].mean()) if len(of_hand) else np.nan,
                "unit": "share",
                "n": len(of_hand),
                "note": f"{int((of_hand['status'] == 'taken').sum())} stay because another tag "
                "has their minimum",
            }
        )
    rows += _offset_rows(boundaries)
    columns = [
        "hand",
        "measure",
        "value",
        "unit",
        "chance",
        "chance_low",
        "chance_high",
        "n",
        "note",
    ]
    return pd.DataFrame(rows).reindex(columns=columns)


def _offset_rows(boundaries: pd.DataFrame) -> list[dict[str, object]]:
    """Offset between the hands where both were moved (Naert et al. 2017, Fig. 5)."""
    keys = ["recording", "sign", "edge"]
    moved = boundaries[boundaries["moved"].astype(bool)]
    right, left = (moved[moved["hand"] == hand].set_index(keys)["refined_s"] for hand in HANDS)
    offset = (left - right).dropna().to_numpy(dtype=float)
    note = "" if len(offset) else "no tag was moved for both hands"
    return [
        {"hand": "both", "measure": measure, "value": value, "unit": "s", "n": len(offset),
         "note": note}
        for measure, value in (
            ("median offset between the hands, absolute", _median(np.abs(offset))),
            ("median offset, left after right", _median(offset)),
        )
    ]  # fmt: skip


def _share(distance: NDArray[np.float64], reach: float) -> float:
    return float(np.mean(distance <= reach)) if len(distance) else float("nan")


def _median(values: NDArray[np.float64]) -> float:
    finite = values[np.isfinite(values)]
    return float(np.median(finite)) if len(finite) else float("nan")


def _interval(draws: NDArray[np.float64]) -> dict[str, float]:
    finite = draws[np.isfinite(draws)]
    if not len(finite):
        return {"chance": np.nan, "chance_low": np.nan, "chance_high": np.nan}
    low, high = np.quantile(finite, [0.025, 0.975])
    return {"chance": float(finite.mean()), "chance_low": float(low), "chance_high": float(high)}


def truth_errors(boundaries: pd.DataFrame, truth: pd.DataFrame) -> pd.DataFrame:
    """Join tags with the true boundaries of the same recording, sign, edge and hand.

    Returns recording, sign, edge, hand, manual_error_s, refined_error_s (signed, tag - truth).
    """
    keys = ["recording", "sign", "edge", "hand"]
    both = boundaries.merge(truth[[*keys, "true_s"]], on=keys, validate="one_to_one")
    both["manual_error_s"] = both["manual_s"] - both["true_s"]
    both["refined_error_s"] = both["refined_s"] - both["true_s"]
    return both[[*keys, "manual_error_s", "refined_error_s"]]


def truth_summary(errors: pd.DataFrame, draws: int, rng: np.random.Generator) -> pd.DataFrame:
    """Summarise errors to truth before and after refinement, per hand, with bootstrap intervals."""
    rows = []
    for hand in HANDS:
        of_hand = errors[errors["hand"] == hand]
        if of_hand.empty:
            continue
        resampled = rng.integers(0, len(of_hand), size=(draws, len(of_hand)))
        for segmentation in ("manual", "refined"):
            error = of_hand[f"{segmentation}_error_s"].abs().to_numpy(dtype=float)
            low, high = np.quantile(error[resampled].mean(axis=1), [0.025, 0.975])
            rows.append(
                {
                    "hand": hand,
                    "segmentation": segmentation,
                    "n": len(error),
                    "mean_error_s": error.mean(),
                    "low_s": low,
                    "high_s": high,
                    "median_error_s": np.median(error),
                    "within_20ms": np.mean(error <= 0.02 + 1e-9),
                }
            )
    return pd.DataFrame(rows)
