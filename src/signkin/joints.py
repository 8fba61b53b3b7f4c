"""The names of joints: one vocabulary for every corpus, whatever its files call them.

A corpus maps its own names to these in corpus.yaml. Sided names start with
`right_` or `left_`, always the signer's own side.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Sequence

HANDS = ("right", "left")

MIDLINE = ("pelvis", "spine", "spine_1", "spine_2", "spine_3", "chest", "neck", "neck_1", "head",
           "head_top", "nose", "mouth")  # fmt: skip
BODY = ("clavicle", "hip", "knee", "ankle", "heel", "toe", "eye", "ear", "mouth")
ARM = ("shoulder", "elbow", "wrist", "palm")
FINGERS = ("thumb", "index", "middle", "ring", "pinky")

_FINGER = re.compile(rf"({'|'.join(FINGERS)})_([1-4]|tip)")


def is_known(joint: str) -> bool:
    """Return whether `joint` belongs to the vocabulary."""
    if joint in MIDLINE:
        return True
    hand, part = split(joint)
    return hand is not None and (part in BODY or is_arm_part(part))


def is_arm_part(part: str) -> bool:
    """Return whether a part (`elbow`, `index_tip`) lies between the shoulder and the fingertips."""
    return part in ARM or _FINGER.fullmatch(part) is not None


def split(joint: str) -> tuple[str | None, str]:
    """Return side and part: `right_wrist` -> (`right`, `wrist`); midline -> (None, name)."""
    for hand in HANDS:
        if joint.startswith(f"{hand}_"):
            return hand, joint.removeprefix(f"{hand}_")
    return None, joint


def hands_of(joints: Iterable[str]) -> tuple[str, ...]:
    """Return the hands whose wrist is among the joints: one of a one-handed recording."""
    there = set(joints)
    return tuple(hand for hand in HANDS if f"{hand}_wrist" in there)


def wrists_of(joints: Iterable[str]) -> list[str]:
    """Return the wrists among the joints."""
    return [f"{hand}_wrist" for hand in hands_of(joints)]


def arm_joints(joints: Iterable[str], hand: str) -> list[str]:
    """Return the joints of one arm, shoulder to fingertips (Naert et al. 2017, section 5.1)."""
    sided = ((joint, *split(joint)) for joint in joints)
    return [joint for joint, side, part in sided if side == hand and is_arm_part(part)]


_TRUNK = ("pelvis", "spine", "spine_1", "spine_2", "spine_3", "chest", "neck", "neck_1", "head",
          "head_top")  # fmt: skip


def bones(joints: Sequence[str]) -> list[tuple[int, int]]:
    """Return the pairs of joints that a stick figure joins by a line."""
    place = {joint: i for i, joint in enumerate(joints)}
    names: list[tuple[str, str]] = []
    trunk = [joint for joint in _TRUNK if joint in place]
    names += list(itertools.pairwise(trunk))
    top = next((j for j in ("chest", "spine_3", "spine_2", "neck") if j in place), None)
    for hand in HANDS:
        arm = [f"{hand}_{part}" for part in ("clavicle", "shoulder", "elbow", "wrist")]
        arm = [joint for joint in arm if joint in place]
        if top is not None and arm and not arm[0].endswith("wrist"):
            arm = [top, *arm]
        names += list(itertools.pairwise(arm))
        names.append((f"{hand}_shoulder", f"{hand}_hip"))
        for finger in FINGERS:
            chain = [f"{hand}_wrist"]
            chain += [f"{hand}_{finger}_{n}" for n in ("1", "2", "3", "4", "tip")]
            chain = [joint for joint in chain if joint in place]
            names += list(itertools.pairwise(chain))
    if top is None:
        names.append(("right_shoulder", "left_shoulder"))
    names.append(("right_hip", "left_hip"))
    return [(place[a], place[b]) for a, b in names if a in place and b in place]


def vocabulary() -> str:
    """Return a sentence that tells which names there are, for error messages."""
    sided = ", ".join((*ARM, *BODY))
    fingers = ", ".join(FINGERS)
    return (
        f"one of {', '.join(MIDLINE)}, or right_/left_ followed by {sided}, "
        f"or by {fingers} with _1 to _4 or _tip"
    )
