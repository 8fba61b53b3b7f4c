"""What is done to an annotation after it is read: excerpts, rules for glosses, labels of frames."""

from __future__ import annotations

import math
import unicodedata
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import Any

from signkin.annotation import Annotation, Interval, LeftOut, TierWish, tier_key
from signkin.errors import SignkinError


def excerpt(
    annotation: Annotation,
    from_s: float = 0.0,
    to_s: float | None = None,
    clock_offset_s: float = 0.0,
    clip: Sequence[TierWish] = (),
) -> Annotation:
    """Return the stretch of an annotation that a recording covers, in the recording's time.

    from_s, to_s: in the annotation's time; from_s becomes 0. clock_offset_s: added besides.
    Intervals that do not lie inside the stretch as a whole are left out and listed; those of
    the tiers of `clip` are cut at its ends.
    """
    if from_s == 0.0 and to_s is None and clock_offset_s == 0.0:
        return annotation
    given = (from_s, clock_offset_s, 0.0 if to_s is None else to_s)
    if any(isinstance(v, bool) or not isinstance(v, int | float) for v in given) or not (
        math.isfinite(from_s) and math.isfinite(clock_offset_s)
    ):
        raise SignkinError(
            f"from_s is {from_s}, clock_offset_s {clock_offset_s}",
            place="excerpt",
            expected="seconds",
        )
    last = math.inf if to_s is None else to_s
    if not last > from_s:
        raise SignkinError(
            f"the excerpt runs from {from_s:g} s to {last:g} s",
            place="from_s, to_s",
            expected="an end after the start",
        )
    cut = from_s != 0.0 or to_s is not None
    shift = clock_offset_s - from_s
    kept, left_out = [], list(annotation.left_out)
    clipped = {name for wish in clip for name in annotation.chosen.get(tier_key(wish), ())}
    for i in annotation.intervals:
        if cut and i.tier in clipped and i.end_s > from_s and i.start_s < last:
            i = replace(i, start_s=max(i.start_s, from_s), end_s=min(i.end_s, last))
        if cut and not (from_s - 1e-9 <= i.start_s and i.end_s <= last + 1e-9):
            where = "outside" if i.end_s <= from_s or i.start_s >= last else "partly outside"
            place = f"{i.label[:40]!r} at {i.start_s:.3f} s"
            left_out.append(LeftOut(i.tier, place, f"{where} the excerpt"))
            continue
        start, end = round(i.start_s + shift, 9), round(i.end_s + shift, 9)
        kept.append(replace(i, start_s=max(start, 0.0) if start > -1e-6 else start, end_s=end))
    if annotation.intervals and not kept:
        first, end = annotation.intervals[0].start_s, max(i.end_s for i in annotation.intervals)
        raise SignkinError(
            f"no interval lies between {from_s:g} s and {last:g} s; they run from {first:.3f} s "
            f"to {end:.3f} s",
            place="from_s, to_s",
            expected="one or more",
        )
    return replace(
        annotation,
        intervals=tuple(kept),
        left_out=tuple(left_out),
        clock_offset_s=annotation.clock_offset_s + shift,
    )


def _composed(text: object) -> str:
    return unicodedata.normalize("NFC", str(text))


@dataclass(frozen=True)
class GlossRules:
    """How glosses are made from labels; the label as written is kept beside.

    strip: marks taken off both ends, again and again. merge: gloss -> the gloss it counts as,
    looked up after stripping.
    """

    strip: tuple[str, ...] = ()
    merge: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, rules: Mapping[str, Any]) -> GlossRules:
        """Return the rules of corpus.yaml's `annotation.gloss`, checked."""
        strip, merge = rules.get("strip", ()), rules.get("merge", {})
        unknown = [str(key) for key in rules if key not in ("strip", "merge")]
        marks = [strip] if isinstance(strip, str) else list(strip or ())
        if unknown or not all(isinstance(mark, str) and mark for mark in marks):
            raise SignkinError(
                f"the rules are {unknown or marks}"[:120],
                place="key annotation.gloss",
                expected='strip: ["*", "^"] and merge: {HOUSE1: HOUSE}',
            )
        if not isinstance(merge or {}, Mapping):
            raise SignkinError(
                "merge is no table", place="key annotation.gloss.merge", expected="gloss: gloss"
            )
        table = {_composed(key): _composed(value) for key, value in (merge or {}).items()}
        chained = [key for key, value in table.items() if value in table and table[value] != value]
        if chained:
            raise SignkinError(
                f"{chained[0]} counts as {table[chained[0]]}, which counts as another",
                place="key annotation.gloss.merge",
                expected="each gloss once, to the gloss it ends as",
            )
        return cls(tuple(marks), table)

    def gloss(self, label: str) -> str:
        """Return the gloss of a label. One that is nothing but marks stays as it is."""
        text, before = label.strip(), None
        while text != before:
            before = text
            for mark in self.strip:
                text = text.removeprefix(mark).removesuffix(mark).strip()
        text = text or label
        return self.merge.get(text, text)

    def applied(self, annotation: Annotation) -> Annotation:
        """Return the annotation with glosses for labels."""
        intervals = []
        for interval in annotation.intervals:
            gloss = self.gloss(interval.label)
            written = "" if gloss == interval.label else interval.label
            intervals.append(replace(interval, label=gloss, written=interval.written or written))
        return replace(annotation, intervals=tuple(intervals))


def signs_of_hands(
    by_hand: Mapping[str, Sequence[Interval]], dominant: str = "right"
) -> tuple[tuple[Interval, ...], tuple[LeftOut, ...]]:
    """Return one sequence of signs from the tiers of both hands, and what has no place in it.

    by_hand: intervals of `right`, `left` and `both`; dominant: the signer's stronger hand.
    The dominant hand's signs and those of both hands come first. A sign of the other hand
    counts as one where the first are at rest; with the same gloss at the same time it is the
    two-handed sign that is there already; during another gloss it is left out and listed.
    """
    unknown = [hand for hand in by_hand if hand not in ("right", "left", "both")]
    if unknown or dominant not in ("right", "left"):
        raise SignkinError(
            f"hands {unknown or dominant!r}", place="hands", expected="right, left or both"
        )
    other = "left" if dominant == "right" else "right"
    signs = sorted([*by_hand.get("both", ()), *by_hand.get(dominant, ())])
    starts = [sign.start_s for sign in signs]
    longest = max((sign.end_s - sign.start_s for sign in signs), default=0.0)
    alone, left_out = [], []
    for mine in sorted(by_hand.get(other, ())):
        # At the same time: more than half of the shorter of the two.
        first = bisect_left(starts, mine.start_s - longest)
        last = bisect_left(starts, mine.end_s)
        during = [sign for sign in signs[first:last] if _overlap(mine, sign) > 0.5]
        if not during:
            alone.append(mine)
        elif all(sign.label != mine.label for sign in during):
            place = f"{mine.label[:40]!r} at {mine.start_s:.3f} s"
            told = f"the {other} hand's, during {during[0].label[:40]!r} of the dominant hand"
            left_out.append(LeftOut(mine.tier, place, told))
    return tuple(sorted([*signs, *alone])), tuple(left_out)


def _overlap(a: Interval, b: Interval) -> float:
    """Return the time that two intervals share, as a part of the shorter one."""
    shared = min(a.end_s, b.end_s) - max(a.start_s, b.start_s)
    return shared / min(a.end_s - a.start_s, b.end_s - b.start_s)


def labels_to_intervals(
    labels: Sequence[object], rate_hz: float, *, tier: str = "sign", blank: Sequence[str] = ("",)
) -> tuple[Interval, ...]:
    """Return intervals from a label a frame: frames of one label that follow one another.

    labels: (F,), as text; None, NaN and those of `blank` are no sign. Frame i lasts from
    i / rate_hz to (i + 1) / rate_hz seconds.
    """
    if not (isinstance(rate_hz, int | float) and math.isfinite(rate_hz) and rate_hz > 0):
        raise SignkinError(f"the rate is {rate_hz}", place="rate_hz", expected="a rate in Hz")
    none = set(blank)
    texts = ["" if label is None or label != label else str(label).strip() for label in labels]
    out, frame = [], 0
    for text, run in groupby(texts):
        length = sum(1 for _ in run)
        if text and text not in none:
            start, end = round(frame / rate_hz, 9), round((frame + length) / rate_hz, 9)
            out.append(Interval(start, end, text, tier))
        frame += length
    return tuple(out)
