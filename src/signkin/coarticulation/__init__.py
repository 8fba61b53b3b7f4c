"""Coarticulation (Naert, Larboulette & Gibet 2017): refinement, transitions, durations."""

from signkin.coarticulation.duration import (
    LinearDuration,
    MeanDuration,
    SimpleBoundedDuration,
    SimpleDuration,
    SurfaceDuration,
)
from signkin.coarticulation.posture import euclidean_distance, geodesic_distance
from signkin.coarticulation.segmentation import refine

__all__ = [
    "LinearDuration",
    "MeanDuration",
    "SimpleBoundedDuration",
    "SimpleDuration",
    "SurfaceDuration",
    "euclidean_distance",
    "geodesic_distance",
    "refine",
]
