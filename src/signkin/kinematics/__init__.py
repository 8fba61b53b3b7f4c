"""Kinematics: gaps, low-pass filters, speed and its minima, orientations, plausibility."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from signkin.kinematics.curvature import curvature  # not on first use: its file has its name

if TYPE_CHECKING:
    from signkin.kinematics.derivatives import speed, velocity
    from signkin.kinematics.filters import lowpass, response_db
    from signkin.kinematics.gaps import fill_gaps
    from signkin.kinematics.minima import speed_minima
    from signkin.kinematics.plausibility import check_recording
    from signkin.kinematics.rotations import parent_relative, with_limb_frames

__all__ = [
    "check_recording",
    "curvature",
    "fill_gaps",
    "lowpass",
    "parent_relative",
    "response_db",
    "speed",
    "speed_minima",
    "velocity",
    "with_limb_frames",
]

_HOMES = {
    "check_recording": "plausibility",
    "fill_gaps": "gaps",
    "lowpass": "filters",
    "parent_relative": "rotations",
    "response_db": "filters",
    "speed": "derivatives",
    "speed_minima": "minima",
    "velocity": "derivatives",
    "with_limb_frames": "rotations",
}


def __getattr__(name: str) -> Any:
    # Imported on first use: who wants one function does not wait for SciPy's other parts.
    if name in _HOMES:
        from importlib import import_module

        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
