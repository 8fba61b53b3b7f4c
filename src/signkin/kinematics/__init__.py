"""Kinematics: gaps, low-pass filters, speed and its minima, orientations, plausibility."""

from signkin.clock import resample
from signkin.kinematics.curvature import curvature
from signkin.kinematics.derivatives import speed, velocity
from signkin.kinematics.filters import lowpass, response_db
from signkin.kinematics.gaps import cut_at_gaps, fill_gaps
from signkin.kinematics.minima import speed_minima
from signkin.kinematics.noise import Noise, measure_noise
from signkin.kinematics.plausibility import check_recording
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
    "speed",
    "speed_minima",
    "velocity",
    "with_limb_frames",
]
