"""Reading and writing of recordings and annotations; a format is one file."""

from signkin.io import bvh, eaf, kinect, pose, tsd, wide_csv, words_csv
from signkin.io.registry import (
    annotation_formats,
    motion_formats,
    read_annotation,
    read_recording,
)

__all__ = [
    "annotation_formats",
    "bvh",
    "eaf",
    "kinect",
    "motion_formats",
    "pose",
    "read_annotation",
    "read_recording",
    "tsd",
    "wide_csv",
    "words_csv",
]
