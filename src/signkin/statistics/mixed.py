"""Group differences where transitions come from several recordings or signers: a mixed model."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
import pandas as pd
import statsmodels.formula.api as smf
from scipy import stats

from signkin.statistics.findings import Finding, Kind, untestable

TEST = "mixed model, likelihood ratio"
EDGE = 1e-5  # a gain in log-likelihood that is none
WITHIN = "transition (within)"
FEW_LEVELS = 5  # below it a variance between levels is hardly known


def mixed_model(data: pd.DataFrame, comparison: str) -> list[Finding]:
    """Return the likelihood-ratio test of `group` with signer and recording as random effects.

    data: duration_s, group, signer, recording. Random: an intercept a signer, and one a
    recording in it; where there is one signer, an intercept a recording. Fitted by maximum
    likelihood with and without `group`. With it come the SDs of the random effects.
    """
    n = len(data)
    signers, recordings = data["signer"].nunique(), data["recording"].nunique()
    if data["group"].nunique() < 2:
        return [untestable(TEST, Kind.DIFFERENCE, comparison, n, "fewer than two groups")]
    if recordings < 2:
        return [
            untestable(
                TEST, Kind.DIFFERENCE, comparison, n, "one recording only: no random effect to tell"
            )
        ]
    if np.ptp(data["duration_s"]) == 0:
        return [untestable(TEST, Kind.DIFFERENCE, comparison, n, "all durations are equal")]
    recording = "recording" if signers > 1 and recordings > signers else ""
    outer = "signer" if signers > 1 else "recording"
    told = [f"random intercepts: {' and '.join(filter(None, (outer, recording)))}"]
    counts = {"signer": signers, "recording": recordings}
    few = [k for k in filter(None, (outer, recording)) if counts[k] < FEW_LEVELS]
    told += [f"{counts[k]} {k}s only: their variance is hardly known" for k in few]
    caught: set[str] = set()
    full = _fit("duration_s ~ C(group)", data, outer, recording, caught)
    null = _fit("duration_s ~ 1", data, outer, recording, caught)
    if full.variances[WITHIN] <= 1e-20:
        return [
            untestable(
                TEST, Kind.DIFFERENCE, comparison, n, "all durations within the groups are equal"
            )
        ]
    ratio = max(0.0, 2 * (full.llf - null.llf))
    df = data["group"].nunique() - 1
    told += sorted(caught)
    told.append("no effect size: see the variances")
    out = [
        Finding(
            TEST,
            Kind.DIFFERENCE,
            comparison,
            (),
            "chi squared",
            ratio,
            df,
            p=float(stats.chi2.sf(ratio, df)),
            n=n,
            notes=tuple(told),
        )
    ]
    total = sum(full.variances.values())
    for name, variance in full.variances.items():
        out.append(
            Finding(
                "mixed model, random effect",
                Kind.VARIANCE,
                f"{comparison}: {name}",
                (),
                "SD (s)",
                float(np.sqrt(variance)),
                effect_name="share of variance",
                effect=variance / total,
                n=n,
                notes=(
                    "of the variance that groups do not explain",
                    "no interval: variances near 0 have none by maximum likelihood",
                ),
            )
        )
    return out


@dataclass(frozen=True)
class _Fit:
    """The log-likelihood of a fit, and its variances by where they come from."""

    llf: float
    variances: dict[str, float]


def _fit(formula: str, data: pd.DataFrame, outer: str, inner: str, caught: set[str]) -> _Fit:
    """Return the best of the nested fits: least squares, the outer effect, the inner, both.

    A variance of exactly 0 makes statsmodels' likelihood infinite or its matrix singular; the
    model without that effect is then the maximum.
    """
    plain = smf.ols(formula, data).fit()
    nothing = dict.fromkeys(filter(None, (outer, inner)), 0.0)
    best = _Fit(float(plain.llf), {**nothing, WITHIN: float(plain.ssr / plain.nobs)})
    plans: list[tuple[str, str]] = [(outer, ""), (inner, ""), (outer, inner)]
    for group, nested in plans if inner else plans[:1]:
        extra = {"vc_formula": {nested: f"0 + C({nested})"}} if nested else {}
        model = smf.mixedlm(formula, data, groups=group, re_formula="1", **extra)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # all of them tell of a variance near 0: told below
            try:
                fit = model.fit(reml=False, method="lbfgs")
            except np.linalg.LinAlgError:  # singular on the way: a variance near 0 again
                continue
        if np.isfinite(fit.llf) and fit.llf > best.llf + EDGE:
            between = {**nothing, group: float(np.asarray(fit.cov_re)[0, 0])}
            if nested:
                between[nested] = float(fit.vcomp[0])
            best = _Fit(float(fit.llf), {**between, WITHIN: float(fit.scale)})
    caught |= {f"no variance between {name}s" for name in nothing if not best.variances[name]}
    return best
