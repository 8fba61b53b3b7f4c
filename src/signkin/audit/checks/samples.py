"""Checks that show what data could stand behind a mean and an SD: all samples, or some of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from signkin import seeds
from signkin.audit.checks.rows import Row, each, rows_of, want_settings
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
    """What a row asks for: n, the sums and the span of the SD in grains, and the scale."""

    def __init__(
        self, row: Row, grain: str, scale: tuple[str, str], divisor: str, items: str, rounding: str
    ) -> None:
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
        self.settings = ", ".join([*told, f"divisor {divisor}"])
        self.printed = f"{row['mean']} ({row['sd']}), n = {row['n']}"

    def plain(self, verdict: str, why: str) -> Finding:
        return Finding(verdict, why, self.printed, settings=self.settings)

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
    rounding: str = "nearest",
) -> list[Finding]:  # fmt: skip
    """How many samples have a row's mean and SD, and what they have in common (CLOSURE).

    low, high: the ends of the scale, or the printed least and greatest value. All sorted samples
    on the grain are counted, each once; of every value the least, mean and greatest number of
    copies is told, and the page draws them. Undecidable where there are too many to count.
    """
    want_settings(grain, items, divisor, rounding)
    scale = (context.text(low) if low else "", context.text(high) if high else "")

    def one(row: Row, divisor: str) -> Finding:
        asked = _Asked(row, grain, scale, divisor, items, rounding)
        return asked.impossible() or _counted(asked)

    return _of_rows(context, table, (n, mean, sd), divisor, one)


def _counted(asked: _Asked) -> Finding:
    pairs: list[tuple[int, int]] = []
    too_many = "too many samples to count; `sprite` shows some"
    for total in asked.sums:
        squares = asked.span.squares(asked.n, total)
        if len(pairs) + len(squares) > MOST_PAIRS:
            return asked.plain(UNDECIDABLE, too_many)
        pairs += [(total, q) for q in squares]
    found = count_samples(asked.n, pairs, asked.low, asked.high)
    if found is None:
        return asked.plain(UNDECIDABLE, too_many)
    if not found.samples:
        return asked.plain(INCONSISTENT, f"no sample on the scale prints {asked.printed}")
    bars = tuple(
        Copies(shown(v * asked.step), float(a), m, float(b))
        for v, a, m, b in zip(found.values, found.least, found.mean, found.most, strict=True)
    )
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
    rounding: str = "nearest", draws: str = "20",
) -> list[Finding]:  # fmt: skip
    """Samples that have a row's mean and SD, made one by one and shown (SPRITE).

    low, high: the ends of the scale, or the printed least and greatest value. draws: how many are
    made, up to 200. A sample found is a proof; those shown are possible ones, not likely ones.
    """
    want_settings(grain, items, divisor, rounding)
    number = count(draws)
    if number > MOST_DRAWS:
        raise SignkinError(f"draws is {draws}", expected=f"at most {MOST_DRAWS}")
    scale = (context.text(low) if low else "", context.text(high) if high else "")

    def one(row: Row, divisor: str) -> Finding:
        asked = _Asked(row, grain, scale, divisor, items, rounding)
        rng = seeds.stream(0, "sprite", *row.cells.values(), asked.settings)
        return asked.impossible() or _drawn(asked, number, rng)

    return _of_rows(context, table, (n, mean, sd), divisor, one)


def _drawn(asked: _Asked, draws: int, rng: np.random.Generator) -> Finding:
    # Of large samples fewer: the time goes with n.
    draws = max(1, min(draws, 40_000 // asked.n))
    found = draw_samples(asked.n, asked.sums, asked.span, asked.low, asked.high, draws, rng)
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
    context: OnPrint, table: str, columns: tuple[str, str, str], divisor: str,
    one: Callable[[Row, str], Finding],
) -> list[Finding]:  # fmt: skip
    readings = DIVISORS if divisor == "either" else (divisor,)

    def judge(row: Row) -> Finding:
        return over_readings([(f"divisor {d}", partial(one, row, d)) for d in readings])

    roles = dict(zip(("n", "mean", "sd"), columns, strict=True))
    return each(rows_of(context, table, roles), judge)
