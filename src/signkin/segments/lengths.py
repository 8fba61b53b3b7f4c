"""How much of the time two segmentations agree on: exact lengths, no frames."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Overlap:
    """Seconds in which both, one or none of two segmentations has a sign."""

    both_s: float
    predicted_only_s: float
    reference_only_s: float
    neither_s: float

    @property
    def f1_sign(self) -> float:
        """Frame F1 of signs, with frames infinitely short; NaN where neither has a sign."""
        return _ratio(2 * self.both_s, 2 * self.both_s + self._one_s)

    @property
    def f1_transition(self) -> float:
        """Frame F1 of what is no sign."""
        return _ratio(2 * self.neither_s, 2 * self.neither_s + self._one_s)

    @property
    def iou_sign(self) -> float:
        """Intersection over union of signs."""
        return _ratio(self.both_s, self.both_s + self._one_s)

    @property
    def iou_transition(self) -> float:
        """Intersection over union of what is no sign."""
        return _ratio(self.neither_s, self.neither_s + self._one_s)

    @property
    def accuracy(self) -> float:
        """Share of the time that both call the same."""
        return _ratio(self.both_s + self.neither_s, self._total_s)

    @property
    def kappa(self) -> float:
        """Cohen's kappa (1960) of sign or not; NaN where chance alone agrees on everything."""
        a = (self.both_s + self.predicted_only_s) / self._total_s
        b = (self.both_s + self.reference_only_s) / self._total_s
        chance = a * b + (1 - a) * (1 - b)
        return _ratio(self.accuracy - chance, 1 - chance)

    @property
    def _one_s(self) -> float:
        return self.predicted_only_s + self.reference_only_s

    @property
    def _total_s(self) -> float:
        return self.both_s + self._one_s + self.neither_s


def overlap(predicted: Floats, reference: Floats, span_s: tuple[float, float]) -> Overlap:
    """Measure where two segmentations have signs, within a span of time.

    predicted, reference: (N, 2), (M, 2) starts and ends in s, in order of start; time that two
    segments of one side share counts once.
    """
    cuts = np.unique(np.clip(np.concatenate([predicted.ravel(), reference.ravel(), span_s]),
                             *span_s))  # fmt: skip
    lengths, middles = np.diff(cuts), (cuts[:-1] + cuts[1:]) / 2
    p, r = _inside(middles, predicted), _inside(middles, reference)
    return Overlap(
        *(float(lengths[where].sum()) for where in (p & r, p & ~r, ~p & r, ~p & ~r)),
    )


def covering(predicted: Floats, reference: Floats, span_s: tuple[float, float]) -> float:
    """Return how well the pieces of one segmentation cover those of the reference, 0 to 1.

    Both cut the span into pieces, signs and what lies between; each piece of the reference counts
    by its length, with the intersection over union of the predicted piece that fits it best
    (Arbelaez et al. 2011; van den Burg & Williams 2020, eq. 7).
    """
    a, b = _cuts(predicted, span_s), _cuts(reference, span_s)
    both = np.unique(np.concatenate([a, b]))
    lengths, middles = np.diff(both), (both[:-1] + both[1:]) / 2
    i, j = (np.searchsorted(cuts, middles) - 1 for cuts in (a, b))  # pieces that share this time
    whole = np.maximum(a[i + 1], b[j + 1]) - np.minimum(a[i], b[j])
    best = np.zeros(len(b) - 1)
    np.maximum.at(best, j, lengths / whole)
    return float(np.average(best, weights=np.diff(b)))


def share_of_segments(predicted: Floats, reference: Floats) -> float:
    """Return the number of predicted segments as a share of the reference's; NaN without any."""
    return _ratio(len(predicted), len(reference))


def _inside(times: Floats, segments: Floats) -> NDArray[np.bool_]:
    """Return which times lie in a segment; as many have started as ended outside all."""
    started = np.searchsorted(np.sort(segments[:, 0]), times, side="right")
    ended = np.searchsorted(np.sort(segments[:, 1]), times, side="right")
    return np.asarray(started > ended)


def _cuts(segments: Floats, span_s: tuple[float, float]) -> Floats:
    return np.unique(np.clip(np.append(segments.ravel(), span_s), *span_s))


def _ratio(part: float, whole: float) -> float:
    return part / whole if whole else float("nan")
