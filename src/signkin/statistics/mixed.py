"""Group differences where transitions come from several recordings or signers: a mixed model."""

from __future__ import annotations

import warnings

import numpy as np
import pandas as pd
import statsmodels.formula.api as smf
from scipy import stats
from statsmodels.regression.mixed_linear_model import MixedLMResultsWrapper
from statsmodels.tools.sm_exceptions import ConvergenceWarning

from signkin.statistics.findings import Finding, untestable

TEST = "mixed model, likelihood ratio"
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
        return [untestable(TEST, comparison, n, "fewer than two groups")]
    if recordings < 2:
        return [untestable(TEST, comparison, n, "one recording only: no random effect to tell")]
    if np.ptp(data["duration_s"]) == 0:
        return [untestable(TEST, comparison, n, "all durations are equal")]
    recording = "recording" if signers > 1 and recordings > signers else ""
    outer = "signer" if signers > 1 else "recording"
    told = [f"random intercepts: {' and '.join(filter(None, (outer, recording)))}"]
    counts = {"signer": signers, "recording": recordings}
    few = [k for k in filter(None, (outer, recording)) if counts[k] < FEW_LEVELS]
    told += [f"{counts[k]} {k}s only: their variance is hardly known" for k in few]
    caught: set[str] = set()
    try:
        full = _fit("duration_s ~ C(group)", data, outer, recording, caught)
        null = _fit("duration_s ~ 1", data, outer, recording, caught)
    except (np.linalg.LinAlgError, ValueError) as error:
        return [untestable(TEST, comparison, n, f"the fit fails ({error})")]
    ratio = max(0.0, 2 * float(full.llf - null.llf))
    df = data["group"].nunique() - 1
    within = float(full.scale)
    between = {outer: float(np.asarray(full.cov_re)[0, 0])}
    if recording:
        between["recording"] = float(full.vcomp[0])
    told += sorted(caught)
    told.append("no effect size: see the variances")
    out = [Finding(TEST, comparison, "chi squared", ratio, df, p=float(stats.chi2.sf(ratio, df)),
                   n=n, note="; ".join(told))]  # fmt: skip
    for name, variance in {**between, "transition (within)": within}.items():
        total = within + sum(between.values())
        out.append(
            Finding(
                "mixed model, random effect", f"{comparison}: {name}", "SD (s)",
                float(np.sqrt(variance)), effect_name="share of variance",
                effect=variance / total, n=n,
                note="of the variance that groups do not explain; no interval: variances near 0 "
                "have none by maximum likelihood",
            )
        )  # fmt: skip
    return out


def _fit(
    formula: str, data: pd.DataFrame, outer: str, inner: str, caught: set[str]
) -> MixedLMResultsWrapper:
    extra = {"vc_formula": {inner: f"0 + C({inner})"}} if inner else {}
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always")
        fit = smf.mixedlm(formula, data, groups=outer, re_formula="1", **extra).fit(
            reml=False, method=["lbfgs", "bfgs", "cg"]
        )
    for warning in issued:
        if issubclass(warning.category, ConvergenceWarning):
            text = str(warning.message).lower()
            caught.add(
                "a random effect has no variance (on the edge of what is possible)"
                if "boundary" in text or "singular" in text
                else "the optimiser reported trouble; see the log"
            )
    if not np.isfinite(fit.llf):
        raise ValueError("no finite likelihood")
    return fit
