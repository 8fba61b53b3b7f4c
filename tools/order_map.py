"""Does the preferred order name the principle that made a movement? Strokes of known order, binned.

python -m tools.numbers RESULTS DATA order_map

isl-sim made anew of strokes of least acceleration, jerk and snap (orders 3, 5, 7), one or more for
each of the design, with little noise and the sensor's; through two low-passes, into 50 and
100 bins, under three readings of the prior. 8 recordings each. RESULTS and DATA are not read.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from signkin.binning import (
    Posterior,
    chance_line,
    fit_many,
    hit_rate,
    noise_coverage,
    residual_autocorrelation,
)
from signkin.corpus import load_corpus
from signkin.recording import Recording
from signkin.simulate import isl
from signkin.studies.endres2013.posteriors import chosen, prior_of
from signkin.studies.endres2013.settings import CutSettings
from signkin.studies.endres2013.single_signs import Trajectory, movement_of, recorded
from tools.numbers import table
from tools.shipped import shipped

ROOT = Path(__file__).resolve().parents[1]
MOST = 8  # recordings
ORDERS = tuple(range(8))
GENERATORS = {3: "acceleration", 5: "jerk", 7: "snap"}
PARTS = (1, 3)
NOISES_MM = (0.05, 0.8)
CUTOFFS_HZ = (6.0, 20.0)
BINS = (50, 100)
READINGS: dict[str, dict[str, Any]] = {
    "sensor": {},
    "literal, mm": {"noise": "data", "scale": "literal", "length_unit": "mm"},
    "plain, nu = 1,000": {"noise": "data", "scale": "plain", "dof": 1000.0},
}
PRINTED_M = (13, 7, 2)


@dataclass(frozen=True)
class Cell:
    """One setting of the map."""

    generator: int
    parts: int
    noise_mm: float
    cutoff_hz: float
    bins: int
    reading: str


@dataclass(frozen=True, eq=False)
class Found:
    """What binning says there: means over recordings; hits are of order 3, against strokes."""

    posterior: NDArray[np.float64]
    counts: tuple[float, float, float]
    hit_rate: float
    false_per_s: float
    chance: float
    autocorrelation: float
    coverage: float

    @property
    def peak(self) -> int:
        """The order with the most probability."""
        return int(np.argmax(self.posterior))


@dataclass(frozen=True, eq=False)
class Cut:
    """A trajectory, and where strokes start and end within it, in s from its start."""

    trajectory: Trajectory
    ends_s: NDArray[np.float64]


def recordings(generator: int, parts: int, noise_mm: float) -> list[tuple[Recording, Any]]:
    """Return some recordings of isl-sim made so, with what the simulator knows of them."""
    corpus = load_corpus(ROOT / "corpora" / "isl-sim")
    names = set(chosen([e.recording for e in corpus.entries], MOST))
    entries = [e for e in corpus.entries if e.recording in names]
    takes = isl.simulate(
        entries, corpus.name, noise_mm / 1000, shipped().seed, isl.Recipe(generator, parts)
    )
    hands = [f"{hand}_wrist" for hand in isl.HANDS]
    return [
        (
            Recording(
                name=take.recording, rate_hz=isl.RATE_HZ, joints=tuple(hands), unit="m",
                positions=np.stack([take.measured[hand] for hand in isl.HANDS], axis=1),
            ),
            take,
        )
        for take in takes
    ]  # fmt: skip


def cut(made: Sequence[tuple[Recording, Any]], cutoff_hz: float, bins: int) -> list[Cut]:
    """Return the movements in bins."""
    own = CutSettings.of(shipped())
    own = replace(own, lowpass=own.lowpass.model_copy(update={"cutoff_hz": cutoff_hz}), bins=bins)
    out = []
    for recording, take in made:
        movement = movement_of(recording, own)
        start, stop = (movement.active.start or 0, movement.active.stop or len(take.path))
        ends = isl.stroke_ends(take, start / isl.RATE_HZ, stop / isl.RATE_HZ)
        out.append(Cut(recorded(movement, bins), ends))
    return out


def found(cuts: Sequence[Cut], noise_mm: float, reading: str) -> Found:
    """Bin trajectories under a reading of the prior."""
    prior = shipped({f"binning.prior.{key}": v for key, v in READINGS[reading].items()})
    x = [c.trajectory.x - c.trajectory.x.mean(axis=0) for c in cuts]
    fits = fit_many(
        x, ORDERS, [prior_of(prior.binning.prior, noise_mm / 1000, one) for one in x],
        [c.trajectory.bin_s for c in cuts], sample_at=[c.trajectory.sample_at for c in cuts],
    )  # fmt: skip
    posterior = np.mean([f.order_probability for f in fits], axis=0)
    best = int(np.argmax(posterior))
    window = prior.binning.hit_window_s
    rates = [
        hit_rate(f.boundaries_s(3), c.ends_s, window, duration_s=c.trajectory.duration_s)
        for f, c in zip(fits, cuts, strict=True)
    ]
    false = float(np.mean([r.false_positives_per_s for r in rates]))
    line = chance_line(
        [c.ends_s for c in cuts], [c.trajectory.duration_s for c in cuts], 1,
        np.linspace(0, 20, 11), window, 60,
    )  # fmt: skip
    return Found(
        posterior,
        _counts(fits),
        float(np.mean([r.hit_rate for r in rates])),
        false,
        float(np.interp(false, line.false_positives_per_s, line.hit_rate)),
        float(np.mean([residual_autocorrelation(f, best) for f in fits])),
        float(np.mean([noise_coverage(f, best) for f in fits])),
    )


def _counts(fits: Sequence[Posterior]) -> tuple[float, float, float]:
    zero, three, seven = (float(np.mean([f.map_count(s) for f in fits])) for s in (0, 3, 7))
    return zero, three, seven


def whole() -> Iterator[tuple[Cell, Found]]:
    """Yield every cell of the map, and print it."""
    print("\n| generator | parts | noise (mm) | low-pass | bins | reading | peak | P | M at 0, 3, 7"
          " | order 3 against strokes: hits, false a second, chance | residuals: r of neighbours, "
          "within the 95 % band |")  # fmt: skip
    print("|---" * 11 + "|")
    for generator, parts, noise in product(GENERATORS, PARTS, NOISES_MM):
        made = recordings(generator, parts, noise)
        for cutoff, bins in product(CUTOFFS_HZ, BINS):
            cuts = cut(made, cutoff, bins)
            for reading in READINGS:
                one = found(cuts, noise, reading)
                counts = ", ".join(f"{c:.1f}" for c in one.counts)
                print(
                    f"| {GENERATORS[generator]} ({generator}) | {parts} | {noise:g} "
                    f"| {cutoff:g} Hz | {bins} | {reading} | {one.peak} "
                    f"| {one.posterior.max():.2f} | {counts} "
                    f"| {one.hit_rate:.2f}, {one.false_per_s:.2f}, {one.chance:.2f} "
                    f"| {one.autocorrelation:.2f}, {one.coverage:.2f} |",
                    flush=True,
                )
                yield Cell(generator, parts, noise, cutoff, bins, reading), one


def of_peaks(cells: Mapping[Cell, Found]) -> str:
    """Return the map: the preferred order at 50 and 100 bins, 6 Hz before 20 Hz."""
    rows = []
    for generator, parts, noise in product(GENERATORS, PARTS, NOISES_MM):
        row = [f"{GENERATORS[generator]} ({generator}), {parts}, {noise:g} mm"]
        for reading in READINGS:
            told = (
                " ".join(
                    str(cells[Cell(generator, parts, noise, cutoff, bins, reading)].peak)
                    for bins in BINS
                )
                for cutoff in CUTOFFS_HZ
            )
            row.append("; ".join(told))
        rows.append(row)
    return table(("least (order), strokes for one, noise", *READINGS), rows)


def of_strokes(cells: Mapping[Cell, Found]) -> str:
    """Return hits of order 3 on strokes, M, and the checks of residuals, at T = 100."""
    rows = []
    for generator, parts, cutoff in product(GENERATORS, PARTS, CUTOFFS_HZ):
        one = cells[Cell(generator, parts, 0.8, cutoff, 100, "sensor")]
        rows.append(
            [
                f"{GENERATORS[generator]} ({generator}), {parts}, {cutoff:g} Hz",
                f"{one.hit_rate:.2f} ({one.chance:.2f}), {one.false_per_s:.1f}",
                ", ".join(f"{c:.1f}" for c in one.counts),
                f"{one.autocorrelation:.2f}, {one.coverage:.2f}",
            ]
        )
    head = ("sensor's prior, 0.8 mm", "hits (chance), false a second", "M", "residuals: r, in band")
    return table(head, rows)


def nearest(cells: Mapping[Cell, Found], most: int = 5) -> list[tuple[Cell, Found]]:
    """Return the cells whose M at orders 0, 3 and 7 comes nearest to the printed 13, 7 and 2."""

    def off(one: Found) -> float:
        return float(np.abs(np.log((np.array(one.counts) + 0.5) / np.add(PRINTED_M, 0.5))).max())

    return sorted(cells.items(), key=lambda item: off(item[1]))[:most]


def main(results: Path, data: Path) -> dict[str, str]:
    """Print the map and what comes nearest to the paper; returns the tables of the page."""
    cells = dict(whole())
    print("\nM nearest to 13, 7 and 2:")
    for cell, one in nearest(cells):
        print(f"  {cell}: {', '.join(f'{c:.1f}' for c in one.counts)}, peak {one.peak}")
    right = sum(one.peak == cell.generator for cell, one in cells.items())
    print(f"\nThe preferred order is the generator's in {right} of {len(cells)} cells.")
    return {"order_map-peaks": of_peaks(cells), "order_map-strokes": of_strokes(cells)}


def sample(results: Path) -> tuple[str, str]:
    """Return a place and the start of a row of it, worked out anew, to compare."""
    one = found(cut(recordings(5, 1, 0.8), 6.0, 100), 0.8, "sensor")
    return "order_map-strokes", (
        f"| jerk (5), 1, 6 Hz | {one.hit_rate:.2f} ({one.chance:.2f}), {one.false_per_s:.1f} |"
    )
