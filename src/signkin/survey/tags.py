"""Checks of a recording's tags: against one another, and against the motion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from signkin.annotation import Interval
from signkin.kinematics.derivatives import speed
from signkin.kinematics.filters import lowpass
from signkin.kinematics.gaps import fill_gaps
from signkin.recording import Recording
from signkin.survey.clock import Offset, clock_offset
from signkin.survey.motion import LONGEST_GAP_S, wrists
from signkin.survey.notices import Notice, judged, untestable

CUTOFF_HZ = 6.0
# Means of sign tags of the corpora here: 0.2 to 0.7 s; citation forms reach 1.5 s.
SIGN_S = (0.12, 1.6)
SHORTEST_S = 0.04
STILL_SHARE = 0.1  # of the recording's usual speed: a tagged sign that moves less is none
LEAST_COVER = 0.5
NEARLY = 0.04  # of the motion, which tags leave open at its ends


def tag_notices(recording: Recording, signs: Sequence[Interval]) -> list[Notice]:
    """Return the checks of one recording's sign tags; signs: in order of time."""
    if not signs:
        return [Notice("tags", "look", 0, "tags", "one or more", "the sign tier is empty here")]
    start = np.array([s.start_s for s in signs])
    end = np.array([s.end_s for s in signs])
    fast = fastest_wrist(recording)
    return [
        *_lengths(start, end), *_overlaps(start, end), *_labels(signs),
        *_cover(recording, start, end), *_stillness(recording, fast, start, end),
        _clock(recording, fast, start, end),
    ]  # fmt: skip


def fastest_wrist(recording: Recording) -> NDArray[np.float64]:
    """Return the speed of the faster wrist, frame by frame, low-passed, (F,); NaN in gaps."""
    found = []
    for path in wrists(recording).values():
        filled = fill_gaps(path, recording.rate_hz, LONGEST_GAP_S)[0]
        cutoff = min(CUTOFF_HZ, 0.4 * recording.rate_hz)
        found.append(speed(lowpass(filled, recording.rate_hz, cutoff), recording.rate_hz))
    return np.asarray(np.fmax.reduce(found))


def _lengths(start: NDArray[np.float64], end: NDArray[np.float64]) -> Iterator[Notice]:
    lengths = end - start
    middle, (low, high) = float(np.median(lengths)), SIGN_S
    yield judged(
        "tags, median length", middle, "s", f"{low:g} to {high:g} s", not low <= middle <= high,
        "not the length of signs: is the tier the signs', and the unit of time right (ms, frames)?",
    )  # fmt: skip
    short = int((lengths < SHORTEST_S).sum())
    yield judged(
        "tags, too short", short, "tags", f"none below {SHORTEST_S:g} s", short > 0,
        "no sign is so short: slips of the mouse",
    )  # fmt: skip


def _overlaps(start: NDArray[np.float64], end: NDArray[np.float64]) -> Iterator[Notice]:
    over = int((start[1:] < end[:-1] - 1e-9).sum())
    yield judged(
        "tags, overlapping", over, "pairs", "none", over > 0,
        "they count in no statistic: two hands' tiers in one, or slips",
    )  # fmt: skip
    touching = float((np.abs(start[1:] - end[:-1]) <= 1e-9).mean()) if len(start) > 1 else 0.0
    yield judged(
        "tags without a gap to the next", touching, "share", "below 50 %", touching > 0.5,
        "signs are tagged end to end, so that there are no transitions to measure",
    )  # fmt: skip


def _labels(signs: Sequence[Interval]) -> Iterator[Notice]:
    empty = sum(not s.label.strip() for s in signs)
    yield judged("tags without a gloss", empty, "tags", "none", empty > 0, "name them in the tier")


def _cover(
    recording: Recording, start: NDArray[np.float64], end: NDArray[np.float64]
) -> Iterator[Notice]:
    cover = float((end.max() - start.min()) / recording.duration_s)
    told = "much of the motion has no tags: an excerpt, or motion and tags of different rates"
    if abs(cover - 0.5) < NEARLY and start.min() < NEARLY * recording.duration_s:
        told = (
            f"the tags end where half of the motion is over: at {2 * recording.rate_hz:g} Hz, not "
            f"{recording.rate_hz:g}, both would last as long (or the other half has no tags)"
        )
    yield judged(
        "tags, part of the motion from the first to the last", cover, "share",
        f"above {LEAST_COVER + NEARLY:.0%}", cover < LEAST_COVER + NEARLY, told,
    )  # fmt: skip


def _stillness(
    recording: Recording, fast: NDArray[np.float64], start: NDArray[np.float64],
    end: NDArray[np.float64],
) -> Iterator[Notice]:  # fmt: skip
    """Tags in which no hand moves."""
    check = "tags outside motion"
    if np.isnan(fast).all():
        yield untestable(check, "no wrist speed")
        return
    usual = float(np.nanpercentile(fast, 75))
    still = 0
    for a, b in zip(start, end, strict=True):
        part = fast[int(a * recording.rate_hz) : int(np.ceil(b * recording.rate_hz)) + 1]
        part = part[np.isfinite(part)]
        still += bool(len(part)) and float(part.max()) < STILL_SHARE * usual
    share = still / len(start)
    yield judged(
        check, still, "tags", "at most one in twenty", share > 0.05,
        "no hand moves in them: are tags and motion of one recording, on one clock?",
    )  # fmt: skip


def _clock(
    recording: Recording, fast: NDArray[np.float64], start: NDArray[np.float64],
    end: NDArray[np.float64],
) -> Notice:  # fmt: skip
    check = "clock, tags to motion"
    found = clock_offset(fast, recording.rate_hz, np.concatenate([start, end]))
    if found is None:
        return untestable(check, "too few tags, or too short a recording, for an estimate")
    return clock_notice(check, found)


def clock_notice(check: str, found: Offset) -> Notice:
    """Return the notice of an estimated offset."""
    if not found.certain:
        return untestable(check, "no shift of the tags fits the minima of speed better than chance")
    return judged(
        check, found.offset_s, "s", "near 0", found.wrong,
        f"shifted by {found.offset_s:+.2f} s the tags would lie at minima of speed (the dip is "
        f"{found.depth:.1f} robust SDs deep there, {found.at_zero:.1f} as it is): check the clock",
        "wrong",
    )  # fmt: skip
