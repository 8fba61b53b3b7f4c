"""An annotation: the tagged intervals of one recording, validated when it is made.

Times are seconds from the recording's start; a tier is a named layer of
intervals (signs, utterances, translations).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed


@dataclass(frozen=True, order=True)
class Interval:
    """A labelled stretch of time on a tier; `start_s` < `end_s`.

    written: the label as the file has it, where rules for glosses changed it; else empty.
    """

    start_s: float
    end_s: float
    label: str
    tier: str
    written: str = field(default="", compare=False)

    @property
    def as_written(self) -> str:
        """The label as the file has it."""
        return self.written or self.label


@dataclass(frozen=True)
class LeftOut:
    """An interval of a file that cannot be used and is not read: where it stands, and why."""

    tier: str
    place: str
    reason: str

    def __str__(self) -> str:
        """Return `tier T, PLACE: REASON`."""
        return f"tier {self.tier}, {self.place}: {self.reason}"


# A tier by name, or by what is in common: {"pattern": "Gloss*", "participant": "S1"}.
TierWish = str | Mapping[str, str]


def tier_key(wanted: TierWish) -> str:
    """Return a wish as text: the name, or `pattern Gloss*, participant S1`."""
    if isinstance(wanted, str):
        return wanted
    return ", ".join(f"{key} {wanted[key]}" for key in sorted(wanted))


@dataclass(frozen=True, eq=False, kw_only=True)
class Annotation:
    """Intervals of one recording, kept in order of time.

    name: the recording's name.
    intervals: in order of start, then end.
    clock_offset_s: what was added to the file's times to get the recording's.
    interpolated: number of times that the file leaves open and that were interpolated.
    left_out: intervals of the file that could not be used (no length, a time that is no number,
    outside the excerpt), so that none is missing without a word.
    empty_tiers: tiers that were asked for and hold nothing.
    chosen: the file's tiers for each tier, pattern or participant that was asked for, by its
    text (`tier_key`).
    """

    name: str
    intervals: tuple[Interval, ...]
    clock_offset_s: float = 0.0
    interpolated: int = 0
    left_out: tuple[LeftOut, ...] = ()
    empty_tiers: tuple[str, ...] = ()
    chosen: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the times and put the intervals in order."""
        for interval in self.intervals:
            place = f"tier {interval.tier}, {interval.label!r}"
            if not (np.isfinite(interval.start_s) and np.isfinite(interval.end_s)):
                raise self._error(place, "a time is missing", "a start and an end")
            if interval.end_s <= interval.start_s:
                raise self._error(
                    place,
                    f"it runs from {interval.start_s:.3f} s to {interval.end_s:.3f} s",
                    "an end after the start",
                )
            if interval.start_s < 0:
                raise self._error(
                    place,
                    f"it starts at {interval.start_s:.3f} s",
                    "a time inside the recording; check clock_offset_s, or from_s of an excerpt",
                )
        object.__setattr__(self, "intervals", tuple(sorted(self.intervals)))

    def _error(self, place: str, found: str, expected: str) -> SignkinError:
        return SignkinError(found, file=f"annotation {self.name}", place=place, expected=expected)

    @property
    def tiers(self) -> tuple[str, ...]:
        """Names of the tiers that hold intervals, sorted."""
        return tuple(sorted({interval.tier for interval in self.intervals}))

    def tier(self, name: str) -> tuple[Interval, ...]:
        """Return the intervals of a tier in order of time; an unknown tier is an error."""
        if name in self.empty_tiers:
            return ()
        found = tuple(interval for interval in self.intervals if interval.tier == name)
        if not found:
            raise self._error("tiers", f"no tier {name!r}", listed(self.tiers, 40))
        return found

    def of(self, wanted: TierWish) -> tuple[Interval, ...]:
        """Return the intervals of a tier, pattern or participant that was asked for."""
        names = self.chosen.get(tier_key(wanted), (tier_key(wanted),))
        return tuple(interval for interval in self.intervals if interval.tier in names)

    def times_s(self, name: str) -> NDArray[np.float64]:
        """Return starts and ends of a tier, (N, 2), in seconds."""
        return np.array([(i.start_s, i.end_s) for i in self.tier(name)]).reshape(-1, 2)

    def refuse_past(self, duration_s: float, tolerance_s: float) -> None:
        """Refuse intervals that end after the motion does (by more than a tolerance)."""
        late = [i for i in self.intervals if i.end_s > duration_s + tolerance_s]
        if late:
            last = max(late, key=lambda i: i.end_s)
            raise self._error(
                f"tier {last.tier}, {last.label!r}",
                f"{len(late)} intervals end after the motion, the last at {last.end_s:.3f} s",
                f"no time after {duration_s:.3f} s, the end of the motion",
            )
