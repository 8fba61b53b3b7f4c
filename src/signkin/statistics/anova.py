"""Do durations differ between groups? ANOVA, Welch, factorial ANOVA, Kruskal-Wallis.

Arrays and frames in, findings out. scipy and statsmodels do the tests; what is done here is to
see whether the data allow them, and to say so where they do not.
"""

from __future__ import annotations

import warnings
from itertools import combinations

import numpy as np
import pandas as pd
import statsmodels.formula.api as smf
from numpy.typing import NDArray
from scipy import stats
from statsmodels.regression.linear_model import RegressionResultsWrapper
from statsmodels.stats.anova import anova_lm
from statsmodels.stats.oneway import anova_oneway
from statsmodels.tools.sm_exceptions import SingularMatrixWarning

from signkin.errors import listed
from signkin.statistics.effects import eta_squared, omega_squared, share_interval
from signkin.statistics.findings import Finding, Groups, Kind, joined, p_text, untestable
from signkin.statistics.power import power_of_f

NOTHING_VARIES = "all durations within the groups are equal"
LEVENE, SHAPIRO = "Levene", "Shapiro-Wilk"
CLASSIC, WELCH, KRUSKAL = "one-way ANOVA", "Welch's ANOVA", "Kruskal-Wallis"
TYPE_2, TYPE_3 = "factorial ANOVA, type II", "factorial ANOVA, type III"
ETA, OMEGA = "eta squared", "omega squared"
PARTIAL_ETA, PARTIAL_OMEGA = f"partial {ETA}", f"partial {OMEGA}"


def one_way(groups: Groups, comparison: str, alpha: float, effect_f: float) -> list[Finding]:
    """Return Levene, Shapiro, one-way ANOVA, Welch's ANOVA and Kruskal-Wallis.

    groups: label -> durations in s. effect_f: Cohen's f that the power is told for.
    """
    filled = {k: g for k, g in groups.items() if len(g)}
    n = sum(len(g) for g in filled.values())
    residuals = np.concatenate([g - g.mean() for g in filled.values()]) if filled else np.empty(0)
    checks = [_levene(filled, comparison, n), _shapiro(residuals, comparison)]
    told = "; ".join(_told(check) for check in checks)
    out = list(checks)
    for test in (_classic, _welch):
        out += test(filled, comparison, n, alpha, effect_f, told)
    out.append(_kruskal(filled, comparison, n))
    return out


def _told(check: Finding) -> str:
    if np.isnan(check.p):
        return f"{check.test} {check.note}"
    return f"{check.test} {check.statistic_name} = {check.statistic:.3g}, {p_text(check.p)}"


def _levene(groups: Groups, comparison: str, n: int) -> Finding:
    kept, note = _of_two_or_more(groups)
    if len(kept) < 2:
        return untestable(LEVENE, Kind.CHECK, comparison, n, "fewer than two groups of two or more")
    if all(np.ptp(g) == 0 for g in kept.values()):
        return untestable(LEVENE, Kind.CHECK, comparison, n, NOTHING_VARIES)
    found = stats.levene(*kept.values(), center="median")
    m = sum(map(len, kept.values()))
    df = (len(kept) - 1, m - len(kept))
    about = "equal variances? around the median (Brown-Forsythe)"
    return Finding(
        LEVENE,
        Kind.CHECK,
        comparison,
        (),
        "W",
        float(found.statistic),
        *df,
        float(found.pvalue),
        n=m,
    ).noted(about, note)


def _shapiro(residuals: NDArray[np.float64], comparison: str) -> Finding:
    n = len(residuals)
    if n < 3 or np.ptp(residuals) == 0:
        why = "fewer than three values" if n < 3 else NOTHING_VARIES
        return untestable(SHAPIRO, Kind.CHECK, comparison, n, why)
    found = stats.shapiro(residuals)
    return Finding(
        SHAPIRO,
        Kind.CHECK,
        comparison,
        (),
        "W",
        float(found.statistic),
        p=float(found.pvalue),
        n=n,
        notes=("normal residuals?",),
    )


def _classic(
    groups: Groups, comparison: str, n: int, alpha: float, effect_f: float, told: str
) -> list[Finding]:
    reason = _why_no_anova(groups, n)
    if reason:
        return [untestable(CLASSIC, Kind.DIFFERENCE, comparison, n, reason)]
    found = stats.f_oneway(*groups.values())
    single = [k for k, g in groups.items() if len(g) == 1]
    note = f"{listed(single)}: one value each, no variance of its own" if single else ""
    df = (len(groups) - 1, n - len(groups))
    return f_findings(
        CLASSIC,
        comparison,
        float(found.statistic),
        df,
        float(found.pvalue),
        n,
        alpha,
        effect_f,
        told,
        (note,),
    )


def _welch(
    groups: Groups, comparison: str, n: int, alpha: float, effect_f: float, told: str
) -> list[Finding]:
    kept, note = _of_two_or_more(groups)
    flat = [k for k, g in kept.items() if np.ptp(g) == 0]
    kept = {k: g for k, g in kept.items() if k not in flat}
    if flat:
        note = joined(note, f"left out, all durations equal: {listed(flat)}")
    if len(kept) < 2:
        reason = f"fewer than two groups of two or more that vary ({note or 'one group'})"
        return [untestable(WELCH, Kind.DIFFERENCE, comparison, n, reason)]
    m = sum(map(len, kept.values()))
    found = anova_oneway(list(kept.values()), use_var="unequal", welch_correction=True)
    df = (float(found.df_num), float(found.df_denom))
    return f_findings(
        WELCH,
        comparison,
        float(found.statistic),
        df,
        float(found.pvalue),
        m,
        alpha,
        effect_f,
        told,
        (note,),
        error_df=m - len(kept),
    )


def _kruskal(groups: Groups, comparison: str, n: int) -> Finding:
    if len(groups) < 2:
        return untestable(KRUSKAL, Kind.DIFFERENCE, comparison, n, "fewer than two groups")
    if np.ptp(np.concatenate(list(groups.values()))) == 0:
        return untestable(KRUSKAL, Kind.DIFFERENCE, comparison, n, "all durations are equal")
    found = stats.kruskal(*groups.values())
    return Finding(
        KRUSKAL,
        Kind.DIFFERENCE,
        comparison,
        (),
        "H",
        float(found.statistic),
        len(groups) - 1,
        p=float(found.pvalue),
        effect_name="epsilon squared",
        effect=float(found.statistic) / (n - 1),
        n=n,
        notes=(
            "of ranks, ties corrected",
            "no interval: the distribution of H under a difference is not known",
        ),
    )


def f_findings(
    test: str,
    comparison: str,
    f: float,
    df: tuple[float, float],
    p: float,
    n: int,
    alpha: float,
    effect_f: float,
    told: str = "",
    notes: tuple[str, ...] = (),
    names: tuple[str, str] = (ETA, OMEGA),
    error_df: float | None = None,
) -> list[Finding]:
    """Return an F test as two findings: with eta squared and with omega squared.

    names: what the two are called. error_df: degrees of freedom that turn F into eta squared,
    where the test's own are no count of values (Welch).
    """
    low, high = share_interval(f, *df, n, alpha)
    power = power_of_f(effect_f, *df, n, alpha)
    effects = (
        eta_squared(f, df[0], df[1] if error_df is None else error_df),
        omega_squared(f, df[0], n),
    )
    return [
        Finding(
            test,
            Kind.DIFFERENCE,
            comparison,
            (),
            "F",
            f,
            *df,
            p,
            name,
            value,
            low,
            high,
            n,
            told,
            power,
            f"f = {effect_f:g}",
        ).noted(*notes)
        for name, value in zip(names, effects, strict=True)
    ]


def _of_two_or_more(groups: Groups) -> tuple[dict[str, NDArray[np.float64]], str]:
    single = [k for k, g in groups.items() if len(g) == 1]
    note = f"left out, one value each: {listed(single)}" if single else ""
    return {k: g for k, g in groups.items() if len(g) > 1}, note


def _why_no_anova(groups: Groups, n: int) -> str:
    if len(groups) < 2:
        return "fewer than two groups"
    if n - len(groups) < 1:
        return "no group has two values"
    if all(np.ptp(g) == 0 for g in groups.values()):
        return NOTHING_VARIES
    return ""


# --- two factors -----------------------------------------------------------------------------


def factorial(
    values: NDArray[np.float64],
    before: NDArray[np.object_],
    after: NDArray[np.object_],
    names: tuple[str, str],
    alpha: float,
    effect_f: float,
) -> list[Finding]:
    """Return the ANOVA of two crossed factors with sums of squares of type II and III.

    names: what the factors are called. Empty cells: type II needs none of them (main effects
    from models without interaction, the error from all filled cells; the interaction has the
    degrees of freedom that the filled cells leave it); type III is undefined, and is given for
    the largest block of levels without an empty cell.
    """
    data = pd.DataFrame({"y": values, "a": before.astype(str), "b": after.astype(str)})
    title = f"{names[0]} x {names[1]}"
    counts = pd.crosstab(data["a"], data["b"])
    single = [name for name, k in zip(names, counts.shape, strict=True) if k < 2]
    n = len(data)
    if n == 0 or single:
        reason = f"{listed(single) if single else title}: one level only"
        return [untestable(t, Kind.DIFFERENCE, title, n, reason) for t in (TYPE_2, TYPE_3)]
    empty = [f"{a} before {b}" for a in counts.index for b in counts.columns if not counts.at[a, b]]
    note = f"empty cells: {listed(empty)}" if empty else ""
    return [
        *_type2(data, names, alpha, effect_f, note),
        *_type3(data, counts, names, alpha, effect_f, note),
    ]


def _type2(
    data: pd.DataFrame, names: tuple[str, str], alpha: float, effect_f: float, note: str
) -> list[Finding]:
    n = len(data)
    cells = _ols("y ~ C(cell)", data.assign(cell=data["a"] + "|" + data["b"]))
    reason = _why_no_error(cells)
    if reason:
        return [untestable(TYPE_2, Kind.DIFFERENCE, f"{names[0]} x {names[1]}", n, reason)]
    both, only_a, only_b = (_ols(f, data) for f in ("y ~ C(a) + C(b)", "y ~ C(a)", "y ~ C(b)"))
    out: list[Finding] = []
    for name, small, large in (
        (names[0], only_b, both),
        (names[1], only_a, both),
        (f"{names[0]} x {names[1]}", both, cells),
    ):
        df1 = large.df_model_rank - small.df_model_rank
        if df1 < 1:
            reason = "the filled cells leave no degree of freedom to tell it from the rest"
            out.append(untestable(TYPE_2, Kind.DIFFERENCE, name, n, joined(reason, note)))
            continue
        rss = [r.fit.ssr for r in (small, large)]
        f = (rss[0] - rss[1]) / df1 / cells.fit.mse_resid
        df = (float(df1), float(cells.fit.df_resid))
        out += f_findings(
            TYPE_2,
            name,
            max(f, 0.0),
            df,
            float(stats.f.sf(f, *df)),
            n,
            alpha,
            effect_f,
            notes=(note,),
            names=(PARTIAL_ETA, PARTIAL_OMEGA),
        )
    return out


def _type3(
    data: pd.DataFrame,
    counts: pd.DataFrame,
    names: tuple[str, str],
    alpha: float,
    effect_f: float,
    note: str,
) -> list[Finding]:
    title = f"{names[0]} x {names[1]}"
    rows, columns = _largest_block(counts)
    if not rows:
        reason = f"no two levels of each factor have all four cells filled; {note}"
        return [untestable(TYPE_3, Kind.DIFFERENCE, title, len(data), reason)]
    kept = data[data["a"].isin(rows) & data["b"].isin(columns)]
    left_out = len(data) - len(kept)
    if left_out:
        note += (
            f"; only {names[0]} {', '.join(rows)} and {names[1]} {', '.join(columns)}, which have "
            f"no empty cell ({left_out} transitions left out)"
        )
    model = _ols("y ~ C(a, Sum) * C(b, Sum)", kept)
    reason = _why_no_error(model)
    if reason:
        return [untestable(TYPE_3, Kind.DIFFERENCE, title, len(kept), reason)]
    found = anova_lm(model.fit, typ=3)
    out: list[Finding] = []
    terms = {names[0]: "C(a, Sum)", names[1]: "C(b, Sum)", title: "C(a, Sum):C(b, Sum)"}
    for name, term in terms.items():
        row = found.loc[term]
        df = (float(row["df"]), float(found.loc["Residual", "df"]))
        out += f_findings(
            TYPE_3,
            name,
            float(row["F"]),
            df,
            float(row["PR(>F)"]),
            len(kept),
            alpha,
            effect_f,
            notes=(note,),
            names=(PARTIAL_ETA, PARTIAL_OMEGA),
        )
    return out


class _Fitted:
    """A least-squares fit with the rank of its design, whatever its coding."""

    def __init__(self, fit: RegressionResultsWrapper) -> None:
        self.fit = fit
        self.df_model_rank = int(fit.nobs - fit.df_resid)


def _ols(formula: str, data: pd.DataFrame) -> _Fitted:
    with warnings.catch_warnings():
        # Crossed levels that never meet: degrees of freedom are counted by the rank.
        warnings.simplefilter("ignore", SingularMatrixWarning)
        return _Fitted(smf.ols(formula, data).fit())


def _why_no_error(model: _Fitted) -> str:
    if model.fit.df_resid < 1:
        return "no cell has two values"
    # Rounding leaves a sum of squares of about 1e-30 where nothing varies.
    if model.fit.ssr <= 1e-20 * max(1.0, float(model.fit.nobs)):
        return NOTHING_VARIES
    return ""


def _largest_block(counts: pd.DataFrame) -> tuple[list[str], list[str]]:
    """Return the levels of both factors, two or more of each, that hold most in filled cells."""
    best: tuple[int, list[str], list[str]] = (0, [], [])
    for k in range(2, len(counts.index) + 1):
        for rows in combinations(counts.index, k):
            columns = [c for c in counts.columns if (counts.loc[list(rows), c] > 0).all()]
            held = int(counts.loc[list(rows), columns].to_numpy().sum())
            if len(columns) >= 2 and held > best[0]:
                best = (held, list(rows), columns)
    return best[1], best[2]
