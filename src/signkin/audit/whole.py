"""Which sums of squares can n whole numbers with a given sum have, within bounds?

Sum and sum of squares have one parity. Without bounds 16 numbers or more can have every sum of
squares of that parity from the least one on: with r <= n / 2 ones and zeros elsewhere, eight of
the zeros stay free, and four pairs (a, -a) among them add 2 (a^2 + b^2 + c^2 + d^2), which is
every even number (Lagrange); r > n / 2 is the same seen from 1 (x -> 1 - x). Fewer numbers, and
bounds that cut, are searched, in a counted number of steps.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain
from math import isqrt

from signkin.audit.rounding import Interval

MOST_STEPS = 8_000  # of one question; beyond it the answer is that there is none
ALWAYS = 16  # so many numbers have every sum of squares
FREE = 60  # numbers searched one by one; further ones are set aside
Pair = tuple[int, int]


class TooLong(Exception):
    """The search has used up its steps."""


@dataclass
class Steps:
    """The steps that a search may still take."""

    left: int = MOST_STEPS

    def take(self, number: int = 1) -> None:
        """Take steps; raises TooLong when there are none left."""
        self.left -= number
        if self.left < 0:
            raise TooLong


def least_squares(n: int, total: int) -> int:
    """Return the least sum of squares of n whole numbers with a sum: all beside the mean."""
    low, ones = divmod(total, n)
    return (n - ones) * low * low + ones * (low + 1) ** 2


def most_squares(n: int, total: int, low: int, high: int) -> int:
    """Return the greatest one within bounds: all at a bound but one. n low <= total <= n high."""
    if high == low:
        return n * low * low
    tops, rest = divmod(total - n * low, high - low)
    if rest == 0:
        return tops * high * high + (n - tops) * low * low
    return tops * high * high + (low + rest) ** 2 + (n - tops - 1) * low * low


def bounds_of(
    n: int, total: int, squares: int, low: int | None, high: int | None
) -> tuple[int, int, bool]:
    """Return the least and greatest value that one number can have, and whether bounds cut.

    No value lies farther from the mean than sqrt(ss (n - 1) / n).
    """
    ss_n = n * squares - total * total  # n times the sum of squares around the mean
    reach = isqrt(max(0, ss_n * (n - 1)))
    bottom, top = -((reach - total) // n), (total + reach) // n
    cut = (low is not None and low > bottom) or (high is not None and high < top)
    return (
        bottom if low is None else max(low, bottom),
        top if high is None else min(high, top),
        cut,
    )


def possible(
    n: int,
    total: int,
    squares: int,
    low: int | None = None,
    high: int | None = None,
    steps: Steps | None = None,
) -> bool | None:
    """Whether n whole numbers in low..high have a sum and a sum of squares; None: too long."""
    if (total - squares) % 2 or squares < least_squares(n, total):
        return False
    bottom, top, cut = bounds_of(n, total, squares, low, high)
    if bottom > top or not n * bottom <= total <= n * top:
        return False
    if squares > most_squares(n, total, bottom, top):
        return False
    if not cut and n >= ALWAYS:
        return True
    steps = steps or Steps()
    try:
        if n <= FREE:
            return next(multisets(n, total, squares, bottom, top, steps), None) is not None
        windows = _windows(n, total, squares, bottom, top)
        found = any(_set_aside(n, total, squares, *window, steps) for window in windows)
        return True if found else None
    except TooLong:
        return None


def _windows(n: int, total: int, squares: int, low: int, high: int) -> Iterator[tuple[int, int]]:
    """Yield bounds around the mean within the given ones: what fits in them fits in those."""
    mean = total // n
    sd = isqrt(max(0, n * squares - total * total)) // n + 1
    for times in (2, 4):
        bottom, top = max(low, mean - times * sd), min(high, mean + times * sd)
        inside = bottom < top and n * bottom <= total <= n * top
        if inside and squares <= most_squares(n, total, bottom, top):
            yield bottom, top
    yield low, high


def _set_aside(n: int, total: int, squares: int, low: int, high: int, steps: Steps) -> bool:
    """Look for many numbers: some at the bounds, some at the mean, FREE ones searched."""

    def rest(extremes: int) -> tuple[int, int, int]:
        at_high = extremes * (total - n * low) // (n * (high - low))
        at_low = extremes - at_high
        return (
            n - extremes,
            total - at_high * high - at_low * low,
            squares - at_high * high * high - at_low * low * low,
        )

    few, many = 0, n - 1
    while few < many:  # as many at the bounds as the squares allow
        middle = (few + many + 1) // 2
        k, s, q = rest(middle)
        few, many = (middle, many) if q >= least_squares(k, s) else (few, middle - 1)
    for fewer in (0, 2, 5, 10, 20, 40, 80):
        if fewer > few:
            break
        k, s, q = rest(few - fewer)
        away, (floor, ones) = max(0, k - FREE), divmod(s, k)
        up = ones * away // k
        s -= away * floor + up
        q -= (away - up) * floor**2 + up * (floor + 1) ** 2
        if next(multisets(k - away, s, q, low, high, steps), None) is not None:
            return True
    return False


def multisets(
    n: int, total: int, squares: int, low: int | None, high: int | None, steps: Steps
) -> Iterator[tuple[int, ...]]:
    """Yield all falling sequences of n whole numbers with a sum and a sum of squares.

    Moved to a mean near zero first, which keeps the numbers small. Raises TooLong.
    """
    shift = total // n
    moved = total - n * shift
    moved_squares = squares - 2 * shift * total + n * shift * shift
    reach = isqrt(max(moved_squares, 0))
    bottom = -reach if low is None else max(low - shift, -reach)
    top = reach if high is None else min(high - shift, reach)
    dead: set[tuple[int, int, int, int]] = set()

    def search(k: int, s: int, q: int, most: int) -> Iterator[tuple[int, ...]]:
        # k numbers left, none above `most`, with sum s and squares q.
        if (q - s) % 2 or not k * bottom <= s <= k * most or q < least_squares(k, s):
            return
        if q > most_squares(k, s, bottom, most):
            return
        if k == 1:
            yield (s,)  # q is both the least and the greatest: s^2
            return
        if k == 2:
            root = isqrt(2 * q - s * s)
            if root * root == 2 * q - s * s and (s + root) % 2 == 0:
                larger, smaller = (s + root) // 2, (s - root) // 2
                if larger <= most and smaller >= bottom:
                    yield (larger, smaller)
            return
        state = (k, s, q, most)
        if state in dead:
            return
        found = False
        # The largest number is at least the mean, and no farther from it than the spread allows.
        spread = isqrt((k - 1) * (k * q - s * s)) // k + 1
        first = min(most, s // k + spread + 1, isqrt(q))
        last = max(-(-s // k), bottom)
        for value in range(first, last - 1, -1):
            steps.take()
            for others in search(k - 1, s - value, q - value * value, value):
                found = True
                yield (value, *others)
        if not found:
            dead.add(state)

    if moved_squares >= 0 and bottom <= top:
        for values in search(n, moved, moved_squares, top):
            yield tuple(value + shift for value in values)


@dataclass(frozen=True)
class Span:
    """The values of a variance's root (an SD), in steps, as an interval, and its divisor."""

    sd: Interval
    step: Fraction
    divisor: int

    def squares(self, n: int, total: int) -> range:
        """Return the sums of squares, of the right parity, that the SD allows beside a sum."""
        low, high = (
            max(edge, Fraction(0)) ** 2 * self.divisor / self.step**2
            for edge in (self.sd.low, self.sd.high)
        )
        first, first_exact = _edge(low, total, n, up=True)
        last, last_exact = _edge(high, total, n, up=False)
        if self.sd.low_open and self.sd.low >= 0 and first_exact:
            first += 1
        if self.sd.high_open and last_exact:
            last -= 1
        first = max(first, least_squares(n, total))
        return range(first + (first - total) % 2, last + 1, 2)


def _edge(ss: Fraction, total: int, n: int, up: bool) -> tuple[int, bool]:
    """Return ss + total^2 / n as a whole number, rounded up or down, and whether it is one."""
    top = ss.numerator * n + total * total * ss.denominator
    whole, rest = divmod(top, n * ss.denominator)
    return whole + (1 if up and rest else 0), rest == 0


def pairs_allowed(
    n: int,
    sums: Iterable[int],
    span: Span,
    low: int | None = None,
    high: int | None = None,
    steps: Steps | None = None,
) -> Iterator[Pair | None]:
    """Yield each (sum, sum of squares) that n whole numbers can have and the print allows.

    None stands for a pair whose search was too long. Raises TooLong after all steps.
    """
    steps = steps or Steps()
    for total in sums:
        steps.take()
        squares = span.squares(n, total)
        if squares and (low is not None or high is not None):
            # One bound and the sum imply another.
            bottom = total - (n - 1) * high if low is None and high is not None else low
            top = total - (n - 1) * low if high is None and low is not None else high
            assert bottom is not None and top is not None
            if not n * bottom <= total <= n * top:
                continue
            most = most_squares(n, total, bottom, top)
            squares = squares[: max(0, (most - squares[0]) // 2 + 1)]
        for found in _outwards(squares):
            own = Steps(min(steps.left, MOST_STEPS // 8))
            before = own.left
            answer = possible(n, total, found, low, high, own)
            steps.take(1 + before - max(own.left, 0))
            if answer is not False:
                yield None if answer is None else (total, found)


def _outwards(squares: range) -> Iterator[int]:
    """Yield the middle half first: at the ends of what bounds allow there are gaps."""
    quarter = len(squares) // 4
    middle = squares[quarter : len(squares) - quarter]
    yield from chain(middle, squares[:quarter], squares[len(squares) - quarter :])
