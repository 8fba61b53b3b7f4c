"""A transition between two signs by one of the paper's methods, with the run's settings."""

from __future__ import annotations

from collections.abc import Sequence

from signkin.coarticulation.synthesis import Sign, Transition, blend, interpolate
from signkin.recording import Recording
from signkin.settings.sections import Synthesis

INTERPOLATION = "interpolation"


def joined(
    signs: Sequence[Sign],
    duration_s: float,
    method: str,
    settings: Synthesis,
    idle: tuple[Recording, int] | None = None,
) -> Transition:
    """Return the transition from the first to the second of two signs.

    method: interpolation or blending. idle: recording and frame
    of the posture that stands in for motion that was not captured (blending only).
    """
    first, second = signs
    if method == INTERPOLATION:
        return interpolate(
            first,
            second,
            duration_s,
            orientations=settings.orientations,
            keep_limbs=settings.keep_limbs,
        )
    return blend(
        first,
        second,
        duration_s,
        orientations=settings.orientations,
        keep_limbs=settings.keep_limbs,
        idle=idle,
    )
