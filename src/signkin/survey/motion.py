"""Checks of a recording's motion: clock, gaps, frozen and torn stretches, sides, axes, tempo."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.signal import periodogram

from signkin.errors import SignkinError
from signkin.joints import HANDS
from signkin.kinematics.gaps import fill_gaps, longest_stretch_s, stretches
from signkin.kinematics.noise import measure_noise
from signkin.kinematics.plausibility import check_recording
from signkin.recording import Recording
from signkin.survey.notices import Notice, judged, untestable

FROZEN_S = 0.5  # a wrist that moves keeps its place to the last bit for no longer
LONGEST_GAP_S = 0.2
MOST_MISSING = 0.2
# Wrists' velocity: half of its power lies below this. On the corpora here, medians over recordings
# of continuous or repeated signing are 1.3 to 2.0 Hz; half or double the rate leaves that range.
TEMPO_HZ = (0.8, 3.5)
TEMPO_BAND_HZ = 6.0
TEMPO_LEAST_S = 1.5
SIDES = "{}s, right of left"
SWAPPED = (
    "right and left are swapped: motion.joints has them the wrong way round, or motion.right "
    "points to the signer's left"
)
WIDEST_M = 2.5  # the space that two wrists reach while their owner stands
TORN_SDS = 25.0  # a third difference this far out is a jump, not noise nor movement


def motion_notices(recording: Recording) -> list[Notice]:
    """Return the checks of one recording's motion."""
    notices = [
        *_gaps(recording), *_frozen(recording), *_jumps(recording), *_sides(recording),
        *_upright(recording), *_space(recording), _tempo(recording),
    ]  # fmt: skip
    notices += _body(recording)
    return notices


def wrists(recording: Recording) -> dict[str, NDArray[np.float64]]:
    """Return the wrists' paths that the recording has, (F, 3)."""
    return {
        hand: recording.track(f"{hand}_wrist")
        for hand in HANDS
        if f"{hand}_wrist" in recording.joints
    }


def _gaps(recording: Recording) -> Iterator[Notice]:
    for hand, path in wrists(recording).items():
        gap = np.asarray(np.isnan(path).any(axis=1))
        share, longest = float(gap.mean()), longest_stretch_s(gap, recording.rate_hz)
        yield judged(
            f"{hand} wrist, missing", share, "share", f"at most {MOST_MISSING:.0%}",
            share > MOST_MISSING,
            "the wrist is not seen for much of it: is the joint named right, the hand in view?",
        )  # fmt: skip
        yield judged(
            f"{hand} wrist, longest gap", longest, "s", f"at most {LONGEST_GAP_S:g} s is filled",
            longest > LONGEST_GAP_S, "this gap stays: no minima and no bins in it",
        )  # fmt: skip


def _frozen(recording: Recording) -> Iterator[Notice]:
    """Stretches in which a wrist keeps its place to the last bit, within ones where it moves."""
    for hand, path in wrists(recording).items():
        still = np.concatenate([[False], (np.diff(path, axis=0) == 0).all(axis=1)])
        longest = longest_stretch_s(still, recording.rate_hz)
        share = float(still.mean())
        # Pixels stand still while a hand rests; that is how they are.
        whole = recording.unit == "px" and np.array_equal(path, np.round(path), equal_nan=True)
        check = f"{hand} wrist, longest frozen stretch"
        if whole:
            yield untestable(check, "whole pixels: a resting hand stands still to the last bit")
            continue
        yield judged(
            check, longest, "s", f"below {FROZEN_S:g} s", longest > FROZEN_S and share < 1,
            "the tracker or the file repeats a frame there: such stretches are no stillness",
        )  # fmt: skip


def _jumps(recording: Recording) -> Iterator[Notice]:
    """Frames at which a wrist jumps, by third differences far beyond their own scatter."""
    for hand, path in wrists(recording).items():
        third = np.linalg.norm(np.diff(path, n=3, axis=0), axis=1)
        third = third[np.isfinite(third)]
        check = f"{hand} wrist, jumps"
        if len(third) < 20:
            yield untestable(check, "fewer than 20 frames in a row")
            continue
        scatter = 1.4826 * float(np.median(np.abs(third - np.median(third))))
        if scatter == 0:
            yield untestable(check, "more than half of the frames do not move at all")
            continue
        out: NDArray[np.bool_] = np.greater(third, np.median(third) + TORN_SDS * scatter)
        count = len(stretches(out))
        per_minute = count / (recording.duration_s / 60)
        yield judged(
            check, count, "places", "at most 5 a minute", count > 1 and per_minute > 5,
            "the path is torn there: tracking lost, or frames missing",
        )  # fmt: skip


def _sides(recording: Recording) -> Iterator[Notice]:
    """Right of the signer must be right of left, for shoulders and hips always, hands mostly."""
    for part, level in (("shoulder", "wrong"), ("hip", "wrong"), ("wrist", "look")):
        pair = [f"{hand}_{part}" for hand in HANDS]
        if not set(pair) <= set(recording.joints):
            continue
        across = recording.track(pair[0])[:, 0] - recording.track(pair[1])[:, 0]
        across = across[np.isfinite(across)]
        if not len(across):
            continue
        share = float((across > 0).mean())
        yield judged(
            SIDES.format(part), share, "share of frames", "above 50 %", share < 0.5,
            SWAPPED if part != "wrist" else "the hands are crossed most of the time, or swapped",
            level,
        )  # fmt: skip
        if part != "wrist":
            yield judged(
                f"{part}s, turned", 1 - share, "share of frames", "below 5 %",
                0.05 < 1 - share <= 0.5,
                "the sides change within the recording: the signer turns, or the tracker swaps",
            )  # fmt: skip


def _upright(recording: Recording) -> Iterator[Notice]:
    """The head is above the hips, or the hands on the whole below the face."""
    tops = [j for j in ("head_top", "head", "nose", "neck") if j in recording.joints]
    if not tops:
        yield untestable("upright", "no head, nose or neck")
        return
    top = recording.track(tops[0])[:, 2]
    bottoms = [j for j in ("pelvis", "right_hip", "right_shoulder") if j in recording.joints]
    name = bottoms[0] if bottoms else "the lower hand"
    hands = [path[:, 2] for path in wrists(recording).values()]
    below = recording.track(name)[:, 2] if bottoms else np.fmin.reduce(hands)
    height = top - below
    height = height[np.isfinite(height)]
    share = float((height > 0).mean()) if len(height) else float("nan")
    if np.isnan(share):
        yield untestable("upright", f"no frame with {tops[0]} and {name}")
        return
    yield judged(
        f"upright, {tops[0]} above {name}", share, "share of frames", "above 80 %", share < 0.8,
        "motion.up is another axis, or points down", "wrong" if share < 0.5 else "look",
    )  # fmt: skip


def _space(recording: Recording) -> Iterator[Notice]:
    """The space that the wrists reach, in metres."""
    if recording.unit != "m":
        return
    paths = list(wrists(recording).values())
    if not paths:
        return
    points = np.concatenate(paths)
    if np.isnan(points).all():
        return
    low, high = np.nanpercentile(points, [1, 99], axis=0)
    reach = float((high - low).max())
    yield judged(
        "space of the hands", reach, "m", f"0.05 to {WIDEST_M:g} m", not 0.05 <= reach <= WIDEST_M,
        "no arms reach so far, or so little: motion.unit is wrong, or these are pixels", "wrong",
    )  # fmt: skip


def _tempo(recording: Recording) -> Notice:
    """Half of the power of the faster wrist's velocity lies below this frequency."""
    found = []
    for path in wrists(recording).values():
        filled = fill_gaps(path, recording.rate_hz, LONGEST_GAP_S)[0]
        runs = stretches(np.asarray(~np.isnan(filled).any(axis=1)))
        first, end = max(runs, key=lambda r: r[1] - r[0], default=(0, 0))
        if (end - first) / recording.rate_hz >= TEMPO_LEAST_S:
            found.append((float(np.ptp(filled[first:end], axis=0).max()), filled[first:end]))
    if not found:
        return untestable("tempo", f"no stretch of {TEMPO_LEAST_S:g} s without a gap")
    path = max(found, key=lambda item: item[0])[1]
    hertz, power = periodogram(np.diff(path, axis=0), fs=recording.rate_hz, axis=0)
    kept = hertz <= min(TEMPO_BAND_HZ, recording.rate_hz / 2)
    mass = np.cumsum(power.sum(axis=1)[kept])
    if mass[-1] <= 0:
        return untestable("tempo", "the wrists do not move")
    half = float(hertz[kept][np.searchsorted(mass, mass[-1] / 2)])
    low, high = TEMPO_HZ
    return judged(
        "tempo", half, "Hz", f"{low:g} to {high:g} Hz over a corpus", not low <= half <= high,
        "slower or faster than signing: the rate may be wrong (half of it doubles all times), or "
        "much of the recording is rest",
    )  # fmt: skip


def _body(recording: Recording) -> list[Notice]:
    """Lengths and speeds that a body can have (signkin.kinematics.plausibility)."""
    if not all(f"{hand}_wrist" in recording.joints for hand in HANDS):
        return [untestable("body", "one wrist alone")]
    levels = {"plausible": "fine", "implausible": "look", "not testable": "not testable"}
    return [
        Notice(f.check, levels[f.verdict], f.value, f.unit, f"{f.low:g} to {f.high:g}", f.note)
        for f in check_recording(recording)
    ]


def noise_sd(recording: Recording) -> float:
    """Return the measured noise of the wrists that there are, NaN where it cannot be measured."""
    try:
        return measure_noise(recording, [f"{hand}_wrist" for hand in wrists(recording)]).sd
    except SignkinError:
        return float("nan")
