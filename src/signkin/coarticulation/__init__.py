"""Coarticulation (Naert, Larboulette & Gibet 2017): refinement, transitions, durations."""

from signkin.coarticulation.duration import (
    DurationModel,
    LinearDuration,
    MeanDuration,
    SimpleBoundedDuration,
    SimpleDuration,
    SurfaceDuration,
    Transitions,
)
from signkin.coarticulation.posture import euclidean_distance, geodesic_distance
from signkin.coarticulation.retrieval import retrieve
from signkin.coarticulation.segmentation import refine, refine_each
from signkin.coarticulation.synthesis import blend, interpolate

__all__ = [
    "DurationModel",
    "LinearDuration",
    "MeanDuration",
    "SimpleBoundedDuration",
    "SimpleDuration",
    "SurfaceDuration",
    "Transitions",
    "blend",
    "euclidean_distance",
    "geodesic_distance",
    "interpolate",
    "refine",
    "refine_each",
    "retrieve",
]
