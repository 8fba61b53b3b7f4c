"""Refined tags back into ELAN files (Naert et al. 2017, section 4.2)."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from signkin.annotation import Interval
from signkin.errors import SignkinError
from signkin.io.eaf import NewTier, insert_tiers
from signkin.joints import HANDS


def refined_copies(folder: Path, about: pd.DataFrame, boundaries: pd.DataFrame) -> dict[str, bytes]:
    """Return, by file name, each ELAN file with a tier of refined signs for each hand.

    folder: of the originals. about: table `recordings`. boundaries: table `boundaries`.
    """
    out = {}
    for row in about.itertuples(index=False):
        rows = boundaries[boundaries["recording"] == row.recording]
        if rows.empty:
            continue
        path = folder / str(row.annotation_file)
        tiers = [NewTier(f"signkin refined {hand}", _refined(rows, hand)) for hand in HANDS]
        try:
            out[f"{row.recording}.eaf"] = insert_tiers(
                path.read_bytes(),
                tiers,
                float(row.clock_offset_s),
            )
        except SignkinError as error:
            raise error.at(file=path) from error
    return out


def _refined(rows: pd.DataFrame, hand: str) -> tuple[Interval, ...]:
    of_hand = rows[rows["hand"] == hand]
    table = of_hand.pivot(index="sign", columns="edge", values="refined_s")
    glosses = of_hand.drop_duplicates("sign").set_index("sign")["gloss"]
    return tuple(
        Interval(float(row["start"]), float(row["end"]), str(glosses[sign]), hand)
        for sign, row in table.iterrows()
    )
