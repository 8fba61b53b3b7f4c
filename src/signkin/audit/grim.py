"""GRIM: can n values on a grain have the printed mean? (Brown & Heathers 2017, exact here.)

Values that come in steps (whole frames, whole points of a scale) have sums that are whole
numbers of steps; a mean that no such sum gives cannot be right. The mean of a scale of three
items comes in thirds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import floor

from signkin.audit.findings import CONSISTENT, INCONSISTENT, UNDECIDABLE, Finding
from signkin.audit.rounding import Interval, allowed, count, ratio, shown
from signkin.errors import SignkinError


@dataclass(frozen=True)
class Grim(Finding):
    """A finding with the sums, in grains, that the mean allows (a range of whole numbers)."""

    sums: Sequence[int] = ()


def grain_of(grain: str, items: int | str = 1) -> Fraction:
    """Return the step of the values: the grain over the items that each is the mean of.

    grain: a number or a ratio (`0.01`, `1/3`); zero or less is an error.
    """
    step = ratio(grain)
    if step <= 0:
        raise SignkinError(f"the grain is {grain}", expected="a step above 0")
    try:
        return step / count(items)
    except SignkinError:
        raise SignkinError(f"items is {items!r}", expected="a whole number from 1") from None


def grim(
    mean: str,
    n: int | str,
    grain: str = "1",
    rounding: str = "nearest",
    items: int | str = 1,
) -> Grim:
    """Say whether n multiples of `grain` can have the printed mean, and by which sums.

    mean: as printed. grain: the step of one answer (`0.01` for seconds of whole frames at
    100 Hz, `1/3`; 100 for percentages of people). items: how many answers each value is the
    mean of. Undecidable where n is so large that every mean with these decimals passes.
    """
    n, step, values = count(n), grain_of(grain, items), allowed(mean, rounding)
    total = Interval(values.low * n, values.high * n, values.low_open, values.high_open)
    sums = total.multiples(step)
    interval = f"{shown(total.low / step)} to {shown(total.high / step)} grains"
    told = grain if str(items) == "1" else f"{grain} / {items} (items)"
    if total.width >= step:
        return Grim(
            UNDECIDABLE,
            f"with n = {n} every mean with these decimals is a multiple of {told} over n",
            mean,
            f"{len(sums)} sums",
            interval,
            sums=sums,
        )
    if sums:
        found = Fraction(sums[0]) * step / n
        why = f"{sums[0]} grains of {told} over {n} are {shown(found)}"
        return Grim(CONSISTENT, why, mean, shown(found), interval, sums=sums)
    nearest = round(values.middle * n / step)
    why = (
        f"no sum of {n} multiples of {told} gives {mean}; the nearest, {nearest} grains, gives "
        f"{shown(nearest * step / n)}"
    )
    return Grim(
        INCONSISTENT, why, mean, shown(nearest * step / n), interval,
        nearest=_neighbours(values.middle, n, step, mean),
    )  # fmt: skip


def _neighbours(value: Fraction, n: int, step: Fraction, mean: str) -> str:
    """Return the possible means to both sides of a printed one, with its decimals."""
    places = len(mean.partition(".")[2]) if "e" not in mean.lower() else 2
    below = floor(value * n / step)
    found = [f"{float(k * step / n):.{places}f}" for k in (below, below + 1)]
    return " or ".join(dict.fromkeys(found))
