"""What durations of transitions become when tags are moved, or uncertain (Naert et al. 2017, 5)."""

from __future__ import annotations

import numpy as np
import pandas as pd
from scipy.stats import norm, spearmanr
from statsmodels.stats.oneway import anova_oneway

from signkin import tables
from signkin.coarticulation import LinearDuration, SurfaceDuration, Transitions
from signkin.errors import SignkinError
from signkin.joints import HANDS
from signkin.seeds import stream

DRAWS = 200
QUANTILES = {"low90_s": 0.05, "low50_s": 0.25, "high50_s": 0.75, "high90_s": 0.95}
MOST_TRIES = 20  # draws of a transition that would end before it starts
LEAST_S = 0.001
KEY = ["recording", "transition"]
NONE = "no transition between tags that all have a posterior"


def posterior_durations(
    corpus: str,
    transitions: pd.DataFrame,
    posteriors: pd.DataFrame,
    unit: str,
    euclidean_unit_m: float,
    seed: int,
) -> pd.DataFrame:
    """Return the table `posterior_durations`: measures of transitions, by hand.

    transitions, posteriors: tables `transitions` and `boundary_posteriors`. Boundaries are drawn
    from the quantiles of their posteriors, each by itself, and again where a transition would end
    before it starts. Distances stay those at the manual tags, so that what changes is the
    durations' doing. unit: of distances, m or px; metres are counted in euclidean_unit_m.
    """
    parts = []
    for hand in HANDS:
        rows = _of_hand(transitions, posteriors, hand)
        if rows.empty:
            parts.append(pd.DataFrame([{"hand": hand, "measure": "transitions", "note": NONE}]))
            continue
        scale = euclidean_unit_m if unit == "m" else 1.0
        rows["euclidean"] = rows[f"euclidean_{unit}"].to_numpy(dtype=float) / scale
        rng = stream(seed, corpus, hand, "posterior_durations")
        drawn = [_measures(rows, seconds) for seconds in _drawn(rows, rng)]
        manual = _measures(rows, rows["duration_s_manual"].to_numpy(dtype=float))
        refined = _measures(rows, rows["duration_s_refined"].to_numpy(dtype=float))
        for (name, of_unit), value in manual.items():
            values = np.array([d[name, of_unit] for d in drawn])
            there = values[np.isfinite(values)]
            low, high = np.quantile(there, [0.025, 0.975]) if len(there) else (np.nan, np.nan)
            mean = there.mean() if len(there) else np.nan
            parts.append(
                pd.DataFrame(
                    {
                        "hand": hand, "measure": name, "unit": of_unit, "manual": value,
                        "refined": refined[name, of_unit], "posterior": mean, "low": low,
                        "high": high, "n": len(rows), "note": "",
                    },
                    index=[0],
                )
            )  # fmt: skip
    names = tables.TABLES["posterior_durations"].names()
    return pd.concat(parts, ignore_index=True).assign(corpus=corpus).reindex(columns=names)


def _of_hand(transitions: pd.DataFrame, posteriors: pd.DataFrame, hand: str) -> pd.DataFrame:
    """Return transitions with durations of both segmentations, and quantiles of both ends."""
    own = transitions[(transitions["hand"] == hand) & (transitions["status"] == "ok")]
    manual, refined = (own[own["segmentation"] == kind] for kind in ("manual", "refined"))
    rows = manual.merge(refined[[*KEY, "duration_s"]], on=KEY, suffixes=("_manual", "_refined"))
    of_hand = posteriors[posteriors["hand"] == hand]
    for edge, at in (("end", "start_s"), ("start", "end_s")):  # a transition starts at an end
        tags = of_hand[of_hand["edge"] == edge].assign(at=lambda x: x["manual_s"].round(6))
        tags = tags.drop_duplicates(["recording", "at"])
        columns = {name: f"{edge}_{name}" for name in QUANTILES}
        tags = tags[["recording", "at", *QUANTILES]].rename(columns=columns)
        rows = rows.assign(at=rows[at].round(6)).merge(tags, on=["recording", "at"])
    return rows.dropna(subset=[f"{e}_{q}" for e in ("start", "end") for q in QUANTILES])


def _drawn(rows: pd.DataFrame, rng: np.random.Generator) -> np.ndarray:
    """Return durations of DRAWS sets of boundaries, (DRAWS, N)."""
    ends = {
        edge: rows[[f"{edge}_{name}" for name in QUANTILES]].to_numpy(dtype=float)
        for edge in ("end", "start")
    }
    out = np.full((DRAWS, len(rows)), -1.0)
    for _ in range(MOST_TRIES):
        again = out <= 0
        if not again.any():
            break
        times = {edge: _by_quantiles(q, rng.uniform(size=out.shape)) for edge, q in ends.items()}
        out[again] = (times["start"] - times["end"])[again]
    return np.maximum(out, LEAST_S)


def _by_quantiles(quantiles: np.ndarray, level: np.ndarray) -> np.ndarray:
    """Return values (D, N) at levels, by quantiles (N, 4) that are joined in normal scores."""
    at = norm.ppf(list(QUANTILES.values()))
    z = norm.ppf(level)
    k = np.clip(np.searchsorted(at, z) - 1, 0, len(at) - 2)  # outside, the last slope goes on
    column = np.arange(quantiles.shape[0])
    low, high = quantiles[column, k], quantiles[column, k + 1]
    return np.asarray(low + (high - low) * (z - at[k]) / (at[k + 1] - at[k]))


def _measures(rows: pd.DataFrame, seconds: np.ndarray) -> dict[tuple[str, str], float]:
    """Return what is told of durations in s, (N,): means, tests and models."""
    out = {
        ("mean duration", "s"): float(seconds.mean()),
        ("SD of durations", "s"): float(seconds.std(ddof=1)) if len(seconds) > 1 else np.nan,
        ("median duration", "s"): float(np.median(seconds)),
    }
    p, squared = _types(rows["type"].astype(str).to_numpy(), seconds)
    out["types differ: Welch's ANOVA, p", ""] = p
    out["types differ: share of variance (eta squared)", ""] = squared
    euclidean = rows["euclidean"].to_numpy(dtype=float)
    geodesic = rows["geodesic_rad"].to_numpy(dtype=float)
    there = np.isfinite(euclidean)
    rho = spearmanr(euclidean[there], seconds[there]).statistic if there.sum() > 3 else np.nan
    out["duration and Euclidean distance: Spearman's rho", ""] = float(rho)
    out["LINEAR, mean absolute error in sample", "s"] = _error(
        LinearDuration(), geodesic, euclidean, seconds
    )
    out["SURFACE, mean absolute error in sample", "s"] = _error(
        SurfaceDuration(), geodesic, euclidean, seconds
    )
    return out


def _types(types: np.ndarray, seconds: np.ndarray) -> tuple[float, float]:
    """Return Welch's p and eta squared of the types that have two transitions or more."""
    groups = [seconds[types == name] for name in np.unique(types[types != ""])]
    groups = [g for g in groups if len(g) > 1 and g.std() > 0]
    if len(groups) < 2:
        return np.nan, np.nan
    every = np.concatenate(groups)
    between = sum(len(g) * (g.mean() - every.mean()) ** 2 for g in groups)
    p = anova_oneway(groups, use_var="unequal", welch_correction=True).pvalue
    return float(p), float(between / ((every - every.mean()) ** 2).sum())


def _error(
    model: LinearDuration | SurfaceDuration,
    geodesic: np.ndarray,
    euclidean: np.ndarray,
    seconds: np.ndarray,
) -> float:
    there = np.isfinite(euclidean)
    if isinstance(model, SurfaceDuration) or np.isfinite(geodesic).any():
        there &= np.isfinite(geodesic)
    data = Transitions(geodesic[there], euclidean[there], seconds[there])
    try:
        return float(np.mean(np.abs(model.fit(data).predict(data) - seconds[there])))
    except SignkinError:  # no geodesic distance, or too few transitions
        return np.nan
