"""How far Bayesian binning moves with the choices of docs/interpretations.md.

python -m tools.numbers RESULTS DATA binning

40 recordings of each corpus, evenly spread.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from signkin.binning import Posterior, fit_many
from signkin.binning.hit_rate import hit_rate
from signkin.corpus import Corpus, data_folder, load_corpus
from signkin.recording import Recording
from signkin.settings import Settings
from signkin.stages.ingest import ingest
from signkin.stages.wrists import in_bins
from signkin.studies.endres2013.posteriors import (
    FITTED_MAP,
    Data,
    Study,
    chosen,
    prior_of,
)
from signkin.studies.endres2013.settings import CutSettings, FitSettings
from signkin.studies.endres2013.single_signs import (
    POWERLAW,
    RECORDED,
    Trajectory,
    movement_of,
    single_signs,
)
from signkin.studies.one_wrist.long_series import long_series
from signkin.studies.one_wrist.settings import SeriesSettings
from tools.binning_tables import (
    MOST,
    ORDERS,
    SHIPPED,
    Outcome,
    by_variant,
    of_many_dof,
    of_picking,
    of_recovery,
)
from tools.numbers import table
from tools.shipped import changed, shipped

ROOT = Path(__file__).resolve().parents[1]
SINGLE = ("isl-sim", "isl-kinect", "auslan-hq")
CONTINUOUS = ("lsf-sim", "dgs-1984189", "libras")
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Takes:
    """Some recordings of a corpus."""

    corpus: Corpus
    recordings: Sequence[Recording]


@dataclass(frozen=True)
class Variant:
    """A change to what a run does. config: keys below `binning`, as a.b."""

    config: Mapping[str, object]
    noise: float = 1.0
    offset_m: float = 0.0
    max_count: int | None = None
    rate: float = 1.0
    whole: bool = False


VARIANTS = {
    SHIPPED: Variant({}),
    "noise_sd halved": Variant({}, noise=0.5),
    "noise_sd doubled": Variant({}, noise=2.0),
    "prior.noise data": Variant({"prior.noise": "data"}),
    "prior.scale plain": Variant({"prior.scale": "plain"}),
    "prior.concentration 0.001": Variant({"prior.concentration": 0.001}),
    "prior.concentration 10": Variant({"prior.concentration": 10.0}),
    "prior.time_unit second": Variant({"prior.time_unit": "second"}),
    "prior.time_unit trajectory": Variant({"prior.time_unit": "trajectory"}),
    "bins 50": Variant({"bins": 50}),
    "bins 200": Variant({"bins": 200}),
    "M up to 20 only": Variant({}, max_count=20),
    "0.3 m off the centre": Variant({}, offset_m=0.3),
    "1 m off the centre": Variant({}, offset_m=1.0),
    "rest not left out": Variant({}, whole=True),
    "twice the rate": Variant({}, rate=2.0),
    "four times the rate": Variant({}, rate=4.0),
}


def with_binning(settings: Settings, changes: Mapping[str, object]) -> Settings:
    """Return the settings with keys below `binning` changed."""
    return changed(settings, {f"binning.{key}": value for key, value in changes.items()})


def takes(name: str, results: Path, data: Path) -> Takes | None:
    """Read some recordings of a corpus; None where its data are not there."""
    corpus = load_corpus(ROOT / "corpora" / name)
    folder = data_folder(corpus, data, results)
    if folder is None:
        return None
    wanted = set(chosen([entry.recording for entry in corpus.entries], MOST))
    entries = [entry for entry in corpus.entries if entry.recording in wanted]
    return Takes(corpus, ingest(corpus, folder, entries).recordings)


def cut(of: Takes, settings: Settings, variant: Variant) -> list[Trajectory]:
    """Return the trajectories, those with more bins than the highest order."""
    recordings = [replace(r, rate_hz=r.rate_hz * variant.rate) for r in of.recordings]
    if variant.whole:
        law = settings.powerlaw.model_copy(update={"active_share": 0.0})
        settings = settings.model_copy(update={"powerlaw": law})
    own = CutSettings.of(settings)
    found = single_signs(of.corpus, recordings, own, settings.seed).trajectories
    return [t for t in found if len(t.x) > max(ORDERS)]


def binned(
    of: Takes, trajectories: Sequence[Trajectory], settings: Settings, variant: Variant
) -> list[Posterior]:
    """Bin trajectories with the settings of a variant."""
    x = [t.x - t.x.mean(axis=0) + variant.offset_m for t in trajectories]
    prior = settings.binning.prior
    return fit_many(
        x, ORDERS, [prior_of(prior, of.corpus.noise_sd * variant.noise, one) for one in x],
        [t.bin_s for t in trajectories], max_count=variant.max_count, expectations=False,
        sample_at=[t.sample_at for t in trajectories],
    )  # fmt: skip


def greatest(posterior: Posterior, order: int) -> Ints:
    """Return the bins with the M largest values of the boundary posterior."""
    found = np.argsort(-posterior.boundary_probability(order), kind="stable")
    return np.sort(found[: posterior.map_count(order)])


def rates(
    trajectories: Sequence[Trajectory], fits: Sequence[Posterior], order: int,
    choose: Callable[[Posterior, int], Ints], window_s: float,
) -> str:  # fmt: skip
    """Return hit rate and false positives a second on ground truth."""
    found = [
        hit_rate(
            fit.times_s(choose(fit, order)), t.boundaries_s, window_s,
            duration_s=t.duration_s,
        )
        for t, fit in zip(trajectories, fits, strict=True)
        if t.dataset == POWERLAW
    ]  # fmt: skip
    if not found:
        return "none"
    seconds = sum(t.duration_s for t in trajectories if t.dataset == POWERLAW)
    hits, misses = sum(r.hits for r in found), sum(r.misses for r in found)
    wrong = sum(r.false_positives for r in found)
    return f"{hits / (hits + misses):.2f}, {wrong / seconds:.2f}"


def maxima(posterior: Posterior, order: int) -> Ints:
    """Return the boundaries as a run does."""
    return posterior.boundaries(order)


def single_bins(posterior: Posterior, order: int) -> Ints:
    """Return the largest local maxima without a clearance."""
    probability = posterior.boundary_probability(order)
    padded = np.concatenate([[-np.inf], probability, [-np.inf]])
    peak = (padded[1:-1] >= padded[:-2]) & (padded[1:-1] >= padded[2:])
    found = np.flatnonzero(peak & (probability > 0))
    best = found[np.argsort(-probability[found], kind="stable")]
    return np.sort(best[: posterior.map_count(order)])


def outcome(
    of: Takes, settings: Settings, variant: Variant, known: list[Trajectory] | None = None
) -> Outcome:
    """Bin the trajectories of a corpus under a variant; known: as `cut` returns them for it."""
    trajectories = cut(of, settings, variant) if known is None else known
    fits = binned(of, trajectories, settings, variant)
    by_kind = {
        kind: [f for t, f in zip(trajectories, fits, strict=True) if t.dataset == kind]
        for kind in (RECORDED, POWERLAW)
    }
    mean = {
        kind: np.mean([f.order_probability for f in here], axis=0)
        for kind, here in by_kind.items()
        if here
    }
    recorded = by_kind[RECORDED]
    return Outcome(
        counts=tuple(float(np.mean([f.map_count(s) for f in recorded])) for s in (0, 3, 7)),
        posterior=mean[RECORDED],
        truths_posterior=mean.get(POWERLAW),
        rates=rates(trajectories, fits, 3, maxima, settings.binning.hit_window_s),
        recorded=len(recorded),
        truths=len(by_kind[POWERLAW]),
        left=sum(t.hand == "left" for t in trajectories if t.dataset == RECORDED),
    )


def choices(of: Takes, settings: Settings) -> dict[str, Outcome]:
    """Print what each variant does to a corpus; returns it."""
    print(f"\n### {of.corpus.name}: M at orders 0, 3, 7; order posterior; ground truth\n")
    print("| | M | peak | P(3-5) | truth's peak | order 3: hit rate, false pos./s | left hand |")
    print("|---" * 7 + "|")
    found = {}
    for label, variant in VARIANTS.items():
        one = found[label] = outcome(of, with_binning(settings, variant.config), variant)
        print(
            f"| {label} | {one.m()} | {one.peak} | {one.middle} | {one.truths_peak} "
            f"| {one.rates} (n = {one.truths}) | {one.left} of {one.recorded} |",
            flush=True,
        )
    return found


def picking(of: Takes, settings: Settings) -> dict[str, list[str]]:
    """Print hits on ground truth by the way in which boundaries are taken; returns the cells."""
    shipped = VARIANTS[SHIPPED]
    trajectories = cut(of, settings, shipped)
    fits = binned(of, trajectories, settings, shipped)
    window = settings.binning.hit_window_s
    ways: dict[str, Callable[[Posterior, int], Ints]] = {
        "local maxima, 3 bins cleared": maxima,
        "local maxima": single_bins,
        "M largest values": greatest,
        "most probable segmentation": lambda fit, order: fit.map_segmentation(order),
    }
    print(f"\n### {of.corpus.name}, ground truth: hit rate, false positives a second\n")
    print("| | order 0 | order 1 | order 3 | order 5 |")
    print("|---" * 5 + "|")
    found = {}
    for label, way in ways.items():
        cells = [rates(trajectories, fits, order, way, window) for order in (0, 1, 3, 5)]
        found[label] = [cells[0], cells[2]]
        print(f"| {label} | " + " | ".join(cells) + " |", flush=True)
    return found


def recovery(of: Takes, settings: Settings) -> dict[tuple[str, float, float], list[str]]:
    """Print P(true order), hit rate and false positives a second of fitted trajectories.

    Returns them by the kind of trajectory, b and the share of the noise.
    """
    found = {}
    for kind in ("fitted", FITTED_MAP):
        print(f"\n### {of.corpus.name}, {kind}: P(true order) / hit rate / false pos. a second\n")
        print("| b | noise | " + " | ".join(f"order {order}" for order in ORDERS[1:]) + " |")
        print("|---" * 9 + "|")
        for b in (0.1, 0.001):
            for share in (1.0, 0.1, 0.0125):
                changes = {"prior.concentration": b, "recovery_noise": share}
                cells = found[kind, b, share] = recovered(of, with_binning(settings, changes), kind)
                print(f"| {b:g} | {share:g} | " + " | ".join(cells) + " |", flush=True)
    return found


def recovered(
    of: Takes, settings: Settings, kind: str, orders: Sequence[int] = ORDERS[1:]
) -> list[str]:
    """Return a cell for each true order."""
    runs = Study(of.corpus, FitSettings.of(settings))
    trajectories = cut(of, settings, VARIANTS[SHIPPED])
    fits = runs.run([Data(t, t.dataset, t.x, None, t.boundaries_s) for t in trajectories])
    cells = []
    for order in orders:
        again = [
            item
            for one in fits
            if one.data.dataset == RECORDED
            for item in runs.fitted_data(one, order)
            if item.dataset == kind
        ]
        found = runs.run(again)
        probability = np.mean([f.posterior.order_probability[order] for f in found])
        told = [
            hit_rate(
                f.boundaries_s(order), f.data.truth_s, settings.binning.hit_window_s,
                duration_s=f.data.source.duration_s,
            )
            for f in found
        ]  # fmt: skip
        hits, misses = sum(r.hits for r in told), sum(r.misses for r in told)
        wrong = np.mean([r.false_positives_per_s for r in told])
        share = f"{hits / (hits + misses):.3f}" if hits + misses else "none"
        cells.append(f"{probability:.2f}/{share}/{wrong:.2f}")
    return cells


def nearest(of: Takes, settings: Settings) -> dict[str, Outcome]:
    """Print the printed prior with many degrees of freedom: what comes nearest to the paper."""
    print(f"\n### {of.corpus.name}: the printed prior (data's variances, b = 0.1, T = 100, bins)\n")
    print("| dof | M at 0, 3, 7 | peak | P(3-5) | truth's peak | order 3: hit rate, false pos./s "
          "| refound order 3, averaged: P, hit rate | the most probable |")  # fmt: skip
    print("|---" * 8 + "|")
    out = {}
    for dof in (100, 300, 1000, 3000):
        changes = {
            "prior.noise": "data", "prior.scale": "plain", "prior.dof": dof, "recovery_noise": 1.0,
        }  # fmt: skip
        own = with_binning(settings, changes)
        one = out[f"{dof:,}"] = outcome(of, own, VARIANTS[SHIPPED])
        again = [recovered(of, own, kind, (3,))[0] for kind in ("fitted", FITTED_MAP)]
        print(
            f"| {dof} | {one.m()} | {one.peak} | {one.middle} | {one.truths_peak} "
            f"| {one.rates} (n = {one.truths}) | {again[0]} | {again[1]} |",
            flush=True,
        )
    return out


def many_boundaries(results: Path) -> list[list[str]]:
    """Return how often the most probable M is near T - 1, a row a corpus, by order."""
    out = []
    for name in SINGLE:
        path = results / "endres2013" / name / "binning.csv"
        if not path.exists():
            continue
        rows = pd.read_csv(path)
        rows = rows[rows["dataset"] == RECORDED]
        many = (rows["map_count"] >= rows["n_bins"] / 2).groupby(rows["order"]).sum()
        every = (rows["map_count"] == rows["n_bins"] - 1).groupby(rows["order"]).sum()
        cells = [f"{many[order]:,} ({every[order]:,})" for order in ORDERS]
        n, bins = rows["recording"].nunique(), rows["n_bins"].median()
        out.append([name, f"{n:,}, {bins:g}", *cells])
    return out


def long_ones(of: Takes, settings: Settings) -> dict[str, str]:
    """Print what the settings of long series do; returns boundaries a second."""
    out = {}
    variants: dict[str, dict[str, object]] = {
        SHIPPED: {},
        "longest 1 s": {"continuous.longest_segment_s": 1.0},
        "longest 4 s": {"continuous.longest_segment_s": 4.0},
        "bins of 0.01 s": {"continuous.bin_s": 0.01},
        "bins of 0.04 s": {"continuous.bin_s": 0.04},
        "order 1": {"continuous.order": 1},
        "order 5": {"continuous.order": 5},
    }
    print(f"\n### {of.corpus.name}: boundaries a second, right and left; largest cut mass\n")
    print("| | bins | right | left | cut mass | explained variance, least |")
    print("|---" * 6 + "|")
    for label, changes in variants.items():
        found = long_series(
            of.corpus, of.recordings, SeriesSettings.of(with_binning(settings, changes)), 1
        )
        rows = found.table("wrist_posteriors", of.corpus.unit)
        by_hand = rows.groupby("hand")["boundaries_per_s"].mean()
        out[label] = f"{by_hand['right']:.2f} ({by_hand['left']:.2f})"
        print(
            f"| {label} | {rows['n_bins'].max()} | {by_hand['right']:.2f} | {by_hand['left']:.2f} "
            f"| {rows['cut_mass'].max():.1e} | {rows['explained_variance'].min():.4f} |",
            flush=True,
        )
    return out


def splines(of: Takes, settings: Settings) -> None:
    """Print how far a path at the middle of bins is from straight lines between its samples."""
    apart, fewer, bins = [], 0, settings.binning.bins
    for recording in of.recordings:
        movement = movement_of(recording, CutSettings.of(settings))
        path, wrist = movement.path, movement.wrist
        fewer += len(path) <= bins
        x, bin_s = in_bins(path, wrist.rate_hz, min(bins, len(path)))
        if len(path) <= bins:
            continue
        middle = (np.arange(len(x)) + 0.5) * bin_s
        times = np.arange(len(path)) / wrist.rate_hz
        line = np.column_stack([np.interp(middle, times, axis) for axis in path.T])
        apart.append(np.linalg.norm(x - line, axis=1).max() * 1000)
    told = f"{np.median(apart):.3f} mm (median), {max(apart):.3f} mm (most)" if apart else "none"
    print(f"| {of.corpus.name} | {fewer} of {len(of.recordings)} | {told} |")


def main(results: Path, data: Path) -> dict[str, str]:
    """Print every table; returns those of the page."""
    settings = shipped()
    single = {name: of for name in SINGLE if (of := takes(name, results, data)) is not None}
    many = table(
        ("", "n, median bins", *(f"order {order}" for order in ORDERS)), many_boundaries(results)
    )
    print("\n### Recordings with as many bins as samples; spline against straight lines\n")
    print("| | as many | largest distance |\n|---|---|---|")
    for of in single.values():
        splines(of, settings)
    found = {name: choices(of, settings) for name, of in single.items()}
    picked = {name: picking(of, settings) for name, of in single.items()}
    near = {name: nearest(of, settings) for name, of in single.items()}
    refound = recovery(single["isl-sim"], settings)
    series = {
        name: long_ones(of, settings)
        for name in CONTINUOUS
        if (of := takes(name, results, data)) is not None
    }
    rows = next(iter(series.values()))
    return {
        **by_variant(found),
        "binning-nu": of_many_dof(near),
        "binning-many": many,
        "binning-recovery-map": of_recovery(refound, FITTED_MAP),
        "binning-recovery-averaged": of_recovery(refound, "fitted"),
        "binning-picking": of_picking(picked),
        "binning-long": table(
            ("boundaries a second, right wrist (left)", *series),
            ([label, *(of[label] for of in series.values())] for label in rows),
        ),
    }


def sample(results: Path) -> tuple[str, str]:
    """Return a place and the start of a row of it, from simulated recordings, to compare."""
    settings = shipped()
    of = takes("isl-sim", results, results)
    assert of is not None
    one = outcome(of, settings, VARIANTS[SHIPPED])
    return "binning-noise", f"| **sensor** | {one.m()}; {one.rates} |"
