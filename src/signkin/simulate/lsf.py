"""The corpus lsf-sim: simulated signing whose manual tags carry the printed Table 2.

Two recordings of a body at 100 Hz. Between the manual tags stand the 89
transitions of Naert et al. 2017: their types, numbers, means and SDs are those of
the printed Table 2, and the distances between the postures around them are
designed to lie about the printed surface with its printed mean error. Hands move
in minimum-jerk strokes, each hand with true boundaries of its own; the manual
tags stand beside them by a tagger's jitter.

It shows whether the pipeline finds what was put in. It says nothing about people.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from signkin.annotation import Interval
from signkin.errors import SignkinError
from signkin.io.bvh import write_bvh
from signkin.io.eaf import write_eaf
from signkin.simulate.body import ARM_COORDINATES, ARM_MOVES, HAND_MOVES, Body
from signkin.simulate.chains import chains
from signkin.simulate.printed import integers_with, sums_from_print
from signkin.simulate.strokes import share_done
from signkin.simulate.surface import design_distances

TERMS = ("constant", "geodesic", "euclidean")  # order of theta
RATE_HZ = 100.0
FRAME_S = 0.01
DURATION_RANGE = (10, 50)  # frames; claims N03 and N04 of the paper, the outlier aside
UTTERANCES = 14
MOST_TRANSITIONS = 9  # in one utterance
SIGN_FRAMES = (22, 75)
TAG_JITTER_S = 0.03  # SD of manual tag against the right hand's boundary
MOST_JITTER_S = 0.08
LEFT_LAG_S = (0.025, 0.018)  # mean and SD of the left hand's boundary against the right's
LEAST_TRUE_SIGN_S = 0.14
LEAST_TRUE_TRANSITION_S = 0.05
PAUSE_FRAMES = (140, 200)  # between utterances, hands down and up again
JOINT_NOISE_RAD = 0.0006  # SD per joint and frame: about half a millimetre at the wrist
ROOT_NOISE_CM = 0.03
SWAY_RAD = 0.005
LEAST_DROP_RAD = 0.3  # coordinates of the left arm above rest that count as raised
CANDIDATES = 24
GOAL_TOLERANCE = 1e-7
MOST_TRIES = 40  # other last postures of a sign, where no next one is at the right distance

REST = np.concatenate([[0.0, -0.55, 0.15, -0.35], np.zeros(8)])
RELAXED = np.concatenate([[0.0, -0.38, 0.10, -0.22], np.zeros(8)])
_LOW = np.array([-0.5, -0.35, -0.5, -0.45, -0.9, -0.6, -0.5, *[-0.2] * 5])
_HIGH = np.array([0.5, 0.60, 0.5, 0.55, 0.9, 0.6, 0.5, *[1.1] * 5])


@dataclass
class Token:
    """One sign of an utterance: what, when, and between which postures."""

    gloss: str
    kind: str
    start: int = 0  # manual tags in frames
    end: int = 0
    true_s: dict[str, tuple[float, float]] = field(default_factory=dict)
    first: NDArray[np.float64] = field(default_factory=lambda: np.zeros(24))
    last: NDArray[np.float64] = field(default_factory=lambda: np.zeros(24))

    @property
    def hands(self) -> tuple[str, ...]:
        """Hands that move in the sign."""
        return ("right", "left") if self.kind.startswith("1") else ("right",)


@dataclass(frozen=True)
class Transition:
    """A designed transition: type, duration in frames, distances (rad, cm)."""

    kind: str
    frames: int
    geodesic_rad: float
    euclidean_cm: float


@dataclass(frozen=True, eq=False)
class SimulatedRecording:
    """One recording as it is written: channel values in degrees and cm, and its signs."""

    name: str
    values: NDArray[np.float64]
    utterances: tuple[tuple[Token, ...], ...]


@dataclass(frozen=True, eq=False)
class SimulatedCorpus:
    """The recordings, the true boundaries and the design behind them."""

    recordings: tuple[SimulatedRecording, ...]
    truth: pd.DataFrame
    design: pd.DataFrame


def simulate(
    names: Sequence[str],
    lexicon: Mapping[str, str],
    table2: pd.DataFrame,
    theta: NDArray[np.float64],
    mean_error_s: float,
    euclidean_unit_m: float,
    rng: np.random.Generator,
) -> SimulatedCorpus:
    """Simulate the corpus.

    names: of the recordings. lexicon: gloss -> two digits. table2: the printed table, all
    text. theta (3,), mean_error_s: the printed surface and its mean error, for geodesic
    distances in radians and Euclidean ones in `euclidean_unit_m`.
    """
    designed = _design(table2, theta, mean_error_s, euclidean_unit_m, rng)
    body = Body()
    utterances = _utterances(designed, lexicon, rng)
    order = rng.permutation(len(utterances))
    groups = np.array_split(order, len(names))
    recordings, truth, design = [], [], []
    for name, group in zip(names, groups, strict=True):
        chosen = [utterances[i] for i in sorted(group)]
        recording = _recording(name, chosen, body, rng)
        recordings.append(recording)
        truth += _truth_rows(recording)
        design += _design_rows(name, chosen)
    return SimulatedCorpus(tuple(recordings), pd.DataFrame(truth), pd.DataFrame(design))


# --- what is to be simulated -----------------------------------------------------------------


def _design(
    table2: pd.DataFrame,
    theta: NDArray[np.float64],
    mean_error_s: float,
    unit_m: float,
    rng: np.random.Generator,
) -> list[Transition]:
    kinds, frames = [], []
    for row in table2.itertuples(index=False):
        n = int(row.n)
        if not n:
            continue
        values = _row_durations(row, rng)
        kinds += [str(row.type)] * n
        frames += values
    durations = np.array(frames) * FRAME_S
    dropped = np.array([kind[:2] in ("10", "11") and kind[2:] == "00" for kind in kinds])
    geodesic, euclidean = design_distances(durations, theta, mean_error_s, dropped, rng)
    return [
        Transition(kind, f, float(g), float(e * unit_m * 100))
        for kind, f, g, e in zip(kinds, frames, geodesic, euclidean, strict=True)
    ]


def _row_durations(row: object, rng: np.random.Generator) -> list[int]:
    """Return integer durations with the row's printed number, mean and SD."""
    grain = str(FRAME_S)
    n, mean, sd = int(row.n), row.mean, row.sd  # type: ignore[attr-defined]
    total, squares = sums_from_print(n, mean, sd, grain)
    without = row.n_without_outlier  # type: ignore[attr-defined]
    if not without:
        return integers_with(n, total, squares, *DURATION_RANGE, rng)
    kept = sums_from_print(
        int(without),
        row.mean_without_outlier,  # type: ignore[attr-defined]
        row.sd_without_outlier,  # type: ignore[attr-defined]
        grain,
    )
    outlier = total - kept[0]
    if int(without) != n - 1 or outlier**2 != squares - kept[1]:
        raise SignkinError(
            f"{n} and {without} values do not differ by one outlier",
            place=f"printed row {row.type}",  # type: ignore[attr-defined]
            expected="sums and sums of squares that leave one value",
        )
    return [*integers_with(int(without), *kept, *DURATION_RANGE, rng), outlier]


def _utterances(
    designed: Sequence[Transition], lexicon: Mapping[str, str], rng: np.random.Generator
) -> list[tuple[list[Token], list[Transition]]]:
    """Return utterances: signs, and the transitions between them."""
    pool: dict[tuple[str, str], list[Transition]] = {}
    for transition in designed:
        pool.setdefault((transition.kind[:2], transition.kind[2:]), []).append(transition)
    for transitions in pool.values():
        order = rng.permutation(len(transitions))
        transitions[:] = [transitions[i] for i in order]
    counts = {edge: len(transitions) for edge, transitions in pool.items()}
    glosses: dict[str, list[str]] = {}
    for gloss, kind in lexicon.items():
        glosses.setdefault(kind, []).append(gloss)
    out = []
    for chain in chains(counts, UTTERANCES, MOST_TRANSITIONS, rng):
        tokens = [Token(str(rng.choice(glosses[kind])), kind) for kind in chain]
        between = [pool[edge].pop() for edge in pairwise(chain)]
        out.append((tokens, between))
    return out


# --- one recording ---------------------------------------------------------------------------


def _recording(
    name: str,
    utterances: Sequence[tuple[list[Token], list[Transition]]],
    body: Body,
    rng: np.random.Generator,
) -> SimulatedRecording:
    clock = int(rng.integers(*PAUSE_FRAMES))
    for tokens, between in utterances:
        clock = _place_tags(tokens, between, clock, rng)
        _true_times(tokens, rng)
        _postures(tokens, between, body, rng)
        clock += int(rng.integers(*PAUSE_FRAMES))
    signs = [tokens for tokens, _ in utterances]
    coordinates = _coordinates(signs, clock, rng)
    values = _channel_values(coordinates, body, rng)
    return SimulatedRecording(name, values, tuple(tuple(tokens) for tokens in signs))


def _place_tags(
    tokens: list[Token], between: list[Transition], clock: int, rng: np.random.Generator
) -> int:
    for i, token in enumerate(tokens):
        token.start = clock
        token.end = clock + int(rng.integers(*SIGN_FRAMES))
        clock = token.end + (between[i].frames if i < len(between) else 0)
    return clock


def _true_times(tokens: list[Token], rng: np.random.Generator) -> None:
    """Draw the hands' true boundaries beside the manual tags, in the order they must have."""

    def jitter() -> float:
        return float(np.clip(rng.normal(0, TAG_JITTER_S), -MOST_JITTER_S, MOST_JITTER_S))

    edges = np.array([(token.start, token.end) for token in tokens]).ravel() * FRAME_S
    gaps = np.tile([LEAST_TRUE_SIGN_S, LEAST_TRUE_TRANSITION_S], len(tokens))[:-1]
    right = _drawn_in_order(edges, gaps, jitter)
    mean, sd = LEFT_LAG_S
    left = _drawn_in_order(right, gaps, lambda: float(np.clip(rng.normal(mean, sd), -0.02, 0.07)))
    for i, token in enumerate(tokens):
        token.true_s = {
            "right": (right[2 * i], right[2 * i + 1]),
            "left": (left[2 * i], left[2 * i + 1]),
        }


def _drawn_in_order(
    edges: Iterable[float], gaps: NDArray[np.float64], draw: Callable[[], float]
) -> list[float]:
    """Move each time by a draw, so that the next one still comes late enough after it."""
    out: list[float] = []
    for i, edge in enumerate(edges):
        for _ in range(100):
            time = edge + draw()
            if not out or time - out[-1] >= gaps[i - 1]:
                break
        else:
            time = out[-1] + gaps[i - 1]
        out.append(float(time))
    return out


# --- postures --------------------------------------------------------------------------------


def _postures(
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
    return _inside(token.first + _stroke(token.kind, length_s, rng))


def _first_posture(kind: str, rng: np.random.Generator) -> NDArray[np.float64]:
    right = _target(rng)
    left = {"11": right, "10": _target(rng), "00": RELAXED, "20": _target(rng)}[kind]
    return np.concatenate([right, left])


def _target(rng: np.random.Generator) -> NDArray[np.float64]:
    middle, half = (_LOW + _HIGH) / 2, (_HIGH - _LOW) / 2
    return middle + half * rng.uniform(-0.8, 0.8, ARM_COORDINATES)


def _inside(posture: NDArray[np.float64]) -> NDArray[np.float64]:
    """Keep postures (..., 24) within what the arms can do."""
    right = np.clip(posture[..., :ARM_COORDINATES], _LOW, _HIGH)
    left = np.clip(posture[..., ARM_COORDINATES:], np.minimum(_LOW, RELAXED), _HIGH)
    return np.concatenate([right, left], axis=-1)


def _stroke(kind: str, length_s: float, rng: np.random.Generator) -> NDArray[np.float64]:
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
            outside = np.abs(reached - _inside(reached)).max(axis=1)
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


# --- motion ----------------------------------------------------------------------------------


def minimum_jerk(
    times_s: Sequence[float], values: Sequence[NDArray[np.float64]], at_s: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return a path (F, D) that rests at each key and moves between them with least jerk."""
    keys, stops = np.asarray(times_s), np.asarray(values)
    k = np.clip(np.searchsorted(keys, at_s, side="right") - 1, 0, len(keys) - 2)
    share = share_done((at_s - keys[k]) / (keys[k + 1] - keys[k]))
    return np.asarray(stops[k] + share[:, None] * (stops[k + 1] - stops[k]))


def _coordinates(
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
        posture = _inside(posture + _stroke(token.kind, length_s / (inner + 1), rng))
        out.append((float(share), posture))
    return out


def _channel_values(
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


# --- what is known about it ------------------------------------------------------------------


def _truth_rows(recording: SimulatedRecording) -> list[dict[str, object]]:
    tokens = [token for utterance in recording.utterances for token in utterance]
    return [
        {
            "recording": recording.name,
            "sign": number,
            "edge": edge,
            "hand": hand,
            "true_s": round(token.true_s[hand][i], 6),
        }
        for number, token in enumerate(tokens, start=1)
        for i, edge in enumerate(("start", "end"))
        for hand in token.hands
    ]


def _design_rows(
    name: str, utterances: Sequence[tuple[list[Token], list[Transition]]]
) -> list[dict[str, object]]:
    transitions = [transition for _, between in utterances for transition in between]
    return [
        {
            "recording": name,
            "transition": number,
            "type": transition.kind,
            "duration_s": transition.frames * FRAME_S,
            "geodesic_rad": transition.geodesic_rad,
            "euclidean_m": transition.euclidean_cm / 100,
        }
        for number, transition in enumerate(transitions, start=1)
    ]


def write_motion(recording: SimulatedRecording, path: Path) -> None:
    """Write the motion as BVH (cm, degrees)."""
    write_bvh(path, Body().hierarchy, recording.values, RATE_HZ)


def write_tags(recording: SimulatedRecording, path: Path) -> None:
    """Write the manual tags as ELAN: utterance, and included in it translation and sign."""
    utterances, translations, signs = [], [], []
    for number, tokens in enumerate(recording.utterances, start=1):
        start, end = tokens[0].start * FRAME_S, tokens[-1].end * FRAME_S
        label = f"utterance {number}"
        utterances.append(Interval(start, end, label, "utterance"))
        text = f"(simulated: {label} of {len(recording.utterances)}, no meaning)"
        translations.append(Interval(start, end, text, "translation"))
        signs += [Interval(t.start * FRAME_S, t.end * FRAME_S, t.gloss, "sign") for t in tokens]
    write_eaf(
        path,
        author="signkin simulator",
        date="2017-07-09T00:00:00+00:00",
        media_url=f"{recording.name}.bvh",
        tiers=[
            ("utterance", None, utterances),
            ("translation", "utterance", translations),
            ("sign", "utterance", signs),
        ],
    )
