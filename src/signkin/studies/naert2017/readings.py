"""The paper's plain rule of refinement (4.2): each tag to its nearest minimum, whatever others do.

Ours adds that tags keep their order and never share a minimum. What claims rest on it is told
under both.
"""

from __future__ import annotations

import pandas as pd

from signkin import tables
from signkin.settings.sections import Refinement

PLAIN = "each tag to its nearest minimum"


def plain_boundaries(bounds: pd.DataFrame, settings: Refinement) -> pd.DataFrame:
    """Return the table `readings_boundaries`. bounds: the table `boundaries`."""
    out = bounds.assign(
        reading=PLAIN,
        refined_s=bounds["plain_s"],
        moved=bounds["distance_s"] <= settings.search_window_s + settings.tolerance_s,
    )
    out["status"] = out["moved"].map({True: "moved", False: "far"})
    out["note"] = ""
    return out[tables.TABLES["readings_boundaries"].names()]


def plain_segmentations(transitions: pd.DataFrame, bounds: pd.DataFrame, unit: str) -> pd.DataFrame:
    """Return the table `readings_segmentations`: durations between tags refined so.

    The plain rule moves tags at one instant to one minimum, so that a tag's time tells where it
    goes. Distances of postures are not taken: no claim rests on them.
    """
    keys = ["recording", "hand"]
    plain = bounds.assign(at=bounds["manual_s"].round(6)).drop_duplicates([*keys, "at"])
    to = plain.set_index([*keys, "at"])["plain_s"]
    rows = transitions[(transitions["segmentation"] == "manual") & (transitions["hand"] != "both")]

    def moved(column: str) -> pd.Series:
        index = pd.MultiIndex.from_arrays(
            [rows["recording"], rows["hand"], rows[column].round(6)], names=to.index.names
        )
        return pd.Series(to.reindex(index).to_numpy(), index=rows.index)

    out = rows.assign(
        reading=PLAIN,
        manual_duration_s=rows["duration_s"],
        refined_duration_s=(moved("end_s") - moved("start_s")).round(9),
        **{f"manual_euclidean_{unit}": rows[f"euclidean_{unit}"]},
    )
    return out.reindex(columns=tables.TABLES["readings_segmentations"].names(unit))
