"""`python -m tools.refine_posterior [FIRST SEEDS]`: do intervals of refined tags hold the truth?

Many simulations of lsf-sim, whose true boundaries are known; the tables go into docs/scoring.md.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.stats import t

from signkin import seeds
from signkin.coarticulation import (
    TagModel,
    jitter_between,
    learn_tag_model,
    most_outward_s,
    refine_each,
    refine_posterior,
)
from signkin.errors import SignkinError
from signkin.io.bvh import forward_kinematics
from signkin.joints import HANDS
from signkin.kinematics.derivatives import speed
from signkin.kinematics.filters import lowpass
from signkin.kinematics.minima import minima_with_depth
from signkin.kinematics.rests import rest_times
from signkin.simulate import lsf
from signkin.simulate.body import Body
from tools.marked import fill
from tools.numbers import table
from tools.shipped import shipped
from tools.simulated import simulate_lsf

ROOT = Path(__file__).resolve().parents[1]
SETTINGS = shipped()
FIRST, SEEDS = 201, 12  # what TagModel assumes was chosen on seeds 102 to 113
EDGES = ("start", "end")


@dataclass(frozen=True, eq=False)
class Take:
    """One recording: wrists (F, 3), tags (N, 2) of two taggers, true boundaries (N, 2) by hand."""

    wrists: dict[str, NDArray[np.float64]]
    tags: NDArray[np.float64]
    second: NDArray[np.float64]
    truth: dict[str, NDArray[np.float64]]

    def acts(self, hand: str) -> NDArray[np.bool_]:
        """Return whether the hand acts in each sign, (N,), as the lexicon says."""
        return np.isfinite(self.truth[hand][:, 0])


def simulated(seed: int, parts: int | None = None) -> list[Take]:
    """Simulate lsf-sim once more, or less of it (`simulate_lsf`)."""
    made = simulate_lsf(seed, parts)
    joints = list(Body().hierarchy.joints)
    takes = []
    for recording in made.recordings:
        positions, _ = forward_kinematics(Body().hierarchy, recording.values)
        tokens = [token for utterance in recording.utterances for token in utterance]
        nan = (np.nan, np.nan)
        takes.append(
            Take(
                {h: positions[:, joints.index(f"{h.capitalize()}Hand")] for h in HANDS},
                np.array([(k.start, k.end) for k in tokens]) / lsf.RATE_HZ,
                np.array([(k.start_s, k.end_s) for k in lsf.second_tags(
                    recording.utterances, seeds.stream(seed, "lsf-sim", "second tagger",
                                                       recording.name))]),
                {h: np.array([k.true_s[h] if h in k.hands else nan for k in tokens])
                 for h in HANDS},
            )
        )  # fmt: skip
    return takes


@cache
def minima_of(
    take: Take, cutoff_hz: float, prominence: float
) -> dict[str, tuple[NDArray[np.float64], ...]]:
    """Return times, prominences and rests of minima by hand, as the stage of kinematics does."""
    low = dict(SETTINGS.kinematics.lowpass) | {"cutoff_hz": cutoff_hz}
    speeds = {h: speed(lowpass(x, lsf.RATE_HZ, **low), lsf.RATE_HZ) for h, x in take.wrists.items()}
    fastest = max(float(np.nanpercentile(s, 95)) for s in speeds.values())
    spacing = SETTINGS.kinematics.minima.spacing_s
    found = {}
    for hand, values in speeds.items():
        times, _, depth = minima_with_depth(values, lsf.RATE_HZ, prominence * fastest, spacing)
        rests = rest_times(take.wrists[hand], lsf.RATE_HZ, times)
        found[hand] = (times, depth, np.column_stack(rests))
    return found


@dataclass(frozen=True)
class Variant:
    """What is off: factors on the learnt jitter, on the SD of rests, on the least prominence and
    on the cut-off of the filter.

    second: with the tags of the second annotator. two: with the jitter of both, from their tags.
    wide_s: with tags that start so much earlier and end so much later. alone: minima alone,
    nothing known of rests.
    """  # fmt: skip

    jitter: float = 1.0
    rest: float = 1.0
    prominence: float = 1.0
    cutoff: float = 1.0
    second: bool = False
    two: bool = False
    wide_s: float = 0.0
    alone: bool = False

    def tags(self, take: Take) -> NDArray[np.float64]:
        """Return the tags (N, 2) of a recording."""
        return (take.second if self.second else take.tags) + self.wide_s * np.array([-1, 1])

    def start(self, takes: Sequence[Take]) -> TagModel:
        """Return the model to start learning from."""
        both = (np.concatenate([t.tags for t in takes]), np.concatenate([t.second for t in takes]))
        # Recordings one behind the other: tags of one are never near those of another.
        late = np.repeat(1000.0 * np.arange(len(takes)), [len(t.tags) for t in takes])[:, None]
        model = jitter_between(both[0] + late, both[1] + late) if self.two else TagModel()
        cutoff = self.cutoff * SETTINGS.kinematics.lowpass.cutoff_hz
        return replace(
            model,
            shape_sd_s=self.rest * model.shape_sd_s,
            most_outward_s=most_outward_s(cutoff),
        )


SHIPPED = Variant()


def calibration(simulations: Sequence[Sequence[Take]], variant: Variant = SHIPPED) -> pd.DataFrame:
    """Return `held`, averaged by hand and edge."""
    return _summary(held(simulations, variant))


def held(simulations: Sequence[Sequence[Take]], variant: Variant) -> pd.DataFrame:
    """Return whether intervals hold the truth and the errors, one row a true boundary."""
    rows = []
    for number, takes in enumerate(simulations):
        minima = [
            minima_of(take, variant.cutoff * SETTINGS.kinematics.lowpass.cutoff_hz,
                      variant.prominence * SETTINGS.kinematics.minima.prominence)
            for take in takes
        ]  # fmt: skip
        for hand in HANDS:
            sets = [(variant.tags(take), *m[hand][:2])
                    for take, m in zip(takes, minima, strict=True)]  # fmt: skip
            rests = None if variant.alone else [m[hand][2] * [1, variant.rest] for m in minima]
            acts = [take.acts(hand) for take in takes]
            model = learn_tag_model(
                sets, variant.start(takes), rests_s=rests, acts=acts, jitter_known=variant.two
            )
            model = replace(model, sd_s=variant.jitter * model.sd_s)
            for k, take in enumerate(takes):
                tags, times, depth = sets[k]
                found = refine_posterior(
                    tags, times, depth, rests_s=None if rests is None else rests[k],
                    acts=acts[k], model=model,
                )  # fmt: skip
                plain, _, _ = refine_each(tags, times, SETTINGS.refinement.search_window_s)
                rows.append(_rows(number, hand, take.truth[hand], found, plain, tags))
    return pd.concat(rows)


def _rows(number, hand, truth, found, plain, tags) -> pd.DataFrame:  # type: ignore[no-untyped-def]
    held = {
        name: (truth >= interval[..., 0]) & (truth <= interval[..., 1])
        for name, interval in (("held90", found.interval90_s), ("held50", found.interval50_s))
    }
    rows = pd.DataFrame(
        {
            "simulation": number, "hand": hand, "edge": list(EDGES) * len(truth),
            **{name: values.ravel() for name, values in held.items()},
            **{f"{name}_s": np.abs(values - truth).ravel()
               for name, values in (("posterior", found.mean_s), ("plain", plain),
                                    ("manual", tags))},
        }
    )  # fmt: skip
    return rows[np.isfinite(truth.ravel())]


def _summary(rows: pd.DataFrame) -> pd.DataFrame:
    """Average; gains: plain and manual minus posterior error, with 95 % over simulations.

    least90, most90: how often the 90 % interval holds in the worst and best simulation.
    """
    keys = ["hand", "edge"]
    out = rows.groupby(keys, sort=False).mean(numeric_only=True).drop(columns="simulation")
    out.insert(0, "n", rows.groupby(keys, sort=False).size())
    by_simulation = rows.groupby([*keys, "simulation"], sort=False)
    held = by_simulation["held90"].mean().groupby(keys, sort=False)
    out = out.assign(least90=held.min(), most90=held.max())
    each = by_simulation[["posterior_s", "plain_s", "manual_s"]].mean()
    for rival in ("plain", "manual"):
        gain = (each[f"{rival}_s"] - each["posterior_s"]).groupby(keys, sort=False)
        half = t.ppf(0.975, gain.size() - 1) * gain.std() / np.sqrt(gain.size())
        mean = gain.mean()
        out = out.assign(**{f"than_{rival}_s": mean, f"than_{rival}_low_s": mean - half,
                            f"than_{rival}_high_s": mean + half})  # fmt: skip
    return out.reset_index()


VARIANTS = {
    "as shipped": SHIPPED,
    "second annotator": Variant(second=True),
    "jitter of two annotators, first": Variant(two=True),
    "jitter of two annotators, second": Variant(two=True, second=True),
    "signs tagged 15 ms wide at both ends": Variant(wide_s=0.015),
    "jitter halved": Variant(jitter=0.5), "jitter doubled": Variant(jitter=2.0),
    "SD of rests halved": Variant(rest=0.5), "SD of rests doubled": Variant(rest=2.0),
    "prominence halved": Variant(prominence=0.5), "prominence doubled": Variant(prominence=2.0),
    "cut-off halved": Variant(cutoff=0.5), "cut-off doubled": Variant(cutoff=2.0),
    "minima alone": Variant(alone=True),
    "minima alone, second annotator": Variant(alone=True, second=True),
    "minima alone, 15 ms wide": Variant(alone=True, wide_s=0.015),
}  # fmt: skip


def _pooled(rows: pd.DataFrame) -> list[str]:
    """Return coverage of both intervals, in all and by hand and edge, and the mean error."""
    weights = rows["n"] / rows["n"].sum()
    cells = []
    for column in ("held90", "held50"):
        cells.append(f"{(rows[column] * weights).sum():.3f}")
        cells.append(f"{rows[column].min():.3f}-{rows[column].max():.3f}")
    return [*cells, f"{1000 * (rows['posterior_s'] * weights).sum():.1f}"]


def main(first: int, number: int) -> None:
    """Work out both tables from so many simulations and put them into docs/scoring.md."""
    simulations: list[list[Take]] = []
    while len(simulations) < number:
        try:
            simulations.append(simulated(first))
            print(f"seed {first}", flush=True)
        except SignkinError as error:  # the body cannot take all distances that were drawn
            print(f"seed {first}: {error}", flush=True)
        first += 1
    found = {}
    for name, variant in VARIANTS.items():
        rows = held(simulations, variant)
        found[name] = _summary(rows)
        each = rows.groupby("simulation")[["held90", "held50"]].mean()
        print(name, "; SD over simulations:", each.std().round(3).to_dict(), flush=True)
    found["lsf-sim itself"] = calibration([simulated(SETTINGS.seed)])
    shipped_rows = [
        [f"{r.hand}, {r.edge}", str(r.n), f"{r.held90:.3f}", f"{r.least90:.3f}-{r.most90:.3f}",
         f"{r.held50:.3f}",
         *(f"{1000 * v:.1f}" for v in (r.posterior_s, r.plain_s, r.manual_s)),
         *(f"{1000 * getattr(r, f'than_{rival}_s'):.1f} "
           f"({1000 * getattr(r, f'than_{rival}_low_s'):.1f} to "
           f"{1000 * getattr(r, f'than_{rival}_high_s'):.1f})" for rival in ("plain", "manual"))]
        for r in found["as shipped"].itertuples()
    ]  # fmt: skip
    contents = {
        "posterior": table(
            ["", "n", "90 % holds", "by simulation", "50 % holds", "posterior, ms", "plain, ms",
             "manual, ms", "plain less posterior, ms (95 %)", "manual less posterior, ms (95 %)"],
            shipped_rows,
        ),
        "posterior-varied": table(
            ["", "90 % holds", "by hand and edge", "50 % holds", "by hand and edge",
             "posterior, ms"],
            [[name, *_pooled(rows)] for name, rows in found.items()],
        ),
    }  # fmt: skip
    fill(ROOT / "docs" / "scoring.md", contents)
    for content in contents.values():
        print(content)


if __name__ == "__main__":
    main(*(int(word) for word in (sys.argv[1:] or (FIRST, SEEDS))))
