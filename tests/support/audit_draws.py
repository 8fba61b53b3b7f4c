"""Data that exist, printed, for each check on print: none of them may be accused.

    python tests/support/audit_draws.py 10000        every check, so many draws each, with counts
    python tests/support/audit_draws.py 500 grimmer  one check

A draw makes data, computes what a paper would print of them (numpy, scipy: not the audit's own
arithmetic), rounds it half up, half even or as floating point does, and returns the arguments.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from decimal import ROUND_HALF_EVEN, ROUND_HALF_UP, Decimal
from pathlib import Path

import numpy as np
from scipy import stats

from signkin.audit.commands import findings_of

Rng = np.random.Generator
Draw = Callable[[Rng], tuple[dict[str, object], str]]
DRAWS: dict[str, Draw] = {}


def draw(function: Draw) -> Draw:
    DRAWS[function.__name__] = function
    return function


def put(rng: Rng, value: float, places: int) -> str:
    """Print a number as one of the usual rules does."""
    rule = [ROUND_HALF_UP, ROUND_HALF_EVEN][int(rng.integers(2))]
    if rng.random() < 0.3:
        text = f"{value:.{places}f}"
    else:
        text = str(Decimal(repr(float(value))).quantize(Decimal(1).scaleb(-places), rounding=rule))
    text = text.replace("-0.", "-.") if rng.random() < 0.2 else text
    return text[1:] if text.startswith("0.") and rng.random() < 0.2 else text


def put_p(rng: Rng, p: float) -> str:
    if p < 0.001 and rng.random() < 0.7:
        return "<.001"
    if p > 0.05 and rng.random() < 0.2:
        return rng.choice(["ns", "n.s.", ">.05"])
    if p < 0.05 and rng.random() < 0.2:
        return "<.05"
    return f"{p:.2e}" if p < 0.001 else put(rng, p, int(rng.integers(2, 5)))


def scores(rng: Rng, least: int = 2, most: int = 60) -> tuple[np.ndarray, int, int]:
    low = int(rng.integers(0, 2))
    high = low + int(rng.choice([1, 4, 6, 10, 100]))
    n = int(rng.integers(least, most))
    values = low + (high - low) * rng.beta(*rng.uniform(0.3, 3, 2), size=n)
    return np.rint(values), low, high


@draw
def grim(rng):
    items = int(rng.integers(1, 5))
    n = int(rng.integers(1, 80))
    values = rng.integers(1, 8, (n, items)).mean(axis=1)
    return {"mean": put(rng, values.mean(), 2), "n": str(n), "grain": "1", "items": str(items)}, ""


@draw
def grimmer(rng):
    values, low, high = scores(rng)
    items = int(rng.integers(1, 4))
    if items > 1:
        values = rng.integers(low, high + 1, (len(values), items)).mean(axis=1)
    places, ddof = int(rng.integers(1, 4)), int(rng.integers(2))
    spread = values.std(ddof=ddof)
    of = {"spread": "either"} if rng.random() < 0.3 else {}
    if of and rng.random() < 0.5:
        spread /= len(values) ** 0.5
    scale = {"low": str(low), "high": str(high)} if rng.random() < 0.5 else {}
    return {"mean": put(rng, values.mean(), places), "sd": put(rng, spread, places),
            "n": str(len(values)), "grain": "1", "items": str(items), "divisor": "either",
            **of, **scale}, ""  # fmt: skip


@draw
def debit(rng):
    n = int(rng.integers(2, 2000))
    values = (rng.random(n) < rng.random()).astype(float)
    places = int(rng.integers(1, 4))
    spread = put(rng, values.std(ddof=int(rng.integers(2))), places)
    return {"mean": put(rng, values.mean(), places), "sd": spread, "n": str(n)}, ""


@draw
def range_possible(rng):
    values, low, high = scores(rng)
    given = {"mean": put(rng, values.mean(), 2), "sd": put(rng, values.std(ddof=1), 2)}
    scale = {"grain": "1", "low": str(low), "high": str(high)}
    return {**given, **scale, "n": str(len(values))}, ""


@draw
def closure(rng):
    # Small enough to count in milliseconds, but for one in fifty: large samples on wide scales are
    # counted for seconds, or answered by "too many".
    low, ddof = int(rng.integers(0, 2)), int(rng.integers(2))
    steps = int(rng.choice([1, 4, 6, 10]))
    high, most = low + steps, 40 if steps < 4 or rng.random() < 0.02 else 60 // steps
    values = np.rint(low + steps * rng.beta(*rng.uniform(0.3, 3, 2), rng.integers(2, most)))
    places = int(rng.integers(1, 4))
    spread = put(rng, values.std(ddof=ddof), places)
    return {"mean": put(rng, values.mean(), places), "sd": spread, "n": str(len(values)),
            "grain": "1", "low": str(low), "high": str(high)}, ""  # fmt: skip


@draw
def sprite(rng):
    values, low, high = scores(rng)
    places, ddof = int(rng.integers(1, 4)), int(rng.integers(2))
    given = {"mean": put(rng, values.mean(), places), "sd": put(rng, values.std(ddof=ddof), places)}
    return {**given, "n": str(len(values)), "grain": "1", "low": str(low), "high": str(high),
            "draws": "5"}, ""  # fmt: skip


@draw
def observed_range(rng):
    # A further draw of scale_bounds: the least and greatest value as the range.
    values = rng.normal(10, 3, int(rng.integers(2, 40)))
    places, ddof = int(rng.integers(0, 3)), int(rng.integers(2))
    return {"mean": put(rng, values.mean(), places), "sd": put(rng, values.std(ddof=ddof), places),
            "n": str(len(values)), "low": put(rng, values.min(), places), "observed": True,
            "high": put(rng, values.max(), places)}, ""  # fmt: skip


@draw
def scale_bounds(rng):
    values, low, high = scores(rng)
    values = values if rng.random() < 0.5 else low + (high - low) * rng.random(len(values))
    return {"mean": put(rng, values.mean(), 2), "sd": put(rng, values.std(ddof=1), 2),
            "n": str(len(values)), "low": str(low), "high": str(high)}, ""  # fmt: skip


def samples_of(rng: Rng, least: int = 2, most: int = 5) -> list[np.ndarray]:
    k = int(rng.integers(least, most))
    return [rng.normal(rng.normal(5, 1), rng.uniform(0.5, 3), int(rng.integers(3, 40)))
            for _ in range(k)]  # fmt: skip


@draw
def pooled(rng):
    of, places, ddof = samples_of(rng), int(rng.integers(1, 4)), int(rng.integers(2))
    rows = [f"g{i},{len(v)},{put(rng, v.mean(), places)},{put(rng, v.std(ddof=ddof), places)}"
            for i, v in enumerate(of)]  # fmt: skip
    whole = np.concatenate(of)
    given = {"mean_of_all": put(rng, whole.mean(), 2), "n_of_all": str(len(whole)),
             "sd_of_all": put(rng, whole.std(ddof=ddof), 2)}  # fmt: skip
    return {"table": "t.csv", **given}, "\n".join(["g,n,mean,sd", *rows])


@draw
def same_whole(rng):
    values, places, ddof = rng.normal(5, 2, int(rng.integers(8, 60))), int(rng.integers(0, 3)), 1
    rows = []
    for i in range(int(rng.integers(2, 5))):
        cut = int(rng.integers(2, len(values) - 1))
        mixed = rng.permutation(values)
        for k, v in enumerate((mixed[:cut], mixed[cut:])):
            sd = put(rng, v.std(ddof=ddof), places) if len(v) > 1 else ""
            rows.append(f"g{i}{k},s{i},{len(v)},{put(rng, v.mean(), places)},{sd}")
    return {"table": "t.csv", "split": "by", "sd": "sd"}, "\n".join(["g,by,n,mean,sd", *rows])


@draw
def left_out(rng):
    values = rng.integers(5, 90, int(rng.integers(3, 20))) / 100
    without, ddof = values[1:], int(rng.integers(2))
    cells = [f"{len(v)},{put(rng, v.mean(), 4)},{put(rng, v.std(ddof=ddof), 4)}"
             for v in (values, without)]  # fmt: skip
    return {"table": "t.csv", "row": "a", "suffix": "_o"}, (
        f"g,n,mean,sd,n_o,mean_o,sd_o\na,{cells[0]},{cells[1]}\n"
    )


@draw
def test_of_groups(rng):
    of, places = samples_of(rng, 2, 4), int(rng.integers(1, 4))
    ddof, se = int(rng.integers(2)), bool(rng.random() < 0.3)
    spreads = [v.std(ddof=ddof) / (len(v) ** 0.5 if se else 1) for v in of]
    given = {"n": [str(len(v)) for v in of], "mean": [put(rng, v.mean(), places) for v in of],
             "sd": [put(rng, s, places) for s in spreads], "spread": "either"}  # fmt: skip
    if any(float(s) == 0 for s in given["sd"]):
        given["sd"] = [put(rng, s, 5) for s in spreads]
    if len(of) == 2:
        equal = bool(rng.random() < 0.5)
        done = stats.ttest_ind(*of, equal_var=equal)
        p = done.pvalue / 2 if rng.random() < 0.2 else done.pvalue
        given |= {"t": put(rng, done.statistic, 2), "p": put_p(rng, p),
                  "df": put(rng, done.df, 0 if equal else int(rng.integers(0, 3)))}  # fmt: skip
    else:
        done = stats.f_oneway(*of)
        given |= {"F": put(rng, done.statistic, 2), "p": put_p(rng, done.pvalue)}
    return given, ""


@draw
def groups_differ(rng):
    of = samples_of(rng, 2, 5)
    rows = [f"g{i},{len(v)},{put(rng, v.mean(), 2)},{put(rng, v.std(ddof=1), 2)}"
            for i, v in enumerate(of)]  # fmt: skip
    p = stats.f_oneway(*of).pvalue
    return {"table": "t.csv", "differ": bool(p < 0.05)}, "\n".join(["g,n,mean,sd", *rows])


@draw
def p_value(rng):
    kind = str(rng.choice(["t", "F", "chi2", "z", "r", "Q", "welch"]))
    df = [int(rng.integers(1, 120))]
    if kind == "welch":
        exact = rng.uniform(2, 60)
        t = stats.t.rvs(exact, random_state=rng)
        p = 2 * stats.t.sf(abs(t), exact)
        return {"kind": "t", "statistic": put(rng, t, 2), "p": put_p(rng, p),
                "df": [put(rng, exact, int(rng.integers(0, 3)))]}, ""  # fmt: skip
    if kind == "t":
        value = stats.t.rvs(df[0], random_state=rng)
        p = 2 * stats.t.sf(abs(value), df[0])
    elif kind == "z":
        value, df = rng.normal() * 2, []
        p = 2 * stats.norm.sf(abs(value))
    elif kind == "r":
        df = [int(rng.integers(3, 120))]
        value = np.tanh(rng.normal() / 2)
        p = 2 * stats.t.sf(abs(value) * np.sqrt(df[0] / (1 - value**2)), df[0])
    elif kind == "F":
        df = [int(rng.integers(1, 6)), int(rng.integers(4, 200))]
        value = stats.f.rvs(*df, random_state=rng) * rng.uniform(1, 3)
        p = stats.f.sf(value, *df)
    else:
        value = stats.chi2.rvs(df[0], random_state=rng) * rng.uniform(0.5, 2)
        p = stats.chi2.sf(value, df[0])
    if kind in ("t", "z", "r") and rng.random() < 0.2:
        p = p / 2
    return {"kind": kind, "statistic": put(rng, value, 2), "p": put_p(rng, p),
            "df": [str(d) for d in df]}, ""  # fmt: skip


@draw
def percentage(rng):
    n = int(rng.integers(1, 500))
    k = int(rng.integers(0, n + 1))
    percent = put(rng, 100 * k / n, int(rng.integers(0, 3)))
    return {"count": str(k), "n": str(n), "percent": percent}, ""


@draw
def margins(rng):
    counts = rng.integers(0, 50, (3, 3))
    rows = [f"g{i},{','.join(map(str, r))},{r.sum()}" for i, r in enumerate(counts)]
    rows.append(f"all,{','.join(map(str, counts.sum(axis=0)))},{counts.sum()}")
    return {"table": "t.csv", "columns": ["a", "b", "c"], "total": "sum", "total_row": "all"}, (
        "\n".join(["g,a,b,c,sum", *rows])
    )


@draw
def total(rng):
    counts = rng.integers(0, 50, 4)
    counts[0] += 1
    return {"table": "t.csv", "column": "n", "equals": str(counts.sum())}, (
        "\n".join(["g,n", *(f"g{i},{k}" for i, k in enumerate(counts))])
    )


@draw
def chi_squared(rng):
    shape = (2, 2) if rng.random() < 0.6 else (int(rng.integers(2, 4)), int(rng.integers(2, 5)))
    counts = rng.integers(1, 40, shape)
    which = rng.choice(["pearson", "yates", "g", "fisher"] if shape == (2, 2) else ["pearson", "g"])
    done = stats.chi2_contingency(counts, correction=which == "yates",
                                  lambda_="log-likelihood" if which == "g" else None)  # fmt: skip
    given = {"counts": [[str(c) for c in row] for row in counts]}
    if which == "fisher":
        return {**given, "p": put_p(rng, stats.fisher_exact(counts).pvalue)}, ""
    return {**given, "chi2": put(rng, done.statistic, 2), "p": put_p(rng, done.pvalue)}, ""


@draw
def odds_ratio(rng):
    c = rng.integers(1, 60, (2, 2))
    turned = c[::-1] if rng.random() < 0.5 else c
    (a, b), (d, e) = turned.astype(float)
    odds, se = a * e / (b * d), np.sqrt(1 / a + 1 / b + 1 / d + 1 / e)
    ends = np.exp(np.log(odds) + np.array([-1, 1]) * stats.norm.isf(0.025) * se)
    return {"counts": [[str(x) for x in row] for row in c], "odds_ratio": put(rng, odds, 2),
            "low": put(rng, ends[0], 2), "high": put(rng, ends[1], 2)}, ""  # fmt: skip


@draw
def effect_size(rng):
    if rng.random() < 0.5:
        a, b = (rng.normal(rng.normal(), 1, int(rng.integers(4, 40))) for _ in "ab")
        t = stats.ttest_ind(a, b).statistic
        n = [len(a), len(b)]
        spread = np.sqrt(((n[0] - 1) * a.var(ddof=1) + (n[1] - 1) * b.var(ddof=1)) / (sum(n) - 2))
        d = (a.mean() - b.mean()) / spread
        name = str(rng.choice(["d", "g", "r"]))
        value = {"d": d, "g": d * (1 - 3 / (4 * (sum(n) - 2) - 1)),
                 "r": t / np.sqrt(t * t + sum(n) - 2)}[name]  # fmt: skip
        return {"effect": name, "value": put(rng, value, 2), "kind": "t", "n": [str(x) for x in n],
                "statistic": put(rng, t, 2), "df": [str(sum(n) - 2)]}, ""  # fmt: skip
    of = samples_of(rng, 2, 5)
    whole, k = np.concatenate(of), len(of)
    f, n = stats.f_oneway(*of).statistic, len(whole)
    within = sum(((v - v.mean()) ** 2).sum() for v in of)
    all_ = ((whole - whole.mean()) ** 2).sum()
    omega = (all_ - within - (k - 1) * within / (n - k)) / (all_ + within / (n - k))
    name = str(rng.choice(["eta2", "partial_eta2", "omega2"]))
    value = omega if name == "omega2" else 1 - within / all_
    return {"effect": name, "value": put(rng, value, 2), "kind": "F", "statistic": put(rng, f, 2),
            "df": [str(k - 1), str(n - k)]}, ""  # fmt: skip


@draw
def effect_conversion(rng):
    a, b = (rng.normal(rng.normal(), 1, int(rng.integers(4, 40))) for _ in "ab")
    n, both = [len(a), len(b)], np.concatenate([a, b])
    spread = np.sqrt(((n[0] - 1) * a.var(ddof=1) + (n[1] - 1) * b.var(ddof=1)) / (sum(n) - 2))
    d, r = (a.mean() - b.mean()) / spread, np.corrcoef(both, np.arange(len(both)) < n[0])[0, 1]
    eta2 = 1 - (a.var() * len(a) + b.var() * len(b)) / (both.var() * len(both))
    f, pi3 = np.sqrt(eta2 / (1 - eta2)), np.pi / np.sqrt(3)
    sizes = {"d": d, "r": r, "eta2": eta2, "f": f, "fisher_z": np.arctanh(r),
             "g": d * (1 - 3 / (4 * (sum(n) - 2) - 1)), "cles": stats.norm.cdf(d / np.sqrt(2)),
             "f2": eta2 / (1 - eta2), "log_odds": d * pi3,
             "odds_ratio": np.exp(d * (pi3 if rng.random() < 0.5 else 1.65))}  # fmt: skip
    first, other = rng.choice(sorted(sizes), 2, replace=False)
    if {first, other} == {"log_odds", "odds_ratio"}:
        sizes["odds_ratio"] = np.exp(sizes["log_odds"])
    sign = -1 if rng.random() < 0.3 and "odds_ratio" not in (first, other) else 1
    value = sizes[other] * (sign if other in ("d", "g", "r", "log_odds", "fisher_z") else 1)
    return {"effect": str(first), "value": put(rng, sizes[first], 2), "to": str(other),
            "equals": put(rng, value, 2), "n": [str(x) for x in n]}, ""  # fmt: skip


@draw
def standard_error(rng):
    n, sd = int(rng.integers(2, 300)), rng.uniform(0.1, 20)
    places = int(rng.integers(1, 4))
    return {"n": str(n), "sd": put(rng, sd, places), "se": put(rng, sd / n**0.5, places)}, ""


@draw
def confidence_interval(rng):
    values, places = rng.normal(rng.normal(), 1, int(rng.integers(6, 200))), int(rng.integers(2, 4))
    m, se, df = values.mean(), stats.sem(values), len(values) - 1
    t = stats.t.isf(0.025, df) if rng.random() < 0.7 else 1.96
    p = 2 * stats.t.sf(abs(m / se), df)
    low, high = m - t * se, m + t * se
    extra = {"df": str(df)} if t != 1.96 and rng.random() < 0.5 else {}
    if rng.random() < 0.3:  # a ratio
        m, low, high = np.exp([m, low, high])
    return {"estimate": put(rng, m, places), "low": put(rng, low, places), "p": put_p(rng, p),
            "high": put(rng, high, places), "se": put(rng, se, places), **extra}, ""  # fmt: skip


@draw
def regression_row(rng):
    n, places = int(rng.integers(8, 150)), int(rng.integers(2, 4))
    x = rng.normal(size=n)
    y = x * rng.normal() + rng.normal(size=n)
    done = stats.linregress(x, y)
    sds = {"beta": put(rng, done.rvalue, 2), "sd_x": put(rng, x.std(ddof=1), 2),
           "sd_y": put(rng, y.std(ddof=1), 2)}  # fmt: skip
    t = stats.t.isf(0.025, n - 2)
    return {"b": put(rng, done.slope, places), "se": put(rng, done.stderr, places),
            "t": put(rng, done.slope / done.stderr, 2), "p": put_p(rng, done.pvalue),
            "df": str(n - 2), "low": put(rng, done.slope - t * done.stderr, places),
            "high": put(rng, done.slope + t * done.stderr, places), **sds}, ""  # fmt: skip


@draw
def change_scores(rng):
    pre = rng.normal(10, 3, int(rng.integers(4, 60)))
    post = pre * rng.uniform(-1, 1.5) + rng.normal(0, rng.uniform(0.1, 3), len(pre))
    change, places = post - pre, int(rng.integers(1, 3))
    given = {"pre": pre.mean(), "post": post.mean(), "change": change.mean(),
             "sd_pre": pre.std(ddof=1), "sd_post": post.std(ddof=1),
             "sd_change": change.std(ddof=1)}  # fmt: skip
    told = {k: put(rng, v, places) for k, v in given.items()}
    return {**told, "r": put(rng, np.corrcoef(pre, post)[0, 1], 2)}, ""


@draw
def correlation_matrix(rng):
    k = int(rng.integers(3, 7))
    mixed = rng.normal(size=(k, k)) if rng.random() < 0.8 else rng.normal(size=(k, 1))
    values = rng.normal(size=(int(rng.integers(k, 40)), mixed.shape[1])) @ mixed.T
    values = values + rng.uniform(0, 0.3) * rng.normal(size=values.shape)
    r, places = np.corrcoef(values.T), int(rng.integers(1, 4))
    rows = [",".join([f"v{i}"] + [put(rng, r[i, j], places) if j < i else "" for j in range(k)])
            for i in range(k)]  # fmt: skip
    return {"table": "t.csv"}, "\n".join([",".join(["", *(f"v{i}" for i in range(k))]), *rows])


@draw
def p_values(rng):
    rows = []
    for i in range(4):
        t, df = rng.normal() * 2, int(rng.integers(3, 80))
        p = put_p(rng, 2 * stats.t.sf(abs(t), df))
        rows.append(f"e{i},{put(rng, t, 2)},{df},{p}")
    return {"table": "t.csv", "kind": "t"}, "\n".join(["e,t,df,p", *rows])


@draw
def order(rng):
    of = sorted(samples_of(rng, 2, 5), key=lambda v: v.mean())
    rows = [f"g{i},{len(v)},{put(rng, v.mean(), 2)},{put(rng, v.std(ddof=1), 2)}"
            for i, v in enumerate(of)]  # fmt: skip
    names = [f"g{i}" for i in range(len(of) - 1)]
    return {"table": "t.csv", "lowest": names}, "\n".join(["g,n,mean,sd", *rows])


@draw
def formula(rng):
    a, b = rng.uniform(1, 9, 2)
    text = f"{a:.2f} * {b:.3f} / {a + b:.1f}"
    x, y, s = (float(v) for v in (f"{a:.2f}", f"{b:.3f}", f"{a + b:.1f}"))
    return {"value": text, "equals": put(rng, x * y / s, 2)}, ""


@draw
def last_digits(rng):
    return {"table": "t.csv", "columns": ["x"]}, "\n".join(
        ["x", *(f"{v:.2f}" for v in rng.normal(5, 1, int(rng.integers(30, 200))))]
    )


def accused(name: str, rng: Rng, folder: Path) -> list[str]:
    """Return what a check says against one draw: contradictions, and input it cannot use."""
    given, table = DRAWS[name](rng)
    if table:
        (folder / "t.csv").write_text(table + "\n")
    found = findings_of({"observed_range": "scale_bounds"}.get(name, name), given, folder)
    return [f"{given} {table!r}: {f.why}" for f in found if f.verdict == "inconsistent" or f.fault]


def run(task: tuple[str, int]) -> tuple[str, int, float, float, list[str]]:
    """Return a check, its draws, the mean and greatest time of one (s), and the accusations."""
    name, draws = task
    rng, start, worst, wrong = np.random.default_rng(16), time.process_time(), 0.0, []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(draws):
            before = time.process_time()
            wrong += accused(name, rng, Path(folder))
            worst = max(worst, time.process_time() - before)
    return name, draws, (time.process_time() - start) / draws, worst, wrong


def main(draws: int, names: list[str]) -> int:
    bad = 0
    print("| check | draws | accused | mean time | slowest |\n|---|---|---|---|---|")
    with ProcessPoolExecutor() as pool:
        for name, n, each, worst, wrong in pool.map(
            run, [(name, draws) for name in names or DRAWS]
        ):
            times = f"{each * 1e3:.1f} ms | {worst * 1e3:.0f} ms"
            print(f"| {name} | {n:,} | {len(wrong)} | {times} |", flush=True)
            bad += len(wrong)
            for line in wrong[:3]:
                print("   ", line)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), sys.argv[2:]))
