"""Postures around the transitions, at the two distances that were designed."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from signkin.errors import SignkinError
from signkin.simulate.body import ARM_COORDINATES, ARM_MOVES, HAND_MOVES, Body
from signkin.simulate.lsf.signs import FRAME_S, Token, Transition

LEAST_DROP_RAD = 0.3  # coordinates of the left arm above rest that count as raised
CANDIDATES = 24
GOAL_TOLERANCE = 1e-7
MOST_TRIES = 40  # other last postures of a sign, where no next one is at the right distance
RELAXED = np.concatenate([[0.0, -0.38, 0.10, -0.22], np.zeros(8)])
_LOW = np.array([-0.5, -0.35, -0.5, -0.45, -0.9, -0.6, -0.5, *[-0.2] * 5])
_HIGH = np.array([0.5, 0.60, 0.5, 0.55, 0.9, 0.6, 0.5, *[1.1] * 5])


def choose_postures(
    tokens: list[Token], between: list[Transition], body: Body, rng: np.random.Generator
) -> None:
    """Choose each sign's first and last posture so that the transitions have their distances."""
    tokens[0].first = _first_posture(tokens[0].kind, rng)
    for (token, following), goal in zip(pairwise(tokens), between, strict=True):
        for _ in range(MOST_TRIES):
            token.last = _last_posture(token, rng)
            reached = _reached(token.last, following.kind, goal, body, rng)
            if reached is not None:
                following.first = reached
                break
        else:
            raise SignkinError(
                f"no posture at {goal.geodesic_rad:.4f} rad and {goal.euclidean_cm:.3f} cm found",
                place="simulated posture",
                expected="distances that a body can have",
                todo="Another seed may do.",
            )
    tokens[-1].last = _last_posture(tokens[-1], rng)


def _last_posture(token: Token, rng: np.random.Generator) -> NDArray[np.float64]:
    length_s = (token.end - token.start) * FRAME_S
    return inside(token.first + stroke(token.kind, length_s, rng))


def _first_posture(kind: str, rng: np.random.Generator) -> NDArray[np.float64]:
    right = _target(rng)
    left = {"11": right, "10": _target(rng), "00": RELAXED, "20": _target(rng)}[kind]
    return np.concatenate([right, left])


def _target(rng: np.random.Generator) -> NDArray[np.float64]:
    middle, half = (_LOW + _HIGH) / 2, (_HIGH - _LOW) / 2
    return middle + half * rng.uniform(-0.8, 0.8, ARM_COORDINATES)


def inside(posture: NDArray[np.float64]) -> NDArray[np.float64]:
    """Keep postures (..., 24) within what the arms can do."""
    right = np.clip(posture[..., :ARM_COORDINATES], _LOW, _HIGH)
    left = np.clip(posture[..., ARM_COORDINATES:], np.minimum(_LOW, RELAXED), _HIGH)
    return np.concatenate([right, left], axis=-1)


def stroke(kind: str, length_s: float, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return the change of posture over one stroke: mirrored, opposed, or of one hand only."""
    size = min(0.45, 0.3 + 0.4 * length_s) * rng.uniform(0.6, 1.0)
    direction = rng.normal(size=4)
    right = np.zeros(ARM_COORDINATES)
    right[ARM_MOVES] = size * direction / np.linalg.norm(direction)
    right[HAND_MOVES] = rng.normal(0, 0.12, 8)
    left = np.zeros(ARM_COORDINATES)
    if kind == "11":
        left = right.copy()
    elif kind == "10":
        # The other hand moves too, along but not as a mirror image would.
        other = rng.normal(size=4)
        left[ARM_MOVES] = -0.6 * right[ARM_MOVES] + 0.25 * size * other / np.linalg.norm(other)
        left[HAND_MOVES] = rng.normal(0, 0.12, 8)
    return np.concatenate([right, left])


def _reached(
    start: NDArray[np.float64],
    kind: str,
    goal: Transition,
    body: Body,
    rng: np.random.Generator,
) -> NDArray[np.float64] | None:
    """Return a posture for the next sign at the goal's two distances from `start`, or None.

    Each candidate has a direction for the arms (towards a target that suits the sign) and one
    for the hands; how far to go along each is found by Newton's method, all candidates at once.
    """
    for _ in range(3):
        arms, hands = _directions(start, kind, rng)
        along = np.tile([0.35, 0.5], (CANDIDATES, 1))
        for _ in range(25):
            error, slope = _error_and_slope(start, arms, hands, along, goal, body)
            reached = start + along[:, :1] * arms + along[:, 1:] * hands
            outside = np.abs(reached - inside(reached)).max(axis=1)
            near = np.abs(error).max(axis=1) < GOAL_TOLERANCE
            fits = near & (along[:, 0] > 0.01) & (outside < 1e-12)
            if fits.any():
                # One-handed signs let the other hand drop as far as the distance allows.
                dropped = np.abs(reached - start)[:, 12:].sum(axis=1) if kind == "00" else 0
                return np.asarray(reached[int(np.argmax(np.where(fits, 1 + dropped, 0)))])
            with np.errstate(all="ignore"):
                step = np.einsum("nij,nj->ni", _inverse(slope), error)
            along = along - np.clip(np.nan_to_num(step), -0.3, 0.3)
    return None


def _directions(
    start: NDArray[np.float64], kind: str, rng: np.random.Generator
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    arms = np.zeros((CANDIDATES, 24))
    hands = np.zeros((CANDIDATES, 24))
    moves = np.arange(ARM_COORDINATES)[ARM_MOVES]
    shapes = np.arange(ARM_COORDINATES)[HAND_MOVES]
    for k in range(CANDIDATES):
        right = _target(rng)
        left = {"11": right, "10": _target(rng), "00": RELAXED, "20": start[ARM_COORDINATES:]}[kind]
        arms[k, moves] = (right - start[:ARM_COORDINATES])[ARM_MOVES]
        drop = (left - start[ARM_COORDINATES:])[ARM_MOVES]
        arms[k, ARM_COORDINATES + moves] = drop
        if kind == "00" and np.linalg.norm(drop) > LEAST_DROP_RAD:
            # The left hand goes down, and leaves less of the distance to the right one.
            arms[k, moves] *= rng.uniform(0.3, 1.0)
        hands[k, shapes] = rng.normal(0, 0.5, 8)
        if kind.startswith("1"):
            mixed = hands[k, shapes] if kind == "11" else rng.normal(0, 0.5, 8)
            hands[k, ARM_COORDINATES + shapes] = mixed
    return arms, hands


def _error_and_slope(
    start: NDArray[np.float64],
    arms: NDArray[np.float64],
    hands: NDArray[np.float64],
    along: NDArray[np.float64],
    goal: Transition,
    body: Body,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    step = 1e-6
    shifts = np.array([[0.0, 0.0], [step, 0.0], [0.0, step]])
    points = along[:, None, :] + shifts
    postures = start + points[..., :1] * arms[:, None] + points[..., 1:] * hands[:, None]
    flat = postures.reshape(-1, 24)
    geodesic, euclidean = body.distances(start[None], flat)
    # Scaled so that both distances weigh alike.
    error = np.stack([geodesic / goal.geodesic_rad, euclidean / goal.euclidean_cm], axis=1) - 1
    error = error.reshape(len(along), 3, 2)
    slope = np.stack([(error[:, 1] - error[:, 0]) / step, (error[:, 2] - error[:, 0]) / step], 2)
    return error[:, 0], slope


def _inverse(m: NDArray[np.float64]) -> NDArray[np.float64]:
    determinant = m[:, 0, 0] * m[:, 1, 1] - m[:, 0, 1] * m[:, 1, 0]
    adjugate = np.stack(
        [
            np.stack([m[:, 1, 1], -m[:, 0, 1]], axis=1),
            np.stack([-m[:, 1, 0], m[:, 0, 0]], axis=1),
        ],
        axis=1,
    )
    return np.asarray(adjugate / determinant[:, None, None])
