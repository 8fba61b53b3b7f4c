"""A label a frame, as programs that segment signs write them: runs of one label are intervals."""

from __future__ import annotations

import re
from pathlib import Path

from signkin.annotation import Annotation, TierWish, tier_key
from signkin.annotation_rules import labels_to_intervals
from signkin.errors import SignkinError
from signkin.io.collecting import Collected, TierName, choose_tiers
from signkin.io.registry import annotation_reader
from signkin.io.telling import FRAMES, TIMES, check_undeclared, ignored
from signkin.io.text_rows import TextTable, read_table, read_text
from signkin.rows import plain_name


@annotation_reader("frame_labels", suffixes=())
def read_frame_labels(
    path: Path,
    *,
    tiers: tuple[TierWish, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    rate_hz: float | None = None,
    frame_rate_hz: float | None = None,
    recording_column: str | None = None,
    frame_column: str | None = None,
    first_frame: int = 0,
    header: bool = True,
    blank: tuple[str, ...] | list[str] = ("",),
    separator: str | None = None,
    encoding: str | None = None,
    ignore: tuple[str, ...] | list[str] | None = None,
) -> Annotation:
    """Read labels of frames; frame i lasts from i / rate to (i + 1) / rate.

    frame_rate_hz: of the labels; the motion's (`rate_hz`) where missing.
    header: a table whose columns are tiers; false: a plain list, a label a line.
    frame_column: numbers of the frames, from `first_frame`, which must rise by 1.
    blank: labels that mean no sign, such as `O` or `rest`; an empty one is always one.
    ignore: columns that are no tiers.
    """
    rate = frame_rate_hz if frame_rate_hz is not None else rate_hz
    if rate is None:
        raise SignkinError(
            "labels of frames, no rate", place="frame_rate_hz", expected="the rate of the labels"
        )
    if header:
        columns = [c for c in (recording_column, frame_column) if c is not None]
        table = read_table(path, columns, separator, encoding, keep_blank=True)
        table = table.part(recording_column, part)
        check_undeclared(table, [*columns, *ignored(ignore)])
        _check_counters(table, [*columns, *ignored(ignore), *_names(tiers)])
        before = _frames(table, frame_column, first_frame)
        labels = {
            column: [row.cells[i] for row in table.rows]
            for i, column in enumerate(table.columns)
            if column not in (*columns, *ignored(ignore))
        }
        passed_over = {*columns, *ignored(ignore)} & set(table.columns)
        if len(labels) != len(table.columns) - len(passed_over):
            raise SignkinError("two columns of one name", place="line 1", expected="each once")
    else:
        lines = read_text(path, encoding).removesuffix("\n").split("\n")
        columned = next((i for i, line in enumerate(lines, start=1) if "\t" in line), None)
        if columned is not None:
            raise SignkinError(
                f"found {lines[columned - 1][:40]!r}",
                place=f"line {columned}",
                expected="a label a line; a table has `header: true`",
            )
        before = 0
        labels = {tier_key(tiers[0]) if tiers else "sign": lines}
    chosen = choose_tiers(tiers, [TierName(column) for column in labels])
    collected = Collected()
    none = ("", *(str(word) for word in blank))
    for tier in dict.fromkeys(name for names in chosen.values() for name in names):
        # Frames before the first one that the file numbers have no label.
        for i in labels_to_intervals(labels[tier], rate, tier=tier, blank=none):
            start, end = i.start_s + before / rate, i.end_s + before / rate
            collected.add(start, end, i.label, tier, f"frame {round(start * rate) + first_frame}")
    return collected.annotation(name or part or path.stem, tiers, chosen)


def _names(tiers: tuple[TierWish, ...] | None) -> list[str]:
    return [tier for tier in tiers or () if isinstance(tier, str)]


def _check_counters(table: TextTable, declared: list[str]) -> None:
    """Refuse columns of frames or times that nobody declared: they are no labels."""
    for column in table.columns:
        name = plain_name(column)
        if column not in declared and (name in FRAMES or name in TIMES):
            raise SignkinError(
                f"the column {column!r} is not declared",
                place="line 1",
                expected="columns of labels",
                todo=f"Declare options: {{frame_column: {column}}}, or {{ignore: [{column}]}}.",
            )


def _frames(table: TextTable, column: str | None, first_frame: int) -> int:
    """Return how many frames lie before the first row; numbers must rise by 1."""
    if column is None or not table.rows:
        return 0
    place = table.index(column)
    numbers = []
    for row in table.rows:
        cell = row.cells[place].strip()
        if not re.fullmatch(r"[0-9]{1,12}", cell, re.ASCII):
            raise SignkinError(
                f"found {cell[:40]!r}",
                place=f"line {row.line}, column {column}",
                expected="the number of a frame",
            )
        numbers.append(int(cell))
        if len(numbers) > 1 and numbers[-1] != numbers[-2] + 1:
            raise SignkinError(
                f"frame {numbers[-1]} follows frame {numbers[-2]}",
                place=f"line {row.line}",
                expected="frame numbers that rise by 1; leave the label empty for no sign",
            )
    if numbers[0] < first_frame:
        raise SignkinError(
            f"the first frame is {numbers[0]}",
            place=f"line {table.rows[0].line}",
            expected=f"{first_frame} or later (`first_frame`)",
        )
    return numbers[0] - first_frame
