"""GRIM: can n values on a grain have the printed mean? (Brown & Heathers 2017, exact here.)

Values that come in steps (whole frames, whole points of a scale) have sums that are whole
numbers of steps; a mean that no such sum gives cannot be right.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from signkin.audit.findings import CONSISTENT, INCONSISTENT, UNDECIDABLE, Finding
from signkin.audit.rounding import Interval, allowed, count, exactly, shown
from signkin.errors import SignkinError


@dataclass(frozen=True)
class Grim(Finding):
    """A finding with the sums, in grains, that the mean allows."""

    sums: tuple[int, ...] = ()


def grain_of(grain: str) -> Fraction:
    """Return the step of the values; zero or less is an error."""
    step = exactly(grain)
    if step <= 0:
        raise SignkinError(f"the grain is {grain}", expected="a step above 0")
    return step


def grim(mean: str, n: int | str, grain: str = "1", rounding: str = "nearest") -> Grim:
    """Say whether n multiples of `grain` can have the printed mean, and by which sums.

    mean, grain: as printed (`grain="0.01"` for seconds of whole frames at 100 Hz). Undecidable
    where n is so large that every mean with these decimals passes.
    """
    n, step, values = count(n), grain_of(grain), allowed(mean, rounding)
    total = Interval(values.low * n, values.high * n, values.low_open, values.high_open)
    sums = tuple(total.multiples(step))
    interval = f"{shown(total.low / step)} to {shown(total.high / step)} grains"
    if total.width >= step:
        return Grim(
            UNDECIDABLE,
            f"with n = {n} every mean with these decimals is a multiple of {grain} over n",
            mean,
            f"{len(sums)} sums",
            interval,
            sums=sums,
        )
    if sums:
        found = Fraction(sums[0]) * step / n
        why = f"{sums[0]} grains of {grain} over {n} are {shown(found)}"
        return Grim(CONSISTENT, why, mean, shown(found), interval, sums=sums)
    nearest = round(values.middle * n / step)
    why = (
        f"no sum of {n} multiples of {grain} gives {mean}; the nearest, {nearest} grains, gives "
        f"{shown(nearest * step / n)}"
    )
    return Grim(INCONSISTENT, why, mean, shown(nearest * step / n), interval)
