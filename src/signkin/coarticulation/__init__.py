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
from signkin.coarticulation.refined_posterior import (
    RefinedPosterior,
    jitter_between,
    learn_tag_model,
    refine_posterior,
)
from signkin.coarticulation.retrieval import retrieve
from signkin.coarticulation.segmentation import refine, refine_each
from signkin.coarticulation.synthesis import blend, interpolate
from signkin.coarticulation.tag_model import TagModel, most_outward_s

__all__ = [
    "DurationModel",
    "LinearDuration",
    "MeanDuration",
    "RefinedPosterior",
    "SimpleBoundedDuration",
    "SimpleDuration",
    "SurfaceDuration",
    "TagModel",
    "Transitions",
    "blend",
    "euclidean_distance",
    "geodesic_distance",
    "interpolate",
    "jitter_between",
    "learn_tag_model",
    "most_outward_s",
    "refine",
    "refine_each",
    "refine_posterior",
    "retrieve",
]
