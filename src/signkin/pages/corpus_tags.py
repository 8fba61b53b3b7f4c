"""How good the tags of a corpus are, by hand, signer and recording, and which are the worst."""

from __future__ import annotations

from collections.abc import Iterator

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


def against_chance(chance: pd.DataFrame, window_s: float, alpha: float) -> Iterator[str]:
    """Yield a sentence a hand: do tags lie nearer to minima of speed than by chance?

    chance: the table `tag_chance`. It is decided by the mean share over all windows, corrected by
    Holm, at level alpha; the share within window_s is told beside it.
    """
    shifted = chance[(chance["tags"] == "all") & (chance["null"] == "circular shift")]
    least, most = shifted["window_s"].min(), shifted["window_s"].max()
    within = shifted[
        (shifted["measure"] == "share within the window")
        & ((shifted["window_s"] - window_s).abs() < 1e-9)
    ].set_index("hand")
    for row in shifted[shifted["measure"] == "mean share"].itertuples():
        if pd.isna(row.p_holm):
            yield f"Tags and the {row.hand} hand: {row.note or 'nothing to compare'}."
            continue
        near = row.p_holm < alpha
        share = f"{within.loc[row.hand, 'value']:.0%} of {row.n} starts and ends of signs"
        yield (
            f"{share} lie within {window_s:g} s of a minimum of speed of the {row.hand} hand. Over "
            f"windows from {least:g} to {most:g} s it is {row.value:.0%} on average, and "
            f"{row.chance_low:.0%} to {row.chance_high:.0%} if the same tags are shifted in time "
            f"(p = {row.p_holm:.2g} by Holm): "
            + ("nearer than chance." if near else "no nearer than chance has it.")
        )
