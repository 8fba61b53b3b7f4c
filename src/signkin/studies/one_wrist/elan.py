"""Segments by binning as tiers of their own in the ELAN files."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd

from signkin.annotation import Interval
from signkin.io.eaf import NewTier, elan_copy
from signkin.joints import HANDS
from signkin.stages.ingest import tags_of
from signkin.tables import ByRecording, rows_of


def tiers(found: pd.DataFrame | ByRecording, recording: str) -> list[NewTier]:
    """Return a tier for each hand whose annotations are the segments between boundaries."""
    out = []
    own = rows_of(found, recording)
    for hand in HANDS:
        times = np.sort(own.loc[own["hand"] == hand, "boundary_s"].to_numpy(dtype=float))
        segments = tuple(
            Interval(float(a), float(b), str(i), hand)
            for i, (a, b) in enumerate(pairwise(times), start=1)
        )
        out.append(NewTier(f"signkin binning {hand}", segments))
    return out


def copies(
    folder: Path,
    about: pd.DataFrame,
    found: pd.DataFrame,
    intervals: pd.DataFrame,
    *,
    elan: bool = True,
) -> dict[str, bytes]:
    """Return, by file name, each ELAN file with a tier of segments for each hand.

    intervals: table of this name. elan: whether the originals are ELAN files; else new ones are
    made of their tags.
    """
    segments, tags = ByRecording(found), ByRecording(intervals)
    return {
        f"{row.recording}.eaf": elan_copy(
            folder / str(row.annotation_file),
            tiers(segments, str(row.recording)),
            elan=elan,
            clock_offset_s=float(row.clock_offset_s),
            tags=tags_of(tags, str(row.recording)),
            media_url=str(row.motion_file),
        )
        for row in about.itertuples(index=False)
    }
