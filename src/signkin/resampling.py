"""Differences and peaks with their uncertainty: paired bootstrap, clustered by signer and sign.

Recordings of one signer, and of one sign, are alike: taken one by one they promise more than they
know. Here every signer and every sign is weighted at random, the two independently (the multiplier,
or wild, bootstrap with normal weights). Draws have the variance of clusters in two ways (Cameron,
Gelbach & Miller 2011, J. Bus. Econ. Stat. 29(2): that of signers and that of signs, less that of
their cells, which both have in them), though never less than that of signers or of signs alone;
and they are spread as t with G - 1 degrees of freedom, G the smaller number of clusters: with two
signers hardly anything is decided, as it should be. `python -m tools.verdict_levels` tells how
often such an interval errs, and what it finds (docs/reliability.md).
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy  # loads scipy.stats when it is used: it takes as long to import as numba
from numpy.typing import ArrayLike, NDArray

from signkin.errors import SignkinError

Array = NDArray[np.float64]
Clusters = Mapping[str, Sequence[Hashable]]

# Weights (draws by clusters) up to so many are drawn as one, which takes 250 MB; more, so many at
# a time: the same weights, sums that may differ in their last digit.
WHOLE_UP_TO, AT_ONCE = 16_000_000, 2_000_000


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
    low, high = np.quantile(found, [(1 - level) / 2, (1 + level) / 2])
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
    # Where the peak is hangs on differences alone: what all columns share is left out.
    shared = kept.mean(axis=1, keepdims=True)
    low, high = np.quantile(
        _spread(kept, codes, draws, rng, level), [(1 - level) / 2, (1 + level) / 2], axis=0
    )
    found = _spread(kept - shared, codes, draws, rng, level, one_scale=True)
    highest = found >= found.max(axis=1, keepdims=True) - 1e-12
    probability = (highest / highest.sum(axis=1, keepdims=True)).mean(axis=0)
    return Peak(
        tuple(labels), kept.mean(axis=0), low, high, probability, len(kept), left_out,
        {name: int(c.max()) + 1 for name, c in codes.items()},
    )  # fmt: skip


def narrowed(found: Any, bound: Any, taken: int, n: int) -> Any:
    """Return a bound of a bootstrap whose draws take fewer than n rows: the m out of n bootstrap.

    Draws of `taken` rows spread by the square root of n / taken too much about what was found
    (Bickel, Goetze & van Zwet 1997). found, bound: numbers or arrays.
    """
    return found + np.sqrt(taken / n) * (bound - found)


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
    one_scale: bool = False,
) -> Array:
    """Return means of draws, (draws, K), spread about the estimate as few clusters want it.

    one_scale: all columns are spread by one factor, so that differences between them keep theirs.
    """
    # About the mean: a draw's mean is then free of rounding that grows with the offset.
    centre = values.mean(axis=0)
    deviations = values - centre
    parts = [_sums(deviations, code) for code in codes.values()]
    about = np.zeros((draws, values.shape[1]))
    for part in parts:
        about += _weighed(part, draws, rng)
    drawn: Array = np.sum([np.sum(part**2, axis=0) for part in parts], axis=0)
    wanted: Array = _variance(deviations, list(codes.values()), parts)
    if one_scale:
        drawn, wanted = np.array([np.sum(drawn)]), np.array([np.sum(wanted)])
    scale = np.sqrt(np.divide(wanted, drawn, out=np.zeros_like(wanted), where=drawn > 0))
    half_way, least = (1 + level) / 2, min(map(len, parts))
    factor = scipy.stats.t.ppf(half_way, least - 1) / scipy.stats.norm.ppf(half_way)
    return np.asarray(centre + factor * scale * about)


def _weighed(part: Array, draws: int, rng: np.random.Generator) -> Array:
    """Return sums of clusters, each weighted at random in each draw, (draws, K): part (G, K)."""
    up = draws - draws // 2
    if draws * len(part) <= WHOLE_UP_TO:
        half = rng.standard_normal((up, len(part)))
        return np.asarray(np.concatenate([half, -half[: draws // 2]]) @ part)  # as many up as down
    at_once = max(1, AT_ONCE // len(part))
    sizes = [min(at_once, up - first) for first in range(0, up, at_once)]
    rows = np.concatenate([rng.standard_normal((size, len(part))) @ part for size in sizes])
    return np.concatenate([rows, -rows[: draws // 2]])


def _sums(deviations: Array, code: NDArray[np.intp]) -> Array:
    """Return what each cluster moves the mean by, (G, K); squares add up to its variance."""
    groups = int(code.max()) + 1
    sums = np.stack(
        [np.bincount(code, column, minlength=groups) for column in deviations.T], axis=1
    )
    return np.asarray(sums / len(code) * np.sqrt(groups / (groups - 1)))


def _variance(
    deviations: Array, codes: Sequence[NDArray[np.intp]], parts: Sequence[Array]
) -> Array:
    """Return the variance of the mean, (K,): of clusters of one kind, or of two."""
    own = [np.sum(part**2, axis=0) for part in parts]
    if len(own) == 1:
        return own[0]
    cells = np.unique(codes[0] * (int(codes[1].max()) + 1) + codes[1], return_inverse=True)[1]
    both = np.sum(_sums(deviations, cells.astype(np.intp)) ** 2, axis=0)
    return np.max([*own, sum(own) - both], axis=0)


def _share_above(found: Array) -> float:
    return float(((found > 0) + 0.5 * (found == 0)).mean())


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
