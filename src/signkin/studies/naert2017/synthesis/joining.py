"""A transition between two signs by one of the paper's methods, with the run's settings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from signkin.coarticulation.synthesis import Sign, Transition, blend, interpolate
from signkin.recording import Recording

INTERPOLATION = "interpolation"


def joined(
    signs: Sequence[Sign],
    duration_s: float,
    method: str,
    settings: Mapping[str, Any],
    idle: tuple[Recording, int] | None = None,
) -> Transition:
    """Return the transition from the first to the second of two signs.

    method: interpolation or blending. settings: config's `synthesis`. idle: recording and frame
    of the posture that stands in for motion that was not captured (blending only).
    """
    form = {"orientations": settings["orientations"], "keep_limbs": settings["keep_limbs"]}
    first, second = signs
    if method == INTERPOLATION:
        return interpolate(first, second, duration_s, **form)
    return blend(first, second, duration_s, **form, idle=idle)
