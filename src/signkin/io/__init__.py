"""Reading and writing of recordings and annotations; a format is one file."""

from signkin.io import (
    bvh,
    eaf,
    elan_tab,
    frame_labels,
    kinect,
    pose,
    subtitles,
    textgrid,
    tsd,
    wide_csv,
    words_csv,
)
from signkin.io.registry import (
    annotation_formats,
    motion_formats,
    read_annotation,
    read_recording,
    wants_rate,
)

__all__ = [
    "annotation_formats",
    "bvh",
    "eaf",
    "elan_tab",
    "frame_labels",
    "kinect",
    "motion_formats",
    "pose",
    "read_annotation",
    "read_recording",
    "subtitles",
    "textgrid",
    "tsd",
    "wants_rate",
    "wide_csv",
    "words_csv",
]
