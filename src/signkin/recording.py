"""A recording: one take of motion, validated when it is made.

Units: seconds, metres (or pixels, for image corpora), hertz. Axes: (frame,
joint, xyz), with z up, x towards the signer's right and y forward. Quaternions
are scalar-last. NaN is a gap; nothing here fills it.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError, listed
from signkin.masked import unmasked

UNITS = ("m", "px")
ORIENTATION_SOURCES = ("recorded", "limb_frames", "none")


@dataclass(frozen=True, eq=False, kw_only=True)
class Recording:
    """One take.

    name: the recording's name in its corpus.
    rate_hz: frames a second, > 0; never rounded.
    joints: J names.
    positions: (F, J, 3), in `unit`.
    orientations: (F, J, 4) unit quaternions x, y, z, w in the world frame, or None.
    orientation_source: `recorded`, `limb_frames` (made from positions) or `none`.
    parents: index of each joint's parent, -1 for a root, where a hierarchy is known.
    notes: what was decided in reading, a sentence each (an overruled rate, a resampled clock).
    """

    name: str
    rate_hz: float
    joints: tuple[str, ...]
    positions: NDArray[np.float64]
    orientations: NDArray[np.float64] | None = None
    orientation_source: str = "none"
    unit: str = "m"
    parents: tuple[int, ...] | None = None
    notes: tuple[str, ...] = ()
    _index: dict[str, int] = field(init=False, repr=False, default_factory=dict)

    def __post_init__(self) -> None:
        """Check every field; errors name the recording and the joint or frame."""
        for name in ("positions", "orientations"):
            if np.ma.isMaskedArray(getattr(self, name)):
                object.__setattr__(self, name, unmasked(getattr(self, name)))
        if not (np.isfinite(self.rate_hz) and self.rate_hz > 0):
            raise self._error("rate", f"the rate is {self.rate_hz:g} Hz", "a rate above 0 Hz")
        if self.unit not in UNITS:
            raise self._error("unit", f"the unit is {self.unit!r}", listed(UNITS))
        doubled = sorted(joint for joint, count in Counter(self.joints).items() if count > 1)
        if doubled:
            raise self._error("joints", f"{listed(doubled)} occurs twice", "each joint once")
        expected = f"(frames, {len(self.joints)}, 3)"
        shape = self.positions.shape
        if self.positions.ndim != 3 or shape[1:] != (len(self.joints), 3):
            raise self._error("positions", f"the array has shape {shape}", expected)
        if shape[0] < 2:
            raise self._error("positions", f"there are {shape[0]} frames", "2 frames or more")
        self._refuse_infinite("positions", self.positions)
        self._check_orientations()
        if self.parents is not None and len(self.parents) != len(self.joints):
            raise self._error(
                "parents", f"{len(self.parents)} parents", f"{len(self.joints)}, one a joint"
            )
        object.__setattr__(self, "_index", {joint: i for i, joint in enumerate(self.joints)})

    def _check_orientations(self) -> None:
        if self.orientation_source not in ORIENTATION_SOURCES:
            raise self._error(
                "orientations",
                f"the source is {self.orientation_source!r}",
                listed(ORIENTATION_SOURCES),
            )
        if (self.orientations is None) != (self.orientation_source == "none"):
            raise self._error(
                "orientations",
                f"the source is {self.orientation_source!r} and the orientations are "
                f"{'missing' if self.orientations is None else 'there'}",
                "both or neither",
            )
        if self.orientations is None:
            return
        expected = (*self.positions.shape[:2], 4)
        if self.orientations.shape != expected:
            raise self._error(
                "orientations", f"the array has shape {self.orientations.shape}", str(expected)
            )
        self._refuse_infinite("orientations", self.orientations)
        norms = np.linalg.norm(self.orientations, axis=2)
        off = np.abs(norms - 1) > 1e-6
        if off.any():
            frame, joint = np.argwhere(off)[0]
            raise self._error(
                f"joint {self.joints[joint]}, frame {frame}",
                f"a quaternion has length {norms[frame, joint]:.6g}",
                "unit quaternions",
            )

    def _refuse_infinite(self, what: str, values: NDArray[np.float64]) -> None:
        bad = np.isinf(values).any(axis=2)
        if bad.any():
            frame, joint = np.argwhere(bad)[0]
            raise self._error(
                f"joint {self.joints[joint]}, frame {frame}",
                f"the {what} hold an infinite value",
                "a finite value, or NaN for a gap",
            )

    def _error(self, place: str, found: str, expected: str) -> SignkinError:
        return SignkinError(found, file=f"recording {self.name}", place=place, expected=expected)

    @property
    def frames(self) -> int:
        """Number of frames."""
        return int(self.positions.shape[0])

    @property
    def duration_s(self) -> float:
        """Length in seconds: frames divided by the rate."""
        return self.frames / self.rate_hz

    @property
    def times_s(self) -> NDArray[np.float64]:
        """Time of each frame, (F,), in seconds from the start."""
        return np.arange(self.frames) / self.rate_hz

    def index(self, joint: str) -> int:
        """Return the index of a joint; an unknown name is an error that lists the known ones."""
        try:
            return self._index[joint]
        except KeyError:
            error = self._error("joints", f"no joint {joint!r}", listed(self.joints, 60))
            if joint.endswith("_wrist"):
                error.todo = "What needs both hands cannot be made of one."
            raise error from None

    def track(self, joint: str) -> NDArray[np.float64]:
        """Return the path of one joint, (F, 3)."""
        return self.positions[:, self.index(joint)]

    def frame_at(self, time_s: float) -> int:
        """Return the frame nearest to a time, kept inside the recording."""
        return int(np.clip(np.rint(time_s * self.rate_hz), 0, self.frames - 1))

    def without_orientations(self) -> Recording:
        """Return the recording with its positions only."""
        return replace(self, orientations=None, orientation_source="none")
