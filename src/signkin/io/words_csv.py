"""Tagged intervals in a table (.csv): a row an interval, with its start, end and label."""

from __future__ import annotations

from pathlib import Path

from signkin.annotation import Annotation, TierWish, tier_key
from signkin.errors import SignkinError
from signkin.io.collecting import Collected, TierName, choose_tiers, told_apart
from signkin.io.registry import annotation_reader
from signkin.io.text_rows import TextTable, TimeFormat, read_table


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
    time_unit: str = "s",
    frame_rate_hz: float | None = None,
    end_inclusive: bool = False,
    separator: str | None = None,
    decimal: str | None = None,
    encoding: str | None = None,
) -> Annotation:
    """Read the intervals of one recording.

    time_unit: s, ms, frames or timecode (h:m:s.ms, or h:m:s:f). Frames are those of the
    motion (`rate_hz`) unless `frame_rate_hz` tells the video's.
    duration_column: instead of an end.
    end_inclusive: the end names the last frame that still belongs to the interval.
    tier_column: where missing, all intervals stand on the one tier that was asked for.
    separator, decimal, encoding: where they are not to be found out.
    """
    columns = [start_column, end_column, label_column]
    table = read_table(path, columns, separator, encoding).part(recording_column, part)
    times = TimeFormat(time_unit, decimal, frame_rate_hz if frame_rate_hz is not None else rate_hz)
    if end_inclusive and time_unit not in ("frames", "timecode"):
        raise SignkinError(
            f"end_inclusive with times in {time_unit}", place="end_inclusive", expected="frames"
        )
    start_at, label_at = table.index(start_column), table.index(label_column)
    last = duration_column if duration_column is not None else end_column
    end_at = table.index(last)
    tier_of = _tiers(table, tiers, tier_column, participant_column)
    chosen = choose_tiers(tiers, list(dict.fromkeys(tier_of)))
    wanted = {tier for names in chosen.values() for tier in names}
    collected = Collected()
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
        collected.add(start, end, row.cells[label_at], tier.name, line)
    return collected.annotation(name or part or path.stem, tiers, chosen)


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
