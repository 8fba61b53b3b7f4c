"""Two papers, one wrist: boundaries by binning against speed minima and tags.

The boundaries of long series are held against the speed minima of the same hand, the manual
tags and the tags refined to minima (Naert et al. 2017, 4.1, 4.2).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import tables
from signkin.binning.hit_rate import (
    INTERVAL,
    ChanceLine,
    HitRate,
    chance_line,
    group_rates,
    hit_rate,
)
from signkin.binning.shifted import hits_of_shifts
from signkin.corpus import Corpus
from signkin.joints import HANDS
from signkin.seeds import stream

Floats = NDArray[np.float64]

DRAWS = 400  # sets of Poisson events
RATES_PER_S = np.linspace(0, 8, 13)  # of Poisson events, in the line of no discrimination
FOUND = {
    ("boundaries", "manual tags"): "boundaries (binning) → manual tags",
    ("minima", "manual tags"): "speed minima → manual tags",
    ("boundaries", "refined tags"): "boundaries (binning) → refined tags",
    ("boundaries", "minima"): "boundaries (binning) → speed minima",
}


@dataclass(frozen=True, eq=False)
class Events:
    """Times of one kind of event in s, by (recording, hand)."""

    times: Mapping[tuple[str, str], Floats]

    def of(self, recording: str, hand: str) -> Floats:
        """Return those of a hand of a recording, none where there are none."""
        return self.times.get((recording, hand), np.empty(0))


def _events(frame: pd.DataFrame, column: str) -> Events:
    return Events(
        {
            (str(recording), str(hand)): np.sort(rows[column].dropna().to_numpy(dtype=float))
            for (recording, hand), rows in frame.groupby(["recording", "hand"])
        }
    )


def _distinct(events: Events) -> Events:
    """Return each instant once: one sign may end where the next one starts."""
    return Events({key: np.unique(np.round(times, 6)) for key, times in events.times.items()})


def events_of(
    found: pd.DataFrame, minima: pd.DataFrame, tags: pd.DataFrame | None
) -> dict[str, Events]:
    """Return what is found on wrists, by kind. tags: the table `boundaries` of the other study."""
    out = {
        "boundaries": _events(found, "boundary_s"),
        "minima": _events(minima, "minimum_s"),
    }
    if tags is not None:
        out["manual tags"] = _distinct(_events(tags, "manual_s"))
        out["refined tags"] = _distinct(_events(tags, "refined_s"))
    return out


def one_wrist(
    corpus: Corpus, about: pd.DataFrame, posteriors: pd.DataFrame,
    events: Mapping[str, Events], window_s: float, seed: int,
) -> tuple[pd.DataFrame, pd.DataFrame]:  # fmt: skip
    """Return the tables `one_wrist` and `endres_figure` (marks and chance lines to be drawn).

    about: table `recordings`. posteriors: table `wrist_posteriors`, of the wrists binned.
    """
    rows: list[dict[str, Any]] = []
    points: list[dict[str, Any]] = []
    durations = dict(zip(about["recording"], about["duration_s"], strict=True))
    for hand in HANDS:
        names = list(posteriors.loc[posteriors["hand"] == hand, "recording"])
        wrist = _Wrist(hand, names, [durations[name] for name in names])
        for (found, truth), label in FOUND.items():
            if found not in events or truth not in events:
                continue
            rng = stream(seed, corpus.name, "one wrist", hand, found, truth)
            row, line = _compared(wrist, events[found], events[truth], window_s, rng)
            about_row = {"corpus": corpus.name, "hand": hand, "found": found, "truth": truth}
            rows.append({**about_row, "window_s": window_s, **row})
            if line is None:
                continue
            panel = f"{hand} wrist: {truth}"
            mark = {
                "panel": panel, "series": label, "label": "",
                "x": row["false_positives_per_s"], "x_error": row["false_positives_per_s_se"],
                "y": row["hit_rate"], "y_error": row["hit_rate_se"],
            }  # fmt: skip
            # Whatever is held against one truth, chance is the same.
            known = any(point["panel"] == panel for point in points)
            points += [mark] if known else [mark, *_chance_points(panel, line)]
    frame = pd.DataFrame(points, columns=tables.TABLES["endres_figure"].names()[1:])
    frame["label"] = frame["label"].astype(object).fillna("")
    frame.insert(0, "corpus", corpus.name)
    return pd.DataFrame(rows, columns=tables.TABLES["one_wrist"].names()), frame


@dataclass(frozen=True)
class _Wrist:
    """A hand, the recordings in which it was binned, and how long these are in s."""

    hand: str
    recordings: Sequence[str]
    durations_s: Sequence[float]


def _compared(
    wrist: _Wrist, found: Events, truth: Events, window_s: float, rng: np.random.Generator
) -> tuple[dict[str, Any], ChanceLine | None]:
    """Return the outcome of one comparison, and its line of no discrimination.

    The line's last point has the rate of the events found; None where nothing is to be hit.
    """
    founds = [found.of(name, wrist.hand) for name in wrist.recordings]
    truths = [truth.of(name, wrist.hand) for name in wrist.recordings]
    rates: list[HitRate] = [
        hit_rate(times, known, window_s, duration_s=seconds)
        for times, known, seconds in zip(founds, truths, wrist.durations_s, strict=True)
    ]
    n_found = sum(map(len, founds))
    row: dict[str, Any] = {
        "hits": sum(r.hits for r in rates),
        "n_found": n_found,
        "n_truth": sum(map(len, truths)),
        "recordings": len(wrist.recordings),
        "note": "",
    }
    if not row["n_truth"]:
        return {**row, "note": "nothing to be hit"}, None
    mean = group_rates(rates)
    rate = n_found / sum(wrist.durations_s)
    draws = int(np.clip(round(DRAWS * 20 / len(wrist.recordings)), 20, DRAWS))
    line = chance_line(
        truths, wrist.durations_s, rng, np.append(RATES_PER_S, rate), window_s, draws
    )
    row |= {
        "hit_rate": mean.hit_rate,
        "hit_rate_se": mean.hit_rate_se,
        "false_positives_per_s": mean.false_positives_per_s,
        "false_positives_per_s_se": mean.false_positives_per_s_se,
        "chance_hit_rate": line.hit_rate[-1],
        "chance_low": line.hit_rate_low[-1],
        "chance_high": line.hit_rate_high[-1],
        **_shifted(founds, truths, wrist.durations_s, window_s, draws, rng.spawn(1)[0]),
    }
    return row, line


def _shifted(
    founds: Sequence[Floats], truths: Sequence[Floats], durations_s: Sequence[float],
    window_s: float, draws: int, rng: np.random.Generator,
) -> dict[str, float]:  # fmt: skip
    """Return the hit rate of events that keep their gaps, shifted in a circle in each recording."""
    rates = np.mean(
        [
            hits_of_shifts(found, np.sort(truth), window_s, seconds, seconds * rng.random(draws))
            / len(truth)
            for found, truth, seconds in zip(founds, truths, durations_s, strict=True)
            if len(truth)
        ],
        axis=0,
    )
    low, high = np.percentile(rates, INTERVAL)
    return {"shifted_hit_rate": rates.mean(), "shifted_low": low, "shifted_high": high}


def _chance_points(panel: str, line: ChanceLine) -> list[dict[str, Any]]:
    """Return the line of no discrimination as points, without the rate of the events found."""
    curves = {
        "chance": (line.false_positives_per_s, line.hit_rate),
        "chance low": (line.false_positives_per_s, line.hit_rate_low),
        "chance high": (line.false_positives_per_s, line.hit_rate_high),
        "closed form": (line.rate_per_s, line.closed_form),
    }
    return [
        {"panel": panel, "series": series, "x": x, "y": y}
        for series, (across, up) in curves.items()
        for x, y in zip(across[:-1], up[:-1], strict=True)
    ]
