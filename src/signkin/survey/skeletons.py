"""Names that known skeletons give to joints, and which joint of the vocabulary each is."""

from __future__ import annotations

import re
from collections.abc import Sequence

from signkin.joints import FINGERS, HANDS

# Part -> names without side, prefix, case and signs. The order is that of preference.
PARTS: dict[str, tuple[str, ...]] = {
    "shoulder": ("shoulder", "upperarm", "arm", "sho", "fsh", "humerus"),
    "elbow": ("elbow", "forearm", "lowerarm", "elb", "radius"),
    "wrist": ("wrist", "hand", "wri", "base", "iwr", "wre"),
    "clavicle": ("clavicle", "collar", "clav", "shoulderblade"),
    "hip": ("hip", "upleg", "thigh", "femur", "asi"),
    "knee": ("knee", "leg", "shin", "tibia", "kne"),
    "ankle": ("ankle", "foot", "ank"),
    "eye": ("eye",),
    "ear": ("ear",),
}
MIDLINE: dict[str, tuple[str, ...]] = {
    "pelvis": ("hips", "pelvis", "midhip", "spinebase", "root", "hip", "center"),
    "chest": ("chest", "spine3", "spine2", "spineshoulder", "upperchest", "t8", "thorax"),
    "neck": ("neck", "c7"),
    "head": ("head", "headcenter"),
    "nose": ("nose",),
}
_SIDES = {"right": ("right", "r"), "left": ("left", "l")}
_FINGER_WORDS = {"thumb": "thumb", "index": "index", "middle": "middle", "mid": "middle",
                 "ring": "ring", "pinky": "pinky", "little": "pinky"}  # fmt: skip
_JOINT_WORDS = {"cmc": "1", "mcp": "1", "pip": "2", "ip": "3", "dip": "3", "tip": "tip"}
# In a thumb the knuckle is the second joint.
_THUMB_WORDS = {"cmc": "1", "mcp": "2", "ip": "3", "tip": "tip"}


def joint_map(names: Sequence[str]) -> dict[str, str]:
    """Return canonical joint -> name in the file, for the names that are recognised.

    MediaPipe's world landmarks go before its image landmarks. Where an arm has `Shoulder` and `Arm`
    (as in BVH of motion-capture suits), the first is the collar.
    """
    world = [n for n in names if "WORLD" in n.upper()]
    hands = [n for n in names if "HAND_LANDMARKS" in n.upper()]
    usable = [*world, *hands] if world else list(names)
    plain = {name: _words(name) for name in usable}
    found: dict[str, str] = {}
    for hand in HANDS:
        of_side = {name: rest for name in usable if (rest := _unsided(plain[name], hand))}
        found |= _arm(of_side, hand)
        for name, rest in of_side.items():
            finger = _finger(rest)
            if finger:
                found.setdefault(f"{hand}_{finger}", name)
    for joint, words in MIDLINE.items():
        for word in words:
            match = next((n for n in usable if "".join(plain[n]) == word), None)
            if match and match not in found.values():
                found[joint] = match
                break
    return found


def _words(name: str) -> list[str]:
    """Return the words of a name, lower case, without a subject's or a component's prefix."""
    bare = name.rpartition(":")[2]
    component, _, point = bare.rpartition(".")
    bare = point if re.search("landmarks|keypoints", component, re.IGNORECASE) else bare
    side = re.match(r"(LEFT|RIGHT)_HAND_LANDMARKS\.", name)
    bare = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", bare)
    words = re.findall(r"[a-z]+|\d+", bare.lower())
    words = [w for w in words if w not in ("mixamorig", "character", "b", "bip", "def", "jnt")]
    return [side[1].lower(), *words] if side else words


def _unsided(words: list[str], hand: str) -> str:
    """Return a name's words as one, without the side; empty where it is not of this side."""
    for side in _SIDES[hand]:
        if side in words:
            rest = list(words)
            rest.remove(side)
            return "".join(rest)
    whole = "".join(words)
    if whole.startswith(_SIDES[hand][0]):
        return whole.removeprefix(_SIDES[hand][0])
    # Plug-in Gait and OpenPose: RSHO, LWrist.
    letter = _SIDES[hand][1]
    known = {word for group in PARTS.values() for word in group}
    if whole.startswith(letter) and whole[1:] in known | {"wra", "wrb"} and whole != "rear":
        return whole[1:]
    return ""


def _arm(of_side: dict[str, str], hand: str) -> dict[str, str]:
    by_rest: dict[str, str] = {}
    for name, rest in of_side.items():
        by_rest.setdefault(rest, name)
    found: dict[str, str] = {}
    for part, words in PARTS.items():
        match = next((by_rest[w] for w in words if w in by_rest), None)
        if match:
            found[f"{hand}_{part}"] = match
    # Two bones: the collar is called shoulder, the upper arm arm.
    if "arm" in by_rest and "shoulder" in by_rest:
        found[f"{hand}_shoulder"] = by_rest["arm"]
        found[f"{hand}_clavicle"] = by_rest["shoulder"]
    if f"{hand}_wrist" not in found and "wra" in by_rest:
        found[f"{hand}_wrist"] = by_rest["wra"]
    return found


def _finger(rest: str) -> str:
    """Return `index_2` for `handindex2` or `indexfingerpip`; empty where it is no finger."""
    bare = rest.removeprefix("hand").replace("finger", "")
    for word, finger in _FINGER_WORDS.items():
        if not bare.startswith(word) or finger not in FINGERS:
            continue
        end = bare.removeprefix(word)
        numbers = _THUMB_WORDS if finger == "thumb" else _JOINT_WORDS
        if end in numbers:
            return f"{finger}_{numbers[end]}"
        if end in ("1", "2", "3", "4"):
            return f"{finger}_{end}"
    return ""
