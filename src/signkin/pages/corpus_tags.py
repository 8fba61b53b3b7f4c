"""How good the tags of a corpus are, by hand, signer and recording, and which are the worst."""

from __future__ import annotations

import pandas as pd
from statsmodels.stats.proportion import proportion_confint

from signkin import tables


def tags_of(corpus: str, boundaries: pd.DataFrame, window_s: float) -> pd.DataFrame:
    """Return how near tags lie to minima of speed, a row a hand of all, a signer, a recording.

    boundaries: the table `boundaries`, a row a tag and hand. window_s: of the refinement.
    """
    told = boundaries.assign(
        near=boundaries["distance_s"] <= window_s + 1e-9,
        moved=boundaries["status"] == "moved",
        all="all",
    )
    parts = []
    for group in ("all", "signer", "recording"):
        own = told.groupby([group, "hand"], sort=group != "recording").agg(
            n=("near", "size"), k=("near", "sum"), moved=("moved", "mean"),
            median_distance_s=("distance_s", "median"),
        ).reset_index(names=["name", "hand"])  # fmt: skip
        parts.append(own.assign(group=group))
    frame = pd.concat(parts, ignore_index=True)
    low, high = proportion_confint(frame["k"].to_numpy(), frame["n"].to_numpy(), method="wilson")
    frame = frame.assign(corpus=corpus, near=frame["k"] / frame["n"], low=low, high=high)
    return frame[tables.TABLES["corpus_tags"].names()]


def worst_tags(boundaries: pd.DataFrame, intervals: pd.DataFrame) -> pd.DataFrame:
    """Return the tags that lie farthest from a minimum of either hand, the worst first.

    A sign that one hand makes has minima of that hand at its tags: the nearer hand counts.
    intervals: the table `intervals`, for the sign's start and end.
    """
    keys = ["recording", "signer", "sign", "gloss", "edge"]
    nearest = boundaries.sort_values("distance_s", kind="stable", na_position="last")
    nearest = nearest.drop_duplicates(keys)
    signs = intervals[intervals["role"] == "sign"]
    signs = signs.sort_values(["recording", "start_s"], kind="stable")
    signs = signs.assign(sign=signs.groupby("recording").cumcount() + 1)
    signs = signs[["recording", "sign", "start_s", "end_s"]]
    found = nearest.merge(signs, on=["recording", "sign"], how="left")
    return found.sort_values("distance_s", ascending=False, na_position="first", kind="stable")
