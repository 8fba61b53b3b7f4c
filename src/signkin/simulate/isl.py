"""The corpus isl-sim: repeated single signs of one wrist, made of strokes with known onsets.

The design is that of the recordings of Endres et al. 2013, section 2.2: two signers, few signs,
many repetitions, one sensor at the wrist, 240 Hz, 0.8 mm of noise. A sign is a path of its own
(a loop and a push; an arc and a fold). A signer has a style: size, tempo, turn of the body, and a
way of their own through each sign. A repetition has its own timing and size. The hand rests,
signs in overlapping minimum-jerk strokes, and rests again. A `Recipe` makes the same signs of
strokes of least acceleration or snap, or of more strokes.

It shows whether the analysis finds what was put in. It says nothing about people.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin import seeds
from signkin.errors import SignkinError, listed
from signkin.simulate.strokes import JERK, Stroke, superposed

T = TypeVar("T")

RATE_HZ = 240.0
HANDS = ("right", "left")

# Metres from the middle between the shoulders: x right, y forward, z up. Wrists at rest in the lap.
REST_M = {"right": np.array([0.16, 0.26, -0.40]), "left": np.array([-0.16, 0.26, -0.40])}
REST_S = (0.30, 0.50)  # before the first and after the last stroke
SWAY_M = 0.0006  # amplitude of the slow drift of a hand, each of two waves and each axis
SWAY_HZ = (0.2, 0.6)


@dataclass(frozen=True)
class Sign:
    """A sign as it is meant: where each stroke ends (m), how long it lasts (s).

    The first stroke raises the hand from rest; a last one back to rest is added.
    """

    stops_m: tuple[tuple[float, float, float], ...]
    durations_s: tuple[float, ...]
    return_s: float = 0.50


@dataclass(frozen=True)
class Style:
    """How a signer signs: size and duration (factors), overlap (of a stroke), turn (rad)."""

    size: float
    duration: float
    overlap: float
    turn_rad: float


SIGNS = {
    # A loop before the chest, against the clock as the signer sees it, then a push forward.
    "loop": Sign(
        (
            (0.12, 0.34, -0.02),
            (-0.02, 0.33, 0.06),
            (-0.13, 0.33, -0.04),
            (-0.04, 0.34, -0.17),
            (0.11, 0.34, -0.10),
            (0.10, 0.53, -0.06),
        ),
        (0.52, 0.34, 0.32, 0.32, 0.34, 0.40),
    ),
    # An arc from the left shoulder over to the right, then down to the left and straight back.
    "fold": Sign(
        (
            (-0.14, 0.28, 0.02),
            (0.00, 0.38, 0.13),
            (0.18, 0.36, 0.05),
            (-0.06, 0.33, -0.15),
            (0.17, 0.36, -0.06),
        ),
        (0.60, 0.36, 0.36, 0.42, 0.40),
    ),
}
STYLES = {
    "sim-1": Style(size=1.08, duration=0.95, overlap=0.48, turn_rad=0.10),
    "sim-2": Style(size=0.92, duration=0.97, overlap=0.42, turn_rad=-0.14),
}
# A signer's own way through a sign: SD of each stop (m) and of each stroke's log duration.
HABIT_M, HABIT_LOG = 0.016, 0.07
# From repetition to repetition: SD of all sizes and durations together (log), of each stop (m),
# of each stroke's log duration, of each overlap, and of the place of rest (m).
AGAIN_SIZE_LOG, AGAIN_TEMPO_LOG, AGAIN_M = 0.05, 0.05, 0.009
AGAIN_LOG, AGAIN_OVERLAP, AGAIN_REST_M = 0.07, 0.03, 0.008
OVERLAP_RANGE = (0.20, 0.60)
BEND = 0.25  # SD of how far the inner ends of a stroke's parts lie off it, of a part's length


@dataclass(frozen=True)
class Recipe:
    """What strokes are made of, beside the design.

    order: of their polynomials: 3, 5 or 7, for least acceleration, jerk or snap. parts: how many
    strokes stand for one of the design; where they meet the path bends by `BEND` of their length.
    """

    order: int = JERK
    parts: int = 1

    def __post_init__(self) -> None:
        """Refuse what makes no stroke."""
        if self.parts < 1:
            raise SignkinError(f"{self.parts} parts", place="simulator", expected="1 or more")


class Planned(Protocol):
    """A recording to be made, as a row of recordings.csv."""

    @property
    def recording(self) -> str:
        """Its name."""

    @property
    def signer(self) -> str:
        """One of STYLES."""

    @property
    def sign(self) -> str:
        """One of SIGNS."""


@dataclass(frozen=True, eq=False)
class SimulatedTake:
    """One recording: what the sensors give, and the truth behind the right hand.

    measured: hand -> (F, 3), metres, with noise. path: (F, 3), the right wrist without noise.
    """

    recording: str
    measured: dict[str, NDArray[np.float64]]
    path: NDArray[np.float64]
    strokes: tuple[Stroke, ...]


def simulate(
    planned: Iterable[Planned], corpus: str, noise_sd_m: float, seed: int,
    recipe: Recipe | None = None,
) -> list[SimulatedTake]:  # fmt: skip
    """Simulate the recordings of a corpus, each from a random stream of its own.

    noise_sd_m: standard deviation of the sensors' white noise, the same in each axis. recipe: of
    the strokes; None: one stroke of least jerk for each of the design.
    """
    made_of = recipe or Recipe()
    takes = []
    for row in planned:
        style = _known(STYLES, row.signer, "signer", row.recording)
        sign = _known(SIGNS, row.sign, "sign", row.recording)
        habit = seeds.stream(seed, corpus, row.signer, row.sign)
        own = seeds.stream(seed, corpus, row.recording)
        usual = _habitual(sign, style, habit)
        takes.append(_take(row.recording, usual, style, noise_sd_m, own, made_of))
    return takes


def _known(there: dict[str, T], name: str, what: str, recording: str) -> T:
    if name not in there:
        raise SignkinError(
            f"the {what} {name!r} is not one of the simulator's",
            file="simulator isl-sim",
            place=f"recording {recording}",
            expected=listed(there),
            todo="Correct recordings.csv.",
        )
    return there[name]


def _habitual(sign: Sign, style: Style, rng: np.random.Generator) -> Sign:
    """Return a sign as a signer makes it, before this repetition's accidents."""
    stops = np.array(sign.stops_m)
    middle = stops.mean(axis=0)
    stops = middle + style.size * (stops - middle) + rng.normal(0, HABIT_M, stops.shape)
    cos, sin = np.cos(style.turn_rad), np.sin(style.turn_rad)
    stops = stops @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
    factors = style.duration * np.exp(rng.normal(0, HABIT_LOG, len(stops) + 1))
    durations = factors * [*sign.durations_s, sign.return_s]
    return Sign(
        tuple((float(x), float(y), float(z)) for x, y, z in stops),
        tuple(float(d) for d in durations[:-1]),
        float(durations[-1]),
    )


def _take(
    recording: str, sign: Sign, style: Style, noise_sd_m: float, rng: np.random.Generator,
    recipe: Recipe,
) -> SimulatedTake:  # fmt: skip
    rest = REST_M["right"] + rng.normal(0, AGAIN_REST_M, 3)
    strokes = [
        part
        for stroke in _strokes(sign, style, rest, rng)
        for part in _parts(stroke, style.overlap, recipe, rng)
    ]
    frames = round((max(s.offset_s for s in strokes) + rng.uniform(*REST_S)) * RATE_HZ)
    at_s = np.arange(frames) / RATE_HZ
    path = superposed(rest, strokes, at_s) + _sway(at_s, rng)
    other = REST_M["left"] + rng.normal(0, AGAIN_REST_M, 3) + _sway(at_s, rng)
    measured = {
        hand: true + rng.normal(0, noise_sd_m, true.shape)
        for hand, true in zip(HANDS, (path, other), strict=True)
    }
    return SimulatedTake(recording, measured, path, tuple(strokes))


def _strokes(
    sign: Sign, style: Style, rest: NDArray[np.float64], rng: np.random.Generator
) -> list[Stroke]:
    stops = np.array(sign.stops_m)
    middle = stops.mean(axis=0)
    size = np.exp(rng.normal(0, AGAIN_SIZE_LOG))
    stops = middle + size * (stops - middle) + rng.normal(0, AGAIN_M, stops.shape)
    home = rest + rng.normal(0, AGAIN_REST_M, 3)  # the hand does not come back to the millimetre
    displacements = np.diff(np.vstack([rest, stops, home]), axis=0)
    tempo = np.exp(rng.normal(0, AGAIN_TEMPO_LOG))
    durations = np.array([*sign.durations_s, sign.return_s])
    durations = durations * tempo * np.exp(rng.normal(0, AGAIN_LOG, len(durations)))
    overlaps = np.clip(style.overlap + rng.normal(0, AGAIN_OVERLAP, len(durations)), *OVERLAP_RANGE)
    onset = rng.uniform(*REST_S)
    strokes = []
    for displacement, duration, overlap in zip(displacements, durations, overlaps, strict=True):
        strokes.append(Stroke(float(onset), float(duration), displacement))
        onset += (1 - overlap) * duration
    return strokes


def _parts(
    stroke: Stroke, overlap: float, recipe: Recipe, rng: np.random.Generator
) -> list[Stroke]:
    """Return the strokes that stand for one of the design: over the same time and way."""
    n = recipe.parts
    if n == 1:
        return [Stroke(stroke.onset_s, stroke.duration_s, stroke.displacement_m, recipe.order)]
    bends = rng.normal(0, BEND * stroke.length_m / n, (n - 1, 3))
    ways = np.diff(np.vstack([np.zeros(3), *bends, np.zeros(3)]), axis=0)
    # Each overlaps the next one, as strokes of the design do; the last ends with the whole.
    duration = stroke.duration_s / (1 + (n - 1) * (1 - overlap))
    return [
        Stroke(
            stroke.onset_s + i * (1 - overlap) * duration, duration,
            stroke.displacement_m / n + way, recipe.order,
        )
        for i, way in enumerate(ways)
    ]  # fmt: skip


def stroke_ends(
    take: SimulatedTake, from_s: float = 0.0, to_s: float = np.inf
) -> NDArray[np.float64]:
    """Return where strokes start and end, in s within a stretch, from its start on, sorted.

    Between two such instants the path is one polynomial, of the recipe's order (and the sway).
    """
    times = np.unique([t for s in take.strokes for t in (s.onset_s, s.offset_s)])
    return times[(times > from_s) & (times < to_s)] - from_s


def _sway(at_s: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Return the slow drift of a hand, (F, 3) in metres: two waves an axis."""
    rates, phases = rng.uniform(*SWAY_HZ, (2, 3)), rng.uniform(0, 2 * np.pi, (2, 3))
    waves = np.sin(2 * np.pi * rates * at_s[:, None, None] + phases)
    return np.asarray(SWAY_M * waves.sum(axis=1))


# --- the truth as tables ---------------------------------------------------------------------


def stroke_table(takes: Sequence[SimulatedTake]) -> pd.DataFrame:
    """Return the table `strokes`: a row a stroke."""
    return pd.DataFrame(
        {
            "recording": take.recording,
            "stroke": number,
            "onset_s": stroke.onset_s,
            "offset_s": stroke.offset_s,
            "length_m": stroke.length_m,
            **dict(zip(("dx_m", "dy_m", "dz_m"), stroke.displacement_m, strict=True)),
        }
        for take in takes
        for number, stroke in enumerate(take.strokes, start=1)
    )


def path_table(takes: Sequence[SimulatedTake]) -> pd.DataFrame:
    """Return the table `true_path`: a row a frame, the right wrist without noise."""
    return pd.concat(
        [
            pd.DataFrame(
                {
                    "recording": take.recording,
                    "frame": np.arange(len(take.path), dtype=np.int32),
                    **{f"right_wrist_{axis}_m": take.path[:, i] for i, axis in enumerate("xyz")},
                }
            )
            for take in takes
        ],
        ignore_index=True,
    )


def motion_columns(take: SimulatedTake) -> dict[str, NDArray[np.float64]]:
    """Return the columns of a recording's file, in metres."""
    return {
        f"{hand}_wrist_{axis}": values[:, i]
        for hand, values in take.measured.items()
        for i, axis in enumerate("xyz")
    }
