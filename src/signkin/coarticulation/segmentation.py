"""Refinement of manual tags by speed minima (Naert et al. 2017, section 4.2), and its quality."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import pandas as pd
import scipy  # loads scipy.stats when it is used: it takes as long to import as numba
from numpy.typing import NDArray

from signkin.annotation import Interval
from signkin.errors import SignkinError
from signkin.joints import HANDS
from signkin.masked import unmasked

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
    by the whole window. Without competition this is the nearest minimum for each tag, which is
    what `refine_each` does throughout.

    A tag without a time (NaN, masked) stays without one and never counts as moved. Raises
    SignkinError for a minimum without a time, and for a window that is no length.
    """
    tags, minima = _checked(intervals_s, minima_s, window_s)
    refined, moved = tags.copy(), np.zeros(tags.shape, dtype=bool)
    there = np.isfinite(tags)
    times, event_of = np.unique(tags[there], return_inverse=True)
    chosen, event_moved = _assign(times, minima, window_s + tolerance_s)
    refined[there], moved[there] = chosen[event_of], event_moved[event_of]
    return refined, moved, nearest(tags, minima)


def refine_each(
    intervals_s: NDArray[np.float64],
    minima_s: NDArray[np.float64],
    window_s: float = 0.15,
    tolerance_s: float = 1e-6,
) -> tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.float64]]:
    """Move each tag to its nearest minimum within the window, whatever the other tags do.

    The paper's rule taken as it stands (4.2): two tags may end on one minimum, and an end may
    come after the next start. Arguments and results as `refine`.
    """
    tags, minima = _checked(intervals_s, minima_s, window_s)
    closest = nearest(tags, minima)
    moved = np.abs(closest - tags) <= window_s + tolerance_s  # NaN is no distance
    return np.where(moved, closest, tags), moved, closest


def _checked(
    intervals_s: NDArray[np.float64], minima_s: NDArray[np.float64], window_s: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return tags (N, 2), NaN where masked, and the minima in order."""
    tags, minima = unmasked(intervals_s).reshape(-1, 2), unmasked(minima_s).ravel()
    lost = int((~np.isfinite(minima)).sum())
    if lost:
        raise SignkinError(
            f"{lost} of {len(minima)} minima have no time",
            place="refinement",
            expected="times in seconds",
            todo="Leave minima without a time out.",
        )
    if not (np.isfinite(window_s) and window_s >= 0):
        raise SignkinError(
            f"the window is {window_s:g} s", place="refinement", expected="0 or more"
        )
    return tags, np.unique(minima)


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
    """Return the minimum nearest to each time (the earlier of two equally near).

    minima: (M,), rising. NaN where there is no minimum, and for a time that is NaN.
    """
    if not len(minima):
        return np.full(np.shape(times), np.nan)
    after = np.clip(np.searchsorted(minima, times), 1, max(len(minima) - 1, 1))
    before = minima[after - 1]
    beyond = minima[np.minimum(after, len(minima) - 1)]
    closest = np.where(np.abs(times - before) <= np.abs(beyond - times), before, beyond)
    return np.where(np.isnan(times), np.nan, closest)


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
        plain, _, _ = refine_each(manual, minima_s[hand], window_s, tolerance_s)
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
                    "plain_s": plain.ravel(),
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
    without the corpus. low, high: 95 % interval of the value, tags taken as independent (the
    exact binomial one of a share; order statistics for a median).
    """
    rows: list[dict[str, object]] = []
    for hand in HANDS:
        of_hand = boundaries[boundaries["hand"] == hand]
        distance = of_hand["distance_s"].to_numpy(dtype=float)
        pieces = [d for (_, h), d in chance.items() if h == hand]
        random_distance = np.concatenate(pieces, axis=1) if pieces else np.empty((1, 0))
        reach = window_s + tolerance_s
        for measure, unit, statistic, interval in (
            ("tags with a minimum within the window", "share", partial(_share, reach=reach),
             partial(_share_interval, reach=reach)),
            ("median distance to the nearest minimum", "s", _median, _median_interval),
        ):  # fmt: skip
            draws = np.array([statistic(row) for row in random_distance])
            rows.append(
                {
                    "hand": hand,
                    "measure": measure,
                    "value": statistic(distance),
                    **interval(distance),
                    "unit": unit,
                    **_interval(draws),
                    "n": len(distance),
                    "note": "" if np.isfinite(distance).any() else "no speed minimum",
                }
            )
        # The plain rule moves a tag exactly where a minimum is in the window.
        inside = np.array([_share(row, reach) for row in random_distance])
        rows += _moved_rows(hand, of_hand, inside, tolerance_s)
    rows += _offset_rows(boundaries)
    columns = [
        "hand",
        "measure",
        "value",
        "low",
        "high",
        "unit",
        "chance",
        "chance_low",
        "chance_high",
        "n",
        "note",
    ]
    return pd.DataFrame(rows).reindex(columns=columns)


def _moved_rows(
    hand: str, tags: pd.DataFrame, chance: NDArray[np.float64], tolerance_s: float
) -> list[dict[str, object]]:
    """Return how many tags were moved, and how many the paper's plain rule puts elsewhere."""
    moved = tags["moved"].to_numpy(dtype=bool)
    refined, plain, closest = (
        tags[column].to_numpy(dtype=float) for column in ("refined_s", "plain_s", "minimum_s")
    )
    other = np.abs(refined - plain) > tolerance_s
    second = moved & (np.abs(refined - closest) > tolerance_s)
    stay = int((tags["status"] == "taken").sum())
    rows: list[dict[str, object]] = [
        {"hand": hand, "measure": "tags moved", **_interval(chance),
         "note": f"{stay} stay because another tag has their minimum; chance: random tags with a "
         "minimum in the window"},
        {"hand": hand, "measure": "tags that the paper's plain rule puts elsewhere",
         "note": f"{int(other.sum())} of {len(tags)} tags; plain: each to its nearest minimum, "
         "whatever the others do"},
        {"hand": hand, "measure": "tags moved to a minimum that is not the nearest",
         "note": f"{int(second.sum())} of {len(tags)} tags: another tag has their nearest"},
    ]  # fmt: skip
    for row, held in zip(rows, (moved, other, second), strict=True):
        row |= {"value": float(held.mean()) if len(held) else np.nan, "unit": "share"}
        row |= {**_binomial(int(held.sum()), len(held)), "n": len(held)}
    return rows


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


def _share_interval(distance: NDArray[np.float64], reach: float) -> dict[str, float]:
    return _binomial(int((distance <= reach).sum()), len(distance))


def _binomial(k: int, n: int) -> dict[str, float]:
    if not n:
        return {"low": np.nan, "high": np.nan}
    found = scipy.stats.binomtest(k, n).proportion_ci(0.95, method="exact")
    return {"low": float(found.low), "high": float(found.high)}


def _median_interval(values: NDArray[np.float64]) -> dict[str, float]:
    """Return the interval of the median between two order statistics, 95 % or more."""
    finite = np.sort(values[np.isfinite(values)])
    below = int(scipy.stats.binom.ppf(0.025, len(finite), 0.5)) if len(finite) > 5 else 0
    if below < 1:
        return {"low": np.nan, "high": np.nan}
    return {"low": float(finite[below - 1]), "high": float(finite[len(finite) - below])}


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
