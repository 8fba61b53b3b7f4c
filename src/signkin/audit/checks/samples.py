"""Checks that show what data could stand behind a mean and an SD: all samples, or some of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from signkin import seeds
from signkin.audit.checks.groups import want_names
from signkin.audit.checks.rows import Row, each, rows_of, scale_columns, scale_of, want_settings
from signkin.audit.closure import count_samples
from signkin.audit.findings import (
    CONSISTENT,
    INCONSISTENT,
    UNDECIDABLE,
    Copies,
    Finding,
    over_readings,
)
from signkin.audit.grim import grain_of, grim
from signkin.audit.grimmer import DIVISORS, grimmer, times_of
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.rounding import allowed, count, ratio, shown
from signkin.audit.sprite import draw_samples
from signkin.audit.whole import Span
from signkin.errors import SignkinError

MOST_PAIRS = 20_000
MOST_BARS = 40  # a histogram with more is drawn in classes
MOST_DRAWS = 200


class _Asked:
    """What a row asks for: n, the sums and the span of the SD in grains, and the scale.

    ends: values that are known to be there (the observed least and greatest), in grains.
    """

    def __init__(
        self, row: Row, grain: str, scale: tuple[str, str], observed: bool, divisor: str,
        items: str, rounding: str,
    ) -> None:  # fmt: skip
        self.n, self.step = count(row["n"]), grain_of(grain, items)
        self.low = ceil(ratio(scale[0]) / self.step) if scale[0] else None
        self.high = floor(ratio(scale[1]) / self.step) if scale[1] else None
        # What cannot be is found out first: GRIM, the ends of the scale, GRIMMER.
        self.first: Finding = grimmer(
            row["mean"], row["sd"], self.n, grain, divisor, rounding, items, *scale
        )
        self.sums = grim(row["mean"], self.n, grain, rounding, items).sums
        self.span = Span(allowed(row["sd"], rounding), self.step, times_of(self.n, divisor))
        told = [f"grain {grain}"] + ([f"items {items}"] if items != "1" else [])
        told += [f"{scale[0] or 'any'} to {scale[1] or 'any'}"] if any(scale) else []
        self.ends: tuple[int, ...] = ()
        if observed:
            if self.low is None or self.high is None:
                raise SignkinError("an observed range lacks an end", expected="low and high")
            told += ["both ends observed"]
            self.ends = (self.low, self.high) if self.n > 2 and self.low < self.high else ()
        self.settings = ", ".join([*told, f"divisor {divisor}"])
        self.printed = f"{row['mean']} ({row['sd']}), n = {row['n']}"

    def plain(self, verdict: str, why: str) -> Finding:
        return Finding(verdict, why, self.printed, settings=self.settings)

    @property
    def others(self) -> int:
        """How many values are not known."""
        return self.n - len(self.ends)

    def sums_of_others(self) -> list[int]:
        return [total - sum(self.ends) for total in self.sums]

    def squares_of_others(self, total: int) -> range:
        """Return the sums of squares that the others may have beside their sum."""
        known = sum(v * v for v in self.ends)
        squares = self.span.squares(self.n, total + sum(self.ends))
        return range(squares.start - known, squares.stop - known, 2)

    def impossible(self) -> Finding | None:
        """Return the finding where there is no sample, or no SD (n = 1)."""
        if self.first.verdict != INCONSISTENT and self.n > 1:
            return None
        found = self.plain(self.first.verdict, self.first.why)
        return replace(found, nearest=self.first.recomputed)


@on_print(
    "means and SDs",
    {"mean": "2.7", "sd": "1.9", "n": "100", "grain": "1", "low": "1", "high": "5"},
)
def closure(
    context: OnPrint, grain: str, low: str = "", high: str = "", table: str = "", n: str = "n",
    mean: str = "mean", sd: str = "sd", divisor: str = "either", items: str = "1",
    rounding: str = "nearest", observed: bool = False, rows: Sequence[str] = (),
) -> list[Finding]:  # fmt: skip
    """How many samples have a row's mean and SD, and what they have in common (CLOSURE).

    low, high: the ends of the scale, numbers or columns; with `observed: true` the printed least
    and greatest value, which then are there. All sorted samples
    on the grain are counted, each once; of every value the least, mean and greatest number of
    copies is told, and the page draws them. Undecidable where there are too many to count.
    """
    want_settings(grain, items, divisor, rounding)

    def one(row: Row, divisor: str) -> Finding:
        scale = scale_of(context, row, low, high)
        asked = _Asked(row, grain, scale, observed, divisor, items, rounding)
        return asked.impossible() or _counted(asked)

    columns = {"n": n, "mean": mean, "sd": sd, **scale_columns(context, table, low, high)}
    return _of_rows(context, table, columns, rows, divisor, one)


def _counted(asked: _Asked) -> Finding:
    pairs: list[tuple[int, int]] = []
    too_many = "too many samples to count; `sprite` shows some"
    for total in asked.sums_of_others():
        squares = asked.squares_of_others(total)
        if len(pairs) + len(squares) > MOST_PAIRS:
            return asked.plain(UNDECIDABLE, too_many)
        pairs += [(total, q) for q in squares]
    found = count_samples(asked.others, pairs, asked.low, asked.high)
    if found is None:
        return asked.plain(UNDECIDABLE, too_many)
    if not found.samples:
        return asked.plain(INCONSISTENT, f"no sample on the scale prints {asked.printed}")
    copies = {
        v: (a, m, b)
        for v, a, m, b in zip(found.values, found.least, found.mean, found.most, strict=True)
    }
    for end in asked.ends:
        copies[end] = tuple(k + 1 for k in copies.get(end, (0, 0.0, 0)))  # type: ignore[assignment]
    bars = tuple(Copies(shown(v * asked.step), *map(float, copies[v])) for v in sorted(copies))
    many = f"{found.samples:,} sample{'s' if found.samples > 1 else ''}"
    sure = [f"{b.least:.0f} of {b.value}" for b in bars if b.least]
    why = f"{many} on the grain print so"
    why += f"; each has at least {', '.join(sure[:6])}" if sure else "; no value is in all of them"
    return replace(
        asked.plain(CONSISTENT, why), recomputed=f"{many}: {_told(bars)}",
        histogram=bars if len(bars) <= MOST_BARS else (), hand=_HAND,
    )  # fmt: skip


_HAND = "any sample shown: its mean and SD, rounded, are the printed ones"


@on_print(
    "means and SDs",
    {"mean": "562", "sd": "87", "n": "60", "grain": "1", "low": "200", "high": "1000"},
)
def sprite(
    context: OnPrint, grain: str, low: str = "", high: str = "", table: str = "", n: str = "n",
    mean: str = "mean", sd: str = "sd", divisor: str = "either", items: str = "1",
    rounding: str = "nearest", draws: str = "20", observed: bool = False,
    rows: Sequence[str] = (),
) -> list[Finding]:  # fmt: skip
    """Samples that have a row's mean and SD, made one by one and shown (SPRITE).

    low, high, observed, rows: as of closure. draws: how many are
    made, up to 200. A sample found is a proof; those shown are possible ones, not likely ones.
    """
    want_settings(grain, items, divisor, rounding)
    number = count(draws)
    if number > MOST_DRAWS:
        raise SignkinError(f"draws is {draws}", expected=f"at most {MOST_DRAWS}")

    def one(row: Row, divisor: str) -> Finding:
        scale = scale_of(context, row, low, high)
        asked = _Asked(row, grain, scale, observed, divisor, items, rounding)
        rng = seeds.stream(0, "sprite", *row.cells.values(), asked.settings)
        return asked.impossible() or _drawn(asked, number, rng)

    columns = {"n": n, "mean": mean, "sd": sd, **scale_columns(context, table, low, high)}
    return _of_rows(context, table, columns, rows, divisor, one)


def _drawn(asked: _Asked, draws: int, rng: np.random.Generator) -> Finding:
    # Of large samples fewer: the time goes with n.
    draws = max(1, min(draws, 40_000 // asked.n))
    found = draw_samples(
        asked.others, asked.sums_of_others(), asked.squares_of_others, asked.low, asked.high,
        draws, rng,
    )  # fmt: skip
    found = [np.sort(np.append(x, asked.ends)) for x in found] if asked.ends else found
    if not found:
        why = "no sample was found in the steps allowed, which proves nothing"
        return asked.plain(UNDECIDABLE, why)
    bars = _classes(found, asked.step)
    unlike = len({x.tobytes() for x in found})
    shortest, longest = min(x[0] for x in found), max(x[-1] for x in found)
    first = _values(found[0], asked.step)
    why = (
        f"{unlike} different samples were made in {draws} draws, with values from "
        f"{shown(shortest * asked.step)} to {shown(longest * asked.step)}; the first: {first}"
    )
    return replace(asked.plain(CONSISTENT, why), recomputed=first, histogram=bars, hand=_HAND)


def _values(x: NDArray[np.int64], step: Fraction) -> str:
    values, copies = np.unique(x, return_counts=True)
    parts = [
        f"{shown(int(v) * step)} x {k}" if k > 1 else shown(int(v) * step)
        for v, k in zip(values, copies, strict=True)
    ]
    more = f" and {len(parts) - 12} more values" if len(parts) > 12 else ""
    return ", ".join(parts[:12]) + more


def _classes(samples: Sequence[NDArray[np.int64]], step: Fraction) -> tuple[Copies, ...]:
    """Return the copies of each value, or of each class of values where there are many."""
    low, high = min(int(x[0]) for x in samples), max(int(x[-1]) for x in samples)
    width = -(-(high - low + 1) // MOST_BARS)
    edges = range(low, high + 1, width)
    counts = np.array([np.bincount((x - low) // width, minlength=len(edges)) for x in samples])
    names = [
        shown(e * step) if width == 1 else f"{shown(e * step)} to {shown((e + width - 1) * step)}"
        for e in edges
    ]
    return tuple(
        Copies(name, float(column.min()), float(column.mean()), float(column.max()))
        for name, column in zip(names, counts.T, strict=True)
    )


def _told(bars: Iterable[Copies]) -> str:
    parts = [
        f"{b.value}: {b.least:.0f} to {b.most:.0f}" if b.least < b.most
        else f"{b.value}: {b.least:.0f}"
        for b in bars
    ]  # fmt: skip
    more = f" and {len(parts) - 12} more values" if len(parts) > 12 else ""
    return ", ".join(parts[:12]) + more


def _of_rows(
    context: OnPrint, table: str, columns: Mapping[str, str], names: Sequence[str], divisor: str,
    one: Callable[[Row, str], Finding],
) -> list[Finding]:  # fmt: skip
    readings = DIVISORS if divisor == "either" else (divisor,)

    def judge(row: Row) -> Finding:
        return over_readings([(f"divisor {d}", partial(one, row, d)) for d in readings])

    found = list(rows_of(context, table, columns))
    want_names(names, {row.name: row for row in found}, table)
    return each([row for row in found if not names or row.name in names], judge)
