"""Reading and writing of recordings and annotations; a format is one file."""

from signkin.io import (
    bvh,
    c3d,
    eaf,
    exports,
    keypoints,
    kinect,
    openpose_json,
    pose,
    tracked,
    trc,
    tsd,
    wide_csv,
    words_csv,
)
from signkin.io.registry import (
    annotation_formats,
    motion_formats,
    read_annotation,
    read_recording,
)

__all__ = [
    "annotation_formats",
    "bvh",
    "c3d",
    "eaf",
    "exports",
    "keypoints",
    "kinect",
    "motion_formats",
    "openpose_json",
    "pose",
    "read_annotation",
    "read_recording",
    "tracked",
    "trc",
    "tsd",
    "wide_csv",
    "words_csv",
]
