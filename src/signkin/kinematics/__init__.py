"""Kinematics: gaps, low-pass filters, speed and its minima, orientations, plausibility."""

from signkin.kinematics.curvature import curvature
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
