"""p of printed statistics: F, t, chi-squared, H, Q, z and r, with all that rounding allows.

A printed statistic is an interval, and so are its degrees of freedom where they have decimals
(Welch, Greenhouse-Geisser); a printed p may be `<0.001`, `ns` or `1.4e-5`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from math import inf, sqrt

import numpy as np
from scipy import stats

from signkin.audit.findings import (
    CONSISTENT,
    DECISION,
    DIGITS,
    INCONSISTENT,
    Finding,
    over_readings,
)
from signkin.audit.kruskal import exact_tail
from signkin.audit.rounding import allowed, exactly, number, shown
from signkin.audit.summaries import Range
from signkin.errors import SignkinError, listed

KINDS = ("F", "t", "chi2", "H", "Q", "z", "r")
_DF = {"F": 2, "t": 1, "chi2": 1, "H": 1, "Q": 1, "z": 0, "r": 1}
SIGNED = ("t", "z", "r")
TAILS = ("open", "two", "one")
Number = str | float | int
_NOT = re.compile(r"n\.?\s?s\.?|not significant", re.IGNORECASE)
_POWER = re.compile(r"\s*(?:[x×*·]|\\times)\s*10\s*(?:\^|\*\*)?\s*\(?([-\u2212+]?\d+)\)?")


@dataclass(frozen=True)
class PrintedP:
    """A printed p: `sign` is `=`, `<`, `>`; the digits, or alpha where `ns` is printed."""

    sign: str
    digits: str
    text: str

    def significant(self, alpha: float) -> bool | None:
        """Whether the print says that p is below alpha; None where it leaves it open."""
        value = float(exactly(self.digits))
        if self.sign == "<":
            return True if value <= alpha else None
        if self.sign == ">":
            return False if value >= alpha else None
        return None if value == alpha else value < alpha


def printed_p(text: str, alpha: str = "0.05") -> PrintedP:
    """Read a printed p: `.03`, `p = .03`, `<0.001`, `≤ .05`, `>.05`, `ns`, `2.1 × 10^-5`."""
    bare = re.sub(r"^p\b\s*", "", text.strip(), flags=re.IGNORECASE)
    if _NOT.fullmatch(bare.lstrip("= ")):
        return PrintedP(">", alpha, text.strip())
    sign = "="
    if bare[:1] in ("<", ">", "=", "≤", "≥"):
        sign = {"≤": "<", "≥": ">"}.get(bare[0], bare[0])
        bare = bare[1:].lstrip("= ")
    digits = _POWER.sub(lambda m: f"e{m[1]}".replace("\u2212", "-"), bare).strip()
    if not 0 <= exactly(digits) <= 1:
        raise SignkinError(f"p is {text}", expected="a number from 0 to 1, or < or > one")
    if sign == "<" and exactly(digits) == 0:  # `< .000`: no p is, and .000 is what was meant
        sign = "="
    return PrintedP(sign, digits, text.strip())


def printed_statistic(text: str, rounding: str = "nearest") -> tuple[float, float, float]:
    """Return (printed value, least, greatest); `<2.2` and `>3` are bounds."""
    sign, digits = ("=", text.strip())
    if digits[:1] in ("<", ">", "="):
        sign, digits = digits[0], digits[1:].strip()
    values, value = allowed(digits, rounding), float(exactly(digits))
    if sign == "<":
        return value, -inf if value < 0 else 0.0, float(values.high)
    return value, float(values.low), inf if sign == ">" else float(values.high)


def _sf(kind: str, statistic: float, df: Sequence[float]) -> float:
    if kind == "F":
        return float(stats.f.sf(statistic, *df))
    if kind in ("chi2", "H", "Q"):  # H of Kruskal and Wallis is about chi-squared
        return float(stats.chi2.sf(statistic, *df))
    if kind == "r":
        statistic = inf if abs(statistic) >= 1 else statistic * sqrt(df[0] / (1 - statistic**2))
    two = stats.norm.sf(abs(statistic)) if kind == "z" else stats.t.sf(abs(statistic), *df)
    return float(2 * two)


def _want(kind: str, df: Sequence[Number]) -> None:
    if kind not in KINDS:
        raise SignkinError(f"the statistic {kind!r}", expected=listed(KINDS))
    if len(df) != _DF[kind] or any(float(exactly(str(d))) <= 0 for d in df):
        raise SignkinError(
            f"degrees of freedom {list(df)} for {kind}", expected=f"{_DF[kind]}, above 0"
        )


def _is_whole(df: Number) -> bool:
    """Whether degrees of freedom are printed whole (`2`); `2.0` is a rounded number."""
    return float(df).is_integer() if isinstance(df, float) else "." not in str(df)


def _df_ends(df: Number, whole_too: bool, rounding: str) -> tuple[float, ...]:
    """Return the ends of what printed degrees of freedom allow; whole ones stand as they are."""
    if _is_whole(df) and not whole_too:
        return (float(exactly(str(df))),)
    values = allowed(f"{df:g}" if isinstance(df, float) else str(df), rounding)
    return max(float(values.low), 1e-6), float(values.high)


def p_range(
    kind: str, statistic: str, df: Sequence[Number], rounding: str = "nearest",
    tails: str = "two", rounded_df: bool = False,
) -> Range:  # fmt: skip
    """Return the p of a printed statistic (by hand from its digits), and the least and greatest.

    tails: `two`, `one`, or `other` (one-tailed, the effect on the other side than predicted).
    rounded_df: the last degrees of freedom are a rounded number even where they are whole.
    """
    _want(kind, df)
    value, low, high = printed_statistic(statistic, rounding)
    if (kind == "r" and low > 1) or (kind == "r" and high < -1):
        raise SignkinError(f"r is {statistic}", expected="a number from -1 to 1")
    if kind not in SIGNED and high < 0:
        raise SignkinError(f"{kind} is {statistic}", expected="a number from 0")
    sizes = [abs(value), abs(low), abs(high)] + ([0.0] if low < 0 < high else [])
    if kind not in SIGNED:
        sizes = [max(v, 0.0) for v in (value, low, high)]
    ends = [_df_ends(d, rounded_df and i == len(df) - 1, rounding) for i, d in enumerate(df)]
    hand = [float(exactly(str(d))) for d in df]
    found = [_sf(kind, size, corner) for size in sizes for corner in (*product(*ends), hand)]
    here = _sf(kind, abs(value), hand)
    if tails == "two":
        return Range(here, min(found), max(found))
    one = Range(here / 2, min(found) / 2, max(found) / 2)
    return one if tails == "one" else Range(1 - one.value, 1 - one.high, 1 - one.low)


def p_uncorrected(
    statistic: str, df: Sequence[Number], rounding: str = "nearest", epsilon: str = "open"
) -> Range:
    """Return the p of F whose degrees of freedom are printed without their correction.

    Repeated measures: Greenhouse and Geisser, or Huynh and Feldt, multiply both by epsilon, which
    lies between 1 / df1 and 1. epsilon: the printed one, or `open`.
    """
    _want("F", df)
    value, low, high = printed_statistic(statistic, rounding)
    first, second = (float(exactly(str(d))) for d in df)
    ends = (1 / first, 1.0)
    if epsilon != "open":
        given = allowed(epsilon, rounding)
        if not 0 < exactly(epsilon) <= 1:
            raise SignkinError(f"epsilon is {epsilon}", expected="a number up to 1, or open")
        ends = (max(float(given.low), 1 / first), min(float(given.high), 1.0))
        ends = (min(ends), max(ends))
    steps = np.linspace(*ends, 65)
    found = [p for f in (low, high) for p in stats.f.sf(max(f, 0.0), steps * first, steps * second)]
    middle = sum(ends) / 2
    return Range(
        _sf("F", value, (middle * first, middle * second)), float(min(found)), float(max(found))
    )


def correction_told(statistic: str, df: Sequence[Number], p: str) -> str:
    """Return that a correction of repeated measures could give a p, where it could; or nothing."""
    read = printed_p(p)
    if read.sign != "=" or float(exactly(str(df[0]))) <= 1:
        return ""
    found = p_uncorrected(statistic, df)
    if not found.low <= float(exactly(read.digits)) <= found.high:
        return ""
    return "; a correction of repeated measures, with df printed uncorrected, could (epsilon: open)"


def p_from(kind: str, statistic: str, *df: Number, rounding: str = "nearest") -> Range:
    """Return the (two-sided) p of a printed statistic, with what its rounding allows.

    kind: F (two degrees of freedom), t, chi2, H (Kruskal-Wallis), Q, r (n - 2), or z (none).
    Degrees of freedom with decimals (as text) are rounded numbers, too.
    """
    return p_range(kind, statistic, df, rounding)


def statistic_from(kind: str, p: str, *df: float, rounding: str = "nearest") -> Range:
    """Return the statistic (its size) that a printed p belongs to; 0.000 has no upper end."""
    values = allowed(p, rounding)
    _want(kind, df)

    def back(p: float) -> float:
        if p <= 0:
            return 1.0 if kind == "r" else inf
        p = min(p, 1.0)
        if kind == "F":
            return float(stats.f.isf(p, *df))
        if kind in ("chi2", "H", "Q"):
            return float(stats.chi2.isf(p, *df))
        t = float(stats.norm.isf(p / 2) if kind == "z" else stats.t.isf(p / 2, *df))
        return t / sqrt(df[0] + t * t) if kind == "r" else t

    return Range(*(back(float(v)) for v in (exactly(p), values.high, values.low)))


def p_agrees(
    kind: str, statistic: str, df: Sequence[Number], p: str, alpha: str = "0.05",
    rounding: str = "nearest", tails: str = "open", groups: Sequence[int | str] = (),
    epsilon: str = "",
) -> Finding:  # fmt: skip
    """Say whether a printed p (`0.03`, `<0.001`, `>0.05`, `ns`) belongs to a printed statistic.

    The wrong number may be either; where they disagree about alpha the finding says so. What a
    paper leaves open is tried: degrees of freedom printed whole may be rounded (Welch), and with
    tails `open` t, z and r may be one-tailed. groups: the sizes of the groups of a
    Kruskal-Wallis test, whose exact p (no ties) is then tried, too. epsilon: of F in repeated
    measures whose p is corrected and whose degrees of freedom are not; `open` tries any.
    """
    if tails not in TAILS:
        raise SignkinError(f"tails: {tails!r}", expected=listed(TAILS))
    wanted = printed_p(p, alpha)
    _want(kind, df)
    sides = {"open": ("two", "one", "other"), "two": ("two",), "one": ("one", "other")}[tails]
    # F and chi-squared of one degree of freedom are squares: one-tailed where the paper says so.
    one = tails == "one" and kind in ("F", "chi2") and float(exactly(str(df[0]))) == 1
    sides = sides if kind in SIGNED or one else ("two",)
    if tails == "open" and wanted.sign != "=":  # against its prediction any statistic is `ns`
        sides = tuple(side for side in sides if side != "other")
    names = {"two": "two-tailed", "one": "one-tailed", "other": "one-tailed, the other way"}
    whole = kind in ("t", "F") and _is_whole(df[-1])
    readings = []
    for side in sides:
        for rounded in (False, True) if whole else (False,):
            name = names[side] if kind in SIGNED or one else "printed"
            name += " with rounded degrees of freedom" if rounded else ""
            found = partial(p_range, kind, statistic, df, rounding, side, rounded)
            readings.append((name, partial(_compared, kind, statistic, df, wanted, alpha,
                                           rounding, found, name)))  # fmt: skip
    if kind == "r" and _is_whole(df[0]) and float(df[0]) > 3:  # r(60) of 60 people
        less = [str(int(float(df[0])) - 2)]
        found = partial(p_range, kind, statistic, less, rounding, sides[0])
        name = f"{names[sides[0]]} with n, not df, in brackets"
        readings.append((name, partial(_compared, kind, statistic, less, wanted, alpha, rounding,
                                       found, name)))  # fmt: skip
    if epsilon and kind == "F":
        found = partial(p_uncorrected, statistic, df, rounding, epsilon)
        name = "of uncorrected degrees of freedom"
        readings.append((name, partial(_compared, kind, statistic, df, wanted, alpha, rounding,
                                       found, name)))  # fmt: skip
    if kind == "H" and groups:
        found = partial(exact_tail, statistic, groups, rounding)
        readings.append(("the exact test", partial(_compared, kind, statistic, df, wanted, alpha,
                                                   rounding, found, "exact")))  # fmt: skip
    words = [word for word, there in (
        ("one-tailed", "one" in sides and sides[0] != "one"),
        ("degrees of freedom rounded", whole), ("n in brackets", kind == "r"),
        ("the exact test", kind == "H" and bool(groups)),
        ("degrees of freedom uncorrected", kind == "F" and bool(epsilon)),
    ) if there]  # fmt: skip
    out = over_readings(readings, ", ".join(words))
    return replace(out, hand=_in_r(kind, statistic, df, "one" in out.settings))


def _in_r(kind: str, statistic: str, df: Sequence[Number], one: bool) -> str:
    """Return how to redo a p in R, from the printed digits."""
    value = re.sub(r"^[<>=\s]+", "", statistic).replace("\u2212", "-")
    size, dfs = value.lstrip("-"), ", ".join(str(d) for d in df)
    times = "" if one else "2 * "
    if kind == "F":
        told = f"pf({value}, {dfs}, lower.tail = FALSE)"
    elif kind in ("chi2", "H", "Q"):
        told = f"pchisq({value}, {dfs}, lower.tail = FALSE)"
    elif kind == "z":
        told = f"{times}pnorm(-{size})"
    elif kind == "r":
        told = f"{times}pt(-{size} * sqrt({dfs} / (1 - {size}^2)), {dfs})"
    else:
        told = f"{times}pt(-{size}, {dfs})"
    return f"in R {told}"


def _compared(
    kind: str, statistic: str, df: Sequence[Number], p: PrintedP, alpha: str, rounding: str,
    find: partial[Range], name: str,
) -> Finding:  # fmt: skip
    found = find()
    value = exactly(p.digits)
    if p.sign == "<":
        fits = found.low < value
    elif p.sign == ">":
        fits = found.high > value
    else:
        print_ = allowed(p.digits, rounding)
        tiny = 1e-12
        fits = found.low <= float(print_.high) + tiny and float(print_.low) - tiny <= found.high
    level = float(number(alpha))
    claimed = p.significant(level)
    differs = claimed is not None and claimed != (found.value < level)
    told = ", ".join(str(d) for d in df)
    equals = statistic if statistic.strip()[:1] in ("<", ">") else f"= {statistic}"
    shape = f"{kind}({told}) {equals}" if df else f"{kind} {equals}"
    bare = p.text.lstrip("p ").strip()
    why = f"{shape} has p {found}"
    told_of = ("one-tailed", "exact", "n, not df", "uncorrected")
    why += f", {name}" if any(word in name for word in told_of) else ""
    if fits:
        return Finding(CONSISTENT, why, f"p {bare}", f"{found.value:.6g}", found.interval,
                       settings=_settings(told, name))  # fmt: skip
    why += ", not as printed: one of the two is wrong"
    why += f", and they disagree about {alpha}" if differs else ""
    near = f"p = {shown(found.value, 3)}"
    if p.sign == "=" and kind != "H":
        back = statistic_from(kind, p.digits, *(float(exactly(str(d))) for d in df))
        near += f", or {kind} of {shown(back.low, 4)} to {shown(back.high, 4)}"
    return Finding(
        INCONSISTENT, why, f"p {bare}", f"{found.value:.6g}", found.interval, nearest=near,
        settings=_settings(told, name), severity=DECISION if differs else DIGITS,
    )  # fmt: skip


def _settings(df: str, name: str) -> str:
    return ", ".join(
        part for part in (f"df {df}" if df else "", name) if part and part != "printed"
    )
