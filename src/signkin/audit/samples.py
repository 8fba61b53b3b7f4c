"""Samples that fit a printed mean and SD: all of them, or some drawn at random (SPRITE-like)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, floor, isqrt

import numpy as np

from signkin import seeds
from signkin.audit.grim import grain_of, grim
from signkin.audit.grimmer import grimmer
from signkin.audit.rounding import count, ratio
from signkin.audit.whole import Steps, TooLong, multisets
from signkin.errors import SignkinError

MOST_STEPS = 200_000
MOST_VALUES = 300


@dataclass(frozen=True)
class Samples:
    """Samples that fit a print, in grains, each sorted; all of them, or some drawn at random."""

    values: tuple[tuple[int, ...], ...]
    complete: bool
    grain: str


def samples(
    mean: str,
    sd: str,
    n: int | str,
    grain: str = "1",
    low: str | None = None,
    high: str | None = None,
    divisor: str = "n-1",
    most: int = 1000,
    seed: int = 0,
    rounding: str = "nearest",
) -> Samples:
    """Return samples of n multiples of `grain` in low..high that print this mean and SD.

    All of them (as sorted samples) where there are at most `most`; else `most` draws of a
    random walk with a seed: it redraws three values at a time among all triples with the same
    sum and sum of squares, which favours no sample that it can reach.
    """
    n = count(n)
    step = grain_of(grain)
    bottom = None if low is None else ceil(ratio(low) / step)
    top = None if high is None else floor(ratio(high) / step)
    if n > MOST_VALUES:
        raise SignkinError(f"samples of {n} values", expected=f"at most {MOST_VALUES}")
    if n == 1:
        kept = [s for s in grim(mean, 1, grain, rounding).sums if _inside(s, bottom, top)]
        return Samples(tuple((s,) for s in kept), True, grain)
    found: list[tuple[int, ...]] = []
    starts: list[tuple[int, ...]] = []
    fits = grimmer(mean, sd, n, grain, divisor, rounding)
    complete = fits.complete
    for total, squares in fits.pairs.get(divisor, ()):
        before = len(found)
        try:
            for values in multisets(n, total, squares, bottom, top, Steps(MOST_STEPS)):
                found.append(tuple(sorted(values)))
                if len(found) > most:
                    complete = False
                    break
        except TooLong:
            complete = False
        starts += found[before : before + 1]
        if len(found) > most:
            break
    if complete:
        return Samples(tuple(sorted(found)), True, grain)
    if not starts:
        raise SignkinError(
            f"the search for {n} values with mean {mean} and SD {sd} is too long",
            expected="a smaller n or SD, or a range of the values",
        )
    rng = seeds.stream(seed, "samples", mean, sd, str(n), grain)
    drawn = _walk(starts, bottom, top, most, rng)
    return Samples(tuple(drawn), False, grain)


def _inside(value: int, low: int | None, high: int | None) -> bool:
    return (low is None or value >= low) and (high is None or value <= high)


def _walk(
    starts: list[tuple[int, ...]],
    low: int | None,
    high: int | None,
    draws: int,
    rng: np.random.Generator,
) -> Iterator[tuple[int, ...]]:
    n = len(starts[0])
    current = [list(start) for start in starts]
    for draw in range(draws):
        values = current[draw % len(current)]
        for _ in range(2 * n):
            at = rng.choice(n, size=3, replace=False)
            s = sum(values[i] for i in at)
            q = sum(values[i] ** 2 for i in at)
            options = [t for t in _triples(s, q) if all(_inside(v, low, high) for v in t)]
            for i, v in zip(at, options[int(rng.integers(len(options)))], strict=True):
                values[i] = v
        yield tuple(sorted(values))


@lru_cache(maxsize=4096)
def _triples(s: int, q: int) -> tuple[tuple[int, int, int], ...]:
    """Return all ordered triples of whole numbers with a sum and a sum of squares."""
    out = []
    spread = isqrt(max(0, 2 * (3 * q - s * s))) // 3 + 1
    for a in range(s // 3 - spread - 1, s // 3 + spread + 2):
        rest, squares = s - a, q - a * a
        square = 2 * squares - rest * rest
        if square < 0:
            continue
        root = isqrt(square)
        if root * root == square and (rest + root) % 2 == 0:
            b, c = (rest + root) // 2, (rest - root) // 2
            out += [(a, b, c)] if b == c else [(a, b, c), (a, c, b)]
    return tuple(out)
