"""What a human body can do, against what a recording says it did.

Rates and units are declared by people and are sometimes wrong. Limb lengths tell
a wrong unit, wrist speeds a wrong rate (speeds grow with the declared rate,
lengths do not). A recording that fails is reported, never changed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from signkin.kinematics.derivatives import speed
from signkin.kinematics.filters import lowpass
from signkin.recording import Recording


@dataclass(frozen=True)
class Limit:
    """The plausible range of a measure, wide enough for any adult."""

    low: float
    high: float
    unit: str


# Lengths: 1st percentile of women to 99th of men, widened by a tenth for markers that sit
# beside the joint (Winter, Biomechanics and Motor Control of Human Movement, fig. 4.1).
LIMITS = {
    "upper arm": Limit(0.20, 0.42, "m"),
    "forearm": Limit(0.18, 0.36, "m"),
    "shoulder width": Limit(0.24, 0.50, "m"),
    "reach": Limit(0.15, 0.85, "m"),
    # Fast signing moves the wrist at 2-3 m/s at its peaks; a whole recording whose fastest
    # hundredth exceeds 4.5 m/s, or never comes to 0.1 m/s, is not signing at that rate.
    "wrist speed": Limit(0.10, 4.5, "m/s"),
    "limb length variation": Limit(0.0, 0.20, "of the length"),
}
SHOULDER_WIDTH_M = 0.36
TYPICAL_WRIST_SPEED = 1.5  # m/s, 99th percentile of ordinary signing
# How many times too short lengths are, by how the unit was mistaken.
MISTAKES = {
    0.001: "in mm, read as m", 0.01: "in cm, read as m", 0.1: "in mm, read as cm",
    10.0: "in cm, read as mm", 100.0: "in m, read as cm", 1000.0: "in m, read as mm",
    0.0254: "in inches, read as m", 2.54: "in inches, read as cm", 25.4: "in inches, read as mm",
    0.3048: "in feet, read as m", 30.48: "in feet, read as cm",
    5.6444: "in the 5.6444 cm of CMU's conversions, read as cm",
    0.056444: "in the 5.6444 cm of CMU's conversions, read as m",
}  # fmt: skip
# Share of the rate, not Hz: a low-pass in Hz would take the speed off that a wrong rate adds.
SPEED_CUTOFF = 0.12


@dataclass(frozen=True)
class Finding:
    """One check: measured value (in `unit`), plausible range, verdict, and what to do."""

    check: str
    value: float
    unit: str
    low: float
    high: float
    verdict: str
    note: str = ""


def check_recording(recording: Recording) -> list[Finding]:
    """Return the findings for lengths, reach, speeds and swapped sides of one recording.

    A pixel recording is measured with the shoulders' width as a ruler (0.36 m); without
    shoulders, lengths and speeds are not testable.
    """
    ruler = metres_per_unit(recording)
    findings = []
    right, left = (_speed_finding(recording, hand, ruler) for hand in ("right", "left"))
    for hand, own, other in (("right", right, left), ("left", left, right)):
        findings += _length_findings(recording, hand, ruler)
        findings.append(_at_rest(own, other))
    findings.append(_swap_finding(recording))
    return _with_unit_advice(findings, recording)


def metres_per_unit(recording: Recording) -> float | None:
    """Return 1 for metres; for pixels, metres a pixel by the shoulders' width, None without."""
    if recording.unit == "m":
        return 1.0
    width = _length(recording, "right_shoulder", "left_shoulder")
    return None if width is None else SHOULDER_WIDTH_M / float(np.nanmedian(width))


def _length(recording: Recording, a: str, b: str) -> NDArray[np.float64] | None:
    if a not in recording.joints or b not in recording.joints:
        return None
    length = np.linalg.norm(recording.track(a) - recording.track(b), axis=1)
    return None if np.isnan(length).all() else np.asarray(length)


def _length_findings(recording: Recording, hand: str, ruler: float | None) -> list[Finding]:
    limbs = {
        "upper arm": (f"{hand}_shoulder", f"{hand}_elbow"),
        "forearm": (f"{hand}_elbow", f"{hand}_wrist"),
    }
    if hand == "right":
        limbs["shoulder width"] = ("right_shoulder", "left_shoulder")
    out = []
    for limb, ends in limbs.items():
        name = limb if limb == "shoulder width" else f"{hand} {limb}"
        length = _length(recording, *ends)
        if recording.unit == "px" or length is None or ruler is None:
            out.append(_untestable(name, LIMITS[limb], recording, ends))
            continue
        middle = float(np.nanmedian(length))
        out.append(_finding(name, middle, LIMITS[limb], ""))
        if limb != "shoulder width":
            spread = float(np.nanstd(length)) / middle if middle > 0 else float("nan")
            note = "the limb changes its length: axes of different units, or poor tracking"
            out.append(
                _finding(f"{name}, variation", spread, LIMITS["limb length variation"], note)
            )
    reach = _length(recording, f"{hand}_shoulder", f"{hand}_wrist")
    if reach is not None and ruler is not None:
        far = float(np.nanpercentile(reach, 99)) * ruler
        limit = LIMITS["reach"]
        out.append(_finding(f"{hand} reach", far, limit, ""))
    return out


def _speed_finding(recording: Recording, hand: str, ruler: float | None) -> Finding:
    limit = LIMITS["wrist speed"]
    name = f"{hand} wrist speed, 99th percentile"
    joint = f"{hand}_wrist"
    if ruler is None or joint not in recording.joints:
        return _untestable(name, limit, recording, (joint,))
    rate = recording.rate_hz
    smooth = lowpass(recording.track(joint), rate, SPEED_CUTOFF * rate)
    moving = speed(smooth, rate)
    if np.isnan(moving).all():
        return _untestable(name, limit, recording, (joint,))
    fastest = float(np.nanpercentile(moving, 99)) * ruler
    note = ""
    if fastest > limit.high:
        likely = rate * TYPICAL_WRIST_SPEED / fastest
        note = (
            f"at {rate:g} Hz no hand moves so fast; ordinary signing "
            f"({TYPICAL_WRIST_SPEED:g} m/s) would mean about {likely:.0f} Hz or another unit, "
            "or in single recordings, jumps of the tracker"
        )
    elif fastest < limit.low:
        note = "this hand hardly moves: a hand that rests, or a wrong rate or unit"
    return _finding(name, fastest, limit, note)


def _at_rest(own: Finding, other: Finding) -> Finding:
    """Let a hand rest while the other signs: a wrong rate or unit would slow down both."""
    if own.value < own.low and other.verdict == "plausible":
        return replace(own, verdict="plausible", note="this hand rests while the other one moves")
    return own


def _swap_finding(recording: Recording) -> Finding:
    """Count frames at which right and left wrist seem to change places (tracker's confusion)."""
    check, limit = "frames at which the hands swap", Limit(0, 0, "frames")
    wrists = ("right_wrist", "left_wrist")
    if not set(wrists) <= set(recording.joints):
        return _untestable(check, limit, recording, wrists)
    right, left = (recording.track(joint) for joint in wrists)
    same = _step(right[1:], right[:-1]) + _step(left[1:], left[:-1])
    swapped = _step(right[1:], left[:-1]) + _step(left[1:], right[:-1])
    apart = _step(right[1:], left[1:])
    with np.errstate(invalid="ignore"):
        jumps = (swapped < 0.3 * same) & (same > apart)
    count = int(np.count_nonzero(jumps))
    return _finding(check, count, limit, "the tracker may have mixed up the sides there")


def _step(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.linalg.norm(a - b, axis=1))


def _finding(check: str, value: float, limit: Limit, note: str) -> Finding:
    fine = limit.low <= value <= limit.high
    verdict = "plausible" if fine else "implausible"
    return Finding(check, value, limit.unit, limit.low, limit.high, verdict, "" if fine else note)


def _untestable(check: str, limit: Limit, recording: Recording, joints: tuple[str, ...]) -> Finding:
    missing = [joint for joint in joints if joint not in recording.joints]
    why = (
        f"no {', '.join(missing)}"
        if missing
        else "pixels without a length of the body to measure by"
        if recording.unit == "px"
        else "no frame with the joints"
    )
    nan = float("nan")
    return Finding(check, nan, limit.unit, limit.low, limit.high, "not testable", why)


def _with_unit_advice(findings: list[Finding], recording: Recording) -> list[Finding]:
    """Say of implausible lengths what would make all of them plausible: one factor, or none."""

    def is_length(finding: Finding) -> bool:
        return finding.unit == "m" and finding.verdict != "not testable" and finding.value > 0

    # A reach bounds from above only: hands may stay near the body.
    low = max((f.low / f.value for f in findings if is_length(f) and "reach" not in f.check),
              default=0.0)  # fmt: skip
    high = min((f.high / f.value for f in findings if is_length(f)), default=0.0)
    if not 0 < low <= high or recording.unit == "px":
        advice = "the unit, the joint map or the tracking is wrong"
    else:
        known = [factor for factor in MISTAKES if low <= factor <= high]
        if known:
            factor = known[0]
            named = f": the file may be {MISTAKES[factor]}"
        else:
            factor, named = float(np.sqrt(low * high)), ""
        advice = f"all lengths would be plausible {factor:.5g} times as long{named}"
    return [
        replace(f, note=advice) if is_length(f) and f.verdict == "implausible" else f
        for f in findings
    ]
