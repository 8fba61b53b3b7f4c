"""Refined tags back into ELAN files (Naert et al. 2017, section 4.2)."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from signkin.annotation import Interval
from signkin.io.eaf import NewTier, elan_copy
from signkin.joints import HANDS
from signkin.stages.ingest import tags_of


def refined_copies(
    folder: Path,
    about: pd.DataFrame,
    boundaries: pd.DataFrame,
    intervals: pd.DataFrame,
    *,
    elan: bool = True,
) -> dict[str, bytes]:
    """Return, by file name, each ELAN file with a tier of refined signs for each hand.

    folder: of the originals. about, boundaries, intervals: tables of these names.
    elan: whether the originals are ELAN files; else new ones are made of their tags.
    """
    out = {}
    for row in about.itertuples(index=False):
        rows = boundaries[boundaries["recording"] == row.recording]
        if rows.empty:
            continue
        out[f"{row.recording}.eaf"] = elan_copy(
            folder / str(row.annotation_file),
            [NewTier(f"signkin refined {hand}", _refined(rows, hand)) for hand in HANDS],
            elan=elan,
            clock_offset_s=float(row.clock_offset_s),
            tags=tags_of(intervals, str(row.recording)),
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
