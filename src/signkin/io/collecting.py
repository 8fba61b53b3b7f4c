"""What every reader of tags does: choose tiers, check intervals, count what cannot be used."""

from __future__ import annotations

import inspect
import math
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path

from signkin.annotation import Annotation, Interval, LeftOut, TierWish, tier_key
from signkin.errors import SignkinError, listed
from signkin.rows import composed

DIGITS = 9  # of seconds: finer than any clock, coarse enough to hide sums of floats
WISH_KEYS = ("pattern", "participant")


def annotation_options(reader: Callable[..., Annotation]) -> list[str]:
    """Return the options of a format: its reader's parameters besides those all readers have."""
    shared = ("path", "tiers", "name", "part")
    return [name for name in inspect.signature(reader).parameters if name not in shared]


def check_annotation_options(
    reader: Callable[..., Annotation], given: Mapping[str, object], path: Path
) -> None:
    """Refuse an option that the format does not have; the error lists those it has."""
    known = annotation_options(reader)
    for option in given:
        if option not in known:
            raise SignkinError(
                f"no option {option!r}",
                file=path,
                place="key annotation.options",
                expected=listed(known) if known else "no option",
            )


@dataclass(frozen=True)
class TierName:
    """A tier as a file names it, and whom it belongs to (empty where the file does not say).

    own: the name without the participant, where tiers are told apart by it.
    """

    name: str
    participant: str = ""
    own: str = ""


def told_apart(tiers: Sequence[TierName]) -> list[TierName]:
    """Return tiers with the participant in the name where several have a tier of that name."""
    people: dict[str, set[str]] = {}
    for tier in tiers:
        people.setdefault(tier.name, set()).add(tier.participant)
    return [
        TierName(f"{tier.name} ({tier.participant})", tier.participant, tier.name)
        if tier.participant and len(people[tier.name]) > 1
        else tier
        for tier in tiers
    ]


def choose_tiers(
    wanted: Sequence[TierWish] | None, known: Sequence[TierName]
) -> dict[str, tuple[str, ...]]:
    """Return, for each wish, the file's tiers in the file's order; None wants every tier.

    A name is looked up as it is written, then whatever way its accents are coded. A wish for
    a pattern (`Gloss*`) or a participant that no tier fulfils is an error, as is a missing name.
    """
    names = list(dict.fromkeys(tier.name for tier in known))
    if wanted is None:
        return {name: (name,) for name in names}
    out: dict[str, tuple[str, ...]] = {}
    for wish in wanted:
        if isinstance(wish, str):
            out[wish] = (_named(wish, names),)
        else:
            out[tier_key(wish)] = _fulfilling(wish, known)
    return out


def _named(wish: str, names: Sequence[str]) -> str:
    if wish in names:
        return wish
    same = [name for name in names if composed(name) == composed(wish)]
    if len(same) == 1:
        return same[0]
    if same:
        raise SignkinError(
            f"{len(same)} tiers look like {wish!r} and differ in how their accents are coded",
            place="tiers",
            expected="one",
            todo="Rename one of them in ELAN.",
        )
    raise SignkinError(
        f"no tier {wish!r}",
        place="tiers",
        expected=listed(map(one_line, names), 60),
        todo="Tier names are case-sensitive.",
    )


def _fulfilling(wish: Mapping[str, str], known: Sequence[TierName]) -> tuple[str, ...]:
    unknown = [str(key) for key in wish if key not in WISH_KEYS]
    if unknown or not wish:
        raise SignkinError(
            f"tiers are asked for by {listed(unknown)}",
            place="tiers",
            expected="a name, or `pattern` and `participant`",
        )
    pattern = composed(str(wish.get("pattern", "*")))
    person = wish.get("participant")
    found = [
        tier.name
        for tier in known
        if fnmatchcase(composed(tier.own or tier.name), pattern)
        and (person is None or composed(tier.participant) == composed(str(person)))
    ]
    if not found:
        told = listed(
            (
                one_line(t.name if t.own or not t.participant else f"{t.name} ({t.participant})")
                for t in known
            ),
            60,
        )
        raise SignkinError(f"no tier with {tier_key(wish)}", place="tiers", expected=told)
    return tuple(dict.fromkeys(found))


def one_line(text: str, most: int = 60) -> str:
    """Return text as a message may quote it: without line ends, cut after `most` letters."""
    flat = " ".join(text.split("\n"))
    return flat if len(flat) <= most else f"{flat[:most]}…"


@dataclass
class Collected:
    """Intervals of a file while it is read."""

    intervals: list[Interval] = field(default_factory=list)
    left_out: list[LeftOut] = field(default_factory=list)

    def add(self, start_s: float, end_s: float, label: str, tier: str, place: str) -> None:
        """Take an interval; one without length is left out, one that runs backwards an error."""
        if not (math.isfinite(start_s) and math.isfinite(end_s)):
            raise SignkinError(
                f"{_short(label)} has a time that is no number",
                place=place,
                expected="a start and an end",
            )
        start, end = round(start_s, DIGITS), round(end_s, DIGITS)
        if end < start:
            raise SignkinError(
                f"{_short(label)} runs from {start_s:.3f} s to {end_s:.3f} s",
                place=place,
                expected="an end after the start",
            )
        if end == start:
            self.leave_out(tier, place, f"{_short(label)} has no length, at {start_s:.3f} s")
        else:
            self.intervals.append(Interval(start, end, label, tier))

    def leave_out(self, tier: str, place: str, reason: str) -> None:
        """Count an interval that cannot be used."""
        self.left_out.append(LeftOut(tier, place, reason))

    def annotation(
        self,
        name: str,
        wanted: Sequence[TierWish] | None,
        chosen: Mapping[str, tuple[str, ...]],
        **about: float | int,
    ) -> Annotation:
        """Return the annotation. Nothing at all on the tiers asked for is an error.

        A tier that was asked for by name gets the name as it was asked for.
        """
        asked = {names[0]: wish for wish, names in chosen.items() if len(names) == 1}
        if wanted is not None:
            by_name = {wish for wish in wanted if isinstance(wish, str)}
            asked = {known: wish for known, wish in asked.items() if wish in by_name}
        intervals = [_readable(interval) for interval in self.intervals]
        if any(known != wish for known, wish in asked.items()):
            intervals = [replace(i, tier=asked.get(i.tier, i.tier)) for i in intervals]
        chosen = {wish: tuple(asked.get(n, n) for n in names) for wish, names in chosen.items()}
        if not intervals and (self.left_out or wanted is not None):
            self._refuse(wanted)
        there = {interval.tier for interval in intervals}
        empty = [n for names in chosen.values() for n in names if n not in there]
        return Annotation(
            name=name,
            intervals=tuple(intervals),
            left_out=tuple(self.left_out),
            empty_tiers=tuple(dict.fromkeys(empty)) if wanted is not None else (),
            chosen=chosen,
            **about,  # type: ignore[arg-type]
        )

    def _refuse(self, wanted: Sequence[TierWish] | None) -> None:
        if self.left_out:
            first = self.left_out[0]
            raise SignkinError(
                f"none of {len(self.left_out)} intervals can be used; the first: {first.reason}",
                place=f"tier {first.tier}, {first.place}",
                expected="one interval or more",
            )
        told = listed((tier_key(wish) for wish in wanted or ()), 6)
        raise SignkinError(
            "the tier is empty" if len(wanted or ()) == 1 else "all these tiers are empty",
            place=f"tier {told!r}" if len(wanted or ()) == 1 else f"tiers {told}",
            expected="intervals",
        )


def _readable(interval: Interval) -> Interval:
    """Return an interval whose label has composed accents, so that one gloss is one text."""
    if unicodedata.is_normalized("NFC", interval.label):
        return interval
    return replace(interval, label=composed(interval.label), written=interval.label)


def _short(label: str) -> str:
    return repr(label if len(label) <= 40 else label[:40] + "…")
