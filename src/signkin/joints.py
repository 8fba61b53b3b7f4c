"""The names of joints: one vocabulary for every corpus, whatever its files call them.

A corpus maps its own names to these in corpus.yaml. Sided names start with
`right_` or `left_`, always the signer's own side.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

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


def vocabulary() -> str:
    """Return a sentence that tells which names there are, for error messages."""
    sided = ", ".join((*ARM, *BODY))
    fingers = ", ".join(FINGERS)
    return (
        f"one of {', '.join(MIDLINE)}, or right_/left_ followed by {sided}, "
        f"or by {fingers} with _1 to _4 or _tip"
    )
