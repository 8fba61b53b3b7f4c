"""How duration goes with distance: correlations, the isochrony exponent, shares; bootstrap."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from statsmodels.regression.linear_model import OLS
from statsmodels.stats.proportion import proportion_confint
from statsmodels.tools.tools import add_constant

from signkin.resampling import narrowed
from signkin.statistics.findings import Finding, Kind, untestable

Array = NDArray[np.float64]
Rows = NDArray[np.intp]
MOST_UNITS = 1000  # that a bootstrap draw takes
PEARSON, SPEARMAN, ISOCHRONY = "Pearson", "Spearman", "isochrony exponent"


def bootstrap(
    statistic: Callable[[Rows], Array | float],
    units: Sequence[Hashable],
    draws: int,
    alpha: float,
    rng: np.random.Generator,
    of_many: Callable[[Rows], Array] | None = None,
) -> tuple[Array, Array]:
    """Return the percentile interval of a statistic of row numbers, by resampling units.

    units: one label a row; rows of one label are drawn together (all different: single rows).
    A draw for which the statistic cannot be computed (NaN) is left out of the quantiles.
    of_many: the statistic of many draws at once, (draws, rows) -> (draws,): taken for single rows,
    whose draws are all as long.

    Of more than MOST_UNITS units, N, a draw takes m = MOST_UNITS of them, and the interval is
    narrowed about the statistic of all rows by the square root of m / N (the m out of N bootstrap;
    Bickel, Goetze and van Zwet 1997): draws cost the same whatever N.
    """
    labels = np.unique(np.asarray(units, dtype=object).astype(str), return_inverse=True)[1]
    order = np.argsort(labels, kind="stable")
    members = np.split(order, np.cumsum(np.bincount(labels))[:-1])

    def drawn(chosen: Rows) -> Array:
        return np.asarray(statistic(np.concatenate([members[i] for i in chosen])), dtype=float)

    n = len(members)
    taken = min(n, MOST_UNITS)
    if of_many is not None and n == len(labels):
        values = of_many(np.concatenate(members)[rng.integers(0, n, (draws, taken))])
    else:
        values = np.stack([drawn(rng.integers(0, n, taken)) for _ in range(draws)])
    low, high = np.nanquantile(values, [alpha / 2, 1 - alpha / 2], axis=0)
    if taken < n:
        whole = np.asarray(statistic(np.arange(len(labels))), dtype=float)
        low, high = (narrowed(whole, bound, taken, n) for bound in (low, high))
    return low, high


def resampled_units(recordings: Sequence[Hashable], least: int) -> tuple[list[Hashable], str]:
    """Return the units to resample and their name: recordings from `least` on, else rows."""
    if len(set(recordings)) >= least:
        return list(recordings), "recordings"
    return list(range(len(recordings))), "transitions"


def correlations(
    distance: Array,
    duration: Array,
    recordings: Sequence[Hashable],
    comparison: str,
    alpha: float,
    draws: int,
    least_recordings: int,
    rng: np.random.Generator,
) -> list[Finding]:
    """Return Pearson's and Spearman's correlation with bootstrap intervals."""
    n = len(distance)
    out = []
    tests = {PEARSON: stats.pearsonr, SPEARMAN: stats.spearmanr}
    for test, function in tests.items():
        reason = _why_no_line(distance, duration)
        if reason:
            out.append(untestable(test, Kind.ASSOCIATION, comparison, n, reason))
            continue
        units, unit = resampled_units(recordings, least_recordings)

        def of(rows: Rows, ranks: bool = test == SPEARMAN) -> float:
            x, y = distance[rows], duration[rows]
            if np.ptp(x) == 0 or np.ptp(y) == 0:
                return float("nan")
            if ranks:
                x, y = stats.rankdata(x), stats.rankdata(y)
            return float(np.corrcoef(x, y)[0, 1])

        def of_many(rows: Rows, ranks: bool = test == SPEARMAN) -> Array:
            return _correlations(distance[rows], duration[rows], ranks)

        low, high = bootstrap(of, units, draws, alpha, rng, of_many)
        r, p = function(distance, duration)
        out.append(
            Finding(
                test,
                Kind.ASSOCIATION,
                comparison,
                (),
                "r",
                float(r),
                df2=n - 2,
                p=float(p),
                effect_name="correlation",
                effect=float(r),
                effect_low=float(low),
                effect_high=float(high),
                n=n,
                notes=(f"interval: bootstrap of {unit}",),
            )
        )
    return out


def _correlations(x: Array, y: Array, ranks: bool) -> Array:
    """Return the correlation of each row of x with that of y; NaN where one of them is constant."""
    constant = (np.ptp(x, axis=1) == 0) | (np.ptp(y, axis=1) == 0)
    if ranks:
        x, y = stats.rankdata(x, axis=1), stats.rankdata(y, axis=1)
    x, y = (v - v.mean(axis=1, keepdims=True) for v in (x, y))
    with np.errstate(invalid="ignore"):
        r = (x * y).sum(axis=1) / np.sqrt((x * x).sum(axis=1)) / np.sqrt((y * y).sum(axis=1))
    return np.where(constant, np.nan, np.clip(r, -1, 1))


def isochrony(distance: Array, duration: Array, comparison: str, alpha: float) -> Finding:
    """Return the exponent b of duration = a distance^b, by least squares on the logarithms.

    1: constant speed; 0: isochrony in full, the same duration over any distance. Robust (HC3)
    standard errors. Transitions of zero length or distance have no logarithm: left out, told.
    """
    there = (distance > 0) & (duration > 0)
    left = int((~there).sum())
    x, y = distance[there], duration[there]
    n = len(x)
    note = f"{left} of zero length or distance left out" if left else ""
    reason = _why_no_line(x, y) or ("fewer than four transitions" if n < 4 else "")
    if reason:
        return untestable(ISOCHRONY, Kind.ASSOCIATION, comparison, n, reason).noted(note)
    fit = OLS(np.log(y), add_constant(np.log(x))).fit(cov_type="HC3", use_t=True)
    low, high = fit.conf_int(alpha)[1]
    return Finding(
        ISOCHRONY,
        Kind.ASSOCIATION,
        comparison,
        (),
        "t",
        float(fit.tvalues[1]),
        df2=n - 2,
        p=float(fit.pvalues[1]),
        effect_name="exponent",
        effect=float(fit.params[1]),
        effect_low=float(low),
        effect_high=float(high),
        n=n,
        notes=("0: same duration over any distance, 1: constant speed", "p is for 0"),
    ).noted(note)


def share(held: NDArray[np.bool_], test: str, comparison: str, alpha: float) -> Finding:
    """Return a share with its Wilson interval."""
    n = len(held)
    if not n:
        return untestable(test, Kind.SHARE, comparison, n, "no transition has a distance")
    low, high = proportion_confint(int(held.sum()), n, alpha=alpha, method="wilson")
    return Finding(
        test,
        Kind.SHARE,
        comparison,
        effect_name="share",
        effect=float(held.mean()),
        effect_low=float(low),
        effect_high=float(high),
        n=n,
        notes=("no test: the diamond is drawn to hold this share",),
    )


def _why_no_line(x: Array, y: Array) -> str:
    if len(x) < 3:
        return "fewer than three transitions with this distance"
    if np.ptp(x) == 0:
        return "all distances are equal"
    if np.ptp(y) == 0:
        return "all durations are equal"
    return ""
