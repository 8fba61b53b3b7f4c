"""Hits by chance where predicted boundaries keep their structure: shifted in a circle.

Poisson events (`hit_rate.chance_line`) cluster and leave gaps as boundaries of a segmentation do
not. Here those of a trajectory stay as they are to one another and move together by a random
time, wrapped around its ends: their number, spacing and regularity are kept, and only where they
stand is chance.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import ArrayLike

from signkin.binning.hit_rate import TOLERANCE_S, Floats, _error, _times
from signkin.binning.pairs import shifted_counts

STEPS = 200  # shifts, evenly spread over the duration


@dataclass(frozen=True)
class Shifted:
    """Hits of one trajectory's predicted boundaries over all shifts: mean and SD."""

    mean: float
    sd: float


def shifted_hits(
    predicted_s: ArrayLike, truth_s: ArrayLike, window_s: float, *, duration_s: float,
    steps: int = STEPS,
) -> Shifted:  # fmt: skip
    """Return how many hits predicted boundaries have that are shifted in a circle.

    predicted_s, truth_s: in s from the start of a trajectory that lasts duration_s. Matched as
    by `hit_rate.match`, for `steps` shifts that lie evenly within the duration.
    """
    predicted, truth = _times(predicted_s, "predicted_s"), np.sort(_times(truth_s, "truth_s"))
    if not (duration_s > 0 and window_s >= 0 and steps > 0):
        raise _error(
            f"a duration of {duration_s:g} s, a window of {window_s:g} s, {steps} steps",
            "a duration and steps above 0, a window from 0",
        )
    hits = hits_of_shifts(
        predicted, truth, window_s, duration_s, (np.arange(steps) + 0.5) / steps * duration_s
    )
    return Shifted(float(hits.mean()), float(hits.std()))


def hits_of_shifts(
    predicted: Floats, truth: Floats, window_s: float, duration_s: float, shifts_s: Floats
) -> Floats:
    """Return the hits of each of many shifts. truth: in order."""
    return shifted_counts(
        np.sort(predicted),
        np.array(truth),
        float(window_s) + TOLERANCE_S,
        float(duration_s),
        np.array(shifts_s),
    )


@dataclass(frozen=True)
class ShiftedRates:
    """A group by chance, each trajectory shifted on its own.

    hit_rate: mean over trajectories; low, high: 95 % of sets of shifts (a sum of many independent
    hits, taken as normal). hpfpps: eq. 17 of the sums; NaN without a false positive.
    """

    hit_rate: float
    low: float
    high: float
    hpfpps: float


def shifted_rates(
    hits: Iterable[Shifted], true: ArrayLike, predicted: ArrayLike, durations_s: ArrayLike
) -> ShiftedRates:
    """Return the rates of a group of trajectories, those without a true boundary left out.

    true, predicted: how many boundaries each has.
    """
    found = np.array([(one.mean, one.sd) for one in hits]).reshape(-1, 2)
    truths, events, seconds = (np.asarray(x, dtype=float) for x in (true, predicted, durations_s))
    used = truths > 0
    n = int(used.sum())
    if not n:
        nan = float("nan")
        return ShiftedRates(nan, nan, nan, nan)
    mean, sd = found[used].T
    rate = float(np.mean(mean / truths[used]))
    reach = NormalDist().inv_cdf(0.975) * float(np.sqrt(np.sum((sd / truths[used]) ** 2))) / n
    false = float((events[used] - mean).sum() / seconds[used].sum())
    share = float(mean.sum() / truths[used].sum())
    return ShiftedRates(
        rate, max(rate - reach, 0.0), min(rate + reach, 1.0),
        share / false if false > 1e-12 else float("nan"),
    )  # fmt: skip
