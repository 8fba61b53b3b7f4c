"""Tagged intervals in a table (.csv): a row an interval, with its start, end and label."""

from __future__ import annotations

from pathlib import Path

from signkin.annotation import Annotation, TierWish, tier_key
from signkin.errors import SignkinError, listed
from signkin.io.collecting import Collected, TierName, choose_tiers, told_apart
from signkin.io.registry import annotation_reader
from signkin.io.telling import check_undeclared, ignored
from signkin.io.text_rows import TextTable, TimeFormat, read_table
from signkin.rows import plain_name

# Words in the names of columns of times.
UNIT_WORDS = {
    **dict.fromkeys(("s", "sec", "secs", "seconds"), "s"),
    **dict.fromkeys(("ms", "msec", "millis", "milliseconds"), "ms"),
    **dict.fromkeys(("frame", "frames"), "frames"),
}
LONG_S = 5  # no sign lasts as long; of sentences in whole seconds it must be said


@annotation_reader("csv", suffixes=(".csv", ".tsv"))
def read_words_csv(
    path: Path,
    *,
    tiers: tuple[TierWish, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    rate_hz: float | None = None,
    recording_column: str | None = None,
    start_column: str = "start",
    end_column: str = "end",
    duration_column: str | None = None,
    label_column: str = "label",
    tier_column: str | None = None,
    participant_column: str | None = None,
    time_unit: str | None = None,
    frame_rate_hz: float | None = None,
    end_inclusive: bool = False,
    separator: str | None = None,
    decimal: str | None = None,
    encoding: str | None = None,
    ignore: tuple[str, ...] | list[str] | None = None,
) -> Annotation:
    """Read the intervals of one recording.

    time_unit: s (default), ms, frames or timecode (h:m:s.ms, or h:m:s:f). Frames are those of the
    motion (`rate_hz`) unless `frame_rate_hz` tells the video's.
    duration_column: instead of an end.
    end_inclusive: the end names the last frame that still belongs to the interval.
    tier_column: where missing, all intervals stand on the one tier that was asked for.
    separator, decimal, encoding: where they are not to be found out.
    ignore: columns whose names mean something else than they do elsewhere.
    """
    columns = [start_column, end_column, label_column]
    table = read_table(path, columns, separator, encoding).part(recording_column, part)
    used = [recording_column, tier_column, participant_column, duration_column, *columns]
    check_undeclared(table, [*filter(None, used), *ignored(ignore)])
    last = duration_column if duration_column is not None else end_column
    if time_unit is None:
        _check_unit(table, start_column, last, duration_column is not None)
    time_unit = time_unit or "s"
    times = TimeFormat(time_unit, decimal, frame_rate_hz if frame_rate_hz is not None else rate_hz)
    if end_inclusive and time_unit not in ("frames", "timecode"):
        raise SignkinError(
            f"end_inclusive with times in {time_unit}", place="end_inclusive", expected="frames"
        )
    start_at, label_at = table.index(start_column), table.index(label_column)
    end_at = table.index(last)
    tier_of = _tiers(table, tiers, tier_column, participant_column)
    chosen = choose_tiers(tiers, list(dict.fromkeys(tier_of)))
    wanted = {tier for names in chosen.values() for tier in names}
    collected = Collected()
    seen: dict[tuple[float, float, str, str], int] = {}
    for row, tier in zip(table.rows, tier_of, strict=True):
        if tier.name not in wanted:
            continue
        line = f"line {row.line}"
        start = times.seconds(row.cells[start_at], f"{line}, column {start_column}")
        end = times.seconds(
            row.cells[end_at], f"{line}, column {last}", 1.0 if end_inclusive else 0.0
        )
        if duration_column is not None:
            end += start
        label = row.cells[label_at]
        first = seen.setdefault((start, end, label, tier.name), row.line)
        if first != row.line:
            collected.leave_out(tier.name, line, f"the same as line {first}")
            continue
        collected.add(start, end, label, tier.name, line)
    return collected.annotation(name or part or path.stem, tiers, chosen)


def _check_unit(table: TextTable, start_column: str, last: str, lasts: bool) -> None:
    """Refuse times that are not declared and, by their columns' names or sizes, no seconds.

    last: the column of ends, or of durations where it `lasts`.
    """
    for column in (start_column, last):
        words = plain_name(column).split("_")
        named = {UNIT_WORDS[word] for word in words if word in UNIT_WORDS}
        if named - {"s"} and "ss" not in words:  # ELAN's ss.msec are seconds
            raise SignkinError(
                f"{column!r} is named as {listed(sorted(named))}",
                place="time_unit",
                expected="the unit of times, declared",
                todo=f"Declare options: {{time_unit: {min(named - {'s'})}}}, or s.",
            )
    start, end = table.index(start_column), table.index(last)
    cells = [(row.cells[start].strip(), row.cells[end].strip()) for row in table.rows]
    if len(cells) < 2 or not all(a.isdecimal() and b.isdecimal() for a, b in cells):
        return
    lengths = sorted(int(b) - (0 if lasts else int(a)) for a, b in cells)
    if lengths[len(lengths) // 2] >= LONG_S:
        raise SignkinError(
            f"whole numbers, half of the intervals of {lengths[len(lengths) // 2]} or longer",
            place=f"columns {start_column}, {last}",
            expected="seconds, or the unit of times, declared",
            todo="Are these milliseconds or frames? Declare options: {time_unit: ms}, frames or s.",
        )


def _tiers(
    table: TextTable,
    tiers: tuple[TierWish, ...] | None,
    tier_column: str | None,
    participant_column: str | None,
) -> list[TierName]:
    if tier_column is None and participant_column is None:
        only = TierName(tier_key(tiers[0]) if tiers else "sign")
        return [only] * len(table.rows) if table.rows else []
    tier_at = None if tier_column is None else table.index(tier_column)
    person_at = None if participant_column is None else table.index(participant_column)
    out = []
    for row in table.rows:
        person = "" if person_at is None else row.cells[person_at].strip()
        out.append(TierName(person if tier_at is None else row.cells[tier_at].strip(), person))
    return told_apart(out)
