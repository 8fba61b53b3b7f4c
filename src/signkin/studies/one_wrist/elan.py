"""Segments by binning as tiers of their own in the ELAN files."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd

from signkin.annotation import Interval
from signkin.errors import SignkinError
from signkin.io.eaf import NewTier, insert_tiers
from signkin.joints import HANDS


def tiers(found: pd.DataFrame, recording: str) -> list[NewTier]:
    """Return a tier for each hand whose annotations are the segments between boundaries."""
    out = []
    for hand in HANDS:
        here = (found["recording"] == recording) & (found["hand"] == hand)
        times = np.sort(found.loc[here, "boundary_s"].to_numpy(dtype=float))
        segments = tuple(
            Interval(float(a), float(b), str(i), hand)
            for i, (a, b) in enumerate(pairwise(times), start=1)
        )
        out.append(NewTier(f"signkin binning {hand}", segments))
    return out


def copies(folder: Path, about: pd.DataFrame, found: pd.DataFrame) -> dict[str, bytes]:
    """Return, by file name, each ELAN file with a tier of segments for each hand."""
    out = {}
    for row in about.itertuples(index=False):
        path = folder / str(row.annotation_file)
        try:
            out[f"{row.recording}.eaf"] = insert_tiers(
                path.read_bytes(), tiers(found, str(row.recording)), float(row.clock_offset_s)
            )
        except SignkinError as error:
            raise error.at(file=path) from error
    return out
