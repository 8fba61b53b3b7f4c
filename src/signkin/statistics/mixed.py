"""Group differences where transitions come from several recordings or signers: a mixed model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from signkin.errors import SignkinError
from signkin.statistics.findings import Finding, Kind, untestable
from signkin.statistics.nested import OPTIMISERS, Maximum, Nested, maximum

TEST = "mixed model, likelihood ratio"
WITHIN = "transition (within)"
FEW_LEVELS = 5  # below it a variance between levels is hardly known


def mixed_model(data: pd.DataFrame, comparison: str) -> list[Finding]:
    """Return the likelihood-ratio test of `group` with signer and recording as random effects.

    data: duration_s, group, signer, recording. Random: an intercept a signer, and one a
    recording in it; where there is one signer, an intercept a recording. Fitted by maximum
    likelihood with and without `group`, each by several optimisers (`nested.maximum`); what they
    say of convergence is told. With it come the SDs of the random effects.
    """
    n = len(data)
    reason = _why_not(data)
    if reason:
        return [untestable(TEST, Kind.DIFFERENCE, comparison, n, reason)]
    levels = _levels(data)
    try:
        full, null = _fitted(data, levels, groups=True), _fitted(data, levels, groups=False)
    except SignkinError as error:
        return [untestable(TEST, Kind.DIFFERENCE, comparison, n, error.found)]
    if full.variances[WITHIN] <= 1e-20:
        reason = "all durations within the groups are equal"
        return [untestable(TEST, Kind.DIFFERENCE, comparison, n, reason)]
    ratio = max(0.0, 2 * (full.maximum.log_likelihood - null.maximum.log_likelihood))
    df = data["group"].nunique() - 1
    test = Finding(
        TEST,
        Kind.DIFFERENCE,
        comparison,
        statistic_name="chi squared",
        statistic=ratio,
        df1=df,
        p=float(stats.chi2.sf(ratio, df)),
        n=n,
        notes=(*_notes(data, levels, full, null), "no effect size: see the variances"),
    )
    total = sum(full.variances.values())
    return [test] + [
        Finding(
            "mixed model, random effect",
            Kind.VARIANCE,
            f"{comparison}: {name}",
            statistic_name="SD (s)",
            statistic=float(np.sqrt(variance)),
            effect_name="share of variance",
            effect=variance / total,
            n=n,
            notes=(
                "of the variance that groups do not explain",
                "no interval: variances near 0 have none by maximum likelihood",
            ),
        )
        for name, variance in full.variances.items()
    ]


def _why_not(data: pd.DataFrame) -> str:
    if data["group"].nunique() < 2:
        return "fewer than two groups"
    if data["recording"].nunique() < 2:
        return "one recording only: no random effect to tell"
    if np.ptp(data["duration_s"]) == 0:
        return "all durations are equal"
    if (data.groupby("group")["duration_s"].agg(np.ptp) == 0).all():
        return "all durations within the groups are equal"
    return ""


def _levels(data: pd.DataFrame) -> tuple[str, ...]:
    """Return the columns with a random intercept, the inner one first."""
    signers, recordings = data["signer"].nunique(), data["recording"].nunique()
    if signers == 1:
        return ("recording",)
    return ("recording", "signer") if recordings > signers else ("signer",)


@dataclass(frozen=True)
class _Fit:
    """A maximum, and the variances by where they come from."""

    maximum: Maximum
    variances: dict[str, float]


def _fitted(data: pd.DataFrame, levels: tuple[str, ...], groups: bool) -> _Fit:
    y = data["duration_s"].to_numpy(dtype=float)
    x = np.ones((len(y), 1))
    if groups:
        dummies = pd.get_dummies(data["group"], drop_first=True).to_numpy(dtype=float)
        x = np.column_stack([x, dummies])
    # A recording belongs to one signer; names may be used again by another.
    codes = [
        data.groupby([*levels[i:]], sort=True).ngroup().to_numpy(dtype=np.intp)
        for i in range(len(levels))
    ]
    model = Nested(x, y, *codes)
    found = maximum(model, OPTIMISERS)
    within = model.residual_variance(found.ratios)
    between = dict(zip(levels, (found.ratios**2 * within).tolist(), strict=True))
    return _Fit(found, {level: between[level] for level in reversed(levels)} | {WITHIN: within})


def _notes(data: pd.DataFrame, levels: tuple[str, ...], full: _Fit, null: _Fit) -> list[str]:
    told = [f"random intercepts: {' and '.join(reversed(levels))}"]
    counts = {level: data[level].nunique() for level in reversed(levels)}
    told += [
        f"{n} {level}s only: their variance is hardly known"
        for level, n in counts.items()
        if n < FEW_LEVELS
    ]
    told += sorted(
        f"no variance between {level}s"
        for level in levels
        if not (full.variances[level] and null.variances[level])
    )
    short = {**null.maximum.short, **full.maximum.short}
    told.append(
        f"the best maximum of {len(OPTIMISERS)} optimisers"
        + (f", {', '.join(short)} stopped short of it" if short else ", which agree")
    )
    return told
