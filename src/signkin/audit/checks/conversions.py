"""A printed effect size told in another one: d, g, r, eta squared, f, odds ratios.

Three scales: the logarithm of an odds ratio, d, and r. Between them lie formulas of which a paper
used one: each is tried, and the finding names it. Borenstein et al. 2009, Introduction to
Meta-Analysis, chapter 7 (logit method; r and d); Chinn 2000; Cox (ln(OR) / 1.65) as Haddock et al.
1998 have it; McGraw and Wong 1992 (common language effect size).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import atanh, exp, inf, log, pi, sqrt, tanh

from scipy import stats

from signkin.audit.checks.counts import set_count
from signkin.audit.checks.effects import ends
from signkin.audit.checks.groups import want_number
from signkin.audit.findings import CONSISTENT, DIGITS, INCONSISTENT, Finding, over_readings
from signkin.audit.registry import OnPrint, on_print
from signkin.audit.two_groups import hedges
from signkin.errors import SignkinError, listed

Function = Callable[[float], float]
Way = tuple[str, Function, Function]  # a formula's name, the formula, its inverse


@dataclass(frozen=True)
class _Effect:
    """An effect size: its scale, to it and back (both rise), bounds, whether it has a sign."""

    scale: str
    into: Function
    back: Function
    low: float = -inf
    high: float = inf
    signed: bool = True


def _same(x: float) -> float:
    return x


def _normal(x: float) -> float:
    return float(sqrt(2) * stats.norm.ppf(x))


EFFECTS = {
    "odds_ratio": _Effect("log odds", lambda x: log(x) if x > 0 else -inf, exp, low=0.0),
    "log_odds": _Effect("log odds", _same, _same),
    "d": _Effect("d", _same, _same),
    "g": _Effect("d", _same, _same),
    "cles": _Effect("d", _normal, lambda d: float(stats.norm.cdf(d / sqrt(2))), 0.0, 1.0),
    "r": _Effect("r", _same, _same, -1.0, 1.0),
    "fisher_z": _Effect("r", tanh, lambda r: atanh(r) if abs(r) < 1 else inf * r),
    "eta2": _Effect("r", sqrt, lambda r: r * r, 0.0, 1.0, signed=False),
    "f": _Effect("r", lambda f: f / sqrt(1 + f * f) if f < inf else 1.0,
                 lambda r: r / sqrt(1 - r * r) if r < 1 else inf, 0.0, signed=False),
    "f2": _Effect("r", lambda f: sqrt(f / (1 + f)) if f < inf else 1.0,
                  lambda r: r * r / (1 - r * r) if r < 1 else inf, 0.0, signed=False),
}  # fmt: skip


@on_print("effect sizes", {"effect": "odds_ratio", "value": "2.48", "to": "d", "equals": "0.50"})
def effect_conversion(
    context: OnPrint, effect: str, value: str, to: str, equals: str, n: Sequence[str] = (),
    df: str = "",
) -> list[Finding]:  # fmt: skip
    """A printed effect size is the printed other one; the finding names the formula.

    effect, to: d, g, cles (common language), odds_ratio, log_odds, r, fisher_z, eta2 (two groups,
    or one degree of freedom above), f or f2 (Cohen's). n: the sizes of two groups, where they are
    told; g wants them, or df. Signs, and which group comes first, are not looked at.
    """
    for name in (effect, to):
        if name not in EFFECTS:
            raise SignkinError(f"the effect size {name!r}", expected=listed(EFFECTS, 20))
    sizes = [set_count("n", context.text(size)) for size in n]
    if len(sizes) not in (0, 2):
        raise SignkinError(f"{len(sizes)} sizes n", expected="those of two groups")
    degrees = want_number("df", context.text(df)) if df else float(sum(sizes) - 2)
    if "g" in (effect, to) and degrees <= 1:
        raise SignkinError("g without its degrees of freedom", expected="n of two groups, or df")
    texts = context.text(value), context.text(equals)
    readings = [
        (name, partial(_converted, (effect, to), texts, name, forward, backward))
        for name, forward, backward in _ways(effect, to, sizes, degrees)
    ]
    return [over_readings(readings)]


def _ways(effect: str, to: str, n: Sequence[int], df: float) -> list[Way]:
    """Return (name, function, its inverse) of every formula from one effect size to the other."""
    before: list[Way] = (
        [(f"{name} of g", f, b) for name, b, f in _small(df)] if effect == "g" else []
    )
    after = [(name, f, b) for name, f, b in _small(df)] if to == "g" else []
    none: list[Way] = [("", _same, _same)]
    out: list[Way] = []
    for a in before or none:
        for step in _steps(EFFECTS[effect].scale, EFFECTS[to].scale, n):
            for c in after or none:
                words = [part[0] for part in (a, step, c) if part[0]]
                out.append((
                    ", ".join(words) or "the one formula",
                    partial(_chained, (a[1], step[1], c[1])),
                    partial(_chained, (c[2], step[2], a[2])),
                ))  # fmt: skip
    return out


def _chained(functions: Sequence[Function], x: float) -> float:
    for function in functions:
        x = function(x)
    return x


def _small(df: float) -> list[Way]:
    out: list[Way] = []
    for name, by in (("Hedges' correction", hedges(df)),
                     ("Hedges' correction 1 - 3 / (4 df - 1)", 1 - 3 / (4 * df - 1))):  # fmt: skip
        out.append((name, partial(_times, by), partial(_times, 1 / by)))
    return out


def _times(by: float, x: float) -> float:
    return x * by


def _steps(start: str, end: str, n: Sequence[int]) -> list[Way]:
    """Return the formulas from one scale to another, by way of d."""
    if start == end:
        return [("", _same, _same)]
    odds = [("logit, ln(OR) sqrt(3) / pi", sqrt(3) / pi), ("Cox, ln(OR) / 1.65", 1 / 1.65)]
    halves = [("r = d / sqrt(d^2 + 4)", 4.0)]
    if n:
        whole = sum(n)
        least = (whole - 2) / n[0] + (whole - 2) / n[1]
        halves += [("r = d / sqrt(d^2 + N^2 / (n1 n2))", whole**2 / (n[0] * n[1])),
                   ("r = d / sqrt(d^2 + df / n1 + df / n2)", least)]  # fmt: skip
    logs: list[Way] = [(name, partial(_times, by), partial(_times, 1 / by)) for name, by in odds]
    halved: list[Way] = [(name, partial(_r_of_d, a), partial(_d_of_r, a)) for name, a in halves]
    by_ends: dict[tuple[str, str], list[Way]] = {
        ("log odds", "d"): logs,
        ("d", "r"): halved,
        ("log odds", "r"): [
            (f"{a}, {b}", partial(_chained, (f, g)), partial(_chained, (v, u)))
            for a, f, u in logs for b, g, v in halved
        ],
    }  # fmt: skip
    if (start, end) in by_ends:
        return by_ends[start, end]
    return [(name, back, there) for name, there, back in by_ends[end, start]]


def _r_of_d(a: float, d: float) -> float:
    return (1.0 if d > 0 else -1.0) if abs(d) == inf else d / sqrt(d * d + a)


def _d_of_r(a: float, r: float) -> float:
    return inf * r if abs(r) >= 1 else r * sqrt(a) / sqrt(1 - r * r)


def _through(effect: _Effect, other: _Effect, by: Function, x: float) -> float:
    found = by(effect.into(min(max(x, effect.low), effect.high)))
    return other.back(found if other.signed else abs(found))


def _converted(
    names: tuple[str, str], texts: tuple[str, str], name: str, forward: Function,
    backward: Function,
) -> Finding:  # fmt: skip
    first, other = (EFFECTS[n] for n in names)
    given, printed = ends(texts[0]), ends(texts[1])
    if given[2] < first.low or given[1] > first.high:
        raise SignkinError(f"{names[0]} is {texts[0]}",
                           expected=f"a number from {first.low:g} to {first.high:g}")  # fmt: skip
    found = [_through(first, other, forward, x) for x in given]
    if not other.signed and given[1] < 0 < given[2] and first.signed:
        found.append(0.0)
    low, high = min(found), max(found)
    turned = sorted((_mirror(names[1], low), _mirror(names[1], high)))
    slack = 1e-9 * max(1.0, abs(found[0]))
    fits = any(a - slack <= printed[2] and printed[1] <= b + slack
               for a, b in ((low, high), turned))  # fmt: skip
    back = _through(other, first, backward, printed[0])
    why = f"{names[0]} {texts[0]} is {names[1]} {found[0]:.4g} ({low:.4g} to {high:.4g})"
    why += f" by {name}" if name != "the one formula" else ""
    return Finding(
        CONSISTENT if fits else INCONSISTENT, why + ("" if fits else f", printed is {texts[1]}"),
        f"{names[1]} {texts[1]}", f"{found[0]:.6g}", f"{low:.6g} to {high:.6g}", settings=name,
        hand=name, severity="" if fits else DIGITS,
        nearest="" if fits else f"{names[1]} {found[0]:.4g}, or {names[0]} {back:.4g}",
    )  # fmt: skip


def _mirror(effect: str, x: float) -> float:
    """Return the effect size with the groups exchanged."""
    if effect == "odds_ratio":
        return 1 / x if x > 0 else inf
    if effect == "cles":
        return 1 - x
    return -x if EFFECTS[effect].signed else x
