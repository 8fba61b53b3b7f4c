"""Postures to motion: strokes of least jerk, rests between utterances, sway and noise."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from signkin.simulate.body import Body
from signkin.simulate.lsf.postures import inside, stroke
from signkin.simulate.lsf.signs import FRAME_S, Token
from signkin.simulate.strokes import share_done

JOINT_NOISE_RAD = 0.0006  # SD per joint and frame: about half a millimetre at the wrist
ROOT_NOISE_CM = 0.03
SWAY_RAD = 0.005
REST = np.concatenate([[0.0, -0.55, 0.15, -0.35], np.zeros(8)])


def minimum_jerk(
    times_s: Sequence[float], values: Sequence[NDArray[np.float64]], at_s: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return a path (F, D) that rests at each key and moves between them with least jerk."""
    keys, stops = np.asarray(times_s), np.asarray(values)
    k = np.clip(np.searchsorted(keys, at_s, side="right") - 1, 0, len(keys) - 2)
    share = share_done((at_s - keys[k]) / (keys[k + 1] - keys[k]))
    return np.asarray(stops[k] + share[:, None] * (stops[k + 1] - stops[k]))


def coordinates_of(
    utterances: Sequence[Sequence[Token]], frames: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Return the coordinates of both arms at every frame, (F, 24)."""
    at = np.asarray(np.arange(frames) * FRAME_S, dtype=np.float64)
    keys: dict[str, list[tuple[float, NDArray[np.float64]]]] = {
        hand: [(-1.0, REST)] for hand in ("right", "left")
    }
    for tokens in utterances:
        for hand in keys:
            # Hands come up from rest before an utterance, and go down after it.
            keys[hand].append((tokens[0].true_s[hand][0] - rng.uniform(0.45, 0.6), REST))
        for token in tokens:
            strokes = _inner_keys(token, rng)
            for hand, part in (("right", slice(0, 12)), ("left", slice(12, 24))):
                start_s, end_s = token.true_s[hand]
                keys[hand].append((start_s, token.first[part]))
                if hand in token.hands:
                    span = end_s - start_s
                    keys[hand] += [(start_s + x * span, posture[part]) for x, posture in strokes]
                keys[hand].append((end_s, token.last[part]))
        for hand in keys:
            keys[hand].append((tokens[-1].true_s[hand][1] + rng.uniform(0.45, 0.6), REST))
    for hand in keys:
        keys[hand].append((frames * FRAME_S + 1.0, REST))
    tracks = []
    for hand in ("right", "left"):
        times = [time for time, _ in keys[hand]]
        tracks.append(minimum_jerk(times, [posture for _, posture in keys[hand]], at))
    return np.hstack(tracks)


def _inner_keys(token: Token, rng: np.random.Generator) -> list[tuple[float, NDArray[np.float64]]]:
    """Return the turning points inside a sign: share of its length, posture."""
    length_s = (token.end - token.start) * FRAME_S
    inner = 0 if length_s < 0.4 else 1 if length_s < 0.62 else 2
    shares = (np.arange(1, inner + 1) + rng.uniform(-0.15, 0.15, inner)) / (inner + 1)
    out = []
    posture = token.first
    for share in shares:
        posture = inside(posture + stroke(token.kind, length_s / (inner + 1), rng))
        out.append((float(share), posture))
    return out


def channel_values(
    coordinates: NDArray[np.float64], body: Body, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Return BVH channel values (F, C): root position in cm, rotations in degrees."""
    frames = len(coordinates)
    rotations = body.rotations(coordinates[:, :12], coordinates[:, 12:])
    moving = [i for i, channels in enumerate(body.hierarchy.channels) if channels]
    noise = rng.normal(0, JOINT_NOISE_RAD, (frames, len(moving), 3))
    noise[:, 0] += _sway(frames, rng)
    noise[:, 1] += _sway(frames, rng)
    turned = rotations[:, moving] @ Rotation.from_rotvec(noise.reshape(-1, 3)).as_matrix().reshape(
        frames, len(moving), 3, 3
    )
    angles = Rotation.from_matrix(turned.reshape(-1, 3, 3)).as_euler("ZXY", degrees=True)
    root = body.hierarchy.offsets[0] + rng.normal(0, ROOT_NOISE_CM, (frames, 3))
    return np.hstack([root, angles.reshape(frames, -1)])


def _sway(frames: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return slow turns of the body, (F, 3): three sines under 0.4 Hz an axis."""
    at = np.arange(frames)[:, None, None] * FRAME_S
    frequency = rng.uniform(0.08, 0.4, (1, 3, 3))
    phase = rng.uniform(0, 2 * np.pi, (1, 3, 3))
    return np.asarray((SWAY_RAD / 3 * np.sin(2 * np.pi * frequency * at + phase)).sum(axis=2))
