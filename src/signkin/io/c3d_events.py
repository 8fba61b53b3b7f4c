"""Events of C3D files as tags, where a corpus asks for them (format `c3d_events`).

An event has a label, a context (the tier: Left, Right, General, ...) and a time. Two events make a
sign, `start_event` and `end_event`, whose gloss is the first one's description; or each event's
label is a gloss, which lasts until the next event of its context.

Source: The C3D File Format User Guide (Motion Lab Systems), "The EVENT group"; times are minutes
and seconds.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from signkin.annotation import Annotation, TierWish
from signkin.errors import SignkinError
from signkin.io.c3d import opened, strings
from signkin.io.collecting import Collected, TierName, choose_tiers
from signkin.io.registry import annotation_reader
from signkin.io.text import encoding_of, quoted

_NO_CONTEXT = "General"


@dataclass(frozen=True)
class Event:
    """An event: its number in the file, from 1, and the recording's time in seconds."""

    number: int
    label: str
    context: str
    description: str
    time_s: float


@annotation_reader("c3d_events")
def read_c3d_events(
    path: Path,
    *,
    tiers: tuple[TierWish, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    start_event: str | None = None,
    end_event: str | None = None,
    blank: tuple[str, ...] | list[str] = (),
    event_clock: str | None = None,
    header: str = "check",
    encoding: str = "utf-8",
) -> Annotation:
    """Read the events of a C3D file as intervals; contexts are tiers.

    start_event, end_event: labels of the events at which a sign starts and ends; the gloss is the
    start's description, or else its label. Without them each label is a gloss that lasts until the
    next event of its context; the last one must be among `blank`: labels that end a sign and are no
    sign themselves.
    event_clock: where the file starts later than frame 1, whether events count from the `capture`'s
    first frame or from the file's (`first_frame`). header: see `c3d.read_c3d`.
    """
    found, first, rate_hz = _events(path, header, encoding)
    if not found:
        raise SignkinError("no events in the file", place="EVENT", expected="labels and times")
    shift_s = _shift(first, rate_hz, event_clock)
    known = [TierName(context) for context in dict.fromkeys(e.context for e in found)]
    chosen = choose_tiers(tiers, known)
    collected = Collected()
    for tier in dict.fromkeys(name for names in chosen.values() for name in names):
        own = sorted((e for e in found if e.context == tier), key=lambda e: (e.time_s, e.number))
        if (start_event is None) != (end_event is None):
            raise SignkinError(
                "one of start_event and end_event", place="options", expected="both, or neither"
            )
        pairs = (
            _until_next(own, blank)
            if start_event is None or end_event is None
            else _paired(own, start_event, end_event)
        )
        for start, end, gloss in pairs:
            place = f"event {start.number}"
            collected.add(start.time_s - shift_s, end.time_s - shift_s, gloss, tier, place)
    return collected.annotation(name or path.stem, tiers, chosen)


def _paired(
    events: Sequence[Event], start_event: str, end_event: str
) -> list[tuple[Event, Event, str]]:
    """Return pairs of a start and the end that follows it; what has no partner is an error."""
    out: list[tuple[Event, Event, str]] = []
    started: Event | None = None
    for event in events:
        if event.label not in (start_event, end_event):
            continue
        if (started is None) == (event.label == end_event):
            raise SignkinError(
                f"{quoted(event.label)} at {event.time_s:.3f} s follows "
                f"{'no start' if started is None else 'a start'}",
                place=f"event {event.number}, context {event.context}",
                expected=f"{start_event} and {end_event} by turns",
            )
        if started is None:
            started = event
        else:
            out.append((started, event, started.description or started.label))
            started = None
    if started is not None:
        raise SignkinError(
            f"{quoted(started.label)} at {started.time_s:.3f} s has no end",
            place=f"event {started.number}, context {started.context}",
            expected=f"{start_event} and {end_event} by turns",
        )
    return out


def _until_next(events: Sequence[Event], blank: Sequence[str]) -> list[tuple[Event, Event, str]]:
    if events and events[-1].label not in blank:
        last = events[-1]
        raise SignkinError(
            f"{quoted(last.label)} at {last.time_s:.3f} s has no end",
            place=f"event {last.number}, context {last.context}",
            expected="an event that ends it, named in options: {blank: [...]}",
            todo="Or declare start_event and end_event.",
        )
    pairs = itertools.pairwise(events)
    return [(start, end, start.label) for start, end in pairs if start.label not in blank]


def _shift(first: int, rate_hz: float, declared: str | None) -> float:
    """Return what to take off the events' times (s)."""
    if declared not in (None, "capture", "first_frame"):
        raise SignkinError(
            f"event_clock is {quoted(declared)}",
            place="event_clock",
            expected="capture or first_frame",
        )
    if first > 1 and declared is None:
        raise SignkinError(
            f"the file starts at frame {first}, {(first - 1) / rate_hz:.3f} s after the capture",
            place="event_clock",
            expected="whether events count from the capture or from the first frame",
            todo="Declare options: {event_clock: capture} (Vicon), or first_frame.",
        )
    return (first - 1) / rate_hz if declared == "capture" else 0.0


def _events(path: Path, header: str, encoding: str) -> tuple[list[Event], int, float]:
    """Return the events, the number of the first frame and the rate of a file."""

    def read(reader: Any) -> tuple[list[Event], int, float]:
        name = encoding_of(b"", encoding)
        times = reader.get("EVENT.TIMES")
        values = [] if times is None else [float(v) for v in times.float_array.ravel()]
        labels = strings(reader, "EVENT.LABELS", name)
        count = len(values) // 2
        if len(labels) < count or len(values) != 2 * count:
            raise SignkinError(
                f"{len(labels)} labels and {len(values)} times",
                place="EVENT",
                expected="a label and two numbers of time for each event",
            )
        contexts = [*strings(reader, "EVENT.CONTEXTS", name), *[""] * count]
        told = [*strings(reader, "EVENT.DESCRIPTIONS", name), *[""] * count]
        found = [
            Event(i + 1, labels[i], contexts[i] or _NO_CONTEXT, told[i],
                  60 * values[2 * i] + values[2 * i + 1])
            for i in range(count)
        ]  # fmt: skip
        return found, int(reader.first_frame), float(reader.point_rate)

    found, first, rate_hz = opened(path, header, read)
    seen: set[tuple[str, str, float]] = set()
    for event in found:
        key = (event.label, event.context, event.time_s)
        if key in seen:
            raise SignkinError(
                f"{quoted(event.label)} stands twice at one time",
                place=f"event {event.number}",
                expected="each event once",
            )
        seen.add(key)
    return found, first, rate_hz
