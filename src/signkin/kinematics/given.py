"""Arrays as callers give them, made arrays of numbers or refused in a sentence."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.masked import unmasked


def numbers(values: Any, place: str, shape: str, axes: int, least: int) -> NDArray[np.float64]:
    """Return an array of numbers of `axes` axes or more, with `least` frames or more.

    place, shape: what it is and how it should look, for the error.
    """
    try:
        found = unmasked(values)
    except (TypeError, ValueError) as error:
        raise SignkinError(
            f"no array of numbers ({error})", place=place, expected=f"shape {shape}"
        ) from error
    if found.ndim < axes or len(found) < least:
        raise SignkinError(
            f"an array of shape {found.shape}",
            place=place,
            expected=f"shape {shape}, {least} frames or more",
        )
    return found


def rate(value: Any) -> float:
    """Return a rate in Hz, a finite number above 0."""
    try:
        found = float(value)
    except (TypeError, ValueError):
        found = float("nan")
    if not (np.isfinite(found) and found > 0):
        raise SignkinError(
            f"the rate is {value!r}", place="rate_hz", expected="a number above 0, in Hz"
        )
    return found
