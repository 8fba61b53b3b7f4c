"""Masked arrays: what a mask hides is a gap, and no number that goes on unseen."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def unmasked(values: Any) -> NDArray[np.float64]:
    """Return an array of numbers, NaN where a mask hides one. No copy where there is no mask."""
    if np.ma.isMaskedArray(values):
        return np.asarray(np.ma.filled(np.ma.asarray(values, dtype=float), np.nan), dtype=float)
    return np.asarray(values, dtype=float)
