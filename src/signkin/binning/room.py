"""Memory for the kernels, kept from one trajectory to the next.

The system clears what it gives out: some megabytes for each fit of 100 bins, 130 for 1,000 bins,
which takes as long as the fit.
"""

from __future__ import annotations

import math
import threading

import numpy as np
from numpy.typing import NDArray

from signkin.binning.lanes import new_aligned

MOST_KEPT = 1 << 23  # numbers in one array, 64 MB; more would be held for a rare series


class Room(threading.local):
    """Arrays by name, for each thread its own."""

    def __init__(self) -> None:
        self._kept: dict[str, NDArray[np.float64]] = {}

    def array(self, name: str, *shape: int) -> NDArray[np.float64]:
        """Return an array of any value, which holds until the same name is asked for again."""
        size = math.prod(shape)
        room = self._kept.get(name)
        if room is None or len(room) < size:
            room = new_aligned(size)
            if size <= MOST_KEPT:
                self._kept[name] = room
        return room[:size].reshape(shape)
