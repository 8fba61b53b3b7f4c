"""All scores of one segmentation against another in one table, each with its chance value."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from signkin.annotation import Interval
from signkin.errors import SignkinError
from signkin.segments.boundaries import Hits, boundary_hits, hausdorff_s, offsets_s
from signkin.segments.frames import RATE_HZ, boundary_f1, frame_labels, mean_f1, segment_f1
from signkin.segments.gamma import DISORDER, disorder, gamma_of
from signkin.segments.lengths import covering, overlap, share_of_segments

Floats = NDArray[np.float64]
Key = tuple[str, str, str]  # measure, of what, unit
TOLERANCES_S = (0.02, 0.05, 0.1, 0.2)
COLUMNS = ["measure", "of", "value", "unit", "chance", "chance_low", "chance_high"]


def as_segments(segments: ArrayLike | Iterable[Interval]) -> Floats:
    """Return starts and ends (N, 2) in s, in order of start; intervals or an array.

    Raises SignkinError for a segment that does not end after it starts, or has no time.
    """
    given: list[Any] = list(segments)  # type: ignore[arg-type]
    pairs = [(s.start_s, s.end_s) if isinstance(s, Interval) else s for s in given]
    times = np.asarray(pairs, dtype=float).reshape(-1, 2)
    wrong = ~(times[:, 1] > times[:, 0])
    if wrong.any():
        k = int(np.argmax(wrong))
        raise SignkinError(
            f"it runs from {times[k, 0]:.3f} s to {times[k, 1]:.3f} s",
            place=f"segment {k + 1}",
            expected="an end after the start",
        )
    return times[np.lexsort((times[:, 1], times[:, 0]))]


def score(
    predicted: ArrayLike | Iterable[Interval],
    reference: ArrayLike | Iterable[Interval],
    *,
    span_s: tuple[float, float] | None = None,
    tolerances_s: Sequence[float] = TOLERANCES_S,
    rate_hz: float = RATE_HZ,
    draws: int = 0,
    rng: np.random.Generator | int = 0,
) -> pd.DataFrame:
    """Score a segmentation against a reference; one row a score.

    predicted, reference: segments (N, 2) in s, or intervals. span_s: the time that counts (None:
    from the first start to the last end of either). rate_hz: of the frames of mF1B and mF1S.
    draws: how many times the predicted segments are shuffled (see `shuffled`) for what chance
    gives; chance is their mean, chance_low to chance_high hold 95 % of them (NaN without draws).

    Columns: measure, of (which edge, class or tolerance), value, unit, chance, chance_low,
    chance_high. Shares are 0 to 1.
    """
    a, b = as_segments(predicted), as_segments(reference)
    if not len(a) and not len(b):
        raise SignkinError("neither side has a segment", place="score", expected="some segments")
    if not (np.isfinite(rate_hz) and rate_hz > 0):
        raise SignkinError(f"a rate of {rate_hz:g} Hz", place="score", expected="above 0")
    times = np.concatenate([a, b])
    span = span_s or (float(times.min()), float(times.max()))
    if not span[1] > span[0]:
        raise SignkinError(
            f"a span from {span[0]:g} s to {span[1]:g} s", place="score", expected="a length"
        )
    outside = int(((times < span[0] - 1e-9) | (times > span[1] + 1e-9)).any(axis=1).sum())
    if outside:
        raise SignkinError(
            f"{outside} segments reach outside {span[0]:g} s to {span[1]:g} s",
            place="score",
            expected="segments within the span",
        )
    found = _scores(a, b, span, tolerances_s, rate_hz)
    generator = np.random.default_rng(rng)
    drawn = [
        _scores(shuffled(a, span, generator), b, span, tolerances_s, rate_hz)
        for _ in range(draws if len(a) else 0)
    ]
    found, drawn = gamma_of(found, drawn)
    rows = []
    for key, value in found.items():
        chance = np.array([d[key] for d in drawn])
        rows.append([key[0], key[1], value, key[2], *interval_of(chance)])
    return pd.DataFrame(rows, columns=COLUMNS)


def shuffled(segments: Floats, span_s: tuple[float, float], rng: np.random.Generator) -> Floats:
    """Return segments with the same lengths and the same gaps between them, in another order.

    The gaps before the first and after the last are among those that change places. Where
    segments overlap, a gap is negative and stays so.
    """
    starts, ends = segments[:, 0], segments[:, 1]
    gaps = np.append(starts, span_s[1]) - np.append(span_s[0], ends)
    lengths = rng.permutation(ends - starts)
    begin = span_s[0] + np.cumsum(rng.permutation(gaps)[:-1]) + np.append(
        0.0, np.cumsum(lengths)[:-1]
    )  # fmt: skip
    made = np.column_stack([begin, begin + lengths])
    made = np.clip(made, *span_s)  # a negative gap may come first; rounding, else
    return made[made[:, 1] > made[:, 0]]


def _scores(
    a: Floats, b: Floats, span: tuple[float, float], tolerances_s: Sequence[float], rate_hz: float
) -> dict[Key, float]:
    out: dict[Key, float] = {}
    for tolerance in tolerances_s:
        by_edge = [boundary_hits(a[:, k], b[:, k], tolerance) for k in (0, 1)]
        for edge, hits in (("start", by_edge[0]), ("end", by_edge[1]),
                           ("all", by_edge[0] + by_edge[1])):  # fmt: skip
            out |= of_hits(hits, f"{edge}, {tolerance:g} s")
    for k, edge in enumerate(("start", "end")):
        offset = offsets_s(a[:, k], b[:, k])
        out["median offset", edge, "s"] = _median(offset)
        out["median offset, absolute", edge, "s"] = _median(np.abs(offset))
        out["Hausdorff distance", edge, "s"] = hausdorff_s(a[:, k], b[:, k])
    out |= of_frames(a, b, span)
    out[DISORDER] = disorder(a, b)
    return out | of_segments(a, b, span, rate_hz)


def of_hits(hits: Hits, of: str) -> dict[Key, float]:
    """Return what boundary hits tell; of: of which boundaries, and how near."""
    return {
        ("boundary hit rate", of, ""): hits.hit_rate,
        ("boundary precision", of, ""): hits.precision,
        ("boundary F1", of, ""): hits.f1,
    }


def of_frames(a: Floats, b: Floats, span: tuple[float, float]) -> dict[Key, float]:
    """Return how far segments (N, 2) and a reference (M, 2) are of one mind at each instant."""
    shared = overlap(a, b, span)
    return {
        ("frame F1", "sign", ""): shared.f1_sign,
        ("frame F1", "transition", ""): shared.f1_transition,
        ("IoU", "sign", ""): shared.iou_sign,
        ("IoU", "transition", ""): shared.iou_transition,
        ("Cohen's kappa", "sign", ""): shared.kappa,
    }


def of_segments(
    a: Floats, b: Floats, span: tuple[float, float], rate_hz: float
) -> dict[Key, float]:
    """Return how whole segments (N, 2) match those of a reference (M, 2)."""
    p, r = (frame_labels(side, span, rate_hz) for side in (a, b))
    return {
        ("covering", "all", ""): covering(a, b, span),
        ("segments, share of the reference's", "sign", ""): share_of_segments(a, b),
        ("mF1B", f"1-4 frames of {1 / rate_hz:g} s", ""): mean_f1(boundary_f1(p, r)),
        ("mF1S", "IoU 0.40-0.75", ""): mean_f1(segment_f1(p, r)),
    }


def _median(values: Floats) -> float:
    there = values[np.isfinite(values)]
    return float(np.median(there)) if len(there) else float("nan")


def interval_of(draws: Floats) -> tuple[float, float, float]:
    """Return mean, 2.5 % and 97.5 % quantile of what chance gave; NaN without draws."""
    there = draws[np.isfinite(draws)]
    if not len(there):
        return float("nan"), float("nan"), float("nan")
    low, high = np.quantile(there, [0.025, 0.975])
    return float(there.mean()), float(low), float(high)
