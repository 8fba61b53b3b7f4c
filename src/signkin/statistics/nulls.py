"""Do tags lie nearer to events (speed minima) than chance has it? Nulls that keep the structure.

Tags placed uniformly at random ignore that tags alternate, keep their gaps and stand only where
there is signing, and that minima are evenly spaced: both make a random tag look farther from, or
nearer to, a minimum than it is. Here tags move within stretches of signing, in one of three ways:

- circular shift: all tags of a stretch by one random time, wrapped around; gaps and order stay,
  and so does whatever period tags and minima have.
- permutation: the durations of signs among themselves, and those of gaps among themselves; ends
  of the stretch, alternation and both distributions stay.
- uniform: as many tags, anywhere in the stretch. What the others are to be compared with.

Beside them stands what a Poisson process of as many minima would give: 1 - exp(-2 rate window).

A stretch is a run of signs without a pause longer than `pause_s`. Nothing is taken from outside
it but minima up to `margin_s` away, so that it does not matter whether a transcript comes as one
recording or cut into several at such pauses.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from signkin.errors import SignkinError
from signkin.masked import unmasked
from signkin.statistics.findings import NAN

Array = NDArray[np.float64]
WINDOWS_S = tuple(k / 100 for k in range(2, 21, 2))  # 20 to 200 ms
PAUSE_S = 2.0
TOLERANCE_S = 1e-6  # floating point: an event this much outside a window still counts
MEDIAN, SHARE, MEAN_SHARE = "median distance", "share within the window", "mean share"
CHANGE = "median change of duration"


class Null(StrEnum):
    """How tags are placed by chance."""

    SHIFT = "circular shift"
    PERMUTATION = "signs and gaps permuted"
    UNIFORM = "uniform"


POISSON = "Poisson"


@dataclass(frozen=True, eq=False)
class Stretch:
    """Signs without a long pause between them, and the minima of one hand around them.

    signs_s: (N, 2), start and end in s, in order of start. minima_s: (M,), rising. rate_hz: of
    the frames that tags and minima stand on.
    """

    signs_s: Array
    minima_s: Array
    rate_hz: float

    @property
    def span_s(self) -> tuple[float, float]:
        """First start and last end."""
        return float(self.signs_s[0, 0]), float(self.signs_s[:, 1].max())

    def counted(self, transitions_only: bool) -> NDArray[np.bool_]:
        """Return which tags count, (N, 2): all, or those that bound a transition."""
        out = np.ones(self.signs_s.shape, dtype=bool)
        if transitions_only:
            out[0, 0] = out[-1, 1] = False
        return out


def stretches(
    signs_s: ArrayLike,
    minima_s: ArrayLike,
    rate_hz: float,
    pause_s: float = PAUSE_S,
    margin_s: float = WINDOWS_S[-1],
) -> list[Stretch]:
    """Cut the signs of one recording where they pause.

    signs_s: (N, 2), in s. minima_s: (M,), of one hand. margin_s: how far beyond the first and
    last tag minima count. Raises SignkinError for times that are none and a rate of 0.
    """
    signs, minima = unmasked(signs_s).reshape(-1, 2), np.sort(unmasked(minima_s))
    for name, values in (("tags", signs), ("minima", minima)):
        lost = int((~np.isfinite(values)).sum())
        if lost:
            raise SignkinError(
                f"{lost} {name} have no time", place="nulls", expected="times in seconds",
                todo="Leave them out.",
            )  # fmt: skip
    if not rate_hz > 0:
        raise SignkinError(f"the rate is {rate_hz:g} Hz", place="nulls", expected="above 0")
    signs = signs[np.argsort(signs[:, 0], kind="stable")]
    latest = np.maximum.accumulate(signs[:, 1]) if len(signs) else signs[:, 1]
    cuts = np.flatnonzero(signs[1:, 0] - latest[:-1] > pause_s + TOLERANCE_S) + 1
    out = []
    for part in np.split(signs, cuts):
        if len(part):
            low, high = part[0, 0] - margin_s, part[:, 1].max() + margin_s
            near = (minima >= low - TOLERANCE_S) & (minima <= high + TOLERANCE_S)
            out.append(Stretch(part, minima[near], rate_hz))
    return out


def placed(stretch: Stretch, null: Null, draws: int, rng: np.random.Generator) -> Array:
    """Return the tags of a stretch placed by chance, (draws, N, 2), on whole frames."""
    signs = stretch.signs_s
    start, end = stretch.span_s
    frames = max(1, round((end - start) * stretch.rate_hz))
    if null is Null.PERMUTATION:
        lengths = np.tile(signs[:, 1] - signs[:, 0], (draws, 1))
        gaps = np.tile(signs[1:, 0] - signs[:-1, 1], (draws, 1))
        lengths, gaps = (rng.permuted(part, axis=1) for part in (lengths, gaps))
        out = np.empty((draws, len(signs), 2))
        before = np.cumsum(lengths[:, :-1] + gaps, axis=1)
        out[..., 0] = start + np.concatenate([np.zeros((draws, 1)), before], axis=1)
        out[..., 1] = out[..., 0] + lengths
        return out
    if null is Null.SHIFT:
        shift = rng.integers(0, frames, (draws, 1, 1)) / stretch.rate_hz
        return np.asarray(start + np.mod(signs - start + shift, frames / stretch.rate_hz))
    return start + rng.integers(0, frames + 1, (draws, len(signs), 2)) / stretch.rate_hz


def distances(times: Array, minima: Array) -> Array:
    """Return the distance of each time to its nearest minimum; infinite where there is none."""
    if not len(minima):
        return np.full(np.shape(times), np.inf)
    after = np.searchsorted(minima, times)
    beyond = minima[np.minimum(after, len(minima) - 1)]
    before = minima[np.maximum(after - 1, 0)]
    return np.minimum(np.abs(times - before), np.abs(beyond - times))


def against_nulls(
    parts: Sequence[Stretch],
    draws: int,
    rng: np.random.Generator,
    windows_s: Sequence[float] = WINDOWS_S,
    transitions_only: bool = False,
) -> pd.DataFrame:
    """Compare how near tags lie to minima with each null, pooled over stretches.

    parts: of one hand, of all recordings of a corpus. transitions_only: tags that bound a
    transition, without the first and last of a stretch.

    Returns a row a null and measure: null, measure, window_s (NaN but for a share), value, chance
    (mean over draws), chance_low and chance_high (their 2.5 % and 97.5 % quantiles), p (one-sided:
    nearer than chance; (1 + draws as near) / (1 + draws)), n (tags), stretches. The measures:
    share within each window, median distance in s, and the mean share over all windows, which is
    one number for the whole curve: where one p is wanted, it is that one. Poisson has a chance
    value alone.
    Raises SignkinError where no tag counts.
    """
    flags = [part.counted(transitions_only) for part in parts]
    n = int(sum(flag.sum() for flag in flags))
    if not n:
        raise SignkinError(
            "no tag to compare with chance", place="nulls",
            expected="transitions between signs" if transitions_only else "signs",
        )  # fmt: skip
    observed = _measures(
        [distances(p.signs_s[f], p.minima_s)[None] for p, f in zip(parts, flags, strict=True)],
        windows_s,
    )
    rows = []
    for null in Null:
        chance = _measures(
            [
                distances(placed(p, null, draws, rng)[:, f], p.minima_s)
                for p, f in zip(parts, flags, strict=True)
            ],
            windows_s,
        )
        rows += [
            {**_key(key), "null": str(null), **_compared(float(value[0]), chance[key], key)}
            for key, value in observed.items()
        ]
    line = _poisson(parts, flags, windows_s)
    rows += [
        {**_key(key), "null": POISSON, "value": float(value[0]), "chance": line[key]}
        for key, value in observed.items()
    ]
    names = ["null", "measure", "window_s", "value", "chance", "chance_low", "chance_high", "p"]
    return pd.DataFrame(rows).reindex(columns=names).assign(n=n, stretches=len(parts))


def change_against_nulls(
    parts: Sequence[Stretch], draws: int, rng: np.random.Generator, window_s: float
) -> pd.DataFrame:
    """Compare how refinement changes durations of transitions with tags placed by chance.

    Each tag goes to its nearest minimum within the window (the paper's plain rule), else it stays;
    the measure is the median change of the times between signs, in s, either way. Rows as
    `against_nulls`, a null each, without p: either side of chance may be looked for.
    """
    observed = _median_change([p.signs_s[None] for p in parts], parts, window_s)
    if not len(observed) or np.isnan(observed[0]):
        raise SignkinError(
            "no transition to compare with chance", place="nulls", expected="signs in a row"
        )
    rows = []
    for null in Null:
        chance = _median_change([placed(p, null, draws, rng) for p in parts], parts, window_s)
        low, high = np.quantile(chance, [0.025, 0.975], method="nearest")
        rows.append(
            {"null": str(null), "measure": CHANGE, "window_s": window_s, "value": observed[0],
             "chance": chance.mean(), "chance_low": low, "chance_high": high}
        )  # fmt: skip
    n = sum(len(p.signs_s) - 1 for p in parts)
    return pd.DataFrame(rows).assign(n=n, stretches=len(parts))


def _median_change(tags: Sequence[Array], parts: Sequence[Stretch], window_s: float) -> Array:
    """Return the median change of each draw. tags: (draws, N, 2) of each stretch."""
    changes = []
    for times, part in zip(tags, parts, strict=True):
        moves = _to_nearest(times, part.minima_s, window_s)
        changes.append(np.abs(moves[:, 1:, 0] - moves[:, :-1, 1]))
    together = np.concatenate(changes, axis=1) if changes else np.empty((0, 0))
    return np.median(together, axis=1) if together.size else np.full(1, NAN)


def _to_nearest(times: Array, minima: Array, window_s: float) -> Array:
    """Return how far each time moves to its nearest minimum; 0 where none lies within reach."""
    if not len(minima):
        return np.zeros_like(times)
    after = np.searchsorted(minima, times)
    beyond = minima[np.minimum(after, len(minima) - 1)] - times
    before = minima[np.maximum(after - 1, 0)] - times
    nearest = np.where(np.abs(before) <= np.abs(beyond), before, beyond)
    return np.where(np.abs(nearest) <= window_s + TOLERANCE_S, nearest, 0.0)


_Key = tuple[str, float]


def _key(key: _Key) -> dict[str, object]:
    return {"measure": key[0], "window_s": key[1]}


def _measures(pieces: Sequence[Array], windows_s: Sequence[float]) -> dict[_Key, Array]:
    """Return each measure for each draw. pieces: (draws, tags) distances of each stretch."""
    together = np.concatenate(pieces, axis=1)
    shares = {(SHARE, float(w)): (together <= w + TOLERANCE_S).mean(axis=1) for w in windows_s}
    return {
        **shares,
        (MEAN_SHARE, NAN): np.mean(list(shares.values()), axis=0),
        (MEDIAN, NAN): np.median(together, axis=1),
    }


def _compared(value: float, chance: Array, key: _Key) -> dict[str, float]:
    sign = -1 if key[0] == MEDIAN else 1
    # Shares of n tags are equal but for rounding, or differ by 1/n.
    as_near = int((sign * chance >= sign * value - 1e-12).sum())
    low, high = np.quantile(chance, [0.025, 0.975], method="nearest")
    return {
        "value": value,
        "chance": float(chance.mean()),
        "chance_low": float(low),
        "chance_high": float(high),
        "p": (1 + as_near) / (1 + len(chance)),
    }


def _poisson(
    parts: Sequence[Stretch], flags: Sequence[NDArray[np.bool_]], windows_s: Sequence[float]
) -> dict[_Key, float]:
    """Return what minima without any order would give, each stretch with its own rate."""
    weights = np.array([flag.sum() for flag in flags], dtype=float)
    rates = np.empty(len(parts))
    for i, part in enumerate(parts):
        low, high = part.span_s
        inside = (part.minima_s >= low) & (part.minima_s <= high)
        rates[i] = inside.sum() / max(high - low, 1 / part.rate_hz)

    def share(window: float) -> float:
        return float(np.average(-np.expm1(-2 * rates * window), weights=weights))

    shares = {(SHARE, float(w)): share(w) for w in windows_s}
    farthest = 1e6
    half = brentq(lambda w: share(w) - 0.5, 0.0, farthest) if share(farthest) > 0.5 else NAN
    return {
        **shares,
        (MEAN_SHARE, NAN): float(np.mean(list(shares.values()))),
        (MEDIAN, NAN): float(half),
    }
