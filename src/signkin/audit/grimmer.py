"""GRIMMER by exact search: can n values on a grain have the printed mean and SD?

In whole grains a sample has a whole sum and a whole sum of squares, of the same parity. Every
pair that the print allows is tried for n whole numbers that have it (`whole`), instead of the
shortcuts of the published tests, one of which accuses wrongly. With the bounds of a scale no SD
is above sqrt((high - mean)(mean - low) n / (n - 1)); for 0 and 1 that is DEBIT.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil, floor

from signkin.audit.findings import CONSISTENT, INCONSISTENT, UNDECIDABLE, Finding
from signkin.audit.grim import grain_of, grim
from signkin.audit.rounding import Interval, allowed, count, exactly, ratio, shown
from signkin.audit.whole import Pair, Span, Steps, TooLong, pairs_allowed, possible
from signkin.errors import SignkinError, listed

DIVISORS = ("n-1", "n")
SPREADS = ("sd", "se")  # what is printed beside the mean: an SD, or a standard error
MOST_PAIRS = 2_000


@dataclass(frozen=True)
class Grimmer(Finding):
    """A finding with the pairs (sum, sum of squares), in grains, for each divisor of the SD.

    complete: whether these are all pairs; else there are more than were listed.
    """

    pairs: Mapping[str, tuple[Pair, ...]] = field(default_factory=dict)
    complete: bool = True


@dataclass(frozen=True)
class _Tried:
    pairs: tuple[Pair, ...]
    open: bool  # a search was too long, or more pairs may be there
    why: str = ""


def times_of(n: int, divisor: str, spread: str = "sd") -> int:
    """Return what the square of a printed SD (or standard error) times is the sum of squares."""
    if divisor not in DIVISORS:
        raise SignkinError(f"the divisor {divisor!r}", expected=listed(DIVISORS))
    if spread not in SPREADS:
        raise SignkinError(f"the spread {spread!r}", expected=listed(SPREADS))
    return (n - 1 if divisor == "n-1" else n) * (n if spread == "se" else 1)


def grimmer(
    mean: str,
    sd: str,
    n: int | str,
    grain: str = "1",
    divisor: str = "either",
    rounding: str = "nearest",
    items: int | str = 1,
    low: str = "",
    high: str = "",
    spread: str = "sd",
) -> Grimmer:
    """Say whether n multiples of `grain` can have the printed mean and standard deviation.

    divisor: `n-1`, `n` or `either`. A single value has no SD with n - 1: a printed 0 there is
    undecidable (a convention), anything else inconsistent. items: each value is the mean of so
    many answers on the grain. low, high: the ends of the scale. spread: `sd`, or `se` where the
    standard error is printed.
    """
    if divisor not in (*DIVISORS, "either"):
        raise SignkinError(f"the divisor {divisor!r}", expected=listed((*DIVISORS, "either")))
    n = count(n)
    of_mean = grim(mean, n, grain, rounding, items)
    between = allowed(sd, rounding)
    if between.high < 0 or exactly(sd) < 0:
        raise SignkinError(f"the SD is {sd}", expected="a number from 0")
    printed = f"{mean} ({sd})"
    if of_mean.verdict == INCONSISTENT:
        return Grimmer(INCONSISTENT, of_mean.why, printed, of_mean.recomputed, of_mean.interval,
                       nearest=f"mean {of_mean.nearest}")  # fmt: skip
    step = grain_of(grain, items)
    edges = (ceil(ratio(low) / step) if low else None, floor(ratio(high) / step) if high else None)
    outside = _outside(mean, n, of_mean.sums, edges, (low, high))
    if outside:
        return Grimmer(INCONSISTENT, outside, printed, of_mean.recomputed, of_mean.interval)
    if n == 1:
        return _single(sd, of_mean.sums)
    tried = DIVISORS if divisor == "either" else (divisor,)
    found = {
        d: _try(n, of_mean.sums, Span(between, step, times_of(n, d, spread)), *edges) for d in tried
    }
    pairs = {d: f.pairs for d, f in found.items()}
    complete = not any(f.open for f in found.values())
    told = grain if str(items) == "1" else f"{grain} / {items} (items)"
    word = "SD" if spread == "sd" else "standard error"
    fitting = [d for d in tried if pairs[d]]
    if not fitting and not complete:
        why = next(f.why for f in found.values() if f.open)
        return Grimmer(UNDECIDABLE, why, printed, pairs=pairs, complete=False)
    if not fitting:
        scale = f" from {low or 'any'} to {high or 'any'}" if low or high else ""
        why = f"no {n} multiples of {told}{scale} have mean {mean} and {word} {sd} with divisor "
        return Grimmer(
            INCONSISTENT, why + " or ".join(tried), printed,
            _nearest(n, of_mean.sums, between, step, times_of(n, tried[0], spread),
                     word, len(sd.partition(".")[2])), pairs=pairs,
        )  # fmt: skip
    return _fits(n, fitting, found, told, step, spread, (printed, str(between), complete))


def _try(n: int, sums: Sequence[int], span: Span, low: int | None, high: int | None) -> _Tried:
    pairs: list[Pair] = []
    unsure = False
    try:
        for pair in pairs_allowed(n, sums, span, low, high, Steps()):
            if pair is None:
                unsure = True
            elif len(pairs) == MOST_PAIRS:
                return _Tried(tuple(sorted(pairs)), True, f"more than {MOST_PAIRS} pairs fit")
            else:
                pairs.append(pair)
    except TooLong:
        unsure = True
    return _Tried(tuple(sorted(pairs)), unsure, "too many samples to try: the search was cut off")


def _outside(
    mean: str, n: int, sums: Sequence[int], edges: tuple[int | None, int | None],
    told: tuple[str, str],
) -> str:  # fmt: skip
    """Return why a mean lies outside its scale, or nothing."""
    low, high = edges
    if low is not None and high is not None and low > high:
        raise SignkinError(f"the scale from {told[0]} to {told[1]}", expected="its lower end first")
    if low is not None and sums[-1] < n * low:
        return f"the mean {mean} lies below {told[0]}, the lower end of the scale"
    if high is not None and sums[0] > n * high:
        return f"the mean {mean} lies above {told[1]}, the upper end of the scale"
    return ""


def _fits(
    n: int, fitting: Sequence[str], tried: Mapping[str, _Tried], grain: str, step: Fraction,
    spread: str, told: tuple[str, str, bool],
) -> Grimmer:  # fmt: skip
    d = fitting[0]
    found = tried[d].pairs
    one = f"in grains of {grain}: sum {found[0][0]}, sum of squares {found[0][1]}"
    number = f"{len(found)} pairs" if not tried[d].open else f"{len(found)} pairs or more"
    why = one if len(found) == 1 and told[2] else f"{number} of sum and sum of squares fit"
    why += f", divisor {' or '.join(fitting)}"
    by = n**0.5 if spread == "se" else 1.0
    sds = [sd_of(pair, n, d) * float(step) / by for pair in found]
    recomputed = f"{shown(Fraction(found[0][0]) * step / n)} ({min(sds):.6g}"
    recomputed += ")" if len(found) == 1 else f" to {max(sds):.6g})"
    pairs = {name: f.pairs for name, f in tried.items()}
    return Grimmer(CONSISTENT, why, told[0], recomputed, told[1], pairs=pairs, complete=told[2])


def _nearest(
    n: int, sums: Sequence[int], sd: Interval, step: Fraction, times: int, word: str, places: int
) -> str:
    """Return the nearest SDs that the first possible sum has, to both sides (no bounds).

    word: `SD` or `standard error`. places: decimals of the printed one.
    """
    if not sums:
        return ""
    total, found = sums[0], []
    below = floor(sd.middle**2 * times / step**2 + Fraction(total * total, n))
    below -= (below - total) % 2  # as odd or even as the sum
    for way, start in ((-2, below), (2, below + 2)):
        for squares in range(start, start + 200 * way, way):
            if possible(n, total, squares, steps=Steps(2_000)):
                root = float((squares - Fraction(total * total, n)) * step**2 / times) ** 0.5
                found.append(f"{root:.{places}f}" if places < 9 else f"{root:.6g}")
                break
    return f"nearest possible: {word} {' or '.join(dict.fromkeys(found))}" if found else ""


def _single(sd: str, sums: Sequence[int]) -> Grimmer:
    pairs = {"n": tuple((s, s * s) for s in sums[:MOST_PAIRS])}
    if exactly(sd) == 0:
        why = "a single value has no SD with divisor n - 1; the printed 0 is a convention"
        return Grimmer(UNDECIDABLE, why, sd, pairs=pairs)
    return Grimmer(INCONSISTENT, f"a single value has no SD, and {sd} is printed", sd)


def sd_of(pair: Pair, n: int, divisor: str = "n-1") -> float:
    """Return the SD, in grains, of n values with a sum and sum of squares."""
    total, squares = pair
    ss = Fraction(squares) - Fraction(total * total, n)
    return float(ss / (n - 1 if divisor == "n-1" else n)) ** 0.5
