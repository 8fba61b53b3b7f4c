"""How far power-law ground truth and hit rates move with the choices of docs/interpretations.md.

python -m tools.numbers RESULTS DATA powerlaw

Corpora of single signs give one trajectory a recording, those of continuous signing one every 2 s;
right wrists, low-passed at 6 Hz as in Endres et al. 2013, section 2.2.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, make_interp_spline

from signkin.binning import chance_line, match
from signkin.corpus import data_folder, load_corpus
from signkin.kinematics import curvature, fill_gaps, lowpass, speed
from signkin.powerlaw import (
    REASONS,
    GroundTruth,
    LeftOut,
    WarpSettings,
    active_part,
    warp_to_power_law,
)
from signkin.stages.ingest import ingest
from tools.numbers import table
from tools.shipped import shipped

ROOT = Path(__file__).resolve().parents[1]
CORPORA = ("isl-sim", "dgs-1984189", "libras", "isl-kinect", "auslan-hq")
MOST = 450  # trajectories of a corpus: every sixth of auslan-hq
PIECE_S = 2.0
Trajectory = tuple[NDArray[np.float64], float]
Found = GroundTruth | LeftOut

CHOICES: dict[str, dict[str, object]] = {
    "as shipped": {},
    "first_gain: first_sample": {"first_gain": "first_sample"},
    "ratios 1.5": {"most_speed_ratio": 1.5, "most_duration_ratio": 1.5},
    "ratios 3": {"most_speed_ratio": 3.0, "most_duration_ratio": 3.0},
    "straight_turn_rad 0.01": {"straight_turn_rad": 0.01},
    "straight_turn_rad 0.1": {"straight_turn_rad": 0.1},
    "straight_turn_rad 0.2": {"straight_turn_rad": 0.2},
    "straight_turn_rad 0.5": {"straight_turn_rad": 0.5},
    "least_r_squared: any": {"least_r_squared": -1e9},
    "output_rate_hz: the recording's": {"output_rate_hz": None},
    "output_rate_hz 960": {"output_rate_hz": 960.0},
}


def trajectories(name: str, results: Path, data: Path) -> list[Trajectory]:
    """Return low-passed paths of right wrists and their rates."""
    corpus = load_corpus(ROOT / "corpora" / name)
    folder = data_folder(corpus, data, results)
    if folder is None:
        return []
    entries = corpus.entries[:: -(-len(corpus.entries) // MOST)]
    out = []
    for take in ingest(corpus, folder, entries).recordings:
        track = fill_gaps(take.track("right_wrist"), take.rate_hz, 0.2)[0]
        path = lowpass(track, take.rate_hz, 6.0, method="fir")
        step = round(PIECE_S * take.rate_hz)
        single = len(corpus.entries) > 2
        pieces = [path] if single else [path[i : i + step] for i in range(0, len(path), step)]
        out += [(p, take.rate_hz) for p in pieces if len(p) > 0.5 * step and np.isfinite(p).all()]
    return out


def warp(paths: list[Trajectory], s: WarpSettings) -> list[Found]:
    """Warp each path with a seed of its own."""
    return [warp_to_power_law(x, rate, i, s) for i, (x, rate) in enumerate(paths)]


def good(found: list[Found]) -> list[GroundTruth]:
    """Return those that are ground truth."""
    return [one for one in found if isinstance(one, GroundTruth)]


def room(found: list[Found]) -> int:
    """Count trajectories with room for the segments."""
    return sum(one.draws > 0 for one in found)


def quartiles(values: list[float]) -> str:
    """Format median and quartiles."""
    if not values:
        return "none"
    low, middle, high = np.percentile(values, [25, 50, 75])
    return f"{middle:.2f} ({low:.2f} to {high:.2f})"


def acceptance(paths: dict[str, list[Trajectory]], s: WarpSettings) -> None:
    """Print what is accepted, and why draws are rejected."""
    print("\n### Acceptance\n")
    print("| | trajectories | with room | ground truth | draws for one | " + " | ".join(REASONS))
    print("|---" * (5 + len(REASONS)) + "|")
    for name, of in paths.items():
        found = warp(of, s)
        truths = good(found)
        why: Counter[str] = Counter()
        for one in found:
            why.update(one.rejected)
        counts = " | ".join(str(why[reason]) for reason in REASONS)
        draws = float(np.median([one.draws for one in truths])) if truths else float("nan")
        print(f"| {name} | {len(of)} | {room(found)} | {len(truths)} | {draws:.0f} | {counts} |")


def choices(
    paths: dict[str, list[Trajectory]], s: WarpSettings
) -> dict[str, dict[str, list[Found]]]:
    """Print the effect of each choice on all corpora; returns what was found."""
    everything = {}
    print(
        "\n### Choices: ground truth of those with room; exponents; R squared, least and median\n"
    )
    print("| | " + " | ".join(paths) + " |")
    print("|---" * (1 + len(paths)) + "|")
    for label, change in CHOICES.items():
        cells = []
        everything[label] = {
            name: warp(of, replace(s, **change))  # type: ignore[arg-type]
            for name, of in paths.items()
        }
        for found in everything[label].values():
            truths = good(found)
            cell = f"{len(truths)} of {room(found)}"
            if truths:
                beta = [law.beta for one in truths for law in one.drawn]
                fits = [law.r_squared for one in truths for law in one.fitted]
                cell += f"; {quartiles(beta)}; {np.nanmin(fits):.2f}, {np.nanmedian(fits):.4f}"
            cells.append(cell)
        print(f"| {label} | " + " | ".join(cells) + " |", flush=True)
    return everything


def accepted(found: list[Found]) -> str:
    """Format how many of those long enough have ground truth."""
    return f"{len(good(found))} of {room(found)}"


def flatness(found: list[Found]) -> str:
    """Format the number of ground truths and the median exponent drawn."""
    beta = [law.beta for one in good(found) for law in one.drawn]
    return f"{len(good(found))}; {np.median(beta):.2f}" if beta else "0"


def places(found: dict[str, dict[str, list[Found]]]) -> dict[str, str]:
    """Return the tables of the page, by the name of their place."""
    names = [{"dgs-1984189": "dgs"}.get(name, name) for name in found["as shipped"]]
    gains = {"**duration**": "as shipped", "first_sample": "first_gain: first_sample"}
    ratios = {"1.5": "ratios 1.5", "**2**": "as shipped", "3": "ratios 3"}
    return {
        "powerlaw-gain": table(
            ("ground truth of those long enough", *names),
            ((label, *map(accepted, found[key].values())) for label, key in gains.items()),
        ),
        "powerlaw-ratio": table(
            ("ratio", *names),
            ((label, *map(flatness, found[key].values())) for label, key in ratios.items()),
        ),
    }


def consequences(paths: dict[str, list[Trajectory]], s: WarpSettings) -> None:
    """Print durations, straight places, sampled against drawn exponents, and the path's error."""
    loose = replace(s, first_gain="first_sample", most_speed_ratio=1e9, most_duration_ratio=1e9)
    print("\n### Consequences\n")
    heads = (
        "segment's duration over recorded", "duration of the whole with first_sample",
        "length that is straight, median and most",
        "refitted minus drawn exponent, median size and most",
        "cubic against quintic spline, mm, median and most",
    )  # fmt: skip
    print("| | " + " | ".join(heads) + " |")
    print("|---" * 6 + "|")
    for name, of in paths.items():
        truths = good(warp(of, s))
        ratio = [float(r) for one in truths for r in one.durations_s / one.durations_recorded_s]
        printed = [
            one.duration_s / float(one.durations_recorded_s.sum()) for one in good(warp(of, loose))
        ]
        straight = [one.straight_share for one in truths]
        shift = [
            abs(a.beta - b.beta)
            for one in truths
            for a, b in zip(one.drawn, one.fitted, strict=True)
        ]
        apart = [1000 * splines_apart(x, rate) for x, rate in of]
        print(
            f"| {name} | {quartiles(ratio)} | {quartiles(printed)} | {np.median(straight):.3f}, "
            f"{max(straight):.3f} | {np.median(shift):.3f}, {max(shift):.3f} "
            f"| {np.median(apart):.3f}, {max(apart):.2f} |"
        )


def splines_apart(x: NDArray[np.float64], rate_hz: float) -> float:
    """Return the largest distance, at one time, of two splines through the active samples."""
    x = x[active_part(speed(x, rate_hz))]
    if len(x) < 6:
        return 0.0
    t = np.arange(len(x)) / rate_hz
    fine = np.linspace(0, t[-1], 10 * len(x))
    difference = CubicSpline(t, x)(fine) - make_interp_spline(t, x, k=5)(fine)
    return float(np.linalg.norm(difference, axis=1).max())


def matching(paths: dict[str, list[Trajectory]], s: WarpSettings) -> None:
    """Print hits of random events under other ways to pair, and the closed form of chance."""
    truths = good(warp(paths["isl-sim"], s))
    edges = [one.boundaries_s for one in truths]
    rng = np.random.default_rng(0)
    print("\n### Pairing random events with ground truth: mean hit rate\n")
    print("| events a second | most pairs | first come, first served | each truth has one in its "
          "window | 1 - exp(-2 w lambda) | false positives a second, most pairs "
          "| the same, first come |")  # fmt: skip
    print("|---" * 7 + "|")
    for rate in (1.0, 2.0, 5.0, 9.0):
        counts = np.zeros((3, 2))
        seconds = 0.0
        for _ in range(50):
            for one, truth in zip(truths, edges, strict=True):
                events = rng.uniform(0, one.duration_s, rng.poisson(rate * one.duration_s))
                best = len(match(events, truth)[0])
                first = first_come(np.sort(events), truth)
                near = int(sum((np.abs(events - edge) <= 0.09).any() for edge in truth))
                counts += [[best, len(events) - best], [first, len(events) - first], [near, 0]]
                seconds += one.duration_s
        hit = counts[:, 0] / (50 * 2 * len(truths))
        closed = 1 - np.exp(-0.18 * rate)
        print(
            f"| {rate:g} | {hit[0]:.3f} | {hit[1]:.3f} | {hit[2]:.3f} | {closed:.3f} "
            f"| {counts[0, 1] / seconds:.2f} | {counts[1, 1] / seconds:.2f} |"
        )
    line = chance_line(edges, [one.duration_s for one in truths], 0, [9.0], draws=500)
    print(
        f"\n95 % of chance at 9 a second: {line.hit_rate_low[0]:.2f} to {line.hit_rate_high[0]:.2f}"
    )


def first_come(events: NDArray[np.float64], truth: NDArray[np.float64]) -> int:
    """Count hits as 3.1 words it: each event takes the nearest boundary, unless it is taken."""
    taken: set[int] = set()
    for event in events:
        nearest = int(np.argmin(np.abs(truth - event)))
        if abs(truth[nearest] - event) <= 0.09:
            taken.add(nearest)
    return len(taken)


def bends() -> None:
    """Print what noise does to the curvature of a circle of 0.1 m, passed at different speeds."""
    print("\n### Curvature of a circle of 10 1/m at 240 Hz, 0.8 mm noise: median and 95 % range\n")
    print("| m/s | as recorded | low-passed | low-passed, spacing 6 | low-passed, 60 Hz |")
    print("|---|---|---|---|---|")
    rng = np.random.default_rng(0)
    for v in (0.05, 0.2, 1.0):
        t = np.arange(240 * 60) / 240
        turn = 10 * v * t
        path = 0.1 * np.column_stack([np.cos(turn), np.sin(turn), 0 * t])
        path += rng.normal(0, 0.0008, path.shape)
        smooth = lowpass(path, 240.0, 6.0, method="fir")
        kinds = [curvature(path), curvature(smooth), curvature(smooth, 6), curvature(smooth[::4])]
        ranges = [np.nanpercentile(k, [50, 2.5, 97.5]) for k in kinds]
        cells = ["{:.1f} ({:.1f} to {:.1f})".format(*found) for found in ranges]
        print(f"| {v:g} | " + " | ".join(cells) + " |")


def main(results: Path, data: Path) -> dict[str, str]:
    """Print every table; returns those of the page."""
    s = settings()
    paths = {name: trajectories(name, results, data) for name in CORPORA}
    paths = {name: of for name, of in paths.items() if of}
    bends()
    acceptance(paths, s)
    found = choices(paths, s)
    consequences(paths, s)
    matching(paths, s)
    return places(found)


def settings() -> WarpSettings:
    """Return the settings of config.yaml."""
    return WarpSettings(**dict(shipped().powerlaw))


def sample(results: Path) -> tuple[str, str]:
    """Return a place and the start of a row of it, from simulated recordings, to compare."""
    found = warp(trajectories("isl-sim", results, results), settings())
    return "powerlaw-ratio", f"| **2** | {flatness(found)} |"
