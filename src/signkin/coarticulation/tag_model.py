"""What tags and speed minima say of a boundary, and how sure they are, learnt without truth.

A tag stands beside its boundary by an offset (lead or lag, by edge) and jitter, or, with a small
probability, by a gross error. A boundary shows as a minimum of speed near it with a probability
(`detection`); all other minima are a Poisson process (`clutter_per_s`). Where boundaries and
others differ in the depth of their minima, depth tells them apart. A minimum may belong to the
boundary or not, and both are summed over, as trackers do it (probabilistic data association,
Bar-Shalom & Tse 1975). A low-pass moves minima to the slower side. Where the hand rests near them
is known (`signkin.kinematics.rest_times`), that counts in their place; else those of starts and of
ends may lie outward of their boundaries, or inward, by the same (`outward_s`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from signkin.coarticulation.tag_order import in_order

Floats = NDArray[np.float64]

REACH_S = 0.4  # a boundary is at most this far from its tag
STEP_S = 0.005  # of the grid of times
DEPTHS = 4  # classes of depth, with as many minima in each
FEWEST = 20  # tags to learn from; with fewer the model stays as given
NONE = -1
EVEN = 0.5  # as tags: how much equal shares of the classes of depth count before the data
MOST_GROSS = 0.1  # more would be no tagging
ROUNDS = 30
SETTLED = 3e-4  # gain of log likelihood a tag that ends the learning


@dataclass(frozen=True)
class TagModel:
    """How tags and minima lie about boundaries; times in seconds.

    bias_s: boundary minus tag, of starts and of ends. sd_s: SD of the jitter. gross: share of
    tags with a gross error, whose SD is gross_sd_s.
    shape_sd_s: SD of a rest's error beyond its own SD, since strokes are not quite polynomials.
    Only its sum with sd_s shows in the data, so it is assumed (from simulated signing).
    detection: probability that a boundary has a minimum. idle_detection: the same of signs in
    which the hand does nothing. clutter_per_s: other minima a second.
    depth_ratio: how much likelier each class of depth, shallow to deep, is for a boundary.

    Where rests are not known: minimum_sd_s: SD of a minimum about where its boundary puts it, of
    starts and of ends; assumed, too. outward_s: so much before a start, and after an end, its
    minimum lies (inward: negative). By how much starts and ends lead alike does not show whether
    tags or minima are off; taken as the minima's, up to most_outward_s, which is what a low-pass
    at 6 Hz can do.
    """

    bias_s: tuple[float, float] = (0.0, 0.0)
    sd_s: float = 0.04
    gross: float = 0.05
    gross_sd_s: float = 0.15
    shape_sd_s: float = 0.0015
    minimum_sd_s: tuple[float, float] = (0.0155, 0.013)
    outward_s: float = 0.0
    most_outward_s: float = 0.03
    detection: float = 0.85
    idle_detection: float = 0.5
    clutter_per_s: float = 1.5
    depth_ratio: tuple[float, ...] = (1.0,) * DEPTHS


@dataclass(frozen=True, eq=False)
class Tagged:
    """The tags of one hand in one recording, on a grid of time.

    times_s: (K,), rising; edge (K,): 0 a start, 1 an end, between for both at one instant; idle
    (K,): 1 of a sign in which the hand does nothing, else 0.
    minima_s (M,), rising; depth (M,) class of each. rest_s, rest_sd_s (M,): where the hand rests
    near each, and the SD of that; None: not known, minima stand for it. evidence: (K, W), what
    else is known, as a factor.
    """

    times_s: Floats
    edge: Floats
    idle: Floats
    minima_s: Floats
    depth: NDArray[np.int64]
    reach_s: float = REACH_S
    step_s: float = STEP_S
    evidence: Floats | None = None
    rest_s: Floats | None = None
    rest_sd_s: Floats | None = None

    @property
    def width(self) -> int:
        """Frames of the grid around each tag."""
        return 2 * round(self.reach_s / self.step_s) + 1

    @property
    def first(self) -> NDArray[np.int64]:
        """First frame of the grid around each tag, (K,)."""
        return np.rint(self.times_s / self.step_s).astype(np.int64) - (self.width // 2)

    @property
    def grid_s(self) -> Floats:
        """Times of the grid around each tag, (K, W)."""
        return np.asarray((self.first[:, None] + np.arange(self.width)) * self.step_s)


def most_outward_s(cutoff_hz: float) -> float:
    """Return how far a low-pass may move a minimum: the SD of its kernel, as of a Gaussian.

    Two passes (forward and back) at cutoff_hz, each with half the power there.
    """
    return math.sqrt(math.log(2)) / (math.sqrt(2.0) * math.pi * cutoff_hz)


def by_edge(pair: tuple[float, float], edge: Floats) -> Floats:
    """Return what holds of each boundary, given it for starts and ends."""
    return (1 - edge) * pair[0] + edge * pair[1]


def normal(x: Floats, sd: float | Floats) -> Floats:
    """Return the density of a normal distribution about 0."""
    return np.asarray(np.exp(-0.5 * (x / sd) ** 2) / (sd * np.sqrt(2 * np.pi)))


def minima_about(tagged: Tagged) -> NDArray[np.int64]:
    """Return for each tag the minima that may be its boundary's own, (K, A); -1: none.

    The first of a row is none; rows are filled up with none.
    """
    low = np.searchsorted(tagged.minima_s, tagged.times_s - tagged.reach_s)
    high = np.searchsorted(tagged.minima_s, tagged.times_s + tagged.reach_s, side="right")
    most = int((high - low).max(initial=0))
    found = low[:, None] + np.arange(-1, most)
    found[(found < low[:, None]) | (found >= high[:, None])] = NONE
    return found


def near_minima(tagged: Tagged, own: NDArray[np.int64], model: TagModel) -> Floats:
    """Return the density of each tag's minima about each time of its grid, (K, A, W); 0: none."""
    if tagged.rest_s is not None and tagged.rest_sd_s is not None:
        rest = np.append(tagged.rest_s, np.inf)[own]
        sd = np.hypot(np.append(tagged.rest_sd_s, 1.0), model.shape_sd_s)[own]
        return normal(rest[:, :, None] - tagged.grid_s[:, None], sd[:, :, None])
    usual = tagged.grid_s + model.outward_s * (2 * tagged.edge[:, None] - 1)
    away = np.append(tagged.minima_s, np.inf)[own][:, :, None] - usual[:, None]
    return normal(away, by_edge(model.minimum_sd_s, tagged.edge)[:, None, None])


def prior_parts(tagged: Tagged, model: TagModel) -> tuple[Floats, Floats]:
    """Return the probability of each time by jitter and by gross error, (K, W) each."""
    away = tagged.grid_s - (tagged.times_s + by_edge(model.bias_s, tagged.edge))[:, None]
    parts = []
    for share, sd in ((1 - model.gross, model.sd_s), (model.gross, model.gross_sd_s)):
        density = normal(away, sd) + 1e-300
        parts.append(share * density / density.sum(axis=1, keepdims=True))
    return parts[0], parts[1]


def posterior(
    tagged: Tagged, model: TagModel, own: NDArray[np.int64], near: Floats
) -> tuple[Floats, float]:
    """Return the probability of each time and own minimum (K, A, W), and the log likelihood."""
    classes = np.append(tagged.depth, 0)[own]
    detection = np.where(tagged.idle > 0, model.idle_detection, model.detection)
    likelihood = (
        near
        * (detection[:, None] / model.clutter_per_s * np.asarray(model.depth_ratio)[classes])[
            :, :, None
        ]
    )
    likelihood[:, 0] = 1 - detection[:, None]
    weights = likelihood * sum(prior_parts(tagged, model))[:, None]  # type: ignore[index]
    if tagged.evidence is not None:
        weights = weights * tagged.evidence[:, None]
    return in_order(weights, tagged.first, own)


def learnt(
    recordings: Sequence[Tagged], model: TagModel, *, jitter_known: bool = False
) -> TagModel:
    """Return the model that makes tags and minima most likely (EM on the marginal likelihood).

    recordings: of one hand; those without a minimum teach nothing. model: where to start; its
    minimum_sd_s, gross_sd_s and the number of classes of depth stay. With fewer than FEWEST tags
    it stays whole. jitter_known: sd_s and gross stay.

    Where rests are not known, all spread of the minima about the tags counts as jitter in the end:
    how much of it is the minima's own does not show, and their errors can be opposite to the
    tag's, so that jitter learnt as what is left over comes out too small. What starts and ends
    differ in becomes outward_s, as far as it may. Rests have neither trouble.
    """
    used = [r for r in recordings if len(r.minima_s) and len(r.times_s)]
    rests = all(r.rest_s is not None for r in used)
    tags = sum(len(r.times_s) for r in used)
    acting = int(sum((1 - r.idle).sum() for r in used))
    if acting < FEWEST:
        return model
    model = replace(model, outward_s=0.0)
    own = [minima_about(r) for r in used]
    near = [near_minima(r, o, model) for r, o in zip(used, own, strict=True)]
    before = -np.inf
    for _ in range(ROUNDS):
        sums = [_expected(r, model, o, n) for r, o, n in zip(used, own, near, strict=True)]
        total = {key: np.sum([s[key] for s in sums], axis=0) for key in sums[0]}
        better = _improved(model, total, tags, acting)
        if jitter_known:
            better = replace(better, sd_s=model.sd_s, gross=model.gross)
        model = better
        if total["log"] - before < SETTLED * tags:
            break
        before = float(total["log"])
    if rests:
        return model
    start, end = model.bias_s
    outward = float(np.clip((end - start) / 2, -model.most_outward_s, model.most_outward_s))
    model = replace(model, outward_s=outward, bias_s=(start + outward, end - outward))
    if jitter_known:
        return model
    minimum = np.sqrt(np.mean(np.square(model.minimum_sd_s)))
    return replace(model, sd_s=float(np.hypot(model.sd_s, minimum)))


def _expected(
    tagged: Tagged, model: TagModel, own: NDArray[np.int64], near: Floats
) -> dict[str, Floats]:
    """Return the expected sums that the next model is made of."""
    found, log = posterior(tagged, model, own, near)
    core, gross = prior_parts(tagged, model)
    with_core = found.sum(axis=1) * core / (core + gross)
    away = tagged.grid_s - tagged.times_s[:, None]
    acts = 1 - tagged.idle
    edges = np.stack([1 - tagged.edge, tagged.edge]) * acts
    classes = len(model.depth_ratio)
    depth = np.append(tagged.depth, 0)
    with_own = found.sum(axis=2) * (own >= 0)
    minimum = np.bincount(depth[own].ravel(), with_own.ravel(), classes)
    inside = np.setdiff1d(own, [NONE])
    spans = np.minimum(np.diff(tagged.times_s), 2 * tagged.reach_s).sum() + 2 * tagged.reach_s
    return {
        "log": np.asarray(log),
        "core": edges @ with_core.sum(axis=1),
        "first": edges @ (with_core * away).sum(axis=1),
        "second": edges @ (with_core * away**2).sum(axis=1),
        "minimum": minimum,
        "acting": acts @ with_own.sum(axis=1),
        "idle": tagged.idle @ with_own.sum(axis=1),
        "minima": np.bincount(tagged.depth[inside], minlength=classes).astype(float),
        "seconds": np.asarray(spans),
    }


def _improved(model: TagModel, total: dict[str, Floats], tags: int, acting: int) -> TagModel:
    core = np.maximum(total["core"], 1e-9)
    bias = total["first"] / core
    spread = (total["second"] - core * bias**2).sum() / core.sum()
    boundary = total["minimum"]
    clutter = np.maximum(total["minima"] - boundary, 0) + 1.0  # one more: no class is impossible
    # Equal shares count as much as half the tags, or few minima would rule a class out for good.
    even = EVEN * tags / len(boundary)
    ours, others = boundary + even, clutter + even
    ratio = (ours / ours.sum()) / (others / others.sum())
    return replace(
        model,
        bias_s=(float(bias[0]), float(bias[1])),
        sd_s=max(float(np.sqrt(spread)), 0.004),
        gross=float(np.clip(1 - core.sum() / acting, 0.002, MOST_GROSS)),
        detection=float(np.clip(total["acting"] / acting, 0.02, 0.995)),
        idle_detection=float(np.clip((total["idle"] + 1) / (tags - acting + 2), 0.02, 0.995)),
        clutter_per_s=float(clutter.sum() / total["seconds"]),
        depth_ratio=tuple(float(x) for x in ratio),
    )
