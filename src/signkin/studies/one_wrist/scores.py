"""Every way of finding boundaries on a hand, scored against the manual tags of a corpus."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd

from signkin import tables
from signkin.joints import HANDS
from signkin.seeds import stream
from signkin.segments import Part, score_methods

DRAWS = 50
MINIMA = "speed minima"
REFINED = "refined tags (nearest minimum)"
POSTERIOR = "refined tags (mean of the posterior)"
BINNING = "Bayesian binning, order {order}"
NOTHING = "this hand has none"


def segmentation_scores(
    corpus: str,
    tags: pd.DataFrame,
    posteriors: pd.DataFrame,
    minima: pd.DataFrame,
    binned: Mapping[str, pd.DataFrame],
    seed: int,
) -> pd.DataFrame:
    """Return the table `segmentation_scores`: each method against the manual tags, by hand.

    tags, posteriors, minima: tables `boundaries`, `boundary_posteriors` and `minima`. binned:
    tables `wrist_posteriors` and `wrist_boundaries`.
    """
    parts = []
    for hand in HANDS:
        manual = _segments(tags[tags["hand"] == hand], "manual_s")
        for method, found in _methods(hand, tags, posteriors, minima, binned):
            scored = [Part(found[name], manual[name]) for name in found if name in manual]
            rng = stream(seed, corpus, hand, method, "segmentation_scores")
            rows = score_methods(scored, DRAWS, rng)
            rows = rows.assign(hand=hand, method=method, recordings=len(scored), note="")
            if not sum(len(part.found) for part in scored):
                rows = pd.DataFrame([{"hand": hand, "method": method, "note": NOTHING}])
            parts.append(rows)
    names = tables.TABLES["segmentation_scores"].names()
    return pd.concat(parts, ignore_index=True).assign(corpus=corpus).reindex(columns=names)


def _methods(
    hand: str,
    tags: pd.DataFrame,
    posteriors: pd.DataFrame,
    minima: pd.DataFrame,
    binned: Mapping[str, pd.DataFrame],
) -> Iterator[tuple[str, Mapping[str, np.ndarray]]]:
    """Yield each method, and what it found by recording: segments (N, 2), or boundaries (N,)."""
    yield REFINED, _segments(tags[tags["hand"] == hand], "refined_s")
    yield POSTERIOR, _segments(posteriors[posteriors["hand"] == hand], "mean_s")
    tagged = dict.fromkeys(tags["recording"])
    none: Mapping[str, np.ndarray] = {str(name): np.empty(0) for name in tagged}
    yield MINIMA, {**none, **_times(minima[minima["hand"] == hand], "minimum_s")}
    wrists = binned["wrist_posteriors"]
    wrists = wrists[(wrists["hand"] == hand) & wrists["recording"].isin(list(tagged))]
    bounds = binned["wrist_boundaries"]
    for order, own in wrists.groupby("order"):
        rows = bounds[(bounds["hand"] == hand) & bounds["recording"].isin(own["recording"])]
        empty = {str(name): np.empty(0) for name in own["recording"]}
        yield BINNING.format(order=order), {**empty, **_times(rows, "boundary_s")}


def _segments(rows: pd.DataFrame, column: str) -> dict[str, np.ndarray]:
    """Return starts and ends of signs by recording, those that run forward."""
    out = {}
    for name, own in rows.groupby("recording"):
        both = own.pivot(index="sign", columns="edge", values=column)
        times = both[["start", "end"]].to_numpy(dtype=float)
        out[str(name)] = np.sort(times[times[:, 1] > times[:, 0]], axis=0)
    return out


def _times(rows: pd.DataFrame, column: str) -> dict[str, np.ndarray]:
    return {
        str(name): np.sort(own[column].dropna().to_numpy(dtype=float))
        for name, own in rows.groupby("recording")
    }
