"""Series of numbers packed small enough for a page: whole steps, differences, DEFLATE, base64.

A series (N, K) is rounded to steps of one size a column, each column's differences are taken, the
low and the high bytes of the 16-bit numbers are set apart, and the whole is compressed. What a
page unpacks differs from the series by at most half a step. NaN, a gap, stays one.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LEVELS = 32_000  # of a 16-bit number, either way; what is left stands for gaps
GAP = -32_768


def packed(series: Floats, step: float) -> Mapping[str, Any]:
    """Return a series (N, K) as the page takes it: rows, columns, step, offsets and the data.

    step: the size of a step at least, in the series' unit; where the range of the columns would
    not fit in 16 bits, as much larger as that wants.
    """
    series = np.asarray(series, dtype=float)
    there = np.isfinite(series)
    # Columns without any number have no extent: NaN is no warning here.
    low = np.where(there, series, np.inf).min(axis=0, initial=np.inf)
    high = np.where(there, series, -np.inf).max(axis=0, initial=-np.inf)
    empty = low > high
    low, high = np.where(empty, 0.0, low), np.where(empty, 0.0, high)
    middle = (low + high) / 2
    widest = float((high - low).max(initial=0.0))
    step = max(step, widest / (2 * LEVELS))
    whole = np.full(series.shape, GAP, dtype=np.int16)
    whole[there] = np.rint(((series - middle) / step)[there]).astype(np.int16)
    return {
        "rows": len(series),
        "columns": series.shape[1],
        "step": float(f"{step:.9g}"),
        "offsets": [float(f"{value:.9g}") for value in middle],
        "data": _compressed(whole),
    }


def _compressed(whole: NDArray[np.int16]) -> str:
    """Return 16-bit numbers (N, K), column by column, as text."""
    columns = np.ascontiguousarray(whole.T)
    # Differences go round at 16 bits, as their sums do when the page takes them back.
    changes = np.diff(columns.astype(np.int32), axis=1, prepend=0).astype(np.uint16).ravel()
    planes = np.concatenate([changes & 0xFF, changes >> 8]).astype(np.uint8)
    return base64.b64encode(zlib.compress(planes.tobytes(), 6)).decode("ascii")


def unpacked(pack: Mapping[str, Any]) -> Floats:
    """Return what a page reads from a pack, (rows, columns)."""
    raw = zlib.decompress(base64.b64decode(pack["data"]))
    planes = np.frombuffer(raw, dtype=np.uint8).reshape(2, pack["columns"], pack["rows"])
    changes = planes[0].astype(np.uint16) | (planes[1].astype(np.uint16) << 8)
    whole = np.cumsum(changes, axis=1, dtype=np.uint16).view(np.int16)
    values = whole.astype(float) * pack["step"] + np.array(pack["offsets"])[:, None]
    return np.where(whole == GAP, np.nan, values).T


def weight(pack: Mapping[str, Any]) -> int:
    """Return how many bytes of a page a pack takes."""
    return len(pack["data"]) + 24 * len(pack["offsets"]) + 80
