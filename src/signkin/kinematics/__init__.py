"""Kinematics: gaps, low-pass filters, speed and its minima, orientations, plausibility."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from signkin.kinematics.curvature import curvature  # not on first use: its file has its name

if TYPE_CHECKING:
    from signkin.clock import resample
    from signkin.kinematics.derivatives import speed, velocity
    from signkin.kinematics.filters import lowpass, response_db
    from signkin.kinematics.gaps import cut_at_gaps, fill_gaps
    from signkin.kinematics.minima import speed_minima
    from signkin.kinematics.noise import Noise, measure_noise
    from signkin.kinematics.plausibility import check_recording
    from signkin.kinematics.rests import rest_times
    from signkin.kinematics.rotations import parent_relative, with_limb_frames
    from signkin.velocities import integrate

__all__ = [
    "Noise",
    "check_recording",
    "curvature",
    "cut_at_gaps",
    "fill_gaps",
    "integrate",
    "lowpass",
    "measure_noise",
    "parent_relative",
    "resample",
    "response_db",
    "rest_times",
    "speed",
    "speed_minima",
    "velocity",
    "with_limb_frames",
]

_HOMES = {
    "Noise": "kinematics.noise",
    "check_recording": "kinematics.plausibility",
    "cut_at_gaps": "kinematics.gaps",
    "fill_gaps": "kinematics.gaps",
    "integrate": "velocities",
    "lowpass": "kinematics.filters",
    "measure_noise": "kinematics.noise",
    "parent_relative": "kinematics.rotations",
    "resample": "clock",
    "response_db": "kinematics.filters",
    "rest_times": "kinematics.rests",
    "speed": "kinematics.derivatives",
    "speed_minima": "kinematics.minima",
    "velocity": "kinematics.derivatives",
    "with_limb_frames": "kinematics.rotations",
}


def __getattr__(name: str) -> Any:
    # Imported on first use: who wants one function does not wait for SciPy's other parts.
    if name in _HOMES:
        from importlib import import_module

        return getattr(import_module(f"signkin.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
