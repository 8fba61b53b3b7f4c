"""Names of the landmarks that trackers give, in their order.

MediaPipe: PoseLandmark and HandLandmark of its Python package. OpenPose: the output formats
BODY_25, COCO and MPI, and the hand, of its documentation.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from signkin.errors import SignkinError, listed
from signkin.io.text import quoted

_SIDED = ("EYE_INNER", "EYE", "EYE_OUTER")
MEDIAPIPE_POSE = (
    "NOSE",
    *(f"LEFT_{part}" for part in _SIDED),
    *(f"RIGHT_{part}" for part in _SIDED),
    "LEFT_EAR", "RIGHT_EAR", "MOUTH_LEFT", "MOUTH_RIGHT",
    *(
        f"{side}_{part}"
        for part in ("SHOULDER", "ELBOW", "WRIST", "PINKY", "INDEX", "THUMB", "HIP", "KNEE",
                     "ANKLE", "HEEL", "FOOT_INDEX")
        for side in ("LEFT", "RIGHT")
    ),
)  # fmt: skip
MEDIAPIPE_HAND = (
    "WRIST", "THUMB_CMC", "THUMB_MCP", "THUMB_IP", "THUMB_TIP",
    *(
        f"{finger}_{part}"
        for finger in ("INDEX_FINGER", "MIDDLE_FINGER", "RING_FINGER", "PINKY")
        for part in ("MCP", "PIP", "DIP", "TIP")
    ),
)  # fmt: skip
# As .pose files name them: component and point.
MEDIAPIPE_HOLISTIC = (
    *(f"POSE_LANDMARKS.{name}" for name in MEDIAPIPE_POSE),
    *(f"FACE_LANDMARKS.{i}" for i in range(468)),
    *(f"LEFT_HAND_LANDMARKS.{name}" for name in MEDIAPIPE_HAND),
    *(f"RIGHT_HAND_LANDMARKS.{name}" for name in MEDIAPIPE_HAND),
)
_ARMS_AND_LEGS = (
    "RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist",
)  # fmt: skip
OPENPOSE_BODY_25 = (
    "Nose", "Neck", *_ARMS_AND_LEGS, "MidHip", "RHip", "RKnee", "RAnkle", "LHip", "LKnee",
    "LAnkle", "REye", "LEye", "REar", "LEar", "LBigToe", "LSmallToe", "LHeel", "RBigToe",
    "RSmallToe", "RHeel",
)  # fmt: skip
OPENPOSE_COCO = (
    "Nose", "Neck", *_ARMS_AND_LEGS, "RHip", "RKnee", "RAnkle", "LHip", "LKnee", "LAnkle",
    "REye", "LEye", "REar", "LEar",
)  # fmt: skip
OPENPOSE_MPI = (
    "Head", "Neck", *_ARMS_AND_LEGS, "RHip", "RKnee", "RAnkle", "LHip", "LKnee", "LAnkle", "Chest",
)  # fmt: skip
# As pose-format names the hand's points: thumb, index, middle, ring, little finger.
OPENPOSE_HAND = (
    "BASE", "T_STT", "T_BCMC", "T_MCP", "T_IP",
    *(f"{finger}_{part}" for finger in "IMRP" for part in ("CMC", "MCP", "PIP", "DIP")),
)  # fmt: skip

LISTS = {
    "mediapipe_pose": MEDIAPIPE_POSE,
    "mediapipe_hand": MEDIAPIPE_HAND,
    "mediapipe_holistic": MEDIAPIPE_HOLISTIC,
    "openpose_body_25": OPENPOSE_BODY_25,
    "openpose_coco": OPENPOSE_COCO,
    "openpose_mpi": OPENPOSE_MPI,
    "openpose_hand": OPENPOSE_HAND,
}


def landmark_names(declared: Any, count: int) -> tuple[str, ...]:
    """Return the names of `count` landmarks: a list of this project's by name, or one's own.

    None names them by their number, from 0.
    """
    if declared is None:
        return tuple(str(i) for i in range(count))
    if isinstance(declared, str):
        if declared not in LISTS:
            raise SignkinError(
                f"no list of landmarks {quoted(declared)}",
                place="options, landmarks",
                expected=f"{listed(LISTS)}, or the names",
            )
        names: Sequence[str] = LISTS[declared]
    elif isinstance(declared, list | tuple) and all(isinstance(n, str) for n in declared):
        names = declared
    else:
        raise SignkinError(
            f"the landmarks are {quoted(declared)}",
            place="options, landmarks",
            expected="a list of names, or one of " + listed(LISTS),
        )
    if len(names) != count:
        raise SignkinError(
            f"{len(names)} landmarks, {count} points in the file",
            place="options, landmarks",
            expected="as many names as points",
        )
    return tuple(names)
