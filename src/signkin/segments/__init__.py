"""Two segmentations of one recording compared: refined tags, annotators, models."""

from signkin.segments.boundaries import Hits, boundary_hits, hausdorff_s, offsets_s
from signkin.segments.frames import boundary_f1, frame_labels, segment_f1
from signkin.segments.gamma import disorder
from signkin.segments.lengths import Overlap, covering, overlap, share_of_segments
from signkin.segments.methods import Part, score_methods
from signkin.segments.scores import as_segments, score, shuffled

__all__ = [
    "Hits",
    "Overlap",
    "Part",
    "as_segments",
    "boundary_f1",
    "boundary_hits",
    "covering",
    "disorder",
    "frame_labels",
    "hausdorff_s",
    "offsets_s",
    "overlap",
    "score",
    "score_methods",
    "segment_f1",
    "share_of_segments",
    "shuffled",
]
