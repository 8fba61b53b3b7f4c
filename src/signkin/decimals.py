"""Printing numbers as papers do: exact fractions, rounded half up, trailing zeros kept.

Binary floating point cannot tell 413/1600 from its neighbours (0.258125 prints as
0.25813 or 0.25812); fractions can.
"""

from __future__ import annotations

from collections.abc import Iterable
from decimal import ROUND_HALF_UP, Decimal, localcontext
from fractions import Fraction

# Times come from files with finite decimals; a nanosecond keeps all of them.
TIME_DECIMALS = 9


def exact(seconds: float) -> Fraction:
    """Return a time as the decimal number it was written as."""
    return Fraction(f"{seconds:.{TIME_DECIMALS}f}")


def mean(values: Iterable[Fraction]) -> Fraction:
    """Return the exact mean."""
    items = list(values)
    return sum(items, Fraction(0)) / len(items)


def variance(values: Iterable[Fraction]) -> Fraction:
    """Return the exact variance with divisor n - 1."""
    items = list(values)
    centre = mean(items)
    return sum(((x - centre) ** 2 for x in items), Fraction(0)) / (len(items) - 1)


def places_of(printed: str) -> int:
    """Return the number of decimals of a printed number: `0.3150` has 4."""
    return len(printed.partition(".")[2])


def fixed(value: Fraction, places: int) -> str:
    """Print a fraction with a number of decimals, rounded half up."""
    return _rounded(_decimal(value), places)


def fixed_root(square: Fraction, places: int) -> str:
    """Print the square root of a fraction with a number of decimals, rounded half up."""
    with localcontext() as context:
        context.prec = 60
        return _rounded(_decimal(square).sqrt(), places)


def places_for(value: float, significant: int = 5) -> int:
    """Return the decimals that show a number to so many significant digits."""
    if value == 0:
        return 0
    exponent = Decimal(f"{abs(value):.{significant - 1}e}").adjusted()
    return max(0, significant - 1 - exponent)


def _decimal(value: Fraction) -> Decimal:
    with localcontext() as context:
        context.prec = 60
        return Decimal(value.numerator) / Decimal(value.denominator)


def _rounded(value: Decimal, places: int) -> str:
    with localcontext() as context:
        context.prec = 80
        return str(value.quantize(Decimal(1).scaleb(-places), rounding=ROUND_HALF_UP))
