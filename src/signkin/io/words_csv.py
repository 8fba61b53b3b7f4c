"""Tagged intervals in a table (.csv): a row an interval, with its start, end and label."""

from __future__ import annotations

from pathlib import Path

from signkin.annotation import Annotation, Interval
from signkin.errors import SignkinError
from signkin.io.registry import annotation_reader
from signkin.io.wide_csv import column_numbers, known_column, read_text_table, rows_of_part

SECONDS_PER = {"s": 1.0, "ms": 0.001}


@annotation_reader("csv", suffixes=(".csv",))
def read_words_csv(
    path: Path,
    *,
    tiers: tuple[str, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    rate_hz: float | None = None,
    recording_column: str | None = None,
    start_column: str = "start",
    end_column: str = "end",
    label_column: str = "label",
    tier_column: str | None = None,
    time_unit: str = "s",
    end_inclusive: bool = False,
) -> Annotation:
    """Read the intervals of one recording.

    time_unit: s, ms or frames (frames want the motion's `rate_hz`).
    end_inclusive: the end names the last frame that still belongs to the interval.
    tier_column: where missing, all intervals stand on the one tier that was asked for.
    """
    rows = rows_of_part(read_text_table(path), recording_column, part)
    step = _seconds_a_unit(time_unit, rate_hz)
    starts = column_numbers(rows, start_column) * step
    ends = (column_numbers(rows, end_column) + (1.0 if end_inclusive else 0.0)) * step
    labels = rows[known_column(rows, label_column)]
    if tier_column is not None:
        tier_of = rows[known_column(rows, tier_column)].tolist()
    else:
        tier_of = [tiers[0] if tiers else "sign"] * len(rows)
    intervals = []
    for line, start, end, label, tier in zip(
        rows.index, starts, ends, labels, tier_of, strict=True
    ):
        if not start < end:
            raise SignkinError(
                f"{label!r} runs from {start:.3f} s to {end:.3f} s",
                place=f"line {line + 2}",
                expected="an end after the start",
            )
        if tiers is None or tier in tiers:
            intervals.append(Interval(round(start, 9), round(end, 9), label, tier))
    return Annotation(name=name or part or path.stem, intervals=tuple(intervals))


def _seconds_a_unit(time_unit: str, rate_hz: float | None) -> float:
    if time_unit == "frames":
        if rate_hz is None:
            raise SignkinError("times in frames, no rate", expected="the rate of the motion")
        return 1.0 / rate_hz
    if time_unit not in SECONDS_PER:
        raise SignkinError(f"the time unit is {time_unit!r}", expected="s, ms or frames")
    return SECONDS_PER[time_unit]
