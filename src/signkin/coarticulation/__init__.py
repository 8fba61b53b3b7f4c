"""Coarticulation (Naert, Larboulette & Gibet 2017): refinement, transitions, durations."""

from signkin.coarticulation.duration import SurfaceDuration
from signkin.coarticulation.posture import euclidean_distance, geodesic_distance
from signkin.coarticulation.segmentation import refine

__all__ = ["SurfaceDuration", "euclidean_distance", "geodesic_distance", "refine"]
