"""Synthetic transitions between two signs (Naert et al. 2017, section 3.1, Fig. 1 and 2).

A transition of duration d runs from the last posture of the first sign to the first posture of
the second one, both included: n + 1 frames, n = d times the rate, rounded, at least 1.

Recordings with recorded orientations and a hierarchy are joined in the frames of the parent
joints, so that limbs keep their length. Others are joined joint by joint in the world; there
limbs may be given their length back (`keep_limbs`).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.joints import HANDS, wrists_of
from signkin.kinematics.rotations import linear, local_pose, slerp, unbroken, world_pose
from signkin.recording import Recording

METHODS = ("interpolation", "blending")
FORMS = {"slerp": slerp, "linear": linear}
# Skeletons whose bones differ by less than this are one skeleton. m.
SAME_BONE_M = 1e-3
RATE_TOLERANCE = 1e-3


@dataclass(frozen=True, eq=False, kw_only=True)
class Sign:
    """A sign in its recording.

    start_s, end_s: its meaning part; the first and last posture are the frames nearest to them.
    """

    recording: Recording
    gloss: str
    start_s: float
    end_s: float

    @cached_property
    def first(self) -> int:
        """Frame of the first posture."""
        return self.recording.frame_at(self.start_s)

    @cached_property
    def last(self) -> int:
        """Frame of the last posture."""
        return max(self.first, self.recording.frame_at(self.end_s))

    @property
    def motion(self) -> NDArray[np.int64]:
        """Frames of the sign."""
        return np.arange(self.first, self.last + 1)


@dataclass(frozen=True, eq=False, kw_only=True)
class Transition:
    """A synthetic transition.

    motion: n + 1 frames, the signs' own postures at its ends. duration_s: as asked for.
    idle: frames before the second sign or after the first one that the recordings do not have
    and the idle posture stands in for (blending only). notes: what was changed or is special.
    """

    motion: Recording
    method: str
    duration_s: float
    idle: int = 0
    notes: tuple[str, ...] = ()

    @property
    def steps(self) -> int:
        """Number of frame intervals, n."""
        return self.motion.frames - 1


# --- the two methods -------------------------------------------------------------------------


def interpolate(
    first: Sign,
    second: Sign,
    duration_s: float,
    *,
    orientations: str = "slerp",
    keep_limbs: bool = True,
) -> Transition:
    """Interpolate between the last posture of the first sign and the first of the second one.

    Positions linearly, orientations by `slerp` or the paper's `linear` form (section 3.1).
    duration_s: above 0. Raises SignkinError for recordings with different joints.
    """
    second, notes = fitted(second, first.recording)
    n = steps_of(duration_s, first.recording.rate_hz)
    left = _Pose.of(first.recording, np.full(n + 1, first.last))
    right = _Pose.of(second.recording, np.full(n + 1, second.first))
    motion = _mixed(first.recording, left, right, ramp(n), _form(orientations), keep_limbs)
    return Transition(motion=motion, method="interpolation", duration_s=duration_s, notes=notes)


def blend(
    first: Sign,
    second: Sign,
    duration_s: float,
    *,
    orientations: str = "slerp",
    keep_limbs: bool = True,
    idle: tuple[Recording, int] | None = None,
) -> Transition:
    """Blend the retraction of the first sign with the preparation of the second one.

    The n frames after the first sign fade into the n frames before the second one with a weight
    that rises linearly from 0 to 1 (section 3.1). idle: recording and frame of the idle posture,
    which a recording that ends too early goes to, and one that starts too late comes from; None:
    the lowest hands of the recording itself.
    """
    second, notes = fitted(second, first.recording)
    n = steps_of(duration_s, first.recording.rate_hz)
    after = first.last + np.arange(n + 1)
    before = second.first - n + np.arange(n + 1)
    left, missing_after = _captured(first.recording, after, idle)
    right, missing_before = _captured(second.recording, before, idle)
    told = list(notes)
    for missing, where, name in (
        (missing_after, "after", first.gloss),
        (missing_before, "before", second.gloss),
    ):
        if missing:
            told.append(f"no motion {where} {name} for {missing} of {n} frames: idle posture")
    motion = _mixed(first.recording, left, right, ramp(n), _form(orientations), keep_limbs)
    return Transition(
        motion=motion,
        method="blending",
        duration_s=duration_s,
        idle=missing_after + missing_before,
        notes=tuple(told),
    )


def steps_of(duration_s: float, rate_hz: float) -> int:
    """Return the number of frame intervals of a duration, at least 1."""
    if not (np.isfinite(duration_s) and duration_s > 0):
        raise SignkinError(
            f"a transition of {duration_s:g} s",
            place="duration",
            expected="a duration above 0 s",
            todo="Choose another duration model, or a lower bound for it.",
        )
    return max(1, round(duration_s * rate_hz))


def ramp(n: int) -> NDArray[np.float64]:
    """Return the weights of the second motion, (n + 1,), from 0 to 1."""
    return np.arange(n + 1) / n


def idle_frame(recording: Recording) -> int:
    """Return the frame of a recording's idle posture: where the wrists hang lowest together."""
    height = sum(recording.track(wrist)[:, 2] for wrist in wrists_of(recording.joints))
    if np.isnan(height).all():
        return 0
    return int(np.nanargmin(height))


# --- recordings that differ ------------------------------------------------------------------


def fitted(sign: Sign, to: Recording) -> tuple[Sign, tuple[str, ...]]:
    """Return the sign in a recording that can be joined to another one, and what was changed.

    Other joints are an error. Another rate is resampled to the other recording's, another length
    of bones (recordings with a hierarchy) is replaced by the other skeleton's.
    """
    if sign.recording is to:
        return sign, ()
    own, notes = _fitted(sign.recording, to)
    return replace(sign, recording=own), notes


@lru_cache(maxsize=64)
def _fitted(own: Recording, to: Recording) -> tuple[Recording, tuple[str, ...]]:
    if own.joints != to.joints or own.unit != to.unit or _joined(own) != _joined(to):
        lost = sorted(set(to.joints) ^ set(own.joints))
        raise SignkinError(
            f"the skeletons of {to.name} and {own.name} differ"
            + (f" in {listed(lost)}" if lost else " in order, unit, hierarchy or orientations"),
            file=f"recording {own.name}",
            expected="the same joints in both recordings",
            todo="Choose signs of recordings with one skeleton.",
        )
    notes = []
    if abs(own.rate_hz - to.rate_hz) > RATE_TOLERANCE * to.rate_hz:
        notes.append(f"{own.name} resampled from {own.rate_hz:g} to {to.rate_hz:g} Hz")
        own = resampled(own, to.rate_hz)
    if _joined(own):
        bones, there = _bones(own), _bones(to)
        child = np.array(own.parents) >= 0
        worst = float(np.abs(bones - there)[child].max(initial=0.0))
        if worst > SAME_BONE_M:
            notes.append(f"{own.name} put on the skeleton of {to.name} ({worst:.3f} m apart)")
            own = _with_bones(own, there)
    return own, tuple(notes)


def resampled(recording: Recording, rate_hz: float) -> Recording:
    """Return a recording at another rate: positions linear, orientations by slerp."""
    frames = int(np.floor((recording.frames - 1) / recording.rate_hz * rate_hz + 1e-9)) + 1
    at = np.minimum(np.arange(frames) / rate_hz * recording.rate_hz, recording.frames - 1)
    low = np.minimum(at.astype(int), recording.frames - 2)
    part = at - low
    positions, turns = recording.positions, recording.orientations
    between = positions[low] + part[:, None, None] * (positions[low + 1] - positions[low])
    # A frame that stands on a captured one takes nothing from a gap beside it.
    exact = part < 1e-9
    between[exact] = positions[low[exact]]
    if turns is not None:
        turned = slerp(turns[low], turns[low + 1], part[:, None, None])
        turned[exact] = turns[low[exact]]
        turns = turned
    return replace(recording, rate_hz=rate_hz, positions=between, orientations=turns)


def _joined(recording: Recording) -> bool:
    """Whether the recording has what joining in the parents' frames wants."""
    return recording.orientation_source == "recorded" and recording.parents is not None


_BONES: WeakKeyDictionary[Recording, NDArray[np.float64]] = WeakKeyDictionary()


def _bones(recording: Recording) -> NDArray[np.float64]:
    """Return the median shift of each joint in its parent's frame, (J, 3)."""
    # Kept as long as the recording is: it is asked for with each other recording.
    if recording not in _BONES:
        shifts = _whole(recording).shifts
        # The same numbers: without gaps in less than half of the time.
        median = np.nanmedian if np.isnan(shifts).any() else np.median
        _BONES[recording] = np.asarray(median(shifts, axis=0))
    return _BONES[recording]


def _with_bones(recording: Recording, bones: NDArray[np.float64]) -> Recording:
    pose = _Pose.of(recording, np.arange(recording.frames))
    assert recording.parents is not None and pose.turns is not None
    child = np.array(recording.parents) >= 0
    pose.shifts[:, child] = bones[child]
    positions, turns = world_pose(pose.shifts, pose.turns, recording.parents)
    return replace(recording, positions=positions, orientations=turns)


def moved(recording: Recording, turn_rad: float, shift: NDArray[np.float64]) -> Recording:
    """Return a recording turned about the vertical and then shifted, as a whole."""
    cosine, sine = np.cos(turn_rad), np.sin(turn_rad)
    matrix = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    positions = recording.positions @ matrix.T + shift
    turns = recording.orientations
    if turns is not None:
        x, y, z, w = np.moveaxis(turns, -1, 0)
        c, s = np.cos(turn_rad / 2), np.sin(turn_rad / 2)
        turns = np.stack([c * x - s * y, c * y + s * x, c * z + s * w, c * w - s * z], axis=-1)
    return replace(recording, positions=positions, orientations=turns)


# --- postures that are mixed -----------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Pose:
    """Postures as they are mixed: shifts (F, J, 3), turns (F, J, 4) or None."""

    shifts: NDArray[np.float64]
    turns: NDArray[np.float64] | None

    @classmethod
    def of(cls, recording: Recording, frames: NDArray[np.int64]) -> _Pose:
        """Return the postures of some frames, in the parents' frames where there are some."""
        whole = _whole(recording)
        return cls(whole.shifts[frames], None if whole.turns is None else whole.turns[frames])


@lru_cache(maxsize=64)
def _whole(recording: Recording) -> _Pose:
    """Return all postures of a recording; many transitions ask for the same."""
    if recording.orientation_source != "recorded" or recording.orientations is None:
        return _Pose(recording.positions, None)
    if recording.parents is None:
        return _Pose(recording.positions, unbroken(recording.orientations))
    shifts, turns = local_pose(recording.positions, recording.orientations, recording.parents)
    return _Pose(shifts, unbroken(turns))


def _captured(
    recording: Recording, frames: NDArray[np.int64], idle: tuple[Recording, int] | None
) -> tuple[_Pose, int]:
    """Return the postures of frames, some of which the recording may not have.

    These go from the recording's last posture to the idle one (or come from it to the first),
    at a constant pace, so that nothing jumps. Returns the number of such frames as well.
    """
    inside = np.clip(frames, 0, recording.frames - 1)
    pose = _Pose.of(recording, inside)
    missing = frames != inside
    if not missing.any():
        return pose, 0
    source, frame = (recording, idle_frame(recording)) if idle is None else idle
    rest = _Pose.of(source, np.array([frame]))
    away = np.abs(frames - inside)
    weight = (away / away.max())[:, None, None]
    shifts = (1 - weight) * pose.shifts + weight * rest.shifts
    turns = pose.turns
    if turns is not None and rest.turns is not None:
        turns = slerp(turns, np.broadcast_to(rest.turns, turns.shape), weight)
    return _Pose(shifts, turns), int(missing.sum())


def _form(name: str) -> str:
    if name not in FORMS:
        raise SignkinError(
            f"orientations by {name!r}", place="synthesis.orientations", expected=listed(FORMS)
        )
    return name


def _mixed(
    recording: Recording,
    left: _Pose,
    right: _Pose,
    weight: NDArray[np.float64],
    form: str,
    keep_limbs: bool,
) -> Recording:
    """Return left and right mixed frame by frame, as a recording with left's name and skeleton."""
    w = weight[:, None, None]
    shifts = (1 - w) * left.shifts + w * right.shifts
    turns = None
    if left.turns is not None and right.turns is not None:
        # One way round for the whole transition: choosing at each frame could jump.
        agree = (left.turns * right.turns).sum(axis=(0, 2), keepdims=True)
        there = np.where(agree < 0, -right.turns, right.turns)
        turns = FORMS[form](left.turns, there, w, shorter=False)
    if turns is None:
        if keep_limbs and recording.unit == "m":
            shifts = _with_limbs(recording.joints, shifts, left.shifts, right.shifts, w[..., 0])
        positions = shifts
    elif recording.parents is None:
        positions = shifts
    else:
        positions, turns = world_pose(shifts, turns, recording.parents)
    return replace(
        recording,
        positions=positions,
        orientations=turns,
        orientation_source="none" if turns is None else "recorded",
    )


def _with_limbs(
    joints: tuple[str, ...],
    mixed: NDArray[np.float64],
    left: NDArray[np.float64],
    right: NDArray[np.float64],
    weight: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Give each limb the length that lies between its lengths in left and right.

    From the shoulders outwards: a limb keeps the direction that mixing gave it, its end and what
    hangs on it are moved. Mixing positions shortens limbs that turn.
    """
    out = mixed.copy()
    for child, parent in limbs(joints):
        limb = mixed[:, child] - mixed[:, parent]
        length = np.linalg.norm(limb, axis=1, keepdims=True)
        wanted = (1 - weight) * _length(left, child, parent) + weight * _length(
            right, child, parent
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            factor = np.where(length > 0, wanted / length, 1.0)
        out[:, child] = out[:, parent] + factor * limb
    return out


def _length(positions: NDArray[np.float64], child: int, parent: int) -> NDArray[np.float64]:
    return np.asarray(
        np.linalg.norm(positions[:, child] - positions[:, parent], axis=1, keepdims=True)
    )


def limbs(joints: Sequence[str]) -> list[tuple[int, int]]:
    """Return (child, parent) of the arms' limbs among canonical joints, from the shoulders on."""
    place = {joint: i for i, joint in enumerate(joints)}
    out = []
    for hand in HANDS:
        chains = [["shoulder", "elbow", "wrist"]]
        for finger in ("thumb", "index", "middle", "ring", "pinky"):
            parts = [f"{finger}_{n}" for n in ("1", "2", "3", "4", "tip")]
            chains.append(["wrist", *(p for p in parts if f"{hand}_{p}" in place)])
        for chain in chains:
            names = [f"{hand}_{part}" for part in chain]
            there = [place[name] for name in names if name in place]
            if names[0] in place:
                out += [(child, parent) for parent, child in itertools.pairwise(there)]
    return out
