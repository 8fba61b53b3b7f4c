"""The rows of each recording of a table, found once for all of them."""

from __future__ import annotations

import numpy as np
import pandas as pd
from numpy.typing import NDArray


class ByRecording:
    """A table by its column `recording`: thousands of recordings are not looked for one by one.

    Rows keep their order and index, as `frame[frame["recording"] == name]` has them.
    """

    def __init__(self, frame: pd.DataFrame) -> None:
        self._frame = frame
        self._places: dict[str, NDArray[np.intp]] = {}
        if len(frame):
            self._places = dict(frame.groupby("recording", sort=False).indices)

    def __getitem__(self, recording: str) -> pd.DataFrame:
        """Return the rows of a recording; none where the table does not name it."""
        return self._frame.iloc[self._places.get(recording, [])]


def rows_of(table: pd.DataFrame | ByRecording, recording: str) -> pd.DataFrame:
    """Return the rows of one recording of a table."""
    if isinstance(table, ByRecording):
        return table[recording]
    return table[table["recording"] == recording]
