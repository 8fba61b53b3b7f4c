"""The mixed model against lme4 1.1-31 on R 4.2.2, which had no part in it.

The R code that made the figures; `made` is the same formula in both languages, no random numbers:

    u <- function(a, b, k) { x <- sin(a * 12.9898 + b * 78.233 + k * 3.77) * 43758.5453
                             x - trunc(x) }
    made <- function(k, S, R, N) {
      d <- expand.grid(t = 1:N, r = 0:(R - 1), s = 0:(S - 1)); i <- seq_len(nrow(d))
      d$signer <- factor(d$s); d$recording <- factor(paste(d$s, d$r))
      d$group <- factor(floor(abs(u(i, 3, k)) * 3))
      d$y <- round(.3 + .085 * u(d$s, 1, k) + .034 * u(d$s * 10 + d$r, 2, k) +
                   .085 * u(i, 4, k) + .02 * (d$group == 0), 4)
      d }
    best <- function(f) {       # random: (1|signer) + (1|recording), or the one that there is
      fits <- lapply(c("bobyqa", "Nelder_Mead", "nlminbwrap"), function(o)
        lmer(f, d, REML = FALSE, control = lmerControl(optimizer = o, calc.derivs = FALSE)))
      fits[[which.max(sapply(fits, logLik))]] }
    logLik(best(y ~ group + random)); logLik(best(y ~ 1 + random)); VarCorr(best(...))
    pchisq(2 * difference, 2, lower.tail = FALSE)

statsmodels 0.15's mixedlm with lbfgs stops 0.10 below the maximum on the first of these sets.
"""

import numpy as np
import pandas as pd
import pytest

from signkin.errors import SignkinError
from signkin.statistics.mixed import mixed_model
from signkin.statistics.nested import OPTIMISERS, Nested, maximum


def u(a, b, k):
    return np.modf(np.sin(a * 12.9898 + b * 78.233 + k * 3.77) * 43758.5453)[0]


def made(k, signers, recordings, transitions):
    shape = np.meshgrid(range(signers), range(recordings), range(transitions), indexing="ij")
    s, r, _ = (x.ravel() for x in shape)
    i = np.arange(1, len(s) + 1)
    group = np.floor(np.abs(u(i, 3, k)) * 3).astype(int)
    y = (
        0.3 + 0.085 * u(s, 1, k) + 0.034 * u(s * 10 + r, 2, k) + 0.085 * u(i, 4, k)
        + 0.02 * (group == 0)
    )  # fmt: skip
    return pd.DataFrame(
        {
            "duration_s": np.round(y, 4), "group": group.astype(str), "signer": s.astype(str),
            "recording": [f"{a} {b}" for a, b in zip(s, r, strict=True)],
        }
    )  # fmt: skip


# (k, signers, recordings, transitions): log-likelihood with and without group, p, SDs
LME4 = {
    (1, 6, 3, 6): (178.7108482007, 178.0708379135, 0.5272869997,
                   {"signer": 0.015549715, "recording": 0.041177502, "within": 0.038624889}),
    (2, 6, 3, 6): (172.40074342324, 169.36556416322, 0.04806604578,
                   {"signer": 0, "recording": 0.040490871, "within": 0.041896649}),
    (5, 6, 3, 6): (178.6512824, 173.3540764, 5.005559672e-03,
                   {"signer": 0.037034411, "recording": 0.031705695, "within": 0.038873832}),
    (9, 6, 3, 6): (165.2509640, 159.0294014, 1.986139144e-03,
                   {"signer": 0.067302846, "recording": 0.035079648, "within": 0.043001017}),
    (3, 1, 12, 6): (118.2490713, 113.1346147, 6.009242233e-03,
                    {"recording": 0.032722648, "within": 0.041085067}),
    (4, 9, 1, 8): (112.0012077, 106.5643729, 4.353240347e-03,
                   {"signer": 0.046792417, "within": 0.044240916}),
    (7, 30, 2, 2): (181.21009533248, 175.26663311184, 0.00262293274,
                    {"signer": 0.062545269, "recording": 0.027151531, "within": 0.034245657}),
}  # fmt: skip


@pytest.mark.parametrize("case", LME4, ids=str)
def test_the_mixed_model_against_lme4(case):
    full, null, p, sds = LME4[case]
    test, *effects = mixed_model(made(*case), "x")
    assert test.statistic == pytest.approx(2 * (full - null), rel=1e-6)
    assert test.p == pytest.approx(p, rel=1e-6)
    assert "which agree" in test.note
    found = {f.comparison.removeprefix("x: ").split(" ")[-1].strip("()"): f for f in effects}
    assert {name: f.statistic for name, f in found.items()} == pytest.approx(sds, abs=2e-7)
    assert sum(f.effect for f in effects) == pytest.approx(1)


def two_levels(case, group=True):
    data = made(*case)
    x = np.ones((len(data), 1))
    if group:
        x = np.column_stack([x, pd.get_dummies(data["group"], drop_first=True)]).astype(float)
    codes = [pd.factorize(data[c])[0] for c in ("recording", "signer")]
    return Nested(x, data["duration_s"].to_numpy(), *codes)


def stops_early(deviance, start):
    """An optimiser that calls a point on the slope its maximum."""
    return start + 0.5, True


def test_an_optimiser_that_stops_wrongly_is_told_and_does_not_count():
    some = {"early": stops_early, "Nelder-Mead": OPTIMISERS["Nelder-Mead"]}
    found = maximum(two_levels((1, 6, 3, 6)), some)
    assert found.log_likelihood == pytest.approx(178.7108482007, abs=1e-6)
    assert list(found.short) == ["early"] and found.short["early"] > 0.01


@pytest.mark.parametrize(
    "broken",
    [
        {"early": stops_early},
        {"never": lambda deviance, start: (OPTIMISERS["Powell"](deviance, start)[0], False)},
        {"lost": lambda deviance, start: (np.full(len(start), np.nan), False)},
    ],
    ids=["early", "never", "lost"],
)
def test_no_optimiser_that_settles_is_a_sentence_and_no_number(broken, monkeypatch):
    with pytest.raises(SignkinError, match="no optimiser settles"):
        maximum(two_levels((1, 6, 3, 6)), broken)
    monkeypatch.setattr("signkin.statistics.mixed.OPTIMISERS", broken)
    (only,) = mixed_model(made(1, 6, 3, 6), "x")
    assert np.isnan(only.p) and np.isnan(only.statistic)
    assert only.note == "not testable: no optimiser settles on a maximum of the likelihood"


def test_the_likelihood_is_that_of_the_normal_density():
    """At any ratios, by the full covariance matrix; also where a variance is 0 or huge."""
    model = two_levels((5, 6, 3, 6))
    for ratios in ([0.0, 0.0], [0.7, 0.0], [0.0, 2.0], [0.3, 0.9], [300.0, 20.0]):
        same = [level[:, None] == level for level in (model.inner, model.outer)]
        h = np.eye(len(model.y)) + sum(r**2 * s for r, s in zip(ratios, same, strict=True))
        residual = model.y - model.y.mean() - model.x @ model.effects(np.array(ratios))
        rss = residual @ np.linalg.solve(h, residual)
        n = len(model.y)
        wanted = -0.5 * (n * np.log(2 * np.pi * rss / n) + n + np.linalg.slogdet(h)[1])
        assert model.log_likelihood(np.array(ratios)) == pytest.approx(wanted, abs=1e-7)
