"""Refined tags back into ELAN files (Naert et al. 2017, section 4.2)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from signkin.annotation import Interval
from signkin.coarticulation.segmentation import EDGES
from signkin.io.eaf import NewTier, elan_copy
from signkin.joints import HANDS
from signkin.stages.ingest import tags_of
from signkin.tables import ByRecording


def refined_copies(
    folder: Path,
    about: pd.DataFrame,
    boundaries: pd.DataFrame,
    intervals: pd.DataFrame,
    *,
    elan: bool = True,
    posteriors: pd.DataFrame | None = None,
) -> dict[str, bytes]:
    """Return, by file name, each ELAN file with a tier of refined signs for each hand.

    folder: of the originals. about, boundaries, intervals: tables of these names. posteriors:
    the table `boundary_posteriors`, where tiers of 90 % intervals are wanted, too.
    elan: whether the originals are ELAN files; else new ones are made of their tags.
    """
    out = {}
    refined, tags = ByRecording(boundaries), ByRecording(intervals)
    uncertain = None if posteriors is None else ByRecording(posteriors)
    for row in about.itertuples(index=False):
        rows = refined[str(row.recording)]
        if rows.empty:
            continue
        tiers = [NewTier(f"signkin refined {hand}", _refined(rows, hand)) for hand in HANDS]
        if uncertain is not None:
            tiers += _posterior_tiers(uncertain[str(row.recording)])
        out[f"{row.recording}.eaf"] = elan_copy(
            folder / str(row.annotation_file),
            tiers,
            elan=elan,
            clock_offset_s=float(row.clock_offset_s),
            tags=tags_of(tags, str(row.recording)),
            media_url=str(row.motion_file),
        )
    return out


def _refined(rows: pd.DataFrame, hand: str) -> tuple[Interval, ...]:
    of_hand = rows[rows["hand"] == hand]
    table = of_hand.pivot(index="sign", columns="edge", values="refined_s")
    glosses = of_hand.drop_duplicates("sign").set_index("sign")["gloss"]
    return tuple(
        Interval(float(row["start"]), float(row["end"]), str(glosses[sign]), hand)
        for sign, row in table.iterrows()
    )


def _posterior_tiers(rows: pd.DataFrame) -> list[NewTier]:
    """Return a tier a hand and edge: 90 % intervals, with gloss, mean, interval and P(off)."""
    return [
        NewTier(f"signkin posterior {hand} {edge}", tuple(_intervals(rows, hand, edge)))
        for hand in HANDS
        for edge in EDGES
    ]


def _intervals(rows: pd.DataFrame, hand: str, edge: str) -> Iterator[Interval]:
    chosen = rows[(rows["hand"] == hand) & (rows["edge"] == edge)].dropna(subset="mean_s")
    chosen = chosen.sort_values(["mean_s", "sign"])
    low, high = (chosen[c].to_numpy(dtype=float) for c in ("low90_s", "high90_s"))
    # A tier has no room for two at once: where they overlap, each ends in the middle. The value
    # has the whole interval.
    middle = (low[1:] + high[:-1]) / 2
    shown_low, shown_high = np.maximum(low, 0.0), high.copy()
    shown_low[1:] = np.where(low[1:] < high[:-1], middle, low[1:])
    shown_high[:-1] = np.where(low[1:] < high[:-1], middle, high[:-1])
    for row, start, end in zip(chosen.itertuples(index=False), shown_low, shown_high, strict=True):
        if end - start < 0.002:  # before the recording's start; ELAN counts milliseconds
            continue
        label = (
            f"{row.gloss} {edge} {row.mean_s:.3f} s ({row.low90_s:.3f}-{row.high90_s:.3f}), "
            f"off by more than 0.1 s: {row.off:.0%}"
        )
        yield Interval(float(start), float(end), label, hand)
