"""Differences and peaks with their uncertainty: paired bootstrap, clustered by signer and sign.

Recordings of one signer, and of one sign, are alike: taken one by one they promise more than they
know. Here signers and signs are drawn independently, each with replacement, and a recording counts
as often as its signer was drawn times its sign was (the pigeonhole bootstrap, Owen 2007, Ann.
Appl. Stat. 1(2), which is on the safe side). Few clusters vary too little among themselves: draws
are spread about the estimate by sqrt(G / (G - 1)) t / z, G the smaller number of clusters (with
two signers hardly anything is decided, as it should be).
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy  # loads scipy.stats when it is used: it takes as long to import as numba
from numpy.typing import ArrayLike, NDArray

from signkin.errors import SignkinError

Array = NDArray[np.float64]
Clusters = Mapping[str, Sequence[Hashable]]


@dataclass(frozen=True)
class Difference:
    """A mean of paired differences, with its interval.

    above: share of draws above 0. n: pairs. left_out: pairs with a number missing. clusters:
    name -> how many.
    """

    value: float
    low: float
    high: float
    above: float
    n: int
    left_out: int
    clusters: Mapping[str, int]


@dataclass(frozen=True, eq=False)
class Peak:
    """Where means are highest, and how sure that is.

    labels: of the K alternatives. mean, low, high: (K,). probability: (K,), that the alternative
    is the peak; they add up to 1. n, left_out, clusters: as `Difference`.
    """

    labels: tuple[Hashable, ...]
    mean: Array
    low: Array
    high: Array
    probability: Array
    n: int
    left_out: int
    clusters: Mapping[str, int]

    @property
    def at(self) -> Hashable:
        """The alternative with the highest mean."""
        return self.labels[int(np.argmax(self.mean))]

    def probability_of(self, *labels: Hashable) -> float:
        """Return the probability that the peak is one of these."""
        unknown = [label for label in labels if label not in self.labels]
        if unknown:
            raise SignkinError(
                f"{unknown[0]} is no alternative",
                place="peak",
                expected=", ".join(map(str, self.labels)),
            )
        chosen = [i for i, label in enumerate(self.labels) if label in labels]
        return float(self.probability[chosen].sum())


def difference(
    a: ArrayLike,
    b: ArrayLike,
    clusters: Clusters,
    draws: int,
    rng: np.random.Generator,
    level: float = 0.95,
) -> Difference:
    """Return the mean of a - b with its bootstrap interval.

    a, b: (N,), the same recordings under two conditions. clusters: one or two names -> labels
    (N,), such as signer and sign. Raises SignkinError for fewer than two clusters of a name.
    """
    values = np.asarray(a, dtype=float) - np.asarray(b, dtype=float)
    kept, labels, left_out = _complete(values[:, None], clusters)
    found = _spread(kept, labels, draws, rng, level)[:, 0]
    low, high = np.nanquantile(found, [(1 - level) / 2, (1 + level) / 2])
    return Difference(
        float(kept.mean()), float(low), float(high), _share_above(found), len(kept), left_out,
        {name: int(codes.max()) + 1 for name, codes in labels.items()},
    )  # fmt: skip


def peak(
    values: ArrayLike,
    labels: Sequence[Hashable],
    clusters: Clusters,
    draws: int,
    rng: np.random.Generator,
    level: float = 0.95,
) -> Peak:
    """Return which of K alternatives has the highest mean, with the probability of each.

    values: (N, K), a row a recording, such as the posterior of each order. labels: K names.
    clusters: as `difference`. Ties within a draw are shared.
    """
    table = np.asarray(values, dtype=float)
    if table.ndim != 2 or table.shape[1] != len(labels) or len(labels) < 2:
        raise SignkinError(
            f"values of shape {table.shape} for {len(labels)} alternatives",
            place="peak",
            expected="(N, K), two alternatives or more",
        )
    kept, codes, left_out = _complete(table, clusters)
    found = _spread(kept, codes, draws, rng, level)
    found = found[~np.isnan(found).any(axis=1)]
    low, high = np.quantile(found, [(1 - level) / 2, (1 + level) / 2], axis=0)
    highest = found >= found.max(axis=1, keepdims=True) - 1e-12
    probability = (highest / highest.sum(axis=1, keepdims=True)).mean(axis=0)
    return Peak(
        tuple(labels), kept.mean(axis=0), low, high, probability, len(kept), left_out,
        {name: int(c.max()) + 1 for name, c in codes.items()},
    )  # fmt: skip


def _complete(values: Array, clusters: Clusters) -> tuple[Array, dict[str, NDArray[np.intp]], int]:
    """Return the rows without a gap and the codes of their clusters; too few are refused."""
    if not 1 <= len(clusters) <= 2:
        raise SignkinError(
            f"{len(clusters)} kinds of clusters", place="bootstrap", expected="one or two"
        )
    there = np.isfinite(values).all(axis=1)
    codes: dict[str, NDArray[np.intp]] = {}
    for name, labels in clusters.items():
        if len(labels) != len(values):
            raise SignkinError(
                f"{len(labels)} labels of {name} for {len(values)} pairs",
                place="bootstrap",
                expected="one a pair",
            )
        chosen = np.asarray([str(label) for label in labels], dtype=object)[there]
        codes[name] = np.unique(chosen, return_inverse=True)[1].astype(np.intp)
        k = int(codes[name].max()) + 1 if len(chosen) else 0
        if k < 2:
            raise SignkinError(
                f"{k} {name} with numbers to compare",
                place="bootstrap",
                expected=f"two or more: what one {name} does tells nothing of others",
            )
    return values[there], codes, int((~there).sum())


def _spread(
    values: Array,
    codes: Mapping[str, NDArray[np.intp]],
    draws: int,
    rng: np.random.Generator,
    level: float,
) -> Array:
    """Return means of draws, (draws, K), spread about the estimate as few clusters want it."""
    first, *others = codes.values()
    second = others[0] if others else np.zeros(len(first), dtype=np.intp)
    shape = (int(first.max()) + 1, int(second.max()) + 1)
    cell = first * shape[1] + second
    size = shape[0] * shape[1]
    counts = np.bincount(cell, minlength=size).reshape(shape).astype(float)
    # About the mean: a draw's mean is then free of rounding that grows with the offset.
    centre = values.mean(axis=0)
    sums = np.stack(
        [np.bincount(cell, column, minlength=size).reshape(shape) for column in (values - centre).T]
    )
    weights = [
        rng.multinomial(g, np.full(g, 1 / g), draws).astype(float) if g > 1 else np.ones((draws, 1))
        for g in shape
    ]
    total = np.einsum("dg,gh,dh->d", weights[0], counts, weights[1], optimize=True)
    means = np.einsum("dg,kgh,dh->dk", weights[0], sums, weights[1], optimize=True)
    with np.errstate(invalid="ignore"):  # a draw whose signers have none of its signs: NaN
        means = np.where(total[:, None] > 0, means / np.maximum(total, 1e-300)[:, None], np.nan)
    least = min(int(c.max()) + 1 for c in codes.values())
    half = (1 + level) / 2
    factor = (
        np.sqrt(least / (least - 1))
        * scipy.stats.t.ppf(half, least - 1)
        / scipy.stats.norm.ppf(half)
    )
    return np.asarray(centre + factor * means)


def _share_above(found: Array) -> float:
    there = found[~np.isnan(found)]
    return float(((there > 0) + 0.5 * (there == 0)).mean())


def ratio_rows(over: Sequence[ArrayLike], under: Sequence[ArrayLike]) -> Array:
    """Return rows whose mean is a ratio of pooled sums, to be drawn as those of a mean.

    over, under: sums above and below the line, (N, K) each. The ratio is taken as linear about
    its estimate (Taylor, to first order). NaN where a sum below the line is 0.
    """
    parts = [
        (sign, np.asarray(part, dtype=float))
        for sign, group in ((1, over), (-1, under))
        for part in group
    ]
    means = [(sign, part, part.mean(axis=0)) for sign, part in parts]
    ratio = np.ones(parts[0][1].shape[1])
    slope = np.zeros(parts[0][1].shape)
    with np.errstate(divide="ignore", invalid="ignore"):
        for sign, part, mean in means:
            ratio = ratio * mean**sign
            slope = slope + sign * (part / mean - 1)
    out = ratio + ratio * slope
    return np.where(np.isfinite(out), out, np.nan)
