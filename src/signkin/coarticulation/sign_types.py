"""Types of signs (Naert et al. 2017, section 5.1): from the lexicon, or inferred from motion.

Two digits: hands (0 one, 1 two, 2 one while the other keeps the context) and
symmetry (1 only for two-handed signs). The paper's types come from people who
know the language; the inference is a stand-in, marked `kinematic` wherever it
is used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.annotation import Interval

# x points to the signer's right: mirroring in the sagittal plane turns its sign.
MIRROR = np.array([-1.0, 1.0, 1.0])


@dataclass(frozen=True)
class TypeRule:
    """Thresholds of the inference (config: sign_types).

    activity: below this ratio of the wrists' paths a sign is one-handed.
    mirror: from this correlation of mirrored velocities a two-handed sign is symmetric.
    held_shift: a still hand that moved less than this since the last sign, in reaches, is held.
    held_height: and stands above this share of its range of heights.
    """

    activity: float
    mirror: float
    held_shift: float
    held_height: float


@dataclass(frozen=True, eq=False)
class Wrists:
    """Low-passed paths of both wrists, (F, 3), relative to the trunk where it is known.

    rate_hz: of the paths. reach: a length of the signer to measure by, in their unit.
    """

    right: NDArray[np.float64]
    left: NDArray[np.float64]
    rate_hz: float
    reach: float

    def frames(self, start_s: float, end_s: float) -> slice:
        """Return the frames of an interval, at least two."""
        first = int(np.clip(np.rint(start_s * self.rate_hz), 0, len(self.right) - 2))
        last = int(np.clip(np.rint(end_s * self.rate_hz), first + 1, len(self.right) - 1))
        return slice(first, last + 1)


def reach_of(
    right: NDArray[np.float64], left: NDArray[np.float64], arm_length: float | None
) -> float:
    """Return a signer's reach: the arm's length, or the wrists' spread where it is unknown.

    The spread is the diagonal of the box that holds the middle 90 % of both wrists' places.
    """
    if arm_length is not None and np.isfinite(arm_length):
        return arm_length
    places = np.concatenate([right, left])
    places = places[~np.isnan(places).any(axis=1)]
    low, high = np.quantile(places, [0.05, 0.95], axis=0)
    return float(np.linalg.norm(high - low))


def sign_type_rows(
    signs: Sequence[Interval],
    utterances: Sequence[str],
    wrists: Wrists,
    lexicon: Mapping[str, str],
    rule: TypeRule,
) -> pd.DataFrame:
    """Return a row a sign of one recording: lexicon type, kinematic type, the one in use.

    utterances: name of each sign's utterance; only a sign before in the same utterance
    can leave a context. Columns as the table `sign_types` without its lead.
    """
    rows: list[dict[str, object]] = []
    for i, sign in enumerate(signs):
        follows = i > 0 and utterances[i] == utterances[i - 1]
        before = rows[-1] if follows else None
        inferred = _infer(sign, signs[i - 1] if follows else None, before, wrists, rule)
        known = lexicon.get(sign.label, "")
        rows.append(
            {
                "sign": i + 1,
                "gloss": sign.label,
                "start_s": sign.start_s,
                "end_s": sign.end_s,
                "lexicon": known,
                **inferred,
                "type": known or inferred["kinematic"],
                "type_source": "lexicon" if known else "kinematic",
            }
        )
    columns = ["sign", "gloss", "start_s", "end_s", "lexicon", "kinematic", "type",
               "type_source", "activity", "mirror", "held_shift", "note"]  # fmt: skip
    return pd.DataFrame(rows, columns=columns)


def _infer(
    sign: Interval,
    before: Interval | None,
    before_row: Mapping[str, object] | None,
    wrists: Wrists,
    rule: TypeRule,
) -> dict[str, object]:
    span = wrists.frames(sign.start_s, sign.end_s)
    right, left = wrists.right[span], wrists.left[span]
    paths = {"right": _path(right), "left": _path(left)}
    out: dict[str, object] = {
        "activity": np.nan,
        "mirror": np.nan,
        "held_shift": np.nan,
        "note": "",
    }
    if not all(np.isfinite(path) for path in paths.values()):
        seen = [hand for hand, path in paths.items() if np.isfinite(path)]
        note = "a wrist is missing: taken for one-handed" if seen else "both wrists are missing"
        return {**out, "kinematic": "00" if seen else "", "note": note}
    busier = max(paths.values())
    activity = min(paths.values()) / busier if busier > 0 else 0.0
    out["activity"] = activity
    if activity >= rule.activity:
        mirror = _mirror_correlation(right, left)
        return {**out, "mirror": mirror, "kinematic": "11" if mirror >= rule.mirror else "10"}
    idle = wrists.left if paths["left"] <= paths["right"] else wrists.right
    if before is None or before_row is None:
        return {**out, "kinematic": "00"}
    shift = _held_shift(idle, span, wrists.frames(before.start_s, before.end_s)) / wrists.reach
    out["held_shift"] = shift
    used_before = str(before_row["kinematic"]).startswith(("1", "2"))
    held = used_before and shift < rule.held_shift and _raised(idle, span, rule.held_height)
    return {**out, "kinematic": "20" if held else "00"}


def _path(track: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.diff(track, axis=0), axis=1).sum())


def _mirror_correlation(right: NDArray[np.float64], left: NDArray[np.float64]) -> float:
    """Return the uncentred correlation of the velocities, the left one mirrored; 1 is a mirror."""
    v, w = np.diff(right, axis=0), np.diff(left, axis=0) * MIRROR
    size = np.sqrt((v**2).sum() * (w**2).sum())
    return float((v * w).sum() / size) if size > 0 else 0.0


def _held_shift(track: NDArray[np.float64], now: slice, before: slice) -> float:
    """Return how far the still hand's middle place lies from where the sign before left it."""
    place = np.nanmedian(track[now], axis=0)
    return float(np.linalg.norm(place - track[before.stop - 1]))


def _raised(track: NDArray[np.float64], now: slice, share: float) -> bool:
    heights = track[:, 2]
    low, high = np.nanquantile(heights, [0.02, 0.98])
    return bool(np.nanmedian(heights[now]) > low + share * (high - low))
