"""What a printed number allows: the interval of values that print so.

Numbers are strings, because trailing zeros count: `0.310` allows a tenth of what `0.31` does.
Everything is exact (fractions); nothing here knows a paper or a unit.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from math import ceil, exp, floor

from signkin.errors import SignkinError, listed

ROUNDINGS = ("nearest", "half_up", "half_even", "truncated", "any")
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?")


@dataclass(frozen=True)
class Interval:
    """The values from `low` to `high`; an end that is `open` is not one of them.

    Arithmetic returns every value the operands allow (ends counted as closed).
    """

    low: Fraction
    high: Fraction
    low_open: bool = False
    high_open: bool = False

    def __contains__(self, value: Fraction) -> bool:
        """Whether a value lies inside."""
        above = value > self.low if self.low_open else value >= self.low
        below = value < self.high if self.high_open else value <= self.high
        return above and below

    def meets(self, other: Interval) -> bool:
        """Whether the two have a value in common."""
        low, high = max(self.low, other.low), min(self.high, other.high)
        return low < high or (low == high and low in self and low in other)

    @property
    def width(self) -> Fraction:
        """High less low."""
        return self.high - self.low

    @property
    def middle(self) -> Fraction:
        """Half way."""
        return (self.low + self.high) / 2

    def multiples(self, step: Fraction) -> range:
        """Return the integers k with k * step inside."""
        first, last = ceil(self.low / step), floor(self.high / step)
        if self.low_open and first * step == self.low:
            first += 1
        if self.high_open and last * step == self.high:
            last -= 1
        return range(first, last + 1)

    def __add__(self, other: Interval | Fraction | int) -> Interval:
        """Sum."""
        other = as_interval(other)
        return Interval(self.low + other.low, self.high + other.high)

    __radd__ = __add__

    def __neg__(self) -> Interval:
        """Mirror in zero."""
        return Interval(-self.high, -self.low, self.high_open, self.low_open)

    def __sub__(self, other: Interval | Fraction | int) -> Interval:
        """Difference."""
        return self + (-as_interval(other))

    def __rsub__(self, other: Interval | Fraction | int) -> Interval:
        """Difference."""
        return as_interval(other) - self

    def __mul__(self, other: Interval | Fraction | int) -> Interval:
        """Product."""
        other = as_interval(other)
        ends = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return Interval(min(ends), max(ends))

    __rmul__ = __mul__

    def __truediv__(self, other: Interval | Fraction | int) -> Interval:
        """Quotient; a divisor that may be zero is an error."""
        other = as_interval(other)
        if other.low <= 0 <= other.high:
            raise SignkinError(
                "division by a number that may be zero", expected="a divisor away from zero"
            )
        return self * Interval(1 / other.high, 1 / other.low)

    def __rtruediv__(self, other: Interval | Fraction | int) -> Interval:
        """Quotient."""
        return as_interval(other) / self

    def __pow__(self, power: int) -> Interval:
        """Whole power from 0."""
        out = Interval(Fraction(1), Fraction(1))
        for _ in range(power):
            out = out * self
        if power % 2 == 0 and power and self.low < 0 < self.high:
            return Interval(Fraction(0), out.high)
        return out

    def __abs__(self) -> Interval:
        """Absolute value."""
        if self.low >= 0:
            return self
        if self.high <= 0:
            return -self
        return Interval(Fraction(0), max(-self.low, self.high))

    def __str__(self) -> str:
        """`0.26825 to 0.26835`, or the one value."""
        if self.low == self.high:
            return shown(self.low)
        return f"{shown(self.low)} to {shown(self.high)}"


def as_interval(value: Interval | Fraction | int) -> Interval:
    """Return an interval of one value, or the interval itself."""
    return value if isinstance(value, Interval) else Interval(Fraction(value), Fraction(value))


def number(printed: str) -> Decimal:
    """Return a printed number as it stands; a comma or any other text is an error."""
    if not isinstance(printed, str):
        raise SignkinError(
            f"the number {printed!r} is no text",
            expected="the printed digits in quotes, because trailing zeros count",
        )
    text = printed.strip().replace("\u2212", "-")
    if not _NUMBER.fullmatch(text):
        todo = "Write a decimal point." if "," in text else None
        raise SignkinError(
            f"{printed!r} is no number", expected="digits with a decimal point", todo=todo
        )
    value = Decimal(text)
    exponent = value.as_tuple().exponent
    if len(text) > 60 or not isinstance(exponent, int) or abs(exponent) > 300:
        raise SignkinError(
            f"the number {printed[:20]!r}... is too long", expected="at most 60 digits, 1e300"
        )
    return value


def is_number(printed: str) -> bool:
    """Whether a printed text is one number (no bound, no word)."""
    return _NUMBER.fullmatch(printed.strip().replace("\u2212", "-")) is not None


def count(printed: str | int) -> int:
    """Return a printed count: a whole number from 1."""
    text = str(printed).strip()
    if not re.fullmatch(r"\d{1,15}", text) or int(text) < 1:
        raise SignkinError(f"n is {text[:40]!r}", expected="a whole number from 1")
    return int(text)


def exactly(printed: str) -> Fraction:
    """Return a printed number as an exact one."""
    return Fraction(number(printed))


def ratio(printed: str) -> Fraction:
    """Return an exact number, which may be written as a ratio: `0.01`, `1/3`."""
    above, line, below = str(printed).partition("/")
    if not line:
        return exactly(printed)
    divisor = exactly(below)
    if divisor == 0:
        raise SignkinError(f"the ratio {printed!r}", expected="a divisor other than 0")
    return exactly(above) / divisor


def allowed(printed: str, rounding: str = "nearest") -> Interval:
    """Return the values that a printed number stands for.

    rounding: `nearest` (half a unit of the last digit to both sides, a tie may have gone either
    way: nothing is accused that any usual rule allows), `half_up` (ties away from zero),
    `half_even`, `truncated`, or `any` (nearest or cut off, where a paper leaves it open).
    """
    if rounding not in ROUNDINGS:
        raise SignkinError(f"the rounding {rounding!r}", expected=listed(ROUNDINGS))
    value = number(printed)
    exponent = value.as_tuple().exponent
    assert isinstance(exponent, int)
    unit = Fraction(10) ** exponent
    size, half = abs(Fraction(value)), unit / 2
    if rounding in ("truncated", "any"):
        part = Interval(size - (half if rounding == "any" else 0), size + unit, high_open=True)
        if size == 0:
            return Interval(-unit, unit, low_open=True, high_open=True)
    else:
        odd = value.as_tuple().digits[-1] % 2 == 1
        part = Interval(
            size - half,
            size + half,
            low_open=rounding == "half_even" and odd,
            high_open=rounding == "half_up" or (rounding == "half_even" and odd),
        )
        if size == 0 and rounding == "half_up":
            return Interval(-half, half, low_open=True, high_open=True)
    return -part if value < 0 else part


def root(value: Interval | Fraction | float) -> Interval | float:
    """Return the square root; of an interval that may lie below zero it is an error."""
    return _each(value, lambda x: x**0.5, lowest=0, what="the square root")


def exponential(value: Interval | Fraction | float) -> Interval | float:
    """Return e to a power, of a number or of an interval."""
    return _each(value, exp, highest=700, what="exp")


def _each(
    value: Interval | Fraction | float,
    function: Callable[[float], float],
    lowest: float = float("-inf"),
    highest: float = float("inf"),
    what: str = "",
) -> Interval | float:
    """Return a rising function of a number or of both ends; floats are off by 1e-15 at most."""
    ends = None if isinstance(value, float) else as_interval(value)
    low: Fraction | float = float(value) if isinstance(value, float) else as_interval(value).low
    high: Fraction | float = low if isinstance(value, float) else as_interval(value).high
    if low < lowest or high > highest:
        raise SignkinError(
            f"{what} of {shown(low)}" + ("" if low == high else f" to {shown(high)}"),
            expected=f"a number from {lowest:g}" if low < lowest else f"one up to {highest:g}",
        )
    if ends is None:
        return function(float(low))
    first, last = (Fraction(function(float(end))) for end in (low, high))
    tiny = Fraction(1, 10**15)
    if low == high and first * first == low:  # an exact root
        return Interval(first, first)
    return Interval(first * (1 - tiny), last * (1 + tiny), ends.low_open, ends.high_open)


def shown(value: Fraction | float, significant: int = 7) -> str:
    """Return a number for people: up to so many significant digits, no trailing noise."""
    return f"{float(value):.{significant}g}"
